/* SPDX-License-Identifier: MIT */
/*
 * The list of findings. Equal findings are merged; a hostile file has as many objects, and so as many different
 * ones, as it likes, which are therefore found by hash.
 */
#include "scene/finding.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

static uint64_t hash_finding(const nt_finding *finding)
{
	uint64_t hash = nt_hash_bytes(0, &finding->code, sizeof finding->code);
	hash = nt_hash_bytes(hash, finding->place.object, strlen(finding->place.object));
	return nt_hash_bytes(hash, finding->detail, strlen(finding->detail));
}

static bool same_finding(const nt_finding *a, const nt_finding *b)
{
	return a->code == b->code && strcmp(a->detail, b->detail) == 0 &&
		strcmp(a->place.object, b->place.object) == 0 && strcmp(a->place.file, b->place.file) == 0;
}

/* False: out of memory. */
static bool keep_text(nt_arena *arena, const char *text, const char **kept)
{
	*kept = *text ? nt_arena_text(arena, text, strlen(text)) : "";
	return *kept != NULL;
}

bool nt_keep_place(nt_arena *arena, const nt_place_view *place, nt_place_view *kept)
{
	*kept = *place;
	return keep_text(arena, place->file, &kept->file) && keep_text(arena, place->pointer, &kept->pointer) &&
		keep_text(arena, place->object, &kept->object);
}

void nt_finding_put(nt_finding_list *list, nt_finding finding, const nt_place *place)
{
	static const nt_place nowhere = {.offset = NT_NO_OFFSET};
	finding.place = nt_view_place(place ? place : &nowhere);
	const uint64_t hash = hash_finding(&finding);
	uint32_t number;
	for (size_t at = NT_HASH_BEGIN;
		(number = nt_hash_index_next(&list->known, hash, &at)) != UINT32_MAX;)
		if (same_finding(&list->items[number], &finding)) {
			list->items[number].count += finding.count;
			return;
		}
	if (list->count >= UINT32_MAX ||
		!nt_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof finding) ||
		!nt_keep_place(&list->arena, &finding.place, &finding.place) ||
		!keep_text(&list->arena, finding.detail, &finding.detail) ||
		!nt_hash_index_add(&list->known, hash, (uint32_t)list->count)) {
		list->failed = true;
		return;
	}
	list->items[list->count++] = finding;
}

void nt_finding_add(nt_finding_list *list, nt_code code, const nt_place *place, size_t count,
	const char *detail_format, ...)
{
	char detail[256] = "";
	if (detail_format) {
		va_list arguments;
		va_start(arguments, detail_format);
		nt_utf8_format(detail, sizeof detail, detail_format, arguments);
		va_end(arguments);
	}
	nt_finding_put(list, (nt_finding){.code = code, .count = count, .detail = detail}, place);
}

void nt_finding_add_as(nt_finding_list *list, nt_code code, nt_severity severity, const nt_place *place,
	const char *detail)
{
	nt_finding_put(list,
		(nt_finding){.code = code, .severity = (uint8_t)(1 + severity), .count = 1, .detail = detail}, place);
}

void nt_findings_set_mesh(nt_finding_list *list, size_t begin, const struct nt_mesh *mesh)
{
	for (size_t i = begin; i < list->count; i++)
		list->items[i].mesh = mesh;
}

void nt_finding_list_free(nt_finding_list *list)
{
	free(list->items);
	nt_hash_index_free(&list->known);
	nt_arena_free(&list->arena);
	*list = (nt_finding_list){0};
}
