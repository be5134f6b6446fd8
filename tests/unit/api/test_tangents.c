/* SPDX-License-Identifier: MIT */
/*
 * The choice of an implementation, which users do not have. That all give the same bytes is tested where
 * they are: test_fast.c, test_sums.c, test_usable.c. And triangles that are solved as quads.
 */
#include "api/tangents.h"
#include "surfaces.h"
#include "test.h"
#include <limits.h>
#include <stdlib.h>
#include <sys/resource.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define MALLOC_IS_OTHER 1
#else
#define MALLOC_IS_OTHER 0
#endif

static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const float texcoords[3][2] = {{0, 0}, {1, 0}, {0, 1}};

static nmtan_status solve(nt_isa isa)
{
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	const nt_implementation implementation = {.isa = isa};
	return nt_tangents(&mesh, NULL, &implementation, &output, NULL);
}

TEST(instruction_set_that_the_processor_lacks_is_an_argument_error)
{
	for (int isa = NT_ISA_AUTO; isa <= NT_ISA_AVX512 + 1; isa++)
		assert_int_equal(solve((nt_isa)isa), nt_cpu_has((nt_isa)isa) ? NMTAN_OK : NMTAN_ERROR_ARGUMENT);
	assert_int_equal(solve((nt_isa)9), NMTAN_ERROR_ARGUMENT);
}

static long minor_faults(void)
{
	struct rusage usage;
	getrusage(RUSAGE_SELF, &usage);
	return usage.ru_minflt;
}

/* Calls without a workspace: malloc keeps what one call gave back for the next, since it is nearly all in one block. A
 * strip, mirrored at each column. */
TEST(a_second_call_has_no_fresh_pages)
{
	enum { MOST = 30000 };
	float *rows = calloc(MOST + 2, 8 * sizeof *rows), *tangents = malloc((size_t)MOST * 48);
	uint32_t *corners = malloc((size_t)MOST * 12);
	for (uint32_t i = 0; i < MOST + 2; i++)
		memcpy(rows + 8 * i,
			(float[8]){(float)(i / 2), (float)(i % 2), 0, 0, 0, 1, (float)(i / 2 % 2), (float)(i % 2)}, 32);
	for (uint32_t i = 0; i < MOST; i++)
		memcpy(corners + 3 * i, (uint32_t[3]){i, i % 2 ? i + 2 : i + 1, i % 2 ? i + 1 : i + 2}, 12);
	for (size_t triangles = 500; triangles <= MOST; triangles = triangles * 3 / 2) {
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = triangles,
			.vertex_count = triangles + 2,
			.indices = corners, .positions = rows, .position_stride_bytes = 32, .normals = rows + 3,
			.normal_stride_bytes = 32,
			.texcoords = rows + 6, .texcoord_stride_bytes = 32};
		const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1};
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
		/* the kernel may take pages away to see who uses them, or needs them itself: not each time */
		long fewest = LONG_MAX;
		for (int try = 0; try < 10 && fewest >= 32; try++) {
			long before = 0;
			for (int call = 0; call < 6; call++) {
				before = call == 2 ? minor_faults() : before;
				assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
			}
			fewest = minor_faults() - before < fewest ? minor_faults() - before : fewest;
		}
		assert_true(MALLOC_IS_OTHER || fewest < 32);
	}
	free(rows);
	free(tangents);
	free(corners);
}

/* Random quads over few points, one in three of their triangles without area, and triangles between them. */
enum { FACES = 60, POINTS = 24 };

typedef struct random_faces {
	float positions[POINTS][3], normals[POINTS][3], texcoords[POINTS][2];
	uint32_t quads[4 * FACES], triangles[6 * FACES]; /* the same faces, quads as their halves */
	uint8_t sizes[FACES], halves[2 * FACES];
	size_t corner_count, triangle_count;
	size_t corners[6 * FACES]; /* of each corner of the triangles: that of the faces */
} random_faces;

static void make_random_faces(random_faces *f, uint64_t seed)
{
	static const size_t cuts[][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}, {0, 2, 3, 0, 1, 2},
		{0, 1, 3, 3, 1, 2}, {2, 3, 0, 1, 2, 0}, {1, 3, 0, 1, 2, 3}, {0, 2, 3, 2, 0, 1}, {0, 1, 2, 2, 3, 0}},
		alone[] = {0, 1, 2};
	enum { CUTS = sizeof cuts / sizeof *cuts };
	_Static_assert(NT_HALF_ABC_ACD + CUTS == NT_HALF_SECOND, "all are here, in their order");
	nt_random random = nt_random_seed(seed);
	for (size_t v = 0; v < POINTS; v++) {
		for (size_t k = 0; k < 3; k++)
			f->positions[v][k] = (float)nt_random_below(&random, 4);
		for (size_t k = 0; k < 2; k++)
			f->texcoords[v][k] = (float)nt_random_below(&random, 5);
		memcpy(f->normals[v], normals[0], sizeof normals[0]);
	}
	f->corner_count = f->triangle_count = 0;
	for (size_t i = 0; i < FACES; i++) {
		const size_t size = 3 + (nt_random_below(&random, 3) > 0), cut = nt_random_below(&random, CUTS);
		uint32_t *face = f->quads + f->corner_count;
		for (size_t k = 0; k < size; k++)
			face[k] = nt_random_below(&random, POINTS);
		f->sizes[i] = (uint8_t)size;
		f->halves[f->triangle_count] =
			(uint8_t)(size == 3 ? NT_HALF_NONE : NT_HALF_ABC_ACD + cut);
		if (size == 4)
			f->halves[f->triangle_count + 1] = NT_HALF_SECOND;
		for (size_t k = 0; k < 3 * (size - 2); k++) {
			const size_t corner = size == 3 ? alone[k] : cuts[cut][k];
			f->triangles[3 * f->triangle_count + k] = face[corner];
			f->corners[3 * f->triangle_count + k] = f->corner_count + corner;
		}
		f->triangle_count += size - 2;
		f->corner_count += size;
	}
}

/* Halves of quads have the bytes of the quads' corners, those of folded and of degenerate ones too. */
TEST(halves_have_the_bytes_of_their_quads)
{
	static random_faces f;
	static float of_faces[4 * FACES][4], of_halves[6 * FACES][4];
	for (uint64_t seed = 1; seed <= 2000; seed++) {
		make_random_faces(&f, seed);
		nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = FACES, .vertex_count = POINTS,
			.face_sizes = f.sizes, .indices = f.quads, .positions = f.positions[0],
			.normals = f.normals[0], .texcoords = f.texcoords[0]};
		const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF,
			.method = (nmtan_method)(seed % 5), .threads = 1 + seed % 3};
		nmtan_output output = {.struct_bytes = sizeof output, .tangents = of_faces[0]};
		assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
		mesh.face_sizes = NULL;
		mesh.indices = f.triangles;
		mesh.face_count = f.triangle_count;
		output.tangents = of_halves[0];
		assert_int_equal(nt_tangents_of_halves(&mesh, f.halves, &options, &output, NULL), NMTAN_OK);
		for (size_t c = 0; c < 3 * f.triangle_count; c++)
			assert_memory_equal(of_halves[c], of_faces[f.corners[c]], sizeof *of_halves);
	}
}

/* None of them halves: what nmtan_tangents() says of the triangles. */
TEST(no_halves_are_triangles)
{
	static random_faces f;
	static float of_faces[6 * FACES][4], of_halves[6 * FACES][4];
	make_random_faces(&f, 1);
	memset(f.halves, NT_HALF_NONE, sizeof f.halves);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = f.triangle_count, .vertex_count = POINTS,
		.indices = f.triangles, .positions = f.positions[0], .normals = f.normals[0],
		.texcoords = f.texcoords[0]};
	nmtan_output output = {.struct_bytes = sizeof output, .tangents = of_faces[0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT, of_triangles = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &of_triangles), NMTAN_OK);
	output.tangents = of_halves[0];
	assert_int_equal(nt_tangents_of_halves(&mesh, f.halves, NULL, &output, &counts), NMTAN_OK);
	assert_memory_equal(of_halves, of_faces, 3 * f.triangle_count * sizeof *of_faces);
	assert_memory_equal(&counts, &of_triangles, sizeof counts);
}
