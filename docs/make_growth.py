#!/usr/bin/env python3
"""Writes the section "How long for my scene" of docs/performance.md and its chart: what `gnomon compare` takes of time and memory
for more triangles and for more pixels.

Usage: docs/make_growth.py BUILD [--triangles 0.1,1,5,20] [--pixels 0.25,1,4,16,64] [--runs 3] [--machine WORDS] [--to FOLDER]

BUILD is a folder in which the program is built (build/release). Counts are in millions. The scenes are terrains of the
same ground in ever finer triangles, which the script makes (20 M triangles: 360 MB in the folder for temporary files).
Triangles grow at 1280x720, pixels on the terrain of 1 M (or the nearest there is). Each point is the median of the
runs, each a process of its own, loading and report included. The machine should do nothing else meanwhile: some 10
minutes on two cores. --machine: what it is measured on, in a few words.
--to: where performance.md and images/ are (default: the script's own folder).
"""
import argparse
import array
import json
import math
import os
import statistics
import struct
import sys
import tempfile
import time

DOCS = os.path.dirname(os.path.abspath(__file__))
BEGIN, END = '<!-- made by make_growth.py: begin -->', '<!-- made by make_growth.py: end -->'
SIDE = 100.0  # world units


def height(x, z):
    return (2.5 * math.sin(0.11 * x) * math.cos(0.07 * z) + math.sin(0.53 * x + 0.31 * z)
            + 0.3 * math.sin(1.7 * x) * math.cos(2.1 * z))


def padded(data, filler):
    return data + filler * (-len(data) % 4)


def write_terrain(path, millions):
    """A square of 2 n^2 triangles, as one GLB; returns how many there are."""
    n = max(1, round(math.sqrt(millions * 1e6 / 2)))
    positions, indices = array.array('f'), array.array('I')
    low, high = math.inf, -math.inf
    for j in range(n + 1):
        for i in range(n + 1):
            x, z = SIDE * i / n, SIDE * j / n
            positions.extend((x, height(x, z), z))
        row = positions[-3 * (n + 1) + 1::3]
        low, high = min(low, min(row)), max(high, max(row))
    for j in range(n):
        for a in range(j * (n + 1), j * (n + 1) + n):
            below = a + n + 1
            indices.extend((a, below, a + 1, a + 1, below, below + 1))
    for numbers in (positions, indices):
        if sys.byteorder == 'big':
            numbers.byteswap()
    places, corners = 4 * len(positions), 4 * len(indices)
    document = {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 0}]}],
        'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [0.6, 0.6, 0.5, 1], 'metallicFactor': 0}}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': len(positions) // 3, 'type': 'VEC3',
                       'min': [0, low, 0], 'max': [SIDE, high, SIDE]},
                      {'bufferView': 1, 'componentType': 5125, 'count': len(indices), 'type': 'SCALAR'}],
        'bufferViews': [{'buffer': 0, 'byteLength': places},
                        {'buffer': 0, 'byteOffset': places, 'byteLength': corners}],
        'buffers': [{'byteLength': places + corners}]}
    text = padded(json.dumps(document).encode(), b' ')
    with open(path, 'wb') as file:
        file.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + places + corners))
        file.write(struct.pack('<I4s', len(text), b'JSON') + text)
        file.write(struct.pack('<I4s', places + corners, b'BIN\0'))
        positions.tofile(file)
        indices.tofile(file)
    return 2 * n * n


def size_of(millions):
    """Width and height of 16:9 with about so many pixels, at most 16384 a side."""
    rows = round(math.sqrt(millions * 1e6 * 9 / 16))
    return min(16384, round(rows * 16 / 9)), rows


def run(words):
    """Seconds and peak bytes of one process."""
    start = time.monotonic()
    process = os.posix_spawn(words[0], words, os.environ,
                             file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(process, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit('failed: ' + ' '.join(words))
    return time.monotonic() - start, usage.ru_maxrss * 1024


def measure(program, scene, size, runs, folder):
    words = [program, 'compare', scene, '--size', '{}x{}'.format(*size), '-o', os.path.join(folder, 'out'), '--quiet']
    found = [run(words) for _ in range(runs)]
    return statistics.median(s for s, _ in found), max(b for _, b in found)


def power(points, k):
    """The exponent of the straight line through the points on logarithmic axes, by least squares."""
    xs, ys = [math.log(p[0]) for p in points], [math.log(p[k]) for p in points]
    mean_x, mean_y = statistics.fmean(xs), statistics.fmean(ys)
    spread = sum((x - mean_x) ** 2 for x in xs)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / spread if spread else math.nan


def short(number):
    return f'{number:.3g}'


class Panel:
    """One chart on logarithmic axes: seconds and gigabytes over a count in millions."""
    WIDTH, HEIGHT, LEFT, TOP = 360, 260, 52, 34

    def __init__(self, title, points, left):
        self.title, self.points, self.x0 = title, points, left
        values = [v for _, s, b in points for v in (s, b / 1e9)]
        self.x = self.decades([p[0] for p in points])
        low, high = self.decades(values)
        self.y = low - 0.1, high  # room for the words below the lower line

    @staticmethod
    def decades(values):
        low, high = math.log10(min(values)), math.log10(max(values))
        pad = max(0.1, 0.06 * (high - low))
        return low - pad, high + pad

    def place(self, x, y):
        across = (math.log10(x) - self.x[0]) / (self.x[1] - self.x[0])
        up = (math.log10(y) - self.y[0]) / (self.y[1] - self.y[0])
        return self.x0 + self.LEFT + across * self.WIDTH, self.TOP + (1 - up) * self.HEIGHT

    def ticks(self, span):
        out = []
        for decade in range(math.floor(span[0]), math.ceil(span[1]) + 1):
            out += [m * 10.0 ** decade for m in (1, 2, 5) if span[0] <= math.log10(m * 10.0 ** decade) <= span[1]]
        return out

    def svg(self):
        left, right = self.x0 + self.LEFT, self.x0 + self.LEFT + self.WIDTH
        bottom = self.TOP + self.HEIGHT
        out = [f'<text x="{left}" y="20" class="title">{self.title}</text>']
        for x in self.ticks(self.x):
            px, _ = self.place(x, 10 ** self.y[0])
            out.append(f'<path class="grid" d="M{px:.1f} {self.TOP}V{bottom}"/>'
                       f'<text x="{px:.1f}" y="{bottom + 16}" text-anchor="middle">{short(x)}</text>')
        for y in self.ticks(self.y):
            _, py = self.place(10 ** self.x[0], y)
            out.append(f'<path class="grid" d="M{left} {py:.1f}H{right}"/>'
                       f'<text x="{left - 6}" y="{py + 4:.1f}" text-anchor="end">{short(y)}</text>')
        for name, unit, k, scale in (('time', 's', 1, 1.0), ('memory', 'GB', 2, 1e-9)):
            places = [self.place(p[0], p[k] * scale) for p in self.points]
            path = 'M' + 'L'.join(f'{x:.1f} {y:.1f}' for x, y in places)
            out.append(f'<path class="{name}" d="{path}"/>')
            out += [f'<circle class="{name}" cx="{x:.1f}" cy="{y:.1f}" r="3"/>' for x, y in places]
            x, y = places[0]  # where the lines are flat and apart
            out.append(f'<text class="{name}" x="{x + 8:.1f}" y="{y + 16:.1f}">{name}, {unit}</text>')
        return '\n'.join(out)


STYLE = '''<style>
text { font: 12px sans-serif; fill: #333 } .title { font-weight: bold } path { fill: none }
.grid { stroke: #ddd } path.time { stroke: #0072b2; stroke-width: 2 } path.memory { stroke: #d55e00; stroke-width: 2 }
circle.time, text.time { fill: #0072b2 } circle.memory, text.memory { fill: #d55e00 }
</style>'''


def chart(by_triangles, by_pixels):
    step = Panel.LEFT + Panel.WIDTH + 30
    panels = [Panel('million triangles, 1280x720', by_triangles, 0),
              Panel('million pixels, one terrain', by_pixels, step)]
    width, tall = 2 * step, Panel.TOP + Panel.HEIGHT + 30
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {tall}" width="{width}" height="{tall}">\n'
            f'{STYLE}\n<rect width="{width}" height="{tall}" fill="#fff"/>\n'
            + '\n'.join(panel.svg() for panel in panels) + '\n</svg>\n')


def table(what, points):
    rows = [f'| {what} | time, s | peak memory, GB |', '|---:|---:|---:|']
    rows += [f'| {short(x)} M | {s:.2f} | {b / 1e9:.2f} |' for x, s, b in points]
    rows.append(f'| grows by the power | {power(points, 1):.2f} | {power(points, 2):.2f} |')
    return '\n'.join(rows)


def section(by_triangles, by_pixels, terrain, wanted):
    return f'''{BEGIN}
## How long for my scene

`gnomon compare` on terrains of the same ground in ever finer triangles, loading and report included; medians of {wanted.runs}
runs{f' on {wanted.machine}' if wanted.machine else ''} (docs/make_growth.py). A power is the slope of the straight line through
a column's points on logarithmic axes: below 1 where a part does not grow. A picture that would take more than `--memory`
is worked through in bands, which is where its memory stops growing with all that a pixel needs.

![Time and peak memory over triangles and pixels](images/growth.svg)

{table('triangles, at 1280x720', by_triangles)}

{table(f'pixels, on {short(terrain)} M triangles', by_pixels)}
{END}'''


def put_section(path, text):
    with open(path, encoding='utf-8') as file:
        page = file.read()
    if BEGIN in page:
        page = page[:page.index(BEGIN)] + text + page[page.index(END) + len(END):]
    else:
        page = page.rstrip('\n') + '\n\n' + text + '\n'
    with open(path, 'w', encoding='utf-8') as file:
        file.write(page)


def counts(text):
    return [float(word) for word in text.split(',')]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build')
    parser.add_argument('--triangles', type=counts, default=counts('0.1,1,5,20'))
    parser.add_argument('--pixels', type=counts, default=counts('0.25,1,4,16,64'))
    parser.add_argument('--runs', type=int, default=3)
    parser.add_argument('--machine', default='')
    parser.add_argument('--to', default=DOCS)
    wanted = parser.parse_args()
    program = os.path.join(os.path.abspath(wanted.build), 'app', 'gnomon')
    by_triangles, by_pixels = [], []
    with tempfile.TemporaryDirectory() as folder:
        scenes = {}
        for millions in wanted.triangles:
            scenes[millions] = os.path.join(folder, f'terrain-{millions}.glb')
            triangles = write_terrain(scenes[millions], millions)
            print(f'{triangles} triangles', file=sys.stderr)
            by_triangles.append((triangles / 1e6, *measure(program, scenes[millions], (1280, 720), wanted.runs, folder)))
        middle = min(wanted.triangles, key=lambda m: abs(m - 1))
        for millions in wanted.pixels:
            size = size_of(millions)
            print('{} x {} pixels'.format(*size), file=sys.stderr)
            by_pixels.append((size[0] * size[1] / 1e6, *measure(program, scenes[middle], size, wanted.runs, folder)))
    os.makedirs(os.path.join(wanted.to, 'images'), exist_ok=True)
    with open(os.path.join(wanted.to, 'images', 'growth.svg'), 'w', encoding='utf-8') as file:
        file.write(chart(by_triangles, by_pixels))
    put_section(os.path.join(wanted.to, 'performance.md'), section(by_triangles, by_pixels, middle, wanted))


if __name__ == '__main__':
    main()
