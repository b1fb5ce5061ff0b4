"""`jaspe.Texture.bake`: arrays that tile."""

from __future__ import annotations

import pickle
from pathlib import Path
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
    assert "emission" in jaspe.Texture("fire").bake(64)
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


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, []),
        ({"format": "exr", "surface": "sphere", "normal": "dx"}, ["--format", "exr", "--surface", "sphere", "--normal", "dx"]),
        ({"frames": 2, "pace": 3, "maps": ["color"]}, ["--frames", "0..2", "--pace", "3", "--maps", "color"]),
        ({"bits": 16, "tile": 1.5}, ["--bits", "16", "--tile", "1.5"]),
    ],
)
def test_sets_are_those_of_the_command_line(
    options: dict[str, Any], words: list[str], command: Callable[..., str], tmp_path: Path
) -> None:
    command("bake", "marble", "--size", 160, "--seed", 5, "-o", tmp_path / "theirs", "--quiet", *words)
    names = jaspe.Texture("marble", seed=5).bake_set(tmp_path / "ours", 160, **options)
    ours, theirs = files(tmp_path / "ours"), files(tmp_path / "theirs")
    assert set(names) == set(ours) and ours == theirs and "material.json" in ours


def test_arrays_are_those_of_the_files(tmp_path: Path) -> None:
    pillow = pytest.importorskip("PIL.Image")
    texture = jaspe.Texture("wood", seed=2)
    texture.bake_set(tmp_path / "set", 64, ["color"])
    (path,) = (tmp_path / "set").glob("*color*.png")
    bytes_of_file = np.asarray(pillow.open(path))
    assert np.abs(texture.bake(64, ["color"])["color"] * 255 - bytes_of_file).max() <= 0.5001


def test_the_preview_is_that_of_the_command_line(command: Callable[..., str], tmp_path: Path) -> None:
    words = ["--size", 96, "--maps", "color", "--preview", "--quiet"]
    command("bake", "organic", "--seed", 5, "-o", tmp_path / "theirs", *words)
    theirs = (tmp_path / "theirs" / "preview.png").read_bytes()
    texture = jaspe.Texture("organic", seed=5)
    assert texture.preview(96)._repr_png_() == theirs
    texture.bake_set(tmp_path / "ours", 96, ["color"], preview=True)
    assert (tmp_path / "ours" / "preview.png").read_bytes() == theirs


def test_previews_show_what_was_asked_for() -> None:
    told: list[tuple[int, int]] = []

    def preview(name: str, **options: Any) -> Any:
        return np.asarray(jaspe.Texture(name).preview(128, resolution=(96, 60), **options)).astype(int)

    ball = preview("marble", surface="sphere", progress=lambda done, total: told.append((done, total)))
    assert ball.shape == (60, 96, 3) and told[-1][0] == told[-1][1]
    assert not np.array_equal(ball, preview("marble"))
    # Fire is seen at dusk, and lights the floor before it: there it is redder than under the sky.
    fire, stone = preview("fire"), preview("stone")
    floor = (slice(52, 59), slice(10, 40))
    assert fire[floor].mean() < stone[floor].mean()
    assert (fire[floor][..., 0] - fire[floor][..., 2]).mean() > 5 > (stone[floor][..., 0] - stone[floor][..., 2]).mean()
    first, second = (preview("fire", frames=4, frame=frame) for frame in (0, 1))
    assert not np.array_equal(first, second)
    with pytest.raises(ValueError, match="frame: expected a number from 0 to 3"):
        preview("fire", frames=4, frame=4)
    with pytest.raises(ValueError, match="resolution: each side is from 1 to 16384"):
        jaspe.Texture("fire").preview(64, resolution=(0, 5))


def test_surfaces_have_their_own_shapes() -> None:
    assert jaspe.Texture("marble").bake(256, ["color"], surface="sphere")["color"].shape == (128, 256, 3)
    assert jaspe.Texture("marble").bake(256, ["height"], surface="cube")["height"].shape == (192, 256)


def test_other_files_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(OSError, match="letter.txt"):
        jaspe.Texture("marble").bake_set(tmp_path, 64)
    with pytest.raises(OSError, match="cannot write"):
        jaspe.Texture("marble").bake_set(tmp_path / "nowhere" / "set", 64)
    with pytest.raises(ValueError, match="bits: 32 does not go with"):
        jaspe.Texture("marble").bake_set(tmp_path / "set", 64, bits=32)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda t: t.bake(0), "size"),
        (lambda t: t.bake(64, ["colour"]), 'did you mean "color"'),
        (lambda t: t.bake(64, []), "no map"),
        (lambda t: t.bake(64, ["color", "color"]), "twice"),
        (lambda t: t.bake(64, tile=-1), "tile"),
        (lambda t: t.bake(64, normal="gd"), '"gl", "dx"'),
        (lambda t: t.bake(64, surface="torus"), '"plane", "sphere"'),
        (lambda t: t.bake(64, frames=3, frame=3), "frame: expected a number from 0 to 2"),
    ],
)
def test_what_is_refused_is_explained(call: Callable[[Any], object], words: str) -> None:
    with pytest.raises(ValueError) as caught:
        call(jaspe.Texture("marble"))
    assert words in str(caught.value)
