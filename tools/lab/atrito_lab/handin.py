"""A hand-in, which is not trusted: plain files of moderate size are copied from its folder; nothing else is opened."""

from __future__ import annotations

import math
import os
import re
import stat
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .sheet import Sheet

DEPTH, FILES = 5, 400
SIZES = {".inp": 2_000_000, ".msh": 20_000_000, ".tab": 5_000_000, ".csv": 5_000_000, ".toml": 200_000, ".txt": 200_000}
ANSWERS = re.compile(r"answers[^/]*\.(toml|txt)", re.I)
NUMBER = re.compile(r"([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD][+-]?\d{1,3})?)\s*(.*)", re.S)


@dataclass
class HandIn:
    """What somebody has handed in, as far as it may be read."""

    number: str
    name: str = ""
    email: str = ""
    folder: Path | None = None  # a copy of what counts
    there: bool = False  # whether there was anything
    deck: Path | None = None
    tables: dict[str, Path] = field(default_factory=dict)
    answers: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def shown(text: str, length: int = 60) -> str:
    """A name that a student chose, fit to be told: no control characters, not long."""
    clean = "".join(letter if letter.isprintable() else "?" for letter in text)
    return clean if len(clean) <= length else clean[:length - 3] + "..."


def file_name(number: str) -> str:
    """A student's number as the name of a folder."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", number).lstrip(".") or "_"


def take_in(source: Path, copy: Path, sheet: Sheet, hand_in: HandIn) -> None:
    """Copy the decks, meshes, tables and answers of a folder, and find out which they are."""
    hand_in.folder = copy
    copy.mkdir(parents=True)
    try:
        if not stat.S_ISDIR(os.lstat(source).st_mode):
            hand_in.notes.append("The hand-in is no folder (an archive has to be unpacked), or a link to one; it was not read.")
            return
    except OSError:
        return
    found = _copy_tree(source, copy, hand_in)
    hand_in.there = bool(found) or bool(hand_in.notes)
    _choose_deck(found, copy, sheet, hand_in)
    _choose_tables(found, copy, hand_in)
    for path in [path for path in found if ANSWERS.fullmatch(path.name)][:1]:
        hand_in.answers = read_answers(copy/path, hand_in.notes)


def _copy_tree(source: Path, copy: Path, hand_in: HandIn) -> list[Path]:
    """Copy what counts; relative paths of the copies, the nearest first."""
    found: list[Path] = []
    waiting = [Path()]
    count = 0
    while waiting:
        folder = waiting.pop(0)
        try:
            names = sorted(os.listdir(source/folder))
        except OSError:
            hand_in.notes.append(f"The folder {shown(str(folder))} cannot be read.")
            continue
        for name in names:
            count += 1
            if count > FILES:
                hand_in.notes.append(f"There are more than {FILES} files; the others were not read.")
                return found
            path = folder/name
            is_link = os.path.islink(source/path)
            if os.path.isdir(source/path) and not is_link and len(path.parts) < DEPTH:
                waiting.append(path)
            elif os.path.isdir(source/path):
                hand_in.notes.append(f"The folder {shown(name)} is {'a link' if is_link else 'too deep'}; it was not read.")
            elif _counts(name) and _copy_file(source/path, copy/path, hand_in):
                found.append(path)
    return found


def _counts(name: str) -> bool:
    """Whether a file is of a kind that is read; decks as run and others that atrito writes are not."""
    suffix = os.path.splitext(name)[1].lower()
    if suffix == ".txt":
        return bool(ANSWERS.fullmatch(name))
    return suffix in SIZES and not name.lower().endswith(".run.inp")


def _copy_file(source: Path, target: Path, hand_in: HandIn) -> bool:
    """Copy a plain file that has one name and is not too large; else say why not."""
    name = shown(source.name)
    limit = SIZES[source.suffix.lower()]
    try:
        handle = os.open(source, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        hand_in.notes.append(f"{name} is a link, or cannot be read; it was left out.")
        return False
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode) or status.st_nlink > 1:
            hand_in.notes.append(f"{name} is no plain file, or has a second name elsewhere; it was left out.")
            return False
        if status.st_size > limit:
            hand_in.notes.append(f"{name} has {status.st_size/1e6:.0f} MB, more than {limit/1e6:g}; it was left out.")
            return False
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(file.read(limit))
    return True


def _choose_deck(found: list[Path], copy: Path, sheet: Sheet, hand_in: HandIn) -> None:
    """The deck: that of the sheet's name, else the only one, else the first with a step."""
    decks = [path for path in found if path.suffix.lower() == ".inp"]
    named = [path for path in decks if path.name.lower() == sheet.deck_name.lower()]
    with_step = [path for path in decks if b"*STEP" in (copy/path).read_bytes().upper()]
    chosen = (named or with_step or decks)[:1]
    if chosen:
        hand_in.deck = copy/chosen[0]
        if len(named or with_step) > 1:
            hand_in.notes.append(f"There are several decks; {shown(str(chosen[0]))} was taken.")


def _choose_tables(found: list[Path], copy: Path, hand_in: HandIn) -> None:
    """The tables by their names; of several the one whose run had the fewest options, then the one nearest to the top."""
    tables = [path for path in found if path.suffix.lower() in (".tab", ".csv")]
    for path in sorted(tables, key=lambda path: len(options_of(copy/path))):
        hand_in.tables.setdefault(path.stem.lower(), copy/path)
    for name, chosen in hand_in.tables.items():
        if sum(path.stem.lower() == name for path in tables) > 1:
            hand_in.notes.append(f"There are several tables {shown(name)}; {shown(str(chosen.relative_to(copy)))} was taken.")


def read_answers(path: Path, notes: list[str]) -> dict[str, Any]:
    """The answers, by names in lower case; of a damaged file what can be made out line by line."""
    text = path.read_bytes().decode("utf-8-sig", "replace").replace("\r\n", "\n")
    if not text.strip():
        notes.append("answers.toml is empty.")
        return {}
    try:
        return _flat(tomllib.loads(text))
    except (ValueError, RecursionError) as trouble:  # TOMLDecodeError is a ValueError
        place = re.search(r"line \d+", str(trouble))
        where = place[0] if place else "it cannot be read"
        notes.append(f"answers.toml is damaged ({where}); what could be made out line by line was read.")
    answers = {}
    pattern = r'^[ \t]*(\w+)[ \t]*=[ \t]*(?:"""(.*?)"""|"([^"\n]+)"|([^#\n]*))'
    for name, long_, short, bare in re.findall(pattern, text, re.M | re.S):
        answers[name.lower()] = long_ or short or bare.strip(' \t"')   # 0.3 behind "", too
    return answers


def _flat(table: dict[str, Any], depth: int = 0) -> dict[str, Any]:
    """All names of a table and of those within it."""
    flat: dict[str, Any] = {}
    for name, value in table.items():
        if isinstance(value, dict) and depth < 4:
            flat.update(_flat(value, depth + 1))
        elif isinstance(value, (str, int, float)):
            flat[name.lower()] = value
    return flat


def number_of(given: Any) -> tuple[float | None, str]:
    """An answer as a number, with a decimal comma if need be, and the unit behind it; None if it is none."""
    if isinstance(given, bool):
        return None, ""
    if isinstance(given, (int, float)):
        try:
            value = float(given)
        except OverflowError:
            return None, ""
        return (value, "") if math.isfinite(value) else (None, "")
    match = NUMBER.fullmatch(str(given).strip())
    if not match or match[2][:1] in (",", "."):
        return None, ""
    value = float(re.sub("[dD]", "e", match[1].replace(",", ".")))
    return (value, match[2].strip()) if math.isfinite(value) else (None, "")


def text_of(given: Any) -> str:
    """An answer in words, without control characters."""
    text = str(given if given is not None else "")[:20_000]
    return "".join(letter if letter.isprintable() or letter == "\n" else " " for letter in text).strip()


def options_of(path: Path) -> list[str]:
    """Options of a run that change its results, as the head of its table tells them: those that are known, one by one."""
    with path.open("rb") as file:
        head = file.read(20_000).decode("utf-8", "replace")
    given = "".join(re.findall(r"(?m)^# options:(.*)$", head)[:1])
    values = "".join(re.findall(r"(?m)^# parameters:(.*)$", head)[:1])
    words: list[str] = []
    for name, value in re.findall(r"[ ,](\w{1,40}) = ([-+.\deE]{1,30}) \(--set\)", values)[:50]:
        words += ["--set", f"{name}={value}"]
    for name, value in re.findall(r" --(refine|solver|contact)[ =](\d|[a-z]{1,10})(?= |$)", given)[:6]:
        words += [f"--{name}", value]
    return words
