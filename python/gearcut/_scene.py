"""Scenes: what is cut, by which tool, on which machine."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path
from typing import Any, Union

import tomli_w

from ._native import NativeScene

SceneLike = Union["Scene", Mapping[str, Any], str, "os.PathLike[str]"]
"""A scene, its sections as a mapping, its TOML text, or the path of a file or of a folder that a cut has written."""

Settings = Union[Mapping[str, Any], Iterable[str]]
"""Keys that differ: ``{"gear.teeth": 45}``, or as on the command line, ``["gear.teeth=45"]``."""


class Scene:
    """A checked scene.

    Parameters
    ----------
    source
        Sections as a mapping, ``{"gear": {"module_mm": 3.0, "teeth": 24}, "tool": {"shaper_cutter": {"teeth": 20}}}``;
        TOML text of more than one line; or a path. Every key is in scenes/README.md.
    settings
        Keys that differ: ``{"gear.teeth": 45, "operation.finish.offset_mm": 0.1}``.
    name
        Name of a scene that is no file.
    folder
        Folder of the files that a scene refers to that is no file.

    Raises
    ------
    SceneError
        The scene is wrong; all problems at once.
    """

    _native: NativeScene
    _folder: str | os.PathLike[str]

    def __init__(
        self,
        source: SceneLike,
        settings: Settings = (),
        *,
        name: str = "scene",
        folder: str | os.PathLike[str] = ".",
    ) -> None:
        lines = setting_lines(settings)
        if isinstance(source, Scene):
            folder = source._folder
            self._native = (
                NativeScene.parse(source.toml, f"{source.name}.toml", Path(folder), lines) if lines else source._native
            )
        elif isinstance(source, Mapping):
            text = tomli_w.dumps(plain(source))
            self._native = NativeScene.parse(text, f"{name}.toml", Path(folder), lines)
        elif isinstance(source, str) and ("\n" in source or not source.strip()):
            self._native = NativeScene.parse(source, f"{name}.toml", Path(folder), lines)
        else:
            path = Path(source)
            folder = path if path.is_dir() else path.parent
            self._native = NativeScene.load(path, lines)
        self._folder = folder

    @property
    def name(self) -> str:
        """Name of the scene: that of its file."""
        return self._native.name

    @property
    def process(self) -> str:
        """``shaping``, ``hobbing`` or ``bevel``."""
        return self._native.process

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return self._native.teeth

    @property
    def module_mm(self) -> float:
        """Module, mm."""
        return self._native.module_mm

    @property
    def face_width_mm(self) -> float:
        """Face width, mm."""
        return self._native.face_width_mm

    @property
    def operations(self) -> list[str]:
        """Names of the operations in their order."""
        return self._native.operations

    @property
    def toml(self) -> str:
        """The scene as TOML with every default written out."""
        return self._native.toml()

    def with_settings(self, settings: Settings) -> Scene:
        """The same scene with other values of some keys."""
        return Scene(self, settings)

    def draft(self, settings: Settings = ()) -> Scene:
        """The same scene with coarser dexels, rays and cells, what ``settings`` say apart: numbers within a second."""
        scene = Scene(self)
        scene._native = self._native.draft(setting_lines(settings))
        return scene

    def __repr__(self) -> str:
        return f"<gearcut.Scene {self.name}: {self.process}, {self.teeth} teeth, module {self.module_mm:g} mm>"

    def _repr_html_(self) -> str:
        text = f"<details><summary>scene</summary><pre>{escape(self.toml)}</pre></details>"
        return f"<b>{escape(repr(self)[1:-1])}</b>{text}"


def plain(value: Any) -> Any:
    """The same without types that TOML does not have: scalars of numpy, arrays, paths."""
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return value


def setting_lines(settings: Settings) -> list[str]:
    """Settings as on the command line."""
    if isinstance(settings, str):
        raise TypeError("settings are a mapping or a list of 'KEY=VALUE', not one text")
    if not isinstance(settings, Mapping):
        return list(settings)
    return [f"{key}={toml_value(value)}" for key, value in settings.items()]


def toml_value(value: Any) -> str:
    """A value as TOML on one line: its texts have no line ends, which TOML escapes."""
    lines = tomli_w.dumps({"value": plain(value)}).removeprefix("value = ").splitlines()
    return " ".join(line.strip() for line in lines)
