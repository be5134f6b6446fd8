/* SPDX-License-Identifier: MIT */
#include <math.h>
#include "ext/draco.h"
#include "format/format.h"
#include "test.h"

static const float positions[][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
static const float texcoords[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0.25f}};
static const int8_t normals[][3] = {{0, 0, 127}, {0, 127, 0}, {-128, 0, 0}, {0, -127, 0}};
static const uint8_t colors[][3] = {{255, 0, 51}, {0, 0, 0}, {0, 0, 0}, {0, 255, 0}};
static const float tangents[4][4];
static const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
static const nt_draco_attribute attributes[] = {
	{.unique_id = 0, .kind = NT_DRACO_POSITION, .component_type = 5126, .components = 3, .data = positions},
	{.unique_id = 1, .kind = NT_DRACO_NORMAL, .component_type = 5120, .components = 3,
		.normalized = true, .data = normals},
	{.unique_id = 2, .kind = NT_DRACO_TEXCOORD, .component_type = 5126, .components = 2,
		.data = texcoords},
	{.unique_id = 3, .kind = NT_DRACO_COLOR, .component_type = 5121, .components = 3,
		.normalized = true, .data = colors},
	{.unique_id = 4, .kind = NT_DRACO_GENERIC, .component_type = 5126, .components = 4,
		.data = tangents},
};
static const nt_draco_mesh quad = {.method = NT_DRACO_SEQUENTIAL, .point_count = 4, .face_count = 2,
	.indices = indices, .attributes = attributes, .attribute_count = 5};

static nt_status open_bytes(nt_scene *scene, const unsigned char *bytes, size_t size,
	nt_error *error)
{
	const nt_read_options options = {.texcoord_set = -1};
	nt_scene_init(scene, "mesh.drc");
	scene->bytes = bytes;
	scene->byte_count = size;
	const nt_format_entry *entry = nt_format_of_input(bytes, size, "no name");
	assert_non_null(entry);
	assert_int_equal(entry->format, NT_FORMAT_DRC);
	return entry->open(scene, &options, error);
}

static nt_draco_block encoded(const nt_draco_mesh *mesh)
{
	nt_draco_block block;
	nt_error error;
	const nt_status status = nt_draco_encode(mesh, &block, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
	return block;
}

TEST(quad_becomes_a_mesh_of_two_triangles)
{
	nt_draco_block block = encoded(&quad);
	nt_scene scene;
	nt_error error;
	assert_int_equal(open_bytes(&scene, block.bytes, block.size, &error), NT_OK);
	assert_int_equal(scene.mesh_count, 1);
	assert_int_equal(scene.instance_count, 1);
	const nt_mesh *mesh = scene.meshes;
	assert_int_equal(mesh->vertex_count, 4);
	assert_int_equal(mesh->face_count, 2);
	assert_true(mesh->triangles && mesh->reachable && mesh->has_normals && mesh->has_texcoords);
	assert_memory_equal(mesh->indices, indices, sizeof indices);
	assert_memory_equal(mesh->positions, positions, sizeof positions);
	assert_memory_equal(mesh->texcoords, texcoords, sizeof texcoords);
	/* n / 127, and -128 is -1 too; c / 255 as sRGB, and alpha 1 */
	static const float unit[] = {0, 0, 1, 0, 1, 0, -1, 0, 0, 0, -1, 0};
	assert_memory_equal(mesh->normals, unit, sizeof unit);
	const float rgba[] = {1, 0, (float)pow((51 / 255.0f + 0.055) / 1.055, 2.4), 1};
	assert_memory_equal(mesh->colors, rgba, sizeof rgba);
	assert_string_equal(scene.left_out.data, "Draco attribute 4 with 4 components"); /* the generic one */
	nt_scene_free(&scene);
	nt_draco_block_free(&block);
}

TEST(mesh_without_positions_is_refused)
{
	nt_draco_mesh bare = quad;
	bare.attributes++;
	bare.attribute_count--;
	nt_draco_block block = encoded(&bare);
	nt_scene scene;
	nt_error error;
	assert_int_equal(open_bytes(&scene, block.bytes, block.size, &error), NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "no positions"));
	nt_scene_free(&scene);
	nt_draco_block_free(&block);
}

/* As OBJ and PLY: glTF cannot store it, and a PLY of it could not be read again. */
TEST(values_that_are_not_finite_are_refused)
{
	nt_draco_block block = encoded(&quad);
	/* every float of the file that is 2.0 or 0.25, the greatest position and the last coordinate, in turn */
	size_t refused = 0;
	for (size_t at = 0; at + 4 <= block.size; at++) {
		static const float values[] = {2.0f, 0.25f}, infinite = INFINITY;
		if (memcmp(block.bytes + at, &values[0], 4) != 0 && memcmp(block.bytes + at, &values[1], 4) != 0)
			continue;
		unsigned char *copy = memcpy(malloc(block.size), block.bytes, block.size);
		memcpy(copy + at, &infinite, 4);
		nt_scene scene;
		nt_error error;
		assert_int_equal(open_bytes(&scene, copy, block.size, &error), NT_ERROR_INPUT);
		assert_non_null(strstr(error.message, "finite"));
		refused++;
		nt_scene_free(&scene);
		free(copy);
	}
	assert_int_equal(refused, 3);
	nt_draco_block_free(&block);
}
