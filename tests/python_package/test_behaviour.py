"""Scenes in every form, errors with places, arrays without copies, Ctrl-C, progress, other libraries."""

import os
import signal
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import gearcut


def test_a_scene_is_a_mapping_a_text_a_path_or_a_folder(
    gear: dict[str, Any], scene_file: Path, found: gearcut.Findings
) -> None:
    of_mapping = gearcut.Scene(gear, name="round")
    assert of_mapping.toml == gearcut.Scene(scene_file).toml == gearcut.Scene(str(scene_file)).toml
    assert of_mapping.toml == gearcut.Scene(tomli_w.dumps(gear), name="round").toml
    assert (of_mapping.process, of_mapping.teeth, of_mapping.operations) == ("shaping", 12, ["rough", "finish"])
    # Settings are those of the command line; scalars of numpy are numbers.
    settings = {"gear.teeth": np.int64(13), "gear.module_mm": np.float64(2.5), "operation.finish.name": "last"}
    set_ = gearcut.Scene(gear, settings)
    assert (set_.teeth, set_.module_mm, set_.operations) == (13, 2.5, ["rough", "last"])
    words = ["gear.teeth=13", "gear.module_mm=2.5", 'operation.finish.name="last"']
    assert set_.toml == gearcut.Scene(gear, words).toml
    assert gearcut.Scene(gear).with_settings({"gear.teeth": 13}).teeth == 13
    assert found.folder is not None and gearcut.Scene(found.folder).teeth == 12
    with pytest.raises(TypeError, match="not one text"):
        gearcut.Scene(gear, "gear.teeth=13")


def test_errors_say_key_line_range_and_way_out(
    gear: dict[str, Any], found: gearcut.Findings, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[gear]\nmodul_mm = 3.0\nteeth = 2\n[tool.shaper_cutter]\nteeth = 20\n")
    with pytest.raises(gearcut.SceneError) as raised:
        gearcut.check(path)
    unknown, teeth = raised.value.problems
    assert (unknown.key, unknown.line, unknown.column) == ("gear.modul_mm", 2, 1)
    assert "module_mm" in unknown.way_out and unknown.file == str(path) and unknown.allowed is None
    assert (teeth.key, teeth.line, teeth.source, teeth.allowed) == (
        "gear.teeth",
        3,
        "teeth = 2",
        "whole number, 4 to 2000",
    )
    assert raised.value.key == "gear.modul_mm" and "mine.toml:2:1" in str(raised.value)
    # Of settings, and of geometry, which is found out later.
    with pytest.raises(gearcut.SceneError) as raised:
        gearcut.Scene(gear, {"gear.module_mm": 99})
    assert (raised.value.key, raised.value.allowed, raised.value.line) == ("gear.module_mm", "0.1 to 50", None)
    with pytest.raises(gearcut.SceneError) as raised:
        gearcut.Job(gear).flank(13, "left")
    assert raised.value.key == "gear.teeth" and "tooth 13 does not exist" in str(raised.value)
    with pytest.raises(gearcut.SceneError, match="cannot read the scene"):
        gearcut.Scene("nowhere.toml")
    with pytest.raises(gearcut.SceneError, match="is missing"):
        gearcut.Scene("")
    with pytest.raises(ValueError, match="no side of a tooth"):
        gearcut.Job(gear).flank(1, "top")
    with pytest.raises(KeyError, match="did you mean .*smallest_stock"):
        found["smalest_stock"]


def test_arrays_are_those_that_gearcut_filled(gear: dict[str, Any]) -> None:
    flank = gearcut.Job(gear).flank(3, "right")
    columns, rows = flank.shape
    assert rows == 5 and len(flank.operations) == len(flank.deviations_mm) == 2
    for array in [flank.points_mm, flank.normals, *flank.deviations_mm, *flank.passes]:
        assert array.shape[:2] == (columns, rows) and array.flags.c_contiguous
        # The memory is that of a vector of Rust, which numpy drops with the array.
        assert type(array.base).__name__ == "PySliceContainer" and not array.flags.owndata
    assert [flank.deviation_mm().dtype, flank.passes[0].dtype] == [np.float32, np.uint32]
    # Straight teeth: all rows are alike.
    assert np.ptp(flank.deviation_mm(), axis=1).max() < 1e-6


def test_ctrl_c_ends_a_cut_and_keeps_what_is_finished(gear: dict[str, Any], tmp_path: Path) -> None:
    # Programs that a shell starts in the background ignore the signal.
    signal.signal(signal.SIGINT, signal.default_int_handler)

    def pressed_after(step: str) -> str:
        def press(event: Mapping[str, Any]) -> None:
            if (event["event"], event["step"]) == ("step_finished", step):
                os.kill(os.getpid(), signal.SIGINT)
                # The work goes on when the main thread has had time for the signal.
                time.sleep(1.0)

        with pytest.raises(KeyboardInterrupt) as raised:
            gearcut.cut(gear, out=tmp_path / "gear", progress=press)
        return str(raised.value)

    assert pressed_after("chips") == "no flank is finished, nothing is written"
    assert not list(tmp_path.iterdir())
    assert "what is finished is in" in (words := pressed_after("cut")) and words.endswith("gear.partial")
    assert not (tmp_path / "gear").exists() and not gearcut.read(tmp_path / "gear.partial").complete


def test_other_threads_run_during_a_cut_and_watchers_hear_of_it(gear: dict[str, Any]) -> None:
    counted, ended = [0], threading.Event()

    def count() -> None:
        while not ended.is_set():
            counted[0] += 1
            ended.wait(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    events: list[Mapping[str, Any]] = []
    before = counted[0]
    gearcut.cut(gear, progress=events.append)
    assert counted[0] - before > 10
    ended.set()
    counter.join()
    flanks = [of for of in events if of["event"] == "step_finished" and of["unit"] == "flanks"]
    assert flanks[0]["done"] == 24

    def refuse(event: Mapping[str, Any]) -> None:
        raise RuntimeError(f"no {event['event']}")

    with pytest.raises(RuntimeError, match="no "):
        gearcut.cut(gear, progress=refuse)


def test_other_libraries_read_flanks_and_tables(gear: dict[str, Any], found: gearcut.Findings) -> None:
    import pandas
    import polars
    import pyarrow

    flank = gearcut.Job(gear).flank(3, "right")
    dataset = flank.to_xarray()
    assert dict(dataset.sizes) == {"u": flank.shape[0], "v": flank.shape[1]} and dataset.u.attrs["units"] == "mm"
    assert np.shares_memory(dataset.deviation_finish.values, flank.deviation_mm("finish"))
    table = found.table("operations.rough.allowance")
    frame = table.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 12 and frame.attrs["units"]["AB"] == "mm"
    arrow = table.to_arrow()
    assert isinstance(arrow, pyarrow.Table) and arrow.schema.field("AB").metadata[b"unit"] == b"mm"
    assert polars.DataFrame(table)["AB"].to_list() == table["AB"].tolist() == frame["AB"].tolist()
    all_found = found.to_pandas()
    assert all_found.loc["smallest_stock", "unit"] == "mm" and len(all_found) == len(found)


def test_notebooks_show_key_numbers_and_the_gear(gear: dict[str, Any], found: gearcut.Findings) -> None:
    page = found._repr_html_()
    assert "data:image/png;base64," in page and f"{found['smallest_stock'].value:.6g} mm" in page
    assert "12 teeth" in gearcut.Scene(gear)._repr_html_() and "can be cut" in gearcut.check(gear)._repr_html_()
    table = found.table("operations.rough.allowance")
    assert "AB (mm)" in table._repr_html_() and repr(table).startswith("<gearcut.Table operations.rough.allowance: 12")
