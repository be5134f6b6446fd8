/* SPDX-License-Identifier: MIT */
/*
 * A process that faults removes its temporary files and ends, also where the faulting thread is in the midst of a
 * commit: it does not wait for itself.
 */
#include "file/output.h"
#include "folder.h"
#include "test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATIENCE_SECONDS = 20 };

/* As in_folder(), for a second path in one call. */
static const char *in_folder_a(const char *name)
{
	static char path[400];
	snprintf(path, sizeof path, "%s", in_folder(name));
	return path;
}

/* A temporary file in the folder. */
static nt_temporary *make_file(void)
{
	nt_temporary *made = NULL;
	if (nt_temporary_create(in_folder("out.glb"), 0600, NULL, &made) < 0)
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

static atomic_bool holds, ends, released;

static void *commit(void *unused)
{
	sigset_t before;
	nt_temporaries_hold(&before);
	atomic_store(&holds, true);
	while (!atomic_load(&ends))
		usleep(100);
	usleep(100000);
	atomic_store(&released, true);
	nt_temporaries_release(&before);
	return unused;
}

/* It never returns, and is waited for by nobody. */
static void *commit_later(void *unused)
{
	sigset_t before;
	while (!atomic_load(&ends))
		usleep(100);
	usleep(50000);
	nt_temporaries_hold(&before);
	_exit(4);
	return unused;
}

static void fault_beside_commit(void)
{
	pthread_t other, late;
	if (pthread_create(&other, NULL, commit, NULL) || pthread_create(&late, NULL, commit_later, NULL))
		_exit(2);
	while (!atomic_load(&holds))
		usleep(100);
	atomic_store(&ends, true);
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

/* On a disk of this machine alone a lock of any boot would be seen. */
TEST(names_tell_whose_lock_would_be_seen)
{
	nt_temporary *made = make_file();
	const char *name = strrchr(nt_temporary_path(made), '/') + 1;
	char other[400];
	assert_true(nt_temporary_is_lockable(name, false));
	snprintf(other, sizeof other, ".nmtan-0123456789abcdef0123456789abcdef%s", name + 39);
	assert_true(nt_temporary_is_lockable(other, true));
	assert_false(nt_temporary_is_lockable(other, false));
	assert_false(nt_temporary_is_lockable(".nmtan-1-0-0.tmp", true));
	nt_temporary_discard(made);
}

static void move_and_end(void)
{
	nt_temporary *made;
	if (nt_temporary_create(in_folder("ending/out.glb"), 0600, NULL, &made) < 0 ||
		rename(in_folder_a("ending"), in_folder("ended")))
		_exit(2);
	nt_temporaries_remove_all();
}

/* Moving the folder takes along what is being written in it. */
TEST(a_folder_may_be_moved)
{
	nt_temporary *first, *second;
	sigset_t before;
	assert_int_equal(mkdir(in_folder("old"), 0700), 0);
	assert_true(nt_temporary_create(in_folder("old/a.glb"), 0600, NULL, &first) >= 0);
	assert_true(nt_temporary_create(in_folder("old/b.glb"), 0600, NULL, &second) >= 0);
	assert_int_equal(rename(in_folder_a("old"), in_folder("new")), 0);
	/* another one of this name is not it */
	assert_int_equal(mkdir(in_folder("old"), 0700), 0);
	nt_temporaries_hold(&before);
	assert_true(nt_temporary_rename(first, in_folder("old/a.glb"), false));
	nt_temporaries_release(&before);
	nt_temporary_discard(first);
	nt_temporary_discard(second);
	assert_int_equal(access(in_folder("new/a.glb"), F_OK), 0);
	assert_int_equal(unlink(in_folder("new/a.glb")), 0);
	assert_int_equal(rmdir(in_folder("new")), 0); /* nothing else is in it */
	assert_int_equal(rmdir(in_folder("old")), 0);
	/* a signal has them removed there, too */
	assert_int_equal(mkdir(in_folder("ending"), 0700), 0);
	assert_true(child_ends(move_and_end));
	assert_int_equal(rmdir(in_folder("ended")), 0);
}

static void clean_led(void)
{
	nt_temporaries_clean(in_folder("led/"));
}

TEST(a_leader_has_the_lock_of_others)
{
	nt_temporary *leader, *led;
	char name[NT_TEMPORARY_NAME];
	assert_int_equal(mkdir(in_folder("led"), 0700), 0);
	assert_true(nt_temporary_create(in_folder("led/a.png"), 0600, NULL, &leader) >= 0);
	assert_true(nt_temporary_create(in_folder("led/b.png"), 0600, leader, &led) >= 0);
	assert_true(nt_temporary_close(led));
	assert_true(nt_temporary_leader_of(strrchr(nt_temporary_path(led), '/') + 1, name));
	assert_string_equal(name, strrchr(nt_temporary_path(leader), '/') + 1);
	assert_false(nt_temporary_leader_of(name, name));
	assert_true(child_ends(clean_led));
	assert_int_equal(access(nt_temporary_path(leader), F_OK), 0);
	assert_int_equal(access(nt_temporary_path(led), F_OK), 0);
	nt_temporary_discard(leader);
	assert_true(child_ends(clean_led));
	assert_int_equal(access(nt_temporary_path(led), F_OK), -1);
	nt_temporary_discard(led);
	assert_int_equal(rmdir(in_folder("led")), 0);
}

AROUND_ALL(make_folder, remove_folder)
