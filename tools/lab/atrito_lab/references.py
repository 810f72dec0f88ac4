"""What the lecturer's own runs say: the values of a student's quantities, at each step, on a finer mesh, and as mistakes make them."""

from __future__ import annotations

import math
import threading
from pathlib import Path

from .handin import SIZES
from .program import Keeper, LabError, Run, observe_words
from .sheet import Mistake, Quantity, Sheet, mistaken_deck
from .tables import Cell, Table, TableError, instants, read_table, value_of


def quantity_cell(quantity: Quantity) -> Cell:
    """Where a quantity stands in the tables of a run that observes."""
    return quantity.cell or Cell("summary", "value", (("quantity", f"lab_{quantity.name}"), ("pair", "0")))


class Folder:
    """Tables of a folder, each read once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._tables: dict[str, Table] = {}

    def table(self, name: str) -> Table:
        """A table; TableError if it cannot be read."""
        if name not in self._tables:
            path = self.folder/f"{name}.tab"
            if not path.is_file():
                raise TableError("the run does not write this table")
            if path.stat().st_size > SIZES[".tab"]:
                raise TableError("the run makes it larger than is read")
            self._tables[name] = read_table(path)
        return self._tables[name]

    def value(self, quantity: Quantity, step: int | None = None, increment: int | None = None) -> float | None:
        """The value of a quantity at its step, or at another one; None where there is none."""
        cell = quantity_cell(quantity)
        try:
            found = value_of(self.table(cell.table), cell, step or quantity.step, increment)
        except TableError:
            return None
        return found if math.isfinite(found) else None

    def estimate(self) -> float:
        """The estimated error at the end, in percent; 0 where it is not told."""
        try:
            return value_of(self.table("summary"), Cell("summary", "value", (("quantity", "error_estimate_percent"),)))
        except TableError:
            return 0.0


class Reference:
    """The runs of one student's values, each made when it is asked for."""

    def __init__(self, sheet: Sheet, keeper: Keeper, number: str) -> None:
        self.sheet, self.keeper, self.number = sheet, keeper, number
        self.drawn = sheet.draw(number)
        self._folders: dict[tuple[str, str, int], Folder | Run] = {}
        self._values: dict[str, float] = {}
        self._lock = threading.Lock()

    def folder(self, deck: str, run: str, refine: int) -> Folder | Run:
        """Tables of a run of a deck, or the run where it ended with another code than it should."""
        with self._lock:
            if (deck, run, refine) not in self._folders:
                of = self.sheet.runs[run]
                words = [*of.options, "--digits", "12", *(["--refine", str(refine)] if refine else [])]
                words += observe_words(self.sheet.observations(run))
                made = self.keeper.run(of.command, deck, words, self.sheet.deck_name)
                self._folders[deck, run, refine] = Folder(made.folder) if made.code == of.code else made
            return self._folders[deck, run, refine]

    def tables(self, run: str = "") -> Folder:
        """The reference itself: the complete deck with the student's values."""
        folder = self.folder(self.sheet.complete_deck(self.drawn), run, self.sheet.refine)
        if isinstance(folder, Run):
            values = ", ".join(f"{name} = {value}" for name, value in self.drawn.items())
            raise LabError(f"the deck of the sheet with the values of {self.number} ({values}) ends with {folder.code}: {folder.error}")
        return folder

    def try_all(self) -> None:
        """Whether all values are there."""
        self.tables()
        for quantity in self.sheet.quantities:
            self.value(quantity)

    def value(self, quantity: Quantity) -> float:
        """The right value of a quantity."""
        if quantity.name not in self._values:
            found = self.tables(quantity.run).value(quantity)
            if found is None:
                raise LabError(f"the deck of the sheet gives no value of {quantity.name}")
            self._values[quantity.name] = found
        return self._values[quantity.name]

    def value_by(self, deck: str, quantity: Quantity, refine: int) -> float | None:
        """What another deck, or another mesh, makes of a quantity; None where it gives no value."""
        folder = self.folder(deck, quantity.run, refine)
        return None if isinstance(folder, Run) else folder.value(quantity)

    def finer(self, quantity: Quantity) -> float | None:
        """Its value on a mesh of four times the elements."""
        return self.value_by(self.sheet.complete_deck(self.drawn), quantity, self.sheet.refine + 1)

    def others(self, quantity: Quantity) -> list[tuple[int, int, float]]:
        """Its values at other steps and increments: step, increment, value."""
        folder = self.tables(quantity.run)
        try:
            there = instants(folder.table(quantity_cell(quantity).table))
        except TableError:
            return []
        wanted = quantity.step or max((step for step, _ in there), default=0)
        last = max((increment for step, increment in there if step == wanted), default=0)
        values = [(*instant, folder.value(quantity, *instant)) for instant in there if instant != (wanted, last)]
        return [(step, increment, value) for step, increment, value in values if value is not None]

    def mistaken(self, mistake: Mistake, place: int, quantity: Quantity) -> float | None:
        """What a mistake makes of a quantity; None where it does not touch it."""
        if not mistake.observe:
            return self.value_by(mistaken_deck(self.sheet, mistake, self.drawn), quantity, self.sheet.refine)
        if mistake.quantity != quantity.name:
            return None
        cell = Cell("summary", "value", (("quantity", f"lab_wrong_{place}"), ("pair", "0")))
        try:
            return value_of(self.tables(quantity.run).table("summary"), cell, quantity.step)
        except TableError:
            return None
