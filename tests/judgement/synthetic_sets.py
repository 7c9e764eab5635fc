#!/usr/bin/env python3
"""Draws data that a model can or cannot describe, has them fitted, and tells how the fits judge.

    tests/judgement/synthetic_sets.py --seed 1 --each 6 [--only KIND ...] [--program fingertip]

Presses are those of the continuum at large strain (one `reference` run for each finger, contact and
Poisson's ratio; forces are proportional to E), coupons those of Mooney and Rivlin's law. A set that
cannot be described has a fault of which the best fit without it misses far more than the noise, but
for play, which spoils the way back alone. What the first accusation ought to be is fixed beside
each kind.
"""

import argparse
import csv
import json
import pathlib
import random
import subprocess
import sys
import tempfile

DEPTHS = [0.1 * i for i in range(1, 21)]  # [mm]
RATIOS = [0.3, 0.45]  # Poisson's
KINDS = {}


def kind(accusation=None):
    """A kind of sets: it can be described, or else `accusation` ought to stand in its words."""

    def register(draw):
        KINDS[draw.__name__] = (accusation, draw)
        return draw

    return register


class Bench:
    """Runs the program in a folder of its own."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, verb, settings, out):
        sets = [word for setting in settings for word in ("--set", setting)]
        return subprocess.run([self.program, verb, "--out", str(out), *sets], cwd=self.folder,
                              capture_output=True, text=True)

    def press(self, contact, ratio, rod="5 mm"):
        """[(depth [mm], force [mN])] of 100 kPa."""
        out = self.folder / f"{contact}_{ratio}_{rod.replace(' ', '')}"
        if not (out / "response.csv").exists():
            samples = ",".join(f'"{depth:.1f} mm"' for depth in DEPTHS)
            run = self.run("reference", [
                f"press.contact={contact}", f"rubber.poissons_ratio={ratio}",
                'rubber.youngs_modulus="100 kPa"', f'geometry.rod_radius="{rod}"',
                "press.mode=static", "reference.strain=finite", "reference.fields=false",
                f"press.samples=[{samples}]"], out)
            if run.returncode != 0:
                raise RuntimeError(run.stderr)
        with open(out / "response.csv", newline="") as file:
            return [(1e3 * float(row["indentation [m]"]), 1e3 * float(row["normal_force [N]"]))
                    for row in csv.DictReader(file)]


class Set:
    """One set: what is common to its presses, and its folder."""

    def __init__(self, bench, random_numbers, folder):
        self.bench, self.random, self.folder = bench, random_numbers, folder
        self.ratio = self.random.choice(RATIOS)
        self.modulus = self.random.uniform(50, 400)  # [kPa]
        self.touch = self.random.uniform(0.05, 0.5)  # [mm]
        self.noise = self.random.choice([0.002, 0.005, 0.01])

    def rows(self, contact="frictionless", rod="5 mm", compliance=0.0, zero=0.0, touch=None,
             modulus=None, factor=lambda depth: 1.0):
        """[(position [mm], force [mN], sigma [mN])]; compliance [mm/mN]."""
        scale = (modulus or self.modulus) / 100
        pure = [(d, scale * f * factor(d)) for d, f in self.bench.press(contact, self.ratio, rod)]
        rows = []
        for depth, force in pure:
            sigma = self.noise * max(force, 0.05 * pure[-1][1])
            start = self.touch if touch is None else touch
            rows.append((start + depth + compliance * force,
                         force + zero + self.random.gauss(0, sigma), sigma))
        return rows

    def write(self, name, rows, columns="position [mm];force [mN];sigma [mN]"):
        lines = [columns] + [";".join(f"{value:.9g}" for value in row) for row in rows]
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def fit_presses(self, *files, rig=None):
        names = ",".join(f'"{self.folder / file}"' for file in files)
        settings = [
            "calibration.problem=experiment", f"calibration.data=[{names}]",
            'calibration.parameters=["modulus"]', "calibration.candidates=[]",
            "calibration.forward=continuum", "reference.fields=false",
            "press.contact=frictionless", f"rubber.poissons_ratio={self.ratio}",
            'rubber.youngs_modulus="100 kPa"']
        return self.fit(settings + ([f"calibration.rig={rig}"] if rig else []))

    def coupon(self, name, strains, stress, noise=None):
        error = self.random.choice([0.005, 0.01]) if noise is None else noise
        self.write(name, [(e, stress(e) * (1 + self.random.gauss(0, error))) for e in strains], "e;s")

    def fit_coupons(self, *tests):
        text = "".join(
            f'[[test]]\nkind = "{kind}"\nname = "{name}"\npath = "{path}"\n'
            f'strain = {{column = "e", is = "{strain}"}}\n'
            f'stress = {{column = "s", is = "nominal", unit = "kPa"}}\n'
            for name, kind, path, strain in tests)
        (self.folder / "tests.toml").write_text(text)
        return self.fit(["calibration.problem=material",
                         f'calibration.tests={self.folder / "tests.toml"}',
                         'calibration.laws=["neo-hookean","mooney-rivlin","yeoh-2"]'])

    def fit(self, settings):
        """Exit code, the first accusation, all words."""
        run = self.bench.run("calibrate", settings, self.folder / "fit")
        words = run.stdout + run.stderr
        file = self.folder / "fit" / "calibration.json"
        suspects = json.loads(file.read_text()).get("lack_of_fit") if file.exists() else None
        return run.returncode, suspects[0]["name"] if suspects else "", words


# Material tests and the way back have no list of suspects: the sentences accuse.
TOLD_IN_WORDS = {"compressible": "Is it compressible", "play": "of play or lag of the machine",
                 "slack": "was slack"}


def in_words(accusation, words):
    return accusation if TOLD_IN_WORDS[accusation] in words else ""


def strains(low, high, count=20):
    return [low + (high - low) * i / (count - 1) for i in range(count)]


def nominal(first, second=0.0):
    """Mooney and Rivlin's, uniaxial; constants 2 C1, 2 C2 [kPa]."""
    return lambda e: (1 + e - 1 / (1 + e) ** 2) * (first + second / (1 + e))


PULLED = ("pulled", "uniaxial", "pulled.csv", "engineering")
PRESSED = ("pressed", "uniaxial", "pressed.csv", "engineering")
SHEARED = ("sheared", "simple-shear", "sheared.csv", "shear")


@kind()
def plain(s):
    s.write("a.csv", s.rows())
    return s.fit_presses("a.csv")


@kind()
def compliance_fitted(s):
    s.write("a.csv", s.rows(compliance=s.random.uniform(2e-5, 2e-4)))
    return s.fit_presses("a.csv", rig='{compliance="fit"}')


@kind()
def compliance_given(s):
    compliance = s.random.uniform(2e-5, 2e-4)
    s.write("a.csv", s.rows(compliance=compliance))
    return s.fit_presses("a.csv", rig=f'{{compliance="{compliance:.6g} mm/mN"}}')


@kind()
def zero_fitted(s):
    s.write("a.csv", s.rows(zero=s.random.uniform(-50, 50)))
    return s.fit_presses("a.csv", rig='{force_offset="fit"}')


@kind()
def repeats(s):
    for name in ("a.csv", "b.csv", "c.csv"):
        s.write(name, s.rows(touch=s.touch + s.random.uniform(-0.04, 0.1)))
    return s.fit_presses("a.csv", "b.csv", "c.csv")


def two_fingers_of(s, ratio_of_moduli):
    s.write("a.csv", s.rows())
    s.write("b.csv", s.rows(rod="7 mm", modulus=ratio_of_moduli * s.modulus))
    (s.folder / "both.toml").write_text(
        '[[press]]\npath = "a.csv"\n[[press]]\npath = "b.csv"\n'
        'condition = "geometry.rod_radius=7 mm"\n')
    return s.fit_presses("both.toml")


@kind()
def two_fingers(s):
    return two_fingers_of(s, 1.0)


@kind()
def tension_and_compression(s):
    modulus = s.random.uniform(20, 300)
    s.coupon("pulled.csv", strains(0.02, 0.6), nominal(modulus))
    s.coupon("pressed.csv", strains(-0.3, -0.02), nominal(modulus))
    return s.fit_coupons(PULLED, PRESSED)


@kind()
def tension_and_shear(s):
    modulus, second = s.random.uniform(20, 300), s.random.uniform(0, 0.3)
    s.coupon("pulled.csv", strains(0.02, 0.6), nominal((1 - second) * modulus, second * modulus))
    s.coupon("sheared.csv", strains(0.02, 0.5), lambda e: modulus * e)
    return s.fit_coupons(PULLED, SHEARED)


@kind("compressible")
def compressible(s):
    modulus, softer = s.random.uniform(20, 300), s.random.uniform(0.3, 0.55)
    s.coupon("pulled.csv", strains(0.02, 0.3), nominal(modulus), 0.005)
    s.coupon("pressed.csv", strains(-0.3, -0.02), nominal(softer * modulus), 0.005)
    return s.fit_coupons(PULLED, PRESSED)


@kind("play")
def play(s):
    lost = s.random.uniform(0.05, 0.15)
    s.write("a.csv", s.rows() + [(x - lost, f, sigma) for x, f, sigma in reversed(s.rows())])
    return s.fit_presses("a.csv")


@kind("stiffening")
def negative_compliance(s):
    growth = s.random.uniform(0.15, 0.4)
    s.write("a.csv", s.rows(factor=lambda depth: 1 + growth * (depth / 2) ** 3))
    return s.fit_presses("a.csv")


@kind("sticking")
def wrong_contact(s):
    s.ratio = 0.45  # at 0.3 a stuck curve is a free one times a number
    s.write("a.csv", s.rows(contact="stick"))
    return s.fit_presses("a.csv")


@kind("stiffening")  # of which the words name shape: a thinner layer is stiffer with depth
def wrong_shape(s):
    s.write("a.csv", s.rows(rod="7 mm"))
    return s.fit_presses("a.csv")


@kind("another rubber")
def two_rubbers(s):
    return two_fingers_of(s, s.random.choice([0.7, 1.3, 1.5]))


@kind("drift")
def drift(s):
    rows = s.rows()
    end = s.random.choice([-1, 1]) * s.random.uniform(0.05, 0.15) * rows[-1][1]
    s.write("a.csv", [(10 * i, x, f + end * i / len(rows), e) for i, (x, f, e) in enumerate(rows)],
            "time [s];position [mm];force [mN];sigma [mN]")
    return s.fit_presses("a.csv")


@kind("slack")
def slack(s):
    modulus, way = s.random.uniform(20, 300), s.random.uniform(0.03, 0.08)
    taut = nominal(modulus)
    s.write("pulled.csv", [((e, (taut(e - way) if e > way else 0.0) + s.random.gauss(0, 0.002 * modulus)))
                           for e in strains(0.01, 0.4, 30)], "e;s")
    s.coupon("sheared.csv", strains(0.02, 0.5), lambda e: modulus * e, 0.005)
    return s.fit_coupons(PULLED, SHEARED)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--each", type=int, default=6, help="sets of each kind")
    arguments.add_argument("--only", nargs="+", choices=list(KINDS))
    arguments.add_argument("--program", default="build/release/bin/fingertip")
    options = arguments.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    print("| kind | can be described | exit codes | first accusations |\n|---|---|---|---|")
    refused = accepted = accused_rightly = undescribable = 0
    with tempfile.TemporaryDirectory() as place:
        bench = Bench(program, pathlib.Path(place))
        for place_of_kind, (name, (accusation, draw)) in enumerate(KINDS.items()):
            if options.only and name not in options.only:
                continue
            codes, accused = [], []
            for number in range(options.each):
                # Of a name that says nothing: it stands in the words that are searched.
                folder = pathlib.Path(place) / f"set_{place_of_kind}_{number}"
                folder.mkdir()
                numbers = random.Random(f"{options.seed} {name} {number}")
                code, first, words = draw(Set(bench, numbers, folder))
                codes.append(code)
                accused.append(in_words(accusation, words) if accusation in TOLD_IN_WORDS else first)
            if accusation is None:
                refused += sum(code != 0 for code in codes)
            else:
                undescribable += len(codes)
                accepted += codes.count(0)
                accused_rightly += accused.count(accusation)
            print(f"| {name} | {'yes' if accusation is None else 'no: ' + accusation} "
                  f"| {' '.join(map(str, codes))} | {' '.join(a or '-' for a in accused)} |", flush=True)
    print(f"\nrefused though they can be described: {refused}; accepted though they cannot: {accepted} "
          f"of {undescribable}; accused rightly: {accused_rightly} of {undescribable}")
    sys.exit(1 if refused > 3 or accepted > 0 or accused_rightly < 0.8 * undescribable else 0)


if __name__ == "__main__":
    main()
