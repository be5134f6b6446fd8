/* SPDX-License-Identifier: MIT */
/*
 * Inputs, in a folder of our own that is removed afterwards.
 */
#include "fail_alloc.h"
#include "file/input.h"
#include "folder.h"
#include "test.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

TEST(input_is_mapped_and_knows_which_file_it_is)
{
	put_text_file("a", "some bytes");
	assert_int_equal(link(in_folder("a"), in_folder("b")), 0);
	put_text_file("c", "some bytes");
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("a"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_true(file.mapped);
	assert_int_equal(file.size, 10);
	assert_memory_equal(file.data, "some bytes", 10);
	assert_true(nt_file_is(&file, in_folder("a")));
	assert_true(nt_file_is(&file, in_folder("b")));
	assert_false(nt_file_is(&file, in_folder("c")));
	assert_false(nt_file_is(&file, in_folder("missing")));
	assert_false(nt_file_is(&file, "-"));
	nt_file_close(&file);
}

/* How many of the pages from `bytes` on are in our page tables (Documentation/admin-guide/mm/pagemap.rst); as many
 * as are expected where nobody says so, as in some containers. */
static unsigned present_pages(const unsigned char *bytes, size_t count, size_t page, unsigned expected)
{
	const int fd = open("/proc/self/pagemap", O_RDONLY);
	if (fd < 0)
		return expected;
	unsigned present = 0;
	for (size_t i = 0; i < count; i++) {
		uint64_t entry;
		assert_int_equal(pread(fd, &entry, sizeof entry,
			(off_t)(((uintptr_t)bytes / page + i) * sizeof entry)), sizeof entry);
		present += entry >> 63;
	}
	close(fd);
	return present;
}

TEST(input_pages_that_are_forgotten_go_and_come_back)
{
	enum { PAGES = 8 };
	const size_t page = (size_t)sysconf(_SC_PAGESIZE);
	FILE *stream = fopen(in_folder("in"), "wb");
	for (size_t i = 0; i < PAGES * page; i++)
		fputc((int)(i / page * 7 + i % 251), stream);
	fclose(stream);
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("in"), NT_NAMED_BY_USER, &error), NT_OK);
	unsigned sum = 0;
	for (size_t i = 0; i < file.size; i++)
		sum += file.data[i];
	assert_int_equal(present_pages(file.data, PAGES, page, PAGES), PAGES);

	/* from the middle of page 1 to the middle of page 5: five pages hold some of it */
	nt_file_release(&file, page + page / 2, 4 * page);
	assert_int_equal(present_pages(file.data, PAGES, page, PAGES - 5), PAGES - 5);
	for (size_t i = 0; i < file.size; i++)
		sum -= file.data[i];
	assert_int_equal(sum, 0);

	nt_file_close(&file);
}

/* The error names it, and nothing of it stays open. */
TEST(input_that_cannot_be_read_is_named)
{
	static const struct {
		const char *name; /* in our folder, or absolute */
		nt_naming naming;
		nt_status status;
		const char *message;
	} rows[] = {
		{"missing", NT_NAMED_BY_USER, NT_ERROR_MISSING, "no such file"},
		{"plain/a", NT_NAMED_BY_USER, NT_ERROR_MISSING, "no such file: Not a directory"},
		{"", NT_NAMED_BY_USER, NT_ERROR_MISSING, "cannot read: Is a directory"},
		{"", NT_NAMED_BY_DOCUMENT, NT_ERROR_MISSING, "cannot read: Is a directory"},
		{"loop", NT_NAMED_BY_USER, NT_ERROR_IO, "cannot read: Too many levels of symbolic links"},
		{"/proc/self/mem", NT_NAMED_BY_USER, NT_ERROR_IO, "cannot read: Input/output error"},
		{"/dev/full", NT_NAMED_BY_USER, NT_ERROR_IO, "cannot read: it is a device"},
		{"/dev/full", NT_NAMED_BY_DOCUMENT, NT_ERROR_MISSING, "cannot read: it is no regular file"},
		{"pointer", NT_NAMED_BY_USER, NT_ERROR_MISSING,
			"Git LFS's pointer to the file, not the file itself: git lfs pull brings it"},
		{"pointer", NT_NAMED_BY_US, NT_OK, NULL},
		{"plain", NT_NAMED_BY_USER, NT_OK, NULL}, /* of no bytes */
		{"secret", NT_NAMED_BY_USER, NT_ERROR_IO, "cannot read: Permission denied"},
	};
	const int lowest = dup(STDIN_FILENO);
	close(lowest);
	put_text_file("plain", "");
	put_text_file("secret", "secret");
	put_text_file("pointer", "version https://git-lfs.github.com/spec/v1\n");
	assert_int_equal(symlink("loop", in_folder("loop")), 0);
	assert_int_equal(chmod(in_folder("secret"), 0), 0);
	/* root reads everything */
	for (size_t i = 0; i < sizeof rows / sizeof *rows - (geteuid() == 0); i++) {
		const char *path = rows[i].name[0] == '/' ? rows[i].name : in_folder(rows[i].name);
		nt_error error;
		nt_file file;
		assert_int_equal(nt_file_open(&file, path, rows[i].naming, &error), rows[i].status);
		if (rows[i].message) {
			assert_string_equal(error.message, rows[i].message);
			assert_string_equal(error.place.file, path);
		}
		assert_non_null(file.data);
		nt_file_close(&file);
		assert_int_equal(dup(STDIN_FILENO), lowest);
		close(lowest);
	}
}

/* Files of the system have a size of 0, or one that nobody can map, and a text. */
TEST(input_that_cannot_be_mapped_is_read)
{
	static const char *const paths[] = {"/proc/self/cmdline", "/sys/kernel/mm/transparent_hugepage/enabled"};
	for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
		nt_error error;
		nt_file file;
		if (access(paths[i], R_OK) != 0)
			continue;
		assert_int_equal(nt_file_open(&file, paths[i], NT_NAMED_BY_USER, &error), NT_OK);
		assert_false(file.mapped);
		assert_in_range(file.size, 1, 4000);
		nt_file_close(&file);
		fail_allocations_from(0);
		const nt_status status = nt_file_open(&file, paths[i], NT_NAMED_BY_USER, &error);
		assert_true(stop_failing_allocations());
		assert_int_equal(status, NT_ERROR_MEMORY);
		assert_string_equal(error.place.file, paths[i]);
	}
}

AROUND_EACH(make_folder, remove_folder)
