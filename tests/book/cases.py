"""Cases of the book: what case.toml says, and values out of the tables of a run. README.md has the format."""
import math
import re
import tomllib
from pathlib import Path

KINDS = ("closed form", "other program", "published", "read off a curve")
CASE_KEYS = {"id": str, "title": str, "group": str, "origin": str, "address": str, "kind": str, "smooth": bool, "data": str, "note": str,
             "deck": str, "refine": list, "options": list, "command": str, "exit": int, "picture": str, "run": list, "value": list,
             "left_out": list}
RUN_KEYS = {"name": str, "deck": str, "refine": list, "options": list, "command": str, "exit": int}
VALUE_KEYS = {"name": str, "reference": float, "second": float, "between": list, "run": str, "kind": str, "observe": str, "table": str,
              "column": str, "where": str, "pick": str, "step": int, "increment": int, "factor": float, "uncertainty": str, "tolerance": float,
              "absolute": float, "why": str, "missed": str}
LEFT_OUT_KEYS = {"name": str, "reference": float, "why": str}
PICKS = {"only": None, "max": max, "min": min, "sum": math.fsum, "mean": lambda v: math.fsum(v)/len(v), "range": lambda v: max(v) - min(v),
         "first": lambda v: v[0], "last": lambda v: v[-1]}
FUNCTIONS = {"abs": abs, "max": max, "min": min, "sqrt": math.sqrt, "hypot": math.hypot, "atan2": math.atan2, "cos": math.cos, "sin": math.sin,
             "pi": math.pi}


class BookError(Exception):
    """What is wrong with a case or with what a run wrote, in words for who wrote the case."""


def check_keys(where, given, known, required):
    """Every key is known and has its type, every required one is there."""
    for key, value in given.items():
        if key not in known:
            raise BookError(f"{where}: unknown key {key}")
        wanted = (int, float) if known[key] is float else known[key]
        if not isinstance(value, wanted) or isinstance(value, bool) != (known[key] is bool):
            raise BookError(f"{where}: {key} is no {known[key].__name__}")
    for key in required:
        if key not in given:
            raise BookError(f"{where}: {key} is missing")


class Run:
    """One deck with its options, at some levels of refinement."""

    def __init__(self, where, given, default):
        self.name = given.get("name", "")
        self.deck = given.get("deck", default.get("deck"))
        self.refine = given.get("refine", default.get("refine", [0]))
        self.options = given.get("options", default.get("options", []))
        self.command = given.get("command", default.get("command", "")).split()
        self.exit = given.get("exit", default.get("exit", 0))
        if not self.deck:
            raise BookError(f"{where}: deck is missing")
        if not self.refine or any(type(k) is not int for k in self.refine) or self.refine != sorted(set(self.refine)):
            raise BookError(f"{where}: refine is a list of whole numbers that grow")


class Value:
    """A quantity, its reference, and how near it must come on the finest mesh."""

    def __init__(self, where, given, kind):
        check_keys(where, given, VALUE_KEYS, ("name", "uncertainty", "why"))
        self.place = f"{where}, {given['name']}"
        self.given = given
        for key in VALUE_KEYS:
            setattr(self, key, given.get(key))
        self.run = self.run or ""
        self.kind = self.kind or kind
        self.factor = 1.0 if self.factor is None else self.factor
        self.pick = self.pick or "only"
        if self.kind not in KINDS:
            raise BookError(f"{self.place}: kind is one of {', '.join(KINDS)}")
        if (self.observe is None) == (self.table is None) or (self.table is None) != (self.column is None):
            raise BookError(f"{self.place}: either observe, or table and column")
        if self.pick not in PICKS:
            raise BookError(f"{self.place}: pick is one of {', '.join(PICKS)}")
        if self.between is not None:
            if len(self.between) != 2 or not self.between[0] < self.between[1] or self.reference is not None or self.tolerance or self.absolute:
                raise BookError(f"{self.place}: between has two numbers, the less first, and goes without reference and tolerance")
        elif self.reference is None or (self.tolerance is None) == (self.absolute is None):
            raise BookError(f"{self.place}: a reference, and either tolerance or absolute")
        if self.absolute is None and self.reference == 0:
            raise BookError(f"{self.place}: where the reference is 0 the tolerance is absolute")

    def error(self, found):
        """Relative error, absolute where the tolerance is; of an interval how far outside, over its width."""
        if self.between is not None:
            low, high = self.between
            return max(low - found, found - high, 0.0)/(high - low)
        return abs(found - self.reference)/(1.0 if self.absolute is not None else abs(self.reference))

    def allowed(self):
        return 0.0 if self.between is not None else self.tolerance if self.absolute is None else self.absolute

    def holds(self, found):
        return not math.isnan(found) and self.error(found) <= self.allowed()


class Case:
    """A folder of tests/book."""

    def __init__(self, folder):
        self.folder = Path(folder)
        where = self.folder.name
        try:
            with open(self.folder/"case.toml", "rb") as file:
                given = tomllib.load(file)
        except (OSError, tomllib.TOMLDecodeError) as error:
            raise BookError(f"{where}: {error}") from error
        check_keys(where, given, CASE_KEYS, ("id", "title", "group", "origin", "address", "kind", "data", "value"))
        for key in CASE_KEYS:
            setattr(self, key, given.get(key))
        if not self.folder.name.startswith(self.id + "-"):
            raise BookError(f"{where}: the folder is not called {self.id}-...")
        self.runs = [Run(where, given, {})] if self.deck else []
        for k, run in enumerate(self.run or []):
            check_keys(f"{where}, run {k + 1}", run, RUN_KEYS, ("name",))
            self.runs.append(Run(f"{where}, run {k + 1}", run, given))
        names = [run.name for run in self.runs]
        if len(set(names)) < len(names):
            raise BookError(f"{where}: two runs of one name")
        self.values = [Value(where, value, self.kind) for value in self.value]
        for value in self.values:
            if value.run not in names:
                raise BookError(f"{value.place}: no run {value.run or 'of the case itself (deck)'}")
        for k, row in enumerate(self.left_out or []):
            check_keys(f"{where}, left_out {k + 1}", row, LEFT_OUT_KEYS, ("name", "why"))
        self.decks = list(dict.fromkeys(run.deck for run in self.runs))

    def of_run(self, run):
        return [value for value in self.values if value.run == run.name]

    def observed(self, value):
        """Name of the value for --observe: its place among the values of the case."""
        return f"book_{self.values.index(value) + 1}"


def read_cases(book, wanted=()):
    """All cases of a folder in the order of their names and numbers, or the wanted ones."""
    cases = sorted((Case(path.parent) for path in Path(book).glob("*/case.toml")), key=lambda case: re.sub(r"\d+", lambda n: n[0].zfill(4), case.id))
    ids = [case.id for case in cases]
    for name in ids:
        if ids.count(name) > 1:
            raise BookError(f"two cases {name}")
    for name in wanted:
        if name not in ids:
            raise BookError(f"no case {name}")
    return [case for case in cases if not wanted or case.id in wanted]


def read_table(path):
    """Columns and rows of a .tab; numbers where they are."""
    columns, rows = None, []
    try:
        lines = Path(path).read_text().splitlines()
    except OSError as error:
        raise BookError(f"{Path(path).name}: {error.strerror}") from error
    for line in lines:
        if line.startswith("# columns:"):
            columns = line.split()[2:]
        elif line.strip() and not line.startswith("#"):
            rows.append([number(word) for word in line.split()])
    if columns is None:
        raise BookError(f"{Path(path).name}: no line of columns")
    return columns, rows


def number(word):
    try:
        return float(word)
    except ValueError:
        return word


def last_rows(columns, rows, step, increment):
    """Rows of one step and increment, the last ones unless told; of all where the step is 0."""
    if step == 0:
        return rows
    for name, told in (("step", step), ("increment", increment)):
        if name in columns and rows:
            k = columns.index(name)
            wanted = rows[-1][k] if told is None else told
            rows = [row for row in rows if row[k] == wanted]
    return rows


def evaluate(where, expression, columns, row):
    """An expression of the names of columns, and functions."""
    names = dict(zip(columns, row))
    try:
        return eval(expression, {"__builtins__": {}}, FUNCTIONS | names)  # pylint: disable=eval-used
    except Exception as error:
        raise BookError(f"{where}: {expression}: {error}") from error


def find_value(case, value, folder):
    """What a run in a folder found for a value, times its factor."""
    if value.observe is not None:
        table, column, where = "summary.tab", "value", f"quantity == '{case.observed(value)}'"
    else:
        table, column, where = value.table, value.column, value.where
    columns, rows = read_table(Path(folder)/table)
    rows = last_rows(columns, rows, value.step, value.increment)
    if where:
        rows = [row for row in rows if evaluate(value.place, where, columns, row)]
    found = [evaluate(value.place, column, columns, row) for row in rows]
    if not found or (value.pick == "only" and len(found) > 1):
        raise BookError(f"{value.place}: {len(found)} rows of {table} where one should be")
    found = found[0] if value.pick == "only" else PICKS[value.pick](found)
    if not isinstance(found, float):
        raise BookError(f"{value.place}: {found} is no number")
    return found*value.factor


def find_summary(folder, quantity):
    """A quantity of the step at the end of the run, from summary.tab, or None."""
    try:
        columns, rows = read_table(Path(folder)/"summary.tab")
    except BookError:
        return None
    at, value, step, increment = (columns.index(name) for name in ("quantity", "value", "step", "increment"))
    end = (rows[-1][step], rows[-1][increment])
    return next((row[value] for row in rows if row[at] == quantity and (row[step], row[increment]) == end), None)
