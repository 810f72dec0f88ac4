"""Statics of rigid bodies with exact smooth sides: whether forces of contact can balance the loads, how large they need to be, and
which motions what is closed leaves free. Knows nothing of meshes but the ends of the sides."""

import math

import numpy as np

from curved_meshes import Line

NEAR = 1e-4        # of the size of a pair: what touches without large motions
MARGIN = 0.1       # of friction: what both less and more of it balance is sure
HARDLY = 300.0     # contact forces over loads beyond which a balance is a matter of digits


class Samples:
    """Points of a side on its exact curves: x, outward normals, curve of each."""

    def __init__(self, mesh, name, per_face=6):
        x, normals, curves = [], [], []
        for number, face in mesh.side(name):
            curve = mesh.outline[mesh.faces[number, face]][1]
            a, b = (mesh.x[i] for i in mesh.face_nodes(number, face)[:2])
            for t in (np.arange(per_face) + 0.5)/per_face:
                at = curve.project(a + t*(b - a))
                x.append(at)
                normals.append(curve.normal(at))
                curves.append(curve)
        self.take(x, normals, curves)

    def take(self, x, normals, curves):
        self.x, self.n, self.curves = np.array(x), np.array(normals), curves
        self.size = np.ptp(self.x, axis=0).max()
        self.pieces = {}
        for i, curve in enumerate(curves):
            self.pieces.setdefault(id(curve), (curve, []))[1].append(i)
        step = np.linalg.norm(np.diff(self.x, axis=0), axis=1) if len(x) > 1 else np.array([0.0])
        self.spacing = {key: max(np.median(step)*3, self.size/40) for key in self.pieces}

    @classmethod
    def of_rigid(cls, pieces, per_piece=60):
        """pieces: (curve, points from end to end)."""
        samples = cls.__new__(cls)
        x, normals, curves = [], [], []
        for curve, ends in pieces:
            for t in (np.arange(per_piece) + 0.5)/per_piece:
                at = ends(t)
                x.append(at)
                normals.append(curve.normal(at))
                curves.append(curve)
        samples.take(x, normals, curves)
        return samples

    def meet(self, x, normal, is_straight):
        """(gap, normal upon the slave's side) of the nearest piece that x faces: that of a straight side counts."""
        best = None
        for key, (curve, members) in self.pieces.items():
            n = normal if is_straight or not isinstance(curve, Line) else -curve.normal(x)
            gap = distance_along(x, n, curve)
            if gap is None:
                continue
            y = x + gap*n
            nearest = members[int(np.argmin(((self.x[members] - y)**2).sum(axis=1)))]
            if np.linalg.norm(self.x[nearest] - y) > self.spacing[key] or curve.normal(y) @ n > -0.2:
                continue
            if normal @ n < 0.2 or gap < -0.2*self.size:
                continue
            if best is None or abs(gap) < abs(best[0]):
                best = (gap, n)
        return best


def distance_along(x, n, curve):
    if isinstance(curve, Line):
        slope = curve.normal(x) @ n
        return None if abs(slope) < 1e-3 else float(((curve.a - x) @ curve.normal(x))/slope)
    away = x - curve.centre
    b, c = away @ n, away @ away - curve.radius**2
    if b*b < c:
        return None
    root = math.sqrt(b*b - c)
    # into the circle's wall from within, or onto it from outside
    return -b + root if curve.outward < 0 else -b - root


def nearest_points(slave, master):
    """(x, normal, curve) of the slave where two curves are nearest."""
    for curve, members in slave.pieces.values():
        for other, _ in master.pieces.values():
            if isinstance(curve, Line) and isinstance(other, Line):
                continue
            if isinstance(other, Line):
                toward = -other.normal(None)*curve.outward
            elif isinstance(curve, Line):
                toward = curve.normal(None)
            else:
                toward = (curve.centre - other.centre)*(1 if other.outward < 0 else -1)*(1 if curve.outward > 0 else -1)
            if np.linalg.norm(toward) < 1e-9*slave.size:
                continue
            toward = toward/np.linalg.norm(toward)
            x = curve.project(other.centre) if isinstance(curve, Line) else curve.centre + curve.radius*toward
            near = slave.x[members]
            if np.linalg.norm(near - x, axis=1).min() < slave.spacing[id(curve)]:
                yield x, curve.normal(x), curve


def points_of_pair(slave, master):
    """(x, normal out of the slave, gap) of samples of the slave's side."""
    found = []
    for x, n, curve in [*zip(slave.x, slave.n, slave.curves), *nearest_points(slave, master)]:
        sight = master.meet(x, n, isinstance(curve, Line))
        if sight:
            found.append((x, sight[1], sight[0]))
    return found


def row(x, direction, about, size):
    """What a force along `direction` at x does to a body, moments over a size: and the motion along it."""
    away = (x - about)/size
    return np.array([direction[0], direction[1], away[0]*direction[1] - away[1]*direction[0]])


class Frame:
    """Bodies as rigid: forces and moments about the middle of each, over its size."""

    def __init__(self, middles, sizes):
        self.n, self.middles, self.sizes = len(sizes), middles, sizes

    def column(self, parts):
        """parts: (body, x, force); body None is the ground."""
        b = np.zeros(3*self.n)
        for body, x, force in parts:
            if body is not None:
                b[3*body:3*body + 3] += row(np.asarray(x), force, self.middles[body], self.sizes[body])
        return b

    def moment(self, body, force, moment, at):
        b = self.column([(body, at, force)])
        b[3*body + 2] += moment/self.sizes[body]
        return b


def rays(frame, slave, master, x, n, nu):
    t = np.array([-n[1], n[0]])
    for sign in ((1, -1) if nu > 0 else (0,)):
        force = -n + sign*nu*t
        yield frame.column([(slave, x, force), (master, x, -force)])


def balance(columns, supports, load, weight=1e-5):
    """Least squares with forces that push: what is left over of the load, and the sum of the forces that do it, over the load."""
    scale = np.linalg.norm(load)
    if scale == 0:
        return 0.0, 0.0
    both = [*columns, *supports, *(-s for s in supports)]
    if not both:
        return 1.0, 0.0
    a = np.array(both).T
    least = np.concatenate([np.full(len(columns), weight), np.zeros(2*len(supports))])
    q = nonnegative(np.vstack([a, least]), np.append(-load/scale, 0.0))
    return float(np.linalg.norm(a @ q + load/scale)), float(q[:len(columns)].sum())


def nonnegative(a, b):
    """The least |a q - b| with q >= 0, by Lawson's and Hanson's method."""
    n = a.shape[1]
    q, active = np.zeros(n), np.zeros(n, bool)
    for _ in range(6*a.shape[0] + 60):
        gradient = a.T @ (b - a @ q)
        gradient[active] = -np.inf
        k = int(np.argmax(gradient))
        if gradient[k] <= 1e-13:
            break
        active[k] = True
        while True:
            chosen = np.flatnonzero(active)
            s = np.linalg.lstsq(a[:, chosen], b, rcond=1e-14)[0]
            if (s > 0).all():
                q[:] = 0
                q[chosen] = s
                break
            now = q[chosen]
            bad = s <= 0
            step = np.min(now[bad]/np.maximum(now[bad] - s[bad], 1e-300))
            now = now + step*(s - now)
            now[bad & (now <= 1e-14)] = 0
            if not (now[bad] == 0).any():
                now[np.flatnonzero(bad)[0]] = 0
            q[:] = 0
            q[chosen] = now
            active = q > 0
            if not active.any():
                break
    return q


def free_motions(rows, supports, n):
    """Motions that supports and rows leave (columns), and how far the next one is from being free: rows are of length 1."""
    left = null_space(supports, n)[0]
    if not len(rows):
        return left, math.inf
    a = np.array(rows)
    inner, least = null_space(list((a/np.maximum(np.linalg.norm(a, axis=1), 1e-300)[:, None]) @ left), left.shape[1])
    return left @ inner, least


def null_space(rows, n):
    if not len(rows) or n == 0:
        return np.eye(n), math.inf
    a = np.array(rows)
    _, s, v = np.linalg.svd(a)
    s = np.concatenate([s, np.zeros(n - len(s))])
    free = s < 1e-7*max(np.linalg.norm(a, axis=1).max(), 1e-300)
    return v[free].T, (s[~free].min() if (~free).any() else math.inf)
