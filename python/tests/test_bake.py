"""`jaspe.Texture.bake`: arrays that tile."""

from __future__ import annotations

import pickle
from typing import Any, Callable

import numpy as np
import pytest

import jaspe

NAMES = [material.name for material in jaspe.textures()]


@pytest.mark.parametrize("name", NAMES)
def test_maps_tile(name: str) -> None:
    maps = jaspe.Texture(name).bake(128, ["color", "height", "normal"])
    assert {key: value.shape for key, value in maps.items()} == {
        "color": (128, 128, 3), "height": (128, 128), "normal": (128, 128, 3),
    }
    for key, values in maps.items():
        assert values.dtype == np.float32 and values.min() >= 0 and values.max() <= 1, key
        for axis in (0, 1):
            steps = np.abs(np.diff(values, axis=axis))
            seam = np.abs(np.take(values, 0, axis) - np.take(values, -1, axis))
            assert np.quantile(seam, 0.99) <= np.quantile(steps, 0.999) + 1e-6, (key, axis)
    assert maps["height"].min() == 0 and maps["height"].max() == 1
    low, high = maps.height_range
    assert low < high and maps.tile > 0
    lengths = np.linalg.norm(2 * maps["normal"].astype(np.float64) - 1, axis=-1)
    assert np.abs(lengths - 1).max() < 1e-3


def test_settings_reach_the_bake() -> None:
    texture = jaspe.Texture("marble", seed=4)
    assert set(texture.bake(64)) == {"color", "height", "normal", "roughness", "ao"}
    gl, dx = (texture.bake(64, ["normal"], normal=normal)["normal"] for normal in ("gl", "dx"))
    assert np.allclose(gl[..., 1], 1 - dx[..., 1], atol=1e-6) and np.array_equal(gl[..., 0], dx[..., 0])
    small, large = (texture.bake(128, ["color"], tile=tile) for tile in (1, 4))
    assert (small.tile, large.tile) == (1, 4) and not np.array_equal(small["color"], large["color"])
    first, second = (jaspe.Texture("fire").bake(64, ["color"], frames=4, frame=frame)["color"] for frame in (0, 1))
    assert not np.array_equal(first, second)
    told: list[tuple[int, int]] = []
    maps = texture.bake(64, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1]
    again = pickle.loads(pickle.dumps(maps))
    assert np.array_equal(again["color"], maps["color"]) and again.height_range == maps.height_range


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda t: t.bake(0), "size"),
        (lambda t: t.bake(64, ["colour"]), 'did you mean "color"'),
        (lambda t: t.bake(64, []), "no map"),
        (lambda t: t.bake(64, ["color", "color"]), "twice"),
        (lambda t: t.bake(64, tile=-1), "tile"),
        (lambda t: t.bake(64, normal="gd"), '"gl", "dx"'),
        (lambda t: t.bake(64, frames=3, frame=3), "frame: expected a number from 0 to 2"),
    ],
)
def test_what_is_refused_is_explained(call: Callable[[Any], object], words: str) -> None:
    with pytest.raises(ValueError) as caught:
        call(jaspe.Texture("marble"))
    assert words in str(caught.value)
