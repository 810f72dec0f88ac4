"""Random scenes: are linear quantities between their bounds?

    quantity_bounds.py ATRITO FROM TO SEED [--keep] [--times X] [--folder F]

One to three skew blocks on one another, pressed so that all of the contact is closed, without friction or stuck: then the problem with
the contact states held is the contact problem, and a mesh of second degree, 8 x as fine, tells the quantities. Scenes whose states
are others are left out. The sides are turned, and the units are others, in half of the scenes each. A row a quantity outside, and how wide the
bounds are. --times 0.2 makes them narrower: then some are outside.
"""

import argparse
import pathlib
import re
import shutil
import subprocess

import numpy as np

KINDS = ['CPE3', 'CPE4', 'CPE6', 'CPE8', 'CPE9', 'CPE4R', 'CPE8R', 'CPS4', 'CPS8']
DIGITS = 2e-3       # of the width of a bound: what the reference is off by


class Scene:
    def __init__(self, number, seed):
        rng = np.random.default_rng([seed, number])
        self.n = int(rng.choice([1, 2, 2, 3]))
        self.kind = str(rng.choice(KINDS))
        self.angle = 0.0 if rng.random() < 0.5 else float(rng.uniform(-np.pi, np.pi))
        self.length, self.force = (1.0, 1.0) if rng.random() < 0.5 else (10.0**rng.uniform(-3, 3), 10.0**rng.uniform(-6, 6))
        self.nu = float(rng.choice([0, 50, 50]))
        self.law = str(rng.choice(['stuck', 'nonlocal', 'slope']))
        self.delta = float(rng.choice([0, 0, 1e-6, 1e-3]))
        self.nx = int(rng.integers(3, 6))
        self.corners, y = [], 0.0
        left, right = 0.0, 2.0
        for i in range(self.n):
            height = float(rng.uniform(0.6, 1.2))
            lean = rng.uniform(-0.15, 0.15, 2)
            top = (left + lean[0], right + lean[1])
            self.corners.append([(left, y), (right, y), (top[1], y + height), (top[0], y + height)])
            left, right = top
            y += height
        self.ny = [int(rng.integers(2, 4)) for i in range(self.n)]
        self.young = 10.0**rng.uniform(1, 3, self.n)
        self.poisson = rng.uniform(0, 0.4, self.n)
        self.pressure = float(rng.uniform(1, 2))
        self.slope = float(rng.uniform(-0.2, 0.2))
        self.pull = float(rng.uniform(-0.15, 0.15))*(self.nu > 0 or self.n == 1)
        self.side = float(rng.uniform(-0.1, 0.1))*(self.nu > 0 or self.n == 1)
        self.weight = float(rng.choice([0, rng.uniform(0, 0.3)]))
        self.heat = float(rng.choice([0, 0, 1e-3]))

    def turn(self, x, y):
        c, s = np.cos(self.angle), np.sin(self.angle)
        return c*x - s*y, s*x + c*y

    def deck(self, kind):
        stress = self.force/self.length**2
        text = ['*HEADING', 'random blocks']
        for i, corners in enumerate(self.corners):
            text.append(f'*BLOCK, TYPE={kind}, ELSET=B{i}, NX={self.nx}, NY={self.ny[i]}')
            text += ['%.15g, %.15g' % self.turn(self.length*x, self.length*y) for x, y in corners]
        for i in range(self.n):
            text += [f'*MATERIAL, NAME=M{i}', '*ELASTIC', f'{self.young[i]*stress:.15g}, {self.poisson[i]:.15g}']
            if self.heat:
                text += ['*EXPANSION', '1.']
            text += [f'*SOLID SECTION, ELSET=B{i}, MATERIAL=M{i}', f'{0.7*self.length:.15g}']
        text += ['*SURFACE INTERACTION, NAME=I', '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY',
                 f'{self.delta*self.length/stress:.15g}']
        if self.nu and self.law == 'nonlocal':
            text += ['*FRICTION, NONLOCAL', f'{self.nu}, {0.02*self.length:.15g}, 0.']
        elif self.nu:
            text += ['*FRICTION', f'{self.nu}' + (f', {100*stress/self.length:.15g}' if self.law == 'slope' else '')]
        for i in range(1, self.n):
            text += ['*CONTACT PAIR, INTERACTION=I', f'B{i}-BOTTOM, B{i - 1}-TOP']
        text += ['*BOUNDARY', 'B0-BOTTOM, 1, 2']
        if self.nu == 0 and self.n > 1:                      # nothing slides away
            text += [f'B{i}-RIGHT, 1' for i in range(1, self.n)]
        text += ['*STEP', '*STATIC', '*DSLOAD']
        top = f'B{self.n - 1}-TOP'
        text += [f'{top}, P, {self.pressure*stress:.15g}']
        if self.pull:
            text += ['%s, TRVEC, %.15g, %.15g, %.15g' % (top, self.pull*stress, *self.turn(1, 0))]
        if self.side:
            text += [f'B{self.n - 1}-LEFT, P, {self.side*stress:.15g}']
        if self.weight:
            text += ['*DLOAD'] + ['B%d, GRAV, %.15g, %.15g, %.15g' % (i, self.weight*stress/self.length, *self.turn(0, -1))
                                  for i in range(self.n)]
            for i in range(self.n):
                k = text.index(f'*MATERIAL, NAME=M{i}')
                text[k + 1:k + 1] = ['*DENSITY', '1.']
        if self.heat:
            text += ['*TEMPERATURE'] + [f'B{i}, {self.heat:.15g}' for i in range(self.n)]
        return '\n'.join(text + ['*END STEP', ''])

    def quantities(self):
        last = self.n - 1
        found = {'top1': f'mean(u1, B{last}-TOP)', 'top2': f'mean(u2, B{last}-TOP)', 'body': f'3*mean(u2, B0)-mean(u1, B{last})',
                 'sx': f'mean(s11, B{last})', 'sy': 'mean(s22, B0)', 'sd': f'mean(s12, B{last})-mean(s22, B0)',
                 'rx': 'rf1(B0-BOTTOM)', 'ry': 'rf2(B0-BOTTOM)'}
        if self.n > 1:
            found.update(nn='normal_resultant(1)', tt='shear_resultant(1)', pp='mean(pressure, 1)')
        return found


def table(folder):
    values = {}
    for line in (folder/'summary.tab').read_text().splitlines():
        if line[:1] != '#':
            words = line.split()
            values.setdefault(words[2], []).append(float(words[3]))
    return values


def run(atrito, path, *options):
    return subprocess.run([atrito, str(path), *options], capture_output=True, text=True)


def judge(atrito, number, seed, times, work, counts, widths):
    scene = Scene(number, seed)
    if scene.nu == 0 and scene.n > 1:
        scene.angle = 0.0
    folder = work/str(number)
    folder.mkdir(parents=True, exist_ok=True)
    (folder/'coarse.inp').write_text(scene.deck(scene.kind))
    (folder/'fine.inp').write_text(scene.deck(scene.kind[:3] + '9'))
    options = []
    for name, text in scene.quantities().items():
        options += ['--observe', f'{name}={text}']
    coarse = run(atrito, folder/'coarse.inp', '-o', folder/'coarse', *options, '--bound', ','.join(scene.quantities()))
    fine = run(atrito, folder/'fine.inp', '-o', folder/'fine', '--refine', '3', '--proof', 'off', *options)
    for name, outcome in ('coarse', coarse), ('fine', fine):
        if outcome.returncode:
            counts['failed'] += 1
            print(number, name, outcome.returncode, outcome.stderr.strip().splitlines()[-1:])
            return
    bounds, truth = table(folder/'coarse'), table(folder/'fine')
    for found in bounds, truth:
        states = [sum(found.get(name, [0])) for name in ('open_points', 'stick_points', 'slip_points')]
        if states[0] or (states[1] if scene.nu == 0 else states[2]):
            counts['other states'] += 1
            return
    counts['scenes'] += 1
    for name in scene.quantities():
        least, most, true = bounds[name + '_least'][0], bounds[name + '_most'][0], truth[name][0]
        if not least <= most:
            counts['no bound'] += 1
            text = (folder/'coarse'/'coarse.lst').read_text()
            print(number, scene.kind, name, re.findall(rf'\n *{name} .*', text))
            continue
        counts['bounds'] += 1
        middle, half = (least + most)/2, (most - least)/2*times
        least, most = middle - half, middle + half
        if abs(true) > 0:
            widths.append((most - least)/abs(true))
        unit = {'s': scene.force/scene.length**2, 'p': scene.force/scene.length**2, 't': scene.length*0.01,
                'b': scene.length*0.01, 'r': scene.force, 'n': scene.force}[name[0]]
        if name == 'tt':
            unit = scene.force
        allowed = DIGITS*(most - least) + 1e-8*(abs(true) + unit)
        if name in ('sx', 'sy', 'sd'):        # the reference recovers stresses at nodes
            allowed += 1e-3*(abs(true) + unit)
        if not least - allowed <= true <= most + allowed:
            counts['outside'] += 1
            print('OUTSIDE', number, scene.kind, name, least, true, most)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('atrito')
    parser.add_argument('first', type=int)
    parser.add_argument('last', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('--keep', action='store_true')
    parser.add_argument('--times', type=float, default=1.0)
    parser.add_argument('--folder', default='quantity-bounds')
    asked = parser.parse_args()
    work, widths = pathlib.Path(asked.folder), []
    counts = dict.fromkeys(['scenes', 'bounds', 'outside', 'no bound', 'other states', 'failed'], 0)
    for number in range(asked.first, asked.last + 1):
        judge(asked.atrito, number, asked.seed, asked.times, work, counts, widths)
    print(counts, 'width over value: median %.2g, 90 %% %.2g' % tuple(np.quantile(widths or [0], [0.5, 0.9])))
    if not asked.keep:
        shutil.rmtree(work)
    raise SystemExit(1 if counts['outside'] or not counts['bounds'] else 0)


if __name__ == '__main__':
    main()
