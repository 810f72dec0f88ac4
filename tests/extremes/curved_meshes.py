"""Meshes of discs, rings and blocks whose sides are arcs and lines: structured, or unstructured as Gmsh's (Delaunay's triangles,
quadrilaterals made of them), of elements with 3, 4, 6, 8 or 9 nodes. What the sides are exactly is kept beside the mesh."""

import math

import numpy as np

from shape_functions import least_jacobian

TRIANGLES = (3, 6)


class Arc:
    """A circle's part; outward is +1 where the body lies inside the circle, -1 for a hole or a groove."""

    def __init__(self, centre, radius, outward):
        self.centre, self.radius, self.outward = np.array(centre, float), radius, outward

    def project(self, x):
        away = x - self.centre
        return self.centre + away*(self.radius/np.linalg.norm(away))

    def normal(self, x):
        away = x - self.centre
        return away*(self.outward/np.linalg.norm(away))

    def moved(self, motion):
        return Arc(motion.place(self.centre), self.radius*motion.length, self.outward)


class Line:
    def __init__(self, a, b):
        """The body is on the left on the way from a to b."""
        self.a, self.b = np.array(a, float), np.array(b, float)

    def normal(self, _):
        along = (self.b - self.a)/np.linalg.norm(self.b - self.a)
        return np.array([along[1], -along[0]])

    def project(self, x):
        n = self.normal(x)
        return x - ((x - self.a) @ n)*n

    def moved(self, motion):
        return Line(motion.place(self.a), motion.place(self.b))


class Mesh:
    """Nodes, elements of one kind, and sides: name -> list of (element, face, piece of its outline)."""

    def __init__(self, x, cells, edges, outline):
        """edges: (node, node) in the order round the element -> piece; outline: piece -> (side, curve)."""
        self.x, self.cells, self.outline = np.array(x, float), [list(cell) for cell in cells], outline
        self.faces = {}
        for number, cell in enumerate(self.cells):
            for face in range(len(cell)):
                piece = edges.get((cell[face], cell[(face + 1) % len(cell)]))
                if piece is not None:
                    self.faces[number, face] = piece

    def side(self, name):
        return [(number, face) for (number, face), piece in self.faces.items() if self.outline[piece][0] == name]

    def side_nodes(self, name):
        nodes = {}
        for number, face in self.side(name):
            for node in self.face_nodes(number, face):
                nodes[node] = self.outline[self.faces[number, face]][1]
        return nodes

    def face_nodes(self, number, face):
        cell = self.cells[number]
        corners = 3 if len(cell) in TRIANGLES else 4
        nodes = [cell[face], cell[(face + 1) % corners]]
        return nodes + [cell[corners + face]] if len(cell) > corners else nodes

    def curves(self, name):
        return [(piece, curve) for piece, (side, curve) in self.outline.items() if side == name]

    def elevate(self, nodes, is_curved):
        """Middles of sides, on the exact curve or, where elements would fold, on the chord; and centres."""
        if nodes in (3, 4):
            return
        kept = self.x, self.cells
        self.add_middles(nodes, is_curved)
        if is_curved and not self.is_sound():
            self.x, self.cells = kept
            self.add_middles(nodes, False)

    def is_sound(self):
        """Whether no element is near to folding over."""
        return all(least_jacobian(self.x[cell]) > 0.1 for cell in self.cells)

    def add_middles(self, nodes, is_curved):
        x, middle, cells = list(self.x), {}, []
        for number, cell in enumerate(self.cells):
            middles = []
            for face, a in enumerate(cell):
                b = cell[(face + 1) % len(cell)]
                key = (min(a, b), max(a, b))
                if key not in middle:
                    at = 0.5*(self.x[a] + self.x[b])
                    piece = self.faces.get((number, face))
                    if is_curved and piece is not None:
                        at = self.outline[piece][1].project(at)
                    middle[key] = len(x)
                    x.append(at)
                middles.append(middle[key])
            new = cell + middles
            if nodes == 9:
                new.append(len(x))
                x.append(0.5*sum(x[i] for i in middles) - 0.25*sum(self.x[i] for i in cell))
            cells.append(new)
        self.x, self.cells = np.array(x), cells

    def renumber(self, rng):
        order = rng.permutation(len(self.x))
        place = np.empty(len(order), int)
        place[order] = np.arange(len(order))
        self.x = self.x[order]
        cells = [[int(place[i]) for i in cell] for cell in self.cells]
        turn = rng.permutation(len(cells))
        self.cells = [cells[i] for i in turn]
        back = {int(old): new for new, old in enumerate(turn)}
        keys = [(back[number], face) for number, face in self.faces]
        faces = dict(zip(keys, self.faces.values()))
        self.faces = {keys[i]: faces[keys[i]] for i in rng.permutation(len(keys))}


# -- structured -----------------------------------------------------------------------------------------------------------------


def stations(n, spacing, rng, is_closed=False):
    """0 to 1 in n parts: uniform, graded, random."""
    if spacing == 'uniform':
        size = np.ones(n)
    elif spacing == 'graded':
        size = 1 + 0.6*np.cos(2*math.pi*(np.arange(n)/n + rng.random())) if is_closed else 2.5**np.linspace(0, 1, n)
    else:
        size = rng.uniform(0.5, 1.5, n)
    at = np.concatenate([[0], np.cumsum(size)])/size.sum()
    at[-1] = 1.0
    return at


def grid(place, s, t, names, curves, is_closed, is_triangles, rng):
    """place(s, t) for s, t of 0 to 1. Sides t = 0, s = 1, t = 1, s = 0; a closed grid has the first and the third only. s grows so
    that the body is on the left along t = 0."""
    columns = len(s) - 1 if is_closed else len(s)
    x = [place(s[i], t[j]) for j in range(len(t)) for i in range(columns)]
    at = lambda i, j: j*columns + i % columns
    cells, edges = [], {}
    for j in range(len(t) - 1):
        for i in range(len(s) - 1):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            if j == 0:
                edges[a, b] = piece_of(curves[0], s[i], s[i + 1])
            if j == len(t) - 2:
                edges[c, d] = piece_of(curves[2], s[i], s[i + 1])
            if not is_closed and i == len(s) - 2:
                edges[b, c] = piece_of(curves[1], t[j], t[j + 1])
            if not is_closed and i == 0:
                edges[d, a] = piece_of(curves[3], t[j], t[j + 1])
            if not is_triangles:
                cells.append((a, b, c, d))
            elif rng.random() < 0.5:
                cells += [(a, b, c), (a, c, d)]
            else:
                cells += [(a, b, d), (b, c, d)]
    outline = {}
    for name, pieces in zip(names, curves):
        for _, _, piece, curve in pieces:
            outline[piece] = (name, curve)
    return Mesh(x, cells, edges, outline)


def piece_of(pieces, a, b):
    middle = 0.5*(a + b)
    for low, high, piece, _ in pieces:
        if low <= middle <= high:
            return piece
    raise ValueError('an edge on no piece of the outline')


# -- unstructured ---------------------------------------------------------------------------------------------------------------


def triangulate(points):
    """Delaunay's triangles by Bowyer's and Watson's method."""
    x = np.array(points, float)
    middle, size = x.mean(axis=0), 50*np.ptp(x, axis=0).max()
    n = len(x)
    x = np.vstack([x, middle + size*np.array([[-1, -0.8], [1, -0.8], [0, 1.3]])])
    triangles = np.array([[n, n + 1, n + 2]])
    circles = np.array([circle(x, triangles[0])])
    for i in range(n):
        bad = ((x[i] - circles[:, :2])**2).sum(axis=1) < circles[:, 2]*(1 - 1e-12)
        edges = {}
        for a, b, c in triangles[bad]:
            for edge in ((a, b), (b, c), (c, a)):
                if (edge[1], edge[0]) in edges:
                    del edges[edge[1], edge[0]]
                else:
                    edges[edge] = True
        new = np.array([[a, b, i] for a, b in edges])
        triangles = np.vstack([triangles[~bad], new])
        circles = np.vstack([circles[~bad], [circle(x, triangle) for triangle in new]])
    return [tuple(int(i) for i in triangle) for triangle in triangles if max(triangle) < n]


def circle(x, triangle):
    a, b, c = x[list(triangle)]
    d = 2*((b[0] - a[0])*(c[1] - a[1]) - (b[1] - a[1])*(c[0] - a[0]))
    if d == 0:
        return (a[0], a[1], 1e30)
    bb, cc = ((b - a)**2).sum(), ((c - a)**2).sum()
    at = np.array([(c[1] - a[1])*bb - (b[1] - a[1])*cc, (b[0] - a[0])*cc - (c[0] - a[0])*bb])/d
    return (a[0] + at[0], a[1] + at[1], (at**2).sum())


def inside(x, loops):
    """Which of the points lie in the outline."""
    odd = np.zeros(len(x), bool)
    for loop in loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0)):
            crosses = (a[1] > x[:, 1]) != (b[1] > x[:, 1])
            with np.errstate(divide='ignore', invalid='ignore'):
                odd ^= crosses & (x[:, 0] < a[0] + (x[:, 1] - a[1])/(b[1] - a[1])*(b[0] - a[0]))
    return odd


def unstructured(loops, names, outline, is_triangles, rng):
    """loops: arrays of points, the body on the left; names: piece of the edge behind each point. None where the outline is not in
    Delaunay's triangles."""
    fixed = np.vstack(loops)
    lengths = np.concatenate([np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1) for loop in loops])
    low, high = fixed.min(axis=0), fixed.max(axis=0)
    h = max(lengths.mean()*1.1, math.sqrt(np.prod(high - low)/120))
    rows = [(low[0] + (i + 0.5*(j % 2))*h, low[1] + j*h*0.87) for j in range(1, int((high[1] - low[1])/(0.87*h)) + 1)
            for i in range(int((high[0] - low[0])/h) + 1)]
    inner = np.array(rows).reshape(-1, 2) + rng.uniform(-0.2, 0.2, (len(rows), 2))*h
    if len(inner):
        near = np.array([(np.linalg.norm(fixed - x, axis=1)/np.maximum(np.minimum(lengths, h), 0.3*h)).min() for x in inner])
        inner = inner[inside(inner, loops) & (near > 0.75)]
    x = np.vstack([fixed, inner])
    triangles = [cell for cell in triangulate(x) if area(x, cell) > 1e-6*h*h]
    keep = inside(np.array([x[list(cell)].mean(axis=0) for cell in triangles]), loops)
    triangles = [cell for cell, here in zip(triangles, keep) if here]
    edges, first = {}, 0
    for loop, pieces in zip(loops, names):
        for i, piece in enumerate(pieces):
            edges[first + i, first + (i + 1) % len(loop)] = piece
        first += len(loop)
    own = {(cell[i], cell[(i + 1) % 3]) for cell in triangles for i in range(3)}
    if not set(edges) <= own or {edge for edge in own if edge[::-1] not in own} != set(edges):
        return None
    if len({i for cell in triangles for i in cell}) < len(x):
        return None
    smooth(x, triangles, len(fixed))
    if min(area(x, cell) for cell in triangles) < 1e-3*h*h:
        return None
    mesh = Mesh(x, triangles, edges, outline) if is_triangles else quadrilaterals(x, triangles, edges, outline)
    return mesh if mesh.is_sound() else None


def area(x, cell):
    a, b, c = x[list(cell)]
    return 0.5*((b[0] - a[0])*(c[1] - a[1]) - (b[1] - a[1])*(c[0] - a[0]))


def smooth(x, triangles, fixed):
    near = {}
    for cell in triangles:
        for i in cell:
            near.setdefault(i, set()).update(cell)
    for _ in range(3):
        for i in range(fixed, len(x)):
            others = list(near[i] - {i})
            x[i] = x[others].mean(axis=0)


def quadrilaterals(x, triangles, edges, outline):
    """Three of each triangle, as Gmsh's subdivision."""
    x, middle, cells, halves = list(x), {}, [], {}
    for cell in triangles:
        middles = []
        for i in range(3):
            a, b = cell[i], cell[(i + 1) % 3]
            key = (min(a, b), max(a, b))
            if key not in middle:
                at = 0.5*(x[a] + x[b])
                piece = edges.get((a, b))
                middle[key] = len(x)
                x.append(at if piece is None else outline[piece][1].project(at))
            middles.append(middle[key])
            if (a, b) in edges:
                halves[a, middle[key]] = halves[middle[key], b] = edges[a, b]
        centre = len(x)
        x.append(sum(x[i] for i in middles)/3)
        for i in range(3):
            cells.append((cell[i], middles[i], centre, middles[i - 1]))
    return Mesh(x, cells, halves, outline)


# -- shapes ---------------------------------------------------------------------------------------------------------------------


class Recipe:
    """How a body is meshed."""

    def __init__(self, nodes, is_curved, is_free, spacing):
        self.nodes, self.is_curved, self.is_free, self.spacing = nodes, is_curved, is_free, spacing

    @property
    def is_triangles(self):
        return self.nodes in TRIANGLES

    def finish(self, mesh, rng):
        mesh.elevate(self.nodes, self.is_curved)
        if self.is_free:
            mesh.renumber(rng)
        return mesh


def on_circle(centre, radius, angles):
    return np.array([[centre[0] + radius*math.cos(a), centre[1] + radius*math.sin(a)] for a in angles])


def ring(recipe, inner, outer, n, layers, rng, angles=None, square=None, centre=(0.0, 0.0)):
    """Sides INSIDE and OUTSIDE. `angles`: those of the nodes of the inner (outer with a negative n) circle; square: half of the
    side of a square outside."""
    if angles is None:
        angles = 2*math.pi*(stations(n, recipe.spacing, rng, True) + (rng.random() if square is None else 0.0))
    hole, rim = Arc(centre, inner, -1), Arc(centre, outer, 1)
    centre = np.array(centre)
    if square is not None:
        corners = centre + square*np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]])
        lines = [Line(corners[i], corners[(i + 1) % 4]) for i in range(4)]
        return square_ring(recipe, hole, square, lines, angles, layers, centre, rng)
    if recipe.is_free:
        others = 2*math.pi*(stations(max(8, int(len(angles)*rng.uniform(0.8, 1.3))), recipe.spacing, rng, True) + rng.random())
        for _ in range(4):
            mesh = unstructured([on_circle(centre, outer, others[:-1]), on_circle(centre, inner, angles[:-1])[::-1]],
                                [['rim']*(len(others) - 1), ['hole']*(len(angles) - 1)],
                                {'rim': ('OUTSIDE', rim), 'hole': ('INSIDE', hole)}, recipe.is_triangles, rng)
            if mesh:
                return recipe.finish(mesh, rng)
    t = np.linspace(0, 1, layers + 1)
    turn = angles - angles[0]

    def place(s, t):
        a, r = angles[0] - s*2*math.pi, inner + t*(outer - inner)
        return centre + r*np.array([math.cos(a), math.sin(a)])

    backwards = 1 - turn[::-1]/(2*math.pi)
    mesh = grid(place, backwards, t, ('INSIDE', '', 'OUTSIDE', ''),
                ([(0, 1, 'hole', hole)], [], [(0, 1, 'rim', rim)], []), True, recipe.is_triangles, rng)
    return recipe.finish(mesh, rng)


def square_ring(recipe, hole, square, lines, angles, layers, centre, rng):
    """A square with a hole; nodes of the hole on the diagonals."""
    angles = np.sort(np.mod(np.concatenate([angles[:-1], math.pi/4 + 0.5*math.pi*np.arange(4)]) + math.pi/4, 2*math.pi)) - math.pi/4
    least = 0.25*2*math.pi/len(angles)
    corner = -math.pi/4 + 0.5*math.pi*np.arange(4)
    angles = np.array([a for a in angles if min(abs(a - b) for b in [*corner, 1.75*math.pi]) > least] + list(corner))
    angles = np.sort(angles)
    kept = [angles[0]]
    for a in angles[1:]:
        if a - kept[-1] > 1e-6:
            kept.append(a)
    angles = np.array([*kept, kept[0] + 2*math.pi])

    def edge(a):
        d = np.array([math.cos(a), math.sin(a)])
        return centre + square*d/np.abs(d).max()

    def place(s, t):
        a = angles[0] - s*2*math.pi
        return (1 - t)*(centre + hole.radius*np.array([math.cos(a), math.sin(a)])) + t*edge(a)

    s = 1 - (angles - angles[0])[::-1]/(2*math.pi)
    # backwards from -45 degrees: below, left, above, right
    names = [(0, 0.25, 'below', lines[3]), (0.25, 0.5, 'left', lines[2]), (0.5, 0.75, 'above', lines[1]), (0.75, 1, 'right', lines[0])]
    mesh = grid(place, s, np.linspace(0, 1, layers + 1), ('INSIDE', '', 'OUTSIDE', ''),
                ([(0, 1, 'hole', hole)], [], names, []), True, recipe.is_triangles, rng)
    return recipe.finish(mesh, rng)


def disc(recipe, radius, n, layers, rng, angles=None, centre=(0.0, 0.0)):
    """A full disc, unstructured; a ring with a small hole where that fails."""
    if angles is None:
        angles = 2*math.pi*(stations(n, recipe.spacing, rng, True) + rng.random())
    rim = Arc(centre, radius, 1)
    for _ in range(4):
        mesh = unstructured([on_circle(centre, radius, angles[:-1])], [['rim']*(len(angles) - 1)], {'rim': ('OUTSIDE', rim)},
                            recipe.is_triangles, rng)
        if mesh:
            return Recipe(recipe.nodes, recipe.is_curved, True, '').finish(mesh, rng)
    return ring(recipe, 0.3*radius, radius, n, layers, rng, angles, centre=centre)


def half_disc(recipe, radius, n, rng, angles=None, centre=(0.0, 0.0)):
    """Below its flat side: sides ROUND (180 to 360 degrees) and FLAT."""
    if angles is None:
        angles = math.pi*(1 + stations(n, recipe.spacing, rng))
    centre = np.array(centre)
    round_side, flat = Arc(centre, radius, 1), Line(centre + [radius, 0], centre - [radius, 0])
    m = max(3, int(0.6*len(angles)))
    if recipe.is_free:
        back = centre + np.stack([radius*(1 - 2*stations(m, 'uniform', rng)[1:-1]), np.zeros(m - 1)], axis=1)
        for _ in range(4):
            mesh = unstructured([np.vstack([on_circle(centre, radius, angles), back])],
                                [['round']*(len(angles) - 1) + ['flat']*m],
                                {'round': ('ROUND', round_side), 'flat': ('FLAT', flat)}, recipe.is_triangles, rng)
            if mesh:
                return recipe.finish(mesh, rng)

    return fan(recipe, radius, angles, centre, round_side, flat, rng)


def fan(recipe, radius, angles, centre, round_side, flat, rng):
    """Half a disc with a small half hole: the flat side has two parts."""
    hole = Arc(centre, 0.3*radius, -1)

    def place(s, t):
        a, r = math.pi*(1 + s), radius*(1 - 0.7*t)
        return centre + r*np.array([math.cos(a), math.sin(a)])

    s = (angles - angles[0])/math.pi
    mesh = grid(place, s, np.linspace(0, 1, 5), ('ROUND', 'FLAT', 'HOLE', 'FLAT'),
                ([(0, 1, 'round', round_side)], [(0, 1, 'flat-right', flat)], [(0, 1, 'hole', hole)],
                 [(0, 1, 'flat-left', flat)]), False, recipe.is_triangles, rng)
    return recipe.finish(mesh, rng)


def block(recipe, corners, nx, ny, rng, s=None):
    """Sides BOTTOM, RIGHT, TOP, LEFT of a parallelogram."""
    corners = np.array(corners, float)
    names = ('BOTTOM', 'RIGHT', 'TOP', 'LEFT')
    lines = [Line(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    if s is None:
        s = stations(nx, recipe.spacing, rng)
    t = np.linspace(0, 1, ny + 1)
    if recipe.is_free:
        loop = [corners[i] + (corners[(i + 1) % 4] - corners[i])*at for i, steps in enumerate((s, t, 1 - s[::-1], t)) for at in steps[:-1]]
        pieces = [names[i] for i, steps in enumerate((s, t, s, t)) for _ in steps[:-1]]
        mesh = unstructured([np.array(loop)], [pieces], dict(zip(names, zip(names, lines))), recipe.is_triangles, rng)
        if mesh:
            return recipe.finish(mesh, rng)
    place = lambda a, b: (1 - b)*((1 - a)*corners[0] + a*corners[1]) + b*((1 - a)*corners[3] + a*corners[2])
    mesh = grid(place, s, t, names, [[(0, 1, name, line)] for name, line in zip(names, lines)], False, recipe.is_triangles, rng)
    return recipe.finish(mesh, rng)


def profile_block(recipe, top, bottom, rng, layers):
    """Columns below a line of pieces (points with the curve behind each, the side's name); x grows. Sides TOP-..., BOTTOM, LEFT,
    RIGHT."""
    points, curves, names = top
    points = np.array(points)
    s = np.arange(len(points))/(len(points) - 1)
    low, high = points[0, 0], points[-1, 0]
    foot = [(low + (high - low)*a, bottom) for a in s]
    foot = [(0.5*(p[0] + f[0]), bottom) for p, f in zip(points, foot)]
    foot[0], foot[-1] = (low, bottom), (high, bottom)

    def place(a, b):
        i = round(a*(len(points) - 1))
        return (1 - b)*np.array(foot[i]) + b*points[i]

    pieces, begin = [], 0
    for i in range(1, len(curves) + 1):
        if i == len(curves) or curves[i] is not curves[begin]:
            pieces.append((s[begin], s[i], f'top{begin}', names[begin], curves[begin]))
            begin = i
    corners = [(low, bottom), (high, bottom), tuple(points[-1]), tuple(points[0])]
    sides = [[(0, 1, name, Line(corners[i], corners[(i + 1) % 4]))] for i, name in enumerate(('BOTTOM', 'RIGHT', 'TOP', 'LEFT'))]
    sides[2] = [(a, b, piece, curve) for a, b, piece, _, curve in pieces]
    mesh = grid(place, s, np.linspace(0, 1, layers + 1), ('BOTTOM', 'RIGHT', 'TOP', 'LEFT'), sides, False, recipe.is_triangles, rng)
    for _, _, piece, name, curve in pieces:
        mesh.outline[piece] = (name, curve)
    return recipe.finish(mesh, rng)
