/* SPDX-License-Identifier: MIT */
/*
 * A new glTF document for a scene from another format (OBJ, PLY, Draco): an empty one that is edited (model.h), and
 * saved as others are.
 *
 * One glTF mesh per mesh (of a mesh with groups: per group), one node per instance of it, one primitive per
 * material. A view has only its length at first: geometry is gathered while its buffer is written, embedded
 * images behind it. Only materials and images that something uses are written; a primitive without texture coordinates
 * gets its material without textures. A mesh without a material gets a neutral one, since glTF's default is metal.
 */
#include "gltf/create/create.h"

#include <string.h>
#include "base/text.h"
#include "gltf/create/model.h"

/* The bytes of a view that holds geometry. */
typedef struct block {
	struct composition *composition;
	const nt_new_primitive *primitive;
	nt_attribute attribute; /* NT_ATTRIBUTE_COUNT: the indices */
} block;

/* The accessors of a primitive. */
typedef struct primitive_record {
	uint32_t attributes[NT_ATTRIBUTE_COUNT];
	uint32_t indices;
} primitive_record;

typedef struct composition {
	nt_scene *scene;
	nt_write_options options;
	nt_output *output;
	nt_sink *main;
	nt_arena arena;
	nt_model model;
	nt_image_set *images;

	nt_new_primitives *primitives;           /* [mesh_count] */
	primitive_record **records;     /* [mesh_count][primitives] */
	nt_material neutral;       /* of primitives without material */
	uint32_t (*materials)[2];  /* [material_count + 1] in the document, without and with textures; last: neutral */
	block *blocks;
	size_t block_count;
} composition;

/* ---- planning ---- */

static nt_status plan_primitives(composition *c, nt_error *error)
{
	nt_scene *scene = c->scene;
	c->primitives = nt_arena_alloc(&c->arena, scene->mesh_count, sizeof *c->primitives);
	c->records = nt_arena_alloc(&c->arena, scene->mesh_count, sizeof *c->records);
	c->materials = nt_arena_alloc(&c->arena, scene->material_count + 1, sizeof *c->materials);
	if (!c->primitives || !c->records || !c->materials)
		return nt_fail_memory(error);
	memset(c->materials, 0xff, (scene->material_count + 1) * sizeof *c->materials);
	c->neutral = nt_material_default("");
	size_t count = 0;
	for (size_t m = 0; m < scene->mesh_count; m++) {
		const nt_status status = nt_new_primitives_make(&scene->meshes[m], &c->arena, &c->primitives[m], error);
		if (status != NT_OK)
			return status;
		c->records[m] = nt_arena_alloc(&c->arena, c->primitives[m].count, sizeof **c->records);
		if (!c->records[m])
			return nt_fail_memory(error);
		count += c->primitives[m].count;
		nt_mesh *mesh = &scene->meshes[m];
		mesh->made_primitives = c->primitives[m].count;
		size_t vertices = 0;
		for (size_t i = 0; i < mesh->made_primitives; i++)
			vertices += c->primitives[m].items[i].vertex_count;
		const size_t own = mesh->vertex_count + mesh->split.source_count;
		mesh->made_copies = mesh->made_primitives > 1 && vertices > own ? vertices - own : 0;
	}
	if (!count)
		return nt_fail(error, NT_ERROR_UNSUPPORTED, "found no faces, expected a mesh");
	c->blocks = nt_arena_alloc(&c->arena, count * (NT_ATTRIBUTE_COUNT + 1), sizeof *c->blocks);
	return c->blocks ? NT_OK : nt_fail_memory(error);
}

/* For nt_model_view(). */
static nt_status write_block(const void *user, const nt_byte_target *to, nt_error *error)
{
	const block *b = user;
	const nt_precision precision = b->composition->options.precision;
	nt_rounding cost = {0};
	if (b->attribute == NT_ATTRIBUTE_COUNT)
		return nt_new_primitive_write_indices(b->primitive, to, error);
	const nt_status status =
		nt_new_primitive_write_attribute(b->primitive, b->attribute, precision, &cost, to, error);
	if (b->attribute == NT_ATTRIBUTE_TANGENT && precision > NT_PRECISION_FLOAT)
		nt_precision_report(b->composition->scene, precision, &cost,
			nt_mesh_place(b->primitive->mesh, &(nt_place){0}));
	return status;
}

static uint32_t add_block(composition *c, const nt_new_primitive *primitive, nt_attribute attribute, uint64_t size)
{
	block *added = &c->blocks[c->block_count++];
	*added = (block){c, primitive, attribute};
	return nt_model_view(&c->model, size,
		attribute == NT_ATTRIBUTE_COUNT ? NT_GLTF_ELEMENT_ARRAY_BUFFER : NT_GLTF_ARRAY_BUFFER,
		write_block, added);
}

static uint32_t plan_attribute(composition *c, const nt_new_primitive *primitive, nt_attribute attribute)
{
	if (!nt_new_primitive_has(primitive, attribute) ||
		(attribute == NT_ATTRIBUTE_BITANGENT && !c->options.bitangents))
		return NT_MODEL_NONE;
	const int width = nt_attribute_width(attribute);
	const nt_precision precision =
		attribute == NT_ATTRIBUTE_TANGENT ? c->options.precision : NT_PRECISION_FLOAT;
	const bool integers = precision > NT_PRECISION_FLOAT;
	const size_t row_bytes = integers ? nt_precision_bytes(precision) : (size_t)width * sizeof(float);
	nt_model_accessor accessor = {
		.view = add_block(c, primitive, attribute, (uint64_t)primitive->vertex_count * row_bytes),
		.component_type = (int)nt_precision_component_type(precision),
		.components = width,
		.count = primitive->vertex_count,
		.normalized = integers,
	};
	if (integers)
		nt_model_require(&c->model, NT_GLTF_QUANTIZATION);
	float min[3], max[3];
	if (attribute == NT_ATTRIBUTE_POSITION) {
		nt_new_primitive_bounds(primitive, min, max);
		accessor.min = min;
		accessor.max = max;
	}
	return nt_model_add_accessor(&c->model, &accessor);
}

static uint32_t plan_indices(composition *c, const nt_new_primitive *primitive)
{
	if (!primitive->indices)
		return NT_MODEL_NONE;
	const uint32_t type = nt_new_primitive_index_type(primitive);
	const nt_model_accessor accessor = {
		.view = add_block(c, primitive, NT_ATTRIBUTE_COUNT,
			(uint64_t)primitive->index_count * nt_gltf_component_bytes(type)),
		.component_type = (int)type,
		.components = 1,
		.count = primitive->index_count,
	};
	return nt_model_add_accessor(&c->model, &accessor);
}

static void plan_geometry(composition *c)
{
	for (size_t m = 0; m < c->scene->mesh_count; m++)
		for (size_t p = 0; p < c->primitives[m].count; p++) {
			const nt_new_primitive *primitive = &c->primitives[m].items[p];
			primitive_record *record = &c->records[m][p];
			for (int s = 0; s < NT_ATTRIBUTE_COUNT; s++)
				record->attributes[s] = plan_attribute(c, primitive, (nt_attribute)s);
			record->indices = plan_indices(c, primitive);
		}
}

static nt_material *material_of(composition *c, const nt_new_primitive *primitive)
{
	return primitive->material == NT_NONE ? &c->neutral : &c->scene->materials[primitive->material];
}

/* Which of a material's two versions a primitive gets: with what takes texture coordinates, where both have something
 * to do with them. */
static bool is_textured(composition *c, const nt_new_primitive *primitive)
{
	return nt_new_primitive_has(primitive, NT_ATTRIBUTE_TEXCOORD) &&
		nt_material_takes_texcoords(material_of(c, primitive));
}

/* The material's number in the document, with or without textures as the primitive takes it. */
static uint32_t *number_of(composition *c, const nt_new_primitive *primitive)
{
	const size_t count = c->scene->material_count;
	return &c->materials[primitive->material == NT_NONE ? count : primitive->material][is_textured(c, primitive)];
}

static nt_status plan_materials(composition *c, nt_error *error)
{
	nt_status status = nt_image_set_create(&c->images, &c->options, error);
	for (size_t m = 0; m < c->scene->mesh_count && status == NT_OK; m++)
		for (size_t p = 0; p < c->primitives[m].count; p++) {
			const nt_new_primitive *primitive = &c->primitives[m].items[p];
			if (is_textured(c, primitive))
				nt_new_material_use(material_of(c, primitive), c->images);
		}
	/* The main file comes before its sidecars, and is none of the images that it refers to. */
	if (status == NT_OK)
		status = nt_output_add(c->output, c->options.path, NT_ROLE_MAIN, &c->main, error);
	if (status == NT_OK)
		status = nt_image_set_add(c->images, c->scene, &c->model, c->output, error);
	for (size_t m = 0; m < c->scene->mesh_count && status == NT_OK; m++)
		for (size_t p = 0; p < c->primitives[m].count; p++) {
			const nt_new_primitive *primitive = &c->primitives[m].items[p];
			uint32_t *known = number_of(c, primitive);
			if (*known == NT_MODEL_NONE)
				*known = nt_new_material_add(material_of(c, primitive),
					is_textured(c, primitive) ? c->images : NULL, &c->model);
		}
	return status;
}

/* The attributes of a primitive, in the order of their names. */
static size_t list_attributes(const primitive_record *record, nt_model_attribute *attributes)
{
	static const nt_attribute order[NT_ATTRIBUTE_COUNT] = {NT_ATTRIBUTE_COLOR, NT_ATTRIBUTE_NORMAL,
		NT_ATTRIBUTE_POSITION, NT_ATTRIBUTE_TANGENT, NT_ATTRIBUTE_TEXCOORD, NT_ATTRIBUTE_BITANGENT};
	size_t count = 0;
	for (int i = 0; i < NT_ATTRIBUTE_COUNT; i++)
		if (record->attributes[order[i]] != NT_MODEL_NONE)
			attributes[count++] =
				(nt_model_attribute){nt_attribute_name(order[i]), record->attributes[order[i]]};
	return count;
}

static const char *name_of(const composition *c, size_t m, uint32_t group)
{
	const nt_mesh *mesh = &c->scene->meshes[m];
	return mesh->groups ? mesh->groups[group] : mesh->name;
}

/* Whether a primitive begins a mesh of the document: the first of each group does. */
static bool begins_mesh(const nt_new_primitives *primitives, size_t p)
{
	return p == 0 || primitives->items[p].group != primitives->items[p - 1].group;
}

/* Meshes, their primitives, and a node for each of their instances. */
static nt_status plan_scene(composition *c, nt_error *error)
{
	const nt_scene *scene = c->scene;
	uint32_t *numbers = nt_arena_alloc(&c->arena, scene->mesh_count, sizeof *numbers);
	if (!numbers)
		return nt_fail_memory(error);
	uint32_t count = 0;
	for (size_t m = 0; m < scene->mesh_count; m++) {
		numbers[m] = count;
		for (size_t p = 0; p < c->primitives[m].count; p++) {
			const nt_new_primitive *primitive = &c->primitives[m].items[p];
			const primitive_record *record = &c->records[m][p];
			nt_model_attribute attributes[NT_ATTRIBUTE_COUNT];
			const size_t attribute_count = list_attributes(record, attributes);
			if (begins_mesh(&c->primitives[m], p))
				count = nt_model_mesh(&c->model, name_of(c, m, primitive->group)) + 1;
			nt_model_primitive(&c->model, attributes, attribute_count, record->indices,
				*number_of(c, primitive));
		}
	}
	for (size_t i = 0; i < scene->instance_count; i++) {
		const size_t m = scene->instances[i].mesh; /* its matrix is that of the origin */
		uint32_t number = numbers[m];
		for (size_t p = 0; p < c->primitives[m].count; p++)
			if (begins_mesh(&c->primitives[m], p))
				nt_model_node(&c->model, name_of(c, m, c->primitives[m].items[p].group), number++,
					scene->origin);
	}
	return NT_OK;
}

nt_status nt_gltf_compose(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error)
{
	composition c = {.scene = scene, .options = *options, .output = output};
	const bool alone = options->format == NT_FORMAT_GLB || options->buffers == NT_BUFFERS_EMBED;
	if (!alone && nt_output_is_stream(options->path))
		return nt_fail(error, NT_ERROR_USAGE,
			"glTF with a .bin cannot go to %s; write glb, or use --buffers=embed",
			strcmp(options->path, "-") == 0 ? "standard output" : "a device");

	nt_status status = nt_model_create(&c.model, error);
	const nt_place place = nt_line_place(scene->path, scene->left_out_line);
	if (scene->left_out.size)
		nt_finding_add(&scene->findings, NT_CODE_REFERENCE_LOST, &place, scene->left_out_count, "%.*s",
			NT_CUT(200, scene->left_out.data));
	scene->findings.failed |= scene->left_out.failed;
	/* The primitives made of each mesh. */
	if (status == NT_OK)
		status = plan_primitives(&c, error);
	/* The layout of the buffer. */
	if (status == NT_OK) {
		plan_geometry(&c);
		status = plan_materials(&c, error);
	}
	if (status == NT_OK)
		status = plan_scene(&c, error);
	if (status == NT_OK)
		status = nt_model_finish(&c.model, error);
	if (status == NT_OK)
		status = nt_gltf_save(scene, &c.model.edits, options, "", output, c.main, error);
	nt_image_set_free(c.images);
	nt_model_free(&c.model);
	nt_arena_free(&c.arena);
	return status;
}
