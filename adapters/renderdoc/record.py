"""Starts a program with RenderDoc in it, records one frame and ends the program: what F12 does, where nobody sits at a window.

/usr/bin/python3 adapters/renderdoc/record.py -o FRAME.rdc [--frame N] PROGRAM WORDS...
"""
import argparse
import os
import shutil
import signal
import sys
import tempfile
import time

LONGEST_S = 120  # from the program's start to the frame


def record(program, words, number, path):
    """Records frame `number` of a program to `path`; an error is a SystemExit with its words."""
    import renderdoc as rd

    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    options = rd.GetDefaultCaptureOptions()
    options.refAllResources = False
    with tempfile.TemporaryDirectory(dir=os.path.dirname(os.path.abspath(path))) as folder:
        started = rd.ExecuteAndInject(shutil.which(program) or program, os.getcwd(), " ".join(words), [], os.path.join(folder, "frame"), options, False)
        if started.result != rd.ResultCode.Succeeded:
            raise SystemExit(f"record: {program} cannot be started: {started.result.Message()}")
        control, until = None, time.monotonic() + LONGEST_S
        while control is None and time.monotonic() < until:
            control = rd.CreateTargetControl("", started.ident, "gnomon", True)
        if control is None:
            raise SystemExit(f"record: {program} has ended, or does not answer")
        try:
            shutil.move(_wait(rd, control, number, until), path)
        finally:
            process = control.GetPID()
            control.Shutdown()
            try:
                os.kill(process, signal.SIGTERM)
            except ProcessLookupError:
                pass
            rd.ShutdownReplay()


def _numbers(number):
    """The frame that is wished for, and later ones, of which the first that is still to come is recorded."""
    numbers = [number]
    while numbers[-1] < 1_000_000:
        numbers.append(max(2 * numbers[-1], numbers[-1] + 10))
    return numbers


def _wait(rd, control, number, until):
    """The file of the frame, once it is recorded."""
    queued = False
    while time.monotonic() < until:
        message = control.ReceiveMessage(None)
        if message.type == rd.TargetControlMessageType.RegisterAPI and message.apiUse.presenting and not queued:
            if not message.apiUse.supported:
                raise SystemExit(f"record: RenderDoc cannot record {message.apiUse.name} here: {message.apiUse.supportMessage}")
            # RenderDoc forgets without a word what is asked for too late, and does not say which frame is being drawn.
            for at in _numbers(number):
                control.QueueCapture(at, 1)
            queued = True
        elif message.type == rd.TargetControlMessageType.NewCapture:
            taken = message.newCapture.frameNumber
            if taken > number:
                print(f"record: frame {taken}, for the program had drawn frame {number} before it could be recorded", file=sys.stderr)
            return message.newCapture.path
        elif message.type == rd.TargetControlMessageType.Disconnected:
            raise SystemExit("record: the program has ended before the frame was drawn")
        elif message.type == rd.TargetControlMessageType.Noop:
            time.sleep(0.02)
    raise SystemExit(f"record: no frame within {LONGEST_S} s" + ("" if queued else ": the program presents nothing"))


def main():
    parser = argparse.ArgumentParser(prog="record.py", description="Record one frame of a program with RenderDoc.")
    parser.add_argument("-o", "--output", metavar="FRAME.rdc", required=True)
    parser.add_argument("--frame", type=int, default=12, metavar="N", help="which frame, counted from the program's start, or the next that can be had [default 12]")
    parser.add_argument("program")
    parser.add_argument("words", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    record(given.program, given.words, given.frame, given.output)


if __name__ == "__main__":
    sys.exit(main())
