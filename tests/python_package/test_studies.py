"""Studies: shares, a stop, rows with units for Arrow and Parquet, and the job script that Dask runs."""

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pandas
import polars
import pyarrow.parquet
import pytest

import gearcut

STUDY = """
[study]
scene = "round.toml"
command = "axes"
settings = ["operation.finish.strokes_per_revolution=2400"]
keep = ["operations.finish.axes.work_speed.peak"]
[[parameter]]
key = "machine.double_strokes_per_minute"
range = [200.0, 600.0]
count = 9
"""


@pytest.fixture
def study_file(scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A study of nine cases in a folder of its own, which is the current one."""
    (tmp_path / "round.toml").write_bytes(scene_file.read_bytes())
    (tmp_path / "speeds.toml").write_text(STUDY)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "speeds.toml"


def test_shares_together_are_the_rows_of_the_command(study_file: Path, tmp_path: Path) -> None:
    subprocess.run([os.environ["GEARCUT"], "study", study_file, "--quiet", "--out", "whole"], check=True)
    expected = pandas.read_csv("whole/rows.csv")
    folders = [gearcut.study(study_file, shard=(number, 3)) for number in (3, 1)]
    assert folders[0] == Path("out/speeds_study/shard_3_of_3")
    with pytest.raises(gearcut.GearcutError, match="6 of 9 cases"):
        gearcut.read_study("out/speeds_study")
    gearcut.study(study_file, shard=(2, 3))
    rows = gearcut.read_study("out/speeds_study")
    speed = "operations.finish.axes.work_speed.peak_deg_per_s"
    for key in ("case", "machine.double_strokes_per_minute", speed):
        assert rows[key].tolist() == expected[key].tolist(), key
    # Of 2,400 strokes a turn and n double strokes a minute the work turns n / 60 / 2,400 of a turn a second.
    assert rows[speed].tolist() == pytest.approx(360 / 60 / 2400 * rows["machine.double_strokes_per_minute"])
    assert (rows.units[speed], rows.units["machine.double_strokes_per_minute"]) == ("deg/s", "1/min")

    pyarrow.parquet.write_table(rows.to_arrow(), "rows.parquet")
    field = pyarrow.parquet.read_schema("rows.parquet").field(speed)
    assert field.metadata[b"unit"] == b"deg/s" and b"largest magnitude" in field.metadata[b"definition"]
    assert pandas.read_parquet("rows.parquet")[speed].tolist() == expected[speed].tolist()
    assert polars.read_parquet("rows.parquet")[speed].to_list() == expected[speed].tolist()


def test_a_study_that_was_stopped_goes_on(study_file: Path) -> None:
    # So many cases take seconds, and events come twice a second.
    study_file.write_text(STUDY.replace("count = 9", "count = 299"))

    def stop(event: Mapping[str, Any]) -> None:
        if event["event"] == "progress" and event["done"] >= 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gearcut.study(study_file, progress=stop)
    before = Path("out/speeds_study/rows.csv").read_text().splitlines()
    gearcut.study(study_file)
    after = Path("out/speeds_study/rows.csv").read_text().splitlines()
    assert 4 <= len(before) < len(after) == 300 and set(before) <= set(after)
    assert gearcut.read_study("out/speeds_study")["case"].tolist() == list(range(299))
    with pytest.raises(gearcut.RefusedError, match="299 cases are more than 5"):
        gearcut.study(study_file, most_cases=5)


def test_maps_are_arrays_and_a_row_is_the_gear_of_its_parameters(study_file: Path, gear: dict[str, Any]) -> None:
    maps = "".join(f'[[map]]\ntooth = {tooth}\nflank = "left"\ncolumns = 5\nrows = 3\n' for tooth in (1, 4))
    parameter = '[[parameter]]\nkey = "mounting.eccentricity_um"\nvalues = [0, 8]\n'
    study_file.write_text(f'[study]\nscene = "round.toml"\nkeep = ["teeth.*.left.F_pi"]\n{parameter}{maps}')
    rows = gearcut.read_study(gearcut.study(study_file))
    found = gearcut.maps(rows)
    assert list(found) == ["tooth_01_left", "tooth_04_left"] and found["tooth_04_left"].shape == (2, 5, 3)
    assert sum(key.startswith("teeth.") for key in rows) == 12
    # Straight teeth are alike along their length; the eccentric gear's are higher on one side.
    assert np.ptp(found["tooth_04_left"], axis=2).max() < 1e-6
    eccentric = gearcut.cut(gear, {"mounting.eccentricity_um": 8})
    assert rows["teeth.tooth_04.left.F_pi_um"][1] == eccentric["teeth.tooth_04.left.F_pi"].value
    job = gearcut.Job(gear, {"mounting.eccentricity_um": 8})
    ends_mm = [float(eccentric[f"teeth.tooth_04.left.evaluated_{end}"]) for end in ("from", "to")]
    flank = job.flank(4, "left", u_mm=np.linspace(*ends_mm, 5), v_mm=[-1.8, 0.0, 1.8])
    assert np.allclose(found["tooth_04_left"][1], 1e3 * flank.deviation_mm("finish"), atol=1e-3)


def test_duckdb_reads_rows_and_parquet_keeps_units(study_file: Path) -> None:
    rows = gearcut.read_study(gearcut.study(study_file))
    pyarrow.parquet.write_table(rows.to_arrow(), "rows.parquet")
    speed = "operations.finish.axes.work_speed.peak_deg_per_s"
    [(largest,)] = duckdb.sql(f"""select max("{speed}") from 'rows.parquet'""").fetchall()
    assert largest == rows[speed].max()
    metadata = duckdb.sql("select value from parquet_kv_metadata('rows.parquet') where key = 'ARROW:schema'").fetchall()
    assert len(metadata) == 1
    assert pyarrow.parquet.read_schema("rows.parquet").field(speed).metadata[b"unit"] == b"deg/s"
