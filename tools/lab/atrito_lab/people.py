"""The list of a class."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

from .program import LabError

# names of columns as Moodle, Excel and people write them
NUMBER = ("number", "id number", "idnumber", "student", "student number", "id", "numero", "número")
EMAIL = ("email", "email address", "e-mail", "mail")
NAMES = (("name", "full name", "nome"), ("first name", "nome próprio"), ("surname", "last name", "apelido"))


@dataclass(frozen=True)
class Student:
    """Somebody of the class."""

    number: str
    name: str = ""
    email: str = ""


def read_class(path: Path) -> list[Student]:
    """A list of the class: a row a student under a row of names of columns; only the number has to be there."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as trouble:
        raise LabError(f"{path}: {trouble}") from None
    first = text.partition("\n")[0]
    rows = [row for row in csv.reader(text.splitlines(), delimiter=max(",;\t", key=first.count)) if any(word.strip() for word in row)]
    if not rows:
        raise LabError(f"{path} is empty")
    heads = [word.strip().lower() for word in rows[0]]
    number = next((heads.index(word) for word in NUMBER if word in heads), None)
    if number is None:
        raise LabError(f"{path}: the first row names no column 'number' (or 'ID number')")
    email = next((heads.index(word) for word in EMAIL if word in heads), None)
    parts = [place for words in NAMES for place, word in enumerate(heads) if word in words]
    students = []
    for line, row in enumerate(rows[1:], 2):
        row = [word.strip() for word in row] + [""]*(len(heads) - len(row))
        if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,39}", row[number]):
            raise LabError(f"{path}, row {line}: {row[number]!r} is no number of a student: letters, digits, . _ and -, at most 40")
        name = " ".join(row[place] for place in parts if row[place])
        students.append(Student(row[number], name, row[email] if email is not None else ""))
    numbers = [student.number.lower() for student in students]
    twice = {number for number in numbers if numbers.count(number) > 1}
    if twice:
        raise LabError(f"{path}: {', '.join(sorted(twice))} is there twice")
    return students
