/* SPDX-License-Identifier: MIT */
/*
 * Stands in for cgltf.h, of which it has what data/examples/cgltf.c calls: whatever the file, a quad and its mirror
 * image that share two vertices. $CGLTF names a folder with the real one.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef size_t cgltf_size;
typedef enum { cgltf_result_success } cgltf_result;
typedef enum {
	cgltf_attribute_type_position,
	cgltf_attribute_type_normal,
	cgltf_attribute_type_texcoord
} cgltf_attribute_type;
typedef struct { const float *floats; cgltf_size width, count; } cgltf_accessor;
typedef struct { cgltf_accessor *data; } cgltf_attribute;
typedef struct { cgltf_accessor *indices; cgltf_attribute *attributes; } cgltf_primitive;
typedef struct { cgltf_primitive *primitives; } cgltf_mesh;
typedef struct { cgltf_mesh *meshes; } cgltf_data;
typedef struct { int type; } cgltf_options;

static const float cgltf_floats[3][18] = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0},
	{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, {0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0}};
static cgltf_accessor cgltf_accessors[4] = {{cgltf_floats[0], 3, 6}, {cgltf_floats[1], 3, 6}, {cgltf_floats[2], 2, 6},
	{NULL, 1, 12}};
static cgltf_attribute cgltf_attributes[3] = {{&cgltf_accessors[0]}, {&cgltf_accessors[1]}, {&cgltf_accessors[2]}};
static cgltf_primitive cgltf_primitives[1] = {{&cgltf_accessors[3], cgltf_attributes}};
static cgltf_mesh cgltf_meshes[1] = {{cgltf_primitives}};
static cgltf_data cgltf_file = {cgltf_meshes};

static cgltf_result cgltf_parse_file(const cgltf_options *options, const char *path, cgltf_data **data)
{
	(void)options, (void)path;
	*data = &cgltf_file;
	return cgltf_result_success;
}

static cgltf_result cgltf_load_buffers(const cgltf_options *options, cgltf_data *data, const char *path)
{
	(void)options, (void)data, (void)path;
	return cgltf_result_success;
}

static void cgltf_free(cgltf_data *data)
{
	(void)data;
}

static const cgltf_accessor *cgltf_find_accessor(const cgltf_primitive *primitive, cgltf_attribute_type type, int index)
{
	return index == 0 ? primitive->attributes[type].data : NULL;
}

static int cgltf_accessor_read_float(const cgltf_accessor *accessor, cgltf_size row, float *out, cgltf_size width)
{
	memcpy(out, accessor->floats + accessor->width * row, width * sizeof *out);
	return 1;
}

static cgltf_size cgltf_accessor_unpack_indices(const cgltf_accessor *accessor, void *out, cgltf_size bytes,
	cgltf_size count)
{
	static const uint32_t indices[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
	memcpy(out, indices, accessor->count * bytes);
	return count;
}
