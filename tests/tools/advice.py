#!/usr/bin/env python3
"""Takes what `gnomon compare` and `gnomon tune` advise, draws it, and holds it to what was promised.

usage: advice.py GNOMON [RUNS [SEED [MODELS]]]      60 runs from seed 0 unless said otherwise; MODELS: a folder of models

Scenes are the program's own and those of the folder; techniques, map sizes, biases and filters are drawn at random. Of a figure
that is said exactly the drawing may differ by 0.1 points, of one said with "about" by a fifth. What is advised is appended to the
command as it stands. What is to be tried is worse neither in the share of wrong pixels nor in the mean error. A smaller map that would do has edges that are off by less than half
a pixel, and asks for no smaller one itself. Prints what does not hold, with its command, and a table. Exit code 1 when there
was any such, 77 where the folder has no models.
"""
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

SCENES = ("acne-floor", "fence", "filtering", "floating-box", "penumbra", "far-away", "light-leaks", "peter-panning", "sphere-plane",
          "teapot", "thin-wall", "wires")  # of one light
NOON = str(pathlib.Path(__file__).parent.parent / "data/advice/noon.json")
# What went wrong once: tried every time.
KNOWN = (("acne-floor", {"--technique": "pcf", "--map-size": "1024", "--bias": "0"}),
         ("acne-floor", {"--technique": "pcf", "--map-size": "2048", "--bias": "0"}),
         (NOON, {}), (NOON, {"--map-size": "512"}))
# Settings far from the technique's own, which are advised: of these something has to be said.
FAR_OFF = (("teapot", {"--technique": "esm", "--bias": "1"}), ("floating-box", {"--technique": "esm", "--esm-exponent": "5"}),
           ("fence", {"--technique": "csm", "--cascades": "1", "--map-size": "256"}),
           ("floating-box", {"--technique": "pcf", "--filter-kernel": "vogel", "--filter-samples": "2", "--filter-radius": "3",
                             "--map-size": "256", "--bias": "0.5"}),
           ("penumbra", {"--technique": "pcf", "--filter-kernel": "vogel", "--filter-samples": "4"}))
MODEL_ENDINGS = (".glb", ".gltf", ".obj", ".ply")
TECHNIQUES = ("hard", "hard", "hard", "pcf", "pcf", "pcss", "vsm", "evsm", "msm", "esm", "csm", "second-depth")
SIZE = ["--size", "160x90"]
SECONDS = 600
TRY = re.compile(r"(?:Try|,|or) (--[a-z].*?): (.*?)\.(?= |$)")
WOULD_DO = re.compile(r"A map of (\d+) would do .*?: its shadow edges are off by ([\d.e-]+) pixels?, (.*?)\.(?= |$)")


def words_of(options):
    return [word for name, value in options.items() for word in ([name, value] if value is not None else [name])]


def options_of(text):
    """The options of "--slope-bias 1 --bias auto"."""
    options = {}
    for part in text.split("--")[1:]:
        name, _, value = part.strip().partition(" ")
        options["--" + name] = value or None
    return options


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *words):
        command = [self.path, *words]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
        if done.returncode not in (0, 1):
            raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip().splitlines()[-1:]}")
        return done.stdout

    def compare(self, scene, options, appended=""):
        """The sentences of the first light, and its part of result.json."""
        out = self.folder / "compared"
        text = self.run("compare", scene, *SIZE, *words_of(options), *appended.split(), "--runs", "1", "--no-report", "-o", str(out))
        light = json.loads((out / "result.json").read_text())["lights"][0]
        said = " ".join(line.strip() for line in text.split("\n\n")[0].splitlines())
        return next(part for part in re.split(r"(?:^| )\S+: (?=Shadow error|No shadow error|No pixel)", said) if part), light


def promised(words, error, compared):
    """What is said as (figure of the error, value, tolerance)."""
    if found := re.search(r"([\d.]+) % on average", words):
        key = "mean_absolute"
    elif found := re.search(r"mean error (?:about )?([\d.]+) %", words):
        key = "mean_absolute"
    elif found := re.search(r"([\d.]+) % wrong", words):
        key = "wrong_fraction"
    elif found := re.search(r"([\d.]+) pixels? wrong", words):
        return "wrong_fraction", float(found[1]) / compared, 1e-3
    elif "none wrong" in words:
        return "wrong_fraction", 0.0, 1e-3
    else:
        raise RuntimeError(f"not understood: {words}")
    value = float(found[1]) / 100
    return key, value, 0.2 * value if "about" in words else 1e-3


def random_options(rng):
    technique = rng.choice(TECHNIQUES)
    options = {"--technique": technique, "--map-size": rng.choice(["128", "256", "512", "1024", "2048"])}
    if rng.random() < 0.7:
        options["--bias"] = rng.choice(["0", "0", "0.1texel", "2texel", "10texel", "0.01"])
    if rng.random() < 0.2:
        options["--slope-bias"] = rng.choice(["1", "3"])
    if technique == "pcf":
        options["--filter-radius"] = rng.choice(["0.5", "1.5", "2.5"])
        if rng.random() < 0.5:
            options["--filter-plane"] = "off"
        if rng.random() < 0.3:
            options.update({"--filter-kernel": "vogel", "--filter-samples": rng.choice(["2", "16"])})
    if technique == "esm" and rng.random() < 0.5:
        options["--esm-exponent"] = rng.choice(["5", "20"])
    if technique == "csm" and rng.random() < 0.5:
        options["--cascades"] = rng.choice(["1", "2"])
    if rng.random() < 0.2:
        options["--depth-format"] = "d16"
    if technique in ("vsm", "evsm", "msm"):
        options["--bleeding-reduction"] = rng.choice(["0", "0.2"])
    return options


class Checks:
    def __init__(self, program):
        self.program, self.failures, self.rows = program, [], {}

    def row(self, kind, *, kept, off=0.0):
        counts = self.rows.setdefault(kind, [0, 0, 0.0])
        counts[0] += 1
        counts[1] += kept
        counts[2] = max(counts[2], off)

    def hold(self, kind, scene, options, faults, off):
        self.row(kind, kept=not faults, off=off)
        for fault in faults:
            self.failures.append(f"{kind}: gnomon compare {scene} {' '.join(SIZE + words_of(options))}: {fault}")

    def compare(self, scene, options, *, advised=False):
        try:
            said, before = self.program.compare(scene, options)
        except RuntimeError as refused:
            if "--technique" not in str(refused):  # cascades are for directional lights
                raise
            return
        compared = before["pixels"]["compared"]
        head = re.split(r" (?:Try|A map of) ", said)[0]
        if found := re.search(r"; ([\d.]+) % wrong", head):
            off = abs(float(found[1]) / 100 - before["error"]["wrong_fraction"])
            self.hold("compare, first line", scene, options, [head] if off > 1e-3 else [], off)
        for arguments, words in TRY.findall(said):
            try:
                _, after = self.program.compare(scene, options, arguments)
            except RuntimeError as refused:
                self.hold("compare, Try", scene, options, [f"{arguments}: {refused}"], 0.0)
                continue
            key, value, tolerance = promised(words, before["error"], compared)
            off = abs(after["error"][key] - value)
            faults = [f"{arguments}: said {words}, drawn {after['error'][key]:.5f}"] if off > tolerance else []
            faults += [f"{arguments}: {name} is {after['error'][name]:.5f} from {before['error'][name]:.5f}"
                       for name in ("wrong_fraction", "mean_absolute") if after["error"][name] > before["error"][name] + 1e-9]
            self.hold("compare, Try", scene, options, faults, off)
        for size, pixels, words in WOULD_DO.findall(said):
            again, after = self.program.compare(scene, options, f"--map-size {size}")
            key, value, tolerance = promised(words, before["error"], compared)
            off = abs(after["error"][key] - value)
            faults = [f"{size}: said {words}, drawn {after['error'][key]:.5f}"] if off > tolerance else []
            if not after["edges"]["rms_pixels"] < 0.5 or "would do" in again:
                faults.append(f"{size}: edges off by {after['edges']['rms_pixels']:.3f} (said {pixels}); {again}")
            self.hold("compare, would do", scene, options, faults, off)
        if "Try" not in said and "would do" not in said:
            self.hold("compare, nothing advised", scene, options, [said] if advised else [], 0.0)

    def tune(self, rng, scene):
        goal = rng.choice(["0.5%", "1%", "2%", "mean:1%"])
        engine = rng.choice([None, "playcanvas", "godot", "unity", "three", "filament"])
        words = ["--max-error", goal, "--map-size", "128:1024:x2", "--runs", "1"] + (["--engine", engine] if engine else ["--technique", "hard,pcf,vsm"])
        try:
            answer = json.loads(self.program.run("tune", scene, *SIZE, *words, "--json", "-"))
        except RuntimeError as refused:  # an engine that cannot be told
            if engine and "--engine" in str(refused):
                return
            raise
        options = options_of(answer["command"])
        options.pop("--size", None)
        _, after = self.program.compare(scene, options)
        errors = after["error"]
        drawn = errors["mean_absolute"] if goal.startswith("mean") else max(errors["wrong_fraction"], errors["mean_absolute"])
        off = abs(drawn - answer["error"])
        faults = [f"tune {' '.join(words)}: said {answer['error']:.5f}, drawn {drawn:.5f}"] if off > 1e-3 else []
        self.hold("tune" + (", an engine's" if engine else ""), scene, options, faults, off)


def main():
    words = sys.argv[1:] + [None] * 4
    program, runs, seed, models = words[0], int(words[1] or 60), int(words[2] or 0), words[3]
    scenes = list(SCENES)
    if models:
        found = sorted(str(p) for p in pathlib.Path(models).rglob("*") if p.suffix in MODEL_ENDINGS and "malformed" not in str(p))
        if not found:
            print(f"skipped: no models in {models}", file=sys.stderr)
            return 77
        scenes = found
    with tempfile.TemporaryDirectory() as folder:
        checks = Checks(Program(program, pathlib.Path(folder)))
        rng = random.Random(seed)
        for scene, options in () if models else KNOWN:
            checks.compare(scene, options)
            if scene == NOON and "--bias" in checks.program.compare(scene, options)[0]:
                checks.failures.append(f"{scene} {options}: a bias for what texels do")
        for scene, options in () if models else FAR_OFF:
            checks.compare(scene, options, advised=True)
        for run in range(runs):
            scene = scenes[run % len(scenes)]
            if run % 5 == 4:
                checks.tune(rng, scene)
            else:
                checks.compare(scene, random_options(rng))
    print("| advice | taken | kept | drawn from promised at most, points |\n|---|--:|--:|--:|")
    for kind, (count, kept, off) in sorted(checks.rows.items()):
        print(f"| {kind} | {count} | {kept} | {100 * off:.2g} |")
    for failure in checks.failures:
        print(failure, file=sys.stderr)
    return 1 if checks.failures else 0


if __name__ == "__main__":
    sys.exit(main())
