/* SPDX-License-Identifier: MIT */
/*
 * glTF files in the folder of the test: made of accessors, converted, opened again.
 */
#ifndef NT_TEST_HAND_GLTF_FILE_H
#define NT_TEST_HAND_GLTF_FILE_H

#include "base/text.h"
#include "fail_alloc.h"
#include "file/input.h"
#include "file/path.h"
#include "folder.h"
#include "gltf/document.h"
#include "gltf/load.h"
#include "pipeline/run.h"
#include "test.h"

/* ---- writing ---- */

#define NORMAL_MAP "\"textures\":[{}],\"materials\":[{\"normalTexture\":{\"index\":0}}],"

/* Members of a document with a triangle of POSITION, NORMAL and TEXCOORD_0 in views 0, 1 and 2. */
#define TRIANGLE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}," \
	"\"material\":0}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"," \
	"\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}," \
	"{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}]," NORMAL_MAP

/* The accessors of a .glb, one behind the other in its buffer. */
typedef struct hand_file {
	nt_buffer bin, accessors;
	size_t accessor_count;
} hand_file;

/* Returns its number. Vectors of whole numbers are normalized. */
static inline size_t put_accessor(hand_file *f, const void *data, size_t count, int type, const char *kind)
{
	const bool vector = *kind == 'V';
	const size_t bytes = count * nt_component_size(type) * (vector ? (size_t)(kind[3] - '0') : 1);
	nt_buffer_format(&f->accessors, "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":%d,"
		"\"count\":%zu,\"type\":\"%s\"%s}", f->accessor_count ? "," : "", f->bin.size, type, count, kind,
		vector && type != NT_GLTF_FLOAT ? ",\"normalized\":true" : "");
	nt_buffer_append(&f->bin, data, bytes);
	nt_buffer_append(&f->bin, "\0\0\0", (4 - bytes % 4) % 4);
	return f->accessor_count++;
}

/* Writes and ends it. members: of the document, each with a comma behind it. */
static inline void put_glb(const char *name, hand_file *f, const char *members)
{
	nt_buffer json = {0};
	nt_buffer_format(&json, "{\"asset\":{\"version\":\"2.0\"},%s\"bufferViews\":[{\"buffer\":0,"
		"\"byteLength\":%zu}],\"accessors\":[%s],\"buffers\":[{\"byteLength\":%zu}]}", members,
		f->bin.size, f->accessors.data, f->bin.size);
	put_glb_file(name, json.data, f->bin.data, f->bin.size);
	nt_buffer_free(&json);
	nt_buffer_free(&f->bin);
	nt_buffer_free(&f->accessors);
	*f = (hand_file){0};
}

/* A buffer of a document, with its bytes in a data URI. */
static inline void append_buffer(nt_buffer *json, const void *bytes, size_t size)
{
	nt_buffer_format(json, "{\"byteLength\":%zu,\"uri\":\"", size);
	nt_uri_append_data(json, "application/octet-stream", bytes, size);
	nt_buffer_text(json, "\"}");
}

/* ---- converting ---- */

/* The summary of a run that succeeds. to: NULL for a check. */
static inline nt_summary convert_file(const char *from, const char *to, nt_settings settings)
{
	nt_summary summary;
	nt_error error;
	settings.io.texcoord_set = -1;
	if (nt_run(in_folder(from), to ? in_folder(to) : NULL, &settings, &summary, &error))
		fail_msg("%s: %s: %s", from, error.place.pointer, error.message);
	return summary;
}

/* Runs it with the first allocation failing, and all behind it, then from the second on, until none fails: memory is
 * exhausted, or the run succeeds all the same. Returns how often it did not. from: a path. */
static inline size_t exhaust_memory(const char *from, nt_settings settings)
{
	char input[512];
	size_t told = 0;
	bool failed = true;
	snprintf(input, sizeof input, "%s", from); /* in_folder() forgets it */
	settings.io.texcoord_set = -1;
	for (size_t n = 0; failed; n++) {
		nt_summary summary;
		nt_error error;
		fail_allocations_from(n);
		const nt_status status = nt_run(input, in_folder("out.glb"), &settings, &summary, &error);
		failed = stop_failing_allocations();
		if (status && (status != NT_ERROR_MEMORY || !failed || !strstr(error.message, "out of memory")))
			fail_msg("%s, allocation %zu: %s", input, n, error.message);
		told += status != NT_OK;
		nt_summary_free(&summary);
		/* what frees the document allocates too, from a reserve: the last ones do no harm */
		assert_true(n < told + 50 && n < 10000);
	}
	return told;
}

/* How often a code was found. */
static inline size_t count_findings(const nt_summary *summary, nt_code code)
{
	size_t count = 0;
	for (size_t i = 0; i < summary->findings.count; i++)
		count += summary->findings.items[i].code == code ? summary->findings.items[i].count : 0;
	return count;
}

/* ---- opening ---- */

static inline nt_file file_in_folder(const char *name)
{
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, in_folder(name), NT_NAMED_BY_USER, &error), NT_OK);
	return file;
}

static inline bool same_files(const char *a, const char *b)
{
	nt_file x = file_in_folder(a), y = file_in_folder(b);
	const bool same = x.size == y.size && memcmp(x.data, y.data, x.size) == 0;
	nt_file_close(&x);
	nt_file_close(&y);
	return same;
}

/* A document in memory, which stays the caller's. */
static inline nt_status open_bytes(nt_scene *scene, const void *bytes, size_t size, const nt_read_options *options,
	nt_error *error)
{
	nt_error_clear(error);
	nt_scene_init(scene, "hand.gltf");
	scene->bytes = bytes;
	scene->byte_count = size;
	return nt_gltf_open(scene, options, error);
}

/* A file, for as long as the scene is used. */
static inline void open_file(nt_scene *scene, nt_file *file, const char *name, const nt_read_options *options)
{
	nt_error error;
	*file = file_in_folder(name);
	if (open_bytes(scene, file->data, file->size, options, &error))
		fail_msg("%s: %s: %s", name, error.place.pointer, error.message);
}

/* The accessor of a TANGENT; target -1: the primitive's. NT_NONE: there is none. */
static inline uint32_t tangent_of(const nt_scene *scene, size_t mesh, size_t primitive, int target)
{
	const nt_json_value *found = nt_json_at(nt_json_find(
		nt_json_at(nt_gltf_root_member(scene->source, "meshes"), mesh), "primitives"), primitive);
	const nt_json_value *attributes = target < 0 ? nt_json_find(found, "attributes") :
		nt_json_at(nt_json_find(found, "targets"), (size_t)target);
	uint64_t index = NT_NONE;
	nt_json_get_uint64(nt_json_find(attributes, "TANGENT"), &index);
	return (uint32_t)index;
}

/* The rows of an accessor, which the scene keeps; *count receives how many there are. */
static inline const float *rows_of(nt_scene *scene, uint32_t index, uint32_t width, uint64_t *count)
{
	const nt_gltf_accessor *accessor;
	nt_error error;
	float *rows;
	assert_int_equal(nt_gltf_get_accessor(scene->source, index, "", &accessor, &error), NT_OK);
	assert_int_equal(nt_gltf_floats(scene->source, accessor, width, 0, &scene->arena, &rows, &error), NT_OK);
	*count = accessor->count;
	return rows;
}

#endif
