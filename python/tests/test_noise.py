"""`jaspe.noise`: values, shapes, strides, periods, gradients, and what is refused."""

from __future__ import annotations

import hashlib
import os
import pickle
import subprocess
import sys
import threading
import time
from typing import Any, Callable

import numpy as np
import pytest

from jaspe import _jaspe, noise

#: The same without its types, for calls that a type checker refuses.
untyped: Any = noise

BASES = noise.names()
SUMS = ["fbm", "turbulence", "ridged", "hybrid"]
ALL = BASES + SUMS


def scattered(count: int, dimensions: int, dtype: Any = np.float32) -> Any:
    return np.random.default_rng(5).uniform(-30, 30, (count, dimensions)).astype(dtype)


def test_published_values_are_met() -> None:
    points = np.array([[0.5, 0.25, 0.5], [-4.2, 10, 6], [3.14, 42, 7], [-3, 7, 11]])
    assert noise.perlin(points).tolist() == [-0.262939453125, 0.14208000000000043, 0.13691995878400012, 0]
    # One point gives one number.
    value = noise.improved((0.5, 0.25, 0.5))
    assert isinstance(value, np.float64) and value == -0.262939453125
    assert isinstance(noise.perlin(np.array([0.5, 0.25, 0.5], np.float32)), np.float32)


@pytest.mark.parametrize("name", ALL)
def test_every_function_is_the_command_lines(name: str, command: Callable[..., str]) -> None:
    points = scattered(20, 3, np.float64)
    words = [name, "-"] if name in BASES else ["improved", "-", "--sum", name]
    lines = command(
        "noise", *words, "--seed", 7, "--gradient", stdin="\n".join(" ".join(map(repr, p)) for p in points.tolist())
    )
    expected = np.array([[float(word) for word in line.split()] for line in lines.splitlines()])
    values, gradient = getattr(noise, name)(points, seed=7, gradient=True)
    assert np.array_equal(values, expected[:, 0])
    assert np.array_equal(gradient, expected[:, 1:])


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("dimensions", [1, 2, 3, 4])
def test_strides_and_batches_leave_no_trace(name: str, dimensions: int) -> None:
    function = getattr(noise, name)
    points = scattered(5000, dimensions)
    values, gradient = function(points, gradient=True)
    assert values.dtype == gradient.dtype == np.float32
    assert values.shape == (5000,) and gradient.shape == (5000, dimensions)
    assert np.array_equal(function(points), values)
    cube = points.reshape(10, 20, 25, dimensions)
    turned = cube.transpose(2, 0, 1, 3)
    views = {
        "columns": (np.asfortranarray(points), values),
        "reversed": (points[::-1], values[::-1]),
        "every third": (points[::3], values[::3]),
        "planes": (np.moveaxis(np.ascontiguousarray(np.moveaxis(cube, -1, 0)), 0, -1), values.reshape(10, 20, 25)),
        "a part of planes": (np.ascontiguousarray(np.moveaxis(cube, -1, 0)).transpose(1, 2, 3, 0)[:, ::2], values.reshape(10, 20, 25)[:, ::2]),
        "crossed": (np.ascontiguousarray(cube.transpose(1, 0, 2, 3)).transpose(1, 0, 2, 3), values.reshape(10, 20, 25)),
        "turned": (turned, values.reshape(10, 20, 25).transpose(2, 0, 1)),
        "fortran": (np.asfortranarray(cube), values.reshape(10, 20, 25)),
        "foreign bytes": (points.astype(">f4"), values),
        "one point at a time": (points[7], values[7]),
        "none": (points[:0], values[:0]),
        "repeated": (np.broadcast_to(points[3], (4000, dimensions)), np.repeat(values[3], 4000)),
    }
    for what, (view, expected) in views.items():
        found = function(view)
        assert found.shape == expected.shape and np.array_equal(found, expected), what
        slopes = function(view, gradient=True)[1]
        assert slopes.shape == view.shape, what
    assert np.array_equal(function(turned, gradient=True)[1], gradient.reshape(cube.shape).transpose(2, 0, 1, 3))
    odd = np.zeros(points.nbytes + 1, np.uint8)[1:].view(np.float32).reshape(points.shape)
    odd[...] = points
    assert np.array_equal(function(odd), values), "unaligned"


@pytest.mark.parametrize("name", [name for name in ALL if name != "white"])
def test_gradients_agree_with_differences(name: str) -> None:
    points = scattered(200, 3, np.float64)
    gradient = getattr(noise, name)(points, gradient=True)[1]
    step = 1e-6
    octaves = {} if name in BASES else {"octaves": 3}
    if octaves:
        gradient = getattr(noise, name)(points, gradient=True, **octaves)[1]
    for axis in range(3):
        along = step * np.eye(3)[axis]
        function = getattr(noise, name)
        slope = (function(points + along, **octaves) - function(points - along, **octaves)) / (2 * step)
        # A crease may lie between the two points.
        assert np.quantile(np.abs(slope - gradient[:, axis]), 0.98) < 1e-5


def test_precisions_are_those_of_the_points() -> None:
    points = scattered(100, 3)
    single = noise.fbm(points)
    assert noise.fbm(points.astype(np.float16)).dtype == np.float32
    double = noise.fbm(points.astype(np.float64))
    assert double.dtype == np.float64 and np.abs(double - single).max() < 1e-3
    assert noise.fbm(points.astype(int)).dtype == np.float64
    assert noise.fbm([[1, 2, 3]]).shape == (1,)


@pytest.mark.parametrize("name", ALL)
def test_periods_are_exact(name: str) -> None:
    # Multiples of 1/64, so that the shifted points are exact.
    points = np.random.default_rng(1).integers(-640, 640, (500, 3)).astype(np.float32) / 64
    function = getattr(noise, name)
    values = function(points, period=(5, 6, 7))
    assert np.array_equal(function(points + np.array([5, 12, -7], np.float32), period=(5, 6, 7)), values)
    assert np.array_equal(function(points + np.float32(4), period=4), function(points, period=4))
    assert not np.array_equal(function(points + np.float32(4)), function(points))


def test_options_reach_the_library() -> None:
    points = scattered(300, 3, np.float64)
    distances = noise.cellular(points, metric="manhattan", jitter=0.5)
    assert np.all(distances >= noise.cellular(points, jitter=0.5))
    first, second = noise.cellular(points), noise.cellular(points, feature="f2")
    assert np.allclose(noise.cellular(points, feature="f2-f1"), second - first)
    assert np.array_equal(noise.fbm(points, octaves=1), noise.perlin(points))
    two = noise.perlin(points) + 0.25 * noise.perlin(3 * points)
    assert np.allclose(noise.fbm(points, octaves=2, lacunarity=3, gain=0.25), two, atol=1e-14)
    assert np.array_equal(noise.fbm(points, basis="perlin"), noise.fbm(points))
    assert np.array_equal(noise.ridged(points, basis="cellular", feature="f2"),
                          noise.ridged(points, basis="cellular", feature="f2"))
    assert not np.array_equal(noise.fbm(points, warp=0.5), noise.fbm(points))
    assert np.array_equal(noise.fbm(points, warp=[0.5]), noise.fbm(points, warp=0.5))
    assert not np.array_equal(noise.fbm(points, warp=[0.5, 0.2]), noise.fbm(points, warp=0.5))


def test_values_stay_within_the_declared_range() -> None:
    for entry in _jaspe.declarations()["bases"]:
        for dimensions, (least, largest, mean, variance) in enumerate(entry["statistics"], 1):
            values = getattr(noise, entry["name"])(scattered(200_000, dimensions))
            assert least <= values.min() and values.max() <= largest
            # Random points of one seed: a tenth of the standard deviation is far outside of chance.
            assert abs(values.mean() - mean) < 0.1 * variance**0.5 or dimensions == 1


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: untyped.perlin(3.0), ValueError, "last axis"),
        (lambda: untyped.perlin(np.zeros(7)), ValueError, "points[..., None]"),
        (lambda: untyped.perlin(np.zeros((3, 100))), ValueError, "moveaxis"),
        (lambda: untyped.perlin(np.zeros((2, 3), complex)), TypeError, "complex128"),
        (lambda: untyped.perlin("abc"), TypeError, "real numbers"),
        (lambda: untyped.perlin([0, 0, 0], seed=-1), ValueError, "seed"),
        (lambda: untyped.perlin([0, 0, 0], seed=0.5), TypeError, "seed"),
        (lambda: untyped.perlin([0, 0, 0], period=(1, 2, 3, 4)), ValueError, "found 4 for points of 3"),
        (lambda: untyped.perlin([0, 0, 0], period=1.5), TypeError, "whole number"),
        (lambda: untyped.perlin([0, 0, 0], period=-1), ValueError, "found -1"),
        (lambda: untyped.perlin([0, 0, 0], period=1 << 40), ValueError, "found"),
        (lambda: untyped.simplex([0, 0, 0], period=1 << 24), ValueError, "up to 2097152"),
        (lambda: untyped.fbm([0, 0, 0], basis="simplx"), ValueError, 'did you mean "simplex"'),
        (lambda: untyped.fbm([0, 0, 0], octaves=float("nan")), ValueError, "octaves"),
        (lambda: untyped.fbm([0, 0, 0], warp="far"), TypeError, "warp"),
        (lambda: untyped.perlin([0, 0, 0], octaves=3), TypeError, "octaves"),
        (lambda: untyped.cellular([0, 0, 0], metric="taxi"), ValueError, '"manhattan"'),
    ],
)
def test_what_is_refused_is_explained(call: Callable[[], object], error: type[Exception], words: str) -> None:
    with pytest.raises(error) as caught:
        call()
    assert words in str(caught.value)


def test_numbers_that_are_none_give_none() -> None:
    values = noise.fbm(np.array([[np.nan, 0, 0], [0, np.inf, 0], [1e30, 0, 0]]))
    assert np.isnan(values[:2]).all() and np.isfinite(values[2])


def test_other_threads_run_meanwhile() -> None:
    points = scattered(2_000_000, 3)
    ticks = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    started = time.perf_counter()
    noise.fbm(points)
    ended = time.perf_counter()
    done.set()
    thread.join()
    assert sum(started < tick < ended for tick in ticks) >= 3


def test_the_number_of_threads_leaves_no_trace() -> None:
    script = (
        "import numpy as np, sys; from jaspe import noise;"
        "p = np.random.default_rng(3).uniform(-9, 9, (100_000, 3)).astype(np.float32);"
        "sys.stdout.buffer.write(noise.fbm(p).tobytes())"
    )
    results = [
        subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "RAYON_NUM_THREADS": threads}, stdout=subprocess.PIPE, check=True,
        ).stdout
        for threads in ("1", "3")
    ]
    assert len(results[0]) == 400_000 and results[0] == results[1]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system forks no processes")
def test_forked_processes_have_threads() -> None:
    script = (
        "import os, numpy as np; from jaspe import noise;"
        "p = np.zeros((100_000, 3), np.float32); noise.perlin(p);"
        "child = os.fork();\n"
        "if child == 0: noise.perlin(p); os._exit(7)\n"
        "raise SystemExit(os.waitpid(child, 0)[1] >> 8)"
    )
    assert subprocess.run([sys.executable, "-W", "ignore", "-c", script], timeout=60).returncode == 7


def test_functions_are_documented_and_pickle() -> None:
    for name in noise.__all__:
        function = getattr(noise, name)
        assert function.__doc__
        assert pickle.loads(pickle.dumps(function)) is function
    assert "Perlin" in str(noise.perlin.__doc__)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("dimensions", [1, 2, 3, 4])
def test_a_grid_is_its_points(name: str, dimensions: int) -> None:
    lengths = [50, 30, 60, 4][:dimensions]
    axes = [np.linspace(-1, 2 + axis, length) for axis, length in enumerate(lengths)]
    grid = noise.Grid(*axes)
    assert grid.shape == tuple(reversed(lengths))
    points = grid.points()
    assert points.dtype == np.float32 and points.shape == (*grid.shape, dimensions)
    assert points[(1,) * dimensions].tolist() == [np.float32(axis[1]) for axis in axes]
    function = getattr(noise, name)
    several = {} if name in BASES else {"octaves": 3}
    values = function(grid, seed=3, **several)
    assert values.dtype == np.float32 and values.shape == grid.shape and values.flags.c_contiguous
    exact = function(points, seed=3, **several)
    assert np.abs(values - exact).max() <= (2e-6 if name in BASES else 2e-6 * 17.5)
    if name in ("simplex", "cellular", "white"):
        assert np.array_equal(values, exact)
    value, gradient = function(grid, seed=3, gradient=True, **several)
    assert np.array_equal(value, values) and gradient.shape == points.shape
    assert gradient.dtype == np.float32 and gradient.flags.c_contiguous
    _, slopes = function(points, seed=3, gradient=True, **several)
    assert np.abs(gradient - slopes).max() <= (2e-6 if name in BASES else 2e-6 * 30)


def test_a_grid_keeps_its_bits_whatever_the_threads() -> None:
    grid = noise.Grid(np.arange(300) * 0.02, np.arange(200) * 0.03, np.arange(20) * 0.1)
    script = (
        "import numpy as np; from jaspe import noise; import hashlib;"
        "grid = noise.Grid(np.arange(300) * 0.02, np.arange(200) * 0.03, np.arange(20) * 0.1);"
        "parts = noise.fbm(grid, octaves=3, gradient=True);"
        "print(hashlib.sha256(b''.join(part.tobytes() for part in parts)).hexdigest())"
    )
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    one = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    parts = noise.fbm(grid, octaves=3, gradient=True)
    assert hashlib.sha256(b"".join(part.tobytes() for part in parts)).hexdigest() == one.stdout.strip()


def test_grids_that_are_refused_say_why() -> None:
    for axes, message in [
        ((), "a grid has one to four axes, found 0; for instance Grid"),
        (([1.0], [2.0], [3.0], [4.0], [5.0]), "one to four axes, found 5"),
        (([[1.0, 2.0]],), r"x: expected the coordinates along one axis, found an array of shape \(1, 2\)"),
        (([1.0], 2.0), r"y: expected the coordinates along one axis, found an array of shape \(\)"),
        (([1.0], ["a"]), "y: coordinates are real numbers"),
        ((np.zeros(2**21, np.float32),) * 3, "larger than any array"),
    ]:
        with pytest.raises((TypeError, ValueError), match=message):
            untyped.Grid(*axes)
    with pytest.raises(ValueError, match="found 3 for points of 2 coordinates"):
        noise.perlin(noise.Grid([0.5], [0.5]), period=(1, 2, 3))
    assert noise.perlin(noise.Grid([], [0.5])).shape == (1, 0)
    grid = pickle.loads(pickle.dumps(noise.Grid([0.5, 1], [0.25], [7])))
    assert repr(grid) == "<jaspe.noise.Grid of 2 × 1 × 1 points>"
    assert np.array_equal(grid, [[[[0.5, 0.25, 7], [1, 0.25, 7]]]])
