"""Judges a run of a curved scene by statics, by what the smooth shapes say, and by the same scene with weak springs.

The forces of contact are found from the displacements alone: stiffness times displacements, less the loads, with elements of its own
(judge.py). What is allowed: round-off as in judge.py for equilibrium; for directions of contact forces the resolution of a curve,
which is the angle of a face where sides are chords, half its square where they are parabolas, and nothing on straight sides.
"""

import copy
import math
import os
import sys

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import curved_scenes
import curved_statics as statics
import judge
from curved_meshes import Line
from scene_reader import read_table

EXCESS = 20.0      # contact forces over the least that balance the loads
STIFF = 10.0       # and over what an overlap asks for
ALIKE = 2e-3       # pressures with and without weak springs, of the largest
LEAST = 10.0       # the idle motion over all others
UNEVEN = 1.3       # normals of nodes between faces of different lengths
SURE = 0.2         # a motion that what is closed resists by less may be free or not
DIGITS = 5.0       # units in the last place of a load, by which it makes a moment


class Verdict:
    def __init__(self):
        self.wrong, self.unsure, self.numbers = [], [], {}

    def test(self, what, value, allowed, where=''):
        self.numbers[what] = max(self.numbers.get(what, 0.0), value/allowed if allowed > 0 else (math.inf if value > 0 else 0.0))
        if not value <= allowed:
            self.wrong.append(f'{what}{where}: {value:.3g}, {allowed:.3g} allowed')


class Tables:
    def __init__(self, scene, folder):
        nodes, self.converged = read_table(os.path.join(folder, 'nodes.tab'))
        u = dict(zip(nodes['node'].astype(int), np.stack([nodes['u1'], nodes['u2']], axis=1)))
        self.u = [np.array([u[body.first + i + 1] for i in range(len(body.mesh.x))]) for body in scene.bodies]
        self.contact, _ = read_table(os.path.join(folder, 'contact.tab'))
        self.notes = ' '.join(open(os.path.join(folder, name)).read() for name in os.listdir(folder) if name.endswith('.lst'))
        self.notes = ' '.join(self.notes.split())
        self.reaction = {}
        if scene.supports:
            table, _ = read_table(os.path.join(folder, 'reactions.tab'))
            self.reaction = {int(n): np.array([a, b]) for n, a, b in zip(table['node'], table['r1'], table['r2'])}

    def pair(self, number):
        rows = self.contact['pair'] == number
        return {name: values[rows] for name, values in self.contact.items()}


def stiffness(scene, body):
    mesh = body.mesh
    n = len(mesh.x)
    k = np.zeros((2*n, 2*n))
    d = judge.elasticity(scene.plane, body.e, body.mu)
    for cell in mesh.cells:
        own, _ = judge.element_matrix(scene.plane, mesh.x[cell], d, scene.thickness)
        dofs = np.array([[2*i, 2*i + 1] for i in cell]).ravel()
        k[np.ix_(dofs, dofs)] += own
    return k


def nodal_loads(scene, number):
    body = scene.bodies[number]
    f = np.zeros((len(body.mesh.x), 2))
    for load in scene.loads:
        if load.body != number:
            continue
        if load.pressure is None:
            x = (body.ideal if scene.is_plain else body.mesh.x)[load.nodes]
            f[load.nodes] += curved_scenes.distributed(x, load)
            continue
        for cell, face in body.mesh.side(load.side):
            nodes = body.mesh.face_nodes(cell, face)
            for t, weight in zip(*judge.GAUSS[3]):
                value, slope = judge.face_shapes(len(nodes), t)
                along = slope @ body.mesh.x[nodes]
                f[nodes] += np.outer(value, np.array([-along[1], along[0]])*(load.pressure*weight*scene.thickness))
    return f


def forces_upon(scene, tables):
    """Of each body: forces at its nodes that are no loads, and how uncertain they are."""
    found = []
    for number, body in enumerate(scene.bodies):
        k, u, f = stiffness(scene, body), tables.u[number], nodal_loads(scene, number)
        away = body.mesh.x - body.mesh.x.mean(axis=0)
        away /= np.abs(away).max()
        z = np.zeros((3, len(u), 2))
        z[0, :, 0] = z[1, :, 1] = 1
        z[2] = np.stack([-away[:, 1], away[:, 0]], axis=1)
        z = z.reshape(3, -1)
        deformed = u.ravel() - z.T @ np.linalg.lstsq(z.T, u.ravel(), rcond=None)[0]
        size = np.abs(k).sum(axis=1)
        error = size*judge.EPS*(judge.MOTION*np.abs(u).max() + judge.GROWTH*np.abs(deformed).max())
        found.append((((k @ deformed).reshape(-1, 2) - f), error.reshape(-1, 2), np.abs(f).max(initial=0.0)))
    return found


# -- exact normals of what is closed --------------------------------------------------------------------------------------------


def exact_normal(scene, pair, samples, x, faces=()):
    """Of the slave at x, or against a straight master's; whether either side is straight there. `faces`: middles of those of a node,
    which may face the master where the node itself looks past it."""
    slave = samples[0]
    piece = min((curve for curve, _ in slave.pieces.values()), key=lambda curve: np.linalg.norm(curve.project(x) - x))
    n = piece.normal(x)
    if isinstance(piece, Line):
        return n, True
    straight = [curve for curve, _ in samples[1].pieces.values() if isinstance(curve, Line)
                and max(-curve.normal(x) @ piece.normal(at) for at in (x, *faces)) > 0.2]
    if straight:
        nearest = min(straight, key=lambda curve: abs((curve.a - x) @ curve.normal(x)))
        return -nearest.normal(x), True
    return n, False


def face_angle(mesh, side):
    """Largest angle of a face of a curved side; and whether its faces are chords."""
    largest, is_chord = 0.0, False
    for number, face in mesh.side(side):
        curve = mesh.outline[mesh.faces[number, face]][1]
        if isinstance(curve, Line):
            continue
        nodes = mesh.face_nodes(number, face)
        a, b = mesh.x[nodes[:2]]
        largest = max(largest, np.linalg.norm(b - a)/curve.radius)
        if len(nodes) == 2 or np.linalg.norm(curve.project(mesh.x[nodes[2]]) - mesh.x[nodes[2]]) > 1e-3*largest**2*curve.radius:
            is_chord = True
    return largest, is_chord


def resolution(scene, pair):
    """What is not known of a normal, in radians: from both sides. That of a straight side is known."""
    worst = 0.0
    for body, side in (pair.slave, pair.master):
        if body is None:
            if all(isinstance(curve, Line) for curve, _ in side.pieces):
                return 0.0
            continue
        if all(isinstance(curve, Line) for _, curve in scene.bodies[body].mesh.curves(side)):
            return 0.0
        angle, is_chord = face_angle(scene.bodies[body].mesh, side)
        worst = max(worst, angle if is_chord else 0.5*angle*angle)
    return UNEVEN*worst


def closed_rows(scene, tables):
    """Rigid motions that what is closed leaves, by three readings: with all held that points which touch may hold; with what
    pressure and sticking hold; with what pressure alone does. Of each the motions, and how little the next one is held."""
    frame = scene.frame()
    rows = [[], [], []]
    for number, pair in enumerate(scene.pairs, 1):
        samples = scene.samples(pair.slave), scene.samples(pair.master)
        field = tables.pair(number)
        moved = max(np.abs(tables.u[b]).max() for b, _ in (pair.slave, pair.master) if b is not None)
        touching = 1e-3*moved + 1e-9*scene.size + 4*scene.grain
        for x, y, p, gap, status in zip(*(field[name] for name in ('x', 'y', 'pressure', 'gap', 'status'))):
            pushes = p > 1e-9*field['pressure'].max()
            if not pushes and gap > touching:
                continue
            at = np.array([x, y])
            n, _ = exact_normal(scene, pair, samples, at)
            columns = [frame.column([(pair.slave[0], at, d), (pair.master[0], at, -d)]) for d in (n, np.array([-n[1], n[0]]))]
            rows[0] += columns if pair.nu > 0 and pushes else columns[:1]
            if pushes:
                rows[1] += columns if pair.nu > 0 and status == 1 else columns[:1]
                rows[2] += columns[:1]
    return [statics.free_motions(those, scene.support_columns(frame), 3*len(scene.bodies)) for those in rows]


def nodal_motion(scene, motion):
    frame, found = scene.frame(), []
    for b, body in enumerate(scene.bodies):
        away = (body.mesh.x - frame.middles[b])/frame.sizes[b]
        a = motion[3*b:3*b + 3]
        found.append(np.stack([a[0] - a[2]*away[:, 1], a[1] + a[2]*away[:, 0]], axis=1))
    return np.concatenate(found).ravel()


def without(z, u):
    """What is left of displacements beside some motions, and the part of these."""
    if z.shape[1] == 0:
        return u, np.zeros_like(u)
    a = np.linalg.lstsq(z, u, rcond=None)[0]
    return u - z @ a, z @ a


# -- verdicts -------------------------------------------------------------------------------------------------------------------


def judge_run(scene, folder, warnings, least):
    """Statics, the law, and motions that are free. `least`: sum of contact forces that balance the loads."""
    verdict = Verdict()
    tables = Tables(scene, folder)
    if not tables.converged:
        verdict.wrong.append('marked NOT CONVERGED')
    forces = forces_upon(scene, tables)
    check_equilibrium(scene, tables, forces, verdict)
    total = 0.0
    for number, pair in enumerate(scene.pairs, 1):
        total += check_pair(scene, tables, forces, number, as_solved(scene, pair, tables.notes), verdict)
    loads = sum(np.abs(nodal_loads(scene, b)).sum() for b in range(len(scene.bodies)))
    verdict.test('contact forces', total, EXCESS*least + 10*loads + STIFF*asked_by_overlap(scene) + 1e-300)
    verdict.tables = tables
    check_idle(scene, tables, warnings, verdict)
    return verdict


def check_equilibrium(scene, tables, forces, verdict):
    largest = max([np.abs(c).max() for c, _, _ in forces] + [f for _, _, f in forces])
    # what one body does not know of its forces the others get by contact
    others = max(error.max() for _, error, _ in forces)
    for number, body in enumerate(scene.bodies):
        c, error, load = forces[number]
        held = {node for b, nodes, _ in scene.supports if b == number for node in nodes}
        touching = set()
        for pair in scene.pairs:
            for side in (pair.slave, pair.master):
                if side[0] == number:
                    touching |= set(body.mesh.side_nodes(side[1]))
        scale, size = max(np.abs(c).max(), load), np.ptp(body.mesh.x, axis=0).max()
        for node in range(len(c)):
            # a load that the digits of the deck alone turn or shift is none, and the program may share it out
            allowed = (judge.FORCE + 8*scene.grain/size)*scale + 1e-13*largest + others
            if node in held and node not in touching:
                printed = tables.reaction.get(body.first + node + 1, np.zeros(2))
                verdict.test('reaction', np.abs(c[node] - printed).max(), allowed, f' at node {body.first + node + 1}')
            elif node not in touching:
                verdict.test('equilibrium', np.abs(c[node]).max(), allowed, f' at node {body.first + node + 1}')


def as_solved(scene, pair, notes):
    """The pair with its roles exchanged, where the listing says so."""
    if f'[N-ROLES] the slave {scene.side_name(pair.slave).upper()} is ' not in notes:
        return pair
    turned = copy.copy(pair)
    turned.slave, turned.master = pair.master, pair.slave
    return turned


def check_pair(scene, tables, forces, number, pair, verdict):
    """The sum of its forces, found from the displacements."""
    where = f' of pair {number}'
    field = tables.pair(number)
    p, shear = field['pressure'], field['shear']
    if not len(p):
        return 0.0
    verdict.test('tension', max(-p.min(), 0.0), 0.0, where)
    verdict.test('friction bound', max((np.abs(shear) - pair.nu*field['weighted_pressure']).max(), 0.0), 1e-7*pair.nu*p.max() + 1e-300,
                 where)
    moved = max(np.abs(tables.u[b]).max() for b, _ in (pair.slave, pair.master) if b is not None)
    place = 1e-9*moved + 1e-12*scene.size + 4*np.abs(np.stack([field['x'], field['y']])).max()*judge.EPS
    verdict.test('penetration', max(-field['gap'].min(), 0.0), place, where)
    verdict.test('gap under pressure', np.abs(field['gap'][p > 0]).max(initial=0.0), place, where)
    body = scene.bodies[pair.slave[0]]
    c, error, load = forces[pair.slave[0]]
    held = {node for b, nodes, _ in scene.supports if b == pair.slave[0] for node in nodes}
    # a node of two pairs has the forces of both
    for other in scene.pairs:
        for side in (other.slave, other.master):
            if side[0] == pair.slave[0] and (other is not pair or side[1] != pair.slave[1]):
                held |= set(body.mesh.side_nodes(side[1]))
    samples = scene.samples(pair.slave), scene.samples(pair.master)
    known = resolution(scene, pair)
    faces = [body.mesh.face_nodes(*face) for face in body.mesh.side(pair.slave[1])]
    spacing = np.median([np.linalg.norm(np.subtract(*body.mesh.x[ends[:2]])) for ends in faces])
    nodes = [node for node in body.mesh.side_nodes(pair.slave[1]) if node not in held]
    largest = np.abs(c[nodes]).max(initial=0.0)
    # over the nodes of a quadratic slave MORTAR spreads the force of a point: only sums have a sign there
    is_by_node = pair.quadrature == 'NODAL' or pair.master[0] is None or len(body.mesh.cells[0]) <= 4
    pushed = unknown = 0.0
    for node in nodes:
        middles = [body.mesh.x[ends[:2]].mean(axis=0) for ends in faces if node in ends]
        n, is_straight = exact_normal(scene, pair, samples, body.mesh.x[node], middles)
        unknown = max(unknown, 0.0 if is_straight else known)
        angle = 1e-6 + 8*scene.grain/spacing + (0.0 if is_straight else known)
        normal, tangential = c[node] @ n, abs(c[node] @ np.array([-n[1], n[0]]))
        small = (1e-6 + 8*scene.grain/spacing)*max(largest, load) + error[node].max()
        at = f' at node {body.first + node + 1}'
        if is_by_node:
            verdict.test('pulling force', normal, angle*largest + small, at)
            # within the cone of friction about a normal that may be off by `angle`
            leans = math.tan(min(math.atan(pair.nu) + angle, 1.5))
            verdict.test('tangential force', tangential, leans*abs(normal) + small, at)
        pushed -= normal
    total = (field['weight']*p).sum()
    if not held & set(body.mesh.side_nodes(pair.slave[1])):
        # a moment that the digits make of the loads is shared out among all nodes
        allowed = (1e-6 + unknown**2 + pair.nu*unknown)*max(total, abs(pushed)) + 8*scene.grain/spacing*max(total, abs(pushed), load) \
            + 2*len(nodes)*error.max()
        verdict.test('sum of pressures', abs(total - pushed), allowed, where)
    return max(total, pushed)


def asked_by_overlap(scene):
    """A force of the order that pushes overlaps apart: those of the smooth shapes, of chords, of the last digit."""
    total = 0.0
    for pair in scene.pairs:
        points = statics.points_of_pair(scene.samples(pair.slave), scene.samples(pair.master))
        overlap = max([-gap for _, _, gap in points] + [0.0]) + 4*scene.grain
        for body, side in (pair.slave, pair.master):
            if body is not None:
                angle, is_chord = face_angle(scene.bodies[body].mesh, side)
                radius = max([curve.radius for _, curve in scene.bodies[body].mesh.curves(side) if not isinstance(curve, Line)] + [0.0])
                overlap += radius*(angle**2/8 if is_chord else angle**4/100)
        stiff = max(scene.bodies[b].e for b, _ in (pair.slave, pair.master) if b is not None)
        total += 2*math.pi*stiff*scene.thickness*overlap
    return total


def check_idle(scene, tables, warnings, verdict):
    """W-IDLE where, and only where, something can move; and the least motion."""
    (surely, _), (sticking, next_one), (perhaps, _) = closed_rows(scene, tables)
    verdict.free, verdict.is_hardly_held = perhaps, next_one < SURE
    told = 'W-IDLE' in warnings
    if surely.shape[1] > 0:
        if not told:
            verdict.wrong.append(f'no W-IDLE: {surely.shape[1]} motions are free')
        z = np.stack([nodal_motion(scene, motion) for motion in surely.T], axis=1)
        rest, idle = without(z, np.concatenate(tables.u).ravel())
        verdict.test('idle motion', np.abs(idle).max(), LEAST*np.abs(rest).max() + 1e-12*scene.size)
    elif sticking.shape[1] > 0 or next_one < SURE:
        verdict.unsure.append('whether a motion is free')
    elif told:
        verdict.wrong.append('W-IDLE, and no motion is free')


def compare_with_springs(scene, verdict, folder, warnings):
    """The same scene with weak springs: pressures, and displacements beside the motions that are free."""
    plain, held = verdict.tables, Tables(scene, folder)
    if 'W-IDLE' in warnings:
        verdict.wrong.append('W-IDLE, though springs hold all bodies')
    springs = 0.0
    for number in scene.idle_bodies():
        body = scene.bodies[number]
        springs += sum(curved_scenes.WEAK*body.e*scene.thickness*abs(held.u[number][node, dof]) for node, dof in scene.spring_nodes(number))
    forces = max(np.abs(nodal_loads(scene, b)).sum() for b in range(len(scene.bodies)))
    for number, pair in enumerate(scene.pairs, 1):
        p, q = plain.pair(number), held.pair(number)
        forces = max(forces, (q['weight']*q['pressure']).sum())
    angle = max(resolution(scene, pair) for pair in scene.pairs)
    allowed = ALIKE + (0.5*angle if verdict.free.shape[1] else 0.0)
    # a moment that the digits make turns what nothing holds: it is no load there, where springs hold it
    moment = DIGITS*scene.grain/scene.size if verdict.free.shape[1] else 0.0
    for number, pair in enumerate(scene.pairs, 1):
        p, q = plain.pair(number)['pressure'], held.pair(number)['pressure']
        scale = max(q.max(initial=0.0), 0.01*forces/(scene.size*scene.thickness))
        # of a pair that bears little the springs bear more
        own = max((held.pair(number)['weight']*q).sum(), 0.01*forces)
        verdict.test('pressure with springs', np.abs(p - q).max(initial=0.0)/scale if scale > 0 else 0.0,
                     allowed + moment + (20*springs/own if own > 0 else 0.0), f' of pair {number}')
    z = np.stack([nodal_motion(scene, motion) for motion in verdict.free.T], axis=1) if verdict.free.shape[1] else np.zeros((1, 0))
    a, b = np.concatenate(plain.u).ravel(), np.concatenate(held.u).ravel()
    difference, idle = without(z, a - b)
    scale = max(np.abs(without(z, b)[0]).max(), 1e-300)
    # weak springs let a load that is the last digit of the deck move a body far, along a side of which the digits tell so much
    turned = 2*scene.grain/scene.size*np.abs(idle).max()
    if forces > 0:
        verdict.test('displacement with springs', np.abs(difference).max()/scale, allowed + 20*springs/forces + turned/scale)
