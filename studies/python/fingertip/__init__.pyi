from os import PathLike
from pathlib import Path
from typing import Any, Mapping, Sequence

from typing_extensions import Unpack

from ._core import Contact as Contact
from ._core import Finger as _Finger
from ._core import Measurement as Measurement
from ._core import Target as Target
from ._core import Wrench as Wrench
from .errors import CannotWrite as CannotWrite
from .errors import ConfigError as ConfigError
from .errors import ControllerFailed as ControllerFailed
from .errors import Error as Error
from .errors import NotConverged as NotConverged
from .errors import Problem as Problem
from .errors import ProcessLost as ProcessLost
from .errors import TestsFailed as TestsFailed
from .keys import Keys
from .runs import Calibration as Calibration
from .runs import Comparison as Comparison
from .runs import Presses as Presses
from .runs import Response as Response
from .runs import Run as Run
from .settings import Key as Key
from .settings import keys as keys
from .settings import sections as sections
from .tables import Table as Table
from .tables import read_csv as read_csv

_File = str | PathLike[str]
_Settings = Mapping[str, Any] | None

def press(settings: _Settings = None, *, slopes: Sequence[str] = (), config: _File | None = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Response: ...
def presses(points: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]], settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, resume: bool = False, quiet: bool = False, threads: int = 0, **further: Unpack[Keys]) -> Presses: ...
def reference(settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, ranks: int = 1, **further: Unpack[Keys]) -> Response: ...
def calibrate(settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Calibration: ...
def modes(settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Run: ...
def grasp(settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Run: ...
def validate(case: _File = "01", *, settings: _Settings = None, out: _File | None = None, force: bool = False, resume: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Run: ...
def compare(*runs: Run | _File, out: _File | None = None, force: bool = False) -> Comparison: ...
def export(format: str, settings: _Settings = None, *, config: _File | None = None, out: _File | None = None, force: bool = False, lossy: bool = False, quiet: bool = True, **further: Unpack[Keys]) -> Run: ...
def check(settings: _Settings = None, *, config: _File | None = None, **further: Unpack[Keys]) -> None: ...
def run(verb: str, *arguments: _File, settings: _Settings = None, config: _File | None = None, out: _File = "", force: bool = False, resume: bool = False, quiet: bool = False, ranks: int = 1, **further: Unpack[Keys]) -> int: ...

class Finger(_Finger):
    def __init__(self, settings: _Settings = None, *, config: _File | None = None, **further: Unpack[Keys]) -> None: ...
