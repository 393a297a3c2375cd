"""Starts a program with RenderDoc in it, records one frame and ends the program: what F12 does, where nobody sits at a window.

/usr/bin/python3 adapters/renderdoc/record.py -o FRAME.rdc [--frame N] PROGRAM WORDS...
/usr/bin/python3 adapters/renderdoc/record.py -o FRAME.rdc --page URL          a web page, in a browser without a screen
"""
import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

LONGEST_S = 600  # from the program's start to the frame
LONGEST_OF_PAGES_S = 120
LOOKED_S = 0.3  # between two looks for programs that are new
SAID_S = 30  # after so long without a frame it is said what is waited for
TO_END_S = 5  # in which a program may end by itself when it is told to


def record(program, words, number, path, longest_s=LONGEST_S):
    """Records frame `number` of a program to `path`; an error is a SystemExit with its words."""
    found = shutil.which(program)
    if not found:
        raise SystemExit(f"record: {program} may not be executed" if os.path.isfile(program) else f"record: no such program: {program}")
    import renderdoc as rd

    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    for caught in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(caught, lambda number, _: sys.exit(128 + number))
    controls = {}
    try:
        with tempfile.TemporaryDirectory(dir=os.path.dirname(os.path.abspath(path))) as folder:
            # Not by RenderDoc's own ExecuteAndInject, which has a second's patience with a program that loads for long.
            # What is named RENDERDOC_ORIGPRELOAD the library leaves to what the program starts, of which a script may be the beginning.
            library = _library()
            prepared = {**os.environ, "LD_PRELOAD": library, "RENDERDOC_ORIGPRELOAD": library, "RENDERDOC_CAPFILE": os.path.join(folder, "frame"),
                        "ENABLE_VULKAN_RENDERDOC_CAPTURE": "1"}
            started = subprocess.Popen([os.path.abspath(found), *words], env=prepared)
            shutil.move(_wait(rd, controls, started, number, longest_s), path)
    finally:
        for control in controls.values():
            control.Shutdown()
        _end(_descendants())
        rd.ShutdownReplay()


def _library():
    """RenderDoc's library, which its module for Python has loaded."""
    with open("/proc/self/maps", encoding="utf-8") as file:
        return next(line.split()[-1] for line in file if "librenderdoc" in line)


def _open_new(rd, controls, others):
    """Opens what has RenderDoc in it and was started by this process; what others started is let alone. `controls`: {number: what is open};
    `others`: {number: process} of the others', which are looked at once; a number is another's when its process has ended."""
    ident = rd.EnumerateRemoteTargets("", 0)
    while ident:
        is_known = ident in controls or os.path.exists(f"/proc/{others.get(ident, 'none')}")
        if not is_known and (control := rd.CreateTargetControl("", ident, "gnomon", False)) is not None:
            if control.GetPID() in _descendants():
                controls[ident] = control
            else:
                others[ident] = control.GetPID()
                control.Shutdown()
        ident = rd.EnumerateRemoteTargets("", ident)


def _descendants():
    """Processes that this one started, and what these did."""
    children = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                state, parent = file.read().rpartition(")")[2].split()[:2]
        except OSError:
            continue
        if state != "Z":
            children.setdefault(int(parent), []).append(int(name))
    found, left = [], [os.getpid()]
    while left:
        mine = children.get(left.pop(), [])
        found, left = found + mine, left + mine
    return found


def _end(processes):
    """Tells processes to end, and makes those that do not."""
    for asked in (signal.SIGTERM, signal.SIGKILL):
        for process in processes:
            try:
                os.kill(process, asked)
            except ProcessLookupError:
                pass
        until = time.monotonic() + TO_END_S
        while (processes := [one for one in processes if one in _descendants()]) and time.monotonic() < until:
            time.sleep(0.05)
        if not processes:
            return


def _numbers(number):
    """The frame that is wished for, and later ones, of which the first that is still to come is recorded."""
    numbers = [number]
    while numbers[-1] < 1_000_000:
        numbers.append(max(2 * numbers[-1], numbers[-1] + 10))
    return numbers


def _wait(rd, controls, started, number, longest_s):
    """The file of the frame, once it is recorded. `controls`: what is opened to speak with the program and what it starts."""
    others, presents, begun = {}, False, time.monotonic()
    said, looked = begun + SAID_S, begun
    while (now := time.monotonic()) < begun + longest_s:
        if now >= looked:
            _open_new(rd, controls, others)
            looked = time.monotonic() + LOOKED_S
        for ident, control in list(controls.items()):
            message = control.ReceiveMessage(None)
            if message.type == rd.TargetControlMessageType.RegisterAPI and message.apiUse.presenting:
                if not message.apiUse.supported:
                    why = message.apiUse.supportMessage or "its context is older than 3.2, or has no core profile"
                    raise SystemExit(f"record: RenderDoc cannot record {message.apiUse.name} here: {why}")
                _queue(control, number)
                presents = True
            elif message.type == rd.TargetControlMessageType.NewCapture:
                taken = message.newCapture.frameNumber
                if taken > number:
                    print(f"record: frame {taken}, for the program had drawn frame {number} before it could be recorded", file=sys.stderr)
                return message.newCapture.path
            elif message.type in (rd.TargetControlMessageType.Disconnected, rd.TargetControlMessageType.Busy):
                controls.pop(ident).Shutdown()  # it has ended, or somebody else speaks with it, who may be looking for a program of their own
        if started.poll() is not None and not _descendants():
            raise SystemExit("record: the program has ended before the frame was drawn" + ("" if presents else ", and presented nothing"))
        if now > said:
            said += SAID_S
            waited = f"frame {number}" if presents else "the program to present a picture"
            print(f"record: waiting for {waited} ({now - begun:.0f} s)", file=sys.stderr)
        time.sleep(0.02)
    raise SystemExit(f"record: no frame within {longest_s:g} s" + ("" if presents else ": the program presents nothing that RenderDoc sees (a core profile of "
                                                                 "OpenGL, Vulkan or Direct3D)"))


def _queue(control, number):
    """RenderDoc forgets without a word what is asked for too late, and does not say which frame is being drawn."""
    for at in _numbers(number):
        control.QueueCapture(at, 1)


def _size(words):
    width, _, height = words.partition("x")
    if not (width.isdigit() and height.isdigit() and 16 <= int(width) <= 8192 and 16 <= int(height) <= 8192):
        raise argparse.ArgumentTypeError("needs WIDTHxHEIGHT, 16 to 8192 each")
    return int(width), int(height)


def _record_page(given):
    """Exit codes are those of gnomon: 3 a page without a frame that has shadows, 4 a file that cannot be written, 5 what is not installed.
    Lines begin with what they are: "note: ", "engine: " or "error: "."""
    from gnomon_page import programs, recording
    from gnomon_page.errors import PageError

    programs.end_on_signals()
    try:
        recording.record(given.page, given.output, given.size, given.wait or LONGEST_OF_PAGES_S, lambda line: print(line, flush=True))
    except PageError as error:
        print(f"error: {error}", flush=True)
        return error.code
    except OSError as error:
        print(f"error: {error}", flush=True)
        return 5
    return 0


def main():
    parser = argparse.ArgumentParser(prog="record.py", description="Record one frame of a program with RenderDoc.")
    parser.add_argument("-o", "--output", metavar="FRAME.rdc", required=True)
    parser.add_argument("--frame", type=int, default=12, metavar="N", help="which frame, counted from the program's start, or the next that can be had [default 12]")
    parser.add_argument("--page", metavar="URL", help="a page of your own, by its address or file, in place of a program: the first frame with shadows")
    parser.add_argument("--size", type=_size, default=(960, 540), metavar="WxH", help="the page's window [default 960x540]")
    parser.add_argument("--wait", type=float, metavar="S", help="seconds in which a page must draw shadows, or a program its frame [default "
                        f"{LONGEST_OF_PAGES_S}, {LONGEST_S} of a program]")
    parser.add_argument("program", nargs="?")
    parser.add_argument("words", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    if bool(given.page) == bool(given.program):
        parser.error("needs a program, or --page URL")
    if given.page:
        return _record_page(given)
    record(given.program, given.words, given.frame, given.output, given.wait or LONGEST_S)


if __name__ == "__main__":
    sys.exit(main())
