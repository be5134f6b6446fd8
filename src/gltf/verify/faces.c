/* SPDX-License-Identifier: MIT */
/*
 * The comparison of faces.h. The triangles of one list are in a tree, which halves space along what tells them apart:
 * of each of the seven values of a corner the sum, the least and the most of a triangle's three, whichever corner comes
 * first. Each triangle of the other list goes down wherever the one that is the same may be. They leave open which
 * corner has which value. Both lists are asked, so that none has more than the other.
 */
#include "gltf/verify/faces.h"

#include <math.h>
#include <stdlib.h>
#include "base/memory.h"
#include "base/parallel.h"

static bool within(const float *a, const float *b, size_t count, float tolerance)
{
	for (size_t i = 0; i < count; i++)
		/* what is not finite has to be the same */
		if (!(fabsf(a[i] - b[i]) <= tolerance) && !(isnan(a[i]) && isnan(b[i])) && a[i] != b[i])
			return false;
	return true;
}

bool nt_verify_close(const nt_verify_corner *a, const nt_verify_corner *b, const nt_verify_tolerance *tolerance)
{
	return within(a->position, b->position, 3, tolerance->position) &&
		within(a->tangent, b->tangent, 4, tolerance->tangent);
}

/* In one of the three ways in which the corners of one can be those of the other. */
static bool same_face(const nt_verify_corner *a, const nt_verify_corner *b, const nt_verify_tolerance *tolerance)
{
	for (size_t turn = 0; turn < 3; turn++) {
		size_t k = 0;
		while (k < 3 && nt_verify_close(&a[k], &b[(k + turn) % 3], tolerance))
			k++;
		if (k == 3)
			return true;
	}
	return false;
}

/* ---- trees ---- */

/* Ranges of so many are searched as they are; of a larger one so many are asked first what tells them apart. */
enum { MOST_LOOKED_AT = 16, ASKED = 64, VALUES = 7, FEATURES = 3 * VALUES, ENOUGH = 16 };

typedef struct node {
	double split;         /* what has at most this is in the first child */
	uint32_t feature;     /* FEATURES: a leaf */
	uint32_t children[2]; /* nodes; of a leaf the range in the order */
} node;

/* The triangles of one list. */
typedef struct face_set {
	const nt_verify_corner *faces;
	const nt_verify_tolerance *tolerance;
	uint32_t *order; /* [face count] by leaf */
	node *nodes;
	size_t node_count, node_capacity;
} face_set;

/* Values that are not finite do not count. */
static double feature_of(const nt_verify_corner *face, uint32_t feature)
{
	const uint32_t value = feature % VALUES, kind = feature / VALUES;
	double v[3];
	for (int k = 0; k < 3; k++)
		v[k] = (double)(value < 3 ? face[k].position[value] : face[k].tangent[value - 3]);
	const double result = kind == 0 ? v[0] + v[1] + v[2]
		: kind == 1 ? fmin(v[0], fmin(v[1], v[2])) : fmax(v[0], fmax(v[1], v[2]));
	return isfinite(result) ? result : 0;
}

/* How far a feature may be from that of the triangle that is the same. */
static double slack_of(const face_set *set, uint32_t feature)
{
	const double tolerance = (double)(feature % VALUES < 3 ? set->tolerance->position : set->tolerance->tangent);
	return (feature < VALUES ? 3.01 : 1.01) * tolerance;
}

/* The feature in which every step-th triangle of a range differs most, in its slack, or a good one of where they are;
 * FEATURES: all are as good as one. */
static uint32_t choose_feature(const face_set *set, uint32_t begin, uint32_t end, uint32_t step, double *split)
{
	uint32_t chosen = FEATURES;
	double most = 0.5;
	for (uint32_t f = 0; f < FEATURES && (f != 3 || most < ENOUGH); f++) {
		double low = INFINITY, high = -INFINITY;
		for (uint32_t i = begin; i < end; i += step) {
			const double value = feature_of(set->faces + 3 * (size_t)set->order[i], f);
			low = fmin(low, value);
			high = fmax(high, value);
		}
		const double spread = (high - low) / (slack_of(set, f) + 1e-300), middle = low + (high - low) / 2;
		if (!(spread > most))
			continue;
		most = spread;
		chosen = f;
		*split = middle < high ? middle : low;
	}
	return chosen;
}

/* Makes the tree of a range of the order. False: out of memory. */
static bool make_tree(face_set *set, uint32_t begin, uint32_t end, uint32_t *root)
{
	node made = {.feature = FEATURES, .children = {begin, end}};
	const uint32_t step = (end - begin) / ASKED + 1;
	if (end - begin > MOST_LOOKED_AT)
		made.feature = choose_feature(set, begin, end, step, &made.split);
	if (made.feature == FEATURES && step > 1)
		made.feature = choose_feature(set, begin, end, 1, &made.split);
	if (!nt_grow((void **)&set->nodes, &set->node_capacity, set->node_count + 1, sizeof *set->nodes))
		return false;
	*root = (uint32_t)set->node_count++;
	if (made.feature < FEATURES) {
		uint32_t middle = begin;
		for (uint32_t i = begin; i < end; i++) {
			const uint32_t face = set->order[i];
			if (feature_of(set->faces + 3 * (size_t)face, made.feature) > made.split)
				continue;
			set->order[i] = set->order[middle];
			set->order[middle++] = face;
		}
		if (!make_tree(set, begin, middle, &made.children[0]) ||
			!make_tree(set, middle, end, &made.children[1]))
			return false;
	}
	set->nodes[*root] = made;
	return true;
}

static bool is_in_tree(const face_set *set, const nt_verify_corner *face, uint32_t root)
{
	const node *n = &set->nodes[root];
	if (n->feature == FEATURES) {
		uint32_t i = n->children[0];
		while (i < n->children[1] && !same_face(face, set->faces + 3 * (size_t)set->order[i], set->tolerance))
			i++;
		return i < n->children[1];
	}
	const double value = feature_of(face, n->feature), slack = slack_of(set, n->feature);
	return (value - slack <= n->split && is_in_tree(set, face, n->children[0])) ||
		(value + slack > n->split && is_in_tree(set, face, n->children[1]));
}

/* ---- lists ---- */

/* The first of a list that the other one does not have; SIZE_MAX: none. */
static nt_status find_missing(const nt_verify_corner *list, size_t count, const nt_verify_corner *other,
	size_t other_count, const nt_verify_tolerance *tolerance, size_t *missing)
{
	face_set set = {.faces = other, .tolerance = tolerance, .order = nt_alloc(other_count, sizeof *set.order)};
	uint32_t root;
	for (size_t f = 0; set.order && f < other_count; f++)
		set.order[f] = (uint32_t)f;
	const bool made = set.order && make_tree(&set, 0, (uint32_t)other_count, &root);
	*missing = SIZE_MAX;
	for (size_t f = 0; f < count && made && *missing == SIZE_MAX; f++)
		if (!is_in_tree(&set, list + 3 * f, root))
			*missing = f;
	free(set.order);
	free(set.nodes);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

typedef struct both_ways {
	const nt_verify_corner *corners[2];
	size_t face_counts[2], missing[2]; /* missing in the other list */
	const nt_verify_tolerance *tolerance;
	nt_status statuses[2];
} both_ways;

static void ask_one_way(void *context, size_t way, unsigned thread)
{
	both_ways *w = context;
	(void)thread;
	w->statuses[way] = find_missing(w->corners[way], w->face_counts[way], w->corners[1 - way],
		w->face_counts[1 - way], w->tolerance, &w->missing[way]);
}

nt_status nt_verify_faces(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b, size_t b_faces,
	const nt_verify_tolerance *tolerance, unsigned threads, size_t *first)
{
	both_ways w = {.corners = {a, b}, .face_counts = {a_faces, b_faces}, .tolerance = tolerance};
	nt_parallel_items(threads, 2, ask_one_way, &w);
	*first = w.missing[0];
	if (*first == SIZE_MAX && (w.missing[1] != SIZE_MAX || a_faces != b_faces))
		*first = 0;
	return w.statuses[0] ? w.statuses[0] : w.statuses[1];
}
