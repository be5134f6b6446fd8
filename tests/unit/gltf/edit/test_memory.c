/* SPDX-License-Identifier: MIT */
/*
 * Every allocation of a run from glTF to glTF fails: sparse accessors, morph targets, shared vertices, texture
 * transforms, data URIs, sidecars, Draco. The run says that memory is exhausted, or does without; leaks are for the
 * sanitizers to see.
 */
#include "hand_gltf_file.h"

static void fail_each(const char *input, nt_settings settings)
{
	settings.io.threads = 1;
	settings.dry_run = true;
	assert_true(exhaust_memory(input, settings) > 40);
	assert_int_equal(count_in_folder(), 0);
}

TEST(allocations_of_every_kind_of_edit_may_fail)
{
	fail_each(NT_DATA_DIR "/sparse.gltf", (nt_settings){.output_format = NT_FORMAT_GLB});
	fail_each(NT_DATA_DIR "/morph.gltf",
		(nt_settings){.output_format = NT_FORMAT_GLTF, .io.buffers = NT_BUFFERS_EMBED});
	fail_each(NT_DATA_DIR "/plates.gltf",
		(nt_settings){.output_format = NT_FORMAT_GLTF, .io.buffers = NT_BUFFERS_COPY,
		.io.bitangents = true, .io.precision = NT_PRECISION_BYTE});
	fail_each(NT_DATA_DIR "/plates.glb", (nt_settings){.output_format = NT_FORMAT_GLB,
		.io.draco = NT_DRACO_AS_SEQUENTIAL, .io.bitangents = true});
	fail_each(NT_DATA_DIR "/transformed.gltf", (nt_settings){.output_format = NT_FORMAT_GLB});
}

AROUND_ALL(make_folder, remove_folder)
