"""Frames that engines draw, recorded, judged, and drawn again as advised, as far as the engines are installed.
/usr/bin/python3 renderdoc_engine_test.py GNOMON SOURCE FOLDER"""
import json
import os
import shutil
import subprocess
import sys
import unittest

GNOMON, SOURCE, FOLDER = (os.path.abspath(word) for word in sys.argv[1:4])
del sys.argv[1:4]
PYTHON = "/usr/bin/python3"


def skip(why):
    print("skipped: " + why)
    sys.exit(77)


for package, code in (("python3-numpy", "import numpy"), ("python3-renderdoc", "import renderdoc")):
    if subprocess.run([PYTHON, "-c", code], stderr=subprocess.DEVNULL).returncode:
        skip(f"{package} is not installed")
# Two that look for a free display at once may take the same one: each test begins to look at a number of its own.
XVFB = ("xvfb-run", "-a", "-n", str(200 + os.getpid() % 5000))
QML = "/usr/lib/qt6/bin/qml"
LAVAPIPE = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"
HAS_GODOT = bool(shutil.which("godot3"))
HAS_QUICK3D = all(os.path.exists(p) for p in (QML, LAVAPIPE, "/usr/lib/x86_64-linux-gnu/qt6/qml/QtQuick3D"))
OGRE_PLUGIN = "/usr/lib/x86_64-linux-gnu/OGRE/RenderSystem_GL3Plus"
HAS_OGRE = all(shutil.which(p) for p in ("g++", "pkg-config")) and os.path.exists(OGRE_PLUGIN + ".so.1.12.10") and not subprocess.run(
    ["pkg-config", "--exists", "OGRE"], stderr=subprocess.DEVNULL).returncode
if not shutil.which("xvfb-run"):
    skip("xvfb-run is not installed")
if not HAS_GODOT and not HAS_QUICK3D and not HAS_OGRE:
    skip("godot3 is not installed, nor Qt Quick 3D, nor OGRE")
os.makedirs(FOLDER, exist_ok=True)
# Mesa's software: the same pictures on every machine.
SOFTWARE = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1", "VK_ICD_FILENAMES": LAVAPIPE, "QSG_RHI_BACKEND": "vulkan", "QSG_RENDER_LOOP": "basic"}
SOFTWARE.pop("DISPLAY", None)
SUN_BESIDE = ("sun-and-spot",)  # scenes that keep floating-box's sun beside their lamp
LAMPS = {
    "spot": {"type": "spot", "position": [2.5, 5, 4], "direction": [-2.2, -5, -3.8], "inner_angle_degrees": 28, "outer_angle_degrees": 32},
    "sun-and-spot": {"type": "spot", "position": [2.5, 5, 4], "direction": [-2.2, -5, -3.8], "inner_angle_degrees": 28, "outer_angle_degrees": 32},
    "point": {"type": "point", "position": [1.5, 3, 2]},
    "point-between": {"type": "point", "position": [1.3, 0.6, 1.0]},  # below what floats highest
}


LONGEST_S = 150  # for a frame to be recorded
# What a recorder that looks for a program of its own does to others: it takes the connection with each over, and gives it back.
LOOKS_AROUND = """
import sys, time
import renderdoc as rd
rd.InitialiseReplay(rd.GlobalEnvironment(), [])
until = time.monotonic() + float(sys.argv[1])
while time.monotonic() < until:
    ident = rd.EnumerateRemoteTargets("", 0)
    while ident:
        if (control := rd.CreateTargetControl("", ident, "another", True)) is not None:
            control.Shutdown()
        ident = rd.EnumerateRemoteTargets("", ident)
    time.sleep(0.2)
"""


def run(*words):
    done = subprocess.run([str(w) for w in words], env=SOFTWARE, cwd=FOLDER, capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done


def scene(name="floating-box"):
    """A GLB of a built-in scene, or of floating-box with a lamp in its sun's place, or with an orthographic camera."""
    path = os.path.join(FOLDER, f"{name}.glb")
    if os.path.exists(path):
        return path
    source = name
    if name in LAMPS or name == "orthographic":
        with open(os.path.join(SOURCE, "scene/builtin/floating-box.json"), encoding="utf-8") as file:
            document = json.loads("".join(line for line in file if not line.startswith("//")))
        if name in LAMPS:
            beside = document["lights"] if name in SUN_BESIDE else []
            document["lights"] = beside + [{"name": "lamp", "intensity": [60, 60, 60], **LAMPS[name]}]
        else:
            del document["camera"]["vertical_fov_degrees"]
            document["camera"]["orthographic_height"] = 3.2
        source = os.path.join(FOLDER, f"{name}.json")
        with open(source, "w", encoding="utf-8") as file:
            json.dump(document, file)
    run(GNOMON, "export", source, "-o", path)
    return path


def record(name, *words):
    """Records a frame of a program."""
    return record_and_said(name, *words)[0]


def record_and_said(name, *words):
    """(The frame's path, what the recorder says.) Our own window stays the process that it is where that variable is set."""
    path = os.path.join(FOLDER, name + ".rdc")
    done = run(*XVFB, "-s", "-screen 0 640x480x24", PYTHON, "-B", os.path.join(SOURCE, "adapters/renderdoc/record.py"), "-o", path,
               "--wait", LONGEST_S, *words)
    return path, done.stderr


def frame(name, glb, **settings):
    """Records a frame of Godot."""
    return record(name, "godot3", "--path", os.path.join(SOURCE, "adapters/godot"), "--stay=1", f"--scene={glb}",
                  *[f"--{k}={v}" for k, v in settings.items()])


def judged_and_said(path):
    """(capture.json, result.json, the notes) of a frame."""
    name = os.path.splitext(os.path.basename(path))[0]
    notes = run(GNOMON, "judge", path, "-o", name).stderr
    documents = []
    for document in (f"{name}-capture/capture.json", f"{name}/result.json"):
        with open(os.path.join(FOLDER, document), encoding="utf-8") as file:
            documents.append(json.load(file))
    return (*documents, notes)


def judged(path):
    """(capture.json, result.json) of a frame."""
    return judged_and_said(path)[:2]


class Refusals(unittest.TestCase):
    def test_what_is_no_frame_is_said_in_one_line(self):
        with open(os.path.join(FOLDER, "no-frame.rdc"), "w", encoding="utf-8") as file:
            file.write("{}")
        for words, code, said in ((["no-frame.rdc"], 3, "is no frame that RenderDoc"), (["missing.rdc"], 3, "no such file"),
                                  (["no-frame.rdc", "--light", "sun"], 2, "--light"), (["capture.json", "--list"], 2, "--list: needs one frame")):
            done = subprocess.run([GNOMON, "judge", *words, "-o", "refused"], cwd=FOLDER, env=SOFTWARE, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
            self.assertRegex(done.stderr, said)
            self.assertEqual(done.stderr.count("\n"), 1)
        self.assertFalse(os.path.exists(os.path.join(FOLDER, "refused-capture")))


class Recording(unittest.TestCase):
    def test_a_frame_that_was_drawn_too_early_gives_its_place_to_a_later_one(self):
        path, said = record_and_said("late", "--frame", "1", GNOMON, "view", "acne-floor", "--size", "320x180")
        self.assertRegex(said, r"frame \d+, for the program had drawn frame 1 before")
        self.assertTrue(os.path.exists(path))

    def test_a_program_is_spoken_with_again_after_another_recorder_has_cut_in(self):
        with subprocess.Popen([PYTHON, "-c", LOOKS_AROUND, "4"]):
            path = record("cut-in", "--frame", "12", GNOMON, "view", "acne-floor", "--size", "320x180")
        self.assertTrue(os.path.exists(path))


@unittest.skipUnless(HAS_GODOT, "godot3 is not installed")
class Godot(unittest.TestCase):
    def check(self, result, least=0.999):
        """V5 is V6 but on borders of texels, and nothing is unexplained."""
        self.assertGreaterEqual(result["judged"]["biased_is_drawn"], least)
        self.assertLess(result["lights"][0]["classes"]["unexplained"], 3)

    def bias(self, capture, layer=0):
        return capture["map"][layer].get("caster_bias", {}).get("constant_world", 0)

    def test_a_suns_bias_is_recovered_and_what_is_advised_is_what_is_then_drawn(self):
        for setting in (0.1, 0.3, 0.7):
            capture, result = judged(frame(f"sun-{setting}", scene(), bias=setting))
            self.check(result)
            self.assertAlmostEqual(self.bias(capture) / setting, 1, delta=0.01)
        advice = result["judged"]["advice"][0]
        self.assertEqual(advice["setting"], "map[].caster_bias.constant_world")
        self.assertLess(advice["wrong_instead"], 0.8 * advice["wrong_now"])
        again = judged(frame("sun-advised", scene(), bias=setting * advice["instead"] / advice["now"]))[1]
        self.assertAlmostEqual(again["lights"][0]["error"]["wrong_fraction"], advice["wrong_instead"], delta=0.0005)

    def test_a_bias_is_recovered_where_an_objects_shift_would_explain_the_map_as_well(self):
        capture, _ = judged(frame("wires-frame", scene("wires"), bias=0.2))
        self.assertAlmostEqual(self.bias(capture) / 0.2, 1, delta=0.01)

    def test_an_orthographic_camera_is_told_from_the_sun_whose_projection_is_parallel_as_well(self):
        capture, result, notes = judged_and_said(frame("orthographic", scene("orthographic"), ambient=0.5))
        self.check(result)
        self.assertAlmostEqual(self.bias(capture), 0.1, delta=0.001)
        self.assertNotIn("changed the camera's depth", notes)
        self.assertIn("it is taken out", notes)  # the ambient light, of which a full map leaves all
        with open(os.path.join(FOLDER, "orthographic-capture/scene.glb"), "rb") as file:
            self.assertIn(b'"orthographic"', file.read())

    def test_ambient_light_and_filters_are_taken_for_what_they_are(self):
        capture, result = judged(frame("sun-filtered", scene(), bias=0.1, filter=1, ambient=0.5))
        self.check(result)
        self.assertEqual(capture["filter"], {"kind": "pcf", "radius_texels": 2.0})

    def test_cascades_are_told_apart(self):
        for mode in ("pssm2", "pssm4"):
            capture, result = judged(frame(mode, scene(), mode=mode))
            self.check(result)
        self.assertGreater(len(capture["map"]), 1)
        self.assertEqual({layer["select"]["by"] for layer in capture["map"]}, {"view_z"})

    def test_cascades_that_blend_are_found_with_the_width_of_the_blend(self):
        capture, result = judged(frame("pssm4-blend", scene(), mode="pssm4", blend=1))
        # The rest are soft edges of two layers at once, which the filter explains.
        self.check(result, 0.998)
        blends = [layer["select"]["blend"] for layer in capture["map"] if "blend" in layer["select"]]
        self.assertEqual(len(blends), 1)  # of the other layers no shadow is seen where they blend
        self.assertAlmostEqual(blends[0], 3.08, delta=0.05)

    def test_a_spot_is_judged_from_its_own_apex(self):
        capture, result = judged(frame("spot", scene("spot")))
        self.check(result)
        self.assertAlmostEqual(self.bias(capture), 0.1, delta=0.001)

    def test_paraboloids_of_a_point_are_judged_by_their_own_texels(self):
        for name in ("point", "point-between"):  # casters in one half, and in both
            capture, result = judged(frame(name, scene(name), mode="paraboloid"))
            self.check(result)
            self.assertEqual([layer["convention"] for layer in capture["map"]], ["paraboloid"] * 2)
            self.assertAlmostEqual(self.bias(capture), 0.1, delta=0.001)

    def test_a_cube_that_is_copied_is_judged_without_a_map(self):
        capture, result = judged(frame("cube", scene("point"), mode="cube"))
        self.assertNotIn("map", capture)
        self.assertLess(result["lights"][0]["error"]["wrong_fraction"], 0.005)

    def test_all_lights_of_a_frame_are_judged_from_one_capture(self):
        path = frame("two-lights", scene("sun-and-spot"), light="all")
        run(GNOMON, "judge", path, "-o", "two-lights")
        with open(os.path.join(FOLDER, "two-lights-capture/capture.json"), encoding="utf-8") as file:
            capture = json.load(file)
        self.assertEqual([light["light"] for light in capture["lights"]], ["light 1", "light 2"])
        with open(os.path.join(FOLDER, "two-lights/judge.jsonl"), encoding="utf-8") as file:
            results = [json.loads(line) for line in file]
        self.assertEqual(len(results), 2)
        for result, light in zip(results, capture["lights"]):
            self.check(result)  # each cancels the other, though one shader draws both maps
            self.assertAlmostEqual(self.bias(light), 0.1, delta=0.001)
        run(GNOMON, "judge", path, "--light", "2", "-o", "second-light")
        with open(os.path.join(FOLDER, "second-light/result.json"), encoding="utf-8") as file:
            self.check(json.load(file))

    def test_lights_are_listed(self):
        listed = run(GNOMON, "judge", frame("listed", scene()), "--list").stdout
        self.assertRegex(listed, r"^light 1: sun, map 2048 x 2048 D24 .*, 6 draws of casters, read by 6 draws from event \d+ on\n$")

    def test_the_scene_script_writes_a_capture_by_itself(self):
        folder = os.path.join(FOLDER, "alone")
        os.makedirs(folder, exist_ok=True)
        run(*XVFB, "-s", "-screen 0 640x480x24", "godot3", "--path", os.path.join(SOURCE, "adapters/godot"), f"--scene={scene()}",
            f"--output={folder}")
        run(GNOMON, "judge", "alone/capture.json", "-o", "alone-verdict")
        with open(os.path.join(FOLDER, "alone-verdict/result.json"), encoding="utf-8") as file:
            result = json.load(file)
        self.assertTrue(result["judged"]["renderer"]["version"].startswith("3."))
        self.assertLess(result["lights"][0]["error"]["wrong_fraction"], 0.005)


@unittest.skipUnless(HAS_QUICK3D, "Qt Quick 3D is not installed")
class Quick3D(unittest.TestCase):
    def test_an_exponential_map_is_judged_with_its_blur_and_factor_named(self):
        capture, result = judged(record("quick3d", "--frame", "20", QML, os.path.join(SOURCE, "adapters/quick3d/draw.qml")))
        self.assertEqual(capture["filter"]["kind"], "esm")
        # shadowFactor is 75; half floats and eight bits of the picture leave it within a tenth.
        self.assertAlmostEqual(capture["renderer"]["settings"]["exponent"] / 75, 1, delta=0.1)
        self.assertTrue(capture["renderer"]["settings"]["matrix"].startswith("cbMain_var.qt_shadowmap0_matrix"))
        self.assertNotIn("caster_bias", capture["map"][0])
        self.assertTrue(result["judged"]["map"])
        self.assertLess(result["lights"][0]["classes"]["unexplained"], 3)


@unittest.skipUnless(HAS_OGRE, "libogre-1.12-dev is not installed")
class Ogre(unittest.TestCase):
    def test_a_depth_map_is_judged_and_what_is_advised_is_what_is_then_drawn(self):
        folder = os.path.join(SOURCE, "adapters/ogre")
        flags = run("pkg-config", "--cflags", "--libs", "OGRE").stdout.split()
        run("g++", "-std=c++17", "-w", f'-DOGRE_PLUGIN="{OGRE_PLUGIN}"', '-DOGRE_MEDIA="/usr/share/OGRE/Media"', os.path.join(folder, "draw.cpp"),
            "-o", "ogre-draw", *flags)
        capture, result = judged(record("ogre", "--frame", "60", "./ogre-draw", folder, "0.012"))
        self.assertGreaterEqual(result["judged"]["biased_is_drawn"], 0.999)
        self.assertLess(result["lights"][0]["classes"]["unexplained"], 3)
        self.assertAlmostEqual(capture["bias"]["constant_depth"], 0.012, delta=1e-6)
        self.assertTrue(capture["renderer"]["settings"]["matrix"].startswith("$Globals.texture_from_world"))
        advice = result["judged"]["advice"][0]
        self.assertEqual(advice["setting"], "bias.constant_depth")
        self.assertLess(advice["wrong_instead"], advice["wrong_now"])
        again = judged(record("ogre-advised", "--frame", "60", "./ogre-draw", folder, str(advice["instead"])))[1]
        self.assertAlmostEqual(again["lights"][0]["error"]["wrong_fraction"], advice["wrong_instead"], delta=0.0005)


if __name__ == "__main__":
    for engine, there in (("godot3", HAS_GODOT), ("qt6-quick3d", HAS_QUICK3D), ("libogre-1.12-dev", HAS_OGRE)):
        if not there:
            print(f"skipped: {engine} is not installed")
    unittest.main()
