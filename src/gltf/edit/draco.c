/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents; with an explicit --draco, plain ones that shall be compressed.
 *
 * The block is encoded again with the copied rows and TANGENT among the attributes. Attributes keep the
 * source's quantization, origin and range, so that they decode to the values they had. Where attributes
 * lie outside of the block (morph targets, joints in some files) or faces are degenerate, order matters
 * and the sequential method is taken. Where compressing again would lose something (the encoder drops
 * vertices that no face uses, and rows outside of the block would no longer fit), where primitives share
 * accessors but not all else, or where it is not wanted, the primitive is written plain.
 */
#include "gltf/edit/draco.h"

#include <string.h>
#include "gltf/edit/draco_gather.h"
#include "gltf/edit/extensions.h"
#include "gltf/edit/append.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

bool nt_gltf_has_draco(const nt_gltf_patcher *p, const nt_gltf_cluster *component)
{
	for (size_t i = 0; i < component->member_count; i++)
		if (component->rows.group_of[i] != NT_NONE &&
			nt_gltf_draco_of(nt_gltf_primitive_of(p->document,
				&p->scene->meshes[component->members[i]])))
			return true;
	return false;
}

void nt_gltf_drop_draco(nt_gltf_patcher *p)
{
	if (!p->document->draco_blocks)
		return;
	for (size_t i = 0; i < p->scene->mesh_count; i++)
		if (nt_gltf_draco_of(nt_gltf_primitive_of(p->document, &p->scene->meshes[i])))
			return;
	nt_gltf_remove_extension(p->document, "extensionsRequired", "KHR_draco_mesh_compression");
	nt_gltf_remove_extension(p->document, "extensionsUsed", "KHR_draco_mesh_compression");
}

/* ---- plain ---- */

/* Takes the extension off a primitive, and its block out of the buffer. The view takes some of the rows. */
static nt_status make_plain(nt_gltf_patcher *p, nt_gltf_cluster *component, size_t member)
{
	nt_json_value *primitive = nt_gltf_primitive_of(p->document,
		&p->scene->meshes[component->members[member]]);
	nt_json_value *extensions = nt_json_find(primitive, "extensions");
	uint64_t index;
	nt_gltf_view view;
	nt_status status = NT_OK;
	if (nt_json_get_uint64(nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), &index) &&
		nt_gltf_get_view(p->document, index, "", &view, NULL) == NT_OK &&
		nt_gltf_draco_release(p, index, 1))
		status = nt_edits_release(&p->edits, (uint32_t)index, 0, view.length, p->error);
	nt_json_remove(p->json, extensions, "KHR_draco_mesh_compression");
	if (nt_json_count(extensions) == 0)
		nt_json_remove(p->json, primitive, "extensions");
	component->rows.changed[member] = true;
	return status;
}

static nt_status make_all_plain(nt_gltf_patcher *p, nt_gltf_cluster *component)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < component->member_count; i++)
		if (component->rows.group_of[i] != NT_NONE &&
			nt_gltf_draco_of(nt_gltf_primitive_of(p->document,
				&p->scene->meshes[component->members[i]])))
			status = make_plain(p, component, i);
	return status;
}

/* ---- compressed again ---- */

static nt_status note_outside(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	nt_gltf_recoding *r = context;
	(void)accessor;
	const bool base = attributes == nt_json_find(r->primitive, "attributes");
	if (!base || !nt_json_find(nt_json_find(r->extension, "attributes"), name))
		r->outside = true;
	return NT_OK;
}

/* Whether every compressed accessor is used by the component alone and has no uncompressed twin. */
static bool accessors_are_own(const nt_gltf_recoding *r)
{
	const nt_gltf_patcher *p = r->patcher;
	const nt_json_value *ids = nt_json_find(r->extension, "attributes");
	const nt_json_value *attributes = nt_json_find(r->primitive, "attributes");
	const nt_json_value *accessors = nt_gltf_root_member(p->document, "accessors");
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		uint64_t accessor;
		if (!nt_json_get_uint64(nt_json_find(attributes, nt_json_key(ids, i, NULL)), &accessor) ||
			p->sharing.foreign[p->sharing.canonical[accessor]] ||
			nt_json_find(nt_json_at(accessors, (size_t)accessor), "bufferView"))
			return false;
	}
	uint64_t indices;
	return nt_json_get_uint64(nt_json_find(r->primitive, "indices"), &indices) &&
		p->sharing.index_users[p->sharing.canonical[indices]] == r->component->member_count &&
		!nt_json_find(nt_json_at(accessors, (size_t)indices), "bufferView");
}

/* Whether edgebreaker would drop a face: two corners at one position. */
static bool has_degenerate_face(const nt_gltf_recoding *r)
{
	const uint32_t *indices = r->component->rows.indices[0];
	for (size_t c = 0; c + 2 < r->mesh->corner_count; c += 3)
		for (size_t k = 0; k < 3; k++) {
			const size_t a = indices[c + k], b = indices[c + (k + 1) % 3];
			const nt_gltf_rows *rows = &r->component->rows;
			const size_t x = a < rows->old_count ? a : rows->sources[a - rows->old_count];
			const size_t y = b < rows->old_count ? b : rows->sources[b - rows->old_count];
			if (memcmp(r->mesh->positions + 3 * x, r->mesh->positions + 3 * y,
				3 * sizeof(float)) == 0)
				return true;
		}
	return false;
}

/* Whether rows outside of the block still fit the points in it. */
static bool order_is_kept(const nt_gltf_recoding *r, const nt_draco_block *block)
{
	if (block->point_count != r->component->rows.new_count || !block->sources)
		return false;
	for (size_t i = 0; i < block->point_count; i++)
		if (block->sources[i] != i)
			return false;
	return true;
}

static nt_draco_method wanted_method(const nt_gltf_recoding *r)
{
	if (r->outside || has_degenerate_face(r) || r->patcher->options->draco == NT_DRACO_AS_SEQUENTIAL)
		return NT_DRACO_SEQUENTIAL;
	return r->patcher->options->draco == NT_DRACO_AS_EDGEBREAKER ? NT_DRACO_EDGEBREAKER :
								       r->source->method;
}

/* Encodes; *done false where the result would not do. */
static nt_status recode(nt_gltf_recoding *r, bool *done)
{
	nt_gltf_patcher *p = r->patcher;
	nt_status status = r->source ? nt_gltf_draco_gather_block(r) : NT_OK;
	if (!status)
		status = nt_gltf_draco_add_own(r);
	if (status)
		return status;
	/* Edgebreaker does not give every mesh back; the other method has nothing to lose. */
	const nt_draco_method method = wanted_method(r);
	nt_draco_block block = {0};
	status = nt_gltf_draco_encode(r, method, &block);
	if (status && status != NT_ERROR_MEMORY && method != NT_DRACO_SEQUENTIAL)
		status = nt_gltf_draco_encode(r, NT_DRACO_SEQUENTIAL, &block);
	if (status == NT_ERROR_MEMORY)
		return nt_fail_memory(p->error);
	if (status || (r->outside && !order_is_kept(r, &block))) {
		r->obstacle = status ? "Draco does not give it back"
				     : "no face uses some of its vertices, whose order matters";
		nt_draco_block_free(&block);
		return NT_OK; /* plain, then */
	}
	*done = true;
	status = r->source ? NT_OK : nt_gltf_draco_take_out(r, &block);
	if (!status && r->outside && r->component->rows.new_count > r->component->rows.old_count)
		status = nt_gltf_grow_attributes(p, r->component, NULL, 0, false);
	if (!status) {
		nt_gltf_draco_describe(r, &block);
		status = nt_gltf_draco_store(r, &block);
	}
	if (!status)
		status = nt_gltf_add_morphs(p, r->component, 0);
	nt_draco_block_free(&block);
	return status;
}

static nt_json_value *member_primitive(const nt_gltf_patcher *p, const nt_gltf_cluster *component,
	size_t member)
{
	return nt_gltf_primitive_of(p->document, &p->scene->meshes[component->members[member]]);
}

/* Whether the component is one primitive, perhaps several times: with the same geometry and the same
 * accessors, so that one block serves them all. */
static bool is_one_primitive(const nt_gltf_patcher *p, const nt_gltf_cluster *component)
{
	const nt_json_value *first = member_primitive(p, component, 0);
	for (size_t i = 1; i < component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[component->members[i]];
		const nt_json_value *other = member_primitive(p, component, i);
		if (mesh->same_as != &p->scene->meshes[component->members[0]] ||
			!nt_json_equal(nt_gltf_draco_of(first), nt_gltf_draco_of(other)))
			return false;
		static const char *const members[] = {"attributes", "targets", "indices"};
		for (size_t k = 0; k < 3; k++)
			if (!nt_json_equal(nt_json_find(first, members[k]), nt_json_find(other, members[k])))
				return false;
	}
	return true;
}

/* The other members refer to what the first one now does. */
static void share_block(nt_gltf_recoding *r)
{
	nt_json *json = r->patcher->json;
	static const char *const members[] = {"attributes", "targets", "indices"};
	for (size_t i = 1; i < r->component->member_count; i++) {
		nt_json_value *other = member_primitive(r->patcher, r->component, i);
		for (size_t k = 0; k < 3; k++)
			if (nt_json_find(r->primitive, members[k]))
				nt_json_set_copy(json, nt_json_put(json, other, members[k]),
					nt_json_find(r->primitive, members[k]));
		nt_json_set_copy(json, nt_json_put(json, nt_json_put(json, other, "extensions"),
			"KHR_draco_mesh_compression"), nt_gltf_draco_of(r->primitive));
	}
}

/* What the user asked for and does not get. */
static void report_members(const nt_gltf_recoding *r, bool compressed)
{
	const nt_gltf_patcher *p = r->patcher;
	nt_finding_list *findings = &p->scene->findings;
	for (size_t i = 0; i < r->component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[r->component->members[i]];
		if (r->component->rows.group_of[i] == NT_NONE)
			continue;
		const bool wanted = p->options->draco > NT_DRACO_OFF ||
			nt_gltf_draco_of(member_primitive(p, r->component, i));
		if (!compressed && wanted)
			nt_finding_add(findings, NT_CODE_DRACO_PLAIN, &mesh->place, 1, "%s", r->obstacle);
		else if (compressed && p->options->precision != NT_PRECISION_FLOAT)
			nt_finding_add(findings, NT_CODE_DRACO_PRECISION, &mesh->place, 1, "%d bits",
				nt_gltf_draco_bits(p->options, NT_DRACO_BITS_TANGENT));
	}
}

nt_status nt_gltf_patch_draco(nt_gltf_patcher *p, nt_gltf_cluster *component, bool *done)
{
	*done = false;
	if (p->options->draco == NT_DRACO_OFF)
		return make_all_plain(p, component);
	nt_gltf_recoding r = {.patcher = p, .component = component,
		.mesh = &p->scene->meshes[component->members[0]]};
	r.primitive = nt_gltf_primitive_of(p->document, r.mesh);
	r.extension = nt_gltf_draco_of(r.primitive);
	nt_status status = NT_OK;
	if (!is_one_primitive(p, component)) {
		r.obstacle = "it shares vertices with other primitives";
	} else if (!r.extension) {
		status = nt_gltf_draco_gather_plain(&r);
	} else if (!accessors_are_own(&r) ||
		!nt_json_get_uint64(nt_json_find(r.extension, "bufferView"), &r.view)) {
		r.obstacle = "something else uses its accessors";
	} else {
		r.source = nt_gltf_draco_block(p->document, r.view);
		nt_gltf_visit_attributes(r.primitive, p->sharing.accessor_count, note_outside, &r);
	}
	if (!status && !r.obstacle)
		status = recode(&r, done);
	if (status)
		return status;
	if (*done)
		share_block(&r);
	report_members(&r, *done);
	return *done ? NT_OK : make_all_plain(p, component);
}
