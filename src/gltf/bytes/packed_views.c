/* SPDX-License-Identifier: MIT */
/*
 * Views that meshoptimizer packed stay packed, by the extension, mode and filter that they have.
 *
 * Edits change the bytes of a packed view, which was decompressed. Values are put into it as they stand before
 * its filter, since undoing a filter and applying it again would round what is there: a copied vertex is a copy of
 * those bytes. New elements that go with a packed view are gathered in one new view for each kind of them, as
 * gltfpack has them: a view costs more than many of its elements.
 *
 * A packed view names two buffers. One has the packed bytes. In the other a reader that does not know the extension
 * finds the plain ones, if it has bytes at all; there the view takes the place that its new length needs.
 */
#include "gltf/bytes/bytes.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

nt_gltf_packing nt_packing_of(const nt_buffer_edits *edits, uint32_t view)
{
	const nt_gltf *document = edits->document;
	nt_gltf_packing p = {.extension = NULL};
	if (!edits->keeps_packed || view >= edits->view_count || nt_gltf_get_packing(document, view, &p, NULL) ||
		p.buffer >= document->buffer_count || p.place >= document->buffer_count)
		return (nt_gltf_packing){.extension = NULL};
	return p;
}

nt_gltf_packing nt_packing_of_accessor(const nt_buffer_edits *edits, uint32_t accessor)
{
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(edits->document, accessor);
	return nt_packing_of(edits, a ? a->view : NT_NONE);
}

nt_status nt_packed_bytes(nt_buffer_edits *edits, uint32_t buffer, uint64_t offset, const unsigned char **bytes,
	nt_error *error)
{
	if (!nt_gltf_is_of_view(buffer) || !edits->keeps_packed)
		return NT_OK;
	const uint32_t view = buffer - NT_GLTF_OF_VIEW(0);
	nt_edited_view *edited = &edits->views[view];
	const nt_gltf_packing p = nt_packing_of(edits, view);
	if (!edited->unfiltered && p.extension && strcmp(p.view.filter, "NONE") != 0) {
		const nt_status status = nt_gltf_unfiltered_view(edits->document, view, &edited->unfiltered, error);
		if (status)
			return status;
	}
	if (edited->unfiltered)
		*bytes = edited->unfiltered + offset;
	return NT_OK;
}

/* ---- tangents ---- */

/* An attribute that is packed, and how. */
static bool find_packed_attribute(const nt_buffer_edits *edits, const nt_json_value *attributes, const char *name,
	nt_gltf_accessor *a, nt_gltf_packing *packing)
{
	const nt_gltf_accessor *found = nt_gltf_named(edits->document, attributes, name);
	if (!found)
		return false;
	*a = *found;
	*packing = nt_packing_of(edits, a->view);
	return packing->extension && strcmp(packing->view.mode, "ATTRIBUTES") == 0;
}

static nt_precision precision_of(const nt_gltf_accessor *a)
{
	if (!a->normalized)
		return NT_PRECISION_FLOAT;
	return a->component_type == NT_GLTF_BYTE ? NT_PRECISION_BYTE :
		a->component_type == NT_GLTF_SHORT ? NT_PRECISION_SHORT : NT_PRECISION_FLOAT;
}

/* The storage of existing tangents. */
static nt_precision replaced_precision(const nt_buffer_edits *edits, const nt_json_value *attributes)
{
	const nt_gltf_accessor *a = nt_gltf_named(edits->document, attributes, "TANGENT");
	return a && a->components == 4 ? precision_of(a) : NT_PRECISION_FLOAT;
}

/* The bits of what an attribute's filter is applied to. */
static nt_status find_bits(nt_buffer_edits *edits, const nt_gltf_accessor *a, const char *filter, int *bits,
	nt_error *error)
{
	const unsigned char *elements = NULL;
	const nt_gltf_view *view = nt_gltf_view_of(edits->document, a);
	nt_status status = nt_gltf_elements(edits->document, a, &elements, error);
	if (!status && elements)
		status = nt_packed_bytes(edits, view->buffer, view->offset + a->offset, &elements, error);
	*bits = status || !elements ? 0 : nt_filter_bits(filter, elements, (size_t)a->count, a->stride,
		(int)a->component_type, a->components);
	return status;
}

nt_status nt_packed_tangents(nt_buffer_edits *edits, const nt_json_value *attributes, nt_precision wanted,
	nt_gltf_packing *packing, nt_tangent_filter *filter, nt_error *error)
{
	static const int most[] = {[NT_PRECISION_SHORT] = 16, [NT_PRECISION_BYTE] = 8};
	nt_gltf_accessor a;
	*filter = (nt_tangent_filter){.precision = wanted == NT_PRECISION_AUTO ? replaced_precision(edits, attributes)
		: wanted, .filter = "NONE"};
	const bool found = find_packed_attribute(edits, attributes, "TANGENT", &a, packing) ||
		find_packed_attribute(edits, attributes, "NORMAL", &a, packing);
	nt_status status = NT_OK;
	if (found) {
		const nt_precision own = precision_of(&a);
		if (wanted == NT_PRECISION_AUTO && filter->precision == NT_PRECISION_FLOAT)
			filter->precision = own;
		const bool integers = filter->precision != NT_PRECISION_FLOAT;
		const char *kind = integers ? "OCTAHEDRAL" : "EXPONENTIAL";
		if (strcmp(packing->view.filter, kind) == 0 && (integers || wanted == NT_PRECISION_AUTO))
			filter->filter = kind;
		if (filter->filter == kind && filter->precision == own)
			status = find_bits(edits, &a, kind, &filter->bits, error);
		if (filter->filter == kind && !filter->bits)
			filter->bits = integers ? most[filter->precision] : 23;
	} else if (!find_packed_attribute(edits, attributes, "POSITION", &a, packing)) {
		*packing = (nt_gltf_packing){.extension = NULL};
	}
	packing->view.filter = filter->filter;
	packing->view.stride = nt_precision_bytes(filter->precision);
	return status;
}

/* ---- packing ---- */

/* The members of a packed view's JSON. */
static void describe(nt_json *json, nt_json_value *extension, const nt_gltf_packing *p, size_t size)
{
	nt_json_put_uint64(json, extension, "byteLength", size);
	nt_json_put_uint64(json, extension, "byteStride", p->view.stride);
	const char *mode = nt_json_find_string(extension, "mode", NULL);
	if (!mode || strcmp(mode, p->view.mode) != 0)
		nt_json_set_string(json, nt_json_put(json, extension, "mode"), p->view.mode, strlen(p->view.mode));
	nt_json_put_uint64(json, extension, "count", p->view.count);
}

/* The packed bytes of elements, and those after the filter where somebody reads them. Both are in the arena. */
static nt_status pack(nt_buffer_edits *edits, nt_gltf_packing *p, const unsigned char *bytes, size_t count,
	unsigned char **packed, size_t *packed_size, const unsigned char **plain, nt_error *error)
{
	if (strcmp(p->view.mode, "TRIANGLES") == 0 && count % 3)
		p->view.mode = "INDICES";
	p->view.count = count;
	*packed = NULL;
	*plain = bytes;
	nt_status status = nt_meshopt_pack(&p->view, bytes, packed, packed_size, error);
	if (!status && !nt_arena_adopt(&edits->arena, *packed))
		status = nt_fail_memory(error);
	if (status || edits->document->buffers[p->place].storage == NT_GLTF_STORED_NOWHERE)
		return status;
	const size_t size = count * (size_t)p->view.stride;
	unsigned char *filtered = nt_arena_alloc(&edits->arena, size, 1);
	if (!filtered)
		return nt_fail_memory(error);
	*plain = memcpy(filtered, bytes, size);
	return nt_meshopt_filter(&p->view, filtered, "", error);
}

/* Puts bytes where a packed view has its own: in their place, or behind the buffer if somebody else refers to them. */
static nt_status put(nt_buffer_edits *edits, uint32_t buffer, uint64_t position, uint64_t old_size, uint32_t view,
	bool packed, const unsigned char *bytes, size_t size, nt_error *error)
{
	nt_segment *segment = nt_segment_at(edits, buffer, position);
	if (!nt_segment_is(segment, position, old_size))
		return nt_edits_add_bytes(edits, buffer, view, packed, bytes, size, error);
	nt_segment_edit(edits, segment, (nt_segment_change){.bytes = bytes, .size = size});
	return NT_OK;
}

nt_status nt_packed_replace(nt_buffer_edits *edits, uint32_t view, const unsigned char *bytes, size_t size,
	nt_error *error)
{
	nt_json *json = edits->document->json;
	nt_json_value *object = nt_gltf_view_json(edits->document, view);
	nt_gltf_packing p = nt_packing_of(edits, view);
	unsigned char *packed;
	const unsigned char *plain;
	size_t packed_size;
	nt_status status = pack(edits, &p, bytes, size / (size_t)p.view.stride, &packed, &packed_size, &plain, error);
	if (status)
		return status;
	uint64_t offset = 0;
	nt_json_find_uint64(object, "byteOffset", &offset);
	describe(json, nt_gltf_compression_of(object, NULL), &p, packed_size);
	nt_json_put_uint64(json, object, "byteLength", size);
	status = put(edits, p.buffer, p.offset, p.view.packed_size, view, true, packed, packed_size, error);
	return status ? status : put(edits, p.place, offset, edits->document->views[view].length, view, false, plain,
		size, error);
}

/* ---- new views ---- */

static bool is_same_kind(const nt_packed_view *a, const nt_gltf_packing *p, uint32_t target)
{
	const nt_gltf_packing *q = &a->packing;
	return a->target == target && strcmp(q->extension, p->extension) == 0 && q->buffer == p->buffer &&
		q->place == p->place && q->view.stride == p->view.stride && strcmp(q->view.mode, p->view.mode) == 0 &&
		strcmp(q->view.filter, p->view.filter) == 0;
}

static nt_status find_packed(nt_buffer_edits *edits, const nt_gltf_packing *p, uint32_t target,
	nt_packed_view **found, nt_error *error)
{
	for (size_t i = 0; i < edits->packed_count; i++)
		if (is_same_kind(&edits->packed[i], p, target)) {
			*found = &edits->packed[i];
			return NT_OK;
		}
	if (!nt_grow((void **)&edits->packed, &edits->packed_capacity, edits->packed_count + 1,
		    sizeof *edits->packed))
		return nt_fail_memory(error);
	nt_packed_view *made = &edits->packed[edits->packed_count++];
	*made = (nt_packed_view){.packing = *p, .target = target};
	made->view = nt_edits_new_view(edits);
	*found = made;
	return NT_OK;
}

nt_status nt_packed_add(nt_buffer_edits *edits, uint32_t buffer, const nt_gltf_packing *packing, const void *bytes,
	size_t size, uint32_t target, uint32_t stride, uint32_t *view, uint64_t *offset, nt_error *error)
{
	*offset = 0;
	if (!packing->extension)
		return nt_edits_add_view(edits, buffer, bytes, size, target, stride, view, error);
	nt_gltf_packing p = *packing;
	if (strcmp(p.view.mode, "TRIANGLES") == 0 && size / p.view.stride % 3)
		p.view.mode = "INDICES";
	nt_packed_view *to = NULL;
	const nt_status status = find_packed(edits, &p, target, &to, error);
	if (status)
		return status;
	*view = to->view;
	*offset = to->bytes.size;
	nt_buffer_append(&to->bytes, bytes, size);
	return to->bytes.failed ? nt_fail_memory(error) : NT_OK;
}

void nt_gltf_place_accessor(nt_json *json, nt_json_value *accessor, uint32_t view, uint64_t offset)
{
	nt_json_put_uint64(json, accessor, "bufferView", view);
	nt_json_remove(json, accessor, "byteOffset");
	nt_json_remove(json, accessor, "sparse");
	if (offset)
		nt_json_put_uint64(json, accessor, "byteOffset", offset);
}

static nt_status finish(nt_buffer_edits *edits, nt_packed_view *new, nt_error *error)
{
	nt_json *json = edits->document->json;
	nt_json_value *object = nt_gltf_view_json(edits->document, new->view);
	nt_gltf_packing *p = &new->packing;
	const unsigned char *bytes = (const unsigned char *)new->bytes.data, *plain;
	const size_t size = new->bytes.size, count = size / (size_t)p->view.stride;
	unsigned char *packed;
	size_t packed_size;
	nt_status status = pack(edits, p, bytes, count, &packed, &packed_size, &plain, error);
	if (status)
		return status;
	nt_json_put_uint64(json, object, "buffer", p->place);
	nt_json_put_uint64(json, object, "byteOffset", 0);
	nt_json_put_uint64(json, object, "byteLength", size);
	if (new->target == NT_GLTF_ARRAY_BUFFER)
		nt_json_put_uint64(json, object, "byteStride", p->view.stride);
	if (new->target)
		nt_json_put_uint64(json, object, "target", new->target);
	nt_json_value *extension = nt_json_put(json, nt_json_put(json, object, "extensions"), p->extension);
	nt_json_put_uint64(json, extension, "buffer", p->buffer);
	nt_json_put_uint64(json, extension, "byteOffset", 0);
	describe(json, extension, p, packed_size);
	if (strcmp(p->view.filter, "NONE") != 0)
		nt_json_set_string(json, nt_json_put(json, extension, "filter"), p->view.filter,
			strlen(p->view.filter));
	status = nt_edits_add_bytes(edits, p->buffer, new->view, true, packed, packed_size, error);
	return status ? status : nt_edits_add_bytes(edits, p->place, new->view, false, plain, size, error);
}

nt_status nt_packed_finish(nt_buffer_edits *edits, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < edits->packed_count; i++)
		status = finish(edits, &edits->packed[i], error);
	return status;
}
