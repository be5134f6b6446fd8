/* SPDX-License-Identifier: MIT */
/*
 * The list of findings. Equal findings are merged by looking back through the list: an input has many
 * occurrences but few different findings, since details name files and statements, not elements.
 */
#include "scene/finding.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

void nt_finding_add(nt_finding_list *list, nt_code code, const nt_place *place, size_t count,
	const char *detail_format, ...)
{
	nt_finding finding = {.code = code, .count = count};
	nt_place_clear(&finding.place);
	if (place)
		finding.place = *place;
	if (detail_format) {
		va_list arguments;
		va_start(arguments, detail_format);
		vsnprintf(finding.detail, sizeof finding.detail, detail_format, arguments);
		va_end(arguments);
	}
	for (size_t i = list->count; i-- > 0;) {
		nt_finding *earlier = &list->items[i];
		if (earlier->code == code && strcmp(earlier->detail, finding.detail) == 0 &&
			strcmp(earlier->place.object, finding.place.object) == 0) {
			earlier->count += count;
			return;
		}
	}
	if (!nt_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof finding)) {
		list->failed = true;
		return;
	}
	list->items[list->count++] = finding;
}

void nt_finding_list_free(nt_finding_list *list)
{
	free(list->items);
	*list = (nt_finding_list){0};
}
