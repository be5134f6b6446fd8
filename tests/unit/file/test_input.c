/* SPDX-License-Identifier: MIT */
/*
 * Inputs, in a folder of our own that is removed afterwards.
 */
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

TEST(input_empty_is_no_error)
{
	put_text_file("a", "");
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("a"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_int_equal(file.size, 0);
	assert_non_null(file.data);
	nt_file_close(&file);
}

TEST(input_missing_or_a_folder_is_named)
{
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("missing"), NT_NAMED_BY_USER, &error), NT_ERROR_MISSING);
	assert_string_equal(error.message, "no such file");
	assert_string_equal(error.place.file, in_folder("missing"));
	nt_file_close(&file);
	assert_int_equal(nt_file_open(&file, in_folder(""), NT_NAMED_BY_USER, &error), NT_ERROR_MISSING);
	assert_string_equal(error.message, "cannot read: Is a directory");
	nt_file_close(&file);
}

TEST(input_without_permission_is_named)
{
	put_text_file("a", "secret");
	assert_int_equal(chmod(in_folder("a"), 0), 0);
	nt_error error;
	nt_file file;
	const nt_status status = nt_file_open(&file, in_folder("a"), NT_NAMED_BY_USER, &error);
	if (geteuid() == 0) { /* root reads everything */
		assert_int_equal(status, NT_OK);
	} else {
		assert_int_equal(status, NT_ERROR_IO);
		assert_string_equal(error.message, "cannot read: Permission denied");
	}
	nt_file_close(&file);
}

TEST(input_pipe_is_read_to_its_end)
{
	assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
	const pid_t child = fork();
	if (child == 0) {
		const int fd = open(in_folder("pipe"), O_WRONLY);
		for (int i = 0; i < 50000; i++)
			if (write(fd, "0123456789", 10) != 10)
				_exit(1);
		_exit(0);
	}
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("pipe"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_false(file.mapped);
	assert_int_equal(file.size, 500000);
	for (size_t i = 0; i < file.size; i++)
		assert_int_equal(file.data[i], '0' + i % 10);
	nt_file_close(&file);
	assert_int_equal(waitpid(child, NULL, 0), child);
}

AROUND_EACH(make_folder, remove_folder)
