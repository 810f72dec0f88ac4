"""Runs curved scenes and judges what atrito says of them.

run_curved_scenes.py ATRITO FIRST LAST SEED [-j N] [--folder DIR] [--only N,N,..] [--one K [--write FILE]] [options of atrito]

Right is exit 0 where the smooth shapes can balance the loads, with tables that curved_judge.py accepts, W-IDLE where a motion is free
and nowhere else, and the same pressures with weak springs; and exit 4 where nothing balances the loads. `ambiguous` are scenes of
which the smooth shapes do not tell (a roller turned by a moment, which its faces may hold and a circle may not): they are not counted
for their exit code. `open`: exit 3 with friction, of loads that can be balanced. Prints what is wrong with its reason, and a table by
kind; DIR (./curved) has the decks and results.txt.
Exit code 0 when nothing is wrong.
"""

import argparse
import multiprocessing
import os
import shutil
import sys
import time

sys.dont_write_bytecode = True  # the sources stay as they are
import curved_judge
import curved_scenes
from run_scenes import chosen_numbers, message, run


class Outcome:
    def __init__(self, number):
        self.number, self.code, self.seconds = number, None, 0.0
        self.word, self.reasons, self.kind, self.notes, self.numbers = '', [], '', '', {}

    def line(self):
        code = 'none' if self.code is None else self.code
        return f'{self.number} {code} {self.word} {self.seconds:.3f} "{self.kind}: {self.notes}" ' + '; '.join(self.reasons)


def judge_number(work):
    settings, number = work
    outcome = Outcome(number)
    base = os.path.join(settings.folder, str(os.getpid()))
    os.makedirs(base, exist_ok=True)
    path = os.path.join(base, 'deck.inp')
    try:
        scene = curved_scenes.make(number, settings.seed)
        outcome.kind, outcome.notes = scene.kind, ', '.join(scene.notes)
        give_verdict(settings, outcome, scene, path, base)
    except Exception as trouble:  # a fault of the judge must not stop the others
        outcome.word, outcome.reasons = 'wrong', [f'the judge failed: {trouble!r}']
    if outcome.word in ('wrong', 'unsolved', 'open'):
        shutil.copy(path, os.path.join(settings.folder, f'{number}.inp'))
    return outcome


def run_deck(settings, text, path, folder):
    with open(path, 'w') as file:
        file.write(text)
    return run(settings.atrito, path, folder, settings.options)


def give_verdict(settings, outcome, scene, path, base):
    balanced, least = scene.balanced()
    outcome.code, said, outcome.seconds = run_deck(settings, scene.deck(), path, os.path.join(base, 'out'))
    if outcome.code == 0:
        verdict = curved_judge.judge_run(scene, os.path.join(base, 'out'), said, least)
        outcome.reasons += verdict.wrong[:4]
        if balanced == 'no':
            outcome.reasons.insert(0, 'exit 0 where nothing balances the loads')
        elif not any(word in said for word in ('E-',)):
            compare(settings, outcome, scene, verdict, base)
        outcome.numbers = verdict.numbers
        unsure = verdict.unsure + ['whether the loads balance']*(balanced == 'unsure')
        outcome.word = 'wrong' if outcome.reasons else 'ambiguous' if unsure else 'right'
        outcome.reasons = outcome.reasons or unsure
    elif outcome.code == 4:
        outcome.word = {'yes': 'wrong', 'no': 'right', 'unsure': 'ambiguous'}[balanced]
        outcome.reasons = [] if balanced == 'no' else [('the loads balance' + (' (plain)' if scene.is_plain else '') + ': '
                                                        if balanced == 'yes' else '') + message(said)]
    elif outcome.code == 3:
        # without friction, or without loads, what can be balanced has a solution; with friction it may have none
        has_friction = any(pair.nu for pair in scene.pairs) and scene.loads
        outcome.word = 'ambiguous' if balanced == 'unsure' else 'open' if has_friction and balanced == 'yes' else 'unsolved'
        outcome.reasons = [f'balanced: {balanced}; ' + message(said)]
    else:
        # faces of a slave that are longer than its master are refused, and elements that four digits fold
        refused = 'no face of the slave finds the master' in said or scene.digits == 4 and 'folds over' in said
        outcome.word = 'ambiguous' if outcome.code == 2 and refused else 'wrong'
        outcome.reasons = ['takes too long' if outcome.code is None else message(said)]


def compare(settings, outcome, scene, verdict, base):
    """With weak springs; friction may have several answers, and of what is hardly held springs hold a part."""
    folder = os.path.join(base, 'springs')
    if not scene.idle_bodies() or any(pair.nu for pair in scene.pairs) or verdict.is_hardly_held:
        return
    code, said, _ = run_deck(settings, scene.deck(True), os.path.join(base, 'springs.inp'), folder)
    if code != 0:
        outcome.reasons.append(f'exit {code} with weak springs: {message(said)}')
        return
    before = len(verdict.wrong)
    curved_judge.compare_with_springs(scene, verdict, folder, said)
    outcome.reasons += verdict.wrong[before:before + 3]


def read_settings():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('atrito')
    parser.add_argument('first', type=int)
    parser.add_argument('last', type=int)
    parser.add_argument('seed', type=int)
    parser.add_argument('-j', type=int, default=1, dest='jobs')
    parser.add_argument('--folder', default='curved')
    parser.add_argument('--only', default=None)
    parser.add_argument('--one', type=int, default=None)
    parser.add_argument('--write', default=None)
    settings, settings.options = parser.parse_known_args()
    return settings


def show_one(settings):
    """One scene, with all numbers of its judge."""
    scene = curved_scenes.make(settings.one, settings.seed)
    if settings.write:
        with open(settings.write, 'w') as file:
            file.write(scene.deck())
    os.makedirs(settings.folder, exist_ok=True)
    outcome = judge_number((settings, settings.one))
    print(outcome.line())
    print('balanced, least sum of contact forces:', *scene.balanced())
    for what, share in sorted(outcome.numbers.items()):
        print(f'   {what}: {share:.2e} of what is allowed')
    return 0 if outcome.word in ('right', 'ambiguous') else 1


def summary(outcomes, seconds):
    words = ('right', 'ambiguous', 'open', 'unsolved', 'wrong')
    out = [f'{"kind":14s}' + ''.join(f'{word:>11s}' for word in words)]
    for kind in [*sorted({outcome.kind for outcome in outcomes}), None]:
        own = [outcome.word for outcome in outcomes if kind in (None, outcome.kind)]
        out.append(f'{kind or "all":14s}' + ''.join(f'{own.count(word):11d}' for word in words))
    slowest = sorted(outcomes, key=lambda outcome: -outcome.seconds)[:3]
    return out + [f'{len(outcomes)} scenes in {seconds:.0f} s, the program {sum(o.seconds for o in outcomes):.0f} s; slowest: '
                  + ', '.join(f'{o.number} ({o.seconds:.1f} s)' for o in slowest)]


def main():
    os.environ['OMP_NUM_THREADS'] = os.environ['OPENBLAS_NUM_THREADS'] = '1'
    settings = read_settings()
    if settings.one is not None:
        return show_one(settings)
    os.makedirs(settings.folder, exist_ok=True)
    begin, outcomes = time.monotonic(), []
    with multiprocessing.Pool(settings.jobs) as pool, open(os.path.join(settings.folder, 'results.txt'), 'w') as rows:
        for outcome in pool.imap(judge_number, [(settings, number) for number in chosen_numbers(settings)]):
            outcomes.append(outcome)
            rows.write(outcome.line() + '\n')
            rows.flush()
            if outcome.word in ('wrong', 'unsolved'):
                print('scene ' + outcome.line(), flush=True)
    for name in os.listdir(settings.folder):
        if name.isdigit() and os.path.isdir(os.path.join(settings.folder, name)):
            shutil.rmtree(os.path.join(settings.folder, name))
    print('\n'.join(summary(outcomes, time.monotonic() - begin)))
    return 1 if any(outcome.word in ('wrong', 'unsolved') for outcome in outcomes) else 0


if __name__ == '__main__':
    sys.exit(main())
