#!/usr/bin/env python3
"""Polygon clipping stroke by stroke with shapely (GEOS): the peer in Python of gearcut's own benchmark.

Job: round gear m 3 mm, z 24, alpha 20 deg, cutter z0 20 with sharp tips at 1.25 m, 1,440 strokes at equal work angles,
one transverse section. The blank is its tip circle; every stroke subtracts the cutter's teeth that reach it. Prints the
time of the clipping alone and how far the outline ends from the exact involute, measured along the involute's normal on
all flanks, 5 % of the profile left out at either end. Times compare on one machine alone.

    python3 -m venv /tmp/peer && /tmp/peer/bin/pip install shapely==2.2.0 numpy==2.4.6
    /tmp/peer/bin/python benches/peers/shapely_clipping.py
"""

import math
import time

import numpy as np
import shapely

M, Z, Z0, ALPHA, STROKES = 3.0, 24, 20, math.radians(20.0), 1440
R, R0 = M * Z / 2, M * Z0 / 2
RB, RB0 = R * math.cos(ALPHA), R0 * math.cos(ALPHA)
TIP, TIP0 = R + M, R0 + 1.25 * M
INV = math.tan(ALPHA) - ALPHA


def involute(base, half_angle, side, roll):
    """Points of an involute flank; `side` +1 or -1, `roll` the tangent of the pressure angle."""
    angle = side * (half_angle - (roll - np.arctan(roll)))
    radius = base * np.hypot(1.0, roll)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def cutter_tooth(chords):
    half = math.pi / (2 * Z0) + INV
    tip_roll = math.sqrt((TIP0 / RB0) ** 2 - 1)
    rolls = tip_roll * (np.arange(chords + 1) / chords) ** (2 / 3)
    right, left = involute(RB0, half, -1, rolls), involute(RB0, half, 1, rolls)[::-1]
    tip = math.atan2(left[0][1], left[0][0])
    angles = tip * (2 * np.arange(1, 16) / 16 - 1)
    arc = TIP0 * np.column_stack([np.cos(angles), np.sin(angles)])
    root = RB0 - 2.0
    ends = [root * np.array([math.cos(half), side * math.sin(half)]) for side in (-1, 1)]
    return np.vstack([ends[0], right, arc, left, ends[1]])


def turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def clip(chords):
    tooth = cutter_tooth(chords)
    circle = np.linspace(0, 2 * math.pi, 30 * Z, endpoint=False)
    gear = shapely.Polygon(TIP * np.column_stack([np.cos(circle), np.sin(circle)]))
    distance = R + R0
    started = time.perf_counter()
    for stroke in range(STROKES):
        work = 2 * math.pi * stroke / STROKES
        center = distance * np.array([math.cos(work), math.sin(work)])
        # A cutter tooth points at the gear's axis when the work angle is a whole space.
        spin = work + math.pi + work * Z / Z0
        teeth = []
        for blade in range(Z0):
            angle = (spin + 2 * math.pi * blade / Z0) % (2 * math.pi)
            points = turned(tooth, angle) + center
            if np.min(np.hypot(points[:, 0], points[:, 1])) < TIP:
                teeth.append(shapely.Polygon(points))
        for one in teeth:
            gear = gear.difference(one)
    return gear, time.perf_counter() - started


def deviations_um(gear):
    """Distances along the involute's normals between the outline and the involute, all flanks."""
    shapely.prepare(gear)
    outline = gear.exterior if gear.geom_type == "Polygon" else max(gear.geoms, key=lambda g: g.area).exterior
    half = math.pi / (2 * Z) + INV
    # From the form point, where the sharp tip corner of the cutter meets the line of action, to the tip.
    form_roll = (R + R0) * math.sin(ALPHA) / RB - math.sqrt((TIP0 / RB) ** 2 - (RB0 / RB) ** 2)
    tip_roll = math.sqrt((TIP / RB) ** 2 - 1)
    arc = np.linspace(form_roll**2, tip_roll**2, 242)[12:-12]
    rolls = np.sqrt(arc)
    found = []
    for tooth in range(Z):
        middle = math.pi * (2 * tooth + 1) / Z
        for side in (-1, 1):
            points = involute(RB, half, side, rolls)
            angle = side * (half - rolls)
            normal = side * np.column_stack([-np.sin(angle), np.cos(angle)])
            points, normal = turned(points, middle), turned(normal, middle)
            rays = shapely.linestrings(np.stack([points - 0.02 * normal, points + 0.02 * normal], axis=1))
            hits = shapely.intersection(rays, outline)
            for hit, point, n in zip(hits, points, normal):
                if not hit.is_empty:
                    found.append(1e3 * float(np.dot(np.array(hit.centroid.coords[0]) - point, n)))
    return np.array(found)


if __name__ == "__main__":
    print(f"shapely {shapely.__version__}, GEOS {shapely.geos_version_string}")
    for chords in (20, 40, 80):
        runs = [clip(chords) for _ in range(3)]
        gear, _ = runs[0]
        d = deviations_um(gear)
        fastest = min(run[1] for run in runs)
        rms = np.sqrt(np.mean(d * d))
        print(f"{chords} chords per flank: {fastest:.2f} s, {len(d)} rays, {rms:.3f} um rms off the involute")
