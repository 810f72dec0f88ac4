"""Makes a class for a sheet: hand-ins of all kinds, and of each the reasons and points that it should have.

A maker writes one hand-in and gives what is not simply right: item -> (kinds that are right, part of the points; None: any).
"""

from __future__ import annotations

import random
import re
from pathlib import Path

from atrito_lab.program import Keeper, Limits, run_atrito
from atrito_lab.references import Reference
from atrito_lab.sheet import Mistake, Quantity, Sheet, mistaken_deck

WORDS = """the pressure grows with load mesh finer edge slip sticks because both bodies yield same amount under contact where friction does not matter since
nothing moves along it and so we saw half of that when force was smaller error falls table shows near corner larger than expected by formula""".split()
Expected = dict[str, tuple[set[str], float | None]]


def said_by(number: str, name: str) -> str:
    """An explanation in words of one's own."""
    return " ".join(random.Random(number + name).choices(WORDS, k=60)) + "."


class Made:
    """One hand-in that is being made."""

    def __init__(self, sheet: Sheet, keeper: Keeper, number: str, neighbour: str, folder: Path) -> None:
        self.sheet, self.keeper, self.number, self.folder = sheet, keeper, number, folder
        self.reference, self.other = Reference(sheet, keeper, number), Reference(sheet, keeper, neighbour)
        self.deck = sheet.complete_deck(self.reference.drawn)
        self.values = {quantity.name: self.reference.value(quantity) for quantity in sheet.quantities}
        self.texts = {item.name: said_by(number, item.name) for item in sheet.explanations}

    @property
    def asked(self) -> list[Quantity]:
        """Quantities that are answered in answers.toml."""
        return [quantity for quantity in self.sheet.quantities if quantity.given == "answer"]

    def of_tables(self, names: list[str] | None = None) -> list[str]:
        """Items that come from tables."""
        names = self.sheet.tables if names is None else names
        shared = [f"table {name}" for name in names] if self.sheet.table_points else []
        return shared + [quantity.name for quantity in self.sheet.quantities
                         if quantity.given == "table" and quantity.cell and quantity.cell.table in names]

    def write(self, options: list[str] | None = None, digits: str = "6") -> None:
        """The hand-in as it is by now: deck, tables of its run, answers."""
        self.folder.mkdir()
        (self.folder/self.sheet.deck_name).write_text(self.deck)
        run_atrito(self.keeper.program, [self.sheet.deck_name, "-o", "output", "--quiet", *(options or [])], self.folder, Limits(),
                   self.folder/"output")
        lines = [f'student = "{self.number}"', "[answers]", *[f"{item.name} = {self.values[item.name]:.{digits}g}" for item in self.asked],
                 "[explanations]", *[f'{name} = """\n{text}\n"""' for name, text in self.texts.items()]]
        (self.folder/"answers.toml").write_text("\n".join(lines) + "\n")

    def is_right(self, quantity: Quantity, value: float) -> bool:
        """Whether a value is within the tolerance."""
        right_value = self.reference.value(quantity)
        return abs(value - right_value) <= quantity.tolerance*max(abs(right_value), quantity.scale)

    def table(self, name: str) -> Path:
        """A table that was written."""
        return self.folder/"output"/f"{name}.tab"

    def all_items(self) -> list[str]:
        """Every item of the sheet."""
        return self.of_tables() + [item.name for item in self.asked] + [item.name for item in self.sheet.explanations]


def right(made: Made) -> Expected:
    made.write()
    return {}


def six_digits(made: Made) -> Expected:
    made.write(["--digits", "6"])
    return {}


def several_runs(made: Made) -> Expected:
    """Runs with other friction, or what the last parameter is, beside the one that counts, in folders that come before it."""
    made.write()
    for parameter in made.sheet.parameters[-1:]:
        words = [made.sheet.deck_name, "-o", "a-try", "--quiet", "--set", f"{parameter.name}={parameter.choices[-1]}*1.5"]
        run_atrito(made.keeper.program, words, made.folder, Limits(), made.folder/"a-try")
    return {}


def by_set(made: Made) -> Expected:
    """The deck has the values of nobody, the command line those of the student."""
    own, made.deck = made.reference.drawn, made.sheet.complete_deck({})
    made.write([word for name, value in own.items() for word in ("--set", f"{name}={value}")])
    return {}


def same_words(made: Made) -> Expected:
    made.texts = {name: said_by(made.other.number, name) for name in made.texts}
    made.write()
    return {}


def twelve_digits_in_odd_places(made: Made) -> Expected:
    made.write(["--digits", "12"], "12")
    (made.folder/"work").mkdir()
    (made.folder/made.sheet.deck_name).rename(made.folder/"work"/"my deck (final).inp")
    (made.folder/"output").rename(made.folder/"work"/"results 2")
    (made.folder/"answers.toml").rename(made.folder/"work"/"answers (1).toml")
    return {}


def comma_and_unit(made: Made) -> Expected:
    made.write()
    path = made.folder/"answers.toml"
    units = {item.name: item.unit for item in made.asked}
    path.write_text(re.sub(r"(?m)^(\w+) = ([-\d.e+]+)$", lambda found: f'{found[1]} = "{found[2].replace(".", ",")} {units[found[1]]}"',
                           path.read_text()))
    return {}


def damaged_answers(made: Made) -> Expected:
    made.write()
    path = made.folder/"answers.toml"
    path.write_text(re.sub(r"(?m)^(\w+) = (?=[-\d])", r'\1 = ""', path.read_text().replace("[answers]", "[answers")))
    return {}


def csv_tables(made: Made) -> Expected:
    made.write(["--format", "csv"])
    return {}


def refined(made: Made) -> Expected:
    made.write(["--refine", "1"])
    return {name: ({"right", "mesh"}, 1.0) for name in made.of_tables()}


def coarse(made: Made) -> Expected:
    made.deck = re.sub(r"(N[XY]=)(\d+)", lambda found: f"{found[1]}{max(1, int(found[2])//2)}", made.deck)
    return _own_run(made, {"mesh"}, 1.0)


def very_coarse(made: Made) -> Expected:
    made.deck = re.sub(r"(N[XY]=)(\d+)", lambda found: f"{found[1]}{max(1, int(found[2])//4)}", made.deck)
    return _own_run(made, {"mesh", "coarse"}, None)


def _own_run(made: Made, kinds: set[str], credit: float | None) -> Expected:
    """Answers are what the deck gives; `kinds` is expected of what is not within the tolerance."""
    expected: Expected = {}
    for quantity in made.sheet.quantities:
        value = made.reference.value_by(made.deck, quantity, made.sheet.refine)
        if value is not None:
            made.values[quantity.name] = value
            if not made.is_right(quantity, value):
                expected[quantity.name] = (kinds, credit)
    made.write()
    return expected


def _scaled(made: Made, factor: float, kinds: set[str], credit: float) -> Expected:
    for item in made.asked:
        made.values[item.name] *= factor
    made.write()
    return {item.name: (kinds, credit) for item in made.asked if not made.is_right(item, made.values[item.name])}


def sign(made: Made) -> Expected:
    return _scaled(made, -1, {"sign"}, made.sheet.credit["sign"])


def twice(made: Made) -> Expected:
    return _scaled(made, 2, {"factor"} | _mistaken(made), None)


def _mistaken(made: Made) -> set[str]:
    return {f"mistake:{mistake.name}" for mistake in made.sheet.mistakes} | {"exchanged"}


def thousand(made: Made) -> Expected:
    return _scaled(made, 1000, {"unit", "factor"}, 0.5)


def tenth(made: Made) -> Expected:
    return _scaled(made, 0.1, {"unit", "factor"}, 0.5)


def wrong(made: Made) -> Expected:
    return _scaled(made, 1.37, {"wrong"}, 0.0)


def force_in_other_unit(made: Made) -> Expected:
    if not made.sheet.parameters:
        return right(made)
    parameter = made.sheet.parameters[-1]
    made.deck = made.sheet.complete_deck(made.reference.drawn | {parameter.name: repr(float(made.reference.drawn[parameter.name])*10)})
    made.write()
    return {name: ({"right", "unit"}, None) for name in made.of_tables()}


def exchanged(made: Made) -> Expected:
    mistake = next((item for item in made.sheet.mistakes if item.kind == "exchanged"), None)
    return right(made) if mistake is None else _mistake_in_deck(made, mistake)


def mistake_in_deck(made: Made) -> Expected:
    mistake = next((item for item in made.sheet.mistakes if item.replace), None)
    return right(made) if mistake is None else _mistake_in_deck(made, mistake)


def mistake_in_formula(made: Made) -> Expected:
    expected: Expected = {}
    for place, mistake in enumerate(made.sheet.mistakes):
        quantity = next((item for item in made.asked if item.name == mistake.quantity), None)
        if quantity and quantity.name not in expected:
            value = made.reference.mistaken(mistake, place, quantity)
            assert value is not None
            made.values[quantity.name] = value
            expected[quantity.name] = ({f"mistake:{mistake.name}"}, mistake.credit if mistake.credit >= 0 else 0.5)
    made.write()
    return expected


def _mistake_in_deck(made: Made, mistake: Mistake) -> Expected:
    made.deck = mistaken_deck(made.sheet, mistake, made.reference.drawn)
    kind = "exchanged" if mistake.kind == "exchanged" else f"mistake:{mistake.name}"
    expected: Expected = {}
    for quantity in made.sheet.quantities:
        value = made.reference.mistaken(mistake, made.sheet.mistakes.index(mistake), quantity)
        if value is None:
            continue
        made.values[quantity.name] = value
        if not made.is_right(quantity, value):
            expected[quantity.name] = ({kind}, mistake.credit if mistake.credit >= 0 else made.sheet.credit[mistake.kind])
    made.write()
    assert expected, f"mistake {mistake.name} changes nothing"
    return expected


def neighbour_in_all(made: Made) -> Expected:
    made.deck = made.sheet.complete_deck(made.other.drawn)
    expected = _neighbours_answers(made, made.sheet.quantities)
    if made.sheet.table_points and made.other.drawn != made.reference.drawn:
        expected |= {f"table {name}": ({"neighbour"}, 0.0) for name in made.sheet.tables}
    return expected


def neighbours_answers(made: Made) -> Expected:
    return _neighbours_answers(made, made.asked)


def _neighbours_answers(made: Made, quantities: list[Quantity]) -> Expected:
    expected: Expected = {}
    for quantity in quantities:
        made.values[quantity.name] = made.other.value(quantity)
        if not made.is_right(quantity, made.values[quantity.name]):
            expected[quantity.name] = ({"neighbour"}, 0.0)
    made.write()
    if len(expected) == 1 and made.deck != made.sheet.complete_deck(made.other.drawn):  # one value alone says little
        return {name: ({"neighbour", "wrong", "factor", "unit", "step"} | _mistaken(made), None) for name in expected}
    return expected


def edited(made: Made) -> Expected:
    """The values that count are made 5 % larger in the tables."""
    made.write()
    names = made.sheet.tables
    for name in names:
        path = made.table(name)
        path.write_text("".join(_larger(line) for line in path.read_text().splitlines(keepends=True)))
    return {name: ({"edited"}, 0.0) for name in made.of_tables()}


def _larger(line: str) -> str:
    return line if line.startswith("#") else re.sub(r"(\d\.\d+e[+-]\d\d)", lambda found: f"{float(found[1])*1.05:.9e}", line)


def edited_once(made: Made) -> Expected:
    """One number of one table, in the last row that has any."""
    if not made.sheet.tables:
        return right(made)
    made.write()
    path = made.table(made.sheet.tables[-1])
    lines = path.read_text().splitlines(keepends=True)
    place = max(place for place, line in enumerate(lines) if re.search(r"[1-9]\.\d+e[+-]\d\d", line) and not line.startswith("#"))
    lines[place] = re.sub(r"([1-9]\.\d+)(e[+-]\d\d)", lambda found: f"{float(found[1])*1.5:.9f}{found[2]}", lines[place])
    path.write_text("".join(lines))
    return {name: ({"edited"}, 0.0) for name in made.of_tables([made.sheet.tables[-1]])}


def added_rows(made: Made) -> Expected:
    """A later step, with larger numbers, behind the rows of the run."""
    made.write()
    for name in made.sheet.tables:
        lines = made.table(name).read_text().splitlines()
        rows = [re.sub(r"^( *)\d+", r"\g<1>7", _larger(line)) for line in lines if not line.startswith("#")]
        made.table(name).write_text("\n".join([*lines, *rows]) + "\n")
    return {name: ({"edited"}, 0.0) for name in made.of_tables()}


def tables_of_another_deck(made: Made) -> Expected:
    """Tables of the neighbour's deck beside one's own."""
    own = made.deck
    made.deck = made.sheet.complete_deck(made.other.drawn)
    made.write()
    (made.folder/made.sheet.deck_name).write_text(own)
    return {} if made.other.drawn == made.reference.drawn else {name: ({"other deck"}, 0.0) for name in made.of_tables()}


def not_converged(made: Made) -> Expected:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_text("# NOT CONVERGED\n" + made.table(name).read_text())
    return {name: ({"not converged"}, 0.0) for name in made.of_tables()}


def cut_tables(made: Made) -> Expected:
    made.write()
    for name in made.sheet.tables:
        text = made.table(name).read_text()
        made.table(name).write_text(text[:len(text) - 30])
    return {name: ({"damaged"}, 0.0) for name in made.of_tables()}


def binary_tables(made: Made) -> Expected:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_bytes(b"PK\x03\x04\0\0" + bytes(range(256))*9)
    return {name: ({"damaged"}, 0.0) for name in made.of_tables()}


def empty_tables(made: Made) -> Expected:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_text("")
    return {name: ({"empty"}, 0.0) for name in made.of_tables()}


def no_tables(made: Made) -> Expected:
    made.write()
    for name in made.sheet.tables:
        made.table(name).unlink()
    return {name: ({"missing"}, 0.0) for name in made.of_tables()}


def no_deck(made: Made) -> Expected:
    made.write()
    (made.folder/made.sheet.deck_name).unlink()
    return {name: ({"unverified"}, 0.5) for name in made.of_tables()}


def deck_with_gaps(made: Made) -> Expected:
    made.write()
    (made.folder/made.sheet.deck_name).write_text("*NODE\n1, what\n" + made.deck)
    return {name: ({"unverified"}, 0.5) for name in made.of_tables()}


def no_answers(made: Made) -> Expected:
    made.write()
    (made.folder/"answers.toml").unlink()
    return {item.name: ({"missing"}, 0.0) for item in [*made.asked, *made.sheet.explanations]}


def nothing(made: Made) -> Expected:
    return {name: ({"missing"}, 0.0) for name in made.all_items()}


def words_for_numbers(made: Made) -> Expected:
    made.write()
    path = made.folder/"answers.toml"
    path.write_text(re.sub(r"(?m)^(\w+) = [-\d.e+]+$", r'\1 = "see the table"', path.read_text()))
    return {item.name: ({"damaged"}, 0.0) for item in made.asked}


def no_explanation(made: Made) -> Expected:
    made.texts = dict.fromkeys(made.texts, "")
    made.write()
    return {item.name: ({"missing"}, 0.0) for item in made.sheet.explanations}


def short_explanation(made: Made) -> Expected:
    made.texts = dict.fromkeys(made.texts, "Because of friction.")
    made.write()
    return {item.name: ({"short"}, 0.5) for item in made.sheet.explanations}


def late_step(made: Made) -> Expected:
    expected: Expected = {}
    for quantity in made.asked:
        for _, _, value in made.reference.others(quantity)[:1]:
            if abs(value - made.values[quantity.name]) > max(quantity.tolerance, 0.01)*abs(made.values[quantity.name]):
                made.values[quantity.name] = value
                expected[quantity.name] = ({"step"}, 0.5)
    made.write()
    return expected


KINDS = [right, six_digits, same_words, several_runs, by_set, twelve_digits_in_odd_places, comma_and_unit, damaged_answers, csv_tables, refined, coarse, very_coarse, sign, twice,
         thousand, exchanged, mistake_in_deck, mistake_in_formula, neighbour_in_all, neighbours_answers, edited, edited_once, added_rows,
         tables_of_another_deck, not_converged, cut_tables, late_step, no_deck, deck_with_gaps, nothing, no_explanation, binary_tables,
         empty_tables, no_tables, no_answers, words_for_numbers, short_explanation, tenth, wrong, right, coarse, edited, sign]
