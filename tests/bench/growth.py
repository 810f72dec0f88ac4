#!/usr/bin/env python3
"""How time and memory grow with a deck: each kind of growth_decks.py at growing n, a line a size.

   tests/bench/growth.py [--run] [--from N] [--to N] [--beyond] [--seconds S] [--memory MIB] [--slow E] [--only REGEX] [--list]
                         [--write DIR] [PROGRAM]

--run        whole runs; otherwise `atrito check`
--from N     the smallest n, default 1000; the next ones are ten times as large
--to N       the largest, default 1000000; a kind may have its own that is smaller
--beyond     also beyond the kind's own largest n
--seconds S  a kind ends with the first size that takes longer, default 20; what takes three times as long is ended
--memory MIB limit of the address space, default 8192
--slow E     tells only kinds whose exponent is above E
--write DIR  makes the decks in DIR (n = --to), and runs nothing

Time is the processor time of the process, memory its largest resident size. The exponent is that of the time between two sizes,
the time of the smallest deck taken off; it is told where the time is above a tenth of a second. Asserts nothing."""
import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from growth_decks import KINDS  # noqa: E402

MIB = 2**20


def write_files(files, folder):
    os.makedirs(folder, exist_ok=True)
    for name, text in files.items():
        with open(os.path.join(folder, name), 'w') as file:
            file.write(text)


def measure(command, folder, seconds, memory):
    """(exit code, processor seconds, MiB)"""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (memory * MIB, memory * MIB))
        resource.setrlimit(resource.RLIMIT_CPU, (int(3 * seconds) + 1, int(3 * seconds) + 2))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with open(os.path.join(folder, 'out.txt'), 'w') as out:
        process = subprocess.Popen(command, cwd=folder, stdout=out, stderr=out, preexec_fn=limit)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = 0
    code = os.waitstatus_to_exitcode(status)
    return code, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def one_kind(name, arguments, folder, base):
    make, most, options, mode = KINDS[name]
    if mode == 'run' and not arguments.run:
        return
    n, before, slope, told = arguments.least, None, 0.0, []
    while n <= (arguments.to if arguments.beyond else min(arguments.to, most)):
        shutil.rmtree(folder, ignore_errors=True)
        files = make(n)
        write_files(files, folder)
        task = [] if arguments.run else ['check']
        place = ['-o', 'out'] if arguments.run else []
        began = time.time()
        code, seconds, mib = measure([arguments.program, *task, 'deck.inp', *place, *options], folder, arguments.seconds,
                                     arguments.memory)
        size = sum(len(text) for text in files.values())
        exponent = ''
        if before and seconds - base > 0.1 and n > before[0]:
            slope = math.log((seconds - base) / max(before[1] - base, 0.001)) / math.log(n / before[0])
            exponent = f'{slope:5.2f}'
        told.append(f'{name:30} {n:9} {size:10} {code:4} {seconds:8.2f} s {mib:8.0f} MiB {exponent}')
        before = (n, seconds)
        if seconds > arguments.seconds or code < 0 or time.time() - began > 4 * arguments.seconds:
            break
        n *= 10
    if slope >= arguments.slow or (before and before[1] > arguments.seconds):
        print('\n'.join(told), flush=True)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program', nargs='?',
                        default=os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../build/release/bin/atrito'))
    parser.add_argument('--run', action='store_true')
    parser.add_argument('--from', dest='least', type=int, default=1000)
    parser.add_argument('--to', type=int, default=1000000)
    parser.add_argument('--beyond', action='store_true')
    parser.add_argument('--seconds', type=float, default=20.0)
    parser.add_argument('--memory', type=int, default=8192)
    parser.add_argument('--slow', type=float, default=-99.0)
    parser.add_argument('--only', default='')
    parser.add_argument('--list', action='store_true')
    parser.add_argument('--write')
    arguments = parser.parse_args()
    arguments.program = os.path.abspath(arguments.program)
    names = [name for name in KINDS if re.search(arguments.only, name)]
    if arguments.list:
        print('\n'.join(names))
        return
    if arguments.write:
        for name in names:
            write_files(KINDS[name][0](min(arguments.to, KINDS[name][1])), os.path.join(arguments.write, name))
        return
    with tempfile.TemporaryDirectory() as folder:
        work = os.path.join(folder, 'work')
        write_files({'deck.inp': KINDS['heading_lines'][0](1)['deck.inp']}, work)
        task = ['deck.inp', '-o', 'out'] if arguments.run else ['check', 'deck.inp']
        base = min(measure([arguments.program, *task], work, 9, arguments.memory)[1] for _ in range(5))
        for name in names:
            one_kind(name, arguments, work, base)


if __name__ == '__main__':
    main()
