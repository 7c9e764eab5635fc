#!/usr/bin/env python3
"""Samples the posterior of E of one press, by Metropolis: nothing in common with the program.

    tests/judgement/posterior_sampler.py a.csv --table response.csv [--steps 40000] [--seed 1]

a.csv: position [mm];force [N] and perhaps sigma [N]. --table: the press without dirt, of 100 kPa,
as the verb `reference` writes it. Prints median and 95 % interval of E [Pa], then the medians of
all that is sought, the share of steps taken and how many samples are as good as independent.

A row has the force z + E f(u) + d(u) + noise at the position t + u + c E f(u), where t is the touch
(flat prior), z the force's zero (Cauchy, of 0.1 % of the largest force, flat where five rows or more
lie before the touch), c the machine's compliance (half of Cauchy, of 0.02 mm/N). The noise is the
told sigma (within a factor of 1.35), or the largest force times anything. d is what the model
leaves out: Gaussian, F times one function and 0.1 F_max times another, each of deviation s and
correlated by exp(-(u - u')²/(2 0.5²)) of depths over the largest one; s has half a Cauchy prior, of
0.01. d is part of the covariance.
"""

import argparse
import csv
import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices
try:
    import numpy as np
except ImportError:
    sys.exit("numpy is missing: run it with a python3 that has it, or install python3-numpy")

ZERO, COMPLIANCE, LEFT_OUT, LENGTH, NEAR_TOUCH, TOLD = 0.001, 0.02, 0.01, 0.5, 0.1, 0.3
MOST_ROWS, FEWEST_BEFORE = 50, 5


def columns(path, separator, *names):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file, delimiter=separator))
    return [np.array([float(row[name]) for row in rows]) if name in rows[0] else None
            for name in names]


def binned(x, force, sigma):
    """At most so many rows: means of neighbours."""
    parts = np.array_split(np.arange(len(x)), min(len(x), MOST_ROWS))
    many = np.array([len(part) for part in parts])
    return [np.array([values[part].mean() for part in parts]) for values in (x, force)] + [
        np.array([sigma[part].mean() for part in parts]) / np.sqrt(many)]


class Posterior:
    """Of ln E, touch, zero, compliance, ln of the noise's factor, ln s."""

    def __init__(self, x, force, sigma, depth, pure):
        self.largest, self.told = force.max(), sigma is not None
        sigma = np.full(len(x), self.largest) if sigma is None else sigma
        self.x, self.force, self.sigma = binned(x, force, sigma)
        power = np.log(pure[1] / pure[0]) / np.log(depth[1] / depth[0])
        fine = np.linspace(0.0, 1.0, 400)**2 * depth[-1]
        inside = np.exp(np.interp(np.log(np.maximum(fine, 1e-9)), np.log(depth), np.log(pure)))
        self.fine = fine
        self.pure = np.where(fine < depth[0], pure[0] * (fine / depth[0])**power, inside)
        self.before = None  # whether rows before touch tell the zero

    def start(self):
        """Scale and touch by least squares over a grid."""
        best = None
        for touch in np.linspace(self.x[0] - 1.0, self.x[-1] - 0.3 * (self.x[-1] - self.x[0]), 400):
            model = np.interp(self.x - touch, self.fine, self.pure)
            if self.x[-1] - touch > self.fine[-1] or model @ model == 0:
                continue
            scale = model @ self.force / (model @ model)
            rest = np.sum((self.force - scale * model)**2)
            if scale > 0 and (best is None or rest < best[0]):
                best = (rest, scale, touch)
        rest, scale, touch = best
        self.before = np.sum(self.x < touch) >= FEWEST_BEFORE
        noise = 1.0 if self.told else np.sqrt(rest / len(self.x)) / np.median(self.sigma)
        return np.array([np.log(scale), touch, 0.0, 0.005, np.log(max(noise, 1e-5)), np.log(0.003)])

    def at(self, place):
        """Logarithm of the density, but for a constant."""
        ln_scale, touch, zero, compliance, ln_noise, ln_left_out = place
        if compliance < 0 or ln_left_out < -14:
            return -np.inf
        pressed = np.exp(ln_scale) * self.pure
        depth = np.interp(self.x - touch, self.fine + compliance * pressed, self.fine)
        if self.x[-1] - touch > self.fine[-1] + compliance * pressed[-1]:
            return -np.inf
        model = np.interp(depth, self.fine, pressed)
        left_out = np.exp(ln_left_out)
        share = depth / max(depth[-1], 1e-9)
        touched = NEAR_TOUCH * model[-1] * (model > 0)
        covariance = left_out**2 * (np.outer(model, model) + np.outer(touched, touched)) * np.exp(
            -np.subtract.outer(share, share)**2 / (2 * LENGTH**2))
        covariance[np.diag_indices_from(covariance)] += (np.exp(ln_noise) * self.sigma)**2
        try:
            factor = np.linalg.cholesky(covariance)
        except np.linalg.LinAlgError:
            return -np.inf
        white = np.linalg.solve(factor, self.force - zero - model)
        density = -0.5 * white @ white - np.sum(np.log(np.diag(factor)))
        density -= np.log1p((compliance / COMPLIANCE)**2)
        if not self.before:
            density -= np.log1p((zero / (ZERO * self.largest))**2)
        if self.told:
            density -= 0.5 * (ln_noise / TOLD)**2
        return density + ln_left_out - np.log1p((left_out / LEFT_OUT)**2)  # of s as ln s


def chain(posterior, steps, numbers):
    """Metropolis; the proposal follows the covariance of what was seen in the first third."""
    place = posterior.start()
    density = posterior.at(place)
    factor = np.diag([0.01, 0.005, 0.002 * posterior.largest, 0.003, 0.1, 0.3])
    seen, taken, burnt = [], 0, steps // 3
    for step in range(steps):
        if step and step <= burnt and step % 500 == 0:
            spread = np.cov(np.array(seen[len(seen) // 2:]).T)
            factor = np.linalg.cholesky(spread + 1e-12 * np.diag(np.diag(spread) + 1e-12))
        size = 0.2 if numbers.random() < 0.2 else 2.4 / np.sqrt(6)
        other = place + size * factor @ numbers.standard_normal(6)
        there = posterior.at(other)
        if np.log(numbers.random()) < there - density:
            place, density, taken = other, there, taken + (step >= burnt)
        seen.append(place)
    return np.array(seen[burnt:]), taken / (steps - burnt)


def independent(values):
    """How many: batch means."""
    batches = np.array_split(values, 30)
    between = np.var([batch.mean() for batch in batches], ddof=1)
    return len(values) if between == 0 else min(len(values), 30 * np.var(values) / between)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("press")
    arguments.add_argument("--table", required=True)
    arguments.add_argument("--steps", type=int, default=40000)
    arguments.add_argument("--seed", type=int, default=1)
    options = arguments.parse_args()
    depth, pure = columns(options.table, ",", "indentation [m]", "normal_force [N]")
    x, force, sigma = columns(options.press, ";", "position [mm]", "force [N]", "sigma [N]")
    posterior = Posterior(x, force, sigma, 1e3 * depth, pure)
    samples, taken = chain(posterior, options.steps, np.random.default_rng(options.seed))
    lower, median, upper = 1e5 * np.exp(np.quantile(samples[:, 0], [0.025, 0.5, 0.975]))
    print(f"{median:.6g} {lower:.6g} {upper:.6g} Pa")
    names = ["ln E/100 kPa", "touch [mm]", "zero [N]", "compliance [mm/N]", "ln noise", "ln s"]
    print("; ".join(f"{name} {value:.4g}" for name, value in
                    zip(names, np.median(samples, axis=0))))
    print(f"{100 * taken:.0f} % of the steps taken; as good as "
          f"{independent(samples[:, 0]):.0f} independent samples")


if __name__ == "__main__":
    main()
