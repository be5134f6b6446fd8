/* SPDX-License-Identifier: MIT */
/*
 * Which primitives become a join, from the JSON alone.
 */
#include "hand_gltf_file.h"
#include <time.h>
#include "gltf/vertex_pools.h"

/* How the joins of a test are found. */
static bool shared, compared;

static void open_text(nt_scene *scene, const nt_buffer *json)
{
	nt_error error;
	const nt_read_options options = {.texcoord_set = -1, .across = true};
	if (open_bytes(scene, json->data, json->size, &options, &error))
		fail_msg("%s: %s", error.place.pointer, error.message);
	nt_select(scene, NT_ONLY_AUTO, NT_EXISTING_KEEP, NT_MAKING_NONE);
	if (shared && (nt_vertex_pools_find(scene, &options, &error) || nt_gltf_find_same(scene, &options, &error)))
		fail_msg("%s", error.message);
	assert_int_equal(nt_gltf_find_joins(scene, !compared, false, &error), NT_OK);
}

/* Primitives by letter: n normal map, N normal map and tangents, 1 normal map with set 1, t turned, . nothing,
 * x nothing and no normals, l nothing and lines, b nothing and 70 000 triangles. Each has both sets. A blank begins
 * another mesh. */
static void open_primitives(nt_scene *scene, nt_buffer *json, const char *letters)
{
	static const char normal[] = "{\"normalTexture\":{\"index\":0%s}},";
	*json = (nt_buffer){0};
	nt_buffer_text(json, "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"componentType\":5126,\"count\":3,"
		"\"type\":\"VEC3\"},{\"componentType\":5126,\"count\":210000,\"type\":\"VEC3\"}],\"textures\":[{}],"
		"\"materials\":[{},");
	nt_buffer_format(json, normal, "");
	nt_buffer_format(json, normal, ",\"texCoord\":1");
	nt_buffer_text(json, "{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":"
		"{\"rotation\":1}}}}],\"meshes\":[{\"primitives\":[");
	for (const char *l = letters; *l; l++) {
		if (*l == ' ') {
			nt_buffer_text(json, "]},{\"primitives\":[");
			continue;
		}
		const int material = *l == 'n' || *l == 'N' ? 1 : *l == '1' ? 2 : *l == 't' ? 3 : 0;
		nt_buffer_format(json, "%s{\"attributes\":{\"POSITION\":%d,%s\"TEXCOORD_0\":0,\"TEXCOORD_1\":0%s},"
			"\"material\":%d,\"mode\":%d}", l > letters && l[-1] != ' ' ? "," : "",
			*l == 'b', *l == 'x' ? "" : "\"NORMAL\":0,", *l == 'N' ? ",\"TANGENT\":0" : "", material,
			*l == 'l' ? 1 : 4);
	}
	nt_buffer_text(json, "]}]}");
	open_text(scene, json);
}

/* The joins as their parts' numbers: "0 2, 1 2". */
static void joins_are(const char *letters, const char *expected)
{
	nt_scene scene;
	nt_buffer json, found = {0};
	open_primitives(&scene, &json, letters);
	nt_buffer_text(&found, "");
	for (size_t i = 0; i < scene.join_count; i++)
		for (size_t k = 0; k < scene.joins[i].part_count; k++) {
			const nt_mesh *part = scene.joins[i].parts[k];
			size_t number = 0;
			while (scene.meshes[number].gltf_mesh != part->gltf_mesh ||
				scene.meshes[number].gltf_primitive != part->gltf_primitive)
				number++;
			/* those that get tangents stand for themselves */
			assert_int_equal(part == &scene.meshes[number], part->decision == NT_DECISION_SOLVE);
			assert_int_equal(part->texcoord_set, scene.joins[i].first->texcoord_set);
			nt_buffer_format(&found, "%s%zu", k ? " " : i ? ", " : "", number);
		}
	assert_string_equal(found.data ? found.data : "", expected);
	nt_buffer_free(&found);
	nt_buffer_free(&json);
	nt_scene_free(&scene);
}

TEST(joins_are_those_of_the_table)
{
	static const char *const rows[][2] = {
		/* kinds are sets and transforms */
		{"nn", "0 1"}, {"n1", ""}, {"nt", ""}, {"nttn", "0 3, 1 2"}, {"n n", ""}, {"nn nn", "0 1, 2 3"},
		/* those without a kind are in all of them */
		{"n.", "0 1"}, {".nN", "0 1 2"}, {"n.1", "0 1, 1 2"}, {".tn", "0 1, 0 2"},
		/* without normals or triangles they have nothing to give, and without one that gets tangents nobody
		 * takes */
		{"nx", ""}, {"nl", ""}, {"N.", ""}, {"..", ""}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		joins_are(rows[i][0], rows[i][1]);
}

/* Whose result each mesh has, "-" its own, behind the joins. */
static void results_are(const char *letters, const char *joins, const char *expected)
{
	nt_scene scene;
	nt_buffer json, found = {0};
	shared = true;
	joins_are(letters, joins);
	open_primitives(&scene, &json, letters);
	for (size_t i = 0; i < scene.mesh_count; i++) {
		const nt_mesh *mesh = &scene.meshes[i];
		if (mesh->decision != NT_DECISION_SOLVE)
			continue;
		assert_true(!mesh->plan.same_as || !mesh->plan.same_as->plan.same_as);
		if (mesh->plan.same_as)
			nt_buffer_format(&found, "%zu", (size_t)(mesh->plan.same_as - scene.meshes));
		else
			nt_buffer_text(&found, "-");
	}
	assert_string_equal(found.data, expected);
	shared = false;
	nt_buffer_free(&found);
	nt_buffer_free(&json);
	nt_scene_free(&scene);
}

/* All primitives of a letter have the same geometry. */
TEST(the_same_geometry_contributes_once)
{
	results_are("nnn", "", "-00");
	results_are("nn.", "0 2", "-0");
	results_are("n..", "0 1", "-");
	results_are("nnt.tn", "0 3, 2 3", "-0-20");
	/* the same parts in another mesh */
	results_are("n. n.", "0 1", "-0");
	results_are("n.. n.", "0 1", "-0");
	/* with set 1 the primitive without need has another geometry than the one that is compared */
	results_are("n.1 n.1", "0 1, 1 2, 4 5", "--0-");
	/* other parts: a result of their own, which those behind may have */
	results_are("n. n n. n", "0 1", "--02");
	results_are("n t n. nt", "2 3", "---01");
}

/* A comparison alone may not cost many times the solve, which is of one triangle here. */
TEST(a_comparison_is_not_dear)
{
	joins_are("nb", "0 1");
	compared = true;
	joins_are("nb", "");
	joins_are("n.", "0 1");
	compared = false;
}

/* A mesh whose primitives all have transforms of their own, with as many that take part in every join: their square is
 * 10^8. */
TEST(many_kinds_cost_linear_time)
{
	enum { KINDS = 10000 };
	nt_buffer json = {0};
	nt_scene scene;
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"componentType\":5126,\"count\":3,"
		"\"type\":\"VEC3\"}],\"textures\":[{}],\"materials\":[{}");
	for (int i = 0; i < KINDS; i++)
		nt_buffer_format(&json, ",{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":"
			"{\"rotation\":%d}}}}", i + 1);
	nt_buffer_text(&json, "],\"meshes\":[{\"primitives\":[");
	for (int i = 0; i < 2 * KINDS; i++)
		nt_buffer_format(&json,
			"%s{\"attributes\":{\"POSITION\":0,\"NORMAL\":0,\"TEXCOORD_0\":0},\"material\":%d}",
			i ? "," : "", i < KINDS ? i + 1 : 0);
	nt_buffer_text(&json, "]}]}");
	const clock_t begin = clock();
	open_text(&scene, &json);
	assert_true(clock() - begin < 10 * CLOCKS_PER_SEC);
	assert_int_equal(scene.join_count, 8);
	nt_scene_free(&scene);
	nt_buffer_free(&json);
}
