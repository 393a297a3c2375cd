"""The command line: python3 adapters/renderdoc FRAME.rdc -o DIR [--light N] | --list. Its lines begin with what they are, so that
`gnomon judge`, which starts it, can tell them from what drivers say: "found: ", "light N: ", "error: "."""
import argparse
import os
import shutil
import sys
import traceback

from .errors import FrameError


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"error: {message}\n")


def arguments(words):
    """What the words ask for; wrong ones end the process with exit code 2."""
    parser = _Parser(prog="python3 adapters/renderdoc", description="Make a capture for gnomon judge of a frame that RenderDoc recorded.")
    parser.add_argument("frame", metavar="FRAME.rdc")
    parser.add_argument("-o", "--output", metavar="DIR", help="the capture's folder")
    parser.add_argument("--light", type=int, metavar="N", help="that light alone, as --list numbers them [default all]")
    parser.add_argument("--list", action="store_true", help="list the lights with a shadow map, and stop")
    parser.add_argument("--name", default="", help="the renderer's name, for the report [default: the frame's name]")
    parser.add_argument("--encoding", choices=("auto", "srgb", "linear"), default="auto",
                        help="of 8-bit pictures that do not say; matters to partly lit pixels alone [default auto: srgb, unless the "
                             "reader has none of that curve's numbers, or an exponential map or a filter fits better without]")
    given = parser.parse_args(words)
    if not given.list and not given.output:
        parser.error("-o DIR is needed (or --list)")
    if given.light is not None and given.light < 1:
        parser.error("--light counts from 1")
    return given


def run(frame, given, say):
    """Lists lights, or writes the capture of one or of all: the path of capture.json then, else None."""
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
    if given.light and given.light > len(lights):
        raise FrameError(f"--light {given.light}: the frame has {len(lights)} (--list)")
    numbered = [(number, *light) for number, light in enumerate(lights, 1) if given.light in (None, number)]
    measured = []
    for number, found, layers in numbered:
        which = f"light {number}: " if len(numbered) > 1 else ""
        try:
            measured.append(capture.Measured(number, *_measure(frame, found, layers, lights, given.encoding, measured)))
        except FrameError as error:
            if not which:
                raise
            failed.append(error)
            say(f"found: {which}left out: {error}")
            continue
        for line in report.findings(frame, *measured[-1].parts):
            say("found: " + which + line)
    if not measured:
        raise failed[-1]
    return capture.write(given.output, frame, measured, given.name or os.path.splitext(os.path.basename(given.frame))[0])


def _measure(frame, found, layers, lights, encoding, before):
    """(found, layers, pixels, test) of a light. Those of one capture share the camera and its picture."""
    from . import casters, decision, extract, masks, pixels

    found.notes.clear()  # a map's, which may be several lights'
    numbers = extract.read_layers(frame, found, layers)
    others = [layer for _, those in lights if those is not layers for layer in those]
    seen, exponent, fitted = pixels.measure(frame, found, layers, encoding, others, numbers)
    if before and not pixels.is_same_picture(before[0].found, before[0].pixels, found, seen):
        raise FrameError("another camera draws it than the first light: --light judges it by itself")
    found.roles, hidden = casters.decide(frame, found.view, [layer for _, those in lights for layer in those], seen.depth, pixels.flip(seen.told, found.view), found.passes.cut)
    pixels.hide(seen, hidden, found.view)
    if not seen.asked.any():
        raise FrameError("no pixel is left whose light could be told: what the camera shows of this light's reach is not what its meshes are")
    masked = masks.leave_out(frame, found, layers, seen)
    found.notes += casters.words(found.view, found.roles)
    test = decision.find_test(found, layers, seen, numbers, exponent, fitted)
    if masked and test.radius:
        seen.asked &= ~masks.shadowed_by(layers, masked, seen, test.radius)
    if left_out := pixels.leave_out_borders(seen, layers, test.radius):
        found.notes.append(f"{left_out} pixels are left out, whose filter reads texels that no caster covers: the replays do not tell their light")
    decision.believe(found, layers, test)
    return found, layers, seen, test


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
    except Exception as error:  # what no frame held before: said in a line, as any other refusal is
        where = traceback.extract_tb(error.__traceback__)[-1]
        say(f"error: this frame holds what is not read ({type(error).__name__}: {error}, {os.path.basename(where.filename)}:{where.lineno})")
        return 3
    return 0
