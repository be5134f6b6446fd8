/* SPDX-License-Identifier: MIT */
/*
 * Peak memory of a conversion: at most one and a half times the output and the input's map, beside what
 * the program holds for a file of one triangle. A grid of 352 800 triangles, as GLB and as OBJ; each run is a
 * process of its own, whose peak the system tells.
 */
#include "folder.h"
#include "test.h"
#include <math.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "pipeline/run.h"

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

static void put_word(FILE *stream, uint32_t word)
{
	fwrite(&word, sizeof word, 1, stream);
}

static void put_floats(FILE *stream, const float *values, size_t count)
{
	fwrite(values, sizeof *values, count, stream);
}

/* Positions, normals, texture coordinates, indices of a wavy grid. */
static void put_grid(FILE *stream, int side)
{
	for (int y = 0; y <= side; y++)
		for (int x = 0; x <= side; x++)
			put_floats(stream, (float[3]){(float)x / (float)side, (float)y / (float)side,
				height(x, y, side)}, 3);
	for (int i = 0; i < (side + 1) * (side + 1); i++)
		put_floats(stream, (float[3]){0, 0, 1}, 3);
	for (int y = 0; y <= side; y++)
		for (int x = 0; x <= side; x++)
			put_floats(stream, (float[2]){(float)x / (float)side, (float)y / (float)side}, 2);
	for (int y = 0; y < side; y++)
		for (int x = 0; x < side; x++) {
			const uint32_t a = (uint32_t)(y * (side + 1) + x), b = a + (uint32_t)side + 1;
			const uint32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
			fwrite(corners, sizeof corners, 1, stream);
		}
}

static void make_glb(const char *path, int side)
{
	const unsigned vertices = (unsigned)((side + 1) * (side + 1)), corners = (unsigned)(6 * side * side);
	char json[2000];
	int length = snprintf(json, sizeof json,
		"{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
		"\"indices\":3,\"material\":0}]}],\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"textures\":[{}],\"accessors\":["
		"{\"bufferView\":0,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\",\"min\":[0,0,-1],"
		"\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"},"
		"{\"bufferView\":2,\"componentType\":5126,\"count\":%u,\"type\":\"VEC2\"},"
		"{\"bufferView\":3,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}],\"bufferViews\":["
		"{\"buffer\":0,\"byteLength\":%u},{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u},"
		"{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u},{\"buffer\":0,\"byteOffset\":%u,"
		"\"byteLength\":%u}],\"buffers\":[{\"byteLength\":%u}]}", vertices, vertices, vertices, corners,
		12 * vertices,
		12 * vertices, 12 * vertices, 24 * vertices, 8 * vertices, 32 * vertices, 4 * corners,
		32 * vertices + 4 * corners);
	while (length % 4)
		json[length++] = ' ';
	const uint32_t bytes = 32 * vertices + 4 * corners;
	FILE *stream = fopen(path, "wb");
	assert_non_null(stream);
	fwrite("glTF", 4, 1, stream);
	put_word(stream, 2);
	put_word(stream, 28 + (uint32_t)length + bytes);
	put_word(stream, (uint32_t)length);
	fwrite("JSON", 4, 1, stream);
	fwrite(json, (size_t)length, 1, stream);
	put_word(stream, bytes);
	fwrite("BIN", 4, 1, stream);
	put_grid(stream, side);
	assert_int_equal(fclose(stream), 0);
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
		const nt_settings settings = {.texcoord_set = -1, .embed = strstr(output, ".gltf"), .threads = 2};
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
	const size_t in = size_of(large), out = size_of(output), most = base + in + out + out / 2;
	/* Linux counts pages for each processor and adds them up in batches: on many, one run may seem to take more */
	for (int try = 0; try < 4 && peak > most; try++)
		peak = peak_of(large, output);
	print_message("%zu bytes to %zu: peak %zu, %zu of them for a triangle or two\n", in, out, peak, base);
	assert_true(SANITIZED || peak <= most);
}

static void a_glb_takes_little_more_than_its_output(void **state)
{
	(void)state;
	make_glb(in_folder("small.glb"), 1);
	make_glb(in_folder("large.glb"), SIDE);
	assert_peak(in_folder("small.glb"), in_folder("large.glb"), in_folder("out.glb"));
}

/* The base64 of a buffer is not held. */
static void a_gltf_with_its_buffer_inside_takes_little_more_than_its_output(void **state)
{
	(void)state;
	make_glb(in_folder("small.glb"), 1);
	make_glb(in_folder("large.glb"), SIDE);
	assert_peak(in_folder("small.glb"), in_folder("large.glb"), in_folder("out.gltf"));
}

static void an_obj_takes_little_more_than_its_output(void **state)
{
	(void)state;
	make_obj(in_folder("small.obj"), 1);
	make_obj(in_folder("large.obj"), SIDE);
	assert_peak(in_folder("small.obj"), in_folder("large.obj"), in_folder("out.glb"));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(a_glb_takes_little_more_than_its_output, make_folder, remove_folder),
		cmocka_unit_test_setup_teardown(a_gltf_with_its_buffer_inside_takes_little_more_than_its_output,
			make_folder, remove_folder),
		cmocka_unit_test_setup_teardown(an_obj_takes_little_more_than_its_output, make_folder, remove_folder),
	};
	return cmocka_run_group_tests_name("pipeline/memory", tests, NULL, NULL);
}
