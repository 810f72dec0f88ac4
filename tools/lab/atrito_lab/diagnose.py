"""Why a value is right or wrong, in the words that a person who marks would use."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Callable

from .handin import HandIn, number_of, shown, text_of
from .program import Run
from .references import Folder, Reference
from .sheet import Explanation, Mistake, Quantity, Sheet, is_number, mistaken_values
from .tables import Table, TableError, differences, parameters_of, read_table, value_of

CLOSE = 3e-3  # what is copied with three digits and more
DIGITS = 3e-5  # what a table with six digits may differ from one with more
DECK_KINDS = {2: ("damaged", "The deck has errors"), 3: ("not converged", "The deck does not converge"),
              4: ("no equilibrium", "The deck has no unique equilibrium"),
              5: ("file", "The deck wants a file that it may not read, or is too large")}
FACTORS = (2.0, 4.0, 10.0, 100.0, 1e3, 1e6)


@dataclass
class Verdict:
    """Points of one item, and the reason."""

    name: str
    text: str
    points: float
    of: float
    kind: str
    reason: str
    value: float | None = None
    right: float | None = None
    unit: str = ""


@dataclass
class TableState:
    """A table that was handed in, or why there is none; kind "right" when the deck was run again and gives it."""

    table: Table | None
    kind: str
    reason: str


@dataclass
class Case:
    """All that is known of one hand-in."""

    sheet: Sheet
    hand_in: HandIn
    reference: Reference
    class_references: dict[str, Reference]
    run: Run | None = None
    own: Folder | None = None
    run_own: Callable[[str], Folder | None] = lambda run: None
    states: dict[str, TableState] = field(default_factory=dict)
    deck_kind: str = ""
    deck_reason: str = ""
    values_kind: str = ""
    values_reason: str = ""
    neighbour: str = ""
    verdicts: list[Verdict] = field(default_factory=list)

    @property
    def points(self) -> float:
        """Points in all."""
        return round(sum(verdict.points for verdict in self.verdicts), 6)


def diagnose(case: Case) -> None:
    """Fill the verdicts of a case whose deck has been run again."""
    _judge_deck(case)
    if case.own:
        _judge_values(case)
    for name in case.sheet.tables:
        case.states[name] = _judge_table(case, name)
    given = {quantity.name: _given(case, quantity) for quantity in case.sheet.quantities}
    wrong = {name: item for name, item in given.items() if isinstance(item, float)}
    case.neighbour = case.neighbour or _neighbour_of(case, wrong)
    share = case.sheet.table_points/max(1, len(case.sheet.tables))
    for name in case.sheet.tables if share else []:
        state = case.states[name]
        credit = 1.0 if state.kind == "right" else case.sheet.credit.get(state.kind, 0.0)
        case.verdicts.append(Verdict(f"table {name}", f"Table {name}, as the deck gives it", credit*share, share, state.kind,
                                     state.reason))
    for quantity in case.sheet.quantities:
        case.verdicts.append(_judge_quantity(case, quantity, given[quantity.name]))
    for explanation in case.sheet.explanations:
        case.verdicts.append(_judge_explanation(case, explanation))


def give_up(case: Case, reason: str) -> None:
    """No points for anything, for a reason that is none of the student's: the lecturer has to look."""
    sheet = case.sheet
    share = sheet.table_points/max(1, len(sheet.tables))
    items = [(f"table {name}", f"Table {name}, as the deck gives it", share) for name in sheet.tables if share]
    items += [(item.name, item.text, item.points) for item in sheet.quantities]
    items += [(item.name, item.text, item.points) for item in sheet.explanations]
    case.verdicts = [Verdict(name, text, 0.0, points, "not marked", reason) for name, text, points in items]


# ---- the deck ----

def _judge_deck(case: Case) -> None:
    """What the deck that was handed in does when it is run again."""
    run = case.run
    if not case.hand_in.there:
        case.deck_kind, case.deck_reason = "missing", "Nothing was handed in."
    elif case.hand_in.deck is None or run is None:
        case.deck_kind, case.deck_reason = "missing", "There is no deck, so the tables cannot be made again."
    elif not case.hand_in.deck.read_bytes().strip():
        case.deck_kind, case.deck_reason = "empty", "The deck is an empty file."
    elif run.timed_out:
        case.deck_kind, case.deck_reason = "time", "The deck ran for longer than it may and was ended."
    elif run.code != 0:
        case.deck_kind, words = DECK_KINDS.get(run.code, ("damaged", f"The deck cannot be run (exit code {run.code})"))
        case.deck_reason = f"{words}: {shown(run.error, 300)}" if run.error else f"{words}."
    else:
        case.deck_kind, case.deck_reason = "right", "The deck runs."


def _judge_values(case: Case) -> None:
    """Whether the deck has the values of the student; if not, whose, or which mistake that is."""
    assert case.own
    try:
        has = parameters_of(case.own.table("summary"))
    except TableError:
        return
    drawn = case.reference.drawn

    def differing(values: dict[str, str]) -> list[str]:
        return [name for name in drawn if name.lower() in has and not _near(has[name.lower()], float(values[name]), 1e-9)]

    differ = differing(drawn)
    if not differ:
        return
    words = ", ".join(f"{name} = {has[name.lower()]:g} (yours is {drawn[name]})" for name in differ)
    case.values_kind, case.values_reason = "own", f"The deck has other values than your sheet: {words}."
    for other, reference in case.class_references.items():
        if other != case.hand_in.number and not differing(reference.drawn):
            case.neighbour = other
            case.values_kind, case.values_reason = "neighbour", f"The deck has the values of somebody else: {words}."
            return
    for mistake in case.sheet.mistakes:
        changed = {name: value for name, value in mistaken_values(mistake, drawn).items() if is_number(value)}
        if mistake.values and not differing(drawn | changed):
            case.values_kind, case.values_reason = f"mistake:{mistake.name}", f"{mistake.text} The deck has {words}."
            return
    ratio = has[differ[0].lower()]/float(drawn[differ[0]]) if float(drawn[differ[0]]) else 0.0
    if len(differ) == 1 and any(_near(ratio, factor, CLOSE) or _near(ratio, 1/factor, CLOSE) for factor in FACTORS if factor >= 10):
        case.values_kind, case.values_reason = "unit", f"A value of the deck is in another unit: {words}."


# ---- tables ----

def _judge_table(case: Case, name: str) -> TableState:
    """A table that was handed in: is it there, whole, converged, and what the deck gives?"""
    path = case.hand_in.tables.get(name)
    if path is None:
        return TableState(None, "missing", f"The table {name} was not handed in.")
    try:
        table = read_table(path)
    except TableError as trouble:
        kind = "empty" if "empty" in str(trouble) else "damaged"
        return TableState(None, kind, f"The table {name} cannot be read: {trouble}.")
    if not table.converged:
        return TableState(table, "not converged", f"The table {name} is of a run that did not converge, as its first line says.")
    if case.own is None:
        return TableState(table, "unverified", f"The table {name} could not be made again. {case.deck_reason}")
    try:
        made = case.own.table(name)
        count, total, first = differences(table, made, DIGITS)
    except TableError as trouble:
        return TableState(table, "edited", f"The deck that was handed in does not give the table {name}: {trouble}.")
    if count:
        digest = table.heads.get("digest")
        other = digest and digest != made.heads.get("digest")
        how = "comes from another deck than the one handed in" if other else "was changed by hand, or is made up"
        return TableState(table, "other deck" if other else "edited",
                          f"The table {name} {how}: when the deck is run again, {count} of {total} numbers differ, first the {first}.")
    if case.values_kind == "neighbour":
        return TableState(table, "neighbour", case.values_reason)
    return TableState(table, "right", f"The deck gives the table {name}.")


# ---- quantities ----

def _given(case: Case, quantity: Quantity) -> float | Verdict:
    """The value that was handed in, or the verdict where there is none."""
    def none(kind: str, reason: str) -> Verdict:
        right = case.reference.value(quantity)
        return Verdict(quantity.name, quantity.text, 0.0, quantity.points, kind, reason, None, right, quantity.unit)

    if quantity.given == "table":
        assert quantity.cell
        state = case.states[quantity.cell.table]
        if state.table is None:
            return none(state.kind, state.reason)
        try:
            return value_of(state.table, quantity.cell, quantity.step)
        except TableError as trouble:
            if not state.table.converged:
                return none("not converged", state.reason)
            return none("damaged", f"The table {quantity.cell.table} has no such value: {trouble}.")
    answer = case.hand_in.answers.get(quantity.name.lower(), "")
    if answer == "":
        return none("missing", "There is no answer." if case.hand_in.there else "Nothing was handed in.")
    value, _ = number_of(answer)
    if value is None:
        return none("damaged", f"{shown(str(answer), 40)!r} is not a number.")
    return value


def _judge_quantity(case: Case, quantity: Quantity, given: float | Verdict) -> Verdict:
    if isinstance(given, Verdict):
        return given
    right = case.reference.value(quantity)
    kind, credit, reason = _classify(case, quantity, given, right)
    if quantity.given == "table":
        assert quantity.cell
        state = case.states[quantity.cell.table]
        if state.kind not in ("right", "neighbour"):
            part = case.sheet.credit.get(state.kind, 0.0)
            reason = state.reason if credit >= 1 or part == 0 else f"{reason} {state.reason}"
            kind, credit = state.kind, min(credit, part)
    if credit < 1 and quantity.hint:
        reason = f"{reason} {quantity.hint}"
    points = round(credit*quantity.points, 6)
    return Verdict(quantity.name, quantity.text, points, quantity.points, kind, reason, given, right, quantity.unit)


def _classify(case: Case, quantity: Quantity, value: float, right: float) -> tuple[str, float, str]:
    """Kind, part of the points, and reason."""
    size = max(abs(right), quantity.scale)
    if abs(value - right) <= quantity.tolerance*size:
        return "right", 1.0, "Right."
    folder = (case.run_own(quantity.run) if quantity.run else case.own) if case.own else None
    own = folder.value(quantity) if folder else None
    from_own = own is not None and abs(value - own) <= max(CLOSE*abs(own), 0.2*quantity.tolerance*size)
    if from_own and case.values_kind:
        return _credited(case, case.values_kind, case.values_reason)
    if case.neighbour and _is_of(case.class_references[case.neighbour], quantity, value):
        return _credited(case, "neighbour", "This is the value of somebody else, not yours.")
    if from_own and folder:
        verdict = _judge_mesh(case, quantity, value, right, folder.estimate())
        if verdict:
            return verdict
    for step, increment, other in case.reference.others(quantity):
        if _near(value, other, CLOSE) and not _near(other, right, CLOSE):
            asked = f"step {quantity.step}" if quantity.step else "the last step"
            return _credited(case, "step", f"This is the value of step {step}, increment {increment}; asked for is the end of {asked}.")
    verdict = _judge_mistakes(case, quantity, value, right, from_own) or _judge_factor(case, quantity, value, right)
    if verdict:
        return verdict
    if from_own:
        return "deck", 0.0, "This is what your deck gives, but the deck is not what was asked for."
    if own is not None and abs(own - right) <= quantity.tolerance*size:
        return "wrong", 0.0, f"Wrong. Your own run gives {own:.4g}."
    return "wrong", 0.0, "Wrong." if case.deck_kind in ("right", "missing") else f"Wrong. {case.deck_reason}"


def _credited(case: Case, kind: str, reason: str) -> tuple[str, float, str]:
    """A verdict with the part of the points that the sheet gives for its kind."""
    if kind.startswith("mistake:"):
        mistake = next(item for item in case.sheet.mistakes if f"mistake:{item.name}" == kind)
        kind = "exchanged" if mistake.kind == "exchanged" else kind
        return kind, mistake.credit if mistake.credit >= 0 else case.sheet.credit[mistake.kind], reason
    return kind, case.sheet.credit.get(kind, 0.0), reason


def _judge_mesh(case: Case, quantity: Quantity, value: float, right: float, mine: float) -> tuple[str, float, str] | None:
    """Whether the mesh explains the difference.

    It may be twice what one more refinement changes, by the square of the ratio of the estimated errors, or the square of the
    student's estimated error, which is what the energy is off by; never more than `coarse`.
    """
    finer, theirs, size = case.reference.finer(quantity), case.reference.tables(quantity.run).estimate(), max(abs(right), quantity.scale)
    ratio = max(1.0, mine/theirs) if mine > 0 and theirs > 0 else 1.0
    refined = 2*abs(right - (right if finer is None else finer))*ratio**2
    allowed = quantity.tolerance*size + max(refined, (mine/100)**2*size)
    estimates = f"estimated error {mine:.2g} % beside {theirs:.2g} % of the reference"
    if abs(value - right) <= min(allowed, quantity.coarse*size):
        return "mesh", case.sheet.credit["mesh"], f"Right within your mesh ({estimates})."
    if ratio > 1.2 and abs(value - right) <= max(allowed, quantity.coarse*size, 0.02*mine*size):
        return "coarse", case.sheet.credit["coarse"], f"The mesh is too coarse for this value ({estimates})."
    return None


def _judge_mistakes(case: Case, quantity: Quantity, value: float, right: float, from_own: bool) -> tuple[str, float, str] | None:
    """Which of the sheet's mistakes comes nearest to this value; of what a deck with the right values gives none of the values."""
    near: list[tuple[float, Mistake]] = []
    for place, mistake in enumerate(case.sheet.mistakes):
        wrong = None if mistake.values and from_own else case.reference.mistaken(mistake, place, quantity)
        if wrong is not None and _near(value, wrong, CLOSE) and not _near(wrong, right, CLOSE):
            near.append((abs(value - wrong), mistake))
    if not near:
        return None
    mistake = min(near, key=lambda item: item[0])[1]
    return _credited(case, f"mistake:{mistake.name}", mistake.text)


def _judge_factor(case: Case, quantity: Quantity, value: float, right: float) -> tuple[str, float, str] | None:
    """Whether the sign is wrong, or a factor that is a half of a symmetric scene, a power of ten or a unit."""
    near = max(quantity.tolerance, CLOSE)
    if right == 0 or value == 0:
        return None
    if _near(value, -right, near):
        return _credited(case, "sign", "The size is right, the sign is not.")
    for factor in FACTORS:
        for ratio, words in ((factor, f"{factor:g} times"), (1/factor, f"1/{factor:g} of")):
            if _near(abs(value), abs(right)*ratio, near):
                sign = " and has the other sign" if value*right < 0 else ""
                if factor >= 10:
                    unit = f" Is it in another unit than {quantity.unit}?" if quantity.unit else " Is the point at the right place?"
                    return _credited(case, "unit" if quantity.unit else "factor", f"The value is {words} the right one{sign}.{unit}")
                return _credited(case, "factor", f"The value is {words} the right one{sign}.")
    return None


def _neighbour_of(case: Case, given: dict[str, float]) -> str:
    """Whose values these are: the one of the class with whom most wrong values agree, three of four, and two at least.

    One alone counts where one is asked for. Values of a class are round and lie close together: fewer agree by chance.
    """
    quantities = {quantity.name: quantity for quantity in case.sheet.quantities}
    wrong = {name: value for name, value in given.items()
             if abs(value - case.reference.value(quantities[name])) > quantities[name].tolerance*max(
                 abs(case.reference.value(quantities[name])), quantities[name].scale)}
    best, most = "", 0
    for number, reference in case.class_references.items():
        if number == case.hand_in.number:
            continue
        same = [name for name, value in wrong.items() if _is_of(reference, quantities[name], value)]
        if len(same) > most and (len(same) >= 2 or len(same) == len(given)):
            best, most = number, len(same)
    return best if 4*most >= 3*len(wrong) else ""


def _is_of(reference: Reference, quantity: Quantity, value: float) -> bool:
    return _near(value, reference.value(quantity), 1e-3)


# ---- explanations ----

def _judge_explanation(case: Case, explanation: Explanation) -> Verdict:
    """Whether a text is there, and long enough to be read."""
    text = text_of(case.hand_in.answers.get(explanation.name.lower()))
    count = len(text.split())
    if not count:
        kind, credit, reason = "missing", 0.0, "There is no explanation." if case.hand_in.there else "Nothing was handed in."
    elif count < explanation.words:
        kind, credit, reason = "short", 0.5, f"{count} words are too few; at least {explanation.words} were asked for."
    else:
        kind, credit, reason = "lecturer", 1.0, f"{count} words; the lecturer reads them, and may change the points."
    return Verdict(explanation.name, explanation.text, credit*explanation.points, explanation.points, kind, reason)


def _near(value: float, other: float, relative: float) -> bool:
    return abs(value - other) <= relative*abs(other)
