"""The command line."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from .check import check_sheet
from .handout import hand_out
from .mark import mark
from .people import read_class
from .program import LabError, Limits, find_program, processors
from .sheet import load_sheet

ABOUT = """atrito-lab: sheets of the laboratory for a class

  atrito-lab hand-out SHEET CLASS.csv -o DIR   a folder a student: the sheet, a deck
                                               with values of one's own, answers.toml
  atrito-lab mark SHEET DIR -o MARKS           points and reasons for all hand-ins of DIR
  atrito-lab check SHEET                       try a sheet: model answer and mistakes

SHEET is a folder with sheet.md and sheet.toml, or the name of one that comes with
atrito, such as 03-hertz. docs/labs/README.md tells the rest."""


def parser() -> argparse.ArgumentParser:
    """The options."""
    top = argparse.ArgumentParser(prog="atrito-lab", description=ABOUT, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = top.add_subparsers(dest="command", required=True, metavar="hand-out, mark or check")
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("sheet", metavar="SHEET")
    common.add_argument("--jobs", type=int, default=processors(), help="runs side by side; default: the processors")
    limits = argparse.ArgumentParser(add_help=False)
    limits.add_argument("--seconds", type=int, default=10, help="of processor that one run may take; default 10")
    limits.add_argument("--megabytes", type=int, default=2000, help="of memory that one run may take; default 2000")
    out = commands.add_parser("hand-out", parents=[common, limits], help="a folder a student")
    out.add_argument("people", metavar="CLASS.csv", type=Path)
    out.add_argument("-o", dest="out", type=Path, required=True, metavar="DIR", help="folder that is made")
    marking = commands.add_parser("mark", parents=[common, limits], help="points and reasons")
    marking.add_argument("folder", metavar="DIR", type=Path, help="a folder a hand-in, named by the student's number")
    marking.add_argument("-o", dest="out", type=Path, required=True, metavar="MARKS",
                         help="folder of marks.csv, lecturer.html, students/")
    marking.add_argument("--class", dest="people", type=Path, metavar="CLASS.csv",
                         help="the class; default: class.csv in DIR, else the folders of DIR")
    commands.add_parser("check", parents=[common, limits], help="try a sheet")
    return top


def main(words: list[str] | None = None) -> int:
    """Run a command; exit code 0: done, 1: trouble, or a sheet that is not right."""
    options = parser().parse_args(words)
    try:
        sheet, program, jobs = load_sheet(options.sheet), find_program(), max(1, options.jobs)
        limits = Limits(max(1, options.seconds), max(100, options.megabytes))
        if options.command == "hand-out":
            hand_out(sheet, read_class(options.people), options.out, program, limits, jobs)
            return 0
        if options.command == "mark":
            mark(sheet, options.folder, options.out, read_class(options.people) if options.people else None, program, limits, jobs)
            return 0
        complaints = check_sheet(sheet, program, limits, jobs)
        for complaint in complaints:
            print(f"{sheet.name}: {complaint}")
        if not complaints:
            print(f"{sheet.name}: {sheet.points:g} points; the model answer has all of them, "
                  f"{len(sheet.mistakes)} mistakes are recognised")
        return 1 if complaints else 0
    except (LabError, OSError) as trouble:
        print(f"atrito-lab: {trouble}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    os.umask(0o077)
    sys.exit(main())
