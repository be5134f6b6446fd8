/* SPDX-License-Identifier: MIT */
/*
 * Every allocation of a run from glTF to glTF fails: sparse accessors, morph targets, shared vertices, texture
 * transforms, data URIs, sidecars, Draco. The run says that memory is exhausted, or does without; leaks are for the
 * sanitizers to see.
 */
#include "fail_alloc.h"
#include "folder.h"
#include "pipeline/run.h"
#include "test.h"

static nt_status run(const char *input, nt_settings settings, nt_error *error)
{
	nt_summary summary;
	settings.texcoord_set = -1;
	settings.threads = 1;
	settings.dry_run = true;
	nt_error_clear(error);
	const nt_status status = nt_run(input, in_folder("out"), &settings, &summary, error);
	stop_failing_allocations();
	nt_summary_free(&summary);
	return status;
}

/* From the first allocation to the last: with none left to fail the run succeeds. */
static void fail_each(const char *input, nt_settings settings)
{
	nt_error error;
	assert_int_equal(run(input, settings, &error), NT_OK);
	size_t count = 0;
	for (;; count++) {
		fail_allocations_from(count);
		const nt_status status = run(input, settings, &error);
		if (status == NT_OK)
			break;
		if (status != NT_ERROR_MEMORY || !strstr(error.message, "out of memory"))
			fail_msg("%s, allocation %zu: %s", input, count, error.message);
	}
	assert_true(count > 40);
	assert_int_equal(count_in_folder(), 0);
}

static void allocations_of_every_kind_of_edit_may_fail(void **state)
{
	(void)state;
	fail_each(NT_DATA_DIR "/sparse.gltf", (nt_settings){.output_format = NT_FORMAT_GLB});
	fail_each(NT_DATA_DIR "/morph.gltf", (nt_settings){.output_format = NT_FORMAT_GLTF, .embed = true});
	fail_each(NT_DATA_DIR "/plates.gltf", (nt_settings){.output_format = NT_FORMAT_GLTF, .buffers = NT_BUFFERS_COPY,
		.bitangents = true, .precision = NT_PRECISION_BYTE});
	fail_each(NT_DATA_DIR "/plates.glb", (nt_settings){.output_format = NT_FORMAT_GLB,
		.draco = NT_DRACO_AS_SEQUENTIAL, .bitangents = true});
	fail_each(NT_DATA_DIR "/transformed.gltf", (nt_settings){.output_format = NT_FORMAT_GLB});
}

int main(void)
{
	const struct CMUnitTest tests[] = {cmocka_unit_test(allocations_of_every_kind_of_edit_may_fail)};
	return cmocka_run_group_tests_name("gltf/edit/memory", tests, make_folder, remove_folder);
}
