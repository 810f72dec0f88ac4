"""Runs random histories and judges every increment of them.

run_histories.py ATRITO RANDOM_SCENES FIRST LAST SEED [-j N] [--folder DIR] [--only N,N,..] [options of atrito]

Each increment that is printed is judged as a scene of its own (judge.py): what acts then is found from the deck's factors, and the
slip that friction feels counts from where the increments before have left it, by their tables. Besides, in history.tab: normal and
shear forces, the dissipation, found anew, which does not fall where the law is incremental; times that ascend to the end of the step.
A history may end early: exit 4 is right where no admissible forces balance the loads then, exit 3 where it is not shown that there
are some that another form finds. Exit code 0 when nothing is wrong.
"""

import copy
import math
import multiprocessing
import os
import re
import shutil
import subprocess
import sys
import time

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import judge
from histories import History
from run_scenes import chosen_numbers, message, run, runner_arguments
from scene_reader import read_deck, read_table

DISSIPATION = 1e-7   # of the sum of its terms
SUMS = 1e-7          # of the sum of the forces
FULL = 1e-7          # of the friction bound, to which it is found: a shear that is nearer to it has reached it


class Outcome:
    def __init__(self, number):
        self.number, self.code, self.word, self.reason, self.frames, self.seconds = number, None, '', '', 0, 0.0


class Memory:
    """What friction remembers of a pair."""

    def __init__(self, n):
        self.rest, self.slip, self.shear, self.drift = np.zeros((4, n))
        self.slides = np.zeros(n, bool)
        self.dissipation = self.terms = 0.0


class Frames:
    """The rows of each increment."""

    def __init__(self, folder, with_reactions):
        self.tables = {}
        for name in ['nodes', 'contact'] + ['reactions']*with_reactions:
            self.tables[name] = read_table(os.path.join(folder, name + '.tab'))[0]
        self.history = None
        if os.path.exists(os.path.join(folder, 'history.tab')):
            self.history = read_table(os.path.join(folder, 'history.tab'), ('centre',))[0]

    def zero(self, name, *columns):
        """What is printed as 0: a small part of the largest number of any increment."""
        table = self.history if name == 'history' else self.tables[name]
        return judge.PRINTED_ZERO*max(np.abs(table[column]).max(initial=0.0) for column in columns)

    def increments(self):
        table = self.tables['nodes']
        return list(dict.fromkeys(zip(table['step'].astype(int), table['increment'].astype(int))))

    def rows(self, name, step, increment):
        table = self.history if name == 'history' else self.tables[name]
        wanted = (table['step'] == step) & (table['increment'] == increment)
        return {column: values[wanted] for column, values in table.items()}


def judge_history(history, scene, folder, end=None):
    """The verdict over all increments, how many there are, and whether what acts at the end (step, time) can be balanced."""
    total = judge.Verdict()
    bodies, owner = judge.build_bodies(scene)
    pairs = [judge.Pair(scene, owner, *names) for names in scene.pairs]
    frames = Frames(folder, True) if os.path.exists(os.path.join(folder, 'nodes.tab')) else None
    memories = [Memory(len(pair.nodes)) for pair in pairs]
    own = {id(group): forces_of(group, scene, bodies, owner) for group in history.groups}
    state = {'u': None, 'reaction': None, 'held': set(), 'from': {}, 'released': {}, 'step': 0}
    times = [0.0]
    for step, increment in frames.increments() if frames else ():
        t = time_of(frames, history, step, increment)
        if t is None or not t > times[-1]:
            total.wrong.append((math.inf, f'time of increment {increment} of step {step}: {t}'))
            break
        times.append(t)
        act(history, step, t - history.steps[step - 1].began, scene, bodies, owner, own, state)
        one = judge_frame(scene, bodies, owner, pairs, memories, frames, step, increment, state)
        for kind, share in one.worst.items():
            total.worst[kind] = max(share, total.worst.get(kind, -1.0))
        total.wrong += [(share, f'step {step} increment {increment}: {text}') for share, text in one.wrong]
        if one.wrong:
            break
    word = ''
    if end and not total.wrong:
        act(history, end[0], end[1] - history.steps[end[0] - 1].began, scene, bodies, owner, own, state)
        word = judge.judge_bodies(bodies, owner, pairs)[0]
    return total, len(times) - 1, word


def time_of(frames, history, step, increment):
    if frames.history is None:
        return history.steps[step - 1].began + history.steps[step - 1].period
    rows = frames.rows('history', step, increment)
    return rows['time'][0] if len(rows['time']) else None


def forces_of(group, scene, bodies, owner):
    """The nodal forces of a group with factor 1, body by body."""
    if group.keyword == 'BOUNDARY':
        return None
    kept = [body.f for body in bodies]
    loads, scene.loads = scene.loads, [(group.keyword, row) for row in group.rows]
    for body in bodies:
        body.f = np.zeros_like(body.f)
    for number, (kind, nodes) in scene.elements.items():
        material, thickness = scene.section[number]
        e, mu, density = scene.materials[material]
        force = judge.volume_force(scene, number, density)
        if force.any():
            body = owner[nodes[0]]
            places = [body.index[node] for node in nodes]
            body.f[places] += np.outer(judge.element_matrix(kind, body.x[places], np.eye(3), thickness)[1], force)
    for kind, row in scene.loads:
        judge.add_load(scene, owner, kind, row)
    scene.loads = loads
    found = [body.f for body in bodies]
    for body, f in zip(bodies, kept):
        body.f = f
    return found


def act(history, number, step_time, scene, bodies, owner, own, state):
    """Loads and supports at a time."""
    step = history.steps[number - 1]
    held, value, factors = set(), {}, list(step.factors(step_time))
    if number != state['step']:
        begin_step(history, step, scene, state)
        state['step'] = number
    share = step.share(step_time)
    for group, factor in factors:
        if group.keyword == 'BOUNDARY':
            for row in group.rows:
                for key in dofs_of(scene, row):
                    value[key] = float(row[3])*factor
    for row in step.fixed:
        for key in dofs_of(scene, row):
            value.setdefault(key, 0.0)
    held = set(value)
    for body in bodies:
        body.f = np.zeros_like(body.f)
        body.held[:] = False
        body.value[:] = 0.0
    for group, factor in factors:
        if group.keyword != 'BOUNDARY':
            for body, f in zip(bodies, own[id(group)]):
                body.f += factor*f
    for (node, dof), u in value.items():
        body = owner[node]
        body.held[body.index[node], dof] = True
        if (node, dof) in state['from']:
            u = u if share == 1 else state['from'][node, dof] + share*(u - state['from'][node, dof])
        body.value[body.index[node], dof] = u
    for (node, dof), r in state['released'].items():
        body = owner[node]
        body.f[body.index[node], dof] += (1 - share)*r
    scene.held = value
    state['held'] = held


def begin_step(history, step, scene, state):
    """Supports that come begin where their dofs are; the forces of those that go fade."""
    held = {key for row in step.fixed for key in dofs_of(scene, row)}
    held |= {key for group, *_ in step.groups if group.keyword == 'BOUNDARY' for row in group.rows for key in dofs_of(scene, row)}
    state['from'], state['released'] = {}, {}
    if state['u'] is None:
        return
    state['from'] = {(node, dof): state['u'][node][dof] for node, dof in held - state['held']}
    state['released'] = {(node, dof): state['reaction'][node][dof] for node, dof in state['held'] - held}


def dofs_of(scene, row):
    for node in scene.nodesets.get(row[0]) or [int(row[0])]:
        for dof in range(int(row[1]), int(row[2] if len(row) > 2 else row[1]) + 1):
            yield node, dof - 1


def judge_frame(scene, bodies, owner, pairs, memories, frames, step, increment, state):
    verdict = judge.Verdict()
    nodes = frames.rows('nodes', step, increment)
    u = {int(node): np.array([a, b]) for node, a, b in zip(nodes['node'], nodes['u1'], nodes['u2'])}
    rows = frames.rows('reactions', step, increment)
    reaction = {int(node): np.array([a, b]) for node, a, b in zip(rows['node'], rows['r1'], rows['r2'])}
    contact = frames.rows('contact', step, increment)
    fields = [judge.pair_fields(pair, i, contact, verdict) for i, pair in enumerate(pairs, 1)]
    if any(field is None for field in fields):
        return verdict
    largest = frames.zero('nodes', 'u1', 'u2')/judge.PRINTED_ZERO
    for body in bodies:
        body.u = np.array([u[node] for node in body.nodes])
        body.error = judge.MOTION*judge.EPS*np.abs(body.u).max() + np.where(body.u == 0, judge.PRINTED_ZERO*largest, 0.0)
        body.error[body.held & (body.value == 0)] = 0.0
        judge.check_supports(body, largest, verdict)
    table = frames.rows('history', step, increment) if frames.history is not None else None
    for i, (pair, field, memory) in enumerate(zip(pairs, fields, memories), 1):
        if pair.law.is_incremental:
            field['elastic'], field['drift'] = field['slip'] - memory.rest, memory.drift
        if len(pair.nodes):
            field['zero'], field['no_shear'] = frames.zero('contact', 'gap', 'slip'), frames.zero('contact', 'shear')
        judge.check_pair(pair, field, i, owner, verdict)
        if len(pair.nodes):
            remember(pair, field, memory, frames.zero('contact', 'slip', 'slip_increment'), i, verdict)
        if table is not None:
            check_row(pair, field, memory, i, frames, table, verdict)
    judge.check_bodies(bodies, owner, pairs, fields, reaction, verdict)
    state['u'], state['reaction'] = u, reaction
    return verdict


def remember(pair, field, memory, zero, number, verdict):
    """Slip increments, dissipation and rest slips."""
    law, t, slip = pair.law, -field['shear'], field['slip']
    for j in range(len(t)):
        where = f'pair {number} point {j + 1}'
        verdict.test('slip increment', field['slip_increment'][j] - (slip[j] - memory.slip[j]),
                     1e-15*(abs(slip[j]) + abs(memory.slip[j])) + 4*zero + 1e-300, where)
        rest, shear = memory.rest[j], abs(t[j])
        # the nonlocal law has friction at open points, too
        is_free = law.kind == 'NONE' or law.nu == 0 or (field['status'][j] == 0 and field['bound'][j] <= 0)
        is_full = not is_free and (field['status'][j] == 2 or field['status'][j] == 0 and shear >= (1 - FULL)*field['bound'][j])
        if is_free:
            rest = slip[j]
        elif is_full:
            limit = law.eps if law.kind == 'NONLOCAL' else shear/law.slope
            rest = slip[j] - math.copysign(limit, t[j]) if shear > 0 else slip[j]
            mean = t[j]
            if memory.slides[j] and t[j]*memory.shear[j] > 0:
                mean = 0.5*(t[j] + memory.shear[j])
            term = field['weight'][j]*mean*(rest - memory.rest[j])
            slack = field['weight'][j]*abs(mean)*(field['place'][j] + memory.drift[j])
            if law.is_incremental:
                verdict.test('friction that drives', min(term, 0.0), slack + 1e-300, where)
            memory.dissipation += term
            memory.terms += abs(term) + slack/DISSIPATION
        if is_free or is_full:
            memory.drift[j] = field['place'][j]
        memory.slides[j] = is_full
        memory.rest[j], memory.slip[j], memory.shear[j] = rest, slip[j], t[j]


def check_row(pair, field, memory, number, frames, table, verdict):
    """Sums over the pair."""
    row = {name: values[table['pair'] == number] for name, values in table.items()}
    where = f'pair {number}'
    forces = field['weight']*field['pressure']
    verdict.test('normal resultant', row['normal_resultant'][0] - forces.sum(), SUMS*forces.sum() + frames.zero('history', 'normal_resultant') + 1e-300, where)
    shears = -field['weight']*field['shear']
    off = abs(abs(row['shear_resultant'][0]) - abs(shears.sum()))
    verdict.test('shear resultant', off, SUMS*(np.abs(shears).sum() + forces.sum()) + frames.zero('history', 'shear_resultant') + 1e-300, where)
    verdict.test('dissipation', row['dissipation'][0] - memory.dissipation, DISSIPATION*memory.terms + frames.zero('history', 'dissipation') + 1e-300, where)
    for status, name in enumerate(('open', 'stick', 'slip')):
        verdict.test('number of points', row[name][0] - (field['status'] == status).sum(), 0.5, where)


def ending(said, folder):
    """Step and time of the increment that had no solution; the listing has all digits of the time."""
    lists = [open(os.path.join(folder, name)).read() for name in os.listdir(folder) if name.endswith('.lst')] if os.path.isdir(folder) else []
    found = [re.search(r'ended in step (\d+), increment \d+, time ([-+.eE\d]+)', ' '.join(text.split())) for text in [*lists, said]]
    found = next((match for match in found if match), None)
    return (int(found.group(1)), float(found.group(2))) if found else None


def judge_number(work):
    settings, number = work
    outcome = Outcome(number)
    base = os.path.join(settings.folder, str(os.getpid()))
    os.makedirs(base, exist_ok=True)
    path, folder = os.path.join(base, 'deck.inp'), os.path.join(base, 'out')
    text = subprocess.run([settings.generator, str(number), str(settings.seed)], capture_output=True, text=True, check=True).stdout
    scene = read_deck(text)
    history = History(text, number, settings.seed, scene)
    scene = read_deck(history.head + '*STEP\n' + text.partition('*STEP\n')[2])
    with open(path, 'w') as file:
        file.write(history.deck)
    outcome.code, said, outcome.seconds = run(settings.atrito, path, folder, settings.options)
    try:
        give_verdict(outcome, history, scene, folder, said)
    except Exception as trouble:  # a fault of the judge must not stop the others
        outcome.word, outcome.reason = 'wrong', f'the judge failed: {trouble!r}'
    if outcome.word in ('wrong', 'open'):
        shutil.copy(path, os.path.join(settings.folder, f'{number}.inp'))
    return outcome


def give_verdict(outcome, history, scene, folder, said):
    if outcome.code not in (0, 3, 4):
        outcome.word, outcome.reason = 'wrong', 'takes too long' if outcome.code is None else message(said)
        return
    end = ending(said, folder) if outcome.code else None
    verdict, outcome.frames, word = judge_history(history, copy.deepcopy(scene), folder, end)
    if verdict.wrong:
        outcome.word, outcome.reason = 'wrong', verdict.text()
    elif outcome.code == 0:
        outcome.word = 'solved' if outcome.frames else 'wrong'
    elif word == 'feasible':
        # exit 4 says that nothing can balance the loads
        outcome.word, outcome.reason = 'wrong' if outcome.code == 4 else 'open', 'loads that can be balanced: ' + message(said)
    else:
        outcome.word, outcome.reason = 'certified', message(said)


def main():
    os.environ['OMP_NUM_THREADS'] = os.environ['OPENBLAS_NUM_THREADS'] = '1'
    settings, settings.options = runner_arguments(__doc__, 'random-histories').parse_known_args()
    os.makedirs(settings.folder, exist_ok=True)
    begin, outcomes = time.monotonic(), []
    with multiprocessing.Pool(settings.jobs) as pool, open(os.path.join(settings.folder, 'results.txt'), 'w') as rows:
        for outcome in pool.imap(judge_number, [(settings, number) for number in chosen_numbers(settings)]):
            outcomes.append(outcome)
            rows.write(f'{outcome.number} {outcome.code} {outcome.word} {outcome.frames} {outcome.seconds:.3f} {outcome.reason}\n')
            rows.flush()
            if outcome.word == 'wrong':
                print(f'history {outcome.number}: exit {outcome.code}, {outcome.reason}', flush=True)
    for name in os.listdir(settings.folder):
        if name.isdigit() and os.path.isdir(os.path.join(settings.folder, name)):
            shutil.rmtree(os.path.join(settings.folder, name))
    slowest = sorted(outcomes, key=lambda outcome: -outcome.seconds)[:4]
    print(f'{len(outcomes)} histories, {sum(outcome.frames for outcome in outcomes)} increments: '
          + ', '.join(f'{sum(outcome.word == word for outcome in outcomes)} {word}' for word in ('solved', 'certified', 'open', 'wrong'))
          + f'; {time.monotonic() - begin:.0f} s, the program {sum(outcome.seconds for outcome in outcomes):.0f} s; slowest: '
          + ', '.join(f'{outcome.number} ({outcome.seconds:.1f} s)' for outcome in slowest))
    return 1 if any(outcome.word == 'wrong' for outcome in outcomes) or not any(outcome.frames for outcome in outcomes) else 0


if __name__ == '__main__':
    sys.exit(main())
