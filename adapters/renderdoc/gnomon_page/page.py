"""A page in the browser: it is opened, looked at, and asked to draw."""
import os
import re
import time
from urllib.parse import quote, urlparse

from .devtools import DevTools
from .errors import PageError

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "page.js")
LOAD_S = 60


def is_address(page):
    return page.startswith(("http://", "https://", "file://"))


def address_of(page):
    """The address of a page that is named by one, or by its file."""
    if page.startswith("file://"):
        path = page.removeprefix("file://").split("?")[0].split("#")[0]
        if not os.path.exists(path):
            raise PageError("no such file")
    if is_address(page):
        return page
    if not os.path.isfile(page):
        raise PageError("no such file; the address of a page begins with http:// or https://")
    return "file://" + quote(os.path.abspath(page))


class Page:
    """The one page of a browser."""

    def __init__(self, reads, writes, size):
        self._tools = DevTools(reads, writes, self._hear)
        self._session, self._frame, self._status, self._loaded = None, None, None, False
        self._contexts, self._workers, self.stopped = {}, set(), None
        self._named = ""  # what an engine calls itself on the console
        self.complaints = []  # what its scripts threw, and what it said to be an error
        with open(SCRIPT, encoding="utf-8") as file:
            self._script = file.read()
        self._open(size)

    def _open(self, size):
        target = next(t for t in self._tools.ask("Target.getTargets", longest_s=LOAD_S)["targetInfos"] if t["type"] == "page")
        self._session = self._tools.ask("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log", "Debugger"):
            self._ask(f"{domain}.enable")
        # Workers draw, too: they wait until they have the script.
        self._ask("Target.setAutoAttach", autoAttach=True, waitForDebuggerOnStart=True, flatten=True)
        self._ask("Page.addScriptToEvaluateOnNewDocument", source=self._script)
        self.resize(*size)

    def _ask(self, method, **parameters):
        return self._tools.ask(method, self._session, **parameters)

    def _hear(self, method, about, session):
        if method == "Target.attachedToTarget" and session:
            self._prepare(about["sessionId"], about["targetInfo"]["type"])
        elif method == "Target.detachedFromTarget":
            self._workers.discard(about["sessionId"])
        elif method == "Runtime.executionContextCreated" and session == self._session:
            self._contexts[about["context"]["id"]] = about["context"]["uniqueId"]
        elif method == "Runtime.executionContextDestroyed" and session == self._session:
            self._contexts.pop(about["executionContextId"], None)
        elif method == "Runtime.executionContextsCleared" and session == self._session:
            self._contexts.clear()
        elif method == "Debugger.paused":
            self.stopped = session
        elif method == "Debugger.resumed":
            self.stopped = None
        elif method == "Page.loadEventFired":
            self._loaded = True
        elif method == "Page.javascriptDialogOpening":
            self._tools.tell("Page.handleJavaScriptDialog", self._session, accept=True)
        elif method == "Network.responseReceived" and about["type"] == "Document" and about.get("frameId") == self._frame:
            self._status = about["response"]["status"]
        elif method == "Runtime.consoleAPICalled" and (named := re.search(r"PlayCanvas [0-9.]+", str(about["args"][:1]))):
            self._named = named[0]
        elif method == "Runtime.exceptionThrown":
            details = about["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description", details["text"]).split("\n")[0])
        elif method == "Log.entryAdded" and about["entry"]["level"] == "error" and not about["entry"].get("url", "").endswith("/favicon.ico"):
            self.complaints.append(" ".join(filter(None, (about["entry"]["text"], about["entry"].get("url")))))

    def _prepare(self, session, kind):
        if kind in ("worker", "shared_worker"):
            self._workers.add(session)
            self._tools.tell("Debugger.enable", session)
            self._tools.tell("Runtime.evaluate", session, expression=self._script)
        self._tools.tell("Runtime.runIfWaitingForDebugger", session)

    def resize(self, width, height):
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def load(self, address):
        """Opens the page; a PageError says why it does not load."""
        self._frame = self._ask("Page.getFrameTree")["frameTree"]["frame"]["id"]
        answer = self._ask("Page.navigate", url=address, longest_s=LOAD_S)
        if answer.get("errorText"):
            raise PageError(f"the page does not load: {answer['errorText']}. Is its server running, and the address right?")
        self.await_load()
        if self._status and self._status >= 400 and urlparse(address).scheme != "file":
            raise PageError(f"the page does not load: its server answers {self._status}")

    def await_load(self):
        """What never ends loading draws all the same."""
        until = time.monotonic() + LOAD_S
        while not self._loaded and time.monotonic() < until:
            self._tools.listen(0.2)

    def _places(self):
        return [(self._session, {"uniqueContextId": context}) for context in self._contexts.values()] + [(worker, {}) for worker in self._workers]

    def _each(self, expression):
        """What an expression gives in the page, the frames in it and its workers."""
        values = []
        for session, where in self._places():
            try:
                told = self._tools.ask("Runtime.evaluate", session, expression=expression, returnByValue=True, **where)
            except PageError:  # it has gone meanwhile
                continue
            values.append(told.get("result", {}).get("value"))
        return values

    def seen(self):
        """What page.js has counted."""
        total = {}
        for one in self._each("gnomon.seen"):
            for name, value in (one or {}).items():
                total[name] = total.get(name, 0) + value
        return total

    def engine(self):
        """The name and version of the engine that draws, as far as it says so: canvases of three.js and Babylon.js do, PlayCanvas to the console."""
        said = """[...(globalThis.document?.querySelectorAll("canvas[data-engine]") ?? [])][0]?.dataset.engine ?? (globalThis.pc?.version && "PlayCanvas " + pc.version)"""
        return next(filter(None, self._each(said)), self._named)

    def arm(self, longest_s, meanwhile=lambda: None):
        """Whether the page is stopped before the next draw into a framebuffer with depth, within so long."""
        self._each("gnomon.arm()")
        if self._stops(longest_s, meanwhile):
            return True
        self._each("gnomon.disarm()")
        return self.stopped is not None

    def _stops(self, longest_s, meanwhile):
        until = time.monotonic() + longest_s
        while self.stopped is None and time.monotonic() < until:
            meanwhile()
            self._tools.listen(0.05)
        return self.stopped is not None

    def arm_from_the_start(self, longest_s):
        """The same of a page that is loaded anew, before its first such draw."""
        script = self._ask("Page.addScriptToEvaluateOnNewDocument", source="gnomon.arm()")["identifier"]
        self._tools.tell("Page.reload", self._session)
        self._stops(longest_s, lambda: None)
        self._ask("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
        return self.stopped is not None

    def go_on(self):
        """Lets a page run on that was stopped."""
        self._each("gnomon.disarm()")
        if self.stopped:
            self._tools.tell("Debugger.resume", self.stopped)
        self.stopped = None

    def hold_animations(self):
        self._tools.tell("Animation.enable", self._session)
        self._tools.tell("Animation.setPlaybackRate", self._session, playbackRate=0)

    def resize_all(self):
        """Tells the page of a new size, for which pages draw anew that draw on demand."""
        self._each("gnomon.resize()")

    def show(self):
        """Makes the page present something new."""
        self._ask("Runtime.evaluate", expression="gnomon.show()")

    def click(self):
        """On the first button that is seen, else in the page's middle. Returns which."""
        found = self._ask("Runtime.evaluate", returnByValue=True, expression="""(() => {
          const shown = (e) => { const r = e.getBoundingClientRect(); return r.width > 1 && r.height > 1 && e.checkVisibility?.() !== false; };
          const button = [...document.querySelectorAll("button, [role=button], input[type=button], input[type=submit]")].find(shown);
          const r = button?.getBoundingClientRect();
          return r ? [r.x + r.width / 2, r.y + r.height / 2, (button.innerText || button.value || "").trim().slice(0, 40)] : [innerWidth / 2, innerHeight / 2, null];
        })()""")
        x, y, words = found["result"]["value"]
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="none" if kind == "mouseMoved" else "left", clickCount=int(kind != "mouseMoved"))
        return "in the page's middle" if words is None else f'the page\'s button "{words}"'

    def rest(self, seconds):
        """Lets the page draw on."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self._tools.listen(until - time.monotonic())

    def listen(self, longest_s):
        self._tools.listen(longest_s)

    def close(self):
        """Asks the browser to end."""
        self._tools.tell("Browser.close")
