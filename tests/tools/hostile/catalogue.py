"""What the catalogue is made of: a case, how one is added, and the scene that most of them spoil."""
import os
from dataclasses import dataclass
from typing import Callable

CASES = []


@dataclass
class Case:
    name: str
    make: Callable        # writes its files into a folder; gives the arguments of atrito, or None for `check deck.inp`
    seconds: float        # of the processor, at most
    mebibytes: int        # of memory, at most
    codes: tuple          # of which the exit code is one
    says: list            # words that are all told


def case(code=0, says=(), seconds=2, mebibytes=200):
    """A generator of a hostile deck becomes a case of its name. Limits are some three times what is needed."""
    def add(make):
        codes = code if isinstance(code, tuple) else (code,)
        words = [says] if isinstance(says, str) else list(says)
        CASES.append(Case(make.__name__.replace("_", " "), make, seconds, mebibytes, codes, words))
        return make
    return add


def write(folder, text, name="deck.inp"):
    """A file of text or bytes."""
    with open(os.path.join(folder, name), "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())


def scene(mesh="", model="", step="", last="", young="1000", q="1", size="1", n=2):
    """A block on another with friction, pressed down; what is given stands behind mesh, model, in the step and behind it."""
    return f"""*HEADING
hostile
*BLOCK, ELSET=LOW, TYPE=CPE4, NX={n}, NY={n}
0, 0
{size}, 0
{size}, {size}
0, {size}
*BLOCK, ELSET=HIGH, TYPE=CPE4, NX={n}, NY={n}
0, {size}
{size}, {size}
{size}, 2*{size}
0, 2*{size}
{mesh}*MATERIAL, NAME=M
*ELASTIC
{young}, 0.3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
1
*SOLID SECTION, ELSET=HIGH, MATERIAL=M
1
*SURFACE INTERACTION, NAME=I
*FRICTION
0.3
*CONTACT PAIR, INTERACTION=I
HIGH-BOTTOM, LOW-TOP
*BOUNDARY
LOW-BOTTOM, 1, 2
HIGH-TOP, 1, 1
{model}*STEP
*STATIC
*DSLOAD
HIGH-TOP, P, {q}
{step}*END STEP
{last}""".replace(f"2*{size}", f"<2*{size}>")
