/* SPDX-License-Identifier: MIT */
/*
 * The fast path against the definition, byte by byte: in every way that it may go, with all outputs.
 */
#ifndef NT_TEST_DEFINITION_H
#define NT_TEST_DEFINITION_H

#include "tangent/fast/fast.h"

typedef struct nt_result {
	float *tangents, *bitangents, *magnitudes;
	bool sorted; /* of the method whose sort of edges is completed */
} nt_result;

nt_result nt_result_make(size_t corners);
void nt_result_free(nt_result *result);

/* Floats of two results with different bits that are not both NaN; `more`: of all outputs. */
size_t nt_result_differences(const nt_result *a, const nt_result *b, size_t corners, bool more);

/* A solve on one thread and with the baseline set, to be changed, that writes a result. */
nt_solve nt_result_solve(const nmtan_mesh *mesh, size_t corners, nt_scratch *scratch, const nt_result *result,
	bool more);

/* The definition's results. */
nt_result nt_result_define(const nmtan_mesh *mesh, size_t corners, bool more);

/* The mesh with its strides. */
nmtan_mesh nt_filled(const nmtan_mesh *mesh);

/* As many threads as are asked for. */
extern const nt_fast_plan nt_usual_plan;

/* One run of the fast path against `expected`: how many floats differ. Prints that. */
size_t nt_compare_run(const char *name, const nmtan_mesh *mesh, size_t corners, const nt_result *expected, bool more,
	nt_isa isa, unsigned threads, const nt_fast_plan *plan);

/* One thread with every instruction set, where few vertices or triangles may go a way of their own, then more threads,
 * and places that do not suffice; the same by bins where there is a choice. */
size_t nt_compare_variants(const char *name, const nmtan_mesh *mesh, size_t corners, const nt_result *expected,
	bool more);

/* A solve with an allocator that fails after `allowed` requests. */
nmtan_status nt_solve_within(const nmtan_mesh *mesh, size_t corners, const nt_result *result, bool more, size_t allowed,
	unsigned threads, const nt_fast_plan *plan);

#endif
