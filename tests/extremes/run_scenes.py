"""Runs random scenes and judges what atrito says of them.

run_scenes.py ATRITO RANDOM_SCENES FIRST LAST SEED [-j N] [--folder DIR] [--most-unsolved N] [--known FILE] [--only N,N,..] [options of atrito]

Right is exit 0 with tables that judge.py accepts, exit 4 where no admissible forces balance the loads, and exit 3 where no other
method or form solves the deck. A deck that ends with exit 3 is tried with the other METHODs and, where the program knows --contact,
with both forms. Prints the decks that are not right with the reason, and the sums; DIR (./scenes) keeps their decks and, in
results.txt, a row a deck. Exit code 0 when nothing is wrong and at most --most-unsolved decks (default: 1 in 1,000) are unsolved
that another method solves. --known: numbers of decks, one a line, that may be wrong; one that is right then is told. --only: these
decks, each of which must be solved or proved to have no equilibrium: exit 3 is wrong for them.
"""

import argparse
import multiprocessing
import os
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # the sources stay as they are
import judge
from scene_reader import read_deck

METHODS = ('METHOD=PICARD, MAXIT=1000', 'METHOD=PICARD, RELAXATION=0.3, MAXIT=3000', 'METHOD=NEWTON', 'METHOD=ANDERSON, MAXIT=500')
LONGEST = 300  # seconds


class Deck:
    """What came of one deck."""

    def __init__(self, number):
        self.number = number
        self.code = None
        self.seconds = 0.0
        self.word = ''       # solved, unsolved, certified, wrong
        self.reason = ''
        self.kind = ''


def run(program, deck, folder, options):
    """Exit code (None: took too long), what was said, seconds."""
    shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    try:
        done = subprocess.run([program, deck, '-o', folder, '--digits', '17', '--quiet', *options], capture_output=True,
                              text=True, errors='replace', timeout=LONGEST, check=False)
        return done.returncode, done.stdout + done.stderr, time.monotonic() - begin
    except subprocess.TimeoutExpired:
        return None, '', time.monotonic() - begin


def message(said):
    """The program's error, as one short line."""
    lines = [line for line in said.splitlines() if ' error ' in line] or said.splitlines()[-1:] or ['']
    return lines[0].rpartition('deck.inp')[2].lstrip(': ')[:260]


def judge_deck(work):
    """Runs and judges one deck in a folder of its own."""
    settings, number = work
    deck = Deck(number)
    base = os.path.join(settings.folder, str(os.getpid()))
    os.makedirs(base, exist_ok=True)
    path, folder = os.path.join(base, 'deck.inp'), os.path.join(base, 'out')
    text = subprocess.run([settings.generator, str(number), str(settings.seed)], capture_output=True, text=True, check=True).stdout
    with open(path, 'w') as file:
        file.write(text)
    deck.kind = text.splitlines()[1].rpartition(': ')[2]
    deck.code, said, deck.seconds = run(settings.atrito, path, folder, settings.options)
    try:
        give_verdict(settings, deck, text, base, folder, said)
    except Exception as trouble:  # a fault of the judge must not stop the others
        deck.word, deck.reason = 'wrong', f'the judge failed: {trouble!r}'
    if deck.word != 'solved' and not (deck.word == 'certified' and deck.code == 4):
        shutil.copy(path, os.path.join(settings.folder, f'{number}.inp'))
    return deck


def give_verdict(settings, deck, text, base, folder, said):
    if deck.code == 0:
        verdict = judge.judge_solution(read_deck(text), folder)
        deck.word, deck.reason = ('wrong' if verdict.wrong else 'solved'), verdict.text()
    elif deck.code == 4:
        word, z = judge.judge_feasibility(read_deck(text))
        deck.word = 'certified' if word == 'infeasible' else 'wrong'
        deck.reason = f'{word} {z:.1e}: {message(said)}'
    elif deck.code == 3:
        word, _ = judge.judge_feasibility(read_deck(text))
        other = solved_by(settings, text, base)
        deck.word = 'unsolved' if other else 'certified' if word == 'infeasible' else 'open'
        deck.reason = f'{word}, ' + (f'solved by {other}: ' if other else 'solved by nothing: ') + message(said)
    else:
        deck.word = 'wrong'
        deck.reason = 'takes too long' if deck.code is None else message(said)


def solved_by(settings, text, base):
    """The first other method or form that solves a deck, or nothing."""
    path, folder = os.path.join(base, 'other.inp'), os.path.join(base, 'other')
    for method in ('', *METHODS):
        with open(path, 'w') as file:
            file.write(text.replace('*STATIC\n', f'*STATIC\n*CONTROLS, {method}\n') if method else text)
        for form in settings.forms:
            if not method and not form:
                continue
            code, _, _ = run(settings.atrito, path, folder, settings.options + form)
            if code == 0 and not judge.judge_solution(read_deck(text), folder).wrong:
                return ' '.join([method, *form]).strip()
    return ''


def runner_arguments(usage, folder):
    """What all runners of random decks take."""
    parser = argparse.ArgumentParser(usage=usage)
    parser.add_argument('atrito')
    parser.add_argument('generator')
    parser.add_argument('first', type=int)
    parser.add_argument('last', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('-j', type=int, default=1, dest='jobs')
    parser.add_argument('--folder', default=folder)
    parser.add_argument('--only', default=None)
    return parser


def chosen_numbers(settings):
    chosen = range(settings.first, settings.last + 1)
    if settings.only:
        chosen = [number for number in map(int, settings.only.split(',')) if number in chosen]
    return chosen


def read_settings():
    parser = runner_arguments(__doc__, 'scenes')
    parser.add_argument('--most-unsolved', type=int, default=None)
    parser.add_argument('--known', default=None)
    settings, settings.options = parser.parse_known_args()
    usage = subprocess.run([settings.atrito, '--help'], capture_output=True, text=True, check=False).stdout
    settings.forms = [[]]
    if '--contact' in usage and '--contact' not in settings.options:
        settings.forms += [['--contact', 'dense'], ['--contact', 'sparse']]
    return settings


def all_decks(settings):
    numbers = [(settings, number) for number in chosen_numbers(settings)]
    if settings.jobs == 1:
        yield from map(judge_deck, numbers)
        return
    with multiprocessing.Pool(settings.jobs) as pool:
        yield from pool.imap(judge_deck, numbers)


def known_numbers(path):
    if path is None:
        return set()
    with open(path) as lines:
        return {int(line.split()[0]) for line in lines if line.strip() and not line.startswith('#')}


def summary(decks, seconds):
    def count(word, code=None):
        return sum(deck.word == word and code in (None, deck.code) for deck in decks)

    solvable = count('solved') + count('unsolved')
    slowest = sorted(decks, key=lambda deck: -deck.seconds)[:5]
    return [f'{len(decks)} decks: {count("solved")} solved, {count("certified", 4)} exit 4 certified, '
            f'{sum(deck.code == 3 for deck in decks)} exit 3 ({count("unsolved")} solved by another method or form, '
            f'{count("certified", 3)} without equilibrium), {count("wrong")} wrong',
            f'{1000*count("unsolved")/max(solvable, 1):.2f} in 1,000 of the decks that can be solved are not; '
            f'{seconds:.0f} s, the program alone {sum(deck.seconds for deck in decks):.0f} s; slowest: '
            + ', '.join(f'{deck.number} ({deck.seconds:.1f} s)' for deck in slowest)]


def main():
    os.environ['OMP_NUM_THREADS'] = os.environ['OPENBLAS_NUM_THREADS'] = '1'
    settings = read_settings()
    os.makedirs(settings.folder, exist_ok=True)
    known = known_numbers(settings.known)
    begin = time.monotonic()
    decks = []
    with open(os.path.join(settings.folder, 'results.txt'), 'w') as rows:
        for deck in all_decks(settings):
            decks.append(deck)
            code = 'none' if deck.code is None else deck.code
            rows.write(f'{deck.number} {code} {deck.word} {deck.seconds:.3f} "{deck.kind}" {deck.reason}\n')
            rows.flush()
            if deck.word in ('wrong', 'unsolved', 'open'):
                print(f'deck {deck.number} ({deck.kind}): exit {code}, {deck.word}: {deck.reason}', flush=True)
    for name in os.listdir(settings.folder):
        path = os.path.join(settings.folder, name)
        if os.path.isdir(path) and name.isdigit():
            shutil.rmtree(path)
    print('\n'.join(summary(decks, time.monotonic() - begin)))
    unexpected = [deck.number for deck in decks if deck.word == 'wrong' and deck.number not in known]
    mended = [deck.number for deck in decks if deck.word not in ('wrong', 'unsolved') and deck.number in known]
    if mended:
        print('known to be wrong, and right now:', *mended)
    if settings.only:
        unexpected += [deck.number for deck in decks if deck.code == 3]
    unsolved = [deck.number for deck in decks if deck.word == 'unsolved' and deck.number not in known]
    most = settings.most_unsolved
    if most is None:
        most = sum(deck.word in ('solved', 'unsolved') for deck in decks)//1000
    return 1 if unexpected or len(unsolved) > most else 0


if __name__ == '__main__':
    sys.exit(main())
