"""The notebooks of studies/examples, executed as Jupyter does; what they claim they assert themselves."""

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from helpers import InFolder

EXAMPLES = Path(os.environ["FINGERTIP_EXAMPLES"])


@unittest.skipUnless(shutil.which("jupyter-nbconvert"), "needs the Debian packages jupyter-nbconvert, python3-ipykernel")
class Notebooks(InFolder):
    def figures(self, name):
        """How many figures it shows, executed in a folder with what it reads."""
        for path in [EXAMPLES / f"{name}.ipynb", *EXAMPLES.glob("my_press.*")]:
            shutil.copy(path, ".")
        done = subprocess.run(["jupyter-nbconvert", "--to", "notebook", "--execute", "--inplace", f"{name}.ipynb"],
                              capture_output=True, text=True)  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        cells = json.loads(Path(f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]
        return sum("image/png" in output.get("data", {}) for cell in cells for output in cell.get("outputs", []))

    def test_press_and_fit(self):
        self.assertEqual(self.figures("press_and_fit"), 2)

    def test_control_loop(self):
        self.assertEqual(self.figures("control_loop"), 1)

    def test_all_of_them_are_run_here(self):
        own = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")}
        self.assertEqual({path.stem for path in EXAMPLES.glob("*.ipynb")}, own - {"all_of_them_are_run_here"})


if __name__ == "__main__":
    sys.exit(unittest.main())
