"""Every noise and every sum of its octaves, over arrays of points.

Each function takes points of shape (…, 1), (…, 2), (…, 3) or (…, 4), with the coordinates along the last axis, and returns
values of shape (…). Arrays may have any strides. float32 (and float16) is evaluated in single precision, everything else in
double precision; single precision is many times as fast. The interpreter's lock is released and all cores work.

    >>> import numpy as np
    >>> float(perlin(np.array([0.5, 0.25, 0.5])))
    -0.262939453125
    >>> value, gradient = fbm(np.zeros((5, 7, 3), np.float32), octaves=4, gradient=True)
    >>> value.shape, gradient.shape
    ((5, 7), (5, 7, 3))

On a grid, give `Grid(x, y, z)` in place of points: it needs no array of them, and takes a fraction of the time.

    >>> x, y = np.arange(640) / 40, np.arange(480) / 40
    >>> fbm(Grid(x, y), octaves=4).shape
    (480, 640)

The noises are one function each: see `names()`. The sums add up octaves of any of them: `basis="simplex"`. What they are,
with formulas, sources and statistics, stands in docs/noise.md.
"""

# The functions are made here from what the library declares of its noises; `noise.pyi` is written from the same declarations
# by python/stubs.py, and a test holds it to them.

from __future__ import annotations

import inspect
from typing import Any, Callable

from . import _jaspe
from ._jaspe import Grid

#: The parameters of every function: name, default, what it is.
_COMMON: list[tuple[str, Any, str]] = [
    ("seed", 0, "Another number gives another noise; 0 is the published table."),
    (
        "period",
        None,
        "Repeat exactly after so many cells: a whole number for all axes, or one for each, where 0 leaves an axis without. "
        "(A sum repeats if its lacunarity is a whole number.)",
    ),
    ("gradient", False, "Return (values, gradient), with the exact derivative along each axis, of the shape of the points."),
]
_SUMS: list[tuple[str, Any, str]] = [
    ("basis", "improved", "The noise whose octaves are added, by its name."),
    ("octaves", 9.0, "How many octaves, from 1 to 64; the part past the point is the weight of one more, which fades in."),
    ("lacunarity", 2.0, "The ratio between the frequencies of neighbouring octaves."),
    ("gain", 0.5, "The ratio between their amplitudes."),
]
_CELLULAR: list[tuple[str, Any, str]] = [
    (
        "feature",
        "f1",
        'What is told of the feature points: "f1", the distance to the nearest; "f2", to the second nearest; "f2-f1", the '
        'difference; "cell", a random number of the nearest.',
    ),
    ("metric", "euclidean", 'How distances are measured: "euclidean", "manhattan" or "chebyshev".'),
    ("jitter", 1.0, "How far feature points stray from the middles of their cells, from 0 to 1."),
]
_WARP: list[tuple[str, Any, str]] = [
    ("warp", None, "Displace the points so far by the same field first, in their own units; again for each number of a sequence."),
]

__all__: list[str] = ["Grid"]


def names() -> list[str]:
    """The names of all noises, as `basis` takes them.

    >>> names()
    ['improved', 'classic', 'lattice', 'value', 'simplex', 'cellular', 'white']
    """
    return [entry["name"] for entry in _jaspe.declarations()["bases"]]


def _parameters(kind: str, name: str) -> list[tuple[str, Any, str]]:
    """The parameters of a function, after the points."""
    if kind == "sums":
        return _COMMON + _SUMS + _CELLULAR + _WARP
    return _COMMON + (_CELLULAR if name == "cellular" else []) + _WARP


def _documentation(kind: str, entry: dict[str, Any]) -> str:
    """What a function says of itself."""
    lines = [entry["sentence"], "", f"Formula: {entry['formula']}.", "", f"Source: {entry['source']}.", ""]
    if kind == "bases":
        ranges = [f"from {least} to {most}" for least, most, _, _ in entry["statistics"]]
        lines += ["Range in one to four dimensions: " + "; ".join(ranges) + ".", ""]
    lines += ["- `points`: an array whose last axis holds the coordinates, or a `Grid`."]
    lines += [f"- `{name}`: {text}" for name, _, text in _parameters(kind, entry["name"])]
    return "\n".join(lines)


def _function(kind: str, entry: dict[str, Any]) -> Callable[..., Any]:
    """The function of a noise or a sum."""
    parameters = _parameters(kind, entry["name"])
    positional = {name for name, _, _ in _COMMON}
    fixed = {"basis": entry["name"]} if kind == "bases" else {"sum": entry["name"]}
    signature = inspect.Signature(
        [inspect.Parameter("points", inspect.Parameter.POSITIONAL_OR_KEYWORD)]
        + [
            inspect.Parameter(
                name,
                inspect.Parameter.POSITIONAL_OR_KEYWORD if name in positional else inspect.Parameter.KEYWORD_ONLY,
                default=default,
            )
            for name, default, _ in parameters
        ]
    )

    defaults = {name: default for name, default, _ in parameters}

    def function(*args: Any, **kwargs: Any) -> Any:
        arguments = signature.bind(*args, **kwargs).arguments
        points = arguments.pop("points")
        return _jaspe.noise(points, **fixed, **{**defaults, **arguments})

    function.__name__ = function.__qualname__ = entry["term"]
    function.__doc__ = _documentation(kind, entry)
    function.__signature__ = signature  # type: ignore[attr-defined]
    return function


def _define() -> None:
    declarations = _jaspe.declarations()
    for kind in ("bases", "sums"):
        for entry in declarations[kind]:
            function = _function(kind, entry)
            for name in dict.fromkeys((entry["term"], entry["name"])):
                # "plain" and "absolute" are words of the scene language, and tell too little here.
                if kind == "bases" or name == entry["term"]:
                    globals()[name] = function
                    __all__.append(name)


_define()
__all__.append("names")
