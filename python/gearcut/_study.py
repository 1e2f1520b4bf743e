"""Studies: many scenes that differ in a few keys, a row each."""

from __future__ import annotations

import csv
import json
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._errors import GearcutError
from ._findings import Table, column_of, parsed
from ._progress import ProgressLike, watched


def study(
    file: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    shard: tuple[int, int] = (1, 1),
    most_cases: int = 100_000,
    progress: ProgressLike = None,
) -> Path:
    """Makes the cases of a study file that its folder does not have yet, as ``gearcut study``; gives the folder.

    Parameters
    ----------
    file
        The study: TOML, docs/studies.md.
    out
        Its folder; left out, ``out/NAME_study``, of a share ``out/NAME_study/shard_I_of_N``.
    shard
        Which share of how many, the first one is 1. A share that was stopped goes on with the same call.
    most_cases
        More cases than these are refused.
    progress
        As for :meth:`Job.cut`. Ctrl-C loses no finished case.
    """
    with watched(progress) as watcher:
        return _native.study(Path(file), None if out is None else Path(out), shard, most_cases, watcher)


def read_study(folder: str | os.PathLike[str]) -> Table:
    """The rows of a study, those of its shares together: parameters and kept quantities with units and definitions.

    ``pyarrow.parquet.write_table(rows.to_arrow(), path)`` makes Parquet of them, units in the metadata of the fields.
    """
    folder = Path(folder)
    parts = sorted(path.parent for path in folder.glob("shard_*_of_*/rows.csv")) or [folder]
    cells: list[list[str]] = []
    heads: list[str] = []
    for part in parts:
        with (part / "rows.csv").open(newline="", encoding="utf-8") as file:
            own, *rows = csv.reader(file)
        heads = heads or own
        if own != heads:
            raise GearcutError(f"{part} has other columns than {parts[0]}: they are shares of two studies")
        cells.extend(rows)
    cases = json.loads((parts[0] / "run.json").read_text(encoding="utf-8"))["cases"]
    cells.sort(key=lambda row: int(row[0]))
    if [int(row[0]) for row in cells] != list(range(cases)):
        raise GearcutError(f"{folder} has {len(cells)} of {cases} cases; make the others with the same study")
    with (parts[0] / "columns.csv").open(newline="", encoding="utf-8") as file:
        about = {row["column"]: row for row in csv.DictReader(file)}
    columns = {key: column_of([parsed(row[place]) for row in cells]) for place, key in enumerate(heads)}
    units = {key: about[key]["unit"] or None for key in heads}
    return Table("rows", f"Cases of {folder.name}", columns, units, {key: about[key]["definition"] for key in heads})


def maps(rows: Table) -> dict[str, NDArray[np.float64]]:
    """The maps of flanks that a study keeps, by their flanks, such as ``tooth_01_left``.

    Each is an array of the shape ``[cases, places along the profile, places along the tooth]``, um, NaN where no pass
    came: from the form point to the tip, and from one end of the tooth to the other.
    """
    cells: dict[str, dict[tuple[int, int], NDArray[Any]]] = {}
    for key in rows:
        place = re.fullmatch(r"map\.(\w+)\.u(\d+)_v(\d+)_um", key)
        if place:
            cells.setdefault(place[1], {})[int(place[2]), int(place[3])] = rows[key]
    found = {}
    for flank, columns in cells.items():
        last_u, last_v = max(columns)
        heights = np.empty((rows.rows, last_u + 1, last_v + 1))
        for (u, v), column in columns.items():
            heights[:, u, v] = column
        found[flank] = heights
    return found
