"""Pictures and animations over a Dask cluster: `pip install jaspe[distributed]`.

    from dask.distributed import Client
    import jaspe.distributed

    client = Client("scheduler:8786")
    image = jaspe.distributed.render(jaspe.load("scene.sc"), client, samples=256)

The result is the same, to the bit, as on one machine. A worker that dies is no loss: its parts are rendered by others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Iterator, Mapping, Optional, Union, overload

import numpy as np

from ._jaspe import Image
from ._progress import Progress, following
from ._scene import Scene

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["render", "render_frames"]

#: Parts for each thread of the cluster: enough that the last ones do not keep the others waiting.
_PARTS_PER_THREAD = 4

#: Smaller parts would be rendered sooner than they are sent, and pixels at their borders are looked at twice.
_LEAST_SIDE = 64


@overload
def render(scene: Scene, client: Client, *, progress: Progress = None, **options: Any) -> Image: ...
@overload
def render(scene: Iterable[Scene], client: Client, *, progress: Progress = None, **options: Any) -> list[Image]: ...
def render(
    scene: Union[Scene, Iterable[Scene]], client: Client, *, progress: Progress = None, **options: Any
) -> Union[Image, list[Image]]:
    """Renders a scene in parts, or several scenes as the frames of an animation, on the workers of a cluster.

    `options` are those of `Scene.render`; `threads` is the number of threads that each part takes, 1 unless given, since
    every thread of a worker has a part of its own.
    """
    if isinstance(scene, Scene):
        with following(progress, "rendering") as report:
            return _render_one(scene, client, report, options)
    scenes = list(scene)
    images: list[Optional[Image]] = [None] * len(scenes)
    with following(progress, "rendering") as report:
        for number, image in _frames(scenes, client, report, options):
            images[number] = image
    return [image for image in images if image is not None]


def render_frames(
    scenes: Iterable[Scene], client: Client, *, progress: Progress = None, **options: Any
) -> Iterator[tuple[int, Image]]:
    """Renders the frames of an animation, each on one worker, and gives them with their numbers as they are done.

    For long sequences, whose frames are saved as they come rather than kept: see `render` for the rest.
    """
    with following(progress, "rendering") as report:
        yield from _frames(list(scenes), client, report, options)


def _frames(
    scenes: list[Scene], client: Client, report: Any, options: Mapping[str, Any]
) -> Iterator[tuple[int, Image]]:
    """The frames as they are done."""
    for scene in scenes:
        # What is wrong with a scene is said here rather than in a traceback from elsewhere.
        scene.check()
    settings = {"threads": 1, **options}
    futures = {client.submit(_frame, scene, settings, pure=False): number for number, scene in enumerate(scenes)}
    for future in _as_completed(futures, client, report):
        yield futures[future], future.result()


def _render_one(scene: Scene, client: Client, report: Any, options: Mapping[str, Any]) -> Image:
    """A picture from its parts."""
    scene.check()
    crop = options.get("crop")
    if crop is None:
        width, height = options.get("resolution") or scene.resolution
        crop = (0, 0, width, height)
    settings = {"threads": 1, **options}
    # The scene travels as the result of a task, so that a worker that lost it has it made again.
    source = client.submit(_received, scene, pure=False)
    parts = _parts(crop, _thread_count(client))
    futures = {client.submit(_frame, source, {**settings, "crop": part}, pure=False): part for part in parts}
    left, top, right, bottom = crop
    pixels = np.zeros((bottom - top, right - left, 4), np.float32)
    layers: dict[str, Any] = {}
    encoding: Any = "linear"
    for future in _as_completed(futures, client, report):
        x0, y0, x1, y1 = futures[future]
        image = future.result()
        place = (slice(y0 - top, y1 - top), slice(x0 - left, x1 - left))
        encoding = image.encoding
        pixels[place] = image.pixels
        for name, layer in image.layers.items():
            layers.setdefault(name, np.zeros_like(pixels))[place] = layer.pixels
    return Image(pixels, encoding, {name: Image(layer, encoding) for name, layer in layers.items()})


def _as_completed(futures: Mapping[Any, object], client: Any, report: Any) -> Iterator[Any]:
    """The futures in the order in which they are done. Whatever ends the loop early, the rest is called off."""
    import distributed

    as_completed: Any = distributed.as_completed
    done = 0
    try:
        for future in as_completed(list(futures)):
            done += 1
            yield future
            if report is not None:
                report(done, len(futures))
    finally:
        if done < len(futures):
            client.cancel(list(futures))


def _thread_count(client: Any) -> int:
    return int(sum(client.nthreads().values()))


def _parts(crop: tuple[int, int, int, int], threads: int) -> list[tuple[int, int, int, int]]:
    """Nearly square parts of a rectangle, several for each thread, row by row."""
    left, top, right, bottom = crop
    area = (right - left) * (bottom - top)
    side = max(_LEAST_SIDE, int((area / max(1, threads * _PARTS_PER_THREAD)) ** 0.5))
    return [
        (x, y, min(x + side, right), min(y + side, bottom))
        for y in range(top, bottom, side)
        for x in range(left, right, side)
    ]


def _received(scene: Scene) -> Scene:
    """A scene on a worker. It compiles there once, for all parts."""
    return scene


def _frame(scene: Scene, options: Mapping[str, Any]) -> Image:
    """A part of a picture, or a whole one, on a worker."""
    return scene.render(progress=False, **options)
