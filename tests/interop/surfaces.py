"""Heights and spacing of one surface through files, from gearcut to other programs and back; its parameters in all.

The surface that travels is asymmetric in x and y, rows and columns differ in number and spacing, and one copy has a
hole: nothing can be flipped, transposed or scaled unseen.
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
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
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
        out.write(f"# gearcut surface: heights in um\n# dx_um = {DX_UM}\n# dy_um = {DY_UM}\n")
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

    for name in ("surfalize.x3p", "surfalize.sdf", "surfalize.sur", "surfalize.al3d"):
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


# surfalize's name and arguments where ours is a function's value.
CALLS = {"Smr(0)": ("Smr", 0.0), "Sdc(10,80)": ("Sdc", 10, 80)}
CALLS |= {"Smrk1": ("Smr1",), "Smrk2": ("Smr2",)}
CALLS |= {f"{name}({p})": (name, p) for name in ("Smc", "Vm", "Vv") for p in (10, 50, 80)}
# Same sums over the same points: rounding alone.
EXACT = "Sa Sq Ssk Sku Sp Sv Sz Ssw Sdq Sdr Spc S10z S5p S5v".split()
# surfalize's material ratio curve has 10,000 quantiles, gearcut's all heights.
CURVE = "Sk Spk Svk Smrk1 Smrk2 Spkx Svkx Sxp Vmp Vmc Vvc Vvv".split() + list(CALLS)
# Where the autocorrelation falls to 0.2: straight lines between lags here, cubic splines along rays there.
BORDER = ["Sal", "Str"]


def compare_parameters(program, path, defined):
    """One surface evaluated by gearcut, surfalize and SurfaceTopography; every parameter that exists must agree."""
    import surfalize
    from SurfaceTopography import open_topography

    ours = json.loads(gearcut(program, path, "--form", "none", "--json"))["parameters"]
    value = lambda symbol: ours[symbol]["value"]  # noqa: E731
    surface = surfalize.Surface.load(path).center()
    name = os.path.basename(path)
    worst = {}

    def agree(group, symbol, theirs, expected, tolerance, floor=0.0):
        if expected is None or np.isnan(theirs):
            if not (expected is None and np.isnan(theirs)):
                raise SystemExit(f"{name}: {symbol} is {expected} here and {theirs} there")
            return
        off = abs(theirs - expected) / max(abs(expected), floor, 1e-300)
        if off > tolerance:
            raise SystemExit(f"{name}: {symbol} is {expected} here and {theirs} there")
        worst[group] = max(worst.get(group, (0.0, 0))[0], off), worst.get(group, (0.0, 0))[1] + 1

    def theirs(symbol):
        method, *arguments = CALLS.get(symbol, (symbol,))
        return float(getattr(surface, method)(*arguments))

    for symbol in EXACT:
        agree("sums over points", symbol, theirs(symbol), value(symbol), 1e-9)
    for symbol in CURVE:
        # Heights next to the mean plane have no relative accuracy: a twentieth of Sq counts as one.
        floor = 0.05 * value("Sq") if ours[symbol]["unit"] == "um" else 0.0
        agree("material ratio curve", symbol, theirs(symbol), value(symbol), 5e-3, floor)
    for symbol in BORDER:
        agree("autocorrelation", symbol, theirs(symbol), value(symbol), 5e-3)
    # Where the programs differ by definition, the difference is the one that is known.
    nx, ny = surface.size
    for symbol in ("Spd", "Svd"):
        agree("known differences", symbol, theirs(symbol), value(symbol) * nx * ny / ((nx - 1) * (ny - 1)), 1e-9)
    # Curvature of pits of the surface turned over here, of the surface as it is there.
    agree("known differences", "Svc", -theirs("Svc"), value("Svc"), 1e-9)
    for symbol in ("Sak1", "Sak2"):  # areas over a ratio in per cent there, volumes per area here
        agree("known differences", symbol, theirs(symbol), 100 * value(symbol), 5e-3)
    turned = (180 - theirs("Std") - value("Std") + 90) % 180 - 90  # its y points up the map; classes of half a degree
    # Heights alike in all directions have none: there the largest of equal classes is chance.
    has_direction = value("Str") is None or value("Str") < 0.3
    if has_direction and abs(turned) > 0.5:
        raise SystemExit(f"{name}: Std is {value('Std')} here and {theirs('Std')} there")
    topography = open_topography(path).topography().detrend("center").to_unit("µm")
    agree("SurfaceTopography", "Sq", topography.rms_height_from_area(), value("Sq"), 1e-9)
    # Its gradient averages both directions over the same points.
    agree("SurfaceTopography", "Sdq", topography.rms_gradient(), value("Sdq"), 1e-3)
    # A column as a profile, across the marks. What surfalize calls R is what it is given: the primary profile.
    arguments = ["--profile", "p", "--line-form", "none", "--lambda-s-um", "0", "--line", "x=0", "--json"]
    line = json.loads(gearcut(program, path, *arguments))["profiles"][0]["parameters"]
    heights = surface.data[:, 0]
    profile = surfalize.Profile(heights - heights.mean(), surface.step_y)
    for symbol in ("a", "q", "t", "sk", "ku"):
        peer = float(getattr(profile, f"R{symbol}")())
        agree("profile, sums over points", f"P{symbol}", peer, line[f"P{symbol}"]["value"], 1e-9)
    compare_core_of_profile(program, name, heights, surface.step_y)
    for group, (off, count) in worst.items():
        print(f"ok   {name + ', ' + group:58s} {off:.1e}, {count} compared")
    missing = [symbol for symbol in defined if value(symbol) is None]
    if missing:
        raise SystemExit(f"{name}: no {', '.join(missing)}, so that nothing was compared")


def compare_core_of_profile(program, name, heights, step_um):
    """Pk of a line with straight lines between its points: both programs tend to one value as points come closer.

    surfalize puts height k of N at k / (N - 1) and takes whole points for the ends of the 40 % window, gearcut puts
    it at (k + 1/2) / N: a per cent on some hundred points, and less and less as they come closer.
    """
    import surfalize

    off = []
    places = np.arange(len(heights))
    for times in (1, 4, 16):
        fine = np.interp(np.arange(times * (len(heights) - 1) + 1) / times, places, heights)
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as out:
            rows = (f"{k * step_um / times:.9f}\t{z:.12f}\n" for k, z in enumerate(fine))
            out.write("x [um]\tz [um]\n" + "".join(rows))
            out.flush()
            arguments = ["--profile", "p", "--line-form", "none", "--lambda-s-um", "0", "--json"]
            ours = json.loads(gearcut(program, out.name, *arguments))["profiles"][0]["parameters"]["Pk"]["value"]
        off.append(abs(float(surfalize.Profile(fine - fine.mean(), step_um / times).Rk()) / ours - 1))
    words = ", ".join(f"{share:.1e}" for share in off)
    if not (off[2] < 2e-3 and off[2] < off[0] / 4):
        raise SystemExit(f"{name}: Pk does not tend to one value as points come closer: {words}")
    print(f"ok   {name + ', Pk at 1, 1/4, 1/16 of the spacing':58s} {words}")


def main(program, keep):
    folder = tempfile.mkdtemp(prefix="gearcut_interop_")
    # A flank as gearcut cuts it, and heights of many lengths with hills that lie inside.
    scene = os.path.join(ROOT, "tests", "browser", "scene.toml")
    out = os.path.join(folder, "gear")
    subprocess.run([program, "cut", scene, "--backend", "cpu", "--quiet", "--out", out], check=True)
    compare_parameters(program, os.path.join(out, "texture", "finish", "tooth_03_left.x3p"), ["Sal", "Sk", "Vmp"])
    rough = os.path.join(folder, "gaussian.x3p")
    source = os.path.join(ROOT, "crates", "texture", "tests", "data", "p6_gauss_isotropic.npy")
    gearcut(program, source, "--spacing-um", "1", "--save", rough)
    compare_parameters(program, rough, ["Str", "Spc", "S10z"])
    for hole in (False, True):
        z = heights(hole)
        csv = os.path.join(folder, "given.csv")
        write_csv(csv, z)
        names = ["ours.x3p", "ours.sdf", "ours_ascii.sdf", "ours.sur"]
        paths = [os.path.join(folder, name) for name in names]
        gearcut(program, csv, "--force", *(part for path in paths for part in ("--save", path)))
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
            gearcut(program, path, "--force", "--save", back)
            # AL3D holds metres as 32-bit floats.
            tolerance = 2e-6 if name.endswith((".sur", ".al3d")) else 1e-9
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
