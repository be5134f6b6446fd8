/* SPDX-License-Identifier: MIT */
/*
 * A faulty file may refer to accessors, views or buffers that it does not have, where nobody looks: in a mesh of no
 * scene, a skin, an image. What an edit adds takes the next numbers, and such a reference would come to mean it. So the
 * lowest number of each kind that is referred to in vain is noted before anything is added, and the file is refused if
 * it is taken. What extensions other than those below refer to is not known.
 */
#include "gltf/dangling.h"

#include <stdio.h>
#include "gltf/draco.h"

static const char *const arrays[NT_GLTF_GROWING] = {[NT_GLTF_ACCESSORS] = "accessors",
	[NT_GLTF_VIEWS] = "bufferViews", [NT_GLTF_BUFFERS] = "buffers"};

/* Where a reference is: /array/index, and within that /part/number if part is not NULL. */
typedef struct owner {
	const char *array;
	size_t index;
	const char *part;
	size_t number;
} owner;

static size_t count_in_file(const nt_gltf *document, nt_gltf_growing kind)
{
	return kind == NT_GLTF_ACCESSORS ? document->kept_count :
		kind == NT_GLTF_VIEWS ? document->view_count : document->buffer_count;
}

/* reference: NULL: there is none. */
static void note(nt_gltf *document, nt_gltf_growing kind, const nt_json_value *reference, const owner *at)
{
	nt_gltf_dangling *lowest = &document->dangling[kind];
	uint64_t number;
	if (!nt_json_get_uint64(reference, &number) || number < count_in_file(document, kind) ||
		number >= lowest->number)
		return;
	lowest->number = number;
	const int length = snprintf(lowest->pointer, sizeof lowest->pointer, "/%s/%zu", at->array, at->index);
	if (at->part)
		snprintf(lowest->pointer + length, sizeof lowest->pointer - (size_t)length, "/%s/%zu", at->part,
			at->number);
}

static void note_all(nt_gltf *document, const nt_json_value *attributes, const owner *at)
{
	for (size_t i = 0; i < nt_json_count(attributes); i++)
		note(document, NT_GLTF_ACCESSORS, nt_json_at(attributes, i), at);
}

static void look_at_primitive(nt_gltf *document, const nt_json_value *primitive, const owner *at)
{
	note_all(document, nt_json_find(primitive, "attributes"), at);
	note(document, NT_GLTF_ACCESSORS, nt_json_find(primitive, "indices"), at);
	note(document, NT_GLTF_VIEWS, nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), at);
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (size_t i = 0; i < nt_json_count(targets); i++)
		note_all(document, nt_json_at(targets, i), at);
}

static void look_at_sampler(nt_gltf *document, const nt_json_value *sampler, const owner *at)
{
	note(document, NT_GLTF_ACCESSORS, nt_json_find(sampler, "input"), at);
	note(document, NT_GLTF_ACCESSORS, nt_json_find(sampler, "output"), at);
}

static void look_at_skin(nt_gltf *document, const nt_json_value *skin, const owner *at)
{
	note(document, NT_GLTF_ACCESSORS, nt_json_find(skin, "inverseBindMatrices"), at);
}

static void look_at_node(nt_gltf *document, const nt_json_value *node, const owner *at)
{
	note_all(document, nt_json_find(nt_json_find(nt_json_find(node, "extensions"), "EXT_mesh_gpu_instancing"),
		"attributes"), at);
}

static void look_at_accessor(nt_gltf *document, const nt_json_value *accessor, const owner *at)
{
	const nt_json_value *sparse = nt_json_find(accessor, "sparse");
	note(document, NT_GLTF_VIEWS, nt_json_find(accessor, "bufferView"), at);
	note(document, NT_GLTF_VIEWS, nt_json_find(nt_json_find(sparse, "indices"), "bufferView"), at);
	note(document, NT_GLTF_VIEWS, nt_json_find(nt_json_find(sparse, "values"), "bufferView"), at);
}

static void look_at_image(nt_gltf *document, const nt_json_value *image, const owner *at)
{
	note(document, NT_GLTF_VIEWS, nt_json_find(image, "bufferView"), at);
}

static void look_at_view(nt_gltf *document, const nt_json_value *view, const owner *at)
{
	note(document, NT_GLTF_BUFFERS, nt_json_find(view, "buffer"), at);
}

void nt_gltf_find_dangling(nt_gltf *document)
{
	static const struct {
		const char *array, *part; /* part: an array in each element; NULL: the element itself is looked at */
		void (*look_at)(nt_gltf *document, const nt_json_value *element, const owner *at);
	} places[] = {{"meshes", "primitives", look_at_primitive}, {"animations", "samplers", look_at_sampler},
		{"skins", NULL, look_at_skin}, {"nodes", NULL, look_at_node}, {"accessors", NULL, look_at_accessor},
		{"images", NULL, look_at_image}, {"bufferViews", NULL, look_at_view}};
	if (document->dangling_known)
		return;
	document->dangling_known = true;
	for (size_t i = 0; i < NT_GLTF_GROWING; i++)
		document->dangling[i].number = UINT64_MAX;
	for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
		const nt_json_value *elements = nt_gltf_root_member(document, places[p].array);
		owner at = {.array = places[p].array, .part = places[p].part};
		for (at.index = 0; at.index < nt_json_count(elements); at.index++) {
			const nt_json_value *element = nt_json_at(elements, at.index);
			if (!at.part)
				places[p].look_at(document, element, &at);
			const nt_json_value *parts = at.part ? nt_json_find(element, at.part) : NULL;
			for (at.number = 0; at.number < nt_json_count(parts); at.number++)
				places[p].look_at(document, nt_json_at(parts, at.number), &at);
		}
	}
}

nt_status nt_gltf_check_dangling(const nt_gltf *document, nt_error *error)
{
	for (nt_gltf_growing kind = 0; document->dangling_known && kind < NT_GLTF_GROWING; kind++) {
		const nt_gltf_dangling *lowest = &document->dangling[kind];
		if (lowest->number < nt_json_count(nt_gltf_root_member(document, arrays[kind])))
			return nt_fail_pointer(error, NT_ERROR_INPUT, lowest->pointer, "refers to %s[%llu], there are %zu",
				arrays[kind], (unsigned long long)lowest->number, count_in_file(document, kind));
	}
	return NT_OK;
}
