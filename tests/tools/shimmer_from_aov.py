#!/usr/bin/env python3
"""Flips found again without `gnomon shimmer`: single frames are compared, the first frame's receivers are looked for in
each by projection, and V6 - V0 is read there from the frames' channels (--aov). Prints the rank correlation (Spearman)
between the flips of both evaluations, over tiles of the picture.

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
OPTIONS = ["--size", f"{WIDTH}x{HEIGHT}", "--map-size", "512", "--technique", TECHNIQUE, "--quiet"]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
PIXELS = range(WIDTH * HEIGHT)


def channels(path, names, work):
    """Channels of an image, as tuples, row 0 at the top."""
    few = os.path.join(work, "few" + os.path.splitext(path)[1])
    subprocess.run(["oiiotool", path, "--ch", ",".join(names), "-o", few], check=True)
    text = subprocess.run(["oiiotool", "--dumpdata", few], check=True, capture_output=True, text=True).stdout
    pixels = re.findall(r"Pixel \(\d+, \d+\): ([^\n(]*)", text)
    assert len(pixels) == WIDTH * HEIGHT
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


def frame_of(index, work):
    view, angles = camera(index)
    path = os.path.join(work, "frame.exr")
    subprocess.run([PROGRAM, "compare", SCENE, *OPTIONS, "--runs", "1", "--no-report", f"--camera-orbit={angles[0]!r},{angles[1]!r}",
                    "--aov", path, "-o", os.path.join(work, "frame")], check=True, stderr=subprocess.DEVNULL)
    position = channels(path, ["position.X", "position.Y", "position.Z"], work)
    values = channels(path, ["class.V", "drawn.V", "truth.V"], work)  # EXR files sort their channels
    return view, position, [drawn - truth if label >= 0 else None for label, drawn, truth in values]


def look_up(receivers, view, position, error):
    """V6 - V0 of each receiver in a frame; None where the frame does not show it, or does not compare it."""
    eye, right, up, forward, tangent = view
    found = []
    for receiver in receivers:
        away = (receiver[0] - eye[0], receiver[1] - eye[1], receiver[2] - eye[2])
        depth = dot(away, forward)
        value = None
        if depth > 0:
            column = math.floor((dot(away, right) / (depth * tangent * WIDTH / HEIGHT) + 1.0) * WIDTH / 2)
            row = math.floor((1.0 - dot(away, up) / (depth * tangent)) * HEIGHT / 2)
            if 0 <= column < WIDTH and 0 <= row < HEIGHT:
                at = row * WIDTH + column
                if math.dist(position[at], receiver) < 4.0 * depth * tangent / HEIGHT:  # two pixels
                    value = error[at]
        found.append(value)
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


def tiles(flips):
    columns, rows = WIDTH // TILE, HEIGHT // TILE
    out = [0] * (columns * rows)
    for i in PIXELS:
        x, y = i % WIDTH // TILE, i // WIDTH // TILE
        if x < columns and y < rows:
            out[y * columns + x] += flips[i]
    return out


def measured(work):
    """Flips of each receiver as `gnomon shimmer` counts them, read from the frames of its page."""
    out = os.path.join(work, "film")
    subprocess.run([PROGRAM, "shimmer", SCENE, *OPTIONS, "--frames", str(FRAMES), "--path", "orbit", "--report-max-mb", "1000",
                    "-o", out], check=True, stderr=subprocess.DEVNULL)
    with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
        page = file.read()
    start = page.index('id="page-data">') + len('id="page-data">')
    films = json.loads(page[start:page.index("</script>", start)])["parts"]["film-0"]["flips"]
    flips, png = [0] * (WIDTH * HEIGHT), os.path.join(work, "flips.png")
    for uri in films:
        with open(png, "wb") as file:
            file.write(base64.b64decode(uri.split(",", 1)[1]))
        marked = channels(png, ["R", "G", "B"], work)
        flips = [count + (value[0] > 0) for count, value in zip(flips, marked)]
    with open(os.path.join(out, "result.json"), encoding="utf-8") as file:
        assert sum(flips) == json.load(file)["lights"][0]["flips"]
    return flips


def main():
    with tempfile.TemporaryDirectory() as work:
        flips = measured(work)
        _, receivers, before = frame_of(0, work)
        found = [0] * len(flips)
        for index in range(1, FRAMES):
            view, position, error = frame_of(index, work)
            after = look_up(receivers, view, position, error)
            for i in PIXELS:
                if before[i] is not None and after[i] is not None and abs(after[i] - before[i]) > 0.5:
                    found[i] += 1
            before = after
    pairs = [(a, b) for a, b in zip(tiles(flips), tiles(found)) if a > 0 or b > 0]
    print(f"{SCENE}, {TECHNIQUE}: {sum(flips)} flips measured, {sum(found)} found again, rank correlation "
          f"{correlation(ranks([a for a, _ in pairs]), ranks([b for _, b in pairs])):.3f} over {len(pairs)} tiles of "
          f"{TILE} x {TILE} pixels")


main()
