"""Progress: events for a callable, or a bar."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Union

ProgressLike = Union[None, bool, Callable[[Mapping[str, Any]], object]]
"""``True`` for a bar, or a callable that takes events: ``{"event": "progress", "step": "cut", "done": 3, ...}``."""


@contextmanager
def watched(progress: ProgressLike) -> Iterator[Callable[[str], None] | None]:
    """What takes events as texts, until the work has ended."""
    if progress is None or progress is False:
        yield None
        return
    bars = Bars() if progress is True else None
    takes: Callable[[Mapping[str, Any]], object] = bars if bars is not None else progress  # type: ignore[assignment]
    try:
        yield lambda text: (takes(json.loads(text)), None)[1]
    finally:
        if bars is not None:
            bars.close()


class Bars:
    """A bar for each step, of tqdm where it is there; lines on standard error otherwise."""

    def __init__(self) -> None:
        self.bar: Any = None
        try:
            from tqdm.auto import tqdm
        except ImportError:
            tqdm = None
        self.tqdm = tqdm

    def __call__(self, event: Mapping[str, Any]) -> None:
        kind = event["event"]
        if kind == "note":
            return
        if self.tqdm is None:
            if kind == "step_finished":
                print(f"{event['step']}: {event['done']} {event['unit']}", file=sys.stderr)
            return
        if kind == "step_started":
            self.close()
            self.bar = self.tqdm(total=event["total"], desc=event["step"], unit=f" {event['unit']}")
        elif self.bar is not None and event["step"] == self.bar.desc.removesuffix(": "):
            self.bar.update(event["done"] - self.bar.n)

    def close(self) -> None:
        """Ends the bar."""
        if self.bar is not None:
            self.bar.close()
            self.bar = None
