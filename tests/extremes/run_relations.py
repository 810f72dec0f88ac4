"""Relations between two decks of one scene: what both say must be the same.

run_relations.py ATRITO RANDOM_SCENES FIRST LAST SEED [-j N] [--folder DIR] [--only N,N,..] [--which RELATION,..] [--mixed] [options of atrito]

Scene K is one of random_scenes, a history of one (histories.py) or a curved one (curved_scenes.py), in turn; with --mixed all are those of mixed_scenes.py. Its deck is run, and then
turned, mirrored, in other units (of a curved scene with all digits, of others with all of them at places that have few), with other numbers; with every solver, in both forms, with
two threads; with an empty step behind it, its step in two, and begun again by --restart. Exit codes and W-IDLE must be the same, and
all numbers of nodes.tab, reactions.tab, stress.tab (its invariants, point by point) and contact.tab to 1e-9 of the largest of their
column (of a pair in contact.tab), after they were turned back. Where a deck with all digits differs more, or another one by less than 1e-5, or by any part where the program tells that
pressures hang on the digits of coordinates (W-DIGITS), with another solver or form, too, it is measured what the digits are worth: both
decks are run with places that are off by the last digit. If its answer moves by as much, the scene is `loose`, and says nothing. Neither does it where one run ends
with exit 3 and the other has friction that the last digits move by more than 1e-7, which to the program is no solution. Where one ends
with exit 4 and the other with 3, since it is too near the limit, the places are off by as much as the deck of all digits is. Where
friction acts to 1e-7, which is what the outer loop is stopped at, and only where both forms agree so far (else there may be several
answers). Far from the origin the last digit of a coordinate is more than that of the motions: it is allowed, too. Prints a table by
relation with the largest difference, and what failed; exit code 0 when nothing did.
"""

import math
import multiprocessing
import os
import random
import shutil
import subprocess
import sys
import time

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import curved_scenes
import deck_relations as relations
import mixed_scenes
from deck_relations import Back, Deck
from histories import History
from run_scenes import chosen_numbers, run, runner_arguments
from scene_reader import read_deck, read_table

EXACT, WITH_FRICTION = 1e-9, 1e-7
DIGITS, EPS = 64, 2.0**-52
NO_FEW_DIGITS = 250.5          # units of the last digit
LITTLE = 1e-4  # of the largest displacement, of the loads, of what they do to the stiffest body, of pressures: slips, reactions,
               # displacements, shears that are much less are measured by it
OTHER_DECKS = {'quarter turn': relations.quarter_turn, 'turn': relations.turn, 'mirror': relations.mirror, 'units': relations.units,
               'renumbered': relations.renumber, 'empty step': relations.empty_step}
SHAKES = 3                     # decks with other last digits, of one that was turned and differs
WORTH = 3.0                    # times what they move an answer by, turning it may
NEW_DIGITS = ('turn', 'units')  # what few digits say of a curve is lost where all its digits are others
ILL_CONDITIONED = 1e-5         # of other decks a larger difference is no round-off: what hangs on a last digit there is a fault, untold
OTHER_OPTIONS = {'skyline': ['--solver', 'skyline'], 'banded': ['--solver', 'banded'], 'sparse': ['--solver', 'sparse'],
                 'dense form': ['--contact', 'dense'], 'sparse form': ['--contact', 'sparse'], 'threads': ['--threads', '2']}
RELATIONS = [*OTHER_DECKS, *OTHER_OPTIONS, 'step in two', 'restart']
COLUMNS = {'gap': 'L', 'pressure': 'P', 'weighted_pressure': 'P', 'shear': 'P-', 'slip': 'L-', 'weight': 'A'}


class Result:
    def __init__(self, settings, text, base, name, options=(), deck_folder=None):
        path = os.path.join(base, name + '.inp')
        self.folder = deck_folder or os.path.join(base, name)
        with open(path, 'w') as file:
            file.write(text)
        self.path, self.text, self.options = path, text, options
        self.code, said, _ = run(settings.atrito, path, self.folder, [*settings.options, *options])
        deck = Deck(text)
        self.load, self.least, self.stiffness = deck.largest_load(), deck.least_motion(), deck.stress_of_motion()
        self.is_idle = 'W-IDLE' in said
        self.is_undecided = self.code == 3 and 'too near the limit' in said
        self.tells_digits = 'differences of coordinates' in said
        self.is_built = 'E-NOT-BUILT' not in said  # supports along axes of their own may do less
        self.tables = {}
        if self.code == 0:
            for table in ('nodes', 'reactions', 'stress', 'contact'):
                file = os.path.join(self.folder, table + '.tab')
                if os.path.exists(file):
                    self.tables[table] = read_table(file)[0]


def frame(table, is_last):
    """All rows, or those of the last increment."""
    if not is_last or not len(table['step']):
        return table
    last = max(zip(table['step'], table['increment']))
    rows = (table['step'] == last[0]) & (table['increment'] == last[1])
    return {name: values[rows] for name, values in table.items()}


def largest_difference(first, other, back):
    """Over all columns, in parts of the largest value of each; and where."""
    worst = (0.0, '')
    spared = last_digits(first.tables.get('nodes'))
    u = max((np.abs(first.tables['nodes'][c]).max(initial=0.0) for c in ('u1', 'u2')), default=0.0) if 'nodes' in first.tables else 0.0
    far = max((np.abs(first.tables['nodes'][c]).max(initial=0.0) for c in 'xy'), default=0.0) if 'nodes' in first.tables else 0.0
    contact = first.tables.get('contact')  # which an overlap makes without any load
    force = 0.0 if contact is None else np.abs(contact['pressure']*contact['weight']).max(initial=0.0)
    floor = {'reactions': LITTLE*max(first.load, force), 'stress': DIGITS*EPS*first.stiffness*u/EXACT, 'contact': max(LITTLE*u, DIGITS*EPS*far/EXACT), 'nodes': LITTLE*first.least}
    for name, table in first.tables.items():
        if name not in other.tables:
            return math.inf, f'{name}.tab is missing'
        a, b = frame(table, back.is_last), frame(other.tables[name], back.is_last)
        if len(a['step']) != len(b['step']):
            return math.inf, f'{name}.tab has {len(b["step"])} rows for {len(a["step"])}'
        rule = {'contact': compare_points, 'stress': compare_stresses}.get(name, compare_nodes)
        for part, where in rule(a, b, back, ('r1', 'r2') if name == 'reactions' else ('u1', 'u2'), floor[name]):
            part = part if part == math.inf else max(part - spared, 0.0)
            worst = max(worst, (part, f'{name} {where}'), key=lambda one: (not one[0] <= math.inf, one[0]))
    return worst


def last_digits(nodes):
    """Of the coordinates, in parts of the largest displacement."""
    if nodes is None:
        return 0.0
    u = np.abs(np.stack([nodes['u1'], nodes['u2']])).max(initial=0.0)
    return DIGITS*EPS*np.abs(np.stack([nodes['x'], nodes['y']])).max(initial=0.0)/u if u > 0 else 0.0


def compare_nodes(a, b, back, columns, floor):
    number = b['node'].astype(int)
    if back.node:
        number = np.array([back.node[int(node)] for node in number])
    order, mine = np.lexsort((number, b['increment'], b['step'])), np.lexsort((a['node'], a['increment'], a['step']))
    if (number[order] != a['node'][mine]).any():
        yield math.inf, 'nodes'
        return
    there = back.vector(np.stack([b[c] for c in columns], axis=1))[order]/(back.length if columns[0] == 'u1' else back.force)
    here = np.stack([a[c] for c in columns], axis=1)[mine]
    scale = np.abs(here).max(initial=0.0)
    scale = max(scale, np.abs(there).max(initial=0.0), floor)
    yield (np.abs(here - there).max(initial=0.0)/scale if scale > 0 else 0.0), columns[0][0]


def compare_stresses(a, b, back, _, floor):
    """Half of the trace, the largest shear and what lies across the plane, at the points nearest."""
    for key in sorted(set(zip(a['step'], a['increment']))):
        i, j = (np.flatnonzero((t['step'] == key[0]) & (t['increment'] == key[1]) | back.is_last) for t in (a, b))
        if len(i) != len(j):
            yield math.inf, 'points of stress'
            return
        here, there = np.stack([a['x'][i], a['y'][i]], axis=1), back.vector(np.stack([b['x'][j], b['y'][j]], axis=1))/back.length
        j = j[[((there - place)**2).sum(axis=1).argmin() for place in here]]
        for what, of in (('trace', lambda t, k: t['s11'][k] + t['s22'][k]), ('s33', lambda t, k: t['s33'][k]),
                         ('shear', lambda t, k: np.hypot(0.5*(t['s11'][k] - t['s22'][k]), t['s12'][k]))):
            x, y = of(a, i), of(b, j)*back.length**2/back.force
            scale = max(*(np.abs(a[c][i]).max(initial=0.0) for c in ('s11', 's22', 's12')), np.abs(y).max(initial=0.0), floor)
            if scale > 0:
                yield np.abs(x - y).max()/scale, what


def compare_points(a, b, back, _, floor):
    units = {'L': back.length, 'P': back.force/back.length**2, 'A': back.length**2}
    for pair in sorted(set(a['pair'])):
        mine, theirs = a['pair'] == pair, b['pair'] == pair
        steps = sorted(set(zip(a['step'][mine], a['increment'][mine])))
        others = sorted(set(zip(b['step'][theirs], b['increment'][theirs])))
        rows, partners = [], []
        for (step, increment), (other, another) in zip(steps, others):
            i = np.flatnonzero(mine & (a['step'] == step) & (a['increment'] == increment))
            j = np.flatnonzero(theirs & (b['step'] == other) & (b['increment'] == another))
            if len(i) != len(j):
                yield math.inf, f'points of pair {int(pair)}'
                return
            there = back.vector(np.stack([b['x'][j], b['y'][j]], axis=1))/back.length
            here = np.stack([a['x'][i], a['y'][i]], axis=1)
            nearest = ((here[:, None, :] - there[None, :, :])**2).sum(axis=2).argmin(axis=1)
            rows += list(i)
            partners += list(j[nearest])
        for name, unit in COLUMNS.items():
            x = a[name][rows]
            y = b[name][partners]/units[unit[0]]*(back.hand if unit.endswith('-') else 1.0)
            scale = max(np.abs(x).max(initial=0.0), np.abs(y).max(initial=0.0))
            if name in ('gap', 'slip'):
                # both are differences of places and motions
                scale = max(scale, *(np.abs(a[c][rows]).max(initial=0.0) for c in ('gap', 'slip')), floor)
            if name == 'shear':
                scale = max(scale, LITTLE*np.abs(a['pressure'][rows]).max(initial=0.0))
            if scale > 0:
                yield np.abs(x - y).max()/scale, f'{name} of pair {int(pair)}'


class Outcome:
    def __init__(self, number):
        self.number, self.kind, self.code, self.found, self.is_one = number, '', None, {}, True
        self.loose, self.undecided, self.told = set(), set(), set()


def deck_of(settings, number, digits=None):
    if getattr(settings, 'mixed', False):
        return mixed_scenes.make(number, settings.seed, digits)
    if number % 3 == 2:
        scene = curved_scenes.make(number, settings.seed, digits)
        return 'curved ' + scene.kind, scene.deck()
    text = subprocess.run([settings.generator, str(number), str(settings.seed)], capture_output=True, text=True, check=True).stdout
    if number % 3 == 0:
        return 'scene', text
    return 'history', History(text, number, settings.seed, read_deck(text)).deck


def judge_number(work):
    settings, number = work
    outcome = Outcome(number)
    base = os.path.join(settings.folder, str(os.getpid()))
    os.makedirs(base, exist_ok=True)
    try:
        outcome.kind, text = deck_of(settings, number)
        compare_all(settings, outcome, Deck(text), base)
    except Exception as trouble:  # a fault of the judge must not stop the others
        outcome.found['judge'] = (math.inf, repr(trouble))
    if any(not good(outcome, name) for name in outcome.found):
        with open(os.path.join(settings.folder, f'{number}.inp'), 'w') as file:
            file.write(Deck(text).text() if 'judge' not in outcome.found else text)
    return outcome


def compare_all(settings, outcome, deck, base):
    first = Result(settings, deck.text(), base, 'first')
    outcome.code = first.code
    outcome.has_friction = deck.has_friction()
    forms = {}
    for name, options in OTHER_OPTIONS.items():
        if name in settings.relations or (outcome.has_friction and name.endswith('form')):
            forms[name] = compare(settings, outcome, base, first, Result(settings, deck.text(), base, 'other', options), Back(), name)
    if outcome.has_friction:
        outcome.is_one = all(forms[name] <= WITH_FRICTION for name in ('dense form', 'sparse form'))
    for name in OTHER_OPTIONS:
        if name in outcome.found and name in outcome.told and not good(outcome, name):
            measure_digits(settings, outcome, (deck,), base, name)
    exact = Deck(deck_of(settings, outcome.number, digits=17)[1])
    all_digits = first
    if exact.text() == deck.text():
        # places of few digits so far that they are none, as those of the other deck are none
        exact = relations.without_few_digits(deck, random.Random(f'{settings.seed}-{outcome.number}'), NO_FEW_DIGITS)
    if exact.text() != deck.text():
        all_digits = Result(settings, exact.text(), base, 'all-digits')
        if outcome.has_friction and outcome.is_one:
            outcome.is_one = all(difference(all_digits, Result(settings, exact.text(), base, 'other', options), Back())[0] <= WITH_FRICTION
                                 for name, options in OTHER_OPTIONS.items() if name.endswith('form'))
    for name, relation in OTHER_DECKS.items():
        if name in settings.relations:
            mine, its = (exact, all_digits) if name in NEW_DIGITS else (deck, first)
            found = relation(mine, random.Random(f'{settings.seed}-{outcome.number}-{name}'))
            if found:
                compare(settings, outcome, base, its, Result(settings, found[0].text(), base, 'other'), found[1], name)
                if name in outcome.found and not good(outcome, name) and (name in NEW_DIGITS or name in outcome.told
                                                                                   or outcome.found[name][0] < ILL_CONDITIONED):
                    other = relation(exact, random.Random(f'{settings.seed}-{outcome.number}-{name}'))
                    measure_digits(settings, outcome, (exact, other[0]), base, name)
    if 'step in two' in settings.relations:
        found = relations.split_step(deck, None)
        if found:
            one = Result(settings, found[2].text(), base, 'two-increments')
            compare(settings, outcome, base, one, Result(settings, found[0].text(), base, 'other'), found[1], 'step in two')
    if 'restart' in settings.relations:
        begin_again(settings, outcome, deck, base)


def measure_digits(settings, outcome, decks, base, name):
    """What the last digits are worth, where a relation that makes others of them does not hold: of either deck."""
    moved = 0.0
    digits = NO_FEW_DIGITS if name in outcome.undecided else 1.0  # by which the deck without few digits is off already
    for deck in decks:
        first = Result(settings, deck.text(), base, 'digits')
        for shake in range(SHAKES):
            other = relations.shaken(deck, random.Random(f'{settings.seed}-{outcome.number}-{name}-{shake}'), digits)
            other = Result(settings, other.text(), base, 'other')
            moved = max(moved, math.inf if first.is_idle != other.is_idle else difference(first, other, Back())[0])
    if outcome.found[name][0] <= WORTH*moved:
        outcome.loose.add(name)


def hangs_on_digits(settings, results, base):
    """Of runs one of which alone has a solution: whether the last digits of places move it by more than the outer loop is stopped at.
    To the program friction that is less certain is no solution, and whether its loop ends at one is chance."""
    for result in results:
        deck, solved = Deck(result.text), []
        for shake in range(SHAKES):
            other = relations.shaken(deck, random.Random(f'{settings.seed}-{shake}'))
            solved.append(Result(settings, other.text(), base, 'shaken', result.options))
        solved = [one for one in [result, *solved] if one.code == 0]
        if any(difference(solved[0], one, Back())[0] > WITH_FRICTION for one in solved[1:]):
            return True
    return False


def begin_again(settings, outcome, deck, base):
    whole, part = relations.begun(deck)
    first = Result(settings, whole.text(), base, 'whole')
    begun = Result(settings, part.text(), base, 'other')
    file = os.path.join(begun.folder, 'other.restart.h5')
    if begun.code != 0 or not os.path.exists(file):
        return
    kept = os.path.join(base, 'kept.h5')
    shutil.copy(file, kept)
    compare(settings, outcome, base, first, Result(settings, whole.text(), base, 'other', ['--restart', kept]), Back(), 'restart')


def difference(first, other, back):
    if first.code != other.code:
        return math.inf, f'exit {other.code} for {first.code}'
    return (0.0, '') if first.code != 0 else largest_difference(first, other, back)


def compare(settings, outcome, base, first, other, back, name):
    if name not in RELATIONS or not other.is_built:
        return 0.0
    found = difference(first, other, back)
    # the last iterate of a run without a solution is none that a motion could be idle in; what is begun again tells of its own increments
    if found[0] < math.inf and first.is_idle != other.is_idle and name not in ('step in two', 'restart') and first.code != 3:
        found = math.inf, 'W-IDLE in one only'
    outcome.found[name] = found
    if first.tells_digits and other.tells_digits:
        outcome.told.add(name)
    if outcome.has_friction and {first.code, other.code} == {0, 3} and '--restart' not in other.options \
            and hangs_on_digits(settings, (first, other), base):
        outcome.loose.add(name)
    if {first.code, other.code} == {3, 4} and (first.is_undecided or other.is_undecided):
        outcome.undecided.add(name)
    if settings.keep and found[0] > EXACT:
        shutil.copy(other.path, os.path.join(settings.folder, f'{outcome.number}-{name.replace(" ", "-")}.inp'))
    return found[0]


def good(outcome, name):
    if name == 'judge':
        return False
    if name in outcome.loose:
        return True
    return outcome.found[name][0] <= (WITH_FRICTION if outcome.has_friction else EXACT) or not outcome.is_one


def summary(outcomes, names):
    out = [f'{"relation":14s}{"same":>7s}{"not":>6s}{"several":>9s}{"loose":>7s}   largest, failing']
    for name in names:
        own = [outcome for outcome in outcomes if name in outcome.found]
        counted = [outcome for outcome in own if outcome.is_one]
        bad = sorted((outcome for outcome in counted if not good(outcome, name)), key=lambda outcome: -outcome.found[name][0])
        loose = [outcome for outcome in counted if name in outcome.loose]
        fine = max((outcome.found[name][0] for outcome in counted if good(outcome, name) and outcome not in loose), default=0.0)
        out.append(f'{name:14s}{len(counted) - len(bad) - len(loose):7d}{len(bad):6d}{len(own) - len(counted):9d}{len(loose):7d}   '
                   f'{fine:.1e}  '
                   + ' '.join(f'{outcome.number} ({outcome.found[name][0]:.0e} {outcome.found[name][1]})' for outcome in bad[:6])
                   + (' ...' if len(bad) > 6 else ''))
    return out


def main():
    os.environ['OMP_NUM_THREADS'] = os.environ['OPENBLAS_NUM_THREADS'] = '1'
    parser = runner_arguments(__doc__, 'relations')
    parser.add_argument('--which', default=','.join(RELATIONS))
    parser.add_argument('--keep', action='store_true')
    parser.add_argument('--mixed', action='store_true')
    settings, settings.options = parser.parse_known_args()
    settings.relations = settings.which.split(',')
    os.makedirs(settings.folder, exist_ok=True)
    begin, outcomes = time.monotonic(), []
    with multiprocessing.Pool(settings.jobs) as pool, open(os.path.join(settings.folder, 'results.txt'), 'w') as rows:
        for outcome in pool.imap(judge_number, [(settings, number) for number in chosen_numbers(settings)]):
            outcomes.append(outcome)
            bad = '; '.join(f'{name} {part:.1e} {where}' for name, (part, where) in outcome.found.items() if not good(outcome, name))
            rows.write(f'{outcome.number} {outcome.code} {"one" if outcome.is_one else "several"} "{outcome.kind}" {bad}\n')
            rows.flush()
            if bad:
                print(f'scene {outcome.number} ({outcome.kind}, exit {outcome.code}): {bad}', flush=True)
    for name in os.listdir(settings.folder):
        if name.isdigit() and os.path.isdir(os.path.join(settings.folder, name)):
            shutil.rmtree(os.path.join(settings.folder, name))
    names = [name for name in [*RELATIONS, 'judge'] if any(name in outcome.found for outcome in outcomes)]
    print('\n'.join(summary(outcomes, names)))
    print(f'{len(outcomes)} scenes, {sum(len(outcome.found) for outcome in outcomes)} relations in {time.monotonic() - begin:.0f} s')
    return 1 if any(not good(outcome, name) for outcome in outcomes for name in outcome.found) else 0


if __name__ == '__main__':
    sys.exit(main())
