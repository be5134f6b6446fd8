/* SPDX-License-Identifier: MIT */
/*
 * The comparison of faces.h. Triangles of one list are put into cubes of space by their centres, a few
 * tolerances wide; one of the other list looks into the cubes that its own centre may have come from, at most
 * eight. Where many lie in one cube they are in a tree, which halves space along what tells them apart: of each of the
 * seven values of a corner the sum, the least and the most of a triangle's three, whichever corner comes first. What
 * they leave open is which corner has which value. Both lists are asked, so that none has more than the other.
 */
#include "gltf/verify/faces.h"

#include <math.h>
#include <stdlib.h>
#include "base/hash_index.h"
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

/* Cube of a centre along each axis, shifted by so many tolerances. */
static void cube_of(const nt_verify_corner *face, double size, double shift, int64_t cube[3])
{
	for (int i = 0; i < 3; i++) {
		const double centre = ((double)face[0].position[i] + face[1].position[i] + face[2].position[i]) / 3;
		const double number = floor((centre + shift) / size);
		cube[i] = number > -9e15 && number < 9e15 ? (int64_t)number : 0;
	}
}

/* ---- trees ---- */

/* Cubes of fewer triangles are searched as they are, and so are leaves. */
enum { MOST_LOOKED_AT = 32, VALUES = 7, FEATURES = 3 * VALUES };

typedef struct node {
	double split;         /* what has at most this is in the first child */
	uint32_t feature;     /* FEATURES: a leaf */
	uint32_t children[2]; /* nodes; of a leaf the range in the order */
} node;

/* What lies in one cube. */
typedef struct group {
	uint32_t first, count; /* in the order */
	uint32_t root;         /* of its tree; UINT32_MAX: none */
} group;

/* The triangles of one list. */
typedef struct face_set {
	const nt_verify_corner *faces;
	const nt_verify_tolerance *tolerance;
	nt_hash_index cubes; /* numbers of groups */
	group *groups;       /* [group_count] */
	size_t group_count;
	uint32_t *order;     /* [face count] by group */
	node *nodes;
	size_t node_count, node_capacity;
} face_set;

/* What is not finite says nothing. */
static double feature_of(const nt_verify_corner *face, uint32_t feature)
{
	const uint32_t value = feature / 3;
	double v[3];
	for (int k = 0; k < 3; k++)
		v[k] = (double)(value < 3 ? face[k].position[value] : face[k].tangent[value - 3]);
	const double result = feature % 3 == 0 ? v[0] + v[1] + v[2]
		: feature % 3 == 1 ? fmin(v[0], fmin(v[1], v[2])) : fmax(v[0], fmax(v[1], v[2]));
	return isfinite(result) ? result : 0;
}

/* How far a feature may be from that of the triangle that is the same. */
static double slack_of(const face_set *set, uint32_t feature)
{
	const double tolerance = (double)(feature < 3 * 3 ? set->tolerance->position : set->tolerance->tangent);
	return (feature % 3 == 0 ? 3.01 : 1.01) * tolerance;
}

/* The feature in which triangles differ most, in its slack; FEATURES: all are as good as one. */
static uint32_t choose_feature(const face_set *set, uint32_t begin, uint32_t end, double *split)
{
	uint32_t chosen = FEATURES;
	double most = 0.5;
	for (uint32_t f = 0; f < FEATURES; f++) {
		double low = INFINITY, high = -INFINITY;
		for (uint32_t i = begin; i < end; i++) {
			const double value = feature_of(set->faces + 3 * (size_t)set->order[i], f);
			low = fmin(low, value);
			high = fmax(high, value);
		}
		const double spread = (high - low) / (slack_of(set, f) + 1e-300);
		if (!(spread > most))
			continue;
		most = spread;
		chosen = f;
		*split = low + (high - low) / 2;
	}
	return chosen;
}

/* Makes the tree of a range of the order. False: out of memory. */
static bool make_tree(face_set *set, uint32_t begin, uint32_t end, uint32_t *root)
{
	node made = {.feature = FEATURES, .children = {begin, end}};
	if (end - begin > MOST_LOOKED_AT)
		made.feature = choose_feature(set, begin, end, &made.split);
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

static bool is_in_range(const face_set *set, const nt_verify_corner *face, uint32_t begin, uint32_t end)
{
	for (uint32_t i = begin; i < end; i++)
		if (same_face(face, set->faces + 3 * (size_t)set->order[i], set->tolerance))
			return true;
	return false;
}

static bool is_in_tree(const face_set *set, const nt_verify_corner *face, uint32_t root)
{
	const node *n = &set->nodes[root];
	if (n->feature == FEATURES)
		return is_in_range(set, face, n->children[0], n->children[1]);
	const double value = feature_of(face, n->feature), slack = slack_of(set, n->feature);
	return (value - slack <= n->split && is_in_tree(set, face, n->children[0])) ||
		(value + slack > n->split && is_in_tree(set, face, n->children[1]));
}

/* ---- cubes ---- */

static double cube_size(const nt_verify_tolerance *tolerance)
{
	return 4.0 * tolerance->position + 1e-30;
}

/* Gives each triangle a group, and counts them. */
static bool find_groups(face_set *set, size_t count, uint32_t *numbers)
{
	for (size_t f = 0; f < count; f++) {
		int64_t cube[3];
		cube_of(set->faces + 3 * f, cube_size(set->tolerance), 0, cube);
		const uint64_t hash = nt_hash_bytes(0, cube, sizeof cube);
		size_t at = NT_HASH_BEGIN;
		numbers[f] = nt_hash_index_next(&set->cubes, hash, &at);
		if (numbers[f] == UINT32_MAX) {
			numbers[f] = (uint32_t)set->group_count++;
			set->groups[numbers[f]] = (group){.root = UINT32_MAX};
			if (!nt_hash_index_add(&set->cubes, hash, numbers[f]))
				return false;
		}
		set->groups[numbers[f]].count++;
	}
	return true;
}

static bool fill_set(face_set *set, size_t count)
{
	set->groups = nt_alloc(count, sizeof *set->groups);
	set->order = nt_alloc(count, sizeof *set->order);
	uint32_t *numbers = nt_alloc(count, sizeof *numbers), end = 0;
	bool made = set->groups && set->order && numbers && find_groups(set, count, numbers);
	for (size_t g = 0; g < set->group_count && made; g++)
		set->groups[g].first = end += set->groups[g].count;
	for (size_t f = count; f-- > 0 && made;)
		set->order[--set->groups[numbers[f]].first] = (uint32_t)f;
	for (size_t i = 0; i < set->group_count && made; i++) {
		group *g = &set->groups[i];
		if (g->count > MOST_LOOKED_AT)
			made = make_tree(set, g->first, g->first + g->count, &g->root);
	}
	free(numbers);
	return made;
}

static void free_set(face_set *set)
{
	nt_hash_index_free(&set->cubes);
	free(set->groups);
	free(set->order);
	free(set->nodes);
}

static bool is_in_group(const face_set *set, const nt_verify_corner *face, const group *g)
{
	return g->root != UINT32_MAX ? is_in_tree(set, face, g->root)
		: is_in_range(set, face, g->first, g->first + g->count);
}

static bool is_known(const face_set *set, const nt_verify_corner *face)
{
	int64_t low[3], high[3], cube[3];
	cube_of(face, cube_size(set->tolerance), -1.01 * set->tolerance->position, low);
	cube_of(face, cube_size(set->tolerance), 1.01 * set->tolerance->position, high);
	for (cube[0] = low[0]; cube[0] <= high[0]; cube[0]++)
		for (cube[1] = low[1]; cube[1] <= high[1]; cube[1]++)
			for (cube[2] = low[2]; cube[2] <= high[2]; cube[2]++) {
				size_t at = NT_HASH_BEGIN;
				const uint32_t number =
					nt_hash_index_next(&set->cubes, nt_hash_bytes(0, cube, sizeof cube), &at);
				if (number != UINT32_MAX && is_in_group(set, face, &set->groups[number]))
					return true;
			}
	return false;
}

/* The first face of `a` that `b` does not have. */
static nt_status find_missing(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b,
	size_t b_faces, const nt_verify_tolerance *tolerance, size_t *missing)
{
	face_set set = {.faces = b, .tolerance = tolerance};
	const bool made = fill_set(&set, b_faces);
	*missing = SIZE_MAX;
	for (size_t f = 0; f < a_faces && made && *missing == SIZE_MAX; f++)
		if (!is_known(&set, a + 3 * f))
			*missing = f;
	free_set(&set);
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
