/* SPDX-License-Identifier: MIT */
/*
 * The entry point of the compute library: checks what the caller gave, runs the method, repairs.
 *
 * Checking costs one pass over indices and face sizes, so that no later stage has to doubt them.
 */
#include "api/tangents.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#include "api/inside.h"
#include "base/cpu.h"
#include "base/deadline.h"
#include "base/parallel.h"
#include "base/structs.h"
#include "base/vec.h"
#include "tangent/fast/fast.h"
#include "tangent/frames.h"
#include "tangent/solve.h"
#include "tangent/sums/sums.h"
#include "topology/corners.h"

/* No stage shares fewer corners among threads. */
enum { LEAST_SHARED_CORNERS = 1 << 14 };

static nmtan_status check_attributes(nmtan_mesh *mesh)
{
	if (!mesh->positions || !mesh->normals || !mesh->texcoords)
		return NMTAN_ERROR_ARGUMENT;
	if (!nt_fill_stride(&mesh->position_stride_bytes, 3 * sizeof(float), mesh->vertex_count) ||
		!nt_fill_stride(&mesh->normal_stride_bytes, 3 * sizeof(float),
			nt_row_count(mesh, mesh->normal_count, mesh->normal_indices)) ||
		!nt_fill_stride(&mesh->texcoord_stride_bytes, 2 * sizeof(float),
			nt_row_count(mesh, mesh->texcoord_count, mesh->texcoord_indices)) ||
		!isfinite(nt_stored_v_offset(mesh)))
		return NMTAN_ERROR_ARGUMENT;
	return NMTAN_OK;
}

static nmtan_status check_options(const nmtan_options *options)
{
	const float degrees = options->angular_threshold_degrees;
	if ((options->jobs && !options->jobs->run) || (unsigned)options->method > NMTAN_METHOD_MIKKTSPACE_SORTED ||
		(unsigned)options->repair > NMTAN_REPAIR_OFF || !(degrees >= 0.0f && degrees <= 180.0f))
		return NMTAN_ERROR_ARGUMENT;
	return NMTAN_OK;
}

/* Spec page, step 7: float degrees to radians, double cosine, rounded once. */
static float threshold_cos(float degrees)
{
	return (float)cos((double)((degrees * (float)M_PI) / 180.0f));
}

static nmtan_status run_method(const nt_solve *solve, nmtan_method method, size_t *ill_conditioned)
{
	switch (method) {
	case NMTAN_METHOD_MIKKTSPACE:
	case NMTAN_METHOD_MIKKTSPACE_SORTED:
		return solve->one_by_one || !nt_fast_can(solve)
			? nt_mikktspace_scalar(solve) : nt_mikktspace_fast(solve);
	case NMTAN_METHOD_AREA:
		return nt_area(solve);
	case NMTAN_METHOD_LENGYEL:
		return nt_lengyel(solve);
	case NMTAN_METHOD_ROBUST:
		return nt_robust(solve, ill_conditioned);
	}
	return NMTAN_ERROR_ARGUMENT;
}

/* Scratch on the stack: allocating takes as long as solving two triangles. */
enum { SMALL_BYTES = 8192 };

/* So many corners, and without a workspace: one block for nearly all that is needed, a corner. Fresh pages are 0.4 of
 * the time of a mesh of 15 000 triangles. */
enum { ONE_BLOCK_CORNERS = 3 * 32768, ONE_BLOCK_BYTES = 22 };

/* One call: the checked input, and the scratch where the caller gave none. begin_request() sets what is needed. */
typedef struct request {
	nmtan_options options;
	nmtan_mesh mesh;        /* plain */
	const uint32_t *corners; /* what nt_make_plain() says */
	nmtan_stored_uv stored; /* of mesh */
	nt_known known;
	nt_solve solve;
	nt_scratch own;
	nt_scratch_mark mark;
	nmtan_timing timing; /* of this call */
	const nmtan_jobs *jobs_before; /* of this thread */
	bool sorted_instead;
	size_t summed_instead;
	double begin;
	char memory[SMALL_BYTES]; /* of `own`: what few triangles need */
} request;

/* Copies of what the caller gave, of whatever version; false where a size is none. */
static bool read_arguments(request *r, const nmtan_mesh *mesh, const nmtan_options *options)
{
	if (!options)
		r->options = (nmtan_options)NMTAN_OPTIONS_INIT;
	if (!nt_struct_read(&r->mesh, sizeof r->mesh, mesh) ||
		(options && !nt_struct_read(&r->options, sizeof r->options, options)) ||
		(r->options.timing && !nt_struct_read(&r->timing, sizeof r->timing, r->options.timing)))
		return false;
	if (!r->mesh.stored)
		return true;
	const bool read = nt_struct_read(&r->stored, sizeof r->stored, r->mesh.stored);
	r->mesh.stored = &r->stored;
	return read;
}

static nt_scratch *begin_own_scratch(request *r, size_t corner_count)
{
	nt_scratch_init(&r->own, r->options.allocator);
	nt_scratch_lend(&r->own, r->memory, sizeof r->memory);
	if (!r->options.allocator && corner_count < ONE_BLOCK_CORNERS)
		nt_scratch_expect(&r->own, ONE_BLOCK_BYTES * corner_count);
	return &r->own;
}

static void end_request(request *r)
{
	nt_pool_use(r->jobs_before);
	if (r->solve.threads > 1)
		nt_pool_stay(-1);
	nmtan_timing sum;
	if (r->options.timing && nt_struct_read(&sum, sizeof sum, r->options.timing)) {
		sum.weld += r->timing.weld;
		sum.split += r->timing.split;
		sum.solve += nt_seconds() - r->begin - r->timing.weld - r->timing.split;
		nt_struct_write(r->options.timing, &sum, sizeof sum);
	}
	nt_scratch_back(r->solve.scratch, r->mark);
	if (r->solve.scratch == &r->own)
		nt_scratch_free(&r->own);
}

/* Checks everything before anything is computed, and fills in what was left to defaults. */
static nmtan_status begin_request(request *r, const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_implementation *implementation)
{
	if (!read_arguments(r, mesh, options))
		return NMTAN_ERROR_ARGUMENT;
	r->timing = (nmtan_timing)NMTAN_TIMING_INIT;
	if (r->options.timing)
		r->begin = nt_seconds();
	size_t corner_count;
	nmtan_status status = check_options(&r->options);
	if (!status)
		status = check_attributes(&r->mesh);
	if (!status)
		status = nt_check_faces(&r->mesh, &corner_count);
	if (status)
		return status;
	nt_scratch *scratch = r->options.workspace
		? &r->options.workspace->scratch : begin_own_scratch(r, corner_count);
	r->known = (nt_known){.flags = NULL};
	r->solve = (nt_solve){.mesh = &r->mesh,
		.corner_count = corner_count,
		.threshold_cos = r->options.angular_threshold_degrees > 0.0f
			? threshold_cos(r->options.angular_threshold_degrees) : -1.0f,
		/* asking how many processors there are is a system call */
		.threads = corner_count < LEAST_SHARED_CORNERS ? 1 : nt_thread_count(r->options.threads),
		.isa = implementation->isa == NT_ISA_AUTO ? nt_cpu_best() : implementation->isa,
		.sorted = r->options.method == NMTAN_METHOD_MIKKTSPACE_SORTED,
		.one_by_one = implementation->scalar,
		.scratch = scratch,
		.timing = r->options.timing ? &r->timing : NULL,
		/* bounds on the error of the determinants of `texcoords` say nothing about those of others */
		.known = nt_has_stored_texcoords(&r->mesh) ? NULL : &r->known,
		.repair = r->options.repair == NMTAN_REPAIR_ON,
		.summed_instead = &r->summed_instead,
		.sorted_instead = &r->sorted_instead};
	r->sorted_instead = false;
	r->summed_instead = 0;
	r->mark = nt_scratch_here(scratch);
	r->jobs_before = nt_pool_use(r->options.jobs);
	if (r->solve.threads > 1)
		nt_pool_stay(1);
	status = nt_make_plain(&r->mesh, corner_count, scratch, &r->corners);
	if (status)
		end_request(r);
	return status;
}

/* Counts of this call, all zero; false where the caller's struct has no size. */
static bool begin_counts(nmtan_counts *own, const nmtan_counts *given)
{
	const bool sound = !given || nt_struct_read(own, sizeof *own, given);
	*own = (nmtan_counts)NMTAN_COUNTS_INIT;
	return sound;
}

typedef struct normal_count {
	const nmtan_mesh *mesh;
	size_t not_unit; /* atomic */
} normal_count;

static void count_normals(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	normal_count *job = context;
	size_t not_unit = 0;
	for (size_t v = begin; v < end; v++)
		not_unit += !nt_is_unit_normal(nt_normal(job->mesh, v));
	(void)nt_atomic_add(&job->not_unit, not_unit, RELAXED);
}

static void end_counts(const request *r, nmtan_counts *met, size_t ill_conditioned, nmtan_counts *given)
{
	if (!given)
		return;
	normal_count normals = {&r->mesh, 0};
	nt_parallel_ranges(r->solve.threads, r->mesh.vertex_count, LEAST_SHARED_CORNERS, count_normals, &normals);
	met->normals_not_unit = normals.not_unit;
	met->ill_conditioned = ill_conditioned;
	met->sorted_instead = r->sorted_instead;
	met->summed_instead = r->summed_instead;
	nt_struct_write(given, met, sizeof *met);
}

/* The tool alone has halves. */
#ifdef NT_NO_HALVES
static nmtan_status solve_quads(request *r, const uint8_t *halves, size_t *ill_conditioned, nmtan_counts *repaired)
{
	(void)r, (void)halves, (void)ill_conditioned, (void)repaired;
	return NMTAN_ERROR_ARGUMENT;
}
#else
const uint8_t nt_half_corners[NT_HALF_SECOND][2][3] = {
	{{0, 0, 0}, {0, 0, 0}}, /* NT_HALF_NONE */
	{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}, {{0, 2, 3}, {0, 1, 2}}, {{0, 1, 3}, {3, 1, 2}},
	{{2, 3, 0}, {1, 2, 0}}, {{1, 3, 0}, {1, 2, 3}}, {{0, 2, 3}, {2, 0, 1}}, {{0, 1, 2}, {2, 3, 0}},
};

/* Solves quads in the place of their halves, whose corners take the quads' results. They are repaired as quads, so that
 * both halves of a folded one have its baker's sign. Nothing is known of the halves; `repaired` receives what was
 * repaired. */
static nmtan_status solve_quads(request *r, const uint8_t *halves, size_t *ill_conditioned, nmtan_counts *repaired)
{
	const nmtan_mesh *mesh = &r->mesh;
	nt_scratch *scratch = r->solve.scratch;
	nmtan_mesh quads = *mesh;
	uint8_t *sizes = nt_scratch_alloc(scratch, mesh->face_count, 1);
	uint32_t *indices = nt_scratch_alloc(scratch, r->solve.corner_count, sizeof *indices);
	nt_solve solve = r->solve;
	solve.tangents = nt_scratch_alloc(scratch, r->solve.corner_count, 4 * sizeof *solve.tangents);
	if (!sizes || !indices || !solve.tangents)
		return NMTAN_ERROR_MEMORY;
	quads.face_count = solve.corner_count = 0;
	for (size_t t = 0, parts; t < mesh->face_count; t += parts) {
		uint32_t *corners = indices + solve.corner_count;
		parts = halves[t] == NT_HALF_NONE ? 1 : 2;
		for (size_t part = 0; part < parts; part++)
			for (size_t k = 0; k < 3; k++)
				corners[parts == 1 ? k : nt_half_corners[halves[t]][part][k]] =
					(uint32_t)nt_vertex_of(mesh, 3 * (t + part) + k);
		sizes[quads.face_count++] = (uint8_t)(2 + parts);
		solve.corner_count += 2 + parts;
	}
	quads.indices = indices;
	quads.face_sizes = sizes;
	solve.mesh = &quads;
	solve.known = r->solve.known = NULL;
	solve.bitangents = solve.magnitudes = NULL;
	solve.faults = NULL;
	nmtan_status status = run_method(&solve, r->options.method, ill_conditioned);
	if (!status && solve.repair)
		status = nt_repair(&solve, repaired);
	r->solve.repair = false;
	repaired->degenerate_positions = repaired->degenerate_texcoords = repaired->mirrored = 0;
	repaired->stored_differently = repaired->folded_quads = 0;
	const float *from = solve.tangents;
	for (size_t t = 0, parts; !status && t < mesh->face_count; t += parts) {
		parts = halves[t] == NT_HALF_NONE ? 1 : 2;
		for (size_t i = 0; i < 3 * parts; i++)
			memcpy(r->solve.tangents + 4 * (3 * t + i),
				from + 4 * (parts == 1 ? i : nt_half_corners[halves[t]][i / 3][i % 3]),
				4 * sizeof *from);
		from += 4 * (2 + parts);
	}
	return status;
}
#endif

nmtan_status nt_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_implementation *implementation, const nmtan_output *output, nmtan_counts *counts)
{
	nmtan_output to;
	nmtan_counts met;
	if (!mesh || !output || !nt_struct_read(&to, sizeof to, output) || !to.tangents ||
		!nt_fill_stride(&to.tangent_stride_bytes, NT_TANGENT_BYTES, 0) || !begin_counts(&met, counts) ||
		!nt_cpu_has(implementation->isa))
		return NMTAN_ERROR_ARGUMENT;
	request r;
	nmtan_status status = begin_request(&r, mesh, options, implementation);
	if (status)
		return status;
	r.solve.tangents = to.tangent_stride_bytes == NT_TANGENT_BYTES ? to.tangents :
		(float *)nt_scratch_alloc(r.solve.scratch, r.solve.corner_count, NT_TANGENT_BYTES);
	r.solve.bitangents = to.bitangents;
	r.solve.magnitudes = to.magnitudes;
	r.solve.faults = to.corner_faults;
	if (to.corner_faults)
		memset(to.corner_faults, 0, r.solve.corner_count);

	/* the method's own answer, then what a renderer can use */
	size_t ill_conditioned = 0;
	nmtan_counts of_quads;
	if (implementation->halves)
		of_quads = (nmtan_counts)NMTAN_COUNTS_INIT;
	if (!r.solve.tangents)
		status = NMTAN_ERROR_MEMORY;
	else if (r.solve.corner_count > 0)
		status = implementation->halves ? solve_quads(&r, implementation->halves, &ill_conditioned, &of_quads)
						: run_method(&r.solve, r.options.method, &ill_conditioned);
	if (!status && r.solve.corner_count > 0)
		status = nt_repair(&r.solve, &met);
	if (implementation->halves)
		nt_counts_add(&met, &of_quads);
	if (!status)
		nt_put_tangents(to.tangents, to.tangent_stride_bytes, r.solve.tangents, r.solve.corner_count);
	end_counts(&r, &met, ill_conditioned, counts);
	end_request(&r);
	return status;
}

nmtan_status nmtan_tangents(const nmtan_mesh *mesh, const nmtan_options *options, const nmtan_output *output,
	nmtan_counts *counts)
{
	const nt_implementation best = {.isa = NT_ISA_AUTO};
	return nt_tangents(mesh, options, &best, output, counts);
}

nmtan_status nt_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_vertex_request *wanted, nmtan_split_output *output, nmtan_counts *counts)
{
	nt_split_places places;
	nmtan_counts met;
	nmtan_mesh given;
	if (!mesh || !output || !nt_struct_read(&given, sizeof given, mesh) ||
		!nt_split_read(&places, &given, output) || !places.given.vertex_tangents || !begin_counts(&met, counts))
		return NMTAN_ERROR_ARGUMENT;
	request r;
	const nt_implementation best = {.isa = NT_ISA_AUTO};
	nmtan_status status = begin_request(&r, &given, options, &best);
	if (status)
		return status;
	nt_scratch *scratch = r.solve.scratch;
	nt_splitter splitter;
	size_t ill_conditioned = 0;
	status = nt_split_begin(&places, &r.mesh, r.solve.corner_count, r.corners, scratch);
	r.solve.spare = places.own.vertex_tangents; /* the split fills it at the end */
	r.solve.spare_bytes =
		(r.mesh.vertex_count + (wanted->lends_copies ? places.own.source_capacity : 0)) * NT_TANGENT_BYTES;
	r.solve.tangents = nt_scratch_alloc(scratch, r.solve.corner_count, NT_TANGENT_BYTES);
	if (!status)
		status = r.solve.tangents ? nt_splitter_begin(&splitter, &r.mesh, r.solve.corner_count, &places.own,
						    scratch)
					  : NMTAN_ERROR_MEMORY;
	splitter.lazy = wanted->lazy_indices;
	splitter.threads = r.solve.threads;
	if (!status && r.solve.corner_count > 0) {
		r.solve.sparse = r.solve.known && !r.mesh.face_sizes;
		status = run_method(&r.solve, r.options.method, &ill_conditioned);
		if (!status)
			status = nt_repair_and_split(&r.solve, &met, &splitter);
	}
	if (!status) {
		nt_splitter_end(&splitter);
		status = nt_split_end(&places, &r.mesh);
	}
	end_counts(&r, &met, ill_conditioned, counts);
	end_request(&r);
	nt_struct_write(output, &places.given, sizeof places.given);
	return status;
}

nmtan_status nmtan_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	nmtan_split_output *output, nmtan_counts *counts)
{
	const nt_vertex_request nothing = {.lazy_indices = false};
	return nt_vertex_tangents(mesh, options, &nothing, output, counts);
}
