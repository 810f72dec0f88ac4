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
    """The runs of one student's values. Runs beyond the first are made when they are asked for."""

    def __init__(self, sheet: Sheet, keeper: Keeper, number: str) -> None:
        self.sheet, self.keeper, self.number = sheet, keeper, number
        self.drawn = sheet.draw(number)
        self._folders: dict[str, Folder | None] = {}
        self._lock = threading.Lock()

    def _run(self, deck: str, refine: int) -> Run:
        words = [*self.sheet.options, "--digits", "12", *(["--refine", str(refine)] if refine else []), *observe_words(self.sheet.observations())]
        return self.keeper.run(deck, words, self.sheet.deck_name)

    def _folder(self, name: str, deck: str, refine: int) -> Folder | None:
        """Tables of a run, None if it failed."""
        with self._lock:
            if name not in self._folders:
                run = self._run(deck, refine)
                self._folders[name] = Folder(run.folder) if run.code == 0 else None
            return self._folders[name]

    def tables(self) -> Folder:
        """The reference itself: the complete deck with the student's values."""
        deck = self.sheet.complete_deck(self.drawn)
        folder = self._folder("reference", deck, self.sheet.refine)
        if folder is None:
            run = self._run(deck, self.sheet.refine)
            raise LabError(f"the deck of the sheet with the values of {self.number} ({self.values_in_words()}) ends with {run.code}: {run.error}")
        return folder

    def values_in_words(self) -> str:
        """The student's values."""
        return ", ".join(f"{name} = {value}" for name, value in self.drawn.items())

    def value(self, quantity: Quantity) -> float:
        """The right value of a quantity."""
        found = self.tables().value(quantity)
        if found is None:
            raise LabError(f"the deck of the sheet gives no value of {quantity.name}")
        return found

    def finer(self, quantity: Quantity) -> float | None:
        """Its value on a mesh of four times the elements."""
        folder = self._folder("finer", self.sheet.complete_deck(self.drawn), self.sheet.refine + 1)
        return folder.value(quantity) if folder else None

    def others(self, quantity: Quantity) -> list[tuple[int, int, float]]:
        """Its values at other steps and increments: step, increment, value."""
        try:
            table = self.tables().table(quantity_cell(quantity).table)
        except TableError:
            return []
        wanted = quantity.step or max((step for step, _ in instants(table)), default=0)
        last = max((increment for step, increment in instants(table) if step == wanted), default=0)
        values = [(step, increment, self.tables().value(quantity, step, increment)) for step, increment in instants(table)
                  if (step, increment) != (wanted, last)]
        return [(step, increment, value) for step, increment, value in values if value is not None]

    def mistaken(self, mistake: Mistake, place: int, quantity: Quantity) -> float | None:
        """What a mistake makes of a quantity; None where it does not touch it."""
        if mistake.observe:
            if mistake.quantity != quantity.name:
                return None
            cell = Cell("summary", "value", (("quantity", f"lab_wrong_{place}"), ("pair", "0")))
            try:
                return value_of(self.tables().table("summary"), cell, quantity.step)
            except TableError:
                return None
        folder = self._folder(f"mistake {place}", mistaken_deck(self.sheet, mistake, self.drawn), self.sheet.refine)
        return folder.value(quantity) if folder else None
