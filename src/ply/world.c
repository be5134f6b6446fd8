/* SPDX-License-Identifier: MIT */
/*
 * The meshes of a scene as one mesh in the world. PLY has no nodes, so every instance is written with its matrix
 * applied: positions by the matrix, normals by its inverse transpose, tangents by its upper 3x3 and made perpendicular
 * to the normal again. If the determinant is negative, faces are wound the other way round and w changes its sign, so
 * that the bitangent stays the image of the bitangent. Instances with the identity keep their bits.
 *
 * v points up in PLY: the scene has it so, but what came from glTF is -v there and becomes 1 - v.
 */
#include "ply/parts.h"

#include "base/vec.h"
#include "scene/values.h"

static bool is_written(const nt_mesh *mesh)
{
	return mesh->triangles && mesh->positions && mesh->face_count > 0;
}

size_t ply_world_vertices(const nt_mesh *mesh)
{
	return is_written(mesh) ? mesh->vertex_count + mesh->split.source_count : 0;
}

/* Alpha as a byte divided by 255; -1: it is none. */
static int alpha_byte(float alpha)
{
	const float scaled = alpha * 255.0f;
	return scaled >= 0.0f && scaled <= 255.5f && rintf(scaled) / 255.0f == alpha ? (int)rintf(scaled) : -1;
}

ply_placement ply_find_placement(const nt_instance *instance)
{
	static const double identity[16] = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0};
	const double *m = instance->matrix;
	ply_placement p = {.identity = memcmp(m, identity, sizeof identity) == 0};
	for (size_t i = 0; i < 4; i++)
		p.columns[i] = (nt_dvec3){m[4 * i], m[4 * i + 1], m[4 * i + 2]};
	for (size_t i = 0; i < 3; i++)
		p.cofactors[i] = nt_dvec3_cross(p.columns[(i + 1) % 3], p.columns[(i + 2) % 3]);
	p.mirrored = nt_dvec3_dot(p.columns[0], p.cofactors[0]) < 0.0;
	for (size_t i = 0; p.mirrored && i < 3; i++)
		p.cofactors[i] = nt_dvec3_scale(-1.0, p.cofactors[i]);
	return p;
}

/* Whether a node puts a mesh where float would move vertices by more than a hundredth of an edge: such nodes are what a
 * file with an origin has. */
static bool is_far(const ply_placement *p, const nt_mesh *mesh)
{
	if (p->identity)
		return false;
	double lengths[NT_ORIGIN_TRIED], largest = 0;
	const double scale = cbrt(fabs(nt_dvec3_dot(p->columns[0], p->cofactors[0])));
	const size_t count = ply_sample_edges(mesh, NULL, NT_ORIGIN_TRIED, lengths);
	for (size_t i = 0; i < count; i++)
		lengths[i] *= scale;
	for (size_t i = 0; i < 4; i++)
		largest += fmax(fabs(p->columns[i].x), fmax(fabs(p->columns[i].y), fabs(p->columns[i].z))) *
			(i < 3 ? (double)nt_largest_of(mesh->positions, 3 * mesh->vertex_count, 0) : 1);
	return nt_origin_is_suspected((float)fmin(largest, FLT_MAX), lengths, count, 1);
}

void ply_find_world(ply_world *l, const nt_scene *scene, bool bitangents)
{
	*l = (ply_world){.byte_colors = true, .doubles = nt_scene_has_origin(scene),
		.flips_v = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB};
	nt_srgb_init(&l->srgb);
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		if (!is_written(mesh))
			continue;
		l->normals |= mesh->normals != NULL;
		l->texcoords |= mesh->texcoords != NULL;
		l->tangents |= mesh->split.vertex_tangents || mesh->tangents;
		l->colors |= mesh->colors != NULL;
		const ply_placement p = ply_find_placement(&scene->instances[i]);
		l->doubles |= is_far(&p, mesh);
		/* whether all of them come from sRGB bytes */
		for (size_t k = 0; mesh->colors && k < 4 * mesh->vertex_count && l->byte_colors; k++)
			l->byte_colors = (k % 4 == 3 ? alpha_byte(mesh->colors[k])
				: nt_srgb_byte(&l->srgb, mesh->colors[k])) >= 0;
		l->vertex_count += ply_world_vertices(mesh);
		l->face_count += mesh->face_count;
	}
	l->bitangents = bitangents && l->tangents && l->normals;
}

static nt_dvec3 combine(const nt_dvec3 *columns, const float *v)
{
	return nt_dvec3_add(nt_dvec3_add(nt_dvec3_scale(v[0], columns[0]), nt_dvec3_scale(v[1], columns[1])),
		nt_dvec3_scale(v[2], columns[2]));
}

/* Positions as the source has them, if the scene holds these beside what is relative to its origin. */
static nt_dvec3 place_position(const ply_placement *p, const nt_mesh *mesh, size_t vertex)
{
	if (mesh->exact_positions) {
		const size_t source = vertex < mesh->source_vertex_count ? vertex
			: mesh->vertex_sources[vertex - mesh->source_vertex_count];
		const double *place = mesh->exact_positions + 3 * source;
		return (nt_dvec3){place[0], place[1], place[2]};
	}
	const float *place = mesh->positions + 3 * vertex;
	return p->identity ? nt_dvec3_load(place) : nt_dvec3_add(combine(p->columns, place), p->columns[3]);
}

/* A matrix that flattens leaves some normals without a direction: they stay what they are. */
static void place_normal(const ply_placement *p, const float *from, float *to)
{
	nt_dvec3 n = combine(p->cofactors, from);
	if (p->identity || !nt_dvec3_normalise(&n))
		memcpy(to, from, 3 * sizeof *to);
	else
		nt_dvec3_store(n, to);
}

/* n: the normal as written, NULL: none. */
static void place_tangent(const ply_placement *p, const float *n, const float *from, float *to)
{
	memcpy(to, from, 4 * sizeof *to);
	if (p->identity)
		return;
	nt_dvec3 t = combine(p->columns, from);
	if (n)
		t = nt_dvec3_reject(nt_dvec3_load(n), t);
	if (!nt_dvec3_normalise(&t) && n)
		t = nt_dvec3_perpendicular(nt_dvec3_load(n));
	nt_dvec3_store(t, to);
	to[3] = p->mirrored ? -from[3] : from[3];
}

static bool are_finite(const float *values, size_t count)
{
	while (count > 0 && isfinite(values[count - 1]))
		count--;
	return count == 0;
}

/* glTF may hold, or make of what it holds, numbers that no reader of PLY takes, this one included. */
static nt_status fail_not_finite(const nt_mesh *mesh, const char *what, size_t vertex, bool placed, nt_error *error)
{
	nt_fail(error, NT_ERROR_INPUT, "the %s of vertex %zu is not finite%s, expected finite numbers for PLY",
		what, vertex, placed ? " where the node places it" : "");
	nt_mesh_place(mesh, &error->place);
	return NT_ERROR_INPUT;
}

/* An attribute that only other meshes have is zero, a colour white. */
nt_status ply_world_vertex(const ply_world *l, const ply_placement *p, const nt_mesh *mesh, size_t vertex,
	double values[PLY_VALUES], nt_error *error)
{
	const size_t v = vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
	const nt_dvec3 place = place_position(p, mesh, v);
	float position[3], normal[3] = {0}, uv[2] = {0}, tangent[4] = {0}, bitangent[3];
	nt_dvec3_store(place, position);
	if (!are_finite(position, 3))
		return fail_not_finite(mesh, "position", v, are_finite(mesh->positions + 3 * v, 3), error);
	/* the normals that tangents are made for */
	if (mesh->normals)
		place_normal(p, (mesh->solve_normals ? mesh->solve_normals : mesh->normals) + 3 * v, normal);
	if (!are_finite(normal, 3))
		return fail_not_finite(mesh, "normal", v, false, error);
	if (mesh->colors && !are_finite(mesh->colors + 4 * v, 4))
		return fail_not_finite(mesh, "colour", v, false, error);
	for (size_t i = 0; i < 4 && l->colors; i++) {
		const float c = mesh->colors ? mesh->colors[4 * v + i] : 1.0f;
		if (l->byte_colors)
			values[PLY_RED + i] = (i == 3 ? alpha_byte(c) : nt_srgb_byte(&l->srgb, c)) / 255.0;
		else
			values[PLY_RED + i] = i == 3 ? c : nt_srgb_from_linear(c);
	}
	if (mesh->texcoords) {
		uv[0] = mesh->texcoords[2 * v];
		uv[1] = l->flips_v ? 1.0f + mesh->texcoords[2 * v + 1] : mesh->texcoords[2 * v + 1];
	}
	if (!are_finite(uv, 2))
		return fail_not_finite(mesh, "texture coordinate", v, false, error);
	const float *own = mesh->split.vertex_tangents ? mesh->split.vertex_tangents + 4 * vertex
		: mesh->tangents ? mesh->tangents + 4 * v : NULL;
	if (own)
		place_tangent(p, mesh->normals ? normal : NULL, own, tangent);
	nt_bitangent(normal, tangent, bitangent);
	values[PLY_X] = place.x;
	values[PLY_X + 1] = place.y;
	values[PLY_X + 2] = place.z;
	for (size_t i = 0; i < 4; i++) {
		if (i < 3) {
			values[PLY_NX + i] = normal[i];
			values[PLY_BX + i] = bitangent[i];
		}
		if (i < 2)
			values[PLY_S + i] = uv[i];
		values[PLY_TX + i] = tangent[i];
	}
	return NT_OK;
}
