#!/usr/bin/env python3
"""Flips found again without `gnomon shimmer`: single frames are compared, each of SCALE times as many pixels a side, the
first frame's receivers are looked for in them by their positions, and V6 is read there from the frames' channels (--aov).
The light stands still, and so does the truth of a receiver that stays: it is that of the first frame, and is read nowhere
else, for beside a true edge the nearest receiver of another frame has another truth. Of the pixels around the place that
the camera shows a receiver at, the one whose own receiver lies nearest counts, where that is no farther than NEAR pixels.
Prints the rank correlation (Spearman) between the flips of both evaluations, over tiles of the picture.

shimmer_from_aov.py PROGRAM [SCENE [TECHNIQUE]]    needs oiiotool; SCENE is a built-in one
"""
import base64
import json
import math
import os
import re
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
SCENE = sys.argv[2] if len(sys.argv) > 2 else "courtyard"
TECHNIQUE = sys.argv[3] if len(sys.argv) > 3 else "hard"
WIDTH, HEIGHT, FRAMES, FPS, TILE = 400, 225, 12, 30.0, 15
SCALE = 2  # of the frames that V6 is read from, along both sides
NEAR = 1.0  # of their pixels; a pixel's middle is half its diagonal off at most, and more where the surface is seen aslant
OPTIONS = ["--map-size", "512", "--technique", TECHNIQUE, "--quiet"]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
PIXELS = range(WIDTH * HEIGHT)


def size(scale=1):
    return ["--size", f"{scale * WIDTH}x{scale * HEIGHT}"]


def channels(path, names, work, scale=1):
    """Channels of an image, as tuples, row 0 at the top."""
    few = os.path.join(work, "few" + os.path.splitext(path)[1])
    subprocess.run(["oiiotool", path, "--ch", ",".join(names), "-o", few], check=True)
    text = subprocess.run(["oiiotool", "--dumpdata", few], check=True, capture_output=True, text=True).stdout
    pixels = re.findall(r"Pixel \(\d+, \d+\): ([^\n(]*)", text)
    assert len(pixels) == scale * WIDTH * scale * HEIGHT
    return [tuple(map(float, pixel.split())) for pixel in pixels]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def camera(frame):
    """Eye, right, up, forward and the tangent of half the height's angle, as on the path `orbit`; and its azimuth and
    elevation in degrees."""
    with open(os.path.join(ROOT, "scene", "builtin", SCENE + ".json"), encoding="utf-8") as file:
        given = json.loads(re.search(r'"camera":\s*(\{[^}]*\})', file.read()).group(1))  # scene files hold comments
    eye, target, angle = given["eye"], given["target"], math.radians(10.0 * frame / FPS)
    back = [a - b for a, b in zip(eye, target)]
    turned = (math.cos(angle) * back[0] + math.sin(angle) * back[2], back[1],
              math.cos(angle) * back[2] - math.sin(angle) * back[0])
    forward = unit([-x for x in turned])
    right = unit(cross(forward, (0.0, 1.0, 0.0)))
    tangent = math.tan(math.radians(given["vertical_fov_degrees"]) / 2)
    place = tuple(a + b for a, b in zip(target, turned))
    angles = math.degrees(math.atan2(turned[0], turned[2])), math.degrees(math.asin(-forward[1]))
    return (place, right, cross(right, forward), forward, tangent), angles


def frame_of(index, work, scale):
    """The view, and of each pixel its receiver and V6 (None where it is not compared)."""
    view, angles = camera(index)
    path = os.path.join(work, "frame.exr")
    subprocess.run([PROGRAM, "compare", SCENE, *OPTIONS, *size(scale), "--runs", "1", "--no-report",
                    f"--camera-orbit={angles[0]!r},{angles[1]!r}", "--aov", path, "-o", os.path.join(work, "frame")],
                   check=True, stderr=subprocess.DEVNULL)
    position = channels(path, ["position.X", "position.Y", "position.Z"], work, scale)
    values = channels(path, ["class.V", "drawn.V"], work, scale)  # EXR files sort their channels
    return view, position, [drawn if label >= 0 else None for label, drawn in values]


def nearest(receiver, view, position, width, height):
    """The pixel whose own receiver lies nearest; None where none is near."""
    eye, right, up, forward, tangent = view
    away = (receiver[0] - eye[0], receiver[1] - eye[1], receiver[2] - eye[2])
    depth = dot(away, forward)
    if depth <= 0:
        return None
    column = math.floor((dot(away, right) / (depth * tangent * width / height) + 1.0) * width / 2)
    row = math.floor((1.0 - dot(away, up) / (depth * tangent)) * height / 2)
    best, least = None, NEAR * 2.0 * depth * tangent / height
    for y in range(max(row - 1, 0), min(row + 2, height)):
        for x in range(max(column - 1, 0), min(column + 2, width)):
            distance = math.dist(position[y * width + x], receiver)
            if distance < least:
                best, least = y * width + x, distance
    return best


def look_up(receivers, counted, view, position, drawn):
    """V6 of each receiver in a frame; None where no receiver of the frame lies near it, or none that is compared."""
    width, height = SCALE * WIDTH, SCALE * HEIGHT
    found = []
    for receiver, counts in zip(receivers, counted):
        at = nearest(receiver, view, position, width, height) if counts else None
        found.append(None if at is None else drawn[at])
    return found


def ranks(values):
    """Equal values share the mean of their places."""
    order = sorted(range(len(values)), key=values.__getitem__)
    places = {}
    for place, i in enumerate(order):
        places.setdefault(values[i], []).append(place)
    return [sum(places[v]) / len(places[v]) for v in values]


def correlation(a, b):
    mean_a, mean_b = sum(a) / len(a), sum(b) / len(b)
    both = sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b))
    return both / math.sqrt(sum((x - mean_a) ** 2 for x in a) * sum((y - mean_b) ** 2 for y in b))


def tiles(sums, steps):
    """The mean per step of each tile; None where it has no step."""
    columns, rows = WIDTH // TILE, HEIGHT // TILE
    total, count = [0.0] * (columns * rows), [0] * (columns * rows)
    for i in PIXELS:
        x, y = i % WIDTH // TILE, i // WIDTH // TILE
        if x < columns and y < rows:
            total[y * columns + x] += sums[i]
            count[y * columns + x] += steps[i]
    return [t / n if n else None for t, n in zip(total, count)]


class Changes:
    """Of each receiver over the film: flips, sum of the temporal error's size, and the pairs of frames that count."""

    def __init__(self):
        self.flips, self.sums, self.steps = [0] * (WIDTH * HEIGHT), [0.0] * (WIDTH * HEIGHT), [0] * (WIDTH * HEIGHT)
        self.near = 0  # flips that are less than 0.12 above one half: a step of 1/9, and what eight bits round

    def add(self, before, after):
        for i in PIXELS:
            if before[i] is None or after[i] is None:
                continue
            error = abs(after[i] - before[i])
            self.steps[i] += 1
            self.sums[i] += error
            self.flips[i] += error > 0.5
            self.near += 0.5 < error < 0.62


def measured(work):
    """As `gnomon shimmer` sees it, read from the frames of its page: red V6, green V0, bit 32 of blue where compared."""
    out = os.path.join(work, "film")
    subprocess.run([PROGRAM, "shimmer", SCENE, *OPTIONS, *size(), "--frames", str(FRAMES), "--path", "orbit", "--report-max-mb",
                    "1000", "-o", out], check=True, stderr=subprocess.DEVNULL)
    with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
        page = file.read()
    start = page.index('id="page-data">') + len('id="page-data">')
    films = json.loads(page[start:page.index("</script>", start)])["parts"]["film-0"]["seen"]
    changes, before, png = Changes(), None, os.path.join(work, "seen.png")
    for uri in films:
        with open(png, "wb") as file:
            file.write(base64.b64decode(uri.split(",", 1)[1]))
        after = [(r - g) / 255 if int(b) & 32 else None for r, g, b in channels(png, ["R", "G", "B"], work)]
        if before is not None:
            changes.add(before, after)
        before = after
    with open(os.path.join(out, "result.json"), encoding="utf-8") as file:
        assert sum(changes.flips) == json.load(file)["lights"][0]["flips"]
    return changes


def main():
    with tempfile.TemporaryDirectory() as work:
        film, found = measured(work), Changes()
        _, receivers, before = frame_of(0, work, 1)
        counted = [value is not None for value in before]
        for index in range(1, FRAMES):
            after = look_up(receivers, counted, *frame_of(index, work, SCALE))
            found.add(before, after)
            before = after
    print(f"{SCENE}, {TECHNIQUE}: {sum(film.flips)} flips measured ({film.near} of them by less than 0.12 above one half), "
          f"{sum(found.flips)} found again in {100 * sum(found.steps) / sum(film.steps):.0f} % of the pairs")
    for name, ours, theirs in (("flips", film.flips, found.flips), ("temporal error", film.sums, found.sums)):
        pairs = [(a, b) for a, b in zip(tiles(ours, film.steps), tiles(theirs, found.steps))
                 if a is not None and b is not None and (a > 0 or b > 0)]
        print(f"  rank correlation of {name}: {correlation(ranks([a for a, _ in pairs]), ranks([b for _, b in pairs])):.3f} "
              f"over {len(pairs)} tiles of {TILE} x {TILE} pixels")


main()
