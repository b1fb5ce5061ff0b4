"""`jaspe.Image`: arrays in and out, files."""

from __future__ import annotations

import io
import pickle
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import jaspe


def samples_of_png(data: bytes) -> tuple[int, int, int, int]:
    """Width, height, bits and the kind of colour of a PNG file."""
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    width, height, bits, kind = struct.unpack(">IIBB", data[16:26])
    return width, height, bits, kind


def picture() -> Any:
    light = np.zeros((4, 6, 3), np.float32)
    light[:, :, 0] = np.linspace(0, 1, 6)
    light[:, :, 2] = 0.25
    return light


def test_light_is_kept_and_encoded_for_the_display() -> None:
    image = jaspe.Image(picture())
    assert (image.width, image.height, image.encoding) == (6, 4, "linear")
    assert np.array_equal(image.linear, picture())
    assert image.pixels.shape == (4, 6, 4) and (image.pixels[..., 3] == 1).all()
    shown = np.asarray(image)
    assert shown.dtype == np.uint8 and shown.shape == (4, 6, 3)
    # sRGB by its own formula: a quarter of the light is 137 of 255.
    assert (shown[..., 2] == 137).all() and shown[0, 0, 0] == 0 and shown[0, 5, 0] == 255
    assert image.display(16).dtype == np.uint16 and image.display(16)[0, 5, 0] == 65535
    assert np.array_equal(np.asarray(image, dtype=np.float64), shown)


def test_coverage_is_straight_alpha() -> None:
    light = np.full((2, 2, 4), 0.5, np.float32)
    shown = np.asarray(jaspe.Image(light))
    assert shown.shape == (2, 2, 4) and (shown[..., :3] == 255).all() and (shown[..., 3] == 128).all()


def test_display_values_are_not_encoded_again() -> None:
    image = jaspe.Image(picture(), encoding="display")
    assert np.asarray(image)[0, 0, 2] == 64
    assert abs(image.linear[0, 0, 2] - 0.0509) < 1e-4


def test_images_are_values() -> None:
    image = jaspe.Image(picture(), layers={"half": jaspe.Image(picture() / 2)})
    other = pickle.loads(pickle.dumps(image))
    assert other == image and other.layers["half"] == jaspe.Image(picture() / 2)
    assert image != jaspe.Image(picture())
    assert repr(image) == "<jaspe.Image 6 x 4>"


def test_files_are_chosen_by_extension(tmp_path: Path) -> None:
    image = jaspe.Image(picture())
    for name, magic in {
        "a.png": b"\x89PNG", "a.jpg": b"\xff\xd8", "a.exr": b"v/1\x01", "a.hdr": b"#?RADIANCE", "a.bmp": b"BM",
        "a.tiff": b"II",
    }.items():
        image.save(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(magic), name
    image.save(str(tmp_path / "b.png"), bits=16)
    assert samples_of_png((tmp_path / "b.png").read_bytes()) == (6, 4, 16, 2)
    assert samples_of_png(image._repr_png_()) == (6, 4, 8, 2)
    assert image._repr_png_() == (tmp_path / "a.png").read_bytes()


def test_pillow_and_pyplot_take_images() -> None:
    pillow = pytest.importorskip("PIL.Image")
    image = jaspe.Image(picture())
    assert np.array_equal(np.asarray(pillow.fromarray(np.asarray(image))), np.asarray(image))
    assert np.array_equal(np.asarray(pillow.open(io.BytesIO(image._repr_png_()))), np.asarray(image))


def test_what_is_refused_is_explained(tmp_path: Path) -> None:
    image = jaspe.Image(picture())
    with pytest.raises(ValueError, match="height, width, 3"):
        jaspe.Image(np.zeros((4, 6)))
    with pytest.raises(ValueError, match="height, width, 3"):
        jaspe.Image(np.zeros((4, 6, 2)))
    with pytest.raises(ValueError, match="height, width, 3"):
        jaspe.Image(np.zeros((0, 6, 3)))
    with pytest.raises(ValueError, match='"linear" or "display"'):
        jaspe.Image(picture(), encoding="srgb")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"unknown picture format `.gif`; .*\.png"):
        image.save(tmp_path / "a.gif")
    with pytest.raises(ValueError, match="8 or 16"):
        image.save(tmp_path / "a.png", bits=12)  # type: ignore[arg-type]
    with pytest.raises(OSError, match="there is no folder"):
        image.save(tmp_path / "nowhere" / "a.png")
    with pytest.raises(ValueError, match="without a copy"):
        image.__array__(copy=False)
    assert list(tmp_path.iterdir()) == []


def test_png_samples_are_the_array() -> None:
    # Rows of a PNG without filters, decoded here: the file holds what the array says.
    image = jaspe.Image(picture())
    data, place, packed = image._repr_png_(), 8, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place : place + 8])
        packed += data[place + 8 : place + 8 + length] if kind == b"IDAT" else b""
        place += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(4, 19)
    decoded = np.zeros((4, 18), np.uint8)
    for y, row in enumerate(rows):
        above = decoded[y - 1] if y else np.zeros(18, np.uint8)
        for x in range(18):
            left = int(decoded[y, x - 3]) if x >= 3 else 0
            corner = int(above[x - 3]) if x >= 3 else 0
            up = int(above[x])
            near = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            guess = {0: 0, 1: left, 2: up, 3: (left + up) // 2, 4: near}[int(row[0])]
            decoded[y, x] = (int(row[x + 1]) + guess) % 256
    assert np.array_equal(decoded.reshape(4, 6, 3), np.asarray(image))
