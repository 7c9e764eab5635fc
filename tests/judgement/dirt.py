"""Kinds of dirt, and what sets of every kind have: numbers drawn by a seed, a folder, a fit."""

import collections
import json
import math
import re
import shlex

Kind = collections.namedtuple("Kind", "of group draw describable cause")
KINDS = {}
# Of a fit: exit code, {name: (estimate, lower, upper)}, first cause, why it failed, screen.
Fit = collections.namedtuple("Fit", "code found first failed words")


def kinds_of(of, group):
    """A decorator of kinds of `of` (presses or tests) in this group.

    describable: True: a laboratory's honest model can describe it, and has to accept it; False: it
    cannot, and what refuses it names `cause` first, a regular expression; "either": accepted or
    refused, both are fine. Whatever is accepted has to cover the truth.
    """

    def kind(describable=True, cause=""):
        def register(draw):
            KINDS[draw.__name__] = Kind(of, group, draw, describable, cause)
            return draw

        return register

    return kind


class Unseen(Exception):
    """A fault that does not show: another set has to be drawn."""


class Set:
    """One set: its numbers, its folder, the truth of what is sought."""

    problem, record = "", ""

    def __init__(self, bench, numbers, folder):
        self.bench, self.random, self.folder = bench, numbers, folder
        self.modulus = 0.0  # [kPa]
        self.truths = {}  # of names a number or (low, high): anything between is right; [Pa]
        self.seen = None  # what the truth without the fault misses, over the largest force

    def between(self, low, high):
        """Of its logarithm."""
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def either_sign(self, low, high):
        return self.random.choice([-1, 1]) * self.random.uniform(low, high)

    def table(self, name, titles, rows):
        lines = [";".join(titles)] + [";".join(f"{value:.9g}" for value in row) for row in rows]
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def fitted(self, settings):
        settings = [f"calibration.problem={self.problem}"] + settings
        words = [self.bench.program, "calibrate", "--out", str(self.folder / "fit")]
        words += [word for setting in settings for word in ("--set", setting)]
        (self.folder / "command.txt").write_text(shlex.join(words) + "\n")
        run = self.bench.run("calibrate", settings, self.folder / "fit")
        screen = (run.stdout + run.stderr).replace(f"{self.folder}/", "")
        (self.folder / "words.txt").write_text(screen)
        file = self.folder / "fit" / self.record
        told = json.loads(file.read_text()) if file.exists() else {}
        errors = re.findall(r"(?m)^fingertip: (?!note: )(?:not accepted: |error: )?(.*)$", screen)
        suspects = told.get("lack_of_fit")
        failed = told.get("failed") or (errors if run.returncode else [])
        return Fit(run.returncode, self.estimates(told), suspects[0]["name"] if suspects else "",
                   failed, screen)

    def estimates(self, told):
        raise NotImplementedError

    def names_cause(self, fit, cause):
        """Whether the first suspect or the first sentence that refuses matches."""
        return any(re.search(cause, text) for text in [fit.first] + fit.failed[:1])
