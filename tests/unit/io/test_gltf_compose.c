/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>
#include "ext/tinygltf.h"
#include "io/format.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static char folder[] = "/tmp/nmtan-compose-XXXXXX";

static int make_folder(void **state)
{
	(void)state;
	return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
	(void)state;
	char command[100];
	snprintf(command, sizeof command, "rm -r '%s'", folder);
	return system(command);
}

static const char *path_of(const char *name)
{
	static char paths[4][200];
	static unsigned next;
	char *path = paths[next++ % 4];
	snprintf(path, sizeof paths[0], "%s/%s", folder, name);
	return path;
}

static void write_file(const char *name, const void *bytes, size_t size)
{
	FILE *file = fopen(path_of(name), "wb");
	assert_non_null(file);
	assert_int_equal(fwrite(bytes, 1, size, file), size);
	fclose(file);
}

static bool exists(const char *name)
{
	return access(path_of(name), F_OK) == 0;
}

/* The text of a file, for strstr(). */
static char *text_of(const char *name)
{
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, path_of(name), &error), NMTAN_OK);
	char *text = calloc(file.size + 1, 1);
	memcpy(text, file.data, file.size);
	nt_file_close(&file);
	return text;
}

/* ---- composing and reading back ---- */

static nmtan_status compose(nt_scene *scene, nt_write_options options, const char *name,
	nt_error *error)
{
	nt_output *output;
	options.path = path_of(name);
	options.format = strstr(name, ".glb") ? NT_FORMAT_GLB : NT_FORMAT_GLTF;
	assert_int_equal(nt_output_create(&output, NULL, error), NMTAN_OK);
	const nmtan_status status = nt_gltf_compose(scene, &options, output, error);
	if (status == NMTAN_OK)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

static void compose_well(nt_scene *scene, nt_write_options options, const char *name)
{
	nt_error error;
	const nmtan_status status = compose(scene, options, name, &error);
	if (status != NMTAN_OK)
		fail_msg("%s", error.message);
}

typedef struct opened {
	nt_file main, companion;
	nt_reread *reread;
} opened;

static bool find_companion(void *user, const char *uri, const unsigned char **bytes, size_t *size)
{
	opened *file = user;
	nt_error error;
	if (strstr(uri, ".bin") == NULL ||
		nt_file_open(&file->companion, path_of(uri), &error) != NMTAN_OK)
		return false;
	*bytes = file->companion.data;
	*size = file->companion.size;
	return true;
}

static opened open_back(const char *name)
{
	opened file = {.companion = {.fd = -1}};
	nt_error error;
	assert_int_equal(nt_file_open(&file.main, path_of(name), &error), NMTAN_OK);
	const nmtan_status status = nt_reread_open(&file.reread, file.main.data, file.main.size,
		find_companion, &file, &error);
	if (status != NMTAN_OK)
		fail_msg("%s", error.message);
	return file;
}

static void close_back(opened *file)
{
	nt_reread_free(file->reread);
	nt_file_close(&file->main);
	if (file->companion.data)
		nt_file_close(&file->companion);
}

static nt_reread_array array_of(const opened *file, size_t mesh, size_t primitive, const char *name)
{
	nt_reread_array array;
	nt_error error;
	const nmtan_status status =
		nt_reread_attribute(file->reread, mesh, primitive, name, &array, &error);
	if (status != NMTAN_OK)
		fail_msg("%s", error.message);
	return array;
}

static void assert_floats(const opened *file, size_t primitive, const char *name,
	const float *expected, size_t count, int width)
{
	const nt_reread_array array = array_of(file, 0, primitive, name);
	assert_int_equal(array.count, count);
	assert_int_equal(array.components, width);
	assert_int_equal(array.component_type, NT_GLTF_FLOAT);
	assert_memory_equal(array.data, expected, count * (size_t)width * sizeof(float));
}

static void assert_indices(const opened *file, size_t primitive, const uint16_t *expected,
	size_t count)
{
	const nt_reread_array array = array_of(file, 0, primitive, NULL);
	assert_int_equal(array.count, count);
	assert_int_equal(array.component_type, NT_GLTF_UNSIGNED_SHORT);
	assert_memory_equal(array.data, expected, count * sizeof *expected);
}

/* ---- a scene made by hand ---- */

/* A quad and a triangle in the plane z = 0; vertex 2 is split for the triangle, which has tangents the other
 * way. v is not a float of few bits on purpose: 1 - v rounds.
 *
 *   3---2---4
 *   |   | /
 *   0---1     quad 0 1 2 3, triangle 1 4 2 */
static float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 1, 0};
static float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0, 0};
static float texcoords[] = {0, 0, 1, 0.1f, 1, 1, 0, 0.7f, 2, 1};
static uint32_t corners[] = {0, 1, 2, 3, 1, 4, 2};
static uint8_t sizes[] = {4, 3};
static uint8_t diagonals[] = {1, 0};
static uint32_t split_corners[] = {0, 1, 2, 3, 1, 4, 5};
static uint32_t split_sources[] = {2};
static float tangents[] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, -1, 0, 0, -1};
static uint32_t face_primitive[] = {1, 0};

typedef struct hand_scene {
	nt_scene scene;
	nt_mesh mesh;
	nt_primitive primitives[2];
	nt_instance instance;
	nt_material material;
} hand_scene;

/* Fills a scene in place, since it points into itself. */
static nt_scene *make_scene(hand_scene *hand)
{
	*hand = (hand_scene){
		.mesh = {.name = "hand", .vertex_count = 5, .positions = positions, .normals = normals,
			.texcoords = texcoords, .face_count = 2, .corner_count = 7, .face_sizes = sizes,
			.face_diagonals = diagonals, .indices = corners, .primitive_count = 1,
			.split = {split_corners, split_sources, 1, tangents}},
		.primitives = {{.material = NT_NONE, .face_count = 1}, {.material = NT_NONE, .face_count = 1}},
		.instance = {.matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
		.material = {.name = "m", .base_color = {1, 1, 1, 1}, .roughness = 1, .normal_scale = 1},
	};
	nt_scene_init(&hand->scene, path_of("hand.obj"));
	hand->mesh.primitives = hand->primitives;
	hand->scene.meshes = &hand->mesh;
	hand->scene.mesh_count = 1;
	hand->scene.instances = &hand->instance;
	hand->scene.instance_count = 1;
	hand->scene.materials = &hand->material;
	hand->scene.material_count = 1;
	return &hand->scene;
}

/* What the whole mesh should look like in the file: the copy of vertex 2 at the end, v turned round, normals of
 * unit length, the zero one along z. */
static const float out_positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 1, 0, 1, 1, 0};
static const float out_normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float out_texcoords[] = {0, 1, 1, 1 - 0.1f, 1, 0, 0, 1 - 0.7f, 2, 0, 1, 0};
/* cross((0, 0, 1), (x, 0, 0)) * w = (0, x, 0) * w; the last has w = -1, which signs its zeros */
static const float out_bitangents[] = {
	0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, -0.0f, 1, -0.0f};
static const uint16_t out_indices[] = {0, 1, 3, 1, 2, 3, 1, 4, 5};

static void assert_whole(const opened *file)
{
	assert_floats(file, 0, "POSITION", out_positions, 6, 3);
	assert_floats(file, 0, "NORMAL", out_normals, 6, 3);
	assert_floats(file, 0, "TEXCOORD_0", out_texcoords, 6, 2);
	assert_floats(file, 0, "TANGENT", tangents, 6, 4);
	assert_indices(file, 0, out_indices, 9);
}

static void one_primitive_is_the_same_in_every_container(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	static const char *const names[] = {"one.gltf", "one embedded.gltf", "one.glb"};
	for (size_t i = 0; i < COUNT(names); i++) {
		compose_well(scene, (nt_write_options){.embed = i == 1, .bitangents = true}, names[i]);
		opened file = open_back(names[i]);
		assert_whole(&file);
		assert_floats(&file, 0, "_BITANGENT", out_bitangents, 6, 3);
		close_back(&file);
	}
	assert_true(exists("one.bin"));
	assert_false(exists("one embedded.bin"));
	char *text = text_of("one.gltf");
	assert_non_null(strstr(text, "\"uri\":\"one.bin\""));
	assert_non_null(strstr(text, "\"min\":[0.0,0.0,0.0]"));
	assert_non_null(strstr(text, "\"max\":[2.0,1.0,0.0]"));
	assert_non_null(strstr(text, "\"generator\":\"nmtan " NMTAN_VERSION_STRING "\""));
	free(text);
	nt_scene_free(scene);
}

static void several_primitives_get_their_own_vertices_in_order_of_use(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	hand.mesh.primitive_count = 2;
	hand.mesh.face_primitive = face_primitive; /* the triangle first */
	compose_well(scene, (nt_write_options){.bitangents = true}, "two.gltf");
	opened file = open_back("two.gltf");
	assert_int_equal(nt_reread_primitive_count(file.reread, 0), 2);

	/* triangle 1 4 5 */
	static const uint16_t triangle[] = {0, 1, 2};
	static const float triangle_positions[] = {1, 0, 0, 2, 1, 0, 1, 1, 0};
	static const float triangle_tangents[] = {1, 0, 0, 1, 1, 0, 0, 1, -1, 0, 0, -1};
	assert_indices(&file, 0, triangle, 3);
	assert_floats(&file, 0, "POSITION", triangle_positions, 3, 3);
	assert_floats(&file, 0, "TANGENT", triangle_tangents, 3, 4);
	assert_floats(&file, 0, "NORMAL", out_normals, 3, 3);
	assert_floats(&file, 0, "_BITANGENT", out_bitangents + 9, 3, 3);

	/* quad 0 1 3, 1 2 3: vertices 0 1 3 2 */
	static const uint16_t quad[] = {0, 1, 2, 1, 3, 2};
	static const float quad_positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
	static const float quad_texcoords[] = {0, 1, 1, 1 - 0.1f, 0, 1 - 0.7f, 1, 0};
	assert_indices(&file, 1, quad, 6);
	assert_floats(&file, 1, "POSITION", quad_positions, 4, 3);
	assert_floats(&file, 1, "TEXCOORD_0", quad_texcoords, 4, 2);
	close_back(&file);
	nt_scene_free(scene);
}

static void mesh_without_tangents_is_written_without(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	hand.mesh.split = (nt_split){0};
	hand.mesh.face_diagonals = NULL; /* unsolved quads: either diagonal will do */
	compose_well(scene, (nt_write_options){.bitangents = true}, "bare.glb");
	opened file = open_back("bare.glb");
	assert_null(array_of(&file, 0, 0, "TANGENT").data);
	assert_null(array_of(&file, 0, 0, "_BITANGENT").data);
	static const uint16_t indices[] = {0, 1, 2, 0, 2, 3, 1, 4, 2};
	assert_indices(&file, 0, indices, 9);
	close_back(&file);

	/* no NORMAL, no TANGENT */
	make_scene(&hand);
	hand.mesh.normals = NULL;
	compose_well(scene, (nt_write_options){0}, "bare.glb");
	file = open_back("bare.glb");
	assert_null(array_of(&file, 0, 0, "TANGENT").data);
	close_back(&file);

	/* solved quads must say where they were cut */
	make_scene(&hand);
	hand.mesh.face_diagonals = NULL;
	nt_error error;
	assert_int_equal(compose(scene, (nt_write_options){0}, "bare.glb", &error), NMTAN_ERROR_INTERNAL);
	nt_scene_free(scene);
}

static void triangles_without_indices_stay_without(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	hand.mesh = (nt_mesh){.name = "", .vertex_count = 5, .positions = positions,
		.colors = tangents, .face_count = 1, .corner_count = 3};
	compose_well(scene, (nt_write_options){0}, "soup.gltf");
	opened file = open_back("soup.gltf");
	assert_null(array_of(&file, 0, 0, NULL).data);
	assert_floats(&file, 0, "POSITION", positions, 3, 3); /* the other two are not used */
	assert_floats(&file, 0, "COLOR_0", tangents, 3, 4);
	assert_null(array_of(&file, 0, 0, "TEXCOORD_0").data);
	close_back(&file);
	nt_scene_free(scene);
}

static void index_65535_is_reserved(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	enum { MOST = 65536 };
	float *many = calloc(MOST, 3 * sizeof *many);
	many[3 * (MOST - 1)] = 7;
	uint32_t triangle[] = {0, 1, MOST - 2};
	hand.mesh = (nt_mesh){.name = "", .positions = many, .face_count = 1, .corner_count = 3,
		.indices = triangle};
	for (size_t count = MOST - 1; count <= MOST; count++) {
		triangle[2] = (uint32_t)count - 1;
		hand.mesh.vertex_count = count;
		compose_well(scene, (nt_write_options){0}, "many.glb");
		opened file = open_back("many.glb");
		const nt_reread_array indices = array_of(&file, 0, 0, NULL);
		const int type = count < MOST ? NT_GLTF_UNSIGNED_SHORT : NT_GLTF_UNSIGNED_INT;
		assert_int_equal(indices.component_type, type);
		assert_int_equal(array_of(&file, 0, 0, "POSITION").count, count);
		close_back(&file);
	}
	free(many);
	nt_scene_free(scene);
}

static void bounds_are_finite_whatever_the_positions_are(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	float wild[] = {NAN, -INFINITY, NAN, NAN, 2, INFINITY, NAN, 3, INFINITY};
	hand.mesh = (nt_mesh){.name = "", .vertex_count = 3, .positions = wild, .face_count = 1,
		.corner_count = 3};
	compose_well(scene, (nt_write_options){0}, "wild.gltf");
	char *text = text_of("wild.gltf");
	assert_null(strstr(text, "null"));
	assert_non_null(strstr(text, "\"max\":[0.0,3.0,3.4028234663852886e+38]"));
	assert_non_null(strstr(text, "\"min\":[0.0,-3.4028234663852886e+38,3.4028234663852886e+38]"));
	free(text);
	nt_scene_free(scene);
}

static void empty_scene_is_a_valid_document(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	hand.mesh.face_count = hand.mesh.corner_count = 0;
	compose_well(scene, (nt_write_options){0}, "empty.gltf");
	char *text = text_of("empty.gltf");
	assert_string_equal(text,
		"{\"asset\":{\"generator\":\"nmtan " NMTAN_VERSION_STRING "\",\"version\":\"2.0\"}}");
	free(text);
	assert_false(exists("empty.bin"));
	compose_well(scene, (nt_write_options){0}, "empty.glb");
	opened file = open_back("empty.glb");
	assert_int_equal(nt_reread_mesh_count(file.reread), 0);
	close_back(&file);
	nt_scene_free(scene);
}

static void gltf_with_a_bin_cannot_go_to_standard_output(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_scene(&hand);
	const nt_write_options options = {.format = NT_FORMAT_GLTF, .path = "-"};
	nt_error error;
	assert_int_equal(nt_gltf_compose(scene, &options, NULL, &error), NMTAN_ERROR_USAGE);
	nt_scene_free(scene);
}

/* ---- images ---- */

static const unsigned char png[] = "\x89PNG\r\n\x1a\n and then some";
static const unsigned char jpeg[] = "\xff\xd8\xff\xe0 and then some more";

/* mtl/m.mtl with images beside it, one of them under a name that needs encoding. */
static nt_scene *make_textured(hand_scene *hand)
{
	nt_scene *scene = make_scene(hand);
	mkdir(path_of("mtl"), 0777);
	mkdir(path_of("mtl/tex"), 0777);
	write_file("mtl/m.mtl", "", 0);
	write_file("mtl/tex/a b.png", png, sizeof png);
	write_file("mtl/n.jpg", jpeg, sizeof jpeg);
	write_file("mtl/t.tga", "\0\0\2", 3);
	write_file("outside.png", png, sizeof png);
	static char library[200];
	snprintf(library, sizeof library, "%s", path_of("mtl/m.mtl"));
	hand->material.library = library;
	hand->material.line = 3;
	hand->material.base_color_map = "tex\\a b.png";
	hand->material.emissive_map = "./tex/../tex/a b.png";
	hand->material.normal_map = "n.jpg";
	hand->primitives[0].material = 0;
	return scene;
}

static const nt_finding *finding_of(const nt_scene *scene, nt_code code)
{
	for (size_t i = 0; i < scene->findings.count; i++)
		if (scene->findings.items[i].code == code)
			return &scene->findings.items[i];
	return NULL;
}

static void linked_images_are_relative_to_the_output(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	mkdir(path_of("out"), 0777);
	compose_well(scene, (nt_write_options){0}, "out/linked.gltf");
	char *text = text_of("out/linked.gltf");
	assert_non_null(strstr(text, "\"uri\":\"../mtl/tex/a%20b.png\""));
	assert_non_null(strstr(text, "\"uri\":\"../mtl/n.jpg\""));
	/* one image, used twice */
	assert_non_null(strstr(text, "\"baseColorTexture\":{\"index\":0}"));
	assert_non_null(strstr(text, "\"emissiveTexture\":{\"index\":0}"));
	assert_non_null(strstr(text, "\"normalTexture\":{\"index\":1}"));
	assert_non_null(strstr(text, "\"textures\":[{\"source\":0},{\"source\":1}]"));
	assert_int_equal(scene->findings.count, 0);
	free(text);
	nt_scene_free(scene);
}

static void embedded_images_lie_behind_the_geometry(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	compose_well(scene, (nt_write_options){0}, "images.glb");
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, path_of("images.glb"), &error), NMTAN_OK);
	assert_non_null(memmem(file.data, file.size, "\"mimeType\":\"image/png\"", 22));
	/* the last one ends the chunk, which is padded to 4 */
	const size_t padding = (4 - sizeof jpeg % 4) % 4;
	assert_memory_equal(file.data + file.size - padding - sizeof jpeg, jpeg, sizeof jpeg);
	assert_non_null(memmem(file.data, file.size, png, sizeof png));
	nt_file_close(&file);
	opened back = open_back("images.glb");
	assert_whole(&back);
	close_back(&back);
	nt_scene_free(scene);
}

static void copied_images_stand_beside_the_output(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	mkdir(path_of("copies"), 0777);
	compose_well(scene, (nt_write_options){.images = NT_IMAGES_COPY}, "copies/c.gltf");
	char *text = text_of("copies/c.gltf"), *copy = text_of("copies/n.jpg");
	assert_non_null(strstr(text, "\"uri\":\"n.jpg\""));
	assert_non_null(strstr(text, "\"uri\":\"a%20b.png\""));
	assert_memory_equal(copy, jpeg, sizeof jpeg);
	assert_true(exists("copies/a b.png"));
	free(text);
	free(copy);

	/* two of one name, and one that is there already */
	write_file("mtl/a b.png", png, sizeof png);
	hand.material.normal_map = "a b.png";
	compose_well(scene, (nt_write_options){.images = NT_IMAGES_COPY}, "mtl/c.gltf");
	text = text_of("mtl/c.gltf");
	assert_non_null(strstr(text, "\"uri\":\"a%20b.png\""));
	assert_non_null(strstr(text, "\"uri\":\"a%20b-1.png\""));
	assert_true(exists("mtl/a b-1.png"));
	free(text);
	nt_scene_free(scene);
}

static void no_images_means_no_textures(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	compose_well(scene, (nt_write_options){.images = NT_IMAGES_NONE}, "none.gltf");
	char *text = text_of("none.gltf");
	assert_null(strstr(text, "exture"));
	assert_non_null(strstr(text, "\"material\":0"));
	free(text);
	nt_scene_free(scene);
}

static void missing_and_foreign_images_are_findings(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	hand.material.base_color_map = "gone.png";
	hand.material.emissive_map = "t.tga";
	hand.material.normal_map = NULL;
	compose_well(scene, (nt_write_options){0}, "gone.gltf");
	const nt_finding *missing = finding_of(scene, NT_CODE_IMAGE_MISSING);
	assert_non_null(missing);
	assert_string_equal(missing->detail, "gone.png");
	assert_string_equal(missing->place.file, hand.material.library);
	assert_int_equal(missing->place.line, 3);
	const nt_finding *type = finding_of(scene, NT_CODE_IMAGE_TYPE);
	assert_non_null(type);
	assert_string_equal(type->detail, "t.tga");
	char *text = text_of("gone.gltf");
	assert_non_null(strstr(text, "\"uri\":\"mtl/gone.png\"")); /* the link stays */
	assert_null(strstr(text, "tga"));
	assert_null(strstr(text, "emissiveTexture"));
	free(text);
	compose_well(scene, (nt_write_options){0}, "gone.glb"); /* there is nothing to embed */
	opened file = open_back("gone.glb");
	close_back(&file);
	nt_scene_free(scene);
}

static void images_outside_of_the_mtl_folder_need_leave(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	assert_int_equal(symlink("../outside.png", path_of("mtl/link.png")), 0);
	hand.material.base_color_map = "../outside.png";
	hand.material.emissive_map = "link.png";
	hand.material.normal_map = "C:\\work\\n.jpg"; /* found by its last part */
	compose_well(scene, (nt_write_options){0}, "confined.gltf");
	char *text = text_of("confined.gltf");
	assert_null(strstr(text, "outside"));
	assert_null(strstr(text, "link.png"));
	assert_non_null(strstr(text, "\"uri\":\"mtl/n.jpg\""));
	assert_non_null(strstr(finding_of(scene, NT_CODE_IMAGE_MISSING)->detail, "../outside.png"));
	free(text);
	compose_well(scene, (nt_write_options){.allow_outside = true}, "confined.gltf");
	text = text_of("confined.gltf");
	assert_non_null(strstr(text, "\"uri\":\"outside.png\""));
	assert_non_null(strstr(text, "\"uri\":\"mtl/link.png\""));
	assert_non_null(strstr(text, "\"uri\":\"mtl/n.jpg\""));
	free(text);
	nt_scene_free(scene);
}

static void primitive_without_texcoords_gets_no_textures(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	hand.mesh.texcoords = NULL;
	compose_well(scene, (nt_write_options){0}, "plain.gltf");
	char *text = text_of("plain.gltf");
	assert_null(strstr(text, "exture"));
	assert_null(strstr(text, "images"));
	free(text);
	nt_scene_free(scene);
}

static void images_are_safe_from_the_output(void **state)
{
	(void)state;
	hand_scene hand;
	nt_scene *scene = make_textured(&hand);
	write_file("mtl/n.bin", png, sizeof png);
	hand.material.normal_map = "n.bin"; /* a PNG by content, and where the buffer would go */
	nt_error error;
	assert_int_equal(compose(scene, (nt_write_options){0}, "mtl/n.gltf", &error), NMTAN_ERROR_IO);
	assert_false(exists("mtl/n.gltf"));
	char *kept = text_of("mtl/n.bin");
	assert_memory_equal(kept, png, sizeof png);
	free(kept);
	nt_scene_free(scene);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(one_primitive_is_the_same_in_every_container),
		cmocka_unit_test(several_primitives_get_their_own_vertices_in_order_of_use),
		cmocka_unit_test(mesh_without_tangents_is_written_without),
		cmocka_unit_test(triangles_without_indices_stay_without),
		cmocka_unit_test(index_65535_is_reserved),
		cmocka_unit_test(bounds_are_finite_whatever_the_positions_are),
		cmocka_unit_test(empty_scene_is_a_valid_document),
		cmocka_unit_test(gltf_with_a_bin_cannot_go_to_standard_output),
		cmocka_unit_test(linked_images_are_relative_to_the_output),
		cmocka_unit_test(embedded_images_lie_behind_the_geometry),
		cmocka_unit_test(copied_images_stand_beside_the_output),
		cmocka_unit_test(no_images_means_no_textures),
		cmocka_unit_test(missing_and_foreign_images_are_findings),
		cmocka_unit_test(images_outside_of_the_mtl_folder_need_leave),
		cmocka_unit_test(primitive_without_texcoords_gets_no_textures),
		cmocka_unit_test(images_are_safe_from_the_output),
	};
	return cmocka_run_group_tests_name("io/gltf_compose", tests, make_folder, remove_folder);
}
