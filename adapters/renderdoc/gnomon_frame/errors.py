"""The one error that this package raises for a person to read."""


class FrameError(Exception):
    """A frame that no capture can be made of: one sentence that says why, and what to do."""
