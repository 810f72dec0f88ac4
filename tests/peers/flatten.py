"""Decks of parts and instances, as Abaqus/CAE writes them, made flat: CalculiX reads no *PART. Standard library alone.

Nodes and elements of the instances are numbered one after the other, in the order of their cards; a set or surface of an instance is called
INSTANCE_NAME. Words for supports (ENCASTRE) become degrees of freedom of the plane, and a pair gets the TYPE that CalculiX must be told.
"""
import math

import cards as deck_cards

SUPPORTS = {"ENCASTRE": (1, 2), "PINNED": (1, 2), "XSYMM": (1, 1), "YSYMM": (2, 2), "XASYMM": (2, 2), "YASYMM": (1, 1)}
LISTS = {"*NSET": "NSET", "*ELSET": "ELSET"}
REFERENCES = {"*BOUNDARY": 1, "*CLOAD": 1, "*DLOAD": 1, "*DSLOAD": 1, "*CONTACTPAIR": 2, "*TIE": 2, "*SURFACE": 1, "*TEMPERATURE": 1,
              "*INITIALCONDITIONS": 1, "*NSET": 99, "*ELSET": 99}
SAME = 1e-7
ENDS = ("*PART", "*ENDPART", "*ASSEMBLY", "*ENDASSEMBLY", "*INSTANCE", "*ENDINSTANCE")
NOT_MOVED = ((0.0, 0.0), (0.0, 0.0, 0.0))


class Scope:
    """An instance: its name, what is added to its numbers, and its place."""

    def __init__(self, name, nodes, elements, place):
        self.name, self.nodes, self.elements, self.place = name, nodes, elements, place

    def moved(self, x, y):
        """Coordinates after the translation and the rotation about an axis along z."""
        (tx, ty), (xa, ya, angle) = self.place
        x, y, c, s = x + tx - xa, y + ty - ya, math.cos(angle), math.sin(angle)
        return xa + c*x - s*y, ya + s*x + c*y

    def named(self, word):
        """The flat name of a set or surface, or the flat number of a node."""
        if word.isdigit():
            return str(int(word) + self.nodes)
        return f"{self.name}_{word}" if self.name else word


class Flat:
    """A flat deck; places of its nodes, by number."""

    def __init__(self, cards):
        self.cards = cards
        self.places = {}
        for card in cards:
            if card.keyword == "*NODE":
                for row in card.rows():
                    xy = [float(word) if word else 0.0 for word in row[1:3]] + [0.0, 0.0]
                    self.places[int(row[0])] = tuple(xy[:2])

    def renumbered(self, moved, places):
        """Displacements of a run of the deck of parts by the numbers of the flat deck: by place, at one place by the order of the numbers."""
        if all(math.dist(place, self.places.get(node, (math.inf, 0.0))) <= SAME*(1.0 + math.hypot(*place)) for node, place in places.items()):
            return moved
        ours, numbers = by_place(places), {}
        for place, nodes in by_place(self.places).items():
            numbers.update(zip(ours.get(place, []), nodes))
        return [{numbers.get(node, -node): value for node, value in step.items()} for step in moved]


def by_place(places):
    """Numbers of the nodes at each place, in order."""
    found = {}
    for node in sorted(places):
        key = tuple(round(value, 7) + 0.0 for value in places[node])
        found.setdefault(key, []).append(node)
    return found


def flat(cards):
    """The deck without parts and instances; a deck without them as it is."""
    if not any(card.keyword == "*INSTANCE" for card in cards):
        return Flat(cards)
    parts, body, scopes, made, inside, assembly = {}, None, {}, [], None, None
    for card in cards:
        if card.keyword == "*PART":
            body = parts.setdefault(card.options["NAME"], [])
        elif card.keyword == "*ENDPART":
            body = None
        elif body is not None:
            body.append(card)
        elif card.keyword == "*INSTANCE":
            inside = instance(card, made)
            scopes[inside.name] = inside
            made += [placed(own, inside) for own in parts.get(card.options.get("PART", ""), [])]
        elif card.keyword == "*ENDINSTANCE":
            inside = None
        elif card.keyword not in ENDS:
            if card.keyword == "*NODE" and not inside and not assembly:
                assembly = Scope("", *behind(made), NOT_MOVED)
            made.append(placed(card, inside) if inside else outer(card, scopes, assembly))
    return Flat(made)


def instance(card, made):
    """A scope behind all nodes and elements so far."""
    rows = [[float(word) for word in row if word] for row in card.rows()]
    shift = (rows[0] + [0.0, 0.0])[:2] if rows else [0.0, 0.0]
    turn = (rows[1][0], rows[1][1], math.radians(rows[1][6])*(1 if rows[1][5] > rows[1][2] else -1)) if len(rows) > 1 else (0.0, 0.0, 0.0)
    return Scope(card.options["NAME"], *behind(made), (shift, turn))


def behind(made):
    """The largest numbers of a node and of an element so far."""
    numbers = {"*NODE": [0], "*ELEMENT": [0]}
    for own in made:
        if own.keyword in numbers:
            numbers[own.keyword] += [int(row[0]) for row in own.rows()]
    return max(numbers["*NODE"]), max(numbers["*ELEMENT"])


def placed(card, scope):
    """A card of a part in an instance."""
    rows = card.rows()
    if card.keyword == "*NODE":
        xy = [scope.moved(*([float(word) if word else 0.0 for word in row[1:3]] + [0.0, 0.0])[:2]) for row in rows]
        rows = [[str(int(row[0]) + scope.nodes), *(f"{value:.12e}" for value in at)] for row, at in zip(rows, xy)]
    elif card.keyword == "*ELEMENT":
        rows = [[str(int(row[0]) + scope.elements)] + [str(int(word) + scope.nodes) for word in row[1:] if word] for row in rows]
    elif card.keyword in LISTS:
        rows = listed(card, scope)
    elif card.keyword == "*SURFACE":
        rows = [[str(int(row[0]) + scope.elements) if row[0].isdigit() else scope.named(row[0].upper()), *row[1:]] for row in rows]
    return made_card(card, rows, {name: scope.named(card.options[name]) for name in named_options(card)})


def listed(card, scope):
    """Rows of a set of nodes or elements."""
    more = scope.nodes if card.keyword == "*NSET" else scope.elements
    if "GENERATE" in card.options:
        return [[str(int(row[0]) + more), str(int(row[1]) + more), *row[2:]] for row in card.rows()]
    return [[str(int(word) + more) if word.isdigit() else scope.named(word.upper()) for word in row if word] for row in card.rows()]


def named_options(card):
    """Options that name a set or a surface of the instance."""
    return [name for name in ("NSET", "ELSET", "NAME") if name in card.options and (name != "NAME" or card.keyword == "*SURFACE")]


def outer(card, scopes, assembly):
    """A card of the assembly or of the model: references name their instance; a number alone is one of the assembly's own nodes."""
    if card.keyword in LISTS and "INSTANCE" in card.options:
        scope = scopes[card.options["INSTANCE"]]
        return made_card(card, listed(card, scope), {})
    if card.keyword == "*NODE" or (card.keyword == "*NSET" and assembly and "GENERATE" in card.options):
        return placed(card, assembly)
    rows = [[reference(word, scopes, assembly) if k < REFERENCES.get(card.keyword, 0) else word for k, word in enumerate(row)] for row in card.rows()]
    if card.keyword == "*CONTACTPAIR":
        return made_card(card, rows, {"TYPE": card.options.get("TYPE", "SURFACE TO SURFACE")})   # which CalculiX must be told
    if card.keyword == "*BOUNDARY":
        rows = [[row[0], *map(str, SUPPORTS[row[1].upper()])] if row[1].upper() in SUPPORTS else row for row in rows]
    return made_card(card, rows, {})


def reference(word, scopes, assembly):
    """The flat name of INSTANCE.NAME or ASSEMBLY.INSTANCE.NAME, or the flat number of a node of the assembly."""
    if assembly and word.isdigit():
        return assembly.named(word)
    pieces = word.upper().split(".")
    if len(pieces) > 1 and pieces[-2] in scopes:
        return scopes[pieces[-2]].named(pieces[-1])
    return word


def made_card(card, rows, options):
    """A card with other data and other values of some options."""
    given = {**card.options, **options}
    given.pop("INSTANCE", None)
    words = [card.keyword] + [f"{name}={value}" if value else name for name, value in given.items() if name != "INTERNAL"]
    made = deck_cards.card_of(", ".join(words), *[", ".join(row) for row in rows])
    return made
