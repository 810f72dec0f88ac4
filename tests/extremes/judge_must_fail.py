"""The judge must notice: judge_must_fail.py ATRITO [RANDOM_SCENES]

A base with two punches, the second loaded 1e-7 of the first, is solved by ATRITO and accepted by the judge. Then one number of one
table is changed at a time, by little for the pair or the body that it belongs to, and the judge must say so. The linear programme
must know blocks that stand from blocks that slide or tip over, by closed form, also beside loads 1e9 times theirs. With the
generator as second argument: run_scenes.py must end with 1 on a program that lies.
"""

import os
import shutil
import stat
import subprocess
import sys

sys.dont_write_bytecode = True  # the sources stay as they are
import judge
from scene_reader import read_deck

BLOCK = '*BLOCK, TYPE={kind}, ELSET={name}, NX={nx}, NY={ny}\n{x0}, {y0}\n{x1}, {y0}\n{x1}, {y1}\n{x0}, {y1}\n' \
        '*MATERIAL, NAME=M-{name}\n*ELASTIC\n{e}, 0.2\n*SOLID SECTION, ELSET={name}, MATERIAL=M-{name}\n1.\n'
PAIR = '*SURFACE INTERACTION, NAME={name}\n*FRICTION{law}\n*CONTACT PAIR, INTERACTION={name}, QUADRATURE=NODAL\n{slave}, {master}\n'
FLOOR = '*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -9., 0.\nLINE, 9., 0.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR\n'
SOFT = '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n100.\n'
END = '*NODE PRINT\nU, RF\n*END STEP\n'


def block(name, x0, y0, x1, y1, nx=4, ny=2, kind='CPS4', e='1000.'):
    return BLOCK.format(name=name, kind=kind, x0=x0, y0=y0, x1=x1, y1=y1, nx=nx, ny=ny, e=e)


def punches():
    return ('*HEADING\na strong and a weak pair\n' + block('B1', 0., 0., 3., 0.5, 12)
            + block('B2', 0.25, 0.5, 1.25, 1., kind='CPS9') + block('B3', 1.75, 0.5, 2.75, 1.)
            + PAIR.format(name='P1', law='\n0.3', slave='B2-BOTTOM', master='B1-TOP')
            + PAIR.format(name='P2', law=', NONLOCAL\n0.3, 1e-13, 0.4', slave='B3-BOTTOM', master='B1-TOP')
            + '*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\n*DSLOAD\nB2-TOP, P, 1.\nB2-LEFT, P, 0.2\nB3-TOP, P, 1e-7\nB3-LEFT, P, 0.2e-7\n'
            + END)


class Table:
    """A table as text, one number of which is changed."""

    def __init__(self, path):
        self.path = path
        with open(path) as file:
            self.lines = file.read().splitlines()
        columns = [line for line in self.lines if line.startswith('# columns:')][0]
        self.columns = columns.split()[2:]

    def rows(self, choose=lambda row: True):
        for i, line in enumerate(self.lines):
            if not line.startswith('#') and choose(dict(zip(self.columns, map(float, line.split())))):
                yield i

    def value(self, i, column):
        return float(self.lines[i].split()[self.columns.index(column)])

    def with_value(self, i, column, text):
        words = self.lines[i].split()
        words[self.columns.index(column)] = text
        return self.lines[:i] + [' '.join(words)] + self.lines[i + 1:]

    def write(self, lines):
        with open(self.path, 'w') as file:
            file.write('\n'.join(lines) + '\n')


FAILED = []


def expect(what, good):
    print(('ok: ' if good else 'FAILED: ') + what)
    if not good:
        FAILED.append(what)


def notices(what, deck, folder, table, lines, word=''):
    table.write(lines)
    verdict = judge.judge_solution(read_deck(deck), folder)
    table.write(table.lines)
    text = verdict.text()
    expect(f'{what} is noticed ({text[:90]})', text.startswith('violated') and any(word in reason for _, reason in verdict.wrong))


def tables_must_be_right(atrito):
    deck, folder = punches(), 'must-fail-out'
    with open('must-fail.inp', 'w') as file:
        file.write(deck)
    done = subprocess.run([atrito, 'must-fail.inp', '-o', folder, '--digits', '17', '--quiet'], check=False)
    verdict = judge.judge_solution(read_deck(deck), folder) if done.returncode == 0 else None
    expect('the scene is solved and accepted', verdict is not None and not verdict.wrong)
    if verdict is None or verdict.wrong:
        print('   ', done.returncode, verdict and verdict.text())
        return
    contact_must_be_right(deck, folder)
    bodies_must_be_right(deck, folder)


def contact_must_be_right(deck, folder):
    contact = Table(os.path.join(folder, 'contact.tab'))
    for pair, name in ((1, 'strong'), (2, 'weak')):
        rows = list(contact.rows(lambda row: row['pair'] == pair))
        pressed = [i for i in rows if contact.value(i, 'pressure') > 0]
        largest = {column: max(abs(contact.value(i, column)) for i in rows) for column in contact.columns}
        i = pressed[len(pressed)//2]
        for column, share, word in (('pressure', 1e-5, ''), ('shear', 1e-5, ''), ('weighted_pressure', 1e-9, 'weighted'),
                                    ('weight', 1e-9, 'weight')):
            changed = repr(contact.value(i, column) + share*largest[column])
            notices(f'{column} of the {name} pair, {share:g}', deck, folder, contact, contact.with_value(i, column, changed), word)
        slides = [j for j in pressed if contact.value(j, 'status') == 2]
        expect(f'the {name} pair slides somewhere', bool(slides))
        for j in slides[:1]:
            for factor, word in ((1 + 1e-6, 'friction bound'), (1 - 1e-6, 'friction at')):
                changed = repr(contact.value(j, 'shear')*factor)
                notices(f'{factor:.6f} of the bound of the {name} pair', deck, folder, contact, contact.with_value(j, 'shear', changed), word)
        # a pair that sticks in hard contact has gaps and slips of 0: its motion is that of the nodes
        move = 1e-5*motion_of(folder, pair)
        for column in ('gap', 'slip'):
            changed = repr(contact.value(i, column) + move)
            notices(f'{column} of the {name} pair, {move:.1e}', deck, folder, contact, contact.with_value(i, column, changed), column)
        notices(f'tension in the {name} pair', deck, folder, contact, contact.with_value(i, 'pressure', '-1e-30'), 'tension')
        notices(f'status in the {name} pair', deck, folder, contact, contact.with_value(i, 'status', '0'), 'status')
        notices(f'shear of the wrong sign in the {name} pair', deck, folder, contact,
                contact.with_value(i, 'shear', repr(-contact.value(i, 'shear'))))
    notices('a missing point', deck, folder, contact, contact.lines[:-1], 'points')
    notices('what is not a number', deck, folder, contact, contact.with_value(i, 'slip', 'NaN'), 'tables')


def motion_of(folder, pair):
    """The deformation of the punch of a pair: displacements without its mean."""
    nodes = Table(os.path.join(folder, 'nodes.tab'))
    body = [i for i in nodes.rows(lambda row: row['y'] >= 0.5 and (0.25 <= row['x'] <= 1.25 if pair == 1 else 1.75 <= row['x'] <= 2.75))]
    values = [nodes.value(i, 'u2') for i in body if nodes.value(i, 'y') > 0.5]
    return max(values) - min(values)


def bodies_must_be_right(deck, folder):
    nodes = Table(os.path.join(folder, 'nodes.tab'))
    for pair, name in ((1, 'strong'), (2, 'weak')):
        last = [i for i in nodes.rows(lambda row: row['y'] == 1.0 and (row['x'] < 1.5) == (pair == 1))][0]
        changed = repr(nodes.value(last, 'u2') + 1e-4*motion_of(folder, pair))
        notices(f'a displacement of the {name} body', deck, folder, nodes, nodes.with_value(last, 'u2', changed), 'equilibrium')
    first = list(nodes.rows())[0]
    notices('a support that moves', deck, folder, nodes, nodes.with_value(first, 'u1', '1e-9'), 'support')
    reactions = Table(os.path.join(folder, 'reactions.tab'))
    row = list(reactions.rows())[3]
    changed = repr(reactions.value(row, 'r2')*(1 + 1e-4))
    notices('a reaction', deck, folder, reactions, reactions.with_value(row, 'r2', changed), 'reaction')
    notices('a run that did not converge', deck, folder, nodes, ['# NOT CONVERGED', *nodes.lines], 'CONVERGED')


def one_block(push, law='\n0.3', height=0.5, weight=1.0, more=''):
    """A block 2 wide on a floor: pressure on its top, and a push at half its height."""
    return (block('B1', 0., 0., 2., height) + FLOOR + PAIR.format(name='P1', law=law, slave='B1-BOTTOM', master='FLOOR') + more
            + f'*STEP\n*STATIC\n*DSLOAD\nB1-TOP, P, {weight}\nB1-LEFT, P, {push}\n' + END)


def weak_block(push):
    """A block whose loads are 1e-9 of those of the block under it, pushed by a share of its own weight."""
    return (block('B1', 0., 0., 2., 0.5) + block('B2', 0., 0.5, 2., 1.) + FLOOR
            + PAIR.format(name='P1', law='\n0.3', slave='B1-BOTTOM', master='FLOOR')
            + PAIR.format(name='P2', law='\n0.3', slave='B2-BOTTOM', master='B1-TOP')
            + f'*STEP\n*STATIC\n*DLOAD\nB1, BY, -1.\nB1, BX, 0.1\n*DSLOAD\nB2-TOP, P, 1e-9\nB2-LEFT, P, {4e-9*push}\n' + END)


def clamped_block(slope):
    """A block without friction between two clamped ones, pushed to where the joint below it rises."""
    joint = '*BLOCK, TYPE=CPS4, ELSET={}, NX=2, NY=1\n0., {}\n1., {}\n1., {}\n0., {}\n*MATERIAL, NAME=M-{}\n*ELASTIC\n1000., 0.2\n' \
            '*SOLID SECTION, ELSET={}, MATERIAL=M-{}\n1.\n'
    rise = repr(0.5 + slope)
    return (joint.format('B1', 0., 0., rise, 0.5, 'B1', 'B1', 'B1') + joint.format('B2', 0.5, rise, 1., 1., 'B2', 'B2', 'B2')
            + joint.format('B3', 1., 1., 1.5, 1.5, 'B3', 'B3', 'B3')
            + PAIR.format(name='P1', law='\n0.', slave='B2-BOTTOM', master='B1-TOP')
            + PAIR.format(name='P2', law='\n0.', slave='B2-TOP', master='B3-BOTTOM')
            + '*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 1, 2\nB3-TOP, 1, 2\n*DSLOAD\nB2-LEFT, P, 1.\n' + END)


def hung_block(lowered, behaviour=''):
    """A block pushed to the side, 0.1 above a rough floor, its bottom lowered by its supports."""
    pair = PAIR.format(name='P1', law='\n0.3', slave='B1-BOTTOM', master='FLOOR').replace('*FRICTION', behaviour + '*FRICTION')
    return (block('B1', 0., 0.1, 2., 0.6) + FLOOR + pair
            + f'*STEP\n*STATIC\n*BOUNDARY\nB1-BOTTOM, 2, 2, {-lowered}\n*DSLOAD\nB1-LEFT, P, 1.\n' + END)


def programme_must_know():
    # N = 2 p, H = push height; it slides at H = nu N, tips over at H height/2 = N
    cases = [('a block that friction holds', one_block(1.19), 'feasible'),
             ('a block that slides', one_block(1.21), 'infeasible'),
             ('a block that slides by 1e-6', one_block(1.2*(1 + 1e-6)), 'infeasible'),
             ('a block that just holds', one_block(1.2*(1 - 1e-6)), 'feasible'),
             ('a tall block that stands', one_block(0.99*4/16, '\n9.', 4.), 'feasible'),
             ('a tall block that tips over', one_block(1.01*4/16, '\n9.', 4.), 'infeasible'),
             ('a block without friction', one_block(1e-6, '\n0.'), 'infeasible'),
             ('a block that is lifted', one_block(0., weight=-1.0), 'infeasible'),
             ('a block without load', one_block(0., weight=0.), 'feasible'),
             ('a weak block that friction holds', weak_block(0.299), 'feasible'),
             ('a weak block that slides', weak_block(0.301), 'infeasible'),
             # the whole average: 1/4 elements, all points within rho; friction of the mean pressure at all points
             ('an averaged law that holds', one_block(1.19, ', NONLOCAL\n0.3, 0., 90.'), 'feasible'),
             ('an averaged law that slides', one_block(1.21, ', NONLOCAL\n0.3, 0., 1e4'), 'infeasible'),
             # the constant of the whole line, for rho far beyond it: next to no friction
             ('a line kernel that does not reach', one_block(0.1, ', NONLOCAL, KERNEL=LINE\n0.3, 0., 1e4'), 'infeasible'),
             # the joint rises by round-off: no force that could be balances the push
             ('a joint that is level but for round-off', clamped_block(1e-15), 'infeasible'),
             ('a joint that rises by the tenth digit of its places', clamped_block(1e-10), 'infeasible'),
             ('a joint that rises by 1e-8', clamped_block(1e-8), 'feasible'),
             ('a block that supports hold above the floor', hung_block(0.0), 'infeasible'),
             ('a block that supports press upon the floor', hung_block(0.2), 'feasible'),
             ('a block that supports put on a hard floor', hung_block(0.1), 'feasible'),
             ('a block that supports put on a soft floor', hung_block(0.1, SOFT), 'infeasible'),
             ('a block that supports press upon a soft floor', hung_block(0.2, SOFT), 'feasible'),
             ('a supported block', one_block(100.).replace('*DSLOAD', '*BOUNDARY\nB1-RIGHT, 1\n*DSLOAD'), 'feasible')]
    for what, deck, word in cases:
        found, z = judge.judge_feasibility(read_deck(deck))
        expect(f'{what} is {word} ({found}, {z:.1e})', found == word)


def runner_must_notice(atrito, generator):
    """A program that answers each deck by the tables of the first one, or by exit 4, is found out."""
    here = os.path.dirname(os.path.abspath(__file__))
    for name, lie in (('tables of another deck', 'exit 0'), ('exit 4 for all', 'exit 4'), ('a crash', 'exit 139')):
        liar = os.path.abspath('liar.sh')
        with open(liar, 'w') as file:
            file.write('#!/bin/sh\n[ "$1" = --help ] && exit 0\nmkdir -p "$3"\n' + f'cp {os.path.abspath("must-fail-out")}/*.tab "$3"\n{lie}\n')
        os.chmod(liar, os.stat(liar).st_mode | stat.S_IXUSR)
        done = subprocess.run([sys.executable, os.path.join(here, 'run_scenes.py'), liar, generator, '1', '12', '11', '--folder', 'liar'],
                              capture_output=True, text=True, check=False)
        expect(f'{name}: found out', done.returncode == 1 and 'wrong' in done.stdout and ' 0 wrong' not in done.stdout)
    shutil.rmtree('liar', ignore_errors=True)


def main():
    tables_must_be_right(sys.argv[1])
    programme_must_know()
    if len(sys.argv) > 2:
        runner_must_notice(sys.argv[1], sys.argv[2])
    print(f'{len(FAILED)} failed')
    return 1 if FAILED else 0


if __name__ == '__main__':
    sys.exit(main())
