# SPDX-License-Identifier: MIT
"""blender -b --python blender_quads.py -- FOLDER: meshes of quads as Blender's exporter writes them, with its tangents.

One .glb each: Suzanne subdivided 0, 1 and 2 times, a torus, a sphere and a cone whose base is a fan; and `ngon`, a cone
whose base has 32 corners, for which the exporter makes no tangents. `parts`, Suzanne of two materials by halves, and
`mixed`, of three by faces: Blender solves them whole and the exporter writes primitives.
"""

import os
import sys

import bpy

folder, = sys.argv[sys.argv.index("--") + 1:]


def export(name, make, levels=0, smooth=True, materials=1, choose=lambda i, face: 0):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    make()
    thing = bpy.context.object
    if levels:
        thing.modifiers.new("subdivision", "SUBSURF").levels = levels
        bpy.ops.object.modifier_apply(modifier="subdivision")
    if smooth:
        bpy.ops.object.shade_smooth()
    for i in range(materials):
        material = bpy.data.materials.new(f"m{i}")
        material.use_nodes = True
        tree = material.node_tree
        texture, normal = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
        texture.image = bpy.data.images.new("n", 4, 4)
        tree.links.new(texture.outputs[0], normal.inputs[1])
        tree.links.new(normal.outputs[0], tree.nodes["Principled BSDF"].inputs["Normal"])
        thing.data.materials.append(material)
    for i, face in enumerate(thing.data.polygons):
        face.material_index = choose(i, face)
    bpy.ops.export_scene.gltf(filepath=os.path.join(folder, name + ".glb"), export_format="GLB", export_tangents=True)


for levels in range(3):
    export(f"suzanne{levels}", bpy.ops.mesh.primitive_monkey_add, levels)
export("torus", bpy.ops.mesh.primitive_torus_add)
export("sphere", bpy.ops.mesh.primitive_uv_sphere_add)
export("cone", lambda: bpy.ops.mesh.primitive_cone_add(end_fill_type="TRIFAN"), smooth=False)
export("ngon", bpy.ops.mesh.primitive_cone_add, smooth=False)
export("parts", bpy.ops.mesh.primitive_monkey_add, materials=2, choose=lambda i, face: int(face.center[0] > 0.1))
export("mixed", bpy.ops.mesh.primitive_monkey_add, 1, materials=3, choose=lambda i, face: i * 7919 // 13 % 3)
