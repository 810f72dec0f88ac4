"""Handing out: a folder a student, with the sheet, a deck with the student's own values, and an empty answers.toml."""

from __future__ import annotations

import csv
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .people import Student
from .program import Keeper, LabError, Limits
from .references import Reference
from .sheet import Sheet

BESIDE = (".md", ".png", ".svg", ".pdf")


def hand_out(sheet: Sheet, students: list[Student], out: Path, program: str, limits: Limits, jobs: int) -> None:
    """Make the folders; each complete deck is solved first, and nothing is written if one gives no values."""
    if out.exists() and any(out.iterdir()):
        raise LabError(f"{out} is not empty: students may have worked there; give another folder")
    with tempfile.TemporaryDirectory(prefix="atrito-lab-") as work, ThreadPoolExecutor(jobs) as pool:
        keeper = Keeper(program, Path(work), limits)
        list(pool.map(lambda student: Reference(sheet, keeper, student.number).try_all(), students))
    for student in students:
        folder = out/student.number
        folder.mkdir(parents=True)
        values = sheet.draw(student.number)
        (folder/sheet.deck_name).write_text(sheet.deck_with_gaps(values, student.number), encoding="utf-8")
        (folder/"answers.toml").write_text(empty_answers(sheet, student), encoding="utf-8")
        for path in sorted(sheet.folder.iterdir()):
            if path.suffix in BESIDE and not path.name.startswith("answer"):
                shutil.copyfile(path, folder/path.name)
    with (out/"class.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["number", "name", "email", *[parameter.name for parameter in sheet.parameters]])
        for student in students:
            writer.writerow([student.number, student.name, student.email, *sheet.draw(student.number).values()])
    print(f"{len(students)} folders in {out}; class.csv there has the list and everybody's values")


def empty_answers(sheet: Sheet, student: Student) -> str:
    """answers.toml, with a line a question."""
    lines = [f"# Answers to sheet {sheet.name} ({sheet.title})",
             "# Write numbers in place of \"\", such as 12.5 or 1.2e-3, in the unit that is named, and texts between",
             "# the three quotes. A line that begins with # is not read.", "",
             f'student = "{student.number}"', "", "# your values, as they stand in the deck:"]
    lines += [f"#    {name} = {value}" for name, value in sheet.draw(student.number).items()]
    lines += ["", "[answers]"]
    for quantity in sheet.quantities:
        if quantity.given == "answer":
            unit = f" [{quantity.unit}]" if quantity.unit else ""
            lines += [f"# {quantity.text}{unit} (points: {quantity.points:g})", f'{quantity.name} = ""']
    if sheet.explanations:
        lines += ["", "[explanations]"]
    for item in sheet.explanations:
        lines += [f"# {item.text} ({item.words} words at least; points: {item.points:g})", f'{item.name} = """', '"""']
    tables = ", ".join(f"{name}.tab" for name in sheet.tables)
    lines += ["", f"# Hand in this file, your deck {sheet.deck_name}" + (f", and of its output folder {tables}." if tables else ".")]
    return "\n".join(lines) + "\n"
