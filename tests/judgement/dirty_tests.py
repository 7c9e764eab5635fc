"""Kinds of dirt in tests of a material. Truth: laws of rubber in closed form; G is sought."""

import math
import re

from dirt import Set, kinds_of

FORMER = ["neo-hookean", "mooney-rivlin", "yeoh-2"]  # laws that are tried, unless a kind says more


def stress(way, strain, slope, second=0.0):
    """Nominal, of a rubber that keeps its volume. slope: dW/dI1 of I1; second: dW/dI2."""
    l = 1 + strain
    if way == "simple-shear":
        return 2 * strain * (slope(3 + strain**2) + second)
    if way == "planar":
        return 2 * (l - l**-3) * (slope(l**2 + 1 + l**-2) + second)
    if way == "equibiaxial":
        return 2 * (l - l**-5) * (slope(2 * l**2 + l**-4) + second * l**2)
    return 2 * (l - l**-2) * (slope(l**2 + 2 / l) + second / l)


def ogden(way, strain, modulus, exponent):
    l = 1 + strain
    if way == "simple-shear":
        l = math.exp(math.asinh(0.5 * strain))
        return 2 * modulus / exponent * (l**exponent - l**-exponent) / (l + 1 / l)
    side = {"uniaxial": -0.5, "planar": -1, "equibiaxial": -2}[way]
    return 2 * modulus / exponent * (l**exponent - l**(side * exponent)) / l


class Tests(Set):
    problem, record = "material", "laws.json"

    def __init__(self, bench, numbers, folder):
        super().__init__(bench, numbers, folder)
        self.modulus = self.between(20, 1000)  # G [kPa]
        self.noise = self.between(0.003, 0.015)  # of the stress, at least of a tenth of the largest
        self.count = numbers.randint(15, 50)
        self.second = numbers.choice([0.0, numbers.uniform(0, 0.4)])  # 2 C01/G
        self.laws, self.described = FORMER, []

    def law(self, way, modulus=None):
        """Stress [kPa] of strain."""
        modulus = modulus or self.modulus
        first = 0.5 * modulus * (1 - self.second)
        return lambda e: stress(way, e, lambda _: first, 0.5 * modulus * self.second)

    def pulled(self):
        return "uniaxial", 0.0, self.random.uniform(0.3, 0.8)

    def pressed(self):
        return "uniaxial", 0.0, -self.random.uniform(0.15, 0.35)

    def sheared(self):
        return "simple-shear", 0.0, self.random.uniform(0.3, 0.6)

    def sheet(self):
        return "planar", 0.0, self.random.uniform(0.3, 0.6)

    def rows(self, law, first, last, count=None):
        """[(strain, stress)], the first of which is a step behind rest."""
        count = count or self.count
        return [(e, law(e)) for e in (first + (last - first) * (i + 1) / count
                                      for i in range(count))]

    def noisy(self, rows):
        largest = max(abs(p) for _, p in rows)
        return [(e, self.random.gauss(p, self.noise * max(abs(p), 0.1 * largest)))
                for e, p in rows]

    def tell(self, way, *specimens, measure=None):
        """Writes rows of a test, of each specimen, and says what they are."""
        number = len(self.described) + 1
        names = [f"{'abcdefgh'[i]}{number}.csv" for i in range(len(specimens))]
        for name, rows in zip(names, specimens):
            self.table(name, ["e", "s"], rows)
        paths = ", ".join(f'"{name}"' for name in names)
        measure = measure or ("shear" if way == "simple-shear" else "engineering")
        self.described.append(
            f'[[test]]\nkind = "{way}"\nname = "test {number}"\npath = [{paths}]\n'
            f'strain = {{column = "e", is = "{measure}"}}\n'
            'stress = {column = "s", is = "nominal", unit = "kPa"}\n')

    def test(self, ways, law=None, change=lambda rows: rows, told=None, **how):
        """Measures and tells one; change: of noisy rows."""
        way, first, last = ways
        rows = self.noisy(self.rows(law or self.law(way), first, last))
        self.tell(told or way, change(rows), **how)

    def fit(self):
        (self.folder / "tests.toml").write_text("".join(self.described))
        laws = ",".join(f'"{law}"' for law in self.laws)
        self.truths = self.truths or {"shear_modulus": 1e3 * self.modulus}
        return self.fitted([f'calibration.tests={self.folder / "tests.toml"}',
                            f"calibration.laws=[{laws}]"])

    def estimates(self, told):
        if told.get("shear_modulus_lower") is None:
            return {}
        return {"shear_modulus": tuple(told["shear_modulus" + end]
                                       for end in ("", "_lower", "_upper"))}

    def names_cause(self, fit, cause):
        """Laws have no list of suspects: any sentence, before it says where else to look."""
        return any(re.search(cause, re.split(r"\bElse\b", sentence)[0]) for sentence in fit.failed)


# What laws describe.

kind = kinds_of("tests", "tests that laws describe")


@kind()
def tension_and_compression(s):
    s.test(s.pulled())
    s.test(s.pressed())
    return s.fit()


@kind()
def tension_and_shear(s):
    s.test(s.pulled())
    s.test(s.sheared())
    return s.fit()


@kind()
def three_ways(s):
    s.test(s.pulled())
    s.test(s.sheet())
    s.test(("equibiaxial", 0.0, s.random.uniform(0.2, 0.5)))
    return s.fit()


def single(name, law):
    """One test, of a law whose form is tried: law(set) gives (way, strain) -> stress."""

    def draw(s):
        s.laws = sorted({*FORMER, name})
        ways, true = s.random.choice([s.pulled, s.sheet, s.sheared])(), law(s)
        s.test(ways, lambda e: true(ways[0], e))
        return s.fit()

    draw.__name__ = "single_" + name.replace("-", "_")
    kind()(draw)


def yeoh(s):
    second = s.random.uniform(0.01, 0.1) * s.modulus
    return lambda way, e: stress(way, e, lambda i: 0.5 * s.modulus + 2 * second * (i - 3))


def gent(s):
    limit = s.random.uniform(3, 30)
    return lambda way, e: stress(way, e, lambda i: 0.5 * s.modulus * limit / (limit - i + 3))


def of_ogden(s):
    exponent = s.random.choice([-2.0, 1.3, 3.0, 5.0])
    return lambda way, e: ogden(way, e, s.modulus, exponent)


def mooney(s):
    second = s.random.uniform(0.1, 0.5) * s.modulus
    return lambda way, e: stress(way, e, lambda _: 0.5 * (s.modulus - second), 0.5 * second)


single("neo-hookean", lambda s: lambda way, e: stress(way, e, lambda _: 0.5 * s.modulus))
single("mooney-rivlin", mooney)
single("yeoh-2", yeoh)
single("gent", gent)
single("ogden-1", of_ogden)


@kind()
def small_strain(s):
    s.test(("uniaxial", 0.0, s.random.uniform(0.03, 0.08)))
    return s.fit()


@kind()
def noise_of_tests(s):
    s.noise = 0.05
    s.test(s.pulled())
    s.test(s.sheared())
    return s.fit()


@kind()
def few_rows_of_tests(s):
    s.count = 6
    s.test(s.pulled())
    s.test(s.pressed())
    return s.fit()


@kind()
def coarse_steps(s):
    """Of the load cell."""
    way, first, last = s.pulled()
    step = s.between(0.01, 0.05) * s.law(way)(last)
    s.test((way, first, last), change=lambda rows: [(e, step * round(p / step)) for e, p in rows])
    s.test(s.sheared())
    return s.fit()


@kind()
def spikes_of_tests(s):
    s.count = max(s.count, 30)

    def spiked(rows):
        largest = max(abs(p) for _, p in rows)
        for place in s.random.sample(range(s.count), s.random.randint(1, 2)):
            e, p = rows[place]
            rows[place] = (e, p + s.either_sign(0.2, 1.0) * largest)
        return rows

    s.test(s.pulled(), change=spiked)
    s.test(s.sheared())
    return s.fit()


@kind()
def tare_at_rest(s):
    """Rows at rest tell the zero."""
    way, first, last = s.pulled()
    rows = [(0.0, 0.0)] * s.random.randint(10, 30) + s.rows(s.law(way), first, last)
    zero = s.either_sign(0.01, 0.08) * rows[-1][1]
    s.tell(way, [(e, p + zero) for e, p in s.noisy(rows)])
    s.test(s.sheared())
    return s.fit()


@kind()
def cycles_of_tests(s):
    """The first loading is the truth, those after it are softer."""
    way, first, last = s.pulled()
    rows, soft = s.rows(s.law(way), first, last), s.random.uniform(0.6, 0.95)
    softer = [(e, p * (soft + (1 - soft) * e / last)) for e, p in rows]
    s.tell(way, s.noisy(rows + softer[-2::-1] + softer[1:]))
    s.test(s.sheared())
    return s.fit()


@kind()
def specimens_scatter(s):
    """The truth is the mean of all that might be cut."""
    (way, first, last), scatter = s.pulled(), s.random.uniform(0.03, 0.1)
    s.tell(way, *[s.noisy(s.rows(s.law(way, s.random.gauss(1, scatter) * s.modulus), first, last))
                  for _ in range(s.random.randint(3, 6))])
    return s.fit()


# What they do not, or only within an honest interval.

kind = kinds_of("tests", "faults of tests")


@kind("either")
def zero_off(s):
    """No row is at rest."""
    way, first, last = s.pulled()
    zero = s.either_sign(0.02, 0.08) * s.law(way)(last)
    s.test((way, 0.1 * last, last), change=lambda rows: [(e, p + zero) for e, p in rows])
    s.test(s.sheared())
    return s.fit()


@kind("either")
def pretension(s):
    """The strain counts from where the specimen bears already."""
    way, first, last = s.pulled()
    before = s.random.uniform(0.01, 0.04)
    s.test((way, before, last), change=lambda rows: [(e - before, p) for e, p in rows])
    s.test(s.sheared())
    return s.fit()


@kind("either")
def stress_drifts(s):
    """In one of two tests, by 3 to 10 % of its stress at the end."""
    way, first, last = s.pulled()
    drift = s.either_sign(0.03, 0.1) * s.law(way)(last)
    s.test((way, first, last), change=lambda rows: [
        (e, p + drift * (i + 1) / s.count) for i, (e, p) in enumerate(rows)])
    s.test(s.sheared())
    return s.fit()


def of_two_moduli(s, factor):
    """Tension, and shear of a rubber so much stiffer; any modulus between is right."""
    s.test(s.pulled())
    sheared = s.sheared()
    s.test(sheared, s.law(sheared[0], factor * s.modulus))
    s.truths = {"shear_modulus": tuple(sorted([1e3 * s.modulus, 1e3 * factor * s.modulus]))}
    return s.fit()


@kind(False, r"(?i)\bbatch|contradict|differ|disagree")
def batches(s):
    return of_two_moduli(s, s.random.choice([0.8, 1.2]))


@kind("either")
def rates(s):
    """One test is faster than the other, and stiffer by 5 to 15 %."""
    return of_two_moduli(s, s.random.uniform(1.05, 1.15))


@kind(False, "compressible")
def compressible(s):
    """Softer in compression by half or more: it yields its volume."""
    softer, s.second = s.random.uniform(0.3, 0.55), 0.0
    s.test(("uniaxial", 0.0, 0.3))
    s.test(("uniaxial", 0.0, -0.3), s.law("uniaxial", softer * s.modulus))
    return s.fit()


@kind(False, "compressible|foam")
def foam(s):
    """Ogden's and Hill's with the exponent 2: tension has 2 G (1 + nu), shear G."""
    ratio = s.random.uniform(0.0, 0.2)
    s.test(s.pulled(), lambda e: s.modulus * (1 + e - (1 + e)**(-2 * ratio - 1)))
    s.second = 0.0
    s.test(s.sheared())
    return s.fit()


@kind(False, "(?i)plate|friction|barrel|bulg")
def stuck_plates(s):
    """Short cylinders between plates that hold them; nobody tells. The factor of Gent and Lindley,
    1 + 2 S², S a quarter of diameter over height."""
    flatness = s.random.uniform(1.5, 3.0) / 4
    s.test(s.pulled())
    way, first, last = s.pressed()
    free = s.law(way)
    s.test((way, first, last), lambda e: free(e) * (1 + 2 * flatness**2))
    return s.fit()


@kind(False, "slack")
def slack(s):
    """Part of the way."""
    way, first, last = s.pulled()
    lost, taut = s.random.uniform(0.03, 0.08), s.law(way)
    s.test((way, first, last), lambda e: taut(max(0.0, e - lost)))
    s.test(s.sheared())
    return s.fit()


@kind(False, "(?i)planar|biaxial|contradict|kind")
def biaxial_called_planar(s):
    s.test(s.pulled())
    s.test(("equibiaxial", 0.0, s.random.uniform(0.2, 0.5)), told="planar")
    return s.fit()


@kind(False, "(?i)stretch|at rest|zero")
def stretch_told_as_strain(s):
    s.test(s.pulled(), change=lambda rows: [(1 + e, p) for e, p in rows])
    s.test(s.sheared())
    return s.fit()


@kind(False, "(?i)shear|contradict|differ|disagree")
def angle_told_as_shear(s):
    """Half of it is the tensor's, which was told as the angle's tangent."""
    s.test(s.pulled())
    s.test(s.sheared(), change=lambda rows: [(0.5 * e, p) for e, p in rows])
    return s.fit()


@kind(False, r"(?i)\bgrip|slip|slides|yield|peak|falls")
def grips_slip(s):
    """From some stretch on the specimen slides out and the stress falls off."""
    way, first, last = s.pulled()
    begins, whole = s.random.uniform(0.4, 0.7) * last, s.law(way)
    s.test((way, first, last),
           lambda e: whole(e) if e < begins else whole(begins) * (1 - 0.3 * (e - begins) / last))
    s.test(s.sheared())
    return s.fit()
