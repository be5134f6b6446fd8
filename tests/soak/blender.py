# SPDX-License-Identifier: MIT
"""blender -b --python blender.py -- MODULE FILE...: Blender's calc_tangents beside the Python module.

On Suzanne, Suzanne subdivided, and each OBJ: for every corner of every triangle the angle between the two tangents and
whether the signs are equal, and the time of both. Blender's own MikkTSpace computes in float in another order, so
angles are not 0.

Ends with 1 where a sign differs or more than a thousandth of a mesh's corners is over 0.05 degrees off: Blender's copy of
MikkTSpace groups a few corners otherwise than the reference, whose bytes are ours. Corners to which no triangle
gives a tangent (no area in texture coordinates) are counted apart: each program fills them in its own way.
"""

import sys
import time

import bpy
import numpy as np

module, *files = sys.argv[sys.argv.index("--") + 1:]
sys.path.insert(0, module)
import nmtan  # noqa: E402


def corner_array(items, name, size):
    values = np.empty(len(items) * size, np.float32)
    items.foreach_get(name, values)
    return values.reshape(-1, size)


def compare(name, mesh):
    mesh.calc_normals_split()
    start = time.perf_counter()
    mesh.calc_tangents()
    blender_seconds = time.perf_counter() - start
    theirs, signs = corner_array(mesh.loops, "tangent", 3), corner_array(mesh.loops, "bitangent_sign", 1)
    normals = corner_array(mesh.loops, "normal", 3)
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    positions = corner_array(mesh.vertices, "co", 3)[vertices]
    texcoords = corner_array(mesh.uv_layers.active.data, "uv", 2)
    start = time.perf_counter()
    ours = nmtan.tangents(positions, normals, texcoords, method="mikktspace-sorted", repair=False)
    seconds = time.perf_counter() - start
    dots = np.einsum("ij,ij->i", ours[:, :3].astype(float), theirs)
    cross = np.linalg.norm(np.cross(ours[:, :3].astype(float), theirs), axis=1)
    degrees = np.degrees(np.arctan2(cross, dots))
    triangles = texcoords.astype(float).reshape(-1, 3, 2)
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    placeholder = np.repeat(a[:, 0] * b[:, 1] == a[:, 1] * b[:, 0], 3)
    off = (degrees > 0.05) & ~placeholder
    wrong = (ours[:, 3] != signs[:, 0]) & ~placeholder
    print(f"{name}: {len(mesh.loops) // 3} triangles, worst {degrees[~placeholder].max(initial=0):.4f} degrees, {off.sum()} corners off, "
          f"{wrong.sum()} other signs, {placeholder.sum()} without a tangent; Blender {blender_seconds:.3f} s, "
          f"nmtan {seconds:.3f} s, {blender_seconds / seconds:.1f} times")
    return wrong.sum() > 0 or 1000 * off.sum() > len(off)


def triangulated(thing):
    modifier = thing.modifiers.new("triangles", "TRIANGULATE")
    modifier.keep_custom_normals = True
    return thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()


bad = 0
print(f"Blender {bpy.app.version_string}, nmtan {nmtan.version()}")
for levels in (0, 3):
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    if levels:
        monkey.modifiers.new("subdivision", "SUBSURF").levels = levels
    bad += compare(f"Suzanne, subdivided {levels} times", triangulated(monkey))
for path in files:
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.wm.obj_import(filepath=path)
    for thing in bpy.context.selected_objects:
        if thing.type == "MESH" and thing.data.uv_layers.active:
            bad += compare(path.rsplit("/", 1)[-1], triangulated(thing))
sys.exit(1 if bad else 0)
