"""The one error that this package raises for a person to read."""

BAD_INPUT, CANNOT_WRITE, MISSING = 3, 4, 5  # gnomon's exit codes


class PageError(Exception):
    """A page of which no frame can be recorded: one sentence that says why and what to do, and the exit code."""

    def __init__(self, words, code=BAD_INPUT):
        super().__init__(words)
        self.code = code
