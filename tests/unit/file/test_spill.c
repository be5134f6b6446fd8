/* SPDX-License-Identifier: MIT */
/*
 * Large blocks wait in a file without a name.
 */
#include "file/spill.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

enum { LARGE = 300 * 1024, SMALL = 1000 };

static unsigned char *make_block(size_t size, unsigned seed)
{
	unsigned char *bytes = malloc(size);
	for (size_t i = 0; i < size; i++)
		bytes[i] = (unsigned char)(i * 7 + i / 251 + seed);
	return bytes;
}

static void expect_block(const unsigned char *bytes, size_t size, unsigned seed)
{
	unsigned char *expected = make_block(size, seed);
	assert_memory_equal(bytes, expected, size);
	free(expected);
}

/* How many entries the folder has besides . and .. */
static size_t count_files(void)
{
	size_t count = 0;
	DIR *folder = opendir(in_folder(""));
	while (readdir(folder))
		count++;
	closedir(folder);
	return count - 2;
}

static void large_blocks_are_in_the_file(void **state)
{
	(void)state;
	nt_spill *s = nt_spill_create(in_folder("out.glb"));
	unsigned char *blocks[4];
	const unsigned char *kept[4];
	for (unsigned i = 0; i < 4; i++) {
		blocks[i] = make_block(i % 2 ? SMALL : LARGE + i, i);
		kept[i] = nt_spill_take(s, blocks[i], i % 2 ? SMALL : LARGE + i);
		assert_true((kept[i] == blocks[i]) == (i % 2 == 1));
	}
	assert_int_equal(count_files(), 0);
	for (unsigned i = 0; i < 4; i++) {
		expect_block(kept[i], i % 2 ? SMALL : LARGE + i, i);
		nt_spill_forget(s, kept[i]);
		expect_block(kept[i], i % 2 ? SMALL : LARGE + i, i);
	}
	nt_spill_free(s);
}

static void without_a_file_all_stays_in_memory(void **state)
{
	(void)state;
	char nowhere[300];
	snprintf(nowhere, sizeof nowhere, "%s", in_folder("none/out.glb"));
	const char *const targets[] = {NULL, nowhere};
	for (int i = 0; i < 2; i++) {
		nt_spill *s = nt_spill_create(targets[i]);
		unsigned char *block = make_block(LARGE, 3);
		assert_ptr_equal(nt_spill_take(s, block, LARGE), block);
		nt_spill_forget(s, block);
		expect_block(block, LARGE, 3);
		nt_spill_free(s);
	}
	nt_spill_free(NULL);
}

static void spill_without_memory_leaves_the_block(void **state)
{
	(void)state;
	fail_allocations_from(0);
	assert_null(nt_spill_create("x"));
	stop_failing_allocations();
	nt_spill *s = nt_spill_create(NULL);
	unsigned char *block = make_block(SMALL, 1);
	fail_allocations_from(0);
	const unsigned char *kept = nt_spill_take(s, block, SMALL);
	stop_failing_allocations();
	assert_null(kept);
	free(block);
	nt_spill_free(s);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(large_blocks_are_in_the_file),
		cmocka_unit_test(without_a_file_all_stays_in_memory),
		cmocka_unit_test(spill_without_memory_leaves_the_block),
	};
	return cmocka_run_group_tests_name("file/spill", tests, make_folder, remove_folder);
}
