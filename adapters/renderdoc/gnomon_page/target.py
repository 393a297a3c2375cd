"""RenderDoc's target control of a browser: which of its processes draws, and one frame of it."""
import os
import time

import renderdoc as rd

from .errors import MISSING, PageError

START_S = 60  # in which the browser makes its Vulkan device


def _is_below(process, parent):
    """Whether a process is another, or was started below it."""
    while process > 1 and process != parent:
        try:
            with open(f"/proc/{process}/stat", encoding="utf-8") as file:
                process = int(file.read().rsplit(")", 1)[1].split()[1])
        except OSError:
            return False
    return process == parent


def _targets():
    ident = rd.EnumerateRemoteTargets("", 0)
    while ident:
        yield ident
        ident = rd.EnumerateRemoteTargets("", ident)


class Target:
    """The process below `parent` that draws."""

    def __init__(self, parent):
        self._parent, self._control, self._draws = parent, None, False

    def _connect(self):
        for ident in list(_targets()):
            control = rd.CreateTargetControl("", ident, "gnomon", False)  # one that another recorder speaks with is let alone
            if control and _is_below(control.GetPID(), self._parent):
                self._control = control
                return
            if control:
                control.Shutdown()

    def _hear(self):
        """The file of a frame that has come meanwhile, or None. The connection is cut off once, when the device is made."""
        if self._control is None:
            self._connect()
            if self._control is None:
                time.sleep(0.3)
            return None
        message = self._control.ReceiveMessage(None)
        if message.type == rd.TargetControlMessageType.RegisterAPI:
            self._draws = True
        elif message.type == rd.TargetControlMessageType.NewCapture:
            return message.newCapture.path
        elif message.type in (rd.TargetControlMessageType.Disconnected, rd.TargetControlMessageType.Busy):
            self._control.Shutdown()
            self._control, self._draws = None, False
        elif message.type == rd.TargetControlMessageType.Noop:
            time.sleep(0.02)
        return None

    def wait(self):
        """Until its device is there."""
        until = time.monotonic() + START_S
        while not self._draws:
            self._hear()
            if time.monotonic() > until:
                raise PageError("RenderDoc's layer is in no process of the browser: Chromium did not start to draw on Vulkan. Its own words: "
                                "chromium --use-gl=angle --use-angle=vulkan --enable-logging=stderr", MISSING)

    def ask(self, frames=1):
        """Asks for the next frames."""
        self.wait()
        self._control.TriggerCapture(frames)

    def frame(self, longest_s):
        """The file of the frame that was asked for, or None where none is presented within so long."""
        until = time.monotonic() + longest_s
        while time.monotonic() < until:
            path = self._hear()
            if path and os.path.exists(path):
                return path
        return None

    def close(self):
        if self._control:
            self._control.Shutdown()
