"""Heights and spacing of one surface through files, from gearcut to other programs and back.

The surface is asymmetric in x and y, rows and columns differ in number and spacing, and one copy has a hole: nothing can be
flipped, transposed or scaled unseen.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings

import numpy as np

warnings.simplefilter("ignore")
DX_UM, DY_UM = 2.0, 3.0
ROWS, COLUMNS = 7, 11


def heights(hole):
    x, y = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    z = 0.1 * x - 0.37 * y + 0.011 * x * y + 0.3 * np.sin(1.3 * x + 0.7 * y)
    if hole:
        z[2, 4] = np.nan
    return z


def gearcut(program, *arguments):
    done = subprocess.run([program, "texture", *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"gearcut texture {' '.join(arguments)}\n{done.stderr}")
    return done.stdout


def write_csv(path, z):
    with open(path, "w") as out:
        out.write(f"# dx_um = {DX_UM}\n# dy_um = {DY_UM}\n")
        # Notes go into comments and trailers of the formats that have some: readers must not stumble over them.
        notes = {"scene": "[gear]\nmodule_mm = 3.0 # * < & >", "frame": "x \u00b5m"}
        out.write(f"# notes = {json.dumps(notes)}\n")
        for row in z:
            out.write(",".join("" if np.isnan(v) else repr(float(v)) for v in row) + "\n")


def read_csv(path):
    lines = open(path).read().splitlines()
    facts = dict(line[1:].split("=", 1) for line in lines if line.startswith("#") and "=" in line)
    rows = [[float(v) if v else np.nan for v in line.split(",")] for line in lines if not line.startswith("#")]
    return np.array(rows), float(facts[" dx_um "]), float(facts[" dy_um "])


def check(name, found, expected, tolerance_um, mean_lost=False):
    z, dx, dy = found
    z = np.asarray(np.ma.filled(z, np.nan), dtype=float)
    if z.shape != expected.shape:
        raise SystemExit(f"{name}: shape {z.shape}, not {expected.shape}")
    for got, wanted in ((dx, DX_UM), (dy, DY_UM)):
        if abs(got / wanted - 1) > 1e-6:
            raise SystemExit(f"{name}: spacing {got}, not {wanted} um")
    if not np.array_equal(np.isnan(z), np.isnan(expected)):
        raise SystemExit(f"{name}: other holes")
    off = z - expected
    if mean_lost:
        off = off - np.nanmean(off)
    worst = np.nanmax(np.abs(off))
    if worst > tolerance_um:
        raise SystemExit(f"{name}: heights differ by {worst} um")
    print(f"ok   {name:58s} {worst:.1e} um")


def by_surfalize(path):
    import surfalize

    surface = surfalize.Surface.load(path)
    return surface.data, surface.step_x, surface.step_y


def by_surfacetopography(path):
    from SurfaceTopography import open_topography

    topography = open_topography(path).topography()
    factor = {"m": 1e6, "mm": 1e3, "µm": 1.0, "um": 1.0, "nm": 1e-3}[topography.unit]
    z = np.ma.filled(np.ma.masked_invalid(topography.heights()), np.nan).T * factor
    sx, sy = topography.physical_sizes
    return z, sx * factor / z.shape[1], sy * factor / z.shape[0]


def by_x3pio(path):
    import x3pio

    surface = x3pio.read(path)
    layer = surface.layers[0]
    steps = [float(np.diff(v)[0]) * 1e6 for v in (layer.x_values, layer.y_values)]
    return np.asarray(layer.z) * 1e6, *steps


def write_with_surfalize(z, folder):
    import surfalize

    for name in ("surfalize.x3p", "surfalize.sdf", "surfalize.sur"):
        path = os.path.join(folder, name)
        surfalize.Surface(z.copy(), DX_UM, DY_UM).save(path)
        yield path


def write_with_surfacetopography(z, folder):
    from SurfaceTopography import Topography

    path = os.path.join(folder, "surfacetopography.x3p")
    Topography(z.T * 1e-6, (COLUMNS * DX_UM * 1e-6, ROWS * DY_UM * 1e-6), unit="m").to_x3p(path)
    yield path


def write_with_x3pio(z, folder):
    import x3pio

    path = os.path.join(folder, "x3pio.x3p")
    x3pio.write(path, z * 1e-6, x_scale=DX_UM * 1e-6, y_scale=DY_UM * 1e-6)
    yield path


def main(program, keep):
    folder = tempfile.mkdtemp(prefix="gearcut_interop_")
    for hole in (False, True):
        z = heights(hole)
        csv = os.path.join(folder, "given.csv")
        write_csv(csv, z)
        names = ["ours.x3p", "ours.sdf", "ours_ascii.sdf", "ours.sur"]
        paths = [os.path.join(folder, name) for name in names]
        gearcut(program, csv, *(part for path in paths for part in ("--save", path)))
        what = "with a hole" if hole else "whole"
        for path, name in zip(paths, names):
            # SUR steps are a billionth of the range, its spacing and step are 32-bit floats.
            tolerance = 1e-6 if name.endswith(".sur") else 1e-12
            check(f"{name} {what}, opened by surfalize", by_surfalize(path), z, tolerance)
            check(f"{name} {what}, opened by SurfaceTopography", by_surfacetopography(path), z, tolerance)
        check(f"ours.x3p {what}, opened by x3pio", by_x3pio(paths[0]), z, 1e-12)
        writers = (write_with_surfalize, write_with_surfacetopography, write_with_x3pio)
        for path in (path for writer in writers for path in writer(z, folder)):
            name = os.path.basename(path)
            back = os.path.join(folder, "back.csv")
            gearcut(program, path, "--save", back)
            tolerance = 2e-6 if name.endswith(".sur") else 1e-9
            check(f"{name} {what}, opened by gearcut", read_csv(back), z, tolerance)
            if keep:
                os.makedirs(keep, exist_ok=True)
                shutil.copy(path, os.path.join(keep, ("hole_" if hole else "") + name))
    if keep:
        with open(os.path.join(keep, "truth.json"), "w") as out:
            rows = [[float(v) for v in row] for row in heights(False)]
            json.dump({"dx_um": DX_UM, "dy_um": DY_UM, "hole": [2, 4], "heights_um": rows}, out)
            out.write("\n")
    shutil.rmtree(folder)
    print("all surfaces came through")


if __name__ == "__main__":
    arguments = sys.argv[1:]
    keep_folder = arguments[arguments.index("--keep") + 1] if "--keep" in arguments else None
    main(arguments[0], keep_folder)
