"""The notebooks, cell by cell, as Jupyter would run them."""

import json
import os
import sys
import unittest
from pathlib import Path

from helpers import InFolder

NOTEBOOKS = Path(os.environ["FINGERTIP_NOTEBOOKS"])


class Notebooks(InFolder):
    def setUp(self):
        super().setUp()
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib here")
        matplotlib.use("Agg")

    def execute(self, name):
        """The names that the cells leave, and the figures they draw."""
        import matplotlib.pyplot as plt

        notebook = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        names, shown = {"__name__": "__main__"}, []

        def show():
            for number in plt.get_fignums():
                figure = plt.figure(number)
                shown.append(figure)
                kept = os.environ.get("FINGERTIP_NOTEBOOK_FIGURES")  # for people who want to look
                if kept:
                    figure.savefig(Path(kept) / f"{name}_{len(shown)}.png", dpi=80)
            plt.close("all")

        plt.show, before = show, plt.show
        try:
            for place, cell in enumerate(cells):
                exec(compile("".join(cell["source"]), f"{name}, code cell {place + 1}", "exec"), names)
        finally:
            plt.show = before
        return names, shown

    def test_press_and_plot(self):
        names, figures = self.execute("press_and_plot")
        self.assertEqual(len(figures), 1)
        self.assertEqual(len(names["lattice"].indentation), 6)

    def test_calibrate(self):
        names, figures = self.execute("calibrate")
        self.assertEqual(len(figures), 1)
        self.assertTrue(names["fit"].material.exists())

    def test_control_loop(self):
        names, figures = self.execute("control_loop")
        self.assertEqual(len(figures), 1)
        self.assertGreater(len(names["rows"]), 590)

    def test_all_of_them_are_run_here(self):
        own = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")}
        self.assertEqual({path.stem for path in NOTEBOOKS.glob("*.ipynb")}, own - {"all_of_them_are_run_here"})


if __name__ == "__main__":
    sys.exit(unittest.main())
