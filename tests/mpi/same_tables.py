#!/usr/bin/env python3
"""Are the tables of atrito-mpi those of the plain program?

   same_tables.py PLAIN MPI --ranks 1,2,3,4 [options] DECK.inp | FOLDER ...

   FOLDER         all decks below it, or what record.py has recorded
   --jobs J       so many decks at a time; default 1
   --exceptions FILE   what may differ, and why (exceptions.txt beside this file)
   --only TEXT    decks whose name has the text
   --at-most S    leaves out what takes the plain program longer [s]
   --options TEXT of atrito besides, for both: '--share all --contact sparse'
   --keep DIR     the results stay there
   --quiet        only what differs, and the sum

Both run each deck with --digits 17, the ranks with --share all; exit codes, the codes of messages and all tables are compared, these by
`atrito compare --rtol 1e-10`, which knows the scale of each column. What differs as well when the plain program solves with --solver
sparse or skyline (of --contact sparse, which heeds neither of them, with the dense form) is at the edge of double precision, and may
differ by NOISE times as much. A component that is NOTHING beside the others of its kind (KINDS) in both is round-off. Left out are
timing.tab and iterations.tab and, in other tables, how many iterations and solves it took, and times. `differs` tells the largest
difference over what would be allowed."""
import argparse, concurrent.futures, json, math, os, re, shutil, subprocess, sys, tempfile, time

RTOL = 1e-10
NOISE = 30.0                # two runs say little of how large differences may be
NOTHING = 1e-9              # of the largest of its kind; below it a component is zero but for round-off
KINDS = {'displacement': re.compile(r'u[12]?(_max|_min)?$|(max_abs_)?slip(_increment)?$'),
         'stress': re.compile(r's\d\d$|s1_max$|s3_min$|mises$|(weighted_|contact_|max_)?pressure$|(max_abs_)?shear$'),
         'force': re.compile(r'[rf][12xy]$|(normal|shear)_resultant$')}
COUNTS = {'picard_iterations', 'linear_solves', 'iterations'}
TABLE = re.compile(r'\.(tab|csv)$')
HERE = os.path.dirname(os.path.abspath(__file__))


class Deck:
    def __init__(self, name, command, path, options):
        self.name, self.command, self.path, self.options = name, command, os.path.abspath(path), options


def find_decks(paths):
    for path in paths:
        if os.path.isfile(path):
            name = os.path.relpath(path, os.path.join(HERE, '..', '..'))
            yield Deck(name if not name.startswith('..') else path, 'run', path, [])
            continue
        for folder, folders, files in os.walk(path):
            folders.sort()
            if 'run.json' in files:
                del folders[:]
                run = json.load(open(os.path.join(folder, 'run.json')))
                test, mark = run['test'].removeprefix('verify_'), os.path.basename(os.path.normpath(folder))[:6]
                name = ' '.join([f'{test}/{os.path.basename(run["deck"])}', *run['options'], f'[{mark}]'])
                yield Deck(name, run['command'], os.path.join(folder, 'files', run['deck']), run['options'])
            else:
                yield from find_decks(os.path.join(folder, file) for file in sorted(files) if file.endswith('.inp'))


def without_digits(options):
    """The options but --digits N, which both runs get anew."""
    kept, skip = [], False
    for word in options:
        if not skip and word != '--digits':
            kept.append(word)
        skip = word == '--digits' and not skip
    return kept


def arguments(deck, output, over_ranks):
    command = [] if deck.command == 'run' else [deck.command]
    share = ['--share', 'all'] if over_ranks and deck.command == 'run' else []     # small scenes, too
    proof = ['--proof', 'off'] if deck.command == 'run' else []      # over ranks there is no bound of the error
    return command + [deck.path, '-o', output] + without_digits(deck.options) + ['--digits', '17'] + share + proof


def settings():
    """What ./run --ranks sets (tools/ranks.sh); where a run ends with an error mpirun does not wait two seconds for the other ranks to end,
    which have nothing to clean up here."""
    script = f'. {HERE}/../../tools/ranks.sh; prepare_mpirun; env | grep "^OMPI_\\|^PRTE_"'
    lines = subprocess.run(['sh', '-c', script], capture_output=True, text=True).stdout.splitlines()
    return dict(os.environ, OMPI_MCA_odls_base_sigkill_timeout='0', **dict(line.split('=', 1) for line in lines))


def run(program, deck, output, environment, limit, more=()):
    """Exit code, codes of errors and warnings, seconds, all that is said."""
    begin = time.time()
    process = subprocess.Popen(program + arguments(deck, output, len(program) > 1) + list(more), env=environment, cwd=os.path.dirname(output), stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors='replace')
    try:
        said = process.communicate(timeout=limit)[1]
    except subprocess.TimeoutExpired:
        process.terminate()
        process.communicate()
        return None, [], time.time() - begin, ''
    return process.returncode, sorted(re.findall(r'(?:error|warning|note) \[([A-Z0-9-]+)\]', said)), time.time() - begin, said


def is_count(column):
    """Counts of iterations, whose digits may be lost to rounding, and times."""
    return column in COUNTS or column.endswith(('_wall', '_cpu'))


def drop_counts(folder):
    """Takes counts and times out of the tables below a folder."""
    for place, _, files in os.walk(folder):
        for path in (os.path.join(place, file) for file in files if TABLE.search(file)):
            lines = open(path, errors='replace').read().splitlines()
            separator = ',' if path.endswith('.csv') else None
            new, columns = [], []
            for line in lines:
                words = line.split(separator)
                if line.startswith('# columns:'):
                    columns = words[2:]
                elif not line.startswith('#') and separator and not columns:
                    columns = words
                elif not line.startswith('#') and any(map(is_count, columns)) and len(words) == len(columns):
                    line = (separator or ' ').join('0' if is_count(c) else w for c, w in zip(columns, words))
                if os.path.basename(path).startswith('summary.') and COUNTS & set(words):
                    continue
                new.append(line)
            if new != lines:
                open(path, 'w').write('\n'.join(new) + '\n')


def tables(folder):
    return sorted(os.path.relpath(os.path.join(place, file), folder) for place, _, files in os.walk(folder) for file in files
                  if TABLE.search(file) and not re.match(r'(timing|iterations)\.', file))


def differences(plain, a, b):
    """What `atrito compare` finds: of each table and column the largest difference, and that over what is allowed."""
    found = {}
    said = subprocess.run([plain, 'compare', a, b, '--rtol', str(RTOL)], capture_output=True, text=True, errors='replace').stdout
    for line in said.splitlines():
        place, _, rest = line.partition(': ')
        words = place.split(', ')
        if not TABLE.search(words[0]) or re.match(r'(timing|iterations)\.', words[0]):
            continue
        size = re.search(r'differ by ([-+.0-9e]+), allowed ([-+.0-9e]+)', rest)
        off = (float(size[1]), float(size[1])/max(float(size[2]), sys.float_info.min)) if size else (math.inf, math.inf)
        found[words[0], words[-1]] = max(off, found.get((words[0], words[-1]), (0.0, 0.0)))
    return found


def values_of(folder, name):
    """Pairs of column, or in a table of quantities of quantity, and value."""
    columns = []
    for line in open(os.path.join(folder, name), errors='replace').read().splitlines():
        words = line.split(',' if name.endswith('.csv') else None)
        if line.startswith('# columns:'):
            columns = words[2:]
        elif not columns and name.endswith('.csv'):
            columns = words
        elif not line.startswith('#') and len(words) == len(columns):
            quantity = words[columns.index('quantity')] if 'quantity' in columns else None
            for column, word in zip(columns, words):
                if quantity is None or column == 'value':
                    try:
                        yield quantity or column, float(word)
                    except ValueError:
                        pass


def kind_of(column):
    return next((kind for kind, pattern in KINDS.items() if pattern.match(column)), None)


def nothings(folders):
    """Table and column of what is NOTHING beside the largest of its kind, in all tables of both."""
    largest, of_kind = {}, {}
    for folder in folders:
        for name in tables(folder):
            for column, value in values_of(folder, name):
                kind = kind_of(column)
                if kind and math.isfinite(value):
                    largest[name, column] = max(abs(value), largest.get((name, column), 0.0))
                    of_kind[kind] = max(abs(value), of_kind.get(kind, 0.0))
    return {key for key, size in largest.items() if size <= NOTHING*of_kind[kind_of(key[1])]}


def compare(plain, a, b, by_others, excepted, between=None):
    """The largest difference over what is allowed, that of the excepted tables, and what is past it."""
    names_a, names_b = tables(a), tables(b)
    faults = [f'{name} only of one' for name in sorted(set(names_a) ^ set(names_b))]
    found = differences(plain, a, b)
    noise = [differences(plain, a, other) for other in by_others.folders()] if found else []
    noise.append(between or {})
    worst, worst_excepted = 0.0, 0.0
    round_off = nothings([a, b]) if found else set()
    for key, (off, ratio) in sorted(found.items()):
        if off <= NOISE*max([other.get(key, (0.0, 0.0))[0] for other in noise], default=0.0) or key in round_off:
            continue
        limit = excepted.get(os.path.basename(key[0]), excepted.get('*'))
        if limit is not None:
            worst_excepted = max(worst_excepted, ratio)
        else:
            worst = max(worst, ratio)
        if limit is None or ratio*RTOL > limit:
            faults.append(f'{key[0]} {key[1]} differs by {ratio*RTOL:.1e}')
    return f'{worst:.1e}' if worst > 0 else '0', f'{worst_excepted:.1e}' if worst_excepted > 0 else '0', faults


def read_exceptions(path):
    """Lines `DECK TABLE LIMIT REASON`, by | apart; DECK is a regular expression for the beginning of the name."""
    rows = []
    for line in open(path):
        if line.strip() and not line.startswith('#'):
            deck, table, limit, reason = [part.strip() for part in line.split('|')]
            rows.append((re.compile(deck), table, float(limit), reason))
    return rows


def others(options):
    """What else the plain program can solve with; of two words the last counts. To the sparse form the solver of the bodies is nothing."""
    if ('--contact', 'sparse') in zip(options, options[1:]):
        return [['--contact', 'dense']]
    return [['--solver', name] for name in ('sparse', 'skyline') if ('--solver', name) not in zip(options, options[1:])]


class ByOthers:
    """The results of the plain program with its other solvers: run when they are asked for, once."""

    def __init__(self, deck, options, work):
        self.deck, self.options, self.work, self.found = deck, options, work, None

    def folders(self):
        if self.found is None:
            self.found = []
            for other in others(self.deck.options):
                self.found.append(os.path.join(self.work, other[-1]))
                run([self.options.plain], self.deck, self.found[-1], None, self.options.at_most, other)
                drop_counts(self.found[-1])
        return self.found


def try_deck(deck, options, exceptions, environment):
    """Lines of the report, and whether all is as it should be."""
    work = tempfile.mkdtemp(dir=options.keep, prefix='same-')
    excepted = {table: limit for pattern, table, limit, _ in exceptions if pattern.match(deck.name)}
    try:
        plain = os.path.join(work, 'plain')
        code, said, seconds, _ = run([options.plain], deck, plain, None, options.at_most)
        if code is None:
            return [f'{deck.name}: left out, more than {options.at_most} s'], True, False
        drop_counts(plain)
        by_others, right, words = ByOthers(deck, options, work), True, []
        for n in options.ranks:
            by_ranks = os.path.join(work, f'ranks-{n}')
            found = run(['mpirun', '-n', str(n), options.mpi], deck, by_ranks, environment, 100 + 20*seconds)
            drop_counts(by_ranks)
            worst, worst_excepted, faults = compare(options.plain, plain, by_ranks, by_others, excepted)
            if faults and found[0] == code:
                # what two runs over the same ranks do not agree on is round-off: memory is aligned otherwise
                once_more = os.path.join(work, f'ranks-{n}-again')
                run(['mpirun', '-n', str(n), options.mpi], deck, once_more, environment, 100 + 20*seconds)
                drop_counts(once_more)
                between = differences(options.plain, by_ranks, once_more)
                worst, worst_excepted, faults = compare(options.plain, plain, by_ranks, by_others, excepted, between)
            if found[0] != code:
                faults.append(f'exit {found[0]}, not {code}' if found[0] is not None else 'does not end')
                faults.append('says at last: ' + ' / '.join(found[3].splitlines()[-40:]))
            if found[1] != said and 'messages' not in excepted:
                faults.append(f'said {found[1]}, not {said}')
            right = right and not faults
            words.append(f'{n} ranks {worst}' + (f' ({worst_excepted} excepted)' if worst_excepted != '0' else '') +
                         ''.join(f' FAILED: {fault}' for fault in faults))
        return [f'{deck.name}: exit {code}, {len(tables(plain))} tables, differs: {"; ".join(words)}'], right, True
    finally:
        if not options.keep:
            shutil.rmtree(work, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('plain', type=os.path.abspath)
    parser.add_argument('mpi', type=os.path.abspath)
    parser.add_argument('paths', nargs='+')
    parser.add_argument('--ranks', type=lambda text: [int(n) for n in text.split(',')], default=[1, 2, 3, 4])
    parser.add_argument('--jobs', type=int, default=1)
    parser.add_argument('--exceptions', default=os.path.join(HERE, 'exceptions.txt'))
    parser.add_argument('--only', default='')
    parser.add_argument('--at-most', type=float, default=None)
    parser.add_argument('--options', default='')
    parser.add_argument('--keep')
    parser.add_argument('--quiet', action='store_true')
    options = parser.parse_args()
    more = options.options.split()
    decks = sorted((Deck(deck.name, deck.command, deck.path, deck.options + more) for deck in find_decks(options.paths) if options.only in deck.name), key=lambda deck: deck.name)
    if options.keep:
        options.keep = os.path.abspath(options.keep)
        os.makedirs(options.keep, exist_ok=True)
    exceptions, environment = read_exceptions(options.exceptions), settings()
    wrong = compared = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for lines, right, was_run in pool.map(lambda deck: try_deck(deck, options, exceptions, environment), decks):
            wrong += not right
            compared += was_run
            if not (right and options.quiet):
                print('\n'.join(lines), flush=True)
    print(f'{compared} decks with {", ".join(map(str, options.ranks))} ranks: {wrong} differ; {len(decks) - compared} left out')
    return 1 if wrong or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
