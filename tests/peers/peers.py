"""Decks of other programs and for them: each is run as it is, CalculiX beside, and docs/user/compatibility.md is made of what is found.

    python3 peers.py --atrito PROGRAM --ccx PROGRAM --examples FOLDER --work FOLDER --write PAGE     makes the page
    python3 peers.py --atrito PROGRAM --ccx PROGRAM --examples FOLDER --work FOLDER --check PAGE     exit 1 where the page tells otherwise
    python3 peers.py ... --only NAME,NAME                                                             prints rows of the page

FOLDER of the examples: the test decks of CalculiX. `expected.txt` says what may differ, by how much and why. Standard library alone.
"""
import argparse
import pathlib
import re
import shutil
import sys

import cards
import flatten
import gmsh
import page
import refined
import results

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE/"contact"))
import make_decks
LIMIT = 1e-4             # of the largest displacement
CONTACT_LIMIT = 1e-2     # of our own scenes with contact, whose laws the programs integrate differently
KEEPS_ITS_CALCULIX = ("contact-",)


class Row:
    """What is found of a deck."""

    def __init__(self, name, own, words=""):
        self.name, self.own, self.shows = name, own, words
        self.elements, self.verdict, self.difference, self.words = "", "", "", ""


class Expected:
    """The lines of expected.txt: name | verdict | limit | words."""

    def __init__(self, path):
        self.lines = {}
        for line in path.read_text().splitlines():
            if line.strip() and not line.startswith("#"):
                name, verdict, limit, words = (word.strip() for word in line.split("|"))
                self.lines[name] = (verdict, float(limit or 0), words)

    def verdict(self, name):
        """The verdict that is asked for; empty: any."""
        return self.lines.get(name, ("", 0, ""))[0]

    def limit(self, name):
        """The limit of the difference, 0 where none is stated."""
        return self.lines.get(name, ("", 0, ""))[1]

    def words(self, name):
        """The explanation."""
        return self.lines.get(name, ("", 0, ""))[2]


def judge(row, text, given, expected, keep_ccx):
    """Runs a deck as it is and, where it is solved, the two copies that are compared."""
    work, name = given.work, row.name
    deck = gmsh.flat(cards.read(text), given.own)
    text = gmsh.located(text, given.own)
    row.elements = ", ".join(cards.element_types(deck))
    (work/f"{name}.inp").write_text(text)
    code, _, said = results.run([given.atrito, f"{name}.inp", "-o", f"{name}-as-it-is", "--quiet"], work)
    if code == 2:
        row.verdict = "refused"
        row.words = results.first_error(said)
    elif code:
        row.verdict = "FAILS"
        row.words = f"exit {code}: {results.first_error(said)}"
    elif row.own and name.startswith(KEEPS_ITS_CALCULIX):
        compare_contact(row, given, keep_ccx)
    else:
        compare(row, deck, cards.read(text), given, expected)
    if row.verdict in ("agreed", "explained"):
        row.words = "; ".join(word for word in (row.words, expected.words(name)) if word)



def compare(row, deck, as_it_is, given, expected):
    """Displacements of the two programs; a mesh of Gmsh is read here as it is."""
    flat = flatten.flat(deck)
    try:
        ours, places = results.atrito(given.atrito, given.work, f"{row.name}-copy", cards.text_of(cards.for_atrito(as_it_is)))
    except results.Failed as failed:
        row.verdict, row.words = "FAILS", str(failed)
        return
    try:
        theirs = results.ccx(given.ccx, given.work, f"{row.name}-ccx", cards.text_of(cards.for_ccx(flat.cards)),
                             cards.elements(flat.cards) if cards.of_revolution(deck) else None,
                             ties_in_part=expected.verdict(row.name) == "explained")
    except results.Failed as failed:
        row.verdict, row.words = "solved", f"CalculiX has no result: {failed}"
        return
    try:
        most, node = results.difference(of_elements(flat.renumbered(ours, places), flat.cards), theirs)
    except results.Failed as failed:
        row.verdict, row.words = "DIFFERS", str(failed)
        return
    row.difference = f"{most:.1e}"
    row.verdict = verdict(most, deck, row, expected)
    if row.verdict == "DIFFERS":
        row.words = f"at node {node}"
    if cards.touches(deck) and row.own:
        ours, theirs = results.greatest_pressures(given.work, f"{row.name}-copy", f"{row.name}-ccx")
        row.difference += f", greatest p {ours:.4g} and {theirs:.4g}"
    if cards.is_large(deck):
        row.words = "; ".join(filter(None, (row.words, "NLGEOM: CalculiX is run without it")))


def of_elements(moved, deck):
    """Without nodes that no element has."""
    nodes = {node for row in cards.elements(deck).values() for node in row}
    return [{node: value for node, value in step.items() if node in nodes} for step in moved]


def verdict(most, deck, row, expected):
    """agreed, explained (within the limit that is stated with its reason), or DIFFERS."""
    if most <= (CONTACT_LIMIT if cards.touches(deck) and row.own else LIMIT):
        return "agreed"
    return "explained" if most <= expected.limit(row.name) else "DIFFERS"


def compare_contact(row, given, keep_ccx):
    """Forces and pressures of a pair, by the program that knows these decks."""
    command = [sys.executable, str(HERE/"contact"/"compare_contact.py"), str(given.made/f"{row.name}.inp"), "--atrito", str(given.atrito), "--quiet"]
    stored = HERE/"contact"/"ccx"/f"{row.name}.ccx"
    command += ["--stored", str(stored)] if keep_ccx and stored.exists() else ["--ccx", str(given.ccx)]
    code, said, _ = results.run(command, given.work, 600)
    found = re.search(r"forces ([\d.]+) %, pressures ([\d.]+) %", said)
    row.verdict = {0: "agreed", 1: "DIFFERS"}.get(code, "FAILS")
    row.difference = f"forces {float(found[1]):.1f} %, pressures {float(found[2]):.1f} %" if found else ""
    row.words = "" if found else said.strip()[:200]


def others(decks, given):
    """(reason, names) of the decks that are not of a plane, and of faults: how `check` refuses each of them."""
    reasons, faults = {}, []
    for name, text in decks.items():
        (given.work/f"{name}.inp").write_text(text)
    for name in decks:
        code, _, said = results.run([given.atrito, "check", f"{name}.inp", "--quiet"], given.work)
        if code not in (0, 2):
            faults.append(f"{name}: exit {code} of check")
        reason = reason_of(said) if code == 2 else "accepted by check"
        reasons.setdefault(reason, []).append(name)
    return reasons, faults


def reason_of(said):
    """What is said of a deck that lies outside: its first E-OUTSIDE, else its first error; without numbers of nodes and the like."""
    errors = [(code, text) for severity, code, text in results.messages(said) if severity == "error"]
    outside = [error for error in errors if error[0] == "E-OUTSIDE"]
    code, text = (outside or errors or [("", "no message")])[0]
    text = re.sub(r" \(and [0-9]+ more lines?\)$", "", text)
    return f"[{code}] {re.sub(r'[0-9]{2,}', 'N', text) if code != 'E-OUTSIDE' else text}"


def unknown_of(reasons):
    """How many decks are refused because of a keyword or a type that is not known by name."""
    return sum(len(names) for reason, names in reasons.items() if "unknown" in reason)


def derived(path, decks):
    """Text and words, by name, of the decks that are changed in one thing."""
    made = {}
    for line in path.read_text().splitlines():
        name, deck, *changes, words = ((word.strip() for word in line.split("|")) if not line.startswith("#") else ("", "", ""))
        if deck in decks:
            text = decks[deck]
            for old, new in zip(changes[::2], changes[1::2]):
                old, new = old.replace("/", "\n"), new.replace("/", "\n")
                if text.count(old) != 1:
                    raise SystemExit(f"{path}: {name}: {old!r} stands {text.count(old)} times in the deck")
                text = text.replace(old, new)
            made[name] = (text, words)
    return made


def complaints(rows, expected, unknown, faults):
    """What is wrong whatever the page says."""
    found = list(faults)
    for row in rows:
        wanted = expected.verdict(row.name)
        if wanted and row.verdict != wanted:
            found.append(f"{row.name}: {row.verdict}, {wanted} is expected: {row.words}")
        elif not wanted and row.verdict in ("FAILS", "DIFFERS"):
            found.append(f"{row.name}: {row.verdict}, {row.difference} {row.words}")
    if unknown > expected.limit("unknown"):
        found.append(f"{unknown} decks have a keyword that is unknown by name, {expected.limit('unknown'):.0f} at most are expected")
    return found


def version(program):
    """Of CalculiX."""
    found = re.search(r"Version ([\w.]+)", results.run([program, "-v"], ".")[1])
    return found[1] if found else "unknown"


def differs(kept, found):
    """Lines in which the page is not what is found; of a page of another version of CalculiX nothing can be said."""
    if page.version(kept) != page.version(found):
        print(f"the page is of CalculiX {page.version(kept)}, this is {page.version(found)}: verdicts are checked, the page is not compared")
        return []
    return page.differences(kept, found)


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("atrito", "ccx", "examples", "work"):
        parser.add_argument(f"--{name}", required=True, type=pathlib.Path)
    parser.add_argument("--write", type=pathlib.Path)
    parser.add_argument("--check", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--fresh", action="store_true", help="runs CalculiX for the decks contact-*, too: minutes; else what it found is kept")
    parser.add_argument("--own", type=pathlib.Path, default=HERE/"decks", help="folder of our own decks")
    parser.add_argument("--expected", type=pathlib.Path, default=HERE/"expected.txt")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    given.work, given.atrito, given.own = given.work.resolve(), given.atrito.resolve(), given.own.resolve()
    given.made = given.work/"decks"
    shutil.rmtree(given.made, ignore_errors=True)
    if given.own == HERE/"decks":
        make_decks.main(given.made, [])
    return given


def all_rows(given, expected):
    """Rows of the plane decks, theirs and our own; all decks that are not plane; and the texts of those that are."""
    theirs = cards.decks(given.examples)
    paths = sorted([*given.own.glob("*.inp"), *given.made.glob("*.inp")], key=lambda path: path.name)
    own = {path.stem: path.read_text() for path in paths}
    rest = {name: text for name, text in theirs.items() if not cards.plane(cards.read(text))}
    rows = []
    wanted = given.only.split(",") if given.only else None
    every = {name: (text, "") for name, text in {**theirs, **own}.items() if name not in rest}
    every.update(derived(HERE/"derived.txt", {**theirs, **own}))
    for name, (text, words) in every.items():
        if wanted is None or name in wanted:
            row = Row(name, name in own, words)
            judge(row, text, given, expected, keep_ccx=not given.fresh)
            rows.append(row)
            print(f"{row.name}: {row.verdict} {row.difference} {row.words[:90]}", flush=True)
    return rows, rest, {name: text for name, (text, _) in every.items()}


def main():
    """Makes the page, or compares it."""
    given = arguments()
    expected = Expected(given.expected)
    rows, rest, decks = all_rows(given, expected)
    if given.only:
        return 0
    meshes = refined.table(given, decks, [row.name for row in rows if row.verdict != "refused"])
    reasons, faults = others(rest, given)
    text = page.text(rows, meshes, reasons, version(given.ccx))
    wrong = complaints(rows, expected, unknown_of(reasons), faults) + [fault for mesh in meshes for fault in mesh.faults()]
    if given.write:
        given.write.write_text(text)
    if given.check:
        wrong += differs(given.check.read_text(), text)
    for line in wrong:
        print(f"FAILED: {line}")
    print(f"{len(rows)} decks compared, {sum(map(len, reasons.values()))} others; {results.spent():.1f} s of processor time")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
