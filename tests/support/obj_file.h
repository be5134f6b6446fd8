/* SPDX-License-Identifier: MIT */
/*
 * OBJ files in strings, for the tests of the reader. Bytes are copied into a block of their exact size, so that the
 * sanitizers see a step too far.
 */
#ifndef NT_TEST_OBJ_FILE_H
#define NT_TEST_OBJ_FILE_H

#include "test.h"
#include "obj/read.h"

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

typedef struct reading {
	nt_scene scene;
	nt_error error;
	nt_status status;
	unsigned char *bytes;
} reading;

static inline void open_bytes(reading *r, const char *text, size_t size, unsigned threads)
{
	r->bytes = malloc(size ? size : 1);
	memcpy(r->bytes, text, size);
	nt_scene_init(&r->scene, "folder/test.obj");
	r->scene.bytes = r->bytes;
	r->scene.byte_count = size;
	nt_error_clear(&r->error);
	const nt_read_options options = {.texcoord_set = -1, .threads = threads};
	r->status = nt_obj_open(&r->scene, &options, &r->error);
}

static inline void open_text(reading *r, const char *text)
{
	open_bytes(r, text, strlen(text), 1);
}

static inline void close_reading(reading *r)
{
	nt_scene_free(&r->scene);
	free(r->bytes);
}

/* The mesh of a file that is sound and has one. */
static inline const nt_mesh *only_mesh(reading *r, const char *text)
{
	open_text(r, text);
	if (r->status)
		print_message("%zu: %s\n", r->error.place.line, r->error.message);
	assert_int_equal(r->status, NT_OK);
	assert_int_equal(r->scene.mesh_count, 1);
	return &r->scene.meshes[0];
}

#endif
