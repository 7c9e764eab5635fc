"""Errors are exceptions with the program's words."""

import _thread
import json
import os
import signal
import threading
import unittest
from pathlib import Path

from helpers import QUICK, InFolder

import fingertip


class Errors(InFolder):
    def test_of_keys_name_the_nearest_one(self):
        with self.assertRaises(fingertip.ConfigError) as told:
            fingertip.press(pres_contact="stick")
        self.assertEqual(told.exception.problems[0].key, "pres.contact")
        self.assertIn("press", str(told.exception))
        self.assertFalse(Path("runs").exists())

    def test_of_files_name_the_line(self):
        Path("mine.toml").write_text('[press]\ncontact = "glue"\n', encoding="utf-8")
        with self.assertRaises(fingertip.ConfigError) as told:
            fingertip.press(config="mine.toml")
        self.assertEqual(told.exception.problems[0].place, "mine.toml:2")

    def test_of_a_fit_that_fails_its_tests_keep_the_run(self):
        Path("flat.csv").write_text(
            "indentation [mm],normal_force [mN],sigma [mN]\n" + "".join(f"{0.2 * i},5,0.01\n" for i in range(1, 6)),
            encoding="utf-8",
        )
        with self.assertRaises(fingertip.TestsFailed) as told:
            fingertip.calibrate(calibration_problem="experiment", calibration_data=["flat.csv"],
                                lattice_spacing="tip_radius/6", lattice_kinematics="small",
                                press_contact="frictionless")  # fmt: skip
        self.assertTrue(told.exception.run.folder.exists())
        self.assertIsNone(told.exception.run.material)

    def test_ctrl_c_ends_the_run_and_nothing_else(self):
        before = signal.getsignal(signal.SIGINT)
        timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            fingertip.press(press_mode="quasi-static", lattice_spacing="tip_radius/16", out="long")
        timer.join()
        self.assertEqual(json.loads(Path("long/manifest.json").read_text())["status"], "interrupted")
        # Python's own handler is back, and the next run is not stopped by the last one's.
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        fingertip.press(QUICK, press_mode="static")
        with self.assertRaises(KeyboardInterrupt):
            _thread.interrupt_main()
            for _ in range(10**6):
                pass


if __name__ == "__main__":
    unittest.main()
