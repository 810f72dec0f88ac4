#!/usr/bin/env python3
"""Stands in for atrito in the tests of tests/verify and records what they run, for same_tables.py.

   record.py TESTS.json PLAIN FOLDER [NAME ...]    runs the tests of `ctest --show-only=json-v1 -L verify`, all or those of these names,
                                                   with this in place of PLAIN; what they run comes into FOLDER
   record.py --run PLAIN FOLDER ARGUMENTS          one run: recorded, then PLAIN runs it

A record is a folder: the deck and what it includes below files/, and run.json with the command, the deck's place, the options and the
test that runs it. What is run twice is recorded once. Recorded are runs, sweeps, studies and limits; not what goes on from a restart file."""
import concurrent.futures, hashlib, json, os, re, shutil, subprocess, sys

COMMANDS = ('sweep', 'study', 'limit')
NOT_RUN = ('check', 'compare', 'help', '--help', '--version', 'man', 'completion')
WITH_VALUE = ('-o', '--output')
INCLUDE = re.compile(r'^\s*\*\s*include\s*,.*?input\s*=\s*("[^"]*"|[^,\n]*)', re.IGNORECASE | re.MULTILINE)


def included(path, found):
    """Adds a file and what it includes, by absolute path."""
    path = os.path.normpath(path)
    if path in found or not os.path.isfile(path):
        return
    data = open(path, 'rb').read()
    found[path] = data
    for name in INCLUDE.findall(data.decode('utf-8', 'replace')):
        included(os.path.join(os.path.dirname(path), name.strip().strip('"')), found)


def split(arguments):
    """Command, deck and options, without the folder of the results; None for what is no run."""
    words, command, options = list(arguments), 'run', []
    if not words or words[0] in NOT_RUN:
        return None
    if words[0] in COMMANDS:
        command = words.pop(0)
    deck = None
    while words:
        word = words.pop(0)
        if word in WITH_VALUE:
            words = words[1:]
        elif deck is None and not word.startswith('-') and os.path.isfile(word):
            deck = word
        elif word not in ('--plot', '--report', '--quiet'):
            options.append(word)
    return None if deck is None or {'--help', '--version', '--restart'} & set(options) else (command, deck, options)


def record(folder, arguments):
    run = split(arguments)
    if run is None:
        return
    command, deck, options = run
    found = {}
    included(os.path.abspath(deck), found)
    root = os.path.commonpath([os.path.dirname(path) for path in found])
    places = sorted((os.path.relpath(path, root), data) for path, data in found.items())
    digest = hashlib.sha256(repr((command, options, [data for _, data in places])).encode()).hexdigest()[:16]
    place = os.path.join(folder, digest)
    try:
        os.makedirs(place)
    except FileExistsError:
        return
    for name, data in places:
        path = os.path.join(place, 'files', name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        open(path, 'wb').write(data)
    with open(os.path.join(place, 'run.json'), 'w') as file:
        json.dump({'test': os.environ.get('ATRITO_RECORDED_TEST', ''), 'command': command, 'deck': os.path.relpath(os.path.abspath(deck), root),
                   'options': options}, file)


def run_test(test, plain, folder):
    """One test with the stand-in; its exit code."""
    properties = {p['name']: p['value'] for p in test.get('properties', [])}
    bin_folder = os.path.join(folder, 'bin')
    command = [os.path.join(bin_folder, 'atrito') if word == plain else word for word in test['command']]
    work = os.path.join(folder, 'work', test['name'])
    os.makedirs(work, exist_ok=True)
    log = open(os.path.join(folder, 'work', test['name'] + '.log'), 'wb')
    environment = dict(os.environ, ATRITO_RECORDED_TEST=test['name'])
    return subprocess.call(command, cwd=work, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)


def main():
    if sys.argv[1] == '--run':
        plain, folder, arguments = sys.argv[2], sys.argv[3], sys.argv[4:]
        try:
            record(folder, arguments)
        except (OSError, ValueError) as trouble:         # what cannot be recorded is run all the same
            with open(os.path.join(folder, 'trouble'), 'a') as file:
                file.write(f'{arguments}: {trouble}\n')
        os.execv(plain, [plain] + arguments)
    tests, plain, folder, names = json.load(open(sys.argv[1])), os.path.abspath(sys.argv[2]), os.path.abspath(sys.argv[3]), sys.argv[4:]
    shutil.rmtree(os.path.join(folder, 'bin'), ignore_errors=True)
    os.makedirs(os.path.join(folder, 'bin'))
    os.makedirs(os.path.join(folder, 'records'), exist_ok=True)
    for name in os.listdir(os.path.dirname(plain)):         # programs that are looked for beside atrito
        os.symlink(os.path.join(os.path.dirname(plain), name), os.path.join(folder, 'bin', name))
    stand_in = os.path.join(folder, 'bin', 'atrito')
    os.remove(stand_in)
    with open(stand_in, 'w') as file:
        file.write(f'#!/bin/sh\nexec {sys.executable} {os.path.abspath(__file__)} --run {plain} {folder}/records "$@"\n')
    os.chmod(stand_in, 0o755)
    chosen = [t for t in tests['tests'] if plain in t['command'] and (not names or t['name'] in names)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for test, code in zip(chosen, pool.map(lambda t: run_test(t, plain, folder), chosen)):
            if code != 0:
                print(f'{test["name"]}: exit {code} with the stand-in')
    print(f'{len(chosen)} tests, {len(os.listdir(os.path.join(folder, "records")))} runs recorded')


main()
