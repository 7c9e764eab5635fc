"""Soft fingertips: a lattice of masses and springs against the continuum.

    import fingertip
    lattice = fingertip.press(press_mode="static", lattice_spacing="tip_radius/12")
    continuum = fingertip.reference()
    lattice.to_dataframe()

Every key of the configuration is a keyword argument (`fingertip.keys`); results are the program's,
in the same folders and from the same cache. SI throughout.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any, Mapping, Sequence

from . import _core
from ._core import Contact, Measurement, Target, Wrench
from .errors import (
    CannotWrite,
    ConfigError,
    ControllerFailed,
    Error,
    NotConverged,
    Problem,
    ProcessLost,
    TestsFailed,
)
from .runs import SLOPES, Calibration, Comparison, Presses, Response, Run
from .settings import Key, config_file, described, keys, literal, sections, sets
from .tables import Table, read_csv

__all__ = [
    "Calibration", "CannotWrite", "Comparison", "ConfigError", "Contact", "ControllerFailed", "Error",
    "Finger", "Key", "Measurement", "NotConverged", "Presses", "Problem", "ProcessLost", "Response", "Run", "Table",
    "Target", "TestsFailed", "Wrench", "calibrate", "check", "compare", "export", "grasp", "keys", "modes", "press", "presses",
    "read_csv", "reference", "run", "sections", "validate",
]  # fmt: skip


def _fresh(verb: str) -> str:
    """A folder that is not there yet, as the program would choose it."""
    stem = f"runs/{verb}-{time.strftime('%Y%m%d-%H%M%S')}"
    folder, number = stem, 2
    while os.path.exists(folder):
        folder, number = f"{stem}-{number}", number + 1
    return folder


def _run(kind, verb, arguments, config, settings, out, force, resume, quiet, ranks, further, options={}):
    out = os.fspath(out) if out is not None else _fresh(verb)
    code = _core.run(verb, [os.fspath(word) for word in arguments], config_file(config), sets(settings, further),
                     out, force, resume, quiet, ranks, **options)  # fmt: skip
    result = kind(out)
    if code == 3:
        raise NotConverged("; ".join(result.warnings) or f"not converged: {out}", result)
    if code == 4:
        failed = result.result.get("failed", []) if isinstance(result, Calibration) else [
            criterion["name"] for criterion in result.summary.get("criteria", []) if not criterion["passed"]
        ]  # fmt: skip
        raise TestsFailed("; ".join(map(str, failed)) or f"tests failed: {out}", result)
    result._warn()
    return result


def press(settings: Mapping[str, Any] | None = None, *, slopes: Sequence[str] = (), config=None, out=None,
          force=False, resume=False, quiet=True, **further) -> Response:  # fmt: skip
    """Presses the lattice. `slopes`: keys by which `press.slopes[key]` then has the exact derivatives of the
    normal force at rest: rubber.youngs_modulus (Poisson's ratio held), rubber.poissons_ratio (E held)."""
    if unknown := [name for name in slopes if name not in SLOPES]:
        raise ConfigError([("slopes", str(name), "", "no exact slope is known by this key",
                            "choose among " + ", ".join(SLOPES)) for name in unknown])  # fmt: skip
    if slopes:
        further["press_slopes"] = True
    return _run(Response, "press", [], config, settings, out, force, resume, quiet, 1, further)


def presses(points: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]],
            settings: Mapping[str, Any] | None = None, *, config=None, out=None, resume=False, quiet=False, threads=0,
            **further) -> Presses:  # fmt: skip
    """Presses the lattice with every combination of values, {"section.key": [values]}, or with each of a list of
    settings, [{"section.key": value}, ...], `threads` at a time (0: as many as there are cores): the verb sweep.
    What did not converge is left out, and told."""
    grid = isinstance(points, Mapping)
    if wrong := [key for key in points if grid and (isinstance(points[key], str) or not hasattr(points[key], "__len__"))]:
        raise ConfigError([(key, str(points[key]), "", "an axis is a list of values", "put it into brackets")
                           for key in wrong])  # fmt: skip
    axes = sets(points, {}) if grid else ["sweep.points=" + literal(list(points))]
    folder = os.fspath(out) if out is not None else _fresh("sweep")
    given = sets(settings, further) + axes + ([f"run.threads={threads}"] if threads else [])
    code = _core.run("sweep", ["press"], config_file(config), given, folder, False, resume, quiet, 1)
    result = Presses(folder)
    if code == 3:
        missing = int((result.samples["status"] != "finished").sum())
        raise NotConverged(f"{missing} of {result.samples.rows} presses did not converge: {folder}", result)
    return result


def reference(settings: Mapping[str, Any] | None = None, *, config=None, out=None, force=False, resume=False,
              quiet=True, ranks=1, **further) -> Response:  # fmt: skip
    """Presses the continuum; forces have error bars."""
    return _run(Response, "reference", [], config, settings, out, force, resume, quiet, ranks, further)


def calibrate(settings: Mapping[str, Any] | None = None, *, config=None, out=None, force=False, resume=False,
              quiet=True, **further) -> Calibration:  # fmt: skip
    """Fits constants or moduli (calibration_problem)."""
    return _run(Calibration, "calibrate", [], config, settings, out, force, resume, quiet, 1, further)


def modes(settings: Mapping[str, Any] | None = None, *, config=None, out=None, force=False, resume=False,
          quiet=True, **further) -> Run:  # fmt: skip
    """Natural frequencies of the lattice."""
    return _run(Run, "modes", [], config, settings, out, force, resume, quiet, 1, further)


def grasp(settings: Mapping[str, Any] | None = None, *, config=None, out=None, force=False, resume=False,
          quiet=True, **further) -> Run:  # fmt: skip
    """Two fingers hold a block."""
    return _run(Run, "grasp", [], config, settings, out, force, resume, quiet, 1, further)


def validate(case: str | os.PathLike = "01", *, settings: Mapping[str, Any] | None = None, out=None, force=False,
             resume=False, quiet=True, **further) -> Run:  # fmt: skip
    """Runs a case and judges it by its criteria."""
    return _run(Run, "validate", [case], None, settings, out, force, resume, quiet, 1, further)


def compare(*runs: Run | str | os.PathLike, out=None, force=False) -> Comparison:
    """Sets the force curves of runs beside each other, the continuum's first."""
    folders = [run.folder if isinstance(run, Run) else run for run in runs]
    return _run(Comparison, "compare", folders, None, None, out, force, False, True, 1, {})


def export(format: str, settings: Mapping[str, Any] | None = None, *, config=None, out=None, force=False,
           lossy=False, quiet=True, **further) -> Run:  # fmt: skip
    """Writes the finger for another program; `lossy`: although not all of it can be said there."""
    options = {"format": format, "lossy": lossy}
    return _run(Run, "export", [], config, settings, out, force, False, quiet, 1, further, options)


def check(settings: Mapping[str, Any] | None = None, *, config=None, **further) -> None:
    """Raises ConfigError with all problems of the settings."""
    _core.check(config_file(config), sets(settings, further))


def run(verb: str, *arguments: str | os.PathLike, settings: Mapping[str, Any] | None = None, config=None, out="",
        force=False, resume=False, quiet=False, ranks=1, **further) -> int:  # fmt: skip
    """Any verb as on the command line; its exit code."""
    return _core.run(verb, [os.fspath(word) for word in arguments], config_file(config), sets(settings, further),
                     os.fspath(out), force, resume, quiet, ranks)  # fmt: skip


class Finger(_core.Finger):
    """The finger of a press, to be stepped in a control loop of one's own.

        finger = fingertip.Finger(lattice_spacing="tip_radius/8")
        seen = finger.reset()
        while finger.indentation < finger.depth:
            seen = finger.step(finger.target(seen.time))

    A step takes a Wrench at the rod's endpoint, or a Target for the built-in servo, holds it for
    one period (controller_period) and returns the next Measurement. Sensors, actuators and their
    delays are those of the section hardware.
    """

    def __init__(self, settings: Mapping[str, Any] | None = None, *, config=None, **further):
        super().__init__(config_file(config), sets(settings, further))


for _verb in (press, reference, calibrate, modes, grasp):
    _verb.__doc__ = described(_verb.__doc__ + """

    settings: {"section.key": value} or {"section": {"key": value}}; keyword arguments
    (section_key=value) count after them, both after `config`, a TOML file. `out`: folder of the
    run, else a new one below runs/. Raises ConfigError, NotConverged, TestsFailed,
    ControllerFailed, CannotWrite; Ctrl-C ends it with KeyboardInterrupt and keeps what is done.
    """)
del _verb
