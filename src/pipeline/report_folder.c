/* SPDX-License-Identifier: MIT */
/*
 * Reports as folders: see report_folder.h.
 */
#include "pipeline/report_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>
#include "file/input.h"
#include "file/lookup.h"
#include "file/output.h"
#include "file/path.h"
#include "file/uri.h"

/* Names may have 255 bytes; the rest is for endings and temporary names. */
enum { MOST_STEM = 100, HEAD_BYTES = 1024 };

static const char index_name[] = "index.html";

/* ---- names ---- */

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

static bool is_taken(const nt_report_folder *folder, const nt_hash_index *names, const char *name)
{
	const uint64_t hash = hash_of_name(name);
	size_t at = NT_HASH_BEGIN;
	uint32_t page;
	while ((page = nt_hash_index_next(names, hash, &at)) != UINT32_MAX)
		if (strcasecmp(folder->pages[page], name) == 0)
			return true;
	return strcasecmp(name, index_name) == 0;
}

static nt_status name_pages(nt_report_folder *folder, nt_error *error)
{
	const nt_report_target *target = folder->target;
	nt_hash_index names = {0};
	folder->pages = nt_calloc(target->input_count, sizeof *folder->pages);
	bool named = folder->pages;
	for (size_t i = 0; i < target->input_count && named; i++) {
		unsigned attempt = 0;
		char *name = page_name(target->inputs[i], attempt);
		while (name && is_taken(folder, &names, name)) {
			free(name);
			name = page_name(target->inputs[i], ++attempt);
		}
		folder->pages[i] = name;
		named = name && nt_hash_index_add(&names, hash_of_name(name), (uint32_t)i);
	}
	nt_hash_index_free(&names);
	return named ? NT_OK : nt_fail_memory(error);
}

static bool append_path(const nt_report_folder *folder, const char *page, nt_buffer *path)
{
	const char *directory = folder->target->path;
	path->size = 0;
	nt_buffer_text(path, directory);
	if (directory[strlen(directory) - 1] != '/')
		nt_buffer_text(path, "/");
	nt_buffer_text(path, page);
	return !path->failed;
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

static nt_status check_page(const nt_report_folder *folder, const char *path, nt_error *error)
{
	const nt_output_options options = {.no_clobber = folder->target->no_clobber};
	struct stat info;
	bool ours = false;
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
	nt_buffer path = {0};
	nt_status status = append_path(folder, index_name, &path)
		? check_page(folder, path.data, error) : nt_fail_memory(error);
	for (size_t i = 0; i < folder->target->input_count && !status; i++)
		status = append_path(folder, folder->pages[i], &path)
			? check_page(folder, path.data, error) : nt_fail_memory(error);
	nt_buffer_free(&path);
	return status;
}

/* ---- writing ---- */

static nt_status write_page(const nt_report_folder *folder, const char *page, const nt_report_target *what,
	nt_report *const *reports, size_t count, nt_error *error)
{
	nt_report_target target = *what;
	nt_buffer path = {0};
	nt_status status = append_path(folder, page, &path)
		? check_page(folder, path.data, error) : nt_fail_memory(error);
	target.path = path.data;
	target.input_count = 0; /* check_page() knows them */
	if (!status)
		status = nt_report_to_file(reports, count, &target, error);
	if (status && path.data)
		nt_error_in_output(error, path.data);
	nt_buffer_free(&path);
	return status;
}

/* Whether a part is there. Any other file of its name is refused. */
static nt_status find_part(const char *path, const char *text, bool *there, nt_error *error)
{
	struct stat info;
	nt_file file;
	*there = stat(path, &info) == 0 && S_ISREG(info.st_mode);
	if (!*there)
		return NT_OK; /* what else is in the way is said when it is written */
	nt_status status = nt_file_open_untraced(&file, path, error);
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
	nt_buffer name = {0}, path = {0};
	nt_status status = NT_OK;
	for (int kind = 0; kind < NT_HTML_PART_COUNT && !status; kind++) {
		bool there = false;
		name.size = 0;
		const nt_report_target part = {.text = nt_html_part(kind, &name)};
		status = !name.failed && append_path(folder, name.data, &path)
			? find_part(path.data, part.text, &there, error) : nt_fail_memory(error);
		if (!status && write && !there)
			status = write_page(folder, name.data, &part, NULL, 0, error);
	}
	nt_buffer_free(&name);
	nt_buffer_free(&path);
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
	nt_report_target page = *folder->target;
	nt_buffer link = {0};
	page.style.index = index_name;
	nt_status status = write_page(folder, folder->pages[input], &page, &report, 1, error);
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
	nt_report_target page = *folder->target;
	page.rows = &folder->rows;
	return write_page(folder, index_name, &page, NULL, 0, error);
}

void nt_report_folder_free(nt_report_folder *folder)
{
	for (size_t i = 0; folder->pages && i < folder->target->input_count; i++)
		free(folder->pages[i]);
	free(folder->pages);
	nt_key_set_free(&folder->inputs);
	nt_buffer_free(&folder->rows);
}
