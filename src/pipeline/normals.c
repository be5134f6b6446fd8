/* SPDX-License-Identifier: MIT */
/*
 * Normals: tangent/normals.c makes them for corners, here they become those of vertices. A vertex splits where its
 * corners' normals differ: the same splitting as for tangents, with the normal in the place of the tangent.
 *
 * The one normal of a vertex is what is written, made unit, and tangents have to lie across that. Most meshes have
 * nothing but normals of unit length and are only looked at. A length is 1 if |n|^2 is within 2^-11 of it: such normals
 * are used as they are, so that rounding them again changes no tangent. Others are made unit, here and in the same way
 * for every format. The normals that are solved are those that are written; but a glTF that is made from a glTF keeps
 * what it has, and so does a PLY whose normals are integers. One without a direction counts as lacking if the output
 * gets new normals; in a glTF it stays, and tangents are made for the smooth normal of the faces around it.
 */
#include "pipeline/stages.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "base/vec.h"
#include "tangent/frames.h"

/* Made normals less apart than this are one: rounding of positions makes some ten millionths of well-shaped triangles
 * in one plane, and the coarsest normals that glTF can quantize to in 16 bits are 3e-5 apart. */
static const double CLOSE_RADIANS = 1e-5;

/* Corner normals of a mesh, as rows that nmtan_split compares; the fourth number says that smooth ones cancel. mode:
 * how they are made; groups and smoothing go by it. */
static nt_status make_corner_normals(const nt_mesh *mesh, nt_normals mode, int degrees, float (*rows)[4])
{
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(mesh, &stored);
	view.position_stride_bytes = 3 * sizeof(float);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	uint32_t *flat = NULL, *groups = NULL;
	nmtan_status made = NMTAN_OK;
	if (mode == NT_NORMALS_FLAT || mode == NT_NORMALS_REPLACE_FLAT) {
		flat = nt_scratch_alloc(&scratch, mesh->face_count, sizeof *flat);
		if (flat)
			memset(flat, 0, mesh->face_count * sizeof *flat);
		made = flat ? NMTAN_OK : NMTAN_ERROR_MEMORY;
	} else if (mode == NT_NORMALS_ANGLE || mode == NT_NORMALS_REPLACE_ANGLE) {
		groups = nt_scratch_alloc(&scratch, mesh->corner_count, sizeof *groups);
		made = groups ? nt_crease_groups(&view, mesh->corner_count, degrees, &scratch, groups)
			      : NMTAN_ERROR_MEMORY;
	}
	if (!made)
		made = nt_corner_normals(&view, mesh->corner_count,
			mode == NT_NORMALS_AUTO ? mesh->face_smoothing : flat, groups, &scratch, rows);
	nt_scratch_free(&scratch);
	return nt_status_of(made);
}

/* ---- normals that are there ---- */

typedef struct looking {
	const float *normals;
	atomic_bool odd;
} looking;

static void look_at_range(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	looking *l = context;
	size_t odd = 0;
	for (size_t v = begin; v < end; v++)
		odd += !nt_is_unit_normal(l->normals + 3 * v);
	if (odd)
		atomic_store(&l->odd, true);
}

/* Whether a mesh has normals that are not of unit length. */
static bool has_odd(const nt_mesh *mesh, unsigned threads)
{
	enum { GRAIN = 1 << 16 };
	looking l = {.normals = mesh->normals};
	const size_t count = mesh->normals ? mesh->vertex_count : 0;
	nt_parallel_ranges(count < 2 * GRAIN ? 1 : nt_thread_count(threads), count, GRAIN, look_at_range, &l);
	return l.odd;
}

static bool has_direction(const float *n)
{
	nt_dvec3 d = nt_dvec3_load(n);
	return nt_dvec3_normalise(&d);
}

/* Vertices whose normal has no direction lack it. */
static nt_status mark_directionless(nt_scene *scene, nt_mesh *mesh, unsigned threads)
{
	if (!has_odd(mesh, threads))
		return NT_OK;
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		if (has_direction(mesh->normals + 3 * v))
			continue;
		if (!mesh->vertex_lacks) {
			mesh->vertex_lacks = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 1);
			if (!mesh->vertex_lacks)
				return NT_ERROR_MEMORY;
			memset(mesh->vertex_lacks, 0, mesh->vertex_count);
		}
		mesh->vertex_lacks[v] |= NT_LACKS_NORMAL;
	}
	return NT_OK;
}

/* Vertices without a direction take the smooth normal of their first corner. */
static nt_status replace_directionless(nt_mesh *mesh, float *normals)
{
	float (*corners)[4] = nt_alloc(mesh->corner_count, sizeof *corners);
	const nt_status status = corners ? make_corner_normals(mesh, NT_NORMALS_SMOOTH, 0, corners) : NT_ERROR_MEMORY;
	for (size_t c = 0; !status && c < mesh->corner_count; c++) {
		float *n = normals + 3 * nt_mesh_vertex(mesh, c);
		if (has_direction(n))
			continue;
		memcpy(n, corners[c], 3 * sizeof *n);
		mesh->replaced_normals++;
	}
	free(corners);
	return status;
}

/* In solve_normals of a glTF, which keeps those that it has. */
static nt_status make_unit(nt_scene *scene, nt_mesh *mesh, unsigned threads)
{
	if (!has_odd(mesh, threads))
		return NT_OK;
	float *normals = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 3 * sizeof *normals);
	if (!normals)
		return NT_ERROR_MEMORY;
	memcpy(normals, mesh->normals, mesh->vertex_count * 3 * sizeof *normals);
	size_t directionless = 0;
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		float *n = normals + 3 * v;
		nt_dvec3 d = nt_dvec3_load(n);
		if (nt_is_unit_normal(n))
			continue;
		if (!nt_dvec3_normalise(&d)) {
			directionless++;
			continue;
		}
		nt_dvec3_store(d, n);
		mesh->scaled_normals++;
	}
	*(nt_format_is_gltf(scene->format) ? &mesh->solve_normals : &mesh->normals) = normals;
	return directionless ? replace_directionless(mesh, normals) : NT_OK;
}

/* ---- normals that are made ---- */

static bool replaces(nt_normals mode)
{
	return mode >= NT_NORMALS_REPLACE_FLAT;
}

static bool lacks_normal(const nt_mesh *mesh, size_t vertex)
{
	return !mesh->normals || (mesh->vertex_lacks && mesh->vertex_lacks[vertex] & NT_LACKS_NORMAL);
}

/* Whether there is anything to be made. */
static bool any_made(const nt_mesh *mesh, nt_normals mode)
{
	bool any = replaces(mode) || !mesh->normals;
	for (size_t v = 0; !any && mesh->vertex_lacks && v < mesh->vertex_count; v++)
		any = lacks_normal(mesh, v);
	return any && mesh->corner_count;
}

/* Corners keep the normal their vertex has, where it has one and that is not to be replaced. */
static void choose_normals(nt_mesh *mesh, nt_normals mode, float (*rows)[4])
{
	mesh->made_normal_corners = mesh->replaced_normal_corners = mesh->cancelled_normal_corners = 0;
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const size_t vertex = nt_mesh_vertex(mesh, c);
		const bool lacks = lacks_normal(mesh, vertex), make = lacks || replaces(mode);
		if (!make)
			memcpy(rows[c], mesh->normals + 3 * vertex, 3 * sizeof(float));
		mesh->made_normal_corners += lacks;
		mesh->replaced_normal_corners += make && !lacks;
		mesh->cancelled_normal_corners += make && rows[c][3] != 0.0f;
		rows[c][3] = 0.0f;
	}
}

static bool are_close(const float a[3], const float b[3])
{
	double square = 0;
	for (int k = 0; k < 3; k++)
		square += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
	return square <= CLOSE_RADIANS * CLOSE_RADIANS;
}

/* A corner takes the normal of an earlier corner of its vertex that differs by no more than rounding: two triangles
 * of a plane do not make two vertices. The last few different ones are looked at, so that a hub stays cheap. */
static nt_status join_close(const nt_mesh *mesh, float (*rows)[4])
{
	enum { MOST_COMPARED = 8 };
	uint32_t *last = nt_alloc(mesh->vertex_count, sizeof *last);   /* corner with the latest normal of a vertex */
	uint32_t *before = nt_alloc(mesh->corner_count, sizeof *before); /* the one with another normal before it */
	if (last && before)
		memset(last, 0xff, mesh->vertex_count * sizeof *last);
	for (size_t c = 0; last && before && c < mesh->corner_count; c++) {
		const size_t vertex = nt_mesh_vertex(mesh, c);
		uint32_t other = last[vertex];
		for (int i = 0;
			i < MOST_COMPARED && other != NT_NONE && !are_close(rows[c], rows[other]); i++)
			other = i + 1 < MOST_COMPARED ? before[other] : NT_NONE;
		if (other != NT_NONE) {
			memcpy(rows[c], rows[other], sizeof rows[c]);
			continue;
		}
		before[c] = last[vertex];
		last[vertex] = (uint32_t)c;
	}
	const bool done = last && before;
	free(last);
	free(before);
	return done ? NT_OK : NT_ERROR_MEMORY;
}

/* Appends copies of `floats` numbers for each source to a vertex array, if it is there. False: memory is exhausted. */
static bool grow_rows(nt_arena *arena, float **rows, size_t floats, size_t count, const uint32_t *sources,
	size_t source_count)
{
	const float *before = *rows;
	if (!before || !source_count)
		return true;
	*rows = nt_arena_alloc(arena, count + source_count, floats * sizeof **rows);
	if (!*rows)
		return false;
	memcpy(*rows, before, count * floats * sizeof **rows);
	for (size_t i = 0; i < source_count; i++)
		memcpy(*rows + (count + i) * floats, before + sources[i] * floats, floats * sizeof **rows);
	return true;
}

/* The vertices that rows make, indices and sources of a mesh. Vertices and their copies without texture coordinates
 * stay known. */
static nt_status make_vertices(nt_arena *arena, nt_mesh *mesh, float (*rows)[4], uint32_t *indices, uint32_t *sources)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
		.source_capacity = mesh->corner_count};
	const nt_status status = nt_status_of(nmtan_split(&view, rows[0], NULL, &split));
	if (status)
		return status;
	const size_t before = mesh->vertex_count, added = split.source_count, count = before + added;
	const uint8_t *lacks = mesh->vertex_lacks;
	bool any = false;
	for (size_t v = 0; lacks && v < before; v++)
		any |= lacks[v] & NT_LACKS_TEXCOORD;
	uint8_t *kept = any ? nt_arena_alloc(arena, count, 1) : NULL;
	float *normals = nt_arena_alloc(arena, count, 3 * sizeof *normals);
	if (!normals || (any && !kept) || !grow_rows(arena, &mesh->positions, 3, before, sources, added) ||
		!grow_rows(arena, &mesh->texcoords, 2, before, sources, added) ||
		!grow_rows(arena, &mesh->colors, 4, before, sources, added) ||
		!grow_rows(arena, &mesh->solve_texcoords, 2, before, sources, added))
		return NT_ERROR_MEMORY;
	for (size_t v = 0; v < count; v++) {
		memcpy(normals + 3 * v, (float[]){0, 0, 1}, 3 * sizeof *normals); /* for those that no face uses */
		if (kept)
			kept[v] = lacks[v < before ? v : sources[v - before]] & NT_LACKS_TEXCOORD;
	}
	for (size_t c = 0; c < mesh->corner_count; c++)
		memcpy(normals + 3 * (size_t)indices[c], rows[c], 3 * sizeof *normals);
	mesh->vertex_lacks = kept;
	mesh->vertex_count = count;
	mesh->vertex_sources = sources;
	mesh->indices = indices;
	mesh->normals = normals;
	mesh->stored_normals = NULL;
	mesh->tangents = NULL; /* authored for other normals */
	mesh->normals_made = mesh->has_normals = true;
	return NT_OK;
}

static nt_status make_lacking(nt_scene *scene, nt_mesh *mesh, nt_normals mode, int degrees)
{
	nt_arena *arena = nt_mesh_arena(scene, mesh);
	if (!any_made(mesh, mode))
		return NT_OK;
	float (*rows)[4] = nt_alloc(mesh->corner_count, sizeof *rows);
	uint32_t *indices = nt_alloc(mesh->corner_count, sizeof *indices);
	uint32_t *sources = nt_alloc(mesh->corner_count, sizeof *sources);
	nt_status status = NT_ERROR_MEMORY;
	if (rows && indices && sources)
		status = make_corner_normals(mesh, mode, degrees, rows);
	if (!status) {
		choose_normals(mesh, mode, rows);
		status = join_close(mesh, rows);
	}
	if (!status)
		status = make_vertices(arena, mesh, rows, indices, sources);
	free(rows);
	/* both, whatever became of the other: the arena frees what it cannot keep */
	bool kept = nt_arena_adopt(arena, indices);
	kept &= nt_arena_adopt(arena, sources);
	return status || kept ? status : NT_ERROR_MEMORY;
}

nt_status nt_make_normals(nt_scene *scene, nt_mesh *mesh, nt_normals mode, int degrees, unsigned threads,
	nt_error *error)
{
	/* a glTF keeps the normals that it has, unless others are asked for */
	nt_status status = nt_format_is_gltf(scene->format) ? NT_OK : mark_directionless(scene, mesh, threads);
	if (!status)
		status = make_lacking(scene, mesh, mode, degrees);
	if (!status)
		status = make_unit(scene, mesh, threads);
	return status ? nt_fail(error, status, "cannot make normals: %s", nt_status_text(status)) : NT_OK;
}

void nt_tell_normals(nt_scene *scene, const nt_mesh *mesh, nt_normals mode)
{
	/* OBJ's default is flat; exporters that write neither s nor vn mean nothing by it, and scans are smooth */
	const bool chosen = scene->format == NT_FORMAT_OBJ && mode == NT_NORMALS_AUTO && !mesh->face_smoothing;
	if (mesh->made_normal_corners)
		nt_finding_add(&scene->findings, NT_CODE_NORMALS_MADE, nt_mesh_place(mesh, &(nt_place){0}),
			mesh->made_normal_corners, "%s", chosen ? "smooth, because the file has no s" : "");
	if (mesh->replaced_normal_corners)
		nt_finding_add(&scene->findings, NT_CODE_NORMALS_REPLACED, nt_mesh_place(mesh, &(nt_place){0}),
			mesh->replaced_normal_corners, NULL);
	if (mesh->cancelled_normal_corners)
		nt_finding_add(&scene->findings, NT_CODE_NORMALS_CANCELLED, nt_mesh_place(mesh, &(nt_place){0}),
			mesh->cancelled_normal_corners, NULL);
}
