"""Opens what `gearcut export` writes with ezdxf: audits files, closes contours, compares flanks with involutes.

Draws with ezdxf what a scene takes for its pitch curve."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
import numpy as np
import shapely
from ezdxf.math import bulge_to_arc, global_bspline_interpolation

SHAPING, HOBBING = "scenes/shaping", "scenes/hobbing"
# Name, scene, arguments.
CASES = [
    ("circular", f"{SHAPING}/circular_m3_z24.toml", []),
    ("circular_cut", f"{SHAPING}/circular_m3_z24.toml", ["--as-cut"]),
    ("circular_inch", f"{SHAPING}/circular_m3_z24.toml", ["--units", "inch"]),
    ("undercut", f"{SHAPING}/circular_m3_z24.toml", ["--set", "gear.teeth=10"]),
    ("undercut_cut", f"{SHAPING}/circular_m3_z24.toml", ["--set", "gear.teeth=10", "--as-cut"]),
    ("elliptical", f"{SHAPING}/elliptical_normal.toml", []),
    ("concave_cut", f"{SHAPING}/fourier_concave.toml", ["--as-cut"]),
    ("ring", f"{SHAPING}/internal_ellipse.toml", []),
    ("hobbed", f"{HOBBING}/circular_helical.toml", ["--section-mm", "3"]),
]
TOLERANCE_MM = 1e-3


def check(name, holds, detail=""):
    print(f"{'ok  ' if holds else 'FAIL'} {name} {detail}")
    if not holds:
        sys.exit(1)


def flattened(entity, unit, steps=24):
    """Points of a polyline, many on each arc, mm."""
    vertices = entity.get_points("xyb")
    count = len(vertices) if entity.closed else len(vertices) - 1
    points = []
    for i in range(count):
        (x, y, bulge), (u, v, _) = vertices[i], vertices[(i + 1) % len(vertices)]
        if bulge == 0:
            share = np.arange(steps)[:, None] / steps
            points.append(np.array([x, y]) * (1 - share) + np.array([u, v]) * share)
            continue
        centre, start, end, radius = bulge_to_arc((x, y), (u, v), bulge)
        sweep = (end - start) % (2 * np.pi)
        angles = start + sweep * np.arange(steps) / steps
        arc = np.array([centre.x, centre.y]) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        # ezdxf's arcs run counter-clockwise.
        if bulge < 0:
            arc = np.array([centre.x, centre.y]) + radius * np.stack(
                [np.cos(end - sweep * np.arange(steps) / steps), np.sin(end - sweep * np.arange(steps) / steps)], axis=1
            )
        points.append(arc)
    return unit * np.concatenate(points)


def off_involute_mm(points, teeth, radius_mm, alpha, within_mm):
    """Largest distance of flanks from the involutes of a round gear without shift."""
    base = radius_mm * np.cos(alpha)
    r = np.hypot(*points.T)
    on_flank = (r > within_mm[0]) & (r < within_mm[1])
    pitch = 2 * np.pi / teeth
    place = (np.arctan2(points[on_flank, 1], points[on_flank, 0]) / pitch - 0.5) % 1
    half = np.minimum(place, 1 - place) * pitch
    inv = lambda angle: np.tan(angle) - angle
    expected = 0.5 * np.pi / teeth + inv(alpha) - inv(np.arccos(base / r[on_flank]))
    return base * np.abs(half - expected).max(), on_flank.sum()


def drawn(document, path):
    import matplotlib

    matplotlib.use("Agg")
    from ezdxf.addons.drawing import matplotlib as drawing

    drawing.qsave(document.modelspace(), path, bg="#FFFFFF", fg="#000000", dpi=300)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for name, scene, more in CASES:
            path = folder / f"{name}.dxf"
            command = [arguments.program, "export", scene, "--dxf", path, "--quiet", "--force", *more]
            said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            one(name, path, said, more)
            if arguments.keep:
                drawn(ezdxf.readfile(path), path.with_suffix(".png"))
        taken(arguments.program, folder)
        for name, scene in [("cutter", CASES[0][1]), ("hob", CASES[-1][1])]:
            path = folder / f"{name}.dxf"
            command = [arguments.program, "export", scene, "--tool-dxf", path, "--force"]
            subprocess.run(command, check=True, capture_output=True)
            audit = ezdxf.readfile(path).audit()
            check(f"{name}: a sound file", not audit.errors and not audit.fixes)
            if arguments.keep:
                drawn(ezdxf.readfile(path), path.with_suffix(".png"))


def taken(program, folder):
    """Pitch curves that gearcut takes from drawings: a spline by ezdxf in inches, and what gearcut drew itself."""
    angles = np.linspace(0, 2 * np.pi, 361)
    known = lambda angle: 60 + 4 * np.cos(2 * angle) + np.sin(3 * angle)
    polar = lambda r, angle: np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)
    spline, own = folder / "spline.dxf", folder / "taken.dxf"
    document = ezdxf.new("R2010", units=ezdxf.units.IN)
    tool = global_bspline_interpolation(polar(known(angles) / 25.4, angles), degree=3)
    document.modelspace().add_spline().apply_construction_tool(tool)
    document.saveas(spline)
    scene = f"{SHAPING}/table_of_points.toml"
    fine = np.linspace(0, 2 * np.pi, 100001)
    perimeter = np.hypot(*np.diff(polar(known(fine), fine), axis=0).T).sum()
    scale = np.pi * 2.5 * 48 / perimeter
    for name, source in [("taken from ezdxf", spline), ("taken from gearcut", own)]:
        setting = f"gear.pitch_curve.table.file={source.resolve()}"
        path = folder / "out.dxf"
        command = [program, "export", scene, "--dxf", path, "--set", setting, "--tolerance-um", "0.5", "--force"]
        subprocess.run(command, check=True, capture_output=True)
        curve = ezdxf.readfile(path).modelspace().query('LWPOLYLINE[layer=="PITCH_CURVE"]')[0]
        points = flattened(curve, 1.0)
        off = np.abs(np.hypot(*points.T) - scale * known(np.arctan2(points[:, 1], points[:, 0]))).max()
        # Half a micrometre of arcs each time that the curve is drawn.
        check(f"{name}: its pitch curve", off < (0.6e-3 if source == spline else 1.2e-3), f"{1000 * off:.3f} um")
        path.rename(own)


def one(name, path, said, more):
    document = ezdxf.readfile(path)
    audit = document.audit()
    check(f"{name}: a sound file", not audit.errors and not audit.fixes, document.acad_release)
    inch = "inch" in more
    unit = 25.4 if inch else 1.0
    units = [document.header["$INSUNITS"], document.header["$MEASUREMENT"]]
    check(f"{name}: units", units == ([1, 0] if inch else [4, 1]))
    layer = "AS_CUT" if "--as-cut" in more else "TARGET"
    layers = {e.dxf.layer for e in document.modelspace()}
    check(f"{name}: layers", {layer, "PITCH_CURVE", "BLANK"} <= layers, str(sorted(layers)))
    profiles = document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    check(f"{name}: one profile", len(profiles) == 1)
    profile = profiles[0]
    lengths = [np.hypot(u - x, v - y) for (x, y, _), (u, v, _) in pairs(profile)]
    check(f"{name}: closed, no piece without length", profile.closed and min(lengths) * unit > 1e-6)
    points = flattened(profile, unit)
    polygon = shapely.Polygon(points)
    check(f"{name}: does not cross itself", polygon.is_valid)
    check(f"{name}: counter-clockwise", shapely.LinearRing(points).is_ccw)
    count = said.splitlines()[1].split()
    lines = int(said.splitlines()[1].rsplit("has", 1)[1].split()[0])
    check(f"{name}: pieces", len(lengths) == int(count[1]) + int(count[4]), f"{len(lengths)} for {lines} lines")
    if layer == "TARGET":
        check(f"{name}: a quarter of a polyline's at most", 4 * len(lengths) <= lines)
    if name.startswith("circular") and layer == "TARGET":
        off, places = off_involute_mm(points, 24, 36.0, np.radians(20), (35.2, 38.99))
        check(f"{name}: flanks are involutes", off <= TOLERANCE_MM and places > 2000, f"{1000 * off:.3f} um at most")
    if name == "circular_cut":
        off, _ = off_involute_mm(points, 24, 36.0, np.radians(20), (35.2, 38.9))
        check(f"{name}: flanks are involutes but for marks", 2e-4 < off < 0.01, f"{1000 * off:.3f} um")


def pairs(polyline):
    vertices = polyline.get_points("xyb")
    return list(zip(vertices, vertices[1:] + ([vertices[0]] if polyline.closed else [])))


if __name__ == "__main__":
    main()
