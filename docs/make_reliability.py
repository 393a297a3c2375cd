#!/usr/bin/env python3
"""Writes the table of docs/reliability.md: what was tried to break the program, and how often it broke.

Usage: docs/make_reliability.py BUILD [SCALE]

BUILD is a folder in which everything is built (build/release). SCALE multiplies scenes, mutations and kills (default 1:
some five minutes on two cores; the figures of a release are made with 10). What stands below the table is written by hand.
"""
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DOCS = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(DOCS, 'reliability.md')
TESTS = os.path.join(os.path.dirname(DOCS), 'tests')
RANDOM_COMPARE = os.path.join(TESTS, 'tools', 'random_compare.py')
FAULTS = os.path.join(TESTS, 'faults', 'campaign.py')
BELOW = '\nWhat each hard case is stands in'
FUZZ_TARGETS = {
    'json': 'scene files', 'gltf': 'glTF and GLB', 'obj': 'OBJ', 'ply': 'PLY', 'world': 'small worlds, all structures',
    'capture': 'captures', 'rubric': 'rubrics', 'sweep': "sweeps' folders", 'words': 'command lines'}
RANDOMISED = ['raytrace_test', 'raytrace_solids_test', 'raytrace_packet_test', 'raytrace_wide_test', 'raytrace_cells_test',
              'raytrace_accel_test', 'raytrace_two_level_test', 'hybrid_test', 'effects_test']
COMPARE = ['compare', 'floating-box', '--size', '96x54', '--map-size', '128', '--runs', '1', '-q']
FAILING_CALLS = """## Single calls that fail

One call of the C library fails in each run: the n-th write, fsync, rename, open, mkdir, unlink, read, listing of a folder, mmap,
malloc, thread, process or pipe. Here n is spread evenly and over all calls that publish. "Reached" are the points at which the
program was the one to answer; calls of a graphics driver's own, of which `tests/faults/points.py` says why, are not. In further runs
somebody has planted something where the command writes (`tests/faults/planted.py`): lists, links, FIFOs, another user's things."""
SWEEP = ['sweep', 'floating-box', '--size', '96x54', '--map-size', '32,64,128', '--bias', '0:0.1:4', '--runs', '1', '-q']


class Page:
    def __init__(self, build, scale):
        self.build, self.scale, self.rows, self.notes, self.tables = build, scale, [], [], []

    def program(self):
        return os.path.join(self.build, 'app', 'gnomon')

    def test(self, name):
        return os.path.join(self.build, 'tests', name)

    def times(self, count):
        return max(1, round(count * self.scale))

    def run(self, words, **more):
        start = time.monotonic()
        done = subprocess.run(words, capture_output=True, text=True, errors='replace', **more)
        return done, time.monotonic() - start

    def add(self, what, tried, failed, seconds, command):
        print(f'{what}: {tried} tried, {failed} failed, {seconds:.0f} s', file=sys.stderr)
        self.rows.append((what, tried, failed, seconds, command))


def numbers(text):
    return [int(n) for n in re.findall(r'\b\d+\b', text)]


def exactness(page):
    n = page.times(300)
    done, seconds = page.run([page.test('precisions_agree_test'), str(n)])
    pixels, doubtful, differ, asked, wrong = numbers(done.stdout)[:5]
    page.add(f'`robust` against `exact`: pixels of {n} random scenes of which `robust` is certain', pixels - doubtful, differ,
             seconds, f'`precisions_agree_test {n}`')
    page.add('`exact` against rational numbers: pixels of those scenes', asked, wrong, 0, 'the same')
    n = page.times(200)
    done, seconds = page.run([page.test('random_scenes_gl_test'), str(n)])
    found = re.findall(r'(\w+) +(\d+) scenes, (\d+) pixels surely lit or shadowed, (\d+) wrong', done.stdout)
    if len(found) != 2:
        sys.exit(f'random_scenes_gl_test said something else:\n{done.stdout}{done.stderr}')
    for technique, scenes, pixels, wrong in found:
        page.add(f'`{technique}` against the ray tracer: pixels of {scenes} random scenes', int(pixels), int(wrong), seconds,
                 f'`random_scenes_gl_test {n}`')
        seconds = 0
    n = page.times(1e6)
    done, seconds = page.run([page.test('exact_gmp_test'), str(n)])
    page.add('`exact` against rational numbers: triangles of eight hard kinds', n, 0 if done.returncode == 0 else 'some',
             seconds, f'`exact_gmp_test {n}`')
    n = page.times(2)
    done, seconds = page.run([page.test('compare_invariance_gl_test')], env=dict(os.environ, GNOMON_INVARIANCE=str(n)))
    failures = done.stdout.count(': Failure')
    page.add(f'{n} random scene{"s" if n > 1 else ""}, every technique: scaled, shuffled, cut, moved', 6 * n, failures, seconds,
             f'`GNOMON_INVARIANCE={n} compare_invariance_gl_test`')


def hard_cases(page):
    done, seconds = page.run([page.program(), 'verify', '--rays', str(page.times(100000)), '--json', '-', '-q'])
    rows = json.loads(done.stdout)['rows']
    page.add(f'Hard cases: checks in the {len(rows)} rows of `gnomon verify`', sum(r['tried'] for r in rows),
             sum(r['wrong'] for r in rows if not r['ok']), seconds, f'`gnomon verify --rays {page.times(100000)}`')


def other_seeds(page):
    n, ran, failed, seconds = page.times(0.5), 0, 0, 0.0
    for seed in range(1, n + 1):
        for program in RANDOMISED:
            done, took = page.run([page.test(program)], env=dict(os.environ, GNOMON_TEST_SEED=str(seed)))
            count = re.search(r'(\d+) tests? from \d+ test suites? ran', done.stdout)
            wrong = re.search(r'(\d+) FAILED TEST', done.stdout)
            ran, seconds = ran + (int(count[1]) if count else 0), seconds + took
            failed += int(wrong[1]) if wrong else done.returncode != 0
    page.add(f'The tests of the tracer, the hybrid and the effects with {n} other seed{"s" if n > 1 else ""}: tests', ran, failed,
             seconds, f'`GNOMON_TEST_SEED=1` to `{n}`, `{RANDOMISED[0]}` and {len(RANDOMISED) - 1} more')


def random_comparisons(page):
    n = page.times(10)
    done, seconds = page.run([sys.executable, RANDOM_COMPARE, page.program(), str(n)])
    found = re.search(r'(\d+) runs, (\d+) failed', done.stdout)
    if not found:
        sys.exit(f'random_compare.py said something else:\n{done.stdout}{done.stderr}')
    page.add('Random scenes and options: sums that are none, other results with other threads, bands or structures', n, int(found[2]),
             seconds, f'`tests/tools/random_compare.py BUILD/app/gnomon {n}`')


def mutated_files(page):
    n, failed, seconds = page.times(1500), 0, 0.0
    for target in FUZZ_TARGETS:
        done, took = page.run([page.test(f'fuzz_replay_{target}'), '--mutations', str(n), '--seed', '2'])
        failed += done.returncode != 0
        seconds += took
    page.add(f'Mutations of {", ".join(FUZZ_TARGETS.values())}, {n:,} each: crashes, sanity checks failed', n * len(FUZZ_TARGETS),
             failed, seconds, f'`fuzz_replay_NAME --mutations {n} --seed 2` ({", ".join(FUZZ_TARGETS)})')


def faults(page):
    names = 'Faults.*:NoDataLost.*:FewResources.*:Outside.*:Names.*:ExitCodes.*:Interrupt.*'
    done, seconds = page.run([page.test('app_test'), f'--gtest_filter={names}'])
    ran = re.search(r'(\d+) tests? from \d+ test suites? ran', done.stdout)
    failed = re.search(r'\[  FAILED  \] (\d+) test', done.stdout)
    skipped = re.search(r'\[  SKIPPED \] (\d+) test', done.stdout)
    page.add('Faults provoked (full disk, limits, signals, broken pipe, no driver, an error in a thread, ...): tests',
             int(ran[1]) if ran else 0, int(failed[1]) if failed else 0, seconds, f"`app_test --gtest_filter='{names}'`")
    if skipped:
        page.notes.append(f'{skipped[1]} of the tests of faults were skipped: what they need is not on this machine.')


def failing_calls(page):
    n = page.times(200)
    with tempfile.TemporaryDirectory() as here:
        table = os.path.join(here, 'table.md')
        done, seconds = page.run([sys.executable, FAULTS, page.program(), page.test('libfault_injector.so'), '--points', str(n),
                                  '--jobs', str(os.cpu_count()), '--table', table])
        if os.path.exists(table):
            page.tables.append(open(table, encoding='utf-8').read())
    found = re.search(r'^(\d+) points of (\d+) commands, (\d+) reached: (.*)$', done.stdout, re.MULTILINE)
    if not found:
        sys.exit(f'campaign.py said something else:\n{done.stdout}{done.stderr}')
    page.add(f'Single calls that fail (files, memory, threads, processes), planted folders and links, in {found[2]} commands: half outputs, older results or '
             "files of the user's harmed, wrong exit codes, crashes, hangs", int(found[3]), sum(numbers(found[4])), seconds,
             f'`tests/faults/campaign.py BUILD/app/gnomon BUILD/tests/libfault_injector.so --points {n} --table FILE`')


def killed(page, words, folder, after):
    process = subprocess.Popen([page.program(), *words, '-o', folder], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    try:
        process.wait(timeout=after)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        process.wait()


def files_of(folder):
    return {name: open(os.path.join(folder, name), 'rb').read() for name in ('sweep.jsonl', 'sweep.json')}


def kills(page):
    moments = random.Random(1)
    with tempfile.TemporaryDirectory() as here:
        whole = os.path.join(here, 'whole')
        start = time.monotonic()
        page.run([page.program(), *COMPARE, '-o', whole])
        length, expected = time.monotonic() - start, set(os.listdir(whole))
        n, partial = page.times(60), 0
        for _ in range(n):
            folder = os.path.join(here, 'out')
            killed(page, COMPARE, folder, moments.uniform(0.0, 1.2 * length))
            partial += os.path.isdir(folder) and set(os.listdir(folder)) != expected
            shutil.rmtree(folder, ignore_errors=True)
        page.add('`compare` killed (SIGKILL) at random moments: folders that are neither whole nor absent', n, partial,
                 time.monotonic() - start, 'this script')
        start = time.monotonic()
        page.run([page.program(), *SWEEP, '-o', os.path.join(here, 'sweep')])
        length, expected = time.monotonic() - start, files_of(os.path.join(here, 'sweep'))
        n, wrong = page.times(25), 0
        for _ in range(n):
            folder = os.path.join(here, 'sweep-out')
            killed(page, SWEEP, folder, moments.uniform(0.0, length))
            done, _ = page.run([page.program(), *SWEEP, '-o', folder])
            wrong += done.returncode != 0 or files_of(folder) != expected
            shutil.rmtree(folder, ignore_errors=True)
        page.add('`sweep` killed at random moments and run again: other bytes than without', n, wrong,
                 time.monotonic() - start, 'this script')


def text_of(page):
    version = page.run([page.program(), '--version'])[0].stdout.strip()
    lines = ['# Reliability', '',
             'For whoever asks whether the program can be relied on: what was tried to break it, and how often it broke. The table is',
             f'written by `docs/make_reliability.py BUILD {page.scale:g}`, last for {version}; programs lie in `BUILD/tests`.', '',
             '| what | tried | failed | seconds | command |', '|---|--:|--:|--:|---|']
    for what, tried, failed, seconds, command in page.rows:
        time_text = f'{seconds:.0f}' if seconds else ''
        lines.append(f'| {what} | {tried:,} | {failed} | {time_text} | {command} |')
    lines += ['', *page.notes] if page.notes else []
    lines += ['', FAILING_CALLS, '', *(table.rstrip('\n') for table in page.tables)] if page.tables else []
    with open(PAGE, encoding='utf-8') as before:
        text = before.read()
    return '\n'.join(lines) + '\n' + text[text.index(BELOW):]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    page = Page(os.path.abspath(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) == 3 else 1.0)
    for part in (exactness, hard_cases, other_seeds, random_comparisons, mutated_files, faults, failing_calls, kills):
        part(page)
    text = text_of(page)
    with open(PAGE, 'w', encoding='utf-8') as out:
        out.write(text)


if __name__ == '__main__':
    main()
