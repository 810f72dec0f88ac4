"""Runs decks by two programs, one before a change that must not be seen and one after it, and compares all that they tell.

same_answers.py BEFORE AFTER [-j N] [--tolerance X] [--random PROGRAM FIRST LAST SEED] [PATH ...] [-- options of atrito]

A PATH is a deck or a folder with decks (*.inp, at any depth); --random has decks made by random_scenes. Exit codes and the names of
messages must be the same; so must all tables but timing.tab, words to the letter and numbers to --tolerance (1e-12) of the largest of
their column. Build both without optimisation (-DCMAKE_BUILD_TYPE=None -DCMAKE_Fortran_FLAGS=-O0): then the same sums are the same to
the last digit, and only what was changed differs. Prints what differs, a line a deck; exit code 0 when nothing does.
"""

import argparse
import glob
import multiprocessing
import os
import re
import shutil
import subprocess
import sys
import tempfile

LONGEST = 300  # seconds


def run(program, deck, folder, options):
    """Exit code, names of messages, tables by name."""
    try:
        done = subprocess.run([program, deck, '-o', folder, '--digits', '17', '--quiet', *options], capture_output=True, text=True,
                              errors='replace', timeout=LONGEST, check=False, cwd=os.path.dirname(deck))
    except subprocess.TimeoutExpired:
        return 'too long', [], {}
    names = re.findall(r'\[([EWN]-[A-Z0-9-]+)\]', done.stdout + done.stderr)
    tables = {os.path.basename(path): rows_of(path) for path in glob.glob(os.path.join(folder, '*.tab'))}
    tables.pop('timing.tab', None)
    return done.returncode, names, tables


def rows_of(path):
    """The cells of a table, row by row; its head but the lines that name program, deck and digest."""
    with open(path, encoding='utf-8', errors='replace') as file:
        lines = file.read().splitlines()
    return [line.split() for line in lines if not re.match(r'# (program|deck|digest|command|date)\b', line)]


def number(cell):
    """Its value, or None."""
    try:
        return float(cell)
    except ValueError:
        return None


def differs(before, after, tolerance):
    """Where two tables differ by most, in words; '' where they do not."""
    if [len(row) for row in before] != [len(row) for row in after]:
        return 'another shape'
    scale, worst, words = {}, tolerance, ''
    for row in before + after:
        for column, cell in enumerate(row):
            value = number(cell)
            if value is not None and abs(value) < 1e300:
                scale[column] = max(scale.get(column, 0.0), abs(value))
    for line, (old, new) in enumerate(zip(before, after)):
        for column, (a, b) in enumerate(zip(old, new)):
            if a == b:
                continue
            x, y = number(a), number(b)
            if x is None or y is None:
                return f'row {line + 1}: {a} is {b}'
            off = abs(x - y)/max(scale[column], 1e-300)
            if off > worst:
                worst, words = off, f'row {line + 1}, column {column + 1}: {a} is {b}'
    return words


def compare(work):
    """What differs of a deck: (deck, words)."""
    deck, given = work
    folder = tempfile.mkdtemp(dir=given.folder)
    if deck.isdigit():
        path = os.path.join(folder, 'deck.inp')
        with open(path, 'w', encoding='utf-8') as file:
            subprocess.run([given.random[0], deck, given.random[3]], stdout=file, check=True)
    else:
        path = deck
    a = run(given.before, path, os.path.join(folder, 'before'), given.options)
    b = run(given.after, path, os.path.join(folder, 'after'), given.options)
    words = []
    if a[0] != b[0]:
        words.append(f'exit {a[0]} is {b[0]}')
    if a[1] != b[1]:
        words.append(f'messages {" ".join(a[1])} are {" ".join(b[1])}')
    if a[2].keys() != b[2].keys():
        words.append(f'tables {sorted(a[2].keys() ^ b[2].keys())} of one alone')
    for name in sorted(a[2].keys() & b[2].keys()):
        word = differs(a[2][name], b[2][name], given.tolerance)
        if word:
            words.append(f'{name}: {word}')
    shutil.rmtree(folder, ignore_errors=True)
    return deck, '; '.join(words)


def decks_of(paths):
    """All decks of files and folders."""
    found = []
    for path in paths:
        inside = glob.glob(os.path.join(path, '**', '*.inp'), recursive=True)
        found += sorted(inside) if os.path.isdir(path) else [path]
    return [os.path.abspath(path) for path in found]


def main():
    """0: the same."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('before', type=os.path.abspath)
    parser.add_argument('after', type=os.path.abspath)
    parser.add_argument('paths', nargs='*')
    parser.add_argument('-j', dest='jobs', type=int, default=1)
    parser.add_argument('--tolerance', type=float, default=1e-12)
    parser.add_argument('--random', nargs=4, metavar=('PROGRAM', 'FIRST', 'LAST', 'SEED'))
    at = sys.argv.index('--') if '--' in sys.argv else len(sys.argv)
    given = parser.parse_intermixed_args(sys.argv[1:at])
    given.options = sys.argv[at + 1:]
    decks = decks_of(given.paths)
    if given.random:
        given.random[0] = os.path.abspath(given.random[0])
        decks += [str(k) for k in range(int(given.random[1]), int(given.random[2]) + 1)]
    different = 0
    with tempfile.TemporaryDirectory() as given.folder, multiprocessing.Pool(given.jobs) as pool:
        for deck, words in pool.imap(compare, [(deck, given) for deck in decks]):
            if words:
                different += 1
                print(f'{deck}: {words}', flush=True)
    print(f'{len(decks)} decks, {different} of them not the same')
    return 1 if different or not decks else 0


if __name__ == '__main__':
    sys.exit(main())
