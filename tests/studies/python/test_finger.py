"""A finger stepped in a loop of one's own."""

import sys
import unittest
from pathlib import Path

import numpy as np
from helpers import QUICK, InFolder

import fingertip

sys.path.insert(0, str(Path(__file__).parents[3] / "studies/control/examples"))
import hold_by_touch  # noqa: E402


def pressed(finger, command, periods=10_000):
    """What a loop sees: time, indentation and force at every period until the depth is reached."""
    seen, rows = finger.reset(), []
    for _ in range(periods):
        rows.append((seen.time, finger.indentation, finger.normal_force))
        if finger.indentation >= finger.depth:
            break
        seen = finger.step(command(finger, seen))
    return np.array(rows)


class Pid:
    """Proportional-integral-derivative control of the endpoint's position, critically damped."""

    def __init__(self, omega=300.0):
        self.omega, self.sum = omega, np.zeros(3)

    def __call__(self, finger, seen):
        wanted, w = finger.target(seen.time), self.omega
        error = wanted.position - seen.position
        self.sum = self.sum + w**3 * error * finger.period
        rate = wanted.velocity - seen.velocity
        acceleration = wanted.acceleration + 3 * w**2 * error + self.sum + 3 * w * rate
        inertia = finger.inertia
        force = inertia[:3, :3] @ acceleration - seen.force
        return fingertip.Wrench(force, inertia[3:, :3] @ acceleration - seen.torque)


class Finger(InFolder):
    def test_led_by_the_servo_presses_as_the_program_does(self):
        response = fingertip.press(QUICK, run_symmetry=False)  # under the built-in PID
        finger = fingertip.Finger(QUICK)
        rows = pressed(finger, lambda finger, seen: finger.target(seen.time))
        trace = response.trace
        count = min(len(rows), trace.rows - 1)  # the program stops within its last period
        self.assertGreater(count, 100)
        np.testing.assert_array_equal(rows[:count, 0], trace.time[:count])
        np.testing.assert_array_equal(rows[:count, 1], trace.indentation[:count])
        np.testing.assert_array_equal(rows[:count, 2], trace.normal_force[:count])

    def test_led_from_python_reaches_the_depth(self):
        response = fingertip.press(QUICK)
        rows = pressed(fingertip.Finger(QUICK), Pid())
        self.assertGreaterEqual(rows[-1, 1], 0.6e-3)
        force = np.interp(0.6e-3, rows[:, 1], rows[:, 2])
        self.assertAlmostEqual(force / response.normal_force[-1], 1.0, delta=0.02)

    def test_reset_is_the_beginning(self):
        finger = fingertip.Finger(QUICK, hardware_force_noise="1 mN")
        first = pressed(finger, Pid(), 60)
        np.testing.assert_array_equal(pressed(finger, Pid(), 60), first)

    def test_measures_what_its_sensors_tell(self):
        finger = fingertip.Finger(QUICK, hardware_tactile=False)
        seen = finger.measure()
        self.assertIsNone(seen.contact)
        self.assertEqual(seen.time, 0.0)
        np.testing.assert_array_equal(seen.orientation, [1, 0, 0, 0])
        self.assertIn("Measurement", repr(seen))
        self.assertEqual(finger.period, 1e-3)
        self.assertIsNotNone(fingertip.Finger(QUICK).measure().contact)

    def test_a_skin_alone_holds_a_force(self):
        rows = hold_by_touch.hold(lattice_spacing="tip_radius/8", sensor_noise="5 Pa", sensor_latency="2 ms")
        settled = rows[rows[:, 0] > 0.7]
        self.assertGreater(len(settled), 50)
        self.assertLess(settled[:, 2].std(), 0.01 * hold_by_touch.WANTED)
        self.assertAlmostEqual(settled[:, 1].mean() / hold_by_touch.WANTED, 1.0, delta=0.01)
        self.assertAlmostEqual(settled[:, 2].mean() / hold_by_touch.WANTED, 1.0, delta=0.02)
        self.assertLess(rows[:, 2].max(), 1.2 * hold_by_touch.WANTED)

    def test_has_the_skin_that_is_asked_for(self):
        finger = fingertip.Finger(QUICK, sensor_taxels={"rings": 2, "per_ring": 6})
        self.assertEqual(finger.taxels.shape, (12, 7))
        np.testing.assert_allclose(np.linalg.norm(finger.taxels[:, :3], axis=1), 0.01, rtol=1e-9)
        np.testing.assert_array_equal(finger.measure().taxels, np.zeros((12, 3)))
        self.assertEqual(fingertip.Finger(QUICK).measure().taxels.shape, (0, 3))

    def test_refuses_what_is_no_number(self):
        finger = fingertip.Finger(QUICK)
        finger.reset()
        with self.assertRaises(fingertip.ControllerFailed):
            finger.step(fingertip.Wrench(force=[np.nan, 0, 0]))

    def test_refuses_bad_settings(self):
        with self.assertRaises(fingertip.ConfigError):
            fingertip.Finger(lattice_spacing="3 cm")


if __name__ == "__main__":
    unittest.main()
