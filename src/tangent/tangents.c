/* SPDX-License-Identifier: MIT */
/*
 * The entry point of the compute library: checks what the caller gave, runs the method, repairs.
 *
 * Checking costs one pass over indices and face sizes, so that no later stage has to doubt them.
 */
#include <math.h>
#include <string.h>
#include "base/cpu.h"
#include "base/parallel.h"
#include "tangent/repair.h"
#include "tangent/solve.h"
#include "topology/corners.h"

/* A row stride: 0 becomes the row's size; false where the stride cannot be. */
static bool fill_stride(size_t *stride_bytes, size_t row_bytes)
{
	if (*stride_bytes == 0)
		*stride_bytes = row_bytes;
	return *stride_bytes >= row_bytes && *stride_bytes % sizeof(float) == 0;
}

static nmtan_status check_attributes(nmtan_mesh *mesh)
{
	if (!mesh->positions || !mesh->normals || !mesh->texcoords)
		return NMTAN_ERROR_ARGUMENT;
	if (!fill_stride(&mesh->position_stride_bytes, 3 * sizeof(float)) ||
		!fill_stride(&mesh->normal_stride_bytes, 3 * sizeof(float)) ||
		!fill_stride(&mesh->texcoord_stride_bytes, 2 * sizeof(float)) ||
		!isfinite(mesh->stored_v_offset))
		return NMTAN_ERROR_ARGUMENT;
	return NMTAN_OK;
}

static nmtan_status check_options(const nmtan_options *options)
{
	const float degrees = options->angular_threshold_degrees;
	if ((unsigned)options->method > NMTAN_METHOD_ROBUST ||
		(unsigned)options->repair > NMTAN_REPAIR_OFF ||
		(unsigned)options->path > NMTAN_PATH_FAST || (unsigned)options->isa > NMTAN_ISA_AVX512)
		return NMTAN_ERROR_ARGUMENT;
	if (!(degrees >= 0.0f && degrees <= 180.0f) || !nt_cpu_has(options->isa))
		return NMTAN_ERROR_ARGUMENT;
	return NMTAN_OK;
}

/* Spec page, step 7: float degrees to radians, double cosine, rounded once. */
static float threshold_cos(float degrees)
{
	return (float)cos((double)((degrees * (float)M_PI) / 180.0f));
}

static nmtan_status run_method(const nt_solve *solve, const nmtan_options *options,
	size_t *ill_conditioned)
{
	switch (options->method) {
	case NMTAN_METHOD_MIKKTSPACE:
		return options->path == NMTAN_PATH_SCALAR ? nt_mikktspace_scalar(solve)
							  : nt_mikktspace_fast(solve);
	case NMTAN_METHOD_AREA:
		return nt_area(solve);
	case NMTAN_METHOD_LENGYEL:
		return nt_lengyel(solve);
	case NMTAN_METHOD_ROBUST:
		return nt_robust(solve, ill_conditioned);
	}
	return NMTAN_ERROR_ARGUMENT;
}

nmtan_status nmtan_tangents(const nmtan_mesh *mesh, const nmtan_options *options, nmtan_output *output)
{
	static const nmtan_options defaults = {0};
	if (!mesh || !output || !output->tangents)
		return NMTAN_ERROR_ARGUMENT;
	if (!options)
		options = &defaults;

	/* what was given must be sound before anything is computed */
	nmtan_mesh checked = *mesh;
	memset(&output->counts, 0, sizeof output->counts);
	nmtan_status status = check_options(options);
	if (!status)
		status = check_attributes(&checked);
	nt_vouched vouched = {0};
	nt_solve solve = {.mesh = &checked, .vouched = &vouched};
	if (!status)
		status = nt_check_faces(&checked, &solve.corner_count);
	if (status || solve.corner_count == 0)
		return status;

	nt_scratch own;
	nt_scratch_init(&own, options->allocator);
	solve.scratch = options->workspace ? &options->workspace->scratch : &own;
	solve.threshold_cos = options->angular_threshold_degrees > 0.0f
		? threshold_cos(options->angular_threshold_degrees) : -1.0f;
	solve.threads = nt_thread_count(options->threads);
	solve.one_by_one = options->path == NMTAN_PATH_SCALAR;
	solve.isa = options->isa == NMTAN_ISA_AUTO ? nt_cpu_best() : options->isa;
	solve.tangents = output->tangents;
	solve.bitangents = output->bitangents;
	solve.magnitudes = output->magnitudes;

	/* the method's own answer, then what a renderer can use */
	const nt_scratch_mark mark = nt_scratch_here(solve.scratch);
	size_t ill_conditioned = 0;
	status = run_method(&solve, options, &ill_conditioned);
	if (!status)
		status = nt_repair(&solve, options->repair == NMTAN_REPAIR_ON, &output->counts);
	output->counts.ill_conditioned = ill_conditioned;
	nt_scratch_back(solve.scratch, mark);
	nt_scratch_free(&own);
	return status;
}
