"""Decks of quadrilaterals, straight ones, on finer and finer meshes, in both programs: they come to the same.

A quadrilateral is divided into n by n. A side whose ends are held is held; a force at a node is spread as the function of that node on the coarse
mesh, over the outer edges at it, or over the elements at a node within.
"""
import cards
import flatten
import results

TWICE = (1, 2, 4, 8)
DECKS = {"planestrain": TWICE, "planestress3": (*TWICE, 16, 32), "prepomax-style-stiff": (*TWICE, 16), "cae-style-alike": (*TWICE, 16),
         "prepomax-punch": (1, 2, 4)}
# of the finest mesh; a pressure that has no bound, at the corner of a punch, is spread differently for long
LIMIT = {"planestrain": 1e-5, "planestress3": 1e-4, "prepomax-style-stiff": 3e-3, "cae-style-alike": 1e-3, "prepomax-punch": 1e-2}


class Mesh:
    """The rows of one deck: divisions, difference, largest displacements."""

    def __init__(self, name, kind):
        self.name, self.kind, self.rows, self.fault = name, kind, [], ""

    def lines(self):
        """A table of the page."""
        lines = [f"`{self.name}` ({self.kind}{'; ' + self.fault if self.fault else ''})", "",
                 "| n | difference | atrito | CalculiX |", "|---|---|---|---|"]
        return lines + [f"| {n} | {off:.1e} | {ours:.5e} | {theirs:.5e} |" for n, off, ours, theirs in self.rows] + [""]

    def faults(self):
        """What is wrong: a finest mesh that is apart, or differences that grow by a tenth after the largest (or after those of printing)."""
        if self.fault:
            return [f"{self.name} refined: {self.fault}"]
        offs = [row[1] for row in self.rows]
        after = offs[offs.index(max(offs)):]
        grows = any(b > 1.1*a for a, b in zip(after, after[1:]) if b > 1e-5)
        return [f"{self.name} refined: differences {offs}"] if grows or offs[-1] > LIMIT[self.name] else []


def table(given, decks, solved):
    """The meshes of all decks that are there and are solved as they are."""
    made = []
    for name, divisions in DECKS.items():
        if name in decks and name in solved:
            made.append(series(given, name, cards.read(decks[name]), divisions))
    return made


def series(given, name, deck, divisions):
    """One deck on all its meshes."""
    mesh = Mesh(name, ", ".join(cards.element_types(deck)))
    for n in divisions:
        text = Divided(flatten.flat(deck).cards, n).text()
        copy = cards.read(text)
        try:
            ours, _ = results.atrito(given.atrito, given.work, f"{name}-{n}", cards.text_of(cards.for_atrito(copy)))
            theirs = results.ccx(given.ccx, given.work, f"{name}-{n}-ccx", cards.text_of(cards.for_ccx(copy)))
            off, _ = results.difference(ours, theirs)
        except results.Failed as failed:
            mesh.fault = str(failed)
            break
        mesh.rows.append((n, off, largest(ours), largest(theirs)))
    return mesh


def largest(moved):
    """The largest displacement."""
    return max(abs(value) for pair in moved[-1].values() for value in pair)


class Divided:
    """A flat deck of quadrilaterals with n by n for each."""

    def __init__(self, deck, n):
        self.deck, self.n, self.at, self.numbers = deck, n, {}, {}
        self.places, self.sets = places(deck), node_sets(deck)
        self.coarse, self.groups, self.weight, self.rows = cards.elements(deck), element_sets(deck), {}, {}
        edges = {edge for nodes in self.coarse.values() for edge in sides(nodes[:4])}
        self.middles = {tuple(sorted(edge)): middle for nodes in self.coarse.values() for edge, middle in zip(sides(nodes[:4]), nodes[4:])}
        self.outer_edges = [edge for edge in edges if edge[::-1] not in edges]
        self.first = {element: k*n*n + 1 for k, element in enumerate(self.coarse)}
        for element, nodes in self.coarse.items():
            self.divide(element, nodes)

    def number(self, key):
        """Number of the node with these shares of coarse nodes."""
        if key not in self.numbers:
            nodes = tuple(node for node, _ in key)
            known = nodes[0] if len(key) == 1 else self.middles.get(nodes) if key[0][1] == key[-1][1] == 0.5 else None
            self.numbers[key] = known or max(self.places) + len(self.numbers) + 1
            self.at[self.numbers[key]] = tuple(sum(share*self.places[node][k] for node, share in key) for k in (0, 1))
        return self.numbers[key]

    def divide(self, element, nodes):
        """The n by n elements of one, row by row; each gives a quarter of its share to its corners."""
        n, order = self.n, 2 if len(nodes) == 8 else 1

        def key(i, j):
            x, y = i/(n*order), j/(n*order)
            shares = zip(nodes, ((1 - x)*(1 - y), x*(1 - y), x*y, (1 - x)*y))
            return tuple(sorted((node, round(share, 12)) for node, share in shares if share > 0.0))
        for j in range(0, n*order, order):
            for i in range(0, n*order, order):
                keys = [key(i, j), key(i + order, j), key(i + order, j + order), key(i, j + order)]
                for corner in keys:
                    self.weight[corner] = self.weight.get(corner, 0.0) + 0.25
                if order == 2:
                    keys += [key(i + 1, j), key(i + 2, j + 1), key(i + 1, j + 2), key(i, j + 1)]
                self.rows[self.first[element] + (j*n + i)//order] = [self.number(key) for key in keys]

    def parts(self, element, face=0):
        """Numbers of the elements that a coarse one became; of those at one of its faces."""
        n, first = self.n, self.first[element]
        at = {0: range(n*n), 1: range(n), 2: range(n - 1, n*n, n), 3: range(n*n - n, n*n), 4: range(0, n*n, n)}[face]
        return [first + k for k in at]

    def spread(self, node):
        """Shares of a force at a coarse node: {number: share}."""
        ends = {end for edge in self.outer_edges if node in edge for end in edge}
        found = {}
        for key, number in self.numbers.items():
            shares = dict(key)
            if node in shares and (not ends or self.on_edge(shares, node)):
                weight = (1.0 if shares[node] < 1.0 else (len(ends) - 1)/2) if ends else self.weight[key]
                found[number] = shares[node]*weight
        return {number: share/sum(found.values()) for number, share in found.items()}

    def on_edge(self, shares, node):
        """Whether a node lies on an outer edge at a coarse node."""
        return any(node in edge and set(shares) <= set(edge) for edge in self.outer_edges)

    def text(self):
        """The deck."""
        lines = ["*NODE"] + [f"{node}, {x:.12e}, {y:.12e}" for node, (x, y) in sorted(self.at.items())]
        made = {"*ELEMENT": self.divided, "*ELSET": self.grouped, "*BOUNDARY": self.held, "*CLOAD": self.forces, "*SURFACE": self.on_faces,
                "*DLOAD": self.on_faces}
        for card in self.deck:
            if card.keyword in made:
                head = [", ".join(word for word in line.split(",") if word.strip().upper() != "GENERATE") for line in card.head]
                lines += head + made[card.keyword](card)
            elif card.keyword != "*NODE":
                lines += card.lines()
        return "\n".join(lines) + "\n"

    def divided(self, card):
        """Rows of elements."""
        return [", ".join(map(str, [k, *self.rows[k]])) for row in card.rows() for k in self.parts(int(row[0]))]

    def grouped(self, card):
        """Rows of a set of elements; names of sets stay."""
        return [str(k) for element in members(card, {}) for k in (self.parts(element) if isinstance(element, int) else [element])]

    def on_faces(self, card):
        """Rows of a surface or of pressures: a row an element."""
        lines = []
        for row in card.rows():
            elements = [int(row[0])] if row[0].isdigit() else self.groups[row[0].upper()]
            face = int(row[1][1]) if row[1][1:].isdigit() else 0
            lines += [", ".join([str(k), *row[1:]]) for element in elements for k in self.parts(element, face)]
        return lines

    def forces(self, card):
        """Forces, spread; of elements of eight nodes as they are."""
        rows = [[node, *row[1:]] for row in card.rows() for node in self.sets.get(row[0].upper(), [row[0]])]
        if self.middles:
            return [", ".join(map(str, row)) for row in rows]
        return [f"{node}, {row[1]}, {float(row[2])*share:.12e}" for row in rows for node, share in self.spread(int(row[0])).items()]

    def held(self, card):
        """Supports: of a degree of freedom all nodes between coarse nodes that are held, by the same value, on one outer edge."""
        lines, held = [], {}
        for row in card.rows():
            first, last, value = (row + ["", "", ""])[1:4]
            for dof in range(int(first), int(last or first) + 1):
                held.setdefault((dof, float(value or 0)), set()).update(map(int, self.sets.get(row[0].upper(), [row[0]])))
        for (dof, value), nodes in held.items():
            for key, number in self.numbers.items():
                on = {node for node, _ in key}
                if on <= nodes and (len(on) == 1 or any(on <= set(edge) for edge in self.outer_edges)):
                    lines.append(f"{number}, {dof}, {dof}" + (f", {value!r}" if value else ""))
        return lines


def sides(nodes):
    """Edges of an element."""
    return list(zip(nodes, nodes[1:] + nodes[:1]))


def places(deck):
    """Coordinates of the nodes; what is not given is 0."""
    found = {}
    for card in deck:
        if card.keyword == "*NODE":
            for row in card.rows():
                xy = [float(word) if word else 0.0 for word in row[1:3]]
                found[int(row[0])] = tuple((xy + [0.0, 0.0])[:2])
    return found


def members(card, known):
    """What a set lists: numbers, and the members of known sets or the names of others."""
    found = []
    for row in card.rows():
        if "GENERATE" in card.options:
            found += range(int(row[0]), int(row[1]) + 1, int((row + [""])[2] or 1))
        else:
            for word in filter(None, row):
                found += [int(word)] if word.isdigit() else known.get(word.upper(), [word])
    return found


def node_sets(deck):
    """Numbers of the nodes of each set."""
    found = {}
    for card in deck:
        if card.keyword == "*NSET":
            found.setdefault(card.options["NSET"], []).extend(members(card, found))
        elif card.keyword == "*NODE" and "NSET" in card.options:
            found.setdefault(card.options["NSET"], []).extend(int(row[0]) for row in card.rows())
    return found


def element_sets(deck):
    """Numbers of the elements of each set."""
    found = {}
    for card in deck:
        if card.keyword == "*ELSET":
            found.setdefault(card.options["ELSET"], []).extend(members(card, found))
        elif card.keyword == "*ELEMENT" and "ELSET" in card.options:
            found.setdefault(card.options["ELSET"], []).extend(int(row[0]) for row in card.rows())
    return found
