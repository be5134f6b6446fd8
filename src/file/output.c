/* SPDX-License-Identifier: MIT */
/*
 * Output sets: see input.h. Everything that can be refused is refused when a file is added, before a
 * byte is computed: a folder that is missing, a target that is a directory, an input or a file that
 * must stay. Renames come at the end, all at once; what they have placed is taken back when a later
 * one fails.
 *
 * A target that is a symbolic link keeps being one: the file it points to is replaced.
 */
#include "file/input.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/temporary.h"

/* Buffer of a sink, and from which size on the kernel copies better than write() does. */
enum { SINK_BUFFER_BYTES = 256 * 1024, KERNEL_COPY_BYTES = 1024 * 1024,
	MAPPED_COPY_BYTES = 2 * 1024 * 1024 };

struct nt_sink {
	nt_sink *next;            /* in the order of adding */
	nt_temporary *temporary;  /* NULL: written through */
	int fd;
	bool main, placed;
	bool shared_fd;           /* standard output: not ours to close */
	bool no_kernel_copy;      /* it was tried in vain */
	bool dry;                 /* counts bytes and drops them */
	uint64_t size;
	uint64_t copied; /* of them from an input file as they are */
	size_t used;              /* bytes in buffer */
	unsigned char *buffer;
	char *path;               /* as the caller named it */
	char *target;             /* where symbolic links lead; NULL when written through */
};

typedef struct protected_file {
	dev_t device;
	ino_t inode;
	char *path;
	const char *way_out; /* a constant; NULL: none */
} protected_file;

struct nt_output {
	nt_output_options options;
	nt_sink *first, *last, *main;
	protected_file *guarded;
	size_t guarded_count, guarded_capacity;
};

static nt_status fail_at(nt_error *error, const char *path)
{
	return nt_error_in_file(error, path);
}

static nt_status fail_write(nt_error *error, const char *path, int number)
{
	if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot write: %s", strerror(number));
	return fail_at(error, path);
}

nt_status nt_output_create(nt_output **output, const nt_output_options *options, nt_error *error)
{
	*output = nt_calloc(1, sizeof **output);
	if (!*output)
		return nt_fail_memory(error);
	if (options)
		(*output)->options = *options;
	return NT_OK;
}

nt_status nt_output_protect(nt_output *output, const char *path, const char *way_out, nt_error *error)
{
	struct stat status;
	const bool known = strcmp(path, "-") == 0 ? fstat(STDIN_FILENO, &status) == 0
						  : stat(path, &status) == 0;
	/* what is not there cannot be overwritten, what is no regular file is not replaced */
	if (!known || !S_ISREG(status.st_mode))
		return NT_OK;
	char *copy = strdup(path);
	if (!copy || !nt_grow((void **)&output->guarded, &output->guarded_capacity,
			     output->guarded_count + 1, sizeof *output->guarded)) {
		free(copy);
		return nt_fail_memory(error);
	}
	output->guarded[output->guarded_count++] =
		(protected_file){status.st_dev, status.st_ino, copy, way_out};
	return NT_OK;
}

/* Refuses a target that exists and has to stay. */
static nt_status check_existing(const nt_output *output, const char *path,
	const struct stat *status, nt_error *error)
{
	if (S_ISDIR(status->st_mode)) {
		nt_fail(error, NT_ERROR_IO, "cannot write: it is a directory");
		return fail_at(error, path);
	}
	for (size_t i = 0; i < output->guarded_count; i++) {
		const protected_file *file = &output->guarded[i];
		if (file->device != status->st_dev || file->inode != status->st_ino)
			continue;
		nt_fail(error, NT_ERROR_IO, "refusing to write: it is the same file as the input %s%s%s",
			strcmp(file->path, "-") == 0 ? "(standard input)" : file->path,
			file->way_out ? "; " : "", file->way_out ? file->way_out : "");
		return fail_at(error, path);
	}
	if (output->options.no_clobber && S_ISREG(status->st_mode)) {
		nt_fail(error, NT_ERROR_IO, "refusing to write: the file exists already");
		return fail_at(error, path);
	}
	return NT_OK;
}

/* Two files of one set must not end at one place. */
static nt_status check_twins(const nt_output *output, const nt_sink *sink, nt_error *error)
{
	for (const nt_sink *other = output->first; other; other = other->next) {
		if (!other->target || strcmp(other->target, sink->target) != 0)
			continue;
		nt_fail(error, NT_ERROR_IO,
			"refusing to write: another file of this output has the same name");
		return fail_at(error, sink->path);
	}
	return NT_OK;
}

/* Creates the temporary beside the target and explains why it cannot. */
static nt_status open_temporary(nt_sink *sink, nt_error *error)
{
	sink->fd = nt_temporary_create(sink->target, &sink->temporary);
	if (sink->fd >= 0)
		return NT_OK;
	const int number = errno;
	const char *slash = strrchr(sink->target, '/');
	const int length = slash ? (int)(slash - sink->target) + (slash == sink->target) : 1;
	const char *folder = slash ? sink->target : ".";
	if (number == ENOENT || number == ENOTDIR)
		nt_fail(error, NT_ERROR_IO, "cannot write: there is no folder \"%.*s\"", length, folder);
	else if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot create a file in the folder \"%.*s\": %s", length,
			folder, strerror(number));
	return fail_at(error, sink->path);
}

static nt_status open_sink(const nt_output *output, nt_sink *sink, nt_error *error)
{
	sink->dry = output->options.dry_run;
	if (strcmp(sink->path, "-") == 0) {
		sink->fd = STDOUT_FILENO;
		sink->shared_fd = true;
		return NT_OK;
	}
	struct stat status;
	const bool exists = stat(sink->path, &status) == 0;
	if (exists) {
		const nt_status checked = check_existing(output, sink->path, &status, error);
		if (checked)
			return checked;
		if (sink->dry && !S_ISREG(status.st_mode))
			return NT_OK;
		if (!S_ISREG(status.st_mode)) {
			sink->fd = open(sink->path, O_WRONLY | O_CLOEXEC);
			return sink->fd < 0 ? fail_write(error, sink->path, errno) : NT_OK;
		}
	}
	sink->target = exists ? realpath(sink->path, NULL) : strdup(sink->path);
	if (!sink->target)
		return fail_write(error, sink->path, errno);
	const nt_status checked = check_twins(output, sink, error);
	return checked || sink->dry ? checked : open_temporary(sink, error);
}

static void free_sink(nt_sink *sink)
{
	if (sink->fd >= 0 && !sink->shared_fd)
		close(sink->fd);
	nt_temporary_discard(sink->temporary);
	free(sink->buffer);
	free(sink->path);
	free(sink->target);
	free(sink);
}

nt_status nt_output_add(nt_output *output, const char *path, bool main, nt_sink **sink,
	nt_error *error)
{
	nt_sink *added = nt_calloc(1, sizeof *added);
	if (!added)
		return nt_fail_memory(error);
	added->fd = -1;
	added->path = strdup(path);
	added->buffer = nt_alloc(SINK_BUFFER_BYTES, 1);
	const nt_status status = added->path && added->buffer ? open_sink(output, added, error)
								 : nt_fail_memory(error);
	if (status) {
		free_sink(added);
		return status;
	}
	if (output->last)
		output->last->next = added;
	else
		output->first = added;
	output->last = added;
	if (main && !output->main) {
		added->main = true;
		output->main = added;
	}
	*sink = added;
	return NT_OK;
}

/* Takes `count` written bytes off the front of two parts. */
static void advance(struct iovec parts[2], size_t count)
{
	for (int i = 0; i < 2; i++) {
		const size_t taken = count < parts[i].iov_len ? count : parts[i].iov_len;
		parts[i].iov_base = (char *)parts[i].iov_base + taken;
		parts[i].iov_len -= taken;
		count -= taken;
	}
}

/* Writes both parts to the end, whatever the kernel takes at a time. */
static nt_status write_parts(nt_sink *sink, struct iovec parts[2], nt_error *error)
{
	while (parts[0].iov_len || parts[1].iov_len) {
		const ssize_t count = parts[0].iov_len ? writev(sink->fd, parts, 2)
						       : writev(sink->fd, parts + 1, 1);
		if (count >= 0)
			advance(parts, (size_t)count);
		else if (errno == EAGAIN)
			poll(&(struct pollfd){.fd = sink->fd, .events = POLLOUT}, 1, -1);
		else if (errno != EINTR)
			return fail_write(error, sink->path, errno);
	}
	return NT_OK;
}

/* The buffer, then `size` bytes that do not go through it. */
static nt_status flush_with(nt_sink *sink, const void *bytes, size_t size, nt_error *error)
{
	struct iovec parts[2] = {{.iov_base = sink->buffer, .iov_len = sink->used},
		{.iov_base = (void *)(uintptr_t)bytes, .iov_len = size}};
	sink->used = 0;
	return write_parts(sink, parts, error);
}

nt_status nt_sink_write(nt_sink *sink, const void *bytes, size_t size, nt_error *error)
{
	sink->size += size;
	if (sink->dry)
		return NT_OK;
	if (size > SINK_BUFFER_BYTES - sink->used) {
		if (size >= SINK_BUFFER_BYTES / 2)
			return flush_with(sink, bytes, size, error);
		const nt_status status = flush_with(sink, NULL, 0, error);
		if (status)
			return status;
	}
	if (size)
		memcpy(sink->buffer + sink->used, bytes, size);
	sink->used += size;
	return NT_OK;
}

/* Lets the kernel copy what it can; *done receives how much that was. Falling short is no error: the
 * rest is written, and a fault of the disk shows itself there. */
static void copy_in_kernel(nt_sink *sink, const nt_file *from, size_t offset, size_t size,
	size_t *done)
{
	*done = 0;
	while (*done < size) {
		off64_t begin = (off64_t)(offset + *done);
		const ssize_t count = copy_file_range(from->fd, &begin, sink->fd, NULL, size - *done, 0);
		if (count < 0 && errno == EINTR)
			continue;
		if (count <= 0) {
			sink->no_kernel_copy = true;
			return;
		}
		*done += (size_t)count;
	}
}

/* Whether pages of a range fall on pages of the output. Where they do not, the kernel would write every page of the
 * output in two pieces: 62 ms for 197 MB, where pages that are fetched and written take 52. */
static bool pages_meet(const nt_sink *sink, size_t offset)
{
	return (sink->size - offset) % (size_t)sysconf(_SC_PAGESIZE) == 0;
}

/* From the map, some of it at a time, which is let go of again. */
static nt_status copy_mapped(nt_sink *sink, const nt_file *from, size_t offset, size_t size,
	nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t left = size, part; left && !status; left -= part, offset += part) {
		part = left < MAPPED_COPY_BYTES ? left : MAPPED_COPY_BYTES;
		nt_file_fetch(from, offset, part);
		status = nt_sink_write(sink, from->data + offset, part, error);
		nt_file_release(from, offset, part);
	}
	return status;
}

nt_status nt_sink_copy(nt_sink *sink, const nt_file *from, size_t offset, size_t size,
	nt_error *error)
{
	if (offset > from->size || size > from->size - offset)
		return nt_fail(error, NT_ERROR_INTERNAL, "a range to copy is outside of its file");
	sink->copied += size;
	if (size < KERNEL_COPY_BYTES || !from->mapped || !sink->temporary || sink->no_kernel_copy)
		return nt_sink_write(sink, from->data + offset, size, error);
	if (!pages_meet(sink, offset))
		return copy_mapped(sink, from, offset, size, error);
	const nt_status status = flush_with(sink, NULL, 0, error);
	if (status)
		return status;
	size_t done;
	copy_in_kernel(sink, from, offset, size, &done);
	sink->size += done;
	return nt_sink_write(sink, from->data + offset + done, size - done, error);
}

nt_status nt_output_written(nt_output *output, const char *path, const char **temporary,
	nt_error *error)
{
	*temporary = NULL;
	for (nt_sink *sink = output->first; sink; sink = sink->next)
		if (sink->temporary && strcmp(sink->path, path) == 0) {
			*temporary = nt_temporary_path(sink->temporary);
			return flush_with(sink, NULL, 0, error);
		}
	return NT_OK;
}

uint64_t nt_output_size(const nt_output *output)
{
	uint64_t size = 0;
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		size += sink->size;
	return size;
}

uint64_t nt_output_copied(const nt_output *output)
{
	uint64_t size = 0;
	for (const nt_sink *sink = output->first; sink; sink = sink->next)
		size += sink->copied;
	return size;
}

/* Everything onto the disk and closed. */
static nt_status finish_sink(const nt_output *output, nt_sink *sink, nt_error *error)
{
	const nt_status status = flush_with(sink, NULL, 0, error);
	if (status)
		return status;
	if (output->options.sync && sink->temporary && fsync(sink->fd) != 0)
		return fail_write(error, sink->path, errno);
	if (sink->shared_fd || sink->fd < 0)
		return NT_OK;
	const int fd = sink->fd;
	sink->fd = -1;
	return close(fd) != 0 && errno != EINTR ? fail_write(error, sink->path, errno) : NT_OK;
}

static nt_status place_sink(const nt_output *output, nt_sink *sink, nt_error *error)
{
	if (!sink->temporary)
		return NT_OK;
	sink->placed = nt_temporary_rename(sink->temporary, sink->target, !output->options.no_clobber);
	if (sink->placed)
		return NT_OK;
	if (errno == EEXIST && output->options.no_clobber) {
		nt_fail(error, NT_ERROR_IO, "refusing to write: the file exists already");
		return fail_at(error, sink->path);
	}
	return fail_write(error, sink->path, errno);
}

/* Companions in order, the main file last; what is in place is removed again when one fails. */
static nt_status place_all(nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	nt_temporaries_hold();
	for (nt_sink *sink = output->first; sink && !status; sink = sink->next)
		if (sink != output->main)
			status = place_sink(output, sink, error);
	if (!status && output->main)
		status = place_sink(output, output->main, error);
	for (const nt_sink *sink = output->first; sink && status; sink = sink->next)
		if (sink->placed)
			unlink(sink->target);
	nt_temporaries_release();
	return status;
}

/* The renames themselves onto the disk: the folder of each file. Best effort: not every file system
 * lets a folder be synchronised. */
static void sync_folder(const char *target)
{
	const char *slash = strrchr(target, '/');
	char *folder = slash ? strndup(target, (size_t)(slash - target) + 1) : strdup(".");
	const int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
	if (fd >= 0) {
		fsync(fd);
		close(fd);
	}
	free(folder);
}

nt_status nt_output_commit(nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (nt_sink *sink = output->first; sink && !status; sink = sink->next)
		status = finish_sink(output, sink, error);
	if (!status)
		status = place_all(output, error);
	for (const nt_sink *sink = output->first; sink && !status; sink = sink->next)
		if (output->options.sync && sink->target)
			sync_folder(sink->target);
	nt_output_abort(output);
	return status;
}

void nt_output_abort(nt_output *output)
{
	if (!output)
		return;
	for (nt_sink *sink = output->first; sink;) {
		nt_sink *next = sink->next;
		free_sink(sink);
		sink = next;
	}
	for (size_t i = 0; i < output->guarded_count; i++)
		free(output->guarded[i].path);
	free(output->guarded);
	free(output);
}
