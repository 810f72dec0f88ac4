"""Shape functions and quadrature of elements with 3, 4, 6, 8 and 9 nodes: no code of the program."""

import functools
import math

import numpy as np

CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
NINE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]], float)
GAUSS = {2: (np.array([-1, 1])/math.sqrt(3), np.array([1.0, 1.0])),
         3: (np.array([-math.sqrt(0.6), 0, math.sqrt(0.6)]), np.array([5, 8, 5])/9)}
POINTS = {4: 2, 8: 3, 9: 3}  # a direction
INSIDE = {3: [(1/3, 1/3, 0.5)], 6: [(1/6, 1/6, 1/6), (2/3, 1/6, 1/6), (1/6, 2/3, 1/6)]}


def line_shapes(order, t):
    """Values and derivatives of the Lagrange polynomials at -1, 1 or -1, 0, 1."""
    if order == 1:
        return {-1: ((1 - t)/2, -0.5), 1: ((1 + t)/2, 0.5)}
    return {-1: (t*(t - 1)/2, t - 0.5), 0: (1 - t*t, -2*t), 1: (t*(t + 1)/2, t + 0.5)}


def lagrange(order, xi, eta):
    a, b = line_shapes(order, xi), line_shapes(order, eta)
    at = CORNERS if order == 1 else NINE
    value = np.array([a[int(i)][0]*b[int(j)][0] for i, j in at])
    slope = np.array([[a[int(i)][1]*b[int(j)][0], a[int(i)][0]*b[int(j)][1]] for i, j in at])
    return value, slope


def serendipity(xi, eta):
    """Eight nodes: the nine without what the centre adds, a quarter of it less at corners and half of it more at middles."""
    value, slope = lagrange(2, xi, eta)
    share = np.array([-0.25]*4 + [0.5]*4)
    return value[:8] + share*value[8], slope[:8] + np.outer(share, slope[8])


def triangle(n, r, s):
    area, slope = np.array([1 - r - s, r, s]), np.array([[-1, -1], [1, 0], [0, 1]], float)
    if n == 3:
        return area, slope
    after = [1, 2, 0]
    value = np.concatenate([area*(2*area - 1), 4*area*area[after]])
    return value, np.vstack([slope*(4*area - 1)[:, None], 4*(slope*area[after][:, None] + slope[after]*area[:, None])])


@functools.lru_cache(maxsize=1000)
def shapes(n, a, b):
    """Values and derivatives (n, 2) of an element's n functions. They are kept: not to be changed."""
    if n in INSIDE:
        return triangle(n, a, b)
    return serendipity(a, b) if n == 8 else lagrange(1 if n == 4 else 2, a, b)


def quadrature(n):
    """(a, b, weight) of the stiffness."""
    if n in INSIDE:
        return INSIDE[n]
    points, weights = GAUSS[POINTS[n]]
    return [(x, y, v*w) for x, v in zip(points, weights) for y, w in zip(points, weights)]


def least_jacobian(x):
    """Least Jacobian on a grid of points over the largest: an element far from folding over has some tenths."""
    if len(x) in INSIDE:
        at = [(i/4, j/4) for i in range(5) for j in range(5 - i)]
    else:
        at = [(i/2 - 1, j/2 - 1) for i in range(5) for j in range(5)]
    matrices = [shapes(len(x), a, b)[1].T @ x for a, b in at]
    size = [m[0, 0]*m[1, 1] - m[0, 1]*m[1, 0] for m in matrices]
    return min(size)/max(map(abs, size))
