# SPDX-License-Identifier: MIT
"""blender -b --factory-startup --python blender.py -- KIT OUT: each KIT/*.obj, exported as GLB with tangents."""
import glob
import os
import sys

import bpy

kit, out = sys.argv[sys.argv.index("--") + 1:]
for path in sorted(glob.glob(os.path.join(kit, "*.obj"))):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z")
    name = os.path.splitext(os.path.basename(path))[0]
    bpy.ops.export_scene.gltf(filepath=os.path.join(out, name + ".glb"), export_tangents=True, export_yup=False)
