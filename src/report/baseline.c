/* SPDX-License-Identifier: MIT */
/*
 * Baselines: the fingerprints of an earlier JSON report, so that only new findings count. A finding of one file is no
 * excuse for another: a fingerprint counts together with the file's name, as reports show it.
 */
#include "report/report.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "json/json.h"

static int by_number(const void *a, const void *b)
{
	const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return x < y ? -1 : x > y;
}

/* The 16 hexadecimal digits of a fingerprint. */
static bool read_fingerprint(const nt_json_value *finding, uint64_t *fingerprint)
{
	size_t length;
	const char *text = nt_json_get_string(nt_json_find(finding, "fingerprint"), &length);
	if (!text || length != 16 || strspn(text, "0123456789abcdef") != 16)
		return false;
	*fingerprint = strtoull(text, NULL, 16);
	return true;
}

const char *nt_shown_path(const char *path)
{
	const char *slash = strrchr(path, '/');
	return path[0] == '/' && slash ? slash + 1 : path;
}

uint64_t nt_baseline_key(const char *file, uint64_t fingerprint)
{
	while (file[0] == '.' && file[1] == '/')
		file += 2;
	return nt_hash_bytes(fingerprint, file, strlen(file));
}

static nt_status read_findings(nt_baseline *baseline, size_t *capacity, const char *file,
	const nt_json_value *findings, nt_error *error)
{
	const size_t count = nt_json_count(findings);
	if (!nt_grow((void **)&baseline->keys, capacity, baseline->count + count, sizeof *baseline->keys))
		return nt_fail_memory(error);
	for (size_t i = 0; i < count; i++) {
		uint64_t fingerprint;
		if (!read_fingerprint(nt_json_at(findings, i), &fingerprint))
			return nt_fail(error, NT_ERROR_INPUT,
				"finding %zu of the baseline has no fingerprint of 16 hexadecimal digits", i);
		baseline->keys[baseline->count++] = nt_baseline_key(file, fingerprint);
	}
	return NT_OK;
}

static nt_status read_files(nt_baseline *baseline, const nt_json_value *root, nt_error *error)
{
	const char *report = nt_json_get_string(nt_json_find(root, "report"), NULL);
	const nt_json_value *files = nt_json_find(root, "files");
	if (!report || strcmp(report, "nmtan") != 0 || nt_json_type_of(files) != NT_JSON_ARRAY)
		return nt_fail(error, NT_ERROR_INPUT, "the baseline is not a JSON report of nmtan");
	size_t capacity = 0;
	nt_status status = NT_OK;
	for (size_t i = 0; i < nt_json_count(files) && !status; i++) {
		const nt_json_value *file = nt_json_at(files, i);
		const char *name = nt_json_get_string(nt_json_find(file, "file"), NULL);
		status = read_findings(baseline, &capacity, name ? name : "", nt_json_find(file, "findings"), error);
	}
	return status;
}

nt_status nt_baseline_read(nt_baseline *baseline, const char *text, size_t size, nt_error *error)
{
	*baseline = (nt_baseline){0};
	nt_json *document = NULL;
	nt_status status = nt_json_parse(&document, text, size, NULL, error);
	if (status)
		return status;
	status = read_files(baseline, nt_json_root(document), error);
	nt_json_free(document);
	if (status)
		nt_baseline_free(baseline);
	else if (baseline->count)
		qsort(baseline->keys, baseline->count, sizeof *baseline->keys, by_number);
	return status;
}

void nt_baseline_free(nt_baseline *baseline)
{
	free(baseline->keys);
	*baseline = (nt_baseline){0};
}
