"""Ten problems of the book by CalculiX beside: the same meshes, error and time on three of them, and what had to be chosen by hand.

The decks are made by tests/peers/contact/make_decks.py, the results read by tests/peers/results.py."""
import math
import re
import sys
from pathlib import Path

sys.path += [str(Path(__file__).resolve().parent.parent/"peers"), str(Path(__file__).resolve().parent.parent/"peers"/"contact")]
import results                                 # pylint: disable=wrong-import-position
from make_decks import Deck, even, flat        # pylint: disable=wrong-import-position

from cases import BookError, find_summary      # pylint: disable=wrong-import-position
from pages import MADE, ROUND_OFF, table                  # pylint: disable=wrong-import-position

LEVELS = (0, 1, 2)
TIME = 600                                     # seconds of the clock for a run of CalculiX
STICK = 0.1                                    # stick slope of CalculiX over the slope of its contact


class Problem:
    """What a problem is for either program, on one mesh."""

    def __init__(self, program, level):
        self.deck = Deck("made by tests/book/calculix.py")
        self.ours = program == "atrito"
        self.fine = 2**level
        self.observe = ""                      # atrito: an expression
        self.read = None                       # CalculiX: a function of this and of what it wrote

    def contact(self, slave, master, modulus, face, friction=0.0, clearance=None, straight=True, stiffness=1000):
        """Hard contact here; there a slope, stiffness times E over the length of a face, and with friction another one while it sticks."""
        if self.ours:
            law = "*SURFACE INTERACTION, NAME=JOINT" + (f"\n*FRICTION\n{friction:g}" if friction else "")
            self.deck.add(f"{law}\n*CONTACT PAIR, INTERACTION=JOINT\n{slave}, {master}")
        else:
            slope = stiffness*modulus/face
            self.deck.pair(slave, master, friction, slope, STICK*slope, name="JOINT")
        if clearance is not None and (self.ours or clearance != 0 and straight):
            self.deck.add(f"*CLEARANCE, SLAVE={slave}, MASTER={master}, VALUE={clearance:.12g}")

    def ends(self, lines, increment=None, forces=""):
        """The last step with its loads; of CalculiX all displacements are wanted, and the force of a set of supports."""
        self.deck.add(f"*STEP\n*STATIC{'' if increment is None else chr(10) + increment}\n{lines}")
        if not self.ours:
            self.deck.add("*NODE FILE, FREQUENCY=1000" + (", OUTPUT=3D" if "CAX" in self.deck.e_type else "") + "\nU")
            if "*CONTACT PAIR" in self.text():
                self.deck.add("*CONTACT FILE, FREQUENCY=1000\nCSTR")
            if forces:
                self.deck.add(f"*NODE PRINT, NSET={forces}, FREQUENCY=1000, TOTALS=ONLY\nRF")
        self.deck.add("*END STEP")

    def text(self):
        return "\n".join(self.deck.lines) + "\n"

    def wants(self, component, body, x, y, sign=1.0):
        """The displacement of a node of a body along axis 1 or 2."""
        self.observe = f"{sign:g}*u{component}({x:.12g}, {y:.12g}, {body})"
        self.read = lambda found: sign*found.displacement(component, body, x, y)


class Found:
    """What CalculiX wrote."""

    def __init__(self, problem, moved, folder):
        self.moved, self.folder = moved, folder
        self.places, body = {}, None           # by body
        for line in problem.deck.lines:
            if line.startswith("*"):
                body = line[12:] if line.startswith("*NODE, NSET=") else None
            elif body:
                number, x, y = line.split(",")
                self.places.setdefault(body, {})[int(number)] = float(x), float(y)

    def displacement(self, component, body, x, y):
        nodes = self.places[body]
        node = min(nodes, key=lambda k: math.hypot(nodes[k][0] - x, nodes[k][1] - y))
        return self.moved[-1][node][component - 1]

    def force(self, component):
        """Of the supports that were asked for, at the end."""
        return float((self.folder/"theirs.dat").read_text().split()[component - 4])

    def largest_pressure(self):
        most, inside = 0.0, False
        for line in (self.folder/"theirs.frd").read_text().splitlines():
            if line.startswith(" -4"):
                inside = "CONTACT" in line
            elif inside and line.startswith(" -1"):
                most = max(most, float(line[49:61]))
        return most


def polar(u, v):
    return u*math.cos(v), u*math.sin(v)


def rings(p, e_type, radii, counts, moduli, poisson, load, clearance=0.0):
    """Two rings, a quarter, or two shells; the load is words about LOADED, the outer or inner side."""
    r0, r1, r2 = radii
    overlap = 0.0 if p.ours else clearance     # CalculiX: drawn, since *CLEARANCE between curved faces of unlike meshes is far off
    for name, low, high, across in (("INNER", r0, r1, counts[0]), ("OUTER", r1 + overlap, r2, counts[1])):
        p.deck.mesh(name, e_type, even(low, high, 2*p.fine), even(0.0, math.pi/2, across*p.fine), polar)
    p.deck.material("M", "INNER OUTER", moduli, poisson)
    p.contact("INNER-RIGHT", "OUTER-LEFT", moduli, r1*math.pi/2/counts[1]/p.fine, clearance=clearance, straight=False)
    p.deck.add("*BOUNDARY\nINNER-BOTTOM, 2\nOUTER-BOTTOM, 2\nINNER-TOP, 1\nOUTER-TOP, 1")
    p.ends(load)


def ca1(p):
    rings(p, "CPE8", (0.2, 0.6, 1.0), (3, 4), 1e9, 0.2, "*DSLOAD\nOUTER-RIGHT, P, 1e6")
    p.wants(1, "OUTER", 1.0, 0.0)


def ca2(p):
    load = "*DSLOAD, FUNCTION\nOUTER-RIGHT, P, 1e7 + 1e5*(x**2 - y**2)/(x**2 + y**2)"
    if not p.ours:                             # a pressure a face: that in its middle
        n = 4*p.fine
        first = 2*p.fine*3*p.fine
        load = "*DLOAD\n" + "\n".join(f"{first + 2*p.fine*(k + 1)}, P2, {1e7 + 1e5*math.cos(2*(k + 0.5)*math.pi/2/n):.12g}" for k in range(n))
    rings(p, "CPE8", (0.2, 0.6, 1.0), (3, 4), 1e9, 0.2, load)
    p.wants(1, "INNER", 0.6, 0.0)


def ca3(p):
    rings(p, "CAX8", (20.0, 30.0, 40.0), (4, 3), 2000.0, 0.3, "*DSLOAD\nINNER-LEFT, P, 25.")
    p.wants(1, "INNER", 20.0, 0.0)


def f6(p):
    rings(p, "CAX8", (20.0, 30.0, 40.0), (4, 3), 210e3, 0.3, "", clearance=-0.01)
    p.wants(1, "OUTER", 40.0, 0.0)


def f1(p):
    for name, low, high in (("SHAFT", 0.0, 50.0), ("HUB", 50.0, 100.0)):
        p.deck.mesh(name, "CAX8", even(low, high, 4*p.fine), even(0.0, 10.0, p.fine), flat)
    p.deck.material("STEEL", "SHAFT", 210e3, 0.3)
    p.deck.material("ALUMINIUM", "HUB", 70e3, 0.33)
    p.contact("SHAFT-RIGHT", "HUB-LEFT", 70e3, 10.0/p.fine, clearance=-0.05)
    p.deck.add("*BOUNDARY\nSHAFT-BOTTOM, 2\nHUB-BOTTOM, 2\nSHAFT-TOP, 2\nHUB-TOP, 2")
    p.ends("")
    p.wants(1, "HUB", 50.0, 0.0)


def v1(p):
    p.deck.mesh("CYLINDER", "CAX8", even(4.0, 8.0, 2*p.fine), even(0.0, 1.0, p.fine), flat)
    p.deck.material("M", "CYLINDER", 3e7, 0.3)
    p.deck.add("*BOUNDARY\nCYLINDER-BOTTOM, 2")
    p.ends("*DSLOAD\nCYLINDER-LEFT, P, 30000.")
    p.wants(1, "CYLINDER", 4.0, 0.0)


def m1(p):
    for name, low in (("LOWER", 0.0), ("UPPER", 0.5)):
        p.deck.mesh(name, "CPE8", even(0.0, 1.0, p.fine), even(low, low + 0.5, p.fine), flat)
    p.deck.material("M", "LOWER UPPER", 1e6, 0.3)
    p.contact("UPPER-BOTTOM", "LOWER-TOP", 1e6, 1.0/p.fine, 0.2)
    p.deck.add("*BOUNDARY\nLOWER-BOTTOM, 2\nLOWER-LEFT, 1\nUPPER-LEFT, 1")
    p.ends("*DSLOAD\nUPPER-TOP, P, 109.89")
    p.wants(2, "UPPER", 1.0, 1.0)


def rigid(p, left, right, top, across):
    """A rigid straight line: drawn here, there a row of elements that are held."""
    if p.ours:
        p.deck.add(f"*SURFACE, NAME=BED-TOP, TYPE=SEGMENTS\nSTART, {left:g}, {top:g}\nLINE, {right:g}, {top:g}\n*RIGID BODY, ANALYTICAL SURFACE=BED-TOP")
    else:
        p.deck.mesh("BED", p.deck.e_type, even(left, right, across), even(top - (right - left)/across, top, 1), flat)
        p.deck.add("*BOUNDARY\nBED, 1, 2")


def be1(p):
    p.deck.mesh("BEAM", "CPS8", even(0.0, 2.0, 20*p.fine), even(-0.05, 0.05, p.fine), flat)
    elements = p.deck.elements
    rigid(p, 1.5, 2.5, -0.06, 5)
    p.deck.material("M", "BEAM" if p.ours else "BEAM BED", 1e6, 0.0)
    p.contact("BEAM-BOTTOM", "BED-TOP", 1e6, 0.1/p.fine)
    p.deck.add(f"*BOUNDARY\nBEAM-LEFT, 2\nBEAM-RIGHT, 1\n*ELSET, ELSET=TOPS, GENERATE\n{elements - 20*p.fine + 1}, {elements}")
    p.ends("*DLOAD\nTOPS, P3, 1.", "0.25, 1.", "BEAM-LEFT")
    p.observe = "2*normal_resultant"
    p.read = lambda found: 2*(2.0 - found.force(2) - 0.1/p.fine/6)   # it leaves out what the load puts on the held corner


def b2(p):
    p.deck.mesh("BAR", "CPS8", even(0.0, 6.0, 30*p.fine), even(0.0, 0.1, p.fine), flat)
    elements = p.deck.elements
    rigid(p, -1.0, 7.0, 0.0, 40)
    p.deck.material("M", "BAR" if p.ours else "BAR BED", 1e5, 0.0)
    p.contact("BAR-BOTTOM", "BED-TOP", 1e5, 0.1/p.fine, 0.5, stiffness=50)
    p.deck.add(f"*ELSET, ELSET=TOPS, GENERATE\n{elements - 30*p.fine + 1}, {elements}\n*ELSET, ELSET=ENDS, GENERATE\n{30*p.fine}, {elements}, {30*p.fine}")
    if not p.ours:
        p.deck.add("*BOUNDARY\nBAR-LEFT, 1")   # nothing reaches it; without it the first increment is singular
    p.deck.add("*STEP\n*STATIC\n*DLOAD\nTOPS, P3, 1.\n*END STEP")
    p.ends("*DLOAD\nENDS, P2, -20.", "0.25, 1.")
    p.wants(1, "BAR", 6.0, 0.05)


def j6(p):
    rise = 1e-3
    lift = lambda u, v: (u, v + (1 - v/1.5)*(0.0 if p.ours else rise*(1 - math.cos(2*math.pi*u))))
    p.deck.mesh("BODY", "CPE8", even(0.0, 0.5, 16*p.fine), [1.5*(k/(8*p.fine))**2 for k in range(8*p.fine + 1)], lift)
    rigid(p, -0.1, 0.6, 0.0, 4)
    p.deck.material("M", "BODY" if p.ours else "BODY BED", 1e5, 0.3)
    p.contact("BODY-BOTTOM", "BED-TOP", 1e5, 0.5/16/p.fine, stiffness=100)
    if p.ours:
        p.deck.add(f"*CLEARANCE, SLAVE=BODY-BOTTOM, MASTER=BED-TOP, FUNCTION\n{rise}*(1 - cos(2*pi*x))")
    p.deck.add("*BOUNDARY\nBODY-LEFT, 1\nBODY-RIGHT, 1")
    p.ends("*DSLOAD\nBODY-TOP, P, 86.30749048", "0.25, 1.")
    p.observe = "max_pressure"
    p.read = lambda found: found.largest_pressure()


def by_atrito(program, problem, folder):
    """What is found, and seconds of the processor."""
    before = results.spent()
    (folder/"ours.inp").write_text(problem.text())
    code, _, said = results.run([program, "ours.inp", "-o", "ours", "--quiet", "--digits", "12", "--observe", f"book={problem.observe}"], folder)
    if code:
        raise BookError(said)
    return find_summary(folder/"ours", "book"), results.spent() - before


def by_calculix(program, problem, folder):
    """The same; of bodies of revolution displacements are read from the solid that it makes of them."""
    before = results.spent()
    elements = {}
    if problem.deck.e_type.startswith("CAX"):
        inside = False
        for line in problem.deck.lines:
            if line.startswith("*"):
                inside = line.startswith("*ELEMENT")
            elif inside:
                number, *nodes = map(int, line.split(","))
                elements[number] = nodes
    moved = results.ccx(program, folder, "theirs", problem.text(), elements, limit=TIME)
    return problem.read(Found(problem, moved, folder)), results.spent() - before


def compare(atrito, ccx, work, tell=print):
    """Rows (problem, [(error, seconds) of atrito on each mesh], [the same of CalculiX])."""
    rows = []
    for problem_row in PROBLEMS:
        name, _, make, reference, *_ = problem_row
        found = {"atrito": [], "ccx": []}
        for level in LEVELS:
            folder = work/f"calculix-{name}-{level}"
            folder.mkdir(parents=True, exist_ok=True)
            for program in found:
                problem = Problem(program, level)
                make(problem)
                try:
                    number, seconds = by_atrito(atrito, problem, folder) if program == "atrito" else by_calculix(ccx, problem, folder)
                except results.Failed as failure:
                    tell(f"{name:4} {program:7} refine {level}: {failure}")
                    continue
                found[program].append((abs(number/reference - 1), seconds))
                tell(f"{name:4} {program:7} refine {level}: {number:.8g}, error {found[program][-1][0]:.1e}, {seconds:.2f} s")
        rows.append((problem_row, found["atrito"], found["ccx"]))
    return rows


def padded(cells):
    """Meshes on which CalculiX does not end in time have no number."""
    cells = list(cells)
    return cells + ["not ended"]*(len(LEVELS) - len(cells))


def page(rows, version):
    """docs/verification/book/calculix.md."""
    lines = ["# The book beside CalculiX", "", MADE.replace("--write", "--calculix ccx"), "",
             f"Ten of the problems by both programs on the same three meshes, each twice as fine as the one before; {version}. Errors are those of the",
             "named quantity against the reference of the book. Seconds are processor time, one thread, with reading and writing.", "",
             "![Error over run time](calculix.svg)", "",
             "*By hand* lists what had to be chosen. Contact is hard in atrito. CalculiX has a slope of pressure over penetration, the given number times E",
             "over the length of a face, and with friction a stick slope of a tenth of that. Smaller slopes are less exact (CA1 with 50: 8e-4 on the finest mesh),",
             "larger ones converge less well, or oscillate (J6 with 1000: the largest pressure is 76 % off on the coarsest mesh). The table has the",
             "best of a few tries.", "",
             "Where curved sides have different nodes, chords and parabolas leave gaps that are not part of the problem. In atrito `*CLEARANCE`",
             "sets the gap to 0, or to the overlap. With that card the answers of CalculiX are far worse, so its gap, or its overlap, is that of the",
             "mesh. In B2 the error is that of the one-dimensional reference, and in BE1 that of beam theory.", ""]
    meshes = range(1, len(LEVELS) + 1)
    head = ["problem", "quantity", *(f"error, mesh {k}" for k in meshes), *(f"seconds, mesh {k}" for k in meshes), "by hand"]
    cells = []
    for (name, title, _, _, *by_hand), *found in rows:
        for k, program in enumerate(("atrito", "CalculiX")):
            errors = ["round-off" if e < ROUND_OFF else f"{e:.1e}" for e, _ in found[k]]
            cells.append([f"[{name}]({name}.md) {program}", title if k == 0 else "", *padded(errors), *padded(f"{t:.2f}" for _, t in found[k]), by_hand[k]])
    lines += table(head, cells)
    ours, theirs = (sum(t for row in rows for _, t in row[k]) for k in (1, 2))
    return "\n".join(lines + ["", f"All thirty runs: {ours:.1f} s by atrito, {theirs:.1f} s by CalculiX."]) + "\n"


def picture(rows):
    """Error over run time, both logarithmic; a line a problem and program."""
    points = [(t, max(e, ROUND_OFF)) for row in rows for side in row[1:] for e, t in side]
    low = [math.floor(math.log10(min(p[k] for p in points))) for k in (0, 1)]
    high = [math.ceil(math.log10(max(p[k] for p in points))) for k in (0, 1)]
    wide, tall, left, top = 560, 360, 60, 34

    def place(t, e):
        x, y = math.log10(t) - low[0], high[1] - math.log10(max(e, ROUND_OFF))
        return left + wide*x/(high[0] - low[0]), top + tall*y/(high[1] - low[1])
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + wide + 20}" height="{top + tall + 46}"',
             'font-family="sans-serif" font-size="12">',
             '<rect width="100%" height="100%" fill="white"/>']
    for k in range(low[0], high[0] + 1):
        x = place(10.0**k, 1)[0]
        lines.append(f'<path stroke="#ddd" d="M{x:.1f},{top}v{tall}"/>')
        lines.append(f'<text x="{x:.1f}" y="{top + tall + 16}" text-anchor="middle">{10.0**k:g}</text>')
    for k in range(low[1], high[1] + 1):
        y = place(1, 10.0**k)[1]
        lines.append(f'<path stroke="#ddd" d="M{left},{y:.1f}h{wide}"/>')
        lines.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">1e{k}</text>')
    for side, colour, name in ((1, "#0072b2", "atrito"), (2, "#d55e00", "CalculiX")):
        lines.append(f'<text x="{left + 90*(side - 1)}" y="20" fill="{colour}" font-weight="bold">{name}</text>')
        for row in rows:
            way = [place(t, e) for e, t in row[side]]
            lines.append(f'<path fill="none" stroke="{colour}" d="M' + "L".join(f"{x:.1f},{y:.1f}" for x, y in way) + '"/>')
            lines += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{colour}"/>' for x, y in way]
            lines.append(f'<text x="{way[-1][0] + 4:.1f}" y="{way[-1][1] - 3:.1f}" font-size="9" fill="{colour}">{row[0][0]}</text>')
    lines.append(f'<text x="{left + wide/2}" y="{top + tall + 36}" text-anchor="middle">seconds of the processor</text>')
    lines.append(f'<text x="{left + 200}" y="20">relative error of the quantity</text>')
    return "\n".join(lines) + "\n</svg>\n"


def write(atrito, ccx, work, pages):
    """The page and its picture."""
    rows = compare(atrito, ccx, work)
    _, said, _ = results.run([ccx, "-v"], work)
    version = re.search(r"[Vv]ersion\s+([\w.]+)", said)
    (pages/"book"/"calculix.md").write_text(page(rows, f"CalculiX {version[1] if version else ''}".strip()))
    (pages/"book"/"calculix.svg").write_text(picture(rows))


# number, quantity, how it is made, reference, what is chosen by hand here and there
PROBLEMS = (
    ("CA1", "two rings under pressure: u_r outside", ca1, -8e-4, "gap 0", "slope 1000"),
    ("CA2", "two rings, pressure with cos 2 theta: u_r where they touch", ca2, -0.005517366819, "gap 0", "slope 1000; the pressure of each face"),
    ("CA3", "two spherical shells: u_r inside", ca3, 0.2, "gap 0", "slope 1000"),
    ("F1", "press fit, plane strain: u_r of the bore", f1, 0.04586789994, "", "slope 1000"),
    ("F6", "spherical shells with an overlap: u_r outside", f6, 0.00452380952335, "", "slope 1000; the overlap drawn"),
    ("V1", "thick cylinder under pressure, no contact: u_r inside", v1, 0.007866666667, "", ""),
    ("M1", "two blocks pressed, friction 0.2: u_y at the top", m1, -9.99999e-05, "", "slope 1000, stick slope"),
    ("BE1", "beam with a stop: reaction of the stop", be1, 1.875187219, "", "slope 1000; elements as the stop; four increments"),
    ("B2", "bar pulled on a bed of friction: u_x of its end", b2, 4e-4, "",
     "slope 50, stick slope; elements as the bed; a support; four increments"),
    ("J6", "wavy surface on a rigid flat: largest pressure", j6, 345.2299619, "", "slope 100; elements as the flat; four increments"),
)
