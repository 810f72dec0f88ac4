#!/usr/bin/env python3
"""Prints the deck of a scene with a line for every node and element, coordinates with 12 digits, as a mesh generator or a script writes it.

   meshes.py KIND SIZE [all|line] >deck.inp

SIZE is about the number of displacements: 5e4, 2e5, 1e6. `all` prints displacements, reactions and stresses of everything (default),
`line` those of the contact line alone.

   a, p               scenes A and P (scene-a.sh, scene-p.sh), squares row by row
   a-moved, p-moved   the same, inner nodes moved at random by up to 15 % of a side along x and y
   square             a square pressed on a square and pushed aside, free quads of Gmsh
   hole               a plate with a hole pressed on a block and pushed aside, the same
   graded             square on square, sizes 1:1000 from one end of the contact line on, the same
   rotated            scene P with elements 25 times as long as high, turned by 45 degrees

Sides that touch match, so that they can be glued. numpy; the kinds of Gmsh want its module (pip install gmsh).
"""
import math
import os
import sys

import numpy as np

DIGITS = 12
SEED = 20240229
TURN = math.pi/4
FLATNESS = 25
GRADING = 1000.0
KINDS = ('a', 'p', 'a-moved', 'p-moved', 'square', 'hole', 'graded', 'rotated')
GMSH_ALGORITHM = 6          # Frontal-Delaunay
GMSH_RECOMBINATION = 3      # blossom full-quad: no triangles are left
GMSH_EXCESS = 1.22          # nodes that this makes over those that the sizes ask for


class Body:
    """Nodes x (n, 2) with their numbers, elements (m, 4) of places in x, counterclockwise."""

    def __init__(self, name, x, elements, numbers):
        self.name, self.x, self.elements, self.numbers = name, x, elements, numbers

    def faces(self, where):
        """(element, face) of the outline whose ends both satisfy where(x, y), and the places of their nodes; faces from 1."""
        ends = np.stack([self.elements, np.roll(self.elements, -1, axis=1)], axis=2).reshape(-1, 2)
        ends.sort(axis=1)
        key = ends[:, 0]*len(self.x) + ends[:, 1]
        order = np.argsort(key, kind='stable')
        key = key[order]
        alone = np.ones(len(key), bool)
        same = key[1:] == key[:-1]
        alone[1:] &= ~same
        alone[:-1] &= ~same
        outer = np.sort(order[alone])
        inside = where(self.x[:, 0], self.x[:, 1])
        outer = outer[inside[ends[outer]].all(axis=1)]
        return outer//4, outer % 4 + 1, np.unique(ends[outer])

    def is_inner(self):
        nodes = self.faces(lambda x, y: np.ones(len(x), bool))[2]
        inner = np.ones(len(self.x), bool)
        inner[nodes] = False
        return inner


def grid(name, first, nx, ny, x1, x2, y1, y2):
    """A rectangle of nx x ny elements, nodes row by row from number `first` on."""
    x = x1 + (x2 - x1)*np.arange(nx + 1)/nx
    y = y1 + (y2 - y1)*np.arange(ny + 1)/ny
    corner = (np.arange(ny)[:, None]*(nx + 1) + np.arange(nx)[None, :]).ravel()
    return Body(name, np.stack([np.tile(x, ny + 1), np.repeat(y, nx + 1)], axis=1),
                np.stack([corner, corner + 1, corner + nx + 2, corner + nx + 1], axis=1),
                first + np.arange((nx + 1)*(ny + 1)))


def move_inner(bodies, side):
    random = np.random.default_rng(SEED)
    for body in bodies:
        inner = body.is_inner()
        body.x[inner] += 0.15*side*random.uniform(-1.0, 1.0, (inner.sum(), 2))


def rotate(bodies):
    c, s = math.cos(TURN), math.sin(TURN)
    for body in bodies:
        body.x = body.x @ np.array([[c, s], [-s, c]])


def scene_p(size, flat=1):
    """Lower block 2 x 1, upper 1 x 0.5; elements 1/n long and 1/(n flat) high. Unless turned, 1/n has more digits than are printed."""
    n = 2*round(math.sqrt(size/2.5/2/flat)/2)
    while flat == 1 and 10**DIGITS % n == 0:
        n += 2
    lower = grid('LOWER', 1, 2*n, n*flat, 0.0, 2.0, 0.0, 1.0)
    return [lower, grid('UPPER', len(lower.x) + 1, n, n*flat//2, 0.5, 1.5, 1.0, 1.5)], 1.0/n


def scene_a(size):
    k = round(math.sqrt(size/2/(6*5 + 32*6)))
    lower = grid('LOWER', 1, 6*k, 5*k, 0.0, 0.6, 0.0, 0.5)
    return [lower, grid('UPPER', len(lower.x) + 1, 32*k, 6*k, 0.0, 3.2, 0.5, 1.1)], 0.1/k


class Gmsh:
    """Two bodies in one mesh of Gmsh, whose numbers are kept; the surfaces share no point."""

    def __init__(self):
        try:
            import gmsh
        except ImportError:
            sys.exit('meshes.py: this kind wants Gmsh: pip install gmsh')
        self.gmsh = gmsh
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber('General.Terminal', 0)
        gmsh.option.setNumber('General.NumThreads', 1)
        gmsh.option.setNumber('Mesh.Algorithm', GMSH_ALGORITHM)
        gmsh.option.setNumber('Mesh.RecombineAll', 1)
        gmsh.option.setNumber('Mesh.RecombinationAlgorithm', GMSH_RECOMBINATION)
        self.geo = gmsh.model.geo

    def outline(self, corners, h):
        """Lines round a polygon, counterclockwise, those along -x the other way round: sides that touch are meshed alike."""
        points = [self.geo.addPoint(x, y, 0, h) for x, y in corners]
        loop = []
        for i, (x, _) in enumerate(corners):
            j = (i + 1) % len(corners)
            back = corners[j][0] < x
            line = self.geo.addLine(points[j], points[i]) if back else self.geo.addLine(points[i], points[j])
            loop.append(-line if back else line)
        return loop

    def circle(self, x, y, r, h):
        centre = self.geo.addPoint(x, y, 0, h)
        points = [self.geo.addPoint(x + r*c, y + r*s, 0, h) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        return [self.geo.addCircleArc(points[i], centre, points[(i + 1) % 4]) for i in range(4)]

    def mesh(self, names, loops):
        """A surface a body, each of its loops; the first is the outline."""
        surfaces = [self.geo.addPlaneSurface([self.geo.addCurveLoop(loop) for loop in loops_of]) for loops_of in loops]
        self.geo.synchronize()
        mesh = self.gmsh.model.mesh
        # its recombination prints on the standard output, where the deck belongs
        sys.stdout.flush()
        deck = os.dup(1)
        os.dup2(2, 1)
        mesh.generate(2)
        os.dup2(deck, 1)
        mesh.renumberNodes()
        tags, x, _ = mesh.getNodes()
        coordinates = np.empty((len(tags) + 1, 2))
        coordinates[tags] = x.reshape(-1, 3)[:, :2]
        bodies = []
        for name, surface in zip(names, surfaces):
            types, _, nodes = mesh.getElements(2, surface)
            if list(types) != [3]:
                sys.exit('meshes.py: Gmsh left elements other than quads')
            elements = nodes[0].reshape(-1, 4).astype(np.int64)
            numbers, places = np.unique(elements, return_inverse=True)
            places = places.reshape(-1, 4)
            x = coordinates[numbers]
            d = x[places]
            a, b = d[:, 2] - d[:, 0], d[:, 3] - d[:, 1]
            clockwise = a[:, 0]*b[:, 1] - a[:, 1]*b[:, 0] < 0
            places[clockwise] = places[clockwise][:, ::-1]
            bodies.append(Body(name, x, places, numbers))
        self.gmsh.finalize()
        return bodies

    def grade(self, h):
        """Sizes from h at (0, 1) to GRADING times h at a distance of 1."""
        field = self.gmsh.model.mesh.field
        size = field.add('MathEval')
        field.setString(size, 'F', f'{h}*(1+{GRADING - 1}*Min(1,Sqrt(x*x+(y-1)*(y-1))))')
        field.setAsBackgroundMesh(size)
        for option in ('ExtendFromBoundary', 'FromPoints', 'FromCurvature'):
            self.gmsh.option.setNumber('Mesh.MeshSize' + option, 0)


def rectangle(x1, x2, y1, y2):
    return [(x1, y1), (x2, y1), (x2, y2), (x1, y2)]


def scene_gmsh(kind, size):
    gmsh = Gmsh()
    size /= GMSH_EXCESS
    upper = rectangle(0, 1, 1, 2)
    lower = rectangle(0, 1, 0, 1)
    if kind == 'square':
        h = math.sqrt(2*2/size)
        loops = [[gmsh.outline(lower, h)], [gmsh.outline(upper, h)]]
    elif kind == 'hole':
        h = math.sqrt(2*(3 - math.pi/16)/size)
        block = [(-0.5, 0), (1.5, 0), (1.5, 1), (1, 1), (0, 1), (-0.5, 1)]
        loops = [[gmsh.outline(block, h)], [gmsh.outline(upper, h), gmsh.circle(0.5, 1.5, 0.25, h)]]
    else:
        # size = 2 int dA/h^2 with h = a (1 + GRADING r): a half circle of sizes that grow with r, and corners of one size
        r = np.linspace(0, 1, 100001)
        weight = r/(1 + (GRADING - 1)*r)**2
        count = 2*(math.pi*((weight[1:] + weight[:-1])/2).sum()*(r[1] - r[0]) + (2 - math.pi/2)/GRADING**2)
        h = math.sqrt(count/size)
        loops = [[gmsh.outline(lower, h)], [gmsh.outline(upper, h)]]
        gmsh.grade(h)
    return gmsh.mesh(['LOWER', 'UPPER'], loops)


def near(value, to):
    return abs(value - to) < 1e-9


def make(kind, size):
    """Bodies, their sides by name, and whether the scene is A. Sides are found before anything is turned."""
    if kind in ('a', 'a-moved'):
        bodies, side = scene_a(size)
    elif kind in ('p', 'p-moved'):
        bodies, side = scene_p(size)
    elif kind == 'rotated':
        bodies, side = scene_p(size, FLATNESS)
    else:
        bodies, side = scene_gmsh(kind, size), None
    lower, upper = bodies
    low, joint, top = lower.x[:, 1].min(), upper.x[:, 1].min(), upper.x[:, 1].max()
    right = upper.x[:, 0].max()
    sides = {
        'LOWER-BOTTOM': lower.faces(lambda x, y: near(y, low)),
        'LOWER-TOP': lower.faces(lambda x, y: near(y, joint)),
        'UPPER-BOTTOM': upper.faces(lambda x, y: near(y, joint) & (x < (0.6 + 1e-9 if kind[0] == 'a' else 9.0))),
        'UPPER-TOP': upper.faces(lambda x, y: near(y, top)),
        'UPPER-RIGHT': upper.faces(lambda x, y: near(x, right)),
    }
    if kind.endswith('-moved'):
        move_inner(bodies, side)
    if kind == 'rotated':
        rotate(bodies)
    return bodies, sides


def print_lines(form, columns):
    rows = zip(*(column.tolist() for column in columns))
    print('\n'.join([form % row for row in rows]))


def print_mesh(bodies, sides):
    numbers = np.concatenate([body.numbers for body in bodies])
    x = np.concatenate([body.x for body in bodies])
    order = np.argsort(numbers, kind='stable')
    print('*NODE')
    print_lines(f'%d, %.{DIGITS}g, %.{DIGITS}g', [numbers[order], x[order, 0], x[order, 1]])
    first = {}
    element = 0
    for body in bodies:
        first[body.name] = element + 1
        print(f'*ELEMENT, TYPE=CPE4, ELSET={body.name}')
        print_lines('%d, %d, %d, %d, %d', [element + 1 + np.arange(len(body.elements)), *body.numbers[body.elements].T])
        element += len(body.elements)
    for name, (elements, faces, nodes) in sides.items():
        body = bodies[0] if name.startswith('LOWER') else bodies[1]
        print(f'*NSET, NSET={name}-NODES')
        print_lines('%d', [body.numbers[nodes]])
        print(f'*SURFACE, NAME={name}')
        print_lines('%d, S%d', [first[body.name] + elements, faces])


def print_scene(kind, printed):
    print('''*MATERIAL, NAME=STONE
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STONE
1.
*SOLID SECTION, ELSET=UPPER, MATERIAL=STONE
1.
*SURFACE INTERACTION, NAME=JOINT
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e7
*FRICTION, NONLOCAL
.3, 1e-7, .01
*CONTACT PAIR, INTERACTION=JOINT
UPPER-BOTTOM, LOWER-TOP
*BOUNDARY
LOWER-BOTTOM-NODES, 1, 2''')
    if kind[0] == 'a':
        print('UPPER-RIGHT-NODES, 1\n*STEP\n*STATIC\n*DSLOAD\nUPPER-TOP, P, 1.')
    else:
        u = np.array([0.007, -0.01])
        if kind == 'rotated':
            c, s = math.cos(TURN), math.sin(TURN)
            u = np.array([[c, -s], [s, c]]) @ u
        print(f'*STEP\n*STATIC\n*BOUNDARY\nUPPER-TOP-NODES, 1, 1, {u[0]:.{DIGITS}g}\nUPPER-TOP-NODES, 2, 2, {u[1]:.{DIGITS}g}')
    print('*NODE PRINT\nU, RF\n*EL PRINT\nS' if printed == 'all' else '*NODE PRINT, NSET=UPPER-BOTTOM-NODES\nU')
    print('*CONTACT PRINT\n*END STEP')


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[1] not in KINDS or sys.argv[3:] not in ([], ['all'], ['line']):
        sys.exit(__doc__)
    kind, size = sys.argv[1], float(sys.argv[2])
    bodies, sides = make(kind, size)
    print(f'*HEADING\nMesh {kind}, {2*sum(len(body.x) for body in bodies)} displacements')
    print_mesh(bodies, sides)
    print_scene(kind, (sys.argv[3:] or ['all'])[0])


if __name__ == '__main__':
    main()
