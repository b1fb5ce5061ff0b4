"""What the tests share."""

from __future__ import annotations

import os
import subprocess
from typing import Callable

import pytest


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """Runs the command line program, and returns what it prints. JASPE names the program."""
    program = os.environ.get("JASPE")
    if program is None:
        pytest.skip("JASPE does not name the command line program, with which results are compared")

    def run(*arguments: object, stdin: str = "") -> str:
        words = [program, *map(str, arguments)]
        done = subprocess.run(words, input=stdin, capture_output=True, text=True, check=True)
        return done.stdout

    return run
