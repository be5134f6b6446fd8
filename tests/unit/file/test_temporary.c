/* SPDX-License-Identifier: MIT */
/*
 * A process that faults removes its temporary files and ends, also where the faulting thread is in the midst of a
 * commit: it does not wait for itself.
 */
#include "file/temporary.h"
#include "folder.h"
#include "test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATIENCE_SECONDS = 20 };

/* A temporary file in the folder. */
static nt_temporary *make_file(void)
{
	nt_temporary *made = NULL;
	if (nt_temporary_create(in_folder("out.glb"), 0600, &made) < 0)
		_exit(2);
	return made;
}

/* Whether a child that does this ends by itself, with 0. */
static bool child_ends(void (*work)(void))
{
	const pid_t child = fork();
	if (child == 0) {
		alarm(PATIENCE_SECONDS);
		work();
		_exit(0);
	}
	int status = -1;
	assert_int_equal(waitpid(child, &status, 0), child);
	return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static void fault_in_commit(void)
{
	sigset_t before;
	const nt_temporary *made = make_file();
	nt_temporaries_hold(&before);
	nt_temporaries_remove_all(); /* as the handler of a fault does */
	if (access(nt_temporary_path(made), F_OK) == 0)
		_exit(3);
}

TEST(a_fault_in_a_commit_ends_the_process)
{
	assert_true(child_ends(fault_in_commit));
}

static atomic_bool holds, released;

static void *commit(void *unused)
{
	sigset_t before;
	nt_temporaries_hold(&before);
	atomic_store(&holds, true);
	usleep(100000);
	atomic_store(&released, true);
	nt_temporaries_release(&before);
	return unused;
}

static void fault_beside_commit(void)
{
	pthread_t other;
	if (pthread_create(&other, NULL, commit, NULL))
		_exit(2);
	while (!atomic_load(&holds))
		usleep(100);
	nt_temporaries_remove_all();
	if (!atomic_load(&released) || pthread_join(other, NULL))
		_exit(3);
}

TEST(a_fault_waits_for_the_commit_of_another_thread)
{
	assert_true(child_ends(fault_beside_commit));
}

static void release_and_fault(void)
{
	sigset_t before;
	nt_temporaries_hold(&before);
	nt_temporaries_release(&before);
	fault_beside_commit();
}

TEST(a_hold_that_is_over_is_no_hold)
{
	assert_true(child_ends(release_and_fault));
}

/* Ends without removing its file, of which the parent gets the path. */
TEST(stale_files_are_those_that_nobody_has_locked)
{
	int ends[2];
	char path[400] = "";
	assert_int_equal(pipe(ends), 0);
	const pid_t child = fork();
	if (child == 0) {
		nt_temporary *dead = make_file();
		if (write(ends[1], nt_temporary_path(dead), strlen(nt_temporary_path(dead)) + 1) < 0)
			_exit(1);
		_exit(0);
	}
	assert_int_equal(waitpid(child, NULL, 0), child);
	assert_true(read(ends[0], path, sizeof path) > 0);
	close(ends[0]);
	close(ends[1]);
	assert_int_equal(access(path, F_OK), 0);
	nt_temporary *alive = make_file(), *second = NULL;
	put_file("linked", "x", 1);
	assert_true(nt_temporary_link(in_folder("linked"), in_folder("out.bin"), &second));
	put_file(".nmtan-x", "x", 1);
	nt_temporaries_clean(in_folder(""));
	assert_int_equal(access(path, F_OK), -1);
	assert_int_equal(access(nt_temporary_path(alive), F_OK), 0);
	assert_int_equal(access(nt_temporary_path(second), F_OK), 0);
	assert_int_equal(access(in_folder(".nmtan-x"), F_OK), 0);
	const char *name = strrchr(path, '/') + 1;
	char other[400];
	assert_true(nt_temporary_is_lockable(name, false));
	snprintf(other, sizeof other, ".nmtan-0123456789abcdef0123456789abcdef%s", name + 39);
	assert_true(nt_temporary_is_lockable(other, true));
	assert_false(nt_temporary_is_lockable(other, false));
	assert_false(nt_temporary_is_lockable(".nmtan-1-0-0.tmp", true));
	nt_temporary_discard(alive);
	nt_temporary_discard(second);
}

int main(void)
{
	return run_group_within("file/temporary", make_folder, remove_folder);
}
