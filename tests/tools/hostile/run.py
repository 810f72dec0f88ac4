#!/usr/bin/env python3
"""Runs the catalogue of hostile decks: each has limits of time and memory, and what it has to end with (README.md).

run.py ATRITO [--only PATTERN] [--list] [--must-fail] [--patience N] [--without KIND]
"""
import argparse
import importlib
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading

from catalogue import CASES, Case

FILES = ["text", "growth", "sizes", "files", "many", "reported", "numbers"]
ROOM = 2048                    # MiB of addresses beyond the limit of a case: libraries map more than they touch
NEVER = re.compile(r"untime error|Backtrace|internal error|forrtl|AddressSanitizer|already allocated|allocated object")


def run(atrito, case, folder):
    """What is wrong with the end of a run, a list of words; and its processor seconds and MiB."""
    arguments = case.make(folder) or ["check", "deck.inp"]
    made = set(os.listdir(folder))

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, ((case.mebibytes + ROOM) << 20,) * 2)
        resource.setrlimit(resource.RLIMIT_CPU, (int(2 * case.seconds) + 2,) * 2)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as said, open(os.devnull, "rb") as nothing:
        process = subprocess.Popen([atrito, *arguments], cwd=folder, stdin=nothing, stdout=said, stderr=said,
                                   preexec_fn=limit, start_new_session=True)
        timer = threading.Timer(10 * case.seconds + 20, os.killpg, (process.pid, signal.SIGKILL))
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        timer.cancel()
        said.seek(0)
        text = said.read().decode("utf-8", "replace")
    process.returncode = os.waitstatus_to_exitcode(status)
    seconds, mebibytes = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024
    wrong = []
    if process.returncode not in case.codes:
        wrong.append(f"exit {process.returncode}, expected {case.codes}: {text[-400:]}")
    if seconds > case.seconds:
        wrong.append(f"{seconds:.1f} s, at most {case.seconds}")
    if mebibytes > case.mebibytes:
        wrong.append(f"{mebibytes:.0f} MiB, at most {case.mebibytes}")
    wrong += [f"not said: {words}; but {text[-400:]}" for words in case.says if words not in text]
    if NEVER.search(text):
        wrong.append(f"of the run-time library: {NEVER.search(text).group()}")
    if re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", text):
        wrong.append("a control character is told")
    if len(text) > 2_000_000:
        wrong.append(f"{len(text)} characters are told")
    left = set(os.listdir(folder)) - made
    if left and process.returncode not in (0, 3):
        wrong.append(f"left behind: {sorted(left)}")
    return wrong, seconds, mebibytes


def run_all(atrito, cases):
    """The number of cases that fail."""
    failed, total = 0, 0.0
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            wrong, seconds, mebibytes = run(atrito, case, folder)
        total += seconds
        print(f"{'FAILED' if wrong else 'ok':6} {seconds:6.2f} of {case.seconds:3} s {mebibytes:6.0f} of {case.mebibytes:5} MiB  "
              f"{case.name}")
        for words in wrong:
            print("       " + words.replace("\n", "\n       "))
        failed += bool(wrong)
    print(f"{len(cases)} cases, {total:.1f} s of processor time, {failed} failed")
    return failed


def must_fail(atrito):
    """Each wrong expectation is noticed: the number of those that are not."""
    def empty(folder):
        with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8"):
            pass

    wrong = {"the code": Case("code", empty, 5, 500, (0,), ["E-EMPTY"]), "the words": Case("words", empty, 5, 500, (2,), ["E-FULL"]),
             "the time": Case("time", empty, 0, 500, (2,), ["E-EMPTY"]), "the memory": Case("memory", empty, 5, 1, (2,), ["E-EMPTY"])}
    missed = [what for what, case in wrong.items() if run_all(atrito, [case]) == 0]
    for what in missed:
        print(f"a wrong expectation of {what} is not noticed")
    return len(missed) + run_all(atrito, [Case("right", empty, 5, 500, (2,), ["E-EMPTY"])])


def main():
    options = argparse.ArgumentParser()
    options.add_argument("atrito")
    options.add_argument("--only", default="", help="cases whose name matches")
    options.add_argument("--list", action="store_true")
    options.add_argument("--must-fail", action="store_true")
    options.add_argument("--patience", type=int, default=1, help="limits of time are so many times as long: for builds with checks")
    options.add_argument("--without", default="", help="a kind that is left out")
    given = options.parse_args()
    atrito = os.path.abspath(given.atrito)
    for name in [name for name in FILES if name != given.without]:
        importlib.import_module(name)
    for case in CASES:
        case.seconds *= given.patience
    cases = [case for case in CASES if re.search(given.only, case.name)]
    if given.list:
        for case in cases:
            print(f"{case.name}: {case.seconds} s, {case.mebibytes} MiB, exit {case.codes}")
        return 0
    return must_fail(atrito) if given.must_fail else run_all(atrito, cases)


if __name__ == "__main__":
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    sys.exit(1 if main() else 0)
