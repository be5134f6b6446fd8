/* SPDX-License-Identifier: MIT */
/*
 * Damaged glTF, thousands of times: bytes flipped, numbers and names of the JSON exchanged, pieces cut
 * out. Whatever comes of it, the run ends with a status, and an error has words; the sanitizers see the
 * rest. NT_MUTATIONS sets the number of mutations; they are the same in every run.
 */
#include "test.h"
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/buffer.h"
#include "io/file.h"
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

static uint32_t random_state;

static uint32_t random_below(uint32_t limit)
{
	random_state = random_state * 1664525u + 1013904223u;
	return limit ? (uint32_t)((uint64_t)(random_state >> 4) * limit >> 28) : 0;
}

/* Bytes [begin, end) of a text are replaced by others. */
static void splice(nt_buffer *text, size_t begin, size_t end, const char *by)
{
	nt_buffer out = {0};
	nt_buffer_append(&out, text->data, begin);
	nt_buffer_text(&out, by);
	nt_buffer_append(&out, text->data + end, text->size - end);
	nt_buffer_free(text);
	*text = out;
}

static bool is_number_character(char c)
{
	return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/* Exchanges a number of the JSON. */
static void mutate_number(nt_buffer *file, size_t begin, size_t end)
{
	static const char *const numbers[] = {"0", "-1", "1", "2", "3", "4", "5", "6", "7", "12", "36",
		"255", "65535", "65536", "4294967295", "4294967296", "9007199254740993",
		"18446744073709551615", "18446744073709551616", "1e308", "0.5", "-0", "5121", "5123", "5125",
		"5126", "null", "\"x\"", "[]", "{}"};
	size_t at = begin + random_below((uint32_t)(end - begin));
	while (at < end && !(file->data[at] >= '0' && file->data[at] <= '9'))
		at++;
	size_t from = at, to = at;
	while (from > begin && is_number_character(file->data[from - 1]))
		from--;
	while (to < end && is_number_character(file->data[to]))
		to++;
	if (to > from)
		splice(file, from, to, numbers[random_below(sizeof numbers / sizeof *numbers)]);
}

/* Exchanges a string of the JSON. */
static void mutate_string(nt_buffer *file, size_t begin, size_t end)
{
	static const char *const strings[] = {"\"\"", "\"../../../etc/passwd\"", "\"/etc/passwd\"",
		"\"C:\\\\x\"", "\"file:///etc/passwd\"", "\"a\\u0000b\"", "\"data:;base64,AAAA\"",
		"\"data:,x\"", "\"SCALAR\"", "\"VEC2\"", "\"VEC3\"", "\"MAT4\"", "\"POSITION\"",
		"\"TEXCOORD_0\"", "\"indices\"", "\"sparse\"", "\"bufferView\"", "\"byteOffset\"",
		"\"extensions\"", "\"byteStride\"", "[[[[[[[[]]]]]]]]", "7"};
	size_t at = begin + random_below((uint32_t)(end - begin));
	while (at < end && file->data[at] != '"')
		at++;
	size_t to = at + 1;
	while (to < end && file->data[to] != '"')
		to++;
	if (to < end)
		splice(file, at, to + 1, strings[random_below(sizeof strings / sizeof *strings)]);
}

static void store_u32(nt_buffer *file, size_t at, size_t value)
{
	for (size_t i = 0; i < 4; i++)
		file->data[at + i] = (char)(value >> 8 * i);
}

/* A number or a string of the JSON; most of the time the lengths of a container follow, so that the
 * damage itself is met. */
static void mutate_json(nt_buffer *file)
{
	const bool glb = file->size > 20 && memcmp(file->data, "glTF", 4) == 0;
	const size_t before = file->size, begin = glb ? 20 : 0;
	size_t length = file->size;
	if (glb)
		length = (unsigned char)file->data[12] | (size_t)(unsigned char)file->data[13] << 8 |
			(size_t)(unsigned char)file->data[14] << 16;
	if (length > file->size - begin)
		length = file->size - begin;
	if (random_below(4))
		mutate_number(file, begin, begin + length);
	else
		mutate_string(file, begin, begin + length);
	if (glb && file->size > 20 && random_below(16)) {
		store_u32(file, 8, file->size);
		store_u32(file, 12, length + file->size - before);
	}
}

static void mutate(nt_buffer *file)
{
	const size_t begin = random_below((uint32_t)file->size);
	size_t end;
	switch (random_below(10)) {
	case 0: /* a byte anywhere */
		file->data[begin] = (char)random_below(256);
		break;
	case 1: /* the end or a piece is missing */
		end = random_below(2) ? file->size : begin + random_below(40);
		splice(file, begin, end > file->size ? file->size : end, "");
		break;
	default:
		mutate_json(file);
	}
}

typedef struct counts {
	size_t runs, solved, refused, geometry;
} counts;

static void run_one(const char *path, counts *tally)
{
	const nt_settings settings = {.texcoord_set = -1, .only = NT_ONLY_ALL,
		.existing = NT_EXISTING_REPLACE, .dry_run = true, .threads = 1,
		.output_format = random_below(4) ? NT_FORMAT_GLB : NT_FORMAT_GLTF};
	nt_summary summary;
	nt_error error;
	const nmtan_status status = nt_run(path, "/tmp/nmtan-hostile-output", &settings, &summary, &error);
	tally->runs++;
	tally->solved += status == NMTAN_OK;
	tally->geometry += summary.solved_count > 0 || strstr(error.place.pointer, "/accessors/") ||
		strstr(error.place.pointer, "/bufferViews/") || strstr(error.place.pointer, "/primitives/");
	if (status) {
		tally->refused++;
		if (getenv("NT_VERBOSE"))
			print_message("%s: %s\n", error.place.pointer, error.message);
		if (status == NMTAN_ERROR_INTERNAL || strlen(error.message) < 8)
			fail_msg("%s: status %d, \"%s\"", path, status, error.message);
	}
	nt_summary_free(&summary);
}

static void link_companions(const char *seed, const char *folder)
{
	char command[1024];
	const char *slash = strrchr(seed, '/');
	snprintf(command, sizeof command, "cp '%.*s'/*.bin '%s' 2>/dev/null", (int)(slash - seed), seed,
		folder);
	if (system(command) != 0)
		return; /* the seed has none */
}

static void damaged_files_end_with_a_status(void **state)
{
	(void)state;
	const char *wanted = getenv("NT_MUTATIONS");
	const size_t rounds = (wanted ? (size_t)atoi(wanted) : 600) / SEED_COUNT;
	char folder[] = "/tmp/nmtan-test-hostile-XXXXXX", path[300];
	assert_non_null(mkdtemp(folder));
	counts tally = {0};
	for (size_t s = 0; s < SEED_COUNT; s++) {
		nt_file file;
		nt_error error;
		if (nt_file_open(&file, seeds[s], &error) != NMTAN_OK)
			continue; /* ../shared is not there */
		link_companions(seeds[s], folder);
		snprintf(path, sizeof path, "%s/x%s", folder, strrchr(seeds[s], '.'));
		for (size_t i = 0; i < rounds; i++) {
			random_state = (uint32_t)(s * 1000003 + i);
			nt_buffer bytes = {0};
			nt_buffer_append(&bytes, file.data, file.size);
			for (uint32_t k = 1 + random_below(2); k-- > 0 && bytes.size;)
				mutate(&bytes);
			FILE *stream = fopen(path, "wb");
			assert_non_null(stream);
			if (bytes.size)
				assert_int_equal(fwrite(bytes.data, 1, bytes.size, stream), bytes.size);
			fclose(stream);
			nt_buffer_free(&bytes);
			run_one(path, &tally);
		}
		nt_file_close(&file);
	}
	char command[400];
	snprintf(command, sizeof command, "rm -rf '%s'", folder);
	assert_int_equal(system(command), 0);
	print_message("%zu mutations: %zu written, %zu refused; %zu came as far as geometry\n", tally.runs,
		tally.solved, tally.refused, tally.geometry);
	assert_true(tally.geometry * 3 >= tally.runs);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(damaged_files_end_with_a_status),
	};
	return cmocka_run_group_tests_name("io/gltf hostile", tests, NULL, NULL);
}
