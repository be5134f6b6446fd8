/* SPDX-License-Identifier: MIT */
#include "gltf/create/create.h"
#include "gltf/edit/edit.h"
#include "gltf/load.h"
#include "gltf/verify/verify.h"
#include "hand_gltf.h"
#include "scene/values.h"

#include <math.h>

/* Nothing is committed, so nothing may be left. */
static int remove_empty_folder(void **state)
{
	return count_in_folder() ? -1 : remove_folder(state);
}

/* Writes the scene, lets `spoil` change what the writer should have written, and verifies. */
static nt_status verify_after(const char *name, void (*spoil)(hand_scene *), nt_error *error)
{
	hand_scene hand;
	make_scene(&hand);
	divide(&hand);
	const char *path = in_folder(name);
	const nt_write_options options = {.path = path,
		.format = strstr(name, ".glb") ? NT_FORMAT_GLB : NT_FORMAT_GLTF};
	nt_output *output;
	assert_int_equal(nt_output_create(&output, NULL, error), NT_OK);
	assert_int_equal(nt_gltf_compose(&hand.scene, &options, output, error), NT_OK);
	if (spoil)
		spoil(&hand);
	const nt_status status = nt_verify_gltf(&hand.scene, output, path, &options, error);
	nt_output_abort(output);
	return status;
}

TEST(good_output_is_good)
{
	nt_error error;
	assert_int_equal(verify_after("a b.glb", NULL, &error), NT_OK);
	assert_int_equal(verify_after("a b.gltf", NULL, &error), NT_OK); /* its .bin has no name yet */
}

static void change_last_tangent(hand_scene *hand)
{
	hand->tangents[23] = 1;
}

static void add_a_mesh(hand_scene *hand)
{
	static nt_mesh twice[2];
	twice[0] = twice[1] = hand->mesh;
	hand->scene.meshes = twice;
	hand->scene.mesh_count = 2;
}

static void turn_the_diagonal(hand_scene *hand)
{
	static uint8_t other[] = {0, 0};
	hand->mesh.face_diagonals = other;
}

TEST(every_difference_is_told)
{
	nt_error error;
	assert_int_equal(verify_after("a.glb", change_last_tangent, &error), NT_ERROR_INTERNAL);
	assert_non_null(strstr(error.message, "corner 6 of mesh \"hand\""));
	assert_int_equal(verify_after("a.gltf", turn_the_diagonal, &error), NT_ERROR_INTERNAL);
	assert_int_equal(verify_after("a.glb", add_a_mesh, &error), NT_ERROR_INTERNAL);
	assert_non_null(strstr(error.place.file, "a.glb"));
}

/* ---- a document that is edited ---- */

/* data/morph.gltf is a quad with one target that moves its positions; data/plates.gltf has three primitives of six
 * vertices each. */
enum { MESHES = 3, VERTICES = 6 };

typedef struct edited {
	nt_file file;
	nt_scene scene;
	nt_output *output;
	float tangents[MESHES][VERTICES][4], moved[VERTICES][3];
	uint32_t classes[VERTICES]; /* each vertex has its own */
	nt_morph_tangents morphed;
} edited;

static void edit(edited *p, const char *input, const nt_write_options *options)
{
	static const nt_read_options reading = {.texcoord_set = -1, .morphs = NT_MORPH_BAKE};
	nt_error error;
	assert_int_equal(nt_file_open(&p->file, input, NT_NAMED_BY_USER, &error), NT_OK);
	nt_scene_init(&p->scene, input);
	p->scene.bytes = p->file.data;
	p->scene.byte_count = p->file.size;
	p->scene.format = NT_FORMAT_GLTF;
	assert_int_equal(nt_gltf_open(&p->scene, &reading, &error), NT_OK);
	for (int v = 0; v < VERTICES; v++) {
		const float tangent[] = {0.6f, 0.8f, 0, 1}, moved[] = {-0.8f, 0.6f, 0};
		for (int m = 0; m < MESHES; m++)
			memcpy(p->tangents[m][v], tangent, sizeof tangent);
		memcpy(p->moved[v], moved, sizeof moved);
	}
	for (size_t m = 0; m < p->scene.mesh_count; m++) {
		nt_mesh *mesh = &p->scene.meshes[m];
		assert_int_equal(nt_gltf_load(&p->scene, mesh, &reading, &error), NT_OK);
		assert_true(mesh->vertex_count <= VERTICES);
		mesh->decision = NT_DECISION_SOLVE;
		mesh->split.vertex_tangents = p->tangents[m][0];
		if (!mesh->morph_count)
			continue;
		for (uint32_t v = 0; v < VERTICES; v++)
			p->classes[v] = v;
		p->morphed = (nt_morph_tangents){.class_of = p->classes, .parent = p->classes, .class_count = VERTICES,
			.words = (uint32_t *)(void *)p->moved[0], .word_count = 3 * VERTICES, .user_count = 2};
		mesh->morph_tangents = &p->morphed;
		mesh->morphs[0].class_count = mesh->morphs[0].row_count = VERTICES;
	}
	assert_int_equal(nt_output_create(&p->output, NULL, &error), NT_OK);
	assert_int_equal(nt_gltf_edit(&p->scene, options, p->output, &error), NT_OK);
}

static void close_edited(edited *p)
{
	nt_output_abort(p->output);
	nt_scene_free(&p->scene);
	nt_file_close(&p->file);
}

TEST(tangents_of_targets_are_compared)
{
	static const struct {
		nt_precision precision;
		nt_draco_choice draco;
	} ways[] = {{NT_PRECISION_FLOAT, NT_DRACO_KEEP}, {NT_PRECISION_SHORT, NT_DRACO_KEEP},
		{NT_PRECISION_BYTE, NT_DRACO_KEEP}, {NT_PRECISION_AUTO, NT_DRACO_AS_SEQUENTIAL}};
	for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
		const char *path = in_folder("a.glb");
		const nt_write_options options = {.path = path, .format = NT_FORMAT_GLB,
			.precision = ways[i].precision, .draco = ways[i].draco};
		edited p;
		nt_error error;
		edit(&p, NT_DATA_DIR "/morph.gltf", &options);
		assert_int_equal(p.scene.meshes[0].morph_count, 1);
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
		/* one bit of one number: 0.6 again, but for its last one */
		p.moved[2][1] = nextafterf(p.moved[2][1], 1);
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_ERROR_INTERNAL);
		assert_non_null(strstr(error.message, "corner 2 "));
		close_edited(&p);
	}
}

/* The order of threads does not matter. */
TEST(the_first_mesh_that_differs_is_told)
{
	static const nt_draco_choice ways[] = {NT_DRACO_OFF, NT_DRACO_AS_SEQUENTIAL, NT_DRACO_AS_EDGEBREAKER};
	for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
		const char *path = in_folder("a.glb");
		nt_write_options options = {.path = path, .format = NT_FORMAT_GLB, .draco = ways[i]};
		edited p;
		nt_error error;
		edit(&p, NT_DATA_DIR "/plates.gltf", &options);
		assert_int_equal(p.scene.mesh_count, MESHES);
		for (options.threads = 1; options.threads <= 4; options.threads++)
			assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
		for (int m = MESHES; m-- > 0;) {
			p.tangents[m][p.scene.meshes[m].indices[3]][3] = -1;
			for (options.threads = 1; options.threads <= 4; options.threads++) {
				char pointer[40];
				assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error),
					NT_ERROR_INTERNAL);
				snprintf(pointer, sizeof pointer, "/meshes/0/primitives/%d", m);
				assert_string_equal(error.place.pointer, pointer);
				assert_non_null(strstr(error.message, i == 0 ? "corner " : "in TANGENT of"));
			}
		}
		close_edited(&p);
	}
}

/* A triangle and a vertex that is in none. A source without that vertex would have the same corners. tinygltf refuses
 * the skin, and meshes are compared all the same. */
TEST(vertices_that_are_drawn_besides_triangles_are_told)
{
	static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}],\"skins\":[{\"joints\":[0]}],"
		"\"accessors\":[{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}}]}]}";
	const char *path = in_folder("a.glb");
	const nt_write_options options = {.path = path, .format = NT_FORMAT_GLB};
	edited p;
	nt_error error;
	put_text_file("unindexed.gltf", text);
	edit(&p, in_folder("unindexed.gltf"), &options);
	assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
	p.scene.meshes[0].source_vertex_count--;
	assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_ERROR_INTERNAL);
	assert_non_null(strstr(error.message, "in the vertices that are drawn of mesh"));
	assert_int_equal(p.scene.findings.items[0].code, NT_CODE_NOT_VERIFIED);
	/* one more face, of a primitive that gets no tangents */
	p.scene.meshes[0].decision = NT_SKIP_NO_SLOT;
	assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
	p.scene.meshes[0].primitives[0].face_count--;
	assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_ERROR_INTERNAL);
	assert_non_null(strstr(error.message, "in the number of faces of mesh"));
	close_edited(&p);
	remove(in_folder("unindexed.gltf"));
}

/* Changes the source instead of the block: the first vertex, by more than a step of its grid. */
TEST(each_attribute_of_a_block_is_compared)
{
	static const nt_draco_choice ways[] = {NT_DRACO_AS_SEQUENTIAL, NT_DRACO_AS_EDGEBREAKER};
	static const char *const names[] = {"POSITION", "NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"};
	for (size_t i = 0; i < 2 * sizeof names / sizeof *names; i++) {
		const char *path = in_folder("a.glb"), *name = names[i / 2];
		const nt_write_options options = {.path = path, .format = NT_FORMAT_GLB, .draco = ways[i % 2]};
		_Alignas(float) unsigned char changed[VERTICES * 16];
		char expected[60];
		edited p;
		nt_error error;
		edit(&p, NT_DATA_DIR "/skin.gltf", &options);
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
		nt_gltf *document = p.scene.source;
		nt_gltf_accessor *a = &document->accessors[nt_gltf_reference(document,
			nt_json_find(nt_gltf_primitive_of(document, &p.scene.meshes[0]), "attributes"), name)];
		assert_true(a->decoded && a->count * a->stride <= sizeof changed);
		a->decoded = memcpy(changed, a->decoded, (size_t)a->count * a->stride);
		if (a->component_type == NT_GLTF_FLOAT)
			*(float *)(void *)changed += 0.01f;
		else
			changed[0]++;
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_ERROR_INTERNAL);
		snprintf(expected, sizeof expected, "in %s of mesh", name);
		assert_non_null(strstr(error.message, expected));
		close_edited(&p);
	}
}

/* As if the encoder had taken one bit less than was asked for: a value of the source is put 0.3 of its grid's step
 * beside a point of the grid, which is 0.6 of a step if there is one bit more. Sequential normals may be two steps
 * away. The tangents' 0.8 is between two points. */
TEST(fewer_bits_than_were_asked_for_are_told)
{
	static const nt_draco_choice ways[] = {NT_DRACO_AS_SEQUENTIAL, NT_DRACO_AS_EDGEBREAKER};
	static const struct {
		const char *name;
		nt_draco_bits kind;
		size_t place; /* of the float */
		float values[2]; /* by way */
	} rows[] = {{"POSITION", NT_DRACO_BITS_POSITION, 3, {0.3f * 2 / 16383, 0.3f * 2 / 16383}},
		{"NORMAL", NT_DRACO_BITS_NORMAL, 0, {1.5f / 2047, 0.3f / 2047}},
		{"TEXCOORD_0", NT_DRACO_BITS_TEXCOORD, 0, {1 - 0.3f / 4095, 1 - 0.3f / 4095}},
		{"TANGENT", NT_DRACO_BITS_TANGENT, 0, {0, 0}}};
	for (size_t i = 0; i < 2 * sizeof rows / sizeof *rows; i++) {
		const char *path = in_folder("a.glb"), *name = rows[i / 2].name;
		nt_write_options options = {.path = path, .format = NT_FORMAT_GLB, .draco = ways[i % 2]};
		float changed[VERTICES * 4];
		char expected[60];
		edited p;
		nt_error error;
		edit(&p, NT_DATA_DIR "/skin.gltf", &options);
		nt_gltf *document = p.scene.source;
		const uint32_t number = nt_gltf_reference(document,
			nt_json_find(nt_gltf_primitive_of(document, &p.scene.meshes[0]), "attributes"), name);
		if (rows[i / 2].values[0] > 0) {
			nt_gltf_accessor *a = &document->accessors[number];
			const void *all = memcpy(changed, a->decoded, (size_t)a->count * a->stride);
			changed[rows[i / 2].place] = rows[i / 2].values[i % 2];
			a->decoded = all;
		}
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_OK);
		options.draco_bits[rows[i / 2].kind] = nt_gltf_draco_bits(options.draco_bits, rows[i / 2].kind) + 1;
		assert_int_equal(nt_verify_gltf(&p.scene, p.output, path, &options, &error), NT_ERROR_INTERNAL);
		snprintf(expected, sizeof expected, "in %s of mesh", name);
		assert_non_null(strstr(error.message, expected));
		close_edited(&p);
	}
}

AROUND_ALL(make_folder, remove_empty_folder)
