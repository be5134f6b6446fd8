/* SPDX-License-Identifier: MIT */
/*
 * The lists of extensions that a document uses and requires.
 */
#include "gltf/edit/extensions.h"

#include <string.h>

void nt_gltf_list_extension(nt_gltf *document, const char *list, const char *name)
{
	nt_json *json = document->json;
	nt_json_value *names = nt_json_put(json, nt_json_root(json), list);
	for (size_t i = 0; i < nt_json_count(names); i++) {
		const char *text = nt_json_get_string(nt_json_at(names, i), NULL);
		if (text && strcmp(text, name) == 0)
			return;
	}
	nt_json_set_string(json, nt_json_append(json, names), name, strlen(name));
}

void nt_gltf_remove_extension(nt_gltf *document, const char *list, const char *name)
{
	nt_json_value *names = nt_gltf_root_member(document, list);
	for (size_t i = nt_json_count(names); i-- > 0;) {
		const char *text = nt_json_get_string(nt_json_at(names, i), NULL);
		if (text && strcmp(text, name) == 0)
			nt_json_remove_at(document->json, names, i);
	}
	/* an empty list is not valid */
	if (names && nt_json_count(names) == 0)
		nt_json_remove(document->json, nt_json_root(document->json), list);
}
