"""The pages of the book: book.md, a page a case, their pictures; and whether those that are there are up to date."""
import math
import posixpath
import re
import tomllib
from pathlib import Path

from cases import BookError, check_keys, KINDS

ROUND_OFF = 1e-9                               # an error below it is told as such: its digits are those of the machine
MADE = "<!-- made by tests/book/run_book --write: change the case, not the page -->"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])")
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
OUTLINE_ONLY = 20000                           # characters of a picture beyond which inner edges are left out
LONGEST_DECK = 90                              # lines of a deck that a page shows


def read_left_out(book):
    """Cases of the collection that the book does not have, with the reason."""
    path = Path(book)/"left-out.toml"
    if not path.exists():
        return []
    with open(path, "rb") as file:
        given = tomllib.load(file)
    for row in given["case"]:
        check_keys("left-out.toml", row, {"id": str, "title": str, "why": str}, ("id", "title", "why"))
    return given["case"]


def of_value(number, value=None):
    """Seven digits; 0 for what is nothing beside what is allowed where the reference is 0."""
    if number == 0 or value and value.reference == 0 and value.error(number) < value.allowed()/1000:
        return "0"
    rounded = float(f"{number:.7g}")
    return f"{rounded:.0f}" if rounded.is_integer() and abs(rounded) < 1e6 else f"{number:#.7g}".rstrip(".")


def of_error(number, value):
    if value.between is not None:
        return "inside" if number == 0 else f"{number:.1e} of the width outside"
    if number < (ROUND_OFF if value.absolute is None else value.allowed()/1000):
        return "round-off"
    return f"{number:.1e}"


def cell(text):
    return str(text).replace("|", "\\|")


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|"*len(head), *("| " + " | ".join(cell(c) for c in row) + " |" for row in rows)]


def verdict(value, found):
    if value.holds(found):
        return "holds"
    return "**missed**"


def order(value, errors):
    """Order of convergence over the last two meshes; nothing where an error is round-off."""
    if len(errors) < 2 or min(errors[-2:]) < 100*ROUND_OFF or value.between is not None or value.absolute is not None:
        return ""
    return f"{math.log2(errors[-2]/errors[-1]):.1f}"


def reference(value):
    if value.between is not None:
        return f"{value.between[0]:.10g} to {value.between[1]:.10g}"
    return f"{value.reference:.10g}"


def allowed(value):
    if value.between is not None:
        return "inside"
    return f"{value.allowed():.2g}" + ("" if value.absolute is None else " absolute")


def run_tables(case, run, outcomes):
    """What a run found, value by value and mesh by mesh, and the error that the program itself estimates."""
    results = [outcomes[case, run, level] for level in run.refine]
    smooth = bool(case.smooth) and len(run.refine) > 1
    head = ["quantity", "reference", *(f"refine {k}" for k in run.refine), "error", *(["order"] if smooth else []), "allowed", "verdict"]
    rows = []
    for value in case.of_run(run):
        found = [result.found[value] for result in results]
        errors = [value.error(number) for number in found]
        rows.append([value.name, reference(value), *(of_value(number, value) for number in found), of_error(errors[-1], value),
                     *([order(value, errors)] if smooth else []), allowed(value), verdict(value, found[-1])])
    lines = table(head, rows) + [""]
    columns = [("mesh", [f"refine {level}" for level in run.refine])]
    if any(result.counts for result in results):
        for k, name in enumerate(("bodies", "elements", "nodes")):
            columns += [(name, [result.counts[k] if result.counts else "" for result in results])]
    if any(result.estimate is not None for result in results):
        columns += [("estimated error %", [percent(result.estimate) for result in results])]
    if any(result.bound is not None for result in results):
        columns += [("bound of the error %", [percent(result.bound) for result in results])]
    relative = [value for value in case.of_run(run) if value.tolerance is not None]
    true = [max((value.error(result.found[value]) for value in relative), default=math.nan) for result in results]
    columns += [("largest true error of the values %", [percent(100*number) for number in true])]
    columns += [("seconds", [f"{result.seconds:.2f}" for result in results])]
    head, rows = [name for name, _ in columns], zip(*(cells for _, cells in columns))
    return lines + table(head, rows) + [""]


def percent(number):
    if number is None or math.isnan(number):
        return ""
    return "round-off" if number < 100*ROUND_OFF else f"{number:.2g}"


def shown_path(case, file):
    """A file of the case by its name, one that stands elsewhere by its path in the repository."""
    return posixpath.normpath(f"tests/book/{case.folder.name}/{file}") if "/" in file else file


def link(case, file):
    path = posixpath.normpath(f"tests/book/{case.folder.name}/{file}")
    return f"[{shown_path(case, file)}](../../../{path})"


def shown_deck(path):
    lines = path.read_text().rstrip("\n").split("\n")
    if len(lines) > LONGEST_DECK:
        return ["", f"Its {len(lines)} lines are not shown here.", ""]
    return ["", *(("    " + line).rstrip() for line in lines), ""]


def page(case, outcomes):
    """The page of a case."""
    lines = [f"# {case.id} {case.title}", "", MADE, "", f"From {case.origin}: {case.address}", ""]
    if case.picture != "none":
        shows = "mechanism" if case.command else "mesh"
        lines += [f"![The {shows} of {case.id}, displaced]({case.id}.svg)", ""]
    lines += ["## The problem", "", *case.data.strip().split("\n"), ""]
    for deck in case.decks:
        lines += [f"## The deck {link(case, deck)}", *shown_deck(case.folder/deck)]
        included = re.findall(r"(?im)^\*include, *input=(\S+)", (case.folder/deck).read_text())
        if included:
            lines += ["It includes " + " and ".join(link(case, name) for name in included) + ".", ""]
    lines += ["## Results", ""]
    for run in case.runs:
        words = " ".join(["atrito", *run.command, shown_path(case, run.deck), *run.options])
        lines += [f"`{words}` with `--refine` {', '.join(map(str, run.refine))}" +
                  (f", which ends with exit code {run.exit}" if run.exit else "") + ":", "", *run_tables(case, run, outcomes)]
    lines += ["Errors are relative unless marked *absolute*; *allowed* is the tolerance of the test on the finest mesh.", ""]
    if case.note:
        lines += [*case.note.strip().split("\n"), ""]
    lines += ["## The references", ""]
    lines += table(["quantity", "kind", "reference", "published, or found otherwise", "uncertainty", "reason for the tolerance"],
                   [[v.name, v.kind, reference(v), "" if v.second is None else f"{v.second:.10g}", v.uncertainty, v.why] for v in case.values])
    for value in case.values:
        if value.missed:
            lines += ["", f"**Missed:** {value.name}. {value.missed}"]
    if case.left_out:
        lines += ["", "Not computed:", ""]
        for row in case.left_out:
            lines += [f"- {row['name']}" + (f" ({row['reference']:.10g})" if "reference" in row else "") + f": {row['why']}"]
    return "\n".join(lines) + "\n"


def counted(chosen, names, of, first):
    """A table of cases and values, a row a name of what `of` says of a case and a value."""
    rows = []
    for name in names:
        here = [(case, value) for case in chosen for value in case.values if of(case, value) == name]
        rows.append([name, len({case.id for case, _ in here}), len(here), sum(bool(value.missed) for _, value in here)])
    return table([first, "cases", "values", "missed"], rows)


def row_of_case(case, outcomes):
    """Its row in the overview."""
    finest = {run.name: outcomes[case, run, run.refine[-1]] for run in case.runs}
    errors = [value.error(finest[value.run].found[value]) for value in case.values if value.tolerance is not None and not value.missed]
    estimates = [out.estimate for out in finest.values() if out.estimate is not None]
    missed = sum(bool(value.missed) for value in case.values)
    seconds = sum(out.seconds for (of, _, _), out in outcomes.items() if of is case)
    return [f"[{case.id}](book/{case.id}.md)", case.title, case.group, len(case.values), percent(100*max(errors)) if errors else "",
            percent(max(estimates)) if estimates else "", f"{seconds:.1f}", f"{missed} of {len(case.values)} missed" if missed else "holds"]


def overview(chosen, outcomes, left_out):
    """book.md: counts, a row a case, what is left out."""
    values = [value for case in chosen for value in case.values]
    missed = sum(bool(value.missed) for value in values)
    groups = sorted({case.group for case in chosen}, key=str.casefold)
    lines = ["# The book of cases", "", MADE, "",
             f"{len(chosen)} problems with known answers, {len(values)} values from {len(groups)} origins. Each page has the data, the deck, the references",
             f"and the results of atrito, mostly on several meshes. On the finest mesh {len(values) - missed} values are within their tolerance, {missed} are",
             "missed, with the reason on the page. `./check book` runs all cases; it fails if a value leaves its tolerance, or is no longer missed.",
             "[Ten cases beside CalculiX](book/calculix.md): errors and times.", ""]
    lines += counted(chosen, KINDS, lambda case, value: value.kind, "kind of reference") + [""]
    lines += counted(chosen, groups, lambda case, value: case.group, "origin")
    lines += ["", "## The cases", "",
              "The largest error is that of the values with a relative tolerance, on the finest mesh, without missed ones. The estimate is the",
              "program's own, of the stresses in the energy norm. Seconds are processor time of all runs of a case.", ""]
    lines += table(["case", "title", "origin", "values", "largest error %", "estimate %", "seconds", "verdict"],
                   [row_of_case(case, outcomes) for case in chosen])
    lines += ["", "## Left out", "", "Cases of the collection that are not here" + (":" if left_out else ": none. Values of cases that are:"), ""]
    lines += [f"- {row['id']} {row['title']}: {row['why']}" for row in left_out]
    lines += [f"- [{case.id}](book/{case.id}.md) {row['name']}: {row['why']}" for case in chosen for row in case.left_out or []]
    return "\n".join(lines) + "\n"


def all_pages(folder, chosen, outcomes, left_out, everything):
    made = {folder/"book"/f"{case.id}.md": page(case, outcomes) for case in chosen}
    return made | ({folder/"book.md": overview(chosen, outcomes, left_out)} if everything else {})


def write(folder, chosen, outcomes, left_out, lines, everything):
    """Writes pages and pictures, and removes those of cases that are gone."""
    (folder/"book").mkdir(parents=True, exist_ok=True)
    made = all_pages(folder, chosen, outcomes, left_out, everything)
    for path, text in made.items():
        path.write_text(text)
    for case, data in lines.items():
        (folder/"book"/f"{case.id}.svg").write_text(picture(data))
    if everything:
        ids = {case.id for case in chosen}
        for path in list((folder/"book").glob("*.md")) + list((folder/"book").glob("*.svg")):
            if path.stem not in ids and not path.stem.startswith("calculix"):
                path.unlink()


def check(folder, chosen, outcomes, left_out, everything):
    """Complaints about pages that are not what would be written now."""
    complaints = []
    for path, text in all_pages(folder, chosen, outcomes, left_out, everything).items():
        there = path.read_text() if path.exists() else ""
        for k, (old, new) in enumerate(zip(comparable(there) + [""], comparable(text) + [""])):
            if not same_line(old, new):
                complaints.append(f"{path.name}, line {k + 1}: run_book --write makes another one\n   there: {old[:300]}\n   now:   {new[:300]}")
                break
    for case in chosen:
        if case.picture != "none" and not (folder/"book"/f"{case.id}.svg").exists():
            complaints.append(f"{case.id}.svg is not there")
    return complaints


def comparable(text):
    """Lines without the cells of seconds."""
    lines, column = [], None
    for line in text.split("\n"):
        cells = line.split(" | ")
        if not line.startswith("|"):
            column = None
        elif "seconds" in line:
            column = next((k for k, word in enumerate(cells) if word.strip("| ") == "seconds"), column)
        elif column is not None and len(cells) > column:
            cells[column] = ""
        lines.append(" | ".join(cells))
    return lines


def same_line(old, new):
    """The same words, and numbers to the digits that rounding leaves alone; of errors, which have few, those below 1e-4 are alike."""
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return False
    return all(near(a, b) for a, b in zip(NUMBER.findall(old), NUMBER.findall(new)))


def near(old, new):
    digits = len(re.sub(r"e.*|\D", "", old).lstrip("0"))
    a, b = float(old), float(new)
    return abs(a - b) <= 1e-4*max(abs(a), abs(b)) or digits <= 4 and (abs(a - b) <= 0.05*max(abs(a), abs(b)) or max(abs(a), abs(b)) < 1e-4)


def picture(path, width=480.0):
    """An SVG of the data of a picture of the program: polylines of each body, displaced as much as can be seen."""
    if not path.exists():
        raise BookError(f"{path}: no data for the picture")
    bodies = []                                # (title, polylines)
    for line in path.read_text().splitlines():
        if line.startswith(("# block", "# a rigid surface")):
            bodies.append((line, [[]]))
        elif not line.startswith("#") and bodies:
            words = line.split()
            if words:
                bodies[-1][1][-1].append([float(word) for word in words[:4]])
            elif bodies[-1][1][-1]:
                bodies[-1][1].append([])
    points = [p for _, polylines in bodies for polyline in polylines for p in polyline]
    size = math.hypot(max(p[0] for p in points) - min(p[0] for p in points), max(p[1] for p in points) - min(p[1] for p in points))
    largest = max(math.hypot(*p[2:4]) for p in points)
    scale = 0.04*size/largest if largest > 0 else 0.0
    if scale > 0:
        scale = 10**math.floor(math.log10(scale))*max(m for m in (1, 2, 5) if m*10**math.floor(math.log10(scale)) <= scale)
    low = [min(p[k] + scale*p[k + 2] for p in points) for k in (0, 1)]
    high = [max(p[k] + scale*p[k + 2] for p in points) for k in (0, 1)]
    unit = min(width/max(high[0] - low[0], 1e-300), width/max(high[1] - low[1], 1e-300))
    text = svg(bodies, low, high, unit, scale, True)
    return text if len(text) < OUTLINE_ONLY else svg(bodies, low, high, unit, scale, False)


def svg(bodies, low, high, unit, scale, inner):
    """Paths in tenths of pixels, a body and kind of line each."""
    def place(p):
        return 10 + unit*(p[0] + scale*p[2] - low[0]), 10 + unit*(high[1] - p[1] - scale*p[3])
    wide, tall = round(20 + unit*(high[0] - low[0])), round(42 + unit*(high[1] - low[1]))
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{max(wide, 260)}" height="{tall}">',
             f'<rect width="{max(wide, 260)}" height="{tall}" fill="white"/>']
    for title, polylines in bodies:
        outline = "edges inside" not in title
        if not (outline or inner):
            continue
        body = re.search(r"body (\d+)", title)
        steps = []
        for polyline in polylines:
            way = simplified([place(p) for p in polyline]) if polyline else []
            if len(way) > 1:
                steps.append("M" + "L".join(f"{x:.1f},{y:.1f}" for x, y in way))
        colour = COLOURS[(int(body[1]) - 1) % len(COLOURS)] if body else "#808080"
        lines.append(f'<path fill="none" stroke="{colour}" stroke-width="{1.6 if outline else 0.5}" d="{"".join(steps)}"/>')
    lines.append(f'<text x="10" y="{tall - 8}" font-family="sans-serif" font-size="12">displacements drawn {scale:g} times</text>')
    return "\n".join(lines) + "\n</svg>\n"


def simplified(way):
    """A way in pixels without points that lie within half a pixel of the line between those that are left."""
    if len(way) < 3:
        return way if way[0] != way[-1] else way[:1]
    (x, y), (dx, dy) = way[0], (way[-1][0] - way[0][0], way[-1][1] - way[0][1])
    length = math.hypot(dx, dy)
    away = [abs((p[0] - x)*dy - (p[1] - y)*dx)/length if length else math.hypot(p[0] - x, p[1] - y) for p in way]
    k = max(range(len(way)), key=away.__getitem__)
    if away[k] < 0.5:
        return [way[0], way[-1]]
    return simplified(way[:k + 1]) + simplified(way[k:])[1:]
