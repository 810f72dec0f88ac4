"""What other programs read: marks.csv for Moodle and spreadsheets, results.json for Gradescope."""

from __future__ import annotations

import csv
import json
from pathlib import Path

from .diagnose import Case
from .sheet import Sheet


def cell(value: object) -> str:
    """A word of a spreadsheet that is never a formula: what would be one has an apostrophe before it."""
    if isinstance(value, (int, float)):
        return f"{value:g}"
    text = "".join(letter if letter.isprintable() else " " for letter in str(value))
    return f"'{text}" if text.lstrip()[:1] in ("=", "+", "-", "@", "|", "%") else text


def write_marks(sheet: Sheet, cases: list[Case], path: Path) -> None:
    """A row a student: number, name, address, points in all and of each item, and the reasons of what is not full."""
    items = [verdict.name for verdict in cases[0].verdicts]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["ID number", "Name", "Email address", f"{sheet.name} (of {sheet.points:g})", *items, "Feedback"])
        for case in cases:
            told = "; ".join(f"{verdict.name}: {verdict.reason}" for verdict in case.verdicts if verdict.points < verdict.of)
            person = case.hand_in
            row = [person.number, person.name, person.email, case.points, *[verdict.points for verdict in case.verdicts], told]
            writer.writerow([cell(value) for value in row])


def write_results(case: Case, path: Path) -> None:
    """The results of one student in the form that Gradescope documents for results.json."""
    tests = [{"name": verdict.text, "number": str(place), "score": verdict.points, "max_score": verdict.of,
              "status": "passed" if verdict.points >= verdict.of else "failed", "output": verdict.reason, "output_format": "text"}
             for place, verdict in enumerate(case.verdicts, 1)]
    extra = {"sheet": case.sheet.name, "values": case.reference.drawn, "whose": case.neighbour,
             "kinds": {verdict.name: verdict.kind for verdict in case.verdicts}}
    results = {"score": case.points, "output": " ".join([case.deck_reason, case.values_reason, *case.hand_in.notes]).strip(),
               "output_format": "text", "test_output_format": "text", "test_name_format": "text", "visibility": "visible",
               "tests": tests, "extra_data": extra}
    path.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
