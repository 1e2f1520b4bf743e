"""Scenes made ready: checked, moved, cut, rolled."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._findings import Findings, Notice, Quantity, Table, quantity, read_csv
from ._flank import Flank
from ._progress import ProgressLike, watched
from ._scene import Scene, SceneLike, Settings


@dataclass(frozen=True)
class Checked:
    """What a scene means before anything is cut."""

    notices: list[Notice]
    """What must be known before cutting, in the order in which it was found."""
    text: str
    """Geometry, tool, machine, cost: what ``gearcut check --verbose`` prints."""

    @property
    def ok(self) -> bool:
        """Whether it can be cut as it is: without faults."""
        return all(notice.severity != "fault" for notice in self.notices)

    def __repr__(self) -> str:
        return f"<gearcut.Checked {'can be cut' if self.ok else 'not as it is'}: {len(self.notices)} notices>"

    def _repr_html_(self) -> str:
        notices = "".join(f"<li>{escape(str(notice))}</li>" for notice in self.notices)
        return f"<b>{escape(repr(self)[1:-1])}</b><ul>{notices}</ul><pre>{escape(self.text)}</pre>"


@dataclass(frozen=True)
class Axes(Checked):
    """How the axes of the machine move."""

    tables: Mapping[str, Table]
    """Positions, speeds and accelerations of every operation; the keys of columns carry their units."""

    def __repr__(self) -> str:
        return f"<gearcut.Axes of {', '.join(self.tables)}: {len(self.notices)} notices>"


class Job:
    """A scene made ready to cut.

    Parameters
    ----------
    scene, settings
        As for :class:`gearcut.Scene`.
    backend
        ``cpu``; ``gpu``; or ``auto``: a GPU if it is faster.
    """

    def __init__(self, scene: SceneLike, settings: Settings = (), *, backend: str = "cpu") -> None:
        self.scene = scene if isinstance(scene, Scene) and not settings else Scene(scene, settings)
        """The scene."""
        self._native = _native.NativeJob(self.scene._native, backend)

    def check(self) -> Checked:
        """What the scene means; nothing is cut."""
        notices, text = self._native.check()
        return Checked([Notice(*of) for of in notices], text)

    def axes(self, out: str | os.PathLike[str] | None = None) -> Axes:
        """How the axes move; tables, charts and programs go to ``out``, if it is given."""
        with TemporaryDirectory() as temporary:
            folder = Path(temporary, "axes") if out is None else Path(out)
            notices, text = self._native.axes(folder)
            tables = {
                name: read_csv(folder / "axes" / f"{name}.csv", f"axes.{name}", f"axes of operation {name}")
                for name in self.scene.operations
                if (folder / "axes" / f"{name}.csv").is_file()
            }
        return Axes([Notice(*of) for of in notices], text, tables)

    def flank(
        self, tooth: int, side: str, *, u_mm: ArrayLike | None = None, v_mm: ArrayLike | None = None
    ) -> Flank:
        """Cuts one flank through all operations.

        Parameters
        ----------
        tooth
            From 1, counter-clockwise.
        side
            ``left`` or ``right``.
        u_mm, v_mm
            Places of your own, both or none: arcs along the profile from the form point, and places along the tooth
            from the middle of the face, mm, increasing. Without them, those of the scene's spacing.
        """
        if (u_mm is None) != (v_mm is None):
            raise TypeError("give both u_mm and v_mm, or none of them")
        at = None if u_mm is None else (np.asarray(u_mm, float).tolist(), np.asarray(v_mm, float).tolist())
        return Flank(**self._native.flank(tooth, side, at))

    def flanks(self, teeth: Iterable[int] | None = None) -> Iterator[Flank]:
        """Cuts the flanks of some teeth, or of all, one after the other; only one is in memory."""
        for tooth in range(1, self.scene.teeth + 1) if teeth is None else teeth:
            for side in ("left", "right"):
                yield self.flank(tooth, side)

    def cut(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        only: Iterable[str] | None = None,
        frames: int | None = None,
        progress: ProgressLike = None,
    ) -> Findings:
        """Cuts and measures the whole gear.

        Parameters
        ----------
        out
            Folder of the files that ``gearcut cut`` writes; without it nothing is written.
        only
            Parts that are written beside the numbers: ``maps``, ``pictures``, ``meshes``, ``texture``, ``chips``,
            ``axes``, ``report``. Without it, all of them.
        frames
            How many pictures of the cut as it happens are drawn.
        progress
            ``True`` for a bar (of tqdm, where it is there), or a callable that takes every event as a dictionary; an
            exception that it raises ends the cut.

        Ctrl-C ends the cut; what is finished is then in ``OUT.partial``.
        """
        parts = None if only is None else list(only)
        with TemporaryDirectory() as temporary, watched(progress) as watcher:
            if out is None:
                nothing: list[str] = []
                _, text, _ = self._native.cut(Path(temporary, self.scene.name), nothing, None, watcher)
                return Findings(json.loads(text))
            folder, text, _ = self._native.cut(Path(out), parts, frames, watcher)
        return Findings(json.loads(text), folder)

    def __repr__(self) -> str:
        return f"<gearcut.Job of {self.scene!r}>"


def check(scene: SceneLike, settings: Settings = ()) -> Checked:
    """What a scene means before anything is cut: :meth:`Job.check`."""
    return Job(scene, settings).check()


def axes(scene: SceneLike, settings: Settings = (), *, out: str | os.PathLike[str] | None = None) -> Axes:
    """How the axes of the machine move: :meth:`Job.axes`."""
    return Job(scene, settings).axes(out)


def cut(
    scene: SceneLike,
    settings: Settings = (),
    *,
    out: str | os.PathLike[str] | None = None,
    only: Iterable[str] | None = None,
    draft: bool = False,
    progress: ProgressLike = None,
) -> Findings:
    """Cuts and measures a whole gear: :meth:`Job.cut`; ``draft`` on coarser dexels (:meth:`Scene.draft`)."""
    read = Scene(scene).draft(settings) if draft else Scene(scene, settings)
    return Job(read).cut(out, only=only, progress=progress)


def pair(a: SceneLike, b: SceneLike, *, progress: ProgressLike = None, **options: Any) -> Findings:
    """Rolls two gears on each other.

    Parameters
    ----------
    a, b
        Scenes, or folders that a cut has written.
    progress
        As for :meth:`Job.cut`.
    options
        Those of ``gearcut pair``: ``flanks`` (``"cut"`` or ``"nominal"``), ``positions``, ``sections``,
        ``center_distance_mm``, ``center_distance_error_um``, ``eccentricity_a_um``, ``eccentricity_a_at_deg``,
        ``eccentricity_b_um``, ``eccentricity_b_at_deg``, ``parallelism_in_plane_um``, ``parallelism_out_of_plane_um``,
        ``phase_teeth``, ``marking_um``.
    """
    with watched(progress) as watcher:
        text = _native.pair(Scene(a)._native, Scene(b)._native, options, watcher)
    return Findings(json.loads(text))


@dataclass(frozen=True)
class Texture(Mapping[str, Quantity]):
    """Parameters of ISO 25178-2 by symbol: ``texture["Sa"]``."""

    parameters: Mapping[str, Quantity]
    """All of them."""
    chain: list[str]
    """What was done to the surface first, step by step."""

    def __getitem__(self, symbol: str) -> Quantity:
        return self.parameters[symbol]

    def __iter__(self) -> Iterator[str]:
        return iter(self.parameters)

    def __len__(self) -> int:
        return len(self.parameters)

    def __repr__(self) -> str:
        return f"<gearcut.Texture {', '.join(f'{of.key} {of.words}' for of in list(self.parameters.values())[:3])} ...>"


def texture(
    surface: ArrayLike | str | os.PathLike[str],
    *,
    spacing_um: float | tuple[float, float] | None = None,
    form: str = "plane",
    s_filter_um: float | None = None,
    l_filter_um: float | None = None,
    robust: bool = False,
    crop_um: float = 0.0,
) -> Texture:
    """Texture of a surface.

    Parameters
    ----------
    surface
        Heights, um, of the shape ``[rows, columns]``, NaN where nothing was measured; or a file: X3P, SDF, SUR, NPY,
        CSV, GWY and other text.
    spacing_um
        Distance of the points, um, along x and y; files that carry one need none.
    form
        What is taken off first: ``none``, ``plane``, ``poly2``, ``poly2-plus-cylinder``.
    s_filter_um, l_filter_um
        Nesting indices, um.
    robust
        Whether the L-filter is the robust one of ISO 16610-71.
    crop_um
        Margin cut off every side afterwards, um.
    """
    both = (spacing_um, spacing_um) if isinstance(spacing_um, (int, float)) else spacing_um
    chain = (form, s_filter_um, l_filter_um, robust, crop_um)
    if isinstance(surface, (str, os.PathLike)):
        text, words = _native.texture_of_file(Path(surface), None if both is None else list(both), chain)
    elif both is None:
        raise TypeError("heights in an array need spacing_um")
    else:
        text, words = _native.texture(np.asarray(surface, np.float64), both, chain)
    return Texture({symbol: quantity(symbol, entry) for symbol, entry in json.loads(text).items()}, words)
