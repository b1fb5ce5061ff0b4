"""The package as a whole: stubs, types, examples in docstrings."""

from __future__ import annotations

import doctest
import re
import subprocess
import sys
from pathlib import Path

import pytest

import jaspe
import jaspe._declarations
import jaspe._scene
import jaspe.noise

PYTHON = Path(__file__).parents[1]


def test_stubs_are_those_of_the_declarations() -> None:
    done = subprocess.run([sys.executable, PYTHON / "stubs.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_examples_in_docstrings_hold() -> None:
    tried = 0
    for module in (jaspe, jaspe.noise, jaspe._declarations, jaspe._scene):
        result = doctest.testmod(module)
        assert result.failed == 0, module
        tried += result.attempted
    assert tried >= 10


def test_the_lines_of_the_readme_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (PYTHON.parent / "README.md").read_text("utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert blocks
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").mkdir()
    scene = (PYTHON.parent / "scenes" / "six-materials.sc").read_text("utf-8")
    # Smaller, for speed.
    (tmp_path / "scenes" / "six-materials.sc").write_text(re.sub(r"resolution \d+ \d+", "resolution 96 60", scene), "utf-8")
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})
    assert (tmp_path / "six.png").read_bytes().startswith(b"\x89PNG")


def test_the_package_says_its_version_and_its_names() -> None:
    assert jaspe.__version__.count(".") == 2
    assert all(hasattr(jaspe, name) for name in jaspe.__all__)
