"""The recording of one page: frames are taken until one has a shadow map that it draws itself."""
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from . import programs
from .errors import CANNOT_WRITE, PageError
from .page import Page, address_of
from .target import Target

EXTRACTOR = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
STOP_S = 3  # in which a page that draws each frame draws shadows
FRAME_S = 20  # in which one that was stopped presents the frame
QUIET_S = 0.4  # in which what was drawn before is presented
SHOWN_S = 2  # in which something small is
TRIES = 8
SETTLE_S = 2  # in which a page that has begun to draw shows the rest
PATIENCE_S = 10  # for what a page does by itself
TAKES = 3  # frames of one kind that are looked at
REPLAY_S = 300
NO_WEBGL = "Is it the page that shows the scene, and drawn within the time (record.py --wait S)?"
SHADOWS_ON = "Are its shadows on (three.js: renderer.shadowMap.enabled, light.castShadow, mesh.castShadow)?"


def _why_none(path):
    """Why a frame has no light with a shadow map, or None where it has. It is replayed by a process of its own: drivers crash."""
    words = [sys.executable, "-B", EXTRACTOR, path, "--list"]
    try:
        done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=REPLAY_S, errors="replace")
    except subprocess.TimeoutExpired:
        return f"its replay ended with code 124, for it takes more than {REPLAY_S} s"
    if done.returncode == 0:
        return None
    errors = [line.removeprefix("error: ") for line in done.stdout.splitlines() if line.startswith("error: ")]
    return errors[0] if errors else f"its replay ended with code {done.returncode}"


def _has_no_map(why):
    """Whether a later frame may be another: this one has no map, or one of an earlier frame."""
    return bool(re.search("has no shadow map|was drawn in an earlier frame|ended with code", why))


class Recording:
    """Of an open page, which must draw shadows within `longest_s`. `say(line)` is told what is done and waited for."""

    def __init__(self, page, target, longest_s, say):
        self._page, self._target, self._say = page, target, say
        self._until, self._said, self._why = time.monotonic() + longest_s, None, "the page presents no frame"
        self._unread = None

    def _tell(self, what):
        if what != self._said:
            self._say(f"note: {what}")
            self._said = what

    def _is_late(self):
        return time.monotonic() > self._until

    def _what_is_missing(self):
        """What a page has not done yet that draws shadows; "" where it has."""
        seen = self._page.seen()
        if not seen.get("contexts"):
            return "the page has no WebGL context" + (", and asked for WebGPU, which is switched off here" if seen.get("webgpu") else "")
        if not seen.get("draws"):
            return "the page draws nothing with WebGL"
        return "" if seen.get("depths") else "the page draws with WebGL, but into no shadow map"

    def _await_drawing(self, longest_s):
        """Whether the page draws into some texture within so long."""
        until = min(time.monotonic() + longest_s, self._until)
        while missing := self._what_is_missing():
            self._why = missing
            self._tell(f"waiting: {missing} yet")
            if time.monotonic() > until:
                return False
            self._page.listen(0.5)
        return True

    def _looked_at(self, path):
        """The frame if it has shadows, else None."""
        why = _why_none(path)
        if why is None:
            return path
        self._why = why
        if not _has_no_map(why):
            self._unread = path
        self._tell(f"waiting for a frame with shadows: {why}")
        return None

    def _take(self):
        """The frame of a page that is stopped: all that is drawn from here to what the page presents then. Of two frames that are asked for the
        first is over once the second has begun; nothing may be presented any more before the page goes on."""
        for _ in range(TRIES):
            self._target.ask(2)
            for _ in range(TRIES):
                self._page.show()
                if self._target.frame(SHOWN_S):
                    break
            if not self._target.frame(QUIET_S):
                self._page.go_on()
                return self._target.frame(FRAME_S)
        self._page.hold_animations()  # of style sheets, which go on without the page's scripts
        self._page.go_on()
        return None

    def _takes(self, stops):
        """The first of some frames that has shadows. `stops()`: whether the page stops before one."""
        for _ in range(TAKES):
            if self._is_late() or self._unread or not stops():
                return None
            path = self._take()
            if path and self._looked_at(path):
                return path
        return None

    def _on_demand(self):
        self._tell("the page draws no shadows by itself now: it is told of a new size")
        return self._page.arm(STOP_S, self._page.resize_all)

    def _from_the_start(self):
        self._tell("the page is loaded anew, for its first shadows")
        return self._page.arm_from_the_start(2 * PATIENCE_S)

    def frame(self):
        """The first frame with shadows, or one whose map cannot be read; a PageError where there is neither."""
        if not self._await_drawing(PATIENCE_S):
            self._tell(f"clicking {self._page.click()}, for {self._why}")
        if self._await_drawing(math.inf):
            self._page.rest(SETTLE_S)
            self._why = "the page drew shadows, and none while it was waited for"
        patience = STOP_S
        while not self._is_late():
            for stops in (lambda: self._page.arm(patience), self._on_demand, self._from_the_start):
                path = self._takes(stops) or self._unread
                if path:
                    return path
            self._tell(f"clicking {self._page.click()}")
            patience *= 4  # a page may take so long for a frame
        raise PageError(self._refusal())

    def _refusal(self):
        said = f" The page says: {self._page.complaints[0][:200]}" if self._page.complaints else ""
        hint = "" if "frame in which" in self._why else " " + (NO_WEBGL if "WebGL context" in self._why or "nothing" in self._why else SHADOWS_ON)
        return f"no frame with shadows: {self._why}.{hint}{said}"


def record(page, output, size, longest_s, say):
    """Writes a frame with shadows of a page to the file `output`. `say(line)` is told of what is done and waited for."""
    address = address_of(page)
    browser, server, environment = programs.find()
    try:
        import renderdoc as rd
    except ImportError as error:
        raise PageError(f"{error}: RenderDoc's module for Python is not installed (Debian: apt install python3-renderdoc python3-numpy)", 5) from None
    folder = os.path.dirname(os.path.abspath(output))
    if not os.path.isdir(folder):
        raise PageError(f"{output}: no such folder", CANNOT_WRITE)
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    say("note: the page is drawn by Chromium without its sandbox, on Mesa's software Vulkan: judge pages of your own only")
    with tempfile.TemporaryDirectory(dir=folder, prefix=".frames-") as frames, programs.display(server, size) as display:
        environment |= {"DISPLAY": display, "RENDERDOC_CAPFILE": os.path.join(frames, "frame")}
        with programs.chromium(browser, environment, size) as (process, reads, writes):
            target = Target(process.pid)
            try:
                _record(Page(reads, writes, size), target, address, output, longest_s, say)
            finally:
                target.close()


def _record(page, target, address, output, longest_s, say):
    target.wait()
    say(f"note: opening {address}")
    page.load(address)
    path = Recording(page, target, longest_s, say).frame()
    try:
        shutil.move(path, output)
    except OSError as error:
        raise PageError(f"{output}: {error.strerror}", CANNOT_WRITE) from None
    seen = page.seen()
    if seen.get("antialias") or seen.get("samples"):
        say("note: the page asks for multisampling, which is switched off in this frame")
    if engine := page.engine():
        say(f"engine: {engine}")
    if seen.get("webgpu"):
        say("note: the page asks for WebGPU, which is not there in this frame")
    page.close()
