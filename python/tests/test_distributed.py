"""`jaspe.distributed`: the same bits on a cluster, whatever happens to its workers."""

from __future__ import annotations

import copy
import os
import signal
import threading
import time
from typing import Any, Iterator

import pytest

import jaspe

distributed: Any = pytest.importorskip("distributed")

import jaspe.distributed  # noqa: E402

SCENE = """
image { resolution 200 150 aa 0 1 }
camera { type pinhole eye 0 1 5 target 0 0 0 up 0 1 0 fov 40 aspect 1.333 }
light { type point color 1 1 1 power 600 p 3 4 5 }
shader { name veined type marble depth 6 }
shader { name floor type wood }
object { shader veined type sphere c 0 0 0 r 1 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
"""


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:
        yield client


def scene() -> jaspe.Scene:
    return jaspe.loads(SCENE)


def test_a_picture_is_that_of_one_machine(client: Any) -> None:
    told: list[tuple[int, int]] = []
    image = jaspe.distributed.render(
        scene(), client, seed=3, layers=["ids"], progress=lambda done, total: told.append((done, total))
    )
    assert image == scene().render(seed=3, layers=["ids"])
    assert len(told) == told[-1][0] == told[-1][1] > 3
    part = jaspe.distributed.render(scene(), client, resolution=(300, 200), samples=2, crop=(11, 13, 217, 180))
    assert part == scene().render(resolution=(300, 200), samples=2, crop=(11, 13, 217, 180))
    assert jaspe.distributed.render(scene(), client, dialect="report") == scene().render(dialect="report")


def test_changes_travel_along(client: Any) -> None:
    changed = scene()
    changed.shaders["veined"].depth = 1
    assert jaspe.distributed.render(changed, client, samples=1) == changed.render(samples=1)


def test_an_animation_is_rendered_in_order(client: Any) -> None:
    frames = []
    for depth in (1, 2, 3):
        frame = copy.copy(scene())
        frame.shaders["veined"].depth = depth
        frames.append(frame)
    images = jaspe.distributed.render(frames, client, samples=1, resolution=(60, 40))
    assert images == [frame.render(samples=1, resolution=(60, 40)) for frame in frames]
    assert images[0] != images[2]
    later = dict(jaspe.distributed.render_frames(frames, client, samples=1, resolution=(60, 40)))
    assert [later[number] for number in range(3)] == images


def test_mistakes_come_back(client: Any) -> None:
    with pytest.raises(jaspe.SceneError, match="no camera"):
        jaspe.distributed.render([jaspe.loads("image { resolution 8 8 }")], client)
    with pytest.raises(ValueError, match="look"):
        jaspe.distributed.render(scene(), client, look="normal")


@pytest.mark.skipif(os.name == "nt", reason="processes are ended otherwise there")
def test_a_worker_may_die(client: Any) -> None:
    victims = list(client.run(os.getpid).values())
    killed = threading.Event()

    def kill(done: int, total: int) -> None:
        if done >= 2 and not killed.is_set():
            killed.set()
            os.kill(victims[0], signal.SIGKILL)

    options: dict[str, Any] = {"samples": 16, "resolution": (320, 240)}
    image = jaspe.distributed.render(scene(), client, progress=kill, **options)
    assert killed.is_set()
    assert image == scene().render(**options)
    deadline = time.monotonic() + 30
    while victims[0] in client.run(os.getpid, on_error="ignore").values() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert victims[0] not in client.run(os.getpid, on_error="ignore").values()
