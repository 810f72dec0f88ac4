"""The decks contact-*.inp are those that make_decks.py makes, to the letter, and no others.

    python3 decks_are_made.py FOLDER_OF_DECKS
"""
import pathlib
import sys
import tempfile

import make_decks


def main(folder):
    """Names of what differs; none is good."""
    with tempfile.TemporaryDirectory() as scratch:
        make_decks.main(scratch, [])
        made = {path.name: path.read_text() for path in pathlib.Path(scratch).glob("*.inp")}
    there = {path.name: path.read_text() for path in pathlib.Path(folder).glob("contact-*.inp")}
    different = [name for name in sorted(made.keys() | there.keys()) if made.get(name) != there.get(name)]
    print(f"{len(there)} decks, {len(different)} of them not as they are made:", *different)
    return 0 if there and not different else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
