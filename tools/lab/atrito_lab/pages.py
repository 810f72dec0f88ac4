"""Pages in HTML: one for each student, one for the lecturer. Each is one file, without scripts, and all text in it is escaped."""

from __future__ import annotations

import html
import math
import re
from collections import Counter
from pathlib import Path

from .diagnose import Case, Verdict
from .handin import file_name, shown, text_of
from .sheet import Sheet
from .tables import Cell, Table, TableError, number, read_table, rows_of

STYLE = Path(__file__).with_name("style.css").read_text(encoding="utf-8")


def say(text: object) -> str:
    """A text for HTML: escaped, without control characters."""
    return html.escape("".join(letter if letter.isprintable() or letter == "\n" else "\ufffd" for letter in str(text)))


def asked(text: str) -> str:
    """What is asked for, in HTML: options of the program are not broken behind their dashes."""
    return re.sub(r"(--\w+)", r"<span class=whole>\1</span>", say(text))


def page(title: str, body: list[str]) -> str:
    """A page; its policy lets nothing be fetched or run."""
    return "\n".join([
        "<!doctype html>", '<html lang="en">', "<head>", '<meta charset="utf-8">',
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; style-src \'unsafe-inline\'">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">', f"<title>{say(title)}</title>", f"<style>{STYLE}</style>",
        "</head>", "<body>", *body, "</body>", "</html>", ""])


def table_of(heads: list[str], rows: list[list[str]], right: set[int]) -> list[str]:
    """A table; `right` are the columns of numbers. The words of the cells are HTML already."""
    kinds = [" class=n" if place in right else "" for place in range(len(heads))]
    lines = ["<table>", "<thead><tr>", *(f"<th{kind}>{say(head)}</th>" for kind, head in zip(kinds, heads)), "</tr></thead>", "<tbody>"]
    for row in rows:
        lines += ["<tr>", *(f'<td data-l="{say(head)}"{kind}>{word}</td>' for kind, head, word in zip(kinds, heads, row)), "</tr>"]
    return [*lines, "</tbody>", "</table>"]


def mood(verdict: Verdict) -> str:
    """Class of a verdict by its points."""
    return "good" if verdict.points >= verdict.of else "part" if verdict.points > 0 else "bad"


def value_in_words(value: float | None, unit: str) -> str:
    """A number with its unit, for HTML."""
    return "" if value is None else say(f"{value:.5g} {unit}".strip())


def write_feedback(case: Case, path: Path) -> None:
    """The page of a student."""
    sheet, hand_in = case.sheet, case.hand_in
    body = [f"<h1>{say(sheet.title)}</h1>", f"<p class=soft>{say(hand_in.name)} {say(hand_in.number)}</p>",
            f"<p class=total>{case.points:g} of {sheet.points:g} points</p>"]
    notes = [text for text in (case.deck_reason if case.deck_kind != "right" else "", case.values_reason, *hand_in.notes) if text]
    if notes:
        body += ["<ul>", *[f"<li>{say(note)}</li>" for note in notes], "</ul>"]
    rows = [[asked(verdict.text), value_in_words(verdict.value, verdict.unit), value_in_words(verdict.right, verdict.unit),
             f'<span class={mood(verdict)}>{verdict.points:g}</span> / {verdict.of:g}', say(verdict.reason)] for verdict in case.verdicts]
    body += ["<h2>Points</h2>", *table_of(["Asked", "Yours", "Right", "Points", "Why"], rows, {1, 2, 3})]
    body += picture_of(case)
    values = [[say(item.name), say(f"{case.reference.drawn[item.name]} {item.unit}"), say(item.text)] for item in sheet.parameters]
    body += ["<h2>Your values</h2>", *table_of(["", "Value", ""], values, {1})] if values else []
    for explanation in sheet.explanations:
        text = text_of(hand_in.answers.get(explanation.name.lower()))
        if text:
            body += [f"<h2>{asked(explanation.text)}</h2>", f"<div class=text>{say(text)}</div>"]
    path.write_text(page(f"{sheet.name}: {hand_in.number}", body), encoding="utf-8")


# ---- pictures ----

def curve_of(table: Table, picture: dict[str, str]) -> list[tuple[float, float]]:
    """Points of a picture, from the rows of a table at its step."""
    rows = rows_of(table, Cell(picture["table"], picture["y"]), int(picture["step"]) or None)
    across, up = table.column(picture["x"]), table.column(picture["y"])
    points = [(number(row[across]), number(row[up])) for row in rows]
    return sorted(point for point in points if all(map(math.isfinite, point)))[:5000]


def picture_of(case: Case) -> list[str]:
    """The student's curve over that of the reference, where the sheet has a picture."""
    picture = case.sheet.picture
    if not picture:
        return []
    reference = curve_of(case.reference.tables().table(picture["table"]), picture)
    own: list[tuple[float, float]] = []
    trouble = ""
    try:
        given = case.hand_in.tables.get(picture["table"])
        own = curve_of(read_table(given), picture) if given else []
    except TableError as error:
        trouble = f" Yours cannot be drawn: {error}."
    return [f"<h2>{say(picture['text'])}</h2>", *draw(reference, own, picture),
            f"<p class=soft>Line with points: your table {say(picture['table'])}{'' if own else ' (there is none to draw)'}. "
            f"Dashed: the reference, {say(picture['y'])} over {say(picture['x'])} with your values.{say(trouble)}</p>"]


def ticks(low: float, high: float) -> list[float]:
    """Round numbers from below `low` to above `high`, 1, 2 or 5 times a power of ten apart."""
    size = 10.0**math.floor(math.log10((high - low)/4))
    step = next(size*factor for factor in (1, 2, 5, 10) if (high - low)/(size*factor) <= 5)
    first, last = math.floor(low/step + 1e-9), math.ceil(high/step - 1e-9)
    return [place*step for place in range(first, last + 1)]


def not_zero(curve: list[tuple[float, float]], least: float) -> list[float]:
    """The ends of the part of a curve that is not zero, with a zero on each side."""
    counted = [place for place, (_, y) in enumerate(curve) if abs(y) > least]
    return [curve[max(0, counted[0] - 1)][0], curve[min(counted[-1] + 1, len(curve) - 1)][0]] if counted else []


def draw(reference: list[tuple[float, float]], own: list[tuple[float, float]], picture: dict[str, str]) -> list[str]:
    """Two curves as a drawing (SVG), where one of them is not zero."""
    top = max((abs(y) for _, y in reference), default=0.0) or 1.0
    ends = [place for curve in (reference, own) for place in not_zero(curve, 1e-3*top) if reference[0][0] <= place <= reference[-1][0]]
    left, right = min(ends, default=reference[0][0]), max(ends, default=reference[-1][0])
    across = ticks(left, right if right > left else left + 1.0)
    left, right = across[0], across[-1]
    heights = [0.0, *(y for x, y in [*reference, *own] if left <= x <= right and abs(y) < 3*top)]
    up = ticks(min(heights), max(*heights, min(heights) + 1e-9*top))
    low, span = up[0], up[-1] - up[0]

    def place(x: float, y: float) -> tuple[float, float]:
        return 70 + 610*(x - left)/(right - left), 280 - 255*(y - low)/span

    lines = ['<svg viewBox="0 0 700 325" role="img">', '<clipPath id="inside"><rect x="66" y="20" width="620" height="264"/></clipPath>']
    for y in up:
        height = place(left, y)[1]
        lines.append(f'<line class=grid x1="70" x2="680" y1="{height:.1f}" y2="{height:.1f}"/>'
                     f'<text x="64" y="{height + 4:.1f}" text-anchor="end">{y:.4g}</text>')
    lines += [f'<text x="{place(x, 0)[0]:.1f}" y="300" text-anchor="middle">{x:.4g}</text>' for x in across]
    lines += [f'<text x="375" y="320" text-anchor="middle">{say(picture["x"])}</text>', f'<text x="70" y="14">{say(picture["y"])}</text>',
              '<polyline class=axis points="70,25 70,280 680,280"/>', '<g clip-path="url(#inside)">']
    for kind, curve in (("own", own), ("ref", reference)):
        points = [place(x, y) for x, y in curve if abs(y) < 1e3*top]
        lines.append(f'<polyline class={kind} points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}"/>')
        if kind == "own" and len(points) <= 500:
            lines += [f'<circle class=own cx="{x:.1f}" cy="{y:.1f}" r="3"/>' for x, y in points if 66 <= x <= 686]
    return [*lines, "</g>", "</svg>"]


# ---- the lecturer's page ----

def write_lecturer(sheet: Sheet, cases: list[Case], strange: list[str], path: Path) -> None:
    """The page of the lecturer."""
    points = [case.points for case in cases]
    body = [f"<h1>{say(sheet.title)}</h1>",
            f"<p class=total>{len(cases)} hand-ins, {sum(points)/len(points):.1f} of {sheet.points:g} points in the mean</p>",
            "<h2>Points of the class</h2>", *histogram(points, sheet.points)]
    body += ["<h2>What failed most</h2>", *failures(cases)]
    alike = hand_ins_alike(cases)
    body += ["<h2>Hand-ins that are alike</h2>", *(["<ul>", *[f"<li>{say(line)}</li>" for line in alike], "</ul>"] if alike else ["<p>None.</p>"])]
    if strange:
        body += ["<h2>Of nobody in the class</h2>", f"<p>{say(', '.join(strange[:50]))}</p>"]
    rows = [[f'<a href="students/{file_name(case.hand_in.number)}/feedback.html">{say(case.hand_in.number)}</a>',
             say(case.hand_in.name), f"{case.points:g}", say(summary(case))] for case in cases]
    body += ["<h2>The class</h2>", *table_of(["Number", "Name", "Points", "What was not right"], rows, {2})]
    for explanation in sheet.explanations:
        body += [f"<h2>To read: {asked(explanation.text)}</h2>", f"<p class=soft>A good answer: {say(explanation.good)}</p>"]
        for case in cases:
            text = text_of(case.hand_in.answers.get(explanation.name.lower()))
            if text:
                body += [f"<p class=soft>{say(case.hand_in.number)} {say(case.hand_in.name)}</p>", f"<div class=text>{say(text)}</div>"]
    path.write_text(page(f"{sheet.name}: the class", body), encoding="utf-8")


def histogram(points: list[float], most: float) -> list[str]:
    """Ten bars, and the points between them."""
    counts = Counter(min(9, int(10*value/most)) if most else 0 for value in points)
    tallest = max(counts.values())
    lines = ['<svg viewBox="0 -10 700 225" role="img">']
    for place in range(10):
        count = counts.get(place, 0)
        height = 160*count/tallest
        lines.append(f'<rect class=bar x="{20 + 66*place}" y="{180 - height:.1f}" width="60" height="{height:.1f}"/>'
                     f'<text x="{50 + 66*place}" y="{174 - height:.1f}" text-anchor="middle">{count or ""}</text>')
    lines += [f'<text x="{17 + 66*place}" y="200" text-anchor="middle">{most*place/10:.3g}</text>' for place in range(11)]
    return [*lines, "</svg>"]


def failures(cases: list[Case]) -> list[str]:
    """The items by the points lost, and why."""
    rows = []
    for place, first in enumerate(cases[0].verdicts):
        all_ = [case.verdicts[place] for case in cases]
        kinds = Counter(verdict.kind for verdict in all_ if verdict.points < verdict.of)
        lost = sum(verdict.of - verdict.points for verdict in all_)
        if kinds:  # so the item has points
            rows.append((lost/first.of, [asked(first.text), str(sum(kinds.values())), f"{100*lost/(first.of*len(all_)):.0f} %",
                                say(", ".join(f"{kind} {count}" for kind, count in kinds.most_common()))]))
    rows.sort(key=lambda row: -row[0])
    return table_of(["Item", "Not full", "Points lost", "Reasons"], [row for _, row in rows], {1, 2}) if rows else ["<p>Nothing.</p>"]


def summary(case: Case) -> str:
    """What was not right, in a line."""
    if not case.hand_in.there:
        return "nothing handed in"
    kinds: dict[str, list[str]] = {}
    for verdict in case.verdicts:
        if verdict.points < verdict.of:
            kinds.setdefault(verdict.kind, []).append(verdict.name)
    parts = [f"{kind}: {', '.join(names)}" for kind, names in kinds.items()]
    extra = [case.deck_reason] if case.deck_kind not in ("right", "missing") else []
    extra += [f"values of {case.neighbour}"] if case.neighbour else []
    return shown("; ".join([*extra, *parts]), 300)


def hand_ins_alike(cases: list[Case]) -> list[str]:
    """Who has the same tables, or explains in the same words."""
    lines = []
    tables: dict[str, list[str]] = {}
    for case in cases:
        for name in case.sheet.tables:
            if name in case.hand_in.tables:
                body = [line for line in case.hand_in.tables[name].read_bytes().splitlines() if not line.startswith(b"#")]
                tables.setdefault(f"{name} {hash(tuple(body))}", []).append(case.hand_in.number)
    for key, numbers in tables.items():
        if len(numbers) > 1 and any(case.states[key.split()[0]].table for case in cases if case.hand_in.number in numbers):
            lines.append(f"{', '.join(numbers)}: the same table {key.split()[0]}")
    return lines + texts_alike(cases)


def texts_alike(cases: list[Case]) -> list[str]:
    """Students whose explanations share most of their words in order, together with those who share them with one of these."""
    lines = []
    for explanation in cases[0].sheet.explanations if cases else []:
        groups: list[set[str]] = []
        pieces = [(case.hand_in.number, _pieces(text_of(case.hand_in.answers.get(explanation.name.lower())))) for case in cases]
        for place, (number_, mine) in enumerate(pieces):
            for other, theirs in pieces[place + 1:]:
                least = min(len(mine), len(theirs))
                if least >= 8 and len(mine & theirs) >= 0.6*least:
                    joined = {number_, other}.union(*(group for group in groups if group & {number_, other}))
                    groups = [group for group in groups if not group & joined] + [joined]
        lines += [f"{', '.join(sorted(group))}: {explanation.name}, mostly in the same words" for group in groups]
    return lines


def _pieces(text: str) -> set[str]:
    """All runs of four words of a text."""
    words = "".join(letter.lower() if letter.isalnum() else " " for letter in text).split()
    return {" ".join(words[place:place + 4]) for place in range(len(words) - 3)}
