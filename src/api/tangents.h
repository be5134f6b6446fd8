/* SPDX-License-Identifier: MIT */
/*
 * The entry points beyond nmtan.h: what the tool asks of nmtan_vertex_tangents(), and which implementation
 * tests and benches want of nmtan_tangents().
 */
#ifndef NT_API_TANGENTS_H
#define NT_API_TANGENTS_H

#include "tangent/solve.h"

typedef struct nt_vertex_request {
	bool lends_copies; /* room for copies in vertex_tangents may serve as scratch */
	bool lazy_indices; /* with source_count 0 output->indices is not written: they are the mesh's own */
	void (*passed)(void *user, nt_mesh_part part); /* see nt_solve */
	void *user;
} nt_vertex_request;

/* nmtan_vertex_tangents() with a request. */
nmtan_status nt_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_vertex_request *request, nmtan_split_output *output, nmtan_counts *counts);

/* All give the same bytes, so users do not choose. */
typedef struct nt_implementation {
	bool scalar; /* the definition, one triangle after the other, instead of the passes in lanes */
	nt_isa isa;  /* of the lanes */
} nt_implementation;

/* nmtan_tangents() by that implementation. Returns NMTAN_ERROR_ARGUMENT also for an instruction set that the
 * processor lacks. */
nmtan_status nt_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_implementation *implementation, const nmtan_output *output, nmtan_counts *counts);

#endif
