/* SPDX-License-Identifier: MIT */
/*
 * Views whose content is gone. Views are never removed or renumbered, since extensions we do not know may
 * refer to them, and they may not be empty; but they need not keep bytes that nobody reads. The bytes are
 * taken out, and the number waits for a new view: see take_view() of gltf_layout.c.
 */
#include "io/gltf_layout.h"
#include "io/gltf_view.h"

static bool is_plain(const nt_gltf_layout *layout, uint32_t index, nt_gltf_view *view)
{
	const nt_json_value *json = nt_json_at(nt_gltf_root_member(layout->document, "bufferViews"), index);
	return nt_gltf_get_view(layout->document, index, "", view, NULL) == NT_OK &&
		view->buffer < NT_GLTF_VIRTUAL && !nt_json_find(json, "extensions");
}

nt_status nt_layout_vacate_view(nt_gltf_layout *layout, uint32_t index, size_t users, nt_error *error)
{
	nt_gltf_view view;
	if (!is_plain(layout, index, &view) || layout->vacant[index])
		return NT_OK;
	const uint64_t begin = view.offset, end = begin + view.length, alignment = layout->alignment;
	if (nt_layout_users(layout, view.buffer, begin, end) != users)
		return NT_OK;
	/* padding behind it has no purpose any more */
	const uint64_t padded = begin + (view.length + alignment - 1) / alignment * alignment;
	const bool pads = padded <= layout->buffers[view.buffer].old_length &&
		nt_layout_users(layout, view.buffer, end, padded) == 0;
	layout->vacant[index] = true;
	layout->vacancies[layout->vacancy_count++] = index;
	return nt_layout_edit(layout, view.buffer, begin, (pads ? padded : end) - begin,
		(const unsigned char *)"", 0, error);
}

nt_status nt_layout_vacate(nt_gltf_layout *layout, uint32_t index, uint64_t offset, uint64_t length,
	nt_error *error)
{
	nt_gltf_view view;
	const nt_status status = nt_layout_vacate_view(layout, index, 1, error);
	if (status || layout->vacant[index] || !is_plain(layout, index, &view))
		return status;
	const uint64_t begin = view.offset + offset;
	if (length == view.length || nt_layout_users(layout, view.buffer, begin, begin + length) != 1)
		return NT_OK;
	return nt_layout_edit(layout, view.buffer, begin, length, (const unsigned char *)"", 0, error);
}
