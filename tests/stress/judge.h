/* SPDX-License-Identifier: MIT */
/*
 * Judges the results of every method on one mesh against the oracle, and counts.
 */
#ifndef NT_STRESS_JUDGE_H
#define NT_STRESS_JUDGE_H

#include <stdbool.h>
#include <stddef.h>
#include "nmtan.h"
#include "surfaces.h"

enum { COLUMN_RAW, COLUMN_REPAIRED, COLUMN_AREA, COLUMN_LENGYEL, COLUMN_ROBUST, COLUMN_COUNT };

typedef struct column {
	const char *name;
	nmtan_method method;
	nmtan_repair repair;
} column;

extern const column columns[COLUMN_COUNT];

/* Results of one method on one mesh. */
typedef struct score {
	size_t faces, oriented; /* oriented: exact determinant not zero */
	size_t corners;
	size_t wrong_sign;  /* oriented faces with a corner whose w is not the exact sign */
	size_t mixed_sign;  /* faces whose corners differ in w */
	size_t zero;        /* corners: zero or not unit or not finite */
	size_t parallel;    /* corners: T along N */
	size_t beyond;      /* corners of oriented faces whose condition is not */
	size_t unnamed;     /* of these, robust: without NMTAN_FAULT_ILL_CONDITIONED */
	size_t off;         /* corners of a condition below 2^24: a component further than 2^-23 from the oracle */
	size_t tilted;      /* corners: |T . N| above 2^-21 */
	size_t leaning;     /* corners with a unit normal: |T . N| above 2^-10 */
	size_t replaced;    /* the default: corners whose bytes are not MikkTSpace's */
	size_t inexact;     /* corners with MikkTSpace's bytes replaced, condition below 2^24: as `off` */
	size_t kept;        /* corners with MikkTSpace's own bytes that have a bound (bounds.h) */
	size_t beyond_bound; /* of these: outside of it */
	size_t unbounded;   /* corners with MikkTSpace's own bytes that have none */
	double kept_degrees, kept_share, kept_units; /* of those with a bound: the worst angle, angle over bound, and
	                                                angle over 2^-24 times the condition */
	double unbounded_degrees; /* of the others: the worst angle to the average of all triangles of the
	                             orientation */
	size_t altered;     /* usable MikkTSpace corners whose bytes repair changed */
	double worst_degrees; /* over corners whose condition is below 2^24 */
	double ns_per_triangle;
} score;

/* Scores all methods. With `oracle` false only time and what needs no oracle but signs. False: a call of the library
 * failed or memory is exhausted. */
bool judge_mesh(const nt_owned *owned, bool oracle, score scores[COLUMN_COUNT]);

#endif
