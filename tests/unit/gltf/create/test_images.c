/* SPDX-License-Identifier: MIT */
/*
 * Images of new glTF documents: linked, embedded, copied or left out. Tests of decoding are in tests/unit/image.
 */
#include "hand_gltf.h"

#include <sys/stat.h>
#include "pipeline/stages.h"

static const unsigned char png[] = "\x89PNG\r\n\x1a\n and then some";
static const unsigned char jpeg[] = "\xff\xd8\xff\xe0 and then some more";

static hand_scene hand;

/* mtl/m.mtl with images beside it, one of them under a name that needs encoding. */
static int set_up(void **state)
{
	*state = make_scene(&hand);
	mkdir(in_folder("mtl"), 0777);
	mkdir(in_folder("mtl/tex"), 0777);
	put_file("mtl/m.mtl", "", 0);
	put_file("mtl/tex/a b.png", png, sizeof png);
	put_file("mtl/n.jpg", jpeg, sizeof jpeg);
	put_file("mtl/t.tga", "\0\0\2", 3);
	put_file("outside.png", png, sizeof png);
	static char library[200];
	snprintf(library, sizeof library, "%s", in_folder("mtl/m.mtl"));
	hand.material.library = library;
	hand.material.line = 3;
	hand.material.base_color_map.name = "tex\\a b.png";
	hand.material.emissive_map.name = "./tex/../tex/a b.png";
	hand.material.normal_map.name = "n.jpg";
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++)
		hand.material.maps[i].gain = 1;
	hand.primitives[0].material = 0;
	return 0;
}

static int tear_down(void **state)
{
	nt_scene_free(*state);
	return 0;
}

/* As the pipeline does it. The images here are no images, and none is looked into. */
static nt_status compose_with_images(nt_scene *scene, nt_write_options options, const char *name, nt_error *error)
{
	const nt_settings settings = {.images = options.images,
		.outside = options.allow_outside ? NT_OUTSIDE_YES : NT_OUTSIDE_NO,
		.bump = NT_BUMP_NORMAL};
	const nt_texture_rules rules = {.threads = 1};
	nt_textures *textures;
	nt_summary summary = {0};
	assert_int_equal(nt_stage_textures(scene, &settings, in_folder("o"), &textures, error), NT_OK);
	assert_int_equal(nt_textures_make(textures, &rules, error), NT_OK);
	assert_int_equal(nt_tell_textures(scene, &settings, textures, &summary, error), NT_OK);
	options.textures = textures;
	const nt_status status = compose(scene, options, name, error);
	nt_textures_free(textures);
	return status;
}

static void compose_images_well(nt_scene *scene, nt_write_options options, const char *name)
{
	nt_error error;
	const nt_status status = compose_with_images(scene, options, name, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
}

static const nt_finding *finding_of(const nt_scene *scene, nt_code code)
{
	for (size_t i = 0; i < scene->findings.count; i++)
		if (scene->findings.items[i].code == code)
			return &scene->findings.items[i];
	return NULL;
}

TEST(linked_images_are_relative_to_the_output)
{
	nt_scene *scene = *state;
	mkdir(in_folder("out"), 0777);
	compose_images_well(scene, (nt_write_options){.images = NT_IMAGES_LINK}, "out/linked.gltf");
	/* one image, used twice */
	assert_file_says("out/linked.gltf", PARTS("\"uri\":\"../mtl/tex/a%20b.png\"",
		"\"uri\":\"../mtl/n.jpg\"", "\"baseColorTexture\":{\"index\":0}",
		"\"emissiveTexture\":{\"index\":0}", "\"normalTexture\":{\"index\":1}",
		"\"textures\":[{\"source\":0},{\"source\":1}]"));
	assert_int_equal(scene->findings.count, 2);
	assert_int_equal(scene->findings.items[0].code, NT_CODE_LINK_LEAVES);
	/* by default they are copied from there, and linked from above */
	compose_images_well(scene, (nt_write_options){0}, "out/copied.gltf");
	assert_file_says("out/copied.gltf", PARTS("\"uri\":\"a%20b.png\"", "\"uri\":\"n.jpg\""));
	compose_images_well(scene, (nt_write_options){0}, "above.gltf");
	assert_file_says("above.gltf", PARTS("\"uri\":\"mtl/tex/a%20b.png\"", "\"uri\":\"mtl/n.jpg\""));
	assert_int_equal(scene->findings.count, 2);
}

TEST(embedded_images_lie_behind_the_geometry)
{
	nt_scene *scene = *state;
	compose_images_well(scene, (nt_write_options){0}, "images.glb");
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, in_folder("images.glb"), &error), NT_OK);
	assert_non_null(memmem(file.data, file.size, "\"mimeType\":\"image/png\"", 22));
	/* the last one ends the chunk, which is padded to 4 */
	const size_t padding = (4 - sizeof jpeg % 4) % 4;
	assert_memory_equal(file.data + file.size - padding - sizeof jpeg, jpeg, sizeof jpeg);
	assert_non_null(memmem(file.data, file.size, png, sizeof png));
	nt_file_close(&file);
	opened back = open_back("images.glb");
	assert_whole(&back, hand.tangents);
	close_back(&back);
}

TEST(copied_images_stand_beside_the_output)
{
	nt_scene *scene = *state;
	mkdir(in_folder("copies"), 0777);
	compose_images_well(scene, (nt_write_options){.images = NT_IMAGES_COPY}, "copies/c.gltf");
	char *text = text_of("copies/c.gltf"), *copy = text_of("copies/n.jpg");
	assert_non_null(strstr(text, "\"uri\":\"n.jpg\""));
	assert_non_null(strstr(text, "\"uri\":\"a%20b.png\""));
	assert_memory_equal(copy, jpeg, sizeof jpeg);
	assert_true(exists("copies/a b.png"));
	free(text);
	free(copy);

	/* two of one name, and one that is there already: the other is called by its bytes (xxhsum -H2) */
	put_file("mtl/a b.png", jpeg, sizeof jpeg);
	hand.material.normal_map.name = "a b.png";
	compose_images_well(scene, (nt_write_options){.images = NT_IMAGES_COPY}, "mtl/c.gltf");
	assert_file_says("mtl/c.gltf", PARTS("\"uri\":\"a%20b.png\"",
		"\"uri\":\"a%20b-256d04da728a78c9.png\""));
	assert_true(exists("mtl/a b-256d04da728a78c9.png"));
}

TEST(no_images_means_no_textures)
{
	nt_scene *scene = *state;
	compose_images_well(scene, (nt_write_options){.images = NT_IMAGES_NONE}, "none.gltf");
	assert_file_says("none.gltf", PARTS("!exture", "\"material\":0"));
}

TEST(missing_and_foreign_images_are_findings)
{
	nt_scene *scene = *state;
	hand.material.base_color_map.name = "gone.png";
	hand.material.emissive_map.name = "t.tga"; /* three bytes */
	hand.material.normal_map.name = NULL;
	compose_images_well(scene, (nt_write_options){0}, "gone.gltf");
	/* nobody asked for a link to nothing */
	assert_file_says("gone.gltf", PARTS("!gone.png"));
	compose_images_well(scene, (nt_write_options){.images = NT_IMAGES_LINK}, "gone.gltf");
	const nt_finding *missing = finding_of(scene, NT_CODE_IMAGE_MISSING);
	assert_non_null(missing);
	assert_string_equal(missing->detail, "gone.png");
	assert_string_equal(missing->place.file, hand.material.library);
	assert_int_equal(missing->place.line, 3);
	const nt_finding *type = finding_of(scene, NT_CODE_IMAGE_TYPE);
	assert_non_null(type);
	assert_string_equal(type->detail, "t.tga");
	/* the link stays */
	assert_file_says("gone.gltf", PARTS("\"uri\":\"mtl/gone.png\"", "!tga", "!emissiveTexture"));
	compose_images_well(scene, (nt_write_options){0}, "gone.glb"); /* there is nothing to embed */
	opened file = open_back("gone.glb");
	close_back(&file);
}

TEST(images_outside_of_the_mtl_folder_need_leave)
{
	nt_scene *scene = *state;
	scene->path = hand.material.library; /* beside the OBJ would be inside, too */
	assert_int_equal(symlink("../outside.png", in_folder("mtl/link.png")), 0);
	hand.material.base_color_map.name = "../outside.png";
	hand.material.emissive_map.name = "link.png";
	hand.material.normal_map.name = "C:\\work\\n.jpg"; /* found by its last part */
	compose_images_well(scene, (nt_write_options){0}, "confined.gltf");
	assert_file_says("confined.gltf", PARTS("!outside", "!link.png", "\"uri\":\"mtl/n.jpg\""));
	assert_non_null(strstr(finding_of(scene, NT_CODE_IMAGE_MISSING)->detail, "../outside.png"));
	compose_images_well(scene, (nt_write_options){.allow_outside = true}, "confined.gltf");
	assert_file_says("confined.gltf", PARTS("\"uri\":\"outside.png\"", "\"uri\":\"mtl/link.png\"",
		"\"uri\":\"mtl/n.jpg\""));
}

TEST(primitive_without_texcoords_gets_no_textures)
{
	nt_scene *scene = *state;
	hand.mesh.texcoords = NULL;
	compose_images_well(scene, (nt_write_options){0}, "plain.gltf");
	assert_file_says("plain.gltf", PARTS("!exture", "!images"));
}

TEST(images_are_safe_from_the_output)
{
	nt_scene *scene = *state;
	put_file("mtl/n.bin", png, sizeof png);
	hand.material.normal_map.name = "n.bin"; /* a PNG by content, and where the buffer would go */
	compose_images_well(scene, (nt_write_options){0}, "mtl/n.gltf");
	char *kept = text_of("mtl/n.bin"), *text = text_of("mtl/n.gltf");
	assert_memory_equal(kept, png, sizeof png);
	assert_non_null(strstr(text, "\"uri\":\"n-"));
	free(text);
	free(kept);
	/* nor is the main file's name to be had */
	nt_error error;
	assert_int_equal(compose_with_images(scene, (nt_write_options){0}, "mtl/n.bin", &error), NT_ERROR_IO);
	kept = text_of("mtl/n.bin");
	assert_memory_equal(kept, png, sizeof png);
	free(kept);
}

AROUND_ALL(make_folder, remove_folder)
AROUND_EACH(set_up, tear_down)
