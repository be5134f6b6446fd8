/* SPDX-License-Identifier: MIT */
/*
 * Opening a glTF, and the geometry of its primitives, compressed or not, for the table of formats and the stages.
 */
#ifndef NT_GLTF_LOAD_H
#define NT_GLTF_LOAD_H

#include "base/memory.h"
#include "base/text.h"
#include "ext/draco.h"
#include "gltf/document.h"
#include "scene/scene.h"

/* Describes the meshes of scene->bytes. */
nt_status nt_gltf_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* Describes what the materials of a primitive ask for, those of variants and levels of detail included: slots, texture
 * coordinates, their transform. Returns NT_OK, NT_ERROR_INPUT or NT_ERROR_MEMORY. */
nt_status nt_gltf_describe_materials(nt_scene *scene, nt_mesh *mesh, const nt_json_value *primitive,
	const char *pointer, const nt_read_options *options, nt_error *error);

/* Brings the geometry of a mesh of an opened glTF. */
nt_status nt_gltf_load(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
	nt_error *error);

/* ---- what morph targets add: load_targets.c ---- */

/* Finds the targets that move a mesh: their tangents differ from the base's. normals: its accessor; NULL: none. */
nt_status nt_gltf_load_targets(nt_scene *scene, nt_mesh *mesh, const nt_gltf_accessor *normals, nt_error *error);

/* Copies the normals of a mesh, which are written to: shared arrays are not. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_own_normals(nt_scene *scene, nt_mesh *mesh, nt_error *error);

/* Gives a vector the length 1, if it has any. */
void nt_gltf_normalise(float *n);

/* A mesh as a morph target moves it: both are malloc'ed, [vertex_count][3], NULL as the base has them. Nothing changes,
 * so that threads may ask at once. Returns NT_OK or NT_ERROR_MEMORY; to be freed in either case. */
nt_status nt_gltf_move(const nt_mesh *mesh, const nt_morph *morph, float **positions, float **normals);

/* The normals of all vertices of the pool of a mesh that has some, as a load has them; not to be written to. New data
 * is in the arena. */
nt_status nt_gltf_load_normals(nt_gltf *document, const nt_mesh *mesh, nt_arena *arena, float **normals,
	nt_error *error);

/*
 * For the table of formats: opens and decodes what loads of these meshes take. A mesh is `ready` then, or its load will
 * find a fault: loads of ready ones only read the document, each for a scene with an arena of its own.
 *
 *   needed  [mesh_count] meshes that will be loaded; several threads decode their compressed blocks here
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_gltf_prepare(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);

/* ---- values as a decoder of Draco will have them: draco_values.c ---- */

/* Whether Draco takes these attributes of a mesh, of which only faces and the number of vertices are asked for; with
 * `whole` also whether faces use all its vertices. Returns NT_OK; what nt_draco_encode() has against it; NT_ERROR_INPUT
 * where a vertex is not used; NT_ERROR_MEMORY, NT_ERROR_MODULE or NT_ERROR_IO. */
nt_status nt_gltf_draco_takes(const nt_mesh *mesh, const nt_draco_attribute *attributes, size_t count, bool whole,
	nt_error *error);

/* The plain floats of a mesh with ->quantized become what a decoder will have of them: nt_gltf_draco_takes() it. After
 * faces are loaded, before texture transforms are applied. One with a block that cannot be made again, since something
 * beside it counts vertices that no face uses, loses ->quantized. positions, normals, texcoords: accessors,
 * NULL of what the mesh does not have. */
nt_status nt_gltf_quantize_vertices(nt_scene *scene, nt_mesh *mesh, const nt_gltf_accessor *positions,
	const nt_gltf_accessor *normals, const nt_gltf_accessor *texcoords, const nt_read_options *options,
	nt_error *error);

/* Normals that were made for meshes with ->quantized: tangents will be solved for what a decoder has of them. */
nt_status nt_gltf_quantize_made_normals(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* ---- KHR_draco_mesh_compression, compressed primitives of a document: draco.c ---- */

/* Decoded blocks are kept: several primitives may share one, and it may be encoded again. */

/* A primitive's KHR_draco_mesh_compression; NULL: none. */
nt_json_value *nt_gltf_draco_of(const nt_json_value *primitive);

/* Decodes a primitive's KHR_draco_mesh_compression, where it has one: from then on its accessors have
 * their elements. */
nt_status nt_gltf_decode_draco(nt_gltf *document, const nt_json_value *primitive,
	const char *pointer, nt_error *error);

/* Decodes the blocks of several meshes on several threads. needed: [mesh_count]. A block that
 * fails is left for nt_gltf_decode_draco(), which has it alone and says what is wrong. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_gltf_decode_ahead(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);

/* Quantization of what was not quantized before, as the options have it, or the default. */
int nt_gltf_draco_bits(const int *draco_bits, nt_draco_bits which);

/* Draco's kind of an attribute of that name, and the bits of its floats: 0 for what must come back as it was. */
nt_draco_kind nt_gltf_draco_kind(const char *name);
int nt_gltf_draco_bits_of(const int *draco_bits, const char *name);

/* How an accessor is quantized that was not: on the document's grid for it, or on its own with these bits. */
nt_draco_quantization nt_gltf_draco_grid(const nt_gltf *document, uint32_t accessor, int bits);

/* How a primitive's block has its tangents; NULL: it has none, or is not loaded. */
const nt_draco_quantization *nt_gltf_draco_tangents_of(const nt_gltf *document, const nt_json_value *primitive);

/* The grid of tangents that are encoded: the one that they have where it decodes to -1 and 1 exactly, as w has to be,
 * else one of our own. source: NULL: they have none. */
nt_draco_quantization nt_gltf_draco_tangent_grid(const nt_draco_quantization *source, const int *draco_bits);

/* Whether it is not the mesh that keeps Draco from quantizing or encoding it. */
static inline bool nt_gltf_is_beside_mesh(nt_status status)
{
	return status == NT_ERROR_MEMORY || status == NT_ERROR_MODULE || status == NT_ERROR_IO;
}

/* The block of a view; NULL: not decoded. */
const nt_draco_mesh *nt_gltf_draco_block(const nt_gltf *document, uint64_t view);

/* Gives each content an accessor of its own. Loading finds malformed parts. Returns NT_OK,
 * NT_ERROR_INPUT (nt_gltf_check_dangling()) or NT_ERROR_MEMORY. */
nt_status nt_gltf_separate_draco(nt_gltf *document, nt_error *error);

#endif
