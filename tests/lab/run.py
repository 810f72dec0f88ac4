#!/usr/bin/env python3
"""Tries the laboratory: a made-up class of a sheet is marked, and so are hostile hand-ins.

    run.py [--atrito PROGRAM] [--count 60] [--hostile] [SHEET ...]
    run.py [--atrito PROGRAM] --check         model answers and mistakes of all sheets but 03-hertz, which lab_class checks
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [str(TOP/"tools"/"lab"), str(Path(__file__).resolve().parent)]

from atrito_lab.mark import hand_ins_of  # noqa: E402
from atrito_lab.people import Student  # noqa: E402
from atrito_lab.program import Keeper, Limits, find_program, processors  # noqa: E402
from atrito_lab.sheet import Sheet, load_sheet  # noqa: E402
import hostile  # noqa: E402
from made_class import KINDS, Expected, Made, right  # noqa: E402

failures = 0


def fail(text: str) -> None:
    """Tell what is not as expected."""
    global failures
    failures += 1
    print(f"FAILED: {text}")


def lab(words: list[str]) -> subprocess.CompletedProcess[str]:
    """Run the tool."""
    return subprocess.run([str(TOP/"tools"/"lab"/"atrito-lab"), *words], capture_output=True, text=True, check=False)


def clock() -> tuple[float, float]:
    """Seconds by the clock, and of processor that all programs took that were run."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic(), used.ru_utime + used.ru_stime


def since(start: tuple[float, float]) -> str:
    """What has gone by, in words."""
    seconds, processor = (now - then for now, then in zip(clock(), start))
    return f"{seconds:.1f} s ({processor:.1f} s of processor)"


def make_class(sheet: Sheet, count: int, folder: Path) -> dict[str, tuple[str, Expected]]:
    """Make the hand-ins, and a list of the class; what is expected of each number."""
    # a small class, of continuous integration, takes the reference runs from the making of it
    keeper = Keeper(find_program(), folder/("made" if count >= 60 else "marks/references"), Limits())
    numbers = [f"{2026001 + place}" for place in range(count)]
    (folder/"hand-ins").mkdir()
    (folder/"class.csv").write_text("number;name;email\n" + "".join(f"{number};Student {number};{number}@example.org\n" for number in numbers))

    def make(place: int) -> tuple[str, tuple[str, Expected]]:
        kind = KINDS[place % len(KINDS)]
        made = Made(sheet, keeper, numbers[place], numbers[(place + 7) % count], folder/"hand-ins"/numbers[place])
        return numbers[place], (kind.__name__, kind(made))

    with ThreadPoolExecutor(processors()) as pool:
        return dict(pool.map(make, range(count)))


def try_class(sheet: Sheet, count: int, folder: Path) -> None:
    """Mark a made-up class, and look at points and reason of every item."""
    expected = make_class(sheet, count, folder)
    correct(sheet, expected, folder/"marks")
    start = clock()
    done = lab(["mark", str(sheet.folder), str(folder/"hand-ins"), "-o", str(folder/"marks"), "--class", str(folder/"class.csv")])
    taken = since(start)
    if done.returncode:
        fail(f"{sheet.name}: exit {done.returncode}: {done.stderr}")
        return
    rows = {row["ID number"]: row for row in csv.DictReader((folder/"marks"/"marks.csv").open(newline=""))}
    for number, (kind, wanted) in expected.items():
        results = json.loads((folder/"marks"/"students"/number/"results.json").read_text())
        judge(sheet, f"{sheet.name} {number} ({kind})", results, wanted)
        numbers = list(expected)
        neighbour = numbers[(numbers.index(number) + 7) % count] if any(kinds == {"neighbour"} for kinds, _ in wanted.values()) else ""
        whose = results["extra_data"]["whose"]  # in other sheets several of the class may have the same values
        if (whose != neighbour if sheet.name == "03-hertz" else bool(whose) != bool(neighbour)) and kind != "tables_of_another_deck":
            fail(f"{sheet.name} {number} ({kind}): values of {whose!r}, not {neighbour!r}")
        if abs(float(rows[number][f"{sheet.name} (of {sheet.points:g})"]) - results["score"]) > 1e-4:
            fail(f"{number}: marks.csv has other points than results.json")
    look_for_alike(sheet, expected, (folder/"marks"/"lecturer.html").read_text())
    print(f"{sheet.name}: {count} hand-ins marked in {taken}")


def correct(sheet: Sheet, expected: dict[str, tuple[str, Expected]], marks: Path) -> None:
    """The lecturer changes the points of the first student's first explanation."""
    if sheet.explanations:
        marks.mkdir(exist_ok=True)
        number, item = next(iter(expected)), sheet.explanations[0]
        (marks/"corrections.csv").write_text(f"number,item,points,reason\n{number},{item.name},{item.points/4},Why?\n")
        expected[number] = (expected[number][0], expected[number][1] | {item.name: ({"corrected"}, 0.25)})


def look_for_alike(sheet: Sheet, expected: dict[str, tuple[str, Expected]], page: str) -> None:
    """The page of the lecturer names those who explain in the same words, and nobody else."""
    numbers = list(expected)
    wanted = [", ".join(sorted([number, numbers[(place + 7) % len(numbers)]])) for place, number in enumerate(numbers) if expected[number][0] == "same_words"]
    told = re.findall(r"<li>([\d, ]+): (\w+), mostly in the same words</li>", page)
    if sorted(told) != sorted((pair, item.name) for pair in wanted for item in sheet.explanations):
        fail(f"{sheet.name}: explanations in the same words are said to be those of {told}, not {wanted}")


TOP_KEYS = {"score", "execution_time", "output", "output_format", "test_output_format", "test_name_format", "visibility", "stdout_visibility", "extra_data",
            "tests", "leaderboard"}
TEST_KEYS = {"score", "max_score", "status", "name", "name_format", "number", "output", "output_format", "tags", "visibility", "extra_data"}


def look_at_form(who: str, results: dict) -> None:
    """Whether results.json has the form that Gradescope documents."""
    formats = ("text", "html", "simple_format", "md", "ansi")
    right_top = set(results) <= TOP_KEYS and isinstance(results["score"], (int, float)) and results["visibility"] in ("hidden", "after_due_date", "after_published", "visible")
    right_tests = all(set(test) <= TEST_KEYS and isinstance(test["score"], (int, float)) and 0 <= test["score"] <= test["max_score"]
                      and test["status"] in ("passed", "failed") and test["output_format"] in formats and isinstance(test["number"], str) for test in results["tests"])
    if not right_top or not right_tests or results["output_format"] not in formats or results["score"] != round(sum(test["score"] for test in results["tests"]), 6):
        fail(f"{who}: results.json has not the form of Gradescope")


def judge(sheet: Sheet, who: str, results: dict, wanted: Expected) -> None:
    """Kinds and points of one hand-in."""
    look_at_form(who, results)
    for (name, kind), test in zip(results["extra_data"]["kinds"].items(), results["tests"], strict=True):
        kinds, credit = wanted.get(name, ({"right", "mesh", "lecturer"}, 1.0))
        if kind not in kinds:
            fail(f"{who}: {name} is {kind}, not {' or '.join(sorted(kinds))}: {test['output']}")
        elif credit is not None and abs(test["score"] - credit*test["max_score"]) > 1e-6:
            fail(f"{who}: {name} has {test['score']} of {test['max_score']}, not {credit} of it: {test['output']}")
    unknown = set(wanted) - set(results["extra_data"]["kinds"])
    if unknown:
        fail(f"{who}: no item {unknown}")


def tree(folder: Path) -> dict[str, tuple[int, int]]:
    """What is in a folder: size and time of each file, links not followed."""
    return {os.path.join(place, name): (os.lstat(os.path.join(place, name)).st_size, os.lstat(os.path.join(place, name)).st_mtime_ns)
            for place, _, names in os.walk(folder) for name in names}


def try_hostile(sheet: Sheet, folder: Path) -> None:
    """Hostile hand-ins and two good ones: nothing changes outside MARKS, nothing of them is run or shown as it is, the good ones are marked."""
    keeper = Keeper(find_program(), folder/"made", Limits())
    (folder/"secret.txt").write_text(hostile.SECRET)
    (folder/"hand-ins").mkdir()
    numbers = [str(3001 + place) for place in range(len(hostile.KINDS) + 2)]
    for place, number in enumerate(numbers):
        made = Made(sheet, keeper, number, numbers[place - 1], folder/"hand-ins"/number)
        (hostile.KINDS[place] if place < len(hostile.KINDS) else right)(made)
    with (folder/"class.csv").open("w", newline="") as file:
        csv.writer(file).writerows([["number", "name"], *[[number, (hostile.FORMULA, hostile.EVIL)[place % 2]] for place, number in enumerate(numbers)]])
    before, elsewhere = tree(folder), set(os.listdir(tempfile.gettempdir()))
    start = clock()
    done = lab(["mark", str(sheet.folder), str(folder/"hand-ins"), "-o", str(folder/"marks"), "--class", str(folder/"class.csv"), "--seconds", "3"])
    taken = since(start)
    if done.returncode:
        fail(f"hostile: exit {done.returncode}: {done.stderr[-2000:]}")
        return
    after = {name: state for name, state in tree(folder).items() if not name.startswith(str(folder/"marks"))}
    if after != before:
        fail(f"hostile: changed outside of MARKS: {set(after.items()) ^ set(before.items())}")
    left = [name for name in set(os.listdir(tempfile.gettempdir())) - elsewhere if "pwned" in name]
    if left or list(Path.cwd().glob("pwned")):
        fail(f"hostile: something was run: {left}")
    for path in (folder/"marks").rglob("*"):
        if path.suffix in (".html", ".csv", ".json") and path.is_file() and "references" not in path.parts:
            look_at(path)
    for number, kind in zip(numbers, [*hostile.KINDS, right, right]):
        results = json.loads((folder/"marks"/"students"/number/"results.json").read_text())
        if "not marked" in results["extra_data"]["kinds"].values():
            fail(f"hostile: {number} ({kind.__name__}) was not marked: {results['tests'][0]['output']}")
        is_full = results["score"] == sheet.points
        if kind in hostile.LEFT_OUT and "read" not in results["output"]:
            fail(f"hostile: {number} ({kind.__name__}) is not told what was left out: {results['output']}")
        if is_full != (kind in (right, *hostile.HARMLESS)):
            fail(f"hostile: {number} ({kind.__name__}) has {results['score']} points")
    print(f"{sheet.name}: {len(hostile.KINDS)} hostile hand-ins marked in {taken}")


def look_at(path: Path) -> None:
    """A file of MARKS: no tag, formula, control character or secret of a hand-in."""
    text = path.read_text(encoding="utf-8")
    if hostile.SECRET in text or "root:x:" in text:
        fail(f"hostile: {path.name} tells what a file outside says")
    if any(ord(letter) < 32 and letter not in "\n\r" or 0x7f <= ord(letter) < 0xa0 or letter in "\u202e\u2066" for letter in text):
        fail(f"hostile: {path} has a control character")
    if path.suffix == ".html" and any(tag in text.lower() for tag in ("<script", "<img", "<style>body{d", "<a href=javascript")):
        fail(f"hostile: {path} has a tag of a hand-in")
    if path.suffix == ".csv":
        for row in csv.reader(text.splitlines()):
            for word in row:
                if word[:1] in ("=", "+", "-", "@", "\t"):
                    fail(f"hostile: marks.csv has the formula {word[:40]}")


def try_draw(sheet: Sheet, folder: Path) -> None:
    """Handing out twice gives the same; `check` is content, and is not with a sheet whose model answer is wrong."""
    (folder/"two.csv").write_text("\ufeffnumber,name\n77,Ana\n78,\"O'Neill, Tó\"\n", encoding="utf-8")
    for out in ("first", "second"):
        done = lab(["hand-out", str(sheet.folder), str(folder/"two.csv"), "-o", str(folder/out)])
        if done.returncode:
            fail(f"{sheet.name}: hand-out: {done.stderr}")
            return
    for path in (folder/"first").rglob("*.*"):
        if path.read_bytes() != (folder/"second"/path.relative_to(folder/"first")).read_bytes():
            fail(f"{sheet.name}: {path.name} is another one when it is handed out again")
    decks = [(folder/"first"/number/sheet.deck_name).read_text() for number in ("77", "78")]
    if sheet.parameters and decks[0].splitlines()[1:] == decks[1].splitlines()[1:]:
        fail(f"{sheet.name}: two students have the same values")
    if not lab(["hand-out", str(sheet.folder), str(folder/"two.csv"), "-o", str(folder/"first")]).returncode:
        fail(f"{sheet.name}: handed out over a folder with files")
    done = lab(["check", str(sheet.folder)])
    if done.returncode:
        fail(f"{sheet.name}: check: {done.stdout}{done.stderr}")


def try_folders(folder: Path) -> None:
    """A hand-in is found by a number with dots and underscores: alone, before a name, behind it, or by the name as Moodle writes it."""
    for place, name in enumerate(("UP-2026.007_B", "UP-2026.007_B_Tó Filho", "Tó UP-2026.007_B", "Tó Filho_12_assignsubmission_file_")):
        (folder/f"folders-{place}"/name).mkdir(parents=True)
        found = hand_ins_of(folder/f"folders-{place}", [Student("UP-2026.007_B", "Tó Filho"), Student("2026.007")])
        if [source and source.name for _, source in found] != [name, None]:
            fail(f"the folder {name} is not found by its number or name, or somebody else's number is seen in it: {found}")


def try_wrong_sheets(sheet: Sheet, folder: Path) -> None:
    """What is wrong with a sheet is told: by reading it, or by `check`."""
    (folder/sheet.name).mkdir()
    text = (sheet.folder/"sheet.toml").read_text()
    (folder/sheet.name/"sheet.md").write_text("")
    for place, (old, new, told) in enumerate([
            ("points = ", "ponits = ", "ponits"), ("tolerance = ", "tolerance = -", "the model answer"), ("deck = \"", "deck = \"../", "is neither in"),
            ("from = 3.0\nto = 5.0", "from = -5.0\nto = -3.0", "ends with 4"),
            ("\n[[mistake]]", "\n[[mistake]]\nname = \"none\"\ntext = \"\"\nset = {}\n[[mistake]]", "needs one of set, replace"),
            ("\n[[mistake]]", f"\n[[mistake]]\nname = \"none\"\ntext = \"\"\nset = {{ {sheet.parameters[0].name} = \"{sheet.parameters[0].name}\" }}\n[[mistake]]",
             "mistake none is not recognised"), ("[parameters.", "[parameters.no_", "the deck defines no_")]):
        if old in text:
            (folder/sheet.name/"sheet.toml").write_text(text.replace(old, new, 1))
            (folder/sheet.name/sheet.deck_name).write_text(sheet.deck)
            done = lab(["check", str(folder/sheet.name)])
            if done.returncode != 1 or told not in done.stdout + done.stderr or "Traceback" in done.stderr:
                fail(f"{sheet.name}, wrong sheet {place}: exit {done.returncode}, not {told!r}: {done.stdout}{done.stderr}")


def main() -> int:
    """All that is asked for."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("sheets", nargs="*", metavar="SHEET")
    options.add_argument("--atrito")
    options.add_argument("--count", type=int, default=60)
    options.add_argument("--hostile", action="store_true", help="the hostile hand-ins alone")
    options.add_argument("--check", action="store_true", help="model answers and mistakes alone")
    given = options.parse_args()
    if given.atrito:
        os.environ["ATRITO"] = given.atrito
    sheets = given.sheets or sorted(path.parent.name for path in (TOP/"docs"/"labs").glob("*/sheet.toml"))
    if given.check:
        for name in sheets:
            done = lab(["check", name]) if name != "03-hertz" else None
            if done and done.returncode:
                fail(f"{name}: check: {done.stdout}{done.stderr}")
        print("all as expected" if not failures else f"{failures} failed")
        return 1 if failures else 0
    if given.hostile or given.count >= 60:
        with tempfile.TemporaryDirectory(prefix="lab-test-") as work:
            try_hostile(load_sheet(sheets[0]), Path(work))
    for sheet in map(load_sheet, sheets):
        if not given.hostile:
            with tempfile.TemporaryDirectory(prefix="lab-test-") as work:
                try_class(sheet, given.count, Path(work))
                try_draw(sheet, Path(work))
                if sheet.name == "03-hertz":
                    try_folders(Path(work))
                    try_wrong_sheets(sheet, Path(work))
    print("all as expected" if not failures else f"{failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
