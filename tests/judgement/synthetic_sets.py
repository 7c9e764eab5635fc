#!/usr/bin/env python3
"""Draws dirty measurements whose truth is known, has them fitted, and judges what the fits tell.

    tests/judgement/synthetic_sets.py --seed 1 [--sets 200] [--each N] [--only KIND ...]
                                      [--group presses|tests] [--program fingertip]
                                      [--keep FOLDER] [--jobs 1] [--sampler N]

Kinds of dirt stand in dirty_presses.py and dirty_tests.py: each says whether an honest model can
describe it. What a fit accepts has to have the truth in its 95 % interval, whatever the dirt; what
can be described has to be accepted; what is refused rightly has to be accused of the right cause.
With --sampler accepted presses of plainer kinds are also given to posterior_sampler.py, a sampler
that shares nothing with the program, and the widths of both intervals compared.
"""

import argparse
import collections
import concurrent.futures
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import dirty_presses
import dirty_tests
from dirt import KINDS, Unseen
from truth import Bench

FAMILIES = {"presses": dirty_presses.Press, "tests": dirty_tests.Tests}
FAR = 1.5  # half-widths of the truth from the middle of the interval
COVERED, FAR_SHARE, REFUSED_SHARE, RIGHT_SHARE, WIDER = 0.92, 0.01, 0.04, 0.9, 2.0
SAMPLER = pathlib.Path(__file__).with_name("posterior_sampler.py")

# What a fit tells of one parameter: truth (low, high), its distance from the middle of the interval
# over half of the width.
Told = collections.namedtuple("Told", "name estimate lower upper truth distance")
Judged = collections.namedtuple("Judged", "kind number set fit told right seconds")


def told_of(fit, truths):
    result = []
    for name, truth in truths.items():
        low, high = truth if isinstance(truth, tuple) else (truth, truth)
        if name not in fit.found or None in fit.found[name]:
            return []
        estimate, lower, upper = fit.found[name]
        middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
        distance = abs(min(max(middle, low), high) - middle) / max(1e-300, half)
        result.append(Told(name, estimate, lower, upper, (low, high), distance))
    return result


def judged(options, bench, place, name, number):
    kind, begin = KINDS[name], time.monotonic()
    # Of a name that says nothing: it stands in the words that are searched.
    folder = place / f"set_{list(KINDS).index(name)}_{number}"
    for trial in range(20):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        s = FAMILIES[kind.of](bench, random.Random(f"{options.seed} {name} {number} {trial}"),
                              folder)
        try:
            fit = kind.draw(s)
            break
        except Unseen:
            continue
    else:
        raise RuntimeError(f"{name}: the fault never shows")
    right = fit.code != 0 and kind.describable is False and s.names_cause(fit, kind.cause)
    return Judged(name, number, s, fit, told_of(fit, s.truths), right, time.monotonic() - begin)


# What is counted.


class Counts:
    def __init__(self, sets):
        of = {describable: [j for j in sets if KINDS[j.kind].describable is describable]
              for describable in (True, False, "either")}
        self.sets = sets
        self.accepted = [j for j in sets if j.fit.code == 0]
        told = [t for j in self.accepted for t in j.told]
        self.told = len(told)
        self.covered = sum(t.distance <= 1 for t in told)
        self.far = [j for j in self.accepted if not j.told or any(t.distance > FAR for t in j.told)]
        self.describable = of[True]
        self.refused = [j for j in of[True] if j.fit.code != 0]
        self.rightly = [j for j in of[False] if j.fit.code != 0]
        self.misjudged = [j for j in self.rightly if not j.right]
        self.widths = [0.5 * (t.upper - t.lower) / t.truth[0] for t in told]

    def row(self, group):
        width = f"{100 * statistics.median(self.widths):.2g} %" if self.widths else ""
        return (f"| {group} | {len(self.sets)} | {len(self.accepted)} | {self.covered} of "
                f"{self.told} | {len(self.far)} | {len(self.refused)} of {len(self.describable)} | "
                f"{len(self.rightly) - len(self.misjudged)} of {len(self.rightly)} | {width} |")

    def missed(self):
        """What is wanted and is not so."""
        wanted = {
            f"coverage at least {COVERED}": self.covered >= COVERED * self.told,
            f"far outside at most {FAR_SHARE}": len(self.far) <= FAR_SHARE * len(self.accepted),
            f"refused though describable at most {REFUSED_SHARE}":
                len(self.refused) <= REFUSED_SHARE * len(self.describable),
            "exits of 0, 2 and 4 alone": all(j.fit.code in (0, 2, 4) for j in self.sets),
            f"right causes at least {RIGHT_SHARE}":
                len(self.misjudged) <= (1 - RIGHT_SHARE) * len(self.rightly)}
        return [words for words, holds in wanted.items() if not holds]


def line_of(j):
    told = "; ".join(
        f"{t.name} {t.estimate:.5g} ({t.lower:.5g} to {t.upper:.5g}), truth "
        + " to ".join(f"{bound:.5g}" for bound in sorted(set(t.truth)))
        + f", {t.distance:.1f} half-widths" for t in j.told)
    seen = f"; without the fault {100 * j.set.seen:.2g} % are missed" if j.set.seen else ""
    cause = j.fit.first or "no suspect"
    failed = f": {j.fit.failed[0][:160]}" if j.fit.failed else ""
    return (f"- {j.kind} {j.number} ({j.set.folder.name}): {told or 'no estimate'}{seen}; exit "
            f"{j.fit.code}; {cause}{failed}")


def sampled(options, bench, sets):
    """Compares widths with those of the sampler; whether the program's are at most twice."""
    python, fine, done = options.sampler_python, True, 0
    print("\n| sampled | E of the fit | of the sampler | truth | widths, fit over sampler |\n"
          "|---|---|---|---|---|")
    for j in sets:
        if done == options.sampler:
            break
        if j.kind not in dirty_presses.PLAINER or j.fit.code != 0 or not j.told:
            continue
        place = bench.place(j.set.contact, j.set.ratio, **j.set.finger)
        words = [python, str(SAMPLER), str(j.set.folder / "a.csv"), "--table",
                 str(place / "response.csv")]
        run = subprocess.run(words, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{SAMPLER.name}: {run.stderr.strip()}")
        median, lower, upper = map(float, run.stdout.split()[:3])  # [Pa]
        told = j.told[0]
        ratio = (told.upper - told.lower) / (upper - lower)
        fine, done = fine and ratio <= WIDER, done + 1
        print(f"| {j.kind} {j.number} | {told.estimate:.5g} ({told.lower:.5g} to {told.upper:.5g}) "
              f"| {median:.5g} ({lower:.5g} to {upper:.5g}) | {told.truth[0]:.5g} | {ratio:.2f} |",
              flush=True)
    return fine


def numbers_of(options):
    """How many sets of each kind, dealt in turn."""
    names = [name for name, kind in KINDS.items()
             if (not options.only or name in options.only)
             and (not options.group or kind.of == options.group)]
    return {name: options.each or options.sets // len(names) + (i < options.sets % len(names))
            for i, name in enumerate(names)}


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--sets", type=int, default=200)
    arguments.add_argument("--each", type=int, help="sets of each kind, instead")
    arguments.add_argument("--only", nargs="+", choices=list(KINDS))
    arguments.add_argument("--group", choices=list(FAMILIES))
    arguments.add_argument("--program", default="build/release/bin/fingertip")
    arguments.add_argument("--keep", type=pathlib.Path, help="folder that keeps files and runs")
    arguments.add_argument("--jobs", type=int, default=1)
    arguments.add_argument("--sampler", type=int, default=0, metavar="N",
                           help="compare N presses of plainer kinds with a sampler")
    arguments.add_argument("--sampler-python", default="/usr/bin/python3", help="one with numpy")
    options = arguments.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    print("| kind | describable | exit codes | truth from the interval's middle, half-widths | "
          "first cause of refusals |\n|---|---|---|---|---|")
    groups = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as temporary:
        place = (options.keep or pathlib.Path(temporary)).resolve()
        place.mkdir(parents=True, exist_ok=True)
        bench = Bench(program, place)
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            waiting = {name: [pool.submit(judged, options, bench, place, name, number)
                              for number in range(count)]
                       for name, count in numbers_of(options).items() if count}
            for name, promised in waiting.items():
                sets = [promise.result() for promise in promised]
                groups[KINDS[name].group] += sets
                told = {True: "yes", False: "no", "either": "either"}[KINDS[name].describable]
                print(f"| {name} | {told} | {' '.join(str(j.fit.code) for j in sets)} | "
                      + " ".join("/".join(f"{t.distance:.1f}" for t in j.told) or "-" for j in sets)
                      + " | " + ", ".join((j.fit.first or "-") + " (right)" * j.right
                                          for j in sets if j.fit.code) + " |", flush=True)
        everything = [j for sets in groups.values() for j in sets]
        fine = sampled(options, bench, everything) if options.sampler else True
    print("\n| group | sets | accepted | truth in the interval | far outside | "
          "refused though describable | refused rightly, right cause | median half-width |\n"
          "|---|---|---|---|---|---|---|---|")
    for group, sets in groups.items():
        print(Counts(sets).row(group))
    counts = Counts(everything)
    print(counts.row("all"))
    for title, sets in (("Accepted, the truth far outside", counts.far),
                        ("Refused though describable", counts.refused),
                        ("Refused rightly, for another cause", counts.misjudged)):
        print(f"\n{title}: {len(sets)}\n" + "\n".join(map(line_of, sets)))
    missed = counts.missed() + ([] if fine else [f"widths at most {WIDER} of the sampler's"])
    print(f"\nseed {options.seed}, {len(everything)} sets, "
          f"{sum(j.seconds for j in everything) / max(1, len(everything)):.1f} s each. "
          + ("As wanted" if not missed else "Not as wanted: " + "; ".join(missed)))
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
