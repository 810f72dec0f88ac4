"""The comparison must notice: must_fail.py ATRITO CCX FOLDER

Small examples of its own make a page, which is then right; what is changed by little afterwards - a displacement, a row or a count of
the page, an exit code, a keyword that is not known - must be told. A deck of parts must come out flat as it was. Standard library alone.
"""
import pathlib
import stat
import subprocess
import sys

sys.dont_write_bytecode = True
import cards
import flatten
import gmsh
import page
import refined
import results

HERE = pathlib.Path(__file__).resolve().parent
MATERIAL = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n0.01\n"
SQUARE = "*NODE, NSET=ALL\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0.5, 0.\n6, 1., 0.5\n7, 0.5, 1.\n8, 0., 0.5\n"
HELD = "*BOUNDARY\n1, 1, 2\n5, 2\n2, 2\n"
STEP = "*STEP{large}\n*STATIC\n*CLOAD\n3, 1, 0.01\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n"
EIGHT = SQUARE + "*ELEMENT, TYPE=CPS8, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n" + MATERIAL + HELD + STEP
FOUR = SQUARE.split("5, 0.5")[0] + "*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n" + MATERIAL + "*BOUNDARY\n1, 1, 2\n2, 2\n" + STEP
SOLID = "*NODE\n1, 0., 0., 1.\n*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 1, 1, 1, 1, 1, 1, 1\n" + MATERIAL
PART = """*PART, NAME=P
*NODE
1, 1., 0.
2, 2., 0.
3, 2., 1.
4, 1., 1.
*ELEMENT, TYPE=CPS4
1, 1, 2, 3, 4
*NSET, NSET=SIDE, GENERATE
1, 2
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=I, PART=P
*END INSTANCE
*INSTANCE, NAME=J, PART=P
0., 5.
0., 5., 0., 0., 5., 1., 90.
*END INSTANCE
*NODE
1, 0., 9.
*NSET, NSET=SPARE
1
*NSET, NSET=TOP, INSTANCE=J
3, 4
*END ASSEMBLY
*BOUNDARY
J.SIDE, ENCASTRE
I.2, 1, 1
"""


# A unit square that runs clockwise, and beside it a triangle; their common side, and the base, are physical curves.
MESH = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "base"
1 2 "seam"
2 7 "all"
$EndPhysicalNames
$Entities
0 2 1 0
1 0 0 0 2 0 0 1 1 0
2 1 0 0 1 1 0 1 2 0
3 0 0 0 2 1 0 1 7 0
$EndEntities
$Nodes
1 6 1 9
2 3 0 6
1
2
3
4
5
9
0 0 0
1 0 0
1 1 0
0 1 0
2 0 0
7 7 0
$EndNodes
$Elements
4 5 1 5
1 1 1 2
1 1 2
2 2 5
1 2 1 1
3 2 3
2 3 3 1
4 1 4 3 2
2 3 2 1
5 2 5 3
$EndElements
"""


class Scene:
    """A folder of examples and of decks of our own, and the page of them."""

    def __init__(self, atrito, ccx, folder):
        self.atrito, self.ccx, self.folder, self.failed = str(pathlib.Path(atrito).resolve()), ccx, folder, 0
        for name in ("examples", "own"):
            (folder/name).mkdir(parents=True, exist_ok=True)
        (folder/"examples"/"eight.inp").write_text(EIGHT.format(large=""))
        (folder/"examples"/"large.inp").write_text(EIGHT.format(large=", NLGEOM=NO"))
        (folder/"examples"/"solid.inp").write_text(SOLID)
        (folder/"own"/"wrong.inp").write_text(EIGHT.format(large="").replace("1000.", "-1000."))
        self.page = folder/"page.md"

    def run(self, action, atrito="", expected="unknown | | 1 |\n"):
        """Exit code and output of peers.py."""
        (self.folder/"expected.txt").write_text(expected)
        done = subprocess.run([sys.executable, str(HERE/"peers.py"), "--atrito", atrito or self.atrito, "--ccx", self.ccx, "--examples",
                               str(self.folder/"examples"), "--own", str(self.folder/"own"), "--work", str(self.folder/"work"),
                               "--expected", str(self.folder/"expected.txt"), action, str(self.page)],
                              capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def complain(self, what, wrong):
        """Counts and tells."""
        if wrong:
            self.failed += 1
            print(f"FAILED: {what}")

    def must_tell(self, what, said, fragment):
        """An exit code 1, and words in the output."""
        self.complain(f"{what}: exit {said[0]}, {said[1][-600:]}", said[0] != 1 or fragment not in said[1])

    def liar(self, name, script):
        """A program that is atrito but for a line of shell."""
        path = self.folder/name
        path.write_text(f"#!/bin/sh\n{script}\n".replace("ATRITO", self.atrito))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)


def programs_that_lie(scene):
    """A displacement that is off by 3e-4, exit codes."""
    off = scene.liar("off", "ATRITO \"$@\" || exit\n[ -f \"$3/nodes.tab\" ] || exit 0\n"
                     "awk '!/^#/ && $2 == 7 { $5 *= 1.0003 } { print }' \"$3/nodes.tab\" >\"$3/n\" && mv \"$3/n\" \"$3/nodes.tab\"")
    scene.must_tell("a displacement is off", scene.run("--check", off), "eight: DIFFERS")
    scene.must_tell("not converged", scene.run("--check", scene.liar("three", "ATRITO \"$@\" && exit 3")), "eight: FAILS")
    scene.must_tell("check breaks", scene.run("--check", scene.liar("crash", "[ $1 = check ] && exit 9; ATRITO \"$@\"")), "exit 9 of check")


def pages_that_lie(scene):
    """A verdict, a count, a reason, a row too many."""
    kept = scene.page.read_text()
    for what, old, new in (("verdict", "| eight | CPS8 | agreed |", "| eight | CPS8 | explained |"), ("count", "| 2 |", "| 3 |"),
                           ("reason", "[E-", "[F-"), ("row", "| eight |", "| none | | | | |\n| eight |")):
        scene.complain(f"the page has no {old}", old not in kept)
        scene.page.write_text(kept.replace(old, new, 1))
        scene.must_tell(f"another {what}", scene.run("--check"), "FAILED: ")
    scene.page.write_text(kept.replace(f"CalculiX {page.version(kept)}", "CalculiX 1.0"))
    code, said = scene.run("--check")
    scene.complain(f"a page of another version: {said}", code != 0 or "the page is not compared" not in said)
    scene.page.write_text(kept)


def sides(scene):
    """The page is right as it is made; expectations that are not met."""
    code, said = scene.run("--write")
    scene.complain(f"the page cannot be made: {said}", code != 0)
    code, said = scene.run("--check")
    scene.complain(f"the page is not found right: {said}", code != 0 or "3 decks compared, 1 others" not in said)
    scene.must_tell("a verdict is expected", scene.run("--check", expected="unknown | | 1 |\nwrong | agreed | |\n"), "wrong: refused")
    (scene.folder/"examples"/"odd.inp").write_text("*NO SUCH KEYWORD\n")
    scene.must_tell("an unknown keyword", scene.run("--check", expected="unknown | | 0 |\n"), "unknown by name")
    (scene.folder/"examples"/"odd.inp").unlink()


def other_elements(scene):
    """Another solution on fine meshes, as the one with half the stiffness."""
    half = scene.liar("half", 'sed "s/^1000\\./500./" "$1" >"$1.half"; f="$1.half"; shift; ATRITO "$f" "$@"')
    (scene.folder/"examples"/"planestrain.inp").write_text(FOUR.format(large=""))
    code, said = scene.run("--write")
    scene.complain(f"four nodes: {said}", "planestrain refined" in said)
    scene.must_tell("another material", scene.run("--write", half), "planestrain refined: differences")


def comparisons(scene):
    """Differences and pages by themselves; a deck of parts."""
    theirs = [{1: (1.0, 0.0), 2: (0.0, 2.0)}]
    scene.complain("difference", results.difference([{1: (1.0, 0.0), 2: (0.0, 2.1)}], theirs)[1] != 2)
    scene.complain("not a number", results.difference([{1: (float("nan"), 0.0)}], theirs)[0] <= 1)
    for ours in ([{3: (1.0, 0.0)}], theirs*2):
        try:
            results.difference(ours, theirs)
            scene.complain(f"{ours} are compared", True)
        except results.Failed:
            pass
    scene.complain("pages with other sizes", page.differences("| agreed | 1.0e-06 |", "| agreed | 2.0e-07 |"))
    eight = refined.Divided(cards.read(EIGHT.format(large="")), 2)
    scene.complain(f"{len(eight.at)} nodes", len(eight.at) != 21 or eight.at[7] != (0.5, 1.0) or any(len(row) != 8 for row in eight.rows.values()))
    forces = refined.Divided(cards.read(FOUR.format(large="")), 2).spread(3)
    scene.complain(f"forces {forces}", abs(sum(forces.values()) - 1) > 1e-12 or forces.get(3) != 0.5 or len(forces) != 3)
    flat = flatten.flat(cards.read(PART))
    scene.complain(f"places {flat.places}", flat.places[1] != (1.0, 0.0) or max(map(abs, flat.places[5])) > 6.0 or
                   abs(flat.places[5][0]) > 1e-12 or abs(flat.places[5][1] - 6.0) > 1e-12)
    text = cards.text_of(flat.cards)
    for line in ("J_SIDE, 1, 2", "2, 1, 1", "2, 5, 6, 7, 8", "7, 8", "5, 6", "*NSET, NSET=J_SIDE, GENERATE", "9, 0.000000000000e+00, 9.000000000000e+00", "9"):
        scene.complain(f"no line {line} in\n{text}", line not in text.splitlines())


def meshes(scene):
    """A mesh of Gmsh becomes flat: elements counterclockwise, faces on curves, no node without an element."""
    folder = scene.folder/"own"
    (scene.folder/"square.msh").write_text(MESH)
    deck = "*INCLUDE, INPUT=../square.msh, TYPE=GMSH, ELEMENTS=CPE\n*MATERIAL, NAME=M\n"
    lines = cards.text_of(gmsh.flat(cards.read(deck), folder)).splitlines()
    for line in ("4, 1, 2, 3, 4", "5, 2, 5, 3", "*ELEMENT, TYPE=CPE3", "*SURFACE, NAME=base, TYPE=ELEMENT", "4, S1", "5, S1", "*ELSET, ELSET=all",
                 "4, S2", "5, S3", "*MATERIAL, NAME=M"):
        scene.complain(f"no line {line} in\n{lines}", line not in lines)
    scene.complain("a node without an element", any(line.startswith("9,") for line in lines))
    path = gmsh.located(deck, folder).splitlines()[0]
    scene.complain(f"the mesh is not found: {path}", path != f"*INCLUDE, INPUT={scene.folder/'square.msh'}, TYPE=GMSH, ELEMENTS=CPE")


def main(atrito, ccx, folder):
    """All of it."""
    scene = Scene(atrito, ccx, pathlib.Path(folder).resolve())
    (scene.folder/"examples"/"planestrain.inp").unlink(missing_ok=True)
    comparisons(scene)
    meshes(scene)
    sides(scene)
    pages_that_lie(scene)
    programs_that_lie(scene)
    other_elements(scene)
    return 1 if scene.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
