"""The command line: python3 adapters/renderdoc FRAME.rdc -o DIR [--light N] | --list. Its lines begin with what they are, so that
`gnomon judge`, which starts it, can tell them from what drivers say: "found: ", "light N: ", "error: "."""
import argparse
import os
import shutil
import sys

from .errors import FrameError


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"error: {message}\n")


def arguments(words):
    """What the words ask for; wrong ones end the process with exit code 2."""
    parser = _Parser(prog="python3 adapters/renderdoc", description="Make a capture for gnomon judge of a frame that RenderDoc recorded.")
    parser.add_argument("frame", metavar="FRAME.rdc")
    parser.add_argument("-o", "--output", metavar="DIR", help="the capture's folder")
    parser.add_argument("--light", type=int, metavar="N", help="which light, as --list numbers them [default 1]")
    parser.add_argument("--list", action="store_true", help="list the lights with a shadow map, and stop")
    parser.add_argument("--name", default="", help="the renderer's name, for the report [default: the frame's name]")
    parser.add_argument("--encoding", choices=("auto", "srgb", "linear"), default="auto",
                        help="of 8-bit pictures that do not say; matters to partly lit pixels alone [default auto: srgb, unless an "
                             "exponential map fits better without]")
    given = parser.parse_args(words)
    if not given.list and not given.output:
        parser.error("-o DIR is needed (or --list)")
    if given.light is not None and given.light < 1:
        parser.error("--light counts from 1")
    return given


def run(frame, given, say):
    """Lists lights, or writes the capture of one: the path of capture.json then, else None."""
    from . import capture, extract, passes, report

    maps = passes.find_maps(frame)
    if not maps:
        raise passes.why_none(frame)
    lights, failed = [], []
    for one in maps:
        try:
            found = extract.look_at(frame, one)
            lights += [(found, layers) for layers in found.lights]
        except FrameError as error:
            failed.append(error)
    if not lights:
        raise failed[0]
    if given.list:
        for number, (found, layers) in enumerate(lights, 1):
            say(report.light_line(number, frame, found, layers))
        return None
    number = given.light or 1
    if number > len(lights):
        raise FrameError(f"--light {number}: the frame has {len(lights)} (--list)")
    found, layers = lights[number - 1]
    numbers = extract.read_layers(frame, found, layers)
    pixels, exponent = extract.measure(frame, found, layers, given.encoding)
    test = extract.find_test(found, layers, pixels, numbers, exponent)
    for line in report.findings(frame, found, layers, test):
        say("found: " + line)
    return capture.write(given.output, frame, found, layers, pixels, test, given.name or os.path.splitext(os.path.basename(given.frame))[0])


def _on_a_display(words):
    """OpenGL is replayed on a display: where there is none this process goes on below xvfb-run, or returns."""
    if shutil.which("xvfb-run"):
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        os.execvp("xvfb-run", ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 64x64x24", sys.executable, "-B", package, *words])


def main(words=None):
    """Exit codes are those of gnomon: 0 done, 2 wrong words, 3 a frame that no capture can be made of, 4 a folder that cannot be
    written, 5 RenderDoc's module or a display is missing."""
    words = sys.argv[1:] if words is None else words
    given = arguments(words)
    say = lambda line: print(line, flush=True)
    try:
        from .replay import Frame, NoDisplay
    except ImportError as error:
        say(f"error: {error}. Frames are replayed by RenderDoc's module for Python (Debian: apt install python3-renderdoc python3-numpy)")
        return 5
    try:
        with Frame.open(given.frame) as frame:
            run(frame, given, say)
    except NoDisplay as error:
        _on_a_display(words)
        say(f"error: {error}")
        return 5
    except FrameError as error:
        say(f"error: {error}")
        return 3
    except OSError as error:
        say(f"error: {error}")
        return 4
    return 0
