/* SPDX-License-Identifier: MIT */
/*
 * A second look at glTF output before it takes its name: another parser takes it, and what the reader finds in
 * every corner is the position and tangent that were to be written; of blocks that Draco encoded, all attributes.
 */
#ifndef NT_GLTF_VERIFY_VERIFY_H
#define NT_GLTF_VERIFY_VERIFY_H

#include "base/text.h"
#include "file/output.h"
#include "gltf/document.h"
#include "scene/format.h"
#include "scene/scene.h"

/*
 * Reads back the glTF or GLB `path` of an output set that is complete but not committed, and compares it
 * with the scene it was written from, morph targets included; what Draco or a filter of meshoptimizer changes
 * within that, and faces of a block in any order if the method is edgebreaker. An output that is written
 * through cannot be read back: nothing is done then. options: those that it was written with; of its threads several
 * compare meshes, with the same result. If tinygltf refuses an output, the scene gets the finding NOT_VERIFIED, and
 * our reader alone compares.
 *
 * Returns NT_OK; NT_ERROR_INTERNAL where the output is not what it should be, which says mesh and
 * corner, or attribute, or what our reader refuses; NT_ERROR_IO, NT_ERROR_MEMORY; NT_ERROR_UNSUPPORTED for what
 * tinygltf cannot take (4 GB and more).
 */
nt_status nt_verify_gltf(nt_scene *scene, nt_output *output, const char *path, const nt_write_options *options,
	nt_error *error);

/*
 * blocks.c. Compares the block of a primitive that was read back, and is loaded, with what was to be encoded of a mesh
 * of the source. *bad receives the name of an attribute that differs, or what else does; NULL: nothing.
 *
 * Returns NT_OK, also where something differs; NT_ERROR_MEMORY or what keeps Draco from quantizing.
 */
nt_status nt_verify_block(nt_gltf *source, const nt_mesh *mesh, const nt_write_options *options, const nt_gltf *found,
	const nt_json_value *primitive, nt_arena *arena, const char **bad, nt_error *error);

#endif
