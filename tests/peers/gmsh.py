"""A deck with a mesh of Gmsh made flat: CalculiX reads no .msh. Format 4.1, text; standard library alone.

The mesh becomes nodes, elements (clockwise ones turned), a set of nodes and one of elements of each physical group, and of each physical
curve a surface of the faces that lie on it, under the names of the groups.
"""
import cards as deck_cards

FACES = {3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 3), (3, 0))}
KINDS = {2: 3, 3: 4, 9: 6, 16: 8}        # Gmsh's numbers of triangles and quadrilaterals, and their nodes


class Mesh:
    """Nodes, elements, lines by their entities, and the groups of the entities."""

    def __init__(self, text):
        self.nodes, self.elements, self.of, self.lines = {}, {}, {}, {}
        self.groups = {}                 # name: (dimension, tags of its entities)
        blocks = {}
        for block in text.split("$End")[:-1]:
            head, _, body = block.partition("\n$")[2].partition("\n") if not block.startswith("$") else block[1:].partition("\n")
            blocks[head.strip()] = body.splitlines()
        names = self.names(blocks.get("PhysicalNames", ["0"]))
        self.read_entities(blocks["Entities"], names)
        self.read_nodes(blocks["Nodes"])
        self.read_elements(blocks["Elements"])

    @staticmethod
    def names(lines):
        """Names of physical groups by dimension and tag."""
        rows = [line.split(maxsplit=2) for line in lines[1:]]
        return {(int(row[0]), int(row[1])): row[2].strip('"') for row in rows}

    def read_entities(self, lines, names):
        """Which entities are of which groups."""
        counts = [int(word) for word in lines[0].split()]
        dimensions = [k for k, count in enumerate(counts) for _ in range(count)]
        for dimension, line in zip(dimensions, lines[1:]):
            words = line.split()
            at = 4 if dimension == 0 else 7
            for group in words[at + 1:at + 1 + int(words[at])]:
                name = names[dimension, abs(int(group))]
                self.groups.setdefault(name, (dimension, []))[1].append(int(words[0]))

    def read_nodes(self, lines):
        """Coordinates by number."""
        at = 1
        while at < len(lines):
            count = int(lines[at].split()[3])
            for k in range(at + 1, at + 1 + count):
                self.nodes[int(lines[k])] = tuple(float(word) for word in lines[k + count].split()[:2])
            at += 1 + 2*count

    def read_elements(self, lines):
        """Nodes of the elements of surfaces, and of the lines of curves."""
        at = 1
        while at < len(lines):
            dimension, tag, kind, count = (int(word) for word in lines[at].split())
            for line in lines[at + 1:at + 1 + count]:
                number, *nodes = (int(word) for word in line.split())
                if dimension == 2:
                    self.elements[number], self.of[number] = self.turned(nodes, KINDS[kind]), tag
                elif dimension == 1:
                    self.lines.setdefault(tag, []).append(nodes)
            at += 1 + count

    def turned(self, nodes, count):
        """The nodes counterclockwise."""
        corners = count if count < 6 else count//2
        ring = [self.nodes[node] for node in nodes[:corners]]
        twice = sum(a[0]*b[1] - b[0]*a[1] for a, b in zip(ring, ring[1:] + ring[:1]))
        if twice > 0.0:
            return nodes
        return [nodes[0], *nodes[corners - 1:0:-1], *nodes[:corners - 1:-1]] if count > 4 else [nodes[0], *nodes[:0:-1]]

    def faces(self, tags):
        """Element and number of the faces that lie on curves."""
        on = {frozenset(line[:2]) for tag in tags for line in self.lines.get(tag, [])}
        found = []
        for element, nodes in self.elements.items():
            corners = len(nodes) if len(nodes) < 6 else len(nodes)//2
            found += [(element, k + 1) for k, ends in enumerate(FACES[corners]) if frozenset(nodes[end] for end in ends) in on]
        return found

    def cards(self, family):
        """Cards of the mesh; the family of the elements: CPE, CPS or CAX."""
        used = {node for nodes in self.elements.values() for node in nodes}
        made = [deck_cards.card_of("*NODE", *[f"{node}, {x:.12e}, {y:.12e}" for node, (x, y) in self.nodes.items() if node in used])]
        for count in sorted({len(nodes) for nodes in self.elements.values()}):
            rows = [", ".join(map(str, [number, *nodes])) for number, nodes in self.elements.items() if len(nodes) == count]
            made.append(deck_cards.card_of(f"*ELEMENT, TYPE={family}{count}", *rows))
        for name, (dimension, tags) in self.groups.items():
            if dimension == 2:
                made.append(deck_cards.card_of(f"*ELSET, ELSET={name}", *[str(number) for number, tag in self.of.items() if tag in tags]))
            elif dimension == 1:
                nodes = dict.fromkeys(node for tag in tags for line in self.lines.get(tag, []) for node in line)
                made.append(deck_cards.card_of(f"*NSET, NSET={name}", *map(str, nodes)))
                made.append(deck_cards.card_of(f"*SURFACE, NAME={name}, TYPE=ELEMENT", *[f"{number}, S{face}" for number, face in self.faces(tags)]))
        return made


def located(text, folder):
    """The deck with the paths of its meshes from anywhere."""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        if line.upper().replace(" ", "").startswith("*INCLUDE,INPUT="):
            head, _, rest = line.partition("=")
            lines[k] = f"{head}={(folder/rest.split(',')[0].strip()).resolve()},{rest.partition(',')[2]}"
    return "\n".join(lines) + "\n"


def flat(cards, folder):
    """The deck with the nodes and elements of its meshes."""
    made = []
    for card in cards:
        if card.keyword == "*INCLUDE" and card.options.get("TYPE") == "GMSH":
            name = next(word.partition("=")[2].strip() for word in " ".join(card.head).split(",") if word.strip().upper().startswith("INPUT"))
            made += Mesh((folder/name).read_text()).cards(card.options.get("ELEMENTS", "CPS"))
        else:
            made.append(card)
    return made
