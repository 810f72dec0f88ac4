"""The gallery, docs/user/gallery.md: a picture of each deck of input/ (gallery.toml) and of each case of the book, and a way to both."""
import os
import re
import tomllib
from pathlib import Path

from cases import check_keys

MADE = "<!-- made by tests/book/run_book --write: change tests/book/gallery.toml, not the page -->"
HEAD = """# Gallery

*For those who look for a deck to begin with. After it you have found one near to your scene.*

Every deck of `input/` and every case of the [book](../verification/book.md), meshes displaced. A click on a picture or a name leads to what is said of it.
"""
WIDTH = 220                                    # of a picture [pixels]


def read(book):
    """Rows of gallery.toml: deck, section (kept until another one is given), page, text, options; none where it is not there."""
    path = Path(book)/"gallery.toml"
    if not path.exists():
        return []
    rows = tomllib.loads(path.read_text())["deck"]
    for row in rows:
        check_keys("gallery.toml", row, {"deck": str, "section": str, "page": str, "text": str, "options": list}, ("deck", "page", "text"))
    return rows


def name_of(row):
    return re.sub(r"\W+", "-", row["deck"].removeprefix("input/").removesuffix(".inp"))


def picture(row):
    return f"figures/gallery/{name_of(row)}.svg"


def entry(image, link, name, text):
    return f'| [<img src="{image}" width="{WIDTH}" alt="{name}">]({link}) | [**{name}**]({link}) {text} |'


def page(rows, cases):
    lines = [HEAD]
    for row in rows:
        if "section" in row:
            lines += [f"\n## {row['section']}\n", "| | |", "|---|---|"]
        deck = f"../../{row['deck']}"
        lines += [entry(picture(row), row["page"], row["deck"].rpartition("/")[2], f"{row['text']} ([deck]({deck}))")]
    lines += ["\n## The book of cases\n", "| | |", "|---|---|"]
    for case in cases:
        link = f"../verification/book/{case.id}.md"
        if case.picture != "none":
            lines += [entry(link.replace(".md", ".svg"), link, case.id, f"{case.title} ({case.group})")]
    return MADE + "\n\n" + "\n".join(lines) + "\n"


def write(book, folder, cases, draw):
    """Writes page and pictures into docs/user; draw: the SVG of a row."""
    rows = read(book)
    (folder/"figures"/"gallery").mkdir(parents=True, exist_ok=True)
    for path in (folder/"figures"/"gallery").glob("*.svg"):
        path.unlink()
    for row in rows:
        (folder/picture(row)).write_text(draw(row))
    (folder/"gallery.md").write_text(page(rows, cases))


def check(book, folder, cases, top):
    """Complaints: decks of input/ that are not there, pictures that are missing, a page that is not up to date."""
    rows = read(book)
    if not rows:
        return []
    listed = {row["deck"] for row in rows}
    there = {os.path.relpath(path, top) for path in Path(top, "input").rglob("*.inp")}
    complaints = [f"gallery.toml has not {deck}" for deck in sorted(there - listed)]
    complaints += [f"gallery.toml: there is no {deck}" for deck in sorted(listed - there)]
    complaints += [f"{picture(row)} is not there" for row in rows if not (folder/picture(row)).exists()]
    path = folder/"gallery.md"
    if not path.exists() or path.read_text() != page(rows, cases):
        complaints.append("gallery.md: run_book --write makes another one")
    return complaints
