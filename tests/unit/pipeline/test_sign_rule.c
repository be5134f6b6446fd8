/* SPDX-License-Identifier: MIT */
/*
 * The sign rule on whole files: in what nmtan writes as glTF, B = cross(N, T) w
 * runs along -dP/dv of the written texture coordinates on every triangle whose normals agree with its
 * winding. The authored tangents of SheenCloth and of the pbr sphere obey the same rule, which
 * shows that it is the right one.
 */
#include "folder.h"
#include "test.h"
#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>
#include "file/input.h"
#include "gltf/load.h"
#include "pipeline/run.h"

typedef struct rule_count {
	size_t triangles, judged, wrong, mixed;
	size_t bad_w; /* corners whose w is not minus the sign of the exact determinant */
} rule_count;

static void cross(const float a[3], const float b[3], double out[3])
{
	for (int i = 0; i < 3; i++)
		out[i] = (double)a[(i + 1) % 3] * b[(i + 2) % 3] - (double)a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const double a[3], const float b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* One triangle: dP/dv = (-cu d1 + bu d2) / det. */
static void judge_triangle(const nt_mesh *mesh, const uint32_t v[3], rule_count *count)
{
	float p[3][3], n[3][3], uv[3][2], t[3][4];
	for (int k = 0; k < 3; k++) {
		memcpy(p[k], mesh->positions + 3 * v[k], sizeof p[k]);
		memcpy(n[k], mesh->normals + 3 * v[k], sizeof n[k]);
		memcpy(t[k], mesh->tangents + 4 * v[k], sizeof t[k]);
		uv[k][0] = mesh->texcoords[2 * v[k]];
		uv[k][1] = -mesh->texcoords[2 * v[k] + 1]; /* as it is stored */
	}
	count->triangles++;
	count->mixed += t[0][3] != t[1][3] || t[0][3] != t[2][3];
	const int sign = nmtan_orientation(uv[0], uv[1], uv[2]);
	for (int k = 0; k < 3; k++)
		count->bad_w += sign != 0 && t[k][3] != (float)-sign;
	const double bu = (double)uv[1][0] - uv[0][0], cu = (double)uv[2][0] - uv[0][0];
	float d1[3], d2[3], dv[3];
	for (int i = 0; i < 3; i++) {
		d1[i] = p[1][i] - p[0][i];
		d2[i] = p[2][i] - p[0][i];
		dv[i] = (float)(sign * (bu * d2[i] - cu * d1[i]));
	}
	double face[3];
	cross(d1, d2, face);
	for (int k = 0; k < 3; k++) {
		if (sign == 0 || !(dot(face, n[k]) > 0))
			continue;
		double b[3];
		cross(n[k], t[k], b);
		const double along = -t[k][3] * dot(b, dv);
		const double length = sqrt((double)dv[0] * dv[0] + (double)dv[1] * dv[1] + (double)dv[2] * dv[2]);
		/* a vertex normal far from the face's, or an average over a sharp bend, can turn a frame
		 * by nearly 90 degrees: only clear cases are judged */
		if (fabs(along) < 0.1 * length)
			continue;
		count->judged++;
		count->wrong += along < 0;
	}
}

/* Judges every triangle of a glTF file that has tangents; false: it is not read. */
static bool judge_file(const char *path, rule_count *count)
{
	static const nt_read_options options = {.texcoord_set = 0, .transform = NT_TRANSFORM_KEEP,
		.morphs = NT_MORPH_KEEP};
	nt_error error;
	nt_file file;
	nt_scene scene;
	if (nt_file_open(&file, path, NT_NAMED_BY_USER, &error))
		return false;
	nt_scene_init(&scene, path);
	scene.bytes = file.data;
	scene.byte_count = file.size;
	const bool read = nt_gltf_open(&scene, &options, &error) == NT_OK;
	for (size_t m = 0; read && m < scene.mesh_count; m++) {
		nt_mesh *mesh = &scene.meshes[m];
		if (!mesh->triangles || nt_gltf_load(&scene, mesh, &options, &error) || !mesh->normals ||
			!mesh->texcoords || !mesh->tangents)
			continue;
		for (uint32_t c = 0; c + 3 <= mesh->corner_count; c += 3) {
			const uint32_t corners[3] = {c, c + 1, c + 2};
			judge_triangle(mesh, mesh->indices ? mesh->indices + c : corners, count);
		}
	}
	nt_scene_free(&scene);
	nt_file_close(&file);
	return read;
}

/* Converts a file to a new GLB and judges that. */
static void judge_conversion(const char *input, rule_count *count)
{
	const nt_settings settings = {.io.texcoord_set = -1, .existing = NT_EXISTING_REPLACE,
		.io.images = NT_IMAGES_LINK, .verify = true};
	const char *output = in_folder("out.glb");
	nt_summary summary;
	nt_error error;
	if (nt_run(input, output, &settings, &summary, &error))
		fail_msg("%s: %s", input, error.message);
	nt_summary_free(&summary);
	rule_count own = {0};
	assert_true(judge_file(output, &own));
	if (own.bad_w || own.mixed || own.wrong)
		print_error("%s: %zu wrong of %zu, %zu corners with the wrong w, %zu triangles mixed\n", input,
			own.wrong, own.judged, own.bad_w, own.mixed);
	count->triangles += own.triangles;
	count->judged += own.judged;
	count->wrong += own.wrong;
	count->mixed += own.mixed;
	count->bad_w += own.bad_w;
}

/* No w may be wrong, and no triangle may have two. */
static rule_count judge_all(const char *const *patterns)
{
	rule_count count = {0};
	for (; *patterns; patterns++) {
		glob_t found;
		if (glob(*patterns, 0, NULL, &found) == 0)
			for (size_t i = 0; i < found.gl_pathc; i++)
				judge_conversion(found.gl_pathv[i], &count);
		globfree(&found);
	}
	assert_int_equal(count.bad_w, 0);
	assert_int_equal(count.mixed, 0);
	return count;
}

TEST(bitangents_run_along_minus_v_in_our_own_data)
{
	/* not transformed.gltf: its mirrored square has the sign of what the transform makes of the coordinates,
	 * see test_small_models.sh */
	static const char *const patterns[] = {"data/*.obj", "data/*.ply", "data/[!t]*.gltf", "data/*.glb", NULL};
	const rule_count count = judge_all(patterns);
	assert_true(count.judged > 0);
	assert_int_equal(count.wrong, 0);
}

static void need_shared(void)
{
	if (access("../shared/models", F_OK) == 0)
		return;
	print_message("SKIP: ../shared is not here\n");
	skip();
}

TEST(authored_tangents_obey_the_same_rule)
{
	need_shared();
	static const char *const authored[] = {
		"../shared/models/gltf/SheenCloth/glTF_Binary/SheenCloth.glb",
		"../shared/models/gltf/SheenCloth/glTF/SheenCloth.gltf"};
	for (size_t i = 0; i < sizeof authored / sizeof *authored; i++) {
		rule_count count = {0};
		assert_true(judge_file(authored[i], &count));
		assert_true(count.judged > 1000);
		assert_int_equal(count.wrong, 0);
	}
	static const char *const patterns[] = {"../shared/models/gltf/draco_sphere/*.gltf",
		"../shared/models/gltf/pbr_sphere/*/*.gltf", NULL};
	const rule_count count = judge_all(patterns);
	assert_true(count.judged > 1000);
	assert_int_equal(count.wrong, 0);
}

/* SheenCloth's normal texture is sampled through KHR_texture_transform with the scale (30, -30), which its
 * authored tangents ignore. Ours honour it: against the coordinates as they stand, every bitangent is
 * reversed and every w negated. */
TEST(mirroring_texture_transforms_reverse_the_sign)
{
	need_shared();
	rule_count count = {0};
	judge_conversion("../shared/models/gltf/SheenCloth/glTF_Binary/SheenCloth.glb", &count);
	assert_true(count.judged > 10000);
	assert_int_equal(count.wrong, count.judged);
	assert_int_equal(count.mixed, 0);
}

/* If texture directions spin around a vertex, its average can lie more than 90 degrees from one of
 * its triangles; w is right all the same. */
TEST(w_is_exact_on_damaged_geometry)
{
	need_shared();
	static const char *const patterns[] = {"../shared/models/obj/*geract.obj", "../shared/models/obj/spot.obj",
		"../shared/models/obj/doomcone*.obj", "../shared/models/obj/obliterated.obj",
		"../shared/models/obj/rancid_geometry.obj", "../shared/models/ply/cube*.ply", NULL};
	const rule_count count = judge_all(patterns);
	assert_true(count.judged > 10000);
	assert_true(count.wrong * 100 < count.judged);
}

AROUND_ALL(make_folder, remove_folder)
