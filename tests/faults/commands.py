"""What the campaign of faults runs: every command that writes, on small pictures, and what its inputs are.

A run's folder holds in/ (inputs, made once), out/ (what is written), said/ (what goes to stdout) and tmp/ (TMPDIR); words name
them as they are seen from there.
"""
import dataclasses
import json
import pathlib
import struct
import subprocess
import zlib

SMALL = ["--size", "48x27", "--map-size", "64", "--runs", "1"]
SWEEP = ["acne-floor", "--size", "48x27", "--map-size", "64,128", "--bias", "0,0.1", "--runs", "1"]
PICTURE = ["--size", "24x14"]


@dataclasses.dataclass
class Command:
    """`older` are the words that write an older result in the same place; None where they are no others."""

    name: str
    words: list
    older: list = None
    resumes: bool = False  # a run that failed is taken up by the next, so that out/ may hold a part
    grades: bool = False  # whom it could not grade it names, and gives all others their points
    refuses: bool = False  # of several inputs it judges those that it can read
    window: bool = False
    share: float = 1.0  # of the points, where a run takes long or makes few calls
    code: int = 0

    def output_of(self, name):
        """To which of the command's outputs, of which each is whole by itself, a file belongs: all that a run writes is one, but
        for its --trace, a record of the run that comes last, and for what a window is asked for in its turn."""
        before = dict(zip(self.words[1:], self.words)).get(name)
        return name if before == "--trace" or name in SCRIPT or name.startswith("said/") else "outputs"

    @property
    def folder(self):
        """Whether out/ as a whole is what the command writes."""
        return "out" in self.words


def with_size(words, size):
    return [size if before == "--size" else word for before, word in zip([""] + words, words)]


def command(name, *words, other=None, **more):
    words = list(words)
    if other is None:
        older = with_size(words, "40x24")
        return Command(name, words, None if older == words else older, **more)
    return Command(name, words, list(other), **more)


SHIMMER = ["shimmer", "acne-floor", "--size", "48x27", "--map-size", "64", "--frames", "3"]
TUNE = ["tune", "acne-floor", "--max-error", "100%", "--technique", "izb", "--map-size", "64", "--size", "24x14", "--runs", "1"]
BENCH = ["bench", "thin-wall", "--accel", "bvh,grid", "--size", "16x9", "--runs", "1"]
TECHNIQUES = ["bench", "--techniques", "thin-wall", "--size", "16x9", "--map-size", "64", "--runs", "1"]

COMMANDS = [
    command("compare", "compare", "acne-floor", *SMALL, "-o", "out"),
    command("compare --aov", "compare", "in/scene.json", *SMALL, "-o", "out", "--aov", "out/values.exr", "--json", "out/also.json"),
    command("compare --json -", "compare", "in/model.glb", *SMALL, "--json", "-"),
    command("compare in bands", "compare", "acne-floor", "--size", "32x768", "--map-size", "64", "--runs", "1", "--memory", "6M",
            "-o", "out", "--aov", "out/values.exr", other=["compare", "acne-floor", *SMALL, "-o", "out"]),
    command("judge", "judge", "in/capture/capture.json", "-o", "out", other=["judge", "in/other/capture.json", "-o", "out"]),
    command("judge several", "judge", "in/capture/capture.json", "in/other/other.json", "-o", "out",
            other=["judge", "in/other/other.json", "in/other/capture.json", "-o", "out"], refuses=True),
    command("sweep", "sweep", *SWEEP, "-o", "out", other=["sweep", *SWEEP, "-o", "out"], resumes=True),
    command("sweep resumed", "sweep", *SWEEP, "-o", "out", other=["copy", "in/half"], resumes=True),
    command("merge", "merge", "in/shard1", "in/shard2", "-o", "out", other=["merge", "in/shard1", "in/shard2", "-o", "out"]),
    command("diff", "diff", "in/before", "in/after", "-o", "out", other=["diff", "in/after", "in/before", "-o", "out"]),
    command("grade", "grade", "in/rubric.json", "in/class", "--jobs", "1", "-o", "out",
            other=["grade", "in/rubric.json", "in/class/ada", "-o", "out"], grades=True),
    command("grade functions", "grade", "in/functions.json", "in/functions", "--jobs", "1", "-o", "out",
            other=["grade", "in/functions.json", "in/functions/ada", "-o", "out"], grades=True),
    command("grade --new", "grade", "--new", "out"),
    command("grade --new functions", "grade", "--new", "out", "rays-and-light", share=0.3),
    command("shimmer", *SHIMMER, "-o", "out"),
    command("shimmer --film", *SHIMMER, "--film", "apng", "-o", "out"),
    command("lessons", "lessons", "--only", "acne,peter-panning", "-o", "out", other=["lessons", "--only", "acne", "-o", "out"]),
    command("export", "export", "thin-wall", "-o", "out/scene.glb", other=["export", "acne-floor", "-o", "out/scene.glb"]),
    command("export --suite", "export", "--suite", "out", *PICTURE),
    command("raster", "raster", "in/model.obj", *PICTURE, "--map-size", "64", "-o", "out/picture.png", "--json", "out/picture.json"),
    command("raster in bands", "raster", "acne-floor", "--size", "64x512", "--map-size", "64", "--memory", "1M", "-o", "out/picture.exr",
            other=["raster", "acne-floor", *PICTURE, "-o", "out/picture.exr"]),
    command("raytrace", "raytrace", "in/scene.json", *PICTURE, "-o", "out/picture.exr", "--trace", "out/trace.json"),
    command("tune", *TUNE, "-o", "out", "--json", "out/also.json"),
    command("shaders", "shaders", "-o", "out"),
    command("shaders --call", "shaders", "--call", "fresnel", "--shader-dir", "in/functions/ada", "--json", "out/answers.json",
            other=["shaders", "--call", "reflection", "--json", "out/answers.json"]),
    command("bench", *BENCH, "--json", "out/bench.json"),
    command("bench --techniques", *TECHNIQUES, "-o", "out/table.md", share=0.1),
    command("verify", "verify", "--rays", "1000", "--case", "1", "--json", "out/cases.json", share=0.2),
    command("plan", "plan", "in/model.glb", "--json", "out/plan.json"),
    command("scenes", "scenes", "--json", "out/scenes.json"),
    command("completion", "--completion", "bash", share=0.3),
    command("man page", "--man-page", share=0.3),
    command("manual", "--manual", "options", share=0.3),
    command("view", "view", "acne-floor", "--size", "640x360", "--map-size", "64", "--script", "in/script.txt", window=True),
]

SCENE = {
    "schema": "gnomon/scene/1", "include": ["part.json"],
    "materials": [{"name": "tiles", "texture": {"file": "tiles.png"}}],
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -1]}],
    "shapes": [{"name": "ball", "sphere": {"center": [0, 1, 0], "radius": 1}, "material": "tiles"}],
}
PART = {"schema": "gnomon/scene/1", "materials": [{"name": "grey"}],
        "shapes": [{"name": "floor", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": "grey"}]}
MODEL = """mtllib model.mtl
v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv 0 1 -1\nv 1 1 0\nv -1 1 0
vt 0 0\nvt 1 0\nvt 1 1
usemtl tiles
f 1/1 4/2 3/3\nf 1/1 3/2 2/3\nf 5 6 7
"""
RUN = {"scene": "acne-floor", "options": {"size": "32x18", "map-size": "64"}}
RUBRIC = {
    "schema": "gnomon/rubric/1", "title": "Two checks", "technique": "hard", "hand_in": ["technique/hard.glsl"], "limits": {"seconds": 60},
    "checks": [{"name": "It draws", "points": 1, "kind": "draws", "runs": [RUN]},
               {"name": "As the program does", "points": 1, "kind": "equals", "pixels": 5, "runs": [RUN]}],
}
FUNCTIONS = {
    "schema": "gnomon/rubric/1", "title": "One function", "hand_in": ["function/fresnel.glsl"], "limits": {"seconds": 60},
    "checks": [{"name": "Into glass", "points": 1, "kind": "answers", "function": "fresnel", "cases": "in"},
               {"name": "Out of glass", "points": 1, "kind": "answers", "function": "fresnel", "cases": "out"}],
}
FRESNEL = """float fresnel(float cosine, float n1, float n2) {
  return %s;
}
"""
SHADER = """float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  return test.gap > light.bias.x + %s ? 0.0 : 1.0;
}
"""
SCRIPT = """set panels off
wait 2
screenshot out/window.png
save-scene out/saved.json
quit
"""


def png(width, height, grey):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(grey(x, y) for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def capture(lit, size):
    width, height = size
    text = {"schema": "gnomon/capture/1", "renderer": {"name": "another"}, "scene": "acne-floor", "size": [width, height],
            "visibility": "visibility.png"}
    return {"capture.json": json.dumps(text), "visibility.png": png(width, height, lit)}


def put(folder, files):
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


def make_inputs(program, folder, environment):
    """Fills in/ and makes the folders beside it; what the program itself writes there is made by it."""
    into = folder / "in"
    put(into, {"scene.json": json.dumps(SCENE), "part.json": json.dumps(PART), "tiles.png": png(8, 8, lambda x, y: 40 * (x + y) % 256),
               "model.obj": MODEL, "model.mtl": "newmtl tiles\nmap_Kd tiles.png\n", "rubric.json": json.dumps(RUBRIC), "script.txt": SCRIPT,
               "functions.json": json.dumps(FUNCTIONS), "functions/ada/function/fresnel.glsl": FRESNEL % "0.04",
               "functions/ben/function/fresnel.glsl": FRESNEL % "1.0 - cosine",
               "class/ada/technique/hard.glsl": SHADER % "0.0", "class/ben/technique/hard.glsl": SHADER % "1000.0"})
    put(into / "capture", capture(lambda x, y: 255 if x > 9 else 0, (48, 27)))
    put(into / "other", capture(lambda x, y: 255, (40, 24)))
    (into / "other/other.json").write_bytes((into / "other/capture.json").read_bytes())

    def run(*words):
        done = subprocess.run([program, *words, "-q"], cwd=folder, env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"the campaign's inputs: gnomon {' '.join(words)}: {done.stderr}")
    for shard in ("1", "2"):
        run("sweep", *SWEEP, "--shard", f"{shard}/2", "-o", f"in/shard{shard}")
    run("sweep", *SWEEP, "-o", "in/half")
    run("compare", "acne-floor", *SMALL, "-o", "in/before")
    run("compare", "acne-floor", *SMALL, "--bias", "0", "-o", "in/after")
    journal = into / "half/sweep.jsonl"
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:-2]))
    run("export", "thin-wall", "-o", "in/model.glb")
