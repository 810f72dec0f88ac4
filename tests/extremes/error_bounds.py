"""Random scenes of two to four bodies: is the bound of the error above the error?

    error_bounds.py ATRITO FROM TO SEED [-j N] [--pieces M] [--keep] [--only 3,5] [--reference ATRITO] [--times X]

Each scene is run with --proof on, and again on a mesh whose cells are cut into M x M elements of second degree; the energy of the
difference of both displacements is what the bound must not be below. A row a scene, and tables of the ratio of both. --times 0.5 halves the bounds: then they are below.
"""

import argparse
import collections
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np

from bound_meshes import Block, Mesh, SIDES, distance, elasticity

KINDS = ['3', '4', '6', '8', '9', '4R', '8R', '4B']
ALLOWED = 0.04      # of the error: the bound is for the friction bound of the run, the reference has its own


class Scene:
    def __init__(self, number, seed):
        rng = self.rng = np.random.default_rng([seed, number])
        self.number = number
        self.n = int(rng.choice([2, 2, 2, 3, 3, 4]))
        self.kinds = [str(rng.choice(KINDS))]*self.n
        if rng.random() < 0.1:
            self.kinds = [str(k) for k in rng.choice(KINDS, self.n)]
        self.is_plane_stress = rng.random() < 0.2
        self.is_matching = rng.random() > 0.4
        self.is_free = rng.random() < 0.3
        self.young = 10.0**rng.uniform(0, 3, self.n)
        self.poisson = np.where(rng.random(self.n) < 0.05, 0.49, rng.uniform(0, 0.45, self.n))
        self.thickness = np.where(rng.random() < 0.9, np.ones(self.n), rng.uniform(0.5, 2, self.n))
        self.nu = float(rng.choice([0, rng.uniform(0, 0.5), rng.uniform(0, 2)], p=[0.35, 0.45, 0.2]))
        size = 1/self.young.min()
        self.delta = size*float(rng.choice([0, 10.0**rng.uniform(-9, -3)], p=[0.35, 0.65]))
        self.eps = size*float(rng.choice([0, 10.0**rng.uniform(-6, -3)]))
        self.is_local = rng.random() < 0.3
        self.angle = 0.0 if rng.random() < 0.6 else float(rng.uniform(-np.pi, np.pi))
        self.has_heat = rng.random() < 0.15
        self.is_on_slave = rng.random() < 0.5
        self.roughness = float(rng.choice([0, 0.1]))
        self.quadrature = str(rng.choice(['', 'NODAL', 'MORTAR'], p=[0.7, 0.15, 0.15]))
        if self.angle != 0 and self.n > 2:
            self.is_free = False
        self.make_blocks(rng)
        self.make_loads(rng, size)

    def make_blocks(self, rng):
        """A stack, or several blocks side by side upon one; pairs are (upper, lower, side of the upper, side of the lower)."""
        self.blocks, self.pairs, self.gap = [], [], []
        self.is_stack = self.n == 2 or rng.random() < 0.6 and self.angle == 0
        grid = 0.5 if self.is_stack else 0.4
        y, x0, width = 0.0, 0.0, int(rng.integers(4, 7))
        for i in range(self.n):
            ny, height = int(rng.integers(2, 4)), float(rng.uniform(0.5, 1.2))
            if i > 0 and self.is_stack:
                below = width
                width = int(rng.integers(3, 7))
                x0 += grid*int(rng.integers(-1, 2)) if self.is_matching else grid*float(rng.uniform(-0.6, 0.6))
                if x0 + grid*width < 2.5*grid or abs(x0) > grid*below/2:
                    x0 = 0.0
            elif i > 0:
                width = 3
            nx = width if self.is_matching else int(rng.integers(3, 7))
            left, right = x0, x0 + grid*width
            if not self.is_stack and i == 0:
                nx, right = 3*(self.n - 1) + 1, grid*(3*(self.n - 1) + 1)
                if not self.is_matching:
                    nx = int(rng.integers(4, 9))
            elif not self.is_stack:
                left, right = grid*(3*i - 3 + (1 if i == self.n - 1 else 0)), grid*3*i + (grid if i == self.n - 1 else 0)
            lean = rng.uniform(-0.2, 0.2, 2) if self.is_stack else np.zeros(2)
            gap = 0.0
            if i > 0:
                gap = float(rng.choice([0, rng.uniform(0, 0.3)], p=[0.6, 0.4]))*0.1
                self.gap.append(gap)
                self.pairs.append((i, i - 1 if self.is_stack else 0, 'BOTTOM', 'TOP'))
            self.gap_is_given = False
            low = y if self.is_stack else (0.0 if i == 0 else self.top_of_base)
            corners = [(left, low), (right, low), (right + lean[0], low + height), (left + lean[1], low + height)]
            if self.is_stack:
                x0 = left + lean[1]
            top = right + lean[0] - left - lean[1]
            if self.is_stack and self.is_matching:       # the next one counts in this one's elements
                grid = top/nx
                width = nx
            elif self.is_stack:
                grid, width = top/nx, nx
            self.blocks.append(Block(corners, np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1), self.kinds[i][0] in '36',
                                     self.roughness, rng))
            y = low + height
            if i == 0:
                self.top_of_base = y
        if not self.is_stack:
            for i in range(2, self.n):
                if i == self.n - 1:
                    continue
                self.pairs.append((i, i - 1, 'LEFT', 'RIGHT'))
                self.gap.append(0.0)
        self.clearance = [str(k) for k in rng.choice(['no', 'value', 'curve'], len(self.pairs), p=[0.6, 0.2, 0.2])]
        self.gap_size = float(10.0**rng.uniform(-3, 0))

    def make_loads(self, rng, size):
        self.size = size
        self.free = [i > 0 and self.is_free and rng.random() < 0.7 for i in range(self.n)]
        # held along a side, across the contact alone; or on top, which is moved down and along
        self.hold = ['BOTTOM' if i == 0 else str(rng.choice(['RIGHT', 'LEFT'])) for i in range(self.n)]
        for i in range(1, self.n):
            on_top = rng.random() < 0.3 or self.angle != 0
            if self.loaded_top(i) and on_top and not self.free[i]:
                self.hold[i] = 'TOP'
        self.pressure = [float(rng.uniform(0.2, 1)) for i in range(self.n)]
        self.slope = [float(rng.choice([0, rng.uniform(-0.2, 0.2)])) for i in range(self.n)]
        self.side = [float(rng.choice([0, rng.uniform(-0.3, 0.3)])) for i in range(self.n)]
        self.weight = [float(rng.choice([0, rng.uniform(0, 0.5)], p=[0.6, 0.4])) for i in range(self.n)]
        self.moved = np.stack([rng.uniform(-0.1, 0.1, self.n), rng.uniform(-0.3, -0.02, self.n)], axis=1)*size
        self.heat = rng.uniform(0, 1, 4)*0.1
        self.heat_twist = bool(rng.random() < 0.3)

    def loaded_top(self, i):
        return i == self.n - 1 if self.is_stack else i > 0

    def meshes(self, kind_of, m):
        found, node, element = [], 1, 1
        for block, kind in zip(self.blocks, kind_of):
            mesh = Mesh(block, int(kind[0]), m, node, element)
            node += len(mesh.nodes)
            element += len(mesh.elements)
            found.append(mesh)
        return found

    def turn(self):
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[c, -s], [s, c]])

    def gap_at(self, k, x):
        """The gap that *CLEARANCE gives a pair, at a place along its side, 0 to 1."""
        most = self.gap_size*self.size
        return most if self.clearance[k] == 'value' else 4*most*(x - 0.4)**2

    def write(self, path, meshes, kinds, coarse):
        pathlib.Path(path).write_text(self.deck(meshes, kinds, coarse, 'CPS' if self.is_plane_stress else 'CPE'))

    def deck(self, meshes, kinds, coarse, state):
        turn, out = self.turn(), ['*HEADING', f'scene {self.number}']
        for i, (mesh, kind) in enumerate(zip(meshes, kinds)):
            out += ['*NODE']
            out += [f'{mesh.first_node + k}, {x[0]:.17g}, {x[1]:.17g}' for k, x in enumerate(mesh.nodes @ turn.T)]
            out += [f'*ELEMENT, TYPE={state}{kind.rstrip("B")}, ELSET=E{i}']
            out += [f'{mesh.first_element + k}, ' + ', '.join(str(mesh.first_node + j) for j in nodes)
                    for k, nodes in enumerate(mesh.elements)]
            for side in SIDES:
                out += [f'*SURFACE, NAME=E{i}-{side}']
                out += [f'{e}, S{face}' for e, face in mesh.sides[side]]
            bbar = ', FORMULATION=BBAR' if kind.endswith('B') and not self.is_plane_stress else ''
            out += [f'*MATERIAL, NAME=M{i}', '*ELASTIC', f'{self.young[i]:.17g}, {self.poisson[i]:.17g}', '*DENSITY', '1.']
            out += ['*EXPANSION', f'{self.size:.17g}']
            out += [f'*SOLID SECTION, ELSET=E{i}, MATERIAL=M{i}{bbar}', f'{self.thickness[i]:.17g}']
        out += ['*SURFACE INTERACTION, NAME=LAW', '*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=PENALTY', f'{self.delta:.17g}']
        if self.nu > 0 and self.is_local:
            out += ['*FRICTION', f'{self.nu:.17g}' + (f', {1/self.eps:.17g}' if self.eps > 0 else '')]
        elif self.nu > 0:
            out += ['*FRICTION, NONLOCAL', f'{self.nu:.17g}, {self.eps:.17g}, 0.']
        quadrature = f', QUADRATURE={self.quadrature}' if self.quadrature else ''
        names = []
        for upper, lower, side, other in self.pairs:
            pair = [f'E{upper}-{side}', f'E{lower}-{other}']
            names.append(pair if self.is_on_slave else pair[::-1])
            out += [f'*CONTACT PAIR, INTERACTION=LAW{quadrature}', ', '.join(names[-1])]
        for k, pair in enumerate(names):
            if self.clearance[k] != 'no':
                out += [f'*CLEARANCE, SLAVE={pair[0]}, MASTER={pair[1]}, TABULAR'] + self.clearances(k, pair[0], meshes, coarse)
        out += ['*STEP', '*STATIC']
        self.write_supports(meshes, turn, out)
        self.write_loads(meshes, coarse, turn, out)
        return '\n'.join([*out, '*NODE PRINT', 'U', '*CONTACT PRINT', '*END STEP', ''])

    def clearances(self, k, slave, meshes, coarse):
        """Linear between the nodes of the coarse mesh."""
        i, side = int(slave[1]), slave.split('-')[1]
        along = 0 if side in ('BOTTOM', 'TOP') else 1
        at = sorted(coarse[i].nodes[j][along] for j in coarse[i].on_side[side])
        values = [self.gap_at(k, (x - at[0])/(at[-1] - at[0])) for x in at]
        return [f'{meshes[i].first_node + j}, {np.interp(meshes[i].nodes[j][along], at, values):.17g}'
                for j in meshes[i].on_side[side]]

    def write_supports(self, meshes, turn, out):
        out += ['*BOUNDARY']
        for i, mesh in enumerate(meshes):
            if self.free[i]:
                continue
            moved = turn @ self.moved[i] if self.hold[i] == 'TOP' else np.zeros(2)
            for j in mesh.on_side[self.hold[i]]:
                out += [f'{mesh.first_node + j}, {d + 1}, {d + 1}, {moved[d]:.17g}' for d in range(2)
                        if self.hold[i] in ('TOP', 'BOTTOM') or d == 0]

    def write_loads(self, meshes, coarse, turn, out):
        for i, mesh in enumerate(meshes):
            if self.loaded_top(i) and self.hold[i] != 'TOP':
                c = turn @ np.array([1, 0])
                value, slope = self.pressure[i], self.slope[i]*(not self.free[i])
                out += ['*DSLOAD, FUNCTION', f'E{i}-TOP, P, {value:.17g} + ({slope:.17g})*(({c[0]:.17g})*x + ({c[1]:.17g})*y)']
            on_pair = {p[2] for p in self.pairs if p[0] == i} | {p[3] for p in self.pairs if p[1] == i}
            if self.side[i] != 0 and i > 0 and not (self.free[i] and self.nu == 0):
                side = 'LEFT' if self.hold[i] == 'RIGHT' else 'RIGHT'
                if side not in on_pair:
                    d = turn @ np.array([1, 0.3])
                    out += ['*DSLOAD', f'E{i}-{side}, TRVEC, {self.side[i]*(0.2 if self.free[i] else 1):.17g}, '
                                       f'{d[0]:.17g}, {d[1]:.17g}']
            if self.weight[i] > 0:
                d = turn @ np.array([0, -1])
                out += ['*DLOAD', f'E{i}, GRAV, {self.weight[i]:.17g}, {d[0]:.17g}, {d[1]:.17g}']
        if self.has_heat:
            out += ['*TEMPERATURE']
            for mesh, mine in zip(meshes, coarse):
                x, y = mine.nodes[:, 0], mine.nodes[:, 1]
                a, b, c, d = self.heat
                heat = a + b*x + c*y + (d*x*y if self.heat_twist else 0)
                out += [f'{mesh.first_node + k}, {value:.17g}' for k, value in enumerate(mesh.cell_values(heat, mine))]


def run(atrito, deck, folder, *options):
    done = subprocess.run([atrito, deck, '-o', folder, '--digits', '17', *options], capture_output=True, text=True, timeout=600)
    return done.returncode, done.stdout + done.stderr


def summary_of(folder):
    found = {}
    for line in (folder/'summary.tab').read_text().splitlines():
        if not line.startswith('#'):
            word = line.split()
            found[word[2], int(word[1])] = float(word[3])
    return found


def displacements(folder, meshes):
    table = np.loadtxt(folder/'nodes.tab', comments='#', ndmin=2)
    u = table[np.argsort(table[:, 1])][:, 4:6]
    return [u[m.first_node - 1:m.first_node - 1 + len(m.nodes)] for m in meshes]


def judge(number, arguments):
    """A row of results: what became of the scene, and its numbers."""
    scene = Scene(number, arguments.seed)
    folder = arguments.folder/str(number)
    folder.mkdir(parents=True, exist_ok=True)
    row = dict(number=number, kind='mixed' if len(set(scene.kinds)) > 1 else scene.kinds[0], matching=scene.is_matching,
               free=any(scene.free), nu=scene.nu, delta=scene.delta, heat=scene.has_heat, clearance='/'.join(scene.clearance),
               n=scene.n, turned=scene.angle != 0, quadrature=scene.quadrature)
    coarse = scene.meshes(scene.kinds, 1)
    scene.write(folder/'coarse.inp', coarse, scene.kinds, coarse)
    code, text = run(arguments.atrito, folder/'coarse.inp', folder/'coarse', '--proof', 'on')
    if code != 0:
        return dict(row, result=f'exit {code}')
    got = summary_of(folder/'coarse')
    line = re.search(r'^error .*(?:\n {6,}.*)*', text, re.M)
    row['says'] = ' '.join(line.group(0).split()) if line else ''
    if ('error_bound_percent', 0) not in got:
        return dict(row, result='no bound')
    energy = got['strain_energy', 0]
    row['eta'] = arguments.times*got['error_bound_percent', 0]/100*np.sqrt(2*energy)
    row['bulk'], row['normal'] = got['error_bound_bulk', 0], got['error_bound_normal', 0]
    row['certified'] = got['error_certified', 0] == 1
    fine_kinds = ['6' if k[0] in '36' else '9' for k in scene.kinds]
    fine = scene.meshes(fine_kinds, arguments.pieces)
    scene.write(folder/'fine.inp', fine, fine_kinds, coarse)
    code, text = run(arguments.reference, folder/'fine.inp', folder/'fine', '--quiet')
    if code != 0:
        return dict(row, result=f'reference exit {code}')
    square = whole = 0.0
    turn = scene.turn()
    u, u_fine = displacements(folder/'coarse', coarse), displacements(folder/'fine', fine)
    for i in range(scene.n):
        d = elasticity(scene.young[i], scene.poisson[i], scene.is_plane_stress, scene.thickness[i])
        for mesh in (coarse[i], fine[i]):
            mesh.nodes = mesh.nodes @ turn.T
        one, other = distance(coarse[i], u[i], fine[i], u_fine[i], d)
        square, whole = square + one, whole + other
    row['error'], row['norm'] = np.sqrt(square), np.sqrt(whole)
    row['ratio'] = row['eta']/row['error'] if row['error'] > 1e-9*row['norm'] else np.nan
    least = 1 if scene.nu == 0 else 1 - ALLOWED
    row['result'] = 'below' if row['eta'] < least*row['error'] - 1e-9*row['norm'] else 'sound'
    if not row['certified']:
        row['result'] = 'estimated'
    if row['result'] == 'sound' and not arguments.keep:
        shutil.rmtree(folder)
    return row


def tell(row):
    words = [f'{row["number"]:5d} {row["result"]:10s}']
    if 'error' in row:
        words.append(f'eta {row["eta"]/row["norm"]:.3e} true {row["error"]/row["norm"]:.3e} ratio {row["ratio"]:.3f} '
                     f'normal {row["normal"]:.2f}')
    words.append(f'{row["kind"]} n={row["n"]} {"matching" if row["matching"] else "not"} {"free" if row["free"] else "held"} '
                 f'nu={row["nu"]:.2f} delta={row["delta"]:.1e} {row["clearance"]} {"heat" if row["heat"] else ""} '
                 f'{"turned" if row["turned"] else ""} {row["quadrature"]}')
    if 'error' not in row:
        words.append(row.get('says', ''))
    return ' '.join(words)


def table(rows):
    """Shares of the ratio of bound and error, by what scenes are."""
    groups = collections.OrderedDict([('all', rows)])
    for kind in KINDS + ['mixed']:
        groups[f'nodes {kind}'] = [r for r in rows if r['kind'] == kind]
    for name, key in (('matching', 'matching'), ('free', 'free'), ('turned', 'turned'), ('heated', 'heat')):
        groups[name] = [r for r in rows if r[key]]
        groups[f'not {name}'] = [r for r in rows if not r[key]]
    groups['friction'] = [r for r in rows if r['nu'] > 0]
    groups['no friction'] = [r for r in rows if r['nu'] == 0]
    print(f'{"scenes":14s} {"n":>5s} {"least":>7s} {"median":>7s} {"90 %":>7s} {"95 %":>7s} {"most":>7s}')
    for name, of_group in groups.items():
        ratio = np.array([r['ratio'] for r in of_group if np.isfinite(r['ratio'])])
        if len(ratio):
            print(f'{name:14s} {len(ratio):5d} {ratio.min():7.3f} {np.median(ratio):7.3f} {np.quantile(ratio, .9):7.3f} '
                  f'{np.quantile(ratio, .95):7.3f} {ratio.max():7.3f}')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('atrito')
    parser.add_argument('first', type=int)
    parser.add_argument('last', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('-j', type=int, default=1)
    parser.add_argument('--pieces', type=int, default=4)
    parser.add_argument('--times', type=float, default=1.0)
    parser.add_argument('--keep', action='store_true')
    parser.add_argument('--only')
    parser.add_argument('--reference')
    parser.add_argument('--folder', type=pathlib.Path, default=pathlib.Path('error-bounds'))
    arguments = parser.parse_args()
    arguments.reference = arguments.reference or arguments.atrito
    numbers = [int(k) for k in arguments.only.split(',')] if arguments.only else range(arguments.first, arguments.last + 1)
    with concurrent.futures.ProcessPoolExecutor(arguments.j) as pool:
        rows = list(map_rows(pool, numbers, arguments))
    print(collections.Counter(r['result'] for r in rows))
    table([r for r in rows if r['result'] in ('sound', 'below')])
    return 1 if any(r['result'] == 'below' for r in rows) else 0


def map_rows(pool, numbers, arguments):
    for row in pool.map(judge, numbers, [arguments]*len(numbers)):
        print(tell(row), flush=True)
        yield row


if __name__ == '__main__':
    sys.exit(main())
