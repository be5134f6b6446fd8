/* SPDX-License-Identifier: MIT */
/*
 * Draco blocks, each encoded by one thread. The largest come first, so that no thread is left alone with one of them at
 * the end; and of those that take much memory only so many are encoded at once as there is room for.
 */
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "base/memory.h"
#include "base/parallel.h"

/* ---- one ---- */

/* How many faces edgebreaker would drop: two corners at one position, as Draco gets them. A block that is decoded has
 * those that its quantization made: the first encoder saw them with an area, a second one does not. */
static size_t count_degenerate_faces(const nt_gltf_recoding *r)
{
	size_t count = 0;
	const nt_draco_attribute *positions = NULL;
	for (size_t i = 0; !positions && i < r->attribute_count; i++)
		positions = r->attributes[i].kind == NT_DRACO_POSITION ? &r->attributes[i] : NULL;
	const uint32_t *indices = r->vertices->users[0].numbers;
	if (!positions)
		return 0;
	const size_t width = nt_component_size(positions->component_type) * (size_t)positions->components;
	const size_t stride = positions->stride_bytes ? positions->stride_bytes : width;
	const char *elements = positions->data;
	for (size_t c = 0; c + 2 < r->mesh->corner_count; c += 3) {
		const char *points[3];
		for (size_t k = 0; k < 3; k++)
			points[k] = elements + stride * nt_vertex_source(r->vertices, indices[c + k]);
		count += memcmp(points[0], points[1], width) == 0 || memcmp(points[1], points[2], width) == 0 ||
			memcmp(points[2], points[0], width) == 0;
	}
	return count;
}

/* Whether faces of which two corners are at one position may go: they draw nothing, unless joints move the corners
 * apart. Only those of a block, whose own grid made them, since other files may mean them. */
static bool may_drop_faces(const nt_gltf_recoding *r)
{
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	return r->extension && r->options->draco == NT_DRACO_KEEP && !nt_json_find(attributes, "JOINTS_0");
}

/* Draco's own default. With edgebreaker, a torus of 245 000 triangles takes at level 4 0.85 of the bytes in 1.07 of the
 * time, level 8 twice the bytes in 0.69; with many seams level 6 makes up to a quarter more. */
enum { DRACO_SPEED = 5 };

/* The mesh, to be encoded by the method that is asked for or that the source has. */
static nt_draco_mesh mesh_of(const nt_gltf_recoding *r)
{
	return (nt_draco_mesh){
		.method = r->options->draco == NT_DRACO_AS_SEQUENTIAL ? NT_DRACO_SEQUENTIAL
			: r->options->draco == NT_DRACO_AS_EDGEBREAKER ? NT_DRACO_EDGEBREAKER : r->source->method,
		.point_count = r->vertices->new_count,
		.face_count = r->mesh->corner_count / 3,
		.indices = r->vertices->users[0].numbers,
		.attributes = r->attributes,
		.attribute_count = r->attribute_count,
		.speed = DRACO_SPEED,
	};
}

/* Whether edgebreaker cannot be taken; notes why. */
static bool needs_sequential(nt_gltf_recoding *r)
{
	r->faces_without_area = r->outside ? 0 : count_degenerate_faces(r);
	r->sequential_instead = r->outside || (r->faces_without_area > 0 && !may_drop_faces(r));
	return r->sequential_instead;
}

/* Whether elements outside of the block still fit the points in it. */
static bool order_is_kept(const nt_gltf_recoding *r)
{
	if (r->block.point_count != r->vertices->new_count || !r->block.sources)
		return false;
	for (size_t i = 0; i < r->block.point_count; i++)
		if (r->block.sources[i] != i)
			return false;
	return true;
}

/* Edgebreaker does not give every mesh back; the other method has nothing to lose. */
static nt_status encode(nt_gltf_recoding *r, nt_error *error)
{
	nt_draco_mesh mesh = mesh_of(r);
	if (mesh.method == NT_DRACO_EDGEBREAKER && needs_sequential(r))
		mesh.method = NT_DRACO_SEQUENTIAL;
	nt_status status = nt_draco_encode(&mesh, &r->block, error);
	if (status && !nt_gltf_is_beside_mesh(status) && mesh.method != NT_DRACO_SEQUENTIAL) {
		mesh.method = NT_DRACO_SEQUENTIAL;
		status = nt_draco_encode(&mesh, &r->block, error);
		r->sequential_instead = !status;
	}
	return status;
}

nt_status nt_gltf_draco_encode(nt_gltf_recoding *r, nt_error *error)
{
	nt_error failure;
	const nt_status status = encode(r, &failure);
	if (nt_gltf_is_beside_mesh(status)) {
		*error = failure;
		return status;
	}
	r->encoded = true;
	if (status || (r->outside && !order_is_kept(r))) {
		r->obstacle = status ? "Draco does not give it back"
				     : "no face uses some of its vertices, whose order matters";
		nt_draco_block_free(&r->block);
	}
	free(r->block.sources);
	r->block.sources = NULL;
	return NT_OK;
}

/* ---- several ---- */

static uint64_t need_of(const nt_gltf_recoding *r)
{
	const nt_draco_mesh mesh = mesh_of(r);
	return nt_draco_encoding_bytes(&mesh);
}

static int compare_needs(const void *a, const void *b)
{
	const uint64_t x = need_of(*(nt_gltf_recoding *const *)a), y = need_of(*(nt_gltf_recoding *const *)b);
	return (x < y) - (x > y);
}

static void encode_item(void *context, size_t item, unsigned thread)
{
	nt_gltf_recoding *const *list = context;
	nt_error ignored;
	(void)thread;
	nt_gltf_draco_encode(list[item], &ignored);
}

void nt_gltf_draco_encode_all(nt_gltf_recoding **list, size_t count, unsigned threads)
{
	if (!count)
		return;
	qsort(list, count, sizeof *list, compare_needs);
	/* half, as several inputs have by default */
	const uint64_t room = count > 1 && threads > 1 ? nt_memory_available() / 2 : 0;
	for (size_t first = 0, end; first < count; first = end) {
		const uint64_t most = need_of(list[first]), fitting = most ? room / most : threads;
		const unsigned at_once = fitting < 1 ? 1 : fitting < threads ? (unsigned)fitting : threads;
		/* those that are half as large may be more */
		for (end = first + 1; end < count && (at_once == threads || need_of(list[end]) > most / 2);)
			end++;
		nt_parallel_items(at_once, end - first, encode_item, list + first);
	}
}
