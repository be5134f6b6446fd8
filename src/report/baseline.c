/* SPDX-License-Identifier: MIT */
/*
 * Baselines: the findings of an earlier JSON report, so that only new ones count. A file is compared with what the
 * baseline says of its name: there a finding is known by its fingerprint, in which the mesh's name is, else by its
 * geometry. A file of a name that the baseline does not have, renamed or copied, is compared by geometry with all of
 * the baseline: equal positions of another file are the same finding.
 */
#include "report/report.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/memory.h"
#include "json/json.h"

/* ---- pairs by keys ---- */

/* Both lists are sorted and gone through at once. */

static int by_key(const void *a, const void *b)
{
	const nt_keyed *x = a, *y = b;
	if (x->key != y->key)
		return x->key < y->key ? -1 : 1;
	return x->index < y->index ? -1 : x->index > y->index;
}

/* The things that have keys, ascending, equal ones in their order; the caller frees the list. NULL: out of memory. */
static nt_keyed *list_keys(const void *things, size_t count, nt_key_of key_of, size_t *listed)
{
	nt_keyed *list = nt_alloc(count, sizeof *list);
	*listed = 0;
	for (size_t i = 0; list && i < count; i++) {
		const uint64_t key = key_of(things, i);
		if (key)
			list[(*listed)++] = (nt_keyed){key, (uint32_t)i};
	}
	if (*listed)
		qsort(list, *listed, sizeof *list, by_key);
	return list;
}

/* The first one from `at` on whose key is not below, by steps that grow and shrink. */
static size_t skip_to(const nt_keyed *list, size_t count, size_t at, uint64_t key)
{
	for (size_t step = 1; step > 0;) {
		const bool below = step <= count - at && list[at + step - 1].key < key;
		at += below ? step : 0;
		step = below ? 2 * step : step / 2;
	}
	return at;
}

/*
 * Pairs what has no partner yet. Equal keys are paired one by one in their order, in time that many equal ones do not
 * lengthen, and a much longer old list hardly. pairs->taken NULL: none is.
 */
static void pair_keys(nt_pairs *pairs, const nt_keyed *old, size_t old_count, const nt_keyed *new, size_t new_count)
{
	bool *taken = pairs->taken;
	for (size_t a = 0, b = 0; b < new_count; b++) {
		if (pairs->partners[new[b].index] != UINT32_MAX)
			continue;
		a = skip_to(old, old_count, a, new[b].key);
		while (a < old_count && old[a].key == new[b].key && taken && taken[old[a].index])
			a++;
		if (a == old_count || old[a].key != new[b].key)
			continue;
		pairs->partners[new[b].index] = old[a].index;
		if (taken)
			taken[old[a].index] = true;
		a++;
	}
}

/* Every new thing without a partner. False: out of memory. */
static bool begin_pairs(nt_pairs *pairs, size_t new_count)
{
	pairs->partners = nt_alloc(new_count, sizeof *pairs->partners);
	for (size_t i = 0; pairs->partners && i < new_count; i++)
		pairs->partners[i] = UINT32_MAX;
	return pairs->partners != NULL;
}

bool nt_pair(nt_pairs *pairs, const void *old, size_t old_count, const void *new, size_t new_count,
	const nt_key_of keys[2])
{
	pairs->taken = nt_calloc(old_count, sizeof *pairs->taken);
	bool made = begin_pairs(pairs, new_count) && pairs->taken;
	for (int i = 0; i < 2 && keys[i] && made; i++) {
		size_t counts[2] = {0};
		nt_keyed *lists[2] = {list_keys(old, old_count, keys[i], &counts[0]),
			list_keys(new, new_count, keys[i], &counts[1])};
		made = lists[0] && lists[1];
		if (made)
			pair_keys(pairs, lists[0], counts[0], lists[1], counts[1]);
		free(lists[0]);
		free(lists[1]);
	}
	return made;
}

void nt_pairs_free(nt_pairs *pairs)
{
	free(pairs->partners);
	free(pairs->taken);
}

/* ---- baselines ---- */

static int by_file(const void *a, const void *b)
{
	const nt_baseline_entry *x = a, *y = b;
	return x->file < y->file ? -1 : x->file > y->file;
}

/* Both sides of a pair as one kind of thing. */
static uint64_t fingerprint_of(const void *entries, size_t index)
{
	return ((const nt_baseline_entry *)entries)[index].fingerprint;
}

static uint64_t geometry_of(const void *entries, size_t index)
{
	return ((const nt_baseline_entry *)entries)[index].geometry;
}

static uint64_t key_of_file(const char *file)
{
	while (file[0] == '.' && file[1] == '/')
		file += 2;
	return nt_hash_bytes(0, file, strlen(file)) | 1;
}

/* 16 hexadecimal digits. */
static bool read_digits(const nt_json_value *finding, const char *name, uint64_t *number)
{
	size_t length;
	const char *text = nt_json_get_string(nt_json_find(finding, name), &length);
	if (!text || length != 16 || strspn(text, "0123456789abcdef") != 16)
		return false;
	*number = strtoull(text, NULL, 16);
	return true;
}

static nt_status read_findings(nt_baseline *baseline, size_t *capacity, uint64_t file, const nt_json_value *findings,
	nt_error *error)
{
	const size_t count = nt_json_count(findings);
	if (!nt_grow((void **)&baseline->entries, capacity, baseline->count + count + 1, sizeof *baseline->entries))
		return nt_fail_memory(error);
	baseline->entries[baseline->count++] = (nt_baseline_entry){.file = file}; /* a file may have no findings */
	for (size_t i = 0; i < count; i++) {
		nt_baseline_entry entry = {.file = file};
		if (!read_digits(nt_json_at(findings, i), "fingerprint", &entry.fingerprint))
			return nt_fail(error, NT_ERROR_INPUT,
				"finding %zu of the baseline has no fingerprint of 16 hexadecimal digits", i);
		/* reports of earlier versions have none */
		read_digits(nt_json_at(findings, i), "geometry", &entry.geometry);
		baseline->entries[baseline->count++] = entry;
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
		status = read_findings(baseline, &capacity, key_of_file(name ? name : ""),
			nt_json_find(file, "findings"), error);
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
	if (!status && baseline->count)
		qsort(baseline->entries, baseline->count, sizeof *baseline->entries, by_file);
	if (!status) {
		baseline->geometries = list_keys(baseline->entries, baseline->count, geometry_of,
			&baseline->geometry_count);
		status = baseline->geometries ? NT_OK : nt_fail_memory(error);
	}
	if (status)
		nt_baseline_free(baseline);
	return status;
}

void nt_baseline_free(nt_baseline *baseline)
{
	free(baseline->entries);
	free(baseline->geometries);
	*baseline = (nt_baseline){0};
}

/* ---- what is known ---- */

/* The first entry of a file or of a later one. */
static size_t find_entries(const nt_baseline *baseline, uint64_t file)
{
	size_t low = 0, high = baseline->count;
	while (low < high) {
		const size_t middle = (low + high) / 2;
		if (baseline->entries[middle].file < file)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

bool nt_baseline_apply(const nt_baseline *baseline, nt_report *report)
{
	const size_t count = report->finding_count;
	const uint64_t own = key_of_file(report->shown);
	const size_t first = find_entries(baseline, own), old_count = find_entries(baseline, own + 1) - first;
	const nt_baseline_entry *old = baseline->entries ? baseline->entries + first : NULL;
	nt_baseline_entry *new = nt_calloc(count, sizeof *new);
	nt_pairs pairs = {0};
	bool made = new != NULL;
	for (size_t i = 0; made && i < count; i++) {
		new[i].fingerprint = report->findings[i].fingerprint;
		new[i].geometry = report->findings[i].geometry;
	}
	if (made && old_count) {
		made = nt_pair(&pairs, old, old_count, new, count, (const nt_key_of[]){fingerprint_of, geometry_of});
	} else if (made) {
		size_t listed;
		nt_keyed *keys = list_keys(new, count, geometry_of, &listed);
		made = keys && begin_pairs(&pairs, count);
		if (made)
			pair_keys(&pairs, baseline->geometries, baseline->geometry_count, keys, listed);
		free(keys);
	}
	for (size_t i = 0; made && i < count; i++)
		report->findings[i].known = pairs.partners[i] != UINT32_MAX;
	free(new);
	nt_pairs_free(&pairs);
	return made;
}
