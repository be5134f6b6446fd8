/* SPDX-License-Identifier: MIT */
/*
 * Every prefix of a PLY file, every byte replaced, and memory that ends; tests/cli/texts.tsv has each fault and where
 * it is.
 */
#include "fail_alloc.h"
#include "ply/ply.h"
#include "ply_file.h"

/* A prefix that lacks nothing but blanks at the end is sound, any other one is refused with a place. */
TEST(every_prefix_is_read_or_refused)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		for (size_t size = 0; size < m.size; size++) {
			reading r;
			open_bytes(&r, m.bytes, size);
			if (r.status) {
				/* "format ascii 1." is another version */
				assert_true(r.status == NT_ERROR_INPUT ||
					    (r.status == NT_ERROR_UNSUPPORTED &&
						    r.error.place.line == 2));
				assert_true(r.error.place.line > 0 || r.error.place.offset <= size);
			} else {
				assert_true(encoding == PLY_ASCII && size + 6 > m.size);
			}
			close_reading(&r);
		}
	}
}

/* Every byte of the body replaced by others: nothing may be read or written out of bounds. */
TEST(damaged_bytes_do_no_harm)
{
	static const unsigned char values[] = {0, 1, 9, '-', ' ', '\n', '9', 0x7f, 0x80, 0xff};
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		for (size_t at = 0; at < m.size; at++) {
			const unsigned char kept = m.bytes[at];
			for (size_t i = 0; i < sizeof values; i++) {
				m.bytes[at] = values[i];
				reading r;
				open_bytes(&r, m.bytes, m.size);
				close_reading(&r);
			}
			m.bytes[at] = kept;
		}
	}
}

/* Opens a file, of which `is_right` says whether it was read as it should be, with ever more allocations; each fails
 * alone, and with all that come later. The writer tells what fails in a list. */
static void open_with_few_allocations(const void *bytes, size_t size, bool (*is_right)(const nt_scene *scene))
{
	bool failed = true;
	size_t n = 0;
	for (; failed || n % 2; n++) {
		nt_scene scene;
		nt_error error;
		nt_error_clear(&error);
		nt_scene_init(&scene, "test.ply");
		scene.bytes = bytes;
		scene.byte_count = size;
		const nt_read_options options = {.texcoord_set = -1, .threads = 1};
		(n % 2 ? fail_allocations_from : fail_allocation)(n / 2);
		const nt_status status = nt_ply_open(&scene, &options, &error);
		failed = stop_failing_allocations();
		const bool listed = scene.findings.failed || scene.left_out.failed;
		assert_true(failed ? status == NT_ERROR_MEMORY || listed : !status);
		assert_true(failed || is_right(&scene));
		nt_scene_free(&scene);
	}
	assert_true(n > 40);
}

static bool is_full(const nt_scene *scene)
{
	return scene->meshes[0].face_count == 5 && scene->meshes[0].vertex_count == 9;
}

static bool is_far(const nt_scene *scene)
{
	return scene->instances[0].matrix[12] > 4999999 && scene->meshes[0].face_count == 4;
}

TEST(every_allocation_may_fail)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		open_with_few_allocations(m.bytes, m.size, is_full);
	}
	/* the second reading of positions that float does not hold, and the second cut of polygons */
	char text[800];
	int size = sprintf(text, "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
		"property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n");
	for (int i = 0; i < 6; i++)
		size += sprintf(text + size, "%d.0%d -5000000.0%d 0\n", 5000000, i, i * i);
	size += sprintf(text + size, "5 0 1 2 3 5\n3 0 1 2\n");
	open_with_few_allocations(text, (size_t)size, is_far);
}
