"""Runs a contact deck in atrito and in CalculiX, the same file, and compares forces and pressures at the end of each step.

    python3 compare_contact.py DECK --atrito PROGRAM [--ccx PROGRAM] [--stored FILE] [--folder FOLDER] [--keep FILE]

CalculiX is run where --ccx names a program (of the path) that is there; else its results are taken from the file --stored.
--keep writes such a file. Printed are the largest differences of each step; exit 0 when forces are within 1 % and pressures
within 3 %, 1 when not, 2 when one of the programs fails or a result is missing. Standard library alone.

Forces: the sums over the sets of *NODE PRINT with RF; of bodies of revolution, and where the deck has no such set, those of the
pair of *CONTACT PRINT with CF. A component is compared with itself, or with a tenth of the force where it is less.
The line `** compare: axial forces` leaves the radial one out (README.md).
Pressures: at the slave's nodes that a line `** compare: SURFACE AXIS FROM TO` of the deck covers, relative to themselves, or to a
fifth of the largest there.
"""
import argparse
import hashlib
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

FORCES = 0.01
PRESSURES = 0.03
FACES = {3: ((0, 1, 3), (1, 2, 4), (2, 0, 5)), 4: ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7))}


class Missing(Exception):
    """A result that should be there is not."""


def options(card):
    """Keyword and options of a keyword line, in capitals."""
    words = [word.strip().upper() for word in card.split(",")]
    pairs = [word.partition("=") for word in words[1:]]
    return words[0].replace(" ", ""), {name.strip(): value.strip() for name, _, value in pairs}


class Deck:
    """What of a deck the comparison needs."""

    def __init__(self, path):
        self.nodes, self.elements, self.sets, self.faces = {}, {}, {}, {}
        self.slaves, self.prints, self.windows, self.steps, self.revolved, self.contact_forces = [], [], [], 0, False, 0
        self.axial = False
        keyword, given = "", {}
        for line in path.read_text().splitlines():
            if line == "** compare: axial forces":
                self.axial = True
            elif line.startswith("** compare:"):
                surface, axis, low, high = line.split(":")[1].split()
                self.windows.append((surface.upper(), axis, float(low), float(high)))
            elif line.startswith("**"):
                continue
            elif line.startswith("*"):
                keyword, given = options(line)
                self.begin(keyword, given)
            else:
                self.data(keyword, given, [word.strip().upper() for word in line.split(",") if word.strip()])

    def begin(self, keyword, given):
        """A keyword line."""
        if keyword == "*STEP":
            self.steps += 1
        elif keyword == "*NODEPRINT" and "NSET" in given:
            self.prints.append(given["NSET"])
        elif keyword == "*ELEMENT" and given["TYPE"].startswith("CAX"):
            self.revolved = True
        elif keyword == "*CONTACTPRINT" and "SLAVE" in given:
            self.contact_forces += 1

    def data(self, keyword, given, words):
        """A data line."""
        if keyword == "*NODE":
            self.nodes[int(words[0])] = (float(words[1]), float(words[2]))
        elif keyword == "*ELEMENT":
            self.elements[int(words[0])] = [int(word) for word in words[1:]]
        elif keyword == "*NSET":
            self.sets.setdefault(given["NSET"], []).extend(int(word) for word in words)
        elif keyword == "*SURFACE":
            self.faces.setdefault(given["NAME"], []).append((int(words[0]), int(words[1][1]) - 1))
        elif keyword == "*CONTACTPAIR":
            self.slaves.append(words[0])

    def slave_nodes(self, surface):
        """Nodes of the faces of a surface."""
        found = set()
        for element, face in self.faces[surface]:
            nodes = self.elements[element]
            corners = 3 if len(nodes) in (3, 6) else 4
            found.update(nodes[k] for k in FACES[corners][face] if k < len(nodes))
        return sorted(found)

    def normals(self, surface):
        """The outward normal at each node of a surface: the mean of its faces'."""
        sums = {}
        for element, face in self.faces[surface]:
            nodes = self.elements[element]
            ends = [nodes[k] for k in FACES[3 if len(nodes) in (3, 6) else 4][face] if k < len(nodes)]
            (x0, y0), (x1, y1) = self.nodes[ends[0]], self.nodes[ends[1]]
            xm, ym = self.nodes[ends[2]] if len(ends) == 3 else ((x0 + x1)/2, (y0 + y1)/2)
            along = [(4*xm - 3*x0 - x1, 4*ym - 3*y0 - y1), (3*x1 + x0 - 4*xm, 3*y1 + y0 - 4*ym), (x1 - x0, y1 - y0)]
            for node, (dx, dy) in zip(ends, along):
                total = sums.setdefault(node, [0.0, 0.0])
                sums[node] = [total[0] + dy, total[1] - dx]
        return {node: (x/math.hypot(x, y), y/math.hypot(x, y)) for node, (x, y) in sums.items()}

    def compared(self, surface):
        """Nodes of a slave whose pressures are compared: those in all of its windows."""
        windows = [window for window in self.windows if window[0] == surface]
        return [node for node in self.slave_nodes(surface)
                if all(low <= self.nodes[node]["xy".index(axis)] <= high for _, axis, low, high in windows)]


# --- CalculiX ---------------------------------------------------------------------------------------------------------------

def dat_forces(text):
    """[(fx, fy)] a printing of RF, one after the other."""
    sums, inside = [], False
    for line in text.splitlines():
        words = line.split()
        if "forces (fx,fy,fz)" in line:
            sums.append([0.0, 0.0])
            inside = True
        elif inside and len(words) == 4 and words[0].isdigit():
            sums[-1] = [sums[-1][k] + float(words[k + 1]) for k in (0, 1)]
        elif words:
            inside = False
    return sums


def dat_contact_forces(text, scale):
    """The forces of the contact, one printing after the other."""
    lines = text.splitlines()
    heads = [k for k, line in enumerate(lines) if "total surface force" in line]
    return [[scale*float(word) for word in lines[k + 2].split()[:2]] for k in heads]


def frd_pressures(text):
    """Pressure by node of each CONTACT block of a .frd file."""
    blocks, inside = [], False
    for line in text.splitlines():
        if line.startswith(" -4"):
            inside = "CONTACT" in line
            if inside:
                blocks.append({})
        elif line.startswith(" -3"):
            inside = False
        elif inside and line.startswith(" -1"):
            blocks[-1][int(line[3:13])] = float(line[49:61])
    return blocks


def run_ccx(path, folder, program):
    """Runs a copy of the deck, peer.inp."""
    shutil.copy(path, folder/"peer.inp")
    done = subprocess.run([program, "peer"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode or not (folder/"peer.frd").exists():
        raise Missing(f"CalculiX, exit {done.returncode}: {done.stdout[-300:]}")


def read_ccx(deck, folder):
    """(force, pressure): by (step, name) and (step, node)."""
    text = (folder/"peer.dat").read_text()
    if use_pairs(deck):
        # A body of revolution is a wedge of 2 degrees there.
        names = [f"pair-{k + 1}" for k in range(deck.contact_forces)]
        rows = dat_contact_forces(text, 180.0 if deck.revolved else 1.0)
    else:
        names, rows = deck.prints, dat_forces(text)
    fields = frd_pressures((folder/"peer.frd").read_text())
    if len(rows) != deck.steps*len(names) or len(fields) != deck.steps:
        raise Missing(f"CalculiX: {len(rows)} forces and {len(fields)} fields in {deck.steps} steps")
    force = {(k//len(names) + 1, names[k % len(names)]): row for k, row in enumerate(rows)}
    pressure = {(step, node): field.get(node, 0.0) for step, field in enumerate(fields, 1)
                for slave in deck.slaves for node in deck.slave_nodes(slave)}
    return force, pressure


def use_pairs(deck):
    """Whether forces are those of pairs: the reactions of bodies of revolution lack in CalculiX what the hoop stress gives."""
    return deck.revolved or not deck.prints


def digest(text):
    """A number of what a deck says, without its comments and its title."""
    said = hashlib.sha256()
    title = False
    for line in text.splitlines():
        title = line.startswith("*HEADING") or (title and not line.startswith("*"))
        if not title and not line.startswith("**"):
            said.update(line.encode() + b"\n")
    return said.hexdigest()[:16]


def keep(path, deck_path, force, pressure):
    """Writes what CalculiX found."""
    lines = [f"deck {digest(deck_path.read_text())}"]
    lines += [f"force {step} {name} {x:.6e} {y:.6e}" for (step, name), (x, y) in force.items()]
    lines += [f"pressure {step} {node} {value:.5e}" for (step, node), value in pressure.items()]
    path.write_text("\n".join(lines) + "\n")


def stored(path, deck_path):
    """Reads what `keep` wrote, for the same deck."""
    force, pressure = {}, {}
    lines = path.read_text().splitlines()
    if lines[:1] != [f"deck {digest(deck_path.read_text())}"]:
        raise Missing(f"{path.name} is of another deck")
    for words in (line.split() for line in lines[1:]):
        if words[0] == "force":
            force[int(words[1]), words[2]] = [float(words[3]), float(words[4])]
        elif words[0] == "pressure":
            pressure[int(words[1]), int(words[2])] = float(words[3])
    return force, pressure


# --- atrito -----------------------------------------------------------------------------------------------------------------

def table(path):
    """Rows of a table as dictionaries."""
    names, rows = [], []
    for line in path.read_text().splitlines():
        if line.startswith("# columns:"):
            names = line.split()[2:]
        elif line.startswith("#"):
            if "NOT CONVERGED" in line:
                raise Missing(f"{path.name}: not converged")
        else:
            rows.append(dict(zip(names, line.split())))
    return rows


def last_increments(rows):
    """The rows of the last increment of each step."""
    last = {}
    for row in rows:
        last[row["step"]] = max(last.get(row["step"], 0), int(row.get("increment", 0)))
    return [row for row in rows if int(row.get("increment", 0)) == last[row["step"]]]


def run_atrito(deck, path, folder, program):
    """(force, pressure) as those of CalculiX."""
    command = [program, str(path), "-o", str(folder/"tables"), "--quiet", "--digits", "12"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Missing(f"atrito, exit {done.returncode}: {done.stderr[:1500]}")
    force, pressure = {}, {}
    slaves = [(slave, deck.normals(slave)) for slave in deck.slaves]
    places = [{tuple(round(x, 6) for x in deck.nodes[node]): node for node in normals} for _, normals in slaves]
    for row in last_increments(table(folder/"tables"/"contact.tab")):
        step, k = int(row["step"]), int(row["pair"]) - 1
        node = places[k].get((round(float(row["x"]), 6), round(float(row["y"]), 6)))
        if node is None:
            # A face that lies over the end of the master has its points in what is covered of it.
            if float(row["pressure"]) != 0.0:
                raise Missing(f"no node of {slaves[k][0]} at ({row['x']}, {row['y']})")
            continue
        pressure[step, node] = float(row["pressure"])
        if use_pairs(deck):
            nx, ny = slaves[k][1][node]
            normal, shear = -float(row["pressure"])*float(row["weight"]), float(row["shear"])*float(row["weight"])
            add_force(force, (step, f"pair-{k + 1}"), normal*nx - shear*ny, normal*ny + shear*nx)
    if not use_pairs(deck):
        for row in last_increments(table(folder/"tables"/"reactions.tab")):
            for name in deck.prints:
                if int(row["node"]) in deck.sets[name]:
                    add_force(force, (int(row["step"]), name), float(row["r1"]), float(row["r2"]))
    return force, pressure


def add_force(force, key, x, y):
    """One more share of a force."""
    total = force.get(key, [0.0, 0.0])
    force[key] = [total[0] + x, total[1] + y]


# --- comparison -------------------------------------------------------------------------------------------------------------

def compare(deck, ours, theirs, say):
    """The largest differences of forces and of pressures; a line a step."""
    most_force = most_pressure = 0.0
    for step in range(1, deck.steps + 1):
        worst_force = 0.0
        if not any(k == step for k, _ in theirs[0]):
            raise Missing(f"step {step}: no forces of CalculiX")
        for (k, name), (x, y) in theirs[0].items():
            if k != step:
                continue
            if (k, name) not in ours[0]:
                raise Missing(f"step {step}: no force of {name}")
            size = math.hypot(x, y)
            for axis, mine, other in zip("xy", ours[0][k, name], (x, y)):
                if size > 0.0 and not (deck.axial and axis == "x"):
                    worst_force = max(worst_force, abs(mine - other)/max(abs(other), size/10))
        worst, count, where = 0.0, 0, 0
        for slave in deck.slaves:
            nodes = deck.compared(slave)
            if any((step, node) not in theirs[1] for node in nodes):
                raise Missing(f"step {step}: no pressures of CalculiX on {slave}")
            largest = max((theirs[1][step, node] for node in nodes), default=0.0)
            for node in nodes:
                if (step, node) not in ours[1]:
                    raise Missing(f"step {step}: no pressure at node {node}")
                other = theirs[1][step, node]
                if largest > 0.0:
                    off = abs(ours[1][step, node] - other)/max(other, largest/5)
                    count += 1
                    if off > worst:
                        worst, where = off, node
        if not count:
            raise Missing(f"step {step}: no pressures are compared")
        place = f" at ({deck.nodes[where][0]:.4g}, {deck.nodes[where][1]:.4g})" if where else ""
        say(f"   step {step}: forces {100*worst_force:.3f} %, {count} pressures {100*worst:.3f} %{place}")
        most_force, most_pressure = max(most_force, worst_force), max(most_pressure, worst)
    return most_force, most_pressure


def main():
    """One deck."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--atrito", required=True)
    parser.add_argument("--ccx", default="")
    parser.add_argument("--stored", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true", help="the last line alone")
    given = parser.parse_args()
    deck = Deck(given.deck)
    with tempfile.TemporaryDirectory() as scratch:
        folder = given.folder or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            if given.ccx and shutil.which(given.ccx):
                run_ccx(given.deck, folder, shutil.which(given.ccx))
                theirs, source = read_ccx(deck, folder), "run beside"
                if given.keep:
                    keep(given.keep, given.deck, *theirs)
            elif given.stored and given.stored.exists():
                theirs, source = stored(given.stored, given.deck), "stored"
            else:
                raise Missing("neither CalculiX nor stored results")
            ours = run_atrito(deck, given.deck, folder, given.atrito)
            force, pressure = compare(deck, ours, theirs, (lambda line: None) if given.quiet else print)
        except Missing as missing:
            print(f"{given.deck.stem}: {missing}")
            return 2
    good = force <= FORCES and pressure <= PRESSURES
    verdict = "agreed" if good else "DIFFERS"
    print(f"{given.deck.stem}: {verdict}, forces {100*force:.3f} %, pressures {100*pressure:.3f} % (CalculiX {source})")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
