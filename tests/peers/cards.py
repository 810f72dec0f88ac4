"""Decks as cards, and the copies of a deck that are compared: of one load history, with the displacements of all nodes asked for.

Only what asks for output, and NLGEOM, is changed; everything else stays as it was written. Standard library alone.
"""
import gzip

OUTPUT = {"*NODEPRINT", "*NODEFILE", "*ELPRINT", "*ELFILE", "*CONTACTPRINT", "*CONTACTFILE", "*NODEOUTPUT", "*ELEMENTOUTPUT",
          "*CONTACTOUTPUT", "*OUTPUT", "*SECTIONPRINT", "*ENERGYPRINT"}


NODES = {stem + str(count): count for stem in ("CPE", "CPS", "CAX", "M3D") for count in (3, 4, 6, 8)}


class Card:
    """A keyword, its options (in capitals, without blanks), its keyword lines and its data lines."""

    def __init__(self, line):
        self.head, self.data = [line], []
        self.keyword, self.options = "", {}

    def close(self):
        """Reads the keyword line once it is whole."""
        words = [word.strip() for word in " ".join(self.head).split(",") if word.strip()]
        self.keyword = "".join(words[0].split()).upper()
        pairs = [word.partition("=") for word in words[1:]]
        self.options = {name.strip().upper(): value.strip().upper() for name, _, value in pairs}

    def rows(self):
        """Data lines as lists of items."""
        return [[word.strip() for word in line.split(",")] for line in self.data]

    def lines(self):
        """The card as it was written."""
        return self.head + self.data


def read(text):
    """The cards of a deck; comments and empty lines are left out."""
    cards, goes_on = [], False
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if goes_on:
            cards[-1].head.append(line)
        elif line.lstrip().startswith("*"):
            cards.append(Card(line))
        elif cards:
            cards[-1].data.append(line)
        goes_on = (goes_on or line.lstrip().startswith("*")) and line.rstrip().endswith(",")
    for card in cards:
        card.close()
    return cards


def text_of(cards):
    """A deck of these cards."""
    return "\n".join(line for card in cards for line in card.lines()) + "\n"


def card_of(*lines):
    """A card from its lines."""
    card = Card(lines[0])
    card.data = list(lines[1:])
    card.close()
    return card


def without_output(cards):
    """All but the requests of output."""
    return [card for card in cards if card.keyword not in OUTPUT]


def asking(cards, *requests):
    """The cards with other requests of output in each step."""
    asked = []
    for card in without_output(cards):
        if card.keyword == "*ENDSTEP":
            asked += [card_of(*request) for request in requests]
        asked.append(card)
    return asked


def is_large(cards):
    """Whether a step asks for large displacements."""
    return any(card.keyword == "*STEP" and card.options.get("NLGEOM", "NO") != "NO" for card in cards)


def linear(cards):
    """Steps without NLGEOM."""
    return [without(card, "NLGEOM") if card.keyword == "*STEP" else card for card in cards]


def without(card, option):
    """A card without one of its options."""
    words = [word.strip() for word in " ".join(card.head).split(",") if word.strip()]
    return card_of(", ".join(word for word in words if not word.upper().startswith(option)), *card.data)


def for_ccx(cards):
    """What CalculiX runs: displacements at the end of each step, of the plane's nodes or, of bodies of revolution, of the solid's; with the
    equation solver that it has."""
    form = "3D" if of_revolution(cards) else "2D"
    return asking([without(card, "SOLVER") if card.keyword == "*STATIC" else card for card in linear(cards)],
                  (f"*NODE FILE, OUTPUT={form}, FREQUENCY=1000000", "U"), *([("*CONTACT FILE, FREQUENCY=1000000", "CSTR")] if touches(cards) else []))


def for_atrito(cards):
    """What atrito runs for its table of nodes: the deck with *NODE PRINT of all nodes."""
    return asking(cards, ("*NODE PRINT", "U"), *([("*CONTACT PRINT", "CSTRESS")] if touches(cards) else []))


def touches(cards):
    """Whether there are pairs of contact."""
    return any(card.keyword == "*CONTACTPAIR" for card in cards)


def steps(cards):
    """How many steps there are."""
    return sum(card.keyword == "*STEP" for card in cards)


def element_types(cards):
    """Types of elements, in the order of the deck."""
    found = [card.options.get("TYPE", "?") for card in cards if card.keyword == "*ELEMENT"]
    return list(dict.fromkeys(found))


def plane(cards):
    """Whether all elements are of a plane or of revolution, or lines on their edges."""
    kinds = element_types(cards)
    return any(kind.startswith(("CPE", "CPS", "CAX", "M3D")) for kind in kinds)


def of_revolution(cards):
    """Whether there are elements of bodies of revolution."""
    return any(kind.startswith("CAX") for kind in element_types(cards))


def elements(cards):
    """Nodes of the elements by number."""
    found, items, wanted = {}, [], 0
    for card in cards:
        if card.keyword == "*ELEMENT":
            wanted = NODES.get(card.options.get("TYPE", "").rstrip("R"), 0)
            for row in card.rows() if wanted else []:
                items += [int(word) for word in row if word]
                if len(items) > wanted:
                    found[items[0]] = items[1:]
                    items = []
    return found


def decks(folder):
    """Text of the decks of a folder by name, packed or not."""
    found = {}
    for path in sorted(folder.iterdir()):
        name = path.name.removesuffix(".gz")
        if name.endswith(".inp"):
            raw = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
            found[name.removesuffix(".inp")] = raw.decode("utf-8", "replace")
    return found
