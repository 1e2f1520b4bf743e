"""Opens STEP files of `gearcut export` with OpenCASCADE: a valid solid, its volume, target points on its faces;
flanks of bevel gears as faces."""

import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
import numpy as np
from drawings import check, flattened
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.GProp import GProp_GProps
from OCP.gp import gp_Pnt
from OCP.IFSelect import IFSelect_RetDone
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

HELICAL = ["gear.teeth=15", "gear.face_width_mm=6"]
# Name, scene, settings, teeth whose flanks have points, points on each, face width in mm; all along the tooth the
# section has the same area.
CASES = [
    ("round", "scenes/shaping/circular_m3_z24.toml", [], "1..4", "15x3", 20.0),
    ("elliptical", "scenes/shaping/elliptical_normal.toml", [], "1..7", "15x3", 30.0),
    ("ring", "scenes/shaping/internal_circle.toml", [], "1..4", "15x3", 16.0),
    ("helical", "scenes/hobbing/circular_helical.toml", HELICAL, "1..4", "15x5", 6.0),
]
# Helical gears as cut: name, scene, settings, tolerance in um, above the marks of flanks.
CUT = [
    ("shaped_as_cut", "scenes/shaping/helical.toml", ["gear.teeth=13", "gear.face_width_mm=4"], 2.0),
    ("hobbed_as_cut", "scenes/hobbing/circular_helical.toml", HELICAL, 5.0),
]
# Bevel gears: name, scene, teeth.
BEVELS = [("formate", "scenes/bevel/formate.toml", 41), ("hypoid", "scenes/bevel/hypoid.toml", 62)]
TOLERANCE_MM = 1e-3


def parts(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def volume_mm3(shape):
    properties = GProp_GProps()
    # By Gauss and Kronrod: plain Gauss points are too few for B-splines of many spans, by 1e-4.
    BRepGProp.VolumePropertiesGK_s(shape, properties, 1e-6, False, False, False, False, False)
    return properties.Mass()


def off_mm(shape, points, tolerance_mm=TOLERANCE_MM):
    """Largest distance of points from the faces, each looked for on the faces whose boxes hold it."""
    boxes, surfaces = [], []
    for face in parts(shape, TopAbs_FACE):
        face = TopoDS.Face(face)
        box = Bnd_Box()
        BRepBndLib.Add_s(face, box)
        boxes.append([part for p in (box.CornerMin(), box.CornerMax()) for part in (p.X(), p.Y(), p.Z())])
        surfaces.append(BRep_Tool.Surface_s(face))
    quick = [ShapeAnalysis_Surface(surface) for surface in surfaces]
    boxes = np.array(boxes)
    worst = 0.0
    for point in points:
        beside = 0.01
        holds = ((boxes[:, :3] - beside < point) & (point < boxes[:, 3:] + beside)).all(axis=1)
        nearest = np.inf
        for i in np.flatnonzero(holds):
            # A foot near by; where that is too far, all feet.
            quick[i].ValueOfUV(gp_Pnt(*point), 1e-7)
            nearest = min(nearest, quick[i].Gap())
        if nearest > tolerance_mm:
            feet = [GeomAPI_ProjectPointOnSurf(gp_Pnt(*point), surfaces[i]) for i in np.flatnonzero(holds)]
            nearest = min([foot.LowerDistance() for foot in feet if foot.NbPoints()], default=np.inf)
        worst = max(worst, nearest)
    return worst


def section_mm2(path, layer="TARGET"):
    """Area of the section between profile and bore or rim, from a drawing."""
    space = ezdxf.readfile(path).modelspace()
    x, y = flattened(space.query(f'LWPOLYLINE[layer=="{layer}"]')[0], 1.0, 100).T
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    for circle in space.query("CIRCLE"):
        if circle.dxf.layer in ("BORE", "RIM"):
            area -= np.pi * circle.dxf.radius**2
    return abs(area)


def one(program, folder, name, scene, settings, teeth, grid, face_mm):
    path = folder / f"{name}.step"
    sets = [word for setting in settings for word in ("--set", setting)]
    run = lambda *more: subprocess.run(
        [program, "export", scene, *sets, "--quiet", "--force", *more], check=True, capture_output=True, text=True
    ).stdout
    said = run("--step", path, "--tolerance-um", str(1000 * TOLERANCE_MM))
    drawing = folder / f"{name}_fine.dxf"
    run("--dxf", drawing, "--tolerance-um", "0.1")
    table = folder / f"{name}_points.csv"
    run("--points", table, "--teeth", teeth, "--grid", grid)
    shape = read(name, path)
    check(f"{name}: one solid", len(list(parts(shape, TopAbs_SOLID))) == 1)
    faces = len(list(parts(shape, TopAbs_FACE)))
    check(f"{name}: faces", f"{faces} faces" in said, f"{faces}, {path.stat().st_size // 1000} kB")
    expected = section_mm2(drawing) * face_mm
    off = abs(volume_mm3(shape) / expected - 1)
    check(f"{name}: volume", off < 1e-5, f"{expected:.3f} mm3, off by {off:.1e}")
    on_faces(name, shape, table)
    return shape


def as_cut(program, folder, name, scene, settings, tolerance_um):
    path, drawing, table = (folder / f"{name}{end}" for end in (".step", ".dxf", "_points.csv"))
    sets = [word for setting in settings for word in ("--set", setting)]
    run = lambda *more: subprocess.run(
        [program, "export", scene, *sets, "--as-cut", "--quiet", "--force", *more],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    run("--step", path, "--tolerance-um", str(tolerance_um))
    run("--points", table, "--teeth", "1..3", "--grid", "40x17")
    shape = read(name, path)
    check(f"{name}: one solid", len(list(parts(shape, TopAbs_SOLID))) == 1)
    face_mm = float(settings[-1].split("=")[1])
    # Sections as they are cut, mark by mark, over the face.
    expected = 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(6)):
        run("--dxf", drawing, "--tolerance-um", "0.1", "--section-mm", f"{0.5 * face_mm * place:.9f}")
        expected += 0.5 * face_mm * weight * section_mm2(drawing, "AS_CUT")
    off = abs(volume_mm3(shape) / expected - 1)
    check(f"{name}: volume", off < 1e-5, f"{expected:.3f} mm3, off by {off:.1e}")
    on_faces(name, shape, table, 1e-3 * tolerance_um, "cut")
    return shape


def bevel(program, folder, name, scene, teeth):
    path, table = folder / f"{name}.step", folder / f"{name}_points.csv"
    command = [program, "export", scene, "--quiet", "--force"]
    subprocess.run([*command, "--step", path], check=True, capture_output=True)
    subprocess.run([*command, "--points", table, "--grid", "9x6"], check=True, capture_output=True)
    shape = read(name, path)
    shells, faces = (len(list(parts(shape, kind))) for kind in (TopAbs_SHELL, TopAbs_FACE))
    size = f"{path.stat().st_size // 1000} kB"
    check(f"{name}: a face for each flank", [shells, faces] == [2 * teeth] * 2, f"{faces}, {size}")
    on_faces(name, shape, table)
    return shape


def read(name, path):
    reader = STEPControl_Reader()
    check(f"{name}: is read", reader.ReadFile(str(path)) == IFSelect_RetDone)
    reader.TransferRoots()
    shape = reader.OneShape()
    check(f"{name}: valid", BRepCheck_Analyzer(shape).IsValid())
    return shape


def on_faces(name, shape, table, tolerance_mm=TOLERANCE_MM, kind="target"):
    rows = list(csv.DictReader(table.open()))
    points = np.array([[float(row[column]) for column in ("x_mm", "y_mm", "z_mm")] for row in rows])
    off = off_mm(shape, points, tolerance_mm)
    check(f"{name}: {len(points)} {kind} points on faces", off <= tolerance_mm, f"{1000 * off:.3f} um at most")
    # A fault of two tolerances is seen.
    normals = np.array([[float(row[column]) for column in ("nx", "ny", "nz")] for row in rows[:20]])
    check(f"{name}: points beside are not", off_mm(shape, points[:20] + 2 * tolerance_mm * normals) > tolerance_mm)


def drawn(shape, path):
    """A picture of the solid, its faces shaded by their normals."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    BRepMesh_IncrementalMesh(shape, 0.05, False, 0.3, True)
    triangles = []
    for face in parts(shape, TopAbs_FACE):
        mesh = BRep_Tool.Triangulation_s(TopoDS.Face(face), TopLoc_Location())
        nodes = np.array([[p.X(), p.Y(), p.Z()] for p in (mesh.Node(i + 1) for i in range(mesh.NbNodes()))])
        corners = [mesh.Triangle(i + 1).Get() for i in range(mesh.NbTriangles())]
        triangles.append(nodes[np.array(corners) - 1])
    triangles = np.concatenate(triangles)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-300
    shade = 0.25 + 0.7 * np.abs(normals @ (np.array([0.3, 0.5, 0.8]) / np.sqrt(0.98)))
    figure = plt.figure(figsize=(10, 10))
    axes = figure.add_subplot(projection="3d")
    axes.add_collection3d(Poly3DCollection(triangles, facecolors=np.stack([shade] * 3 + [np.ones_like(shade)], axis=1)))
    reach = np.abs(triangles[..., :2]).max()
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
    axes.set_axis_off()
    axes.view_init(50, -60)
    figure.savefig(path, dpi=130, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for cases, opened in [(CASES, one), (CUT, as_cut), (BEVELS, bevel)]:
            for case in cases:
                shape = opened(arguments.program, folder, *case)
                if arguments.keep:
                    drawn(shape, folder / f"{case[0]}_solid.png")


if __name__ == "__main__":
    main()
