/* SPDX-License-Identifier: MIT */
/*
 * The stage that makes normals: corner normals come from tangent/normals.c; here they become vertices. A
 * vertex splits where its corners' normals differ: the same splitting as for tangents, with the normal in
 * the place of the tangent.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "tangent/normals.h"

/* Made normals less apart than this are one: rounding of positions makes some ten millionths of well-shaped triangles
 * in one plane, and the coarsest normals that glTF can quantize to in 16 bits are 3e-5 apart. */
static const double CLOSE_RADIANS = 1e-5;

/* Data of one run of the stage; everything is malloc'ed and handed to the arena at the end. */
typedef struct normal_job {
	float (*rows)[4];     /* [corner_count] normals as rows that nmtan_split compares */
	uint32_t *indices;    /* [corner_count] */
	uint32_t *sources;    /* [corner_count] */
	float *normals;       /* [new vertex count][3] */
} normal_job;

static void free_job(normal_job *job)
{
	free(job->rows);
	free(job->indices);
	free(job->sources);
	free(job->normals);
}

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
	if (replaces(mode) || !mesh->normals)
		return true;
	for (size_t v = 0; mesh->vertex_lacks && v < mesh->vertex_count; v++)
		if (lacks_normal(mesh, v))
			return true;
	return false;
}

/* A grown copy of a vertex array in the arena, copies appended; NULL when memory is exhausted. */
static float *grow_rows(nt_arena *arena, const float *rows, size_t floats, size_t count,
	const uint32_t *sources, size_t source_count)
{
	float *grown = nt_arena_alloc(arena, count + source_count, floats * sizeof *grown);
	if (!grown)
		return NULL;
	memcpy(grown, rows, count * floats * sizeof *grown);
	for (size_t i = 0; i < source_count; i++)
		memcpy(grown + (count + i) * floats, rows + (size_t)sources[i] * floats,
			floats * sizeof *grown);
	return grown;
}

static bool grow_mesh(nt_arena *arena, nt_mesh *mesh, const uint32_t *sources, size_t source_count)
{
	float **const arrays[] = {&mesh->positions, &mesh->texcoords, &mesh->colors,
		&mesh->solve_texcoords};
	static const size_t floats[] = {3, 2, 4, 2};
	for (int i = 0; i < 4 && source_count > 0; i++) {
		if (!*arrays[i])
			continue;
		*arrays[i] = grow_rows(arena, *arrays[i], floats[i], mesh->vertex_count, sources,
			source_count);
		if (!*arrays[i])
			return false;
	}
	return true;
}

static nt_status make_corner_normals(const nt_mesh *mesh, nt_normals mode, int degrees, normal_job *job)
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
			mode == NT_NORMALS_AUTO ? mesh->face_smoothing : flat, groups, &scratch, job->rows);
	nt_scratch_free(&scratch);
	return nt_status_of(made);
}

/* Corners keep the normal their vertex has, where it has one and that is not to be replaced. */
static void choose_normals(nt_mesh *mesh, nt_normals mode, normal_job *job)
{
	mesh->made_normal_corners = mesh->replaced_normal_corners = mesh->cancelled_normal_corners = 0;
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const size_t vertex = nt_mesh_vertex(mesh, c);
		const bool lacks = lacks_normal(mesh, vertex), make = lacks || replaces(mode);
		if (!make)
			memcpy(job->rows[c], mesh->normals + 3 * vertex, 3 * sizeof(float));
		mesh->made_normal_corners += lacks;
		mesh->replaced_normal_corners += make && !lacks;
		mesh->cancelled_normal_corners += make && job->rows[c][3] != 0.0f;
		job->rows[c][3] = 0.0f;
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
static nt_status join_close(const nt_mesh *mesh, normal_job *job)
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
			i < MOST_COMPARED && other != NT_NONE && !are_close(job->rows[c], job->rows[other]); i++)
			other = i + 1 < MOST_COMPARED ? before[other] : NT_NONE;
		if (other != NT_NONE) {
			memcpy(job->rows[c], job->rows[other], sizeof job->rows[c]);
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

static nt_status split_by_normal(nt_scene *scene, nt_mesh *mesh, normal_job *job)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = job->indices,
		.sources = job->sources,
		.source_capacity = mesh->corner_count};
	const nt_status status = nt_status_of(nmtan_split(&view, &job->rows[0][0], NULL, &split));
	if (status)
		return status;
	const size_t vertex_count = mesh->vertex_count + split.source_count;
	job->normals = nt_calloc(vertex_count, 3 * sizeof(float));
	if (!job->normals || !grow_mesh(nt_mesh_arena(scene, mesh), mesh, job->sources, split.source_count))
		return NT_ERROR_MEMORY;
	for (size_t v = 0; v < vertex_count; v++)
		job->normals[3 * v + 2] = 1.0f; /* for vertices that no face uses */
	for (size_t c = 0; c < mesh->corner_count; c++)
		memcpy(job->normals + 3 * (size_t)job->indices[c], job->rows[c], 3 * sizeof(float));
	mesh->vertex_count = vertex_count;
	return NT_OK;
}

static void report_normals(nt_scene *scene, const nt_mesh *mesh, nt_normals mode)
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

/* Vertices and their copies without texture coordinates stay known. */
static bool keep_lacks(nt_scene *scene, nt_mesh *mesh, const uint32_t *sources)
{
	const uint8_t *before = mesh->vertex_lacks;
	bool any = false;
	for (size_t v = 0; before && v < mesh->source_vertex_count; v++)
		any |= before[v] & NT_LACKS_TEXCOORD;
	mesh->vertex_lacks = any ? nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->vertex_count, 1) : NULL;
	for (size_t v = 0; mesh->vertex_lacks && v < mesh->vertex_count; v++)
		mesh->vertex_lacks[v] = NT_LACKS_TEXCOORD &
			before[v < mesh->source_vertex_count ? v : sources[v - mesh->source_vertex_count]];
	return !any || mesh->vertex_lacks;
}

/* The new arrays become the mesh's. */
static nt_status adopt(nt_scene *scene, nt_mesh *mesh, nt_normals mode, normal_job *job)
{
	mesh->indices = job->indices;
	mesh->vertex_sources = job->sources;
	mesh->normals = job->normals;
	mesh->stored_normals = NULL;
	const bool lacks_kept = keep_lacks(scene, mesh, job->sources);
	mesh->tangents = NULL; /* authored for other normals */
	mesh->normals_made = true;
	mesh->has_normals = true;
	uint32_t *indices = job->indices, *sources = job->sources;
	float *normals = job->normals;
	job->indices = job->sources = NULL;
	job->normals = NULL;
	report_normals(scene, mesh, mode);
	/* each, whatever became of the others: the arena frees what it cannot keep */
	bool kept = nt_arena_adopt(nt_mesh_arena(scene, mesh), indices);
	kept &= nt_arena_adopt(nt_mesh_arena(scene, mesh), sources);
	kept &= nt_arena_adopt(nt_mesh_arena(scene, mesh), normals);
	return kept && lacks_kept ? NT_OK : NT_ERROR_MEMORY;
}

static nt_status make_lacking(nt_scene *scene, nt_mesh *mesh, nt_normals mode, int degrees)
{
	if (!any_made(mesh, mode) || mesh->corner_count == 0)
		return NT_OK;
	normal_job job = {
		.rows = nt_alloc(mesh->corner_count, sizeof *job.rows),
		.indices = nt_alloc(mesh->corner_count, sizeof *job.indices),
		.sources = nt_alloc(mesh->corner_count, sizeof *job.sources),
	};
	nt_status status = NT_ERROR_MEMORY;
	if (job.rows && job.indices && job.sources)
		status = make_corner_normals(mesh, mode, degrees, &job);
	if (!status) {
		choose_normals(mesh, mode, &job);
		status = join_close(mesh, &job);
		if (!status)
			status = split_by_normal(scene, mesh, &job);
		if (!status)
			status = adopt(scene, mesh, mode, &job);
	}
	free_job(&job);
	return status;
}

static nt_status make_normals(nt_scene *scene, nt_mesh *mesh, nt_normals mode, int degrees, unsigned threads,
	nt_error *error)
{
	/* a glTF keeps the normals that it has, unless others are asked for */
	const bool keeps = nt_format_is_gltf(scene->format);
	nt_status status = keeps ? NT_OK : nt_mark_directionless(scene, mesh, threads);
	if (!status)
		status = make_lacking(scene, mesh, mode, degrees);
	if (!status)
		status = nt_make_unit_normals(scene, mesh, threads);
	return status ? nt_fail(error, status, "cannot make normals: %s", nt_status_text(status)) : NT_OK;
}

/* Copies in joins have their own normals, whatever the others get. */
static nt_status make_normals_of_copies(nt_scene *scene, unsigned threads, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->join_count; i++)
		for (size_t k = 0; !status && k < scene->joins[i].part_count; k++) {
			nt_mesh *mesh = scene->joins[i].parts[k];
			if (!nt_mesh_is_wanted(mesh) && mesh->positions)
				status = make_normals(scene, mesh, NT_NORMALS_AUTO, 0, threads, error);
		}
	return status;
}

/* Whether a mesh that gets no tangents gets the normals that the user asks for: a scan without texture coordinates.
 * Primitives of a glTF have a decision of their own for that. */
static bool is_shaded_only(const nt_scene *scene, const nt_mesh *mesh, nt_normals mode)
{
	return mode != NT_NORMALS_AUTO && !nt_format_is_gltf(scene->format) && mesh->positions &&
	       !nt_mesh_is_wanted(mesh);
}

nt_status nt_stage_normals(nt_scene *scene, nt_normals mode, int degrees, unsigned threads, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (is_shaded_only(scene, mesh, mode)) {
			status = make_normals(scene, mesh, mode, degrees, threads, error);
			continue;
		}
		if (!nt_mesh_is_wanted(mesh) || (!mesh->plan.same_as && nt_mesh_is_solved_ahead(mesh)))
			continue;
		if (!mesh->plan.same_as) {
			status = make_normals(scene, mesh, mode, degrees, threads, error);
			continue;
		}
		nt_mesh_share(mesh);
		if (mesh->normals_made)
			report_normals(scene, mesh, mode);
	}
	return status ? status : make_normals_of_copies(scene, threads, error);
}
