#!/usr/bin/env python3
"""Draws lattice presses by a seed and judges the errors that they tell of their forces.

    tests/judgement/drawn_presses.py [--seed 2] [--presses 300] [--only CLASS ...]
                                     [--auto | --edges | --aside | --turned | --fields | --markers | --continuum]
                                     [--rows FILE] [--program fingertip]

Each press is run twice: with `run.error = estimate`, which is judged, and with the continuum, which
is the truth, at rest and to 0.2 % (as a solid to 1 %). A bar covers where
|F - F_continuum| <= bar + the continuum's own error. Seed 1 is the draw by which the constants in
lattice/press/press_deviation.cc were fitted; any other one judges them. --rows writes every sample.

With --auto each press takes `lattice.spacing = "auto"` at a tolerance of 2, 5 or 10 % instead, at
rest, and the error of its first sample is judged: within the tolerance in 95 % of the presses that
`lattice.max_particles` allows, and in the median no more than 1.5 times finer than needed, if errors
go with the power 2.4 of the spacing.

With --edges the same presses are made on cylinders and rounded edges, whose truth is a solid's.
With --aside domes are tilted, slid by a quarter of the depth or meet a ball beside the axis, those in
time under the PID controller: the errors of lateral force and torque are judged as well.

With --turned domes are pressed and then, at full depth, turned or pushed aside, some of them tilted,
under stick or Coulomb friction, at rest: it is the errors of torque and lateral force after that
motion that are judged. With --continuum besides it is those that the continuum tells of a press to 2
or 0.5 %, by a continuum to a tenth of it (a solid's to a third).

With --fields it is the error of the pressures, point by point, that is judged, in those of the
presses whose truth is a meridian's.

With --markers it is the error of displacements that is judged, of a grid of markers in those of the
presses whose truth is a meridian's, some on the surface and some below it; with --continuum besides it
is that of the continuum.

With --continuum it is the continuum that is pressed, to 4, 2, 1 and on a meridian 0.1 %, and its own
error that is judged, by a continuum to a tenth of what that tells at best (a solid's to a third).
"""

import argparse
import bisect
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import statistics
import sys
import tempfile

from truth import Bench

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "studies/examples"
SHARES = (0.25, 0.5, 0.75, 1.0)  # of the deepest sample
COVERED, WIDEST = 0.95, 4.0  # share of samples; median of bar over error
FEWEST = 40  # samples of a class that is judged by itself

# Of the examples' profiles: largest radius, thinnest wall under the contact [mm].
PROFILES = {"paper_finger": (10.0, 5.0), "solid_finger": (10.0, 10.0),
            "hollow_finger": (12.5, 2.5), "flat_ellipsoid": (12.0, 6.0)}
YOUNG = 'rubber.youngs_modulus="20 kPa"'
LAWS = {"neo-hookean": [YOUNG], "gent": [YOUNG, "rubber.gent_jm=5"],
        "yeoh": ['rubber.yeoh=["4 kPa", "0.4 kPa", "0.1 kPa"]'],
        "mooney-rivlin": ['rubber.mooney_rivlin=["3 kPa", "0.7 kPa"]']}
SOLID = ["geometry.shape=solid", f"geometry.file=\"{EXAMPLES}/paper_finger.csv\"",
         "geometry.bond=\"x < 5 mm and x > -5 mm and y < 5 mm and y > -5 mm and z < 5 mm "
         "and z > -14.999 mm\"", "geometry.endpoint=\"-3 cm\""]


def log_uniform(numbers, low, high):
    return math.exp(numbers.uniform(math.log(low), math.log(high)))


def draw(numbers):
    """One press: its classes and its settings."""
    model = numbers.choice(["hookean", "hookean", "network", "network", "central"])
    contact = numbers.choice(["stick", "frictionless", "coulomb"])
    moves = contact == "coulomb" or numbers.random() < 0.3
    shape = numbers.choice(["dome", "dome", "dome", "profile", "solid"])
    body = numbers.choice(["plane", "ball", "ball"])
    ratio = numbers.uniform(0.25, 0.49)
    cells = round(log_uniform(numbers, 4, 10 if moves else 24))
    law = numbers.choice(sorted(LAWS)) if model == "network" else "neo-hookean"
    radius, rod = 10.0, 10.0 * numbers.uniform(0.3, 0.7)
    share, ball = numbers.uniform(0.05, 0.3), 10.0 * log_uniform(numbers, 0.2, 5)
    name, tilt = numbers.choice(sorted(PROFILES)), numbers.uniform(2, 10)
    tilted = shape == "dome" and not moves and numbers.random() < 0.2
    speed = log_uniform(numbers, 0.3, 3)
    sets = [f"lattice.model={model}", f"press.contact={contact}",
            f"rubber.poissons_ratio={ratio:.4f}", f"rubber.law={law}",
            *LAWS[law],
            "press.mode=" + ("quasi-static" if moves else "static")]
    if moves:
        sets.append(f"press.speed=\"{speed:.3f} cm/s\"")
    if contact == "coulomb":
        sets.append("press.friction=0.5")
    wall = radius - rod
    if shape == "dome":
        sets.append(f"geometry.rod_radius=\"{rod:.3f} mm\"")
    if shape == "profile":
        radius, wall = PROFILES[name]
        sets += ["geometry.shape=profile", f"geometry.profile=\"{EXAMPLES / name}.csv\""]
    if shape == "solid":
        radius, wall = 10.0, 5.0
        sets += SOLID
    cells = max(cells, math.ceil((2 if shape == "dome" else 4) * radius / wall * 1.02))
    sets.append(f"lattice.spacing=tip_radius/{cells}")
    samples = ", ".join(f'"{share * wall * part:.4f} mm"' for part in SHARES)
    sets.append(f"press.samples=[{samples}]")
    if body == "ball":
        sets += ["obstacle.shape=sphere", f"obstacle.radius=\"{ball:.3f} mm\""]
    if tilted:
        sets.append(f"press.tilt=\"{tilt:.2f} deg\"")
    classes = [model, contact, "in time" if moves else "static", shape, body,
               "tilted" if tilted else "straight", "nu < 0.4" if ratio < 0.4 else "nu >= 0.4", law]
    about = {"flat": not tilted, "spacing": 1e-3 * radius / cells, "wall": 1e-3 * wall,
             "ratio": ratio,
             "speed": 1e-2 * speed if moves else 0.0,
             "ball": 1e-3 * ball if body == "ball" else math.inf}
    return classes, sets, about


def rows_of(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def place_of(row):
    """Depth and lateral displacement [nm], twist [nrad]."""
    return tuple(round(1e9 * float(row.get(name) or 0.0))
                 for name in ("indentation [m]", "lateral_displacement [m]", "twist [rad]"))


def truth_of(sets, meridian):
    """Of the STL of the dome the dome's own meridian."""
    kept = [s for s in sets if not s.startswith(("geometry.", "press.speed", "press.mode"))
            or "profile" in s or "rod_radius" in s]
    return kept + ["press.mode=static", f"reference.tolerance={0.002 if meridian else 0.01}",
                   "reference.fields=false"]


TOLERANCES = (0.02, 0.05, 0.1)
ORDER, FINER, PARTICLES = 2.4, 1.5, 60000


def automatic(number, drawn):
    """The same press at rest with an automatic spacing; `central` has an error of its own besides."""
    classes, sets, about = drawn
    tolerance = TOLERANCES[number % 3]
    kept = [s for s in sets
            if not s.startswith(("lattice.spacing", "press.mode", "press.speed", "press.friction"))]
    kept = [s.replace("=central", "=hookean").replace("=coulomb", "=stick") for s in kept]
    return classes, [*kept, "press.mode=static", "lattice.spacing=auto",
                     f"lattice.tolerance={tolerance}", f"lattice.max_particles={PARTICLES}"], \
        about | {"tolerance": tolerance}


def on_edge(number, drawn):
    """The same press on a cylinder or a rounded edge."""
    classes, sets, about = drawn
    body = "cylinder" if number % 2 else "edge"
    radius = 1e3 * min(about["ball"], 0.02) * (1.0 if body == "cylinder" else 0.3)
    kept = [s for s in sets if not s.startswith(("obstacle.", "press.tilt"))]
    return [*classes[:4], body, "straight", *classes[6:]], \
        [*kept, f"obstacle.shape={body}", f"obstacle.radius=\"{radius:.3f} mm\""], \
        about | {"flat": False}


def aside_of_axis(number, drawn):
    """The same press as one of a dome whose symmetry is broken; in time by the PID controller."""
    classes, sets, about = drawn
    kept = [s for s in sets if not s.startswith((
        "obstacle.", "press.tilt", "press.mode", "press.speed", "press.samples", "geometry.",
        "lattice.spacing"))]
    way, contact = ("tilted", "slid", "ball beside")[number % 3], classes[1]
    mode = "pid" if classes[2] == "in time" else "static"
    depth = 0.08 * (1 + number % 5)
    if way == "tilted":
        kept.append(f'press.tilt="{2 + number % 7} deg"')
    elif way == "slid":
        kept.append(f'press.lateral="{0.25 * depth:.4f} cm"')
        if contact == "frictionless":
            contact = "stick"
            kept = [s.replace("=frictionless", "=stick") for s in kept]
    else:
        kept += ["obstacle.shape=sphere", f'obstacle.radius="{5 + number % 10} mm"',
                 f'obstacle.offset="{0.5 + 0.25 * (number % 4)} mm"']
    samples = ", ".join(f'"{depth * part:.4f} cm"' for part in SHARES)
    return [classes[0], contact, classes[2], way], \
        [*kept, f"press.samples=[{samples}]", f"lattice.spacing=tip_radius/{6 + number % 7}",
         f"press.mode={mode}"], about | {"flat": False}


def judge_automatic(samples, presses):
    """Of each press its first sample."""
    first = {}
    for sample in samples:
        first.setdefault(sample["press"], sample)
    of = list(first.values())
    kept = statistics.mean(s["error"] <= s["tolerance"] + s["slack"] for s in of)
    finer = statistics.median((s["tolerance"] / max(s["error"], 1e-4)) ** (1 / ORDER) for s in of)
    print(f"{presses - len(of)} of {presses} presses left out: lattice.max_particles")
    print(f"tolerance kept in {100 * kept:.1f} % of {len(of)} presses; "
          f"{finer:.2f} times finer than needed in the median")
    return kept >= COVERED and finer <= FINER and 2 * len(of) >= presses


def draw_turned(numbers):
    """One press of a dome that is turned or pushed aside at full depth: its classes and its
    settings. Most are turned and straight, whose truth is a meridian's."""
    way = numbers.choice(["turned"] * 8 + ["slid"] * 2 + ["turned, tilted", "slid, tilted"])
    model = numbers.choice(["hookean", "hookean", "hookean", "central"])
    contact = numbers.choice(["stick", "stick", "coulomb"])
    body, ball = numbers.choice(["plane", "ball"]), 10.0 * log_uniform(numbers, 0.4, 5)
    ratio, rod = numbers.uniform(0.25, 0.49), 10.0 * numbers.uniform(0.3, 0.7)
    share, twist = numbers.uniform(0.05, 0.3), numbers.uniform(1, 30)
    aside, tilt, friction = (numbers.uniform(*range_) for range_ in ((0.05, 0.5), (1, 6), (0.2, 1)))
    flat, wall = way == "turned", 10.0 - rod
    cells = round(log_uniform(numbers, 5, 12 if flat else 8))
    cells = max(cells, math.ceil(20.0 / wall * 1.02))
    tolerance = numbers.choice([0.02, 0.005] if flat else [0.04, 0.02])
    if not flat:  # the solid is to take minutes
        body, rod = "plane", min(rod, 6.0)
        wall = 10.0 - rod
    sets = [f"lattice.model={model}", f"press.contact={contact}", YOUNG,
            f"rubber.poissons_ratio={ratio:.4f}", "press.mode=static",
            f'geometry.rod_radius="{rod:.3f} mm"', f"lattice.spacing=tip_radius/{cells}",
            f'press.samples=["{share * wall:.4f} mm"]', "press.lateral_samples=1"]
    if contact == "coulomb":
        sets.append(f"press.friction={friction:.3f}")
    if body == "ball":
        sets += ["obstacle.shape=sphere", f'obstacle.radius="{ball:.3f} mm"']
    if "turned" in way:
        sets.append(f'press.twist="{twist:.2f} deg"')
    else:
        sets += [f'press.lateral="{aside * share * wall:.4f} mm"', "press.lateral_path=after"]
    if "tilted" in way:
        sets.append(f'press.tilt="{tilt:.2f} deg"')
    if not flat:
        sets.append("reference.max_unknowns=200000")
    classes = [f"{contact}, {way}", model, f"{contact}, {body}",
               f"{contact}, nu {'<' if ratio < 0.4 else '>='} 0.4"]
    return classes, sets, {"flat": flat, "tolerance": tolerance, "spacing": 1e-2 / cells,
                           "wall": 1e-3 * wall, "ratio": ratio, "moved": True}


def draw_continuum(numbers):
    """One press of the continuum: its classes and its settings."""
    kind = numbers.choice(["meridian", "meridian", "meridian", "meridian", "transient", "tilted",
                           "edge", "solid"])
    flat = kind in ("meridian", "transient")
    shape = numbers.choice(["dome", "profile"]) if flat else "solid" if kind == "solid" else "dome"
    tolerance = numbers.choice([0.04, 0.02, 0.01, 0.001] if flat else [0.04, 0.02])
    contacts = ["stick", "frictionless"] + (["coulomb"] if kind != "transient" else [])
    contact = numbers.choice(contacts)
    strain = "linear" if kind == "transient" else numbers.choice(["linear", "finite"])
    ratio = numbers.choice([0.3, 0.43, 0.47, 0.49])
    rod, ball = 10.0 * numbers.uniform(0.3, 0.7), 10.0 * log_uniform(numbers, 0.3, 5)
    share, name = numbers.uniform(0.05, 0.25), numbers.choice(sorted(PROFILES))
    body, tilt = numbers.choice(["plane", "ball"]), numbers.uniform(2, 10)
    relaxes = kind == "meridian" and contact != "coulomb" and numbers.random() < 0.25
    speed = log_uniform(numbers, 1, 10)
    wall = PROFILES[name][1] if shape == "profile" else 5.0 if shape == "solid" else 10.0 - rod
    sets = [f"press.contact={contact}", f"rubber.poissons_ratio={ratio}", YOUNG,
            f"reference.strain={strain}", "reference.fields=false",
            f"press.mode={'quasi-static' if kind == 'transient' or relaxes else 'static'}"]
    if contact == "coulomb":
        sets.append("press.friction=0.4")
    if relaxes:
        sets.append('rubber.relaxation=[[0.3, "0.1 s"]]')
    if kind == "transient":
        sets += ["reference.mode=transient", f"press.speed=\"{speed:.3f} cm/s\""]
    if shape == "dome":
        sets.append(f"geometry.rod_radius=\"{rod:.3f} mm\"")
    if shape == "profile":
        sets += ["geometry.shape=profile", f"geometry.profile=\"{EXAMPLES / name}.csv\""]
    if shape == "solid":
        sets += SOLID
    if kind == "edge":
        body = "edge"
        sets += ["obstacle.shape=edge", f"obstacle.radius=\"{0.3 * ball:.3f} mm\""]
    elif body == "ball":
        sets += ["obstacle.shape=sphere", f"obstacle.radius=\"{ball:.3f} mm\""]
    if kind == "tilted":
        sets.append(f"press.tilt=\"{tilt:.2f} deg\"")
    samples = ", ".join(f'"{share * wall * part:.4f} mm"' for part in SHARES)
    sets.append(f"press.samples=[{samples}]")
    classes = [kind, contact, strain, shape, body, f"nu {ratio}", f"{100 * tolerance:g} %",
               "relaxes" if relaxes else "elastic"]
    return classes, sets, {"tolerance": tolerance, "flat": flat, "wall": 1e-3 * wall}


def measure_continuum(bench, number, drawn):
    """As measure(), of the continuum's own error."""
    classes, sets, about = drawn
    out = bench.folder / f"press{number}"
    sets = [s for s in sets if not s.startswith(("lattice.", "reference.fields"))]
    tables, tolerance = [], about["tolerance"]
    for folder in (out, out / "truth"):
        run = bench.run("reference", [*sets, "reference.fields=false",
                                      f"reference.tolerance={tolerance:.3g}"], folder)
        if run.returncode not in (0, 3):
            return run.stderr.strip().splitlines()[:3]
        tables.append(rows_of(folder / "response.csv"))
        # A mesh may be better than was asked for: the truth is better than what it tells.
        bars = [float(row["force_error [N]"] or "nan") / float(row["normal_force [N]"])
                for row in tables[0] if float(row["normal_force [N]"]) > 0.0]
        known = [bar for bar in bars if not math.isnan(bar)]
        tolerance = max(1e-4, min(tolerance, *known) * (0.1 if about["flat"] else 0.3))
    found = []
    for row, true in zip(*tables):
        force, bar = float(row["normal_force [N]"]), float(row["force_error [N]"] or "nan")
        if not force > 0.0 or math.isnan(bar):
            continue
        found += judged(row, true, about | {"press": number, "classes": classes})
    return found


def measure(bench, number, drawn):
    """[{classes, error and bar relative to the force, ...}] of the samples of one press, or why
    there are none."""
    classes, sets, about = drawn
    out = bench.folder / f"press{number}"
    strain = "linear" if classes[0] in ("hookean", "central") or "moved" in about else "finite"
    press = bench.run("press", [*sets, "run.error=estimate", "run.threads=1"], out)
    if press.returncode != 0:
        return press.stderr.strip().splitlines()[:3]
    if "as fine as lattice.max_particles" in press.stderr:
        return []  # no promise
    truth = bench.run("reference", [*truth_of(sets, about["flat"]), f"reference.strain={strain}"],
                      out / "truth")
    if truth.returncode not in (0, 3):
        return truth.stderr.strip().splitlines()[:3]
    known = {place_of(row): row for row in rows_of(out / "truth/response.csv")}
    found = []
    for row in rows_of(out / "response.csv"):
        true = known.get(place_of(row))
        if not true or not true["force_error [N]"]:  # a truth of unknown quality judges nothing
            continue
        if float(row["normal_force [N]"]) > 0.0:
            found += judged(row, true, about | {"press": number, "classes": classes})
    return found


def judged(row, true, about):
    """The error of a row's force, and those of the vectors that symmetry leaves."""
    force, right = float(row["normal_force [N]"]), float(true["normal_force [N]"])
    sample = about | {"force": force, "truth": right, "depth": float(row["indentation [m]"]),
                      "radius": float(row["contact_radius [m]"] or "nan"),
                      "slack": float(true["force_error [N]"] or 0.0) / force,
                      "error": abs(force - right) / force,
                      "bar": float(row["force_error [N]"] or "nan") / force}
    vectors = aside(row, true, sample, "lateral_force", "lateral force", "xy", "N") + \
        aside(row, true, sample, "torque", "torque", "xyz", "N m")
    if "moved" not in about:
        return [sample, *vectors]
    return vectors if any(place_of(row)[1:]) else []


def rings(points):
    """[(radius [m], pressure [Pa])] of a meridian's contact, from the axis on."""
    found = {}
    for point in points:
        radius = math.hypot(float(point["x [m]"]), float(point["y [m]"]))
        found[round(1e9 * radius)] = float(point["normal_traction [Pa]"])
    return sorted((1e-9 * place, pressure) for place, pressure in found.items())


def pressure_at(table, radius):
    """Straight between rings; nothing from half a ring beyond the last on."""
    after = bisect.bisect_left(table, (radius, 0.0))
    if after == 0:
        return table[0][1]
    if after < len(table):
        (r, p), (s, q) = table[after - 1], table[after]
        return p + (q - p) * (radius - r) / (s - r)
    (r, p), half = table[-1], 0.5 * (table[-1][0] - table[-2][0])
    return max(0.0, p * (1.0 - (radius - r) / half))


def fields_of(folder):
    """The points of each sample, by its number."""
    points = {}
    for row in rows_of(folder / "contact_field.csv"):
        points.setdefault(int(row["sample"]), []).append(row)
    return points


def measure_fields(bench, number, drawn):
    """As measure(), of the pressures: root mean square over the contact, over the largest."""
    if not drawn[2]["flat"]:
        return []
    found = measure(bench, number, drawn)
    if found and isinstance(found[0], str):
        return found
    out = bench.folder / f"press{number}"
    own, true = fields_of(out), fields_of(out / "truth")
    numbers = {place_of(row): i + 1 for i, row in enumerate(rows_of(out / "truth/response.csv"))}
    told, pressures = rows_of(out / "response.csv"), []
    for sample in found:
        i = next(i for i, row in enumerate(told) if float(row["indentation [m]"]) == sample["depth"])
        table = rings(true.get(numbers[place_of(told[i])], []))
        if len(table) < 8 or i + 1 not in own or not told[i]["max_pressure [Pa]"]:
            continue
        bar = float(told[i].get("pressure_error [Pa]") or 0.0)
        most, off, area = max(p for _, p in table), 0.0, 0.0
        for point in own[i + 1]:
            radius = math.hypot(float(point["x [m]"]), float(point["y [m]"]))
            part = float(point["area [m^2]"])
            off += part * (float(point["normal_traction [Pa]"]) - pressure_at(table, radius)) ** 2
            area += part
        pressures.append(sample | {"error": math.sqrt(off / area) / most, "bar": bar / most})
    return pressures


def measure_markers(bench, number, drawn, measured=measure):
    """As `measured`, of the displacements of markers, over the indentation."""
    classes, sets, about = drawn
    if not about["flat"] or "solid" in classes:
        return []
    below = (0.0, 0.2, 0.5, 0.8)[number % 4] * 1e3 * about["wall"]
    grid = ["sensor.markers=grid", 'sensor.marker_pitch="1.9 mm"',
            f'sensor.marker_depth="{below:.4f} mm"']
    found = measured(bench, number, (classes, [*sets, *grid], about))
    if found and isinstance(found[0], str):
        return found
    out, rows = bench.folder / f"press{number}", []
    samples = {round(1e9 * sample["depth"]): sample for sample in found}
    true = {(round(1e9 * float(row["indentation [m]"])), row["marker"]): row
            for row in rows_of(out / "truth/markers.csv")}
    axes = [f"displacement_{axis} [m]" for axis in "xyz"]
    for row in rows_of(out / "markers.csv"):
        place = round(1e9 * float(row["indentation [m]"])), row["marker"]
        sample, right = samples.get(place[0]), true.get(place)
        if not sample or not right:
            continue
        own, wanted = ([float(table[axis]) for axis in axes] for table in (row, right))
        errors = [float(table.get("error [m]") or "nan") for table in (row, right)]
        rows.append(sample | {"error": math.dist(own, wanted) / sample["depth"],
                              "bar": errors[0] / sample["depth"],
                              "slack": errors[1] / sample["depth"]})
    return rows


def measure_marked_continuum(bench, number, drawn):
    """The same of the continuum's own."""
    return measure_markers(bench, number, drawn, measure_continuum)


def aside(row, true, sample, column, name, axes, unit):
    """Of a vector that symmetry leaves: its error and bar, over the force."""
    bar = float(row.get(f"{column}_error [{unit}]") or "nan")
    if math.isnan(bar):
        return []
    own, right = ([float(table[f"{column}_{a} [{unit}]"]) for a in axes] for table in (row, true))
    slack = float(true.get(f"{column}_error [{unit}]") or "nan")
    classes = [f"{name}: {c}" for c in sample["classes"]] if "moved" in sample else []
    return [sample | {"classes": [name, *classes], "error": math.dist(own, right) / sample["force"],
                      "bar": bar / sample["force"], "size": math.hypot(*own) / sample["force"],
                      "true size": math.hypot(*right) / sample["force"],
                      "spin": float(row["spin_torque [N m]"] or "nan") / sample["force"],
                      "slack": 0.0 if math.isnan(slack) else slack / sample["force"]}]


def judge(samples, name, widest=WIDEST):
    covered = statistics.mean(s["error"] <= s["bar"] + s["slack"] for s in samples)
    width = statistics.median(s["bar"] / max(s["error"], 1e-9) for s in samples)
    good = len(samples) < FEWEST or (covered >= COVERED and width <= widest)
    print(f"{name:32} {len(samples):5} samples, {100 * covered:5.1f} % covered, "
          f"median bar/error {width:5.2f}{'' if good else '   NOT GOOD'}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="fingertip")
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--presses", type=int, default=300)
    parser.add_argument("--only", nargs="+", default=[])
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--auto", action="store_true")
    mode.add_argument("--edges", action="store_true")
    mode.add_argument("--aside", action="store_true")
    mode.add_argument("--fields", action="store_true")
    mode.add_argument("--markers", action="store_true")
    mode.add_argument("--turned", action="store_true")
    parser.add_argument("--continuum", action="store_true")
    parser.add_argument("--rows")
    asked = parser.parse_args()
    numbers = random.Random(asked.seed)
    draw_one = draw_turned if asked.turned else draw_continuum if asked.continuum else draw
    measure_one = measure_marked_continuum if asked.continuum and asked.markers else \
        measure_continuum if asked.continuum else \
        measure_fields if asked.fields else measure_markers if asked.markers else measure
    drawn = [draw_one(numbers) for _ in range(asked.presses)]
    drawn = [(i, d) for i, d in enumerate(drawn) if set(asked.only) <= set(d[0])]
    for asked_for, changed in ((asked.auto, automatic), (asked.edges, on_edge),
                               (asked.aside, aside_of_axis)):
        if asked_for:
            drawn = [(i, changed(i, d)) for i, d in drawn]
    samples, refused = [], 0
    with tempfile.TemporaryDirectory() as folder, \
            concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        bench = Bench(asked.program, pathlib.Path(folder))
        for (number, d), found in zip(drawn, workers.map(lambda p: measure_one(bench, *p), drawn)):
            if found and isinstance(found[0], str):
                refused += 1
                print(f"press {number} ({', '.join(d[0])}): {' '.join(found)}")
            else:
                samples += found
    if asked.rows:
        pathlib.Path(asked.rows).write_text("\n".join(json.dumps(s) for s in samples) + "\n")
    if asked.auto:
        good = judge_automatic(samples, len(drawn) - refused)
    else:
        widest = math.inf if asked.continuum and not asked.markers else WIDEST
        vectors = ("lateral force", "torque")
        good = asked.turned or judge([s for s in samples if s["classes"][0] not in vectors], "all",
                                     widest)
        for name in sorted({c for s in samples for c in s["classes"]}):
            # Where only a tilt pushes aside, vectors are small beside what the bars are made of.
            width = math.inf if name in vectors and not asked.turned else widest
            good = judge([s for s in samples if name in s["classes"]], name, width) and good
    print(f"{len(drawn)} presses, {refused} without forces")
    return 0 if good and refused == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
