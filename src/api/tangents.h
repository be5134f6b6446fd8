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
} nt_vertex_request;

/* nmtan_vertex_tangents() with a request. */
nmtan_status nt_vertex_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_vertex_request *request, nmtan_split_output *output, nmtan_counts *counts);

#ifndef NT_NO_HALVES
/* A triangle as a solve by quads sees it. The corners of a quad are a, b, c, d; its halves follow one another, and the
 * first says how both are written. */
enum nt_half {
	NT_HALF_NONE,    /* a face of its own */
	NT_HALF_ABC_ACD,
	NT_HALF_ABD_BCD,
	NT_HALF_ACD_ABC,
	NT_HALF_ABD_DBC,
	NT_HALF_CDA_BCA,
	NT_HALF_BDA_BCD,
	NT_HALF_ACD_CAB,
	NT_HALF_ABC_CDA,
	NT_HALF_SECOND
};

/* [enum nt_half][half] the corners of a half, as corners of its quad. */
extern const uint8_t nt_half_corners[NT_HALF_SECOND][2][3];
#endif

/* All give the same bytes, so users do not choose; but for halves of quads. */
typedef struct nt_implementation {
	bool scalar; /* the definition, one triangle after the other, instead of the passes in lanes */
	nt_isa isa;  /* of the lanes */
	const uint8_t *halves; /* [face_count] of a mesh of triangles: enum nt_half, which of them are solved as one
	                          quad. Outputs are tangents and the faults of repair alone. NULL: none */
} nt_implementation;

/* nmtan_tangents() by that implementation. Returns NMTAN_ERROR_ARGUMENT also for an instruction set that the
 * processor lacks. */
nmtan_status nt_tangents(const nmtan_mesh *mesh, const nmtan_options *options,
	const nt_implementation *implementation, const nmtan_output *output, nmtan_counts *counts);

/* nmtan_tangents() where some triangles are solved as quads: see nt_implementation.halves, which may be NULL. */
static inline nmtan_status nt_tangents_of_halves(const nmtan_mesh *mesh, const uint8_t *halves,
	const nmtan_options *options, const nmtan_output *output, nmtan_counts *counts)
{
	return nt_tangents(mesh, options, &(nt_implementation){.isa = NT_ISA_AUTO, .halves = halves}, output, counts);
}

#endif
