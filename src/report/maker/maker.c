/* SPDX-License-Identifier: MIT */
#include "report/maker/maker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/angle.h"
#include "base/numbers.h"
#include "base/vec.h"
#include "topology/corners.h"

/* Halves of bytes' steps add up to that, of other tangents less. */
static const double BYTE_DEGREES = 1.0, OTHER_DEGREES = 0.1, DEGREES = 57.29577951308232;

/* From here on no other maker is tried: the dialects of MikkTSpace differ at a few corners. */
static const double CERTAIN = 0.99999;

/* From this share of the corners away from the border on, it is worth to ask whether each agrees with one of two. */
static const double MAY_BE_BOTH = 0.9;

/* Each triangle at a vertex adds the number of its next vertex and takes that of the one before: around a closed fan
 * nothing is left. The numbers are spread over 64 bits (splitmix64), so that nothing else adds up to 0. */
static uint64_t spread(uint64_t id)
{
	id = (id + 1) * 0x9e3779b97f4a7c15;
	id = (id ^ id >> 30) * 0xbf58476d1ce4e5b9;
	id = (id ^ id >> 27) * 0x94d049bb133111eb;
	return id ^ id >> 31;
}

nt_status nt_maker_border(const nt_mesh *mesh, uint64_t *border)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	size_t count = 0;
	uint32_t *ids = nt_scratch_alloc(&scratch, mesh->corner_count, sizeof *ids);
	uint64_t *left = NULL;
	if (ids && !nt_weld_corners(&view, mesh->corner_count, &scratch, ids, &count))
		left = nt_scratch_alloc(&scratch, count, sizeof *left);
	if (left) {
		memset(left, 0, count * sizeof *left);
		for (size_t c = 0; c < mesh->corner_count; c++)
			left[ids[c]] += spread(ids[c - c % 3 + (c + 1) % 3]) - spread(ids[c - c % 3 + (c + 2) % 3]);
		memset(border, 0, nt_bit_words(mesh->corner_count) * sizeof *border);
		for (size_t c = 0; c < mesh->corner_count; c++)
			border[c / 64] |= (uint64_t)(left[ids[c]] != 0) << c % 64;
	}
	nt_scratch_free(&scratch);
	return left ? NT_OK : NT_ERROR_MEMORY;
}

/* Corners away from the border that agree with one of those that are tried. */
typedef struct either {
	uint64_t *agreeing;     /* bits */
	size_t judged, agreed;  /* agreed: of those that the last one judged */
} either;

static void note_either(either *any, size_t corner, bool agrees)
{
	if (agrees)
		nt_bit_set(any->agreeing, corner);
	any->judged++;
	any->agreed += nt_bit(any->agreeing, corner);
}

/* Counts at corners. */
typedef struct tally {
	size_t judged, agreeing, inverted;
	size_t by_degrees[2 * 180 + 1]; /* halves of a degree */
} tally;

static double share(const tally *t)
{
	return t->judged ? (double)t->agreeing / (double)t->judged : 0.0;
}

static void add(tally *to, const tally *from)
{
	to->judged += from->judged;
	to->agreeing += from->agreeing;
	to->inverted += from->inverted;
	for (size_t i = 0; i < sizeof to->by_degrees / sizeof *to->by_degrees; i++)
		to->by_degrees[i] += from->by_degrees[i];
}

/* Looks at the corners of triangles with an area in texture coordinates, and of quads that have one: of halves that
 * cancel MikkTSpace may make no tangent, and what stands for it proves nothing. any: NULL, or what was tried before. */
static void compare(const nt_mesh *mesh, const nmtan_mesh *view, const uint8_t *halves, const uint64_t *border,
	const float *fresh, nt_maker *maker, either *any)
{
	const double near = tan(maker->degrees / DEGREES) * tan(maker->degrees / DEGREES);
	tally inside = {0}, outside = {0};
	for (size_t t = 0; t < mesh->face_count; t++) {
		size_t v[3];
		for (size_t k = 0; k < 3; k++)
			v[k] = mesh->indices ? mesh->indices[3 * t + k] : 3 * t + k;
		if (!nmtan_orientation(view->texcoords + 2 * v[0], view->texcoords + 2 * v[1],
			view->texcoords + 2 * v[2]))
			continue;
		if (nt_folded_orientation(mesh, halves, t) == NT_FOLDED_EITHER)
			continue;
		for (size_t k = 0; k < 3; k++) {
			const bool at_border = border && nt_bit(border, 3 * t + k);
			tally *of = at_border ? &outside : &inside;
			const nt_dvec3 a = nt_dvec3_load(mesh->tangents + 4 * v[k]);
			const nt_dvec3 b = nt_dvec3_load(fresh + 4 * (3 * t + k));
			const nt_dvec3 cross = nt_dvec3_cross(a, b);
			const double dot = nt_dvec3_dot(a, b), square = nt_dvec3_dot(cross, cross);
			const bool agrees = dot > 0.0 && square <= near * dot * dot;
			of->judged++;
			of->agreeing += agrees;
			if (any && !at_border)
				note_either(any, 3 * t + k, agrees);
			of->inverted += mesh->tangents[4 * v[k] + 3] * fresh[4 * (3 * t + k) + 3] < 0.0f;
			of->by_degrees[square >= 0.0 ? (size_t)(2.0 * DEGREES * nt_angle(sqrt(square), dot)) : 360]++;
		}
	}
	maker->across = outside.judged && share(&outside) < NT_MAKER_SHARE && share(&inside) >= NT_MAKER_SHARE;
	if (!maker->across)
		add(&inside, &outside);
	maker->agreement = share(&inside);
	maker->inverted = 2 * inside.inverted > inside.judged;
	size_t half = 0, below = inside.by_degrees[0];
	while (100 * below < 99 * inside.judged)
		below += inside.by_degrees[++half];
	maker->most_degrees = 0.5 * (double)(half + 1);
}

static nt_status solve_and_compare(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker, either *any)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	const nmtan_options options = {.struct_bytes = sizeof options, .method = maker->method, .threads = threads};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = fresh};
	maker->degrees = mesh->byte_tangents ? BYTE_DEGREES : OTHER_DEGREES;
	const uint8_t *solved = maker->quads ? halves : NULL;
	const nt_status status = nt_status_of(nt_tangents_of_halves(&view, solved, &options, &output, NULL));
	if (any)
		any->judged = any->agreed = 0;
	if (!status)
		compare(mesh, &view, solved, border, fresh, maker, any);
	return status;
}

nt_status nt_maker_compare(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker)
{
	return solve_and_compare(mesh, halves, border, threads, fresh, maker, NULL);
}

/* Whether each corner's tangent is that of MikkTSpace on triangles or on quads: a folded quad is written as triangles
 * of their own signs beside others that were solved as quads (pipeline/quads.c), and exporters triangulate some faces
 * before the solve. `fresh` receives for each corner the nearer one of both. */
static nt_status compare_both(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker)
{
	nt_maker triangles = {.quads = false};
	float *other = nt_alloc(mesh->corner_count, 4 * sizeof *other);
	nt_status status = NT_ERROR_MEMORY;
	if (other)
		status = nt_maker_compare(mesh, NULL, border, threads, other, &triangles);
	if (!status)
		status = nt_maker_compare(mesh, halves, border, threads, fresh, maker);
	for (size_t c = 0; !status && c < mesh->corner_count; c++) {
		const nt_dvec3 t = nt_dvec3_load(mesh->tangents + 4 * (mesh->indices ? mesh->indices[c] : c));
		if (nt_dvec3_dot(t, nt_dvec3_load(other + 4 * c)) > nt_dvec3_dot(t, nt_dvec3_load(fresh + 4 * c)))
			memcpy(fresh + 4 * c, other + 4 * c, 4 * sizeof *other);
	}
	free(other);
	if (!status) {
		nmtan_stored_uv stored;
		const nmtan_mesh view = nt_mesh_view(mesh, &stored);
		compare(mesh, &view, halves, border, fresh, maker, NULL);
	}
	return status;
}

/* any: room for MikkTSpace on triangles and on quads; NULL: there are no quads. */
static nt_status try_makers(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker, either *any)
{
	static const nmtan_method methods[] = {NMTAN_METHOD_MIKKTSPACE, NMTAN_METHOD_MIKKTSPACE_SORTED,
		NMTAN_METHOD_AREA, NMTAN_METHOD_LENGYEL, NMTAN_METHOD_ROBUST};
	enum { MAKERS = 2 * sizeof methods / sizeof *methods };
	double off_mikktspace = 0.0;
	*maker = (nt_maker){.agreement = -1.0};
	for (size_t i = 0; i < MAKERS && maker->agreement < CERTAIN; i++) {
		nt_maker next = {.method = methods[i / 2], .quads = i % 2, .last = true};
		if (next.quads && !halves)
			continue;
		const nt_status status = solve_and_compare(mesh, halves, border, threads, fresh, &next,
			next.method == NMTAN_METHOD_MIKKTSPACE ? any : NULL);
		if (status)
			return status;
		if (i == 0)
			off_mikktspace = next.most_degrees;
		maker->last = false;
		if (next.agreement > maker->agreement)
			*maker = next;
	}
	if (any && maker->agreement < NT_MAKER_SHARE && (double)any->agreed >= MAY_BE_BOTH * (double)any->judged) {
		nt_maker both = {.quads = true, .last = true};
		const nt_status status = compare_both(mesh, halves, border, threads, fresh, &both);
		if (status)
			return status;
		maker->last = false;
		if (both.agreement >= NT_MAKER_SHARE)
			*maker = both;
	}
	maker->off_mikktspace = off_mikktspace;
	maker->known = maker->agreement >= NT_MAKER_SHARE;
	return NT_OK;
}

nt_status nt_find_maker(const nt_mesh *mesh, const uint8_t *halves, const uint64_t *border, unsigned threads,
	float *fresh, nt_maker *maker)
{
	const size_t words = nt_bit_words(mesh->corner_count);
	either any = {.agreeing = halves ? nt_calloc(words, sizeof *any.agreeing) : NULL};
	nt_status status = halves && !any.agreeing ? NT_ERROR_MEMORY : NT_OK;
	if (!status)
		status = try_makers(mesh, halves, border, threads, fresh, maker, halves ? &any : NULL);
	free(any.agreeing);
	if (status)
		return status;
	if (maker->known || !mesh->solve_texcoords)
		return NT_OK;
	nt_mesh plain = *mesh;
	plain.solve_texcoords = NULL;
	nt_maker of_plain;
	const double off_mikktspace = maker->off_mikktspace;
	status = nt_find_maker(&plain, halves, border, threads, fresh, &of_plain);
	maker->last = false;
	if (!status && of_plain.known) {
		*maker = of_plain;
		maker->untransformed = true;
		maker->off_mikktspace = off_mikktspace;
	}
	return status;
}

bool nt_maker_is_mikktspace(const nt_maker *maker)
{
	return maker->known &&
	       (maker->method == NMTAN_METHOD_MIKKTSPACE || maker->method == NMTAN_METHOD_MIKKTSPACE_SORTED);
}

void nt_maker_text(const nt_maker *maker, nt_buffer *out)
{
	static const char *const methods[] = {"MikkTSpace", "area weights", "Lengyel's sums", "the robust method",
		"MikkTSpace with its edges sorted"};
	if (!maker->known)
		return;
	nt_buffer_format(out, "%s%s%s%s%s", methods[maker->method], maker->quads ? ", on quads" : "",
		maker->across ? ", across primitives" : "",
		maker->untransformed ? ", without the texture transform" : "", maker->inverted ? ", w inverted" : "");
	if (!nt_maker_is_mikktspace(maker) && maker->off_mikktspace > maker->degrees)
		nt_buffer_format(out,
			": 99 %% of the corners are within %g degrees of MikkTSpace",
			maker->off_mikktspace);
}
