"""Trying a sheet: the model answer has full marks, and each listed mistake the reason that it should have."""

from __future__ import annotations

import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .diagnose import Case
from .mark import Marking, mark_all
from .people import Student
from .program import Keeper, Limits, run_atrito
from .references import Reference
from .sheet import Mistake, Sheet, mistaken_deck

NUMBERS = ("1001", "1002", "1003")


def check_sheet(sheet: Sheet, program: str, limits: Limits, jobs: int) -> list[str]:
    """Complaints about a sheet; none if it is right."""
    with tempfile.TemporaryDirectory(prefix="atrito-lab-") as work:
        keeper = Keeper(program, Path(work)/"references", limits)

        def attempt(item: tuple[str, Mistake | None]) -> list[str]:
            place = Path(tempfile.mkdtemp(dir=work))
            marking = Marking(sheet, program, limits, 1, keeper, place)
            number, mistake = item
            complaints = make_hand_in(marking, number, mistake, place/"hand-in")
            case = mark_all(marking, [(Student(number), place/"hand-in")])[0]
            return complaints + (judge_mistake(case, mistake) if mistake else judge_model(case))

        with ThreadPoolExecutor(jobs) as pool:
            tried = [*((number, None) for number in NUMBERS), *((NUMBERS[0], mistake) for mistake in sheet.mistakes)]
            return [complaint for complaints in pool.map(attempt, tried) for complaint in complaints]


def make_hand_in(marking: Marking, number: str, mistake: Mistake | None, folder: Path) -> list[str]:
    """A hand-in as the model answer has it, or as somebody with a mistake."""
    sheet = marking.sheet
    reference = Reference(sheet, marking.keeper, number)
    folder.mkdir()
    in_deck = mistake is not None and not mistake.observe
    deck = mistaken_deck(sheet, mistake, reference.drawn) if in_deck and mistake else sheet.complete_deck(reference.drawn)
    (folder/sheet.deck_name).write_text(deck)
    words = [sheet.deck_name, "-o", "output", "--quiet", "--messages", "json"]
    run = run_atrito(marking.program, words, folder, marking.limits, folder/"output")
    place = sheet.mistakes.index(mistake) if mistake else 0
    lines = []
    for quantity in sheet.quantities:
        value = reference.value(quantity)
        if mistake and (in_deck or mistake.quantity == quantity.name):
            wrong = reference.mistaken(mistake, place, quantity)
            value = value if wrong is None else wrong
        lines.append(f"{quantity.name} = {value:.6g}\n")
    lines += [f'{explanation.name} = """{explanation.good}"""\n' for explanation in sheet.explanations]
    (folder/"answers.toml").write_text("".join(lines))
    if run.code:
        return [] if in_deck else [f"the deck with the values of {number} ends with {run.code}: {run.error}"]
    for name in sheet.tables:
        if not (folder/"output"/f"{name}.tab").is_file():
            return [f"the deck writes no table {name}, which is to be handed in"]
    shutil.rmtree(folder/"output"/"plots", ignore_errors=True)
    return []


def judge_model(case: Case) -> list[str]:
    """What the model answer does not have full points for."""
    return [f"the model answer of {case.hand_in.number}: {verdict.name} has {verdict.points:g} of {verdict.of:g}: "
            f"{verdict.kind}: {verdict.reason}"
            for verdict in case.verdicts if verdict.points < verdict.of or verdict.kind not in ("right", "lecturer")]


def judge_mistake(case: Case, mistake: Mistake) -> list[str]:
    """Whether a mistake is recognised."""
    wanted = "exchanged" if mistake.kind == "exchanged" else f"mistake:{mistake.name}"
    kinds = [verdict.kind for verdict in case.verdicts if not mistake.quantity or verdict.name == mistake.quantity]
    told = ", ".join(f"{verdict.name}: {verdict.kind}" for verdict in case.verdicts)
    return [] if wanted in kinds else [f"mistake {mistake.name} is not recognised ({told}). {case.deck_reason}"]
