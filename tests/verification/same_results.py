#!/usr/bin/env python3
"""Tells where the results of two run folders differ: summary.json and every .csv, number by number.

    tests/verification/same_results.py BEFORE AFTER [--relative 1e-9]

Times, rates, hosts, versions and paths are left out. A number counts as the same within `relative`
of itself, or of the largest in its column or list. Ends with 1 where anything else differs.
"""

import argparse
import csv
import json
import math
import pathlib
import sys

LEFT_OUT = ("time", "seconds", "real_time", "wall", "memory", "started", "finished", "host", "version",
            "hash", "command", "folder", "path", "pid", "reused", "cache", "per_mass_step", "factor_processor",
            "thread")


def is_left_out(key):
    return any(word in key.lower() for word in LEFT_OUT) and not key.startswith("time [s]")


def same(a, b, scale, relative):
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return a == b or abs(a - b) <= relative * max(abs(a), abs(b), scale)


def differences_of(a, b, place, relative):
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted(set(a) | set(b)):
            if is_left_out(key):
                continue
            if key not in a or key not in b:
                yield f"{place}.{key}: only {'after' if key in b else 'before'}"
            else:
                yield from differences_of(a[key], b[key], f"{place}.{key}", relative)
    elif isinstance(a, list) and isinstance(b, list):
        if len(a) != len(b):
            yield f"{place}: {len(a)} entries, {len(b)} after"
            return
        numbers = [abs(x) for x in a if isinstance(x, (int, float)) and math.isfinite(x)]
        for n, (x, y) in enumerate(zip(a, b)):
            if isinstance(x, (int, float)) and isinstance(y, (int, float)):
                if not same(x, y, max(numbers, default=0.0), relative):
                    yield f"{place}[{n}]: {x!r}, {y!r} after"
            else:
                yield from differences_of(x, y, f"{place}[{n}]", relative)
    elif isinstance(a, (int, float)) and isinstance(b, (int, float)) and not isinstance(a, bool):
        if not same(a, b, 0.0, relative):
            yield f"{place}: {a!r}, {b!r} after"
    elif a != b:
        yield f"{place}: {str(a)[:60]!r}, {str(b)[:60]!r} after"


def number(cell):
    try:
        return float(cell)
    except ValueError:
        return None


def table_of(file):
    with open(file, newline="") as opened:
        rows = list(csv.reader(opened))
    return rows[0], rows[1:]


def table_differences(before, after, relative):
    (heads, a), (other_heads, b) = table_of(before), table_of(after)
    if heads != other_heads or len(a) != len(b):
        yield f"{before.name}: {len(heads)} columns and {len(a)} rows, {len(other_heads)} and {len(b)} after"
        return
    for column, head in enumerate(heads):
        if is_left_out(head):
            continue
        values = [abs(v) for row in a if (v := number(row[column])) is not None and math.isfinite(v)]
        scale = max(values, default=0.0)
        for line, (x, y) in enumerate(zip(a, b), 2):
            x, y = x[column], y[column]
            u, v = number(x), number(y)
            alike = x == y if u is None or v is None else same(u, v, scale, relative)
            if not alike:
                yield f"{before.name}:{line}, {head}: {x}, {y} after"
                break


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("before", type=pathlib.Path)
    arguments.add_argument("after", type=pathlib.Path)
    arguments.add_argument("--relative", type=float, default=1e-9)
    options = arguments.parse_args()
    found = compared = 0
    for file in sorted(options.before.rglob("*")):
        name = file.relative_to(options.before)
        if file.name != "summary.json" and file.suffix != ".csv" or "figures" in name.parts:
            continue
        other = options.after / name
        if not other.exists():
            lines = [f"{name}: lacks after"]
        elif file.suffix == ".csv":
            lines = list(table_differences(file, other, options.relative))
        else:
            lines = list(differences_of(json.loads(file.read_text()), json.loads(other.read_text()), "", options.relative))
        compared += 1
        found += len(lines)
        for line in lines[:5]:
            print(f"{name.parent}/{line}" if file.suffix == ".csv" else f"{name}{line}")
        if len(lines) > 5:
            print(f"{name}: and {len(lines) - 5} more")
    print(f"{compared} files compared, {found} differences")
    sys.exit(1 if found or not compared else 0)


if __name__ == "__main__":
    main()
