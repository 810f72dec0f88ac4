"""Marking a class: the hand-ins are copied, their decks run again within limits, and each value is judged."""

from __future__ import annotations

import csv
import os
import re
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from . import outputs, pages
from .diagnose import Case, diagnose, give_up
from .handin import HandIn, file_name, options_of, shown, take_in
from .people import Student, read_class
from .program import Keeper, LabError, Limits, Run, observe_words, run_atrito, seconds_since
from .references import Folder, Reference
from .sheet import Sheet


@dataclass
class Marking:
    """What marking a class needs."""

    sheet: Sheet
    program: str
    limits: Limits
    jobs: int
    keeper: Keeper
    work: Path


def mark(sheet: Sheet, folder: Path, out: Path, students: list[Student] | None, program: str, limits: Limits, jobs: int) -> None:
    """Mark all hand-ins of a folder; marks, pages and results go into `out`."""
    start = time.monotonic()
    if not folder.is_dir():
        raise LabError(f"{folder} is no folder")
    found = hand_ins_of(folder, students)
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="atrito-lab-") as work:
        marking = Marking(sheet, program, limits, jobs, Keeper(program, out/"references", limits), Path(work))
        cases = mark_all(marking, found)
        correct(cases, out/"corrections.csv")
        outputs.write_marks(sheet, cases, out/"marks.csv")
        for case in cases:
            place = out/"students"/file_name(case.hand_in.number)
            place.mkdir(parents=True, exist_ok=True)
            outputs.write_results(case, place/"results.json")
            pages.write_feedback(case, place/"feedback.html")
        known = {"class.csv", *(source.name for _, source in found if source)}
        strange = sorted(shown(name) for name in os.listdir(folder) if name not in known)
        pages.write_lecturer(sheet, cases, strange, out/"lecturer.html")
    if strange:
        print(f"of nobody in the class: {', '.join(strange)}")
    print(f"{len(cases)} hand-ins of {sheet.name} marked in {seconds_since(start)}: {out/'marks.csv'}, {out/'lecturer.html'}")


def correct(cases: list[Case], path: Path) -> None:
    """Points by the lecturer go over those of the tool: columns number, item, points, reason."""
    if not path.is_file():
        return
    verdicts = {(case.hand_in.number, verdict.name): verdict for case in cases for verdict in case.verdicts}
    with path.open(newline="", encoding="utf-8-sig") as file:
        for line, row in enumerate(csv.DictReader(file), 2):
            verdict = verdicts.get(((row.get("number") or "").strip(), (row.get("item") or "").strip()))
            try:
                points = float(row.get("points") or "")
            except ValueError:
                verdict = None
            if verdict is None or not 0 <= points <= verdict.of:
                raise LabError(f"{path}, row {line}: no such number and item, or no points between 0 and those of the item")
            verdict.points, verdict.kind, verdict.reason = points, "corrected", row.get("reason") or "Corrected by the lecturer."


def hand_ins_of(folder: Path, students: list[Student] | None) -> list[tuple[Student, Path | None]]:
    """The students and their folders, named by the number, by words of which it is one, or as Moodle does: full name, then _."""
    names = sorted(name for name in os.listdir(folder) if not name.startswith("."))
    if students is None and (folder/"class.csv").is_file():
        students = read_class(folder/"class.csv")
    if students is None:
        students = [Student(name) for name in names if (folder/name).is_dir() and re.fullmatch(r"[A-Za-z0-9._-]{1,40}", name)]
    if not students:
        raise LabError(f"{folder} has no hand-ins: a folder a student, named by the number")
    found: list[tuple[Student, Path | None]] = []
    for student in students:
        fits = [name for name in names if student.number in (name, name.rpartition(".")[0])]
        fits += [name for name in names if re.search(rf"(^|[ _()]){re.escape(student.number)}($|[ _()])", name)]
        fits += [name for name in names if student.name and name.split("_")[0] == student.name]
        found.append((student, folder/fits[0] if fits else None))
    return found


def mark_all(marking: Marking, found: list[tuple[Student, Path | None]]) -> list[Case]:
    """References and the students' own runs first, side by side; then the verdicts, which compare the whole class."""
    references = {student.number: Reference(marking.sheet, marking.keeper, student.number) for student, _ in found}
    cases = [Case(marking.sheet, HandIn(student.number, student.name, student.email), references[student.number], references)
             for student, _ in found]

    def prepare(item: tuple[int, Case]) -> None:
        place, case = item
        case.reference.try_all()
        source = found[place][1]
        if source:
            copy = marking.work/str(place)
            try:
                take_in(source, copy, marking.sheet, case.hand_in)
            except OSError as trouble:
                case.hand_in.notes.append(f"The hand-in could not be read ({trouble.strerror}).")
            case.run = run_again(marking, case, copy, "")
            case.own = own_tables(case.run)
            case.run_own = lambda run: own_tables(run_again(marking, case, copy, run))

    def judge(case: Case) -> None:
        try:
            diagnose(case)
        except LabError:
            raise
        except Exception as trouble:  # one hand-in that nobody foresaw does not keep the others from being marked
            give_up(case, f"This hand-in could not be marked ({type(trouble).__name__}: {trouble}).")

    with ThreadPoolExecutor(marking.jobs) as pool:
        list(pool.map(prepare, enumerate(cases)))
        list(pool.map(judge, cases))
    return cases


def run_again(marking: Marking, case: Case, copy: Path, run: str) -> Run | None:
    """Run the deck of a hand-in, with the options that the head of its summary names; nothing outside the copy is read."""
    deck, of = case.hand_in.deck, marking.sheet.runs[run]
    if deck is None or of.command != "run":
        return None
    table = next((case.hand_in.tables[name] for name in ("summary", *marking.sheet.tables) if name in case.hand_in.tables), None)
    words = [os.path.join(".", deck.relative_to(copy)), "--confine", str(copy), "--quiet", "--messages", "json", "--digits", "12"]
    words += [*(options_of(table) if table else []), *of.options]
    out = marking.work/f"{copy.name}-out-{len(run) and list(marking.sheet.runs).index(run)}"
    for observed in (observe_words(marking.sheet.observations(run)), []):  # a deck may lack what is observed
        made = run_atrito(marking.program, [*words, "-o", str(out), *observed], copy, marking.limits, out)
        if made.code != 1:
            break
    return made


def own_tables(run: Run | None) -> Folder | None:
    """The tables of a run that went well."""
    return Folder(run.folder) if run and run.code == 0 and not run.timed_out else None
