/* SPDX-License-Identifier: MIT */
/*
 * Folded quads and normals that are not of unit length in a whole run: what is counted, that raw tangents are the
 * definition's on what is written, and that every failed allocation ends it with a status and nothing else. More of
 * what is written is tests/cli/test_frames.sh's.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include "api/tangents.h"

/* A folded quad (tests/cli/test_frames.sh derives its halves), and a triangle with a normal of length .5, a zero one
 * and none. */
static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 2 1 0\n"
	"vt 0 0\nvt 1 0\nvt 1 1\nvt 1.25 .5\nvn 0 0 1\nvn 0 0 .5\nvn 0 0 0\n"
	"f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/1/2 6/2/3 7/3\n";

static const nt_settings settings = {.io.texcoord_set = -1, .dry_run = true, .io.threads = 1,
	.output_format = NT_FORMAT_GLB};

TEST(odd_normals_and_folded_quads_are_counted)
{
	put_text_file("in.obj", text);
	nt_summary summary = convert_file("in.obj", "out.glb", settings);
	assert_int_equal(summary.triangle_count, 3);
	assert_int_equal(summary.counts.folded_quads, 1);
	assert_int_equal(summary.counts.repaired_sign, 3); /* the smaller half */
	assert_int_equal(count_findings(&summary, NT_CODE_NORMALS_SCALED), 1);
	assert_int_equal(count_findings(&summary, NT_CODE_NORMALS_MADE), 2);
	nt_summary_free(&summary);
}

/* Our PLY writer's output for a mesh with all attributes and tangents. */
enum { ROW_FLOATS = 12, SIDE = 12, POINTS = (SIDE + 1) * (SIDE + 1), QUADS = SIDE * SIDE, CORNERS = 4 * QUADS };

typedef struct written {
	size_t vertex_count;
	float rows[CORNERS][ROW_FLOATS]; /* position, normal, texture coordinates, tangent */
	uint32_t indices[CORNERS];
	uint8_t sizes[QUADS];
} written;

static void read_written(const char *name, written *w)
{
	static char bytes[1 << 17];
	FILE *file = fopen(in_folder(name), "rb");
	assert_non_null(file);
	assert_in_range(fread(bytes, 1, sizeof bytes, file), 1, sizeof bytes - 1);
	fclose(file);
	const char *body = strstr(bytes, "end_header\n") + strlen("end_header\n");
	assert_int_equal(sscanf(strstr(bytes, "element vertex"), "element vertex %zu", &w->vertex_count), 1);
	assert_in_range(w->vertex_count, 1, CORNERS);
	memcpy(w->rows, body, w->vertex_count * sizeof *w->rows);
	const char *face = body + w->vertex_count * sizeof *w->rows;
	for (size_t f = 0, c = 0; f < QUADS; f++, c += 4, face += 1 + 4 * sizeof(uint32_t)) {
		assert_int_equal(*face, 4);
		w->sizes[f] = 4;
		memcpy(w->indices + c, face + 1, 4 * sizeof(uint32_t));
	}
}

/* Raw tangents have the definition's bytes on positions, normals and texture coordinates as they are written, whatever
 * the input's normals were like: here as long as rounding to a few digits makes them, on both sides of what counts as
 * unit, 2^-11 of |n|^2. The output has them again. */
TEST(the_normals_that_are_solved_are_written)
{
	nt_buffer obj = {0};
	for (int v = 0; v < POINTS; v++) {
		const double x = v % (SIDE + 1), y = v / (SIDE + 1), nx = 0.3 * sin(x), ny = 0.4 * cos(y);
		const double length = (1 + 1e-4 * (v % 17 - 8)) / sqrt(nx * nx + ny * ny + 1);
		nt_buffer_format(&obj, "v %g %g %.5f\nvn %.7f %.7f %.7f\nvt %.5f %.5f\n", x, y, sin(x) * cos(y),
			length * nx, length * ny, length, 0.07 * x + 0.01 * sin(3 * y), 0.06 * y + 0.01 * cos(2 * x));
	}
	for (int q = 0; q < QUADS; q++) {
		const int a = q + q / SIDE + 1, b = a + SIDE + 1;
		nt_buffer_format(&obj, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, a + 1, a + 1, a + 1, b + 1,
			b + 1, b + 1, b, b, b);
	}
	put_file("in.obj", obj.data, obj.size);
	nt_buffer_free(&obj);
	const nt_settings raw = {.io.texcoord_set = -1, .io.threads = 1, .repair = NMTAN_REPAIR_OFF,
		.existing = NT_EXISTING_REPLACE};
	nt_summary summary = convert_file("in.obj", "out.ply", raw);
	assert_in_range(count_findings(&summary, NT_CODE_NORMALS_SCALED), 1, POINTS - 1);
	nt_summary_free(&summary);
	static written w;
	read_written("out.ply", &w);
	const size_t stride = sizeof *w.rows;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = QUADS, .vertex_count = w.vertex_count,
		.face_sizes = w.sizes, .indices = w.indices, .positions = w.rows[0], .normals = w.rows[0] + 3,
		.texcoords = w.rows[0] + 6, .position_stride_bytes = stride, .normal_stride_bytes = stride,
		.texcoord_stride_bytes = stride};
	static float expected[CORNERS][4];
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = expected[0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	const nt_implementation scalar = {.scalar = true};
	assert_int_equal(nt_tangents(&mesh, &options, &scalar, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.normals_not_unit, 0);
	for (size_t c = 0; c < CORNERS; c++)
		assert_memory_equal(expected[c], w.rows[w.indices[c]] + 8, sizeof expected[c]);
	summary = convert_file("out.ply", "again.ply", raw);
	assert_int_equal(count_findings(&summary, NT_CODE_NORMALS_SCALED), 0);
	nt_summary_free(&summary);
}

TEST(failed_allocations_end_the_run)
{
	put_text_file("in.obj", text);
	size_t failures = 0;
	for (bool failed = true; failed; failures++) {
		nt_summary summary;
		nt_error error;
		fail_allocations_from(failures);
		const nt_status status = nt_run(in_folder("in.obj"), in_folder("out.glb"), &settings, &summary, &error);
		failed = stop_failing_allocations();
		assert_true(failed ? status != NT_OK : status == NT_OK);
		nt_summary_free(&summary);
		assert_true(failures < 10000);
	}
	assert_true(failures > 30);
}

AROUND_ALL(make_folder, remove_folder)
