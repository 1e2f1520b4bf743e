"""What can go wrong, as exceptions that say where, what is allowed, and a way out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Problem:
    """One thing wrong with a scene."""

    key: str | None
    """The key or section that the message names first, such as ``gear.module_mm``."""
    message: str
    """What is wrong, with the value and what is allowed."""
    way_out: str
    """What to do about it."""
    allowed: str | None
    """What may be written for the key, such as ``0.1 to 50``; none where the key is no known one."""
    unit: str | None
    """Unit of the key's value; none for counts, ratios and words."""
    file: str | None
    """The scene's file, or the name that stands for it; none for a setting."""
    line: int | None
    """Line, from 1."""
    column: int | None
    """Column in characters, from 1."""
    source: str | None
    """The whole line, or the setting."""


class GearcutError(Exception):
    """Anything that gearcut refuses or cannot do."""


class SceneError(GearcutError, ValueError):
    """A scene that is wrong: every problem with its key, place, allowed values and a way out.

    The attributes of the first problem are those of the exception as well.
    """

    problems: tuple[Problem, ...]

    def __init__(self, text: str, problems: Iterable[Mapping[str, Any]]) -> None:
        super().__init__(text)
        self.problems = tuple(Problem(**problem) for problem in problems)

    @property
    def key(self) -> str | None:
        """The key that the first problem names."""
        return self.problems[0].key

    @property
    def line(self) -> int | None:
        """Line of the first problem."""
        return self.problems[0].line

    @property
    def allowed(self) -> str | None:
        """What may be written for the key of the first problem."""
        return self.problems[0].allowed

    @property
    def way_out(self) -> str:
        """What to do about the first problem."""
        return self.problems[0].way_out


class RefusedError(GearcutError, ValueError):
    """Work that is refused for a reason that no line of a scene says."""

    def __init__(self, key: str, problem: str, way_out: str) -> None:
        super().__init__(f"{problem}\n  way out: {way_out}")
        self.key = key
        """What is to blame."""
        self.problem = problem
        """What is wrong."""
        self.way_out = way_out
        """What to do about it."""
