/* SPDX-License-Identifier: MIT */
/*
 * Only what the scene needs is read: of a GLB of one hundred primitives, one of which needs tangents, the
 * pages of that one, of the document and of nothing else are touched. The input's map is made unreadable;
 * each page gets readable, and counted, when it is first read. A dry run, so that nobody copies the rest.
 * NT_HUNDRED_MB says how large the file is to be.
 */
#include "folder.h"
#include "test.h"
#include <signal.h>
#include <stdio.h>
#include <sys/mman.h>
#include "pipeline/run.h"

enum { PAGE = 4096, MOST_PAGES = 1 << 18 };

static bool guards; /* the next file that is mapped */
static unsigned char *map;
static size_t map_size;
static volatile unsigned char touched[MOST_PAGES];

void *__real_mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset);
void *__wrap_mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset);

void *__wrap_mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset)
{
	void *got = __real_mmap(address, size, protection, flags, fd, offset);
	if (guards && fd >= 0 && got != MAP_FAILED && mprotect(got, size, PROT_NONE) == 0) {
		guards = false;
		map = got;
		map_size = size;
	}
	return got;
}

static void on_fault(int number, siginfo_t *info, void *context)
{
	(void)context;
	unsigned char *at = info->si_addr;
	if (!map || at < map || at >= map + map_size) {
		signal(number, SIG_DFL);
		return;
	}
	const size_t page = (size_t)(at - map) / PAGE;
	touched[page] = 1;
	mprotect(map + page * PAGE, PAGE, PROT_READ);
}

static size_t count_touched(size_t begin, size_t end)
{
	size_t count = 0;
	for (size_t page = begin / PAGE; page <= (end - 1) / PAGE; page++)
		count += touched[page];
	return count;
}

/* Makes the file and runs it. *begin, *end receive the bytes of the 38th primitive. */
static void run(size_t *begin, size_t *end, size_t expected_solved)
{
	char command[800];
	const char *megabytes = getenv("NT_HUNDRED_MB");
	snprintf(command, sizeof command, "python3 tests/support/inputs.py gltf_hundred %s %s %d",
		megabytes ? megabytes : "30", in_folder("in.glb"), expected_solved ? 0 : 1);
	FILE *said = popen(command, "r");
	assert_non_null(said);
	assert_int_equal(fscanf(said, "%zu %zu", begin, end), 2);
	assert_int_equal(pclose(said), 0);

	const struct sigaction watch = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO | SA_NODEFER};
	struct sigaction before;
	assert_int_equal(sigaction(SIGSEGV, &watch, &before), 0);
	const nt_settings settings = {.io.texcoord_set = -1, .dry_run = true, .output_format = NT_FORMAT_GLB};
	nt_summary summary;
	nt_error error;
	map = NULL;
	guards = true;
	memset((void *)(uintptr_t)touched, 0, sizeof touched);
	assert_int_equal(nt_run(in_folder("in.glb"), in_folder("out.glb"), &settings, &summary, &error), NT_OK);
	sigaction(SIGSEGV, &before, NULL);
	assert_non_null(map);
	assert_true(map_size / PAGE < MOST_PAGES);
	assert_int_equal(summary.mesh_count, 100);
	assert_int_equal(summary.solved_count, expected_solved);
	nt_summary_free(&summary);
	const size_t all = count_touched(0, map_size), own = count_touched(*begin, *end);
	print_message("%zu of %zu bytes touched, %zu of them of the primitive\n", all * PAGE, map_size, own * PAGE);
	/* --timing says the same, but for pages that lie half in the document and half in the buffer */
	const size_t read = (size_t)summary.bytes_read;
	assert_true(read <= (all + 2) * PAGE && read + 3 * PAGE >= all * PAGE);
}

TEST(one_primitive_of_a_hundred_is_read)
{
	size_t begin, end;
	run(&begin, &end, 1);
	/* Every page of its own, as many for the JSON as that is long (what is before the first primitive,
	 * which has the same size as the 38th), and no more. */
	const size_t own = count_touched(begin, end), size = end - begin;
	assert_int_equal(own, (end - 1) / PAGE - begin / PAGE + 1);
	const size_t first = begin - 37 * size;
	assert_true(count_touched(0, map_size) <= own + first / PAGE + 2);
}

TEST(nothing_is_read_where_nothing_is_needed)
{
	size_t begin, end;
	run(&begin, &end, 0);
	const size_t first = begin - 37 * (end - begin);
	assert_true(count_touched(0, map_size) <= first / PAGE + 2);
}

AROUND_ALL(make_folder, remove_folder)
