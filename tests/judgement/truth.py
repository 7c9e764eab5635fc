"""What a press is in truth, and whether a fault in its rows shows."""

import bisect
import csv
import math
import os
import re
import subprocess
import threading

DEPTHS = [0.03, 0.06] + [0.1 * i for i in range(1, 21)]  # [mm]
SHOWN_SIGMAS, SHOWN_SHARE = 3.0, 0.02


class Bench:
    """Runs the program in a folder of its own, with a cache of its own."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.tables, self.pressing = {}, threading.Lock()
        self.environment = os.environ | {"XDG_CACHE_HOME": str(folder / "cache")}

    def run(self, verb, settings, out):
        sets = [word for setting in settings for word in ("--set", setting)]
        return subprocess.run([self.program, verb, "--out", str(out), *sets], cwd=self.folder,
                              env=self.environment, capture_output=True, text=True)

    def place(self, contact, ratio, rod="5 mm", tip="10 mm", further=()):
        """Folder of a press of 100 kPa; further: settings."""
        name = "_".join([contact, str(ratio), rod, tip, *further])
        return self.folder / re.sub(r"[^A-Za-z0-9._]+", "", name)

    def press(self, contact, ratio, rod="5 mm", tip="10 mm", further=()):
        """[(depth [mm], force [mN])] of 100 kPa."""
        out = self.place(contact, ratio, rod, tip, further)
        with self.pressing:
            if out in self.tables:
                return self.tables[out]
            if not (out / "response.csv").exists():
                samples = ",".join(f'"{depth:.4g} mm"' for depth in DEPTHS)
                run = self.run("reference", [
                    f"press.contact={contact}", f"rubber.poissons_ratio={ratio}",
                    'rubber.youngs_modulus="100 kPa"', f'geometry.rod_radius="{rod}"',
                    f'geometry.tip_radius="{tip}"', "press.mode=static", "reference.strain=finite",
                    "reference.fields=false", f"press.samples=[{samples}]", *further], out)
                if run.returncode != 0:
                    raise RuntimeError(run.stderr)
            with open(out / "response.csv", newline="") as file:
                self.tables[out] = [(1e3 * float(row["indentation [m]"]),
                                     1e3 * float(row["normal_force [N]"]))
                                    for row in csv.DictReader(file)]
            return self.tables[out]


def force_at(table, depth):
    """Between depths, and beyond them, a power of the depth."""
    if depth <= 0:
        return 0.0
    after = min(max(1, bisect.bisect_left(table, (depth, 0.0))), len(table) - 1)
    (d, f), (e, g) = table[after - 1], table[after]
    return f * (depth / d) ** (math.log(g / f) / math.log(e / d))


def least(function, low, high):
    """Where a function is least: on a grid, then by thirds."""
    step = (high - low) / 40
    best = min((low + i * step for i in range(41)), key=function)
    low, high = best - step, best + step
    while high - low > 1e-5:
        third = (high - low) / 3
        if function(low + third) < function(high - third):
            high -= third
        else:
            low += third
    return 0.5 * (low + high)


# What a machine may be though nobody tells it: compliances [mm/N], zeros over the largest force.
COMPLIANCES, ZEROS = (0.0, 0.01, 0.02, 0.03, 0.04), (-0.002, 0.0, 0.002)


def left_over(presses):
    """What the best common scale and machine and the best touch of each press leave of rows:
    [(force, sigma, rest)].

    presses: [(rows (position, force, sigma), table of the truth without the fault)].
    """
    found = []
    for compliance in COMPLIANCES:
        for zero in ZEROS:
            moved = []
            for rows, table in presses:
                largest = max(abs(force) for _, force, _ in rows)
                moved.append(([(x - compliance * f, f - zero * largest, e) for x, f, e in rows], table))
            found.append(left_by_a_machine(moved))
    return min(found, key=lambda rests: sum((rest / e)**2 for _, e, rest in rests))


def left_by_a_machine(presses):
    """The same of a rigid, tared one."""
    touches = [rows[0][0] - table[0][0] for rows, table in presses]

    def products(k, touch):
        rows, table = presses[k]
        model = [force_at(table, x - touch) / e for x, _, e in rows]
        told = [f / e for _, f, e in rows]
        return (sum(m * m for m in model), sum(m * t for m, t in zip(model, told)),
                sum(t * t for t in told))

    def scale_of(parts):
        return sum(p[1] for p in parts) / max(1e-300, sum(p[0] for p in parts))

    for _ in range(1 if len(presses) == 1 else 8):
        for k in range(len(presses)):
            others = [products(i, touches[i]) for i in range(len(presses)) if i != k]

            def left(touch):
                parts = others + [products(k, touch)]
                return sum(p[2] for p in parts) - scale_of(parts) * sum(p[1] for p in parts)

            touches[k] = least(left, touches[k] - 0.5, touches[k] + 0.5)
    scale = scale_of([products(k, touch) for k, touch in enumerate(touches)])
    return [(f, e, f - scale * force_at(table, x - touch))
            for (rows, table), touch in zip(presses, touches) for x, f, e in rows]


def misses(rests):
    """Whether a row is missed by what has to show."""
    return any(abs(rest) > max(SHOWN_SIGMAS * e, SHOWN_SHARE * abs(f)) for f, e, rest in rests)


def share_missed(rests):
    """Root mean square of what is left over the largest force."""
    return (math.sqrt(sum(rest**2 for _, _, rest in rests) / len(rests))
            / max(abs(f) for f, _, _ in rests))
