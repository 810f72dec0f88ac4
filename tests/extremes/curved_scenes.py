"""Scene K of seed S: closed and curved contacts, with what is known of it by construction.

curved_scenes.py K S [--springs]     prints the deck; --springs: with three weak springs upon each body that nothing holds

Pins in holes, rings in rings, rollers on flats and in grooves, linings, half cylinders, discs between plates, sliders between guides:
exact arcs and lines, meshed in all ways (curved_meshes.py), turned, shifted, in other units, with coordinates of few digits.
"""

import math
import sys

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import curved_meshes as meshes
import curved_statics as statics
from curved_meshes import Arc, Line, Recipe

DIGITS = (4, 6, 8, 10, 12, 17)
ANGLES = (0.0, 30.0, 57.3, 90.0, 114.6)
WEAK = 1e-7  # stiffness of a weak spring over E times the thickness


class Body:
    def __init__(self, name, mesh, e, mu):
        self.name, self.mesh, self.e, self.mu = name, mesh, e, mu
        self.first = 0  # number of nodes and elements before it


class Rigid:
    """A drawn surface that stays where it is: (curve, points from end to end)."""

    def __init__(self, name, pieces):
        self.name, self.pieces = name, pieces


class Pair:
    def __init__(self, slave, master, nu=0.0, slope=None, quadrature=''):
        self.slave, self.master = slave, master  # (number of a body, side), or (None, Rigid)
        self.nu, self.slope, self.quadrature = nu, slope, quadrature


class Load:
    """A force and a moment about `at`, upon some nodes; or a pressure on a closed or straight side."""

    def __init__(self, body, nodes, force, moment, at, pressure=None, side=None):
        self.body, self.nodes, self.force, self.moment, self.at = body, nodes, np.array(force, float), moment, np.array(at, float)
        self.pressure, self.side = pressure, side


class Motion:
    """Turned, made larger, shifted; and the units of force."""

    def __init__(self, degrees, length, shift, force):
        a = math.radians(degrees)
        self.q = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
        if degrees % 90 == 0:
            self.q = np.round(self.q)
        self.length, self.shift, self.force = length, np.array(shift, float), force

    def place(self, x):
        return self.length*(np.asarray(x) @ self.q.T + self.shift)

    def turn(self, v):
        return np.asarray(v) @ self.q.T


class Scene:
    def __init__(self, kind):
        self.kind, self.notes = kind, []
        self.bodies, self.pairs, self.supports, self.loads = [], [], [], []
        self.plane, self.thickness = 'CPE', 1.0
        self.digits, self.is_plain, self.size = 17, False, 1.0

    def add(self, name, mesh, e, mu):
        self.bodies.append(Body(name, mesh, e, mu))
        return len(self.bodies) - 1

    def hold(self, body, nodes, directions=((1.0, 0.0), (0.0, 1.0))):
        """Nodes that do not move along one direction, or along both."""
        self.supports.append((body, list(nodes), [np.array(d) for d in directions]))

    def move(self, motion):
        """To its place and its units."""
        rigid = {}
        for body in self.bodies:
            mesh = body.mesh
            mesh.x = motion.place(mesh.x)
            moved = {id(curve): curve.moved(motion) for _, curve in mesh.outline.values()}
            mesh.outline = {piece: (name, moved[id(curve)]) for piece, (name, curve) in mesh.outline.items()}
            body.e *= motion.force/motion.length**2
        for pair in self.pairs:
            if pair.master[0] is None and id(pair.master[1]) not in rigid:
                rigid[id(pair.master[1])] = pair.master[1]
                pair.master[1].pieces = [(curve.moved(motion), lambda t, ends=ends: motion.place(ends(t)))
                                         for curve, ends in pair.master[1].pieces]
            if pair.slope:
                pair.slope *= motion.force/motion.length**3
        self.supports = [(b, nodes, [motion.turn(d) for d in directions]) for b, nodes, directions in self.supports]
        for load in self.loads:
            load.force = motion.turn(load.force)*motion.force
            load.moment *= motion.force*motion.length
            load.at = motion.place(load.at)
            if load.pressure is not None:
                load.pressure *= motion.force/motion.length**2
        self.thickness *= motion.length
        self.size *= motion.length
        self.q = motion.q

    def round(self):
        """Coordinates as the deck has them."""
        largest = max(np.abs(body.mesh.x).max() for body in self.bodies)
        self.decimals = self.digits - 1 - math.floor(math.log10(largest))
        self.grain = 0.5*10.0**-self.decimals if self.digits < 17 else largest*2.0**-52
        for body in self.bodies:
            body.ideal = body.mesh.x.copy()
            body.mesh.x = np.array([[float(self.text(v)) for v in x] for x in body.mesh.x])
        first = 0
        for body in self.bodies:
            body.first = first
            first += max(len(body.mesh.x), len(body.mesh.cells))

    def text(self, value, more=0):
        decimals = self.decimals + more
        if self.digits == 17:
            return repr(float(value))
        return f'{value:.{decimals}f}' if decimals >= 0 else repr(float(round(value, decimals)))

    # -- what is known

    def frame(self):
        middles = [body.mesh.x.mean(axis=0) for body in self.bodies]
        return statics.Frame(middles, [0.5*np.ptp(body.mesh.x, axis=0).max() for body in self.bodies])

    def support_columns(self, frame):
        columns = []
        for body, nodes, directions in self.supports:
            for node in nodes[:2] + nodes[-1:]:
                columns += [frame.column([(body, self.bodies[body].ideal[node], d)]) for d in directions]
        return columns

    def load_column(self, frame):
        total = np.zeros(3*len(self.bodies))
        for load in self.loads:
            total += frame.moment(load.body, load.force, load.moment, load.at)
        return total

    def samples(self, side):
        body, name = side
        return statics.Samples.of_rigid(name.pieces) if body is None else statics.Samples(self.bodies[body].mesh, name)

    def balanced(self):
        """yes, no or unsure, and the least sum of contact forces."""
        frame = self.frame()
        supports, load = self.support_columns(frame), self.load_column(frame)
        # moments that are round-off of how they were added up are none
        load[np.abs(load) < 1e-12*np.abs(load).max(initial=0.0)] = 0.0
        words, least = set(), math.inf
        for exchanged in (False, True):
            points = []
            for pair in self.pairs:
                slave, master = self.samples(pair.slave), self.samples(pair.master)
                sides = (pair.master[0], pair.slave[0]) if exchanged else (pair.slave[0], pair.master[0])
                found = statics.points_of_pair(master, slave) if exchanged else statics.points_of_pair(slave, master)
                low = min((gap for _, _, gap in found), default=0.0)
                size = min(slave.size, master.size)
                points += [(sides, x, n, gap < low + statics.NEAR*size, pair.nu) for x, n, gap in found]
            for is_near in (True, False):
                for factor in ((1 - statics.MARGIN, 1 + statics.MARGIN) if any(pair.nu for pair in self.pairs) else (1.0,)):
                    columns = [column for sides, x, n, near, nu in points if near or not is_near
                               for column in statics.rays(frame, *sides, x, n, factor*nu)]
                    left, force = statics.balance(columns, supports, load)
                    words.add('yes' if left < 1e-5 and force < statics.HARDLY else 'no' if left > 1e-3 else 'unsure')
                    if is_near:
                        least = min(least, force*np.linalg.norm(load))
        return (words.pop() if len(words) == 1 else 'unsure'), least

    # -- the deck

    def deck(self, with_springs=False):
        out = ['*HEADING', f'curved scene: {self.kind}: {", ".join(self.notes)}']
        element = 0
        for body in self.bodies:
            mesh = body.mesh
            out.append(f'*NODE, NSET={body.name}-ALL')
            out += [f'{body.first + i + 1}, {self.text(x[0])}, {self.text(x[1])}' for i, x in enumerate(mesh.x)]
            out.append(f'*ELEMENT, TYPE={self.plane}{len(mesh.cells[0])}, ELSET={body.name}')
            for i, cell in enumerate(mesh.cells):
                out.append(f'{body.first + i + 1}, ' + ', '.join(str(body.first + j + 1) for j in cell))
            element = max(element, body.first + len(mesh.cells))
        out += self.surface_cards()
        for body in self.bodies:
            out += [f'*MATERIAL, NAME=M-{body.name}', '*ELASTIC', f'{float(body.e)!r}, {float(body.mu)!r}',
                    f'*SOLID SECTION, ELSET={body.name}, MATERIAL=M-{body.name}', repr(float(self.thickness))]
        if with_springs:
            out += self.spring_cards(element)
        for i, pair in enumerate(self.pairs, 1):
            out += [f'*SURFACE INTERACTION, NAME=LAW-{i}']
            if pair.nu:
                out += ['*FRICTION', f'{float(pair.nu)!r}' + (f', {float(pair.slope)!r}' if pair.slope else '')]
            out += [f'*CONTACT PAIR, INTERACTION=LAW-{i}' + (f', QUADRATURE={pair.quadrature}' if pair.quadrature else ''),
                    f'{self.side_name(pair.slave)}, {self.side_name(pair.master)}']
        out += self.support_cards()
        out += ['*STEP', '*STATIC']
        out += self.load_cards()
        return '\n'.join(out + ['*NODE PRINT', 'U, RF', '*BODY PRINT', '*END STEP', ''])

    def side_name(self, side):
        return side[1].name if side[0] is None else f'{self.bodies[side[0]].name}-{side[1]}'

    def surface_cards(self):
        out, known = [], set()
        for side in [side for pair in self.pairs for side in (pair.slave, pair.master)] \
                + [(load.body, load.side) for load in self.loads if load.side]:
            name = self.side_name(side)
            if name in known:
                continue
            known.add(name)
            if side[0] is None:
                # an arc's ends have to be as far from its centre within 1e-4
                drawn = lambda *values: ', '.join(self.text(v, max(0, 7 - self.digits)) for v in values)
                out.append(f'*SURFACE, NAME={name}, TYPE=SEGMENTS')
                for i, (curve, ends) in enumerate(side[1].pieces):
                    a, b = ends(0.0), ends(1.0)
                    if i == 0:
                        out.append('START, ' + drawn(*a))
                    if isinstance(curve, Line):
                        out.append('LINE, ' + drawn(*b))
                    else:
                        out.append('CIRCL, ' + drawn(*b, *curve.centre))
                out.append(f'*RIGID BODY, ANALYTICAL SURFACE={name}')
            else:
                body = self.bodies[side[0]]
                out.append(f'*SURFACE, NAME={name}')
                out += [f'{body.first + number + 1}, S{face + 1}' for number, face in body.mesh.side(side[1])]
        return out

    def support_cards(self):
        out = []
        for i, (number, nodes, directions) in enumerate(self.supports, 1):
            body = self.bodies[number]
            out.append(f'*NSET, NSET=HELD-{i}')
            ids = [str(body.first + node + 1) for node in nodes]
            out += [', '.join(ids[k:k + 12]) for k in range(0, len(ids), 12)]
            if len(directions) == 2:
                out += ['*BOUNDARY', f'HELD-{i}, 1, 2']
            elif np.abs(directions[0]).max() > 1 - 1e-14:
                out += ['*BOUNDARY', f'HELD-{i}, {int(np.argmax(np.abs(directions[0]))) + 1}']
            else:
                d = [float(v) for v in directions[0]]
                out += [f'*TRANSFORM, NSET=HELD-{i}', f'{d[0]!r}, {d[1]!r}, 0., {-d[1]!r}, {d[0]!r}, 0.',
                        '*BOUNDARY', f'HELD-{i}, 1']
        return out

    def load_cards(self):
        forces, pressures = {}, []
        for load in self.loads:
            body = self.bodies[load.body]
            if load.pressure is not None:
                pressures.append(f'{body.name}-{load.side}, P, {float(load.pressure)!r}')
                continue
            x = (body.ideal if self.is_plain else body.mesh.x)[load.nodes]
            for node, force in zip(load.nodes, distributed(x, load)):
                number = body.first + node + 1
                forces[number] = forces.get(number, 0) + force
        out = []
        if forces:
            out.append('*CLOAD')
            out += [f'{node}, {dof + 1}, {float(force[dof])!r}' for node, force in forces.items() for dof in range(2) if force[dof]]
        return out + (['*DSLOAD', *pressures] if pressures else [])

    def spring_nodes(self, number):
        """Three springs: (node, dof), of which the third turns the body back."""
        x = self.bodies[number].mesh.x
        a = int(np.argmin(x @ [0.8, 0.6]))
        b = int(np.argmax(((x - x[a])**2).sum(axis=1)))
        dof = 1 if abs(x[b, 0] - x[a, 0]) > abs(x[b, 1] - x[a, 1]) else 0
        return [(a, 0), (a, 1), (b, dof)]

    def idle_bodies(self):
        """Those without a support that holds all their motions."""
        frame = self.frame()
        columns = np.array(self.support_columns(frame)).reshape(-1, 3*len(self.bodies))
        return [b for b in range(len(self.bodies)) if np.linalg.matrix_rank(columns[:, 3*b:3*b + 3], 1e-9) < 3]

    def spring_cards(self, element):
        out = []
        for number in self.idle_bodies():
            body = self.bodies[number]
            for node, dof in self.spring_nodes(number):
                element += 1
                out += [f'*ELEMENT, TYPE=SPRING1, ELSET=WEAK-{element}', f'{element}, {body.first + node + 1}',
                        f'*SPRING, ELSET=WEAK-{element}', f'{dof + 1}', f'{float(WEAK*body.e*self.thickness)!r}']
        return out


def distributed(x, load):
    """Nodal forces that add up to the load, to the last digits."""
    middle = x.mean(axis=0)
    away = x - middle
    forces = np.tile(load.force/len(x), (len(x), 1))
    across = np.stack([-away[:, 1], away[:, 0]], axis=1)
    for _ in range(2):
        arm = x - load.at
        moment = load.moment - (arm[:, 0]*forces[:, 1] - arm[:, 1]*forces[:, 0]).sum()
        if (away**2).sum() > 0:
            forces = forces + across*(moment/(away**2).sum())
        forces = forces + (load.force - forces.sum(axis=0))/len(x)
    return forces


# -- layouts --------------------------------------------------------------------------------------------------------------------


class Maker:
    """Draws what all layouts have in common."""

    def __init__(self, rng, kind):
        self.rng, self.scene = rng, Scene(kind)
        self.e = 10.0**rng.uniform(3, 6)
        self.t = 10.0**rng.uniform(-0.5, 0.5)
        self.scene.thickness = self.t
        self.scene.plane = self.pick('CPE', 'CPS')
        self.force = self.e*self.t*10.0**rng.uniform(-5, -3.3)
        self.nodes = int(self.pick(3, 4, 6, 8, 9))
        self.nu = self.pick(0.0, 0.0, 0.0, 0.15, 0.4)
        self.slope = self.e*10.0**rng.uniform(0, 2) if self.nu and self.chance(0.4) else None

    def pick(self, *choices):
        return choices[int(self.rng.integers(len(choices)))]

    def chance(self, share):
        return bool(self.rng.random() < share)

    def recipe(self, same=True):
        nodes = self.nodes if same or self.chance(0.7) else int(self.pick(3, 4, 6, 8, 9))
        return Recipe(nodes, self.chance(0.85), self.chance(0.45), self.pick('uniform', 'uniform', 'graded', 'random'))

    def count(self, low, high, recipe):
        """Elements along a side: fewer where each has more nodes, or is cut into three."""
        n = int(self.rng.integers(low, high + 1))
        if recipe.nodes > 4:
            n = max(6, int(0.7*n))
        return max(6, n//2) if recipe.is_free and not recipe.is_triangles else n

    def stiffness(self):
        return self.e*self.pick(1.0, 1.0, 1.0, 10.0, 0.1), float(round(self.rng.uniform(0.0, 0.4), 3))

    def direction(self):
        a = self.pick(-0.5*math.pi, self.rng.uniform(0, 2*math.pi))
        return np.array([math.cos(a), math.sin(a)])

    def clearance(self, radius):
        word = self.pick('touching', 'touching', 'clearance', 'small clearance', 'interference')
        self.scene.notes.append(word)
        return radius*{'touching': 0.0, 'clearance': self.rng.uniform(0.005, 0.03), 'small clearance': self.rng.uniform(1e-3, 3e-3),
                       'interference': -self.rng.uniform(1e-4, 1e-3)}[word]

    def pair(self, one, other):
        """In either role; a rigid surface is the master."""
        slave, master = (one, other) if other[0] is None or self.chance(0.5) else (other, one)
        quadrature = self.pick('', '', 'NODAL', 'MORTAR')
        if master[0] is None and quadrature == 'MORTAR':
            quadrature = ''
        self.scene.pairs.append(Pair(slave, master, self.nu, self.slope, quadrature))

    def load(self, body, nodes, force, moment, at):
        """Upon nodes that nothing holds: *CLOAD goes along the axes of a node's *TRANSFORM."""
        held = {node for b, those, _ in self.scene.supports if b == body for node in those}
        self.scene.loads.append(Load(body, [node for node in nodes if node not in held], force, moment, at))

    def press(self, body, side, pressure, resultant=(0.0, 0.0), at=(0.0, 0.0)):
        self.scene.loads.append(Load(body, [], resultant, 0.0, at, pressure, side))


def middle_nodes(mesh, centre, radius):
    """Nodes well within."""
    near = np.flatnonzero(np.linalg.norm(mesh.x - centre, axis=1) < 0.75*radius)
    return [int(i) for i in near] if len(near) >= 3 else list(range(len(mesh.x)))


def corner_angles(mesh, side, centre):
    """Of the corner nodes on a circle, round it from the first."""
    nodes = {node for number, face in mesh.side(side) for node in mesh.face_nodes(number, face)[:2]}
    a = np.sort([math.atan2(*(mesh.x[i] - centre)[::-1]) for i in nodes])
    return np.append(a, a[0] + 2*math.pi)


def round_body(m, radius, angles=None, n=None, bore=None, centre=(0.0, 0.0)):
    """A disc or a ring with side OUTSIDE."""
    recipe = m.recipe(False)
    n = n or m.count(14, 28, recipe)
    if bore is None and m.chance(0.4):
        return meshes.disc(recipe, radius, n, 3, m.rng, angles, centre)
    bore = bore or radius*m.rng.uniform(0.25, 0.6)
    if angles is not None:
        # what a ring's builder takes are the angles inside
        if recipe.is_free:
            for _ in range(4):
                inner = 2*math.pi*meshes.stations(max(8, int(0.7*len(angles))), 'uniform', m.rng, True)
                loops = [meshes.on_circle(centre, radius, angles[:-1]), meshes.on_circle(centre, bore, inner[:-1])[::-1]]
                mesh = meshes.unstructured(loops,
                                           [['rim']*(len(angles) - 1), ['hole']*(len(inner) - 1)],
                                           {'rim': ('OUTSIDE', Arc(centre, radius, 1)), 'hole': ('INSIDE', Arc(centre, bore, -1))},
                                           recipe.is_triangles, m.rng)
                if mesh:
                    return recipe.finish(mesh, m.rng)
            recipe.is_free = False
    return meshes.ring(recipe, bore, radius, n, 3, m.rng, angles, centre=centre)


def hold_rotation(m, body, centre, radius):
    """One node inside that does not move round the centre."""
    mesh = m.scene.bodies[body].mesh
    away = mesh.x - centre
    node = int(np.argmin(np.abs(np.linalg.norm(away, axis=1) - 0.5*radius)))
    d = np.array([-away[node, 1], away[node, 0]])/np.linalg.norm(away[node])
    m.scene.hold(body, [node], [d])


def load_round(m, body, centre, radius, how):
    """Loads of a pin or a ring: through its centre, with a moment, a pressure inside, none."""
    scene = m.scene
    mesh = scene.bodies[body].mesh
    nodes = list(mesh.side_nodes('INSIDE')) if 'INSIDE' in {s for s, _ in mesh.outline.values()} else middle_nodes(mesh, centre, radius)
    force = m.force*m.direction()
    if how == 'pressure':
        if 'INSIDE' in {s for s, _ in mesh.outline.values()}:
            m.press(body, 'INSIDE', m.force/(m.t*radius))
        else:
            how = 'force'
    if how == 'force':
        m.load(body, nodes, force, 0.0, centre)
    if how == 'moment':
        m.load(body, nodes, force, m.force*radius*m.rng.uniform(0.02, 0.3)*m.pick(1, -1), centre)
    scene.notes.append(how)


def pin(m):
    """A pin in the hole of a lug, a ring, a rigid wall."""
    scene, radius = m.scene, m.rng.uniform(0.5, 2.0)
    c = m.clearance(radius)
    is_matching, wall = m.chance(0.5), m.pick('ring', 'ring', 'square', 'rigid')
    centre = np.zeros(2)
    hole = radius + c
    recipe = m.recipe()
    n = m.count(14, 28, recipe)
    angles = None
    if wall != 'rigid':
        lug = meshes.ring(recipe, hole, hole*m.rng.uniform(1.6, 2.4), n, 3, m.rng, square=hole*2 if wall == 'square' else None)
        angles = corner_angles(lug, 'INSIDE', centre) if is_matching else None
        if is_matching and recipe.is_free and not recipe.is_triangles:
            angles = np.append(angles[:-1:2], angles[0] + 2*math.pi)
    body = scene.add('PIN', round_body(m, radius, angles), *m.stiffness())
    if wall == 'rigid':
        arcs = [(Arc(centre, hole, -1), lambda t, i=i: hole*np.array([math.cos(2*math.pi*(i + t)/3), math.sin(2*math.pi*(i + t)/3)]))
                for i in range(3)]
        other = (None, Rigid('WALL', arcs))
    else:
        number = scene.add('LUG', lug, *m.stiffness())
        outside = list(lug.side_nodes('OUTSIDE'))
        if m.chance(0.3):
            low = lug.x[:, 1].min()
            outside = [i for i in outside if lug.x[i, 1] < 0.3*low] or outside
        scene.hold(number, outside)
        other = (number, 'INSIDE')
    m.pair((body, 'OUTSIDE'), other)
    scene.notes += [wall, 'matching' if is_matching else 'not matching']
    held = m.pick('free', 'free', 'free', 'rotation held', 'held')
    if held == 'rotation held':
        hold_rotation(m, body, centre, radius)
    elif held == 'held':
        scene.hold(body, middle_nodes(scene.bodies[body].mesh, centre, 0.8*radius)[:5])
    scene.notes.append(held)
    load_round(m, body, centre, radius, m.pick('force', 'force', 'force', 'moment', 'pressure', 'none'))


def rings(m):
    """Two to four rings, one in the other."""
    scene, radius = m.scene, m.rng.uniform(0.5, 1.0)
    count = m.pick(2, 2, 3, 4)
    is_matching = m.chance(0.5)
    inner, previous = radius, None
    for i in range(count):
        outer = inner*m.rng.uniform(1.25, 1.6)
        recipe = m.recipe()
        angles = None
        if is_matching and previous is not None:
            recipe = Recipe(m.nodes, recipe.is_curved, False, '')
            angles = corner_angles(scene.bodies[previous].mesh, 'OUTSIDE', np.zeros(2))
        mesh = meshes.ring(recipe, inner, outer, m.count(14, 26, recipe), 2, m.rng, angles)
        number = scene.add(f'RING{i + 1}', mesh, *m.stiffness())
        if previous is not None:
            m.pair((previous, 'OUTSIDE'), (number, 'INSIDE'))
        previous = number
        if i < count - 1:
            inner = outer + m.clearance(outer)
    held = m.pick('outside held', 'outside held', 'nothing held')
    scene.notes += [held, 'matching' if is_matching else 'not matching']
    if held == 'outside held':
        scene.hold(previous, scene.bodies[previous].mesh.side_nodes('OUTSIDE'))
    elif m.chance(0.5):
        scene.hold(previous, list(scene.bodies[previous].mesh.side_nodes('OUTSIDE'))[:2])
        scene.notes.append('at two nodes')
    load_round(m, 0, np.zeros(2), radius, m.pick('pressure', 'pressure', 'force', 'moment', 'none'))


def arc_angles(m, low, high, n, spacing):
    return low + (high - low)*meshes.stations(n, spacing, m.rng)


def roller_loads(m, body, centre, radius, down=None):
    """What presses a roller to the ground, or moves it: its middle is loaded."""
    scene = m.scene
    mesh = scene.bodies[body].mesh
    nodes = list(mesh.side_nodes('INSIDE')) if 'INSIDE' in {s for s, _ in mesh.outline.values()} else middle_nodes(mesh, centre, radius)
    how = m.pick('down', 'down', 'down', 'inclined', 'moment', 'rolls', 'none')
    force, moment = m.force*np.array([0.0, -1.0]), 0.0
    if how == 'inclined':
        a = -0.5*math.pi + m.pick(1, -1)*m.rng.uniform(0.1, 1.2)
        force = m.force*np.array([math.cos(a), math.sin(a)])
    elif how == 'moment':
        moment = m.force*radius*m.rng.uniform(0.02, 0.3)*m.pick(1, -1)
    elif how == 'rolls':
        # a force along the ground that acts where the roller touches it
        across = m.force*m.rng.uniform(0.05, 0.6)*m.pick(1, -1)
        force, moment = np.array([across, -m.force]), across*radius
    if how != 'none':
        m.load(body, nodes, force, moment, centre)
    scene.notes.append(how)


def flat_ground(m, width, depth, height=0.0):
    """A block whose TOP is the ground, held below, or a rigid line."""
    word = m.pick('block', 'block', 'rigid')
    m.scene.notes.append(word + ' ground')
    if word == 'rigid':
        a, b = np.array([-width, height]), np.array([width, height])
        # drawn from left to right it faces up: the body is on its left, the matter on its right
        return None, Rigid('GROUND', [(Line(b, a), lambda t: a + t*(b - a))])
    recipe = m.recipe()
    mesh = meshes.block(recipe, [(-width, height - depth), (width, height - depth), (width, height), (-width, height)],
                        m.count(14, 24, recipe), 4, m.rng)
    number = m.scene.add('GROUND', mesh, *m.stiffness())
    m.scene.hold(number, mesh.side_nodes('BOTTOM'))
    return number, 'TOP'


def hold_roller(m, body, centre, radius):
    held = m.pick('free', 'free', 'free', 'rotation held', 'held')
    if held == 'rotation held':
        hold_rotation(m, body, centre, radius)
    elif held == 'held':
        m.scene.hold(body, middle_nodes(m.scene.bodies[body].mesh, centre, 0.8*radius)[:5])
    m.scene.notes.append(held)


def roller_on_flat(m):
    radius = m.rng.uniform(0.5, 1.5)
    c = max(m.clearance(radius), 0.0)
    centre = np.array([0.0, radius + c])
    angles = None
    if m.chance(0.5):
        # a node where it touches
        n = m.count(16, 30, m.recipe())
        angles = -0.5*math.pi + 2*math.pi*np.arange(n + 1)/n
    body = m.scene.add('ROLLER', round_body(m, radius, angles, centre=centre), *m.stiffness())
    m.pair((body, 'OUTSIDE'), flat_ground(m, 1.5*radius, radius))
    hold_roller(m, body, centre, radius)
    roller_loads(m, body, centre, radius)


def groove_block(m, points, curves, names, bottom):
    recipe = Recipe(m.nodes, m.chance(0.85), False, '')
    mesh = meshes.profile_block(recipe, (points, curves, names), bottom, m.rng, 3)
    number = m.scene.add('GROUND', mesh, *m.stiffness())
    m.scene.hold(number, mesh.side_nodes('BOTTOM'))
    return number


def roller_in_v(m):
    """Each flank is a pair of its own with the roller's half, or one chain of both."""
    radius, slope = m.rng.uniform(0.5, 1.5), m.rng.uniform(0.35, 1.1)
    c = max(m.clearance(radius), 0.0)
    centre = np.array([0.0, (radius + c)/math.cos(slope)])
    wide = 1.4*radius*math.sin(slope) + 0.3*radius
    high = wide*math.tan(slope)
    left, right, foot = np.array([-wide, high]), np.array([wide, high]), np.zeros(2)
    lines = [Line(foot, left), Line(right, foot)]
    recipe = m.recipe()
    n = m.count(6, 12, recipe)
    s, t = meshes.stations(n, recipe.spacing, m.rng), meshes.stations(n, recipe.spacing, m.rng)
    points = [left + a*(foot - left) for a in s] + [foot + a*(right - foot) for a in t[1:]]
    number = groove_block(m, points, [lines[0]]*n + [lines[1]]*n, ['WEST']*n + ['EAST']*n, -radius)
    body = m.scene.add('ROLLER', round_body(m, radius, None, centre=centre), *m.stiffness())
    split_round(m, body, centre)
    m.pair((body, 'OUTSIDE-WEST'), (number, 'WEST'))
    m.pair((body, 'OUTSIDE-EAST'), (number, 'EAST'))
    hold_roller(m, body, centre, radius)
    roller_loads(m, body, centre, radius)


def split_round(m, body, centre):
    """The lower left and the lower right of a rim as sides of their own."""
    mesh = m.scene.bodies[body].mesh
    curve = next(curve for side, curve in mesh.outline.values() if side == 'OUTSIDE')
    mesh.outline['west'], mesh.outline['east'] = ('OUTSIDE-WEST', curve), ('OUTSIDE-EAST', Arc(curve.centre, curve.radius, 1))
    middles = {}
    for key, piece in list(mesh.faces.items()):
        if mesh.outline[piece][0] == 'OUTSIDE':
            a, b = (mesh.x[i] - centre for i in mesh.face_nodes(*key)[:2])
            middles[key] = 0.5*(a + b)
            if max(a[1], b[1]) < 0.3*curve.radius:
                mesh.faces[key] = 'west' if middles[key][0] < 0 else 'east'
    for side, sign in ('west', -1), ('east', 1):
        if side not in mesh.faces.values():                 # its faces are long: the lowest of them
            mesh.faces[min((key for key in middles if sign*middles[key][0] > 0), key=lambda key: middles[key][1])] = side


def roller_in_groove(m):
    """A round groove as wide as the roller, nearly so, or wider."""
    radius = m.rng.uniform(0.5, 1.5)
    c = m.clearance(radius)
    wider = m.pick(0.0, 0.0, m.rng.uniform(0.05, 0.5))
    groove, half = radius*(1 + wider) + c, m.rng.uniform(0.7, 1.35)
    centre = np.array([0.0, -wider*radius - (c if wider else 0.0)])
    recipe = m.recipe()
    n = m.count(10, 18, recipe)
    a = -0.5*math.pi - half + 2*half*meshes.stations(n, recipe.spacing, m.rng)
    arc = Arc((0, 0), groove, -1)
    rim = meshes.on_circle((0, 0), groove, a)
    flank = 0.4*radius
    flats = [Line(rim[0], rim[0] - [flank, 0]), Line(rim[-1] + [flank, 0], rim[-1])]
    points = [rim[0] - [flank, 0], rim[0] - [0.5*flank, 0], *rim, rim[-1] + [0.5*flank, 0], rim[-1] + [flank, 0]]
    number = groove_block(m, points, [flats[0]]*2 + [arc]*n + [flats[1]]*2, ['SHORE-L']*2 + ['GROOVE']*n + ['SHORE-R']*2,
                          -groove - radius)
    angles = None
    if m.chance(0.4):
        rest = 2*math.pi - 2*half
        angles = np.concatenate([a, a[-1] + rest*meshes.stations(max(6, n), 'uniform', m.rng)[1:]])
    body = m.scene.add('ROLLER', round_body(m, radius, angles, centre=centre), *m.stiffness())
    m.pair((body, 'OUTSIDE'), (number, 'GROOVE'))
    m.scene.notes.append(f'groove {"as wide" if not wider else "wider"}')
    hold_roller(m, body, centre, radius)
    roller_loads(m, body, centre, radius)


def lining(m):
    """A ring in a square piece of ground whose outside is held, or on rollers: pressure, forces against each other, moments."""
    scene, radius = m.scene, m.rng.uniform(0.5, 2.0)
    c = m.clearance(radius)
    recipe = m.recipe()
    ground = meshes.ring(recipe, radius + c, 2*radius, m.count(16, 28, recipe), 4, m.rng, square=m.rng.uniform(2, 3)*radius)
    angles = corner_angles(ground, 'INSIDE', np.zeros(2)) if m.chance(0.5) else None
    body = scene.add('LINING', round_body(m, radius, angles, bore=radius*m.rng.uniform(0.75, 0.9)), *m.stiffness())
    number = scene.add('GROUND', ground, *m.stiffness())
    m.pair((body, 'OUTSIDE'), (number, 'INSIDE'))
    outside = ground.side_nodes('OUTSIDE')
    word = m.pick('held', 'below held', 'rollers')
    if word == 'held':
        scene.hold(number, outside)
    else:
        below = [i for i in outside if ground.x[i, 1] < ground.x[:, 1].min() + 1e-9*radius]
        scene.hold(number, below, [(0.0, 1.0)] if word == 'rollers' else ((1.0, 0.0), (0.0, 1.0)))
        if word == 'rollers':
            # two parallel rows of rollers and one that stops it
            left = [i for i in outside if ground.x[i, 0] < ground.x[:, 0].min() + 1e-9*radius and i not in below]
            scene.hold(number, left, [(1.0, 0.0)])
    scene.notes.append(word)
    load_round(m, body, np.zeros(2), radius, m.pick('pressure', 'pressure', 'force', 'moment', 'none'))


def half_cylinder(m):
    """With its round side, or its flat side, on a block."""
    scene, radius = m.scene, m.rng.uniform(0.5, 1.5)
    c = max(m.clearance(radius), 0.0)
    recipe = m.recipe()
    is_round = m.chance(0.65)
    angles = None
    if m.chance(0.5):
        n = 2*(m.count(10, 18, recipe)//2)
        angles = math.pi*(1 + np.arange(n + 1)/n)
    recipe.is_free = recipe.is_free or not is_round
    mesh = meshes.half_disc(recipe, radius, m.count(10, 18, recipe), m.rng, angles)
    if not is_round:
        mesh.x = -mesh.x
        mesh.outline = {piece: (side, Arc(-curve.centre, curve.radius, 1) if isinstance(curve, Arc) else Line(-curve.a, -curve.b))
                        for piece, (side, curve) in mesh.outline.items()}
        if len(mesh.curves('FLAT')) > 1:
            is_round = True
            mesh.x = -mesh.x
            mesh.outline = {piece: (side, Arc(-curve.centre, curve.radius, curve.outward) if isinstance(curve, Arc)
                                    else Line(-curve.a, -curve.b)) for piece, (side, curve) in mesh.outline.items()}
    body = scene.add('HALF', mesh, *m.stiffness())
    low = -radius if is_round else 0.0
    m.pair((body, 'ROUND' if is_round else 'FLAT'), flat_ground(m, 1.6*radius, radius, low - c))
    scene.notes.append('round side down' if is_round else 'flat side down')
    how = m.pick('down', 'down', 'inclined', 'moment', 'none')
    force, moment = np.array([0.0, -m.force]), 0.0
    if how == 'inclined':
        force = m.force*np.array([m.pick(1, -1)*m.rng.uniform(0.05, 0.8), -1.0])
    elif how == 'moment':
        moment = m.force*radius*m.rng.uniform(0.02, 0.4)*m.pick(1, -1)
    top = list(mesh.side_nodes('FLAT' if is_round else 'ROUND'))
    top = [i for i in top if abs(mesh.x[i, 0]) < 0.7*radius]
    # a force that pushes along the ground pushes where it touches
    at = (0.0, low)
    if how != 'none':
        m.load(body, top, force, moment, at)
    scene.notes.append(how)


def disc_between_plates(m):
    """The lower plate is held; the upper one is held, too, or lies on the disc."""
    scene, radius = m.scene, m.rng.uniform(0.5, 1.5)
    c = max(m.clearance(radius), 0.0)
    centre = np.array([0.0, radius + 0.5*c])
    n = 2*(m.count(16, 28, m.recipe())//2)
    angles = -0.5*math.pi + 2*math.pi*np.arange(n + 1)/n if m.chance(0.5) else None
    body = scene.add('DISC', round_body(m, radius, angles, centre=centre), *m.stiffness())
    split_rim(m, body, centre)
    m.pair((body, 'OUTSIDE-LOW'), flat_ground(m, 1.5*radius, 0.8*radius))
    recipe = m.recipe()
    high = 2*radius + c
    wide, top = 1.5*radius, high + 0.8*radius
    plate = meshes.block(recipe, [(-wide, high), (wide, high), (wide, top), (-wide, top)], m.count(12, 20, recipe), 4, m.rng)
    upper = scene.add('PLATE', plate, *m.stiffness())
    m.pair((body, 'OUTSIDE-HIGH'), (upper, 'BOTTOM'))
    word = m.pick('upper held', 'upper free', 'upper guided')
    scene.notes.append(word)
    if word == 'upper held':
        scene.hold(upper, plate.side_nodes('TOP'))
        roller_loads(m, body, centre, radius)
        return
    if word == 'upper guided':
        scene.hold(upper, plate.side_nodes('TOP'), [(1.0, 0.0)])
    how = m.pick('down', 'down', 'across', 'moment')
    force, moment = np.array([0.0, -m.force]), 0.0
    if how == 'across':
        force = m.force*np.array([m.rng.uniform(0.05, 0.5), -1.0])
    elif how == 'moment':
        moment = m.force*radius*m.rng.uniform(0.05, 0.3)
    m.load(upper, [i for i in range(len(plate.x)) if plate.x[i, 1] > high + 0.3*radius], force, moment, (0.0, high))
    scene.notes.append(how)


def split_rim(m, body, centre):
    """Below and above the middle."""
    mesh = m.scene.bodies[body].mesh
    curve = next(curve for side, curve in mesh.outline.values() if side == 'OUTSIDE')
    mesh.outline['low'], mesh.outline['high'] = ('OUTSIDE-LOW', curve), ('OUTSIDE-HIGH', Arc(curve.centre, curve.radius, 1))
    for key, piece in list(mesh.faces.items()):
        if mesh.outline[piece][0] == 'OUTSIDE':
            a, b = (mesh.x[i] - centre for i in mesh.face_nodes(*key)[:2])
            if max(a[1], b[1]) < -0.2*curve.radius:
                mesh.faces[key] = 'low'
            elif min(a[1], b[1]) > 0.2*curve.radius:
                mesh.faces[key] = 'high'


def slider(m):
    """A block between parallel guides, rigid or not: free along them."""
    scene, height, width = m.scene, m.rng.uniform(0.4, 1.0), m.rng.uniform(1.0, 2.0)
    c = max(m.clearance(height), 0.0)
    recipe = m.recipe()
    mesh = meshes.block(recipe, [(-width, 0), (width, 0), (width, height), (-width, height)], m.count(8, 16, recipe), 4, m.rng)
    body = scene.add('SLIDER', mesh, *m.stiffness())
    m.pair((body, 'BOTTOM'), flat_ground(m, 1.5*width, height, -c))
    recipe = m.recipe()
    if m.chance(0.5):
        a, b = np.array([1.5*width, height + c]), np.array([-1.5*width, height + c])
        other = None, Rigid('UPPER', [(Line(b, a), lambda t: a + t*(b - a))])
    else:
        wide, low = 1.5*width, height + c
        top = meshes.block(recipe, [(-wide, low), (wide, low), (wide, low + height), (-wide, low + height)], m.count(10, 18, recipe), 3, m.rng)
        number = scene.add('UPPER', top, *m.stiffness())
        scene.hold(number, top.side_nodes('TOP'))
        other = number, 'BOTTOM'
    m.pair((body, 'TOP'), other)
    held = m.pick('free', 'free', 'free', 'end held')
    if held == 'end held':
        scene.hold(body, mesh.side_nodes('LEFT'), [(1.0, 0.0)])
    how = m.pick('across', 'across', 'along', 'moment', 'inclined', 'none')
    scene.notes += [held, how]
    force, moment = np.array([0.0, -m.force]), 0.0
    if how == 'along':
        force = np.array([m.force, 0.0])
    elif how == 'inclined':
        force = m.force*np.array([m.rng.uniform(0.03, 0.5), -1.0])
    elif how == 'moment':
        moment = m.force*width*m.rng.uniform(0.1, 2.0)
    if how != 'none':
        # round the middle, away from the sides
        nodes = [i for i in range(len(mesh.x)) if 0.2*height < mesh.x[i, 1] < 0.8*height and abs(mesh.x[i, 0]) < 0.8*width]
        if len(nodes) < 2:  # a coarse mesh may have none there, and a moment takes two
            nodes = list(np.argsort(((mesh.x - [0.0, 0.5*height])**2).sum(axis=1))[:3])
        m.load(body, nodes, force, moment, (0.0, 0.0) if how in ('inclined', 'along') else (0.0, 0.5*height))


LAYOUTS = {'pin': pin, 'rings': rings, 'flat': roller_on_flat, 'v-groove': roller_in_v, 'round groove': roller_in_groove,
           'lining': lining, 'half cylinder': half_cylinder, 'plates': disc_between_plates, 'slider': slider}


def make(number, seed, digits=None):
    """The scene; its coordinates of its own number of digits, or of `digits`."""
    rng = np.random.default_rng([seed, number])
    kind = list(LAYOUTS)[int(rng.integers(len(LAYOUTS)))]
    m = Maker(rng, kind)
    LAYOUTS[kind](m)
    scene = m.scene
    scene.digits = int(m.pick(*DIGITS))
    scene.is_plain = m.chance(0.3)
    turn = m.pick(*ANGLES)
    far = 0.0 if scene.digits < 6 or m.chance(0.5) else 10.0**rng.uniform(0, min(scene.digits - 5, 3))
    scene.size = max(np.ptp(np.vstack([body.mesh.x for body in scene.bodies]), axis=0))
    length, force = (1.0, 1.0) if m.chance(0.6) else (10.0**rng.integers(-3, 4), 10.0**rng.integers(-3, 4))
    scene.move(Motion(turn, length, far*rng.uniform(-1, 1, 2), force))
    scene.digits = digits or scene.digits
    scene.round()
    kinds = '/'.join(str(len(body.mesh.cells[0])) for body in scene.bodies)
    scene.notes += [f'nu {m.nu}', f'elements {kinds}', f'{scene.digits} digits', f'{turn} degrees',
                    'plain loads' if scene.is_plain else 'loads exact']
    return scene


def main():
    number, seed = int(sys.argv[1]), int(sys.argv[2])
    scene = make(number, seed)
    sys.stdout.write(scene.deck('--springs' in sys.argv))
    if '--known' in sys.argv:
        word, least = scene.balanced()
        print(f'** balanced: {word}, contact forces at least {least:.3g}', file=sys.stderr)


if __name__ == '__main__':
    main()
