/* SPDX-License-Identifier: MIT */
/*
 * Files that become shorter while they are mapped: what is gone reads as zeros, and is told to the thread that
 * opened the file, and to no other.
 */
#include "test.h"
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include "file/input.h"
#include "file/output.h"
#include "folder.h"

static size_t page;

static void put_pages(const char *name, size_t count)
{
	char *bytes = malloc(count * page);
	assert_non_null(bytes);
	memset(bytes, 'x', count * page);
	put_file(name, bytes, count * page);
	free(bytes);
}

static void open_pages(nt_file *file, const char *name, size_t count)
{
	nt_error error;
	put_pages(name, count);
	nt_watch_forget();
	assert_int_equal(nt_file_open(file, in_folder(name), NT_NAMED_BY_USER, &error), NT_OK);
	assert_true(file->mapped);
}

static void expect_lost(const char *name)
{
	nt_error error;
	assert_int_equal(nt_watch_check(&error), NT_ERROR_IO);
	assert_string_equal(error.place.file, in_folder(name));
	assert_non_null(strstr(error.message, "shorter"));
}

/* The table has room for 512 files, on 70 pages: what of it is not used costs no page fault. To come first. */
TEST(unused_places_are_not_looked_at)
{
	nt_file file;
	nt_error error;
	struct rusage before, after;
	open_pages(&file, "a", 1);
	getrusage(RUSAGE_SELF, &before);
	assert_int_equal(nt_watch_check(&error), NT_OK);
	assert_false(nt_watch_touch(&file, sizeof file));
	getrusage(RUSAGE_SELF, &after);
	assert_in_range(after.ru_minflt - before.ru_minflt, 0, 20);
	nt_file_close(&file);
}

TEST(what_is_gone_reads_as_zeros)
{
	nt_file file;
	nt_error error;
	open_pages(&file, "a", 4);
	assert_int_equal(nt_watch_check(&error), NT_OK);
	assert_int_equal(truncate(in_folder("a"), (off_t)page), 0);
	assert_int_equal(file.data[0], 'x');
	assert_int_equal(file.data[3 * page], 0);
	assert_int_equal(file.data[page], 0);
	assert_int_equal(file.data[4 * page - 1], 0);
	assert_int_equal(file.data[page - 1], 'x');
	expect_lost("a");
	nt_file_close(&file);
	expect_lost("a"); /* also when it is closed */
	nt_watch_forget();
	assert_int_equal(nt_watch_check(&error), NT_OK);
}

/* No signal tells of that. */
TEST(the_last_page_may_lose_a_part)
{
	nt_file file;
	open_pages(&file, "b", 1);
	assert_int_equal(truncate(in_folder("b"), 10), 0);
	expect_lost("b");
	nt_file_close(&file);
}

/* Same size, other bytes; also after it is closed. */
TEST(what_was_written_to_is_told)
{
	nt_file file;
	nt_error error;
	open_pages(&file, "e", 2);
	assert_int_equal(nt_watch_check(&error), NT_OK);
	/* a second later, whatever the clock's grain */
	const struct timespec times[2] = {{.tv_nsec = UTIME_OMIT}, {.tv_sec = time(NULL) + 1}};
	assert_int_equal(utimensat(AT_FDCWD, in_folder("e"), times, 0), 0);
	for (int closed = 0; closed < 2; closed++) {
		assert_int_equal(nt_watch_check(&error), NT_ERROR_IO);
		assert_string_equal(error.place.file, in_folder("e"));
		assert_string_equal(error.message, "the file changed while it was read");
		if (!closed)
			nt_file_close(&file);
	}
}

TEST(a_file_that_stays_is_not_told)
{
	nt_file file, other;
	nt_error error;
	open_pages(&file, "c", 2);
	open_pages(&other, "d", 2);
	assert_int_equal(truncate(in_folder("d"), 0), 0);
	assert_int_equal(other.data[page], 0);
	nt_file_close(&other);
	assert_int_equal(file.data[page], 'x');
	expect_lost("d");
	nt_watch_forget();
	assert_int_equal(nt_watch_check(&error), NT_OK);
	nt_file_close(&file);
}

static void *read_and_check(void *argument)
{
	const nt_file *file = argument;
	nt_error error;
	for (size_t i = 0; i < file->size; i += page)
		if (file->data[i] != 0)
			return (void *)1;
	return nt_watch_check(&error) ? (void *)2 : NULL;
}

TEST(helpers_may_read_and_other_runs_hear_nothing)
{
	nt_file file;
	open_pages(&file, "e", 64);
	assert_int_equal(truncate(in_folder("e"), 0), 0);
	pthread_t threads[4];
	for (int i = 0; i < 4; i++)
		assert_int_equal(pthread_create(&threads[i], NULL, read_and_check, &file), 0);
	for (int i = 0; i < 4; i++) {
		void *fault;
		pthread_join(threads[i], &fault);
		assert_null(fault);
	}
	expect_lost("e");
	nt_file_close(&file);
}

/* The kernel cannot read it for us. */
TEST(what_is_gone_can_be_written)
{
	nt_file file;
	nt_error error;
	nt_output *output;
	nt_sink *sink;
	open_pages(&file, "f", 600);
	assert_int_equal(truncate(in_folder("f"), 0), 0);
	assert_int_equal(nt_output_create(&output, NULL, &error), NT_OK);
	assert_int_equal(nt_output_add(output, in_folder("copy"), NT_ROLE_MAIN, &sink, &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, file.data, file.size, &error), NT_OK);
	assert_int_equal(nt_sink_copy(sink, &file, 0, file.size, &error), NT_OK);
	assert_int_equal(nt_output_size(output), 2 * 600 * page);
	nt_output_abort(output);
	expect_lost("f");
	nt_file_close(&file);
}

TEST(more_files_than_are_watched_are_read)
{
	enum { COUNT = 600 };
	static nt_file files[COUNT];
	nt_error error;
	put_pages("g", 1);
	for (int i = 0; i < COUNT; i++)
		assert_int_equal(nt_file_open(&files[i], in_folder("g"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_true(files[0].mapped);
	assert_false(files[COUNT - 1].mapped);
	assert_int_equal(files[COUNT - 1].size, page);
	for (int i = 0; i < COUNT; i++)
		nt_file_close(&files[i]);
	open_pages(&files[0], "g", 1);
	nt_file_close(&files[0]);
}

static int set_up(void **state)
{
	page = (size_t)sysconf(_SC_PAGESIZE);
	return make_folder(state);
}

AROUND_ALL(set_up, remove_folder)
