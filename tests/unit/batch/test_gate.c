/* SPDX-License-Identifier: MIT */
/*
 * A bound that threads share, and guesses from what files say about themselves: the comment in gate.c has their
 * numbers.
 */
#include "batch/inside.h"
#include "folder.h"
#include "test.h"

#include <stdatomic.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static nt_gate gate;
static atomic_int inside;   /* who holds what they need */
static atomic_int alone;    /* of them, who need more than there is */
static atomic_ulong held;   /* what they hold */
static atomic_bool broken;

static void *use(void *need_of)
{
	const uint64_t need = *(const uint64_t *)need_of;
	for (int i = 0; i < 50; i++) {
		const bool is_alone = nt_gate_enter(&gate, need);
		const int others = atomic_fetch_add(&inside, 1);
		const unsigned long sum = atomic_fetch_add(&held, need) + need;
		if (is_alone != (need > gate.limit) || (is_alone && others > 0) || (!is_alone && sum > gate.limit))
			broken = true;
		atomic_fetch_add(&alone, is_alone);
		usleep(50);
		atomic_fetch_sub(&held, need);
		atomic_fetch_sub(&inside, 1);
		nt_gate_leave(&gate, need);
	}
	return NULL;
}

TEST(what_is_inside_is_never_more_than_the_limit_but_for_one_alone)
{
	static const uint64_t needs[] = {10, 40, 60, 100, 1, 101, UINT64_MAX / 4};
	enum { COUNT = sizeof needs / sizeof *needs };
	pthread_t threads[COUNT];
	nt_gate_init(&gate, 100);
	for (int i = 0; i < COUNT; i++)
		assert_int_equal(pthread_create(&threads[i], NULL, use, (void *)(uintptr_t)&needs[i]), 0);
	for (int i = 0; i < COUNT; i++)
		pthread_join(threads[i], NULL);
	assert_false(broken);
	assert_int_equal(alone, 100);
	assert_int_equal(gate.used, 0);
	nt_gate_end(&gate);
}

static void *enter_with_all(void *unused)
{
	(void)unused;
	nt_gate_enter(&gate, 100);
	atomic_store(&inside, 1);
	return NULL;
}

static void *enter_with_little(void *unused)
{
	(void)unused;
	nt_gate_enter(&gate, 1);
	atomic_store(&inside, 2);
	return NULL;
}

static uint64_t arrived(void)
{
	pthread_mutex_lock(&gate.lock);
	const uint64_t count = gate.arrived;
	pthread_mutex_unlock(&gate.lock);
	return count;
}

TEST(who_fits_does_not_pass_who_waits)
{
	pthread_t large, small;
	nt_gate_init(&gate, 100);
	atomic_store(&inside, 0);
	assert_false(nt_gate_enter(&gate, 50));
	assert_int_equal(pthread_create(&large, NULL, enter_with_all, NULL), 0);
	while (arrived() < 2)
		usleep(100);
	assert_int_equal(pthread_create(&small, NULL, enter_with_little, NULL), 0);
	while (arrived() < 3)
		usleep(100);
	usleep(2000);
	assert_int_equal(atomic_load(&inside), 0);
	nt_gate_leave(&gate, 50);
	pthread_join(large, NULL);
	assert_int_equal(atomic_load(&inside), 1);
	nt_gate_leave(&gate, 100);
	pthread_join(small, NULL);
	assert_int_equal(atomic_load(&inside), 2);
	nt_gate_end(&gate);
}

/* ---- guesses ---- */

enum { MB = 1 << 20 };

static uint64_t need_of(const char *name)
{
	const nt_settings settings = {0};
	return nt_need_of(in_folder(name), &settings, 0);
}

TEST(what_has_all_in_one_file_counts_by_its_bytes)
{
	static const struct {
		const char *name, *text;
		uint64_t each;
	} rows[] = {{"a.drc", "DRACO...", 160}, {"empty.obj", "", 8}, {"v.obj", "v 0 0 0\nv 1 0 0\n", 8},
		{"a.ply", "ply\nelement vertex 1000\n", 8}, {"unnamed", "o\n", 8}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		put_text_file(rows[i].name, rows[i].text);
		assert_int_equal(need_of(rows[i].name), MB + rows[i].each * strlen(rows[i].text));
	}
}

TEST(gltf_counts_by_its_accessors_wherever_their_bytes_are)
{
	static const char plain[] = "{\"accessors\":[{\"count\": 600 },{ \"count\"\n:30}],\"bufferViews\":[]}";
	static const char draco[] =
		"{\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"accessors\":[{\"count\":600}]}";
	put_text_file("a.gltf", plain);
	assert_int_equal(need_of("a.gltf"), MB + 12 * strlen(plain) + 46 * 630);
	put_text_file("d.gltf", draco);
	assert_int_equal(need_of("d.gltf"), MB + 12 * strlen(draco) + 112 * 600);
	const nt_settings compress = {.io.draco = NT_DRACO_AS_EDGEBREAKER};
	assert_int_equal(nt_need_of(in_folder("a.gltf"), &compress, 0), MB + 12 * strlen(plain) + 112 * 630);
	/* cut anywhere */
	for (size_t size = 0; size < sizeof plain - 1; size++) {
		put_file("cut.gltf", plain, size);
		assert_true(need_of("cut.gltf") >= MB);
	}
}

TEST(a_glb_counts_its_json_and_its_bytes)
{
	static const char json[] = "{\"accessors\":[{\"count\":600}]}  ", more[] = "\"count\":99999";
	struct stat info;
	put_glb_file("a.glb", json, more, sizeof more - 1);
	assert_int_equal(stat(in_folder("a.glb"), &info), 0);
	const uint64_t padded = (strlen(json) + 3) / 4 * 4;
	assert_int_equal(need_of("a.glb"), MB + 12 * padded + ((uint64_t)info.st_size - padded) + 46 * 600);
	put_text_file("short.glb", "glTF\2\0\0");
	assert_true(need_of("short.glb") >= MB);
	/* a length beyond the file */
	put_file("long.glb", "glTF\2\0\0\0\30\0\0\0\377\377\377\377JSON{}  ", 24);
	assert_int_equal(need_of("long.glb"), MB + 12 * 4 + 20);
}

/* Each half of these is a number, and what it would take: 2 * 2^63, 46 * 2^60. */
TEST(what_is_claimed_beyond_64_bits_is_more_than_there_is)
{
	static const char *const rows[][2] = {
		{"sum.gltf", "{\"accessors\":[{\"count\":9223372036854775808},{\"count\":9223372036854775808}]}"},
		{"product.gltf", "{\"accessors\":[{\"count\":1152921504606846976}]}"},
		{"number.gltf", "{\"accessors\":[{\"count\":340282366920938463463374607431768211456}]}"}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		put_text_file(rows[i][0], rows[i][1]);
		assert_true(need_of(rows[i][0]) == UINT64_MAX);
	}
}

TEST(where_the_size_says_enough_nothing_is_opened)
{
	const nt_settings settings = {0};
	put_text_file("tiny.glb", "glTF");
	assert_int_equal(nt_need_of(in_folder("tiny.glb"), &settings, 2 * MB), MB + 256 * 4);
	/* the size of a .gltf says nothing about its buffers */
	put_text_file("tiny.gltf", "{\"count\":1000000}");
	assert_int_equal(nt_need_of(in_folder("tiny.gltf"), &settings, 2 * MB), MB + 12 * 17 + 46 * 1000000);
}

TEST(what_has_no_size_is_alone_and_what_is_missing_is_nothing)
{
	assert_int_equal(need_of("nowhere.obj"), 0);
	assert_int_equal(mkfifo(in_folder("pipe.obj"), 0600), 0);
	assert_true(need_of("pipe.obj") == UINT64_MAX);
	const nt_settings settings = {0};
	assert_true(nt_need_of("-", &settings, 0) == UINT64_MAX);
}

AROUND_ALL(make_folder, remove_folder)
