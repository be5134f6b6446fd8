/* SPDX-License-Identifier: MIT */
/*
 * Checks of stored tangents: authored ones on --check, the result on conversion.
 *
 * One by one: finite, of unit length, perpendicular to the normal, w a sign. By triangle: one w on its
 * three corners, and the one that the exact orientation of the texture coordinates asks for. By corner:
 * the angle to a fresh MikkTSpace solve, where there is one to compare with.
 */
#include "report/check.h"

#include <math.h>
#include <string.h>
#include "base/angle.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "report/maker/maker.h"
#include "topology/corners.h"

/* Below this a tangent has no length; the tolerance of the Khronos validator for the others. */
static const double ZERO_LENGTH = 1e-6, UNIT_TOLERANCE = 0.00674;

/* Degrees. Quantisation to 8 bits explains half a degree off perpendicular; MISMATCH is the limit of the fifth bin of
 * the histogram. */
static const double ORTHOGONAL_DEGREES = 1.0, MISMATCH_DEGREES = 30.0;

/* Share of corners from which on other directions are a warning. */
static const double MISMATCH_SHARE = 0.01;

/* Share of the triangles and of their area up to which wrong signs are a warning: a few slivers. */
static const double SLIVER_SHARE = 0.002;

const double nt_angle_bins[NT_ANGLE_BINS] = {1.0, 5.0, 15.0, 30.0, 60.0, 180.0};

/* Triangles that a thread takes at a time. */
enum { PART = 16384 };

/* Said if wrong tangents follow the file's own coordinates, which a material's transform turns or mirrors. */
static const char untransformed_text[] =
	", they were made without the texture transform, as Blender's exporter, glTF-Transform and gltfpack do";

/* Findings of single tangents: the last of them has a detail. */
enum { NOT_FINITE, ZERO, NON_UNIT, BAD_W, PARALLEL, NOT_ORTHOGONAL, TANGENT_TALLIES };
static const nt_code tangent_codes[TANGENT_TALLIES] = {NT_CODE_TAN_NOT_FINITE, NT_CODE_TAN_ZERO, NT_CODE_TAN_NON_UNIT,
	NT_CODE_TAN_BAD_W, NT_CODE_TAN_PARALLEL_NORMAL, NT_CODE_TAN_NOT_ORTHOGONAL};

typedef struct tangent_tallies {
	nt_tally of[TANGENT_TALLIES];
	double worst_length;
	double worst_square; /* sin^2 of the angle off perpendicular that is the worst */
} tangent_tallies;

static double length_of(nt_dvec3 v)
{
	return sqrt(nt_dvec3_dot(v, v));
}

static double degrees_between(nt_dvec3 a, nt_dvec3 b)
{
	return nt_angle(length_of(nt_dvec3_cross(a, b)), nt_dvec3_dot(a, b)) * NT_DEGREES;
}

/* The square of the cosine of a degree: within it of the normal the bitangent is noise. */
static const double PARALLEL_COSINE_SQUARED = 0.9996954135095479;

unsigned nt_tangent_faults(const float *tangent, const float *normal)
{
	if (!isfinite(tangent[0]) || !isfinite(tangent[1]) || !isfinite(tangent[2]) || !isfinite(tangent[3]))
		return NT_FAULT_NOT_FINITE;
	const nt_dvec3 t = nt_dvec3_load(tangent);
	const double square = nt_dvec3_dot(t, t), length = sqrt(square);
	unsigned faults = fabsf(tangent[3]) != 1.0f ? NT_FAULT_W : 0;
	if (length < ZERO_LENGTH)
		return faults | NT_FAULT_ZERO;
	if (fabs(length - 1.0) > UNIT_TOLERANCE)
		faults |= NT_FAULT_LENGTH;
	if (normal) {
		const nt_dvec3 n = nt_dvec3_load(normal);
		const double along = nt_dvec3_dot(t, n);
		faults |= along * along > PARALLEL_COSINE_SQUARED * square * nt_dvec3_dot(n, n) ? NT_FAULT_PARALLEL : 0;
	}
	return faults;
}

/* sin^2 of 0.99 degrees: what is less off perpendicular is no finding. If it is less than the worst, too, and that is
 * not noise, the angle itself does not matter. */
static const double NEARLY_ORTHOGONAL = 0.000298, NOISE = 1e-16, SURELY_LESS = 1.0 - 1e-6;

static void check_angle(nt_check *check, tangent_tallies *tt, uint32_t vertex, nt_dvec3 tangent, bool parallel)
{
	if (!check->mesh->normals)
		return;
	nt_dvec3 normal = nt_dvec3_load(check->mesh->normals + 3 * (size_t)vertex);
	const double dot = nt_dvec3_dot(normal, tangent), square = dot * dot;
	const double both = nt_dvec3_dot(normal, normal) * nt_dvec3_dot(tangent, tangent);
	if (tt->worst_square > NOISE && square < tt->worst_square * SURELY_LESS * both &&
		square < NEARLY_ORTHOGONAL * both)
		return;
	if (!nt_dvec3_normalise(&normal))
		return;
	/* degrees from perpendicular */
	const double off = fabs(degrees_between(normal, tangent) - 90.0);
	nt_report_mesh *facts = check->facts;
	if (!(facts->worst_orthogonality >= off)) {
		facts->worst_orthogonality = off;
		tt->worst_square = square / both;
	}
	if (parallel)
		nt_tally_vertex(check, &tt->of[PARALLEL], vertex, off);
	else if (off > ORTHOGONAL_DEGREES)
		nt_tally_vertex(check, &tt->of[NOT_ORTHOGONAL], vertex, off);
}

static void check_tangent(nt_check *check, tangent_tallies *tt, uint32_t vertex, const float *stored)
{
	const float *normals = check->mesh->normals;
	const unsigned faults = nt_tangent_faults(stored, normals ? normals + 3 * (size_t)vertex : NULL);
	if (faults & NT_FAULT_NOT_FINITE) {
		nt_tally_vertex(check, &tt->of[NOT_FINITE], vertex, NAN);
		return;
	}
	if (faults & NT_FAULT_W)
		nt_tally_vertex(check, &tt->of[BAD_W], vertex, stored[3]);
	const nt_dvec3 tangent = nt_dvec3_load(stored);
	const double length = length_of(tangent);
	if (faults & NT_FAULT_ZERO) {
		nt_tally_vertex(check, &tt->of[ZERO], vertex, length);
		return;
	}
	if (faults & NT_FAULT_LENGTH) {
		nt_tally_vertex(check, &tt->of[NON_UNIT], vertex, length);
		if (fabs(length - 1.0) > fabs(tt->worst_length - 1.0))
			tt->worst_length = length;
	}
	check_angle(check, tt, vertex, tangent, faults & NT_FAULT_PARALLEL);
}

static size_t tangent_count(const nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	if (check->stored == NT_STORED_SPLIT)
		return mesh->vertex_count + mesh->split.source_count;
	return check->stored == NT_STORED_CORNERS ? mesh->corner_count : mesh->vertex_count;
}

/* Tangents that no material uses cannot render wrong: infos, but warnings where glTF itself is broken. */
static nt_severity severity_of(const nt_check *check, nt_code code)
{
	const bool broken = code == NT_CODE_TAN_NOT_FINITE || code == NT_CODE_TAN_ZERO ||
		code == NT_CODE_TAN_NON_UNIT || code == NT_CODE_TAN_BAD_W;
	if (!nt_needs_tangents(check))
		return broken ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO;
	return nt_code_info(code)->severity;
}

/* Each tangent once, in the order of corners. */
static nt_status check_each(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const size_t count = tangent_count(check);
	tangent_tallies *tt = nt_scratch_alloc(check->scratch, 1, sizeof *tt);
	uint8_t *met = nt_scratch_alloc(check->scratch, count, 1);
	if (!tt || !met)
		return NT_ERROR_MEMORY;
	memset(met, 0, count);
	*tt = (tangent_tallies){.worst_length = 1.0};
	for (size_t i = 0; i < TANGENT_TALLIES; i++)
		tt->of[i].code = tangent_codes[i];
	for (size_t c = 0; c < 3 * s->triangle_count; c++) {
		const size_t index = nt_tangent_index(check, nt_side_corner(s, c));
		if (met[index])
			continue;
		met[index] = 1;
		check_tangent(check, tt, nt_side_vertex(s, c), nt_stored_tangents(check) + 4 * index);
	}
	nt_tally_number(&tt->of[NON_UNIT], "worst_length", tt->worst_length);
	nt_tally_number(&tt->of[NOT_ORTHOGONAL], "worst_degrees", check->facts->worst_orthogonality);
	for (size_t i = 0; i < NOT_ORTHOGONAL; i++)
		nt_check_report_as(check, &tt->of[i], severity_of(check, tangent_codes[i]), NULL);
	nt_check_report_as(check, &tt->of[NOT_ORTHOGONAL], severity_of(check, NT_CODE_TAN_NOT_ORTHOGONAL),
		"the worst is %.3g degrees off", check->facts->worst_orthogonality);
	return NT_OK;
}

/* ---- signs ---- */

/* For triangles whose w is right: whether T and the bitangent are reversed. If w is wrong, other_w: whether T alone
 * is. */
static bool is_reversed(const nt_check *check, size_t t, bool other_w)
{
	const nt_surface *s = &check->surface;
	nt_tangent_triangle triangle = {.orientation = s->orientation[t], .other_w = other_w};
	if (check->stored != NT_STORED_AUTHORED || !check->mesh->normals)
		return false;
	for (uint32_t k = 0; k < 3; k++) {
		const uint32_t side = (uint32_t)(3 * t) + k;
		triangle.positions[k] = nt_side_position(s, side);
		triangle.normals[k] = check->mesh->normals + 3 * (size_t)nt_side_vertex(s, side);
		triangle.texcoords[k] = nt_side_texcoord(s, side);
		triangle.tangents[k] = nt_stored_tangent(check, nt_side_corner(s, side));
	}
	return nt_is_reversed(&triangle);
}

/* Tallies and sums of a part. */
enum { MIXED, WRONG, OF_QUAD };
static const nt_code sign_codes[] = {NT_CODE_TAN_MIXED_W_TRIANGLE, NT_CODE_TAN_SIGN_MISMATCH, NT_CODE_TAN_QUAD_SIGN};
enum {
	CHECKED,
	BY_W,
	BY_T,     /* of those by w: T is reversed, and the bitangent is right */
	REVERSED,
	UNTRANSFORMED /* wrong, but right without the texture transform */
};

/* Whether w is right for the file's own coordinates, where a texture transform turns them over. */
static bool fits_untransformed(const nt_check *check, size_t t, float w)
{
	const nt_surface *s = &check->surface;
	const float *uv = check->mesh->texcoords;
	if (!check->mesh->solve_texcoords)
		return false;
	const int sign = nt_orientation(uv + 2 * (size_t)nt_side_vertex(s, 3 * t),
		uv + 2 * (size_t)nt_side_vertex(s, 3 * t + 1), uv + 2 * (size_t)nt_side_vertex(s, 3 * t + 2));
	return sign != 0 && (w > 0.0f) == (sign > 0);
}

/* The number that v is added to on its way between formats that count it from opposite ends: see nmtan_stored_uv. */
static float stored_v_offset(const nt_check *check)
{
	const bool from_gltf = nt_format_is_gltf(check->scene->format);
	if (!nt_is_written(check) || from_gltf == nt_is_gltf(check))
		return 0.0f;
	return from_gltf ? 1.0f : -1.0f;
}

/* The orientation that w is judged by: of the coordinates as they are stored, whose rounding turns tiny triangles. */
static int stored_orientation(const nt_check *check, size_t t, float v_offset)
{
	const nt_surface *s = &check->surface;
	const nt_mesh *mesh = check->mesh;
	const bool exact = mesh->solve_texcoords && mesh->solve_sign;
	if (v_offset == 0.0f || (mesh->solve_texcoords && !exact))
		return s->orientation[t];
	float uv[3][2];
	for (uint32_t k = 0; k < 3; k++) {
		const float *source = mesh->texcoords + 2 * (size_t)nt_side_vertex(s, 3 * t + k);
		uv[k][0] = source[0];
		uv[k][1] = source[1] + v_offset;
	}
	return nt_orientation(uv[0], uv[1], uv[2]) * (exact ? mesh->solve_sign : 1);
}

int nt_quad_orientation(const nt_check *check, size_t t)
{
	const nt_surface *s = &check->surface;
	if (!s->faces || !check->mesh->face_sizes)
		return nt_folded_orientation(check->mesh, check->halves, t);
	const size_t first = t > 0 && s->faces[t - 1] == s->faces[t] ? t - 1 : t;
	if (first + 1 >= s->triangle_count || s->faces[first + 1] != s->faces[first])
		return 0;
	const float *uv[2][3];
	for (size_t k = 0; k < 6; k++)
		uv[k / 3][k % 3] = nt_side_texcoord(s, (uint32_t)(3 * first + k));
	return nt_orientation_of_halves(uv);
}

static void check_sign(const nt_check *check, size_t t, int orientation, nt_part *part)
{
	const nt_surface *s = &check->surface;
	float w[3];
	for (size_t k = 0; k < 3; k++)
		w[k] = nt_stored_tangent(check, nt_side_corner(s, 3 * t + k))[3];
	if (!isfinite(w[0] + w[1] + w[2]) || w[0] == 0.0f || w[1] == 0.0f || w[2] == 0.0f)
		return;
	if ((w[0] > 0.0f) != (w[1] > 0.0f) || (w[1] > 0.0f) != (w[2] > 0.0f)) {
		nt_tally_triangle(check, &part->tallies[MIXED], t, NAN);
		return;
	}
	if (orientation == 0)
		return;
	part->sums[CHECKED]++;
	const bool by_w = (w[0] > 0.0f) != (orientation > 0);
	const int quad = by_w ? nt_quad_orientation(check, t) : 0;
	if (quad == NT_FOLDED_EITHER || (quad && (quad > 0) == (w[0] > 0.0f))) {
		nt_tally_triangle(check, &part->tallies[OF_QUAD], t, w[0]);
		return;
	}
	const bool turned = is_reversed(check, t, by_w), reversed = !by_w && turned;
	part->sums[BY_W] += by_w;
	part->sums[BY_T] += by_w && turned;
	part->sums[REVERSED] += reversed;
	part->sums[UNTRANSFORMED] += by_w && fits_untransformed(check, t, w[0]);
	if (by_w || reversed) {
		nt_tally_triangle(check, &part->tallies[WRONG], t, w[0]);
		part->tallies[WRONG].area += nt_triangle_area(s, t);
	}
}

static void check_sign_part(void *context, size_t begin, size_t end, unsigned slot, nt_part *part)
{
	const nt_check *check = context;
	const float v_offset = stored_v_offset(check);
	(void)slot;
	for (size_t t = begin; t < end; t++)
		check_sign(check, t, stored_orientation(check, t, v_offset), part);
}

static nt_status check_signs(nt_check *check)
{
	nt_part all;
	const nt_status status = nt_check_parts(check, check->surface.triangle_count, PART, sign_codes,
		sizeof sign_codes / sizeof *sign_codes, check_sign_part, check, &all);
	if (status)
		return status;
	nt_check_report_as(check, &all.tallies[MIXED], severity_of(check, NT_CODE_TAN_MIXED_W_TRIANGLE), NULL);
	nt_check_report(check, &all.tallies[OF_QUAD], NULL);
	nt_tally *wrong = &all.tallies[WRONG];
	const double *sums = all.sums, count = (double)wrong->count;
	const double share = sums[CHECKED] > 0.0 ? count / sums[CHECKED] : 0.0;
	nt_tally_number(wrong, "share", share);
	nt_tally_number(wrong, "judged_triangles", sums[CHECKED]);
	nt_tally_number(wrong, "wrong_w", sums[BY_W]);
	nt_tally_number(wrong, "reversed_tangents", sums[REVERSED] + sums[BY_T]);
	nt_tally_number(wrong, "right_without_transform", sums[UNTRANSFORMED]);
	/* Exporters disagree about texture transforms, and so do renderers: not an error. One that turns the texture by
	 * more than a quarter reverses T and the bitangent, but leaves w. */
	const nt_maker *maker = &check->facts->maker;
	const bool untransformed = (sums[UNTRANSFORMED] > 0.0 && sums[UNTRANSFORMED] == count) ||
		(maker->untransformed && !maker->inverted);
	const bool slivers = share <= SLIVER_SHARE && wrong->area <= SLIVER_SHARE * check->total_area;
	const bool judged = check->stored == NT_STORED_AUTHORED;
	if ((judged || check->mesh->keeps_inverted) && check->mesh->pair)
		return NT_OK; /* the map cancels it: TAN_GREEN_PAIR */
	const nt_doubt doubt = judged ? check->mesh->doubt : NT_DOUBT_NONE;
	wrong->repair = doubt == NT_DOUBT_UNDECODABLE ? "--existing=replace" : NULL;
	nt_check_report_as(check, wrong,
		severity_of(check, untransformed || slivers ? NT_CODE_TAN_MIXED_W_TRIANGLE : NT_CODE_TAN_SIGN_MISMATCH),
		"%.3g %% of %.0f%s%s", 100.0 * share, sums[CHECKED],
		untransformed ? untransformed_text
		: 2.0 * sums[BY_T] > count ? ", T is reversed with w: red is inverted, not green"
		: sums[BY_W] == sums[CHECKED] ? ", the convention is inverted"
		: sums[BY_W] == 0.0 ? ", the tangents are reversed too"
				    : "",
		nt_doubt_text(doubt));
	return NT_OK;
}

/* ---- directions ---- */

typedef struct direction_work {
	const nt_check *check;
	const float *fresh;
	const uint64_t *without; /* bits: corners that are not looked at; NULL: none */
} direction_work;

/* tan^2 of 0.99 degrees: less is in the first bin for certain. */
static const double SAME_DIRECTION = 0.0002986;

/* Sums are the histogram. */
static void check_direction(const direction_work *work, size_t c, nt_part *part)
{
	const nt_check *check = work->check;
	const uint32_t corner = nt_side_corner(&check->surface, c);
	nt_dvec3 stored = nt_dvec3_load(nt_stored_tangent(check, corner));
	const nt_dvec3 fresh = nt_dvec3_load(work->fresh + 4 * (size_t)corner);
	const nt_dvec3 cross = nt_dvec3_cross(stored, fresh);
	const double dot = nt_dvec3_dot(stored, fresh);
	if (dot > 0.0 && nt_dvec3_dot(cross, cross) < SAME_DIRECTION * dot * dot) {
		part->sums[0]++;
		return;
	}
	if (!nt_dvec3_normalise(&stored))
		return;
	const double angle = degrees_between(stored, fresh);
	int bin = 0;
	while (bin + 1 < NT_ANGLE_BINS && angle > nt_angle_bins[bin])
		bin++;
	part->sums[bin]++;
	if (angle > MISMATCH_DEGREES)
		nt_tally_vertex(check, &part->tallies[0], nt_side_vertex(&check->surface, c), angle);
	part->greatest[0] = fmax(part->greatest[0], angle);
}

static void check_direction_part(void *context, size_t begin, size_t end, unsigned slot, nt_part *part)
{
	const direction_work *work = context;
	const nt_surface *s = &work->check->surface;
	(void)slot;
	for (size_t t = begin; t < end; t++)
		for (size_t c = 3 * t; c < 3 * t + 3 && s->orientation[t] && s->flatness[t] == NT_SOUND; c++)
			if (!work->without || !nt_bit(work->without, nt_side_corner(s, c)))
				check_direction(work, c, part);
}

static nt_status check_directions(nt_check *check, const float *fresh, const uint64_t *without)
{
	direction_work work = {check, fresh, without};
	nt_part all;
	const nt_status status = nt_check_parts(check, check->surface.triangle_count, PART,
		&(const nt_code){NT_CODE_TAN_DIRECTION_MISMATCH}, 1, check_direction_part, &work, &all);
	if (status)
		return status;
	nt_tally *wrong = &all.tallies[0];
	double checked = 0.0;
	for (int bin = 0; bin < NT_ANGLE_BINS; bin++) {
		check->facts->angle_histogram[bin] = (size_t)all.sums[bin];
		checked += all.sums[bin];
	}
	const double share = checked > 0.0 ? (double)wrong->count / checked : 0.0;
	nt_tally_number(wrong, "share", share);
	nt_tally_number(wrong, "worst_degrees", all.greatest[0]);
	nt_check_report_as(check, wrong,
		share > MISMATCH_SHARE ? severity_of(check, wrong->code) : NT_SEVERITY_INFO,
		"%.3g %% of the corners, the worst by %.4g degrees%s", 100.0 * share, all.greatest[0],
		check->facts->maker.untransformed ? untransformed_text : "");
	return NT_OK;
}

/* fresh: what find_maker() left there. Solves again unless that is MikkTSpace on the same faces. */
static nt_status compare_with_fresh(nt_check *check, float *fresh)
{
	const nt_mesh *mesh = check->mesh;
	const nt_maker *maker = &check->facts->maker;
	const bool solved = maker->last && maker->method == NMTAN_METHOD_MIKKTSPACE && !maker->untransformed &&
		maker->quads == (check->halves != NULL);
	nt_maker mikktspace = {.quads = check->halves != NULL};
	nt_status status = NT_OK;
	/* --across=mesh: as the mesh is solved with the others of its join */
	if (mesh->plan.join && mesh->corner_tangents && mesh->decision != NT_DECISION_REPAIR)
		return check_directions(check, mesh->corner_tangents, NULL);
	if (!solved)
		status = nt_maker_compare(mesh, check->halves, NULL, nt_thread_count(check->options->threads), fresh,
			&mikktspace);
	return status ? status : check_directions(check, fresh, check->elsewhere);
}

/* ---- who made them ---- */

static nt_status report_maker(nt_check *check)
{
	const nt_maker *maker = &check->facts->maker;
	nt_tally tally = {.code = NT_CODE_TAN_MADE_BY, .count = 1, .box = check->facts->box, .share = 1.0};
	nt_buffer text = {0};
	nt_maker_text(maker, &text);
	if (!text.failed)
		nt_check_report(check, &tally, "%s", text.data);
	const bool failed = text.failed;
	nt_buffer_free(&text);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

/* Whether pairs of triangles are to be looked for, of which it is not known yet whether they were solved as quads. */
static bool looks_for_quads(const nt_check *check)
{
	return !check->mesh->halves && check->options->quads == NT_QUADS_AUTO && !check->mesh->face_sizes;
}

/* Finds the maker, and the faces that the mesh is to be compared on. `pairs`: room for halves, if these are looked for;
 * later checks ask for them. */
static nt_status find_maker(nt_check *check, uint8_t *pairs, float *fresh)
{
	const nt_mesh *mesh = check->mesh;
	uint8_t *halves = pairs ? pairs : mesh->halves;
	const size_t quads = pairs ? nt_pair_quads(mesh, false, pairs) : mesh->quad_count;
	uint64_t *border = NULL;
	nt_status status = NT_OK;
	if (mesh->has_siblings) {
		border = nt_scratch_alloc(check->scratch, nt_bit_words(mesh->corner_count), sizeof *border);
		status = border ? nt_maker_border(mesh, border) : NT_ERROR_MEMORY;
	}
	if (!status)
		status = nt_find_maker(mesh, quads ? halves : NULL, border, nt_thread_count(check->options->threads),
			fresh, &check->facts->maker);
	if (status)
		return status;
	check->elsewhere = check->facts->maker.across ? border : NULL;
	check->halves = mesh->halves || (check->facts->maker.known && check->facts->maker.quads) ? halves : NULL;
	return check->facts->maker.known && !nt_maker_is_mikktspace(&check->facts->maker) ? report_maker(check) : NT_OK;
}

/* ---- tangents that are there for nothing, or are not there ---- */

static void check_presence(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	const bool present = check->facts->checked_tangents;
	if (!nt_is_gltf(check))
		return;
	if (present && mesh->slots == 0) {
		const nt_tally unused = {
			.code = NT_CODE_TAN_UNUSED, .count = 1, .box = check->facts->box, .share = 1.0};
		nt_check_report(check, &unused, NULL);
	}
	if (check->stored == NT_STORED_AUTHORED && mesh->slots != 0 && mesh->targets_without_tangents) {
		const nt_tally morphs = {.code = NT_CODE_TAN_MORPH_MISSING,
			.count = mesh->targets_without_tangents, .box = check->facts->box, .share = 1.0};
		nt_check_report(check, &morphs, NULL);
	}
	/* TAN_NO_UV says that nobody can make them, TAN_ACCESSOR that nobody can read them */
	if (!present && mesh->slots != 0 && mesh->reachable && mesh->texcoords && !mesh->tangents_fault) {
		const nt_tally missing = {.code = NT_CODE_TAN_MISSING_REQUIRED, .count = 1,
			.box = check->facts->box, .share = 1.0};
		const bool client_may_make = mesh->slots & NT_SLOT_NORMAL;
		nt_check_report_as(check, &missing,
			client_may_make ? NT_SEVERITY_INFO : NT_SEVERITY_ERROR, "%s",
			client_may_make ? "which clients make from the normal texture's coordinates"
					: "which the material needs and no client can make without a normal texture");
	}
}

nt_status nt_check_tangents(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	const bool compared = check->facts->checked_tangents && check->stored == NT_STORED_AUTHORED &&
			      mesh->texcoords && mesh->normals;
	uint8_t *pairs = NULL;
	if (compared && looks_for_quads(check) && !(pairs = nt_scratch_alloc(check->scratch, mesh->face_count, 1)))
		return NT_ERROR_MEMORY;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	float *fresh = compared ? nt_scratch_alloc(check->scratch, mesh->corner_count, 4 * sizeof *fresh) : NULL;
	nt_status status = compared && !fresh ? NT_ERROR_MEMORY : NT_OK;
	check_presence(check);
	check->halves = mesh->halves;
	if (!status && check->facts->checked_tangents) {
		status = check_each(check);
		if (!status && compared)
			status = find_maker(check, pairs, fresh);
		if (!status && mesh->texcoords)
			status = check_signs(check);
		if (!status && compared)
			status = compare_with_fresh(check, fresh);
	}
	nt_scratch_back(check->scratch, mark);
	return status;
}
