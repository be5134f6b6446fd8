/* SPDX-License-Identifier: MIT */
/*
 * nmtan_split(), and what it has in common with nmtan_vertex_tangents(): see inside.h.
 */
#include "api/inside.h"

#include <string.h>
#include "base/structs.h"
#include "topology/corners.h"
#include "topology/split.h"

bool nt_split_read(nt_split_places *places, const nmtan_mesh *mesh, const nmtan_split_output *output)
{
	nmtan_split_output *given = &places->given;
	if (!nt_struct_read(given, sizeof *given, output) ||
		!nt_fill_stride(&given->vertex_tangent_stride_bytes, NT_TANGENT_BYTES, mesh->vertex_count))
		return false;
	given->source_count = given->split_count = 0;
	if (nt_makes_vertices(mesh) && (!given->indices || given->copy_counts))
		return false;
	return given->indices ? given->sources || given->source_capacity == 0
			      : !given->sources && !given->source_capacity;
}

nmtan_status nt_split_begin(nt_split_places *places, const nmtan_mesh *plain, size_t corner_count,
	const uint32_t *corners, nt_scratch *scratch)
{
	const nmtan_split_output *given = &places->given;
	nmtan_split_output *own = &places->own;
	*own = *given;
	places->corners = corners;
	places->made = corners ? plain->vertex_count : 0;
	own->source_capacity -= places->made < given->source_capacity ? places->made : given->source_capacity;
	own->sources += given->source_capacity - own->source_capacity;
	if (!given->vertex_tangents || (!corners && given->vertex_tangent_stride_bytes == NT_TANGENT_BYTES))
		return NMTAN_OK;
	const size_t copies = own->source_capacity < corner_count ? own->source_capacity : corner_count;
	own->vertex_tangents = nt_scratch_alloc(scratch, plain->vertex_count + copies, NT_TANGENT_BYTES);
	return own->vertex_tangents ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

nmtan_status nt_split_end(nt_split_places *places, const nmtan_mesh *plain)
{
	nmtan_split_output *given = &places->given;
	const nmtan_split_output *own = &places->own;
	const size_t made = places->made;
	given->source_count = made + own->source_count;
	given->split_count = own->split_count;
	if (given->indices && given->source_count > given->source_capacity)
		return NMTAN_ERROR_CAPACITY;
	for (size_t i = 0; made && i < own->source_count; i++)
		given->sources[made + i] = places->corners[own->sources[i]];
	if (made)
		memcpy(given->sources, places->corners, made * sizeof *given->sources);
	if (given->vertex_tangents)
		nt_put_tangents(given->vertex_tangents, given->vertex_tangent_stride_bytes, own->vertex_tangents,
			plain->vertex_count + (given->indices ? own->source_count : 0));
	return NMTAN_OK;
}

void nt_put_tangents(float *to, size_t stride_bytes, const float *from, size_t count)
{
	for (size_t i = 0; to != from && i < count; i++)
		memcpy((char *)to + stride_bytes * i, from + 4 * i, NT_TANGENT_BYTES);
}

static nmtan_status split_mesh(nt_splitter *s, const float *tangents)
{
	nmtan_status status = NMTAN_OK;
	for (size_t c = 0; !status && c < s->corner_count; c++)
		status = nt_splitter_take(s, (uint32_t)nt_vertex_of(s->mesh, c), tangents + 4 * c, c);
	if (!status)
		nt_splitter_end(s);
	return status;
}

/* A mesh of whatever version: of its attributes only normals are looked at, which vertices without corners need. */
static bool read_mesh(nmtan_mesh *mesh, const nmtan_mesh *given)
{
	if (!nt_struct_read(mesh, sizeof *mesh, given))
		return false;
	mesh->positions = mesh->texcoords = NULL;
	return nt_fill_stride(&mesh->normal_stride_bytes, 3 * sizeof(float),
		nt_row_count(mesh, mesh->normal_count, mesh->normal_indices));
}

nmtan_status nmtan_split(const nmtan_mesh *mesh, const float *tangents, const nmtan_options *options,
	nmtan_split_output *output)
{
	nmtan_mesh plain;
	nmtan_options how = NMTAN_OPTIONS_INIT;
	nt_split_places places;
	if (!mesh || !tangents || !output || !read_mesh(&plain, mesh) || !nt_split_read(&places, &plain, output) ||
		(options && !nt_struct_read(&how, sizeof how, options)) ||
		(!plain.normals && places.given.vertex_tangents))
		return NMTAN_ERROR_ARGUMENT;
	size_t corner_count;
	nmtan_status status = nt_check_faces(&plain, &corner_count);
	if (status)
		return status;

	nt_scratch own;
	nt_scratch_init(&own, how.allocator);
	nt_scratch *scratch = how.workspace ? &how.workspace->scratch : &own;
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const uint32_t *corners;
	nt_splitter s;
	status = nt_make_plain(&plain, corner_count, scratch, &corners);
	if (!status)
		status = nt_split_begin(&places, &plain, corner_count, corners, scratch);
	if (!status)
		status = nt_splitter_begin(&s, &plain, corner_count, &places.own, scratch);
	if (!status)
		status = split_mesh(&s, tangents);
	if (!status)
		status = nt_split_end(&places, &plain);
	nt_scratch_back(scratch, mark);
	nt_scratch_free(&own);
	nt_struct_write(output, &places.given, sizeof places.given);
	return status;
}
