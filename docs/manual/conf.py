"""Sphinx' configuration of the manual: the pages of docs/ in the order of docs/README.md, whose lists are its tables of contents.

Formulas become MathML, which browsers draw without a script. Keywords, options, messages, tables and words of the glossary go into the
index; where a page names a keyword or a message, it has a link there."""
import re
from importlib.util import find_spec
from os.path import abspath, dirname, exists, normpath

from docutils import nodes
from docutils.transforms import Transform
from docutils.utils.math import MathError, latex2mathml
from sphinx import addnodes
from sphinx.util import logging

with open(f"{dirname(abspath(__file__))}/../../CMakeLists.txt", encoding="utf-8") as file:
    release = re.search(r"project\(atrito VERSION (\S+)", file.read())[1]
project = "atrito"
author = "the atrito authors"
html_title = f"atrito {release}"
root_doc = "docs/README"
include_patterns = ["[A-Z]*.md", "docs/**.md", "output/reference/README.md", "tests/tools/hostile/README.md"]
exclude_patterns = ["build", "src", ".git", "README.md"]
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath", "html_image"]
myst_dmath_double_inline = True
myst_heading_anchors = 4
highlight_language = "none"
html_theme = "furo" if find_spec("furo") else "alabaster"
html_static_path = ["manual.css"]
html_css_files = ["manual.css"]
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
html_show_sphinx = False

KEYWORDS, MESSAGES, OPTIONS, TABLES = "docs/user/keywords", "docs/user/messages", "docs/user/running", "docs/user/tables"
GLOSSARY, BOOK = "docs/labs/glossary", "docs/verification/book"
MESSAGE = re.compile(r"\b[EWN]-[A-Z]+(?:-[A-Z]+)*\b")
OPTION = re.compile(r"(--[a-z][a-z-]+)")
ACCENT = re.compile(r"<munderover>\s*(<mi>[^<]*</mi>)\s*((?:(?!</?munderover>).)*?)(<mo stretchy=\"false\">[ˆˉ˜˙]</mo>)\s*</munderover>", re.S)


def drop_links(app, docname, source):
    """A link to a page of the sources that is not in the manual is its words alone; a link that leads nowhere is left, and told."""
    def words(link):
        page = normpath(f"{dirname(docname)}/{link[2]}")
        return link[1] if page not in app.env.found_docs and exists(f"{app.srcdir}/{page}.md") else link[0]
    source[0] = re.sub(r"\[([^\]]*)\]\(([^):#]*)\.md(?:#[^)]*)?\)", words, source[0])


def add_contents(_, docname, source):
    """Behind each list of the root page a table of contents, under the heading of the list; in the book one of its pages."""
    if docname == BOOK:
        pages = dict.fromkeys(re.findall(r"\]\((book/[\w-]+)\.md\)", source[0]))
        source[0] += "\n\n```{toctree}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"
    if docname != root_doc:
        return
    parts = source[0].split("\n## ")
    for k, part in enumerate(parts[1:], 1):
        pages = re.findall(r"^- \[(.*?)\]\((.*?)\.md\)", part, re.M)
        entries = "\n".join(f"{title} </{normpath('docs/' + page)}>" for title, page in pages)
        caption = part.split("\n")[0]
        parts[k] = f"{part}\n\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{entries}\n```\n"
    source[0] = "\n## ".join(parts) + "\n```{toctree}\n:hidden:\n:caption: Index\n\nIndex </genindex>\n```\n"


class Titles(Transform):
    """A link that is called like the file of its page gets the title of the page; a heading has no link to a file."""

    default_priority = 400

    def apply(self):
        for link in self.document.findall(addnodes.pending_xref):
            if re.fullmatch(r"[\w./-]+\.md", link.astext()):
                link["refexplicit"] = False
        for title in self.document.findall(nodes.title):
            for link in list(title.findall(addnodes.download_reference)):
                link.replace_self(link.children)


class Index(Transform):
    """Entries of the index, and places of messages in lists, of options and words in tables."""

    default_priority = 400

    def apply(self):
        docname = self.document.settings.env.docname
        if docname in (KEYWORDS, TABLES):
            for section in self.document.findall(nodes.section):
                title = section[0].astext().removesuffix(" +")
                if docname == KEYWORDS and title.startswith("*"):
                    self.enter(section, section["ids"][0], title, "keyword")
                elif docname == TABLES and title.endswith(".tab"):
                    self.enter(section, section["ids"][0], title, "table")
        for item in list(self.document.findall(nodes.list_item)) if docname == MESSAGES else ():
            for name in [bold.astext() for bold in item.findall(nodes.strong)]:
                if MESSAGE.fullmatch(name):
                    item["ids"].append(name)
                    self.enter(item, name, name, "message")
        for row in self.document.findall(nodes.row):
            first = row[0].astext()
            for kind, names in (("option", OPTION.findall(first)[:1] if docname == OPTIONS else ()),
                                ("word", [first] if docname == GLOSSARY and not isinstance(row.parent, nodes.thead) else ())):
                for name in names:
                    place = nodes.make_id(name)
                    row[0]["ids"].append(place)
                    self.enter(row[0], place, name, kind)

    @staticmethod
    def enter(node, place, name, kind):
        entries = [("single", f"{name} ({kind})" if kind != "word" else name, place, "", None)]
        node.insert(1 if isinstance(node, nodes.section) else 0, addnodes.index(entries=entries))


def add_links(app, doctree, docname):
    """Names of keywords between backticks, and of messages, are links to their descriptions."""
    known = app.env.metadata.setdefault("places of names", {})
    if not known:
        for entries in (app.env.get_doctree(page).findall(addnodes.index) for page in (KEYWORDS, MESSAGES) if page in app.env.all_docs):
            for entry in (entry["entries"][0] for entry in entries):
                known[entry[1].split(" (")[0]] = (KEYWORDS if entry[1].startswith("*") else MESSAGES, entry[2])
    for literal in list(doctree.findall(nodes.literal)):
        name = re.match(r"\*[A-Z -]*[A-Z]|[EWN]-[A-Z-]+$", literal.astext())
        link_to(app, docname, literal, known.get(name.group() if name else None))
    for text in list(doctree.findall(nodes.Text)):
        pieces = re.split(f"({MESSAGE.pattern})", text)
        if len(pieces) == 1 or within(text, (nodes.literal, nodes.literal_block, nodes.reference, nodes.title, nodes.FixedTextElement)):
            continue
        fresh = [nodes.Text(piece) for piece in pieces if piece]
        text.parent.replace(text, fresh)
        for piece in fresh:
            link_to(app, docname, piece, known.get(str(piece)))


def within(node, kinds):
    while node.parent is not None:
        node = node.parent
        if isinstance(node, kinds):
            return True
    return False


def link_to(app, docname, node, place):
    """Puts a node into a reference, unless it stands in one or at the place itself."""
    if place is None or place[0] == docname == MESSAGES or within(node, (nodes.reference, nodes.title)):
        return
    reference = nodes.reference("", "", internal=True, refuri=f"{app.builder.get_relative_uri(docname, place[0])}#{place[1]}")
    node.parent.replace(node, reference)
    reference.append(node)


def draw_formula(translator, node):
    """A formula as MathML, with its number at the right."""
    is_display = isinstance(node, nodes.math_block)
    text, *number = re.split(r"\\tag\{(.*?)\}", node.astext().rstrip())
    text = re.sub(r"(\\t?frac)(\d)(\d)", r"\1{\2}{\3}", text)  # which docutils takes for 12 over what follows
    try:
        formula = latex2mathml.tex2mathml(text, as_block=is_display)
    except MathError as error:
        logging.getLogger(__name__).warning("%s: %s", error, text, location=node)
        formula = ""
    formula = ACCENT.sub(r"<msub><mover>\1\3</mover>\2</msub>", formula)
    formula = re.sub(r"<mo[^>]*>([/|])</mo>", r'<mo lspace="0" rspace="0" stretchy="false">\1</mo>', formula)
    number = f"<span>({number[0]})</span>" if number else ""
    translator.body.append(f'<div class="formula"><div>{formula}</div>{number}</div>' if is_display else formula)
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (draw_formula, None), (draw_formula, None))
    app.config.html_math_renderer = "mathml"
    app.add_transform(Titles)
    app.add_transform(Index)
    app.connect("source-read", drop_links)
    app.connect("source-read", add_contents)
    app.connect("doctree-resolved", add_links)
