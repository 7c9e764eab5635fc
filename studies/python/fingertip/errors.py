"""What can go wrong, each with the words of the program."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One thing that is wrong with the input."""

    place: str
    key: str
    value: str
    rule: str
    remedy: str

    def __str__(self) -> str:
        what = f"{self.key} = {self.value}" if self.key and self.value else self.key or self.value
        text = ": ".join(part for part in (self.place, what, self.rule) if part)
        return f"{text}; {self.remedy}" if self.remedy else text


class Error(Exception):
    """Everything that fingertip raises."""


class ConfigError(Error, ValueError):
    """The input is wrong; `problems` has all that was found (exit code 2)."""

    def __init__(self, problems):
        self.problems = [Problem(*problem) for problem in problems]
        super().__init__("\n".join(map(str, self.problems)))


class NotConverged(Error, RuntimeError):
    """A solver stopped short of its tolerance, or the run says that it is not good enough; what was
    finished is kept. `run` has it where the verb came to its end (exit code 3)."""

    def __init__(self, message, run=None):
        super().__init__(message)
        self.run = run


class ProcessLost(NotConverged):
    """A process that did the work was lost."""


class ControllerFailed(Error, RuntimeError):
    """A controller died, hangs, or commanded what is no number."""


class CannotWrite(Error, OSError):
    """A file could not be written or moved."""


class TestsFailed(Error):
    """A fit failed its own tests, or a case a criterion: `run` has what was found (exit code 4)."""

    __test__ = False  # of no test runner's

    def __init__(self, message, run=None):
        super().__init__(message)
        self.run = run
