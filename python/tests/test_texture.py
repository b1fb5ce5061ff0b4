"""`jaspe.Texture`: parameters, colours, pictures."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest

import jaspe

#: The same without its types, for calls that a type checker refuses.
untyped: Any = jaspe

NAMES = [material.name for material in jaspe.textures()]


def points(count: int = 1000, dimensions: int = 3) -> Any:
    return np.random.default_rng(2).uniform(-2, 2, (count, dimensions)).astype(np.float32)


def test_materials_are_listed() -> None:
    assert {"fire", "water", "organic", "wood", "marble", "stone"} <= set(NAMES)
    for material in jaspe.textures():
        texture = jaspe.Texture(material.name)
        assert material.summary and material.parameters
        for parameter in material.parameters:
            assert getattr(texture, parameter.name) == parameter.default
            assert parameter.summary in (type(texture).__dict__[parameter.name].__doc__ or "")
            assert (parameter.kind == "choice") == bool(parameter.choices)


@pytest.mark.parametrize("name", NAMES)
def test_parameters_are_read_and_set(name: str) -> None:
    texture = jaspe.Texture(name, depth=6, diffuse_initial=(1, 0.5, 0), noise="classic")
    assert (texture.depth, texture.diffuse_initial, texture.noise) == (6, (1.0, 0.5, 0.0), "classic")
    before = texture.sample(points())
    untyped_texture: Any = texture
    untyped_texture.depth = np.int64(2)
    texture.diffuse_final = "0.25 0.5 0.75"
    assert texture.parameters["depth"] == 2 and texture.diffuse_final == (0.25, 0.5, 0.75)
    assert not np.array_equal(texture.sample(points()), before)
    texture.depth = None
    assert texture.depth == jaspe.Texture(name).depth
    for other in (eval(repr(texture), {"Texture": jaspe.Texture}), copy.copy(texture), pickle.loads(pickle.dumps(texture))):
        assert other == texture and other is not texture
    assert texture != jaspe.Texture(name)


@pytest.mark.parametrize("name", NAMES)
def test_colours_mix_by_the_field(name: str) -> None:
    texture = jaspe.Texture(name, seed=3)
    at = points(3000).reshape(30, 100, 3)
    colors, field = texture.sample(at), texture.field(at)
    assert colors.shape == (30, 100, 3) and field.shape == (30, 100)
    assert colors.dtype == field.dtype == np.float32
    assert 0 <= colors.min() and colors.max() <= 1
    initial, final = np.array(texture.diffuse_initial, np.float32), np.array(texture.diffuse_final, np.float32)
    w = field[..., None]
    assert np.allclose(colors, np.clip(w * initial + (1 - w) * final, 0, 1), atol=1e-6)
    # Neither strides nor batches nor precision leave a trace.
    assert np.array_equal(texture.sample(np.asfortranarray(at)), colors)
    assert np.array_equal(texture.sample(at.astype(np.float64)), colors)
    assert np.array_equal(texture.sample(at[3, 4]), colors[3, 4])


def test_texture_coordinates_have_two_numbers() -> None:
    texture = jaspe.Texture("marble", space="uv")
    assert texture.sample(points(5, 2)).shape == (5, 3)
    with pytest.raises(ValueError, match="holds 2 coordinates, found an array of shape"):
        texture.sample(points(5, 3))


@pytest.mark.parametrize("name", NAMES)
def test_pictures_are_those_of_the_command_line(name: str, command: Callable[..., str], tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours.png", tmp_path / "theirs.png"
    command("texture", name, "-o", theirs, "--size", "48x32", "--scale", "0.5", "--set", "seed=9", "--quiet")
    jaspe.Texture(name, seed=9).image((48, 32), scale=0.5).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: untyped.Texture("marbel"), ValueError, "did you mean `marble`"),
        (lambda: untyped.Texture("marble", dept=3), TypeError, "did you mean `depth`"),
        (lambda: untyped.Texture("marble", depth=99), ValueError, "from 0 to 32, found 99"),
        (lambda: untyped.Texture("marble", depth=1.5), TypeError, "whole number"),
        (lambda: untyped.Texture("marble", diffuse_final=(1, 2)), TypeError, "colour"),
        (lambda: untyped.Texture("marble", diffuse_final=(1, 2, 0)), ValueError, "from 0 to 1"),
        (lambda: untyped.Texture("marble", noise="simplex"), ValueError, "improved"),
        (lambda: untyped.Texture("marble").image(0), ValueError, "from 1 to 16384"),
        (lambda: untyped.Texture("marble").image("big"), TypeError, "(width, height)"),
        (lambda: untyped.Texture("marble").image(scale=0), ValueError, "scale"),
        (lambda: setattr(untyped.Texture("marble"), "dept", 3), AttributeError, "dept"),
    ],
)
def test_what_is_refused_is_explained(call: Callable[[], object], error: type[Exception], words: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert words in str(caught.value)


def test_a_refused_value_changes_nothing() -> None:
    texture = jaspe.Texture("wood", depth=3)
    with pytest.raises(ValueError):
        texture.depth = 1000
    assert texture.depth == 3
