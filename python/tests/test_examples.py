"""The notebooks in `examples/`: each runs from top to bottom, its code has the right types, and its outputs are current in kind."""

from __future__ import annotations

import base64
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable

import pytest

nbclient: Any = pytest.importorskip("nbclient")
nbformat: Any = pytest.importorskip("nbformat")
pytest.importorskip("matplotlib")
pytest.importorskip("distributed")

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.ipynb"))


def kinds(book: Any) -> list[list[str]]:
    """For each cell with code, the kinds of its outputs."""
    cells = [cell for cell in book.cells if cell.cell_type == "code"]
    return [sorted(kind for output in cell.outputs for kind in output.get("data", {})) for cell in cells]


def test_there_are_notebooks() -> None:
    assert {path.stem for path in EXAMPLES} >= {"noise", "material", "bake", "frames"}
    assert sum(path.stat().st_size for path in EXAMPLES) < 4_500_000


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_notebooks_run(path: Path, tmp_path: Path) -> None:
    stored = nbformat.read(path, as_version=4)
    book = nbformat.read(path, as_version=4)
    nbformat.validate(book)
    client = nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    # What is stored was made by these cells.
    assert kinds(book) == kinds(stored)
    assert any("image/png" in found for found in kinds(book))


def test_a_notebook_shows_the_picture_of_the_command_line(command: Callable[..., str], tmp_path: Path) -> None:
    """The README has both side by side: its command, and the last cell of the notebook, with the same bits below it."""

    def picture(cell: Any) -> bytes:
        (shown,) = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
        return base64.b64decode(shown)

    last = [cell for cell in nbformat.read(EXAMPLES[0].parent / "bake.ipynb", as_version=4).cells if cell.cell_type == "code"][-1]
    readme = (EXAMPLES[0].parents[1] / "README.md").read_text("utf-8")
    words = "jaspe bake organic --preview -o organic/"
    assert f"| `{words}` | `{last.source}` in [a notebook](examples/bake.ipynb) |" in readme
    assert len(picture(last)) > 100_000
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("import jaspe"), nbformat.v4.new_code_cell(last.source)])
    nbclient.NotebookClient(book, timeout=300).execute()
    command(*words.split()[1:-1], tmp_path / "organic", "--quiet")
    assert picture(book.cells[1]) == (tmp_path / "organic" / "preview.png").read_bytes()


@pytest.mark.skipif(sys.version_info < (3, 11), reason="the types of Matplotlib and NumPy are written for later versions")
def test_notebooks_have_the_right_types(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    for path in EXAMPLES:
        book = nbformat.read(path, as_version=4)
        code = "\n\n".join(cell.source.rstrip(";") for cell in book.cells if cell.cell_type == "code")
        (tmp_path / f"{path.stem}_notebook.py").write_text(code + "\n", "utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--allow-untyped-calls", *map(str, tmp_path.glob("*.py"))]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "MYPYPATH": ""})
    assert done.returncode == 0, done.stdout
