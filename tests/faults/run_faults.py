#!/usr/bin/env python3
"""Puts the faults of faults.toml into the sources, one at a time, and tells which tests catch them.

    tests/faults/run_faults.py [--build build/release] [--only N ...] [--all] [--table FILE]
    tests/faults/run_faults.py --check

A fault is caught when a program that ought to catch it fails or does not build its test. With --all
the default tests follow where none does. --check only tells whether every fault has its place. Each
row is written as soon as it is known; a run that is stopped leaves the sources as they were, and
goes on after the rows of the table. Needs a tree without changes in the sources it touches.
"""

import argparse
import pathlib
import subprocess
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
HEAD = "| fault | place | kind | breaks | caught by |\n|---|---|---|---|---|\n"


def place_of(fault):
    """The one source that has the fault's text, once; None if it is not that one alone."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    places = [
        ROOT / name
        for name in listed.stdout.split("\n")
        if pathlib.Path(name).name == fault["file"] and not name.startswith("tests/")
    ]
    counts = {place: place.read_text().count(fault["old"]) for place in places}
    found = [place for place, count in counts.items() if count]
    return found[0] if len(found) == 1 and counts[found[0]] == 1 else None


def succeeds(command):
    return subprocess.run(command, cwd=ROOT, capture_output=True).returncode == 0


def failing_tests(build, pattern):
    """The first tests of ctest's default ones that fail, by name."""
    run = subprocess.run(
        ["ctest", "--test-dir", build, "-R", pattern, "-j", "2", "--stop-on-failure"],
        cwd=ROOT, capture_output=True, text=True)
    if run.returncode == 0:
        return []
    marks = ("***Failed", "***Timeout", "***Exception")
    return [line.split(":", 1)[1].split(" ..")[0].strip()
            for line in run.stdout.splitlines() if any(mark in line for mark in marks)] or ["ctest"]


def caught_by(fault, build, everything):
    if not succeeds(["ninja", "-C", build, *fault["tests"]]):
        return "does not compile: another fault is needed"
    for program in fault["tests"]:
        if failed := failing_tests(build, f"^{program}\\."):
            return failed[0]
    if everything and succeeds(["ninja", "-C", build]):
        if failed := failing_tests(build, "."):
            return failed[0]
    return "nobody" if everything else "none of " + ", ".join(fault["tests"])


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--build", default="build/release")
    arguments.add_argument("--only", type=int, nargs="+", help="numbers of faults, from 1")
    arguments.add_argument("--all", action="store_true", help="all default tests where none catches it")
    arguments.add_argument("--table", default="faults.md")
    arguments.add_argument("--check", action="store_true")
    options = arguments.parse_args()

    faults = tomllib.loads((HERE / "faults.toml").read_text())["fault"]
    lost = [n for n, fault in enumerate(faults, 1) if place_of(fault) is None]
    for number in lost:
        print(f"fault {number}: its text does not stand once in {faults[number - 1]['file']}")
    if lost or options.check:
        print(f"{len(faults) - len(lost)} of {len(faults)} faults have their place")
        sys.exit(1 if lost else 0)

    table = pathlib.Path(options.table)
    rows = table.read_text() if table.exists() else HEAD
    for number, fault in enumerate(faults, 1):
        if f"\n| {number} |" in rows or (options.only and number not in options.only):
            continue
        place = place_of(fault)
        sound = place.read_text()
        try:
            place.write_text(sound.replace(fault["old"], fault["new"]))
            caught = caught_by(fault, options.build, options.all)
        finally:
            place.write_text(sound)
        rows += (f"| {number} | {place.relative_to(ROOT)} | {fault['kind']} | {fault['breaks']} "
                 f"| {caught} |\n")
        table.write_text(rows)
        print(rows.splitlines()[-1], flush=True)


if __name__ == "__main__":
    main()
