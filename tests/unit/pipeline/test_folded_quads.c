/* SPDX-License-Identifier: MIT */
/*
 * Folded quads and normals that are not of unit length in a whole run: what is counted, and that every failed
 * allocation ends it with a status and nothing else. What is written is tests/cli/test_frames.sh's.
 */
#include "hand_gltf_file.h"

/* A folded quad (tests/cli/test_frames.sh derives its halves), and a triangle with a normal of length .5, a zero one
 * and none. */
static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 2 1 0\n"
	"vt 0 0\nvt 1 0\nvt 1 1\nvt 1.25 .5\nvn 0 0 1\nvn 0 0 .5\nvn 0 0 0\n"
	"f 1/1/1 2/2/1 3/3/1 4/4/1\nf 5/1/2 6/2/3 7/3\n";

static const nt_settings settings = {.texcoord_set = -1, .dry_run = true, .threads = 1,
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

int main(void)
{
	return run_group_within("pipeline/folded_quads", make_folder, remove_folder);
}
