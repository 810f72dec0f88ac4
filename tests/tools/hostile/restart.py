#!/usr/bin/env python3
"""Restart files with numbers that their deck does not give, and checksums that are right: exit 2, and what does not fit is named.

restart.py ATRITO CHANGE_RESTART [--all FORM] (every number of the state, which takes minutes)
"""
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

from catalogue import scene, write

PRINTED = """*NODE PRINT, FREQUENCY=1
U, RF
*EL PRINT, FREQUENCY=1, ELSET=HIGH
S
*CONTACT PRINT, FREQUENCY=1
*BODY PRINT, FREQUENCY=1
*JOINT PRINT, FREQUENCY=1
*SECTION PRINT, NAME=CUT
-1, 0.4, 2, 0.4
"""
SECOND = "*STEP\n*STATIC\n0.5, 1.\n*DSLOAD\nHIGH-RIGHT, P, 0.3\n*END STEP\n"
HUGE = "2147483647"
# part, component, which of it, value
HOSTILE = [
    ("state", "step", 1, "0"), ("state", "step", 1, "2"), ("state", "step", 1, HUGE), ("state", "increment", 1, "0"),
    ("state", "increment", 1, "+1"), ("state", "increment", 1, "-5"), ("state", "ends_step", 1, "0"),
    ("state", "contact_form", 1, "0"), ("state", "contact_form", 1, "7"), ("state", "form", 1, "9"), ("state", "form", 1, "-1"),
    ("state", "state", 1, "-1"), ("state", "state", 2, "4"), ("state", "state", 3, HUGE), ("state", "tangential_of", 1, "0"),
    ("state", "tangential_of", 1, HUGE), ("state", "n_dofs", 1, "+1"), ("state", "n_normal", 1, "0"),
    ("state", "n_rigid", 1, "1"), ("state", "n_nodes", 1, "+1"), ("state", "n_elements", 1, "-1"), ("state", "n_points", 1, "+1"),
    ("state", "least_node", 1, "999"), ("state", "n", 1, "+1"), ("state", "n", 1, "-1"), ("state", "status", 1, "3"),
    ("state", "status", 2, "-1"), ("state", "outer", 1, "-1"), ("state", "pair", 1, "0"),
    ("frame_1", "step", 1, "0"), ("frame_1", "converged", 1, "0"),
    ("frame_1", "status", 1, HUGE), ("frame_1", "joint", 1, "0"), ("frame_1", "joint", 3, "2"),
    ("frame_1", "joint", 1, HUGE), ("frame_1", "stress_element", 1, "0"), ("frame_1", "stress_element", 4, "-7"),
    ("frame_1", "stress_element", 5, HUGE), ("frame_1", "stress_point", 1, "5"), ("frame_1", "pair", 1, "2"),
    ("frame_1", "id", 1, "77777"), ("frame_1", "id", 1, "-1"), ("frame_1", "n_equations", 1, "+1"),
    ("frame_1", "inner", 1, "-3"), ("frame_1", "linear_solves", 1, "-1"), ("frame_1", "memory", 1, "-1")]
AGAINST_ITSELF = [("frame_1", "increment", 1, "9"), ("frame_1", "increment", 1, "-1"), ("frame_2", "increment", 1, "1"),
                  ("state", "increments of frames", 1, "2"), ("frame_1", "has_friction", 1, "2"), ("state", "joints", 1, HUGE)]
SPARSE = [("state", "pair", 1, "0"), ("state", "pair", 1, HUGE), ("state", "n_pairs", 1, "-1"), ("state", "n_pairs", 1, "+1"),
          ("state", "n_contact_pairs", 1, "0")]
MOST_MEMORY = 1 << 30  # a list of ZEROS numbers takes more
ZEROS = 300_000_000
BAD = re.compile(r"untime error|Backtrace|internal error|AddressSanitizer|SIGSEGV")
VALUES = ["-1", "0", "1", "2", "3", "+1", "-+1", "1000", HUGE, "-2147483648", "9223372036854775807"]


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def restart(atrito, form, folder, path):
    done = subprocess.run([atrito, "deck.inp", "--quiet", "--contact", form, "-o", "out", "--restart", path], cwd=folder,
                          capture_output=True, timeout=60, preexec_fn=limited)
    return done.returncode, done.stderr.decode("utf-8", "replace")


def try_form(atrito, change, form, every, folder):
    """Faults with the files of a form of the contact system."""
    faults = 0

    def attempt(arguments, codes, words=""):
        nonlocal faults
        shutil.copy(f"{folder}/sound.h5", f"{folder}/r.h5")
        subprocess.run([change, f"{folder}/r.h5", *map(str, arguments)], check=True, timeout=60)
        code, text = restart(atrito, form, folder, "r.h5")
        if code not in codes or words not in text or BAD.search(text):
            faults += 1
            print(f"{form}: {arguments}: exit {code}, expected {codes}, {words}\n   {text[-400:]}")
        return code

    write(folder, scene(model="*RESTART, WRITE\n", step=PRINTED).replace("*STATIC\n", "*STATIC\n0.25, 1.\n"))
    subprocess.run([atrito, "deck.inp", "--quiet", "--contact", form, "-o", "first"], cwd=folder, check=True, timeout=60)
    shutil.move(f"{folder}/first/deck.restart.h5", f"{folder}/sound.h5")
    with open(f"{folder}/deck.inp", "a", encoding="utf-8") as file:
        file.write(SECOND)
    code, text = restart(atrito, form, folder, "sound.h5")
    if code != 0:
        print(f"{form}: the sound file: exit {code}, {text}")
        return 1
    for case in HOSTILE + SPARSE * (form == "sparse"):
        attempt(case, (2,), "r.h5: ")
    for case in AGAINST_ITSELF:
        attempt(case, (5,), "r.h5: is damaged")
    lists = dict(line.split() for line in subprocess.run([change, f"{folder}/sound.h5"], capture_output=True, check=True,
                                                         text=True).stdout.splitlines())
    # lists that claim far more than the file has
    for name in lists:
        attempt([name, ZEROS], (5,), "r.h5: ")
    # what is no number does not go through, wherever it stands among the reals but where something may be undefined
    draw = random.Random(form)
    codes = {}
    for name in ["state", "frame_2"]:
        for value in ["inf", "-inf", "nan"]:
            attempt([f"/{name}/reals", 1 + draw.randrange(int(lists[f"/{name}/reals"])), value], (2, 0) if value == "nan" else (2,))
    # any whole number: refused, or of no consequence but for what is told
    n = int(lists["/state/integers"])
    for place in range(1, n + 1) if every else draw.sample(range(1, n + 1), 30):
        for value in VALUES if every else [draw.choice(VALUES)]:
            code = attempt(["/state/integers", place, value], (0, 2, 5))
            codes[code] = codes.get(code, 0) + 1
            if every and code == 0:
                print(f"{form}: /state/integers {place} {value} is accepted")
    for place in draw.sample(range(1, 1 + int(lists["/state/text"])), 5):
        attempt(["/state/text", place, "27"], (2, 5))
    print(f"{form}: exit codes with any whole number: {dict(sorted(codes.items()))}")
    return faults


def main():
    atrito, change = map(os.path.abspath, sys.argv[1:3])
    every = "--all" in sys.argv
    faults = 0
    for form in [sys.argv[-1]] if every else ["dense", "sparse"]:
        with tempfile.TemporaryDirectory() as folder:
            faults += try_form(atrito, change, form, every, folder)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
