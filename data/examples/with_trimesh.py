# SPDX-License-Identifier: MIT
"""Tangents for a mesh that trimesh has loaded: nmtan-engines(7).

    python3 with_trimesh.py in.glb
"""
import sys

import nmtan
import trimesh


# begin
def add_tangents(mesh):
    """The mesh with copies of the vertices that need several tangents, and the attribute "tangent"."""
    old_uv, old_normals = mesh.visual.uv, mesh.vertex_normals
    result = nmtan.vertex_tangents(mesh.vertices, old_normals, old_uv, mesh.faces)
    grown = trimesh.Trimesh(result.apply(mesh.vertices), result.faces, vertex_normals=result.apply(old_normals),
                            visual=mesh.visual.copy(uv=result.apply(old_uv)), process=False)
    grown.vertex_attributes["tangent"] = result.tangents
    return grown
# end


if __name__ == "__main__":
    made = add_tangents(trimesh.load(sys.argv[1], process=False, force="mesh"))
    for row in made.vertex_attributes["tangent"]:
        print("%g %g %g %g" % tuple(row))
    print(*made.faces.ravel())
