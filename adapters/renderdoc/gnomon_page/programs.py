"""The programs that draw a page where nobody sits at a window, Xvfb and Chromium: what they need, their start and their end."""
import os
import shutil
import signal
import subprocess
import tempfile
from contextlib import contextmanager

from .errors import MISSING, PageError

DRIVERS = [f"{folder}/vulkan/icd.d/lvp_icd{end}" for folder in ("/usr/share", "/etc", "/usr/local/share") for end in (".x86_64.json", ".aarch64.json", ".json")]
LAYERS = [f"{folder}/vulkan/implicit_layer.d/renderdoc_capture.json" for folder in ("/usr/share", "/etc", "/usr/local/share")]
BROWSERS = ("/usr/lib/chromium/chromium", "chromium", "chromium-browser", "google-chrome")
GRACE_S = 5  # for what a program does when it is asked to end
SWITCHES = (
    # WebGL on Vulkan, on a driver that Chromium knows nothing of, in a process that RenderDoc finds.
    "--use-gl=angle", "--use-angle=vulkan", "--ignore-gpu-blocklist", "--disable-gpu-driver-bug-workarounds",
    "--enable-angle-features=exposeNonConformantExtensionsAndVersions", "--no-sandbox", "--no-zygote", "--disable-gpu-watchdog", "--ozone-platform=x11",
    # One process for a page and the frames in it; modules of a page that is a file.
    "--disable-features=IsolateOrigins,site-per-process,Translate", "--disable-site-isolation-trials", "--allow-file-access-from-files",
    # Nothing beside the page that is drawn, such as a tab's turning wheel, and nothing that waits for a person.
    "--no-first-run", "--no-default-browser-check", "--disable-extensions", "--disable-component-update", "--disable-background-networking", "--disable-sync",
    "--disable-breakpad", "--disable-dev-shm-usage", "--password-store=basic", "--autoplay-policy=no-user-gesture-required",
    "--disable-backgrounding-occluded-windows", "--disable-renderer-backgrounding", "--kiosk", "--remote-debugging-pipe",
)


def _first(paths, what, package):
    found = next((path for path in paths if shutil.which(path) or os.path.isfile(path)), None)
    if not found:
        raise PageError(f"{what} is not installed, which recording a page needs (./gnomon install pages; Debian: apt install {package})", MISSING)
    return found


def find():
    """(browser, Xvfb, the environment in which RenderDoc's layer is loaded); a PageError says which package is missing."""
    browser = _first(BROWSERS, "Chromium", "chromium")
    server = _first(("Xvfb",), "Xvfb", "xvfb")
    driver = _first(DRIVERS, "Mesa's software Vulkan (lavapipe)", "mesa-vulkan-drivers")
    _first(LAYERS, "RenderDoc's Vulkan layer", "renderdoc")
    environment = {**os.environ, "VK_ICD_FILENAMES": driver, "VK_DRIVER_FILES": driver, "ENABLE_VULKAN_RENDERDOC_CAPTURE": "1", "RENDERDOC_HOOK_EGL": "0"}
    return browser, server, environment


@contextmanager
def _running(words, **how):
    """A program, with all that it starts ended at the end."""
    program = subprocess.Popen(words, stdin=subprocess.DEVNULL, **how)
    try:
        yield program
    finally:
        for ask in (program.terminate, program.kill):
            ask()
            try:
                program.wait(GRACE_S)
                break
            except subprocess.TimeoutExpired:
                pass


@contextmanager
def display(server, size):
    """The name of a display without a screen. Xvfb ends with its last client, too, should nobody be left to end it."""
    reads, writes = os.pipe()
    words = [server, "-displayfd", str(writes), "-screen", "0", f"{size[0] + 200}x{size[1] + 300}x24", "-nolisten", "tcp", "-terminate", "10"]
    with _running(words, pass_fds=[writes], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
        os.close(writes)
        with os.fdopen(reads) as file:
            number = file.readline().strip()
        if not number:
            raise PageError("Xvfb does not start", MISSING)
        yield f":{number}"


@contextmanager
def chromium(browser, environment, size):
    """(process, what to read from, what to write to). It ends when nobody writes any more."""
    to_browser, from_browser = os.pipe(), os.pipe()
    with tempfile.TemporaryDirectory(prefix="gnomon-browser-", ignore_cleanup_errors=True) as profile:
        words = [browser, *SWITCHES, f"--user-data-dir={profile}", f"--window-size={size[0] + 100},{size[1] + 200}", "about:blank"]
        # The protocol's descriptors are 3 and 4.
        shell = ["/bin/bash", "-c", f'exec "$@" 3<&{to_browser[0]} 4>&{from_browser[1]}', "bash", *words]
        try:
            with _running(shell, env=environment, pass_fds=[to_browser[0], from_browser[1]], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          start_new_session=False) as program:
                os.close(to_browser[0])
                os.close(from_browser[1])
                yield program, from_browser[0], to_browser[1]
        finally:
            os.close(to_browser[1])
            os.close(from_browser[0])


def end_on_signals():
    """SIGTERM and SIGHUP end this process as Ctrl-C does: what it has started is ended first."""
    def leave(number, _frame):
        raise SystemExit(128 + number)

    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
        signal.signal(number, leave)
