"""Web pages, recorded and judged, and what is said of pages that cannot be. /usr/bin/python3 renderdoc_page_test.py GNOMON SOURCE FOLDER"""
import glob
import http.server
import json
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

GNOMON, SOURCE, FOLDER = (os.path.abspath(word) for word in sys.argv[1:4])
del sys.argv[1:4]
PYTHON = "/usr/bin/python3"
RECORD = os.path.join(SOURCE, "adapters/renderdoc/record.py")
sys.path.insert(0, os.path.dirname(RECORD))
from gnomon_page import page, programs  # noqa: E402
from gnomon_page.errors import PageError  # noqa: E402


def skip(why):
    print("skipped: " + why)
    sys.exit(77)


for package, code in (("python3-numpy", "import numpy"), ("python3-renderdoc", "import renderdoc")):
    if subprocess.run([PYTHON, "-c", code], stderr=subprocess.DEVNULL).returncode:
        skip(f"{package} is not installed")
try:
    programs.find()
except PageError as error:
    skip(str(error))
THREE = os.path.join(SOURCE, "adapters/node_modules/three/build")
if not os.path.isdir(THREE):
    skip("the npm package three is not installed")
os.makedirs(FOLDER, exist_ok=True)
os.environ["TMPDIR"] = FOLDER  # other recordings may run beside this
# A sun, a floor, a box on it; words of the address: bias, mode.
SCENE = """<!doctype html><body style="margin:0"><script type="importmap">{"imports": {"three": "/three/three.module.js"}}</script>
<script type="module">
import * as THREE from "three";
const word = (name, otherwise) => new URLSearchParams(location.search).get(name) ?? otherwise;
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(320, 180);
document.body.append(renderer.domElement);
renderer.shadowMap.enabled = true;
renderer.shadowMap.type = THREE.BasicShadowMap;
const camera = new THREE.PerspectiveCamera(40, 16 / 9, 0.1, 50);
camera.position.set(4, 4, 6);
camera.lookAt(0, 0.5, 0);
const scene = new THREE.Scene();
const add = (geometry, x, y, z) => {
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: 0xcccccc }));
  mesh.position.set(x, y, z);
  mesh.castShadow = mesh.receiveShadow = true;
  scene.add(mesh);
  return mesh;
};
add(new THREE.BoxGeometry(8, 0.2, 8), 0, -0.1, 0);
add(new THREE.BoxGeometry(1, 1, 1), 0, 0.5, 0).rotation.y = 0.5;
const light = new THREE.DirectionalLight(0xffffff, 2);
light.position.set(3, 6, 2);
light.castShadow = true;
light.shadow.bias = Number(word("bias", "-0.002"));
light.shadow.mapSize.set(512, 512);
Object.assign(light.shadow.camera, { near: 1, far: 20 });
light.shadow.camera.updateProjectionMatrix();
scene.add(light, new THREE.AmbientLight(0xffffff, 0.3));
const draw = () => renderer.render(scene, camera), loop = () => (draw(), requestAnimationFrame(loop));
const mode = word("mode", "loop");
if (mode === "once") draw();
else if (mode === "click") document.body.append(Object.assign(document.createElement("button"), { textContent: "Start", onclick: loop }));
else loop();
</script>"""
NO_SHADOWS = """<!doctype html><canvas></canvas><script>const gl = document.querySelector("canvas").getContext("webgl");
(function loop() { gl.drawArrays(gl.POINTS, 0, 1); requestAnimationFrame(loop); })();</script>"""
PAGES = {"scene.html": SCENE, "no-shadows.html": NO_SHADOWS, "empty.html": "<!doctype html><p>nothing</p>",
         "frames.html": '<!doctype html><iframe src="scene.html" style="width:340px;height:200px"></iframe>'}


class _Handler(http.server.SimpleHTTPRequestHandler):
    def translate_path(self, path):
        path = path.split("?")[0]
        return os.path.join(THREE, path[7:]) if path.startswith("/three/") else os.path.join(FOLDER, path.lstrip("/"))

    def log_message(self, *_):
        pass


def setUpModule():
    global SERVER, ADDRESS
    for name, text in PAGES.items():
        with open(os.path.join(FOLDER, name), "w", encoding="utf-8") as file:
            file.write(text)
    SERVER = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Handler)
    ADDRESS = f"http://127.0.0.1:{SERVER.server_address[1]}/"
    threading.Thread(target=SERVER.serve_forever, daemon=True).start()


def tearDownModule():
    SERVER.shutdown()


def run(*words):
    return subprocess.run([str(word) for word in words], cwd=FOLDER, capture_output=True, text=True)


def record(name, *more):
    return run(PYTHON, "-B", RECORD, "-o", "refused.rdc", "--size", "320x180", *more, "--page", name if "/" in name or "." not in name else ADDRESS + name)


def left_over():
    """Browsers of this recorder that still run after ten seconds, by their profiles: the system ends their processes one by one."""
    for _ in range(100):
        if not (lines := running()):
            break
        time.sleep(0.1)
    return lines


def running():
    lines = []
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            with open(path, "rb") as file:
                lines.append(file.read())
        except OSError:
            pass
    return [line for line in lines if os.path.join(FOLDER, "gnomon-browser-").encode() in line]


class Judged(unittest.TestCase):
    def judged(self, name, address):
        done = run(GNOMON, "judge", ADDRESS + address, "-o", name)
        self.assertEqual(done.returncode, 0, done.stderr)
        documents = []
        for document in (f"{name}-capture/capture.json", f"{name}/result.json"):
            with open(os.path.join(FOLDER, document), encoding="utf-8") as file:
                documents.append(json.load(file))
        return (*documents, done.stderr)

    def test_a_page_is_judged_and_what_is_advised_is_what_is_then_drawn(self):
        capture, result, said = self.judged("loop", "scene.html?bias=-0.02")
        self.assertIn("judge pages of your own only", said)
        self.assertIn("asks for multisampling, which is switched off", said)
        self.assertTrue(os.path.exists(os.path.join(FOLDER, "loop-capture/frame.rdc")))
        self.assertTrue(result["judged"]["renderer"]["name"].startswith("three.js"))
        self.assertAlmostEqual(capture["bias"]["constant_depth"], 0.02, delta=1e-6)
        self.assertGreater(result["judged"]["biased_is_drawn"], 0.999)
        advice = result["judged"]["advice"][0]
        self.assertEqual(advice["setting"], "bias.constant_depth")
        self.assertLess(advice["wrong_instead"], 0.5 * advice["wrong_now"])
        again = self.judged("again", f"scene.html?bias={-advice['instead']}")[1]
        self.assertAlmostEqual(again["lights"][0]["error"]["wrong_fraction"], advice["wrong_instead"], delta=0.0005)
        self.assertEqual(left_over(), [])

    def test_a_page_that_draws_once_is_loaded_anew(self):
        _, result, said = self.judged("once", "scene.html?mode=once")
        self.assertIn("the page is loaded anew, for its first shadows", said)
        self.assertGreater(result["judged"]["biased_is_drawn"], 0.999)

    def test_a_button_is_clicked_and_what_it_starts_is_judged(self):
        _, result, said = self.judged("click", "scene.html?mode=click")
        self.assertIn('clicking the page\'s button "Start"', said)
        self.assertGreater(result["judged"]["biased_is_drawn"], 0.999)

    def test_a_page_within_a_page_is_judged(self):
        self.assertGreater(self.judged("frames", "frames.html")[1]["judged"]["biased_is_drawn"], 0.999)


class Refused(unittest.TestCase):
    def check(self, done, code, said):
        errors = [line for line in done.stdout.splitlines() if line.startswith("error: ")]
        self.assertEqual((done.returncode, len(errors)), (code, 1), done.stdout + done.stderr)
        self.assertRegex(errors[0], said)
        self.assertFalse(os.path.exists(os.path.join(FOLDER, "refused.rdc")))
        self.assertEqual(left_over(), [])

    def test_pages_without_shadows_say_what_is_missing(self):
        for name, said in (("empty.html", "the page has no WebGL context"), ("no-shadows.html", "draws with WebGL, but into no shadow map. Are its shadows on")):
            self.check(record(name, "--wait", "3"), 3, said)

    def test_pages_that_do_not_load_say_why(self):
        with http.server.HTTPServer(("127.0.0.1", 0), _Handler) as closed:
            port = closed.server_address[1]
        self.check(record(f"http://127.0.0.1:{port}/"), 3, "does not load: net::ERR_CONNECTION_REFUSED. Is its server running")
        self.check(record("nowhere.html"), 3, "its server answers 404")
        self.check(record("/nowhere/page.html"), 3, "no such file")
        done = run(GNOMON, "judge", ADDRESS + "nowhere.html", "-o", "refused")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr.splitlines()[-1], "nowhere.html: the page does not load: its server answers 404")

    def test_what_is_not_installed_is_named_with_its_package(self):
        for name, package in (("BROWSERS", "chromium"), ("DRIVERS", "mesa-vulkan-drivers"), ("LAYERS", "renderdoc")):
            before = getattr(programs, name)
            setattr(programs, name, ("/nowhere",))
            with self.assertRaisesRegex(PageError, f"apt install {package}") as raised:
                programs.find()
            self.assertEqual(raised.exception.code, 5)
            setattr(programs, name, before)

    def test_wrong_words_are_told(self):
        self.assertEqual(run(PYTHON, "-B", RECORD, "-o", "x.rdc").returncode, 2)
        self.assertEqual(run(PYTHON, "-B", RECORD, "-o", "x.rdc", "--page", "x.html", "--size", "2").returncode, 2)


class Ended(unittest.TestCase):
    def test_an_interrupt_ends_what_was_started(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            running = subprocess.Popen([GNOMON, "judge", ADDRESS + "empty.html", "-o", "ended"], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
            until = time.monotonic() + 60
            while not left_over() and time.monotonic() < until:
                time.sleep(0.1)
            self.assertTrue(left_over())
            running.send_signal(number)
            running.communicate(timeout=30)
            self.assertEqual(running.returncode, 128 + number)
            until = time.monotonic() + 20
            while left_over() and time.monotonic() < until:
                time.sleep(0.1)
            self.assertEqual(left_over(), [])


if __name__ == "__main__":
    unittest.main()
