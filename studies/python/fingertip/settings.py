"""The configuration: keys as keyword arguments, dictionaries or files.

`press_contact="stick"` stands for `press.contact`: the first word is the section. Quantities are
texts with a unit, "3 mm"; everything else is what it is in a TOML file.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Mapping, NamedTuple

from . import _core


class Key(NamedTuple):
    """A key of the configuration."""

    name: str
    kind: str
    default: str
    unit: str
    help: str
    allowed: str
    rule: str
    choices: list[tuple[str, str]]

    @property
    def keyword(self) -> str:
        return self.name.replace(".", "_", 1)

    def __str__(self) -> str:
        text = f"{self.keyword}: {self.help} (default {self.default}"
        text += f"; {self.allowed})" if self.allowed else ")"
        return text


keys: dict[str, Key] = {entry["name"]: Key(**entry) for entry in _core.keys()}
sections: dict[str, str] = _core.sections()


def literal(value: Any) -> str:
    """A value as TOML writes it."""
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(literal, value)) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name} = {literal(one)}" for name, one in value.items()) + "}"
    raise TypeError(f"{value!r} is no value of a key: give a text, a number, a truth value, a list or a dictionary")


def sets(settings: Mapping[str, Any] | None, further: Mapping[str, Any]) -> list[str]:
    """Settings and keyword arguments as "section.key=value", the later ones last."""
    given: list[str] = []
    for name, value in (settings or {}).items():
        if isinstance(value, Mapping) and "." not in name:
            given += [f"{name}.{key}={literal(one)}" for key, one in value.items()]
        else:
            given.append(f"{name}={literal(value)}")
    for name, value in further.items():
        given.append(f"{name.replace('_', '.', 1)}={literal(value)}")
    return given


def config_file(config: str | os.PathLike | None) -> str:
    return "" if config is None else os.fspath(config)


def described(text: str) -> str:
    """A docstring with all keys."""
    lines = [text.rstrip(), "", "Keyword arguments, by section:"]
    for section, help_line in sections.items():
        lines += ["", f"{section}: {help_line}"]
        lines += [f"  {key}" for key in keys.values() if key.name.startswith(section + ".")]
    return "\n".join(lines)


def _type_of(key: Key) -> str:
    words = ", ".join(json.dumps(word) for word, _ in key.choices)
    return {
        "choice": f"Literal[{words}]",
        "number": "float",
        "integer": "int",
        "boolean": "bool",
        "numbers": "Sequence[float]",
        "number_pair": "Sequence[float]",
        "quantities": "Sequence[str]",
        "texts": "Sequence[str]",
        "files": "Sequence[str | PathLike[str]]",
        "terms": "Sequence[Sequence[float | str]]",
        "stages": "Sequence[Sequence[str]]",
        "file": "str | PathLike[str]",
        "source": "str | PathLike[str]",
        "fields": "Mapping[str, str | int] | str | PathLike[str]",
    }.get(key.kind, "str")


def stub() -> str:
    """The types of the keyword arguments, for editors and type checkers."""
    lines = [
        "from os import PathLike",
        "from typing import Literal, Mapping, Sequence, TypedDict",
        "",
        "class Keys(TypedDict, total=False):",
    ]
    lines += [f"    {key.keyword}: {_type_of(key)}" for key in keys.values()]
    return "\n".join(lines) + "\n"


def write_stub(file: str) -> None:
    Path(file).write_text(stub(), encoding="utf-8")
