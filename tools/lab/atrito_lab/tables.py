"""Reading the tables of atrito, as text (.tab) or as comma-separated values (.csv), and comparing two of them."""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass, field
from pathlib import Path

# columns that tell which row it is, in any table
KEYS = ("step", "increment", "pair", "quantity", "point", "node", "element", "set", "keyword", "joint", "body")
# rows of summary.tab that tell of the way and not of the result
WAY = ("picard_iterations", "linear_solves", "equilibrium_residual", "max_penetration")


class TableError(Exception):
    """A table that cannot be read; its text says why, as one would say it to the student."""


@dataclass
class Table:
    """A table: names of the columns, rows of words, and what its head says."""

    columns: list[str]
    rows: list[list[str]]
    dimensions: list[str] = field(default_factory=list)
    heads: dict[str, str] = field(default_factory=dict)
    groups: dict[str, str] = field(default_factory=dict)  # dimension of a quantity of summary.tab
    converged: bool = True

    def column(self, name: str) -> int:
        """Number of a column, from 0."""
        if name not in self.columns:
            raise TableError(f"there is no column {name}")
        return self.columns.index(name)

    def numbers(self, name: str) -> list[float]:
        """A column as numbers."""
        place = self.column(name)
        return [number(row[place]) for row in self.rows]


@dataclass(frozen=True)
class Cell:
    """Where a number stands: a column, and the row that `where` and `pick` leave."""

    table: str
    column: str
    where: tuple[tuple[str, str], ...] = ()
    pick: str = "only"  # only, max, min, first, last


def number(word: str) -> float:
    """A word of a table as a number."""
    try:
        value = float(word)
    except ValueError:
        raise TableError(f"{word[:30]!r} is no number") from None
    return value


def read_table(path: Path) -> Table:
    """Read a table file; TableError if it is empty or damaged."""
    text = path.read_bytes()
    if not text.strip():
        raise TableError("the file is empty")
    if b"\0" in text:
        raise TableError("the file is no text")
    lines = text.decode("utf-8", "replace").splitlines()
    table = _from_csv(lines) if path.suffix == ".csv" else _from_text(lines)
    if not table.rows:
        raise TableError("the file has a head and no rows")
    return table


def _from_csv(lines: list[str]) -> Table:
    rows = [row for row in csv.reader(lines) if row]
    for place, row in enumerate(rows, 1):
        if len(row) != len(rows[0]):
            raise TableError(f"row {place} has {len(row)} values for {len(rows[0])} columns")
    return Table(rows[0], rows[1:])


def _from_text(lines: list[str]) -> Table:
    table = Table([], [])
    for place, line in enumerate(lines, 1):
        if line.startswith("#"):
            _read_head(table, line[1:].strip())
        elif line.strip():
            row = line.split()
            if not table.columns:
                raise TableError("the lines that begin with # at the top, which name the columns, are gone")
            if len(row) != len(table.columns):
                raise TableError(f"line {place} has {len(row)} values for {len(table.columns)} columns")
            table.rows.append(row)
    return table


def _read_head(table: Table, line: str) -> None:
    """One line of the head of a table, without its #."""
    if line.startswith("NOT CONVERGED"):
        table.converged = False
        return
    name, colon, rest = line.partition(":")
    if not colon:
        return
    if name == "columns":
        table.columns = rest.split()
    elif name == "dimensions":
        table.dimensions = rest.split()
    elif name.startswith("["):
        table.groups.update({quantity: name for quantity in rest.split()})
    else:
        table.heads[name] = rest.strip()


def parameters_of(table: Table) -> dict[str, float]:
    """The parameters in the head of a table: names in lower case, numbers."""
    found: dict[str, float] = {}
    for part in table.heads.get("parameters", "").split(", "):
        match = re.fullmatch(r"(\w+) = (\S+)( \(--set\))?", part.strip())
        if match:
            try:
                found[match[1].lower()] = float(match[2])
            except ValueError:
                pass
    return found


def rows_of(table: Table, cell: Cell, step: int | None, increment: int | None = None) -> list[list[str]]:
    """Rows that `where` leaves, of a step (none: of the last one) and its increment (none: the last one)."""
    rows = table.rows
    for name, wanted in cell.where:
        place = table.column(name)
        rows = [row for row in rows if _same(row[place], wanted)]
    for name, value in (("step", step), ("increment", increment)):
        if name in table.columns and rows:
            place = table.column(name)
            instant = value if value is not None else max(number(row[place]) for row in rows)
            rows = [row for row in rows if number(row[place]) == instant]
    return rows


def value_of(table: Table, cell: Cell, step: int | None = None, increment: int | None = None) -> float:
    """The number of a cell."""
    rows = rows_of(table, cell, step, increment)
    place = table.column(cell.column)
    values = [number(row[place]) for row in rows]
    what = ", ".join(f"{name} {wanted}" for name, wanted in cell.where)
    if not values:
        raise TableError(f"there is no row with {what}" if what else "there is no such row")
    if cell.pick == "only" and len(values) > 1:
        raise TableError(f"there are {len(values)} rows with {what}")
    if cell.pick in ("max", "min"):
        return max(values) if cell.pick == "max" else min(values)
    return values[-1] if cell.pick == "last" else values[0]


def instants(table: Table) -> list[tuple[int, int]]:
    """Steps and increments that a table has."""
    if "step" not in table.columns or "increment" not in table.columns:
        return []
    return sorted({(int(number(row[table.column("step")])), int(number(row[table.column("increment")]))) for row in table.rows})


def _same(word: str, wanted: str) -> bool:
    """Whether a word of a table is the one wanted: as a word, or as a number up to the digits of a table."""
    if word.lower() == wanted.lower():
        return True
    try:
        return math.isclose(float(word), float(wanted), rel_tol=1e-5, abs_tol=1e-9)
    except ValueError:
        return False


def differences(given: Table, made: Table, tolerance: float) -> tuple[int, int, str]:
    """How many numbers of a table handed in differ from those of a run, of how many, and the first one, in words.

    A number may differ by `tolerance` of the largest of its column (of a row a quantity: of itself), and by a millionth of that of
    the largest of its dimension, which is round-off. Quantities that the run does not have are the student's own.
    """
    keys = [name for name in KEYS if name in given.columns and name in made.columns]
    ours = {_key(made, row, keys, place): row for place, row in enumerate(made.rows)}
    columns = [name for name, dimension in zip(made.columns, made.dimensions) if dimension != "-" and name in given.columns]
    columns = ["value"] if "value" in columns else columns
    largest = _largest(made, columns)
    count, total, first, met = 0, 0, "", 0
    for place, row in enumerate(given.rows):
        quantity = row[given.column("quantity")] if "quantity" in keys else ""
        other = ours.get(_key(given, row, keys, place))
        if other is None and not (quantity and all(quantity != words[made.column("quantity")] for words in made.rows)):
            count, first = count + 1, first or f"the run has no row {' '.join(row)[:60]}"
        if other is None or quantity in WAY:
            continue
        met += 1
        for name in columns:
            mine, theirs = number(row[given.column(name)]), number(other[made.column(name)])
            size = max(abs(theirs), 1e-6*largest[made.groups.get(quantity, "-")]) if quantity else largest[name]
            total += 1
            if not abs(mine - theirs) <= tolerance*size and not (math.isnan(mine) and math.isnan(theirs)):
                which = ", ".join(f"{key} {row[given.column(key)]}" for key in keys if key != "increment")
                count, first = count + 1, first or f"{name} of {which}: {mine:.6g} handed in, {theirs:.6g} from the deck"
    if met < len(made.rows) and "quantity" not in keys:
        count, first = count + len(made.rows) - met, first or f"{len(made.rows) - met} rows of the run are not in the table handed in"
    return count, max(total, 1), first


def _key(table: Table, row: list[str], keys: list[str], place: int) -> tuple[str, ...]:
    return tuple(row[table.column(name)] for name in keys) + (() if "quantity" in keys else (str(place),))


def _largest(made: Table, columns: list[str]) -> dict[str, float]:
    """The size of the numbers of each column, or of the quantities of each dimension where the table has a row a quantity."""
    sizes: dict[str, float] = {"-": 0.0}
    if "quantity" in made.columns:
        for row in made.rows:
            value, group = abs(number(row[made.column("value")])), made.groups.get(row[made.column("quantity")], "-")
            sizes[group] = max(sizes.get(group, 0.0), value if math.isfinite(value) else 0.0)
        return sizes
    dimension = dict(zip(made.columns, made.dimensions))
    column = {name: max((abs(value) for value in made.numbers(name) if math.isfinite(value)), default=0.0) for name in columns}
    return {name: max(column[name], *(1e-6*column[other] for other in columns if dimension[other] == dimension[name]))
            for name in columns}
