"""Face milling of one slot by booleans of meshes, with manifold3d: the peer of gearcut's bevel cutting.

Case: the finishing cut of scenes/bevel/five_linkage_printed.toml (62 teeth, 16 blades), the slot behind tooth 1, at the
positions that gearcut itself writes: blade and cradle angle of every pass that takes anything
(tables/chips_by_pass.csv).
The sweep of a blade through the blank is a closed mesh (its sections joined), and the sweeps are subtracted from the
slot's part of the blank one after the other in the order of time, or all at once.

Against the points and deviations of tables/grid.csv, both flanks of the slot, the distance along the normals is the
error of the method; gearcut's own deviations stand there with it.

    gearcut cut scenes/bevel/five_linkage_printed.toml --out /tmp/peer_bevel
    python3 -m venv /tmp/peer && /tmp/peer/bin/pip install manifold3d==3.5.4 numpy==2.4.6
    /tmp/peer/bin/python benches/peers/manifold_bevel.py /tmp/peer_bevel

Times are processor time of the whole process.
"""

import csv
import math
import sys
import time
import tomllib

import numpy as np
from manifold3d import Manifold, Mesh, OpType
from manifold_hobbing import heights, lofted, solid

FOLDER = sys.argv[1]
SCENE = tomllib.load(open("scenes/bevel/five_linkage_printed.toml", "rb"))
CONES, CRADLE, HEAD = SCENE["gear"]["bevel"], SCENE["machine"]["cradle"], SCENE["tool"]["face_mill"]
TEETH, FACE = SCENE["gear"]["teeth"], SCENE["gear"]["face_width_mm"]
PITCH, FACE_ANGLE, ROOT = (math.radians(CONES[f"{k}_angle_deg"]) for k in ("pitch", "face", "root"))
OUTER = 0.5 * SCENE["gear"]["module_mm"] * TEETH / math.sin(PITCH)
FINISH = SCENE["operation"][-1]
# Cradle angle per angle of the head.
SLOWLY = FINISH["roll_speed_deg_per_s"] / (FINISH["head_speed_per_minute"] * 6.0)
BLADE_HEIGHT = 1.5 * (CONES["addendum_mm"] + CONES["dedendum_mm"])
SWEPT = 0.3  # rad to both sides: the face lies within


def table(name):
    return list(csv.DictReader(open(f"{FOLDER}/tables/{name}.csv")))


def radius():
    """Mean cutter radius as the settings say: the circle through the mean point."""
    import json

    return json.load(open(f"{FOLDER}/results.json"))["sections"]["settings"]["cutter_radius"]["value"]


def edge(outside, points, mean_radius):
    """A blade's outline: (radius, height over the tips), from its back over the tip to the flank."""
    width, tilt, corner = HEAD["point_width_mm"], math.radians(20.0), HEAD["corner_radius_mm"]
    tip = 0.7 * width
    half, end = 0.5 * width, corner * (1 - math.sin(tilt)) / math.cos(tilt)
    lean = np.linspace(0.5 * math.pi, tilt, points)  # of the normal: along the axis to square to the flank
    arc = [(half - end + corner * math.cos(a), corner * (1 - math.sin(a))) for a in lean]
    flank = [(half + h * math.tan(tilt), h) for h in np.linspace(arc[-1][1], BLADE_HEIGHT, points)[1:]]
    back = [(half - tip - h * math.tan(0.5 * tilt), h) for h in np.linspace(BLADE_HEIGHT, 0.0, points + 1)]
    outline = np.array(back + arc + flank)
    sign = 1.0 if outside else -1.0
    return np.stack([mean_radius + sign * outline[:, 0], outline[:, 1]], axis=1)


def in_work(points, cradle):
    """Places of the tool frame in the work's frame (x along the axis from the apex), by the paper's matrices."""
    gamma, ratio = ROOT, CRADLE["roll_ratio"]
    cos, sin = np.cos(cradle)[:, None], np.sin(cradle)[:, None]
    x, y, z = points[..., 0] + CRADLE["radial_setting_mm"], points[..., 1], points[..., 2]
    m = np.stack([cos * x - sin * y + CRADLE.get("cross_shift_mm", 0.0), sin * x + cos * y, z + 0 * x], axis=-1)
    p = np.stack([math.cos(gamma) * m[..., 0] + math.sin(gamma) * m[..., 2], m[..., 1],
                  -math.sin(gamma) * m[..., 0] + math.cos(gamma) * m[..., 2]], axis=-1)
    a = -ratio * cradle
    cos, sin = np.cos(a)[:, None], np.sin(a)[:, None]
    return np.stack([p[..., 0], cos * p[..., 1] - sin * p[..., 2], sin * p[..., 1] + cos * p[..., 2]], axis=-1)


def sweep(outline, cradle_deg, middle, moments):
    """Sections of a blade at some moments, work frame."""
    angle = middle + moments
    out = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    points = np.stack([outline[None, :, 0] * out[:, 0, None], outline[None, :, 0] * out[:, 1, None],
                       -outline[None, :, 1] + 0 * angle[:, None]], axis=-1)
    return in_work(points, math.radians(cradle_deg) + SLOWLY * moments)


def work_from_gear(points, turn):
    """The gear frame's x runs along the work's -z, its z along -x; `turn` brings the slot to where it is cut."""
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    cos, sin = math.cos(turn), math.sin(turn)
    return np.stack([-z, -(sin * x + cos * y), -(cos * x - sin * y)], axis=-1)


def blank(polar, distances):
    """The slot's part of the blank: `polar` is the middle of the slot at cone distances, gear frame."""
    def place(distance, over, angle):
        radius = distance * math.sin(PITCH) + over * math.cos(PITCH)
        along = distance * math.cos(PITCH) - over * math.sin(PITCH)
        return (radius * math.cos(angle), radius * math.sin(angle), -along)

    rings = []
    for distance, middle in zip(distances, polar):
        tip = CONES["addendum_mm"] - (OUTER - distance) * math.tan(FACE_ANGLE - PITCH)
        low = -CONES["dedendum_mm"] + (OUTER - distance) * math.tan(PITCH - ROOT) - 2.0
        angles = middle + np.linspace(-1, 1, 25) * math.pi / TEETH
        rings.append([place(distance, tip, a) for a in angles] + [place(distance, low, a) for a in angles[::-1]])
    return np.array(rings)


def main():
    mean_radius = radius()
    passes = [(int(row["blade"]), float(row["cradle_angle_deg"])) for row in table("chips_by_pass")]
    grid = [row for row in table("grid") if (row["tooth"], row["flank"]) in (("1", "left"), ("2", "right"))]
    number = lambda keys: np.array([[float(row[k]) for k in keys] for row in grid])
    points, normals = number(("x_mm", "y_mm", "z_mm")), number(("nx", "ny", "nz"))
    ours = 1e-3 * number(("deviation_um",))[:, 0]
    # Middle of the slot at the rows, from the points nearest to the pitch cone on both sides.
    distance = -points[:, 2] * math.cos(PITCH) + np.hypot(points[:, 0], points[:, 1]) * math.sin(PITCH)
    angle = np.arctan2(points[:, 1], points[:, 0])
    over = np.polyfit(distance, angle, 3)
    distances = np.linspace(OUTER - FACE, OUTER, 25)
    polar = np.polyval(over, distances)
    # Where blades stand in the middle of the slot: from the head to the mean point, in the tool's frame.
    cradle = math.radians(CRADLE["cradle_angle_deg"])
    head = CRADLE["radial_setting_mm"] * np.array([math.cos(cradle), math.sin(cradle)])
    to = np.array([OUTER - 0.5 * FACE, 0.0]) - head
    middle = math.atan2(to[1], to[0]) - cradle
    # The flanks say how far the slot is turned: the largest distance of their points from the tool's cones is least.
    tip = np.array([[[mean_radius * math.cos(middle), mean_radius * math.sin(middle), 0.0]]])
    mean = in_work(tip, np.array([cradle]))[0, 0]
    turn = math.atan2(-mean[1], -mean[2]) - np.polyval(over, OUTER - 0.5 * FACE)
    turn = fitted(points, normals, turn, mean_radius, middle)
    origins, directions = work_from_gear(points, turn), work_from_gear(normals, turn)
    print(f"{len(passes)} passes; gearcut's deviations {1e3 * ours.min():.4f} to {1e3 * ours.max():.4f} um")
    names = ["method", "sections x points", "sweeps, s", "subtracting, s", "triangles"]
    names += ["off gearcut's surface: rms, um", "largest, um"]
    print(f"| {' | '.join(names)} |\n|{' --- |' * len(names)}")
    center = origins.mean(axis=0)
    stock = work_from_gear(blank(polar, distances), turn) - center
    for count, detail in ((13, 4), (25, 8), (49, 16)):
        started = time.process_time()
        moments = np.linspace(-SWEPT, SWEPT, count)
        outlines = [edge(kind == 0, detail, mean_radius) for kind in (0, 1)]
        sweeps = [solid(*lofted(sweep(outlines[b % 2], q, middle, moments) - center)) for b, q in passes]
        made = time.process_time() - started
        for method in ("one by one", "all at once"):
            started = time.process_time()
            result = solid(*lofted(stock))
            if method == "one by one":
                for one in sweeps:
                    result = result - one
                    result.num_tri()  # evaluates
            else:
                result = Manifold.batch_boolean([result, *sweeps], OpType.Subtract)
            triangles = result.num_tri()
            took = time.process_time() - started
            off = 1e3 * (heights(result, origins - center, directions) - ours)
            print(
                f"| {method} | {count} x {len(outlines[0])} | {made:.2f} | {took:.2f} | {triangles} |"
                f" {math.sqrt(np.nanmean(off**2)):.3g} | {np.nanmax(np.abs(off)):.3g} |",
                flush=True,
            )


def fitted(points, normals, start, mean_radius, middle):
    """Turn of the slot about the axis: the flanks' points touch the cones of the head when they are generated, so that
    the mean over both flanks of their smallest distances to the cones over the roll is zero."""
    cradles = math.radians(CRADLE["cradle_angle_deg"]) + np.linspace(-0.25, 0.25, 201)

    def signed(turn):
        at = work_from_gear(points, turn)
        total = 0.0
        gamma, ratio, tilt = ROOT, CRADLE["roll_ratio"], math.radians(20.0)
        least = np.full((len(points), 2), np.inf)
        for q in cradles:
            a = ratio * q
            y, z = math.cos(a) * at[:, 1] - math.sin(a) * at[:, 2], math.sin(a) * at[:, 1] + math.cos(a) * at[:, 2]
            x = math.cos(gamma) * at[:, 0] - math.sin(gamma) * z - CRADLE.get("cross_shift_mm", 0.0)
            depth = math.sin(gamma) * at[:, 0] + math.cos(gamma) * z
            tx = math.cos(q) * x + math.sin(q) * y - CRADLE["radial_setting_mm"]
            ty = -math.sin(q) * x + math.cos(q) * y
            rho = np.hypot(tx, ty)
            outer = (rho - (mean_radius + 0.5 * HEAD["point_width_mm"] - depth * math.tan(tilt))) * math.cos(tilt)
            inner = (mean_radius - 0.5 * HEAD["point_width_mm"] + depth * math.tan(tilt) - rho) * math.cos(tilt)
            least = np.minimum(least, np.stack([outer, inner], axis=1))
        half = len(points) // 2
        by_side = [least[:half], least[half:]]
        # Each flank belongs to the cone that comes nearest to it.
        kinds = [np.abs(side).mean(axis=0).argmin() for side in by_side]
        return by_side[0][:, kinds[0]].mean() - by_side[1][:, kinds[1]].mean()

    low, high = start - 0.03, start + 0.03
    rising = signed(high) > signed(low)
    for _ in range(40):
        mid = 0.5 * (low + high)
        if (signed(mid) > 0) == rising:
            high = mid
        else:
            low = mid
    return 0.5 * (low + high)


if __name__ == "__main__":
    main()
