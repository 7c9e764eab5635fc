"""Keys as keyword arguments."""

import unittest
from pathlib import Path

import numpy as np

import fingertip
from fingertip import settings


class Literals(unittest.TestCase):
    def test_are_those_of_toml(self):
        for value, text in [
            ("3 mm", '"3 mm"'), (True, "true"), (3, "3"), (0.25, "0.25"), (Path("a b.csv"), '"a b.csv"'),
            (["1 mm", "2 mm"], '["1 mm", "2 mm"]'), ([(0.3, "1 s")], '[[0.3, "1 s"]]'),
            (np.float64(0.5), "0.5"), (np.array([1.0, 2.0]), "[1.0, 2.0]"), ('say "so"', '"say \\"so\\""'),
        ]:  # fmt: skip
            self.assertEqual(settings.literal(value), text)

    def test_are_tables_of_dictionaries(self):
        rig = {"touch_offset": "fit", "compliance": "0.1 mm/N"}
        text = 'calibration.rig={touch_offset = "fit", compliance = "0.1 mm/N"}'
        for given in ({"calibration": {"rig": rig}}, {"calibration.rig": rig}):
            self.assertEqual(settings.sets(given, {}), [text])
        self.assertEqual(settings.sets(None, {"calibration_rig": rig}), [text])

    def test_of_other_things_are_refused(self):
        with self.assertRaises(TypeError):
            settings.literal(object())


class Keys(unittest.TestCase):
    def test_every_one_is_a_keyword_of_its_own(self):
        names = [key.keyword for key in fingertip.keys.values()]
        self.assertGreater(len(names), 100)
        self.assertEqual(len(set(names)), len(names))
        for key in fingertip.keys.values():
            self.assertTrue(key.keyword.isidentifier(), key.name)
            self.assertEqual(settings.sets({}, {key.keyword: 1}), [f"{key.name}=1"])

    def test_keywords_count_after_settings(self):
        given = settings.sets({"press": {"contact": "stick"}, "run.threads": 1}, {"press_contact": "frictionless"})
        self.assertEqual(given, ['press.contact="stick"', "run.threads=1", 'press.contact="frictionless"'])

    def test_docstrings_and_stub_have_them_all(self):
        stub = settings.stub()
        for key in fingertip.keys.values():
            self.assertIn(f"{key.keyword}: {key.help}", fingertip.press.__doc__)
            self.assertIn(f"    {key.keyword}: ", stub)
        compile(stub, "keys.pyi", "exec")
        self.assertEqual((Path(fingertip.__file__).parent / "keys.pyi").read_text(encoding="utf-8"), stub)

    def test_check_finds_what_is_wrong(self):
        fingertip.check(press_contact="frictionless")
        with self.assertRaises(fingertip.ConfigError) as told:
            fingertip.check(press_contact="frictionles", rubber_density="1 m")
        self.assertEqual([problem.key for problem in told.exception.problems], ["press.contact", "rubber.density"])
        self.assertIn("frictionless", told.exception.problems[0].remedy)
        self.assertIsInstance(told.exception, ValueError)


if __name__ == "__main__":
    unittest.main()
