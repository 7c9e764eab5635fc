"""What the scripts share: a folder and a cache of its own for every test."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

# A press of a second or less.
QUICK = {"lattice": {"spacing": "tip_radius/6"}, "press": {"samples": ["0.3 mm", "0.6 mm"]}}


class InFolder(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        cache = os.environ.get("XDG_CACHE_HOME")
        self.addCleanup(self._restore, cache)
        os.environ["XDG_CACHE_HOME"] = str(self.folder / "cache")

    @staticmethod
    def _restore(cache):
        if cache is None:
            os.environ.pop("XDG_CACHE_HOME", None)
        else:
            os.environ["XDG_CACHE_HOME"] = cache

    def program(self, *words):
        """The program itself, with a cache of its own, so that it computes."""
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "other cache")}
        return subprocess.run(
            [os.environ["FINGERTIP_PROGRAM"], *map(str, words)], env=environment, check=True, capture_output=True
        )
