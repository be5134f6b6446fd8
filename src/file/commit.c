/* SPDX-License-Identifier: MIT */
/*
 * Putting a set in place, so that one rename switches from the old set to the new one.
 *
 * After each step the process may be killed, and with options.sync the power may go; the folders are synchronised
 * between the steps. "M" is the main file, "a.bin" a sidecar, "tmp" a temporary name (temporary.c).
 *
 *   step                                   who refers to what           reading M gives
 *   0  all bytes under tmp names           M -> the old a.bin           old set, or nothing
 *   1  new names are taken, never over     M -> the old a.bin           old, or nothing
 *      a file that is there: a.bin where
 *      it is free, else a.new-D.bin
 *   2  rename tmp onto M: the switch       M -> a.bin, a.new-D.bin      new
 *
 * That is all where every sidecar's name was free or had its bytes. If a sidecar replaces one of ours, what step 2
 * places is the staging main file, and it goes on:
 *
 *   3  link a.new-D.bin to tmp, rename     M -> a.new-D.bin             new; a.bin has old
 *      tmp onto a.bin, for each                                         or new bytes
 *   4  rename the final tmp onto M         M -> a.bin                   new
 *   5  unlink a.new-D.bin                  M -> a.bin                   new
 *
 * Superseded content-named files (a-D.bin) follow the same steps, without 3, unlinked before 4. The staging main file
 * names them, so that the next run removes them if this one is killed. A power cut may leave one all the same: no sync
 * is between.
 *
 * Until step 2 everything can be taken back, and is. From step 3 on a failure leaves a whole new set, under names
 * that say what they are: where link(2) or a rename is refused, the staging main file stays and the result says so.
 * The next run recognises what a killed run left: temporary files by their locks, a.bin and a.new-D.bin by the main
 * file's records or by their bytes, and removes any a.new-D.bin of these bytes to which nothing refers. If step 2
 * fails, buffers that step 1 named are removed again; images are not, since another run may use them already.
 *
 * Sets with sidecars are placed one after the other in a folder. If M is another one than when the names were chosen,
 * they are chosen anew: otherwise two runs that write M at once would leave a sidecar that nobody refers to.
 *
 * Files that may be replaced: M, because the user named it; a.bin in step 3, by the rules of sidecar.c. If a name was
 * taken since it was chosen, nothing is replaced, and the caller is told to try again.
 */
#include "file/output_parts.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>
#include "file/input.h"

static nt_status taken_meanwhile(nt_output *output, const char *path, nt_error *error)
{
	if (output->options.result)
		output->options.result->again = true;
	return nt_fail_file(error, NT_ERROR_IO, path,
		"refusing to write: the name was taken, or its file changed, meanwhile");
}

/* ---- folders ---- */

static int open_folder(const char *path)
{
	char folder[PATH_MAX]; /* no memory is asked for: what it tells of has its place */
	return open(nt_folder_of(path, folder), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

/* Not every file system lets a folder be synchronised, and not every user may open it. */
static nt_status sync_opened(int fd, const char *path, nt_error *error)
{
	const bool failed = fd >= 0 && fsync(fd) != 0 && errno != EINVAL && errno != EBADF && errno != ENOTSUP;
	const int number = errno;
	if (fd >= 0)
		close(fd);
	return failed ? nt_sink_fail(error, path, number) : NT_OK;
}

nt_status nt_output_sync_name(const char *path, nt_error *error)
{
	return sync_opened(open_folder(path), path, error);
}

/* Syncs everything so far to the disk, before the next step. */
static nt_status sync_step(const nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (const nt_sink *sink = output->first; output->options.sync && sink && !status; sink = sink->next)
		if (sink->target && sink != output->staging)
			status = nt_output_sync_name(sink->target, error);
	return status;
}

/* A file that is used as it is may not have reached the disk yet. */
static nt_status sync_used(const char *path, nt_error *error)
{
	return sync_opened(open(path, O_RDONLY | O_CLOEXEC), path, error);
}

/* ---- step 1 ---- */

static nt_status place_sidecar(nt_output *output, nt_sink *sink, nt_error *error)
{
	const char *name = nt_sink_place(sink);
	if (sink->is_of_set)
		return NT_OK;
	if (sink->there.id.inode && !nt_state_is(sink->target, &sink->there))
		return taken_meanwhile(output, sink->target, error);
	if (sink->stays)
		return output->options.sync ? sync_used(name, error) : NT_OK;
	sink->placed = nt_temporary_rename(sink->temporary, name, false);
	if (!sink->placed)
		return errno == EEXIST ? taken_meanwhile(output, name, error) : nt_sink_fail(error, name, errno);
	if (output->options.result)
		output->options.result->left = false;
	return NT_OK;
}

/* ---- step 2, and 4 ---- */

static nt_status place_main(const nt_output *output, nt_sink *sink, nt_error *error)
{
	if (!sink->temporary || sink->stays)
		return NT_OK;
	sink->placed = nt_temporary_rename(sink->temporary, sink->target, !output->options.no_clobber);
	if (sink->placed)
		return NT_OK;
	if (errno == EEXIST && output->options.no_clobber)
		return nt_sink_refuse_existing(error, sink->path);
	return nt_sink_fail(error, sink->path, errno);
}

static nt_status place_all(nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (nt_sink *sink = output->first; sink && !status; sink = sink->next)
		if (nt_sink_is_sidecar(sink))
			status = place_sidecar(output, sink, error);
	if (!status)
		status = sync_step(output, error);
	nt_sink *first = output->staging ? output->staging : output->main;
	if (!status && first)
		status = place_main(output, first, error);
	if (!status)
		return sync_step(output, error);
	/* buffers that have a name go again; the main file that would refer to them is not there */
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		if (sink->role == NT_ROLE_BUFFER && sink->placed)
			nt_temporary_remove_name(sink->temporary, nt_sink_place(sink));
	return status;
}

/* ---- steps 3 to 5 ---- */

/* The data of a sidecar under its own name too. */
static bool link_stable(const nt_sink *sink)
{
	nt_temporary *second;
	if (!nt_temporary_link(sink->staging, sink->target, &second))
		return false;
	const bool renamed = nt_temporary_rename(second, sink->target, true);
	const int number = errno;
	nt_temporary_discard(second);
	errno = number;
	return renamed;
}

/* Steps 3 to 5; the staging main file is in place. */
static nt_status settle_names(nt_output *output, nt_error *error)
{
	nt_error ignored;
	bool linked = true;
	for (const nt_sink *sink = output->first; sink && linked; sink = sink->next)
		linked = !sink->staging || link_stable(sink);
	const int number = errno;
	nt_status status = sync_step(output, error);
	if (status)
		return status;
	nt_output_remove_superseded(output);
	if (!linked || place_main(output, output->main, &ignored)) {
		const char *why = strerror(linked ? errno : number);
		nt_buffer *note = output->options.result ? &output->options.result->note : NULL;
		for (const nt_sink *sink = output->first; sink && note; sink = sink->next)
			if (sink->staging)
				nt_buffer_format(note, "; the data of %s stays in %s (%s)", nt_sink_name(sink, false),
					nt_sink_name(sink, true), why);
		return NT_OK;
	}
	status = sync_step(output, error);
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		if (sink->staging)
			unlink(sink->staging);
	return status;
}

/* ---- one after the other ---- */

/* Waits until no other set is being placed in the folder: a lock of the folder, which ends with its descriptor. False:
 * the file system has none. */
static bool lock_folder(int fd)
{
	int result;
	do
		result = flock(fd, LOCK_EX);
	while (result != 0 && errno == EINTR);
	return result == 0;
}

/* By the main file that was there the names of sidecars were chosen. */
static bool main_is_unchanged(const nt_sink *main)
{
	struct stat status;
	return main->there.id.inode ? nt_state_is(main->target, &main->there) : lstat(main->target, &status) != 0;
}

nt_status nt_output_place(nt_output *output, nt_error *error)
{
	sigset_t before;
	const nt_sink *sidecar = output->first;
	while (sidecar && !nt_sink_is_sidecar(sidecar))
		sidecar = sidecar->next;
	const bool alone = sidecar && output->main && output->main->target;
	const int folder = alone ? open_folder(output->main->path) : -1;
	const bool locked = lock_folder(folder);
	nt_temporaries_hold(&before);
	nt_status status = NT_OK;
	const nt_sink *main = output->main && output->main->temporary && !output->main->stays ? output->main : NULL;
	if (alone && main && !output->options.no_clobber && !main_is_unchanged(main))
		status = taken_meanwhile(output, main->path, error);
	/* since it was added somebody else may have come to read it */
	struct stat there;
	if (!status && main && stat(main->target, &there) == 0 && nt_trace_is_read_elsewhere(&there))
		status = nt_fail_file(error, NT_ERROR_IO, main->path,
			"refusing to write: another input of this run is made from it");
	if (!status)
		status = place_all(output, error);
	if (!status && output->staging)
		status = settle_names(output, error);
	else if (!status)
		nt_output_remove_superseded(output);
	if (!status && locked && !output->main->in_place && output->options.find_ownership)
		nt_output_remove_stale_staging(output);
	nt_temporaries_release(&before);
	if (folder >= 0)
		close(folder);
	return status;
}
