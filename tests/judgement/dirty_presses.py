"""Kinds of dirt in measured presses. Truth: the continuum at large strain, scaled by E."""

import math

from dirt import Set, Unseen, kinds_of
from truth import force_at, left_over, misses, share_missed

PLAINER = ["plain", "without_sigma", "few_rows", "white_noise", "rows_before_touch",
           "tare_before_touch", "tare_small", "compliance_small", "ball", "late_start"]
BALL = ("obstacle.shape=sphere", 'obstacle.radius="10 mm"')
SIXTH, THIN = {"rod": "6 mm"}, {"rod": "7 mm"}
CONTACTS = ["frictionless", "stick"]


class Press(Set):
    problem, record = "experiment", "calibration.json"

    def __init__(self, bench, numbers, folder):
        super().__init__(bench, numbers, folder)
        self.ratio = numbers.choice([0.3, 0.45])  # Poisson's
        self.modulus = self.between(50, 1000)  # [kPa]
        self.touch = numbers.uniform(0.05, 0.5)  # [mm]
        self.deepest = numbers.choice([1.2, 1.6, 2.0])  # [mm]
        self.count = numbers.randint(15, 60)
        self.noise = self.between(0.002, 0.02)  # of the force, which counts as so much at least:
        self.floor = numbers.choice([0.05, 1.0])  # of the largest
        self.tells_sigma = numbers.random() < 0.5
        self.contact, self.finger = "frictionless", {}

    # The truth.

    def curve(self, contact=None, finger=None, ratio=None):
        """[(depth [mm], force [mN])] of 100 kPa."""
        return self.bench.press(contact or self.contact, ratio or self.ratio,
                                **(self.finger if finger is None else finger))

    def force(self, depth, **other):
        """[N]"""
        return 1e-5 * self.modulus * force_at(self.curve(**other), depth)

    def share(self, depth):
        return min(1.0, max(0.0, depth / self.deepest))

    def slope(self):
        """At the end [N/mm]."""
        return 10 * (self.force(self.deepest) - self.force(self.deepest - 0.1))

    # Rows: [(position [mm], force [N])].

    def rows(self, first=0.0, before=0, compliance=0.0, zero=0.0, law=None):
        """Without noise. first: share of the depth; before: rows before touch; law: force of
        depth; zero: share of the largest force."""
        law = law or self.force
        step = self.deepest * (1 - first) / self.count
        depths = [step * (i + 1) for i in range(-before, 0)]
        depths += [self.deepest - step * i for i in range(self.count)][::-1]
        return [(self.touch + depth + compliance * law(depth),
                 law(depth) + zero * law(self.deepest)) for depth in depths]

    def sigma(self, force, largest):
        return self.noise * max(abs(force), self.floor * largest)

    def uncertain(self, rows):
        """Rows with the deviation of each."""
        largest = max(abs(force) for _, force in rows)
        return [(x, force, self.sigma(force, largest)) for x, force in rows]

    def noisy(self, rows):
        return [(x, self.random.gauss(force, e)) for x, force, e in self.uncertain(rows)]

    def write(self, name, rows, sigmas, seconds=None, told=1.0):
        """seconds: of a row; told: what of the noise is told."""
        titles = ["position [mm]", "force [N]"]
        table = [list(row) for row in rows]
        if self.tells_sigma:
            titles.append("sigma [N]")
            table = [row + [told * e] for row, e in zip(table, sigmas)]
        if seconds:
            titles.insert(0, "time [s]")
            table = [[seconds * i] + row for i, row in enumerate(table)]
        self.table(name, titles, table)

    def measured(self, rows, name="a.csv", **how):
        """Writes rows with noise."""
        self.write(name, self.noisy(rows), [e for _, _, e in self.uncertain(rows)], **how)

    def soiled(self, change):
        """Writes rows that `change` has made of noisy ones, which no sigma describes."""
        self.tells_sigma = False
        rows = self.noisy(self.rows())
        self.write("a.csv", change(rows), rows)

    def showing(self, make, *tables):
        """Rows of the presses that `make` gives for a fault so large, or for less noise, that it
        shows beside the truth of `tables`."""
        for larger in range(12):
            presses = make(1.2**larger)
            rests = left_over([(self.uncertain(rows), table) for rows, table
                               in zip(presses, tables or [self.curve()])])
            if misses(rests):
                self.seen = share_missed(rests)
                return presses
            self.noise = max(0.001, 0.8 * self.noise)
        raise Unseen

    def stiffness_for(self, compliance, share, most=5000):
        """Sets E so that the compliance is this share of the finger's at the end."""
        self.modulus *= share / (compliance * self.slope())
        self.modulus = min(max(self.modulus, 20), most)

    # The fit.

    def fit(self, *files, rig=None, contact="frictionless", ratio=None, finger=None, further=()):
        """ratio, contact, finger: as they are told."""
        files = files or ("a.csv",)
        names = ",".join(f'"{self.folder / file}"' for file in files)
        settings = [f"calibration.data=[{names}]", 'calibration.parameters=["modulus"]',
                    "calibration.candidates=[]", "calibration.forward=continuum",
                    "reference.fields=false", 'rubber.youngs_modulus="100 kPa"']
        ratio = ratio or self.ratio
        settings += [f"rubber.poissons_ratio={ratio}"] if ratio != "untold" else []
        finger = self.finger if finger is None else finger
        settings += [f'geometry.{part}_radius="{size}"' for part, size in finger.items()
                     if part != "further"] + list(finger.get("further", ()))
        settings += [f"press.contact={contact}"] if contact else []
        settings += [f"calibration.rig={rig}"] if rig else []
        self.truths = self.truths or {"modulus": 1e3 * self.modulus}
        return self.fitted(settings + list(further))

    def estimates(self, told):
        return {p["name"]: (p["estimate"], p["lower"], p["upper"])
                for p in told.get("parameters", [])}

    def fit_two_fingers(self, first, second, **told):
        self.measured(first, "a.csv")
        self.measured(second, "b.csv")
        rod = told.pop("rod", SIXTH["rod"])
        (self.folder / "both.toml").write_text(
            '[[press]]\npath = "a.csv"\n[[press]]\npath = "b.csv"\n'
            f'condition = "geometry.rod_radius={rod}"\n')
        return self.fit("both.toml", **told)


# Noise.

kind = kinds_of("presses", "noise")


@kind()
def plain(s):
    s.tells_sigma = True
    s.measured(s.rows())
    return s.fit()


@kind()
def without_sigma(s):
    s.tells_sigma = False
    s.measured(s.rows())
    return s.fit()


@kind()
def few_rows(s):
    s.count = 8
    s.measured(s.rows())
    return s.fit()


@kind()
def many_rows(s):
    s.count = 400
    s.measured(s.rows())
    return s.fit()


@kind()
def white_noise(s):
    s.noise, s.count = s.random.uniform(0.04, 0.1), s.random.randint(30, 100)
    s.measured(s.rows())
    return s.fit()


@kind()
def heavy_tails(s):
    """Student's, of three degrees of freedom."""
    def tailed(e):
        chi_square = sum(s.random.gauss(0, 1)**2 for _ in range(3))
        return s.random.gauss(0, e) / math.sqrt(chi_square)

    rows = s.rows()
    sigmas = [e for _, _, e in s.uncertain(rows)]
    s.write("a.csv", [(x, f + tailed(e)) for (x, f), e in zip(rows, sigmas)], sigmas)
    return s.fit()


@kind()
def sigma_too_small(s):
    s.tells_sigma = True
    s.measured(s.rows(), told=1 / s.random.uniform(2, 3))
    return s.fit()


@kind()
def sigma_too_large(s):
    s.tells_sigma = True
    s.measured(s.rows(), told=s.random.uniform(2, 3))
    return s.fit()


@kind()
def autocorrelated(s):
    """The next row has 0.8 of the error. Sigma is that of a row."""
    s.count = s.random.randint(30, 100)
    rows, errors, error = s.rows(), [], s.random.gauss(0, 1)
    for _ in rows:
        errors.append(error)
        error = 0.8 * error + 0.6 * s.random.gauss(0, 1)
    sigmas = [e for _, _, e in s.uncertain(rows)]
    s.write("a.csv", [(x, f + e * error) for (x, f), e, error in zip(rows, sigmas, errors)], sigmas)
    return s.fit()


@kind("either")
def vibration(s):
    """A sine that a row does not tell from noise, but the next ones do."""
    s.noise, s.count = s.between(0.002, 0.01), s.random.randint(60, 200)
    height, waves = s.random.uniform(0.01, 0.03), s.random.uniform(5, 15)
    phase = s.random.uniform(0, 2 * math.pi)

    def vibrating(rows):
        return [(x, f + height * rows[-1][1] * math.sin(phase + 2 * math.pi * waves * i / s.count))
                for i, (x, f) in enumerate(rows)]

    s.soiled(vibrating)
    return s.fit()


@kind()
def spikes(s):
    s.count = max(s.count, 25)
    rows = s.rows()
    sigmas = [e for _, _, e in s.uncertain(rows)]
    noisy = s.noisy(rows)
    for place in s.random.sample(range(s.count), s.random.randint(1, 3)):
        x, f = noisy[place]
        noisy[place] = (x, f + s.either_sign(10, 40) * sigmas[place])
    s.write("a.csv", noisy, sigmas)
    return s.fit()


@kind()
def quantised_force(s):
    s.noise = s.between(0.002, 0.01)
    step = s.between(0.01, 0.05) * s.force(s.deepest)
    s.soiled(lambda rows: [(x, step * round(f / step)) for x, f in rows])
    return s.fit()


@kind()
def quantised_position(s):
    s.count, step = s.random.randint(60, 150), s.between(0.02, 0.1)
    s.soiled(lambda rows: [(step * round(x / step), f) for x, f in rows])
    return s.fit()


@kind()
def position_noise(s):
    """Of an encoder."""
    s.count, tremble = s.random.randint(60, 150), s.between(0.002, 0.02)
    s.soiled(lambda rows: [(x + s.random.gauss(0, tremble), f) for x, f in rows])
    return s.fit()


def fit_repeats(s, factors):
    names, modulus = [], s.modulus
    touch, s.contact = s.touch, "frictionless"
    for name, factor in zip("abcdef", factors):
        s.touch, s.modulus = touch + s.random.uniform(-0.04, 0.1), factor * modulus
        names.append(f"{name}.csv")
        s.measured(s.rows(), names[-1])
    s.modulus = modulus
    return s.fit(*names)


@kind()
def repeats(s):
    return fit_repeats(s, [1.0] * 3)


@kind()
def repeats_scatter(s):
    """The truth is the mean of all that might be made."""
    scatter = s.random.uniform(0.05, 0.2)
    return fit_repeats(s, [s.random.gauss(1, scatter) for _ in range(s.random.randint(3, 6))])


# Zero and touch.

kind = kinds_of("presses", "zero and touch")


@kind()
def rows_before_touch(s):
    s.measured(s.rows(before=s.random.randint(6, 20)))
    return s.fit()


@kind()
def tare_before_touch(s):
    s.measured(s.rows(before=s.random.randint(8, 20), zero=s.either_sign(0.01, 0.08)))
    return s.fit()


@kind()
def tare_small(s):
    """No row before touch tells it."""
    s.measured(s.rows(zero=s.either_sign(0, 0.015)))
    return s.fit()


@kind("either")
def tare_large(s):
    s.measured(s.rows(zero=s.either_sign(0.05, 0.15)))
    return s.fit()


@kind()
def zero_fitted(s):
    s.measured(s.rows(zero=s.either_sign(0.01, 0.1)))
    return s.fit(rig='{force_offset="fit"}')


@kind()
def touch_far(s):
    """From the machine's zero."""
    s.touch = s.either_sign(5, 30)
    s.measured(s.rows())
    return s.fit()


@kind()
def late_start(s):
    """The first row is pressed already."""
    s.measured(s.rows(first=s.random.uniform(0.1, 0.3)))
    return s.fit()


@kind()
def shallow(s):
    s.deepest = 0.3
    s.measured(s.rows())
    return s.fit()


@kind("either")
def backlash(s):
    """At the beginning the finger is pressed a little and the drive turns without moving it."""
    rows, lost = s.rows(first=s.random.uniform(0.03, 0.15)), s.random.uniform(0.05, 0.2)
    still = [(rows[0][0] + lost * i / 5, rows[0][1]) for i in range(5)]
    s.measured(still + [(x + lost, f) for x, f in rows])
    return s.fit()


def drifting(s, course, rig=None):
    """course: the zero at a share of the time, over its last value."""
    end = s.either_sign(0.05, 0.15)

    def drifted(strength):
        rows = s.rows()
        return [[(x, f + strength * end * rows[-1][1] * course(i / (len(rows) - 1)))
                 for i, (x, f) in enumerate(rows)]]

    s.measured(drifted(1.0)[0] if rig else s.showing(drifted)[0], seconds=2)
    return s.fit(rig=rig)


@kind(False, "drift|force_offset")  # one press hardly tells them apart: both are the cell's zero
def drift(s):
    return drifting(s, lambda share: share)


@kind(False, "drift|force_offset")  # what has settled is an offset
def drift_to_plateau(s):
    time = s.random.uniform(0.1, 0.5)
    return drifting(s, lambda share: math.expm1(-share / time) / math.expm1(-1 / time))


@kind()
def drift_fitted(s):
    return drifting(s, lambda share: share, rig='{drift="fit"}')


@kind("either")
def zero_jumps(s):
    """Once, on the way."""
    jump, place = s.either_sign(0.03, 0.1), s.random.uniform(0.2, 0.8)
    rows = s.rows()
    s.measured([(x, f + jump * rows[-1][1] * (i > place * s.count))
                for i, (x, f) in enumerate(rows)])
    return s.fit()


# The machine.

kind = kinds_of("presses", "machine")


@kind()
def compliance_small(s):
    """Nobody tells it; 2 to 30 % of the finger's at the end."""
    compliance = s.random.uniform(0.002, 0.04)
    s.stiffness_for(compliance, s.between(0.02, 0.3))
    s.measured(s.rows(compliance=compliance))
    return s.fit()


def given_compliance(s):
    compliance = s.random.uniform(0.01, 0.2)
    s.stiffness_for(compliance, s.between(0.05, 0.6))
    s.measured(s.rows(compliance=compliance))
    return compliance


@kind()
def compliance_fitted(s):
    given_compliance(s)
    return s.fit(rig='{compliance="fit"}')


@kind()
def compliance_given(s):
    return s.fit(rig=f'{{compliance="{given_compliance(s):.6g} mm/N"}}')


@kind()
def compliance_of_blank(s):
    compliance = given_compliance(s)
    largest = s.force(s.deepest)
    s.measured([(0.3 + compliance * largest * i / 30, largest * i / 30) for i in range(31)],
               "blank.csv")
    return s.fit(rig=f'{{blank="{s.folder / "blank.csv"}"}}')


@kind(False, "compliance")
def compliance_beyond(s):
    compliance = s.random.uniform(0.1, 0.3)
    s.stiffness_for(compliance, s.between(0.2, 1.0))
    s.measured(s.showing(lambda strength: [s.rows(compliance=strength * compliance)])[0])
    return s.fit()


@kind("either")
def grips_seat(s):
    """They give way at first."""
    way, force = s.random.uniform(0.05, 0.2), s.random.uniform(0.1, 0.3) * s.force(s.deepest)
    s.measured([(x + way * -math.expm1(-f / force), f) for x, f in s.rows()])
    return s.fit()


@kind(False, r"\bplay\b|lag\b")
def play(s):
    def there_and_back(strength):
        return [s.rows() + [(x - strength * lost, f) for x, f in reversed(s.rows())]]

    lost = s.random.uniform(0.05, 0.15)
    s.measured(s.showing(there_and_back)[0])
    return s.fit()


@kind()
def clipped(s):
    """The load cell ends."""
    s.count = s.random.randint(40, 80)
    limit = s.random.uniform(0.75, 0.93) * s.force(s.deepest)
    rows = s.rows()
    noisy = [(x, min(f, limit)) for x, f in s.noisy(rows)]
    s.write("a.csv", noisy, [e for _, _, e in s.uncertain(rows)])
    return s.fit()


@kind()
def hold(s):
    """On the way, 40 rows at one place."""
    rows = s.rows()
    place = s.random.randint(s.count // 3, 2 * s.count // 3)
    s.measured(rows[:place] + [rows[place]] * 40 + rows[place:], seconds=0.5)
    return s.fit()


@kind()
def second_loading(s):
    """Behind the way back."""
    rows = s.rows()
    s.measured(rows + rows[-2::-1] + rows[1:])
    return s.fit()


@kind()
def gap(s):
    """Rows are lost."""
    s.count = s.random.randint(25, 60)
    rows, begin = s.rows(), s.random.randint(3, 10)
    s.measured(rows[:begin] + rows[begin + s.random.randint(5, 12):])
    return s.fit()


# Contact and shape.

kind = kinds_of("presses", "contact and shape")


@kind()
def contact_open(s):
    s.contact = s.random.choice(CONTACTS)
    s.finger = s.random.choice([{}, SIXTH])
    s.measured(s.rows())
    return s.fit(contact=None)


@kind()
def ball(s):
    s.finger = {"further": BALL}
    s.measured(s.rows())
    return s.fit()


@kind()
def thin(s):
    s.contact, s.finger = "stick", THIN
    s.measured(s.rows())
    return s.fit(contact="stick")


@kind()
def two_fingers(s):
    return s.fit_two_fingers(s.rows(), s.rows(law=lambda d: s.force(d, finger=SIXTH)))


@kind()
def moduli_of_two_contacts(s):
    """A thin layer that sticks resists by its bulk, one that slips does not: both tell nu."""
    s.ratio, s.deepest, s.finger = 0.45, 2.0, SIXTH  # where they do
    s.noise, s.floor = 0.002, 0.05
    for s.contact in CONTACTS:
        s.measured(s.rows(), f"{s.contact}.csv")
    (s.folder / "both.toml").write_text("".join(
        f'[[press]]\npath = "{contact}.csv"\ncondition = "press.contact={contact}"\n'
        for contact in CONTACTS))
    s.truths = {"youngs_modulus": 1e3 * s.modulus,
                "shear_modulus": 1e3 * s.modulus / 2 / (1 + s.ratio)}
    return s.fit("both.toml", contact=None, further=[
        'calibration.parameters=["youngs_modulus","shear_modulus"]'])


@kind()
def ratio_untold(s):
    """Poisson's: E alone is told."""
    s.ratio = s.random.choice([0.45, 0.47, 0.495])
    s.measured(s.rows())
    return s.fit(ratio="untold")


@kind()
def ratio_in_a_range(s):
    s.ratio, s.finger = s.random.choice([0.42, 0.45, 0.47]), s.random.choice([{}, SIXTH, THIN])
    s.measured(s.rows())
    return s.fit(ratio=0.45, further=["calibration.poisson_range=[0.41,0.48]"])


@kind()
def size_in_tolerance(s):
    """Rod and tip are not quite as told, by normal distributions that their owner knows."""
    off = [s.random.gauss(0, 1) for _ in range(2)]
    tolerances = s.random.uniform(0.05, 0.3), s.random.uniform(0.05, 0.2)
    sizes = [round(size + deviation * e, 1)
             for size, deviation, e in zip((5, 10), tolerances, off)]
    told = {"rod": "5 mm", "tip": "10 mm"}
    true = {part: f"{size:g} mm" for part, size in zip(told, sizes)}
    s.measured(s.rows(law=lambda d: s.force(d, finger=true)))
    fields = ", ".join(f'{part}_radius="{e} mm"' for part, e in zip(told, tolerances))
    return s.fit(finger=told, further=[f"calibration.tolerances={{{fields}}}"])


@kind(False, "(?i)another rubber|poisson")
def wrong_ratio(s):
    """Of two fingers: one does not tell it."""
    s.ratio = s.random.choice([0.3, 0.45])
    told = 0.75 - s.ratio
    return s.fit_two_fingers(*s.showing(
        lambda _: [s.rows(), s.rows(law=lambda d: s.force(d, finger=THIN))],
        s.curve(ratio=told), s.curve(ratio=told, finger=THIN)), ratio=told, rod=THIN["rod"])


def wrongly_in_contact(s, truth, told):
    s.ratio, s.deepest, s.finger = 0.45, 2.0, THIN  # where it shows
    s.noise, s.contact = s.between(0.002, 0.005), truth
    s.measured(s.showing(lambda _: [s.rows()], s.curve(told))[0])
    return s.fit(contact=told)


@kind(False, "sticking")
def wrong_contact(s):
    return wrongly_in_contact(s, "stick", "frictionless")


@kind(False, "slip")
def slips(s):
    return wrongly_in_contact(s, "frictionless", "stick")


@kind(False, "slip|another rubber")
def slips_of_two(s):
    """Fingers, which it makes differ."""
    s.ratio, s.deepest, s.noise = 0.45, 2.0, s.between(0.002, 0.01)
    return s.fit_two_fingers(*s.showing(
        lambda _: [s.rows(), s.rows(law=lambda d: s.force(d, finger=THIN))],
        s.curve("stick"), s.curve("stick", finger=THIN)), contact="stick", rod=THIN["rod"])


@kind(False, "slip")
def slip_begins_late(s):
    """It sticks at first."""
    s.ratio, s.deepest, s.finger = 0.45, 2.0, THIN
    s.noise, begins = s.between(0.002, 0.005), s.random.uniform(0.3, 0.6)

    def blended(depth):
        slipped = max(0.0, (s.share(depth) - begins) / (1 - begins))
        return sum(part * s.force(depth, contact=contact) for contact, part in
                   (("stick", 1 - slipped), ("frictionless", slipped)))

    s.measured(s.showing(lambda _: [s.rows(law=blended)], s.curve("stick"))[0])
    return s.fit(contact="stick")


SHAPE = "stiffening|(?i:shape|thickness|obstacle|radius)"  # a thinner layer is stiffer with depth


@kind(False, SHAPE)
def wrong_height(s):
    """The rod is thicker than told."""
    s.deepest = 2.0
    s.measured(s.showing(
        lambda _: [s.rows(law=lambda d: s.force(d, finger=THIN))])[0])
    return s.fit()


@kind(False, SHAPE)
def wrong_tip(s):
    s.deepest = 2.0
    s.measured(s.showing(
        lambda _: [s.rows(law=lambda d: s.force(d, finger={"tip": "8 mm"}))])[0])
    return s.fit()


@kind("either")
def adhesion(s):
    """Johnson, Kendall and Roberts, of the contact that has the force H without it, at the depth h:
    F = H - 2 sqrt(P H), depth h (1 - 4/3 sqrt(P/H)), pull-off force P. It jumps into contact."""
    most = s.force(s.deepest)
    pull = s.random.uniform(0.02, 0.05) * most * 9 / 8  # which is -8/9 P where it touches
    rows = []
    for i in range(s.count):
        depth = s.deepest * (i + 1) / s.count
        low, high = 0.0, 2 * s.deepest
        for _ in range(50):
            middle = 0.5 * (low + high)
            pressed = s.force(middle)
            there = middle * (1 - 4 / 3 * math.sqrt(pull / pressed))
            low, high = (middle, high) if there < depth else (low, middle)
        rows.append((s.touch + depth, s.force(low) - 2 * math.sqrt(pull * s.force(low))))
    if s.random.random() < 0.5:
        step = s.deepest / s.count
        rows = [(s.touch - step * i, 0.0) for i in range(10, 0, -1)] + rows
    s.measured(rows)
    return s.fit()


@kind("either")
def grain(s):
    """A soft grain on the tip is met first and has sunk in when the tip has come to it."""
    height, force = s.random.uniform(0.05, 0.2), s.random.uniform(0.01, 0.04) * s.force(s.deepest)
    step = s.deepest / s.count
    depths = [step * (i + 1) for i in range(-math.ceil(height / step), s.count)]
    s.measured([(s.touch + d, s.force(d) + force * min(1.0, max(0.0, 1 + d / height)))
                for d in depths])
    return s.fit()


# The rubber.

kind = kinds_of("presses", "rubber")


@kind(False, "stiffening")
def negative_compliance(s):
    growth = s.random.uniform(0.15, 0.4)
    s.measured(s.showing(lambda strength: [s.rows(
        law=lambda d: s.force(d) * (1 + strength * growth * s.share(d)**3))])[0])
    return s.fit()


@kind(False, "stiffening")
def layered(s):
    """A hard layer that is reached at some depth."""
    growth, reached = s.random.uniform(0.2, 0.5), s.random.uniform(0.3, 0.6)
    s.measured(s.showing(lambda strength: [s.rows(
        law=lambda d: s.force(d) * (1 + strength * growth * max(0.0, s.share(d) - reached)))])[0])
    return s.fit()


@kind(False, "compliance|soften|relaxation")
def softening(s):
    """It yields with depth, as if the machine did."""
    loss = s.random.uniform(0.1, 0.3)
    s.measured(s.showing(lambda strength: [s.rows(
        law=lambda d: s.force(d) / (1 + strength * loss * s.share(d)**2))])[0])
    return s.fit()


@kind("either")
def another_law(s):
    """Gent's, whose chains end; at rest the same E."""
    s.finger = {"further": ("rubber.law=gent", "rubber.volumetric=quadratic",
                            f"rubber.gent_jm={s.random.choice([1, 3])}")}
    rows = s.rows()
    s.finger = {}
    s.measured(rows)
    return s.fit()


@kind(False, "another rubber")
def two_rubbers(s):
    """Any modulus between is right."""
    ratio = s.random.choice([0.7, 1.3, 1.5])
    other = []

    def presses(strength):
        other[:] = [ratio**strength * s.modulus]
        return [s.rows(), s.rows(law=lambda d: ratio**strength * s.force(d, finger=SIXTH))]

    rows = s.showing(presses, s.curve(), s.curve(finger=SIXTH))
    s.truths = {"modulus": tuple(1e3 * e for e in sorted([s.modulus] + other))}
    return s.fit_two_fingers(*rows)


@kind(False, "relax|hold")
def relaxes(s):
    """It is held on the way, sinks, and is pressed on. Between the moduli at once and after long
    times any is right."""
    fades, time, speed = s.random.uniform(0.15, 0.4), s.between(3, 20), s.deepest / 20  # [mm/s]
    rest = s.rows()
    place, branch, before, rows = len(rest) // 2, 0.0, 0.0, []
    for row in rest[:place] + [rest[place - 1]] * 40 + rest[place:]:
        x, f = row
        held = bool(rows) and x == rows[-1][0]
        step = 0.5 if held else (x - (rows[-1][0] if rows else s.touch)) / speed
        branch = branch * math.exp(-step / time) + fades / (1 - fades) * (f - before)
        before = f
        rows.append((x, f + branch, step))
    clock, times = 0.0, []
    for _, _, step in rows:
        clock += step
        times.append(clock)
    s.tells_sigma = False
    noisy = s.noisy([row[:2] for row in rows])
    s.table("a.csv", ["time [s]", "position [mm]", "force [N]"],
            [(t, *row) for t, row in zip(times, noisy)])
    s.truths = {"modulus": (1e3 * s.modulus, 1e3 * s.modulus / (1 - fades))}
    return s.fit()


@kind()
def hysteresis(s):
    """The way back is softer; the loop takes 5 to 20 % of the work."""
    rows = s.rows()
    lost = s.random.uniform(0.05, 0.2) / 0.27
    back = [(x, f * (1 - lost * (1 - s.share(x - s.touch)))) for x, f in reversed(rows)]
    s.measured(rows + back[1:])
    return s.fit()


@kind("either")
def repeats_soften(s):
    """As it is pressed again and again; any of their moduli is right."""
    left = s.random.uniform(0.75, 0.95)
    factors = [left + (1 - left) * math.exp(-i) for i in range(4)]
    s.truths = {"modulus": (1e3 * s.modulus * factors[-1], 1e3 * s.modulus)}
    return fit_repeats(s, factors)
