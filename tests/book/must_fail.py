#!/usr/bin/env python3
"""The runner of the book notices what is wrong: made-up cases and a made-up program that writes the same tables for all of them.

   must_fail.py"""
import contextlib
import importlib.machinery
import importlib.util
import io
import sys
import tempfile
from pathlib import Path

loader = importlib.machinery.SourceFileLoader("run_book", str(Path(__file__).resolve().parent/"run_book"))
run_book = importlib.util.module_from_spec(importlib.util.spec_from_loader("run_book", loader))
loader.exec_module(run_book)
PROGRAM = """#!/bin/sh
while [ $# -gt 0 ]; do case $1 in -o) folder=$2 ;; --refine) level=$2 ;; --bad) exit 3 ;; esac; shift; done
mkdir -p "$folder" || exit 5
echo "solved       2 bodies, 112 elements, 398 nodes, 736 free displacements"
printf '# columns: step pair quantity value increment\\n1 0 book_1 2.%s 1\\n1 0 error_estimate_percent 0.25 1\\n1 0 error_bound_percent 0.75 1\\n' \\
   "0$level" >"$folder/summary.tab"
printf '# columns: step x pressure increment\\n1 0 9 1\\n2 0 3 1\\n2 1 4 1\\n' >"$folder/contact.tab"
"""
CASE = """id = "X1"
title = "Made up"
group = "none"
origin = "none"
address = "none"
kind = "closed form"
smooth = true
data = "None."
deck = "deck.inp"
refine = [0, 1, 2]
picture = "none"

[[value]]
name = "observed"
reference = 2.0
observe = "u1(1)"
uncertainty = "none"
tolerance = 0.02
why = "made up"

[[value]]
name = "cell"
reference = 4.5
table = "contact.tab"
column = "pressure*x + 1"
where = "x > 0.5"
factor = 0.9
uncertainty = "none"
tolerance = 1e-12
why = "made up"

[[value]]
name = "least"
between = [2, 3.5]
table = "contact.tab"
column = "pressure"
pick = "min"
uncertainty = "none"
why = "made up"
"""
# change of the case (or of a file beside it), exit code, words that are said
FAULTS = (
    ("reference = 2.0", "reference = 2.1", 1, "X1-made-up, observed: 2.02, error 0.0381, 0.02 allowed"),
    ("reference = 4.5", "reference = 4.51", 1, "cell: 4.5, error"),
    ("between = [2, 3.5]", "between = [3.2, 3.5]", 1, "least: 3, error"),
    ("tolerance = 0.02\n", 'tolerance = 0.02\nmissed = "too far"\n', 1, "is within its tolerance, and said to be missed"),
    ("pressure*x", "presure*x", 1, "name 'presure' is not defined"),
    ("x > 0.5", "x > 5", 1, "0 rows of contact.tab"),
    ("x > 0.5", "x >= 0", 1, "2 rows of contact.tab"),
    ("contact.tab", "contacts.tab", 1, "contacts.tab: No such file"),
    ('"pressure"', "\"'three'\"", 1, "is no number"),
    ("u1(1)\"", "u1(1)\"\nstep = 2", 1, "0 rows of summary.tab"),
    ("refine = [0, 1, 2]", "refine = [0]\noptions = ['--bad']", 1, "exit code 3, 0 expected"),
    ("refine = [0, 1, 2]", "refine = [0]\nexit = 3", 1, "exit code 0, 3 expected"),
    ("refine = [0, 1, 2]", "refine = [0, 1, 1]", 2, "refine is a list of whole numbers that grow"),
    ('id = "X1"', 'id = "X2"', 2, "the folder is not called X2-..."),
    ("tolerance = 0.02", "tolerence = 0.02", 2, "unknown key tolerence"),
    ("tolerance = 0.02", "tolerance = '0.02'", 2, "tolerance is no float"),
    ("tolerance = 0.02", "", 2, "a reference, and either tolerance or absolute"),
    ("reference = 2.0", "reference = 0", 2, "where the reference is 0 the tolerance is absolute"),
    ('"closed form"', '"a form"', 2, "kind is one of"),
    ('why = "made up"\n', "", 2, "why is missing"),
    ("factor = 0.9", 'observe = "u2(1)"', 2, "either observe, or table and column"),
    ("factor = 0.9", 'run = "other"', 2, "no run other"),
)
failed = 0


def book(work, case, *options):
    """Runs the made-up case."""
    (work/"X1-made-up").mkdir(exist_ok=True)
    (work/"X1-made-up"/"case.toml").write_text(case)
    (work/"X1-made-up"/"deck.inp").write_text("*HEADING\n")
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        code = run_book.main([str(word) for word in (work/"program", "--book", work, "--pages", work/"docs", *options)])
    return code, said.getvalue()


def expect(what, result, code, words=""):
    global failed                              # pylint: disable=global-statement
    found, said = result
    if found != code or words not in said:
        failed += 1
        print(f"{what}: exit code {found}, {code} expected, with {words}\n{said}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        (work/"program").write_text(PROGRAM)
        (work/"program").chmod(0o755)
        expect("as it is", book(work, CASE, "--write"), 0, "1 cases, 3 values, 0 of them missed as said; 0 complaints")
        expect("its pages", book(work, CASE, "--check"), 0)
        missed = CASE.replace("reference = 4.5", 'reference = 4.7\nmissed = "known"')
        expect("missed as said", book(work, missed), 0, "1 of them missed as said")
        expect("pages without it", book(work, missed, "--check"), 1, "book.md, line")
        page = work/"docs"/"book"/"X1.md"
        text = page.read_text()
        for old, new in (("2.010000 |", "2.020000 |"), ("made up |", "made |"), ("0.25", "0.28"), ("0.75", "0.71"),
                         ("\n## The references", "\n\n## The references")):
            assert old in text
            page.write_text(text.replace(old, new, 1))
            expect(f"a page with {new}", book(work, CASE, "--check"), 1, "X1.md, line")
        page.write_text(text)
        for old, new, code, words in FAULTS:
            assert old in CASE
            expect(f"{new} for {old}", book(work, CASE.replace(old, new)), code, words)
        (work/"summary.tab").write_text("# columns: step pair quantity value increment\n1 0 error_bound_percent 10 1\n2 0 linear_solves 1 9\n")
        bound = run_book.cases.find_summary(work, "error_bound_percent")
        expect("a bound of another step", (bound, ""), None)
        (work/"input").mkdir()
        (work/"input"/"a.inp").write_text("*HEADING\n")
        (work/"gallery.toml").write_text('[[deck]]\nsection = "S"\ndeck = "input/b.inp"\npage = "p.md"\ntext = "t"\n')
        said = run_book.gallery.check(work, work, [], work)
        for words in ("has not input/a.inp", "there is no input/b.inp", "figures/gallery/b.svg is not there", "gallery.md: run_book"):
            expect("a gallery", (1, "\n".join(said)), 1, words)
    print(f"{len(FAULTS) + 11} faults, {failed} not noticed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
