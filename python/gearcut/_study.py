"""Studies: many scenes that differ in a few keys, a row each."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path

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
    for part in parts:
        with (part / "rows.csv").open(newline="", encoding="utf-8") as file:
            heads, *rows = csv.reader(file)
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
