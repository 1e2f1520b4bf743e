"""Opens mesh/ of an output folder with trimesh, meshio and pygltflib, and compares what they see with each other."""

import json
import sys
from pathlib import Path

import meshio
import numpy as np
import pygltflib
import trimesh
from scipy.spatial import cKDTree

NO_PASS = 4294967295


def check(name, holds, detail=""):
    print(f"{'ok  ' if holds else 'FAIL'} {name} {detail}")
    if not holds:
        sys.exit(1)


def main(folder):
    mesh = folder / "mesh"
    scene = json.loads((folder / "run.json").read_text())["scene"]

    stl = trimesh.load(mesh / "gear.stl")
    check("STL: watertight after welding equal corners", stl.is_watertight and stl.is_winding_consistent)
    check("STL: one body", stl.body_count == 1, f"{len(stl.vertices)} vertices, {len(stl.faces)} triangles")

    ply = trimesh.load(mesh / "gear.ply", process=False)
    check("PLY: watertight as written, nothing welded", ply.is_watertight and ply.is_winding_consistent)
    check("PLY: as many triangles as the STL", len(ply.faces) == len(stl.faces))
    check("PLY: same box as the STL", np.array_equal(ply.bounds, stl.bounds), str(ply.bounds.round(4).tolist()))
    check("PLY: same volume as the STL", np.isclose(ply.volume, stl.volume, rtol=1e-6), f"{ply.volume:.3f} mm^3")
    check("PLY: positive volume", ply.volume > 0)

    blank = trimesh.load(mesh / "blank.ply", process=False)
    closed = blank.is_watertight and blank.is_winding_consistent
    check("blank.ply: watertight as written", closed, f"{len(blank.faces)} triangles")
    same = np.isclose(blank.volume, stl.volume, rtol=2e-3)
    check("blank.ply: the same volume by rays as by flanks", same, f"{blank.volume:.1f} mm^3")

    read = meshio.read(mesh / "gear.ply")
    check("meshio: same vertices", np.array_equal(read.points.astype(np.float32), ply.vertices.astype(np.float32)))
    quantities = set(read.point_data)
    wanted = {"height_um", "pass_id", "red", "green", "blue"}
    check("meshio: quantities by vertex", wanted <= quantities, str(sorted(quantities)))
    passes = read.point_data["pass_id"]
    cut = passes != NO_PASS
    heights = read.point_data["height_um"]
    reached = f"{cut.sum()} of {len(cut)} vertices cut"
    check("meshio: a height wherever a pass came", np.isfinite(heights[cut]).all(), reached)
    check("meshio: no height where none came", np.isnan(heights[~cut]).all())
    if "stock_mm" in quantities:
        stock = read.point_data["stock_mm"][cut]
        positive = (stock[np.isfinite(stock)] > -1e-6).all()
        check("meshio: stock is not negative", positive, f"largest {np.nanmax(stock):.4f} mm")

    gltf = pygltflib.GLTF2().load(str(mesh / "gear.glb"))
    buffer = gltf.binary_blob()
    names = [node.name for node in gltf.nodes]
    flanks = sorted(name for name in names if name.startswith("tooth_"))
    check("glTF: a node per flank", len(flanks) % 2 == 0 and len(flanks) == len(set(flanks)), f"{len(flanks)} flanks")
    corners = sum(gltf.accessors[p.indices].count for m in gltf.meshes for p in m.primitives)
    check("glTF: as many triangles as the STL", corners == 3 * len(stl.faces))
    check("glTF: the scene is inside", gltf.asset.extras["scene"] == scene)
    extras = gltf.asset.extras
    told = extras["buffer_unit"] == "mm" and "gear frame" in extras["frame"]
    check("glTF: units, frame and colours are told", told)

    def values(index):
        accessor = gltf.accessors[index]
        view = gltf.bufferViews[accessor.bufferView]
        kind = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}[accessor.componentType]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor.type]
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        size = np.dtype(kind).itemsize
        stride = view.byteStride or width * size
        check_quietly(start % size == 0 and stride % size == 0, "aligned", index)
        return np.ndarray((accessor.count, width), kind, buffer, start, (stride, size))

    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    with_heights = 0
    whole = "KHR_mesh_quantization"
    check("glTF: places of 16 bits are told", gltf.extensionsRequired == [whole] == gltf.extensionsUsed)
    nodes = {node.mesh: node for node in gltf.nodes if node.mesh is not None}
    nearest_vertex = cKDTree(read.points)
    worst_steps = 0.0
    for number, part in enumerate(gltf.meshes):
        attributes = part.primitives[0].attributes
        steps = values(attributes.POSITION)
        accessor = gltf.accessors[attributes.POSITION]
        inside = np.array_equal(steps.min(0), accessor.min) and np.array_equal(steps.max(0), accessor.max)
        check_quietly(inside, part.name, "box")
        step = nodes[number].scale[0]
        places = np.array(nodes[number].translation) + step * steps.astype(float)
        off, vertex = nearest_vertex.query(places)
        # Half a step along each axis, and what f32 rounds off in the PLY.
        worst_steps = max(worst_steps, ((off - 1e-5) / step).max())
        lengths = np.linalg.norm(values(attributes.NORMAL).astype(float), axis=1)
        check_quietly(np.allclose(lengths, 1, atol=1e-5), part.name, "unit normals")
        check_quietly((values(part.primitives[0].indices) < len(places)).all(), part.name, "indices")
        check_quietly(np.isfinite(places).all(), part.name, "finite")
        if part.name.startswith("tooth_"):
            # glTF knows no missing values: a flank with a corner that no pass reached goes without heights.
            expected = heights[vertex].astype(np.float32)
            told = getattr(attributes, "_HEIGHT_UM", None)
            check_quietly((told is not None) == np.isfinite(expected).all(), part.name, "heights where all are known")
            if told is not None:
                check_quietly(np.array_equal(values(told)[:, 0], expected), part.name, "the heights of the PLY")
                with_heights += 1
        low, high = np.minimum(low, places.min(0)), np.maximum(high, places.max(0))
    check("glTF: vertices of the PLY within half a step", worst_steps < 0.87, f"{worst_steps:.3f} steps at most")
    check("glTF: same box as the STL", np.allclose([low, high], stl.bounds, atol=2e-3))
    counted = f"{len(gltf.meshes)} parts, {with_heights} with heights"
    check("glTF: boxes, normals, indices and heights of all parts", with_heights > 0, counted)

    seen = trimesh.load(mesh / "gear.glb")
    check("trimesh opens the glTF", len(seen.geometry) == len(gltf.meshes))
    size = seen.bounds[1] - seen.bounds[0]
    width = stl.bounds[1] - stl.bounds[0]
    upright = [width[0], width[2], width[1]]
    check("glTF: metres, y up", np.allclose(size * 1000, upright, rtol=1e-4), f"{size.round(5).tolist()} m")

    # Rows of a flank and of the body stand at other places along the tooth: sections are compared, end faces left out.
    sides = np.abs(ply.face_normals[:, 2]) < 0.5
    body, body_normals = cKDTree(ply.triangles_center[sides, :2]), ply.face_normals[sides]
    files = sorted((mesh / "flanks").glob("*.ply"))
    check("a PLY per flank", [f.stem for f in files] == flanks)
    for file in files:
        flank = trimesh.load(file, process=False)
        # Its triangles lie beside those of the closed body, whose quads may be split the other way, and look the same
        # way.
        distance, nearest = body.query(flank.triangles_center[:, :2])
        same = (flank.face_normals * body_normals[nearest]).sum(1)[distance < 0.1]
        check_quietly(len(same) > 0 and np.quantile(same, 0.02) > 0.9, file.name, "faces outwards")
    check("flanks open and face outwards", True, f"{len(files)} files")


def check_quietly(holds, *where):
    if not holds:
        check(" ".join(where), False)


main(Path(sys.argv[1]))
