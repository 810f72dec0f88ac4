"""The judge of curved scenes must notice: curved_must_fail.py ATRITO

A roller that a load presses on a flat, free to roll, a pin with friction and a slider are solved by ATRITO and accepted. Then one
number of one table is changed at a time, or a message, and the judge must say so. The statics of smooth shapes must know what stands
from what does not, by closed form; and run_curved_scenes.py must end with 1 on programs that lie.
"""

import math
import os
import shutil
import stat
import subprocess
import sys

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import curved_judge
import curved_scenes
import curved_statics as statics
from judge_must_fail import FAILED, Table, expect

SEED = 3
ROLLER, PIN, SLIDER = 25, 196, 236
MOVES = 94  # which nothing balances
FOLDER = 'curved-must-fail'


class Case:
    def __init__(self, atrito, number):
        self.scene = curved_scenes.make(number, SEED)
        self.folder = os.path.join(FOLDER, str(number))
        os.makedirs(FOLDER, exist_ok=True)
        self.said = self.solve(atrito, self.folder, False)
        self.springs = self.folder + '-springs'
        self.said_with_springs = self.solve(atrito, self.springs, True)
        word, self.least = self.scene.balanced()
        expect(f'scene {number} balances', word == 'yes')
        expect(f'scene {number} is accepted', not self.verdict().wrong)

    def solve(self, atrito, folder, with_springs):
        path = folder + '.inp'
        with open(path, 'w') as file:
            file.write(self.scene.deck(with_springs))
        done = subprocess.run([atrito, path, '-o', folder, '--digits', '17', '--quiet'], capture_output=True, text=True, check=False)
        expect(f'{path} is solved', done.returncode == 0)
        return done.stderr

    def verdict(self, said=None):
        verdict = curved_judge.judge_run(self.scene, self.folder, self.said if said is None else said, self.least)
        if not any(pair.nu for pair in self.scene.pairs):
            curved_judge.compare_with_springs(self.scene, verdict, self.springs, self.said_with_springs)
        return verdict

    def notices(self, what, name, column, change, choose, word, springs=False):
        """One row of a table with another value: the judge's reason has the word."""
        table = Table(os.path.join(self.springs if springs else self.folder, name))
        i = next(table.rows(choose))
        table.write(table.with_value(i, column, repr(float(change(table.value(i, column))))))
        wrong = self.verdict().wrong
        table.write(table.lines)
        expect(f'{what}: {wrong[0] if wrong else "nothing"}', any(word in reason for reason in wrong))


def tables_must_be_right(atrito):
    roller, pin, slider = (Case(atrito, number) for number in (ROLLER, PIN, SLIDER))
    body = roller.scene.bodies[0]
    inner = body.first + 1 + min(set(range(len(body.mesh.x))) - set(body.mesh.side_nodes('OUTSIDE')))
    largest = max(np.abs(u).max() for u in curved_judge.Tables(roller.scene, roller.folder).u)
    most = curved_judge.Tables(roller.scene, roller.folder).contact['pressure'].max()
    pushes = lambda row: row['pressure'] > 0.5*most
    roller.notices('a node inside', 'nodes.tab', 'u1', lambda u: u + 1e-4*largest, lambda row: row['node'] == inner, 'equilibrium')
    roller.notices('a pressure', 'contact.tab', 'pressure', lambda p: 1.001*p, pushes, 'sum of pressures')
    roller.notices('tension', 'contact.tab', 'pressure', lambda p: -p, pushes, 'tension')
    roller.notices('a gap', 'contact.tab', 'gap', lambda gap: gap + 1e-3*largest, pushes, 'gap under pressure')
    roller.notices('an overlap', 'contact.tab', 'gap', lambda gap: -1e-3*largest, lambda row: row['pressure'] == 0, 'penetration')
    roller.notices('a pressure with springs', 'contact.tab', 'pressure', lambda p: 1.2*p, pushes, 'pressure with springs', True)
    roller.notices('a displacement with springs', 'nodes.tab', 'u1', lambda u: u + 0.2*largest, lambda row: row['node'] == inner,
                   'displacement with springs', True)
    expect('no W-IDLE', any('W-IDLE' in reason for reason in roller.verdict('').wrong))
    pin.notices('shear without friction enough', 'contact.tab', 'shear', lambda t: 3*abs(t) + 1.0, lambda row: row['pressure'] > 0,
                'friction bound')
    pin.notices('a reaction', 'reactions.tab', 'r1', lambda r: r + 1e-2*pin.least, lambda row: True, 'reaction')
    idle_must_be_least(slider)
    nothing_may_hold_what_is_free(slider)


def idle_must_be_least(case):
    """The slider moved along its guides: all forces are the same."""
    table = Table(os.path.join(case.folder, 'nodes.tab'))
    along = case.scene.q @ [1.0, 0.0]
    body = case.scene.bodies[0]
    lines = list(table.lines)
    for i in table.rows(lambda row: body.first < row['node'] <= body.first + len(body.mesh.x)):
        words = lines[i].split()
        for name, part in zip(('u1', 'u2'), along):
            k = table.columns.index(name)
            words[k] = repr(float(words[k]) + float(0.1*case.scene.size*part))
        lines[i] = ' '.join(words)
    table.write(lines)
    wrong = case.verdict().wrong
    table.write(table.lines)
    expect(f'an idle motion: {wrong[0] if wrong else "nothing"}', any('idle motion' in reason for reason in wrong))


def nothing_may_hold_what_is_free(case):
    """W-IDLE of a slider whose end is held."""
    body = case.scene.bodies[0].mesh
    case.scene.hold(0, list(body.side_nodes('LEFT')))
    wrong = case.verdict().wrong
    case.scene.supports.pop()
    expect('W-IDLE of a body that is held', any('no motion is free' in reason for reason in wrong))


def statics_must_be_right():
    """A pin in a hole: no moment without friction. A block on a flat: by its edge, and by the angle of friction."""
    frame = statics.Frame([np.zeros(2)], [1.0])
    normals = [np.array([math.cos(angle), math.sin(angle)]) for angle in 2*math.pi*np.arange(720)/720]
    columns = [column for n in normals for column in statics.rays(frame, 0, None, n, n, 0.0)]
    for moment, stands in ((0.0, True), (1e-3, False)):
        left, force = statics.balance(columns, [], frame.moment(0, np.array([0.6, -0.8]), moment, np.zeros(2)))
        expect(f'a pin with a moment of {moment}: {left:.1e} left', (left < 1e-4) == stands)
        if stands:
            expect('what pushes it is the load', abs(force - 1.0) < 1e-4)
    down = np.array([0.0, -1.0])
    columns = [column for x in np.linspace(-1, 1, 41) for column in statics.rays(frame, 0, None, np.array([x, -0.5]), down, 0.0)]
    for at, stands in ((0.98, True), (1.02, False)):
        left, _ = statics.balance(columns, [], frame.moment(0, down, 0.0, np.array([at, 0.0])))
        expect(f'a block loaded at {at} of its half width', (left < 1e-4) == stands)
    rough = [column for x in np.linspace(-1, 1, 41) for column in statics.rays(frame, 0, None, np.array([x, -0.5]), down, 0.3)]
    for across, stands in ((0.29, True), (0.31, False)):
        left, _ = statics.balance(rough, [], frame.moment(0, np.array([across, -1.0]), 0.0, np.array([0.0, -0.5])))
        expect(f'a block with nu 0.3, pushed by {across} of its weight', (left < 1e-4) == stands)
    free, _ = statics.free_motions(columns, [], 3)
    expect('a block on a flat slides', free.shape[1] == 1 and abs(abs(free[0, 0]) - 1) < 1e-9)


def liars_must_be_caught(atrito):
    """Programs that keep W-IDLE to themselves, and that find no equilibrium anywhere."""
    for name, text in (('silent', f'#!/bin/sh\nexec {atrito} "$@" 2>/dev/null\n'), ('refuses', '#!/bin/sh\nexit 4\n'),
                       ('accepts', f'#!/bin/sh\n{atrito} "$@"\nexit 0\n')):
        path = os.path.join(FOLDER, name)
        with open(path, 'w') as file:
            file.write(text)
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        runner = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'run_curved_scenes.py')
        done = subprocess.run([sys.executable, runner, os.path.abspath(path), '1', '500', str(SEED), '--only', f'{ROLLER},{MOVES}',
                               '--folder', os.path.join(FOLDER, 'runs')], capture_output=True, text=True, check=False)
        expect(f'a program that {name}: ' + ' '.join(done.stdout.split('\n')[0].split()[:4]), done.returncode == 1)


def main():
    atrito = os.path.abspath(sys.argv[1])
    shutil.rmtree(FOLDER, ignore_errors=True)
    statics_must_be_right()
    tables_must_be_right(atrito)
    liars_must_be_caught(atrito)
    return 1 if FAILED else 0


if __name__ == '__main__':
    sys.exit(main())
