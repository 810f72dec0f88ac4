"""Decks that say the same in another way: turned, mirrored, in other units, with other numbers, with a step more or a step in two.

A deck is a list of cards; *BLOCK becomes nodes and elements first. Each relation gives a deck and how its tables go back (`Back`).
"""

import math
import re

import numpy as np

from scene_reader import Scene, cards, read_block

CORNERS = {3: 3, 6: 3}


class Back:
    """From the tables of the other deck to those of the first: places and vectors by a matrix and a factor, numbers of nodes."""

    def __init__(self, q=None, length=1.0, force=1.0, node=None, is_last=False):
        self.q = np.eye(2) if q is None else np.array(q, float)
        self.length, self.force, self.node, self.is_last = length, force, node, is_last

    @property
    def hand(self):
        return 1.0 if np.linalg.det(self.q) > 0 else -1.0

    def vector(self, v):
        return v @ self.q


class Deck:
    def __init__(self, text):
        self.cards = explicit(text)

    def copy(self):
        other = Deck.__new__(Deck)
        other.cards = [(keyword, dict(options), [list(row) for row in data]) for keyword, options, data in self.cards]
        return other

    def text(self):
        out = []
        for keyword, options, data in self.cards:
            words = [keyword] + [f'{name}={value}' if value != '' else name for name, value in options.items()]
            out.append('*' + ', '.join(words))
            out += [', '.join(row) for row in data]
        return '\n'.join(out) + '\n'

    def each(self, *keywords):
        return [card for card in self.cards if card[0] in keywords]

    def steps(self):
        """(cards before the first step, cards of each step)."""
        at = [i for i, card in enumerate(self.cards) if card[0] == 'STEP'] + [len(self.cards)]
        return self.cards[:at[0]], [self.cards[a:b] for a, b in zip(at, at[1:])]

    def largest_load(self):
        """The order of the forces of the loads at nodes."""
        size_of = lambda word: abs(float(re.match(r'[(]*([^ )*]+)', word).group(1)))
        loads = [size_of(row[2]) for _, _, data in self.each('CLOAD') for row in data]
        places = [[float(word) for word in row[1:3]] for _, _, data in self.each('NODE') for row in data]
        size = max(max(x) - min(x) for x in zip(*places))
        return max(loads + [size_of(row[2])*size for _, _, data in self.each('DSLOAD') for row in data], default=0.0)

    def stress_of_motion(self):
        """What a motion of one node against the next does: by its round-off a body that moves without strain has stresses."""
        place = {row[0]: (float(row[1]), float(row[2])) for _, _, data in self.each('NODE') for row in data}
        edges = [math.dist(place[row[1]], place[row[2]]) for _, _, data in self.each('ELEMENT') for row in data if len(row) > 3]
        return max((abs(float(data[0][0])) for _, _, data in self.each('ELASTIC')), default=0.0)/min(edges)

    def least_motion(self):
        """The order of what its loads do to the stiffest body."""
        modulus = max((abs(float(data[0][0])) for _, _, data in self.each('ELASTIC')), default=0.0)
        thickness = max((float(data[0][0]) for _, _, data in self.each('SOLID SECTION') if data and data[0][0]), default=1.0)
        return self.largest_load()/(modulus*thickness) if modulus > 0 else 0.0

    def has_friction(self):
        return any(float(data[0][0]) != 0 for _, _, data in self.each('FRICTION'))


def explicit(text):
    """Cards with all nodes, elements, sets and surfaces given one by one."""
    scene, others = Scene(), []
    for keyword, options, data in cards(text):
        if keyword == 'BLOCK':
            read_block(scene, options, data)
        elif keyword == 'NODE':
            for row in data:
                scene.place[int(row[0])] = (float(row[1]), float(row[2]))
                scene.nodesets.setdefault(options.get('NSET', ''), []).append(int(row[0]))
        elif keyword == 'ELEMENT' and not options['TYPE'].startswith('SPRING'):
            for row in data:
                scene.elements[int(row[0])] = (options['TYPE'], [int(word) for word in row[1:]])
                scene.elsets.setdefault(options['ELSET'], []).append(int(row[0]))
        elif keyword == 'SURFACE' and options.get('TYPE') != 'SEGMENTS':
            scene.surfaces.setdefault(options['NAME'], []).extend((int(row[0]), int(row[1][1]) - 1) for row in data)
        elif keyword == 'NSET':
            scene.nodesets.setdefault(options['NSET'], []).extend(int(word) for row in data for word in row if word)
        else:
            others.append((keyword, options, data))
    first = [card for card in others[:1] if card[0] == 'HEADING']
    return first + geometry(scene) + others[len(first):]


def geometry(scene):
    out = [('NODE', {}, [[str(node), repr(float(x)), repr(float(y))] for node, (x, y) in scene.place.items()])]
    for name, members in scene.elsets.items():
        for kind in dict.fromkeys(scene.elements[number][0] for number in members):
            out.append(('ELEMENT', {'TYPE': kind, 'ELSET': name},
                        [[str(number), *map(str, scene.elements[number][1])] for number in members if scene.elements[number][0] == kind]))
    for name, nodes in scene.nodesets.items():
        if name:
            nodes = [str(node) for node in nodes]
            out.append(('NSET', {'NSET': name}, [nodes[i:i + 12] for i in range(0, len(nodes), 12)]))
    for name, faces in scene.surfaces.items():
        out.append(('SURFACE', {'NAME': name}, [[str(number), f'S{face + 1}'] for number, face in faces]))
    return out


def times(row, columns, factor):
    for i in columns:
        if i < len(row) and row[i] != '':
            try:
                row[i] = repr(float(row[i])*factor)
            except ValueError:  # an expression
                row[i] = f'({factor!r})*({row[i]})'


# -- turned and mirrored --------------------------------------------------------------------------------------------------------


def move_places(deck, q):
    for _, _, data in deck.each('NODE'):
        for row in data:
            row[1:3] = [repr(float(v)) for v in q @ [float(row[1]), float(row[2])]]
    for _, options, data in deck.each('SURFACE'):
        if options.get('TYPE') == 'SEGMENTS':
            for row in data:
                for i in range(1, len(row) - 1, 2):
                    row[i:i + 2] = [repr(float(v)) for v in q @ [float(row[i]), float(row[i + 1])]]
    for _, _, data in deck.each('TRANSFORM'):
        row = data[0]
        for i in (0, 3):
            row[i:i + 2] = [repr(float(v)) for v in q @ [float(row[i]), float(row[i + 1])]]
    for _, _, data in deck.each('DLOAD'):
        for row in data:
            if row[1] == 'GRAV':
                row[3:5] = [repr(float(v)) for v in q @ [float(row[3]), float(row[4])]]
    for _, options, data in deck.each('DSLOAD'):
        for row in data:
            if row[1] == 'TRVEC':
                row[3:5] = [repr(float(v)) for v in q @ [float(row[3]), float(row[4])]]
            if 'FUNCTION' in options:
                in_place(row, 2, *(f'(({float(q[0, i])!r})*X + ({float(q[1, i])!r})*Y)' for i in range(2)))


def in_place(row, column, x, y):
    """An expression of places: x and y for its X and Y."""
    row[column] = re.sub(r'\b[XY]\b', lambda found: x if found.group() == 'X' else y, row[column])


def is_of_revolution(deck):
    return any(options['TYPE'].startswith('CAX') for _, options, _ in deck.each('ELEMENT'))


def signed_axes(deck, q):
    """Dofs and their values where axes go to axes."""
    local = {name for _, options, _ in deck.each('TRANSFORM') for name in [options['NSET']]}
    goes = {i: (int(np.argmax(np.abs(q[:, i]))), float(q[:, i].sum())) for i in range(2)}
    for keyword, options, data in deck.each('BOUNDARY', 'CLOAD'):
        value, new = (3 if keyword == 'BOUNDARY' else 2), []
        for row in data:
            dofs = range(int(row[1]), int(row[2] if keyword == 'BOUNDARY' and len(row) > 2 else row[1]) + 1)
            for dof in dofs:
                axis, sign = goes[dof - 1] if row[0] not in local else (dof - 1, 1.0)
                amount = repr(sign*float(row[value])) if len(row) > value else '0.'
                new.append([row[0], str(axis + 1)] + ([str(axis + 1)] if keyword == 'BOUNDARY' else []) + [amount])
        data[:] = new
    for _, _, data in deck.each('DLOAD'):
        for row in data:
            if row[1] in ('BX', 'BY'):
                axis, sign = goes['BX BY'.split().index(row[1])]
                row[1:3] = ['BX BY'.split()[axis], repr(sign*float(row[2]))]
    for _, _, data in deck.each('SPRING'):
        if len(data) > 1:
            data[0][0] = str(goes[int(data[0][0]) - 1][0] + 1)
    for _, _, data in deck.each('EQUATION'):
        for row in data[1:]:
            for i in range(0, len(row), 3):
                axis, sign = goes[int(row[i + 1]) - 1]
                row[i + 1:i + 3] = [str(axis + 1), repr(sign*float(row[i + 2]))]


def places(deck):
    """(row, column of x) of all nodes and of the ends of drawn lines."""
    rows = [(row, 1) for _, _, data in deck.each('NODE') for row in data]
    return rows + [(row, i) for _, options, data in deck.each('SURFACE') if options.get('TYPE') == 'SEGMENTS' for row in data
                   for i in range(1, len(row) - 1, 2)]


def shaken(deck, rng, digits=1.0, is_chosen=lambda words: True):
    """No relation: each place off by a last digit or two, which is what turning a deck does to it; or by some more digits; or some."""
    deck = deck.copy()
    for row, i in places(deck):
        if is_chosen(row[i:i + 2]):
            digit = digits*2.0**-52*math.hypot(float(row[i]), float(row[i + 1]))
            row[i:i + 2] = [repr(float(word) + rng.choice((-1.0, 1.0))*digit) for word in row[i:i + 2]]
    return deck


def without_few_digits(deck, rng, digits):
    """The places that have at most twelve digits, body by body or line by line, get all of them: their new digits say nothing."""
    return shaken(deck, rng, digits, lambda words: all(float(f'{float(word):.11e}') == float(word) for word in words))


def quarter_turn(deck, _):
    if is_of_revolution(deck):
        return None
    deck, q = deck.copy(), np.array([[0.0, -1.0], [1.0, 0.0]])
    move_places(deck, q)
    signed_axes(deck, q)
    return deck, Back(q)


def mirror(deck, _):
    deck, q = deck.copy(), np.diag([1.0, -1.0] if is_of_revolution(deck) else [-1.0, 1.0])
    move_places(deck, q)
    signed_axes(deck, q)
    corners = {}
    for _, options, data in deck.each('ELEMENT'):
        if options['TYPE'].startswith('SPRING'):
            continue
        for row in data:
            nodes = row[1:]
            n = CORNERS.get(len(nodes), 4)
            corners[row[0]] = n
            # round the other way from the same node: sides and their middles in the opposite order
            row[1:] = [nodes[0], *nodes[n - 1:0:-1], *nodes[2*n - 1:n - 1:-1], *nodes[2*n:]]
    face = lambda element, old: corners[element] + 1 - old
    for _, options, data in deck.each('SURFACE'):
        if options.get('TYPE') == 'SEGMENTS':
            data[:] = backwards(data)
        else:
            for row in data:
                row[1] = f'S{face(row[0], int(row[1][1]))}'
    for _, _, data in deck.each('DLOAD'):
        for row in data:
            if row[1][0] == 'P' and row[0] in corners:
                row[1] = f'P{face(row[0], int(row[1][1]))}'
    return deck, Back(q)


def backwards(rows):
    """A drawn line from its other end."""
    out = [['START', *rows[-1][1:3]]]
    for before, row in zip(rows[-2::-1], rows[:0:-1]):
        out.append([row[0], *before[1:3], *row[3:]])
    return out


def turn(deck, rng):
    """By any angle: nodes that something holds get axes of their own."""
    degrees = rng.choice((30.0, 57.3, 114.6))
    if is_of_revolution(deck) or deck.each('SPRING', 'TRANSFORM', 'EQUATION'):
        return None
    by_axes = deck.each('CLOAD') or any(row[1] in ('BX', 'BY') for _, _, data in deck.each('DLOAD') for row in data)
    if len(deck.steps()[1]) > 1 and by_axes:
        return None  # a component that a later step gives again would take that of another load away
    a = math.radians(degrees)
    q = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    deck = deck.copy()
    sets = {options['NSET']: [word for row in data for word in row] for _, options, data in deck.each('NSET')}
    held = {node for _, _, data in deck.each('BOUNDARY') for row in data for node in sets.get(row[0], [row[0]])}
    move_places(deck, q)
    for _, _, data in deck.each('CLOAD'):
        new = []
        for row in data:
            dof = int(row[1]) - 1
            new += [row] if row[0] in held else [[row[0], str(i + 1), repr(float(q[i, dof]*float(row[2])))] for i in range(2)]
        data[:] = new
    for _, _, data in deck.each('DLOAD'):
        new = []
        for row in data:
            if row[1] in ('BX', 'BY'):
                dof = 'BX BY'.split().index(row[1])
                new += [[row[0], 'BX BY'.split()[i], repr(float(q[i, dof]*float(row[2])))] for i in range(2)]
            else:
                new.append(row)
        data[:] = new
    names = sorted(held, key=int)
    axes = [repr(float(v)) for v in (*q[:, 0], 0.0, *q[:, 1], 0.0)]
    extra = [('NSET', {'NSET': 'TURNED'}, [names[i:i + 12] for i in range(0, len(names), 12)]), ('TRANSFORM', {'NSET': 'TURNED'}, [axes])]
    at = next(i for i, card in enumerate(deck.cards) if card[0] in ('MATERIAL', 'STEP'))
    if names:
        deck.cards[at:at] = extra
    return deck, Back(q)


# -- units and numbers ----------------------------------------------------------------------------------------------------------


def units(deck, rng):
    """Lengths and forces in powers of two, which leaves all digits, or of ten."""
    base = rng.choice((2.0, 10.0))
    most = 9 if base == 2 else 3
    a, b = base**rng.randint(-most, most), base**rng.randint(-most, most)
    deck = deck.copy()
    factors = {'NODE': ((1, 2), a), 'ELASTIC': ((0,), b/a**2), 'DENSITY': ((0,), b/a**3), 'SOLID SECTION': ((0,), a), 'CLOAD': ((2,), b),
               'BOUNDARY': ((3,), a), 'CLEARANCE': ((1,), a)}
    for keyword, options, data in deck.cards:
        if keyword in factors:
            for row in data:
                times(row, *factors[keyword])
        elif keyword == 'SURFACE' and options.get('TYPE') == 'SEGMENTS':
            for row in data:
                times(row, range(1, len(row)), a)
        elif keyword == 'DSLOAD':
            for row in data:
                if 'FUNCTION' in options:
                    in_place(row, 2, f'(X/{a!r})', f'(Y/{a!r})')
                times(row, (2,), b/a**2)
        elif keyword == 'DLOAD':
            for row in data:
                times(row, (2,), 1.0 if row[1] == 'GRAV' else b/a**2 if row[1][0] == 'P' else b/a**3)
        elif keyword == 'SURFACE BEHAVIOR' and data:
            times(data[0], (0,), b/a**3 if options.get('PRESSURE-OVERCLOSURE') == 'LINEAR' else a**3/b)
        elif keyword == 'FRICTION':
            times(data[0], (1, 2), a) if 'NONLOCAL' in options else times(data[0], (1,), b/a**3)
        elif keyword == 'SPRING':
            times(data[-1], (0,), b/a)
    return deck, Back(length=a, force=b)


def renumber(deck, rng):
    """Nodes and elements get other numbers and stand in another order."""
    deck = deck.copy()
    nodes = [row[0] for _, _, data in deck.each('NODE') for row in data]
    elements = [row[0] for _, _, data in deck.each('ELEMENT') for row in data]
    node = dict(zip(nodes, map(str, rng.sample(range(1, 2*len(nodes) + 1), len(nodes)))))
    element = dict(zip(elements, map(str, rng.sample(range(1, 2*len(elements) + 1), len(elements)))))
    for keyword, options, data in deck.cards:
        if keyword in ('NODE', 'ELEMENT', 'SURFACE') and options.get('TYPE') != 'SEGMENTS':
            for row in data:
                row[0] = (node if keyword == 'NODE' else element)[row[0]]
                if keyword == 'ELEMENT':
                    row[1:] = [node[word] for word in row[1:]]
            rng.shuffle(data)
        elif keyword == 'NSET':
            data[:] = [[node[word] for word in row if word] for row in data]
        elif keyword == 'EQUATION':
            for row in data[1:]:
                row[::3] = [node[word] for word in row[::3]]
        elif keyword in ('BOUNDARY', 'CLEARANCE', 'CLOAD', 'TEMPERATURE'):
            for row in data:
                row[0] = node.get(row[0], row[0])
        elif keyword == 'DLOAD':
            for row in data:
                row[0] = element.get(row[0], row[0])
    return deck, Back(node={int(new): int(old) for old, new in node.items()})


# -- steps ----------------------------------------------------------------------------------------------------------------------


def empty_step(deck, _):
    if any(options.get('TIME') == 'TOTAL TIME' for _, options, _ in deck.each('AMPLITUDE')):
        return None  # such loads go on
    deck = deck.copy()
    deck.cards += [('STEP', {}, []), ('STATIC', {}, []), ('END STEP', {}, [])]
    return deck, Back(is_last=True)


def scaled_step(step, factor):
    out = []
    for keyword, options, data in step:
        data = [list(row) for row in data]
        for row in data:
            if keyword in ('CLOAD', 'DLOAD', 'DSLOAD'):
                times(row, (2,), factor)
            elif keyword == 'BOUNDARY':
                times(row, (3,), factor)
            elif keyword == 'TEMPERATURE':
                times(row, (1,), factor)
        out.append((keyword, dict(options), data))
    return out


def of_increments(step, n):
    return [(keyword, options, [[repr(1.0/n), '1.']] if keyword == 'STATIC' and n > 1 else [] if keyword == 'STATIC' else data)
            for keyword, options, data in step]


def split_step(deck, _):
    """Two steps of one increment each, and one step of two, which comes third."""
    head, steps = deck.steps()
    if len(steps) > 1 or any(options.get('AMPLITUDE') for _, options, _ in steps[0]):
        return None
    once = of_increments(steps[0], 1)
    one, two = deck.copy(), deck.copy()
    one.cards = head + of_increments(steps[0], 2)
    two.cards = head + scaled_step(once, 0.5) + once
    return two, Back(is_last=True), one


def begun(deck):
    """A history of two steps, and its first step alone, both with *RESTART: a deck of one step gets half of its loads first."""
    head, steps = deck.steps()
    if len(steps) == 1:
        steps = [scaled_step(steps[0], 0.5), steps[0]]
    head = head + [('RESTART', {'WRITE': ''}, [])]
    whole, part = deck.copy(), deck.copy()
    whole.cards, part.cards = head + [card for step in steps for card in step], head + steps[0]
    return whole, part
