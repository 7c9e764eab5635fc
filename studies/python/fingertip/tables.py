"""Tables with units: columns as NumPy arrays, and as pandas or xarray where these are there."""

from __future__ import annotations

import csv
import html
from pathlib import Path
from typing import Iterator, Mapping

import numpy as np


def _parted(title: str) -> tuple[str, str]:
    """ "time [s]" as name and unit."""
    name, _, unit = title.partition(" [")
    return name, unit.rstrip("]")


class Table(Mapping):
    """Columns by name, SI; `units` has their units.

    A column of response.csv or trace.csv looks into the rows as they were read: no copy is made,
    and it cannot be written.
    """

    def __init__(self, rows, titles: list[str], column):
        self._rows = rows
        self._titles = dict(zip((_parted(title)[0] for title in titles), titles))
        self._column = column
        self.units: dict[str, str] = {name: _parted(title)[1] for name, title in self._titles.items()}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._titles:
            raise KeyError(f"{name}; there are {', '.join(self._titles)}")
        return self._column(self._titles[name])

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name not in self._titles:
            raise AttributeError(name)
        return self[name]

    def __dir__(self):
        return [*super().__dir__(), *self._titles]

    def __iter__(self) -> Iterator[str]:
        return iter(self._titles)

    def __len__(self) -> int:
        return len(self._titles)

    @property
    def rows(self) -> int:
        return self._rows

    def __repr__(self) -> str:
        columns = ", ".join(f"{name} [{unit}]" if unit else name for name, unit in self.units.items())
        return f"Table({self.rows} rows: {columns})"

    def _repr_html_(self) -> str:
        shown = [name for name in self if self._known(name)]
        head = "".join(f"<th>{html.escape(self._titles[name])}</th>" for name in shown)
        places = range(self.rows) if self.rows <= 12 else [*range(6), *range(self.rows - 6, self.rows)]
        body = []
        for place in places:
            cells = "".join(f"<td>{_cell(self[name][place])}</td>" for name in shown)
            body.append(f"<tr>{cells}</tr>")
            if self.rows > 12 and place == 5:
                body.append(f"<tr><td colspan='{len(shown)}'>…</td></tr>")
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(body)}</tbody></table>"

    def _known(self, name: str) -> bool:
        column = self[name]
        return column.dtype.kind != "f" or not np.isnan(column).all()

    def to_dataframe(self):
        """A pandas.DataFrame of what is known; the units are in its attrs."""
        import pandas

        frame = pandas.DataFrame({name: self[name] for name in self if self._known(name)})
        frame.attrs["units"] = {name: self.units[name] for name in frame}
        return frame

    def to_xarray(self, along: str | None = None):
        """An xarray.Dataset of what is known, along its first column or another one."""
        import xarray

        along = along or next(iter(self))
        known = [name for name in self if self._known(name) or name == along]
        columns = {name: (along, self[name], {"units": self.units[name]}) for name in known}
        place = {along: columns.pop(along)}
        return xarray.Dataset(columns, coords=place)


def _cell(value) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.6g}"
    return html.escape(str(value))


def compiled(rows) -> Table:
    """A table of the extension's."""
    return Table(len(rows), list(type(rows).columns), rows.column)


def read_csv(file: str | Path) -> Table:
    """Any table that the program writes."""
    with open(file, encoding="utf-8", newline="") as lines:
        titles, *rows = csv.reader(lines)
    columns = {}
    for place, title in enumerate(titles):
        cells = [row[place] for row in rows]
        try:
            columns[title] = np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            columns[title] = np.array(cells, dtype=str)
    return Table(len(rows), titles, columns.__getitem__)
