/* SPDX-License-Identifier: MIT */
/*
 * Numbers that people act on: how densely the texture lies on each island, how far it is stretched, and what splitting
 * costs. Asked for by options->measures; all of it is for the mesh as it is checked.
 *
 * A triangle maps the texture to the surface linearly: with Su and Sv what one texel along u and v spans in space,
 * the largest and smallest singular values of (Su Sv) are the longest and shortest length of a texel (Sander, Snyder,
 * Gortler, Hoppe: Texture Mapping Progressive Meshes, 2001). Stretch is their ratio, 1 where the texture is not
 * distorted; density, in texels per unit of length, one over the root of their product. Medians are by area: half the
 * island has less.
 *
 * Vertices that mirrored and unmirrored triangles share, and the copies that splitting made, by cause: a copy whose w
 * differs from its source's stands on the other side of a mirror, any other one has another direction.
 */
#include "report/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "report/maker/maker.h"

/* A triangle's number and how much of the island it is. */
typedef struct weighed {
	float value, area;
} weighed;

typedef struct texel {
	double longest, shortest;
} texel;

/* Measures of a triangle that has an area in space and in the texture. */
static texel measure_texel(const nt_surface *s, size_t t, double width, double height)
{
	const uint32_t c = (uint32_t)(3 * t);
	const float *pa = nt_side_position(s, c), *pb = nt_side_position(s, c + 1), *pc = nt_side_position(s, c + 2);
	const float *ta = nt_side_texcoord(s, c), *tb = nt_side_texcoord(s, c + 1), *tc = nt_side_texcoord(s, c + 2);
	const double u1 = width * ((double)tb[0] - ta[0]), v1 = height * ((double)tb[1] - ta[1]);
	const double u2 = width * ((double)tc[0] - ta[0]), v2 = height * ((double)tc[1] - ta[1]);
	const double determinant = u1 * v2 - u2 * v1;
	double uu = 0, uv = 0, vv = 0; /* products of Su and Sv */
	for (int i = 0; i < 3; i++) {
		const double p1 = (double)pb[i] - pa[i], p2 = (double)pc[i] - pa[i];
		const double su = (v2 * p1 - v1 * p2) / determinant, sv = (u1 * p2 - u2 * p1) / determinant;
		uu += su * su;
		uv += su * sv;
		vv += sv * sv;
	}
	const double root = sqrt((uu - vv) * (uu - vv) + 4.0 * uv * uv);
	const double longest = sqrt(0.5 * (uu + vv + root));
	/* the difference would cancel; the product of both is the ratio of the areas */
	const double product = 2.0 * nt_triangle_area(s, t) / fabs(determinant);
	return (texel){longest, product / longest};
}

static uint32_t bits_of(float value)
{
	uint32_t bits;
	memcpy(&bits, &value, sizeof bits);
	return bits;
}

static int by_value(const void *a, const void *b)
{
	const weighed *x = a, *y = b;
	return x->value < y->value ? -1 : x->value > y->value;
}

/* Sorts by value; the bits of floats that are not negative are in the order of their values. With many triangles
 * qsort() takes a third of a whole run. other: [count] */
static void sort_weighed(weighed *items, size_t count, weighed *other)
{
	enum { FEW = 256 };
	if (count < FEW) {
		qsort(items, count, sizeof *items, by_value);
		return;
	}
	for (unsigned shift = 0; shift < 32; shift += 8) {
		size_t places[257] = {0};
		for (size_t i = 0; i < count; i++)
			places[(bits_of(items[i].value) >> shift & 255) + 1]++;
		for (size_t i = 0; i < 256; i++)
			places[i + 1] += places[i];
		for (size_t i = 0; i < count; i++)
			other[places[bits_of(items[i].value) >> shift & 255]++] = items[i];
		weighed *const sorted = other;
		other = items;
		items = sorted;
	}
}

/* The median by area of sorted ones. */
static double median_of(const weighed *items, size_t count)
{
	double total = 0.0, sum = 0.0;
	for (size_t i = 0; i < count; i++)
		total += items[i].area;
	for (size_t i = 0; i < count; i++) {
		sum += items[i].area;
		if (sum >= 0.5 * total)
			return items[i].value;
	}
	return NAN;
}

static bool is_measured(const nt_check *check, size_t t)
{
	return check->islands[t] != NT_NONE && check->surface.orientation[t] != 0 &&
		check->surface.flatness[t] == NT_SOUND;
}

/* Triangles by island: list[first[i]] to list[first[i + 1] - 1]. */
static void list_triangles(const nt_check *check, uint32_t *first, uint32_t *list)
{
	const size_t islands = check->facts->island_count;
	memset(first, 0, (islands + 2) * sizeof *first);
	for (size_t t = 0; t < check->surface.triangle_count; t++)
		if (is_measured(check, t))
			first[check->islands[t] + 2]++;
	for (size_t i = 1; i < islands; i++)
		first[i + 2] += first[i + 1];
	for (size_t t = 0; t < check->surface.triangle_count; t++)
		if (is_measured(check, t))
			list[first[check->islands[t] + 1]++] = (uint32_t)t;
}

/* size: of the texture, 0 0: not known. items, other: [count] */
static void measure_island(const nt_check *check, nt_island *island, const uint32_t *list, size_t count,
	const uint32_t size[2], weighed *items, weighed *other)
{
	const bool density = size[0] > 0;
	const double width = density ? size[0] : 1.0, height = density ? size[1] : 1.0;
	for (int pass = density ? 0 : 1; pass < 2 && count; pass++) {
		for (size_t i = 0; i < count; i++) {
			const texel x = measure_texel(&check->surface, list[i], width, height);
			const double value = pass ? x.longest / x.shortest : 1.0 / sqrt(x.longest * x.shortest);
			items[i] = (weighed){(float)value, (float)nt_triangle_area(&check->surface, list[i])};
		}
		sort_weighed(items, count, other);
		const double median = median_of(items, count);
		if (pass) {
			island->stretch[0] = median;
			island->stretch[1] = items[count - 1].value;
		} else {
			island->texel_density[0] = median;
			island->texel_density[1] = items[0].value;
		}
	}
}

/* The size of the normal map of a triangle's material, which is that of its island, but where materials meet inside of
 * one. sizes: [primitive_count] those that were asked for, NT_NONE: not yet; NULL: all have the size of the mesh. */
static nt_status find_size(const nt_check *check, uint32_t (*sizes)[2], uint32_t triangle, uint32_t size[2])
{
	const nt_report_options *options = check->options;
	nt_status status = NT_OK;
	if (sizes) {
		const uint32_t p = check->mesh->face_primitive[nt_triangle_face(&check->surface, triangle)];
		if (sizes[p][0] == NT_NONE) {
			nt_mesh one = *check->mesh;
			one.primitives += p;
			one.primitive_count = 1;
			sizes[p][0] = 0;
			status = options->find_map_size(options->find_user, check->scene, &one, sizes[p]);
		}
		sizes += p;
	}
	memcpy(size, sizes ? *sizes : check->facts->texture_size, 2 * sizeof *size);
	return status;
}

static nt_status measure_islands(nt_check *check)
{
	const size_t islands = check->facts->island_count, triangles = check->surface.triangle_count;
	const size_t primitives = check->mesh->primitive_count;
	const bool several = check->mesh->face_primitive && check->options->find_map_size;
	uint32_t *first = nt_scratch_alloc(check->scratch, islands + 2, sizeof *first);
	uint32_t *list = nt_scratch_alloc(check->scratch, triangles, sizeof *list);
	weighed *items = nt_scratch_alloc(check->scratch, triangles, sizeof *items);
	weighed *other = nt_scratch_alloc(check->scratch, triangles, sizeof *other);
	uint32_t(*sizes)[2] = several ? nt_scratch_alloc(check->scratch, primitives, sizeof *sizes) : NULL;
	if (!first || !list || !items || !other || (several && !sizes))
		return NT_ERROR_MEMORY;
	if (several)
		memset(sizes, 0xff, primitives * sizeof *sizes);
	list_triangles(check, first, list);
	nt_status status = NT_OK;
	for (size_t i = 0; i < islands && !status; i++) {
		nt_island *island = &check->facts->islands[i];
		uint32_t size[2];
		status = find_size(check, sizes, island->first_triangle, size);
		measure_island(check, island, list + first[i], first[i + 1] - first[i], size, items, other);
	}
	return status;
}

nt_status nt_check_measures(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	const nt_report_options *options = check->options;
	nt_report_mesh *facts = check->facts;
	nt_status status = NT_OK;
	if (!options->measures)
		return NT_OK;
	/* what is made here is written as floats */
	facts->vertex_bytes = mesh->vertex_bytes ? mesh->vertex_bytes
		: 12 + (mesh->normals ? 12u : 0) + (mesh->texcoords ? 8u : 0) + (mesh->colors ? 16u : 0) + 16;
	facts->split_vertices = mesh->split.source_count;
	if (!facts->islands)
		return NT_OK;
	if (options->find_map_size)
		status = options->find_map_size(options->find_user, check->scene, mesh, facts->texture_size);
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	if (!status)
		status = measure_islands(check);
	nt_scratch_back(check->scratch, mark);
	return status;
}

/* ---- copies of vertices ---- */

enum { UNMIRRORED = 1, MIRRORED = 2 };

static nt_status check_shared(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const size_t vertex_count = check->mesh->vertex_count;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	uint8_t *sides = nt_scratch_alloc(check->scratch, vertex_count, 1);
	if (!sides)
		return NT_ERROR_MEMORY;
	memset(sides, 0, vertex_count);
	const float right = check->facts->maker.inverted ? -1.0f : 1.0f;
	for (size_t t = 0; t < s->triangle_count; t++) {
		/* both halves of a folded quad may have the quad's tangents; each may have its own */
		const int folded = nt_quad_orientation(check, t);
		const int sign = folded ? folded : nt_settled_orientation(check, t);
		for (size_t c = 3 * t; c < 3 * t + 3 && sign && sign != NT_FOLDED_EITHER; c++) {
			const bool own = folded && check->stored == NT_STORED_AUTHORED;
			const float w = own ? right * nt_stored_tangent(check, nt_side_corner(s, c))[3] : (float)sign;
			sides[nt_side_vertex(s, c)] |= w > 0 ? UNMIRRORED : w < 0 ? MIRRORED : 0;
		}
	}
	nt_tally shared = {.code = NT_CODE_TAN_MIRROR_SHARED_VERTEX};
	for (size_t v = 0; v < vertex_count; v++)
		if (sides[v] == (UNMIRRORED | MIRRORED))
			nt_tally_vertex(check, &shared, (uint32_t)v, NAN);
	nt_scratch_back(check->scratch, mark);
	/* who makes tangents splits them, too */
	const bool stored = check->stored != NT_STORED_NONE;
	nt_check_report_as(check, &shared, stored && nt_needs_tangents(check) ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
		"%s", stored ? "their tangents are wrong on one side" : "");
	return NT_OK;
}

static void check_copies(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	nt_report_mesh *facts = check->facts;
	facts->added_normals = mesh->vertex_count - (facts->vertices_before - mesh->unused_vertices);
	const float *tangents = mesh->split.vertex_tangents;
	const size_t copies = nt_is_written(check) ? mesh->split.source_count : 0;
	for (size_t i = 0; i < copies; i++) {
		const size_t source = mesh->split.sources[i];
		const bool mirror = tangents &&
			tangents[4 * source + 3] != tangents[4 * (mesh->vertex_count + i) + 3];
		*(mirror ? &facts->added_mirror : &facts->added_direction) += 1;
	}
	facts->vertices_after = mesh->unused_vertices + mesh->vertex_count + copies;
}

nt_status nt_check_growth(nt_check *check)
{
	/* what is split is counted by check_copies() */
	const bool split = nt_is_written(check) && check->mesh->split.vertex_tangents;
	const bool both = check->facts->triangles[0] && check->facts->triangles[2];
	const nt_status status = both && !split ? check_shared(check) : NT_OK;
	if (!status)
		check_copies(check);
	return status;
}
