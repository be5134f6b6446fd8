/* SPDX-License-Identifier: MIT */
/*
 * The manifest: see session.h.
 */
#include "cli/session.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/structs.h"
#include "cli/messages.h"
#include "file/input.h"
#include "file/path.h"
#include "report/render/render.h"
#include "report/report.h"
#include "scene/values.h"

/* A job that failed for want of memory has a line all the same. */
enum { LINE_BYTES = 16 * 1024 };

/* ---- a line ---- */

/* Whether a path names another file once its ".." are resolved as they are spelled: one may stand behind a link. */
static bool leads_elsewhere(const char *path, const char *resolved)
{
	struct stat own, other;
	if (!strstr(path, "/../"))
		return false;
	const bool is_there = stat(path, &own) == 0, is_other = stat(resolved, &other) == 0;
	return is_there != is_other || (is_there && !nt_same_file(&own, &other));
}

/* The path of a file in one spelling, whichever run met it: as the input or output (`like`) if it is that, relative to
 * the folder of the run if `like` is relative, else absolute; as it was met if that would be another file, or without
 * memory. */
static const char *shown_path(nt_buffer *shown, const nt_manifest *manifest, const char *path, const char *like)
{
	nt_buffer whole = {0}, other = {0};
	shown->size = 0;
	if (manifest->current.size) {
		nt_path_join(&whole, manifest->current.data, path);
		nt_path_join(&other, manifest->current.data, like);
	}
	const bool known = whole.data && other.data && !whole.failed && !other.failed &&
		!leads_elsewhere(path, whole.data),
		   same = known && strcmp(whole.data, other.data) == 0;
	if (known && like[0] != '/')
		nt_path_relative(shown, manifest->current.data, whole.data);
	else
		nt_buffer_text(shown, known ? whole.data : path);
	nt_buffer_free_into(&whole, shown);
	nt_buffer_free_into(&other, shown);
	return same ? like : shown->failed ? path : shown->data;
}

/* A new output is read once more, while the system still has it in memory. Streams are no more. */
static void append_digest(nt_buffer *out, const char *path)
{
	char digest[NT_DIGEST_TEXT] = "";
	struct stat info;
	nt_error unused;
	if (stat(path, &info) == 0 && S_ISREG(info.st_mode) && !nt_digest_of_file(path, digest, &unused) && digest[0])
		nt_put(out, NT_JSON, ",'xxh128':%s", digest);
}

/* A digest of names, in their order. */
static void append_missing_digest(nt_buffer *out, const nt_manifest *manifest, const nt_job *job, const nt_trace *trace)
{
	uint64_t digest = 0;
	nt_buffer shown = {0};
	for (size_t i = 0; i < trace->count; i++) {
		if (trace->files[i].kind != NT_TRACE_MISSING)
			continue;
		const char *path = shown_path(&shown, manifest, trace->files[i].path, job->input);
		digest = nt_hash_unkeyed(digest, path, strlen(path) + 1);
	}
	nt_buffer_free(&shown);
	if (digest)
		nt_put(out, NT_JSON, ",'missing_digest':%" PRIx64, digest);
}

/* Files of one kind; those that are there with their sizes, and with digests where that is wanted. */
static void append_files(nt_buffer *out, const char *key, const nt_manifest *manifest, const nt_job *job,
	const nt_trace *trace, nt_trace_kind kind, bool digests)
{
	nt_buffer shown = {0};
	nt_put(out, NT_JSON, ",'%-s':[", key);
	for (size_t i = 0; i < trace->count; i++) {
		const nt_trace_file *file = &trace->files[i];
		if (file->kind != kind)
			continue;
		const char *path = shown_path(&shown, manifest, file->path,
			kind == NT_TRACE_WRITTEN && job->output ? job->output : job->input);
		if (kind == NT_TRACE_MISSING || kind == NT_TRACE_SEARCHED) {
			nt_put(out, NT_JSON, ",%s", path);
			continue;
		}
		nt_put(out, NT_JSON, ",{'path':%s,'bytes':%" PRIu64, path, file->size);
		if (digests)
			append_digest(out, file->path);
		nt_buffer_text(out, "}");
	}
	nt_buffer_text(out, "]");
	nt_buffer_free(&shown);
}

static void append_error(nt_buffer *out, const nt_error *error)
{
	const nt_place *place = &error->place;
	nt_put(out, NT_JSON, ",'error':{'message':%s",
		error->message[0] ? error->message : nt_status_text(error->status));
	if (place->file[0])
		nt_put(out, NT_JSON, ",'file':%s", place->file);
	if (place->line)
		nt_put(out, NT_JSON, ",'line':%zu", place->line);
	if (place->offset != NT_NO_OFFSET)
		nt_put(out, NT_JSON, ",'offset':%" PRIu64, place->offset);
	if (place->pointer[0])
		nt_put(out, NT_JSON, ",'pointer':%s", place->pointer);
	if (place->object[0])
		nt_put(out, NT_JSON, ",'object':%s", place->object);
	nt_buffer_text(out, "}");
}

static void append_codes(nt_buffer *out, const char *key, const size_t counts[NT_CODE_COUNT])
{
	nt_put(out, NT_JSON, ",'%-s':{", key);
	for (int code = 0; code < NT_CODE_COUNT; code++)
		if (counts[code])
			nt_put(out, NT_JSON, ",%s:%zu", nt_code_info((nt_code)code)->name, counts[code]);
	nt_buffer_text(out, "}");
}

/* Triangles and vertices: of what got tangents; of a check, of all primitives that it judged,
 * each with its own vertices. */
static void append_sizes(nt_buffer *out, const nt_summary *s, bool check)
{
	size_t triangles = s->triangle_count, before = s->vertex_count, split = s->appended_tangents;
	size_t after = before + s->appended_normals + split + s->made.copies;
	if (check && s->report && !s->report->failure) {
		triangles = before = after = split = 0;
		for (size_t i = 0; i < s->report->mesh_count; i++) {
			const nt_report_mesh *m = &s->report->meshes[i];
			triangles += m->triangle_count;
			before += m->vertices_before;
			after += m->vertices_after;
			split += m->added_mirror + m->added_direction;
		}
	}
	nt_put(out, NT_JSON, ",'triangles':%zu,'vertices_before':%zu,'vertices_after':%zu,'split':%zu", triangles,
		before, after, split);
}

/* Whether a finding of a stage counts, as in a report: --ignore, --severity and --min-severity say so. */
static bool counts(const nt_finding *finding, const nt_report_options *judged)
{
	const uint8_t said = judged->severity[finding->code];
	const nt_severity severity = said ? (nt_severity)(said - 1) : nt_finding_severity(finding);
	return !judged->ignore[finding->code] && severity >= judged->min_severity;
}

/* The findings and the result of a run. The report of one that did not fail has those of the stages, too. */
static void append_run(nt_buffer *out, const nt_summary *s, const nt_report_options *judged, bool check)
{
	const bool reported = s->report && !s->report->failure;
	size_t found[NT_CODE_COUNT] = {0};
	for (size_t i = 0; i < s->findings.count; i++) {
		const nt_finding *finding = &s->findings.items[i];
		if (counts(finding, judged) && !(reported && nt_is_found_again(finding)))
			found[finding->code] += finding->count;
	}
	for (int code = 0; s->report && code < NT_CODE_COUNT; code++)
		found[code] = s->report->counts[code] ? s->report->counts[code] : found[code];
	append_codes(out, "findings", found);
	append_codes(out, "fixed", s->fixed);
	append_sizes(out, s, check);
	if (s->welded.before)
		nt_put(out, NT_JSON, ",'weld_before':%zu,'weld_after':%zu", s->welded.before, s->welded.after);
	nt_put(out, NT_JSON, ",'repaired':%zu,'sorted_instead':%zu,'summed_instead':%zu", s->repaired,
		s->counts.sorted_instead, s->counts.summed_instead);
	if (s->origin[0] != 0 || s->origin[1] != 0 || s->origin[2] != 0) {
		char text[NT_ORIGIN_TEXT];
		nt_put(out, NT_JSON, ",'origin':[%-s]", nt_origin_text(s->origin, text));
	}
	if (s->tangents_digest)
		nt_put(out, NT_JSON, ",'tangents':%" PRIx64, s->tangents_digest);
	nt_put(out, NT_JSON, ",'bytes_read':%" PRIu64 ",'bytes_written':%" PRIu64, s->bytes_read, s->bytes_written);
	nt_buffer_text(out, ",\"seconds\":{");
	for (int stage = 0; stage < NT_STAGE_COUNT; stage++)
		nt_put(out, NT_JSON, ",%s:%.6f", nt_stage_name((nt_stage)stage), s->seconds[stage]);
	nt_put(out, NT_JSON, ",'total':%.6f}", s->total_seconds);
}

static void append_job(nt_buffer *out, const nt_job *job, const nt_manifest *manifest, int exit_code)
{
	static const nt_trace nothing;
	const nt_trace *trace = job->outcome ? &job->outcome->summary.trace : &nothing;
	nt_put(out, NT_JSON, "{'input':%s,'status':%s,'exit_code':%d,'nmtan':%s,'options':%s", job->input,
		job->end == NT_JOB_UNTRIED ? "untried" : job->end == NT_JOB_CURRENT ? "up-to-date"
		: job->status ? "failed" : job->outcome->summary.left ? "left" : "done", exit_code, nmtan_version(),
		manifest->options);
	append_files(out, "outputs", manifest, job, trace, NT_TRACE_WRITTEN, job->end == NT_JOB_RAN && !job->status);
	append_files(out, "dependencies", manifest, job, trace, NT_TRACE_READ, false);
	append_files(out, "missing", manifest, job, trace, NT_TRACE_MISSING, false);
	append_files(out, "searched", manifest, job, trace, NT_TRACE_SEARCHED, false);
	append_missing_digest(out, manifest, job, trace);
	if (job->status && job->outcome)
		append_error(out, &job->outcome->error);
	if (job->outcome && job->end == NT_JOB_RAN)
		append_run(out, &job->outcome->summary, manifest->judged, manifest->check);
	nt_buffer_text(out, "}\n");
}

/* ---- the file ---- */

static nt_status fail(const nt_manifest *manifest, int number, nt_error *error)
{
	nt_fail(error, NT_ERROR_IO, "cannot write the manifest: %s", strerror(number));
	return nt_error_in_output(error, manifest->path);
}

/* It is emptied before it is known what is read: what is there has to be a manifest, or empty. */
static bool is_ours(int fd)
{
	static const char begin[] = "{\"input\":";
	char bytes[sizeof begin - 1];
	const ssize_t count = pread(fd, bytes, sizeof bytes, 0);
	return count <= 0 || (count == (ssize_t)sizeof bytes && memcmp(bytes, begin, sizeof bytes) == 0);
}

static nt_status refuse_foreign(const nt_manifest *manifest, nt_error *error)
{
	struct stat info;
	if (stat(manifest->path, &info) != 0)
		return NT_OK;
	const int fd = S_ISREG(info.st_mode) ? open(manifest->path, O_RDONLY | O_CLOEXEC) : -1;
	const bool ours = fd < 0 || is_ours(fd);
	if (fd >= 0)
		close(fd);
	return ours ? NT_OK : nt_fail_file(error, NT_ERROR_IO, manifest->path,
		"refusing to write: the file exists already and is no manifest");
}

nt_status nt_manifest_open(nt_manifest *manifest, const char *path, const char *options,
	const nt_report_options *judged, bool check, nt_error *error)
{
	*manifest = (nt_manifest){.path = path, .options = options, .judged = judged, .check = check, .fd = -1};
	const bool standard = strcmp(path, "-") == 0;
	if (!standard && refuse_foreign(manifest, error))
		return error->status;
	if (!nt_buffer_reserve(&manifest->line, LINE_BYTES))
		return nt_fail_memory(error);
	nt_error ignored; /* without a name of the folder, files are called as they were met */
	if (nt_path_absolute(&manifest->current, ".", &ignored))
		manifest->current.size = 0;
	manifest->fd = standard ? dup(STDOUT_FILENO)
				: open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
	return manifest->fd < 0 ? fail(manifest, errno, error) : NT_OK;
}

static bool write_whole(int fd, const char *bytes, size_t size)
{
	while (size > 0) {
		const ssize_t count = write(fd, bytes, size);
		if (count < 0 && errno != EINTR)
			return false;
		bytes += count < 0 ? 0 : count;
		size -= count < 0 ? 0 : (size_t)count;
	}
	return true;
}

void nt_manifest_add(nt_manifest *manifest, const nt_job *job, int exit_code)
{
	nt_buffer *line = &manifest->line;
	if (manifest->error.status)
		return;
	line->size = 0;
	append_job(line, job, manifest, exit_code);
	if (line->failed)
		nt_fail_memory(&manifest->error);
	else if (!write_whole(manifest->fd, line->data, line->size))
		fail(manifest, errno, &manifest->error);
}

nt_status nt_manifest_close(nt_manifest *manifest, nt_error *error)
{
	if (manifest->fd >= 0 && close(manifest->fd) != 0 && !manifest->error.status)
		fail(manifest, errno, &manifest->error);
	manifest->fd = -1;
	nt_buffer_free(&manifest->current);
	nt_buffer_free(&manifest->line);
	if (manifest->error.status)
		*error = manifest->error;
	return manifest->error.status;
}
