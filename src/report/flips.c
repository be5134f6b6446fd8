/* SPDX-License-Identifier: MIT */
/*
 * Flipped triangles: a few that are wound against what lies around them. A patch is what is connected in UV space and
 * of one orientation. One that is a small part of its island, in triangles, in area and in texels, is no fold but a
 * mistake of one corner or a relaxed knot: one finding for each island, at the triangles themselves. So is an island of
 * its own that lies inside a much larger one of the other orientation, unless its texels are those of a triangle there:
 * then it is a mirrored detail. Back faces of a two-sided sheet (same positions and UVs, reversed) are not reported.
 *
 * Nothing is said of needles: geometry.c tells of those that an unwrap could make wider. Their texels are those of a
 * line, whichever way they are wound.
 *
 * A flipped triangle or a needle makes no mirror edge, no fold, no overlap and no shared vertex: its bit is set in
 * check->flipped, and its mirror edges go. A patch as small that is not reported loses its mirror edges, too.
 */
#include "report/check.h"

#include <math.h>
#include <string.h>
#include "base/hash_index.h"

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
 * Up to a fourth such patches, and small islands of which most of the rim lies against one, have no mirror seam either.
 * Their rims are of one to three edges, and there are hundreds in an island that UV_MIXED_WINDING_ISLAND tells of once.
 *
 * Area counts because a fold may be a few large triangles beside many small ones; texels count because the back of a
 * planar projection may be a few small triangles that lie on all of the front.
 */
static const double FLIPPED_SHARE = 0.05, SINGLE_SHARE = 0.1, MINORITY_SHARE = 0.15, SEAMLESS_SHARE = 0.25;

/* The height of a needle beside its length, in texture coordinates. An artist who did not write this judged twenty
 * flipped triangles of public files, and refused all six that were thinner. */
static const double NEEDLE_HEIGHT = 0.01;

/* How much is wound one way. */
typedef struct extent {
	size_t triangles;
	double area, uv_area;
} extent;

typedef struct patch {
	extent size;
	uint32_t first;             /* triangle */
	uint32_t sides;             /* that lie against the other orientation */
	uint32_t host;              /* the island at most of them, if any is at more than half; NT_NONE: at none */
	uint32_t host_sides;        /* that lie against it */
	uint32_t votes;             /* for the host, less those against it */
	bool all_slivers;
	bool small, flipped;        /* by itself, and beside what is not small */
	bool minor, seamless;       /* alike: what has no seam of its own */
} patch;

typedef struct patches {
	uint32_t *numbers; /* [triangle_count] NT_NONE: no orientation */
	patch *items;
	uint32_t count;
	extent (*islands)[2]; /* [island_count] mirrored, unmirrored */
} patches;

static size_t island_size(const nt_island *island)
{
	return island->triangles[0] + island->triangles[1] + island->triangles[2];
}

static nt_status number_patches(nt_check *check, patches *p)
{
	const size_t islands = check->facts->island_count;
	p->numbers = check->patches;
	p->count = nt_number_sets(p->numbers, check->surface.triangle_count);
	p->items = nt_scratch_alloc(check->scratch, p->count, sizeof *p->items);
	p->islands = nt_scratch_alloc(check->scratch, islands, sizeof *p->islands);
	if (!p->items || !p->islands)
		return NT_ERROR_MEMORY;
	for (uint32_t i = 0; i < p->count; i++)
		p->items[i] = (patch){.first = NT_NONE, .host = NT_NONE};
	memset(p->islands, 0, islands * sizeof *p->islands);
	return NT_OK;
}

static void add_extent(extent *sum, const extent *other)
{
	sum->triangles += other->triangles;
	sum->area += other->area;
	sum->uv_area += other->uv_area;
}

static double uv_area(const nt_surface *s, size_t t)
{
	const float *a = nt_side_texcoord(s, 3 * t), *b = nt_side_texcoord(s, 3 * t + 1);
	const float *c = nt_side_texcoord(s, 3 * t + 2);
	return 0.5 * fabs(((double)b[0] - a[0]) * ((double)c[1] - a[1]) -
		((double)b[1] - a[1]) * ((double)c[0] - a[0]));
}

static void measure_patches(const nt_check *check, patches *p)
{
	const nt_surface *s = &check->surface;
	for (size_t t = 0; t < s->triangle_count; t++) {
		if (p->numbers[t] == NT_NONE)
			continue;
		patch *one = &p->items[p->numbers[t]];
		one->first = one->first == NT_NONE ? (uint32_t)t : one->first;
		one->all_slivers = (one->all_slivers || !one->size.triangles) && nt_is_sliver(s, t);
		add_extent(&one->size, &(extent){1, nt_triangle_area(s, t), uv_area(s, t)});
	}
	for (uint32_t i = 0; i < p->count; i++) {
		const uint32_t first = p->items[i].first;
		add_extent(&p->islands[check->islands[first]][s->orientation[first] > 0], &p->items[i].size);
	}
}

/* The patch at one side of a mirror edge, and the island at the other one; NULL: one of both has none. */
static patch *patch_at(const nt_check *check, const patches *p, const nt_edge *edge, int side, uint32_t *across)
{
	const uint32_t number = p->numbers[edge->sides[side] / 3];
	*across = check->islands[edge->sides[1 - side] / 3];
	return number == NT_NONE || *across == NT_NONE ? NULL : &p->items[number];
}

/* By Boyer and Moore's vote: which island is at more than half of a patch's sides does not follow from their order, as
 * which one of equal size is met first would. */
static void find_hosts(const nt_check *check, patches *p)
{
	uint32_t across;
	for (size_t i = 0; i < 2 * check->mirrors.count; i++) {
		patch *one = patch_at(check, p, &check->mirrors.items[i / 2], i % 2, &across);
		if (!one)
			continue;
		one->sides++;
		if (one->votes == 0)
			one->host = across;
		if (one->host == across)
			one->votes++;
		else
			one->votes--;
	}
	for (size_t i = 0; i < 2 * check->mirrors.count; i++) {
		patch *one = patch_at(check, p, &check->mirrors.items[i / 2], i % 2, &across);
		if (one)
			one->host_sides += one->host == across;
	}
}

static bool is_share(const extent *part, const extent *all, double share)
{
	return (double)part->triangles <= share * (double)all->triangles && part->area <= share * all->area &&
		part->uv_area <= share * all->uv_area;
}

/* Whether a patch is a whole island, which has texture coordinates of its own. */
static bool is_island(const nt_check *check, const patch *one)
{
	return island_size(&check->facts->islands[check->islands[one->first]]) == one->size.triangles;
}

/* Sets what a patch is by itself: small, minor. */
static void judge_patch(const nt_check *check, const patches *p, patch *one)
{
	const bool alone = is_island(check, one);
	const size_t rim = one->size.triangles + 2; /* outer sides of n triangles in a row */
	if (alone && (one->host == NT_NONE || 2 * (size_t)one->host_sides <= rim))
		return;
	/* of two triangles or more, one side may lie elsewhere */
	const bool inside = !alone || one->host_sides + (one->size.triangles > 1) >= rim;
	one->host = alone ? one->host : check->islands[one->first];
	const extent *host = p->islands[one->host], *alike = &host[check->surface.orientation[one->first] > 0];
	extent all = host[0];
	add_extent(&all, &host[1]);
	const bool minority = is_share(alike, &all, MINORITY_SHARE);
	const bool no_half = (double)alike->triangles <= SEAMLESS_SHARE * (double)all.triangles;
	if (alone)
		add_extent(&all, &one->size);
	const bool few = is_share(&one->size, &all, one->size.triangles == 1 ? SINGLE_SHARE : FLIPPED_SHARE);
	one->small = inside && (one->all_slivers || (few && minority));
	one->minor = one->all_slivers || (few && no_half);
}

/* A patch that only small patches surround is cut off by them, and not flipped itself. */
static void choose_flipped(const nt_check *check, patches *p)
{
	for (uint32_t i = 0; i < p->count; i++)
		judge_patch(check, p, &p->items[i]);
	for (size_t i = 0; i < check->mirrors.count; i++) {
		const uint32_t *sides = check->mirrors.items[i].sides;
		for (int k = 0; k < 2; k++) {
			const uint32_t number = p->numbers[sides[k] / 3], other = p->numbers[sides[1 - k] / 3];
			if (number == NT_NONE || other == NT_NONE)
				continue;
			patch *one = &p->items[number];
			const bool hosted = one->host == check->islands[sides[1 - k] / 3];
			one->flipped |= hosted && one->small && !p->items[other].small;
			one->seamless |= one->flipped || (hosted && one->minor && !p->items[other].minor);
		}
	}
}

/* ---- triangles whose texels are those of another one ---- */

/* A hash of the corners in any order: their coordinates, or their points. */
static uint64_t hash_corners(const nt_surface *s, size_t t, bool points)
{
	uint64_t hash = 0;
	for (size_t side = 3 * t; side < 3 * t + 3; side++)
		hash += nt_hash_words(points ? nt_side_point(s, side)
			: nt_hash_floats(nt_side_texcoord(s, side)[0], nt_side_texcoord(s, side)[1]), 0);
	return hash;
}

/* The sides of a doubled triangle lie against its twin: a patch of n such triangles has n outer sides or more. */
static bool may_have_twins(const nt_check *check, const patch *one)
{
	return one->seamless || (check->surface.orientation[one->first] < 0 && one->sides >= one->size.triangles);
}

/* The key of a triangle of this orientation. With `points` it lies where its twin lies. */
static uint64_t key_of(const nt_surface *s, size_t t, int orientation, bool points)
{
	const uint64_t key = hash_corners(s, t, false) + (uint64_t)orientation;
	return points ? nt_hash_words(key, hash_corners(s, t, true)) : key;
}

static bool same_corner(const nt_surface *s, size_t a, size_t b, bool points)
{
	const float *x = nt_side_texcoord(s, a), *y = nt_side_texcoord(s, b);
	return points ? nt_side_point(s, a) == nt_side_point(s, b) : x[0] == y[0] && x[1] == y[1];
}

/* Whether two triangles have the same corners, in any order. */
static bool same_corners(const nt_surface *s, size_t a, size_t b, bool points)
{
	for (size_t first = 0; first < 3; first++)
		for (size_t step = 1; step < 3; step++)
			if (same_corner(s, 3 * a, 3 * b + first, points) &&
				same_corner(s, 3 * a + 1, 3 * b + (first + step) % 3, points) &&
				same_corner(s, 3 * a + 2, 3 * b + (first + 2 * step) % 3, points))
				return true;
	return false;
}

/* The triangle among `keys` that has this orientation and the corners of t; NT_NONE. */
static uint32_t find_alike(const nt_check *check, const patches *p, const nt_hash_index *keys, size_t t,
	int orientation, bool points)
{
	const nt_surface *s = &check->surface;
	const uint64_t key = key_of(s, t, orientation, points);
	size_t at = NT_HASH_BEGIN;
	for (;;) {
		const uint32_t other = nt_hash_index_next(keys, key, &at);
		if (other == NT_NONE || (s->orientation[other] == orientation && same_corners(s, t, other, false) &&
				points != is_island(check, &p->items[p->numbers[other]]) &&
				(!points || same_corners(s, t, other, true))))
			return other;
	}
}

/* Triangles with the same corners stand once in the table; there they are marked if a twin is met. */
static nt_status find_twins(nt_check *check, patches *p)
{
	const nt_surface *s = &check->surface;
	nt_hash_index keys = {0};
	bool failed = false, any[2] = {false, false};
	for (int pass = 0; pass < 3 && !failed; pass++)
		for (size_t t = 0; t < s->triangle_count && !failed && (pass == 0 || keys.count); t++) {
			const patch *one = p->numbers[t] == NT_NONE ? NULL : &p->items[p->numbers[t]];
			for (int points = 0; points < 2 && one && !failed; points++) {
				if (pass == 1 ? !any[points]
						: !may_have_twins(check, one) || points == is_island(check, one))
					continue;
				const int orientation = pass == 1 ? -s->orientation[t] : s->orientation[t];
				const uint32_t first = find_alike(check, p, &keys, t, orientation, points);
				any[points] |= pass == 0;
				if (pass == 0 && first == NT_NONE)
					failed = !nt_hash_index_add(&keys, key_of(s, t, orientation, points),
						(uint32_t)t);
				else if (pass == 1 && first != NT_NONE)
					nt_bit_set(check->twins, first);
				else if (pass == 2 && nt_bit(check->twins, first))
					nt_bit_set(check->twins, t);
			}
		}
	for (size_t t = 0; (t = nt_bit_next(check->twins, t, s->triangle_count)) < s->triangle_count; t++)
		p->items[p->numbers[t]].flipped = p->items[p->numbers[t]].seamless = false;
	nt_hash_index_free(&keys);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

/* ---- what becomes of them ---- */

/* Whether a triangle's patch has no seam of its own. */
static bool is_seamless(const patches *p, uint32_t triangle)
{
	return p->numbers[triangle] != NT_NONE && p->items[p->numbers[triangle]].seamless;
}

/* Mirror edges stay in their order. */
static void drop_mirror_edges(nt_check *check, const patches *p)
{
	nt_edges *mirrors = &check->mirrors;
	size_t kept = 0;
	for (size_t i = 0; i < mirrors->count; i++) {
		const nt_edge edge = mirrors->items[i];
		if (!is_seamless(p, edge.sides[0] / 3) && !is_seamless(p, edge.sides[1] / 3))
			mirrors->items[kept++] = edge;
	}
	mirrors->count = kept;
}

/* The determinant is the height by the longest side. */
static bool is_needle(const nt_surface *s, size_t t)
{
	double longest = 0.0;
	for (size_t k = 0; k < 3; k++) {
		const float *a = nt_side_texcoord(s, 3 * t + k), *b = nt_side_texcoord(s, 3 * t + (k + 1) % 3);
		const double u = (double)b[0] - a[0], v = (double)b[1] - a[1];
		longest = fmax(longest, u * u + v * v);
	}
	return nt_is_sliver(s, t) || 2.0 * uv_area(s, t) <= NEEDLE_HEIGHT * longest;
}

static void report_flipped(nt_check *check, const patches *p)
{
	nt_report_mesh *facts = check->facts;
	const nt_surface *s = &check->surface;
	nt_tally tally = {.code = NT_CODE_UV_FLIPPED_TRIANGLE};
	double area = 0.0;
	for (size_t t = 0; t < s->triangle_count; t++) {
		const patch *one = p->numbers[t] == NT_NONE ? NULL : &p->items[p->numbers[t]];
		if (!one || !one->flipped)
			continue;
		nt_bit_set(check->flipped, t);
		facts->islands[check->islands[t]].flipped[s->orientation[t] + 1]++;
		if (is_needle(s, t))
			continue;
		tally.island = tally.count == 0 || tally.island == one->host + 1 ? one->host + 1 : 0;
		nt_tally_triangle(check, &tally, t, NAN);
		area += nt_triangle_area(s, t);
	}
	if (nt_is_visible(check, area))
		nt_check_report_as(check, &tally, nt_area_severity(check, area), "%zu triangles, %.3g %% of the area,",
			s->triangle_count, check->total_area > 0.0 ? 100.0 * area / check->total_area : 0.0);
}

nt_status nt_check_flips(nt_check *check)
{
	const size_t triangles = check->surface.triangle_count;
	patches p;
	if (!check->patches || !check->mirrors.count)
		return NT_OK;
	check->flipped = nt_scratch_alloc(check->scratch, nt_bit_words(triangles), sizeof *check->flipped);
	check->twins = nt_scratch_alloc(check->scratch, nt_bit_words(triangles), sizeof *check->twins);
	nt_status status = check->flipped && check->twins ? number_patches(check, &p) : NT_ERROR_MEMORY;
	if (status)
		return status;
	memset(check->flipped, 0, nt_bit_words(triangles) * sizeof *check->flipped);
	memset(check->twins, 0, nt_bit_words(triangles) * sizeof *check->twins);
	measure_patches(check, &p);
	find_hosts(check, &p);
	choose_flipped(check, &p);
	status = find_twins(check, &p);
	if (status)
		return status;
	report_flipped(check, &p);
	drop_mirror_edges(check, &p);
	return NT_OK;
}
