"""The relations must notice: relations_must_fail.py ATRITO RANDOM_SCENES

Scenes whose relations hold are run with programs that lie a little: one changes the last digits of a displacement, a pressure, a
shear, a slip where an option or a card of the other deck is seen; one ends with another exit code; one keeps W-IDLE to itself. And
a relation that goes back the wrong way must not hold: a mirrored shear with its sign, units that are not turned back.
"""

import os
import random
import shutil
import stat
import subprocess
import sys

sys.dont_write_bytecode = True  # the sources stay as they are
import deck_relations as relations
import run_relations
from deck_relations import Back, Deck
from judge_must_fail import FAILED, expect

FOLDER = 'relations-must-fail'
# changes one number of a table by a part of 1e-6 where the words given stand in the command line or the deck
LIAR = '''#!{python}
import os, subprocess, sys
done = subprocess.run([{atrito!r}, *sys.argv[1:]], capture_output=True, text=True)
text = open(sys.argv[1]).read()
sys.stdout.write(done.stdout)
sees = {sees!r} in ' '.join(sys.argv) or {sees!r} in text
hidden = {{'idle': 'W-IDLE', 'digits': 'differences of coordinates'}}.get({table!r}, 'nothing of the kind')
sys.stderr.write(done.stderr.replace(hidden, 'something else') if sees else done.stderr)
path = os.path.join(sys.argv[sys.argv.index('-o') + 1], {table!r} + '.tab')
if sees and os.path.exists(path):
    lines = open(path).read().split('\\n')
    names = [line for line in lines if line.startswith('# columns:')][0].split()[2:]
    k = names.index({column!r})
    rows = [i for i, line in enumerate(lines) if line and line[0] != '#']
    i = max(rows, key=lambda i: abs(float(lines[i].split()[k])))
    words = lines[i].split()
    words[k] = repr(float(words[k])*(1 + {change}))
    lines[i] = ' '.join(words)
    open(path, 'w').write('\\n'.join(lines))
sys.exit({code} if {code} and {quits!r} in ' '.join(sys.argv) else done.returncode)
'''
# (seed, number) of scenes whose relations hold; of the last one W-IDLE is told
SCENES = {'plain': (1, 6), 'history': (1, 52), 'idle': (1, 215), 'digits': (20290223, 24), 'at rest': (20290601, 72),
          'small overlap': (20290611, 51), 'digits of a body': (20290622, 21), 'shears': (20290622, 141)}

# of turned and mirrored decks of the last two
TURNED, MIRRORED = 'START, -0.7083911501', 'START, -0.00025498531946'


def program(atrito, name, sees, table='none', column='', change=1e-6, code=0, quits='--threads'):
    path = os.path.abspath(os.path.join(FOLDER, name))
    with open(path, 'w') as file:
        file.write(LIAR.format(python=sys.executable, atrito=atrito, sees=sees, table=table, column=column, change=change, code=code,
                               quits=quits))
    os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
    return path


def relate(atrito, generator, seed, number, which, *options):
    runner = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'run_relations.py')
    done = subprocess.run([sys.executable, runner, atrito, generator, str(number), str(number), str(seed), '--which', which, '--folder',
                           os.path.join(FOLDER, 'runs'), *options], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout.split('\n')[0]


def liars_must_be_caught(atrito, generator):
    all_of_them = ','.join(run_relations.RELATIONS)
    for (seed, number), which in ((SCENES['plain'], all_of_them), (SCENES['history'], all_of_them),
                                  (SCENES['idle'], 'quarter turn,mirror,threads,banded,dense form'),
                                  (SCENES['digits'], 'mirror'), (SCENES['at rest'], 'turn'), (SCENES['small overlap'], 'banded'),
                                  (SCENES['digits of a body'], 'turn'), (SCENES['shears'], 'mirror')):
        code, said = relate(atrito, generator, seed, number, which)
        expect(f'scene {number} of seed {seed} holds: {said}', code == 0)
    for what, sees, table, column, which, scene in (
            ('a displacement with --threads', '--threads', 'nodes', 'u1', 'threads', 'plain'),
            ('a reaction with --solver', '--solver banded', 'reactions', 'r2', 'banded', 'idle'),
            ('a pressure with --contact', '--contact dense', 'contact', 'pressure', 'dense form', 'idle'),
            ('a weight', '--contact dense', 'contact', 'weight', 'dense form', 'idle'),
            ('a displacement begun again', '--restart', 'nodes', 'u2', 'restart', 'history'),
            ('a pressure by more than its digits', 'START, 3.385724587', 'contact', 'pressure', 'mirror', 'digits'),
            ('a pressure by more than its digits, of a solver', '--solver banded', 'contact', 'pressure', 'banded', 'small overlap'),
            ('a displacement of round-off that is none', '*TRANSFORM', 'nodes', 'u1', 'turn', 'at rest'),
            ('a pressure by more than the digits of a body', TURNED, 'contact', 'pressure', 'turn', 'digits of a body'),
            ('a pressure by more than the digits of shears', MIRRORED, 'contact', 'pressure', 'mirror', 'shears')):
        path = program(atrito, 'liar', sees, table, column, {'digits': 10.0, 'at rest': 1e12, 'small overlap': 10.0,
                                                             'digits of a body': 1e-3, 'shears': 0.1}.get(scene, 1e-6))
        code, said = relate(path, generator, *SCENES[scene], which)
        expect(f'{what}: {said[:100]}', code == 1)
    path = program(atrito, 'liar', '--threads', 'stress', 's12')
    expect('a stress', relate(path, generator, 5, 19, 'threads', '--mixed')[0] == 1)
    code, said = relate(atrito, generator, 20290635, 18, 'banded', '--mixed')
    expect(f'stresses of a body that moves without strain are round-off: {said}', code == 0)
    path = program(atrito, 'liar', '--solver banded', 'stress', 's11', 1e12)
    expect('a stress of round-off that is none', relate(path, generator, 20290635, 18, 'banded', '--mixed')[0] == 1)
    path = program(atrito, 'quits', '--threads', code=3)
    expect('another exit code', relate(path, generator, *SCENES['plain'], 'threads')[0] == 1)
    path = program(atrito, 'quits', 'shaken.inp', 'contact', 'pressure', code=3)
    code, said = relate(path, generator, *SCENES['plain'], 'threads')
    expect(f'friction that the last digits move is no solution, so another exit code says nothing: {said}', code == 0)
    path = program(atrito, 'silent', 'START, 3.385724587', 'digits')
    expect('digits that are not told', relate(path, generator, *SCENES['digits'], 'mirror')[0] == 1)
    path = program(atrito, 'silent', MIRRORED, 'digits')
    expect('digits of shears that are not told', relate(path, generator, *SCENES['shears'], 'mirror')[0] == 1)
    path = program(atrito, 'silent', '--threads', 'idle')
    expect('W-IDLE in one only', relate(path, generator, *SCENES['idle'], 'threads')[0] == 1)


def ways_back_must_count(atrito, generator):
    """The other deck's tables as they are, not turned back."""
    class Settings:
        options = []
    Settings.atrito, Settings.generator, Settings.seed = atrito, generator, SCENES['plain'][0]
    deck = Deck(run_relations.deck_of(Settings, SCENES['plain'][1])[1])
    first = run_relations.Result(Settings, deck.text(), FOLDER, 'first')
    for name in ('mirror', 'quarter turn', 'units', 'renumbered'):
        other, back = run_relations.OTHER_DECKS[name](deck, random.Random(1))
        second = run_relations.Result(Settings, other.text(), FOLDER, 'second')
        part, _ = run_relations.largest_difference(first, second, back)
        wrong, where = run_relations.largest_difference(first, second, Back())
        expect(f'{name}: {part:.1e}, and {wrong:.1e} ({where}) without going back', part < 1e-9 < wrong)
    class Unmirrored(Back):
        hand = 1.0
    other, back = relations.mirror(deck, None)
    second = run_relations.Result(Settings, other.text(), FOLDER, 'second')
    wrong, where = run_relations.largest_difference(first, second, Unmirrored(back.q))
    expect(f'slip of a mirrored deck with its sign: {wrong:.1e} ({where})', wrong > 0.1)


def main():
    atrito, generator = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    liars_must_be_caught(atrito, generator)
    ways_back_must_count(atrito, generator)
    return 1 if FAILED else 0


if __name__ == '__main__':
    sys.exit(main())
