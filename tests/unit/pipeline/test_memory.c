/* SPDX-License-Identifier: MIT */
/*
 * Peak memory of a conversion: at most five thirds of the output, the input's map and a byte a triangle, beside what
 * the program holds for a file of one triangle. A grid of 352 800 triangles, as GLB and as OBJ; each run is a
 * process of its own, whose peak the system tells.
 */
#include "hand_gltf_file.h"
#include <malloc.h>
#include <math.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIDE = 420 }; /* quads along an edge */

static size_t size_of(const char *path)
{
	struct stat status;
	assert_int_equal(stat(path, &status), 0);
	return (size_t)status.st_size;
}

static float height(int x, int y, int side)
{
	return 0.1f * sinf(9.0f * (float)x / (float)side) * cosf(7.0f * (float)y / (float)side);
}

/* A wavy grid. */
static void make_glb(const char *name, int side)
{
	const size_t count = (size_t)(side + 1) * (size_t)(side + 1);
	float(*positions)[3] = calloc(count, sizeof *positions), (*normals)[3] = calloc(count, sizeof *normals);
	float(*texcoords)[2] = calloc(count, sizeof *texcoords);
	uint32_t *indices = malloc(6 * count * sizeof *indices), *at = indices;
	hand_file f = {0};
	for (uint32_t i = 0, row = (uint32_t)side + 1; i < count; i++) {
		const int x = (int)(i % row), y = (int)(i / row);
		texcoords[i][0] = positions[i][0] = (float)x / (float)side;
		texcoords[i][1] = positions[i][1] = (float)y / (float)side;
		positions[i][2] = height(x, y, side);
		normals[i][2] = 1;
		if (x < side && y < side)
			at = mempcpy(at, (uint32_t[]){i, i + 1, i + row + 1, i, i + row + 1, i + row}, 24);
	}
	put_accessor(&f, positions, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, normals, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, texcoords, count, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, indices, (size_t)(at - indices), NT_GLTF_UINT, "SCALAR");
	free(positions);
	free(normals);
	free(texcoords);
	free(indices);
	put_glb(name, &f, NORMAL_MAP "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"
		"\"TEXCOORD_0\":2},\"indices\":3,\"material\":0}]}],");
	malloc_trim(0); /* what stays here is a child's too */
}

static void make_obj(const char *path, int side)
{
	FILE *stream = fopen(path, "wb");
	assert_non_null(stream);
	for (int y = 0; y <= side; y++)
		for (int x = 0; x <= side; x++) {
			const double u = (double)x / side, v = (double)y / side;
			fprintf(stream, "v %.7f %.7f %.7f\nvn 0 0 1\nvt %.7f %.7f\n", u, v, height(x, y, side), u, v);
		}
	for (int y = 0; y < side; y++)
		for (int x = 0; x < side; x++) {
			const int a = y * (side + 1) + x + 1, b = a + side + 1, c = b + 1, d = a + 1;
			fprintf(stream, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, d, d, d, c, c, c);
			fprintf(stream, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, c, c, c, b, b, b);
		}
	assert_int_equal(fclose(stream), 0);
}

/* Converts in a process of its own and returns that one's peak. */
static size_t peak_of(const char *input, const char *output)
{
	fflush(stdout);
	const pid_t child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0); /* by how much large pages round up is the machine's affair */
		const nt_settings settings = {.io.texcoord_set = -1, .io.threads = 2,
			.io.buffers = strstr(output, ".gltf") ? NT_BUFFERS_EMBED : NT_BUFFERS_DEFAULT};
		nt_summary summary;
		nt_error error;
		const nt_status status = nt_run(input, output, &settings, &summary, &error);
		_exit(status || summary.solved_count != 1);
	}
	int status;
	struct rusage usage;
	assert_int_equal(wait4(child, &status, 0, &usage), child);
	assert_int_equal(status, 0);
	return (size_t)usage.ru_maxrss * 1024;
}

/* Sanitizers need memory of their own: under them the conversions run, and their peak says nothing. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static void assert_peak(const char *small, const char *large, const char *output)
{
	const size_t base = peak_of(small, output);
	size_t peak = peak_of(large, output);
	const size_t in = size_of(large), out = size_of(output), most = base + in + out + 2 * out / 3 + 2 * SIDE * SIDE;
	/* Linux counts pages for each processor and adds them up in batches: on many, one run may seem to take more */
	for (int try = 0; try < 4 && peak > most; try++)
		peak = peak_of(large, output);
	print_message("%zu bytes to %zu: peak %zu, %zu of them for a triangle or two\n", in, out, peak, base);
	assert_true(SANITIZED || peak <= most);
}

/* The base64 of a buffer is not held. */
TEST(a_glb_and_a_gltf_with_its_buffer_inside_take_little_more_than_their_output)
{
	make_glb("small.glb", 1);
	make_glb("large.glb", SIDE);
	assert_peak(in_folder("small.glb"), in_folder("large.glb"), in_folder("out.glb"));
	assert_peak(in_folder("small.glb"), in_folder("large.glb"), in_folder("out.gltf"));
}

TEST(an_obj_takes_little_more_than_its_output)
{
	make_obj(in_folder("small.obj"), 1);
	make_obj(in_folder("large.obj"), SIDE);
	assert_peak(in_folder("small.obj"), in_folder("large.obj"), in_folder("out.glb"));
}

AROUND_EACH(make_folder, remove_folder)
