"""Recorded frames of a small engine, one for each common design: what the verdict must say of each, or that there is none.
/usr/bin/python3 renderdoc_designs_test.py GNOMON FOLDER_OF_FRAMES FOLDER"""
import json
import os
import subprocess
import sys
import unittest

GNOMON, FRAMES, FOLDER = (os.path.abspath(word) for word in sys.argv[1:4])
del sys.argv[1:4]


def skip(why):
    print("skipped: " + why)
    sys.exit(77)


if not os.path.isdir(FRAMES):
    skip(f"recorded frames are not here: {FRAMES}")
for package, code in (("python3-numpy", "import numpy"), ("python3-renderdoc", "import renderdoc")):
    if subprocess.run(["/usr/bin/python3", "-c", code], stderr=subprocess.DEVNULL).returncode:
        skip(f"{package} is not installed")
os.makedirs(FOLDER, exist_ok=True)
SOFTWARE = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
SOFTWARE.pop("DISPLAY", None)
# Name: (the reader's bias as the engine has it, most wrong pixels in a hundred). Each is judged, and its test is what was drawn.
JUDGED = {
    "hw": ({"constant_depth": 0.002}, 1), "skydome": ({"constant_depth": 0.002}, 1), "spotlamp": ({"constant_depth": 0.002}, 1),
    "roof": ({"constant_depth": 0.002}, 1), "linear": ({"constant_depth": 0.002}, 1), "half": ({"constant_depth": 0.002}, 1),
    "learn": ({"constant_depth": 0.025, "angle": "one_minus_cosine", "min": 0.0025}, 1),
    "normaloff": ({"constant_depth": 0.0, "normal_offset_world": 0.05}, 1), "spotlinear": ({"constant_depth": 0.05}, 30),
    "scaled": ({"constant_depth": 0.002}, 1), "dynres": ({"constant_depth": 0.002}, 1), "viewmodel": ({"constant_depth": 0.002}, 1),
    "same512": ({"constant_depth": 0.002}, 2), "pancake": ({"constant_depth": 0.002}, 2), "taa": ({"constant_depth": 0.002}, 1),
    "vsm": (None, 1), "evsm": (None, 1), "cascades": ({"constant_depth": 0.002}, 1), "castnormal": ({"constant_depth": 0.0}, 3),
    "omni": ({"constant_depth": 0.002}, 5), "layered": ({"constant_depth": 0.002}, 5)}
# VTK looks its exponential map up with the map's aspect, and draws it with the window's: where its shadow is wrong is judged all the same.
UNREAD = {"vtk": "widens x by 1.778"}
# Name: what the refusal says.
REFUSED = {"staticbig": "of an earlier frame"}
# Name: what a note says of what was left out.
NOTES = {"skydome": "casts no shadow in the verdict: event .* writes no depth", "spotlamp": "stands around the light", "roof": "has an alpha mask",
         "viewmodel": "drawn with another projection than most", "pancake": "are held at it", "vsm": "those of vsm", "evsm": "those of evsm", "castnormal": "moved 0.05 world units times the sine of the angle to the light against their normals", "omni": "distances from the light, 0 to 25"}


def judged(name):
    """(exit code, what was said, capture.json, result.json) of a frame."""
    words = [GNOMON, "judge", os.path.join(FRAMES, name + ".rdc"), "-o", name]
    done = subprocess.run(words, cwd=FOLDER, env=SOFTWARE, capture_output=True, text=True)
    documents = []
    for path in (f"{name}-capture/capture.json", f"{name}/result.json") if done.returncode == 0 else ():
        with open(os.path.join(FOLDER, path), encoding="utf-8") as file:
            documents.append(json.load(file))
    return done.returncode, done.stderr + done.stdout, *(documents or (None, None))


class Designs(unittest.TestCase):
    def test_are_judged_as_they_are(self):
        for name, (bias, most) in JUDGED.items():
            if not os.path.exists(os.path.join(FRAMES, name + ".rdc")):
                continue
            with self.subTest(name):
                code, said, capture, result = judged(name)
                self.assertEqual(code, 0, said)
                self.assertGreater(result["judged"]["biased_is_drawn"], 0.995)
                self.assertLess(result["lights"][0]["error"]["wrong_fraction"], most / 100)
                if bias:
                    self.assertEqual(capture["bias"].keys(), bias.keys())
                    for key, value in bias.items():
                        self.assertTrue(capture["bias"][key] == value or abs(capture["bias"][key] - value) < 1e-6 * value, capture["bias"])
                self.assertRegex(said.replace("\n            ", " "), NOTES.get(name, "Report: "))

    def test_whose_map_is_not_read_are_judged_for_where_all_the_same(self):
        for name, words in UNREAD.items():
            if not os.path.exists(os.path.join(FRAMES, name + ".rdc")):
                continue
            with self.subTest(name):
                code, said, capture, result = judged(name)
                self.assertEqual(code, 0, said)
                self.assertRegex(said.replace("\n            ", " "), words)
                self.assertNotIn("map", capture)
                self.assertIsNone(result["judged"].get("biased_is_drawn"))

    def test_that_cannot_be_judged_say_why(self):
        for name, words in REFUSED.items():
            if not os.path.exists(os.path.join(FRAMES, name + ".rdc")):
                continue
            with self.subTest(name):
                code, said, _, _ = judged(name)
                self.assertEqual(code, 3, said)
                self.assertRegex(said, words)


if __name__ == "__main__":
    unittest.main()
