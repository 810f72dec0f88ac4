"""What compare_contact.py must not let pass: wrong pressures, wrong forces, what is missing, and decks that mean something else.

    python3 must_fail.py FOLDER_OF_DECKS ATRITO
"""
import pathlib
import subprocess
import sys
import tempfile

import compare_contact

HERE = pathlib.Path(__file__).resolve().parent
NAME = "contact-punch-cpe4"


def changed(lines, kind, place, factor):
    """The stored results with the last number of one line of a kind multiplied."""
    rows = [k for k, line in enumerate(lines) if line.startswith(kind)]
    result = list(lines)
    words = result[rows[place]].split()
    words[-1] = f"{float(words[-1])*factor:.6e}"
    result[rows[place]] = " ".join(words)
    return result


def results_cases(lines):
    """Results of CalculiX that are wrong: (what, lines, exit code)."""
    count = sum(line.startswith("pressure") for line in lines)
    middle = count//3//2
    return [("as stored", lines, 0),
            ("a pressure 4 % off", changed(lines, "pressure", middle, 1.04), 1),
            ("a pressure of the last step 4 % off", changed(lines, "pressure", 2*count//3 + middle, 0.96), 1),
            ("a force 1.2 % off", changed(lines, "force", 1, 1.012), 1),
            ("no forces", [line for line in lines if not line.startswith("force")], 2),
            ("no pressures in a step", [line for line in lines if not line.startswith("pressure 2")], 2),
            ("forces of another set", [line.replace("LOWER-BOTTOM", "UPPER-TOP") for line in lines], 2)]


def deck_cases(cards):
    """Decks that differ from that of CalculiX: (what, deck, exit code)."""
    return [("friction 0.31 for 0.3", cards.replace("\n0.3, 100000\n", "\n0.31, 100000\n"), 1),
            ("friction without memory", cards.replace("*FRICTION", "*FRICTION, SLIP=TOTAL"), 1),
            ("5 % stiffer", cards.replace("\n1000, 0.3\n", "\n1050, 0.3\n"), 1),
            ("a surface that is not there", cards.replace("UPPER-BOTTOM, LOWER-TOP", "UPPER-BOTTOM, LOWER-TIP"), 2)]


def main(decks, atrito):
    """Exit 1 when something passes that must not, or the other way round."""
    cards = (pathlib.Path(decks)/f"{NAME}.inp").read_text()
    lines = (HERE/"ccx"/f"{NAME}.ccx").read_text().splitlines()[1:]
    cases = [(what, cards, found, wanted) for what, found, wanted in results_cases(lines)]
    cases += [(what, deck, lines, wanted) for what, deck, wanted in deck_cases(cards)]
    cases.append(("results of another deck", cards, ["deck 0123456789abcdef"] + lines, 2))
    wrong = 0
    with tempfile.TemporaryDirectory() as scratch:
        results, deck = pathlib.Path(scratch)/"results.ccx", pathlib.Path(scratch)/"deck.inp"
        for what, text, found, wanted in cases:
            deck.write_text(text)
            first = [] if found[0].startswith("deck") else [f"deck {compare_contact.digest(text)}"]
            results.write_text("\n".join(first + found) + "\n")
            done = subprocess.run([sys.executable, "-B", HERE/"compare_contact.py", deck, "--atrito", atrito, "--stored", results],
                                  capture_output=True, text=True, check=False)
            last = (done.stdout.strip().splitlines() or ["nothing"])[-1]
            print(f"{what}: exit {done.returncode}, expected {wanted}: {last}")
            wrong += done.returncode != wanted
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
