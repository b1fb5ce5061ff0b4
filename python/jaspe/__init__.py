"""Procedural materials: noise, textures and a ray tracer, over NumPy arrays.

    >>> import numpy as np
    >>> import jaspe

Noise over arrays of points, as many as you like, on all cores:

    >>> points = np.random.default_rng(1).random((1000, 3), np.float32)
    >>> jaspe.noise.perlin(points, seed=7).shape
    (1000,)

Six materials, each a colour at every point of space:

    >>> marble = jaspe.Texture("marble", depth=6)
    >>> marble.sample(points).shape
    (1000, 3)
    >>> marble.image(size=64)
    <jaspe.Image 64 x 64>

Scenes in the language of the Sunflow renderer, read, changed and rendered: `load`, `loads`. Notebooks show them.

The same input gives the same bits on every machine, on any number of threads, and the same as the command line and the
Rust libraries.
"""

from __future__ import annotations

from . import noise
from ._declarations import Declaration, Parameter, textures
from ._errors import Diagnostic, SceneError
from ._jaspe import Image, Texture, __version__
from ._maps import Maps
from ._scene import Scene, Shader, Shaders, load, loads

__all__ = [
    "Declaration",
    "Diagnostic",
    "Image",
    "Maps",
    "Parameter",
    "Scene",
    "SceneError",
    "Shader",
    "Shaders",
    "Texture",
    "load",
    "loads",
    "noise",
    "textures",
    "__version__",
]
