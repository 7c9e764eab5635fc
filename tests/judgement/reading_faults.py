#!/usr/bin/env python3
"""Writes measured files with one fault of reading or none, has them fitted, and counts readings.

    tests/judgement/reading_faults.py --seed 1 [--files 200] [--each N] [--only KIND ...]
                                      [--kinds presses|tests] [--program fingertip] [--keep FOLDER]

Files are presses over travel, of the continuum at large strain, and material tests in tension,
compression, simple shear, planar tension and relaxation, of a neo-Hookean rubber (in simple shear
and planar tension Mooney and Rivlin's bears the same). Each is laid out as some machine would, with
a description as some user would write it, and its modulus is known. A kind that can be read has to
be accepted, with that modulus in the interval; one whose description contradicts the file, or
leaves open what no file tells, has to be refused for the right cause. Accepted with a modulus that
is off by more than 3 %, and out of the interval by more than half of its width, is wrong without a
word.
"""

import argparse
import collections
import json
import math
import pathlib
import random
import re
import shutil
import sys
import tempfile

from truth import Bench, force_at

SIZES = {  # of units, in the first one
    "mm": {"mm": 1.0, "um": 1e-3, "cm": 10.0, "m": 1e3},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "gf": 9.80665e-3},
    "kPa": {"kPa": 1.0, "Pa": 1e-3, "MPa": 1e3, "N/mm^2": 1e3},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "1": {"1": 1.0, "%": 0.01}}
SPELLINGS = {"mm": ["millimeter", "millimetre"], "um": ["µm", "micrometer"], "N": ["newton"],
             "mN": ["millinewton"], "kPa": ["kilopascal"], "MPa": ["megapascal", "N/mm²"],
             "N/mm^2": ["MPa", "N/mm²"], "Pa": ["pascal", "N/m^2"], "s": ["second", "sec"],
             "cm": ["centimeter"], "m": ["meter"], "kN": ["kilonewton"], "min": ["minute"],
             "ms": ["millisecond"], "gf": ["gram_force"]}
TITLES = {
    "position": ["Position", "Standardweg", "Travel", "Extension", "Weg", "Crosshead"],
    "displacement": ["Displacement", "Weg", "Extension", "Crosshead", "Standardweg"],
    "engineering": ["Strain", "Dehnung", "Tensile strain", "e"],
    "stretch": ["Stretch", "lambda", "Streckung"],
    "shear": ["Shear", "Shear strain", "Schiebung"],
    "force": ["Force", "Load", "Kraft", "Standardkraft"],
    "nominal": ["Stress", "Spannung", "Nominal stress", "Engineering stress"],
    "time": ["Time", "Zeit", "Test time"]}
FURTHER = [("Temperature", "degC", 23.0), ("Temperatur", "°C", 21.5), ("Cycle", "", 1.0),
           ("Humidity", "%", 45.0)]
ABOVE = [["Test report"], ["Operator", "M. Weber"], ["Date", "2024-03-11"],
         ["Test speed", "10", "mm/min"], ["Sample", "A12"], ["Software", "TestXpert II V3.71"]]
BELOW = [["Mean", "", "3.71"], ["Std. dev.", "", "0.042"], ["Fmax", "", "5.335"]]
STYLES = ["brackets", "parentheses", "slash", "in", "row"]  # of units in a header
SLOW = ["tension", "compression", "shear", "planar"]
PULLED = ["tension", "planar"]
SCATTER = r"(?i)\bscatter|\bspecimens?\b.{0,60}\bdiffer|\bdiffer.{0,60}\bspecimens?\b"
RATIOS = [0.3, 0.45]  # Poisson's
WRONG_SHARE, WRONG_WIDTHS = 0.03, 0.5
Kind = collections.namedtuple("Kind", "of draw ways cause may_be_right may_be_told told")
KINDS = {}


def kind(of="presses tests", cause=None, ways=SLOW, may_be_right=False, may_be_told=False,
         told=None):
    """A kind of files, for presses, tests or both.

    cause: what its words must match to be refused rightly; without one it can be read.
    may_be_right: accepted with the truth in the interval will do.
    may_be_told: accepted with these words will do.
    told: what its words must match although it is accepted.
    """

    def register(draw):
        KINDS[draw.__name__] = Kind(of.split(), draw, ways, cause, may_be_right, may_be_told, told)
        return draw

    return register


def toml(value):
    return json.dumps(value, ensure_ascii=False)


def inline(entries):
    return "{" + ", ".join(f"{key} = {toml(value)}" for key, value in entries.items()) + "}"


def plain_number(value):
    return f"{value:.12f}".rstrip("0").rstrip(".")


def rounded(value):
    """To one digit."""
    return float(f"{value:.0e}")


class Column:
    """One of the two columns that are fitted: how it stands in the file, and what is said of it."""

    def __init__(self, key, title, base, unit, **said):
        self.key, self.title, self.base, self.said = key, title, base, said
        self.use(unit)
        self.sign = 1

    def use(self, unit):
        self.unit, self.size = unit, SIZES[self.base][unit]
        self.spelled = self.told = unit if unit != "1" else ""  # in the file; in the description

    def written(self, value):
        return self.sign * value / self.size


class Layout:
    """How a machine lays its tables out."""

    def __init__(self, numbers):
        self.separator = numbers.choice(";\t,")
        self.decimal_comma = self.separator != "," and numbers.random() < 0.4
        self.units = numbers.choice(STYLES)
        self.slash = numbers.choice(["/", " / "])
        self.above = numbers.sample(ABOVE, numbers.choice([0, 0, 2, 4]))
        self.further = numbers.sample(FURTHER[:2], 1) + FURTHER[2:][:numbers.choice([0, 1])]
        self.places = numbers.sample(range(2 + len(self.further)), 2)
        self.has_titles, self.blank_row = True, numbers.random() < 0.3
        self.below, self.between = [], {}
        self.encoding, self.line_end = "utf-8", numbers.choice(["\n", "\r\n"])

    def arranged(self, both, further):
        cells = list(further)
        for place, cell in sorted(zip(self.places, both)):
            cells.insert(place, cell)
        return cells

    def titled(self, title, unit):
        if not unit or self.units == "row":
            return title
        return title + {"brackets": f" [{unit}]", "parentheses": f" ({unit})", "in": f" in {unit}",
                        "slash": self.slash + unit}[self.units]

    def header(self, columns):
        titles = self.arranged([self.titled(c.title, c.spelled) for c in columns],
                               [self.titled(title, unit) for title, unit, _ in self.further])
        lines = [self.separator.join(titles)]
        if self.units == "row" and any(c.spelled for c in columns):
            lines.append(self.separator.join(self.arranged(
                [c.spelled for c in columns], [unit for _, unit, _ in self.further])))
        return lines

    def number(self, value, decimals):
        text = f"{value:.{decimals}f}"
        return text.replace(".", ",") if self.decimal_comma else text

    def table(self, columns, rows):
        written = [[c.written(row[i]) for row in rows] for i, c in enumerate(columns)]
        decimals = [max(0, 6 - math.ceil(math.log10(max(values) - min(values))))
                    for values in written]
        lines = self.header(columns) if self.has_titles else []
        for i, pair in enumerate(zip(*written)):
            lines += self.between.get(i, [])
            lines.append(self.separator.join(self.arranged(
                [self.number(value, places) for value, places in zip(pair, decimals)],
                [self.number(value, 1) for _, _, value in self.further])))
        return lines

    def write(self, path, columns, tables):
        lines = [self.separator.join(cells) for cells in self.above]
        lines += [""] if self.above and self.blank_row else []
        for rows in tables:
            lines += self.table(columns, rows) + [""] * (len(tables) > 1)
        lines += [self.separator.join(cells) for cells in self.below]
        path.write_bytes((self.line_end.join(lines) + self.line_end).encode(self.encoding))


class Measurement:
    """Files of one press or test, what is said of them, and the truth."""

    def __init__(self, bench, numbers, folder, kind):
        self.bench, self.random, self.folder, self.kind = bench, numbers, folder, kind
        self.cause = kind.cause
        self.noise = numbers.choice([0.003, 0.005, 0.01])
        self.count = numbers.randint(20, 80)
        self.layout = Layout(numbers)
        self.columns_by = numbers.choice(["title", "number"])
        self.further_keys = ""  # of a description
        self.apart = False  # each file a test of its own

    def columns(self):
        return [self.x, self.y]

    def ramp(self, first=0.0, count=None):
        """Shares of the way."""
        count = count or self.count
        return [first + (1.0 - first) * i / (count - 1) for i in range(count)]

    def dense(self):
        self.count = self.random.randint(1000, 3000)

    def largest(self):
        return abs(self.at(1.0)[1])

    def span(self):
        return abs(self.at(1.0)[0] - self.at(0.0)[0])

    def measure(self, shares=None, lost=0.0):
        """Rows; on ways back a share of the ordinate is lost."""
        shares = shares or self.ramp()
        error = self.noise * max(abs(self.at(share)[1]) for share in shares)
        rows, before = [], shares[0]
        for share in shares:
            x, y = self.at(share)
            y *= 1 - lost * (1 - share) if share < before else 1
            rows.append((x, y + self.random.gauss(0, error)))
            before = share
        return rows

    def shifted(self, rows, x=0.0, y=0.0):
        return [(a + x, b + y) for a, b in rows]

    def tare(self, low, high):
        return self.random.choice([-1, 1]) * self.random.uniform(low, high) * self.largest()

    def untitled(self):
        """The file names no unit."""
        for column in self.columns():
            column.spelled = ""

    def say(self, column):
        titled = self.layout.titled(column.title, column.spelled)
        inner = self.layout.units != "in" and self.random.random() < 0.5
        title = column.title if inner else titled
        place = self.layout.arranged(self.columns(), self.layout.further).index(column) + 1
        told = {"unit": column.told} if column.told else {}
        return {"column": title if self.columns_by == "title" else place} | told | column.said

    def keys(self):
        return "".join(f"{c.key} = {inline(self.say(c))}\n" for c in self.columns() if c.key)

    def fit(self, files):
        """Exit code, (estimate, lower, upper) [Pa] or None, words."""
        names = [f"{'abc'[i]}.csv" for i in range(len(files))]
        for name, tables in zip(names, files):
            self.layout.write(self.folder / name, self.columns(), tables)
        run = self.bench.run("calibrate", self.settings(names), self.folder / "fit")
        words = run.stderr + run.stdout
        return run.returncode, self.found() if run.returncode == 0 else None, words

    def description(self, table, names):
        groups = [[name] for name in names] if self.apart else [names]
        return "".join(f"[[{table}]]\npath = {toml(group if len(group) > 1 else group[0])}\n"
                       + self.further_keys + self.keys() for group in groups)

    def record(self, name):
        return json.loads((self.folder / "fit" / name).read_text())


class Press(Measurement):
    """Share: of the travel."""

    def __init__(self, bench, numbers, folder, kind):
        super().__init__(bench, numbers, folder, kind)
        self.ratio = numbers.choice(RATIOS)
        self.modulus = 1e3 * math.exp(numbers.uniform(math.log(50), math.log(400)))  # [Pa]
        self.touch = numbers.uniform(0.05, 0.5)  # [mm]
        self.deepest = numbers.choice([1.2, 1.6, 2.0])  # [mm]
        self.described = True
        self.x = Column("position", numbers.choice(TITLES["position"]), "mm",
                        numbers.choice(["mm", "mm", "um", "cm"]))
        self.y = Column("force", numbers.choice(TITLES["force"]), "N",
                        numbers.choice(["N", "N", "mN", "kN"]))

    def dense(self):
        self.count = self.random.randint(300, 2000)

    def at(self, share):
        position = share * (self.touch + self.deepest)
        table = self.bench.press("frictionless", self.ratio)
        return position, 1e-8 * self.modulus * force_at(table, position - self.touch)

    def first_touch(self):
        return self.touch / (self.touch + self.deepest)

    def settings(self, names):
        data = "a.csv"
        if self.described:
            data = "press.toml"
            (self.folder / data).write_text(self.description("press", names), encoding="utf-8")
        return ["calibration.problem=experiment", f'calibration.data=["{self.folder / data}"]',
                'calibration.parameters=["modulus"]', "calibration.candidates=[]",
                "calibration.forward=continuum", "reference.fields=false",
                f"rubber.poissons_ratio={self.ratio}", 'rubber.youngs_modulus="100 kPa"',
                "press.contact=frictionless"]

    def found(self):
        told = next(p for p in self.record("calibration.json")["parameters"]
                    if p["name"] == "modulus")
        return told["estimate"], told["lower"], told["upper"]


class Coupon(Measurement):
    """Share: of the strain, of a relaxation of the time's logarithm."""

    def __init__(self, bench, numbers, folder, kind):
        super().__init__(bench, numbers, folder, kind)
        self.way = numbers.choice(kind.ways)
        self.modulus = 1e3 * math.exp(numbers.uniform(math.log(20), math.log(300)))  # G [Pa]
        self.farthest = {"tension": numbers.uniform(0.2, 0.8),
                         "compression": numbers.uniform(-0.35, -0.15),
                         "shear": numbers.uniform(0.2, 0.6), "planar": numbers.uniform(0.2, 0.6),
                         "relaxation": numbers.uniform(0.1, 0.5)}[self.way]
        self.fades, self.time = numbers.uniform(0.1, 0.4), numbers.uniform(1.0, 20.0)  # [s]
        self.length, self.area = numbers.uniform(20, 60), numbers.uniform(12, 200)  # [mm], [mm²]
        if self.way == "relaxation":
            self.count = numbers.randint(40, 80)
            self.x = Column("time", numbers.choice(TITLES["time"]), "s",
                            numbers.choice(["s", "s", "ms", "min"]))
        elif self.way == "shear":
            self.strain_as(numbers.choice(["shear", "displacement"]))
        else:
            self.strain_as(numbers.choice(["engineering", "stretch", "displacement"]))
        self.stress_as(numbers.choice(["nominal", "nominal", "force"]))

    def dense(self):
        if self.way != "relaxation":
            super().dense()

    def strain_as(self, measure, unit=None):
        base = "mm" if measure == "displacement" else "1"
        units = {"displacement": ["mm", "mm", "cm", "um"], "engineering": ["1", "%"]}
        unit = unit or self.random.choice(units.get(measure, ["1"]))
        self.x = Column("strain", self.random.choice(TITLES[measure]), base, unit,
                        **{"is": measure})

    def stress_as(self, measure, unit=None):
        base = "N" if measure == "force" else "kPa"
        unit = unit or self.random.choice({"N": ["N", "N", "mN", "kN"],
                                           "kPa": ["kPa", "MPa", "Pa", "N/mm^2"]}[base])
        self.y = Column("stress", self.random.choice(TITLES[measure]), base, unit,
                        **{"is": measure})

    def stress(self, strain):
        """Nominal [kPa]."""
        stretch, modulus = 1 + strain, 1e-3 * self.modulus
        if self.way == "shear":
            return modulus * strain
        if self.way == "planar":
            return modulus * (stretch - stretch**-3)
        return modulus * (stretch - stretch**-2)

    def at(self, share):
        if self.way == "relaxation":
            x = 0.1 * 3000**share
            y = self.stress(self.farthest) * (
                1 + self.fades / (1 - self.fades) * math.exp(-x / self.time))
        else:
            strain = share * self.farthest
            y = self.stress(strain)
            x = {"displacement": self.length * strain, "stretch": 1 + strain}.get(
                self.x.said["is"], strain)
        return x, y * (1e-3 * self.area if self.y.said["is"] == "force" else 1.0)

    def largest(self):
        return max(abs(self.at(0.0)[1]), abs(self.at(1.0)[1]))

    def keys(self):
        kinds = {"shear": "simple-shear", "planar": "planar", "relaxation": "relaxation"}
        text = f'kind = "{kinds.get(self.way, "uniaxial")}"\n'
        if self.x.said.get("is") == "displacement":
            text += f'length = "{self.length:.6g} mm"\n'
        if self.y.said["is"] == "force":
            text += f'area = "{self.area:.6g} mm^2"\n'
        if self.way == "relaxation":
            text += f'strain = {{value = {self.farthest:.9g}, is = "engineering"}}\n'
        return text + super().keys()

    def settings(self, names):
        (self.folder / "tests.toml").write_text(self.description("test", names), encoding="utf-8")
        return ["calibration.problem=material", f'calibration.tests={self.folder / "tests.toml"}',
                'calibration.laws=["neo-hookean","mooney-rivlin","yeoh-2"]']

    def found(self):
        record = self.record("laws.json")
        return tuple(record["shear_modulus" + end] for end in ("", "_lower", "_upper"))


FAMILIES = {"presses": Press, "tests": Coupon}


# Files that can be read.


@kind(ways=SLOW + ["relaxation"])
def plain(s):
    """Units are described, the file may agree."""
    if s.random.random() < 0.5:
        s.untitled()
    elif isinstance(s, Press):
        s.described = s.random.random() < 0.5
    if s.random.random() < 0.3:
        s.dense()
    return [[s.measure()]]


@kind(ways=SLOW + ["relaxation"])
def unit_in_file(s):
    s.x.told = s.y.told = ""
    return [[s.measure()]]


@kind(ways=SLOW + ["relaxation"])
def unit_respelled(s):
    """File and description agree by another spelling."""
    for column in s.columns():
        if column.unit in SPELLINGS:
            other = s.random.choice(SPELLINGS[column.unit])
            if s.random.random() < 0.5:
                column.spelled = other
            else:
                column.told = other
    return [[s.measure()]]


@kind("tests", ways=["tension", "compression", "planar"])
def per_cent(s):
    s.strain_as("engineering", "%")
    s.x.told = ""
    return [[s.measure()]]


@kind()
def scaled(s):
    """Counts, of a converter or of an encoder."""
    s.untitled()
    if s.x.base == "1":
        s.strain_as("displacement")
        s.x.spelled = ""
    counted = s.random.choice([[s.x], [s.y], [s.x, s.y]])
    for column, span in ((s.x, s.span()), (s.y, s.largest())):
        if column not in counted:
            continue
        count = rounded(span / column.size / s.random.uniform(1e4, 6e4))
        column.size *= count
        if s.random.random() < 0.5:
            column.said["scale"] = count
        else:
            column.told = f"{plain_number(count)} {column.unit}"
    return [[s.measure()]]


@kind()
def zeroed(s):
    """The machine's zeros are elsewhere, and told."""
    if s.x.said.get("is") == "stretch":
        s.strain_as("displacement")
    rows = s.measure()
    rows[0] = s.at(0.0)  # by which the machine would be zeroed
    far = {"mm": s.random.uniform(-20, -5), "1": s.random.uniform(-0.3, 0.3)}[s.x.base]
    near = s.random.uniform(-20, 20) * s.largest()
    for column, zero in ((s.x, far), (s.y, near)):
        form = s.random.choice(["first row", "number", "quantity"])
        if form == "quantity" and column.unit == "1":
            form = "number"
        number = float(f"{column.written(zero):.8g}")
        column.said["zero"] = {"first row": form, "number": number,
                               "quantity": f"{plain_number(number)} {column.unit}"}[form]
    return [[s.shifted(rows, far, near)]]


@kind()
def tare_at_rest(s):
    """A load cell that was not at zero; rows before touch, or at rest, tell it."""
    if isinstance(s, Press):
        s.touch, s.count = 0.5 * s.deepest, s.random.randint(80, 120)
        shares = s.ramp()
    else:
        shares = [0.0] * s.random.randint(20, 40) + s.ramp()
    return [[s.shifted(s.measure(shares), y=s.tare(0.01, 0.08))]]


@kind()
def tare_fitted(s):
    s.y.said["zero"] = "fit"
    first = s.first_touch() if isinstance(s, Press) else s.random.uniform(0.05, 0.25)
    s.count = s.random.randint(40, 80)
    return [[s.shifted(s.measure(s.ramp(first)), y=s.tare(0.01, 0.08))]]


@kind()
def cycles(s):
    up = s.ramp()
    shares = (up + up[-2::-1]) * s.random.choice([2, 3])
    return [[s.measure(shares, lost=s.random.choice([0.0, s.random.uniform(0.05, 0.3)]))]]


@kind()
def reversed_rows(s):
    return [[s.measure()[::-1]]]


@kind()
def noisy_abscissa(s):
    s.count = s.random.randint(1000, 3000)
    step = s.span() / s.count
    return [[[(x + s.random.gauss(0, step), y) for x, y in s.measure()]]]


@kind()
def odd_rows(s):
    """One or two rows far off; perhaps the first."""
    rows = s.measure()
    places = s.random.sample(range(0, len(rows), 3), s.random.choice([1, 2]))
    if s.random.random() < 0.3:
        places[0] = 0
    for place in places:
        x, y = rows[place]
        far = s.random.choice([-1, 1]) * s.random.uniform(3, 10)
        rows[place] = s.random.choice([(x + far * s.span(), y), (x, y + far * s.largest())])
    return [[rows]]


@kind()
def clipped(s):
    """The load cell ends."""
    s.count = s.random.randint(40, 80)
    rows = s.measure()
    limit = abs(s.at(1.0 - s.random.uniform(0.1, 0.25))[1])
    return [[[(x, max(-limit, min(limit, y))) for x, y in rows]]]


@kind(ways=SLOW + ["relaxation"])
def encoded(s):
    s.layout.encoding = s.random.choice(["utf-16", "latin-1", "utf-8-sig"])
    s.layout.further = [("Temperatur", "°C", 21.5)]
    s.layout.places = s.random.sample(range(3), 2)
    s.layout.above = [["Prüfprotokoll"], ["Prüfer", "J. Müller"]]
    if s.y.base == "N":
        s.y.title = "Prüfkraft"
    if s.x.base == "mm":
        s.x.title = "Längenänderung"
    return [[s.measure()]]


@kind("presses")
def second_block(s):
    """Of other fingers are the first and the last."""
    s.further_keys = "block = 2\n"
    factors = [0.6, 1.0, 1.5][:s.random.choice([2, 3])]
    return [[[(x, factor * y) for x, y in s.measure()] for factor in factors]]


@kind()
def repeats(s):
    files = []
    for _ in range(3):
        s.count = s.random.randint(30, 80)
        files.append([s.measure()])
        if isinstance(s, Press):
            s.touch += s.random.uniform(-0.02, 0.05)
    return files


@kind()
def gram_force(s):
    if isinstance(s, Coupon):
        s.stress_as("force", "gf")
    s.y.use("gf")
    s.y.title, s.y.spelled = s.random.choice(["Force", "Load"]), "g"
    s.layout.units = s.random.choice(["parentheses", "brackets"])
    return [[s.measure()]]


@kind()
def bracketed_title(s):
    if isinstance(s, Coupon):
        s.strain_as("displacement")
        s.stress_as("force")
    s.layout.units = "brackets"
    s.x.title = s.random.choice(["Displacement (Strain 1)", "Extension (LVDT 2)"])
    s.y.title = s.random.choice(["Load (Channel 2)", "Force (8800)", "Kraft (Messdose A)"])
    for column in s.columns():
        column.told = s.random.choice([column.unit, ""])
    return [[s.measure()]]


@kind(ways=["compression"])
def signed(s):
    """Compression is negative where it ought to be positive, or the other way about."""
    if s.x.said.get("is") == "stretch":
        s.strain_as("engineering")
    turned = s.columns() if isinstance(s, Coupon) else s.random.choice([[s.y], [s.x, s.y]])
    for column in turned:
        column.sign = column.said["sign"] = -1
    return [[s.measure()]]


@kind(ways=SLOW + ["relaxation"])
def remarks(s):
    """Among the rows, and statistics below them."""
    s.layout.below = s.random.sample(BELOW, s.random.randint(1, 3))
    if s.random.random() < 0.5:  # as spreadsheets write an empty row
        s.layout.below = [[""] * (2 + len(s.layout.further))] + s.layout.below
    if s.random.random() < 0.5:
        s.layout.between = {s.random.randint(5, 15): [s.random.choice(
            ["# pause", "Event: operator", "# gain switched"])]}
    return [[s.measure()]]


@kind("tests", told=SCATTER)
def specimens_pooled(s):
    """Their mean is the truth."""
    return specimens(s)


# Files that cannot.


def both_units(*units):
    """A line that has both."""
    return "(?m)^" + "".join(rf"(?=.*(?<!\w){re.escape(unit)}(?!\w))" for unit in units) + ".*$"


@kind(cause="unit", ways=SLOW + ["relaxation"])
def wrong_unit(s):
    column = s.random.choice([c for c in s.columns() if c.base != "1"])
    if s.random.random() < 0.5:
        wrong = {"kN": "N", "N": "kN", "mN": "N", "kPa": "MPa", "MPa": "kPa"}.get(column.unit)
    else:
        wrong = None
    wrong = wrong or s.random.choice([unit for unit, size in SIZES[column.base].items()
                                      if size != SIZES[column.base][column.unit]])
    column.told = wrong
    s.cause = both_units(column.spelled, wrong)
    return [[s.measure()]]


@kind("tests", cause=both_units("%", "1"), ways=["tension", "compression", "planar"])
def per_cent_told_as_one(s):
    s.strain_as("engineering", "%")
    s.x.told = "1"
    return [[s.measure()]]


@kind("tests", cause=r"(?i)per ?cent|unit = .?\"%", ways=["tension", "planar", "compression"])
def per_cent_untold(s):
    s.farthest = math.copysign(s.random.uniform(0.15, 0.35 if s.farthest < 0 else 0.6), s.farthest)
    s.strain_as("engineering", "%")
    s.x.spelled = s.x.told = ""
    rows = s.measure()
    s.x.said["is"] = s.random.choice(["engineering", "stretch"])
    return [[rows]]


@kind("tests", cause=r"(?i)(?<!\w)mm(?!\w)|displacement|length", ways=["tension", "planar"])
def length_as_strain(s):
    """Without a unit in the file the strain is more than any rubber bears."""
    s.strain_as("displacement", "mm")
    rows, most = s.measure(), s.span()
    s.x.said["is"], s.x.told = "engineering", ""
    if most > 12 and s.random.random() < 0.5:
        s.x.spelled = ""
        s.cause += "|(?i:per ?cent)"
    return [[rows]]


IMPLAUSIBLE = r"(?i)no rubber|any rubber|\bfactor\b|milli|thousand|1 ?000 times"


@kind("tests", cause=IMPLAUSIBLE)
def milli_for_mega(s):
    s.stress_as("nominal", "MPa")
    s.y.spelled, s.y.told = "", "mPa"
    return [[s.measure()]]


@kind("presses", cause=IMPLAUSIBLE, may_be_told=True)
def thousandfold(s):
    """Of a file without units: a rubber of more than 100 MPa or less than 1 kPa."""
    s.untitled()
    s.modulus = 1e3 * s.random.uniform(120, 500)
    wrong = s.random.choice(["kN for N", "mN for N", "N for mN", "um for mm"]).split(" for ")
    column = s.x if wrong[0] == "um" else s.y
    column.use(wrong[1])
    column.spelled, column.told = "", wrong[0]
    return [[s.measure()]]


ZERO = r"(?i)\bzero|offset|at rest|\btare"


@kind("tests", cause=ZERO, may_be_right=True)
def tare_unseen(s):
    s.count = s.random.randint(30, 80)
    rows = s.measure(s.ramp(s.random.uniform(0.1, 0.3)))
    return [[s.shifted(rows, y=s.tare(0.04, 0.08))]]


@kind("tests", cause=r"(?i)at rest|permanent|\bset of\b|\ba set\b|unload|slack", ways=["tension"])
def unloading_alone(s):
    """Its stress vanishes at a set."""
    s.farthest, left = s.random.uniform(0.6, 1.0), s.random.uniform(0.1, 0.4)
    at = s.at

    def unloaded(share):
        return at(share)[0], at(1.0)[1] * max(0.0, (share * s.farthest - left)
                                              / (s.farthest - left))**1.5

    s.at = unloaded
    return [[s.measure(s.ramp(left / s.farthest)[::-1])]]


@kind(cause="(?i)unit|header|name the columns")
def nameless(s):
    """Neither a header nor units."""
    s.untitled()
    s.layout.has_titles, s.columns_by = False, "number"
    if isinstance(s, Press) and s.random.random() < 0.5:
        s.described = False
    for column in s.columns():
        column.told = ""
    return [[s.measure()]]


# Residuals change theirs, and some are no sign of something missed.
@kind(cause=r"(?i)(?<!change )\bsign\b(?! of something)", ways=PULLED)
def sign_turned(s):
    s.y.sign = -1
    return [[s.measure()]]


@kind("tests", cause=SCATTER, may_be_told=True)
def specimens_apart(s):
    s.apart = True
    return specimens(s)


def specimens(s):
    """Three, whose moduli differ by a fifth."""
    modulus = s.modulus
    files = []
    for factor in (0.8, 1.0, 1.2):
        s.modulus, s.count = factor * modulus, s.random.randint(30, 80)
        files.append([s.measure()])
    s.modulus = modulus
    s.random.shuffle(files)
    return files


# Judgement.


def verdict(s, code, found, words):
    """Right, near (out of the interval, but not wrong), wrong, untold or refused; of a file that
    cannot be read refused is for the right cause, misjudged for another, accepted not at all."""
    named = bool(s.cause) and re.search(s.cause, words) is not None
    if code != 0:
        return "refused" if not s.cause or (named and code in (2, 4)) else "misjudged"
    estimate, lower, upper = found
    within = lower <= s.modulus <= upper
    beyond = max(lower - s.modulus, s.modulus - upper)
    wrong = (beyond > WRONG_WIDTHS * (upper - lower)
             and abs(estimate - s.modulus) > WRONG_SHARE * s.modulus)
    if s.cause:
        if (s.kind.may_be_told and named) or (s.kind.may_be_right and within):
            return "right"
        return "wrong" if wrong else "accepted"
    if wrong:
        return "wrong"
    if s.kind.told and not re.search(s.kind.told, words):
        return "untold"
    return "right" if within else "near"


def judged(options, bench, place, name, family, number):
    """Verdict, exit code and a line that tells of a failure."""
    # Of a name that says nothing: it stands in the words that are searched.
    folder = place / f"{family}_{list(KINDS).index(name)}_{number}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    s = FAMILIES[family](bench, random.Random(f"{options.seed} {name} {family} {number}"), folder,
                         KINDS[name])
    code, found, words = s.fit(s.kind.draw(s))
    (folder / "words.txt").write_text(words)
    told = "modulus {:.6g} ({:.6g} to {:.6g}) kPa, ".format(*(1e-3 * f for f in found)) \
        if found else ""
    first = next((line for line in words.splitlines() if line and ": note: " not in line), "")
    return verdict(s, code, found, words), code, \
        f"{name}, {folder.name}: exit {code}, {told}truth {1e-3 * s.modulus:.6g} kPa: " \
        + first.replace(f"{folder}/", "")


def dealt(options):
    """Files of each kind and family, dealt in turn."""
    pairs = [(name, family) for name, each in KINDS.items() for family in each.of
             if (not options.only or name in options.only)
             and (not options.kinds or family == options.kinds)]
    return {pair: options.each or options.files // len(pairs) + (i < options.files % len(pairs))
            for i, pair in enumerate(pairs)}


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--files", type=int, default=200)
    arguments.add_argument("--each", type=int, help="files of each kind and family, instead")
    arguments.add_argument("--only", nargs="+", choices=list(KINDS))
    arguments.add_argument("--kinds", choices=list(FAMILIES))
    arguments.add_argument("--program", default="build/release/bin/fingertip")
    arguments.add_argument("--keep", type=pathlib.Path, help="folder that keeps files and runs")
    options = arguments.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    good = {True: {"right", "near"}, False: {"right", "refused"}}
    totals, failures = {True: collections.Counter(), False: collections.Counter()}, []
    print("| kind | of | can be read | verdicts | exit codes |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as temporary:
        place = (options.keep or pathlib.Path(temporary)).resolve()
        place.mkdir(parents=True, exist_ok=True)
        bench = Bench(program, place)
        for (name, family), count in dealt(options).items():
            readable = KINDS[name].cause is None
            verdicts, codes = collections.Counter(), []
            for number in range(count):
                word, code, line = judged(options, bench, place, name, family, number)
                verdicts[word] += 1
                codes.append(code)
                if word not in good[readable]:
                    failures.append(f"{word}: {line}")
            totals[readable] += verdicts
            told = ", ".join(f"{number} {word}" for word, number in verdicts.most_common())
            print(f"| {name} | {family} | {'yes' if readable else 'no'} | {told} | "
                  f"{' '.join(map(str, codes))} |", flush=True)
    print("\n" + "\n".join(failures))
    readable, other = totals[True], totals[False]
    wrong = readable["wrong"] + other["wrong"]
    refused = readable["refused"] + readable["untold"]
    accepted = readable["right"] + readable["near"] + readable["wrong"]
    caught = other["refused"] + other["right"]
    print(f"\nseed {options.seed}, {readable.total() + other.total()} files. Wrong without a word: "
          f"{wrong}. Refused, or not told of, though they can be read: {refused} of "
          f"{readable.total()}; of {accepted} that were accepted {readable['right']} have the "
          f"truth in the interval. Cannot be read and refused for the right cause: {caught} of "
          f"{other.total()}")
    sys.exit(1 if wrong > 0 or refused > 0.03 * readable.total() or caught < 0.9 * other.total()
             else 0)


if __name__ == "__main__":
    main()
