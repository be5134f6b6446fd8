/* SPDX-License-Identifier: MIT */
#include "base/memory.h"
#include "folder.h"
#include "test.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

TEST(it_is_at_most_what_the_machine_has)
{
	const uint64_t pages = (uint64_t)sysconf(_SC_PHYS_PAGES), page = (uint64_t)sysconf(_SC_PAGESIZE);
	assert_true(nt_memory_available() <= pages * page);
}

TEST(a_limit_of_the_address_space_counts)
{
	struct rlimit before, limit;
	assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
	limit = before;
	limit.rlim_cur = 100 * 1024 * 1024;
	assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
	const uint64_t found = nt_memory_available();
	setrlimit(RLIMIT_AS, &before);
	assert_true(found <= 100 * 1024 * 1024);
}

static unsigned open_files(void)
{
	unsigned count = 0;
	for (int fd = 0; fd < 1024; fd++)
		count += fcntl(fd, F_GETFD) >= 0;
	return count;
}

/* The meaning of a list of groups if these are the limits of version 2 at the root, /a and /a/b, and of version 1. */
TEST(the_least_limit_of_the_groups_above_counts)
{
	static const struct {
		const char *list;
		uint64_t expected;
	} cases[] = {{"0::/\n", UINT64_MAX}, {"0::/a\n", 3000}, {"0::/a/b\n", 3000}, {"0::/a/c\n", 2000},
		{"0::/unknown/x\n", UINT64_MAX},
		{"9:cpu:/a\n4:memory:/a\n0::/\n", 1000}, {"4:memory:/none\n", 5000}, {"no list", UINT64_MAX},
		{"", UINT64_MAX}};
	const char *const folders[] = {"a", "a/b", "a/c", "memory", "memory/a"};
	for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
		assert_int_equal(mkdir(in_folder(folders[i]), 0700), 0);
	put_text_file("a/memory.max", "3000\n");
	put_text_file("a/b/memory.max", "max\n");
	put_text_file("a/c/memory.max", "2000\n");
	put_text_file("memory/memory.limit_in_bytes", "5000\n");
	put_text_file("memory/a/memory.limit_in_bytes", "1000\n");
	const unsigned before = open_files();
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		put_text_file("list", cases[i].list);
		assert_true(nt_memory_of_groups(in_folder("list"), in_folder("")) == cases[i].expected);
	}
	assert_true(nt_memory_of_groups(in_folder("nowhere"), in_folder("")) == UINT64_MAX);
	assert_true(nt_memory_available() > 0);
	assert_int_equal(open_files(), before);
}

AROUND_ALL(make_folder, remove_folder)
