"""The judge of histories must notice: histories_must_fail.py ATRITO RANDOM_SCENES

Takes histories of seed 11 that are solved and in which friction slips and sticks, and changes one number of an increment behind the
first: shear, slip and pressure of a point, dissipation, a displacement, a time.
"""

import copy
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True  # the sources stay as they are
import run_histories
from histories import History
from run_scenes import run
from scene_reader import read_deck

MOST = 60   # scenes that are looked at
CHANGES = (('contact', 'shear', 1.001), ('contact', 'slip', 1.001), ('contact', 'pressure', 1.001), ('contact', 'slip_increment', 1.001),
           ('history', 'dissipation', 1.001), ('history', 'time', 0.1), ('nodes', 'u1', 1.001))


def change(folder, name, column, factor):
    """Multiplies the number of the largest size in the rows of the second increment of the first step; whether there is one."""
    path = os.path.join(folder, name + '.tab')
    if not os.path.exists(path):
        return False
    with open(path) as file:
        lines = file.read().splitlines()
    names = next(line.split()[2:] for line in lines if line.startswith('# columns:'))
    best, size = None, 0.0
    for i, line in enumerate(lines):
        row = dict(zip(names, line.split()))
        if line.startswith('#') or row['step'] != '1' or row['increment'] != '2':
            continue
        value = abs(float(row[column]))
        if not math.isnan(value) and value > size:
            best, size = i, value
    if best is None:
        return False
    words = lines[best].split()
    words[names.index(column)] = repr(float(words[names.index(column)])*factor)
    lines[best] = ' '.join(words)
    with open(path, 'w') as file:
        file.write('\n'.join(lines) + '\n')
    return True


def main():
    program, generator = sys.argv[1:3]
    left = set(CHANGES)
    missed = []
    for number in range(1, MOST + 1):
        text = subprocess.run([generator, str(number), '11'], capture_output=True, text=True, check=True).stdout
        scene = read_deck(text)
        history = History(text, number, 11, scene)
        scene = read_deck(history.head + '*STEP\n' + text.partition('*STEP\n')[2])
        with open('fail.inp', 'w') as file:
            file.write(history.deck)
        for name in sorted(left):
            if run(program, 'fail.inp', 'fail', [])[0] != 0 or not change('fail', *name):
                continue
            left.discard(name)
            if not run_histories.judge_history(history, copy.deepcopy(scene), 'fail')[0].wrong:
                missed.append((number, *name))
        if not left:
            break
    for what in missed:
        print('not noticed: history', *what)
    for what in left:
        print('no history has', *what)
    return 1 if missed or left else 0


if __name__ == '__main__':
    sys.exit(main())
