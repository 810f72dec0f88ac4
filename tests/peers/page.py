"""The text of docs/user/compatibility.md, and how two of them are compared."""
import difflib
import re
import textwrap

HEAD = """# Decks and meshes from elsewhere: what agrees

*For users with decks of Abaqus, CalculiX, PrePoMax, Mecway or Gmsh. After it you know which run here, and how near the results are.*

Decks of other programs, and ours in their style, each run unchanged, with CalculiX VERSION for comparison. `tests/peers` makes this page. Where
CalculiX and its test decks are installed, a test makes it again and fails if a verdict, a count or a reason differs.
"""

MEANING = """The displacements of all nodes at the end of each step are compared; the difference is the largest over the largest displacement. In the
copies that are compared only requests for output are changed. Decks with parts, or with a mesh of Gmsh, which CalculiX cannot read, are made flat.
Of the decks `contact-*` forces and pressures are compared instead; CalculiX takes minutes for them, so its results are stored.

- **agreed**: the difference is at most 1e-4, in our own decks with contact 1e-2; of `contact-*` forces within 1 % and pressures within 3 %
- **explained**: it is more; the test bounds it, and a note says why
- **solved**: solved here, CalculiX gives no result
- **refused**: exit code 2, nothing is solved; the note has the first message
- **DIFFERS**, **FAILS**: neither; there is none as long as the test passes

A deck with NLGEOM is solved here with small displacements, so CalculiX is run without NLGEOM. CalculiX models a body of revolution as a wedge of 2
degrees, and its value for a node of the plane is a mean over the wedge: radial displacements are cos(1 degree) times the true ones at the middle of
an edge (1.5e-4 less), a third of that at corners. So the displacements of its solid elements, turned back into the plane, are compared.
"""

MESHES = """CalculiX has other elements of four nodes in plane stress, and the pressure at the corner of a punch has no limit, so the programs spread it
differently: what differs on a coarse mesh agrees on finer ones. Each element is divided into n by n, and both programs read the same deck. On
four-node meshes forces are spread by the shape functions of the coarse mesh, since the displacement under a force at a node has no limit. The largest
difference of all nodes, and the largest displacement of each program:
"""
WIDTH = 80
FEW = 3                                              # names of decks of one reason that are told


class Notes:
    """Reasons and remarks below a table, each once, by number."""

    def __init__(self):
        self.words = []

    def numbers(self, words):
        """The numbers of the remarks of a row, which end at semicolons."""
        found = []
        for word in filter(None, words.split("; ")):
            if word not in self.words:
                self.words.append(word)
            found.append(self.words.index(word) + 1)
        return ", ".join(map(str, found))

    def lines(self):
        """A list."""
        return [""] + [line for k, words in enumerate(self.words) for line in wrapped(plain(words), f"{k + 1}. ")]


def wrapped(words, first=""):
    """Lines of at most 80 characters; the later ones stand below the first."""
    return textwrap.wrap(words, WIDTH, initial_indent=first, subsequent_indent=" "*len(first), break_long_words=False, break_on_hyphens=False)


def prose(words):
    """Paragraphs and lists of at most 80 characters a line."""
    lines = []
    for paragraph in words.strip().split("\n\n"):
        if paragraph.startswith("- "):
            for item in paragraph[2:].split("\n- "):
                lines += wrapped(" ".join(item.split()), "- ")
        else:
            lines += wrapped(" ".join(paragraph.split()))
        lines.append("")
    return lines


def text(rows, meshes, reasons, version_of_ccx):
    """The whole page."""
    rows, shown = [row for row in rows if not row.shows], [row for row in rows if row.shows]
    lines = prose(HEAD.replace("VERSION", version_of_ccx)) + counts(rows, reasons) + [""] + prose(MEANING)
    lines += ["## Plane decks among CalculiX's own tests", ""] + table([row for row in rows if not row.own])
    lines += ["", "## Decks of tests/peers/decks", ""] + table([row for row in rows if row.own])
    if shown:
        lines += ["", "## Where differences come from", ""] + wrapped("Decks above with what the note says changed, in both programs, and nothing else:")
        lines += [""] + table(shown)
    lines += ["", "## Finer meshes", ""] + prose(MESHES)
    lines += [line for mesh in meshes for line in mesh.lines()]
    lines += ["## CalculiX's other test decks", ""] + wrapped("They are not of a plane. What `atrito check` says of them, its first reason:") + [""]
    for reason, names in sorted(reasons.items(), key=lambda item: (-len(item[1]), item[0])):
        lines += wrapped(f"**{len(names)}** {plain(reason)}: {' '.join(names[:FEW])}{' ...' if len(names) > FEW else ''}", "- ")
    return "\n".join(lines) + "\n"


def counts(rows, reasons):
    """How many of which verdict."""
    verdicts = [verdict for verdict in ("agreed", "explained", "solved", "refused", "DIFFERS", "FAILS")
                if any(row.verdict == verdict for row in rows)]
    lines = ["| decks | number | " + " | ".join(verdicts) + " |", "|---|---|" + "---|"*len(verdicts)]
    for what, own in (("plane decks of CalculiX's tests", False), ("decks of tests/peers/decks", True)):
        group = [row for row in rows if row.own == own]
        lines.append(f"| {what} | {len(group)} | " + " | ".join(str(sum(row.verdict == verdict for row in group)) for verdict in verdicts) + " |")
    total = sum(map(len, reasons.values()))
    refused = total - len(reasons.get("accepted by check", []))
    empty = [str(refused) if verdict == "refused" else "" for verdict in verdicts]
    lines.append(f"| CalculiX's other tests | {total} | " + " | ".join(empty) + " |")
    return lines


def table(rows):
    """A row a deck, and the notes below."""
    notes = Notes()
    lines = ["| deck | elements | verdict | difference | notes |", "|---|---|---|---|---|"]
    for row in rows:
        numbers = notes.numbers("; ".join(filter(None, (row.shows, row.words))))
        lines.append(f"| {row.name} | {row.elements} | {row.verdict} | {row.difference} | {numbers} |")
    return lines + notes.lines()


def plain(words):
    """Words that are not taken as marks."""
    return words.replace("|", "/").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")


def version(words):
    """The version of CalculiX that a page is of."""
    found = re.search(r"CalculiX\s+(\d[\w.]*)", words)
    return found[1] if found else ""


def without_differences(words):
    """A page without the sizes of differences, which depend on round-off and on the version of CalculiX."""
    return re.sub(r"\d\.\d+e[-+]\d+|\d+\.\d+ %|(?<=greatest p )\S+ and [^ ;|]+", "#", words)


def differences(kept, found):
    """Lines in which two pages differ, sizes of differences left out."""
    lines = difflib.unified_diff(without_differences(kept).splitlines(), without_differences(found).splitlines(), "the page", "found", n=0, lineterm="")
    return [line[:300] for line in lines if not line.startswith(("@@", "---", "+++"))]
