"""Scenes: read, changed and rendered."""

from __future__ import annotations

import os
from typing import Any, Iterator, Mapping, Optional, Sequence, Union

from . import _jaspe
from ._errors import Diagnostic
from ._progress import Progress, following

__all__ = ["Scene", "Shader", "Shaders", "load", "loads"]

_Path = Union[str, "os.PathLike[str]"]


def load(path: _Path) -> Scene:
    """Reads a scene from a file, with everything that it includes.

    Raises `SceneError` when the scene has errors, and `OSError` when there is no such file.
    """
    # That the file cannot be read at all is not the scene's fault: the system's own exception names it.
    open(path, "rb").close()
    return Scene(_jaspe.Scene(os.fspath(path), None, {}, True, []))


def loads(
    text: Union[str, bytes],
    files: Optional[Mapping[str, Union[bytes, str, os.PathLike[str]]]] = None,
    *,
    name: str = "scene.sc",
) -> Scene:
    """Reads a scene from text, with the files that it names: their bytes, their text, or paths at which they are on disk.

    Without `files`, they are looked for on disk, relative to the current folder; with it, nothing outside of it is read.
    `name` is what messages call the scene.

    >>> scene = loads(\"\"\"
    ...     image { resolution 40 30 }
    ...     camera { type pinhole eye 0 0 4 target 0 0 0 up 0 1 0 fov 40 aspect 1.333 }
    ...     light { type point color 1 1 1 power 400 p 3 4 5 }
    ...     shader { name veined type marble }
    ...     object { shader veined type sphere c 0 0 0 r 1 }
    ... \"\"\")
    >>> scene.shaders["veined"].depth
    5
    >>> scene.shaders["veined"].depth = 8
    >>> scene.render(samples=4)
    <jaspe.Image 40 x 30>
    """
    known = {path: _bytes(content) for path, content in (files or {}).items()}
    return Scene(_jaspe.Scene(name, _bytes(text), known, files is None, []))


def _bytes(content: Union[bytes, str, os.PathLike[str]]) -> bytes:
    if isinstance(content, (bytes, bytearray, memoryview)):
        return bytes(content)
    if isinstance(content, str):
        return content.encode()
    with open(content, "rb") as file:
        return file.read()


class Scene:
    """A scene, as `load` and `loads` read it.

    Scenes can be copied (`copy.copy`) and pickled; with all files that they need, so that they render anywhere.
    """

    def __init__(self, native: _jaspe.Scene) -> None:
        self._native = native

    @property
    def shaders(self) -> Shaders:
        """The shaders by their names: `scene.shaders["wood0"].depth = 8`."""
        return Shaders(self._native, "shaders")

    @property
    def textures(self) -> Shaders:
        """The `texture` blocks by their names; they are read and set as shaders are."""
        return Shaders(self._native, "textures")

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All warnings and notes so far: those of reading and, after the first rendering or `check`, of compiling."""
        return self._native.diagnostics()

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        width, height = self._native.resolution()
        return width, height

    def set(self, assignment: str) -> None:
        """Changes a parameter of a shader or texture as the command line does: `scene.set("floor.depth=5")`."""
        self._native.set(assignment)

    def check(self) -> list[Diagnostic]:
        """Compiles the scene without rendering it, and returns all that is to be said about it.

        Raises `SceneError` when it has errors.
        """
        self._native.resolution()
        return self.diagnostics

    def text(self) -> str:
        """The scene as text, tidy, with everything that it includes: what `jaspe convert` writes."""
        return self._native.text().decode()

    def render(
        self,
        *,
        samples: Optional[int] = None,
        resolution: Optional[tuple[int, int]] = None,
        aa: Optional[tuple[int, int]] = None,
        seed: int = 0,
        crop: Optional[tuple[int, int, int, int]] = None,
        threads: Optional[int] = None,
        dialect: Optional[str] = None,
        look: Optional[str] = None,
        layers: Sequence[str] = (),
        progress: Progress = None,
    ) -> _jaspe.Image:
        """Renders the scene. Ctrl-C stops.

        - `samples`: exactly so many per pixel, in place of what the scene says.
        - `resolution`: width and height in pixels, in place of the scene's own.
        - `aa`: adaptive antialiasing in place of the scene's own, 2^least to 2^most samples along each edge of a pixel.
        - `seed`: another number gives other sampling noise.
        - `crop`: only this part, (x0, y0, x1, y1) in pixels from the top left, the ends excluded.
        - `threads`: how many work; all by default. The picture does not depend on it.
        - `dialect`: whose meaning the scene's words have, "sunflow" or "report", unless the scene says.
        - `look`: a quick look in place of every shader: "normals", "uvs", "ids", "ambocc" or "gray".
        - `layers`: looks that are rendered as well, and found in `Image.layers`.
        - `progress`: `True` shows a bar with the time left, `None` does so in a terminal or notebook where it takes
          longer than a second or two; a function is called with what is done and the total.
        """
        with following(progress, "rendering") as report:
            return self._native.render(
                resolution=_whole("resolution", resolution, 2, 1, 16_384),
                samples=_number("samples", samples, 1, 1_000_000),
                aa=_whole("aa", aa, 2, -8, 8),
                seed=_number("seed", seed, 0, 2**64 - 1),
                crop=_whole("crop", crop, 4, 0, 16_384),
                threads=_number("threads", threads, 1, 4096),
                dialect=dialect,
                look=look,
                layers=list(layers),
                progress=report,
            )

    def _repr_png_(self) -> bytes:
        """A small picture, by which notebooks show the scene."""
        width, height = self.resolution
        scale = min(1.0, 320 / max(width, height))
        size = max(1, round(width * scale)), max(1, round(height * scale))
        return self.render(resolution=size, samples=1, progress=False)._repr_png_()

    def __repr__(self) -> str:
        names = ", ".join(self.shaders)
        return f"<jaspe.Scene {self._native.path!r} with the shaders {names}>" if names else f"<jaspe.Scene {self._native.path!r}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, self._native.parts()


def _restore(path: str, text: bytes, files: dict[str, bytes], assignments: list[str]) -> Scene:
    return Scene(_jaspe.Scene(path, text, files, False, assignments))


def _number(name: str, value: Any, least: int, most: int) -> Any:
    """A whole number within a range, or nothing."""
    if value is None:
        return None
    if not hasattr(value, "__index__"):
        raise TypeError(f"{name}: expected a whole number, found {value!r}")
    number = value.__index__()
    if not least <= number <= most:
        raise ValueError(f"{name}: expected a number from {least} to {most}, found {number}")
    return number


def _whole(name: str, values: Any, count: int, least: int, most: int) -> Any:
    """So many whole numbers within a range, or nothing."""
    if values is None:
        return None
    if isinstance(values, (str, bytes)) or not hasattr(values, "__len__") or len(values) != count:
        raise TypeError(f"{name}: expected {count} whole numbers, found {values!r}")
    return [_number(name, value, least, most) for value in values]


class Shaders(Mapping[str, "Shader"]):
    """Shaders or textures of a scene by their names."""

    def __init__(self, native: _jaspe.Scene, kind: str) -> None:
        self._native = native
        self._kind = kind

    def _names(self) -> dict[str, str]:
        names: dict[str, str] = {}
        for name, kind in getattr(self._native, self._kind)():
            # Of two with the same name, the first one counts.
            names.setdefault(name, kind)
        return names

    def __getitem__(self, name: str) -> Shader:
        names = self._names()
        if name not in names:
            known = ", ".join(names) or "none"
            raise KeyError(f"there is no `{name}` among the {self._kind} of the scene: {known}")
        return Shader(self._native, name, names[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def __repr__(self) -> str:
        return f"{{{', '.join(f'{name!r}: {shader!r}' for name, shader in self.items())}}}"


class Shader:
    """A shader of a scene. Its parameters are attributes, and entries: `shader.depth = 8` or `shader["depth"] = 8`.

    Where a keyword has a dot, the attribute has an underscore: `glass.absorption_color`. Colours are linear light, as three
    numbers in a scene are; they can be set as text too, as on the command line: `"#ff8000"`.
    """

    _native: _jaspe.Scene
    name: str
    """Its name."""
    type: str
    """What kind of shader it is: "marble", "phong"."""

    def __init__(self, native: _jaspe.Scene, name: str, type: str) -> None:
        self.__dict__.update(_native=native, name=name, type=type)

    @property
    def parameters(self) -> dict[str, Any]:
        """All parameters with their values."""
        return self._native.parameters(self.name)

    def __getitem__(self, key: str) -> Any:
        parameters = self.parameters
        if key not in parameters:
            raise KeyError(self._unknown(key))
        return parameters[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self._native.set(f"{self.name}.{key}={_written(value)}")

    def __getattr__(self, attribute: str) -> Any:
        if attribute.startswith("__"):
            raise AttributeError(attribute)
        parameters = self.parameters
        key = _keyword(attribute, parameters)
        if key not in parameters:
            raise AttributeError(self._unknown(key))
        return parameters[key]

    def __setattr__(self, attribute: str, value: Any) -> None:
        self[_keyword(attribute, self.parameters)] = value

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key.replace(".", "_") for key in self.parameters)]

    def _unknown(self, key: str) -> str:
        known = ", ".join(self.parameters) or "none"
        return f"`{self.name}`, a {self.type}, has no parameter `{key}`; it has {known}"

    def __repr__(self) -> str:
        parameters = ", ".join(f"{key}={value!r}" for key, value in self.parameters.items())
        return f"<{self.type}: {parameters}>"


def _keyword(attribute: str, parameters: Mapping[str, Any]) -> str:
    """The keyword that an attribute stands for."""
    dotted = attribute.replace("_", ".", 1)
    return dotted if attribute not in parameters and dotted in parameters else attribute


def _written(value: Any) -> str:
    """A value as a scene has it."""
    if isinstance(value, str):
        return f'"{value}"' if any(letter.isspace() for letter in value) and not _has_numbers(value) else value
    if hasattr(value, "__iter__"):
        return " ".join(_written(part) for part in value)
    if isinstance(value, bool):
        return str(value).lower()
    if hasattr(value, "__index__"):
        return str(value.__index__())
    return repr(float(value))


def _has_numbers(text: str) -> bool:
    """Whether a text is numbers or a colour in braces, rather than the name of a file."""
    return text.lstrip()[:1] in tuple("{+-.#0123456789")
