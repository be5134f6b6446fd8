/* SPDX-License-Identifier: MIT */
/*
 * Accessors: checked against their views, and decoded to floats or indices. Every legal combination is
 * taken: any component type, normalized or not, interleaved, sparse, without a view. If the file already holds the
 * wanted values, nothing is copied.
 */
#include "gltf/document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/numbers.h"
#include "base/parallel.h"
#include "gltf/quantize.h"

uint32_t nt_gltf_component_bytes(uint64_t component_type)
{
	return component_type == NT_GLTF_INT || component_type > NT_GLTF_FLOAT
		? 0 : nt_component_size((int)component_type);
}

uint32_t nt_gltf_index_type(uint64_t most, uint32_t least)
{
	if (least == NT_GLTF_UBYTE && most <= 0xFF)
		return NT_GLTF_UBYTE;
	return least != NT_GLTF_UINT && most <= 0xFFFF ? NT_GLTF_USHORT : NT_GLTF_UINT;
}

void nt_gltf_store_indices(const uint32_t *indices, size_t count, uint32_t width, unsigned char *bytes)
{
	for (size_t i = 0; i < count; i++)
		for (uint32_t k = 0; k < width; k++)
			bytes[i * width + k] = (unsigned char)(indices[i] >> 8 * k);
}

/* ---- checking ---- */

/* Type names; matrices have columns, which begin at multiples of 4 bytes. */
static bool find_type(const char *name, nt_gltf_accessor *accessor)
{
	static const struct {
		const char *name;
		uint8_t rows, columns;
	} types[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1}, {"MAT2", 2, 2},
		{"MAT3", 3, 3}, {"MAT4", 4, 4}};
	for (size_t i = 0; name && i < sizeof types / sizeof *types; i++) {
		if (strcmp(name, types[i].name) != 0)
			continue;
		uint32_t column = types[i].rows * accessor->component_bytes;
		if (types[i].columns > 1)
			column = (column + 3) / 4 * 4;
		accessor->components = (uint8_t)(types[i].rows * types[i].columns);
		accessor->element_bytes = (uint8_t)(column * types[i].columns);
		return true;
	}
	return false;
}

static nt_status read_format(const nt_json_value *json, const char *pointer,
	nt_gltf_accessor *accessor, nt_error *error)
{
	uint64_t type = 0;
	nt_status status = nt_gltf_uint(json, pointer, "componentType", UINT32_MAX, NT_GLTF_REQUIRED,
		&type, error);
	if (status)
		return status;
	char place[NT_GLTF_POINTER * 2];
	accessor->component_type = (uint32_t)type;
	accessor->component_bytes = (uint8_t)nt_gltf_component_bytes(type);
	if (!accessor->component_bytes) {
		snprintf(place, sizeof place, "%s/componentType", pointer);
		return nt_fail_pointer(error, NT_ERROR_INPUT, place,
			"%llu, expected 5120 to 5123, 5125 or 5126", (unsigned long long)type);
	}
	const char *name = nt_json_find_string(json, "type", NULL);
	if (!find_type(name, accessor)) {
		snprintf(place, sizeof place, "%s/type", pointer);
		return nt_fail_pointer(error, NT_ERROR_INPUT, place,
			"%s%.*s%s, expected SCALAR, VEC2 to VEC4 or MAT2 to MAT4", name ? "\"" : "",
			NT_CUT(30, name ? name : nt_json_type_text(nt_json_find(json, "type"))), name ? "\"" : "");
	}
	nt_json_get_bool(nt_json_find(json, "normalized"), &accessor->normalized);
	return nt_gltf_uint(json, pointer, "count", UINT32_MAX - 1, NT_GLTF_REQUIRED, &accessor->count,
		error);
}

/* `count` elements of `bytes` each, `stride` apart, from `offset` on in view `index`. None lie anywhere. */
static nt_status check_range(uint32_t index, const nt_gltf_view *view, uint64_t offset, uint64_t count,
	uint64_t bytes, uint64_t stride, const char *pointer, nt_error *error)
{
	/* count < 2^32 and stride < 2^16, offset <= 2^53: no overflow */
	const uint64_t end = count ? offset + (count - 1) * stride + bytes : 0;
	if (end > view->length)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%llu elements end at byte %llu of bufferView %u, which has %llu",
			(unsigned long long)count, (unsigned long long)end, index,
			(unsigned long long)view->length);
	return NT_OK;
}

static nt_status check_dense(nt_gltf *document, const nt_json_value *json, const char *pointer,
	nt_gltf_accessor *accessor, nt_error *error)
{
	uint64_t index;
	nt_status status =
		nt_gltf_uint(json, pointer, "bufferView", UINT32_MAX - 1, NT_NONE, &index, error);
	if (status)
		return status;
	accessor->view = (uint32_t)index;
	accessor->stride = accessor->element_bytes;
	if (accessor->view == NT_NONE)
		return NT_OK;
	status = nt_gltf_uint(json, pointer, "byteOffset", (uint64_t)1 << 53, 0, &accessor->offset, error);
	const nt_gltf_view *view;
	if (!status)
		status = nt_gltf_get_view(document, index, pointer, &view, error);
	if (status)
		return status;
	if (view->stride) {
		if (view->stride < accessor->element_bytes)
			return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
				"elements of %u bytes, but bufferView %u has a byteStride of %u",
				accessor->element_bytes, accessor->view, view->stride);
		accessor->stride = view->stride;
	}
	return check_range(accessor->view, view, accessor->offset, accessor->count, accessor->element_bytes,
		accessor->stride, pointer, error);
}

/* One of the two halves of a sparse object. */
static nt_status check_sparse_array(nt_gltf *document, const nt_json_value *sparse, const char *name,
	const char *pointer, uint64_t count, uint64_t element_bytes, uint32_t *view_index,
	uint64_t *offset, nt_error *error)
{
	char place[NT_GLTF_POINTER * 2];
	snprintf(place, sizeof place, "%s/%s", pointer, name);
	const nt_json_value *list = nt_json_find(sparse, name);
	uint64_t index;
	nt_status status = nt_gltf_uint(list, place, "bufferView", UINT32_MAX - 1, NT_GLTF_REQUIRED,
		&index, error);
	if (!status)
		status = nt_gltf_uint(list, place, "byteOffset", (uint64_t)1 << 53, 0, offset, error);
	const nt_gltf_view *view;
	if (!status)
		status = nt_gltf_get_view(document, index, place, &view, error);
	if (status)
		return status;
	*view_index = (uint32_t)index;
	return check_range(*view_index, view, *offset, count, element_bytes, element_bytes, place, error);
}

static nt_status check_sparse(nt_gltf *document, const nt_json_value *sparse, const char *accessor_pointer,
	nt_gltf_accessor *accessor, nt_error *error)
{
	char pointer[NT_GLTF_POINTER], place[NT_GLTF_POINTER * 2];
	snprintf(pointer, sizeof pointer, "%.*s/sparse", NT_CUT(100, accessor_pointer));
	nt_gltf_sparse_arrays arrays;
	nt_status status = nt_gltf_uint(sparse, pointer, "count", accessor->count, NT_GLTF_REQUIRED, &arrays.count,
		error);
	if (status || arrays.count == 0)
		return status;
	snprintf(place, sizeof place, "%s/indices", pointer);
	uint64_t type;
	status = nt_gltf_uint(nt_json_find(sparse, "indices"), place, "componentType", UINT32_MAX,
		NT_GLTF_REQUIRED, &type, error);
	if (status)
		return status;
	if (type != NT_GLTF_UBYTE && type != NT_GLTF_USHORT && type != NT_GLTF_UINT)
		return nt_fail_pointer(error, NT_ERROR_INPUT, place,
			"componentType %llu, expected 5121, 5123 or 5125", (unsigned long long)type);
	arrays.index_type = (uint32_t)type;
	status = check_sparse_array(document, sparse, "indices", pointer, arrays.count, nt_gltf_component_bytes(type),
		&arrays.index_view, &arrays.index_offset, error);
	if (!status)
		status = check_sparse_array(document, sparse, "values", pointer, arrays.count, accessor->element_bytes,
			&arrays.value_view, &arrays.value_offset, error);
	nt_gltf_sparse_arrays *kept = status ? NULL : nt_arena_alloc(&document->arena, 1, sizeof *kept);
	if (kept)
		*kept = arrays;
	accessor->sparse = kept;
	return status || kept ? status : nt_fail_memory(error);
}

/* An accessor as its JSON has it, checked against its views. */
static nt_status read_accessor(nt_gltf *document, uint32_t index, nt_gltf_accessor *accessor, nt_error *error)
{
	const nt_json_value *json = nt_gltf_accessor_json(document, index);
	char pointer[NT_GLTF_POINTER];
	*accessor = (nt_gltf_accessor){.index = index, .view = NT_NONE};
	nt_gltf_pointer(pointer, "accessors", index);
	nt_status status = nt_gltf_check_object(json, pointer, error);
	if (!status)
		status = read_format(json, pointer, accessor, error);
	if (!status)
		status = check_dense(document, json, pointer, accessor, error);
	const nt_json_value *sparse = nt_json_find(json, "sparse");
	if (!status && sparse)
		status = check_sparse(document, sparse, pointer, accessor, error);
	return status;
}

static int compare_places(const void *a, const void *b)
{
	const nt_gltf_accessor *x = *(const nt_gltf_accessor *const *)a, *y = *(const nt_gltf_accessor *const *)b;
	const uint64_t xs[] = {x->view, x->offset, x->component_type, x->components, x->count, x->normalized};
	const uint64_t ys[] = {y->view, y->offset, y->component_type, y->components, y->count, y->normalized};
	for (size_t i = 0; i < sizeof xs / sizeof *xs; i++)
		if (xs[i] != ys[i])
			return xs[i] < ys[i] ? -1 : 1;
	return 0;
}

static int compare_accessors(const void *a, const void *b)
{
	const int places = compare_places(a, b);
	const nt_gltf_accessor *x = *(const nt_gltf_accessor *const *)a, *y = *(const nt_gltf_accessor *const *)b;
	return places ? places : (x->index > y->index) - (x->index < y->index);
}

static bool lies_in_view(const nt_gltf_accessor *accessor)
{
	return accessor->index != NT_NONE && accessor->view != NT_NONE && !accessor->sparse;
}

/* Most views have one accessor, about which there is no question. */
nt_status nt_gltf_find_same_bytes(nt_gltf *document, nt_error *error)
{
	nt_gltf_accessor *const all = document->accessors;
	uint32_t *users = nt_calloc(document->view_count, sizeof *users);
	size_t shared = 0, count = 0;
	for (uint32_t i = 0; users && i < document->accessor_count; i++) {
		all[i].same = i;
		all[i].next = NT_NONE;
		if (lies_in_view(&all[i]))
			shared += users[all[i].view]++ ? 1 + (users[all[i].view] == 2) : 0;
	}
	nt_gltf_accessor **list = users ? nt_alloc(shared, sizeof *list) : NULL;
	for (uint32_t i = 0; list && i < document->accessor_count; i++)
		if (lies_in_view(&all[i]) && users[all[i].view] > 1)
			list[count++] = &all[i];
	if (count)
		qsort(list, count, sizeof *list, compare_accessors);
	for (size_t i = 1; i < count; i++)
		if (compare_places(&list[i], &list[i - 1]) == 0) {
			list[i]->same = list[i - 1]->same;
			list[i - 1]->next = list[i]->index;
		}
	const bool found = list != NULL;
	free(list);
	free(users);
	return found ? NT_OK : nt_fail_memory(error);
}

nt_status nt_gltf_read_arrays(nt_gltf *document, nt_error *error)
{
	if (document->accessors)
		return NT_OK;
	nt_gltf_accessor *all = nt_alloc(document->accessor_count, sizeof *all);
	nt_gltf_read_views(document);
	nt_status status = all ? NT_OK : NT_ERROR_MEMORY;
	for (uint32_t i = 0; status != NT_ERROR_MEMORY && i < document->accessor_count; i++) {
		status = read_accessor(document, i, &all[i], NULL);
		if (status)
			all[i] = (nt_gltf_accessor){.index = NT_NONE, .view = NT_NONE};
	}
	if (status == NT_ERROR_MEMORY) {
		free(all);
		return nt_fail_memory(error);
	}
	document->accessors = all;
	return NT_OK;
}

nt_status nt_gltf_get_accessor(nt_gltf *document, uint64_t index, const char *from,
	const nt_gltf_accessor **accessor, nt_error *error)
{
	nt_gltf_accessor faulty;
	const nt_status status = nt_gltf_check_index("accessors", index, document->accessor_count, from, error);
	*accessor = nt_gltf_sound_accessor(document, index);
	/* a faulty one is read again, to tell what is wrong */
	return status || *accessor ? status : read_accessor(document, (uint32_t)index, &faulty, error);
}

nt_json_value *nt_gltf_accessor_json(const nt_gltf *document, uint64_t index)
{
	return nt_json_at(nt_gltf_root_member(document, "accessors"), (size_t)index);
}

void nt_gltf_state_bounds(nt_json *json, nt_json_value *accessor, size_t components, double bounds[2][4])
{
	static const char *const names[] = {"min", "max"};
	uint64_t type = NT_GLTF_FLOAT;
	nt_json_find_uint64(accessor, "componentType", &type);
	for (size_t b = 0; b < 2; b++) {
		nt_json_value *stated = nt_json_find(accessor, names[b]);
		for (size_t k = 0; nt_json_count(stated) == components && k < components; k++) {
			double old;
			if (!isfinite(bounds[b][k]) ||
				(nt_json_get_double(nt_json_at(stated, k), &old) && old == bounds[b][k]))
				continue;
			if (type == NT_GLTF_FLOAT)
				nt_json_set_double(json, nt_json_at(stated, k), bounds[b][k]);
			else
				nt_json_set_int64(json, nt_json_at(stated, k), (int64_t)bounds[b][k]);
		}
	}
}

void nt_gltf_measure(nt_gltf *document, const nt_gltf_accessor *a, nt_json_value *json, const void *elements,
	size_t stride, size_t count, uint32_t component_type)
{
	double bounds[2][4];
	if (!elements || a->components > 4 || a->element_bytes != a->components * a->component_bytes ||
		(!nt_json_find(json, "min") && !nt_json_find(json, "max")))
		return;
	nt_component_bounds(elements, stride, count, (int)component_type, a->components, bounds);
	nt_gltf_state_bounds(document->json, json, a->components, bounds);
}

/* ---- bytes ---- */

nt_status nt_gltf_elements(nt_gltf *document, const nt_gltf_accessor *accessor,
	const unsigned char **elements, nt_error *error)
{
	*elements = accessor->decoded;
	if (accessor->decoded)
		return NT_OK;
	if (accessor->view == NT_NONE || accessor->count == 0)
		return NT_OK;
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "accessors", accessor->index);
	const uint64_t length = (accessor->count - 1) * accessor->stride + accessor->element_bytes;
	return nt_gltf_view_bytes(document, accessor->view, accessor->offset, length, pointer, elements,
		error);
}

/* An unsigned number of 1, 2 or 4 bytes. */
static uint32_t read_unsigned(const unsigned char *bytes, uint32_t component_type)
{
	if (component_type == NT_GLTF_UBYTE)
		return bytes[0];
	if (component_type == NT_GLTF_USHORT)
		return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
	return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
		(uint32_t)bytes[3] << 24;
}

nt_status nt_gltf_sparse(nt_gltf *document, const nt_gltf_accessor *accessor, nt_arena *arena,
	const uint32_t **elements, const unsigned char **values, nt_error *error)
{
	const uint64_t count = accessor->sparse->count;
	const uint32_t width = nt_gltf_component_bytes(accessor->sparse->index_type);
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/accessors/%u/sparse/indices", accessor->index);
	const unsigned char *numbers;
	nt_status status = nt_gltf_view_bytes(document, accessor->sparse->index_view,
		accessor->sparse->index_offset, count * width, pointer, &numbers, error);
	if (status)
		return status;
	uint32_t *list = nt_arena_alloc(arena, (size_t)count, sizeof *list);
	if (!list)
		return nt_fail_memory(error);
	for (size_t i = 0; i < count; i++) {
		list[i] = read_unsigned(numbers + i * width, accessor->sparse->index_type);
		if (list[i] >= accessor->count || (i > 0 && list[i] <= list[i - 1]))
			return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
				"index %zu is %u, expected %s", i, list[i],
				list[i] >= accessor->count ? "less than the accessor's count" :
							     "more than the one before");
	}
	*elements = list;
	snprintf(pointer, sizeof pointer, "/accessors/%u/sparse/values", accessor->index);
	return nt_gltf_view_bytes(document, accessor->sparse->value_view, accessor->sparse->value_offset,
		count * accessor->element_bytes, pointer, values, error);
}

nt_status nt_gltf_whole_elements(nt_gltf *document, const nt_gltf_accessor *a, nt_arena *arena,
	const unsigned char **elements, size_t *step, nt_error *error)
{
	const uint32_t *replaced;
	const unsigned char *values;
	nt_status status = nt_gltf_elements(document, a, elements, error);
	*step = a->stride;
	if (status || !a->sparse || a->decoded)
		return status;
	const size_t width = a->element_bytes;
	unsigned char *whole = nt_arena_alloc(arena, (size_t)a->count, width);
	if (!whole)
		return nt_fail_memory(error);
	memset(whole, 0, (size_t)a->count * width);
	for (size_t i = 0; *elements && i < a->count; i++)
		memcpy(whole + i * width, *elements + i * a->stride, width);
	status = nt_gltf_sparse(document, a, arena, &replaced, &values, error);
	for (size_t i = 0; !status && i < a->sparse->count; i++)
		memcpy(whole + replaced[i] * width, values + i * width, width);
	*elements = whole;
	*step = width;
	return status;
}

/* ---- decoding ---- */

static void decode_element(const nt_gltf_accessor *accessor, const unsigned char *element, uint32_t width,
	float fill, float *out)
{
	for (uint32_t k = 0; k < width; k++)
		out[k] = k < accessor->components ?
			nt_component_value(element + k * accessor->component_bytes,
				(int)accessor->component_type, accessor->normalized) :
			fill;
}

static void decode_elements(const nt_gltf_accessor *accessor, const unsigned char *elements, uint32_t width,
	float fill, float *out)
{
	const bool plain = accessor->component_type == NT_GLTF_FLOAT && accessor->components >= width;
	for (size_t i = 0; i < accessor->count; i++) {
		if (!elements) {
			for (uint32_t k = 0; k < width; k++)
				out[i * width + k] = k < accessor->components ? 0 : fill;
		} else if (plain) {
			memcpy(out + i * width, elements + i * accessor->stride, width * sizeof *out);
		} else {
			decode_element(accessor, elements + i * accessor->stride, width, fill, out + i * width);
		}
	}
}

/* The elements of an accessor, where they are what is wanted; else NULL. */
static float *floats_as_stored(const nt_gltf_accessor *accessor, uint32_t width, const unsigned char *elements)
{
	float *floats = NULL;
	if (elements && accessor->component_type == NT_GLTF_FLOAT && accessor->components == width &&
		accessor->stride == width * sizeof(float) && (uintptr_t)elements % sizeof(float) == 0 &&
		!accessor->sparse)
		memcpy(&floats, &elements, sizeof floats);
	return floats;
}

nt_status nt_gltf_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width,
	float fill, nt_arena *arena, float **floats, nt_error *error)
{
	const unsigned char *elements;
	nt_status status = nt_gltf_elements(document, accessor, &elements, error);
	if (status)
		return status;
	*floats = floats_as_stored(accessor, width, elements);
	if (*floats)
		return NT_OK;
	float *out = nt_arena_alloc(arena, (size_t)accessor->count, width * sizeof *out);
	if (!out)
		return nt_fail_memory(error);
	decode_elements(accessor, elements, width, fill, out);
	if (accessor->sparse) {
		const uint32_t *replaced;
		const unsigned char *values;
		status = nt_gltf_sparse(document, accessor, arena, &replaced, &values, error);
		if (status)
			return status;
		for (size_t i = 0; i < accessor->sparse->count; i++)
			decode_element(accessor, values + i * accessor->element_bytes, width, fill,
				out + (size_t)replaced[i] * width);
	}
	*floats = out;
	return NT_OK;
}

nt_status nt_gltf_shared_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width, float fill,
	float **floats, nt_error *error)
{
	static nt_lock lock = NT_LOCK_INIT;
	const unsigned char *elements;
	nt_status status = nt_gltf_elements(document, accessor, &elements, error);
	if (status)
		return status;
	*floats = floats_as_stored(accessor, width, elements);
	if (*floats)
		return NT_OK;
	nt_lock_take(&lock);
	if (!document->floats)
		document->floats = nt_calloc(nt_json_count(nt_gltf_root_member(document, "accessors")),
			sizeof *document->floats);
	nt_gltf_floats_of *known = document->floats ? &document->floats[accessor->index] : NULL;
	if (!known)
		status = nt_fail_memory(error);
	else if (!known->values || known->width != width || known->fill != fill)
		status = nt_gltf_floats(document, accessor, width, fill, &document->arena, floats, error);
	else
		*floats = known->values;
	if (!status)
		*known = (nt_gltf_floats_of){*floats, width, fill};
	nt_lock_give(&lock);
	return status;
}

/* elements: NULL gives zeros. */
static void widen(const unsigned char *elements, uint32_t type, uint32_t stride, size_t count, uint32_t *out)
{
	for (size_t i = 0; i < count; i++)
		out[i] = elements ? read_unsigned(elements + i * stride, type) : 0;
}

nt_status nt_gltf_indices(nt_gltf *document, const nt_gltf_accessor *accessor, size_t vertex_count,
	nt_arena *arena, uint32_t **indices, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "accessors", accessor->index);
	const uint32_t type = accessor->component_type;
	if (accessor->components != 1 ||
		(type != NT_GLTF_UBYTE && type != NT_GLTF_USHORT && type != NT_GLTF_UINT))
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"the indices of a primitive are %u components of type %u, expected an unsigned "
			"SCALAR", accessor->components, type);
	const size_t count = (size_t)accessor->count;
	if (accessor->view == NT_NONE && !accessor->decoded && count > NT_GLTF_UNBACKED)
		return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, pointer,
			"%zu indices without a bufferView", count);
	const unsigned char *elements = NULL;
	nt_status status = nt_gltf_elements(document, accessor, &elements, error);
	if (status)
		return status;
	const bool as_wanted = type == NT_GLTF_UINT && accessor->stride == 4 && elements &&
		(uintptr_t)elements % 4 == 0 && !accessor->sparse;
	uint32_t *out = NULL;
	if (as_wanted)
		memcpy(&out, &elements, sizeof out);
	else if (!(out = nt_arena_alloc(arena, count, sizeof *out)))
		return nt_fail_memory(error);
	if (!as_wanted)
		widen(elements, type, accessor->stride, count, out);
	if (accessor->sparse) {
		const uint32_t *replaced;
		const unsigned char *values;
		status = nt_gltf_sparse(document, accessor, arena, &replaced, &values, error);
		if (status)
			return status;
		for (size_t i = 0; i < accessor->sparse->count; i++)
			out[replaced[i]] = read_unsigned(values + i * accessor->element_bytes, type);
	}
	const uint32_t reserved = type == NT_GLTF_UBYTE ? 0xFF : type == NT_GLTF_USHORT ? 0xFFFF : NT_NONE;
	const uint32_t most = nt_largest(out, count);
	const bool sound = count == 0 || (most < vertex_count && most < reserved);
	for (size_t i = 0; !sound && i < count; i++)
		if (out[i] == reserved && nt_gltf_uses(document, "KHR_mesh_primitive_restart"))
			return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, pointer,
				"index %zu restarts the primitive (KHR_mesh_primitive_restart), which nmtan "
				"does not do: write a list of triangles", i);
		else if (out[i] >= vertex_count || out[i] == reserved)
			return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
				"index %zu is %u%s, there are %zu vertices", i, out[i],
				out[i] == reserved ? " (reserved)" : "", vertex_count);
	*indices = out;
	return NT_OK;
}
