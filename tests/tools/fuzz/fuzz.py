#!/usr/bin/env python3
"""Files changed at random, each given to a program of its own: for builds with ATRITO_SANITIZE, by hand (docs/verification/fuzzing.md).

fuzz.py KIND ATRITO [--seed S] [--minutes M] [--count N] [--one K] [--keep FOLDER] [--change PROGRAM] FILE...

KIND: decks (checked; every eighth is solved), meshes (.msh; a deck that includes each stands beside it, NAME.inp), tables (files *.tab,
or folders of them, compared with what they were), restart (NAME.h5, whose deck is NAME.inp; PROGRAM is change_restart, which gives changed
lists their checksums).
Mutation K of seed S is the same everywhere. What is found is told with its number once for each place, and its files are left in FOLDER.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

HOSTILE = ["0", "-1", "1", "2", "3", "7", "-2147483648", "2147483647", "2147483648", "4294967296", "9223372036854775807",
           "-9223372036854775809", "1e308", "-1e308", "1e-308", "1e400", "1e-162", "NaN", "Infinity", "", "x", "1e", "0x10", "1.5", "'", "<", "<1/0>"]
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eEdD][-+]?\d+)?")
# gfortran's own: bounds of what is not allocated, at assignments that allocate; arrays that are absent and handed on
OWN = re.compile(r"-9223372036854775808 [-+] 1|signed integer overflow: 1 - -9223372036854775808|member access within null pointer"
                 r"|load of null pointer|null pointer passed as argument")
WRONG = re.compile(r"AddressSanitizer:? [^\n]*|[^\n]*runtime error: [^\n]*|[^\n]*[Rr]untime error[^\n]*|internal error[^\n]*"
                   r"|Error termination[^\n]*|allocated object[^\n]*")


def mutate(draw, data, others):
    """Some changes of bytes, numbers, lines or pieces."""
    data = bytearray(data)
    for _ in range(draw.choice([1, 1, 1, 2, 3, 8])):
        kind = draw.randrange(12)
        at = draw.randrange(len(data) + 1)
        if kind == 0 and data:
            data[draw.randrange(len(data))] = draw.randrange(256)
        elif kind == 1 and data:
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
        elif kind == 2:
            data[at:at + draw.choice([1, 2, 8, 64, 512])] = b""
        elif kind == 3:
            data[at:at] = bytes(draw.randrange(256) for _ in range(draw.choice([1, 2, 9])))
        elif kind in (4, 5, 6):
            found = list(NUMBER.finditer(data))
            if found:
                number = draw.choice(found)
                data[number.start():number.end()] = draw.choice(HOSTILE).encode()
        elif kind == 7:
            other = draw.choice(others)
            where = draw.randrange(len(other) + 1)
            data[at:at] = other[where:where + draw.choice([10, 100, 1000])]
        else:
            lines = data.split(b"\n")
            i, j = draw.randrange(len(lines)), draw.randrange(len(lines))
            if kind == 8:
                lines[i], lines[j] = lines[j], lines[i]
            elif kind == 9:
                lines[i:i] = lines[j:j + draw.choice([1, 3, 10])]
            elif kind == 10:
                lines[i:i] = [lines[i]] * draw.choice([2, 30, 2000])
            else:
                del lines[i:i + draw.choice([1, 1, 3, 20])]
            data = bytearray(b"\n".join(lines))
    if draw.randrange(40) == 0:
        del data[draw.randrange(len(data) + 1):]
    return bytes(data)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


class Kind:
    """How the files of a kind are changed, and what is run on them."""

    def __init__(self, given):
        self.given = given
        self.files = sorted(given.files)
        self.data = {path: read(path) for path in self.files if not os.path.isdir(path)}

    def mutated(self, draw, path):
        return mutate(draw, self.data[path], list(self.data.values()))


class Decks(Kind):
    def make(self, draw, k, folder):
        write(f"{folder}/deck.inp", self.mutated(draw, draw.choice(self.files)))
        return ["deck.inp", "--quiet", "-o", "out"] if k % 8 == 0 else ["check", "deck.inp"]


class Meshes(Kind):
    def make(self, draw, k, folder):
        path = draw.choice(self.files)
        shutil.copy(os.path.splitext(path)[0] + ".inp", f"{folder}/deck.inp")
        write(os.path.join(folder, os.path.basename(path)), self.mutated(draw, path))
        return ["deck.inp", "--quiet", "-o", "out"] if k % 8 == 0 else ["check", "deck.inp"]


class Tables(Kind):
    def __init__(self, given):
        super().__init__(given)
        self.files = [os.path.join(path, name) for path in self.files if os.path.isdir(path) for name in sorted(os.listdir(path))
                      if name.endswith((".tab", ".csv"))] + [path for path in self.files if os.path.isfile(path)]
        self.data = {path: read(path) for path in self.files}

    def make(self, draw, k, folder):
        path = draw.choice(self.files)
        name = os.path.basename(path)
        os.mkdir(f"{folder}/a")
        os.mkdir(f"{folder}/b")
        write(f"{folder}/a/{name}", self.data[path])
        write(f"{folder}/b/{name}", self.mutated(draw, path))
        if draw.randrange(4) == 0:
            write(f"{folder}/a/{name}", self.mutated(draw, path))
        return ["compare", "a", "b"] if draw.randrange(2) else ["compare", f"a/{name}", f"b/{name}"]


class Restart(Kind):
    def make(self, draw, k, folder):
        path = draw.choice(self.files)
        shutil.copy(os.path.splitext(path)[0] + ".inp", f"{folder}/deck.inp")
        write(f"{folder}/r.h5", self.data[path])
        if draw.randrange(10) == 0:
            write(f"{folder}/r.h5", self.mutated(draw, path))
        else:
            self.change_lists(draw, f"{folder}/r.h5")
        return ["deck.inp", "--quiet", "-o", "out", "--restart", "r.h5"]

    def change_lists(self, draw, path):
        """Values of lists, with checksums that are right."""
        lists = subprocess.run([self.given.change, path], capture_output=True, check=True, text=True).stdout.split("\n")
        lists = [line.split() for line in lists if line and not line.startswith("/origin")]
        for _ in range(draw.choice([1, 1, 1, 2, 5])):
            name, n = draw.choice([line for line in lists for _ in range(1 + 4 * line[0].endswith("integers"))])
            if int(n) == 0:
                continue
            value = draw.choice(["-1", "0", "1", "2", "3", "4", "1000", "2147483647", "-2147483648", "9223372036854775807", "+1", "-+1"]) \
                if name.endswith("integers") else draw.choice(["nan", "inf", "-inf", "0", "-1", "1e308", "1e-308"]) \
                if name.endswith("reals") else str(draw.randrange(256))
            subprocess.run([self.given.change, path, name, str(1 + draw.randrange(int(n))), value], check=True, capture_output=True)


KINDS = {"decks": Decks, "meshes": Meshes, "tables": Tables, "restart": Restart}
CODES = {"tables": (0, 1, 2, 5), "restart": (0, 2, 3, 4, 5)}


def run(given, kind, k, folder):
    """What is wrong, in words that are the same for the same fault; '' when nothing is. And the exit code."""
    draw = random.Random(f"{given.seed} {k}")
    arguments = kind.make(draw, k, folder)
    began = time.monotonic()
    try:
        done = subprocess.run([given.atrito, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=given.seconds,
                              env={**os.environ, "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=4000",
                                   "OMP_NUM_THREADS": "1"})
    except subprocess.TimeoutExpired:
        return "no end", -1
    text = done.stdout.decode("utf-8", "replace")
    write(f"{folder}/said", done.stdout)
    for found in WRONG.finditer(text):
        if not OWN.search(found.group()):
            where = re.search(r"#\d+ \S+ in (?!_gfortr)(\S*atrito\S*|\S+_MOD_\S+)[^\n]*", text[found.start():])
            return re.sub(r"0x[0-9a-f]+|==\d+==|\d{4,}", "N", found.group()) + (f" at {where.group(1)}" if where else ""), done.returncode
    if done.returncode not in CODES.get(given.kind, (0, 2, 3, 4)):
        return f"exit {done.returncode}", done.returncode
    if re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f]", text):
        return "a control character is told", done.returncode
    if time.monotonic() - began > given.seconds / 2:
        return "takes long", done.returncode
    return "", done.returncode


def main():
    options = argparse.ArgumentParser()
    options.add_argument("kind", choices=KINDS)
    options.add_argument("atrito")
    options.add_argument("files", nargs="+")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--minutes", type=float, default=60)
    options.add_argument("--count", type=int, default=10**9)
    options.add_argument("--one", type=int)
    options.add_argument("--keep", default="fuzz-found")
    options.add_argument("--change", default="change_restart")
    options.add_argument("--seconds", type=float, default=60)
    given = options.parse_args()
    given.atrito = os.path.abspath(given.atrito)
    if os.path.exists(given.change):
        given.change = os.path.abspath(given.change)
    kind = KINDS[given.kind](given)
    found, codes, end, k = {}, {}, time.monotonic() + 60 * given.minutes, given.one or 1
    last = k if given.one else given.count
    while k <= last and time.monotonic() < end:
        folder = tempfile.mkdtemp()
        wrong, code = run(given, kind, k, folder)
        codes[code] = codes.get(code, 0) + 1
        if wrong:
            found.setdefault(wrong, []).append(k)
            if len(found[wrong]) == 1:
                print(f"{given.kind}: --seed {given.seed} --one {k}: {wrong}", flush=True)
                os.makedirs(given.keep, exist_ok=True)
                shutil.copytree(folder, f"{given.keep}/{given.kind}-{given.seed}-{k}", dirs_exist_ok=True)
        shutil.rmtree(folder)
        k += 1
    print(f"{given.kind}, seed {given.seed}: {sum(codes.values())} files; exit codes {dict(sorted(codes.items()))}; "
          f"{sum(map(len, found.values()))} wrong in {len(found)} ways")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
