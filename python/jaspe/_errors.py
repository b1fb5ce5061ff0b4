"""What is wrong with a scene, as values and as an exception."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Sequence

__all__ = ["Diagnostic", "SceneError"]


@dataclass(frozen=True)
class Diagnostic:
    """One message: what was found where, and what to do about it."""

    severity: str
    """"error", "warning" or "note"."""
    message: str
    """What is the matter."""
    file: Optional[str]
    """The file, as it was asked for; `None` for what concerns the scene as a whole."""
    line: Optional[int]
    """The line, from 1."""
    column: Optional[int]
    """The column in characters, from 1."""
    hints: tuple[str, ...] = ()
    """What to do next, each a full suggestion."""

    @property
    def hint(self) -> Optional[str]:
        """The first of the hints, if there is one."""
        return self.hints[0] if self.hints else None

    def __str__(self) -> str:
        place = "" if self.file is None else f"{self.file}:{self.line}:{self.column}: "
        hints = "".join(f"; {hint}" for hint in self.hints)
        return f"{place}{self.severity}: {self.message}{hints}"


class SceneError(ValueError):
    """A scene that cannot be rendered as it stands. As text it shows each message with the lines that it is about."""

    diagnostics: list[Diagnostic]
    """Everything there is to say, in the order of the text."""

    def __init__(self, text: str, diagnostics: Sequence[Diagnostic] = ()) -> None:
        super().__init__(text, diagnostics)
        self.diagnostics = list(diagnostics)

    def __str__(self) -> str:
        return str(self.args[0])
