"""Runs of the two programs, and their displacements at the end of each step by node."""
import math
import os
import re
import resource
import subprocess


class Failed(Exception):
    """A program gave no result; the text says why."""


def spent():
    """Seconds of processor time of all programs run so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command, folder, limit=120):
    """(exit code, standard output, standard error); one thread."""
    quiet = {**os.environ, "OMP_NUM_THREADS": "1", "CCX_NPROC_STIFFNESS": "1", "LC_ALL": "C"}
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace", timeout=limit, env=quiet, check=False)
    except subprocess.TimeoutExpired:
        return 99, "", f"not ended after {limit} s"
    return done.returncode, done.stdout, done.stderr


def ccx(program, folder, name, text, elements=None, *, ties_in_part=False, limit=120):
    """Displacements that CalculiX finds: a dictionary node -> (u1, u2) a step; of bodies of revolution their elements are wanted.

    Of a *TIE it may leave out nodes, which is a failure where it is not known of the deck (ties_in_part)."""
    (folder/f"{name}.inp").write_text(text)
    result = folder/f"{name}.frd"
    result.unlink(missing_ok=True)
    code, said, _ = run([program, name], folder, limit)
    errors = [line.strip() for line in said.splitlines() if "*ERROR" in line]
    if code or errors or not result.exists():
        raise Failed(errors[0] if errors else f"exit {code}")
    if "no tied constraint is generated" in said and not ties_in_part:
        raise Failed("it does not tie bodies of revolution (*WARNING in gentiedmpc: no tied constraint is generated)")
    found = frd(result.read_text())
    return wedge(found, elements) if elements else [{node: moved[:2] for node, moved in step.items()} for step in found.steps]


class frd:
    """Nodes, elements and the blocks DISP of a .frd file."""

    def __init__(self, text):
        self.nodes, self.elements, self.steps = {}, {}, []
        into, last = None, []
        for line in text.splitlines():
            mark = line[:5]
            if mark == "    2":
                into = self.nodes
            elif mark == "    3":
                into = self.elements
            elif mark.startswith(" -4"):
                into = {} if line[5:].startswith("DISP") else None
                if into is not None:
                    self.steps.append(into)
            elif mark.startswith(" -3"):
                into = None
            elif into is self.elements:
                if mark.startswith(" -1"):
                    last = self.elements[int(line[3:13])] = []
                else:
                    last += [int(line[k:k + 10]) for k in range(3, len(line.rstrip()), 10)]
            elif into is not None and mark.startswith(" -1"):
                into[int(line[3:13])] = tuple(float(line[k:k + 12]) for k in (13, 25, 37))


def wedge(found, elements):
    """Displacements of bodies of revolution, which CalculiX makes a wedge of 2 degrees: those of one of its sides, turned back into the
    plane. Its own for the plane are means of those of the sides, whose directions differ: at the middle of an edge cos(1 degree) times
    the radial one."""
    side = {}
    for number, nodes in elements.items():
        corners = len(nodes)//2 if len(nodes) > 4 else len(nodes)
        solid = found.elements[number]
        for k, node in enumerate(nodes):
            side[node] = solid[k if k < corners else k + corners]
    return [{node: turned_back(found.nodes[at], step[at]) for node, at in side.items()} for step in found.steps]


def turned_back(place, moved):
    """Radial and axial displacement."""
    radius = math.hypot(place[0], place[2])
    if radius == 0.0:
        return 0.0, moved[1]
    return (moved[0]*place[0] + moved[2]*place[2])/radius, moved[1]


def atrito(program, folder, name, text):
    """Displacements that atrito finds, and the places of the nodes: two dictionaries by node a step."""
    (folder/f"{name}.inp").write_text(text)
    code, _, said = run([program, f"{name}.inp", "-o", name, "--quiet", "--digits", "12"], folder)
    if code:
        raise Failed(first_error(said) or f"exit {code}")
    return nodes_table((folder/name/"nodes.tab").read_text())


def greatest_pressures(folder, ours, theirs):
    """The greatest contact pressures of the last step, of atrito and of CalculiX."""
    rows, names = [], []
    for line in (folder/ours/"contact.tab").read_text().splitlines():
        if line.startswith("# columns:"):
            names = line.split()[2:]
        elif not line.startswith("#"):
            rows.append(dict(zip(names, line.split())))
    mine = max(float(row["pressure"]) for row in rows if row["step"] == rows[-1]["step"])
    other, inside = 0.0, False
    for line in (folder/f"{theirs}.frd").read_text().splitlines():
        if line.startswith(" -4"):
            inside = "CONTACT" in line
            other = 0.0 if inside else other
        elif inside and line.startswith(" -1"):
            other = max(other, float(line[49:61]))
    return mine, other


def nodes_table(text):
    """Displacements and places of the last increment of each step of nodes.tab."""
    names, moved, places = [], {}, {}
    for line in text.splitlines():
        if line.startswith("# columns:"):
            names = line.split()[2:]
        elif not line.startswith("#"):
            row = dict(zip(names, line.split()))
            step, node = int(row["step"]), int(row["node"])
            moved.setdefault(step, {})[node] = (float(row["u1"]), float(row["u2"]))
            places[node] = (float(row["x"]), float(row["y"]))
    return [moved[step] for step in sorted(moved)], places


def messages(said):
    """(severity, id, text) of all messages on standard error."""
    return re.findall(r"^\S.*?: (error|warning|note) \[([^\]]+)\] (.*)$", said, re.MULTILINE)


def first_error(said):
    """The first error as it is told, and how many more there are."""
    errors = [f"[{code}] {text}" for severity, code, text in messages(said) if severity == "error"]
    return errors[0] if errors else ""


def difference(ours, theirs):
    """Largest difference of a displacement, relative to the largest displacement of its step (or 1e-9 of that of all); and its node."""
    if len(ours) != len(theirs):
        raise Failed(f"{len(ours)} steps here, {len(theirs)} there")
    largest = [max((abs(value) for moved in step.values() for value in moved), default=0.0) for step in theirs]
    worst, where = 0.0, 0
    for mine, other, size in zip(ours, theirs, largest):
        missing = sorted(set(mine) - set(other))
        if missing:
            raise Failed(f"node {missing[0]} has no displacement there")
        for node, moved in mine.items():
            off = max(abs(a - b) for a, b in zip(moved, other[node]))/max(size, 1e-9*max(largest), 1e-300)
            if not off <= worst:
                worst, where = off, node
    return worst, where
