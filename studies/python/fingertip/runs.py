"""What the verbs leave: a folder, read as it is asked for."""

from __future__ import annotations

import html
import json
import os
import warnings
from functools import cached_property
from pathlib import Path

import numpy as np

from . import _core
from .errors import ConfigError
from .tables import Table, compiled, read_csv


# Keys by which exact slopes of a force are known, and the columns that have them.
SLOPES = {"rubber.youngs_modulus": "slope_youngs_modulus", "rubber.poissons_ratio": "slope_poissons_ratio"}


class Run:
    """A finished run: its folder, and what is in it."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ConfigError([(str(folder), "", "", "there is no such folder", "give that of a run")])

    @cached_property
    def summary(self) -> dict:
        """summary.json; SI."""
        file = self.folder / "summary.json"
        return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}

    @cached_property
    def manifest(self) -> dict:
        """manifest.json: what was run, when and by which version."""
        return json.loads((self.folder / "manifest.json").read_text(encoding="utf-8"))

    @property
    def warnings(self) -> list[str]:
        return self.summary.get("warnings", [])

    def table(self, name: str) -> Table:
        """Any table of the folder, "convergence" or "convergence.csv"."""
        file = self.folder / (name if name.endswith(".csv") else name + ".csv")
        if not file.exists():
            there = sorted(path.stem for path in self.folder.glob("*.csv"))
            raise KeyError(f"{name}; there are {', '.join(there) or 'no tables'}")
        if file.name == "response.csv":
            return compiled(_core.ResponseTable(file))
        if file.name == "trace.csv":
            return compiled(_core.TraceTable(file))
        return read_csv(file)

    def report(self) -> Path:
        """Writes the page of the run and tells where it is."""
        _core.run("report", [str(self.folder)], "", [], "", False, False, True, 1)
        return self.folder / "report.html"

    def __repr__(self) -> str:
        return f"{type(self).__name__}({str(self.folder)!r})"

    def _warn(self) -> None:
        for text in self.warnings:
            warnings.warn(text, stacklevel=4)


class Response(Run):
    """A press, of the lattice or of the continuum: forces against indentation, SI."""

    @cached_property
    def samples(self) -> Table:
        """response.csv."""
        return self.table("response")

    @cached_property
    def trace(self) -> Table | None:
        """trace.csv of a press in time, once per control period."""
        return self.table("trace") if (self.folder / "trace.csv").exists() else None

    @cached_property
    def contact(self) -> Table | None:
        """contact_field.csv: pressure, shear and state of what touches, `sample` by sample (from 1)."""
        return self.table("contact_field") if (self.folder / "contact_field.csv").exists() else None

    @cached_property
    def taxels(self) -> Table | None:
        """taxels.csv of a finger with a skin (sensor.taxels): stresses of each, `sample` by sample (from 1)."""
        return self.table("taxels") if (self.folder / "taxels.csv").exists() else None

    @cached_property
    def markers(self) -> Table | None:
        """markers.csv of a press with markers (sensor.markers): displacement of each, `sample` by sample (from 1)."""
        return self.table("markers") if (self.folder / "markers.csv").exists() else None

    @property
    def indentation(self) -> np.ndarray:
        """[m]"""
        return self.samples["indentation"]

    @property
    def normal_force(self) -> np.ndarray:
        """[N]"""
        return self.samples["normal_force"]

    @property
    def force_error(self) -> np.ndarray:
        """Estimated, of normal_force [N]; NaN where it is not known."""
        return self.samples["force_error"]

    @property
    def slopes(self) -> dict[str, np.ndarray]:
        """Of normal_force by a key, SI; empty unless the press was asked for slopes."""
        return {key: self.samples[name] for key, name in SLOPES.items() if self.samples._known(name)}

    @property
    def contact_radius(self) -> np.ndarray:
        """[m]"""
        return self.samples["contact_radius"]

    @property
    def units(self) -> dict[str, str]:
        return self.samples.units

    def to_dataframe(self):
        """A pandas.DataFrame of the samples."""
        frame = self.samples.to_dataframe()
        frame.attrs["folder"] = str(self.folder)
        return frame

    def to_xarray(self):
        """An xarray.Dataset of the samples along the indentation."""
        return self.samples.to_xarray("indentation")

    def _repr_html_(self) -> str:
        what = [self.summary.get(name) for name in ("model", "analysis", "kinematics", "strain", "contact")]
        title = ", ".join(str(word) for word in what if word)
        return f"<p>{html.escape(title)} — {html.escape(str(self.folder))}</p>{self.samples._repr_html_()}"


class Presses(Run):
    """Presses by combinations of values: a row per press, and all their curves."""

    @cached_property
    def samples(self) -> Table:
        """table.csv: settings, answer and summary of each press."""
        return self.table("table")

    @cached_property
    def axes(self) -> list[str]:
        """The keys that vary, columns of both tables."""
        return json.loads((self.folder / "sweep.json").read_text(encoding="utf-8"))["axes"]

    @cached_property
    def curves(self) -> Table:
        """curves.csv: the rows of all response.csv behind the values of the axes."""
        return self.table("curves")

    def press(self, row: int) -> Response:
        """That of a row of `samples`."""
        return Response(self.folder / "points" / str(self.samples["point"][row]))

    def to_dataframe(self):
        """A pandas.DataFrame of the curves."""
        return self.curves.to_dataframe()

    def to_xarray(self):
        """An xarray.Dataset over the axes and the number of the sample, NaN where a press has none."""
        frame = self.curves.to_dataframe()
        frame["sample"] = frame.groupby("point").cumcount() + 1
        return frame.drop(columns="point").set_index([*self.axes, "sample"]).to_xarray()


class Calibration(Run):
    """A fit: parameters with their intervals, and the material for further presses."""

    @cached_property
    def result(self) -> dict:
        """calibration.json, of material tests laws.json."""
        for name in ("calibration.json", "laws.json"):
            if (self.folder / name).exists():
                return json.loads((self.folder / name).read_text(encoding="utf-8"))
        return {}

    @property
    def parameters(self) -> dict[str, dict]:
        """`estimate lower upper unit ...` by name; empty for a fit to moduli or of laws."""
        return {entry["name"]: entry for entry in self.result.get("parameters", [])}

    @property
    def material(self) -> Path | None:
        """material.toml, for lattice_constants or rubber_card; None where the fit was rejected."""
        file = self.folder / "material.toml"
        return file if file.exists() else None

    @property
    def failed(self) -> list[str]:
        """Why the fit is not accepted, a sentence each; empty: it is."""
        return self.result.get("failed", [])

    @property
    def statement(self) -> str:
        return self.result.get("statement", "")

    def __repr__(self) -> str:
        return super().__repr__() + "".join(f"\nnot accepted: {reason}" for reason in self.failed)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{html.escape(name)}</td><td>{entry['estimate']:.6g}</td>"
            f"<td>{entry['lower']:.6g} … {entry['upper']:.6g}</td><td>{html.escape(entry['unit'])}</td></tr>"
            for name, entry in self.parameters.items()
            if entry.get("lower") is not None
        )
        table = f"<table><tr><th></th><th>estimate</th><th>95 %</th><th></th></tr>{rows}</table>" if rows else ""
        reasons = "".join(f"<li>{html.escape(reason)}</li>" for reason in self.failed)
        refused = f'<div style="color:#c62828"><b>Not accepted</b><ul>{reasons}</ul></div>' if reasons else ""
        return f"{refused}<p>{html.escape(self.statement)}</p>{table}"


class Comparison(Run):
    """Curves beside each other."""

    @cached_property
    def differences(self) -> Table:
        """comparison.csv."""
        return self.table("comparison")

    @cached_property
    def markers(self) -> Table:
        """comparison_markers.csv, of runs with markers."""
        return self.table("comparison_markers")

    def report(self) -> Path:
        return self.folder / "comparison.html"
