"""Columns of NumPy that look into the rows."""

import gc
import unittest
from pathlib import Path

import numpy as np
from helpers import InFolder

from fingertip import _core
from fingertip.tables import compiled, read_csv


def write_response(file: Path, rows: int) -> None:
    with open(file, "w", encoding="utf-8") as out:
        out.write("indentation [m],normal_force [N],force_error [N]\n")
        out.writelines(f"{1e-9 * (i + 1)!r},{0.5 * i!r},\n" for i in range(rows))


class Columns(InFolder):
    def test_a_million_samples_come_without_a_copy(self):
        rows = 1_000_000
        write_response(self.folder / "response.csv", rows)
        table = _core.ResponseTable(self.folder / "response.csv")
        depth, force = table.column("indentation [m]"), table.column("normal_force [N]")
        self.assertEqual(len(depth), rows)
        # Both lie in the same rows, one number apart, and step from row to row.
        row = depth.strides[0]
        self.assertGreater(row, 8)
        self.assertEqual(force.strides[0], row)
        address = [column.__array_interface__["data"][0] for column in (depth, force)]
        self.assertEqual(address[1] - address[0], 8)
        self.assertIs(depth.base, table)
        self.assertFalse(depth.flags.owndata)
        # The same place whenever it is asked for.
        self.assertEqual(table.column("indentation [m]").__array_interface__["data"][0], address[0])
        self.assertEqual(depth[-1], 1e-9 * rows)
        self.assertEqual(force[12345], 0.5 * 12345)

    def test_keep_their_rows_alive_and_are_not_written(self):
        write_response(self.folder / "response.csv", 10)
        column = _core.ResponseTable(self.folder / "response.csv").column("normal_force [N]")
        gc.collect()
        self.assertEqual(column[9], 4.5)
        with self.assertRaises(ValueError):
            column[0] = 1.0

    def test_have_names_and_units(self):
        write_response(self.folder / "response.csv", 20)
        table = compiled(_core.ResponseTable(self.folder / "response.csv"))
        self.assertEqual(table.units["normal_force"], "N")
        self.assertEqual(table["normal_force"][1], table.normal_force[1])
        self.assertEqual(table.rows, 20)
        with self.assertRaisesRegex(KeyError, "normal_force"):
            table["force"]
        with self.assertRaises(AttributeError):
            table.force
        page = table._repr_html_()
        self.assertIn("normal_force [N]", page)
        self.assertNotIn("max_pressure", page)  # nobody knows it
        self.assertIn("…", page)

    def test_of_an_empty_table_are_empty(self):
        write_response(self.folder / "response.csv", 0)
        try:
            table = _core.ResponseTable(self.folder / "response.csv")
        except ValueError as told:
            self.assertIn("response.csv", str(told))
        else:
            self.assertEqual(len(table.column("normal_force [N]")), 0)


class Csv(InFolder):
    def test_any_table_is_read(self):
        Path("x.csv").write_text('name,x [m],y\na,1,2\n"b, c",,3\n', encoding="utf-8")
        table = read_csv("x.csv")
        self.assertEqual(list(table["name"]), ["a", "b, c"])
        self.assertTrue(np.isnan(table["x"][1]))
        self.assertEqual(table.units, {"name": "", "x": "m", "y": ""})


class Frames(InFolder):
    def test_of_pandas_and_xarray_know_units(self):
        try:
            import pandas  # noqa: F401
            import xarray  # noqa: F401
        except ImportError:
            self.skipTest("no pandas or xarray here")
        write_response(self.folder / "response.csv", 5)
        table = compiled(_core.ResponseTable(self.folder / "response.csv"))
        frame = table.to_dataframe()
        self.assertEqual(list(frame.columns), ["indentation", "normal_force"])
        self.assertEqual(frame.attrs["units"], {"indentation": "m", "normal_force": "N"})
        data = table.to_xarray()
        self.assertEqual(data["normal_force"].attrs["units"], "N")
        self.assertEqual(float(data["normal_force"][2]), 1.0)
        self.assertEqual(data["normal_force"].dims, ("indentation",))


if __name__ == "__main__":
    unittest.main()
