"""Hand-ins of somebody who wishes the marker ill. Each maker writes one; none may change anything outside MARKS, and all are told."""

from __future__ import annotations

import os
from typing import Callable

from made_class import Made

SECRET = "the-secret-of-the-lecturer"
EVIL = "<script>alert(1)</script><img src=x onerror=alert(2)>"
FORMULA = "=HYPERLINK(\"http://example.org\",\"marks\")"
BIG_LOOP = """*BLOCK, TYPE=CPS4, ELSET=B, NX={n}, NY={n}
0, 0
1, 0
1, 1
0, 1
*MATERIAL, NAME=M
*ELASTIC
1, 0
*SOLID SECTION, ELSET=B, MATERIAL=M
*STEP, INC={steps}
*STATIC
{first}, 1
*BOUNDARY
B-BOTTOM, 1, 2
*DSLOAD
B-TOP, P, 1
*NODE PRINT, FREQUENCY=1
U
*END STEP
"""


def answer(made: Made, text: str) -> None:
    """The text as every answer."""
    quoted = text.replace("\\", "\\\\").replace('"', '\\"')
    made.texts = {name: (quoted + " ")*12 for name in made.texts}
    made.write()
    path = made.folder/"answers.toml"
    lines = [f'{item.name} = "{quoted}"' for item in made.asked]
    texts = path.read_text().partition("[explanations]")[2]
    path.write_text("[answers]\n" + "\n".join(lines) + "\n[explanations]" + texts)


def html(made: Made) -> None:
    answer(made, EVIL)


def html_end(made: Made) -> None:
    answer(made, "</td></table></body><style>body{display:none}</style>'\"><a href=javascript:alert(1)>")


def formula(made: Made) -> None:
    answer(made, FORMULA)


def formulas(made: Made) -> None:
    answer(made, "+cmd|' /C calc'!A0")


def shell(made: Made) -> None:
    answer(made, "$(touch pwned); `touch pwned`; touch pwned #")


def control(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").write_bytes(b"[answers]\nestar = \"\x1b[2J\x07\x00\x9b31m\"\n")


def turned(made: Made) -> None:
    answer(made, "\u202e321\u2066")


def nested(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").write_text("a = " + "["*60_000)


def long_number(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").write_text("".join(f"{item.name} = {'9'*5000}\n" for item in made.asked))


def not_numbers(made: Made) -> None:
    made.write()
    words = ["nan", "inf", "-inf", "1e999", "true", "1979-05-27"]
    (made.folder/"answers.toml").write_text("".join(f"{item.name} = {words[place % 6]}\n" for place, item in enumerate(made.asked)))


def slow_pattern(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").write_text('x = """' + '"" '*60_000)


def link_to_secret(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").unlink()
    (made.folder/"answers.toml").symlink_to(made.folder.parent.parent/"secret.txt")


def link_of_folder(made: Made) -> None:
    made.folder.symlink_to(made.folder.parent.parent)


def link_to_folder(made: Made) -> None:
    made.write()
    (made.folder/"more").symlink_to("/")


def link_of_deck(made: Made) -> None:
    made.write()
    (made.folder/made.sheet.deck_name).unlink()
    (made.folder/made.sheet.deck_name).symlink_to("/etc/passwd")


def hard_link(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").unlink()
    os.link(made.folder.parent.parent/"secret.txt", made.folder/"answers.toml")


def pipe(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").unlink()
    os.mkfifo(made.folder/"answers.toml")
    os.mkfifo(made.folder/"summary.tab")


def include(named: str) -> Callable[[Made], None]:
    """A deck that includes a file outside of its folder."""
    def make(made: Made) -> None:
        made.write()
        (made.folder/made.sheet.deck_name).write_text(f"*INCLUDE, INPUT={named}\n{made.deck}")
    return make


def include_neighbour(made: Made) -> None:
    include(f"../{int(made.number) - 1}/{made.sheet.deck_name}")(made)


def include_circle(made: Made) -> None:
    include(made.sheet.deck_name)(made)


def include_many(made: Made) -> None:
    made.write()
    for place in range(200):
        (made.folder/f"part{place}.inp").write_text(f"*INCLUDE, INPUT=part{place + 1}.inp\n"*2)
    (made.folder/made.sheet.deck_name).write_text("*INCLUDE, INPUT=part0.inp\n" + made.deck)


def deck(text: str) -> Callable[[Made], None]:
    """Another deck."""
    def make(made: Made) -> None:
        made.write()
        (made.folder/made.sheet.deck_name).write_text(text)
    return make


def sparse_file(name: str) -> Callable[[Made], None]:
    """A file of 2 GB, which takes no room."""
    def make(made: Made) -> None:
        made.write()
        path = made.folder/(name or made.sheet.deck_name)
        path.unlink(missing_ok=True)
        with path.open("wb") as file:
            file.truncate(2_000_000_000)
    return make


def options(head: str) -> Callable[[Made], None]:
    """A head of summary.tab with options for the run that is made again."""
    def make(made: Made) -> None:
        made.write()
        for name in {"summary", *made.sheet.tables}:
            made.table(name).write_text(f"# options: {head}\n# parameters: {head.replace('=', ' = ')} (--set)\n" + made.table(name).read_text())
    return make


def names(made: Made) -> None:
    made.write()
    for name in ("'; rm -rf ~; '.inp", "a\nb\x1b[31m.tab", "<img src=x onerror=alert(3)>.tab", "-o.inp", "\"quoted\".inp", "$(touch pwned).tab"):
        (made.folder/name).write_text("*NODE\n")
    (made.folder/made.sheet.deck_name).unlink()


def bytes_in_names(made: Made) -> None:
    made.write()
    path = os.path.join(os.fsencode(made.folder), b"\xff\xfe\x80.inp")
    with open(path, "wb") as file:
        file.write(b"\xff\xfe\x00*NODE")


def many_files(made: Made) -> None:
    made.write()
    for place in range(3000):
        (made.folder/f"z{place}.tab").write_text("x")


def deep(made: Made) -> None:
    made.write()
    path = made.folder
    for _ in range(60):
        path = path/"d"
        path.mkdir()
    (path/"summary.tab").write_text("x")


def unreadable(made: Made) -> None:
    made.write()
    (made.folder/"answers.toml").unlink()
    (made.folder/"answers.toml").mkdir()
    (made.folder/"locked").mkdir(mode=0)


def heading(made: Made) -> None:
    made.write()
    deck_ = made.deck.replace("*HEADING\n", f"*HEADING\n{EVIL} `touch pwned` \" ' ; set output '/tmp/pwned'\n")
    (made.folder/made.sheet.deck_name).write_text(deck_)


def error_with_html(made: Made) -> None:
    made.write()
    (made.folder/made.sheet.deck_name).write_text(made.deck + f"\n*{EVIL}\n")


def table_with_html(made: Made) -> None:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_text(f"# columns: {EVIL.replace(' ', '_')} quantity value step pressure s\n{EVIL.replace(' ', '_')} 1 nan 1e999 inf -inf\n")


def wide_table(made: Made) -> None:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_text("# columns: " + "x "*100_000 + "\n" + "1 "*100_000 + "\n")


def long_line(made: Made) -> None:
    made.write()
    for name in made.sheet.tables:
        made.table(name).write_text("9"*15_000_000)


wild_options = options("--refine 9 --set F=1e300 --plot --restart /etc/passwd -o /tmp/pwned")
shell_options = options("--set F=1;touch pwned --solver $(id)")

# what they try has no effect on the points, for the answers are right
LEFT_OUT = (link_to_folder, deep)
HARMLESS = (link_to_folder, bytes_in_names, deep, heading, shell_options)
KINDS: list[Callable[[Made], None]] = [
    html, html_end, formula, formulas, shell, control, turned, nested, long_number, not_numbers, slow_pattern, link_to_secret, link_of_folder,
    link_to_folder, link_of_deck, hard_link, pipe, include("../../secret.txt"), include("/etc/passwd"), include("/dev/zero"), include("/dev/stdin"),
    include_neighbour, include_circle, include_many, deck(BIG_LOOP.format(n=20, steps=1_000_000, first=1e-6)),
    deck(BIG_LOOP.format(n=3000, steps=1, first=1)), deck(BIG_LOOP.format(n=100, steps=100_000, first=1e-5)), deck("\0"*1000), deck("*NODE\n" + "1, 0, 0\n"*200_000),
    sparse_file(""), sparse_file("answers.toml"), wild_options, shell_options, names, bytes_in_names, deep, unreadable, heading, error_with_html, table_with_html,
    wide_table, long_line]
