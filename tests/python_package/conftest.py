"""What the tests share: the command as the tests have built it, and a coarse round gear."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import gearcut

Command = Callable[..., str]


@pytest.fixture(scope="session")
def command(tmp_path_factory: pytest.TempPathFactory) -> Command:
    """Runs gearcut and gives what it prints."""
    folder = tmp_path_factory.mktemp("command")

    def run(*arguments: object) -> str:
        words = [os.environ["GEARCUT"], *map(str, arguments)]
        return subprocess.run(words, check=True, text=True, stdout=subprocess.PIPE, cwd=folder).stdout

    return run


@pytest.fixture(scope="session")
def gear() -> dict[str, Any]:
    """A coarse round gear."""
    return {
        "gear": {"module_mm": 3.0, "teeth": 12, "face_width_mm": 4.0},
        "tool": {"shaper_cutter": {"teeth": 20}},
        "fields": {
            "flank": {"profile_spacing_um": 200.0, "lead_spacing_um": 1000.0},
            "blank": {"spacing_mm": 1.0, "slice_spacing_mm": 2.0},
            "chips": {"spacing_mm": 0.2},
        },
    }


@pytest.fixture(scope="session")
def scene_file(gear: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same gear as a file."""
    import tomli_w

    path = tmp_path_factory.mktemp("scene") / "round.toml"
    path.write_text(tomli_w.dumps(gear))
    return path


@pytest.fixture(scope="session")
def found(gear: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> gearcut.Findings:
    """The same gear, cut, with pictures; under a bar."""
    return gearcut.cut(gear, out=tmp_path_factory.mktemp("found") / "gear", only=["pictures"], progress=True)


def document(folder: Path) -> dict[str, Any]:
    """What a folder of results says."""
    read: dict[str, Any] = json.loads((folder / "results.json").read_text())
    return read
