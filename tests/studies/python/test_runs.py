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
