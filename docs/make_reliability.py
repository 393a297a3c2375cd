#!/usr/bin/env python3
"""Writes docs/reliability.md: what was tried to break the program, and how often it broke.

Usage: docs/make_reliability.py BUILD [SCALE]

BUILD is a folder in which everything is built (build/release). SCALE multiplies scenes, mutations and kills (default 1:
some five minutes on two cores; the figures of a release are made with 10). What other systems and sanitizers gave takes
hours and is written by hand, and so is what other programs state of themselves.
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
FUZZ_TARGETS = {
    'json': 'scene files', 'gltf': 'glTF and GLB', 'obj': 'OBJ', 'ply': 'PLY', 'world': 'small worlds, all structures',
    'capture': 'captures', 'rubric': 'rubrics', 'sweep': "sweeps' folders", 'words': 'command lines'}
COMPARE = ['compare', 'floating-box', '--size', '96x54', '--map-size', '128', '--runs', '1', '-q']
SWEEP = ['sweep', 'floating-box', '--size', '96x54', '--map-size', '32,64,128', '--bias', '0:0.1:4', '--runs', '1', '-q']

PROMISES = """
## The same scene in other numbers

What the ray tracer says of a pixel is the same when all lengths are multiplied by a power of two, when everything moves
by 1e7, and when triangles come in another order, with another corner first, or cut into four. What is drawn:

- **Lengths times a power of two, everything moved, another order of triangles**: every pixel has the same label, with
  every technique; for another order every map and every visibility is the same to the bit.
- **Another corner first**: OpenGL interpolates a triangle's depth from one corner, so that stored depths change in their
  last bits. Only a pixel that is as good as undecided may change its label: its gap lies within rounding of the bias, or
  its filtered visibility near one half. Of the filters `msm` passes these bits on most: visibilities move by up to a
  tenth (one pixel in two million), those of `vsm`, `esm` and `evsm` by less than 0.0005.
- **Triangles cut into four**: OpenGL rounds corners to 1/256 of a pixel or texel, the new ones too, so that an edge
  moves by up to sqrt(2)/256 of a pixel. No more pixels change their label than such edges pass over.
- **Other axes** (x, y and z exchanged): this does not hold. A map's texels are aligned to the world's vertical, and a
  cube's faces to the world's axes, so that the texels lie elsewhere and other pixels are wrong.
"""

SYSTEMS = """
## Systems and sanitizers

| system | compiler | what was run | result |
|---|---|---|---|
| Debian 12 | GCC 12.2 | `.ci/run`: seven programs sanitized, then every test | 121 of 121 passed, none skipped, and 7 of 7 sanitized; 23 minutes on two cores with a compiler cache |
| Debian 12.15, a clean root (`tests/platforms/debian.sh bookworm`) | GCC 12.2, warnings are errors | `./gnomon compare fence`, then every test | 121 tests: 119 passed, none failed, 2 skipped (pandas and Blender are not there); 12 seconds with all of it in a compiler cache, and 17 minutes on two busy cores |
| Debian 13.7, a clean root (`tests/platforms/debian.sh trixie`) | GCC 14.2, warnings are errors | `./gnomon compare fence`, then every test | 121 tests: 117 passed, none failed, 4 skipped (clang-format 14, clang-tidy 14, pandas and Blender are not there); 12 and 29 minutes on two busy cores with part of a compiler cache |

In the clean roots 19 single tests of passed programs are skipped, too: the models beside the project are not there, and root
may write anywhere.

- **AddressSanitizer and UndefinedBehaviorSanitizer**: the readers of files from outside, their mutated files and the
  tracer's own tests, in every run of `.ci/run`; and every test of the program, drivers, windows, browsers and grading
  included (`./gnomon test --preset asan`, 117 tests, 82 minutes on two busy cores): no finding in the program. Seven
  programs did not pass at first, none of them for a fault of this program: drivers leak a few hundred bytes of their own,
  the sanitizer needs more addresses than a test or the grader allows, keeps freed pages back and looks for leaks after the
  last stage of a time budget; mended or skipped with words there, all seven pass. The leak checker is off in the window's tests, where a driver is unloaded before it looks,
  and in two tests that read pictures, where it crashes itself at exit (GCC 12).
- **ThreadSanitizer** (`tests/platforms/thread_sanitizer.sh`, which compiles oneTBB with it as well): `compare` of
  courtyard, fence, whitted, penumbra, studio and shapes, and the tests of the tracer, the wide tree, other structures, the
  hybrid, the loaders, bands, sweeps, shimmer and the window's threads, 312 tests, 24 minutes on two busy cores: no finding.
  With one lock of the window's thread taken out it says so.
- **libFuzzer** (clang 14 with both sanitizers, `cmake --preset fuzz`), half an hour each on a busy core, at most 2 GB and 10
  seconds an input: 351,141 scene files, 291,768 glTF files, 382,449 OBJ files and 418,371 PLY files were tried, none failed.
- **clang 14** looked at every file of the program and of its tests with the same warnings as errors (`-fsyntax-only`): two
  names that hid a member and a capture that was not used, mended.
"""

PEERS = """
## What others state of themselves

None of these programs does the same work, and none publishes the same figures; what they publish is this.

- **SQLite** tells how it is tested: every branch of its core is covered, and allocations, files and power are made to
  fail on purpose; one of its fuzzers runs about a billion mutations a day
  ([How SQLite Is Tested](https://www.sqlite.org/testing.html)). Measured by that, the mutations above are few.
- **Embree** says of its robust mode that it avoids optimizations which reduce accuracy
  ([rtcSetSceneFlags](https://www.embree.org/api.html)); its developers say that rays at vertices may still pass through
  closed geometry in it ([issue 181](https://github.com/RenderKit/embree/issues/181)). It publishes no count of such rays
  and no comparison with exact arithmetic.
- **pbrt** derives bounds of the rounding error of its intersections, and spawns rays from beyond them
  ([PBR, 4th ed., section 6.8](https://pbr-book.org/4ed/Shapes/Managing_Rounding_Error)), which is where this program's
  bounds come from. It publishes no such counts either.
"""


class Page:
    def __init__(self, build, scale):
        self.build, self.scale, self.rows, self.notes = build, scale, [], []

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
    for line in done.stdout.splitlines():
        found = re.match(r'(\w+) +(\d+) scenes, (\d+) pixels with a certain verdict, (\d+) wrong', line)
        if found:
            page.add(f'`{found[1]}` against the ray tracer: pixels of {found[2]} random scenes', int(found[3]), int(found[4]),
                     seconds, f'`random_scenes_gl_test {n}`')
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


def mutated_files(page):
    n = page.times(1500)
    for target, what in FUZZ_TARGETS.items():
        done, seconds = page.run([page.test(f'fuzz_replay_{target}'), '--mutations', str(n), '--seed', '2'])
        page.add(f'Mutations of {what}: crashes, sanity checks failed', n, 0 if done.returncode == 0 else 1, seconds,
                 f'`fuzz_replay_{target} --mutations {n} --seed 2`')


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
             'What was tried to break the program, and how often it broke. The table is written by',
             f'`docs/make_reliability.py BUILD {page.scale:g}`, last for {version}; programs lie in `BUILD/tests`.', '',
             '| what | tried | failed | seconds | command |', '|---|--:|--:|--:|---|']
    for what, tried, failed, seconds, command in page.rows:
        time_text = f'{seconds:.0f}' if seconds else ''
        lines.append(f'| {what} | {tried:,} | {failed} | {time_text} | {command} |')
    lines += ['', *page.notes] if page.notes else []
    lines += ['', 'What each hard case is stands in [hard-cases.md](hard-cases.md).']
    return '\n'.join(lines) + '\n' + PROMISES + SYSTEMS + PEERS


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    page = Page(os.path.abspath(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) == 3 else 1.0)
    for part in (exactness, hard_cases, mutated_files, faults, kills):
        part(page)
    with open(os.path.join(DOCS, 'reliability.md'), 'w', encoding='utf-8') as out:
        out.write(text_of(page))


if __name__ == '__main__':
    main()
