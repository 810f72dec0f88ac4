"""Runs CalculiX on the scenes of this folder and keeps of its results what check.sh compares: NAME.ccx.

    python3 reference.py FOLDER [NAME ...]       in FOLDER; ccx is taken from the path. Standard library alone.

A line `resultant STEP FX FY` a step, what the supports of the base give (bodies of revolution: the force of the contact, *CONTACT PRINT with CF,
of the full circle, as CalculiX leaves out of the radial reaction of a node what the hoop stress gives it); a line `point STEP X PRESSURE SHEAR` for each node of the slave
at the end of each step.
"""
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def slave_nodes(deck):
    """x of the nodes of faces S1 of UPPER-FACE, by number, from the cards of the deck."""
    elements, faces, nodes, card = {}, [], {}, ""
    for line in deck.splitlines():
        if line.startswith("*"):
            card = line.upper()
        elif card.startswith("*ELEMENT"):
            numbers = [int(word) for word in line.split(",")]
            elements[numbers[0]] = numbers[1:]
        elif card.startswith("*SURFACE, NAME=UPPER-FACE"):
            faces.append(int(line.split(",")[0]))
        elif card.startswith("*NODE,"):
            words = line.split(",")
            nodes[int(words[0])] = float(words[1])
    found = set()
    for number in faces:
        of = elements[number]
        found.update(of[:2] + (of[4:5] if len(of) == 8 else []))
    return {number: nodes[number] for number in sorted(found, key=nodes.get)}


def resultants(text):
    """Sums of the forces of each time in a .dat file."""
    sums = []
    for line in text.splitlines():
        words = line.split()
        if "forces" in line:
            sums.append([0.0, 0.0])
        elif len(words) == 4 and words[0].isdigit():
            sums[-1][0] += float(words[1])
            sums[-1][1] += float(words[2])
    return sums


def contact_forces(text):
    """Forces of the contact, of the full circle, of each time in a .dat file: CalculiX has a wedge of 2 degrees."""
    lines = text.splitlines()
    heads = [k for k, line in enumerate(lines) if "total surface force" in line]
    return [[180*float(word) for word in lines[k + 2].split()[:2]] for k in heads]


def contact_fields(text):
    """Pressure and shear by node of each CONTACT block of a .frd file."""
    blocks, inside = [], False
    for line in text.splitlines():
        if line.startswith(" -4"):
            inside = "CONTACT" in line
            if inside:
                blocks.append({})
        elif line.startswith(" -3"):
            inside = False
        elif inside and line.startswith(" -1"):
            values = [float(line[13 + 12*k:25 + 12*k]) for k in range(6)]
            blocks[-1][int(line[3:13])] = (values[3], values[4])
    return blocks


def main(folder, names):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or sorted(path.stem for path in HERE.glob("*.steps")):
        deck = subprocess.run(["sh", HERE/"deck.sh", name], capture_output=True, text=True, check=True).stdout
        round_body = "TYPE=CAX" in deck
        if round_body:
            deck = deck.replace("*CONTACT FILE", "*CONTACT PRINT, MASTER=LOWER-FACE, SLAVE=UPPER-FACE, FREQUENCY=1000\nCF\n*CONTACT FILE", 1)
        (folder/f"{name}.inp").write_text(deck)
        subprocess.run(["ccx", name], cwd=folder, stdout=subprocess.DEVNULL, check=True)
        text = (folder/f"{name}.dat").read_text()
        sums = contact_forces(text) if round_body else resultants(text)
        fields = contact_fields((folder/f"{name}.frd").read_text())
        steps = deck.count("*END STEP")
        if not len(sums) == len(fields) == steps:
            sys.exit(f"{name}: {len(sums)} resultants, {len(fields)} fields, {steps} steps")
        lines = [f"resultant {k} {x:.6e} {y:.6e}" for k, (x, y) in enumerate(sums, 1)]
        for k, field in enumerate(fields, 1):
            lines += [f"point {k} {x:.6f} {field[node][0]:.5e} {field[node][1]:.5e}" for node, x in slave_nodes(deck).items()]
        (folder/f"{name}.ccx").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
