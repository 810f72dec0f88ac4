"""A sheet: one folder with sheet.md and sheet.toml, and a deck with gaps. docs/labs/README.md has the format."""

from __future__ import annotations

import hashlib
import re
import textwrap
import tomllib
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Any

from .program import LabError
from .tables import Cell

GAP, END = re.compile(r"^\*\*\s*LAB\s+gap:\s*(.*)$", re.I), re.compile(r"^\*\*\s*LAB\s+end\s*$", re.I)
NAME = re.compile(r"[a-z][a-z0-9_]{0,24}", re.I)
# part of the points for what is not quite right; a sheet may say otherwise in [credit]
CREDIT = {"mesh": 1.0, "sign": 0.5, "factor": 0.5, "unit": 0.5, "exchanged": 0.5, "mistake": 0.5, "coarse": 0.5, "step": 0.5,
          "own": 0.5, "unverified": 0.5, "neighbour": 0.0, "edited": 0.0, "other deck": 0.0, "not converged": 0.0}


@dataclass(frozen=True)
class Parameter:
    """A value that each student draws: one of `choices`, as they are written in the deck."""

    name: str
    text: str
    unit: str
    choices: tuple[str, ...]


@dataclass(frozen=True)
class Quantity:
    """A number that is asked for: a word in answers.toml, or a cell of a table that is handed in."""

    name: str
    text: str
    unit: str
    points: float
    tolerance: float
    coarse: float
    scale: float
    given: str  # answer or table
    observe: str
    cell: Cell | None
    step: int | None
    hint: str
    run: str


@dataclass(frozen=True)
class Explanation:
    """A text that is asked for: the tool looks whether it is there and how long, the lecturer reads it."""

    name: str
    text: str
    points: float
    words: int
    good: str


@dataclass(frozen=True)
class Mistake:
    """A mistake that is to be recognised: a deck with other values (set) or other words (replace), or another expression (observe)."""

    name: str
    text: str
    credit: float
    kind: str
    quantity: str
    observe: str
    values: tuple[tuple[str, str], ...]
    replace: tuple[str, str] | None


@dataclass(frozen=True)
class RunOf:
    """A run of the deck: atrito itself, or one of its commands; what it is to end with."""

    command: str = "run"
    options: tuple[str, ...] = ()
    code: int = 0


@dataclass
class Sheet:
    """All that a sheet says."""

    folder: Path
    name: str
    title: str
    seed: str
    deck_name: str
    deck: str
    refine: int
    runs: dict[str, RunOf]  # "" is the one whose tables are handed in
    parameters: list[Parameter]
    tables: list[str]
    table_points: float
    quantities: list[Quantity]
    explanations: list[Explanation]
    mistakes: list[Mistake]
    picture: dict[str, str]
    credit: dict[str, float] = field(default_factory=dict)

    @property
    def points(self) -> float:
        """What a faultless hand-in has."""
        return self.table_points + sum(item.points for item in self.quantities) + sum(item.points for item in self.explanations)

    def draw(self, number: str) -> dict[str, str]:
        """The values of a student: the same whenever they are drawn, since the number alone decides."""
        drawn = {}
        for parameter in self.parameters:
            digest = hashlib.sha256(f"{self.name}/{self.seed}/{number}/{parameter.name}".encode()).digest()
            drawn[parameter.name] = parameter.choices[int.from_bytes(digest[:8], "big") % len(parameter.choices)]
        return drawn

    def complete_deck(self, values: dict[str, str]) -> str:
        """The deck with values, complete: the model answer."""
        lines = [line for line in with_values(self.deck, values).splitlines() if not GAP.match(line) and not END.match(line)]
        return "\n".join(lines) + "\n"

    def deck_with_gaps(self, values: dict[str, str], number: str) -> str:
        """The deck that a student gets: instead of what stands in a gap, what is to be written there."""
        lines, inside = [f"** {self.name}, values of {number}"], False
        for line in with_values(self.deck, values).splitlines():
            gap = GAP.match(line)
            if gap:
                inside = True
                lines += [f"** {line}" for line in textwrap.wrap(f"TO COMPLETE: {gap[1]}", 90)]
            elif END.match(line):
                inside = False
            elif not inside:
                lines.append(line)
        return "\n".join(lines) + "\n"

    def observations(self, run: str) -> dict[str, str]:
        """What is observed in a run: its quantities that are expressions, and the expressions of mistakes in them."""
        if self.runs[run].command != "run":
            return {}
        mine = {item.name for item in self.quantities if item.run == run}
        wanted = {f"lab_{item.name}": item.observe for item in self.quantities if item.observe and item.name in mine}
        wrong = {f"lab_wrong_{place}": item.observe for place, item in enumerate(self.mistakes) if item.observe and item.quantity in mine}
        return wanted | wrong


def is_number(word: str) -> bool:
    """Whether a word is a number."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def with_values(deck: str, values: dict[str, str]) -> str:
    """A deck with other values of its parameters, each defined once as `name = value`."""
    for name, value in values.items():
        deck, count = re.subn(rf"(?im)^([ \t]*{re.escape(name)}[ \t]*=[ \t]*)[^\n]*$", lambda found: found[1] + value, deck)
        if count != 1:
            raise LabError(f"the deck defines {name} {count} times, and not once, as a line '{name} = value' of its own")
    return deck


def load_sheet(named: str) -> Sheet:
    """Read a sheet: its folder, or the name of one that comes with atrito. What is wrong ends the tool and says where."""
    folder = find_sheet(named)
    path = folder/"sheet.toml"
    try:
        text = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as trouble:
        raise LabError(f"{path}: {trouble}") from None
    if not (folder/"sheet.md").is_file():
        raise LabError(f"{folder} has no sheet.md")
    try:
        return _sheet_of(folder, _Taker(text, "the sheet"))
    except LabError as trouble:
        raise LabError(f"{path}: {trouble}") from None


def find_sheet(named: str) -> Path:
    """The folder of a sheet."""
    given = Path(named)
    if (given/"sheet.toml").is_file():
        return given.resolve()
    here = Path(__file__).resolve()
    for top in (here.parents[3], here.parents[3]/"doc"/"atrito"):
        if "/" not in named and (top/"docs"/"labs"/named/"sheet.toml").is_file():
            return top/"docs"/"labs"/named
    raise LabError(f"{named} is no folder with a sheet.toml, and no sheet that comes with atrito has this name")


def find_deck(folder: Path, name: str) -> str:
    """The deck of a sheet: in its folder, or in input/labs of the tree or the installation that the folder is in."""
    places = [folder/name]
    for parent in folder.parents:
        places += [parent/"input"/"labs"/name, parent/"atrito"/"input"/"labs"/name]
    for place in places:
        if place.is_file():
            return place.read_text(encoding="utf-8").replace("\r\n", "\n")
    raise LabError(f"the deck {name} is neither in {folder} nor in input/labs")


class _Taker:
    """A table of TOML from which each key is taken once; what is left over is an error."""

    def __init__(self, table: Any, where: str) -> None:
        if not isinstance(table, dict):
            raise LabError(f"{where} has to be a table")
        self.table, self.where = dict(table), where

    def take(self, key: str, kind: Any, default: Any = None) -> Any:
        """The value of a key, of a kind; without a default the key has to be there."""
        if key not in self.table:
            if default is None:
                raise LabError(f"{self.where} has no {key}")
            return default
        value = self.table.pop(key)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or isinstance(value, bool):
            raise LabError(f"{key} of {self.where} is {value!r}, not {getattr(kind, '__name__', kind)}")
        return value

    def line(self, key: str) -> str:
        """A text as one line."""
        return " ".join(self.take(key, str).split())

    def tables(self, key: str) -> list[_Taker]:
        """A list of tables; an empty one where there is none."""
        return [_Taker(item, f"{key} {item.get('name', place) if isinstance(item, dict) else place}")
                for place, item in enumerate(self.take(key, list, []), 1)]

    def end(self) -> None:
        """All keys have to be known."""
        if self.table:
            raise LabError(f"{self.where} has {', '.join(self.table)}, which no sheet has")


def _sheet_of(folder: Path, taker: _Taker) -> Sheet:
    tables = _Taker(taker.take("tables", dict, {}), "tables")
    reference = _Taker(taker.take("reference", dict, {}), "reference")
    credit = _Taker(taker.take("credit", dict, {}), "credit")
    deck_name = taker.take("deck", str)
    parameters = taker.take("parameters", dict, {})
    sheet = Sheet(
        folder=folder, name=folder.name, title=taker.line("title"), seed=str(taker.take("seed", (str, int))), deck_name=deck_name,
        deck=find_deck(folder, deck_name), refine=reference.take("refine", int, 0), runs=_runs_of(reference, taker),
        parameters=[_parameter_of(name, _Taker(item, f"parameter {name}")) for name, item in parameters.items()],
        tables=tables.take("hand_in", list, []), table_points=tables.take("points", float, 0.0),
        quantities=[_quantity_of(item) for item in taker.tables("quantity")],
        explanations=[_explanation_of(item) for item in taker.tables("explanation")],
        mistakes=[_mistake_of(item) for item in taker.tables("mistake")], picture=_picture_of(taker.take("picture", dict, {})))
    sheet.credit = {name: credit.take(name, float, value) for name, value in CREDIT.items()}
    for rest in (taker, tables, reference, credit):
        rest.end()
    _check_sheet(sheet)
    return sheet


def _runs_of(reference: _Taker, taker: _Taker) -> dict[str, RunOf]:
    runs = {"": RunOf(options=tuple(reference.take("options", list, [])))}
    for item in taker.tables("run"):
        run = RunOf(item.take("command", str, "run"), tuple(item.take("options", list, [])), item.take("exit", int, 0))
        runs[item.take("name", str)] = run
        item.end()
        if run.command not in ("run", "limit", "study", "sweep"):
            raise LabError(f"{item.where}: command is run, limit, study or sweep")
    if not all(isinstance(word, str) for run in runs.values() for word in run.options):
        raise LabError("options are words")
    return runs


def _parameter_of(name: str, taker: _Taker) -> Parameter:
    if "choices" in taker.table:
        choices = tuple(str(value) for value in taker.take("choices", list))
    else:
        first, last, step = (Decimal(str(taker.take(key, (int, float)))) for key in ("from", "to", "step"))
        if step <= 0 or last < first:
            raise LabError(f"the range of parameter {name} is empty")
        choices = tuple(str(first + place*step) for place in range(int((last - first)/step) + 1))
    parameter = Parameter(name, taker.line("text"), taker.take("unit", str, ""), choices)
    taker.end()
    if not choices or not all(is_number(choice) for choice in choices):
        raise LabError(f"the choices of parameter {name} have to be numbers")
    return parameter


def _quantity_of(taker: _Taker) -> Quantity:
    observe = taker.take("observe", str, "")
    cell = None
    if "table" in taker.table:
        where = tuple((name, str(value)) for name, value in taker.take("where", dict, {}).items())
        cell = Cell(taker.take("table", str), taker.take("column", str), where, taker.take("pick", str, "only"))
    tolerance = taker.take("tolerance", float)
    quantity = Quantity(
        name=taker.take("name", str), text=taker.line("text"), unit=taker.take("unit", str, ""), points=taker.take("points", float),
        tolerance=tolerance, coarse=taker.take("coarse", float, 5*tolerance), scale=taker.take("scale", float, 0.0),
        given=taker.take("given", str, "answer"), observe=observe, cell=cell, step=taker.take("step", int, 0) or None,
        hint=taker.take("hint", str, ""), run=taker.take("run", str, ""))
    taker.end()
    if bool(observe) == bool(cell):
        raise LabError(f"{taker.where} needs either observe, or table and column")
    if quantity.given not in ("answer", "table") or quantity.given == "table" and not cell:
        raise LabError(f"{taker.where}: given is 'answer', or 'table' where it has a table and a column")
    if cell and cell.pick not in ("only", "max", "min", "first", "last"):
        raise LabError(f"{taker.where}: pick is max, min, first, last, or left out")
    return quantity


def _explanation_of(taker: _Taker) -> Explanation:
    explanation = Explanation(taker.take("name", str), taker.line("text"), taker.take("points", float), taker.take("words", int, 20),
                              taker.take("good", str))
    taker.end()
    return explanation


def _mistake_of(taker: _Taker) -> Mistake:
    replace = taker.take("replace", list, [])
    if replace and (len(replace) != 2 or not all(isinstance(word, str) for word in replace)):
        raise LabError(f"{taker.where}: replace is two texts, the one in the deck and the one of the mistake")
    mistake = Mistake(
        name=taker.take("name", str), text=taker.line("text"), credit=taker.take("credit", float, -1.0),
        kind=taker.take("kind", str, "mistake"), quantity=taker.take("quantity", str, ""), observe=taker.take("observe", str, ""),
        values=tuple((name, str(value)) for name, value in taker.take("set", dict, {}).items()),
        replace=(replace[0], replace[1]) if replace else None)
    taker.end()
    if sum(map(bool, (mistake.observe, mistake.values, mistake.replace))) != 1 or bool(mistake.observe) != bool(mistake.quantity):
        raise LabError(f"{taker.where} needs one of set, replace, or observe with quantity")
    return mistake


def _picture_of(table: dict[str, Any]) -> dict[str, str]:
    taker = _Taker(table, "picture")
    if not table:
        return {}
    picture = {key: taker.take(key, str) for key in ("table", "x", "y", "text")}
    picture["step"] = str(taker.take("step", int, 0))
    taker.end()
    return picture


def _check_sheet(sheet: Sheet) -> None:
    """What one item alone does not show: names given twice or not at all, texts that the deck does not have."""
    names = [item.name for item in sheet.quantities] + [item.name for item in sheet.explanations]
    for name in names:
        if not NAME.fullmatch(name):
            raise LabError(f"{name!r} is no name: letters, digits and underscores, at most 25, a letter first")
        if names.count(name) > 1:
            raise LabError(f"{name} is there twice")
    if not names:
        raise LabError("nothing is asked for: there is no quantity and no explanation")
    for mistake in sheet.mistakes:
        if mistake.quantity and mistake.quantity not in names:
            raise LabError(f"mistake {mistake.name} is of {mistake.quantity}, which is not asked for")
        if mistake.replace and sheet.deck.count(mistake.replace[0]) < 1:
            raise LabError(f"mistake {mistake.name}: the deck has no {mistake.replace[0]!r}")
        if mistake.kind not in ("mistake", "exchanged"):
            raise LabError(f"mistake {mistake.name}: kind is mistake or exchanged")
    for item in sheet.quantities:
        if item.run not in sheet.runs or item.run and item.given == "table" or item.observe and sheet.runs[item.run].command != "run":
            raise LabError(f"{item.name}: there is no run {item.run!r}, or one whose tables are not handed in, or that does not observe")
        if item.given == "table" and item.cell and item.cell.table not in sheet.tables:
            raise LabError(f"{item.name} is read from {item.cell.table}, which hand_in of [tables] does not name")
    depth = 0
    for line in sheet.deck.splitlines():
        depth += 1 if GAP.match(line) else -1 if END.match(line) else 0
        if depth not in (0, 1):
            raise LabError("gaps of the deck: '** LAB gap: what is to be written' and '** LAB end' go in turns")
    if depth:
        raise LabError("the last gap of the deck has no '** LAB end'")
    with_values(sheet.deck, sheet.draw("1"))


def mistaken_deck(sheet: Sheet, mistake: Mistake, values: dict[str, str]) -> str:
    """The deck as somebody makes it who makes this mistake; values of `set` are numbers, or names of the student's own values."""
    if mistake.replace:
        deck = sheet.complete_deck(values)
        return deck.replace(mistake.replace[0], mistake.replace[1])
    return sheet.complete_deck(values | mistaken_values(mistake, values))


def mistaken_values(mistake: Mistake, values: dict[str, str]) -> dict[str, str]:
    """The values of `set`."""
    return {name: values.get(value, value) for name, value in mistake.values}
