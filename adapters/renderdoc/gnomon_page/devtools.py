"""Chromium's DevTools protocol through a pipe: JSON that ends with a zero byte, one object a message."""
import json
import os
import select
import time

from .errors import MISSING, PageError


class DevTools:
    """Both ends of the pipe. Events that come meanwhile are handed to `hears(method, parameters, session)`."""

    def __init__(self, reads, writes, hears):
        self._reads, self._writes, self._hears = reads, writes, hears
        self._last, self._left, self._answers = 0, b"", {}

    def ask(self, method, session=None, longest_s=30, **parameters):
        """The answer's result."""
        number = self.tell(method, session, **parameters)
        until = time.monotonic() + longest_s
        while number not in self._answers:
            self.listen(until - time.monotonic())
            if time.monotonic() > until:
                raise PageError(f"Chromium does not answer ({method})", MISSING)
        answer = self._answers.pop(number)
        if "error" in answer:
            raise PageError(f"Chromium refuses {method}: {answer['error'].get('message', '')}", MISSING)
        return answer["result"]

    def tell(self, method, session=None, **parameters):
        """Asks without waiting; the number of the answer."""
        self._last += 1
        message = {"id": self._last, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        try:
            os.write(self._writes, json.dumps(message).encode() + b"\0")
        except BrokenPipeError:
            raise PageError("Chromium has ended", MISSING) from None
        return self._last

    def listen(self, longest_s):
        """Takes what has come, and waits so long for it at most."""
        if not select.select([self._reads], [], [], max(longest_s, 0))[0]:
            return
        data = os.read(self._reads, 1 << 20)
        if not data:
            raise PageError("Chromium has ended", MISSING)
        *whole, self._left = (self._left + data).split(b"\0")
        for message in map(json.loads, whole):
            if "id" in message:
                self._answers[message["id"]] = message
            else:
                self._hears(message["method"], message.get("params", {}), message.get("sessionId"))
