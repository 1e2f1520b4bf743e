"""Numbers of the package are those of the command, to the last bit, and those of closed forms."""

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command, document

import gearcut


def quantities(section: dict[str, Any], path: str = "") -> dict[str, Any]:
    """All quantities of a document by path."""
    found = {}
    for key, entry in section.items():
        if isinstance(entry, dict) and isinstance(entry.get("definition"), str):
            found[path + key] = entry
        elif isinstance(entry, dict) and "columns" not in entry:
            found.update(quantities(entry, f"{path}{key}."))
    return found


def test_a_cut_finds_what_the_command_finds(command: Command, scene_file: Path, tmp_path: Path) -> None:
    command("cut", scene_file, "--only", "numbers", "--backend", "cpu", "--quiet", "--out", tmp_path / "command")
    expected = document(tmp_path / "command")
    found = gearcut.cut(scene_file)
    all_expected = {**expected["headline"], **quantities(expected["sections"])}
    assert list(found) == list(all_expected) and len(found) > 200
    for key, quantity in found.items():
        of = all_expected[key]
        assert (quantity.value, quantity.unit, quantity.definition) == (of["value"], of.get("unit"), of["definition"])
    assert [notice.id for notice in found.notices] == [notice["id"] for notice in expected["warnings"]]
    # Written by the package, read back, and as another program reads the table.
    written = gearcut.cut(scene_file, out=tmp_path / "package", only=[])
    assert (tmp_path / "package" / "results.json").read_bytes() == (tmp_path / "command" / "results.json").read_bytes()
    again = gearcut.read(tmp_path / "package")
    assert dict(again) == dict(written) == dict(found)
    path = "operations.finish.chips.strokes"
    table = again.table(path)
    with (tmp_path / "command" / again._tables[path]["file"]).open() as file:
        heads, *rows = csv.reader(file)
    for place, key in enumerate(table):
        cells = [row[place] for row in rows]
        if table[key].dtype != object:
            assert np.array_equal(table[key], [float(of) if of else math.nan for of in cells], equal_nan=True), key
    with pytest.raises(gearcut.GearcutError, match="give the cut a folder"):
        found.table(path)


def test_scallops_have_the_height_of_the_closed_form(gear: dict[str, Any]) -> None:
    # Near the pitch point f^2 sin(alpha) (1 / r_c + 1 / r) / 8, with the circular feed f and the pitch radii.
    job = gearcut.Job({**gear, "fields": {}}, {"gear.teeth": 24})
    flank = job.flank(7, "left")
    points_mm = flank.surface_mm("finish")
    near = flank.is_cut("finish") & (abs(np.hypot(points_mm[..., 0], points_mm[..., 1]) - 36.0) < 0.2)
    scallop_um = 1e3 * flank.deviation_mm("finish")[near].max()
    feed_mm = math.pi * 3.0 * 24.0 / 2400.0
    expected_um = 1e3 * feed_mm**2 * math.sin(math.radians(20.0)) * (1 / 30.0 + 1 / 36.0) / 8.0
    assert scallop_um == pytest.approx(expected_um, rel=0.1)
    assert np.allclose(np.linalg.norm(flank.normals, axis=-1), 1.0, atol=1e-12)
    assert np.nanmin(flank.stock_mm("rough")) > 0.05 and flank.index() == flank.index("finish") == 1
    # Places of one's own are cut alike.
    some = job.flank(7, "left", u_mm=flank.u_mm[100:103], v_mm=flank.v_mm[:2])
    assert np.array_equal(some.deviation_mm(), flank.deviation_mm()[100:103, :2])


def test_a_pair_is_that_of_the_command(command: Command, scene_file: Path, tmp_path: Path) -> None:
    rolled = command("pair", scene_file, scene_file, "--flanks", "nominal", "--json", "--out", tmp_path / "pair")
    found = gearcut.pair(scene_file, scene_file, flanks="nominal")
    expected = document(tmp_path / "pair")
    assert rolled and {key: of.value for key, of in found.items()} == {
        key: of["value"] for key, of in {**expected["headline"], **quantities(expected["sections"])}.items()
    }
    # Straight gears at the distance of their pitch circles: (r_a + r_b) exactly.
    assert found["pair.center_distance"].value == 36.0
    with pytest.raises(TypeError, match="no option `positons`"):
        gearcut.pair(scene_file, scene_file, positons=3)


def test_axes_are_those_of_the_command(command: Command, scene_file: Path, tmp_path: Path) -> None:
    command("axes", scene_file, "--out", tmp_path / "axes")
    moved = gearcut.axes(scene_file)
    assert list(moved.tables) == ["rough", "finish"]
    file = tmp_path / "axes" / "axes" / "finish.csv"
    expected = np.genfromtxt(file, delimiter=",", names=True)
    for key, column in moved.tables["finish"].items():
        assert np.array_equal(column, expected[key]), key
    units = moved.tables["finish"].units
    heads = ["stroke", "phi_deg", "center_distance_mm", "work_speed_deg_per_s", "cutter_acceleration_deg_per_s2"]
    assert [units[head] for head in heads] == ["1", "deg", "mm", "deg/s", "deg/s^2"]
    # A round gear: the spindles run at 12 to 20 teeth.
    ratio = moved.tables["finish"]["cutter_speed_deg_per_s"] / moved.tables["finish"]["work_speed_deg_per_s"]
    assert np.allclose(ratio, 12 / 20)


def test_texture_of_a_sine_is_that_of_the_closed_form_and_of_the_command(command: Command, tmp_path: Path) -> None:
    x_um, y_um = np.meshgrid(np.arange(400) * 2.0, np.arange(100) * 5.0)
    heights_um = 0.5 * np.sin(2 * np.pi * x_um / 100.0)
    found = gearcut.texture(heights_um + 0.01 * x_um - 0.02 * y_um, spacing_um=(2.0, 5.0))
    assert float(found["Sa"]) == pytest.approx(2 / math.pi * 0.5, rel=0.01) and found["Sa"].unit == "um"
    np.save(tmp_path / "sine.npy", heights_um)
    of_file = gearcut.texture(tmp_path / "sine.npy", spacing_um=(2.0, 5.0), form="none")
    import json

    printed = command("texture", tmp_path / "sine.npy", "--spacing-um", 2.0, 5.0, "--form", "none", "--json")
    expected = json.loads(printed)["parameters"]
    assert {symbol: of.value for symbol, of in of_file.items()} == {s: of["value"] for s, of in expected.items()}
