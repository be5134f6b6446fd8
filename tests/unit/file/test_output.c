/* SPDX-License-Identifier: MIT */
/*
 * Output sets, in a folder of our own that is removed afterwards.
 */
#include "file/output.h"
#include "folder.h"
#include "test.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static void assert_content(const char *name, const char *text)
{
	nt_error error;
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder(name), NT_NAMED_BY_USER, &error), NT_OK);
	assert_int_equal(file.size, strlen(text));
	assert_memory_equal(file.data, text, file.size);
	nt_file_close(&file);
}

static nt_output *start(const nt_output_options *options)
{
	nt_output *output = NULL;
	nt_error error;
	assert_int_equal(nt_output_create(&output, options, &error), NT_OK);
	return output;
}

static nt_sink *add(nt_output *output, const char *path, nt_role role)
{
	nt_error error;
	nt_sink *sink = NULL;
	assert_int_equal(nt_output_add(output, path, role, &sink, &error), NT_OK);
	return sink;
}

static void assert_refused(nt_output *output, const char *path, const char *message)
{
	nt_error error;
	nt_sink *sink = NULL;
	assert_int_equal(nt_output_add(output, path, NT_ROLE_MAIN, &sink, &error), NT_ERROR_IO);
	assert_string_equal(error.message, message);
	assert_string_equal(error.place.file, path);
}

/* Before there are threads: with them the thread sanitizer hands no signal on in children. */

/* In a child: adds two files, tells the parent, waits for the signal. */
static void wait_for_signal(int ready)
{
	nt_error error;
	nt_temporaries_catch_signals(NULL);
	nt_output *output;
	nt_sink *sink;
	if (nt_output_create(&output, NULL, &error) ||
		nt_output_add(output, in_folder("a"), NT_ROLE_MAIN, &sink, &error) ||
		nt_output_add(output, in_folder("b"), NT_ROLE_BUFFER, &sink, &error) || write(ready, "!", 1) != 1)
		_exit(1);
	for (;;)
		pause();
}

TEST(signals_remove_temporaries_and_end_the_process)
{
	/* the last one while the first is ignored, as by nohup */
	const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGTERM};
	for (int i = 0; i < 4; i++) {
		int ready[2];
		assert_int_equal(pipe(ready), 0);
		const pid_t child = fork();
		if (child == 0) {
			signal(SIGINT, i == 3 ? SIG_IGN : SIG_DFL);
			signal(numbers[i], SIG_DFL);
			wait_for_signal(ready[1]);
		}
		char byte;
		assert_int_equal(read(ready[0], &byte, 1), 1);
		assert_int_equal(count_in_folder(), 2);
		if (i == 3)
			assert_int_equal(kill(child, SIGINT), 0);
		assert_int_equal(kill(child, numbers[i]), 0);
		int code;
		assert_int_equal(waitpid(child, &code, 0), child);
		assert_true(WIFSIGNALED(code));
		assert_int_equal(WTERMSIG(code), numbers[i]);
		assert_int_equal(count_in_folder(), 0);
		close(ready[0]);
		close(ready[1]);
	}
}

static void tell_changed(const char *path, const char *change)
{
	_exit(strcmp(path, in_folder("in")) == 0 && strstr(change, "shorter") ? 7 : 1);
}

/* In a child: a set of one file and a mapped input; a fault after that has become shorter, or not. */
static void fault(int number, bool shorter)
{
	nt_error error;
	nt_file file;
	nt_output *output;
	nt_sink *sink;
	signal(number, SIG_DFL);
	nt_output_catch_faults(tell_changed);
	if (nt_file_open(&file, in_folder("in"), NT_NAMED_BY_USER, &error) || !file.mapped ||
		nt_output_create(&output, NULL, &error) ||
		nt_output_add(output, in_folder("a"), NT_ROLE_MAIN, &sink, &error) ||
		(shorter && truncate(in_folder("in"), 1) != 0))
		_exit(1);
	if (number == SIGABRT)
		abort();
	raise(number);
	_exit(2);
}

/* Only a changed input makes a fault of the process an error of reading. */
TEST(faults_after_an_input_has_changed_leave_nothing)
{
	const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
	/* files of those that end by a signal stay */
	for (int i = 0; i < 8; i++) {
		const int number = numbers[i % 4], shorter = i < 4;
		put_file("in", "four", 4);
		const pid_t child = fork();
		if (child == 0)
			fault(number, shorter);
		int code;
		assert_int_equal(waitpid(child, &code, 0), child);
		if (shorter) {
			assert_true(WIFEXITED(code));
			assert_int_equal(WEXITSTATUS(code), 7);
			assert_int_equal(count_in_folder(), 1);
		} else {
			assert_true(WIFSIGNALED(code));
			assert_int_equal(WTERMSIG(code), number);
		}
	}
}

TEST(output_bytes_are_the_same_for_small_and_large_writes)
{
	enum { SIZE = 7000000, LARGE = 5000000 };
	unsigned char *bytes = malloc(SIZE);
	assert_non_null(bytes);
	for (size_t i = 0; i < SIZE; i++)
		bytes[i] = (unsigned char)(i * 2654435761u >> 13);
	nt_error error;
	nt_output *output = start(NULL);
	nt_sink *sink = add(output, in_folder("out"), NT_ROLE_MAIN);
	size_t done = 0;
	for (size_t step = 0; done < SIZE; step = step * 2 + 1) { /* 0, 1, 3 ... 2^21 - 1 */
		const size_t size = step < SIZE - done ? step : SIZE - done;
		assert_int_equal(nt_sink_write(sink, bytes + done, size, &error), NT_OK);
		done += size;
	}
	assert_int_equal(nt_output_size(output), SIZE);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	nt_file file;
	assert_int_equal(nt_file_open(&file, in_folder("out"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_int_equal(file.size, SIZE);
	assert_memory_equal(file.data, bytes, SIZE);

	/* and copies of it; what was let go of is read again */
	output = start(NULL);
	sink = add(output, in_folder("copy"), NT_ROLE_MAIN);
	nt_sink *second = add(output, in_folder("second"), NT_ROLE_BUFFER);
	assert_int_equal(nt_sink_copy(second, &file, 0, LARGE, &error), NT_OK);
	assert_int_equal(nt_output_settle(output, second, &error), NT_OK);
	char digest[NT_DIGEST_TEXT];
	assert_int_equal(nt_sink_write(sink, "head", 4, &error), NT_OK);
	assert_int_equal(nt_sink_copy(sink, &file, 1, LARGE, &error), NT_OK);
	assert_int_equal(nt_sink_copy(sink, &file, 1 + LARGE, 100, &error), NT_OK);
	assert_int_equal(nt_sink_copy(sink, &file, 0, 0, &error), NT_OK);
	assert_int_equal(nt_sink_copy(sink, &file, SIZE - 1, 2, &error), NT_ERROR_INTERNAL);
	assert_int_equal(nt_output_size(output), 2 * LARGE + 104);
	assert_int_equal(nt_output_copied(output), 2 * LARGE + 100);
	snprintf(digest, sizeof digest, "%s", nt_sink_digest(second));
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	char there[NT_DIGEST_TEXT];
	assert_int_equal(nt_digest_of_file(in_folder("second"), there, &error), NT_OK);
	assert_string_equal(there, digest);
	nt_file copy;
	assert_int_equal(nt_file_open(&copy, in_folder("copy"), NT_NAMED_BY_USER, &error), NT_OK);
	assert_int_equal(copy.size, LARGE + 104);
	assert_memory_equal(copy.data, "head", 4);
	assert_memory_equal(copy.data + 4, bytes + 1, LARGE + 100);
	nt_file_close(&copy);
	assert_memory_equal(file.data, bytes, SIZE);

	/* an output that may not grow so far */
	struct rlimit unlimited;
	assert_int_equal(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
	signal(SIGXFSZ, SIG_IGN);
	assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){LARGE / 2, unlimited.rlim_max}), 0);
	output = start(NULL);
	sink = add(output, in_folder("limited"), NT_ROLE_MAIN);
	assert_int_equal(nt_sink_copy(sink, &file, 1, LARGE, &error), NT_ERROR_IO);
	assert_int_equal(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
	signal(SIGXFSZ, SIG_DFL);
	assert_string_equal(error.message, "cannot write: File too large");
	assert_int_equal(nt_output_end(output, NT_ERROR_IO, &error), NT_ERROR_IO);
	assert_int_equal(count_in_folder(), 3);
	nt_file_close(&file);
	free(bytes);
}

/* The folder of the file that a link leads to is not the one in which sidecars are, and in which others look. */
TEST(output_through_a_link_has_the_lock_of_its_sidecars_beside_them)
{
	assert_int_equal(mkdir(in_folder("elsewhere"), 0700), 0);
	put_text_file("elsewhere/file", "old");
	assert_int_equal(symlink("elsewhere/file", in_folder("soft")), 0);
	nt_error error;
	nt_output *output = start(NULL);
	const char *temporary;
	char leader[NT_TEMPORARY_NAME];
	add(output, in_folder("soft"), NT_ROLE_MAIN);
	nt_sink *sink = add(output, in_folder("soft.bin"), NT_ROLE_BUFFER);
	assert_int_equal(nt_sink_write(sink, "new", 3, &error), NT_OK);
	assert_int_equal(nt_output_settle(output, sink, &error), NT_OK);
	assert_int_equal(nt_output_written(output, in_folder("soft.bin"), &temporary, &error), NT_OK);
	assert_true(nt_temporary_leader_of(strrchr(temporary, '/') + 1, leader));
	assert_int_equal(access(in_folder(leader), F_OK), 0);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	assert_content("soft.bin", "new");
	assert_int_equal(count_in_folder(), 3);
	assert_int_equal(unlink(in_folder("elsewhere/file")), 0);
	assert_int_equal(rmdir(in_folder("elsewhere")), 0);
}

TEST(output_no_clobber_keeps_what_exists)
{
	put_text_file("out", "old");
	nt_error error;
	nt_output *output = start(&(nt_output_options){.no_clobber = true});
	assert_refused(output, in_folder("out"), "refusing to write: the file exists already");
	/* and what came to exist meanwhile; the sidecar that was placed before is taken back */
	add(output, in_folder("late"), NT_ROLE_MAIN);
	add(output, in_folder("sidecar"), NT_ROLE_BUFFER);
	put_text_file("late", "somebody else's");
	assert_int_equal(nt_output_commit(output, &error), NT_ERROR_IO);
	assert_string_equal(error.message, "refusing to write: the file exists already");
	assert_string_equal(error.place.file, in_folder("late"));
	assert_content("late", "somebody else's");
	assert_content("out", "old");
	assert_int_equal(count_in_folder(), 2);
}

AROUND_EACH(make_folder, remove_folder)
