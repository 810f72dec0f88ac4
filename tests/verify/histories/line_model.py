"""Half planes on their common line by boundary elements, with Coulomb friction in increments: a model of its own that shares nothing
with the program nor, but for what it is compared with, with mindlin.py. python3 with numpy.

    python3 line_model.py            Cattaneo and Mindlin: tractions and dissipation against the closed forms
    python3 line_model.py ramp       P and T that grow together: q(0)/(nu p0) against the number of increments

Constant tractions on elements of equal length; relative displacements at their middles (the logarithmic kernel; its constant
does not matter, as the shear force is given, not the shift). Two equal half planes do not couple: p and q are found one after the other.
Lengths over a, tractions over p0, displacements over p0 a/E*.
"""
import math
import sys

import numpy

import mindlin


def influence(x, h):
    """Relative displacement at x_i by a unit traction on the element around x_j: (-2/(pi E*)) int ln|x - s| ds, up to a constant."""
    def primitive(t):
        size = numpy.abs(t)
        return numpy.where(size > 0, t*(numpy.log(numpy.where(size > 0, size, 1)) - 1), 0)
    d = x[:, None] - x[None, :]
    return -2/math.pi*(primitive(d + h/2) - primitive(d - h/2))


def press(a, x, h, force):
    """Pressures of the indenter x^2/(2 R) with R such that force pi/2 gives a = 1, p0 = 1: 1/R = 2 (over p0/(E* a))."""
    touching = numpy.abs(x) < math.sqrt(force/(math.pi/2))*1.05
    while True:
        k = numpy.flatnonzero(touching)
        m = numpy.zeros((k.size + 1, k.size + 1))
        m[:-1, :-1] = a[numpy.ix_(k, k)]
        m[:-1, -1] = -1
        m[-1, :-1] = h
        p = numpy.linalg.solve(m, numpy.append(-x[k]**2, force))[:-1]
        if (p >= 0).all():
            full = numpy.zeros(x.size)
            full[k] = p
            return full
        touching[k[p < 0]] = False


def shear(a, h, limit, force, rest):
    """Shear tractions within +-limit, and their slip shift - a q - rest: 0 where they are smaller, along them where not."""
    side = numpy.zeros(limit.size)
    touching = limit > 0
    for _ in range(1000):
        k = numpy.flatnonzero(touching & (side == 0))
        q = side*limit
        m = numpy.zeros((k.size + 1, k.size + 1))
        m[:-1, :-1] = a[numpy.ix_(k, k)]
        m[:-1, -1] = -1
        m[-1, :-1] = h
        solution = numpy.linalg.solve(m, numpy.append(-rest[k] - (a @ q)[k], force - h*q.sum()))
        q[k] = solution[:-1]
        slip = solution[-1] - a @ q - rest
        over = touching & (side == 0) & (numpy.abs(q) > limit*(1 + 1e-12))
        back = touching & (side*slip < -1e-13)
        if not over.any() and not back.any():
            return q, slip
        side[over] = numpy.sign(q[over])
        side[back] = 0
    raise RuntimeError("no shear tractions found")


class Line:
    def __init__(self, n):
        self.h = 2.2/n
        self.x = (numpy.arange(n) + 0.5)*self.h - 1.1
        self.a = influence(self.x, self.h)
        self.rest = numpy.zeros(n)      # relative displacement at the end of the last increment
        self.work = 0.0

    def go(self, p, force):
        """One increment with friction coefficient 1; the dissipation is traction times slip, summed. What is open moves freely."""
        q, slip = shear(self.a, self.h, p, force, self.rest)
        self.work += self.h*(q*slip).sum()
        self.rest = self.rest + slip
        return q


def history(n, tau, increments):
    """P, then T to tau, to -tau, to tau and to -tau: the tractions at the ends, dissipation of the loading and of the loop after it."""
    line = Line(n)
    p = press(line.a, line.x, line.h, math.pi/2)
    full = math.pi/2*tau
    line.go(p, 0.0)
    ends = []
    works = []
    last = 0.0
    for target in (full, -full, full, 0.0):
        for k in range(1, increments + 1):
            q = line.go(p, last + (target - last)*k/increments)
        last = target
        ends.append(q)
        works.append(line.work)
    return line, p, ends, works


def compare():
    good = True
    n = 330
    for tau in (0.25, 0.5, 0.75):
        line, p, ends, works = history(n, tau, 4)
        inner = numpy.abs(line.x) < 0.99
        for q, back, what in ((ends[0], tau, "loading"), (ends[1], -tau, "reversal"), (ends[2], tau, "return"), (ends[3], 0.0, "unloading")):
            exact = numpy.array([mindlin.reversed_traction(x, tau, back) if abs(x) < 1 else 0.0 for x in line.x])
            kinks = (mindlin.stick(tau), mindlin.reverse_stick(tau, back))
            away = inner & numpy.array([all(abs(abs(x) - c) > 2*line.h for c in kinks) for x in line.x])
            good &= mindlin.require(f"tau {tau}: {what}: largest difference of q", numpy.abs(q - exact)[away].max(), 0, 0.01)
        for found, exact, what in ((works[0], mindlin.loading_work(tau), "loading"), (works[2] - works[0], mindlin.loop_work(tau), "loop")):
            good &= mindlin.require(f"tau {tau}: dissipation of the {what}", found*4/math.pi**2, exact, 0.01*exact)
    return good


def ramp():
    """P and T = P/2 grow together in equal increments of force, and in increments equal in a (force as the square)."""
    n = 440
    for power, what in ((1, "equal in force"), (2, "equal in a")):
        for increments in (1, 2, 5, 10, 20, 50):
            line = Line(n)
            for k in range(1, increments + 1):
                force = math.pi/2*(k/increments)**power
                p = press(line.a, line.x, line.h, force)
                q = line.go(p, 0.5*force)
            middle = numpy.argmin(numpy.abs(line.x))
            slips = int((numpy.abs(numpy.abs(q) - p)[p > 0] < 1e-9).sum())
            print(f"{increments:3d} increments {what}: q(0)/(nu p0) = {q[middle]/p[middle]:.4f}, slip on {slips} of {(p > 0).sum()} elements")


if __name__ == "__main__":
    if sys.argv[1:] == ["ramp"]:
        ramp()
    else:
        sys.exit(0 if compare() else 1)
