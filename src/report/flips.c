/* SPDX-License-Identifier: MIT */
/*
 * Flipped triangles: a few that are wound against their island. A patch is what is connected in UV space and of one
 * orientation. One that is a small part of its island, in triangles, in area and in texels, is no fold but a mistake of
 * one corner or a relaxed knot: one finding for each mesh, at the triangles themselves. Back faces of a two-sided sheet
 * (same positions and UVs, reversed) are not reported. A triangle with texture coordinates of its own is an island:
 * islands.c tells of it.
 *
 * A patch that rounding alone may have turned is not told: its triangles have the height of a line, or, where texture
 * coordinates were rounded to a grid (by Draco, KHR_mesh_quantization or a few decimals in a text), of a step of it.
 * There is no knot in the artist's file then. Nor is a patch of reversed faces, whose sides run in the direction of
 * their neighbours', or of faces that are folded back in space: the layout is right.
 *
 * Nor is anything told where more of the layout is wrong than that: there a flipped triangle is no news.
 *
 * A triangle that is told, or may have been turned, makes no mirror edge, no fold, no overlap and no shared vertex: its
 * bit is set in check->flipped, and its mirror edges go.
 */
#include "report/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/vec.h"

/*
 * A choice, not a gap: of the 1 244 islands of 431 public files that have both orientations, 195 have a minority up to
 * a twentieth, 322 up to a tenth, 180 up to a fifth, and the others are symmetric halves or strips folded over. Up to a
 * twentieth an artist looks for the triangles, above that for the fold. One triangle is never less than a twentieth of
 * an island of fewer than twenty, so that a single one counts up to a tenth.
 *
 * All that has the winding of a flipped patch has to be a minority of its island: of 876 islands with small patches, of
 * 1 451 public files, 722 have up to a fourth and 85 two fifths to a half. These are halves with a jagged middle line;
 * above a seventh, the author alone looked at pictures, and did not find the one more flipped than what lies beside it.
 *
 * Area counts because a fold may be a few large triangles beside many small ones; texels count because the back of a
 * planar projection may be a few small triangles that lie on all of the front.
 */
static const double FLIPPED_SHARE = 0.05, SINGLE_SHARE = 0.1, MINORITY_SHARE = 0.15;

/*
 * A triangle is not told if nobody sees it: it is less than eight texels high, where the texture has 2048 x 2048; or it
 * is a needle in space, whose height is up to a twentieth of its length. Readers who did not write this judged twenty
 * flipped triangles of public files each. The last one agreed with 2 of 10 that are lower than eight texels, for real
 * textures are smaller, or flat there, and with 8 of 10 that are higher; needles up to a fiftieth were refused before.
 */
static const double LEAST_HEIGHT = 8.0 / 2048.0, NEEDLE = 0.05;

/* How much is wound one way. */
typedef struct extent {
	size_t triangles;
	double area, uv_area;
} extent;

typedef struct patch {
	extent size;
	uint32_t first;             /* triangle */
	uint32_t sides;             /* that lie against the other orientation */
	uint32_t reversed;          /* of these, those that are turned over in space, too */
	bool rounded;               /* rounding may have turned all of it */
	bool flipped;
	double seen;                /* area of what is told of it */
} patch;

typedef struct patches {
	uint32_t *numbers; /* [triangle_count] NT_NONE: no orientation */
	patch *items;
	uint32_t count;
	extent (*islands)[2]; /* [island_count] mirrored, unmirrored */
	nt_texcoord_grid grid;
} patches;

static nt_status number_patches(nt_check *check, patches *p)
{
	const size_t islands = check->facts->island_count;
	*p = (patches){.numbers = check->patches};
	p->count = nt_number_sets(p->numbers, check->surface.triangle_count);
	p->items = nt_scratch_alloc(check->scratch, p->count, sizeof *p->items);
	p->islands = nt_scratch_alloc(check->scratch, islands, sizeof *p->islands);
	if (!p->items || !p->islands)
		return NT_ERROR_MEMORY;
	for (uint32_t i = 0; i < p->count; i++)
		p->items[i] = (patch){.first = NT_NONE};
	memset(p->islands, 0, islands * sizeof *p->islands);
	return NT_OK;
}

/* ---- which patches are flipped ---- */

static void add_extent(extent *sum, const extent *other)
{
	sum->triangles += other->triangles;
	sum->area += other->area;
	sum->uv_area += other->uv_area;
}

/* Twice the area of a side's triangle, along its normal. */
static nt_dvec3 normal_of(const nt_surface *s, uint32_t side)
{
	const uint32_t first = side / 3 * 3;
	const nt_dvec3 a = nt_dvec3_load(nt_side_position(s, first));
	return nt_dvec3_cross(nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, first + 1)), a),
		nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, first + 2)), a));
}

/* Whether one of the triangles at two sides of an edge shows its back where the other shows its front: they are folded
 * by more than a right angle, as at the rim of a blade, where a planar projection is mirrored on the other side. A
 * reader refused three of three between 115 and 156 degrees, and agreed with five of nine up to 70. */
static bool is_turned_over(const nt_surface *s, uint32_t a, uint32_t b)
{
	const nt_dvec3 x = normal_of(s, a), y = normal_of(s, b);
	return nt_side_point(s, a) == nt_side_point(s, b) || nt_dvec3_dot(x, y) < 0.0;
}

static void measure_patches(const nt_check *check, patches *p)
{
	const nt_surface *s = &check->surface;
	for (size_t t = 0; t < s->triangle_count; t++) {
		if (p->numbers[t] == NT_NONE)
			continue;
		patch *one = &p->items[p->numbers[t]];
		one->first = one->first == NT_NONE ? (uint32_t)t : one->first;
		one->rounded = (one->rounded || !one->size.triangles) && nt_may_be_turned(s, &p->grid, t);
		add_extent(&one->size, &(extent){1, nt_triangle_area(s, t), nt_uv_area(s, t)});
	}
	for (uint32_t i = 0; i < p->count; i++) {
		const uint32_t first = p->items[i].first;
		add_extent(&p->islands[check->islands[first]][s->orientation[first] > 0], &p->items[i].size);
	}
	for (size_t i = 0; i < check->mirrors.count; i++)
		for (int k = 0; k < 2; k++) {
			const uint32_t *sides = check->mirrors.items[i].sides;
			const uint32_t number = p->numbers[sides[k] / 3];
			if (number == NT_NONE)
				continue;
			p->items[number].sides++;
			p->items[number].reversed += is_turned_over(s, sides[0], sides[1]);
		}
}

static bool is_share(const extent *part, const extent *all, double share)
{
	return (double)part->triangles <= share * (double)all->triangles && part->area <= share * all->area &&
		part->uv_area <= share * all->uv_area;
}

static void choose_flipped(const nt_check *check, patches *p)
{
	for (uint32_t i = 0; i < p->count; i++) {
		patch *one = &p->items[i];
		const extent *island = p->islands[check->islands[one->first]];
		const extent *alike = &island[check->surface.orientation[one->first] > 0];
		extent all = island[0];
		add_extent(&all, &island[1]);
		one->flipped = one->rounded || (is_share(alike, &all, MINORITY_SHARE) &&
			is_share(&one->size, &all, one->size.triangles == 1 ? SINGLE_SHARE : FLIPPED_SHARE));
	}
}

/* ---- the back of a sheet ---- */

/* A hash of a triangle's corners in any order, as one of this orientation has them. */
static uint64_t key_of(const nt_surface *s, size_t t, int orientation)
{
	uint64_t key = (uint64_t)orientation;
	for (size_t side = 3 * t; side < 3 * t + 3; side++)
		key += nt_hash_words(nt_hash_floats(nt_side_texcoord(s, side)[0], nt_side_texcoord(s, side)[1]),
			nt_side_point(s, side));
	return key;
}

static bool same_corner(const nt_surface *s, size_t a, size_t b)
{
	const float *x = nt_side_texcoord(s, a), *y = nt_side_texcoord(s, b);
	return x[0] == y[0] && x[1] == y[1] && nt_side_point(s, a) == nt_side_point(s, b);
}

/* Whether two triangles have the same corners, in any order. */
static bool same_corners(const nt_surface *s, size_t a, size_t b)
{
	for (size_t first = 0; first < 3; first++)
		for (size_t step = 1; step < 3; step++)
			if (same_corner(s, 3 * a, 3 * b + first) &&
				same_corner(s, 3 * a + 1, 3 * b + (first + step) % 3) &&
				same_corner(s, 3 * a + 2, 3 * b + (first + 2 * step) % 3))
				return true;
	return false;
}

/* The triangle among `keys` that has this orientation and the corners of t; NT_NONE. */
static uint32_t find_alike(const nt_surface *s, const nt_hash_index *keys, size_t t, int orientation)
{
	const uint64_t key = key_of(s, t, orientation);
	size_t at = NT_HASH_BEGIN;
	for (;;) {
		const uint32_t other = nt_hash_index_next(keys, key, &at);
		if (other == NT_NONE || (s->orientation[other] == orientation && same_corners(s, t, other)))
			return other;
	}
}

/* The sides of a doubled triangle lie against its twin: a patch of n such triangles has n outer sides or more. */
static bool may_have_twins(const nt_check *check, const patch *one)
{
	return one->flipped || (check->surface.orientation[one->first] < 0 && one->sides >= one->size.triangles);
}

/* Triangles with the same corners stand once in the table; there they are marked if a twin is met. */
static nt_status find_twins(nt_check *check, patches *p)
{
	const nt_surface *s = &check->surface;
	nt_hash_index keys = {0};
	bool failed = false;
	for (int marks = 0; marks < 2 && !failed; marks++)
		for (size_t t = 0; t < s->triangle_count && !failed && (!marks || keys.count); t++) {
			const patch *one = p->numbers[t] == NT_NONE ? NULL : &p->items[p->numbers[t]];
			if (!one || (!marks && !may_have_twins(check, one)))
				continue;
			const int orientation = marks ? -s->orientation[t] : s->orientation[t];
			const uint32_t first = find_alike(s, &keys, t, orientation);
			if (!marks && first == NT_NONE)
				failed = !nt_hash_index_add(&keys, key_of(s, t, orientation), (uint32_t)t);
			else if (marks && first != NT_NONE)
				nt_bit_set(check->twins, first);
		}
	for (size_t t = 0; (t = nt_bit_next(check->twins, t, s->triangle_count)) < s->triangle_count; t++)
		p->items[p->numbers[t]].flipped = false;
	nt_hash_index_free(&keys);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

/* ---- what becomes of them ---- */

/* Mirror edges stay in their order. */
static void drop_mirror_edges(nt_check *check)
{
	nt_edges *mirrors = &check->mirrors;
	size_t kept = 0;
	for (size_t i = 0; i < mirrors->count; i++) {
		const nt_edge edge = mirrors->items[i];
		if (!nt_bit(check->flipped, edge.sides[0] / 3) && !nt_bit(check->flipped, edge.sides[1] / 3))
			mirrors->items[kept++] = edge;
	}
	mirrors->count = kept;
}

static double longest_square(const float *a, const float *b, const float *c, int axes)
{
	double squares[3] = {0.0, 0.0, 0.0};
	for (int axis = 0; axis < axes; axis++) {
		const double ab = (double)b[axis] - a[axis], bc = (double)c[axis] - b[axis];
		const double ca = (double)a[axis] - c[axis];
		squares[0] += ab * ab;
		squares[1] += bc * bc;
		squares[2] += ca * ca;
	}
	return fmax(squares[0], fmax(squares[1], squares[2]));
}

/* Whether somebody may see that a triangle is turned. */
static bool is_seen(const nt_surface *s, patches *p, size_t t)
{
	const double length = sqrt(longest_square(nt_side_texcoord(s, 3 * t), nt_side_texcoord(s, 3 * t + 1),
		nt_side_texcoord(s, 3 * t + 2), 2));
	const double square = longest_square(nt_side_position(s, 3 * t), nt_side_position(s, 3 * t + 1),
		nt_side_position(s, 3 * t + 2), 3);
	return 2.0 * nt_uv_area(s, t) >= LEAST_HEIGHT * length && 2.0 * nt_triangle_area(s, t) > NEEDLE * square &&
		!nt_may_be_turned(s, &p->grid, t);
}

/* Areas of an island. */
typedef struct wrongs {
	double told, untold; /* of flipped triangles; untold also: of those that have no area in UV space */
} wrongs;

/*
 * Whether the layout is in order but for the triangles that are told. Else a reader has other findings about it, and
 * refuses this one: what counts against it is the rarer winding of every island, and in an island where some are told
 * what else is wrong with it. By area, for many a small triangle is nothing beside a large one that is told.
 */
static bool is_in_order(const nt_check *check, const patches *p, const wrongs *islands, size_t told)
{
	double all_told = 0.0, others = 0.0;
	for (size_t i = 0; i < check->facts->island_count; i++) {
		all_told += islands[i].told;
		others += fmin(p->islands[i][0].area, p->islands[i][1].area);
		others += islands[i].told > 0.0 ? islands[i].untold : 0.0;
	}
	return others <= all_told && check->facts->inconsistent_edges <= told;
}

static void report_tally(nt_check *check, const nt_tally *tally)
{
	const nt_mesh *mesh = check->mesh;
	char set[64] = "";
	if (nt_format_is_gltf(check->scene->format))
		snprintf(set, sizeof set, ", in UV set %u%s", mesh->texcoord_set,
			check->untextured ? ", which no texture uses" : "");
	nt_check_report_as(check, tally,
		check->untextured ? NT_SEVERITY_INFO : nt_area_severity(check, tally->area),
		"%.3g %% of the area of %zu%s", 100.0 * tally->area / check->total_area, check->surface.triangle_count,
		set);
}

static nt_status report_flipped(nt_check *check, patches *p)
{
	nt_report_mesh *facts = check->facts;
	const nt_surface *s = &check->surface;
	nt_tally tally = {.code = NT_CODE_UV_FLIPPED_TRIANGLE};
	wrongs *islands = nt_scratch_alloc(check->scratch, facts->island_count, sizeof *islands);
	if (!islands)
		return NT_ERROR_MEMORY;
	memset(islands, 0, facts->island_count * sizeof *islands);
	for (size_t t = 0; t < s->triangle_count; t++) {
		patch *one = p->numbers[t] == NT_NONE ? NULL : &p->items[p->numbers[t]];
		const uint32_t island = check->islands[t];
		if (!one && island != NT_NONE)
			islands[island].untold += nt_triangle_area(s, t);
		if (!one || !one->flipped)
			continue;
		nt_bit_set(check->flipped, t);
		facts->islands[island].flipped[s->orientation[t] + 1]++;
		p->islands[island][s->orientation[t] > 0].area -= nt_triangle_area(s, t);
		one->seen += one->reversed < one->sides && is_seen(s, p, t) ? nt_triangle_area(s, t) : 0.0;
	}
	for (size_t t = 0; (t = nt_bit_next(check->flipped, t, s->triangle_count)) < s->triangle_count; t++) {
		const uint32_t island = check->islands[t];
		const bool told = nt_is_visible(check, p->items[p->numbers[t]].seen) && is_seen(s, p, t);
		*(told ? &islands[island].told : &islands[island].untold) += nt_triangle_area(s, t);
		if (!told)
			continue;
		tally.island = tally.count == 0 || tally.island == island + 1 ? island + 1 : 0;
		nt_tally_triangle(check, &tally, t, NAN);
		tally.area += nt_triangle_area(s, t);
	}
	if (is_in_order(check, p, islands, tally.count))
		report_tally(check, &tally);
	return NT_OK;
}

nt_status nt_check_flips(nt_check *check)
{
	const size_t words = nt_bit_words(check->surface.triangle_count);
	patches p;
	if (!check->patches || !check->mirrors.count)
		return NT_OK;
	check->flipped = nt_scratch_alloc(check->scratch, words, sizeof *check->flipped);
	check->twins = nt_scratch_alloc(check->scratch, words, sizeof *check->twins);
	nt_status status = check->flipped && check->twins ? number_patches(check, &p) : NT_ERROR_MEMORY;
	if (status)
		return status;
	memset(check->flipped, 0, words * sizeof *check->flipped);
	memset(check->twins, 0, words * sizeof *check->twins);
	p.grid = nt_texcoord_grid_of(&check->surface);
	measure_patches(check, &p);
	choose_flipped(check, &p);
	status = find_twins(check, &p);
	if (status)
		return status;
	status = report_flipped(check, &p);
	drop_mirror_edges(check);
	return status;
}
