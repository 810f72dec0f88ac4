"""Makes the decks contact-*.inp, which atrito and CalculiX read alike.

    python3 make_decks.py FOLDER [NAME ...]

Standard library alone. A deck is meshes (nodes, elements, faces), sections, pairs and steps; a line `** compare: ...` says
where the pressures of its pairs are compared (compare_contact.py).
"""
import math
import pathlib
import sys


def graded(*parts):
    """Places of corners: parts (start, end, count, ratio), ratio = last over first length, one after the other."""
    places = [parts[0][0]]
    for start, end, count, ratio in parts:
        q = ratio**(1/(count - 1)) if count > 1 else 1.0
        lengths = [q**k for k in range(count)]
        total = 0.0
        for length in lengths:
            total += length
            places.append(start + (end - start)*total/sum(lengths))
    return places


def even(start, end, count):
    """Places of corners, all lengths alike."""
    return graded((start, end, count, 1.0))


class Deck:
    """The cards of a deck; nodes and elements count on from mesh to mesh."""

    def __init__(self, title, *comments):
        self.lines = ["*HEADING", title] + ["** " + comment for comment in comments]
        self.nodes = 0
        self.elements = 0
        self.e_type = ""

    def add(self, text):
        """Lines as they are."""
        self.lines += text.strip().split("\n")

    def mesh(self, name, e_type, us, vs, place):
        """A mesh over the corners us x vs, taken to (x, y) by place(u, v); sets and surfaces NAME-BOTTOM, -RIGHT, -TOP, -LEFT."""
        self.e_type = e_type
        second = e_type[3] in "68"
        step = 2 if second else 1
        nu, nv = step*(len(us) - 1), step*(len(vs) - 1)

        def at(corners, k):
            if not second:
                return corners[k]
            return corners[k//2] if k % 2 == 0 else (corners[k//2] + corners[k//2 + 1])/2

        number = {}
        self.add(f"*NODE, NSET={name}")
        for j in range(nv + 1):
            for i in range(nu + 1):
                if e_type[3] == "8" and i % 2 and j % 2:
                    continue
                self.nodes += 1
                number[i, j] = self.nodes
                x, y = place(at(us, i), at(vs, j))
                self.lines.append(f"{self.nodes},{x + 0.0:.8g},{y + 0.0:.8g}")
        self.add(f"*ELEMENT, TYPE={e_type}, ELSET={name}")
        faces = {side: [] for side in ("BOTTOM", "RIGHT", "TOP", "LEFT")}
        for j in range(0, nv, step):
            for i in range(0, nu, step):
                self.cell(number, i, j, step, (nu, nv), faces)
        for side, found in faces.items():
            self.add(f"*SURFACE, NAME={name}-{side}, TYPE=ELEMENT")
            self.lines += [f"{element},S{face}" for element, face in found]
        edges = {"BOTTOM": [(i, 0) for i in range(nu + 1)], "TOP": [(i, nv) for i in range(nu + 1)],
                 "LEFT": [(0, j) for j in range(nv + 1)], "RIGHT": [(nu, j) for j in range(nv + 1)]}
        for side, keys in edges.items():
            self.add(f"*NSET, NSET={name}-{side}")
            listed = [str(number[key]) for key in keys if key in number]
            self.lines += [",".join(listed[k:k + 14]) for k in range(0, len(listed), 14)]

    def cell(self, number, i, j, step, ends, faces):
        """The element, or the two triangles, of a cell."""
        corners = [(i, j), (i + step, j), (i + step, j + step), (i, j + step)]
        if self.e_type[3] in "36":
            pieces = [([0, 1, 2], {0: "BOTTOM", 1: "RIGHT"}), ([0, 2, 3], {1: "TOP", 2: "LEFT"})]
        else:
            pieces = [([0, 1, 2, 3], {0: "BOTTOM", 1: "RIGHT", 2: "TOP", 3: "LEFT"})]
        outside = {"BOTTOM": j == 0, "RIGHT": i + step == ends[0], "TOP": j + step == ends[1], "LEFT": i == 0}
        for piece, sides in pieces:
            self.elements += 1
            keys = [corners[k] for k in piece]
            if step == 2:
                keys += [tuple((a + b)//2 for a, b in zip(keys[k], (keys[1:] + keys[:1])[k])) for k in range(len(piece))]
            self.lines.append(",".join([str(self.elements)] + [str(number[key]) for key in keys]))
            for k, side in sides.items():
                if outside[side]:
                    faces[side].append((self.elements, k + 1))

    def material(self, name, sets, modulus=1000.0, poisson=0.3, thickness=1.0, extra=""):
        """A material, and the sections that have it."""
        self.add(f"*MATERIAL, NAME={name}\n*ELASTIC\n{modulus:g}, {poisson:g}{extra}")
        for each in sets.split():
            self.add(f"*SOLID SECTION, ELSET={each}, MATERIAL={name}" + ("" if "CAX" in self.e_type else f"\n{thickness:g}"))

    def pair(self, slave, master, friction=0.3, slope=1e6, stick=1e5, name="ROUGH"):
        """A pair with a law of its own."""
        self.add(f"*SURFACE INTERACTION, NAME={name}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{slope:g}")
        if friction:
            self.add(f"*FRICTION\n{friction:g}, {stick:g}")
        self.add(f"*CONTACT PAIR, INTERACTION={name}, TYPE=SURFACE TO SURFACE\n{slave}, {master}")

    def step(self, lines, increment=0.25, direct=False, supports="", contact=""):
        """A step; the first one has the requests: the forces of a set of supports, and of a pair."""
        self.add(f"*STEP\n*STATIC{', DIRECT' if direct else ''}\n{increment:g}, 1.")
        self.add(lines)
        for each in supports.split():
            self.add(f"*NODE PRINT, NSET={each}, FREQUENCY=1000\nRF")
        if contact:
            slave, master = contact.split()
            self.add(f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}, FREQUENCY=1000\nCF")
        if supports or contact:
            self.add("*CONTACT FILE, FREQUENCY=1000\nCSTR")
        self.add("*END STEP")


def contact_line(half, inside, edge):
    """A side from -half to half whose elements become finer to its ends, where the pressure has no bound."""
    inner = 0.78*half
    return graded((-half, -inner, edge, 0.35), (-inner, inner, inside, 1.0), (inner, half, edge, 1/0.35))


def beneath(line, far, out):
    """The same corners, and some on both sides of them."""
    half, least = line[-1], line[-1] - line[-2]
    right = graded((half, far, out, 0.45*(far - half)/least/out))
    return [-x for x in right[:0:-1]] + line + right[1:]


def flat(u, v):
    """The plane as it is."""
    return u, v


def punch(name, title, e_type, low, high, thickness=1.0, gap=0.0, friction=0.3, steps=(), moduli=(1000.0, 1000.0)):
    """A rectangle 1 x 0.5 on a block 2 x 1, whose base is held; the corners of the rectangle are left out of the comparison."""
    deck = Deck(title, "compare: UPPER-BOTTOM x -0.401 0.401")
    inside, edge, down = low
    deck.mesh("LOWER", e_type, beneath(contact_line(0.5, inside, edge), 1.0, 6), graded((-1.0, 0.0, down, 0.06)), flat)
    inside, edge, up = high
    deck.mesh("UPPER", e_type, contact_line(0.5, inside, edge), graded((gap, gap + 0.5, up, 10.0)), flat)
    deck.material("BELOW", "LOWER", moduli[0], thickness=thickness)
    deck.material("ABOVE", "UPPER", moduli[1], thickness=thickness)
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", friction)
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, "LOWER-BOTTOM" if k == 0 else "")
    return name, deck


def top(x=None, y=None):
    """The upper side moves."""
    lines = ["*BOUNDARY"]
    if x is not None:
        lines.append(f"UPPER-TOP, 1, 1, {x:g}")
    if y is not None:
        lines.append(f"UPPER-TOP, 2, 2, {y:g}")
    return "\n".join(lines)


def cylinder(name, title, e_type, counts, radius=4.0, reach=0.3, window=0.14, thickness=1.0, gap=0.0, friction=0.3,
             steps=(), moduli=(1000.0, 1000.0), centre=0.0, bore=-1.0):
    """A body whose under side has a radius on a block; with a bore half of that, of revolution.

    counts: elements over the reach (below, above), outside, down.
    """
    low = bore + 0.013 if bore > 0.0 else -window
    axial = ("compare: axial forces",) if bore > 0.0 else ()
    deck = Deck(title, f"compare: UPPER-BOTTOM x {centre + low:g} {centre + window:g}", *axial)
    inside, out, down = counts

    def across(width, faces):
        """Alike within the reach, then growing; from the bore, or from side to side."""
        right = graded((max(bore, 0.0), reach, faces, 1.0), (reach, width, out, 5.0))
        return right if bore > 0.0 else [-x for x in right[:0:-1]] + right

    def under(u, v):
        t = (v - gap)/0.5
        return centre + u, v + (1 - t)*u*u/(radius + math.sqrt(radius*radius - u*u))

    deck.mesh("LOWER", e_type, across(1.0, inside[0]), graded((-1.0, 0.0, down, 0.05)), turned(0.0, centre))
    deck.mesh("UPPER", e_type, across(0.5, inside[1]), graded((gap, gap + 0.5, down, 12.0)), under)
    deck.material("BELOW", "LOWER", moduli[0], thickness=thickness)
    deck.material("ABOVE", "UPPER", moduli[1], thickness=thickness)
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", friction)
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        requests = ("", "UPPER-BOTTOM LOWER-TOP") if "CAX" in e_type else ("LOWER-BOTTOM", "")
        deck.step(lines, increment, direct, *(requests if k == 0 else ("", "")))
    return name, deck


def ring(name, title, e_type, low, high, gap=0.0, friction=0.3, steps=()):
    """Bodies of revolution, 1.5 < r < 2.5 on 1 < r < 3, whose base is held."""
    deck = Deck(title, "compare: UPPER-BOTTOM x 1.599 2.401")
    inside, edge, down = low
    side = contact_line(0.5, inside, edge)
    deck.mesh("LOWER", e_type, beneath(side, 1.0, 5), graded((-1.0, 0.0, down, 0.06)), turned(0.0, 2.0))
    inside, edge, up = high
    deck.mesh("UPPER", e_type, contact_line(0.5, inside, edge), graded((gap, gap + 0.5, up, 10.0)), turned(0.0, 2.0))
    deck.material("STEEL", "LOWER UPPER")
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", friction)
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, *(("", "UPPER-BOTTOM LOWER-TOP") if k == 0 else ("", "")))
    return name, deck


def turned(degrees, x0=0.0, y0=0.0):
    """The plane turned about the origin and moved."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda u, v: (x0 + c*u - s*v, y0 + s*u + c*v)


def incline(name, title, e_type, steps):
    """A rectangle on a block that is turned by 15 degrees."""
    deck = Deck(title, "compare: UPPER-BOTTOM x -0.38 0.38")
    side = contact_line(0.5, 12, 5)
    deck.mesh("LOWER", e_type, beneath(side, 1.0, 5), graded((-1.0, 0.0, 8, 0.06)), turned(15.0))
    deck.mesh("UPPER", e_type, side, graded((0.0, 0.5, 6, 8.0)), turned(15.0))
    deck.material("M", "LOWER UPPER")
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", 0.2)
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, "LOWER-BOTTOM" if k == 0 else "")
    return name, deck


def pin(name, title, e_type, steps, window, friction=0.3, clearance=0.02):
    """The lower half of a hollow pin of radius 1 in that of a ring; the pin's inner side is moved, the ring's outer one held."""
    deck = Deck(title, f"compare: PIN-BOTTOM x {-window:g} {window:g}")
    # u: angle from straight down, to the right; v: radius with the other sign, so that elements are counter-clockwise
    def about(y0):
        return lambda u, v: (-v*math.sin(u), y0 + v*math.cos(u))

    angles = graded((-1.5, -0.6, 5, 0.3), (-0.6, 0.6, 24, 1.0), (0.6, 1.5, 5, 1/0.3))
    deck.mesh("RING", e_type, angles, graded((-1.8, -1.0 - clearance, 6, 0.15)), about(clearance))
    deck.mesh("PIN", e_type, angles, graded((-1.0, -0.4, 6, 5.0)), about(0.0))
    deck.material("M", "RING PIN")
    deck.pair("PIN-BOTTOM", "RING-TOP", friction)
    deck.add("*BOUNDARY\nRING-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, "RING-BOTTOM" if k == 0 else "")
    return name, deck


def hub(name, title, e_type, steps, friction=0.2):
    """A hub round a hollow shaft, 0.0002 between them; the shaft is held at its lower end."""
    deck = Deck(title, "compare: HUB-LEFT y -0.401 0.401")
    deck.mesh("SHAFT", e_type, graded((0.4, 1.0, 8, 0.1)), beneath(contact_line(0.5, 12, 6), 1.0, 5), flat)
    deck.mesh("HUB", e_type, graded((1.0002, 1.6002, 7, 12.0)), contact_line(0.5, 12, 6), flat)
    deck.material("M", "SHAFT HUB")
    deck.pair("HUB-LEFT", "SHAFT-RIGHT", friction)
    deck.add("*BOUNDARY\nSHAFT-BOTTOM, 1, 2")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, *(("", "HUB-LEFT SHAFT-RIGHT") if k == 0 else ("", "")))
    return name, deck


def stack(name, title, e_type, steps):
    """Three rectangles one on the other; two pairs, each with a law of its own, the upper one 0.0002 open."""
    deck = Deck(title, "compare: MIDDLE-BOTTOM x -0.501 0.501", "compare: UPPER-BOTTOM x -0.391 0.391")
    side = contact_line(0.5, 12, 5)
    wider = beneath(side, 0.7, 3)
    deck.mesh("LOWER", e_type, beneath(wider, 1.0, 3), graded((-0.6, 0.0, 6, 0.1)), flat)
    deck.mesh("MIDDLE", e_type, wider, graded((0.0, 0.2, 4, 4.0), (0.2, 0.4, 4, 1/4)), flat)
    deck.mesh("UPPER", e_type, side, graded((0.4002, 0.8002, 6, 8.0)), flat)
    deck.material("HARD", "LOWER UPPER", 2000.0)
    deck.material("SOFT", "MIDDLE", 800.0, 0.35)
    deck.pair("MIDDLE-BOTTOM", "LOWER-TOP", 0.4, name="ROUGH")
    deck.pair("UPPER-BOTTOM", "MIDDLE-TOP", 0.15, name="SMOOTH")
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2\nMIDDLE-LEFT, 1")
    for k, (lines, increment, direct) in enumerate(steps):
        deck.step(lines, increment, direct, "LOWER-BOTTOM MIDDLE-LEFT" if k == 0 else "")
    return name, deck


def beam(name, title, e_type):
    """A cantilever above a round-topped support, 0.001 between them: a load closes the gap, then the support is moved along it.

    CalculiX leaves loads on held nodes out of their RF: none is loaded.
    """
    deck = Deck(title, "compare: BEAM-BOTTOM x 1.505 1.546")
    us = graded((-0.3, -0.03, 5, 0.2), (-0.03, 0.09, 20, 1.0), (0.09, 0.3, 4, 1/0.2))
    deck.mesh("SUPPORT", e_type, us, graded((-0.4, 0.0, 8, 0.05)),
              lambda u, v: (1.5 + u, v - (1 + v/0.4)*u*u/(20.0 + math.sqrt(400.0 - u*u))))
    us = graded((0.0, 1.4, 12, 0.15), (1.4, 1.47, 4, 0.3), (1.47, 1.59, 20, 1.0), (1.59, 2.0, 6, 15.0))
    deck.mesh("BEAM", e_type, us, graded((0.001, 0.401, 8, 12.0)), flat)
    deck.material("M", "SUPPORT BEAM", 1e6, thickness=0.01)
    deck.add(f"*ELSET, ELSET=LOADED, GENERATE\n{deck.elements - 28}, {deck.elements}, 1")
    deck.pair("BEAM-BOTTOM", "SUPPORT-TOP", 0.25, 1e9, 1e8)
    deck.add("*BOUNDARY\nSUPPORT-BOTTOM, 2\nBEAM-LEFT, 1, 2")
    deck.step("*BOUNDARY\nSUPPORT-BOTTOM, 1, 1, 0.\n*DLOAD\nLOADED, P3, 30.", 0.25, False, "SUPPORT-BOTTOM BEAM-LEFT")
    deck.step("*BOUNDARY\nSUPPORT-BOTTOM, 1, 1, -0.0001", 0.25, False)
    return name, deck


def thermal(name, title, e_type):
    """A rectangle that is pressed on a block and then heated."""
    deck = Deck(title, "compare: UPPER-BOTTOM x -0.401 0.401")
    us = graded((-1.0, -0.55, 6, 0.3), (-0.55, 0.55, 44, 1.0), (0.55, 1.0, 6, 1/0.3))
    deck.mesh("LOWER", e_type, us, graded((-1.0, 0.0, 12, 0.12)), flat)
    deck.mesh("UPPER", e_type, even(-0.5, 0.5, 40), graded((0.0, 0.5, 10, 6.0)), flat)
    deck.material("M", "LOWER UPPER", extra="\n*EXPANSION\n1e-5")
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", 0.3)
    deck.add("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nLOWER, 20.\nUPPER, 20.\n*BOUNDARY\nLOWER-BOTTOM, 1, 2")
    deck.step(top(0.0, -0.005), 0.25, False, "LOWER-BOTTOM")
    deck.step("*TEMPERATURE\nUPPER, 220.", 0.125, True)
    return name, deck


def loaded(name, title, e_type):
    """A rectangle that its weight and a pressure press on a block, then pushed and let back."""
    deck = Deck(title, "compare: UPPER-BOTTOM x -0.401 0.401")
    side = contact_line(0.5, 12, 5)
    deck.mesh("LOWER", e_type, beneath(side, 1.0, 5), graded((-1.0, 0.0, 8, 0.06)), flat)
    deck.mesh("UPPER", e_type, side, graded((0.0, 0.5, 6, 8.0)), flat)
    deck.material("M", "LOWER UPPER", extra="\n*DENSITY\n0.4")
    deck.pair("UPPER-BOTTOM", "LOWER-TOP", 0.3)
    deck.add("*BOUNDARY\nLOWER-BOTTOM, 1, 2\n*ELSET, ELSET=ALL\nLOWER, UPPER")
    deck.step(top(0.0) + "\n*DLOAD\nUPPER, GRAV, 9.81, 0., -1., 0.\n*DSLOAD\nUPPER-TOP, P, 8.", 0.25, False, "LOWER-BOTTOM")
    deck.step(top(0.012), 0.125, True)
    deck.step(top(0.002), 0.125, True)
    return name, deck


def scenes():
    """All decks, by name."""
    yield punch("punch-cpe4", "Rectangle on a block: pressed, pushed into partial slip, pushed back",
                "CPE4", (28, 8, 15), (28, 8, 13),
                steps=((top(0.0, -0.01), 0.25, False), (top(0.009), 0.125, True), (top(0.001), 0.125, True)))
    yield punch("slides-cps8", "Thin rectangle on a block: pressed, pushed until most of it slips, pushed back",
                "CPS8", (12, 5, 8), (12, 5, 7), thickness=0.01,
                friction=0.1, steps=((top(0.0, -0.01), 0.25, False), (top(0.004), 0.125, True), (top(0.0), 0.125, True)))
    yield punch("gap-cpe6", "Rectangle over a gap: pressed, pushed, lifted by half; triangles",
                "CPE6", (12, 5, 8), (14, 5, 7), gap=0.002,
                moduli=(1000.0, 500.0),
                steps=((top(0.0, -0.012), 0.25, False), (top(0.008), 0.125, False), (top(None, -0.008), 0.125, False)))
    yield cylinder("cylinder-cpe8", "Cylinder on a block: pressed, pushed into partial slip, pushed back",
                   "CPE8", ((15, 15), 5, 8),
                   steps=((top(0.0, -0.01), 0.25, False), (top(0.005), 0.125, True), (top(0.0005), 0.125, True)))
    yield cylinder("cylinder-cps6", "Thin cylinder on a stiffer block: pressed and pushed; triangles",
                   "CPS6", ((13, 13), 5, 7), reach=0.16,
                   thickness=0.01, window=0.09, moduli=(3000.0, 1000.0),
                   steps=((top(0.0, -0.005), 0.25, True), (top(0.0015), 0.125, True)))
    yield cylinder("cylinder-cpe4", "Cylinder over a gap: pressed, pushed until it slides",
                   "CPE4", ((26, 26), 7, 13), gap=0.001,
                   friction=0.2, steps=((top(0.0, -0.011), 0.25, False), (top(0.01), 0.125, True)))
    yield cylinder("sphere-cax8", "Sphere with a bore on a softer block: pressed, lifted by half",
                   "CAX8", ((16, 16), 5, 8), bore=0.05,
                   reach=0.25, moduli=(300.0, 1000.0), window=0.13,
                   steps=((top(0.0, -0.01), 0.25, True), (top(None, -0.005), 0.25, True)))
    yield cylinder("crown-cax6", "Crowned ring over a gap, without friction: touched, pressed; triangles",
                   "CAX6", ((14, 14), 5, 7), gap=0.001,
                   friction=0.0, centre=2.0, window=0.065,
                   steps=((top(0.0, -0.006), 0.25, False), (top(None, -0.011), 0.25, False)))
    yield cylinder("crown-cax4", "Crowned ring: pressed, expanded into partial slip, let back",
                   "CAX4", ((24, 24), 7, 12), centre=2.0,
                   reach=0.14, window=0.07, friction=0.4,
                   steps=((top(0.0, -0.0025), 0.25, True), (top(0.0015), 0.125, True), (top(0.0005), 0.125, True)))
    yield ring("ring-cax8", "Rings: pressed, the upper one expanded, let back by half", "CAX8", (12, 5, 8), (12, 5, 7),
               steps=((top(0.0, -0.01), 0.25, False), (top(0.006), 0.125, True), (top(0.003), 0.125, True)))
    yield incline("incline-cpe8", "Rectangle on an incline: pressed, pushed", "CPE8",
                  ((top(0.0, -0.01), 0.25, False), (top(0.002), 0.125, True)))
    moved = "*BOUNDARY\nPIN-TOP, 1, 1, {}\nPIN-TOP, 2, 2, {}".format
    yield pin("pin-cpe8", "Pin in a bore with clearance: pressed, pushed", "CPE8",
              ((moved(0.0, -0.01), 0.25, False), (moved(0.004, -0.01), 0.125, True)), 0.5)
    moved = "*BOUNDARY\nHUB-RIGHT, 1, 1, {}\nHUB-RIGHT, 2, 2, {}".format
    yield hub("hub-cax8", "Hub round a shaft with clearance: shrunk on it, pushed along it, pushed back", "CAX8",
              ((moved(-0.0016, 0.0), 0.25, True), (moved(-0.0016, 0.0006), 0.125, True), (moved(-0.0016, 0.0), 0.125, True)))
    yield stack("stack-cpe8r", "Three rectangles: pressed, the upper one pushed", "CPE8R",
                ((top(0.0, -0.0022), 0.25, True), (top(0.0004), 0.125, True)))
    yield beam("beam-cps8", "Cantilever over a support with a gap: loaded, the support moved", "CPS8")
    yield thermal("heated-cpe4", "Rectangle on a block: pressed, heated", "CPE4")
    yield loaded("loaded-cpe8", "Rectangle on a block under weight and pressure: pushed, let back", "CPE8")


def main(folder, names):
    """Writes the decks."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, deck in scenes():
        if not names or name in names:
            (folder/f"contact-{name}.inp").write_text("\n".join(deck.lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
