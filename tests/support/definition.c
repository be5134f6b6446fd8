/* SPDX-License-Identifier: MIT */
/* See definition.h. */
#include "definition.h"

#include <math.h>
#include "test.h"
#include "base/cpu.h"
#include "tangent/fast/parts.h"

/* Floats with different bits that are not both NaN. */
static size_t count_differences(const float *a, const float *b, size_t count)
{
	size_t differences = 0;
	for (size_t i = 0; i < count; i++)
		differences += memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]));
	return differences;
}

nt_result nt_result_make(size_t corners)
{
	return (nt_result){malloc(corners * 16 + 1), malloc(corners * 12 + 1), malloc(corners * 8 + 1), false};
}

void nt_result_free(nt_result *r)
{
	free(r->tangents);
	free(r->bitangents);
	free(r->magnitudes);
}

size_t nt_result_differences(const nt_result *a, const nt_result *b, size_t corners, bool more)
{
	size_t differences = count_differences(a->tangents, b->tangents, 4 * corners);
	if (more)
		differences += count_differences(a->bitangents, b->bitangents, 3 * corners) +
			       count_differences(a->magnitudes, b->magnitudes, 2 * corners);
	return differences;
}

nmtan_mesh nt_filled(const nmtan_mesh *mesh)
{
	nmtan_mesh m = *mesh;
	m.position_stride_bytes = m.position_stride_bytes ? m.position_stride_bytes : 12;
	m.normal_stride_bytes = m.normal_stride_bytes ? m.normal_stride_bytes : 12;
	m.texcoord_stride_bytes = m.texcoord_stride_bytes ? m.texcoord_stride_bytes : 8;
	return m;
}

nt_solve nt_result_solve(const nmtan_mesh *mesh, size_t corners, nt_scratch *scratch, const nt_result *r, bool more)
{
	return (nt_solve){.mesh = mesh, .corner_count = corners, .threshold_cos = -1.0f, .threads = 1,
		.isa = NT_ISA_BASELINE, .sorted = r->sorted, .scratch = scratch, .tangents = r->tangents,
		.bitangents = more ? r->bitangents : NULL, .magnitudes = more ? r->magnitudes : NULL};
}

nt_result nt_result_define(const nmtan_mesh *mesh, size_t corners, bool more)
{
	nt_result result = nt_result_make(corners);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	const nt_solve solve = nt_result_solve(mesh, corners, &scratch, &result, more);
	assert_int_equal(nt_mikktspace_scalar(&solve), NMTAN_OK);
	nt_scratch_free(&scratch);
	return result;
}

const nt_fast_plan nt_usual_plan = {.grain = 1};

size_t nt_compare_run(const char *name, const nmtan_mesh *mesh, size_t corners, const nt_result *expected,
	bool more, nt_isa isa, unsigned threads, const nt_fast_plan *plan)
{
	nt_result got = nt_result_make(corners);
	got.sorted = expected->sorted;
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_solve solve = nt_result_solve(mesh, corners, &scratch, &got, more);
	solve.isa = isa;
	solve.threads = threads;
	memset(got.tangents, 0xab, corners * 16);
	assert_int_equal(nt_mikktspace_fast_as(&solve, plan), NMTAN_OK);
	const size_t differences = nt_result_differences(expected, &got, corners, more);
	if (differences)
		print_error("%s%s, set %d, %u threads, bins of 2^%u, %zu places: %zu of %zu floats differ\n", name,
			expected->sorted ? ", sorted" : "", (int)isa, threads, plan->bin_bits, plan->most_places,
			differences, corners * (more ? 9 : 4));
	nt_scratch_free(&scratch);
	nt_result_free(&got);
	return differences;
}

size_t nt_compare_variants(const char *name, const nmtan_mesh *mesh, size_t corners,
	const nt_result *expected, bool more)
{
	static const unsigned threads[] = {2, 3, 8};
	static const nt_fast_plan few_places = {.grain = 1, .most_places = 200},
		bins = {.grain = 1, .bin_bits = 4}, larger_bins = {.grain = 1, .bin_bits = 5},
		two = {.grain = SIZE_MAX, .least_two = 2},
		narrow = {.grain = 1, .most_narrow = NT_NARROW_LIMIT, .small = true};
	static const nt_fast_plan *const small[2] = {&nt_usual_plan, &narrow};
	size_t differences = 0;
	for (nt_isa isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++)
		for (int i = 0; nt_cpu_has(isa) && i < 2; i++)
			differences += nt_compare_run(name, mesh, corners, expected, more, isa, 1, small[i]);
	for (int i = 0; i < 3; i++)
		differences += nt_compare_run(name, mesh, corners, expected, more, nt_cpu_best(), threads[i],
			&nt_usual_plan);
	differences += nt_compare_run(name, mesh, corners, expected, more, nt_cpu_best(), 3, &two);
	for (unsigned count = 1; count <= 3; count += 2)
		differences += nt_compare_run(name, mesh, corners, expected, more, nt_cpu_best(), count, &few_places);
	if (more)
		return differences;
	for (nt_isa isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++)
		if (nt_cpu_has(isa))
			differences += nt_compare_run(name, mesh, corners, expected, false, isa, 1, &bins);
	return differences + nt_compare_run(name, mesh, corners, expected, false, nt_cpu_best(), 3, &larger_bins);
}

/* An allocator that fails after some requests. */
typedef struct budget {
	size_t left, live;
} budget;

/* Lines begin where the scratch wants them to, so that what fits a block does not depend on the addresses of
 * threads. */
static void *spend(void *user, size_t size)
{
	budget *b = user;
	if (b->left == 0)
		return NULL;
	b->left--;
	b->live++;
	return aligned_alloc(64, (size + 63) / 64 * 64);
}

static void give_back(void *user, void *block, size_t size)
{
	(void)size;
	((budget *)user)->live--;
	free(block);
}

nmtan_status nt_solve_within(const nmtan_mesh *mesh, size_t corners, const nt_result *r, bool more, size_t allowed,
	unsigned threads, const nt_fast_plan *plan)
{
	budget b = {allowed, 0};
	const nmtan_allocator allocator = {spend, give_back, &b};
	nt_scratch scratch;
	nt_scratch_init(&scratch, &allocator);
	nt_solve solve = nt_result_solve(mesh, corners, &scratch, r, more);
	solve.threads = threads;
	const nmtan_status status = nt_mikktspace_fast_as(&solve, plan);
	nt_scratch_free(&scratch);
	assert_int_equal(b.live, 0);
	return status;
}
