/* SPDX-License-Identifier: MIT */
/*
 * Every allocation of the OBJ and MTL readers and of the triangulation fails once; leaks are for the
 * sanitizers to see.
 */
#include "folder.h"
#include "fail_alloc.h"
#include "obj/read.h"
#include "scene/values.h"
#include "test.h"

static nt_status open_text(const char *path, const char *text, nt_error *error)
{
	nt_scene scene;
	nt_scene_init(&scene, path);
	scene.bytes = (const unsigned char *)text;
	scene.byte_count = strlen(text);
	nt_error_clear(error);
	const nt_read_options options = {.texcoord_set = -1, .threads = 1, .world = true};
	nt_status status = nt_obj_open(&scene, &options, error);
	stop_failing_allocations();
	if (!status && scene.left_out.failed) /* who writes it says so */
		status = NT_ERROR_MEMORY;
	/* positions that float cannot hold are read again */
	if (!status && strstr(text, "v 50000000"))
		assert_true(scene.origin[0] == 50000000 && scene.meshes[0].exact_positions[3] == 50000000.01);
	nt_scene_free(&scene);
	return status;
}

/* Each allocation of reading it fails once, alone and with all that come later; how many there are. */
static size_t fail_each(const char *path, const char *text)
{
	nt_error error;
	assert_int_equal(open_text(path, text, &error), NT_OK);
	for (size_t count = 0;; count++) {
		fail_allocation(count);
		const nt_status alone = open_text(path, text, &error);
		fail_allocations_from(count);
		const nt_status status = open_text(path, text, &error);
		assert_int_equal(alone, status);
		if (status == NT_OK)
			return count;
		assert_int_equal(status, NT_ERROR_MEMORY);
		assert_string_equal(error.message, "out of memory");
		assert_string_equal(error.place.file, path);
	}
}

TEST(every_allocation_of_the_reader_may_fail)
{
	char path[200], text[4000], *p = text;
	snprintf(path, sizeof path, "%s", in_folder("a.obj"));
	put_text_file("a.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\nbump b.png\nmap_Pr c.png\n");
	p += sprintf(p, "mtllib a.mtl\nmtllib none.mtl\no first\nusemtl a\ns 1\n");
	for (int i = 0; i < 60; i++)
		p += sprintf(p, "v 50000000.%02d %d 0 1 0 0\nvt 0 %d\nvn 0 0 1\n", i, i * i, i);
	p += sprintf(p, "f 1/1/1 2 3//3 4\no \xFC\nusemtl b\nf");
	for (int i = 1; i <= 60; i++)
		p += sprintf(p, " %d", i);
	p += sprintf(p, "\nf 1 1 1 1 1\nf");
	for (int i = 1; i <= 60; i++)
		p += sprintf(p, " 1/%d", i);
	sprintf(p, "\nl 1 2\n");

	assert_true(fail_each(path, text) > 40); /* at least one of each kind */

	/* no face has a material: all get the first */
	strcpy(text, "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
	assert_true(fail_each(path, text) > 10);

	/* tiles, and more primitives than are looked at one by one */
	put_text_file("u.mtl", "newmtl u\nmap_Kd u.<UDIM>.png\nnewmtl n\nmap_Kd n.1001.png\n");
	p = text + sprintf(text, "mtllib u.mtl\nusemtl u\n");
	for (int i = 0; i < 12; i++)
		p += sprintf(p, "g %d\nv %d 0 0\nv 0 1 0\nv 0 0 1\nvt %d.5 0.5\nf -3/-1 -2/-1 -1/-1\nusemtl %s\n",
			12 - i, i, i % 10, i % 2 ? "u" : "n");
	assert_true(fail_each(path, text) > 40);

	/* a name for which the arena has no room left */
	enum { LONG = 100000 };
	char *library = malloc(LONG + 100);
	p = library + sprintf(library, "newmtl a\nmap_Kd ");
	memset(p, 'x', LONG);
	strcpy(p + LONG, ".png\n");
	put_text_file("a.mtl", library);
	strcpy(text, "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
	fail_each(path, text);
	free(library);
}

/* Data goes into common blocks then; comments fill the chunks. */
TEST(every_allocation_for_a_file_of_many_chunks_may_fail)
{
	enum { CHUNKS = 6, CHUNK = 1 << 20 };
	char path[200], *const text = malloc(CHUNKS * CHUNK + 1000), *p = text;
	assert_non_null(text);
	snprintf(path, sizeof path, "%s", in_folder("many.obj"));
	for (int c = 0; c < CHUNKS; c++) {
		p += sprintf(p, "v %d 0 0\nv 0 %d 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nf -3/1/1 -2/1/1 -1/1/1\n#", c, c);
		memset(p, ' ', CHUNK);
		p[CHUNK] = '\n';
		p += CHUNK + 1;
		p[0] = '\0';
	}
	fail_each(path, text);
	free(text);
}

TEST(allocations_of_large_polygons_may_fail)
{
	static float points[100][3];
	static uint32_t triangles[3 * 98];
	for (int i = 0; i < 100; i++) {
		points[i][0] = (float)i;
		points[i][1] = (float)(i * i);
	}
	bool sound;
	for (size_t n = 0; n < 2; n++) {
		fail_allocations_from(n);
		const nt_status status =
			nt_polygon_triangulate((const float(*)[3])points, NULL, 100, triangles, &sound);
		assert_true(stop_failing_allocations());
		assert_int_equal(status, NT_ERROR_MEMORY);
	}
	assert_int_equal(nt_polygon_triangulate((const float(*)[3])points, NULL, 100, triangles, &sound),
		NT_OK);
	assert_true(sound);
}

AROUND_ALL(make_folder, remove_folder)
