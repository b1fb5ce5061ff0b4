import os
from typing import Any, Callable, Literal, Mapping, Optional, Sequence, Union, final

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._errors import Diagnostic
from ._maps import Maps
from ._progress import Progress

__all__ = ["Image", "Scene", "Texture", "__version__", "_texture", "declarations", "noise"]

__version__: str

_Surface = Literal["plane", "sphere", "cube", "cylinder"]
# <maps>
_Map = Literal["color", "height", "normal", "roughness", "ao", "emission"]
# </maps>

def declarations() -> dict[str, Any]: ...
def noise(
    points: ArrayLike,
    *,
    basis: str,
    sum: Optional[str] = None,
    seed: Optional[int] = None,
    period: Union[int, Sequence[int], None] = None,
    gradient: bool = False,
    octaves: Optional[float] = None,
    lacunarity: float = 2.0,
    gain: float = 0.5,
    feature: str = "f1",
    metric: str = "euclidean",
    jitter: float = 1.0,
    warp: Union[float, Sequence[float], None] = None,
) -> Any: ...
def _texture(name: str, parameters: dict[str, Any]) -> Texture: ...
@final
class Image:
    def __new__(
        cls,
        pixels: ArrayLike,
        encoding: Literal["linear", "display"] = "linear",
        layers: Optional[Mapping[str, Image]] = None,
    ) -> Image: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def encoding(self) -> Literal["linear", "display"]: ...
    @property
    def pixels(self) -> NDArray[np.float32]: ...
    @property
    def linear(self) -> NDArray[np.float32]: ...
    @property
    def layers(self) -> dict[str, Image]: ...
    def display(self, bits: Literal[8, 16] = 8) -> NDArray[Any]: ...
    def save(self, path: Union[str, os.PathLike[str]], *, bits: Optional[Literal[8, 16]] = None) -> None: ...
    def __array__(self, dtype: Optional[DTypeLike] = None, copy: Optional[bool] = None) -> NDArray[Any]: ...
    def _repr_png_(self) -> bytes: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]

@final
class Scene:
    def __new__(
        cls, path: str, text: Optional[bytes], files: Mapping[str, bytes], disk: bool, assignments: Sequence[str]
    ) -> Scene: ...
    @property
    def path(self) -> str: ...
    def set(self, assignment: str) -> None: ...
    def parameters(self, name: str) -> dict[str, Any]: ...
    def shaders(self) -> list[tuple[str, str]]: ...
    def textures(self) -> list[tuple[str, str]]: ...
    def diagnostics(self) -> list[Diagnostic]: ...
    def text(self) -> bytes: ...
    def parts(self) -> tuple[str, bytes, dict[str, bytes], list[str]]: ...
    def resolution(
        self, resolution: Optional[Sequence[int]] = None, dialect: Optional[str] = None
    ) -> tuple[int, int]: ...
    def render(
        self,
        *,
        resolution: Optional[Sequence[int]],
        samples: Optional[int],
        aa: Optional[Sequence[int]],
        seed: int,
        crop: Optional[Sequence[int]],
        threads: Optional[int],
        dialect: Optional[str],
        look: Optional[str],
        layers: Sequence[str],
        progress: Optional[Callable[[int, int], object]],
    ) -> Image: ...

@final
class Texture:
    def __new__(cls, name: str, /, **parameters: Any) -> Texture: ...
    @property
    def name(self) -> str: ...
    @property
    def parameters(self) -> dict[str, Any]: ...
    def sample(self, points: ArrayLike) -> NDArray[np.float32]: ...
    def field(self, points: ArrayLike) -> NDArray[np.float32]: ...
    def image(self, size: Union[int, tuple[int, int], None] = None, scale: float = 1.0) -> Image: ...
    def bake(
        self,
        size: int = 1024,
        maps: Optional[Sequence[_Map]] = None,
        *,
        tile: Optional[float] = None,
        surface: _Surface = "plane",
        mesh: Union[str, os.PathLike[str], None] = None,
        normal: Literal["gl", "dx"] = "gl",
        frames: Optional[int] = None,
        pace: int = 1,
        frame: int = 0,
        progress: Progress = None,
    ) -> Maps: ...
    def bake_set(
        self,
        folder: Union[str, os.PathLike[str]],
        size: int = 1024,
        maps: Optional[Sequence[_Map]] = None,
        *,
        tile: Optional[float] = None,
        surface: _Surface = "plane",
        mesh: Union[str, os.PathLike[str], None] = None,
        normal: Literal["gl", "dx"] = "gl",
        frames: Optional[int] = None,
        pace: int = 1,
        format: Literal["png", "exr", "jpg", "webp"] = "png",
        bits: Optional[Literal[8, 16, 32]] = None,
        preview: bool = False,
        progress: Progress = None,
    ) -> list[str]: ...
    def preview(
        self,
        size: int = 1024,
        *,
        resolution: Union[int, tuple[int, int], None] = None,
        tile: Optional[float] = None,
        surface: _Surface = "plane",
        mesh: Union[str, os.PathLike[str], None] = None,
        frames: Optional[int] = None,
        pace: int = 1,
        frame: int = 0,
        progress: Progress = None,
    ) -> Image: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __eq__(self, other: object, /) -> bool: ...
    # <declared>
    @property
    def depth(self) -> int: ...
    @depth.setter
    def depth(self, value: Optional[int]) -> None: ...
    @property
    def diffuse_initial(self) -> tuple[float, float, float]: ...
    @diffuse_initial.setter
    def diffuse_initial(self, value: Optional[Union[Sequence[float], str]]) -> None: ...
    @property
    def diffuse_final(self) -> tuple[float, float, float]: ...
    @diffuse_final.setter
    def diffuse_final(self, value: Optional[Union[Sequence[float], str]]) -> None: ...
    @property
    def noise(self) -> str: ...
    @noise.setter
    def noise(self, value: Optional[Literal["improved", "classic", "lattice"]]) -> None: ...
    @property
    def sum(self) -> str: ...
    @sum.setter
    def sum(self, value: Optional[Literal["plain", "absolute"]]) -> None: ...
    @property
    def seed(self) -> int: ...
    @seed.setter
    def seed(self, value: Optional[int]) -> None: ...
    @property
    def scale(self) -> float: ...
    @scale.setter
    def scale(self, value: Optional[float]) -> None: ...
    @property
    def space(self) -> Optional[str]: ...
    @space.setter
    def space(self, value: Optional[Literal["local", "world", "uv"]]) -> None: ...
    # </declared>
