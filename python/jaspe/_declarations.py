"""What the materials declare of themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from . import _jaspe

__all__ = ["Declaration", "Parameter", "textures"]


@dataclass(frozen=True)
class Parameter:
    """One parameter of a material."""

    name: str
    """Its name."""
    summary: str
    """One sentence, with the unit where there is one."""
    kind: str
    """"int", "float", "color" (display-encoded red, green and blue) or "choice"."""
    default: Any
    """What stands when nothing is given; `None` where that follows from the surroundings."""
    least: Optional[float]
    """The least value of a number."""
    most: Optional[float]
    """The largest value of a number."""
    choices: tuple[str, ...]
    """The words of a choice."""


@dataclass(frozen=True)
class Declaration:
    """A material and its parameters."""

    name: str
    """Its name, which `jaspe.Texture` takes."""
    summary: str
    """What it looks like."""
    parameters: tuple[Parameter, ...]
    """All parameters."""


def textures() -> list[Declaration]:
    """All materials, with their parameters, defaults and ranges.

    >>> [material.name for material in textures()]
    ['fire', 'water', 'organic', 'wood', 'marble', 'stone']
    """
    return [
        Declaration(
            entry["name"], entry["summary"], tuple(Parameter(**parameter) for parameter in entry["parameters"])
        )
        for entry in _jaspe.declarations()["textures"]
    ]
