/* SPDX-License-Identifier: MIT */
/*
 * Writing the bytes of one file of an output set: see output.h. Small pieces are gathered, large ones go straight
 * through.
 */
#include "file/output_parts.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/fs.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/uio.h>
#include <unistd.h>
#include "base/memory.h"
#include "file/input.h"
#include "file/output.h"

/* Ranges of a file that are read once more, and files that get their room at once: that is a system call of 30 us. */
enum { COPIED_BYTES = 2 * 1024 * 1024, LARGE_FILE_BYTES = 1024 * 1024 };

/* Writes of this size go straight through, behind what is in the buffer; so do those for which it has no room. */
enum { STRAIGHT_BYTES = 128 * 1024 };

nt_status nt_sink_fail(nt_error *error, const char *path, int number)
{
	if (number == ENOMEM)
		nt_fail_memory(error);
	else
		nt_fail(error, NT_ERROR_IO, "cannot write: %s", strerror(number));
	return nt_error_in_output(error, path);
}

nt_status nt_sink_refuse_existing(nt_error *error, const char *path)
{
	return nt_fail_file(error, NT_ERROR_IO, path, "refusing to write: the file exists already");
}

/* Without it ext4 reserves room for each of its blocks when that is written: 6.4 ms instead of 4.6 for 35 MB. A
 * refusal changes nothing: if the disk is full, the write that finds it so says it. */
void nt_sink_expect(nt_sink *sink, uint64_t size)
{
	if (sink->temporary && size >= LARGE_FILE_BYTES && size <= INT64_MAX)
		(void)!fallocate(sink->fd, FALLOC_FL_KEEP_SIZE, 0, (off_t)size);
}

/* Takes `count` written bytes off the front of two parts. */
static void advance(struct iovec parts[2], size_t count)
{
	for (int i = 0; i < 2; i++) {
		const size_t taken = count < parts[i].iov_len ? count : parts[i].iov_len;
		if (taken)
			parts[i].iov_base = (char *)parts[i].iov_base + taken;
		parts[i].iov_len -= taken;
		count -= taken;
	}
}

/* Writes both parts to the end, whatever the kernel takes at a time. */
static nt_status write_parts(nt_sink *sink, struct iovec parts[2], nt_error *error)
{
	while (parts[0].iov_len || parts[1].iov_len) {
		const struct iovec *const first = parts[0].iov_len ? parts : parts + 1;
		const ssize_t count = writev(sink->fd, first, parts[0].iov_len ? 2 : 1);
		if (count >= 0) {
			advance(parts, (size_t)count);
		} else if (errno == EAGAIN) {
			poll(&(struct pollfd){.fd = sink->fd, .events = POLLOUT}, 1, -1);
		} else if (errno == EFAULT && nt_watch_touch(parts[1].iov_base, parts[1].iov_len)) {
			continue; /* an input became shorter; who commits asks for that */
		} else if (errno != EINTR) {
			return nt_sink_fail(error, sink->path, errno);
		}
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

nt_status nt_sink_flush(nt_sink *sink, nt_error *error)
{
	return flush_with(sink, NULL, 0, error);
}

nt_status nt_sink_write(nt_sink *sink, const void *bytes, size_t size, nt_error *error)
{
	if (sink->digest)
		nt_digest_add(sink->digest, bytes, size);
	sink->size += size;
	if (sink->dry)
		return NT_OK;
	if (size >= STRAIGHT_BYTES || size > NT_SINK_BUFFER_BYTES - sink->used)
		return flush_with(sink, bytes, size, error);
	if (size)
		memcpy(sink->buffer + sink->used, bytes, size);
	sink->used += size;
	return NT_OK;
}

/* Whether the sink now has the blocks of a whole file, which costs nothing where the file system can (btrfs, XFS). */
static bool share_blocks(nt_sink *sink, const nt_file *from)
{
	const off_t size = (off_t)from->size;
	return from->fd >= 0 && sink->size == 0 && sink->temporary && ioctl(sink->fd, FICLONE, from->fd) == 0 &&
		ftruncate(sink->fd, size) == 0 && lseek(sink->fd, size, SEEK_SET) == size;
}

/* A large range of a file goes through the buffer, which stays in the cache: 0.04 s of processor time for 200 MB, as cp
 * takes, while writing from the map took 0.17 (Zen 5, ext4). Pages of the map are let go. If the file cannot be read,
 * the map says what is there (watch.c). */
nt_status nt_sink_copy(nt_sink *sink, const nt_file *from, size_t offset, size_t size, nt_error *error)
{
	if (offset > from->size || size > from->size - offset)
		return nt_fail(error, NT_ERROR_INTERNAL, "a range to copy is outside of its file");
	sink->copied += size;
	if (size == from->size && size > 0 && share_blocks(sink, from)) {
		sink->size = size;
		if (sink->digest)
			nt_digest_add(sink->digest, from->data, size);
		return NT_OK;
	}
	if (size < COPIED_BYTES || !from->mapped || sink->dry)
		return nt_sink_write(sink, from->data + offset, size, error);
	while (size) {
		const nt_status status = nt_sink_flush(sink, error);
		if (status)
			return status;
		const size_t part = size < NT_SINK_BUFFER_BYTES ? size : NT_SINK_BUFFER_BYTES;
		const ssize_t count = pread(from->fd, sink->buffer, part, (off_t)offset);
		if (count <= 0)
			return nt_sink_write(sink, from->data + offset, size, error);
		if (sink->digest)
			nt_digest_add(sink->digest, sink->buffer, (size_t)count);
		sink->size += (size_t)count;
		sink->used = (size_t)count;
		nt_file_release(from, offset, (size_t)count);
		offset += (size_t)count;
		size -= (size_t)count;
	}
	return NT_OK;
}

nt_status nt_sink_finish(nt_sink *sink, bool sync, nt_error *error)
{
	if (sink->fd < 0)
		return NT_OK;
	const nt_status status = nt_sink_flush(sink, error);
	if (status)
		return status;
	if (sync && sink->temporary && fsync(sink->fd) != 0)
		return nt_sink_fail(error, sink->path, errno);
	if (sink->shared_fd)
		return NT_OK;
	/* closing tells what the disk refused (NFS); a temporary file keeps its lock, or has that of another one */
	if (sink->temporary && nt_temporary_is_led(sink->temporary)) {
		sink->fd = -1;
		return nt_temporary_close(sink->temporary) ? NT_OK : nt_sink_fail(error, sink->path, errno);
	}
	const int fd = sink->temporary ? fcntl(sink->fd, F_DUPFD_CLOEXEC, 0) : sink->fd;
	if (!sink->temporary)
		sink->fd = -1;
	return fd < 0 || (close(fd) != 0 && errno != EINTR) ? nt_sink_fail(error, sink->path, errno) : NT_OK;
}

/* ---- Base64 ---- */

/* Groups of three bytes become four characters, on their way to a sink in a buffer on the stack. */

enum { BUFFER_GROUPS = 4096 };

static void encode_group(const unsigned char *in, char *out)
{
	static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	const unsigned bits = (unsigned)in[0] << 16 | (unsigned)in[1] << 8 | in[2];
	for (int i = 0; i < 4; i++)
		out[i] = digits[bits >> (18 - 6 * i) & 63];
}

nt_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error)
{
	const unsigned char *in = bytes;
	char out[4 * BUFFER_GROUPS];
	size_t used = 0;
	while (base64->rest_count > 0 && base64->rest_count < 3 && size > 0) {
		base64->rest[base64->rest_count++] = *in++;
		size--;
	}
	if (base64->rest_count == 3) {
		encode_group(base64->rest, out);
		used = 4;
		base64->rest_count = 0;
	}
	for (; size >= 3; in += 3, size -= 3) {
		if (used == sizeof out) {
			const nt_status status = nt_sink_write(base64->sink, out, used, error);
			if (status != NT_OK)
				return status;
			used = 0;
		}
		encode_group(in, out + used);
		used += 4;
	}
	while (size-- > 0)
		base64->rest[base64->rest_count++] = *in++;
	return used ? nt_sink_write(base64->sink, out, used, error) : NT_OK;
}

/* Less than three bytes, with what stands for those that lack. */
static void encode_last(const unsigned char *in, size_t count, char out[4])
{
	unsigned char group[3] = {0};
	memcpy(group, in, count);
	encode_group(group, out);
	memset(out + count + 1, '=', 3 - count);
}

nt_status nt_base64_end(nt_base64 *base64, nt_error *error)
{
	if (base64->rest_count == 0)
		return NT_OK;
	char out[4];
	encode_last(base64->rest, base64->rest_count, out);
	base64->rest_count = 0;
	return nt_sink_write(base64->sink, out, sizeof out, error);
}

void nt_base64_append(nt_buffer *buffer, const void *bytes, size_t size)
{
	const unsigned char *in = bytes;
	char *out = nt_buffer_extend(buffer, (size / 3 + (size % 3 != 0)) * 4);
	if (!out)
		return;
	for (; size >= 3; in += 3, out += 4, size -= 3)
		encode_group(in, out);
	if (size)
		encode_last(in, size, out);
}
