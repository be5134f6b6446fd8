/* SPDX-License-Identifier: MIT */
#include "folder.h"
#include "batch/batch.h"
#include "test.h"

#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#define INPUTS(...) ((const char *const[]){__VA_ARGS__}), \
	sizeof((const char *const[]){__VA_ARGS__}) / sizeof(const char *)

/* Stands for nt_run: the input's first letter says how long it takes, "x" in it that it fails. */
static atomic_uint threads_seen;

static nt_status fake_run(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error)
{
	(void)output;
	threads_seen = settings->io.threads;
	usleep((useconds_t)(input[0] - 'a') * 2000);
	summary->mesh_count = (size_t)(input[0] - 'a');
	if (strchr(input, 'x'))
		return nt_fail(error, NT_ERROR_INPUT, "%s is bad", input);
	return NT_OK;
}

typedef struct run_log {
	char names[128];
	size_t meshes, failures;
} run_log;

static void note(void *user, nt_job *job)
{
	run_log *l = user;
	strcat(l->names, job->input);
	l->meshes += job->outcome->summary.mesh_count;
	if (job->status) {
		l->failures++;
		assert_non_null(strstr(job->outcome->error.message, job->input));
	}
}

static void pass(void *user, nt_job *job)
{
	(void)job;
	++*(size_t *)user;
}

/* Stands for nt_run where the bound of memory is about: notes who runs beside whom, with how many threads, and what
 * that takes by the gate's guess. Runs stay until as many as there is room for have been beside one another, half a
 * minute at most, so that no scheduler keeps them apart. */
static atomic_int running, most_running, awaited, wide_runs, wide_beside;
static atomic_size_t running_bytes, most_bytes;

enum { LARGE = 500000, SMALL = 125000 };

static nt_status watched_run(const char *input, const char *output, const nt_settings *settings, nt_summary *summary,
	nt_error *error)
{
	(void)output, (void)summary, (void)error;
	const size_t need = settings->io.threads == 4 ? 0 : (1 << 20) + 8 * (atoi(input + 1) % 4 ? LARGE : SMALL);
	const size_t bytes = atomic_fetch_add(&running_bytes, need) + need;
	for (size_t most = most_bytes; bytes > most && !atomic_compare_exchange_weak(&most_bytes, &most, bytes);)
		;
	const int now = atomic_fetch_add(&running, 1) + 1;
	for (int most = most_running; now > most && !atomic_compare_exchange_weak(&most_running, &most, now);)
		;
	usleep(2000);
	for (int i = 0; i < 15000 && most_running < awaited; i++)
		usleep(2000);
	if (settings->io.threads == 4) {
		wide_runs++;
		wide_beside += atomic_load(&running) > 1 || now > 1;
	}
	atomic_fetch_sub(&running, 1);
	atomic_fetch_sub(&running_bytes, need);
	return NT_OK;
}

TEST(the_bound_of_memory_keeps_jobs_waiting)
{
	static char names[12][20];
	const char *inputs[12];
	static char bytes[LARGE];
	/* one megabyte and eight bytes for each byte: 5 MB and, every fourth, 2 MB */
	for (int i = 0; i < 12; i++) {
		snprintf(names[i], sizeof names[i], "m%02d.obj", i);
		put_file(inputs[i] = names[i], bytes, i % 4 ? LARGE : SMALL);
	}
	const struct {
		uint64_t memory;
		int beside, wide;
	} cases[] = {{100 << 20, 4, 0}, {11 << 20, 2, 0}, {6 << 20, 1, 0}, {4 << 20, 1, 9}};
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		nt_batch batch;
		nt_error error;
		run_log l = {0};
		const nt_settings settings = {.io.threads = 4, .check = true};
		most_running = wide_runs = wide_beside = 0;
		most_bytes = 0;
		awaited = cases[i].beside;
		assert_int_equal(nt_batch_check(&batch, inputs, 12, &error), NT_OK);
		nt_batch_run(&batch, &settings,
			&(nt_batch_options){.run = watched_run, .jobs = 4, .memory = cases[i].memory,
						       .done = note, .user = &l});
		assert_string_equal(l.names,
			"m00.objm01.objm02.objm03.objm04.objm05.objm06.objm07.objm08.objm09.objm10.objm11.obj");
		assert_in_range(most_running, cases[i].beside, 4);
		assert_in_range(most_bytes, 0, cases[i].memory);
		assert_int_equal(wide_runs, cases[i].wide);
		assert_int_equal(wide_beside, 0);
		nt_batch_free(&batch);
	}
}

/* Stands for nt_run where memory is for one at a time: has none at the first try, which waits for the other's. */
static atomic_int tries[2];

static nt_status hungry_run(const char *input, const char *output, const nt_settings *settings, nt_summary *summary,
	nt_error *error)
{
	(void)output, (void)settings;
	const int now = atomic_fetch_add(&running, 1) + 1, own = input[0] - 'a';
	const bool first = tries[own]++ == 0;
	summary->mesh_count++;
	for (int i = 0; i < 15000 && first && !(tries[0] && tries[1]); i++)
		usleep(2000);
	atomic_fetch_sub(&running, 1);
	if (first || input[1] == 'x')
		return nt_fail_memory(error);
	assert_int_equal(now, 1);
	return NT_OK;
}

TEST(what_had_no_memory_beside_others_is_tried_again_alone_with_a_limit_too)
{
	put_text_file("a.obj", "");
	put_text_file("bx.obj", "");
	for (int limited = 0; limited < 2; limited++) {
		nt_batch batch;
		nt_error error;
		size_t ran = 0;
		const nt_settings settings = {.io.threads = 2, .check = true, .max_memory = limited ? 100 << 20 : 0};
		tries[0] = tries[1] = 0;
		assert_int_equal(nt_batch_check(&batch, INPUTS("a.obj", "bx.obj"), &error), NT_OK);
		nt_batch_run(&batch, &settings, &(nt_batch_options){.run = hungry_run, .jobs = 2, .memory = 100 << 20,
			.done = pass, .user = &ran});
		assert_int_equal(ran, 2);
		assert_int_equal(batch.jobs[0].status, NT_OK);
		assert_int_equal(batch.jobs[1].status, limited ? NT_ERROR_LIMIT : NT_ERROR_MEMORY);
		assert_int_equal(tries[0], 2);
		assert_int_equal(tries[1], 2);
		nt_batch_free(&batch);
	}
}

/* Stands for nt_run: a file changes between the moment when the trace notes it and the one when the record does. */
static struct {
	bool of_output;
	const char *text; /* it has this then; NULL: it stays */
	bool is_other;    /* by another file, which takes its name */
} change;
static unsigned changing_runs;

static void put_with_time(const char *path, const char *text, const struct stat *info)
{
	put_text_file(path, text);
	if (info)
		utimensat(AT_FDCWD, path, (struct timespec[]){info->st_atim, info->st_mtim}, 0);
}

static nt_status changing_run(const char *input, const char *output, const nt_settings *settings, nt_summary *summary,
	nt_error *error)
{
	struct stat read, written;
	(void)settings, (void)error;
	changing_runs++;
	put_text_file(output, "made");
	assert_int_equal(stat(input, &read) + stat(output, &written), 0);
	nt_trace_use(&summary->trace);
	nt_trace_note(NT_TRACE_READ, input, NULL, &read);
	nt_trace_note(NT_TRACE_WRITTEN, output, NULL, &written);
	nt_trace_use(NULL);
	usleep(30000);
	if (change.text && changing_runs == 1) {
		const char *path = change.of_output ? output : input;
		put_with_time(change.is_other ? "other" : path, change.text,
			change.of_output && !change.is_other && strlen(change.text) == 4 ? NULL
				: change.of_output ? &written : &read);
		assert_int_equal(change.is_other ? rename("other", path) : 0, 0);
	}
	return NT_OK;
}

TEST(what_changes_before_the_record_has_it_is_made_again)
{
	static const __typeof__(change) rows[] = {{false, NULL, false}, {false, "next", false}, {false, "next", true},
		{false, "longer", false}, {true, "next", false}, {true, "next", true}, {true, "longer", false}};
	for (size_t i = 0; i < 2 * sizeof rows / sizeof *rows; i++) {
		change = rows[i / 2];
		changing_runs = 0;
		put_text_file("c.obj", "text");
		usleep(30000);
		for (int run = 0; run < 2; run++) {
			nt_batch batch;
			nt_update *update;
			nt_error error;
			size_t ran = 0;
			const nt_settings settings = {.io.threads = 1};
			const nt_update_options options = {.look = true, .record = "r", .options = "",
				.by = i % 2 ? NT_UPDATE_BY_CONTENT : NT_UPDATE_BY_TIME};
			assert_int_equal(nt_update_begin(&update, &options, &error), NT_OK);
			assert_int_equal(nt_batch_pair(&batch, "c.obj", "c.glb", &error), NT_OK);
			nt_batch_run(&batch, &settings, &(nt_batch_options){.run = changing_run, .update = update,
				.done = pass, .user = &ran});
			assert_int_equal(batch.jobs[0].status, NT_OK);
			nt_batch_free(&batch);
			nt_update_end(update);
		}
		assert_int_equal(changing_runs, change.text ? 2 : 1);
		assert_int_equal(unlink("r"), 0);
	}
}

TEST(one_input_has_all_threads)
{
	nt_batch batch;
	nt_error error;
	run_log l = {0};
	const nt_settings settings = {.io.threads = 5};
	assert_int_equal(nt_batch_pair(&batch, "a", "b", &error), NT_OK);
	assert_string_equal(batch.jobs[0].output, "b");
	nt_batch_run(&batch, &settings, &(nt_batch_options){.run = fake_run, .done = note, .user = &l});
	assert_int_equal(threads_seen, 5);
	nt_batch_free(&batch);
}

AROUND_ALL(enter_folder, leave_folder)
