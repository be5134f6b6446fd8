/* SPDX-License-Identifier: MIT */
/*
 * Stored tangents, normals and degenerate triangles: each code on the smallest mesh that shows it, and what
 * options do to findings.
 */
#include "hand_mesh.h"
#include "report/report.h"

#include <math.h>

/* An upright unit quad in the xy plane: u along x, v along y, T = (1,0,0), w = 1 is right. glTF, so that
 * slots matter. */
static hand_mesh *sound_quad(void)
{
	hand_mesh *h = hand_new();
	h->scene.format = NT_FORMAT_GLTF;
	h->mesh.slots = NT_SLOT_NORMAL;
	hand_vertex(h, 0, 0, 0, 0, 0);
	hand_vertex(h, 1, 0, 0, 1, 0);
	hand_vertex(h, 1, 1, 0, 1, 1);
	hand_vertex(h, 0, 1, 0, 0, 1);
	hand_quad(h, 0, 1, 2, 3);
	hand_give_tangents(h);
	return h;
}

static void set_tangent(hand_mesh *h, size_t vertex, float x, float y, float z, float w)
{
	memcpy(h->tangents[vertex], (float[4]){x, y, z, w}, sizeof h->tangents[vertex]);
}

TEST(sound_tangents_give_no_findings)
{
	hand_mesh *h = sound_quad();
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->finding_count, 0);
	assert_true(report->meshes[0].worst_orthogonality < 1e-6);
	assert_int_equal(report->meshes[0].angle_histogram[0], 6);
	nt_severity worst;
	assert_false(nt_report_worst(report, &worst));
	hand_free(h, report);
}

/* If dP/dv is 20 degrees from dP/du, a T that averaging turned by 60 degrees has a bitangent that is 130 degrees
 * from dP/dv, and yet is not reversed. */
TEST(tangents_of_sheared_coordinates_are_not_reversed)
{
	hand_mesh *h = sound_quad();
	for (size_t v = 0; v < 4; v++) {
		h->texcoords[v][0] -= h->texcoords[v][1] * 2.7474774f; /* cot 20 degrees */
		set_tangent(h, v, 0.5f, 0.8660254f, 0, 1);
	}
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_TAN_SIGN_MISMATCH), 0);
	hand_free(h, report);
}

TEST(unused_tangents_are_told_and_cannot_be_errors)
{
	hand_mesh *h = sound_quad();
	h->mesh.slots = 0;
	for (size_t v = 0; v < 4; v++)
		h->tangents[v][3] = -1.0f;
	nt_report *report = hand_report(h, NULL);
	hand_finding(report, NT_CODE_TAN_UNUSED);
	assert_int_equal(hand_finding(report, NT_CODE_TAN_SIGN_MISMATCH)->severity, NT_SEVERITY_INFO);
	assert_true(hand_finding(report, NT_CODE_TAN_SIGN_MISMATCH)->numbers[0].value == 1.0); /* all */
	hand_free(h, report);
}

/* A fault of vertex 1, which has one corner, or of several. */
TEST(each_kind_of_bad_tangent_has_its_code)
{
	const struct {
		float t[4];
		size_t first, last; /* vertices */
		nt_code code;
		nt_severity severity;
		size_t count, findings, turned; /* of all codes; corners by the last bin of angles */
		const char *says;
	} cases[] = {
		{{0, 0, 0, 1}, 1, 1, NT_CODE_TAN_ZERO, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{NAN, 0, 0, 1}, 1, 1, NT_CODE_TAN_NOT_FINITE, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{1, 0, 0, INFINITY}, 1, 1, NT_CODE_TAN_NOT_FINITE, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{2, 0, 0, 1}, 1, 1, NT_CODE_TAN_NON_UNIT, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{1.007f, 0, 0, 1}, 1, 1, NT_CODE_TAN_NON_UNIT, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{1, 0, 0, 0}, 1, 1, NT_CODE_TAN_BAD_W, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{1, 0, 0, 0.5f}, 1, 1, NT_CODE_TAN_BAD_W, NT_SEVERITY_ERROR, 1, 1, 0, ""},
		{{0, 0, 1, 1}, 1, 1, NT_CODE_TAN_PARALLEL_NORMAL, NT_SEVERITY_ERROR, 1, 2, 1, ""},
		{{0, 0, -1, 1}, 1, 1, NT_CODE_TAN_PARALLEL_NORMAL, NT_SEVERITY_ERROR, 1, 2, 1, ""},
		{{0.8f, 0, 0.6f, 1}, 1, 1, NT_CODE_TAN_NOT_ORTHOGONAL, NT_SEVERITY_WARNING, 1, 2, 0, ""},
		{{0, 1, 0, 1}, 1, 1, NT_CODE_TAN_DIRECTION_MISMATCH, NT_SEVERITY_WARNING, 1, 1, 1, ""},
		{{0, 1, 0, 1}, 0, 3, NT_CODE_TAN_DIRECTION_MISMATCH, NT_SEVERITY_WARNING, 6, 1, 6, ""},
		/* of three corners, in two triangles */
		{{1, 0, 0, -1}, 0, 1, NT_CODE_TAN_MIXED_W_TRIANGLE, NT_SEVERITY_WARNING, 2, 1, 0, ""},
		{{1, 0, 0, -1}, 0, 3, NT_CODE_TAN_SIGN_MISMATCH, NT_SEVERITY_ERROR, 2, 1, 0,
			"100 % of 2, the convention is inverted"},
		{{-1, 0, 0, 1}, 0, 3, NT_CODE_TAN_SIGN_MISMATCH, NT_SEVERITY_ERROR, 2, 2, 6,
			"100 % of 2, the tangents are reversed too"},
		{{-1, 0, 0, -1}, 0, 3, NT_CODE_TAN_SIGN_MISMATCH, NT_SEVERITY_ERROR, 2, 2, 6,
			"100 % of 2, T is reversed with w: red is inverted, not green"},
		{{1.0067f, 0, 0, 1}, 1, 1, NT_CODE_COUNT, 0, 0, 0, 0, ""}, /* within the validator's tolerance */
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		hand_mesh *h = sound_quad();
		for (size_t v = cases[i].first; v <= cases[i].last; v++)
			memcpy(h->tangents[v], cases[i].t, sizeof cases[i].t);
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(report->finding_count, cases[i].findings);
		if (cases[i].findings) {
			const nt_report_finding *finding = hand_finding(report, cases[i].code);
			assert_int_equal(finding->count, cases[i].count);
			assert_int_equal(finding->severity, cases[i].severity);
			assert_int_equal(finding->spots[0].vertices[0], cases[i].first);
			assert_non_null(strstr(finding->message, cases[i].says));
			assert_int_equal(report->meshes[0].angle_histogram[5], cases[i].turned);
		}
		hand_free(h, report);
	}
}

TEST(morph_targets_without_tangents_are_told)
{
	hand_mesh *h = sound_quad();
	h->mesh.targets_without_tangents = 2;
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_finding(report, NT_CODE_TAN_MORPH_MISSING)->count, 2);
	hand_free(h, report);
}

/* A texture transform that turns u over: what is mirrored is checked as it is looked up, what is shown are the
 * file's own coordinates. */
TEST(texture_transform_that_mirrors_counts)
{
	hand_mesh *h = sound_quad();
	float solved[4][2];
	for (size_t v = 0; v < 4; v++) {
		solved[v][0] = -h->texcoords[v][0];
		solved[v][1] = h->texcoords[v][1];
	}
	h->mesh.solve_texcoords = solved[0];
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].triangles[0], 2);
	const nt_report_finding *sign = hand_finding(report, NT_CODE_TAN_SIGN_MISMATCH);
	assert_int_equal(sign->count, 2);
	assert_int_equal(sign->severity, NT_SEVERITY_WARNING); /* right for the coordinates as stored */
	assert_non_null(strstr(sign->message, "without the texture transform, as Blender's exporter"));
	assert_true(report->meshes[0].islands[0].maximum[0] == 1.0f);
	hand_free(h, report);
}

TEST(degenerate_triangles_are_counted_and_weighed)
{
	hand_mesh *h = sound_quad();
	/* no UV area, half the area of the sound quad, so a third of all; one corner is the quad's */
	hand_vertex(h, 2, 1, 0, 2, 1);
	hand_vertex(h, 1, 2, 0, 5, 1);
	hand_triangle(h, 2, 4, 5);
	/* two corners at one position */
	hand_triangle(h, 0, 1, hand_vertex(h, 1, 0, 0, 1, 1));
	/* three on a line */
	hand_vertex(h, 0, 5, 0, 0, 0);
	hand_vertex(h, 1, 5, 0, 1, 0);
	hand_vertex(h, 2, 5, 0, 0, 1);
	hand_triangle(h, 7, 8, 9);
	nt_report *report = hand_report(h, NULL);
	const nt_report_finding *uv = hand_finding(report, NT_CODE_UV_DEGENERATE_TRIANGLE);
	assert_int_equal(uv->count, 1);
	assert_int_equal(uv->severity, NT_SEVERITY_WARNING);
	assert_true(fabs(uv->numbers[0].value - 1.0 / 3.0) < 1e-12);
	assert_true(uv->numbers[1].value == 1.0 && uv->numbers[2].value == 2.0);
	const nt_report_finding *flat = hand_finding(report, NT_CODE_POS_DEGENERATE_TRIANGLE);
	assert_int_equal(flat->count, 2);
	assert_true(flat->numbers[0].value == 1.0 && flat->numbers[1].value == 1.0);
	hand_free(h, report);
}

/* T runs along the lines of equal v. With v near 1000, which rounding may have changed by 2^-15, it may turn by
 * 2 * 2^-15 / h: 1.25 degrees if the triangle is 0.0028 high, 0.80 if it is 0.0044; of 2^-14 the sign is uncertain. An
 * error of u turns nothing. */
TEST(nearly_collinear_coordinates_far_from_the_origin)
{
	static const struct {
		float u, v, height;
		double degrees; /* 0: it is no finding; infinite: any */
		double steps;   /* of 2^-14, that the height has there: the sine is 1 / 46 in the second row */
	} rows[] = {{0, 1000, 0.00006f, INFINITY, 1}, {0, 1000, 0.0028f, 1.2457, 46}, {0, 1000, 0.0044f, 0, 0},
		{1000, 0, 0.0001f, 0, 0}, {1000, 0, 0.09f, 0, 0}};
	for (size_t n = 0; n < 3 * sizeof rows / sizeof *rows; n++) {
		const size_t i = n / 3, first = n % 3; /* whichever corner comes first */
		hand_mesh *h = hand_new();
		hand_vertex(h, 0, 0, 0, rows[i].u, rows[i].v);
		hand_vertex(h, 1, 0, 0, rows[i].u + 1, rows[i].v);
		hand_vertex(h, 0, 1, 0, rows[i].u, rows[i].v + rows[i].height);
		hand_triangle(h, (uint32_t)first, (uint32_t)(first + 1) % 3, (uint32_t)(first + 2) % 3);
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_NEAR_DEGENERATE), rows[i].degrees > 0);
		if (rows[i].degrees > 0) {
			const nt_number *numbers = hand_finding(report, NT_CODE_UV_NEAR_DEGENERATE)->numbers;
			const double height = rows[i].steps * 0x1p-14;
			assert_string_equal(numbers[1].name, "least_relative_determinant");
			assert_true(fabs(numbers[1].value - height / hypot(1, height)) < 1e-9);
			assert_string_equal(numbers[2].name, "greatest_error_degrees");
			assert_true(isinf(rows[i].degrees) ? isnan(numbers[2].value)
				: fabs(numbers[2].value - rows[i].degrees) < 1e-4);
		}
		hand_free(h, report);
	}
}

/* A right triangle in space beside a square, which is mapped well. Rounding may turn the tangent by the angle whose
 * sine is 2 / n if the triangle is n / 2^25 high in v. */
TEST(triangles_with_next_to_no_area_are_told_by_what_is_wrong_with_them)
{
#define DECIDED(kind) "nearly " kind " coordinates, 33.3 % of the area; rounding decides the tangent"
	static const struct {
		float uv[3][2];
		float height, side;  /* in space: of the triangle and of the square */
		const char *message; /* NULL: none */
	} rows[] = {
		{{{0, 0.25f}, {1, 0.25f}, {0.5f, 0.25f + 0x1p-25f}}, 1, 1, DECIDED("collinear")},
		{{{0, 0.5f}, {1, 0.5f}, {0.5f, 0.5f + 0x1p-18f}}, 1, 1, NULL}, /* by 0.9 degrees */
		{{{0, 0.25f}, {1, 0.25f}, {1, 0.25f + 0x1p-25f}}, 1, 1, DECIDED("coincident")},
		{{{0.5f, 0.5f}, {0.5f + 0x1p-20f, 0.5f}, {0.5f, 0.5f + 0x1p-20f}}, 1, 1,
			"nearly coincident coordinates, 33.3 % of the area; rounding turns tangents by up to 3.6 "
			"degrees"},
		/* as thin in space; wider, but rounding would decide if it were mapped so; where nobody sees it */
		{{{0, 0.25f}, {1, 0.25f}, {0.5f, 0.25f + 0x1p-25f}}, 0x1p-25f, 0, NULL},
		{{{0, 0.25f}, {1, 0.25f}, {0.5f, 0.25f + 0x1p-25f}}, 0x1p-20f, 0, NULL},
		{{{0, 0.25f}, {1, 0.25f}, {0.5f, 0.25f + 0x1p-25f}}, 1, 1000, NULL},
	};
#undef DECIDED
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		hand_mesh *h = hand_new();
		for (uint32_t k = 0; k < 3; k++)
			hand_vertex(h, k == 1, k == 2 ? rows[i].height : 0, 0, rows[i].uv[k][0], rows[i].uv[k][1]);
		hand_triangle(h, 0, 1, 2);
		for (uint32_t k = 0; k < 4; k++)
			hand_vertex(h, 5 + rows[i].side * (float)(k % 2), rows[i].side * (float)(k / 2), 0,
				(float)(k % 2), (float)(k / 2));
		hand_quad(h, 3, 4, 6, 5);
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_NEAR_DEGENERATE), rows[i].message != NULL);
		if (rows[i].message)
			assert_non_null(strstr(hand_finding(report, NT_CODE_UV_NEAR_DEGENERATE)->message,
				rows[i].message));
		hand_free(h, report);
	}
}

/* Positions and texture coordinates of three corners at one place: POS_DEGENERATE_TRIANGLE says it. */
TEST(a_triangle_without_area_in_space_needs_none_in_uv_space)
{
	hand_mesh *h = sound_quad();
	hand_triangle(h, 0, 0, 1);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_UV_DEGENERATE_TRIANGLE), 0);
	assert_int_equal(hand_finding(report, NT_CODE_POS_DEGENERATE_TRIANGLE)->count, 1);
	hand_free(h, report);
}

TEST(what_is_wrong_with_several_is_counted)
{
	static const float uv[][2] = {{0, 0.25f}, {1, 0.25f}, {0.5f, 0.25f + 0x1p-25f}, {1, 0.25f + 0x1p-25f},
		{0.5f, 0.5f}, {0.5f + 0x1p-20f, 0.5f}, {0.5f, 0.5f + 0x1p-20f}};
	static const float xy[][2] = {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {5, 0}, {6, 0}, {5, 1}};
	hand_mesh *h = hand_new();
	for (uint32_t v = 0; v < sizeof uv / sizeof *uv; v++)
		hand_vertex(h, xy[v][0], xy[v][1], 0, uv[v][0], uv[v][1]);
	hand_triangle(h, 0, 1, 2);
	hand_triangle(h, 0, 1, 3);
	hand_triangle(h, 4, 5, 6);
	nt_report *report = hand_report(h, NULL);
	const nt_report_finding *found = hand_finding(report, NT_CODE_UV_NEAR_DEGENERATE);
	assert_string_equal(found->message, "3 triangles have next to no area in UV space: nearly collinear (1) or "
		"coincident (2) coordinates, 100 % of the area; rounding decides the tangents of 2 and turns others "
		"by up to 3.6 degrees");
	assert_string_equal(found->numbers[3].name, "coincident_corners");
	assert_true(found->numbers[3].value == 2);
	assert_string_equal(found->numbers[4].name, "undecided_tangents");
	assert_true(found->numbers[4].value == 2);
	hand_free(h, report);
}

/* Right triangles but one with an angle of 30 degrees: the relative determinant is the sine of the angle. */
TEST(relative_determinants_are_sines)
{
	hand_mesh *h = sound_quad();
	hand_vertex(h, 5, 0, 0, 0, 0);
	hand_vertex(h, 6, 0, 0, 1, 0);
	hand_vertex(h, 5, 1, 0, 0.8660254f, 0.5f);
	hand_triangle(h, 4, 5, 6);
	nt_report *report = hand_report(h, NULL);
	const double *d = report->meshes[0].relative_determinant;
	/* the quad's halves: corner 0 at (0,0) between (1,0) and (1,1), and between (1,1) and (0,1): sin 45 */
	assert_true(fabs(d[0] - 0.5) < 1e-6);
	assert_true(fabs(d[1] - sqrt(0.5)) < 1e-6);
	assert_true(fabs(d[2] - sqrt(0.5)) < 1e-6);
	hand_free(h, report);
}

TEST(normals_are_checked)
{
	hand_mesh *h = sound_quad();
	h->mesh.tangents = NULL;
	h->normals[0][2] = 2.0f;
	h->normals[1][2] = 0.0f;
	h->normals[3][2] = -1.0f; /* triangle 1: 2 + 1 - 1 > 0 */
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_finding(report, NT_CODE_MESH_NORMAL_NON_UNIT)->count, 1);
	assert_int_equal(hand_finding(report, NT_CODE_MESH_NORMAL_ZERO)->count, 1);
	assert_int_equal(hand_findings(report, NT_CODE_MESH_NORMAL_AGAINST_FACE), 0);
	nt_report_free(report);
	h->normals[0][2] = h->normals[2][2] = -1.0f; /* triangle 1: all three; triangle 0: two, and one in front */
	h->normals[1][2] = 1.0f;
	report = hand_report(h, NULL);
	assert_int_equal(hand_finding(report, NT_CODE_MESH_NORMAL_AGAINST_FACE)->count, 1);
	hand_free(h, report);
}

TEST(values_that_are_not_finite_are_told_and_harmless)
{
	hand_mesh *h = sound_quad();
	h->positions[1][0] = NAN;
	h->texcoords[2][1] = INFINITY;
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_finding(report, NT_CODE_POS_NOT_FINITE)->count, 1);
	assert_int_equal(hand_finding(report, NT_CODE_UV_NOT_FINITE)->count, 1);
	hand_free(h, report);
}

/* Lone mirrored triangles of area 1/2, 2 and 9/2, one without an area in UV space, of 1/2, and one that is not
 * mirrored. */
TEST(what_concerns_most_comes_first_and_no_code_hides_another)
{
	static const uint32_t largest_first[3] = {2, 1, 0};
	hand_mesh *h = hand_new();
	h->mesh.wrap[0] = h->mesh.wrap[1] = NT_WRAP_CLAMP;
	for (uint32_t i = 0; i < 5; i++) {
		const float size = i < 3 ? (float)i + 1 : 1, x = 10 * (float)i;
		hand_vertex(h, x, 0, 0, x, 0);
		hand_vertex(h, x + size, 0, 0, i == 3 ? x : i < 3 ? x - size : x + 0.01f, 0);
		hand_vertex(h, x, size, 0, x, i < 4 ? size : 0.01f);
		hand_triangle(h, 3 * i, 3 * i + 1, 3 * i + 2);
	}
	nt_report_options options = {.severity[NT_CODE_UV_DEGENERATE_TRIANGLE] = 1 + NT_SEVERITY_INFO};
	nt_report *report = hand_report(h, &options);
	assert_int_equal(report->finding_count, 4);
	for (size_t i = 0; i < 3; i++) {
		assert_int_equal(report->findings[i].code, NT_CODE_UV_MIRROR_LONE);
		assert_int_equal(report->findings[i].island, largest_first[i]);
	}
	for (options.max_findings = 1; options.max_findings < 4; options.max_findings++) {
		nt_report_free(report);
		report = hand_report(h, &options);
		assert_int_equal(report->finding_count, options.max_findings);
		assert_int_equal(report->dropped, 4 - options.max_findings);
		const bool both = options.max_findings > 1;
		assert_int_equal(report->dropped_by_code[NT_CODE_UV_DEGENERATE_TRIANGLE], !both);
		assert_int_equal(report->dropped_by_code[NT_CODE_UV_MIRROR_LONE], both ? report->dropped : 2);
	}
	nt_report_free(report);
	options.min_severity = NT_SEVERITY_WARNING;
	report = hand_report(h, &options);
	assert_int_equal(report->finding_count + report->by_severity[NT_SEVERITY_INFO], 0);
	hand_free(h, report);
}

/* A baseline of one finding of a file. */
static nt_baseline baseline_with(const char *file, const nt_report_finding *finding)
{
	nt_baseline baseline;
	nt_error error;
	char text[256];
	snprintf(text, sizeof text,
		"{\"report\":\"nmtan\",\"files\":[{\"file\":\"%s\",\"findings\":"
		"[{\"fingerprint\":\"%016llx\",\"geometry\":\"%016llx\"}]}]}",
		file, (unsigned long long)finding->fingerprint, (unsigned long long)finding->geometry);
	assert_int_equal(nt_baseline_read(&baseline, text, strlen(text), &error), NT_OK);
	return baseline;
}

/* v that points the other way mirrors all of a mesh: one finding, not one for each island. */
TEST(islands_that_are_all_mirrored_are_one_finding)
{
	hand_mesh *h = hand_new();
	for (uint32_t i = 0; i < 29; i++) {
		const float x = 10 * (float)i;
		hand_vertex(h, x, 0, 0, x, 0);
		hand_vertex(h, x + 1, 0, 0, x - 1, 0);
		hand_vertex(h, x, 1, 0, x, 1);
		hand_triangle(h, 3 * i, 3 * i + 1, 3 * i + 2);
	}
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_LONE), 1);
	assert_string_equal(hand_finding(report, NT_CODE_UV_MIRROR_LONE)->message,
		"each of all 29 islands (29 triangles) is mirrored and shares no texels with an unmirrored one");
	hand_free(h, report);
}

/* Two lone mirrored islands at one place have one fingerprint; a baseline with it once knows one of them. Another one
 * is not mirrored. */
TEST(baseline_entries_count_once_each)
{
	hand_mesh *h = hand_new();
	for (uint32_t i = 0; i < 2; i++) {
		hand_vertex(h, 0, 0, 0, 1 + 2 * (float)i, 0);
		hand_vertex(h, 1, 0, 0, 2 * (float)i, 0);
		hand_vertex(h, 0, 1, 0, 1 + 2 * (float)i, 1);
		hand_triangle(h, 3 * i, 3 * i + 1, 3 * i + 2);
	}
	for (uint32_t k = 0; k < 3; k++)
		hand_vertex(h, 5 + (k == 1), k == 2, 0, 0.01f * (k == 1), 0.01f * (k == 2));
	hand_triangle(h, 6, 7, 8);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_LONE), 2);
	size_t lone = 0;
	while (report->findings[lone].code != NT_CODE_UV_MIRROR_LONE)
		lone++;
	nt_baseline baseline = baseline_with("hand.ply", &report->findings[lone]);
	nt_report_free(report);
	const nt_report_options options = {.baseline = &baseline};
	report = hand_report(h, &options);
	assert_int_equal(report->known[NT_SEVERITY_INFO], 1);
	nt_baseline_free(&baseline);
	hand_free(h, report);
}

/* Another name of the mesh is no other finding, nor is another name of the file. */
TEST(baseline_knows_geometry_where_names_have_changed)
{
	static const struct {
		const char *file;
		float moved;
		size_t known;
	} rows[] = {{"hand.ply", 0, 1}, {"hand.ply", 1, 0}, {"old.ply", 0, 1}, {"old.ply", 1, 0}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		hand_mesh *h = sound_quad();
		set_tangent(h, 1, 0, 0, 0, 1);
		nt_report *report = hand_report(h, NULL);
		nt_baseline baseline = baseline_with(rows[i].file, hand_finding(report, NT_CODE_TAN_ZERO));
		nt_report_free(report);
		h->mesh.name = "Head.001";
		h->positions[1][0] += rows[i].moved;
		const nt_report_options options = {.baseline = &baseline};
		report = hand_report(h, &options);
		assert_int_equal(report->known[NT_SEVERITY_ERROR], rows[i].known);
		nt_baseline_free(&baseline);
		hand_free(h, report);
	}
}
