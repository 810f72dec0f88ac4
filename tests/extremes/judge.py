"""Judges what a run says of a scene of random_scenes, with code of its own throughout.

judge.py DECK FOLDER     exit 0: the tables in FOLDER (17 digits) solve the deck: equilibrium of each body, the contact law pair by pair
judge.py DECK            exit 4: no admissible forces balance the loads (linear programming)

Prints `holds`, `violated: ...`, `infeasible` or `feasible`. Exit code 0 for holds and infeasible, else 1.

What is allowed, and why (EPS = 2.2e-16):
- LAW = 1e-7 of the pair's own largest friction bound, for the friction law: the outer loop stops at 1e-10 to 1e-8 of it.
- FORCE = 1e-7 of the largest contact force of the pair for the equilibrium of its nodes, of the largest force of the body for the rest.
- BALANCE = 1e-7 of the sum of the forces upon a body, for each rigid motion that its supports leave. A
  body without load rests: 100 EPS of the forces upon its neighbours is round-off there.
- PLACE = 1e-9 of the largest motion of the pair's sides against each other, and GROWTH EPS of the largest displacement of the two
  bodies: solving K u = f in double precision leaves an error of EPS cond(K) in the displacements of a body, which the gap inherits;
  the bodies have cond(K) up to some 1e5 (GROWTH). 16 EPS of the largest coordinate is round-off of the initial distance.
- A nodal force K u is uncertain by |K| times the last digits of the displacements: MOTION EPS of the largest displacement of the
  body, whose deformation and motion were added (and 1e-14 of the largest displacement of all where 0 is printed); and by GROWTH EPS |K| times the largest deformation of the body: the
  backward error of a solution by condensation.
"""

import math
import os
import sys
from decimal import Decimal, getcontext

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
from scene_reader import face_nodes, read_deck, read_table
from shape_functions import GAUSS, line_shapes, quadrature, shapes

EPS = 2.0**-52
LAW = 1e-7
FOUND = 1e-10       # of the largest: friction bounds, where the outer loop stops
FORCE = 1e-7
BALANCE = 1e-7
PLACE = 1e-9
GROWTH = 1e5
MOTION = 64
PRINTED_ZERO = 1e-14
END = 1e-6
TILTED = 0.01      # sine from which on the end of a slave stands on its master
STRAIGHT = 1e-6    # radians between faces that are rounding of the places
CANCEL = 1e-13
BALANCED = 1e-12
MOST_FORCE = 10**8
TINY = Decimal(10)**-30
NOISE = Decimal(10)**-60


# -- finite elements ------------------------------------------------------------------------------------------------------------


def elasticity(kind, e, mu):
    if kind.startswith('CPS'):
        return e/(1 - mu*mu)*np.array([[1, mu, 0], [mu, 1, 0], [0, 0, (1 - mu)/2]])
    return e/((1 + mu)*(1 - 2*mu))*np.array([[1 - mu, mu, 0], [mu, 1 - mu, 0], [0, 0, (1 - 2*mu)/2]])


def element_matrix(kind, x, d, thickness):
    """Stiffness and the integrals of the shape functions."""
    n = len(x)
    k = np.zeros((2*n, 2*n))
    volume = np.zeros(n)
    for xi, eta, weight in quadrature(n):
        value, slope = shapes(n, xi, eta)
        jacobian = slope.T @ x
        size = np.linalg.det(jacobian)*weight*thickness
        gradient = np.linalg.solve(jacobian, slope.T)
        b = np.zeros((3, 2*n))
        b[0, 0::2] = b[2, 1::2] = gradient[0]
        b[1, 1::2] = b[2, 0::2] = gradient[1]
        k += b.T @ d @ b*size
        volume += value*size
    return k, volume


class Body:
    """One connected piece: its nodes, stiffness, loads and supports."""

    def __init__(self, nodes, x):
        self.nodes = nodes
        self.index = {node: i for i, node in enumerate(nodes)}
        self.x = x
        self.k = np.zeros((2*len(nodes), 2*len(nodes)))
        self.f = np.zeros((len(nodes), 2))
        self.held = np.zeros((len(nodes), 2), bool)
        self.value = np.zeros((len(nodes), 2))

    def rigid_motions(self):
        """Two translations and a rotation with the largest displacement about 1: (3, n, 2)."""
        away = self.x - self.x.mean(axis=0)
        z = np.zeros((3, len(self.nodes), 2))
        z[0, :, 0] = 1
        z[1, :, 1] = 1
        z[2, :, 0], z[2, :, 1] = -away[:, 1], away[:, 0]
        z[2] /= np.abs(away).max()
        return z

    def free_motions(self):
        """Those that the supports leave."""
        z = self.rigid_motions()
        if not self.held.any():
            return z
        _, s, v = np.linalg.svd(np.array([z[m][self.held] for m in range(3)]).T)
        s = np.concatenate([s, np.zeros(3 - len(s))])
        return np.tensordot(v[s < 1e-10*s.max()], z, axes=1)


def connected(scene):
    """Sets of nodes that elements connect."""
    parent = {}

    def root(node):
        while parent.setdefault(node, node) != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    for _, nodes in scene.elements.values():
        for node in nodes[1:]:
            parent[root(node)] = root(nodes[0])
    sets = {}
    for node in sorted(parent):
        sets.setdefault(root(node), []).append(node)
    return list(sets.values())


def build_bodies(scene):
    bodies = [Body(nodes, np.array([scene.place[node] for node in nodes])) for nodes in connected(scene)]
    owner = {node: body for body in bodies for node in body.nodes}
    for number, (kind, nodes) in scene.elements.items():
        body = owner[nodes[0]]
        places = [body.index[node] for node in nodes]
        material, thickness = scene.section[number]
        e, mu, density = scene.materials[material]
        k, volume = element_matrix(kind, body.x[places], elasticity(kind, e, mu), thickness)
        dofs = np.array([[2*i, 2*i + 1] for i in places]).ravel()
        body.k[np.ix_(dofs, dofs)] += k
        body.f[places] += np.outer(volume, volume_force(scene, number, density))
    for kind, row in scene.loads:
        add_load(scene, owner, kind, row)
    for (node, dof), value in scene.held.items():
        body = owner[node]
        body.held[body.index[node], dof] = True
        body.value[body.index[node], dof] = value
    return bodies, owner


def volume_force(scene, number, density):
    force = np.zeros(2)
    for kind, row in scene.loads:
        if kind != 'DLOAD' or row[1] not in ('BX', 'BY', 'GRAV') or not is_member(scene, row[0], number):
            continue
        if row[1] == 'GRAV':
            force += density*float(row[2])*np.array([float(row[3]), float(row[4])])
        else:
            force['BX BY'.split().index(row[1])] += float(row[2])
    return force


def is_member(scene, name, number):
    return number in scene.elsets[name] if name in scene.elsets else name == str(number)


def add_load(scene, owner, kind, row):
    if kind == 'CLOAD':
        body = owner[int(row[0])]
        body.f[body.index[int(row[0])], int(row[1]) - 1] += float(row[2])
    elif kind == 'DSLOAD':
        for number, face in scene.surfaces[row[0]]:
            add_pressure(scene, owner, number, face, float(row[2]))
    elif row[1].startswith('P'):
        add_pressure(scene, owner, int(row[0]), int(row[1][1]) - 1, float(row[2]))


def add_pressure(scene, owner, number, face, pressure):
    nodes = face_nodes(scene, number, face)
    body = owner[nodes[0]]
    places = [body.index[node] for node in nodes]
    points, weights = GAUSS[3]
    thickness = scene.section[number][1]
    for t, weight in zip(points, weights):
        value, slope = face_shapes(len(nodes), t)
        along = slope @ body.x[places]
        body.f[places] += np.outer(value, np.array([-along[1], along[0]])*(pressure*weight*thickness))


def face_shapes(n, t):
    """At -1, 1 and, of three, 0."""
    at = line_shapes(n - 1, t)
    order = (-1, 1) if n == 2 else (-1, 1, 0)
    return np.array([at[i][0] for i in order]), np.array([at[i][1] for i in order])


# -- pairs ----------------------------------------------------------------------------------------------------------------------


class Pair:
    """Points of a pair: slave node, normal, weights, initial gap, and the master's nodes and shape functions."""

    def __init__(self, scene, owner, slave, master, law):
        self.law = law
        self.rigid = master in scene.segments
        pieces = self.master_pieces(scene, master)
        faces = chain([(number, face_nodes(scene, number, face)) for number, face in scene.surfaces[slave]])
        where = scene.place
        sees = [all(look(where[node], normal, pieces, length) for node, normal, length in rule(scene, number, nodes))
                for number, nodes in faces]
        # normals of straight sides are known to the digits of the deck, which turn faces against each other
        along = [rule(scene, *face)[0][1] for face in faces] + [(piece[0][1] - piece[0][0])[::-1]*(1, -1) for piece in pieces]
        along = [d/np.linalg.norm(d) for d in along]
        turns = [abs(a[0]*b[1] - a[1]*b[0]) for a in along for b in along]
        self.tilt = max([turn for turn in turns if turn < STRAIGHT], default=0.0)
        self.nodes, weight, length, normal = [], {}, {}, {}
        for (number, nodes), seen in zip(faces, sees):
            for node, w in weighted(scene, nodes):
                if not seen:
                    continue
                if node not in weight:
                    self.nodes.append(node)
                n = [direction for other, direction, _ in rule(scene, number, nodes) if other == node][0]
                weight[node] = weight.get(node, 0) + w*scene.section[number][1]
                length[node] = length.get(node, 0) + w
                normal[node] = normal.get(node, 0) + w*n
        self.x = np.array([where[node] for node in self.nodes]).reshape(-1, 2)
        self.weight = np.array([weight[node] for node in self.nodes])
        self.length = np.array([length[node] for node in self.nodes])
        self.normal = np.array([normal[node]/np.linalg.norm(normal[node]) for node in self.nodes]).reshape(-1, 2)
        ends = [node for _, nodes in faces for node in nodes[:2]]
        for node, n in zip(self.nodes, self.normal):
            if self.rigid or ends.count(node) == 1:
                n[:] = standing(where[node], n, pieces, 2*length[node], floors(pieces) if self.rigid else [])
        self.tangent = np.stack([-self.normal[:, 1], self.normal[:, 0]], axis=1)
        self.gap0, self.master = [], []
        for node, n in zip(self.nodes, self.normal):
            sight = look(where[node], n, pieces, 2*length[node]) or look(where[node], n, pieces, math.inf, 1.0)
            self.gap0.append(sight[0])
            self.master.append([] if self.rigid else list(zip(sight[2], sight[3])))
        self.gap0 = np.array(self.gap0)
        self.bodies = {id(owner[node]): owner[node] for node in self.nodes}
        for masters in self.master:
            self.bodies.update({id(owner[node]): owner[node] for node, _ in masters})
        self.bodies = list(self.bodies.values())
        self.average = self.averages()

    @staticmethod
    def master_pieces(scene, master):
        """(ends and middle, nodes, sign of the outward side)."""
        if master in scene.segments:
            points = [np.array(point) for point in scene.segments[master]]
            return [([a, b], None, -1.0) for a, b in zip(points, points[1:])]
        pieces = []
        for number, face in scene.surfaces[master]:
            nodes = face_nodes(scene, number, face)
            pieces.append(([np.array(scene.place[node]) for node in nodes], nodes, 1.0))
        return pieces

    def averages(self):
        """W with S_rho(p) = W p, on quadrature lengths."""
        n, rho = len(self.nodes), self.law.rho
        distance = np.hypot(*(self.x[:, None, i] - self.x[None, :, i] for i in range(2)))
        spacing = min((distance[j, j + 1] for j in range(n - 1)), default=math.inf)
        if self.law.kind != 'NONLOCAL' or rho <= spacing:
            return np.eye(n)
        q = distance/rho
        inside = q < 1
        w = np.zeros((n, n))
        w[inside] = np.exp(1/((q[inside] - 1)*(q[inside] + 1)))
        w *= self.length
        if self.law.kernel == 'LINE':
            return w*2.252283621043581/rho
        return w/w.sum(axis=1)[:, None]

    def rows(self, j):
        """(node, factor): the relative motion of point j is the sum of factor u."""
        return [(self.nodes[j], 1.0)] + [(node, -shape) for node, shape in self.master[j]]


def chain(faces):
    """Faces in order along T of the slave, which is the direction round the element, from the end where no other face ends."""
    first = {nodes[0]: (number, nodes) for number, nodes in faces}
    ends = {nodes[1] for _, nodes in faces}
    begins = [node for node in first if node not in ends]
    node = begins[0] if begins else faces[0][1][0]
    ordered = []
    while node in first and len(ordered) < len(faces):
        ordered.append(first[node])
        node = first[node][1][1]
    return ordered


def rule(scene, number, nodes):
    """(node, outward normal, length of the face) of a face's points."""
    x = np.array([scene.place[node] for node in nodes])
    result = []
    length = face_length(x)
    for node, t in zip(nodes, (-1.0, 1.0, 0.0)):
        _, slope = face_shapes(len(nodes), t)
        along = slope @ x
        result.append((node, np.array([along[1], -along[0]])/np.linalg.norm(along), length))
    return result


def face_length(x):
    points, weights = GAUSS[3]
    return sum(w*np.linalg.norm(face_shapes(len(x), t)[1] @ x) for t, w in zip(points, weights))


def weighted(scene, nodes):
    """(node, quadrature length): trapezoidal or Simpson's rule."""
    x = np.array([scene.place[node] for node in nodes])
    along = ((0, -1.0, 1.0), (1, 1.0, 1.0)) if len(nodes) == 2 else ((0, -1.0, 1/3), (2, 0.0, 4/3), (1, 1.0, 1/3))
    for node, t, w in ((nodes[i], t, w) for i, t, w in along):
        yield node, w*np.linalg.norm(face_shapes(len(nodes), t)[1] @ x)


def look(x, normal, pieces, reach, over=END):
    """(distance, place t, nodes, shapes, piece) of the nearest piece along the normal that faces x, or None. `over`: how far it may be
    missed, in parts of a piece; a piece that is met properly goes first."""
    best, nearest = None, math.inf
    x = np.array(x)
    for points, nodes, side in pieces:
        a, d = points[0], points[1] - points[0]
        size = np.linalg.norm(d)
        sag = np.zeros(2)
        if len(points) == 3:
            sag = points[2] - 0.5*(points[0] + points[1])
            if np.linalg.norm(sag) <= 8*EPS*max(np.abs(points[0]).max(), np.abs(points[1]).max()):
                sag = np.zeros(2)
        t = meet(x - a, d, sag, normal)
        if t is None or t < -over or t > 1 + over:
            continue
        distance = float((a + t*d + 4*t*(1 - t)*sag - x) @ normal)
        along = d + 4*(1 - 2*t)*sag
        if (along[1]*normal[0] - along[0]*normal[1])*side/np.linalg.norm(along) > -1e-3:
            continue
        away = max(-t, t - 1, 0.0)
        nearness = abs(distance) + (2*END*size if away > 1e-10 else 0.0) + (away*size if over > END else 0.0)
        if distance < -max(reach, size) or nearness >= nearest:
            continue
        nearest = nearness
        t = min(max(t, 0.0), 1.0)
        for place in (0.0, 0.5, 1.0):
            if abs(t - place) < 1e-10:
                t = place
        shape = face_shapes(len(points), 2*t - 1)[0] if nodes else None
        best = (distance, t, nodes, shape, (points, nodes, side))
    return best


def floors(pieces):
    """Segments of a rigid surface beside which no other one turns away: contact with them is along their normal."""
    along = [piece[0][1] - piece[0][0] for piece in pieces]
    away = [i for i, (a, b) in enumerate(zip(along, along[1:])) if a[0]*b[1] - a[1]*b[0] < -1e-6*math.hypot(*a)*math.hypot(*b)]
    return [piece for i, piece in enumerate(pieces) if i not in away and i - 1 not in away]


def standing(x, normal, pieces, reach, floors):
    """The normal where a slave ends: that of what it faces, if its face is turned against it, since it stands there on a corner."""
    sight = look(x, normal, pieces, reach) or look(x, normal, pieces, math.inf, 1.0)
    points, _, side = sight[4]
    if any(points is floor[0] for floor in floors):
        return np.array([points[1][1] - points[0][1], points[0][0] - points[1][0]])*-side/np.linalg.norm(points[1] - points[0])
    along = (points[1] - points[0])/np.linalg.norm(points[1] - points[0])
    other = -side*np.array([along[1], -along[0]])
    return other if abs(other[0]*normal[1] - other[1]*normal[0]) > TILTED else normal


def meet(away, d, sag, normal):
    """t where a + t d + 4 t (1 - t) sag lies on the line along the normal, from the chord by Newton's method."""
    def cross(a, b):
        return a[0]*b[1] - a[1]*b[0]

    along = cross(d, normal)
    if abs(along) <= 1e-12*np.linalg.norm(d):
        return None
    t = cross(away, normal)/along
    for _ in range(20):
        slope = cross(d + 4*(1 - 2*t)*sag, normal)
        if not abs(slope) > 0 or abs(t) > 10:
            break
        step = cross(t*d + 4*t*(1 - t)*sag - away, normal)/slope
        t -= step
        if abs(step) < 1e-16:
            break
    return t


# -- exit 0 ---------------------------------------------------------------------------------------------------------------------


class Verdict:
    """Worst share of what is allowed, by kind, and where."""

    def __init__(self):
        self.worst = {}
        self.wrong = []

    def test(self, kind, value, allowed, where):
        share = abs(value)/allowed if allowed > 0 else (0.0 if value == 0 else math.inf)
        if share > self.worst.get(kind, -1.0):
            self.worst[kind] = share
        if not share <= 1:
            self.wrong.append((share, f'{kind} at {where}: {value:.3e}, allowed {allowed:.3e}'))

    def text(self):
        if not self.wrong:
            return 'holds'
        return f'violated: {max(self.wrong)[1]} ({len(self.wrong)} in all)'


def judge_solution(scene, folder):
    verdict = Verdict()
    bodies, owner = build_bodies(scene)
    pairs = [Pair(scene, owner, *names) for names in scene.pairs]
    try:
        u, reaction, contact = read_results(scene, folder, verdict)
    except (OSError, ValueError, KeyError, IndexError) as trouble:
        verdict.wrong.append((math.inf, f'tables: {trouble!r}'))
        return verdict
    fields = [pair_fields(pair, i, contact, verdict) for i, pair in enumerate(pairs, 1)]
    if any(field is None for field in fields):
        return verdict
    largest = max((np.abs(value).max() for value in u.values()), default=0.0)
    for body in bodies:
        body.u = np.array([u[node] for node in body.nodes])
        body.error = MOTION*EPS*np.abs(body.u).max() + np.where(body.u == 0, PRINTED_ZERO*largest, 0.0)
        body.error[body.held & (body.value == 0)] = 0.0
        check_supports(body, largest, verdict)
    for i, (pair, field) in enumerate(zip(pairs, fields), 1):
        check_pair(pair, field, i, owner, verdict)
    check_bodies(bodies, owner, pairs, fields, reaction, verdict)
    return verdict


def read_results(scene, folder, verdict):
    nodes, converged = read_table(os.path.join(folder, 'nodes.tab'))
    if not converged:
        verdict.wrong.append((math.inf, 'marked NOT CONVERGED'))
    used = {node for _, members in scene.elements.values() for node in members}
    number = nodes['node'].astype(int)
    if set(number) < used:
        raise ValueError('nodes are missing')
    size = max(abs(value) for node in used for value in scene.place[node])
    for node, x, y in zip(number, nodes['x'], nodes['y']):
        off = max(abs(x - scene.place[node][0]), abs(y - scene.place[node][1]))
        verdict.test('coordinate', off, 2e-14*size, f'node {node}')
        scene.place[node] = (scene.place[node][0], scene.place[node][1])
    u = {node: np.array([a, b]) for node, a, b in zip(number, nodes['u1'], nodes['u2'])}
    reaction = {}
    if scene.held:
        table, _ = read_table(os.path.join(folder, 'reactions.tab'))
        reaction = {int(node): np.array([a, b]) for node, a, b in zip(table['node'], table['r1'], table['r2'])}
    contact, _ = read_table(os.path.join(folder, 'contact.tab'))
    return u, reaction, contact


def pair_fields(pair, number, contact, verdict):
    """The rows of a pair, or None where they are not those of its points."""
    rows = contact['pair'] == number
    field = {name: column[rows] for name, column in contact.items()}
    where = f'pair {number}'
    if len(field['x']) != len(pair.nodes):
        verdict.wrong.append((math.inf, f'{where} has {len(field["x"])} points, {len(pair.nodes)} expected'))
        return None
    if len(pair.nodes) == 0:
        return field
    size = np.abs(pair.x).max()
    for j in range(len(pair.nodes)):
        verdict.test('point', max(abs(field['x'][j] - pair.x[j, 0]), abs(field['y'][j] - pair.x[j, 1])), 2e-14*size, where)
        verdict.test('weight', field['weight'][j] - pair.weight[j], 1e-11*pair.weight[j] + 16*EPS*size*pair.weight[j]/pair.length[j],
                     where)
    step = np.linalg.norm(np.diff(pair.x, axis=0), axis=1)
    if len(pair.nodes) > 1 and not np.all(np.diff(field['s']) > 0.5*step):
        verdict.wrong.append((math.inf, f'{where}: s does not grow along the slave'))
    field['bound'] = pair.law.nu*(pair.average @ field['pressure'])
    # slip that the law feels, and how uncertain where it counts from is
    field['elastic'], field['drift'] = field['slip'], np.zeros(len(pair.nodes))
    field['zero'] = field['no_shear'] = 0.0  # what is printed as 0 because of other increments: lengths, shears
    return field


def check_supports(body, largest, verdict):
    for i, node in enumerate(body.nodes):
        for dof in range(2):
            if body.held[i, dof]:
                verdict.test('support', body.u[i, dof] - body.value[i, dof], PRINTED_ZERO*largest + 4*EPS*abs(body.value[i, dof]) + 1e-300,
                             f'node {node}')


def relative_motion(pair, j, owner):
    motion = np.zeros(2)
    for node, factor in pair.rows(j):
        body = owner[node]
        motion += factor*body.u[body.index[node]]
    return motion


def printed_digits(pair, j, owner):
    return sum(abs(factor)*owner[node].error[owner[node].index[node]].sum() for node, factor in pair.rows(j))


def check_pair(pair, field, number, owner, verdict):
    """The law at every point, and gap and slip against the displacements."""
    law = pair.law
    p, gap, slip, t = field['pressure'], field['gap'], field['slip'], -field['shear']
    if len(p) == 0:
        return
    motion = np.array([relative_motion(pair, j, owner) for j in range(len(p))])
    printed = np.array([printed_digits(pair, j, owner) for j in range(len(p))])
    u_n, u_t = (motion*pair.normal).sum(axis=1), (motion*pair.tangent).sum(axis=1)
    size = max(np.abs(u_n).max(), np.abs(u_t).max(), law.delta*p.max())
    largest = max(np.abs(body.u).max() for body in pair.bodies)
    places = PLACE*size + (GROWTH*EPS + pair.tilt)*largest + printed + field['zero'] + 1e-300
    bound = field['bound']
    law_scale = LAW*bound.max() + field['no_shear']
    for j in range(len(p)):
        where = f'pair {number} point {j + 1}'
        place, distance = places[j], places[j] + 16*EPS*np.abs(pair.x).max()
        if p[j] < 0:
            verdict.wrong.append((math.inf, f'tension at {where}: {p[j]}'))
        verdict.test('gap of the nodes', gap[j] - (pair.gap0[j] - u_n[j]), distance, where)
        verdict.test('slip of the nodes', slip[j] - u_t[j], place, where)
        if p[j] > 0:
            verdict.test('gap under pressure', gap[j] + law.delta*p[j], distance + 1e-12*law.delta*p[j], where)
        else:
            verdict.test('penetration', min(gap[j], 0.0), distance, where)
        elastic, uncertain = field['elastic'][j], place + field['drift'][j]
        low = law_range(law, bound[j], elastic - uncertain)[0]
        high = law_range(law, bound[j], elastic + uncertain)[1]
        verdict.test('friction', max(low - t[j], t[j] - high, 0.0), law_scale + 1e-300, where)
        verdict.test('friction bound', max(abs(t[j]) - bound[j], 0.0), law_scale + 1e-300, where)
        average = (pair.average @ p)[j]
        verdict.test('weighted pressure', field['weighted_pressure'][j] - average, 1e-12*p.max() + PRINTED_ZERO*p.max() + 1e-300, where)
        check_status(law, field, j, bound[j], uncertain, distance, where, verdict)
    field['place'] = places


def law_range(law, bound, slip):
    """Least and greatest stress that the law allows at a slip."""
    limit = law.eps if law.kind == 'NONLOCAL' else bound/law.slope
    if law.kind == 'NONE' or bound <= 0:
        return 0.0, 0.0
    if abs(slip) > limit:
        return math.copysign(bound, slip), math.copysign(bound, slip)
    if limit > 0:
        return bound*slip/limit, bound*slip/limit
    return -bound, bound


def check_status(law, field, j, bound, place, distance, where, verdict):
    status, p, slip = int(field['status'][j]), field['pressure'][j], abs(field['elastic'][j])
    limit = law.eps if law.kind == 'NONLOCAL' else bound/law.slope
    # a pressure that is round-off is printed as 0, and the point is closed all the same
    good = p == 0 if status == 0 else p > 0 or abs(field['gap'][j]) <= distance
    if status == 1 and p > 0:
        good = good and law.kind != 'NONE' and law.nu > 0 and slip <= limit*(1 + 1e-7) + place
    # where the bound is less than what bounds are found to it may have been none
    if status == 2 and p > 0 and law.kind != 'NONE' and bound > FOUND*field['bound'].max() and limit > 0:
        good = good and slip >= limit*(1 - 1e-7) - place
    if not good:
        verdict.wrong.append((math.inf, f'status {status} at {where}: p {p}, slip {slip}, limit {limit}'))


def contact_forces(pair, field):
    """(node, force upon it, point) of all points."""
    for j in range(len(pair.nodes)):
        force = -pair.weight[j]*(field['pressure'][j]*pair.normal[j] - field['shear'][j]*pair.tangent[j])
        for node, factor in pair.rows(j):
            yield node, factor*force, j


def check_bodies(bodies, owner, pairs, fields, reaction, verdict):
    """Equilibrium of every node and of every body."""
    for body in bodies:
        body.contact = np.zeros_like(body.u)
        body.sizes = np.abs(body.f)
        body.scale = np.full(len(body.nodes), math.inf)
    for pair, field in zip(pairs, fields):
        forces = list(contact_forces(pair, field))
        largest = max((np.abs(force).max() for _, force, _ in forces), default=0.0)
        for node, force, _ in forces:
            body, i = owner[node], owner[node].index[node]
            body.contact[i] += force
            body.sizes[i] += np.abs(force)
            # a pair without any force asks for nothing: the node has the scale of its body
            if largest > 0:
                body.scale[i] = min(body.scale[i], largest)
    # what is below 1e-14 of these is printed as 0
    reactions = max([np.abs(r).max() for r in reaction.values()] + [np.abs(body.f).sum() for body in bodies])
    for body in bodies:
        body.beside = 0.0
    for pair in pairs:
        for body in pair.bodies:
            body.beside = max([body.beside, *(other.sizes.max() for other in pair.bodies)])
    for number, body in enumerate(bodies, 1):
        check_body(body, number, reaction, reactions, verdict)


def check_body(body, number, reaction, reactions, verdict):
    z = body.rigid_motions().reshape(3, -1)
    u = body.u.ravel()
    amplitude = np.linalg.lstsq(z.T, u, rcond=None)[0]
    deformed = u - z.T @ amplitude
    size = np.abs(body.k)
    internal = (body.k @ deformed).reshape(-1, 2)
    uncertain = (size @ body.error.ravel() + GROWTH*EPS*size.sum(axis=1)*np.abs(deformed).max()).reshape(-1, 2)
    load = np.abs(body.f).max()
    force = max(body.sizes.max(), max((np.abs(reaction[node]).max() for node in body.nodes if node in reaction), default=0.0))
    scale = np.maximum(np.minimum(body.scale, force), 0.0)
    residual = internal - body.f - body.contact
    for i, node in enumerate(body.nodes):
        for dof in range(2):
            where = f'body {number} node {node} dof {dof + 1}'
            allowed = uncertain[i, dof] + 1e-300
            own = max(scale[i], abs(body.f[i, dof])) if load > 0 else scale[i]
            if body.held[i, dof]:
                printed = reaction[node][dof] if node in reaction else math.nan
                verdict.test('reaction', residual[i, dof] - printed, allowed + FORCE*force + PRINTED_ZERO*reactions, where)
            else:
                verdict.test('equilibrium', residual[i, dof], allowed + FORCE*own, where)
    # a body that carries nothing rests: what it has of its neighbours' forces may be their round-off
    rest = 100*EPS*body.beside if not np.abs(body.f).any() else 0.0
    for motion in body.free_motions():
        total = (motion*(body.f + body.contact)).sum()
        verdict.test('balance', total, BALANCE*np.abs(motion).max()*body.sizes.sum() + rest + 1e-300, f'body {number}')


# -- exit 4 ---------------------------------------------------------------------------------------------------------------------


def judge_feasibility(scene):
    """Least z with |Z'(f - B'q)| <= z S + e for the free motions Z of every body, over all admissible forces q: p >= 0,
    |t| <= nu S_rho(p). S is the body's own load. e is round-off where large forces cancel: CANCEL of the sum of the forces q that
    meet at the body, these counted up to ten times all loads. `feasible` when z is at most BALANCED, else `infeasible`, and z.

    The pressures q may be MOST_FORCE of all loads, which is what a proof of the program holds for. Without a limit any load is
    balanced between two clamped bodies: a joint between them is level, or its two sides equal and opposite, to 1e-16, and forces of
    1e16 loads make a load of that; with coordinates of ten digits to 1e-10 (two joints without friction along a row of turned blocks
    that should be parallel: seed 20290305/855, forces of 4.4e8 loads). (By exact arithmetic the rows of action and reaction cancel.
    11 decks of seeds 11 and 12 were feasible by forces of 1e12 to 1e16 loads alone.) A joint that slopes by 1e-8 is still a slope."""
    bodies, owner = build_bodies(scene)
    return judge_bodies(bodies, owner, [Pair(scene, owner, *names) for names in scene.pairs])


def judge_bodies(bodies, owner, pairs):
    """The same with the loads that the bodies have."""
    normal, tangential, touched, h, scale = balance_rows(bodies, owner, pairs)
    if not np.abs(h).any():
        return 'feasible', 0.0
    bound = friction_bounds(pairs)
    apart = [stays_open(pair, j, owner) for pair in pairs for j in range(len(pair.nodes))]
    normal[:, apart] = touched[:, apart] = bound[:, apart] = 0.0
    z = least_unbalance(normal, tangential, touched, bound, h, scale)
    return ('infeasible' if z > BALANCED else 'feasible'), z


def balance_rows(bodies, owner, pairs):
    """Rows of the free motions: what unit normal and tangential forces q = w p, w t at the points do in them, which points touch the
    body, the loads' share, and the size of the body's loads."""
    points = [(pair, j) for pair in pairs for j in range(len(pair.nodes))]
    rows = []
    for body in bodies:
        for motion in body.free_motions():
            a, b, touched = np.zeros((3, len(points)))
            for column, (pair, j) in enumerate(points):
                for node, factor in pair.rows(j):
                    if owner[node] is body:
                        at = motion[body.index[node]]
                        a[column] += factor*(at @ pair.normal[j])
                        b[column] += factor*(at @ pair.tangent[j])
                        touched[column] = 1
            # f = B'q, q upon the slave against its normal
            rows.append((a, b, touched, (motion*body.f).sum(), np.abs(body.f).sum()))
    empty = np.zeros((0, len(points)))
    if not rows:
        return empty, empty, empty, np.zeros(0), np.zeros(0)
    return tuple(np.array(column) for column in zip(*rows))


def stays_open(pair, j, owner):
    """Whether supports keep a point open: its motion along the normal is prescribed, and does not close its gap. (A pressure there
    would cost the bodies nothing and give them friction.) Where contact is soft, touching is not enough: its pressure is then known
    from the overlap, which is none."""
    overlap = -pair.gap0[j]
    for node, factor in pair.rows(j):
        body, i = owner[node], owner[node].index[node]
        if factor and (pair.normal[j]*~body.held[i]).any():
            return False
        overlap += factor*(body.value[i] @ pair.normal[j])
    return overlap < math.copysign(16*EPS*np.abs(pair.x).max(), 1 if pair.law.delta > 0 else -1)


def friction_bounds(pairs):
    """|q_t| <= bound q_n, w_j nu W_jk / w_k in the places of a pair."""
    sizes = [len(pair.nodes) for pair in pairs]
    bound = np.zeros((sum(sizes), sum(sizes)))
    first = 0
    for pair, n in zip(pairs, sizes):
        bound[first:first + n, first:first + n] = pair.law.nu*pair.weight[:, None]*pair.average/pair.weight[None, :]
        if pair.law.kind == 'NONE':
            bound[first:first + n, first:first + n] = 0.0
        first += n
    return bound


def exact(array):
    return np.array([Decimal(float(x)) for x in np.ravel(array)], dtype=object).reshape(np.shape(array))


def least_unbalance(normal, tangential, touched, bound, h, scale):
    """The linear programme, by the primal simplex method in decimals of 100 digits, so that loads of any sizes may meet. Its columns
    are the rays of the admissible forces, one pressure each with the friction that it allows in the directions that serve best:
    they are made when they are wanted. Rows: M q - z S - e <= h, -M q - z S - e <= -h, e - N q <= 0, e <= limit, sum q <= most."""
    getcontext().prec = 100
    m = len(h)
    programme = Programme(exact(normal), exact(tangential), exact(bound), exact(touched))
    zero = exact(np.zeros(m))
    limit = exact(np.full(m, 10*CANCEL*scale.sum()))
    most = [MOST_FORCE*sum(exact(scale))]
    b = np.concatenate([exact(h), -exact(h), zero, limit, most])
    # the order of ties: differences far below what is asked for
    b = b + exact(np.abs(h).max()*1e-25*(1 + np.sin(1 + np.arange(4*m + 1))**2))
    s = np.concatenate([exact(scale), exact(scale), zero, zero, exact([0.0])])
    # first basis: z and the slacks of all rows but the worst, whose slack z replaces
    worst = min((i for i in range(2*m) if s[i] > 0), key=lambda i: b[i]/s[i])
    inverse = exact(np.eye(4*m + 1))
    inverse[:, worst] = -s/s[worst]
    inverse[worst, worst] = -1/s[worst]
    value = inverse @ b
    for _ in range(100*(m + normal.shape[1]) + 100):
        if value[worst] <= Decimal(BALANCED)/10:
            return float(max(value[worst], Decimal(0)))
        column = programme.best_column(inverse[worst])
        if column is None:
            return float(value[worst])
        step = inverse @ column
        size = np.abs(inverse) @ np.abs(column)
        leaving = min((i for i in range(4*m + 1) if step[i] > TINY*size[i]), key=lambda i: value[i]/step[i])
        if leaving == worst:
            return 0.0
        pivot(inverse, value, step, leaving)
    raise ArithmeticError('the linear programme does not end')


class Programme:
    def __init__(self, normal, tangential, bound, touched):
        self.normal, self.tangential, self.bound = normal, tangential, bound
        self.sizes = (touched + touched @ bound)*Decimal(CANCEL)
        self.m, self.n = normal.shape

    def best_column(self, y):
        """The column that lowers z most for its size; None at the optimum. y are the multipliers of the rows: z changes by -y'column."""
        m = self.m
        # multipliers that are round-off are none
        y = np.where(np.abs(y) > np.abs(y).max()*NOISE, y, Decimal(0))
        v, w, share_of_most = y[:m] - y[m:2*m], y[2*m:3*m], y[4*m]
        on_t = v @ self.tangential
        gain = v @ self.normal + np.abs(on_t) @ self.bound - w @ self.sizes + share_of_most
        size = np.abs(v) @ np.abs(self.normal) + (np.abs(v) @ np.abs(self.tangential)) @ self.bound + np.abs(w) @ self.sizes \
            + abs(share_of_most)
        share = [g/q if q > 0 else Decimal(0) for g, q in zip(gain, size)]
        k = max(range(self.n), key=lambda i: share[i], default=None)
        if k is not None and share[k] > TINY:
            return self.ray(k, on_t)
        allowance = y[2*m:3*m] + y[3*m:4*m] - y[:m] - y[m:2*m]
        i = max(range(m), key=lambda i: allowance[i])
        if allowance[i] > TINY*np.abs(y).max():
            unit = np.eye(m)[i]
            return exact(np.concatenate([-unit, -unit, unit, unit, [0.0]]))
        i = max(range(4*m + 1), key=lambda i: y[i])
        return exact(np.eye(4*m + 1)[i]) if y[i] > TINY*np.abs(y).max() else None

    def ray(self, k, on_t):
        sign = np.array([Decimal(1) if x > 0 else Decimal(-1) for x in on_t], dtype=object)
        force = self.normal[:, k] + self.tangential @ (sign*self.bound[:, k])
        return np.concatenate([force, -force, -self.sizes[:, k], exact(np.append(np.zeros(self.m), 1.0))])


def pivot(inverse, value, step, leaving):
    inverse[leaving] = inverse[leaving]/step[leaving]
    value[leaving] = value[leaving]/step[leaving]
    for i in range(len(value)):
        if i != leaving and step[i]:
            inverse[i] = inverse[i] - step[i]*inverse[leaving]
            value[i] = value[i] - step[i]*value[leaving]


def main():
    with open(sys.argv[1]) as deck:
        scene = read_deck(deck.read())
    if len(sys.argv) > 2:
        verdict = judge_solution(scene, sys.argv[2])
        print(verdict.text())
        for kind, share in sorted(verdict.worst.items()):
            print(f'   {kind}: {share:.2e} of what is allowed')
        return 1 if verdict.wrong else 0
    word, z = judge_feasibility(scene)
    print(f'{word} {z:.3e}')
    return 0 if word == 'infeasible' else 1


if __name__ == '__main__':
    sys.exit(main())
