"""Baked maps."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
from numpy.typing import NDArray

__all__ = ["Maps"]


class Maps(dict[str, NDArray[np.float32]]):
    """The maps that `jaspe.Texture.bake` made, by their names."""

    tile: float
    """How many units of the texture the maps show along a side."""
    height_range: tuple[float, float]
    """The heights, in units of the texture, that 0 and 1 of the height map stand for; (0, 0) without that map."""

    def __init__(
        self, maps: Mapping[str, NDArray[np.float32]], tile: float, height_range: tuple[float, float]
    ) -> None:
        super().__init__(maps)
        self.tile = tile
        self.height_range = height_range

    def __reduce__(self) -> tuple[Any, ...]:
        return (Maps, (dict(self), self.tile, self.height_range))
