"""Reads the decks that random_scenes writes, and the tables of a run: no code of the program, and only the part of the deck
language that occurs there."""

import math

import numpy as np

FACE_CORNERS = ((0, 1), (1, 2), (2, 3), (3, 0))


class Scene:
    """Nodes, elements, pairs, supports and loads of a deck."""

    def __init__(self):
        self.place = {}          # node -> (x, y)
        self.elements = {}       # element -> (type, nodes)
        self.elsets = {}
        self.nodesets = {}
        self.surfaces = {}       # name -> list of (element, face 0..3)
        self.segments = {}       # name -> list of (x, y)
        self.materials = {}      # name -> [E, mu, density]
        self.section = {}        # element -> (material, thickness)
        self.laws = {}
        self.pairs = []          # (slave, master, law)
        self.held = {}           # (node, dof 0..1) -> value
        self.loads = []          # (kind, ...)


class Law:
    def __init__(self):
        self.delta = 0.0
        self.kind = 'NONE'
        self.nu = 0.0
        self.slope = math.inf    # shear over slip while sticking, local law
        self.eps = 0.0
        self.rho = 0.0
        self.kernel = 'POINTS'
        self.is_incremental = False  # slip counts from the increment before


def cards(text):
    """(keyword, options, data lines) of a deck."""
    card = None
    for line in text.splitlines():
        if line.startswith('**') or not line.strip():
            continue
        if line.startswith('*'):
            if card:
                yield card
            words = [word.strip() for word in line[1:].split(',')]
            options = {}
            for word in words[1:]:
                name, _, value = word.partition('=')
                options[name.strip().upper()] = value.strip().upper()
            card = (words[0].upper(), options, [])
        else:
            card[2].append([word.strip().upper() for word in line.split(',')])
    if card:
        yield card


def read_deck(text):
    scene = Scene()
    material = law = None
    for keyword, options, data in cards(text):
        if keyword == 'NODE':
            for row in data:
                scene.place[int(row[0])] = (float(row[1]), float(row[2]))
        elif keyword == 'ELEMENT':
            for row in data:
                scene.elements[int(row[0])] = (options['TYPE'], [int(word) for word in row[1:]])
                scene.elsets.setdefault(options['ELSET'], []).append(int(row[0]))
        elif keyword == 'BLOCK':
            read_block(scene, options, data)
        elif keyword == 'SURFACE':
            read_surface(scene, options, data)
        elif keyword == 'MATERIAL':
            material = scene.materials.setdefault(options['NAME'], [0.0, 0.0, 0.0])
        elif keyword == 'ELASTIC':
            material[0], material[1] = float(data[0][0]), float(data[0][1])
        elif keyword == 'DENSITY':
            material[2] = float(data[0][0])
        elif keyword == 'SOLID SECTION':
            for element in scene.elsets[options['ELSET']]:
                scene.section[element] = (options['MATERIAL'], float(data[0][0]))
        elif keyword == 'SURFACE INTERACTION':
            law = scene.laws.setdefault(options['NAME'], Law())
        elif keyword == 'SURFACE BEHAVIOR':
            kind = options.get('PRESSURE-OVERCLOSURE', 'HARD')
            if kind == 'LINEAR':
                law.delta = 1/float(data[0][0])
            elif kind == 'PENALTY':
                law.delta = float(data[0][0])
        elif keyword == 'FRICTION':
            read_friction(law, options, data)
        elif keyword == 'CONTACT PAIR':
            for row in data:
                scene.pairs.append((row[0], row[1], scene.laws[options['INTERACTION']]))
        elif keyword == 'BOUNDARY':
            for row in data:
                value = float(row[3]) if len(row) > 3 else 0.0
                for node in scene.nodesets.get(row[0]) or [int(row[0])]:
                    for dof in range(int(row[1]), int(row[2] if len(row) > 2 else row[1]) + 1):
                        scene.held[node, dof - 1] = value
        elif keyword in ('CLOAD', 'DLOAD', 'DSLOAD'):
            scene.loads += [(keyword, row) for row in data]
        elif keyword not in ('HEADING', 'RIGID BODY', 'STEP', 'STATIC', 'NODE PRINT', 'CONTACT PRINT', 'CONTROLS', 'END STEP'):
            raise ValueError('the judge does not know *' + keyword)
    return scene


def read_friction(law, options, data):
    row = data[0]
    law.nu = float(row[0])
    law.is_incremental = options.get('SLIP', 'TOTAL' if 'NONLOCAL' in options else 'INCREMENTAL') == 'INCREMENTAL'
    if 'NONLOCAL' in options:
        law.kind = 'NONLOCAL'
        law.eps, law.rho = float(row[1]), float(row[2])
        law.kernel = options.get('KERNEL', 'POINTS')
    else:
        law.kind = 'LOCAL'
        if len(row) > 1:
            law.slope = float(row[1])


def read_block(scene, options, data):
    """A grid of elements in a quadrilateral; numbers follow the greatest so far, row by row."""
    nx, ny, name = int(options['NX']), int(options['NY']), options['ELSET']
    order = 2 if options['TYPE'].endswith('9') else 1
    corner = np.array([[float(word) for word in row] for row in data[:4]])
    along = {'X': np.arange(nx + 1)/nx, 'Y': np.arange(ny + 1)/ny}
    for row in data[4:]:
        along[row[0]][1:-1] = [float(word) for word in row[1:]]
    a, b = (refined(along[axis], order) for axis in 'XY')
    node = max(scene.place, default=0) + 1
    element = max(scene.elements, default=0) + 1
    for j, eta in enumerate(b):
        for i, xi in enumerate(a):
            x = (1 - eta)*((1 - xi)*corner[0] + xi*corner[1]) + eta*((1 - xi)*corner[3] + xi*corner[2])
            scene.place[node + j*len(a) + i] = (x[0], x[1])
    row, o = len(a), order
    for j in range(ny):
        for i in range(nx):
            first = node + j*o*row + i*o
            nodes = [first, first + o, first + o*row + o, first + o*row]
            if o == 2:
                nodes += [first + 1, first + row + 2, first + 2*row + 1, first + row, first + row + 1]
            number = element + j*nx + i
            scene.elements[number] = (options['TYPE'], nodes)
            scene.elsets.setdefault(name, []).append(number)
            for face, side, here in ((0, 'BOTTOM', j == 0), (1, 'RIGHT', i == nx - 1), (2, 'TOP', j == ny - 1), (3, 'LEFT', i == 0)):
                if here:
                    scene.surfaces.setdefault(name + '-' + side, []).append((number, face))
                    scene.nodesets.setdefault(name + '-' + side, set()).update(face_nodes(scene, number, face))


def refined(x, order):
    if order == 1:
        return x
    both = np.empty(2*len(x) - 1)
    both[::2] = x
    both[1::2] = 0.5*(x[:-1] + x[1:])
    return both


def read_surface(scene, options, data):
    name = options['NAME']
    if options.get('TYPE') == 'SEGMENTS':
        scene.segments[name] = [(float(row[1]), float(row[2])) for row in data]
        return
    faces = scene.surfaces.setdefault(name, [])
    faces += [(int(row[0]), int(row[1][1]) - 1) for row in data]


def face_nodes(scene, element, face):
    """First end, last end and, with nine nodes, the middle: counter-clockwise round the element."""
    kind, nodes = scene.elements[element]
    first, last = FACE_CORNERS[face]
    ends = [nodes[first], nodes[last]]
    return ends + [nodes[4 + face]] if kind.endswith('9') else ends


def read_table(path, may_be_nan=()):
    """Columns by name, and whether the run did not converge. Raises ValueError for what is not a finite number, but for some
    columns."""
    names, rows, converged = None, [], True
    with open(path) as lines:
        for line in lines:
            if line.startswith('# NOT CONVERGED'):
                converged = False
            if line.startswith('# columns:'):
                names = line.split()[2:]
            if not line.startswith('#') and line.strip():
                rows.append([float(word) for word in line.split()])
    table = np.array(rows).reshape(len(rows), len(names))
    known = [name not in may_be_nan for name in names]
    if not np.all(np.isfinite(table[:, known])):
        raise ValueError(path + ' holds what is not a number')
    return dict(zip(names, table.T)), converged
