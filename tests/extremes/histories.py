"""Random histories: scene K of random_scenes, loaded in steps of increments. history(text, K, S) gives the deck and what acts at a time.

What stands before *STEP stays, but for the SLIP= of friction. Lines of loads that meet at a face or an element go together: a group.
Each step gives some groups another factor, as a ramp or by an amplitude, with OP=MOD or OP=NEW; supports may go and come back.
"""

import random
import re

from scene_reader import cards

KEYWORDS = ('BOUNDARY', 'CLOAD', 'DLOAD', 'DSLOAD')


class Group:
    """Lines of one keyword that are given together, and what they are multiplied by."""

    def __init__(self, keyword, rows):
        self.keyword = keyword
        self.rows = rows
        self.begin = self.end = 0.0   # factors of this step, without an amplitude
        self.curve = None             # the amplitude that multiplies `end`
        self.at_end = 0.0             # factor at the end of the step before
        self.alone = False            # OP=NEW without it: gone

    def at(self, share, step_time, time):
        if self.curve:
            return self.end*self.curve.at(time if self.curve.is_total else step_time)
        return self.end if share == 1 else self.begin + share*(self.end - self.begin)


class Curve:
    def __init__(self, name, is_total, is_smooth, points):
        self.name, self.is_total, self.is_smooth, self.points = name, is_total, is_smooth, points

    def at(self, t):
        if t <= self.points[0][0]:
            return self.points[0][1]
        for (t0, a0), (t1, a1) in zip(self.points, self.points[1:]):
            if t <= t1:
                s = (t - t0)/(t1 - t0)
                if self.is_smooth:
                    s = s**3*(10 - 15*s + 6*s*s)
                return a0 + s*(a1 - a0)
        return self.points[-1][1]

    def text(self):
        options = ', TIME=TOTAL TIME'*self.is_total + ', DEFINITION=SMOOTH STEP'*self.is_smooth
        return f'*AMPLITUDE, NAME={self.name}{options}\n' + ''.join(f'{t!r}, {a!r}\n' for t, a in self.points)


class Step:
    def __init__(self, period, at_once):
        self.period, self.at_once = period, at_once
        self.groups = []      # (group, begin, end, curve) of all that acts
        self.held = set()     # (node or set, dof) that boundary lines hold
        self.began = 0.0

    def factors(self, step_time):
        """(group, factor) at a time of the step."""
        share = 1.0 if self.at_once or step_time >= self.period else step_time/self.period
        for group, begin, end, curve in self.groups:
            group.begin, group.end, group.curve = begin, end, curve
            yield group, group.at(share, step_time, self.began + step_time)

    def share(self, step_time):
        return 1.0 if self.at_once or step_time >= self.period else step_time/self.period


def grouped(body, members):
    """Lines of loads by what they act on: those that share a face or an element and a label are one group."""
    lines = [(keyword, row) for keyword, _, data in body if keyword in ('CLOAD', 'DLOAD', 'DSLOAD') for row in data]
    groups = []
    for keyword, row in lines:
        touched = {(keyword, row[1], part) for part in members(row[0])}
        together = [group for group in groups if group[0] == keyword and group[1] & touched]
        for group in together:
            groups.remove(group)
            touched |= group[1]
        groups.append((keyword, touched, [r for group in together for r in group[2]] + [row]))
    return [Group(keyword, rows) for keyword, _, rows in groups]


def supports(body):
    """Fixed lines, and a group of each displacement that is not zero."""
    rows = [row for keyword, _, data in body if keyword == 'BOUNDARY' for row in data]
    moved = {}
    for row in rows:
        value = float(row[3]) if len(row) > 3 else 0.0
        if value:
            moved.setdefault((row[1], abs(value)), []).append(row)
    fixed = [row for row in rows if not (float(row[3]) if len(row) > 3 else 0.0)]
    return fixed, [Group('BOUNDARY', lines) for lines in moved.values()]


def scaled(group, factor):
    """The lines of a group as they stand in a deck. Its value is what is multiplied."""
    place = {'BOUNDARY': 3, 'CLOAD': 2, 'DLOAD': 2, 'DSLOAD': 2}[group.keyword]
    lines = []
    for row in group.rows:
        row = list(row)
        row[place] = repr(float(row[place])*factor)
        lines.append(', '.join(row))
    return lines


class History:
    """A deck of steps."""

    def __init__(self, text, number, seed, scene):
        self.r = random.Random(f'{seed}-{number}')
        self.head, _, tail = text.partition('*STEP\n')
        self.head = re.sub(r'\*FRICTION(, NONLOCAL)?(?=[,\n])', self.friction, self.head)
        body = list(cards(tail))
        self.fixed, moved = supports(body)
        self.groups = grouped(body, lambda name: scene.elsets.get(name) or scene.surfaces.get(name) or [name]) + moved
        self.curves, self.steps, self.text = [], [], ''
        self.now = {id(group): 0.0 for group in self.groups}
        self.total = 0.0
        self.first = self.r.choice((0.3, 0.6, 1.0))  # of all loads in the first step
        self.dropped = []
        for k in range(self.r.choice((1, 2, 2, 3, 3, 4))):
            self.add_step(k)
        self.deck = self.head + ''.join(curve.text() for curve in self.curves) + self.text

    def friction(self, found):
        if found.group(1):
            return found.group(0) + self.r.choice(('', ', SLIP=INCREMENTAL', ', SLIP=INCREMENTAL'))
        return found.group(0) + self.r.choice(('', '', '', ', SLIP=TOTAL'))

    def curve(self, period):
        r = self.r
        is_total = r.random() < 0.3
        span = self.total + 2*period if is_total else period
        times = sorted(r.uniform(0, span) for _ in range(r.randint(1, 3)))
        points = [(0.0, 0.0)] + [(t, r.uniform(-1, 1.2)) for t in times]
        curve = Curve(f'CURVE-{len(self.curves) + 1}', is_total, r.random() < 0.3, points)
        self.curves.append(curve)
        return curve

    def add_step(self, k):
        r = self.r
        period = r.choice((1.0, 1.0, 0.1, 2.5, 30.0))
        step = Step(period, r.random() < 0.07)
        step.began = self.total
        n = r.choice((1, 2, 3, 4, 6))
        lines = {keyword: [] for keyword in KEYWORDS}
        news = {keyword for keyword in KEYWORDS[1:] if k > 0 and r.random() < 0.1}
        for group in self.groups:
            # a card without lines is none: with OP=NEW something is given
            is_first = group.keyword in news and not lines[group.keyword]
            self.place_group(group, k, step, lines, group.keyword in news, is_first)
        self.text += '*STEP, INC=2000' + ', AMPLITUDE=STEP'*step.at_once + '\n'
        self.text += f'*STATIC\n{period/n!r}, {period!r}, {period/n/32!r}\n'
        self.write_supports(k, step, lines)
        for keyword in KEYWORDS[1:]:
            op = ', OP=NEW' if keyword in news else ''
            for data, curve in lines[keyword]:
                self.text += f'*{keyword}{op}' + (f', AMPLITUDE={curve.name}' if curve else '') + '\n' + '\n'.join(data) + '\n'
        if k == 0 or r.random() < 0.2:
            self.text += '*NODE PRINT, FREQUENCY=1\nU, RF\n*CONTACT PRINT, FREQUENCY=1\n'
        self.text += '*END STEP\n'
        self.total += period
        self.steps.append(step)
        for group, factor in step.factors(period):
            self.now[id(group)] = factor

    def place_group(self, group, k, step, lines, is_new, is_first):
        r = self.r
        before = self.now[id(group)]
        given = r.random() < 0.5 or is_first or k == 0
        if not given:
            self.leave_group(group, k, step, before, is_new)
            return
        if group.keyword in ('CLOAD', 'BOUNDARY') or group.rows[0][1] in ('BX', 'BY'):
            factor = r.choice((0.0, r.uniform(0.2, 1.2), r.uniform(0.2, 1.2), r.uniform(-0.5, 0.5), r.uniform(-1.2, -0.2)))
        else:
            factor = r.choice((0.0, r.uniform(0.3, 1.2), r.uniform(0.3, 1.2), 1.0))
        if k == 0:
            factor = self.first
        curve = self.curve(step.period) if k > 0 and r.random() < 0.15 else None
        step.groups.append((group, before, factor, curve))
        lines[group.keyword].append((scaled(group, factor), curve))

    def leave_group(self, group, k, step, before, is_new):
        if is_new:
            step.groups.append((group, before, 0.0, None))
            return
        last = None
        if k > 0:
            last = next((entry for entry in self.steps[-1].groups if entry[0] is group), None)
        if last and last[3] and last[3].is_total:
            step.groups.append((group, before, last[2], last[3]))
        else:
            step.groups.append((group, before, before, None))

    def write_supports(self, k, step, lines):
        """Zero displacements stay, but for some that go and may come back."""
        r = self.r
        dropped = self.dropped
        if k == 0:
            data = [', '.join(row) for row in self.fixed]
            if data:
                self.text += '*BOUNDARY\n' + '\n'.join(data) + '\n'
        elif dropped and r.random() < 0.7:
            self.text += '*BOUNDARY\n' + '\n'.join(', '.join(row) for row in dropped) + '\n'
            self.dropped = []
        elif self.fixed and r.random() < 0.15 and not dropped:
            self.dropped = [row for row in self.fixed if row[1] == r.choice('12')][::2]
            kept = [row for row in self.fixed if row not in self.dropped]
            if not self.dropped or not kept:
                self.dropped = []
            else:
                self.text += '*BOUNDARY, OP=NEW\n' + '\n'.join(', '.join(row) for row in kept) + '\n'
                self.give_all_again(step, lines)
        for data, curve in lines['BOUNDARY']:
            op = ', OP=NEW' if '*BOUNDARY, OP=NEW' in self.text[self.text.rindex('*STEP'):] else ''
            self.text += '*BOUNDARY' + op + (f', AMPLITUDE={curve.name}' if curve else '') + '\n' + '\n'.join(data) + '\n'
        step.fixed = [row for row in self.fixed if row not in self.dropped]

    def give_all_again(self, step, lines):
        """With OP=NEW every displacement that is to stay is given."""
        for i, (group, before, _, curve) in enumerate(step.groups):
            if group.keyword == 'BOUNDARY' and not any(data == scaled(group, step.groups[i][2]) for data, _ in lines['BOUNDARY']):
                step.groups[i] = (group, before, before, None)
                lines['BOUNDARY'].append((scaled(group, before), None))
