/* SPDX-License-Identifier: MIT */
/*
 * Reports to files and folders: see run.h. A report is written as any output is, to a temporary file that takes
 * its name at the end, and never over an input.
 */
#include "pipeline/run.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "file/input.h"
#include "file/output.h"
#include "file/path.h"

/* Names may have 255 bytes; the rest is for endings and temporary names. */
enum { MOST_STEM = 100, HEAD_BYTES = 1024 };

static const char index_name[] = "index.html";

static nt_status to_sink(void *user, const void *bytes, size_t size, nt_error *error)
{
	return nt_sink_write(user, bytes, size, error);
}

/* Writes a document, or a text. The inputs of a folder are known by check_page(). */
static nt_status write_file(const nt_report_target *target, const char *path, const nt_report_list *what,
	const char *text, nt_error *error)
{
	const nt_output_options options = {.no_clobber = target->no_clobber};
	nt_output *output = NULL;
	nt_sink *sink = NULL;
	nt_status status = nt_output_create(&output, &options, error);
	if (status)
		return status;
	for (size_t i = 0; i < target->input_count && !target->folder && !status; i++)
		status = nt_output_protect(output, target->inputs[i], NULL, error);
	if (!status)
		status = nt_output_add(output, path, NT_ROLE_MAIN, &sink, error);
	if (!status)
		status = text ? nt_sink_write(sink, text, strlen(text), error)
			      : nt_report_write(what, target->format, to_sink, sink, error);
	return nt_output_end(output, status, error);
}

nt_status nt_report_to_file(nt_report *const *reports, size_t count, const nt_report_target *target, nt_error *error)
{
	const nt_report_list what = {.items = (const nt_report *const *)reports, .count = count,
		.style = target->style, .diff = target->diff};
	return write_file(target, target->path, &what, NULL, error);
}

nt_status nt_baseline_open(nt_baseline *baseline, const char *path, nt_error *error)
{
	nt_file file;
	nt_status status = nt_file_open(&file, path, NT_NAMED_BY_USER, error);
	if (status)
		return status;
	status = nt_baseline_read(baseline, (const char *)file.data, file.size, error);
	nt_file_close(&file);
	return status ? nt_error_in_file(error, path) : NT_OK;
}

/* ---- names of pages ---- */

/* Characters that are safe in a name on any system, and in a shell. */
static void append_stem(nt_buffer *name, const char *input)
{
	const char *stem = nt_last_part(input);
	size_t length = strlen(stem);
	if (length > MOST_STEM)
		for (length = MOST_STEM; length > 0 && ((unsigned char)stem[length] & 0xc0) == 0x80;)
			length--;
	for (size_t i = 0; i < length; i++) {
		const unsigned char c = (unsigned char)stem[i];
		const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
			c == '_' ||
			c >= 0x80 || (i > 0 && (c == '.' || c == '-'));
		nt_buffer_append(name, plain ? stem + i : "_", 1);
	}
}

/* The attempt's name for an input's page; NULL: no memory. */
static char *page_name(const char *input, unsigned attempt)
{
	nt_buffer name = {0};
	append_stem(&name, input);
	if (attempt)
		nt_buffer_format(&name, "-%08x", (unsigned)(nt_hash_name(attempt, input) >> 32));
	nt_buffer_text(&name, ".html");
	if (name.failed)
		nt_buffer_free(&name);
	return name.data;
}

/* Systems that do not see the case of letters have one file for both names. */
static uint64_t hash_of_name(const char *name)
{
	uint64_t hash = 0;
	for (const char *c = name; *c; c++) {
		const char lower = (char)(*c >= 'A' && *c <= 'Z' ? *c - 'A' + 'a' : *c);
		hash = nt_hash_bytes(hash, &lower, 1);
	}
	return hash;
}

/* A page is taken by one before, or by the index. */
static nt_status name_pages(nt_report_folder *folder, nt_error *error)
{
	const nt_report_target *target = folder->target;
	uint64_t hash = hash_of_name(index_name);
	nt_key_set taken = {0};
	folder->pages = nt_calloc(target->input_count, sizeof *folder->pages);
	bool named = folder->pages && nt_key_add(&taken, &hash, sizeof hash) != UINT32_MAX;
	for (size_t i = 0; i < target->input_count && named; i++) {
		char *name = NULL;
		size_t before = taken.count;
		for (unsigned attempt = 0; named && taken.count == before; attempt++) {
			free(name);
			name = page_name(target->inputs[i], attempt);
			hash = name ? hash_of_name(name) : 0;
			named = name && nt_key_add(&taken, &hash, sizeof hash) != UINT32_MAX;
		}
		folder->pages[i] = name;
	}
	nt_key_set_free(&taken);
	return named ? NT_OK : nt_fail_memory(error);
}

/* The path of a file of the folder, to be freed; NULL: out of memory. */
static char *path_of(const nt_report_folder *folder, const char *name)
{
	const char *directory = folder->target->path;
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s%s%s", directory, directory[strlen(directory) - 1] == '/' ? "" : "/", name);
	if (path.failed)
		nt_buffer_free(&path);
	return path.data;
}

/* ---- what may be replaced ---- */

static nt_status note_inputs(nt_report_folder *folder, nt_error *error)
{
	const nt_report_target *target = folder->target;
	struct stat info;
	for (size_t i = 0; i < target->input_count; i++) {
		if (stat(target->inputs[i], &info) != 0)
			continue;
		const nt_file_id id = nt_file_id_of(&info);
		if (nt_key_add(&folder->inputs, &id, sizeof id) == UINT32_MAX)
			return nt_fail_memory(error);
	}
	return NT_OK;
}

/* Whether the head of a file says that a report is in it. */
static nt_status look_for_mark(const char *path, bool *ours, nt_error *error)
{
	char head[HEAD_BYTES];
	const int fd = open(path, O_RDONLY | O_CLOEXEC);
	const ssize_t size = fd < 0 ? -1 : read(fd, head, sizeof head);
	const int number = errno;
	if (fd >= 0)
		close(fd);
	if (size < 0)
		return nt_fail_file(error, NT_ERROR_IO, path, "cannot read what is to be replaced: %s",
			strerror(number));
	*ours = memmem(head, (size_t)size, nt_html_mark, strlen(nt_html_mark)) != NULL;
	return NT_OK;
}

/* Whether a page may be written: over what nmtan made, and over no input. */
static nt_status check_page(const nt_report_folder *folder, const char *path, nt_error *error)
{
	const nt_output_options options = {.no_clobber = folder->target->no_clobber};
	struct stat info;
	bool ours = false;
	if (!path)
		return nt_fail_memory(error);
	if (stat(path, &info) != 0)
		return NT_OK; /* what else is in the way is said when it is written */
	nt_status status = nt_output_check_clobber(&options, path, error);
	if (!status && S_ISREG(info.st_mode))
		status = look_for_mark(path, &ours, error);
	if (status)
		return status;
	const nt_file_id id = nt_file_id_of(&info);
	if (ours && nt_key_find(&folder->inputs, &id, sizeof id) == UINT32_MAX)
		return NT_OK;
	return nt_fail_file(error, NT_ERROR_IO, path, "refusing to write: it is no page of a report that nmtan made");
}

static nt_status check_pages(const nt_report_folder *folder, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i <= folder->target->input_count && !status; i++) {
		char *path = path_of(folder, i ? folder->pages[i - 1] : index_name);
		status = check_page(folder, path, error);
		free(path);
	}
	return status;
}

/* ---- writing ---- */

/* A page of a document, or a part that is a text. */
static nt_status write_page(const nt_report_folder *folder, const char *page, const nt_report_list *what,
	const char *text, nt_error *error)
{
	char *path = path_of(folder, page);
	nt_status status = check_page(folder, path, error);
	if (!status)
		status = write_file(folder->target, path, what, text, error);
	if (status && path)
		nt_error_in_output(error, path);
	free(path);
	return status;
}

/* Whether a part is there. Any other file of its name is refused. */
static nt_status find_part(const char *path, const char *text, bool *there, nt_error *error)
{
	struct stat info;
	nt_file file;
	if (!path)
		return nt_fail_memory(error);
	*there = stat(path, &info) == 0 && S_ISREG(info.st_mode);
	if (!*there)
		return NT_OK; /* what else is in the way is said when it is written */
	nt_status status = nt_file_open(&file, path, NT_NAMED_BY_US, error);
	if (status)
		return status;
	if (file.size != strlen(text) || memcmp(file.data, text, file.size) != 0)
		status = nt_fail_file(error, NT_ERROR_IO, path,
			"refusing to write: it is no part of a report that nmtan made");
	nt_file_close(&file);
	return status;
}

/* Writes the parts that are missing, or only looks for them. */
static nt_status put_parts(const nt_report_folder *folder, bool write, nt_error *error)
{
	nt_status status = NT_OK;
	for (int kind = 0; kind < NT_HTML_PART_COUNT && !status; kind++) {
		nt_buffer name = {0};
		const char *text = nt_html_part(kind, &name);
		char *path = name.failed ? NULL : path_of(folder, name.data);
		bool there = false;
		status = find_part(path, text, &there, error);
		if (!status && write && !there)
			status = write_page(folder, name.data, NULL, text, error);
		nt_buffer_free(&name);
		free(path);
	}
	return status;
}

nt_status nt_report_folder_begin(nt_report_folder *folder, const nt_report_target *target, nt_error *error)
{
	*folder = (nt_report_folder){.target = target};
	nt_status status = name_pages(folder, error);
	if (!status)
		status = note_inputs(folder, error);
	if (!status)
		status = check_pages(folder, error);
	if (!status)
		status = put_parts(folder, false, error);
	if (!status && mkdir(target->path, 0777) && errno != EEXIST)
		status = nt_fail(error, NT_ERROR_IO, "cannot make the folder \"%s\": %s", target->path,
			strerror(errno));
	return status ? status : put_parts(folder, true, error);
}

nt_status nt_report_folder_add(nt_report_folder *folder, size_t input, nt_report *report, nt_error *error)
{
	const nt_report_list what = {.items = (const nt_report *const *)&report, .count = 1,
		.style = {.index = index_name}};
	nt_buffer link = {0};
	nt_status status = write_page(folder, folder->pages[input], &what, NULL, error);
	if (status)
		return status;
	nt_uri_append_path(&link, folder->pages[input]);
	if (!link.failed)
		nt_report_index_row(report, link.data, &folder->rows);
	if (link.failed || folder->rows.failed)
		status = nt_fail_memory(error);
	nt_buffer_free(&link);
	return status;
}

nt_status nt_report_folder_end(nt_report_folder *folder, nt_error *error)
{
	const nt_report_list what = {.rows = &folder->rows};
	return write_page(folder, index_name, &what, NULL, error);
}

void nt_report_folder_free(nt_report_folder *folder)
{
	for (size_t i = 0; folder->pages && i < folder->target->input_count; i++)
		free(folder->pages[i]);
	free(folder->pages);
	nt_key_set_free(&folder->inputs);
	nt_buffer_free(&folder->rows);
}
