from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Vector = NDArray[np.float64]

class ResponseTable:
    columns: list[str]
    def __init__(self, file: str | PathLike[str]) -> None: ...
    def __len__(self) -> int: ...
    def column(self, name: str) -> NDArray[Any]: ...

class TraceTable:
    columns: list[str]
    def __init__(self, file: str | PathLike[str]) -> None: ...
    def __len__(self) -> int: ...
    def column(self, name: str) -> NDArray[Any]: ...

class Wrench:
    force: _Vector
    torque: _Vector
    def __init__(self, force: ArrayLike = ..., torque: ArrayLike = ...) -> None: ...

class Target:
    position: _Vector
    orientation: _Vector
    velocity: _Vector
    acceleration: _Vector
    def __init__(self, position: ArrayLike, orientation: ArrayLike = ..., velocity: ArrayLike = ..., angular_velocity: ArrayLike = ..., acceleration: ArrayLike = ..., angular_acceleration: ArrayLike = ...) -> None: ...

class Contact:
    touching: int
    radius: float
    force: _Vector
    torque: _Vector

class Measurement:
    time: float
    position: _Vector
    orientation: _Vector
    velocity: _Vector
    angular_velocity: _Vector
    force: _Vector
    torque: _Vector
    contact: Contact | None
    taxels: _Vector

class Finger:
    time: float
    indentation: float
    normal_force: float
    applied: Wrench
    period: float
    depth: float
    speed: float
    inertia: _Vector
    normal: _Vector
    taxels: _Vector
    time_step: float
    def __init__(self, config: str, sets: list[str]) -> None: ...
    def reset(self) -> Measurement: ...
    def step(self, command: Wrench | Target = ...) -> Measurement: ...
    def measure(self) -> Measurement: ...
    def target(self, time: float) -> Target: ...

def keys() -> list[dict[str, Any]]: ...
def sections() -> dict[str, str]: ...
def check(config: str, sets: list[str]) -> None: ...
def program() -> Path: ...
def run(verb: str, arguments: list[str], config: str | PathLike[str], sets: list[str], out: str | PathLike[str], force: bool, resume: bool, quiet: bool, ranks: int, format: str = ..., lossy: bool = ...) -> int: ...
