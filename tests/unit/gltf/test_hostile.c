/* SPDX-License-Identifier: MIT */
/*
 * Damaged glTF, thousands of times: bytes flipped, numbers and names of the JSON exchanged, pieces cut
 * out. In any case the run ends with a status, and an error has words; the sanitizers see the
 * rest. NT_MUTATIONS sets the number of mutations; they are the same in every run.
 */
#include "folder.h"
#include "test.h"
#include "file/input.h"
#include "mutate.h"
#include "pipeline/run.h"

static const char *const seeds[] = {
	"data/plates.gltf",
	"data/plates.glb",
	"../shared/models/gltf/UnusedTexCoords/TexCoord2.gltf",
	"../shared/models/gltf/BoxMeta/glTF/BoxMeta.gltf",
	"../shared/models/gltf/MultiUVTest/glTF/MultiUVTest.gltf",
	"../shared/models/gltf/TwoSidedPlane/glTF/TwoSidedPlane.gltf",
	"../shared/models/gltf/DuplicateMeshes/duplicate_meshes.gltf",
	"../shared/models/gltf/TextureTransformTest/glTF/TextureTransformTest.gltf",
	"../shared/models/gltf/gltf_transform_extensions/BoxMeshopt.glb",
	"../shared/models/gltf/Box/glTF_Binary/Box_Draco.glb",
};
enum { SEED_COUNT = sizeof seeds / sizeof *seeds };

typedef struct counts {
	size_t runs, solved, refused, geometry;
} counts;

static void run_one(const char *path, uint32_t *chance, counts *tally)
{
	const nt_settings settings = {.io.texcoord_set = -1, .only = NT_ONLY_ALL,
		.existing = NT_EXISTING_REPLACE, .dry_run = true, .io.threads = 1,
		.output_format = mutate_random(chance, 4) ? NT_FORMAT_GLB : NT_FORMAT_GLTF};
	nt_summary summary;
	nt_error error;
	const nt_status status = nt_run(path, in_folder("output"), &settings, &summary, &error);
	tally->runs++;
	tally->solved += status == NT_OK;
	tally->geometry += summary.solved_count > 0 || strstr(error.place.pointer, "/accessors/") ||
		strstr(error.place.pointer, "/bufferViews/") || strstr(error.place.pointer, "/primitives/");
	if (status) {
		tally->refused++;
		if (getenv("NT_VERBOSE"))
			print_message("%s: %s\n", error.place.pointer, error.message);
		if (status == NT_ERROR_INTERNAL || strlen(error.message) < 8)
			fail_msg("%s: status %d, \"%s\"", path, status, error.message);
	}
	nt_summary_free(&summary);
}

static void copy_sidecars(const char *seed)
{
	char command[1024];
	const char *slash = strrchr(seed, '/');
	snprintf(command, sizeof command, "cp '%.*s'/*.bin '%s' 2>/dev/null", (int)(slash - seed), seed, in_folder(""));
	if (system(command) != 0)
		return; /* the seed has none */
}

TEST(damaged_files_end_with_a_status)
{
	const char *wanted = getenv("NT_MUTATIONS");
	const size_t rounds = (wanted ? (size_t)atoi(wanted) : 600) / SEED_COUNT;
	counts tally = {0};
	for (size_t s = 0; s < SEED_COUNT; s++) {
		nt_file file;
		nt_error error;
		if (nt_file_open(&file, seeds[s], NT_NAMED_BY_USER, &error) != NT_OK)
			continue; /* ../shared is not there */
		copy_sidecars(seeds[s]);
		const char *name = strstr(seeds[s], ".glb") ? "x.glb" : "x.gltf";
		char *bytes = malloc(file.size + 2 * MUTATE_ROOM);
		assert_non_null(bytes);
		for (size_t i = 0; i < rounds; i++) {
			uint32_t chance = (uint32_t)(s * 1000003 + i);
			size_t size = file.size;
			memcpy(bytes, file.data, size);
			for (uint32_t k = 1 + mutate_random(&chance, 2); k-- > 0 && size;)
				size = mutate(bytes, size, &chance);
			put_file(name, bytes, size);
			run_one(in_folder(name), &chance, &tally);
		}
		free(bytes);
		nt_file_close(&file);
	}
	print_message("%zu mutations: %zu written, %zu refused; %zu came as far as geometry\n", tally.runs,
		tally.solved, tally.refused, tally.geometry);
	assert_true(tally.geometry * 3 >= tally.runs);
}

AROUND_ALL(make_folder, remove_folder)
