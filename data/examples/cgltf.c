/* SPDX-License-Identifier: MIT */
/*
 * Tangents for a primitive that cgltf has read: nmtan-engines(7). With cgltf.h in this folder:
 *
 *     cc cgltf.c $(pkg-config --cflags --libs nmtan) -lm && ./a.out in.glb
 */
#define CGLTF_IMPLEMENTATION
#include "cgltf.h"
#include <nmtan.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct vertex {
	float pos[3], normal[3], uv[2], tangent[4];
} vertex;

typedef struct geometry {
	vertex *vertices;
	uint32_t *indices, *given, *sources;
	size_t vertex_count, corner_count;
} geometry;

/* begin */
static nmtan_status import(const cgltf_primitive *p, geometry *g)
{
	const size_t vertices = p->attributes[0].data->count, corners = p->indices->count, row = sizeof(vertex);
	vertex *v = calloc(vertices + corners, row); /* a copy for every corner is the most */
	*g = (geometry){v, malloc(4 * corners), malloc(4 * corners), malloc(4 * corners), vertices, corners};
	if (!v || !g->indices || !g->given || !g->sources)
		return NMTAN_ERROR_MEMORY;
	for (size_t i = 0; i < vertices; i++) {
		cgltf_accessor_read_float(cgltf_find_accessor(p, cgltf_attribute_type_position, 0), i, v[i].pos, 3);
		cgltf_accessor_read_float(cgltf_find_accessor(p, cgltf_attribute_type_normal, 0), i, v[i].normal, 3);
		cgltf_accessor_read_float(cgltf_find_accessor(p, cgltf_attribute_type_texcoord, 0), i, v[i].uv, 2);
	}
	cgltf_accessor_unpack_indices(p->indices, g->given, 4, corners);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = corners / 3, .vertex_count = vertices,
		.v_down = 1, .indices = g->given, .positions = v->pos, .normals = v->normal, .texcoords = v->uv,
		.position_stride_bytes = row, .normal_stride_bytes = row, .texcoord_stride_bytes = row};
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = g->indices, .sources = g->sources,
		.source_capacity = corners, .vertex_tangents = v->tangent, .vertex_tangent_stride_bytes = row};
	const nmtan_status status = nmtan_vertex_tangents(&mesh, NULL, &split, NULL);
	for (size_t i = 0; status == NMTAN_OK && i < split.source_count; i++)
		memcpy(&v[g->vertex_count++], &v[g->sources[i]], offsetof(vertex, tangent));
	return status;
}
/* end */

int main(int count, char **arguments)
{
	const cgltf_options options = {0};
	cgltf_data *data = NULL;
	if (count != 2 || cgltf_parse_file(&options, arguments[1], &data) != cgltf_result_success ||
		cgltf_load_buffers(&options, data, arguments[1]) != cgltf_result_success)
		return 2;
	geometry g;
	const nmtan_status status = import(&data->meshes[0].primitives[0], &g);
	for (size_t i = 0; status == NMTAN_OK && i < g.vertex_count; i++)
		printf("%g %g %g %g\n", g.vertices[i].tangent[0], g.vertices[i].tangent[1], g.vertices[i].tangent[2],
			g.vertices[i].tangent[3]);
	for (size_t c = 0; status == NMTAN_OK && c < g.corner_count; c++)
		printf("%u%c", (unsigned)g.indices[c], c + 1 < g.corner_count ? ' ' : '\n');
	if (status != NMTAN_OK)
		fprintf(stderr, "%s\n", nmtan_status_text(status));
	free(g.vertices);
	free(g.indices);
	free(g.given);
	free(g.sources);
	cgltf_free(data);
	return status != NMTAN_OK;
}
