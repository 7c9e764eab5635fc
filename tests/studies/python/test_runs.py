"""Verbs: the program's own results."""

import json
import os
import threading
import unittest
from pathlib import Path

import numpy as np
from helpers import QUICK, InFolder

import fingertip


def words(settings):
    for section, entries in settings.items():
        for name, value in entries.items():
            yield "--set"
            yield f"{section}.{name}={fingertip.settings.literal(value)}"


class SameBits(InFolder):
    def test_as_the_program_press(self):
        for mode in ("static", "quasi-static"):
            response = fingertip.press(QUICK, press_mode=mode)
            self.program("press", *words(QUICK), "--set", f"press.mode={mode}", "--out", f"program {mode}")
            self.assertEqual(
                (response.folder / "response.csv").read_bytes(), Path(f"program {mode}/response.csv").read_bytes()
            )

    def test_as_the_program_reference(self):
        settings = {**QUICK, "reference": {"tolerance": 0.05, "fields": False}}
        response = fingertip.reference(settings)
        self.program("reference", *words(settings), "--out", "program")
        self.assertEqual((response.folder / "response.csv").read_bytes(), Path("program/response.csv").read_bytes())
        self.assertTrue((response.force_error > 0.0).all())

    def test_as_the_program_calibrate(self):
        fit = fingertip.calibrate(lattice_model="central", calibration_seed=3)
        self.program("calibrate", "--set", "lattice.model=central", "--set", "calibration.seed=3", "--out", "program")
        own, other = (json.loads((Path(folder) / "calibration.json").read_text()) for folder in (fit.folder, "program"))
        self.assertEqual(own["constants"], other["constants"])
        self.assertTrue(fit.material.exists())

    def test_from_the_same_cache(self):
        first = fingertip.press(QUICK, press_mode="static")
        os.environ["XDG_CACHE_HOME"] = str(self.folder / "other cache")
        self.program("press", *words(QUICK), "--set", "press.mode=static", "--out", "program")
        again = fingertip.press(QUICK, press_mode="static")  # from the program's cache
        keys = [json.loads((run / "finished.json").read_text())["key"] for run in (first.folder, again.folder)]
        self.assertEqual(*keys)
        self.assertEqual(again.summary["wall_time"], json.loads(Path("program/summary.json").read_text())["wall_time"])


class Results(InFolder):
    def test_of_a_press_in_time(self):
        response = fingertip.press(QUICK, press_mode="quasi-static", out="one")
        self.assertEqual(response.folder, Path("one"))
        np.testing.assert_allclose(np.diff(response.indentation), 1e-5, rtol=1e-6)
        self.assertAlmostEqual(response.indentation[-1], 0.6e-3)
        self.assertTrue((np.diff(response.normal_force) > 0.0).all())
        self.assertEqual(response.units["normal_force"], "N")
        self.assertEqual(response.trace.units["time"], "s")
        self.assertAlmostEqual(response.trace.time[1] - response.trace.time[0], 1e-3)
        self.assertEqual(response.summary["model"], "hookean")
        self.assertIn("<table>", response._repr_html_())
        self.assertIn("hookean", response._repr_html_())
        self.assertTrue(response.report().exists())

    def test_contact_adds_up_to_the_force(self):
        response = fingertip.press(QUICK, press_mode="static")
        contact = response.contact
        self.assertEqual(contact.units["normal_traction"], "Pa")
        for sample in range(1, response.samples.rows + 1):
            here = contact.sample == sample
            force = (contact.area * contact.normal_traction)[here].sum()
            self.assertAlmostEqual(force / response.normal_force[sample - 1], 1.0, delta=1e-6)
        self.assertLessEqual(set(contact.state), {"stick", "slip"})

    def test_are_not_overwritten_unless_asked(self):
        fingertip.press(QUICK, press_mode="static", out="one")
        with self.assertRaisesRegex(fingertip.ConfigError, "exists already"):
            fingertip.press(QUICK, press_mode="static", out="one")
        fingertip.press(QUICK, press_mode="static", out="one", force=True)

    def test_stand_beside_each_other(self):
        fine = fingertip.press(QUICK, press_mode="static")
        soft = fingertip.press(QUICK, press_mode="static", rubber_youngs_modulus="20 gf/cm^2",
                               rubber_shear_modulus="7 gf/cm^2")  # fmt: skip
        comparison = fingertip.compare(fine, soft)
        self.assertEqual(comparison.differences.rows, 2)
        self.assertTrue(comparison.report().exists())

    def test_warnings_are_pythons(self):
        fit = fingertip.calibrate(QUICK, out="fit")
        with self.assertWarnsRegex(UserWarning, "have no effect"):
            fingertip.press(QUICK, press_mode="static", lattice_constants=fit.material, lattice_spacing="tip_radius/10",
                            rubber_poissons_ratio=0.3)  # fmt: skip


class Slopes(InFolder):
    def test_are_derivatives_of_the_force(self):
        def pressed(modulus, ratio, **further):
            return fingertip.press(QUICK, press_mode="static", rubber_youngs_modulus=f"{modulus} kPa",
                                   rubber_poissons_ratio=ratio, **further)  # fmt: skip

        for contact in "stick", "frictionless":
            press = pressed(60.0, 0.45, press_contact=contact, slopes=["rubber.poissons_ratio"])
            soft, hard = (pressed(modulus, 0.45, press_contact=contact).normal_force for modulus in (59.0, 61.0))
            np.testing.assert_allclose(press.slopes["rubber.youngs_modulus"], (hard - soft) / 2e3, rtol=1e-4)
            low, high = (pressed(60.0, ratio, press_contact=contact, press_slopes=True).normal_force
                         for ratio in (0.45 - 1e-4, 0.45 + 1e-4))  # fmt: skip
            np.testing.assert_allclose(press.slopes["rubber.poissons_ratio"], (high - low) / 2e-4, rtol=1e-4)

    def test_are_exact_or_refused(self):
        with self.assertRaisesRegex(fingertip.ConfigError, "no exact slope"):
            fingertip.press(QUICK, press_mode="static", slopes=["geometry.tip_radius"])
        for wrong in {"press_mode": "quasi-static"}, {"press_contact": "coulomb"}, {"lattice_model": "central"}:
            with self.assertRaisesRegex(fingertip.ConfigError, "press.slopes"):
                fingertip.press(QUICK, **{"press_mode": "static", **wrong}, slopes=["rubber.poissons_ratio"])
        self.assertEqual(fingertip.press(QUICK, press_mode="static").slopes, {})


class Many(InFolder):
    AXES = {"rubber.youngs_modulus": ["20 kPa", "40 kPa"], "press.contact": ["stick", "frictionless"]}

    def test_presses_are_those_of_one_by_one(self):
        many = fingertip.presses(self.AXES, QUICK, press_mode="static", threads=2, quiet=True)
        self.assertEqual(many.samples.rows, 4)
        self.assertEqual(set(many.axes), set(self.AXES))
        one = fingertip.press(QUICK, press_mode="static", rubber_youngs_modulus="40 kPa", press_contact="stick")
        row = next(i for i in range(4) if many.samples["press.contact"][i] == "stick"
                   and many.samples["rubber.youngs_modulus"][i] == "40 kPa")  # fmt: skip
        np.testing.assert_array_equal(many.press(row).normal_force, one.normal_force)
        try:
            cube = many.to_xarray()
        except ImportError:
            self.skipTest("no pandas and xarray here")
        here = cube.sel({"rubber.youngs_modulus": "40 kPa", "press.contact": "stick"})
        np.testing.assert_array_equal(here["normal_force"], one.normal_force)

    def test_a_list_of_settings_need_be_no_grid(self):
        points = [{"press.contact": "stick"}, {"rubber.youngs_modulus": "40 kPa", "press.contact": "frictionless"}]
        many = fingertip.presses(points, QUICK, press_mode="static", quiet=True)
        self.assertEqual(many.samples.rows, 2)
        for point in points:
            keywords = {key.replace(".", "_", 1): value for key, value in point.items()}
            one = fingertip.press(QUICK, press_mode="static", **keywords)
            row = list(many.samples["rubber.youngs_modulus"]).index(point.get("rubber.youngs_modulus", ""))
            np.testing.assert_array_equal(many.press(row).normal_force, one.normal_force)
        with self.assertRaisesRegex(fingertip.ConfigError, "nearest valid key is press.contact"):
            fingertip.presses([{"press.contct": "stick"}], QUICK)

    def test_an_axis_is_a_list(self):
        with self.assertRaisesRegex(fingertip.ConfigError, "list of values"):
            fingertip.presses({"press.contact": "stick"}, QUICK)


class Example(InFolder):
    def test_finds_the_wall(self):
        import contextlib
        import io
        import runpy

        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            names = runpy.run_path(os.environ["FINGERTIP_EXAMPLES"] + "/wall_for_a_force.py")
        self.assertLess(abs(names["miss"]), 1e-3)
        self.assertTrue(4.0 < names["wall"] < 9.0, said.getvalue())


class Rejected(InFolder):
    def test_says_so_first(self):
        Path("fit").mkdir()
        Path("fit/calibration.json").write_text(json.dumps({"failed": ["G < 0"], "statement": "E = 1 Pa."}))
        fit = fingertip.Calibration("fit")
        self.assertIsNone(fit.material)
        self.assertEqual(repr(fit), "Calibration('fit')\nnot accepted: G < 0")
        page = fit._repr_html_()
        self.assertLess(page.index("Not accepted"), page.index("E = 1 Pa."))
        self.assertIn("<li>G &lt; 0</li>", page)
        Path("fit/calibration.json").write_text(json.dumps({"failed": [], "statement": "E = 1 Pa."}))
        good = fingertip.Calibration("fit")
        self.assertEqual(repr(good), "Calibration('fit')")
        self.assertNotIn("ccepted", good._repr_html_())


class Beside(InFolder):
    def test_other_threads_go_on(self):
        counted, stop = [0], threading.Event()

        def count():
            while not stop.wait(0.001):
                counted[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        response = fingertip.press(QUICK, press_mode="quasi-static")
        stop.set()
        thread.join()
        self.assertGreater(counted[0], 100 * min(1.0, response.summary["wall_time"]))


if __name__ == "__main__":
    unittest.main()
