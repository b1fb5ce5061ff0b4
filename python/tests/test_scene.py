"""Scenes: reading, parameters, pictures, pickles, Ctrl-C."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import threading
import time
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest

import jaspe

ROOT = Path(__file__).parents[2]
BALL = """
image {{ resolution 48 36 }}
camera {{ type pinhole eye 0 0 4 target 0 0 0 up 0 1 0 fov 40 aspect 1.333 }}
light {{ type point color 1 1 1 power 400 p 3 4 5 }}
shader {{ name glassy type glass eta 1.5 color 1 1 1 absorption.distance 2 absorption.color 0.5 0.9 0.5 }}
{shader}
object {{ shader ball type sphere c 0 0 0 r 1 }}
"""
MARBLE = BALL.format(shader="shader { name ball type marble depth 4 }")
SIX = ROOT / "scenes" / "six-materials.sc"


def scene() -> jaspe.Scene:
    return jaspe.loads(MARBLE)


def test_pictures_are_those_of_the_command_line(command: Callable[..., str], tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours.png", tmp_path / "theirs.png"
    loaded = jaspe.load(SIX)
    loaded.shaders["wood"].depth = 3
    cases: list[tuple[dict[str, Any], list[object]]] = [
        ({"samples": 2}, ["--samples", 2]),
        ({"aa": (0, 1), "seed": 9}, ["--aa", 0, 1, "--seed", 9]),
        ({"samples": 1, "crop": (20, 10, 60, 50)}, ["--samples", 1, "--crop", "20,10,60,50"]),
        ({"look": "normals"}, ["--override", "normals"]),
        ({"dialect": "report", "samples": 1}, ["--dialect", "report", "--samples", 1]),
    ]
    for options, words in cases:
        loaded.render(resolution=(96, 60), **options).save(ours)
        size = ["--resolution", "96x60", "--set", "wood.depth=3", "--quiet"]
        command("render", SIX, "-o", theirs, *size, *words)
        assert ours.read_bytes() == theirs.read_bytes(), words


def test_parameters_are_read_and_set() -> None:
    loaded = scene()
    assert list(loaded.shaders) == ["glassy", "ball"] and len(loaded.shaders) == 2
    ball, glass = loaded.shaders["ball"], loaded.shaders["glassy"]
    assert (ball.name, ball.type, ball.depth, ball.space) == ("ball", "marble", 4, None)
    before = loaded.render()
    ball.depth = 1
    ball.diffuse_initial = np.array([0.25, 0.5, 1])
    ball.diffuse_final = "#ff8000"
    ball["noise"] = "lattice"
    assert (ball.depth, ball.noise, ball.diffuse_initial) == (1, "lattice", (0.25, 0.5, 1.0))
    assert ball.diffuse_final == pytest.approx((1, 0.2158605, 0), abs=1e-6)
    assert loaded.render() != before
    assert glass.absorption_color == (0.5, 0.9, 0.5) and glass["absorption.distance"] == 2
    glass.absorption_distance = 3
    assert glass["absorption.distance"] == 3.0 and "absorption_distance" in dir(glass)
    assert "depth=1" in repr(ball) and "glassy" in repr(loaded)
    assert set(ball.parameters) == {p.name for p in jaspe.textures()[4].parameters}


def test_pictures_and_names_are_words() -> None:
    text = BALL.format(shader="shader { name ball type diffuse texture plain.png }")
    plain = jaspe.Image(np.full((2, 2, 3), 0.5, np.float32))._repr_png_()
    other = jaspe.Image(np.full((2, 2, 3), 0.1, np.float32))._repr_png_()
    loaded = jaspe.loads(text, {"plain.png": plain, "with blanks.png": other})
    assert loaded.shaders["ball"].texture == "plain.png"
    before = loaded.render()
    loaded.shaders["ball"].texture = "with blanks.png"
    assert loaded.shaders["ball"].texture == "with blanks.png"
    assert loaded.render().linear.mean() < before.linear.mean()


def test_files_come_from_memory_or_disk(tmp_path: Path) -> None:
    ball = "shader { name ball type marble }\n"
    (tmp_path / "ball.sc").write_text(ball)
    text = BALL.format(shader="include ball.sc")
    expected = jaspe.loads(BALL.format(shader=ball)).render()
    assert jaspe.loads(text, {"ball.sc": ball}).render() == expected
    assert jaspe.loads(text.encode(), {"ball.sc": tmp_path / "ball.sc"}).render() == expected
    (tmp_path / "whole.sc").write_text(text)
    assert jaspe.load(tmp_path / "whole.sc").render() == expected
    with pytest.raises(jaspe.SceneError, match="ball.sc"):
        jaspe.loads(text, {})
    with pytest.raises(FileNotFoundError, match="nowhere.sc"):
        jaspe.load(tmp_path / "nowhere.sc")


def test_mistakes_have_places_and_advice() -> None:
    with pytest.raises(jaspe.SceneError) as caught:
        jaspe.loads(MARBLE.replace("depth 4", "dept 4").replace("fov 40", "fov forty"), name="ball.sc")
    first, second = [d for d in caught.value.diagnostics if d.severity == "error"][:2]
    assert (first.file, first.line, first.column) == ("ball.sc", 3, 59)
    assert (second.message, second.line, second.hint) == ("unknown keyword `dept` in `marble`", 6, "did you mean `depth`?")
    assert "dept 4" in str(caught.value) and "^^^^" in str(caught.value) and "\x1b" not in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.diagnostics == caught.value.diagnostics
    with pytest.raises(jaspe.SceneError, match="the scene has no camera"):
        jaspe.loads("image { resolution 8 8 }").render()
    with pytest.raises(jaspe.SceneError, match="did you mean `depth`"):
        scene().shaders["ball"].dept = 3
    with pytest.raises(jaspe.SceneError, match="from 0 to 32"):
        scene().shaders["ball"].depth = 99
    with pytest.raises(AttributeError, match="has no parameter `dept`; it has depth"):
        scene().shaders["ball"].dept
    with pytest.raises(KeyError, match="glassy, ball"):
        scene().shaders["bll"]


def test_warnings_are_kept() -> None:
    with pytest.raises(jaspe.SceneError, match="no camera"):
        jaspe.loads("image { resolution 8 8 }").check()
    loaded = jaspe.loads(MARBLE + "shader { name ball type wood }")
    assert [d.severity for d in loaded.check()] == ["warning"] and "already" in str(loaded.diagnostics[0])


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"samples": 0}, ValueError, "samples: expected a number from 1"),
        ({"samples": 1.5}, TypeError, "samples: expected a whole number"),
        ({"resolution": 100}, TypeError, "resolution: expected 2 whole numbers"),
        ({"resolution": (0, 10)}, ValueError, "resolution"),
        ({"crop": (0, 0, 49, 10)}, ValueError, r"within \(0, 0, 48, 36\)"),
        ({"crop": (5, 5, 5, 9)}, ValueError, "crop"),
        ({"threads": 0}, ValueError, "threads"),
        ({"seed": -1}, ValueError, "seed"),
        ({"look": "normal"}, ValueError, 'did you mean "normals"'),
        ({"dialect": "blender"}, ValueError, '"sunflow", "report"'),
        ({"layers": ["depths"]}, ValueError, "look"),
    ],
)
def test_what_is_refused_is_explained(options: dict[str, Any], error: type[Exception], words: str) -> None:
    untyped: Any = scene().render
    with pytest.raises(error, match=words):
        untyped(**options)


def test_crops_and_threads_leave_no_trace() -> None:
    loaded = scene()
    whole = loaded.render(aa=(0, 2))
    assert np.array_equal(loaded.render(aa=(0, 2), crop=(7, 5, 30, 31)).pixels, whole.pixels[5:31, 7:30])
    assert loaded.render(aa=(0, 2), threads=1) == loaded.render(aa=(0, 2), threads=3) == whole


def test_layers_are_looks() -> None:
    image = scene().render(layers=["normals", "ids"])
    assert set(image.layers) == {"normals", "ids"}
    assert image.layers["normals"] == scene().render(look="normals")
    assert image.layers["ids"].linear[18, 24].max() > 0


def test_scenes_are_copied_and_pickled(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    jaspe.Image(np.full((4, 4, 3), 0.3, np.float32)).save(tmp_path / "parts" / "wall.png")
    (tmp_path / "parts" / "ball.sc").write_text("shader { name ball type diffuse texture parts/wall.png }")
    (tmp_path / "whole.sc").write_text(BALL.format(shader="include parts/ball.sc"))
    loaded = jaspe.load(tmp_path / "whole.sc")
    loaded.shaders["glassy"].eta = 1.7
    picture = loaded.render()
    data = pickle.dumps(loaded)
    twin = copy.copy(loaded)
    for path in sorted(tmp_path.rglob("*.*")):
        path.unlink()
    restored = pickle.loads(data)
    assert restored.render() == picture and restored.shaders["glassy"].eta == 1.7
    assert pickle.loads(pickle.dumps(restored)).render() == picture
    twin.shaders["glassy"].eta = 1.2
    assert loaded.shaders["glassy"].eta == 1.7


def test_scenes_are_text_again() -> None:
    loaded = scene()
    loaded.shaders["ball"].depth = 2
    assert "depth 2" in loaded.text()
    assert jaspe.loads(loaded.text()).render() == loaded.render()


def test_notebooks_show_scenes_and_pictures() -> None:
    assert scene()._repr_png_().startswith(b"\x89PNG")
    wide = jaspe.loads(MARBLE.replace("48 36", "6000 100"))._repr_png_()
    assert int.from_bytes(wide[16:20], "big") == 320


def test_progress_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    told: list[tuple[int, int]] = []
    scene().render(samples=64, progress=lambda done, total: told.append((done, total)))
    assert told and told[-1][0] == told[-1][1] > 0
    assert all(a[0] <= b[0] for a, b in zip(told, told[1:]))
    scene().render(samples=4, progress=True)
    assert "rendering [" in capsys.readouterr().err
    with pytest.raises(ZeroDivisionError):
        scene().render(samples=64, progress=lambda done, total: 1 // 0)


@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise there")
@pytest.mark.parametrize("what", ["picture", "photons", "bake"])
def test_ctrl_c_stops_at_once(what: str) -> None:
    photons = 'photons { caustics 16000000 kd 64 0.5 }\nobject { shader glassy type sphere c 1 1 1 r 0.5 }'
    long: dict[str, Callable[[], object]] = {
        "picture": lambda: scene().render(samples=1_000_000, resolution=(1000, 1000)),
        "photons": lambda: jaspe.loads(MARBLE + photons).render(samples=1_000_000),
        "bake": lambda: jaspe.Texture("marble", depth=32).bake(16384),
    }
    pressed: list[float] = []

    def press() -> None:
        pressed.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.3, press).start()
    with pytest.raises(KeyboardInterrupt):
        long[what]()
    assert time.perf_counter() - pressed[0] < 0.2


def test_threads_of_a_program_render_one_scene() -> None:
    loaded, pictures = scene(), []
    expected = loaded.render()
    threads = [threading.Thread(target=lambda: pictures.append(loaded.render())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert pictures == [expected] * 4
