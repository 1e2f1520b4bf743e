"""Hobbing of one tooth space by booleans of meshes, with manifold3d: the peer of gearcut's spatial kernel.

Case: the spur gear of tests/data/hobbing/p12_patch_spur.json (m 8 mm, 35 teeth, hob with 10 gashes, feed 2.5 mm), one
space, a slab of 6 mm, the 363 hob tooth positions whose sweeps can shape it: 11 revolutions of the work by 33 teeth.
The sweep of a tooth's rake face through the slab is a closed mesh (its sections joined), and the sweeps are subtracted
from the blank one after the other in the order of time, or all at once. The blank is the sector of one space alone; an
outline of the whole gear would cost the peer more.

The distance along the rays of the file from the exact surface of all passes, an independent solution that stands in the
file, is the error of the method.

    python3 -m venv /tmp/peer && /tmp/peer/bin/pip install manifold3d==3.5.4 numpy==2.4.6
    /tmp/peer/bin/python benches/peers/manifold_hobbing.py

Times are processor time of the whole process. `cargo bench --bench hobbed_gear -- peer` times gearcut on the same case.
"""

import json
import math
import time

import numpy as np
from manifold3d import CrossSection, Manifold, Mesh, OpType

FILE = json.load(open("tests/data/hobbing/p12_patch_spur.json"))
SETUP = FILE["setup"]
MODULE, ALPHA, GASHES, TEETH = SETUP["mn"], SETUP["alpha_n"], SETUP["Zb"], SETUP["Z"]
RADIUS = 0.5 * MODULE * TEETH
LEAD_ANGLE, PITCH_RADIUS, HAND = SETUP["lam"], SETUP["Rp"], SETUP["hb"]
PARAMETER = 0.5 * MODULE / math.cos(LEAD_ANGLE)  # lead / 2 pi
TILT = -HAND * LEAD_ANGLE  # spur gear
FEED_PER_RAD = SETUP["vz"] / SETUP["wb"]
HALF_SLAB = 3.2  # a little more than the rays of the file
CYCLES, TEETH_EACH_SIDE = range(-5, 6), 16
SWEPT = 0.32  # to both sides: the slab lies within


def hob_profile(points_per_flank):
    """Rake face of a tooth (involute worm, axial gashes): polygon of (radius, place along the axis)."""
    base_lead = math.acos(math.cos(LEAD_ANGLE) * math.cos(ALPHA))
    base = PARAMETER / math.tan(base_lead)
    inv = lambda rho: math.sqrt((rho / base) ** 2 - 1) - math.atan(math.sqrt((rho / base) ** 2 - 1))
    half_pitch_width = 0.25 * math.pi * MODULE / math.cos(LEAD_ANGLE)
    half = lambda rho: half_pitch_width - PARAMETER * (inv(rho) - inv(PITCH_RADIUS))
    tip, root = PITCH_RADIUS + SETUP["ha0"] * MODULE, PITCH_RADIUS - 1.25 * MODULE
    rhos = np.linspace(root, tip, points_per_flank + 1)
    return np.array([(rho, half(rho)) for rho in rhos] + [(rho, -half(rho)) for rho in rhos[::-1]])


def sections(profile, tooth, cycle, moments):
    """Places of the profile in the gear's frame at some moments: (moment, point, xyz).

    Gear frame: the machine's axes at rest when space 0 stands at the pitch point, origin in the gear's axis.
    """
    own = 2 * math.pi * tooth / GASHES
    hob = own + 2 * math.pi * TEETH * cycle + moments  # hob angle; the tooth points to the work at moment 0
    axis = np.array([math.cos(TILT), 0.0, math.sin(TILT)])
    towards = np.array([0.0, -1.0, 0.0])
    third = np.cross(axis, towards)
    angle = HAND * moments
    out = np.cos(angle)[:, None] * towards + np.sin(angle)[:, None] * third
    along = HAND * PARAMETER * own  # a left-hand thread runs to -z of the hob
    centre = np.stack([np.zeros_like(hob), np.full_like(hob, PITCH_RADIUS), FEED_PER_RAD * hob], axis=1)
    in_machine = (
        centre[:, None, :]
        + profile[None, :, 0, None] * out[:, None, :]
        + (along + profile[None, :, 1, None]) * axis[None, None, :]
    )
    # From the pitch point to the gear's axis, and back by what the gear has rolled.
    p = in_machine + np.array([0.0, RADIUS, 0.0])
    turn = -(0.5 * MODULE * (hob - 2 * math.pi * TEETH * cycle)) / RADIUS
    cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
    return np.stack([cos * p[..., 0] - sin * p[..., 1], sin * p[..., 0] + cos * p[..., 1], p[..., 2]], axis=2)


def lofted(rings):
    """Closed mesh through sections of a polygon."""
    count, points, _ = rings.shape
    at = lambda i, j: i * points + j % points
    triangles = []
    for i in range(count - 1):
        for j in range(points):
            a, b, c, d = at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)
            triangles += [(a, b, c), (a, c, d)]
    half = points // 2
    for ring, turned in ((0, True), (count - 1, False)):
        # The polygon is a ladder between its two flanks.
        for j in range(half - 1):
            quad = [at(ring, j), at(ring, j + 1), at(ring, points - 2 - j), at(ring, points - 1 - j)]
            for t in ((quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])):
                triangles.append(t[::-1] if turned else t)
    vertices, faces = rings.reshape(-1, 3), np.array(triangles)
    corners = vertices[faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum()
    return vertices, faces if volume > 0 else faces[:, ::-1]


def solid(vertices, faces):
    made = Manifold(Mesh(vertices.astype(np.float32), faces.astype(np.uint32)))
    assert not made.is_empty(), made.status()
    return made


def blank():
    angles = np.linspace(-1, 1, 41) * 0.8 * math.pi / TEETH
    arc = lambda r: [(r * math.sin(a), r * math.cos(a)) for a in angles]
    outline = arc(RADIUS + MODULE) + arc(RADIUS - 2 * MODULE)[::-1]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1]))
    section = CrossSection([outline if area > 0 else outline[::-1]])
    return Manifold.extrude(section, 2 * HALF_SLAB).translate((0, 0, -HALF_SLAB))


def rays():
    """Rays of the file: origin, direction, exact height; its flank -1, space 0."""
    side = FILE["flank"]
    sigma, z = np.meshgrid(FILE["sigma"], FILE["z"])
    roll = -side * 0.25 * math.pi * MODULE + sigma
    c = -side * sigma * math.cos(ALPHA)
    normal = np.array([side * math.cos(ALPHA), math.sin(ALPHA)])
    p = np.stack([c * normal[0], c * normal[1] + RADIUS], axis=-1)
    cos, sin = np.cos(-roll / RADIUS), np.sin(-roll / RADIUS)
    rotate = lambda x, y: np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
    origin, direction = rotate(p[..., 0], p[..., 1]), rotate(normal[0], normal[1])
    flat = lambda v, w: np.concatenate([v.reshape(-1, 2), w.reshape(-1, 1)], axis=1)
    return flat(origin, z), flat(direction, 0 * z), np.array(FILE["heights"]).reshape(-1)


def heights(result, origins, directions):
    """Height of the surface nearest to the target along each ray, mm."""
    mesh = result.to_mesh()
    corners = np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3][np.asarray(mesh.tri_verts)]
    low, high = corners.min(axis=1), corners.max(axis=1)
    found = np.full(len(origins), np.nan)
    for i, (o, d) in enumerate(zip(origins, directions)):
        near = np.all((low <= o + 0.05) & (high >= o - 0.05), axis=1)
        a, b, c = (corners[near, k] for k in range(3))
        e1, e2 = b - a, c - a
        p = np.cross(d, e2)
        det = np.einsum("ij,ij->i", e1, p)
        with np.errstate(divide="ignore", invalid="ignore"):
            s = o - a
            u = np.einsum("ij,ij->i", s, p) / det
            q = np.cross(s, e1)
            v = q @ d / det
            t = np.einsum("ij,ij->i", e2, q) / det
        hit = t[(u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & np.isfinite(t)]
        if len(hit):
            found[i] = hit[np.abs(hit).argmin()]
    return found


def main():
    origins, directions, exact = rays()
    positions = [(c, k) for c in CYCLES for k in range(-TEETH_EACH_SIDE, TEETH_EACH_SIDE + 1)]
    # Time grows with hob angle.
    positions.sort()
    print(f"{len(positions)} positions")
    names = ["method", "sections x points", "sweeps, s", "subtracting, s", "first fifth, last fifth, s", "triangles"]
    names += ["off the exact surface: rms, um", "largest, um"]
    print(f"| {' | '.join(names)} |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for count, points in ((13, 4), (25, 8), (49, 16), (97, 16)):
        started = time.process_time()
        moments = np.linspace(-SWEPT, SWEPT, count)
        profile = hob_profile(points)
        sweeps = [solid(*lofted(sections(profile, k, c, moments))) for c, k in positions]
        made = time.process_time() - started
        for method in ("one by one", "all at once"):
            started, laps = time.process_time(), []
            result = blank()
            if method == "one by one":
                for sweep in sweeps:
                    lap = time.process_time()
                    result = result - sweep
                    result.num_tri()  # evaluates
                    laps.append(time.process_time() - lap)
            else:
                result = Manifold.batch_boolean([result, *sweeps], OpType.Subtract)
            triangles = result.num_tri()
            took = time.process_time() - started
            off = 1e3 * (heights(result, origins, directions) - exact)
            assert np.isfinite(off).mean() > 0.99, np.isfinite(off).mean()
            fifth = len(laps) // 5
            course = f"{sum(laps[:fifth]):.2f}, {sum(laps[-fifth:]):.2f}" if laps else "-"
            print(
                f"| {method} | {count} x {len(profile)} | {made:.2f} | {took:.2f} | {course} | {triangles} |"
                f" {math.sqrt(np.nanmean(off**2)):.3g} | {np.nanmax(np.abs(off)):.3g} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
