/* SPDX-License-Identifier: MIT */
/*
 * Quads of which triangles are the halves. Which triangles pair is said by hand; the orientation of a folded quad is
 * that of the definition, which is asked with the quad itself.
 */
#include "report/quads.h"
#include "hand_mesh.h"
#include "surfaces.h"

#include <math.h>

/* Vertices 0 to count - 1 at places of their own. */
static hand_mesh *points(uint32_t count)
{
	hand_mesh *h = hand_new();
	for (uint32_t i = 0; i < count; i++)
		hand_vertex(h, (float)i, (float)(i * i), 0, (float)i, 1);
	hand_give_normals(h);
	return h;
}

/* The kind of each triangle: - alone, C and D the first half of an (a b c d) cut by a c or b d, 2 a second half. */
static void expect(const hand_mesh *h, bool polygons, const char *letters)
{
	static const char names[] = {[NT_HALF_NONE] = '-', [NT_HALF_ABC_ACD] = 'C', [NT_HALF_ABD_BCD] = 'D',
		[NT_HALF_ACD_ABC] = 'E', [NT_HALF_ABD_DBC] = 'F', [NT_HALF_CDA_BCA] = 'G', [NT_HALF_BDA_BCD] = 'H',
		[NT_HALF_ACD_CAB] = 'I', [NT_HALF_ABC_CDA] = 'J', [NT_HALF_SECOND] = '2'};
	uint8_t halves[HAND_TRIANGLES];
	char found[HAND_TRIANGLES + 1] = "";
	size_t quads = 0;
	const size_t count = nt_pair_quads(&h->mesh, polygons, halves);
	for (size_t t = 0; t < h->mesh.face_count; t++) {
		found[t] = names[halves[t]];
		quads += halves[t] == NT_HALF_SECOND;
	}
	assert_string_equal(found, letters);
	assert_int_equal(count, quads);
}

TEST(both_cuts_pair_and_so_do_their_mirror_images)
{
	static const uint32_t pairs[][6] = {{0, 1, 2, 0, 2, 3}, {0, 3, 2, 0, 2, 1}, {0, 1, 3, 1, 2, 3},
		{0, 3, 1, 3, 2, 1}};
	static const char *const letters[] = {"C2", "C2", "D2", "D2"};
	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		hand_mesh *h = points(4);
		hand_triangle(h, pairs[i][0], pairs[i][1], pairs[i][2]);
		hand_triangle(h, pairs[i][3], pairs[i][4], pairs[i][5]);
		expect(h, false, letters[i]);
		hand_free(h, NULL);
	}
}

/* Orders of exporters, each as a rule of theirs: quads 0 1 2 3 and 4 5 6 7, cut along 0 2 and along 5 7, then corners
 * of each half exchanged, as a program does that mirrors the model. A program has one order: what the others would pair
 * stays alone. */
TEST(orders_of_exporters_pair_and_one_mesh_has_one)
{
	static const uint32_t halves[4][3] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 7}, {5, 6, 7}};
	static const struct {
		const char *letters;
		uint32_t corners[3];
	} orders[] = {{"C2D2", {0, 1, 2}}, {"E2F2", {0, 2, 1}}, {"G2H2", {2, 1, 0}}};
	for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
		hand_mesh *h = points(8);
		const uint32_t *k = orders[i].corners;
		for (size_t t = 0; t < 4; t++)
			hand_triangle(h, halves[t][k[0]], halves[t][k[1]], halves[t][k[2]]);
		expect(h, false, orders[i].letters);
		hand_free(h, NULL);
	}
	static const uint32_t others[][6] = {{0, 2, 1, 2, 0, 3}, {0, 1, 2, 2, 3, 0}};
	for (size_t i = 0; i < 2; i++) {
		hand_mesh *h = points(12);
		for (uint32_t quad = 0; quad < 3; quad++) {
			const uint32_t *c = quad == 2 ? others[1 - i] : others[i];
			hand_triangle(h, 4 * quad + c[0], 4 * quad + c[1], 4 * quad + c[2]);
			hand_triangle(h, 4 * quad + c[3], 4 * quad + c[4], 4 * quad + c[5]);
		}
		expect(h, false, i ? "J2J2--" : "I2I2--");
		hand_free(h, NULL);
	}
}

/* Triangles with an edge in common that are written in another order, or wound otherwise, are none of these forms. */
TEST(other_neighbours_do_not_pair)
{
	static const uint32_t pairs[][6] = {{0, 1, 2, 3, 1, 0}, {0, 1, 2, 0, 3, 2}, {0, 1, 3, 2, 3, 1},
		{0, 1, 2, 3, 4, 5}};
	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		hand_mesh *h = points(6);
		hand_triangle(h, pairs[i][0], pairs[i][1], pairs[i][2]);
		hand_triangle(h, pairs[i][3], pairs[i][4], pairs[i][5]);
		expect(h, false, "--");
		hand_free(h, NULL);
	}
}

/* Each pair is taken where it begins; what is left over at the end is alone. */
TEST(fans_are_paired_in_order)
{
	static const char *const letters[] = {"", "-", "C2", "C2-", "C2C2", "C2C2-"};
	for (uint32_t triangles = 0; triangles < 6; triangles++) {
		hand_mesh *h = points(8);
		for (uint32_t i = 1; i <= triangles; i++)
			hand_triangle(h, 0, i, i + 1);
		expect(h, false, letters[triangles]);
		hand_free(h, NULL);
	}
}

/* A second quad over copies of vertices: equal by position, normal and texture coordinates, in all but `other`. */
TEST(corners_are_compared_by_value)
{
	for (int other = 0; other <= 4; other++) {
		hand_mesh *h = points(4);
		const uint32_t a = hand_vertex(h, 0, 0, 0, 0, 1), c = hand_vertex(h, 2, 4, 0, 2, 1);
		h->positions[a][2] = other == 1 ? 1.0f : -0.0f;
		h->normals[c][0] = other == 2 ? 1e-30f : -0.0f;
		h->texcoords[a][1] = other == 3 ? 2.0f : 1.0f;
		h->positions[c][1] = other == 4 ? NAN : 4.0f;
		hand_triangle(h, 0, 1, 2);
		hand_triangle(h, a, c, 3);
		expect(h, false, other ? "--" : "C2");
		hand_free(h, NULL);
	}
}

/* One vertex is itself, whatever it holds. */
TEST(vertex_that_is_not_a_number_is_itself)
{
	hand_mesh *h = points(4);
	h->positions[0][0] = h->texcoords[2][1] = NAN;
	hand_quad(h, 0, 1, 2, 3);
	expect(h, false, "C2");
	hand_free(h, NULL);
}

TEST(triangles_without_indices_pair)
{
	static const uint32_t corners[] = {0, 1, 3, 1, 2, 3, 3, 2, 1};
	hand_mesh *h = hand_new();
	for (size_t c = 0; c < 9; c++)
		hand_vertex(h, (float)corners[c], (float)(corners[c] * corners[c]), 0, (float)corners[c], 0);
	hand_give_normals(h);
	for (uint32_t t = 0; t < 3; t++)
		hand_triangle(h, 3 * t, 3 * t + 1, 3 * t + 2);
	h->mesh.indices = NULL;
	expect(h, false, "D2-");
	hand_free(h, NULL);
}

/* A polygon of four corners is a quad, whichever of them its writer put first to tell it from the polygon before. */
TEST(polygons_of_four_corners_are_quads)
{
	hand_mesh *h = points(10);
	hand_quad(h, 0, 1, 2, 3);
	hand_quad(h, 4, 5, 0, 3); /* (0 3 4 5), whose first corner would be 0 again */
	hand_triangle(h, 6, 7, 8);
	hand_quad(h, 0, 3, 4, 5);
	expect(h, true, "C2C2-C2");
	hand_free(h, NULL);
}

/* Pairs that are no polygon stay alone: three triangles are a pentagon, another form has two first corners, and so have
 * vertices that only look the same. */
TEST(other_polygons_stay_triangles)
{
	hand_mesh *h = points(10);
	for (uint32_t i = 1; i <= 3; i++)
		hand_triangle(h, 0, i, i + 1);
	hand_triangle(h, 5, 6, 8);
	hand_triangle(h, 6, 7, 8);
	const uint32_t same = hand_vertex(h, 0, 0, 0, 0, 1);
	hand_triangle(h, 0, 1, 2);
	hand_triangle(h, same, 2, 3);
	expect(h, false, "C2-D2C2");
	expect(h, true, "-------");
	hand_free(h, NULL);
}

/* A vertex that got a second normal has a second number, and is the first corner of its polygon still. */
TEST(made_normals_leave_polygons_whole)
{
	hand_mesh *h = points(5);
	const uint32_t copy = hand_vertex(h, 0, 0, 0, 0, 1);
	uint32_t sources[] = {0};
	h->mesh.source_vertex_count = copy;
	h->mesh.vertex_sources = sources;
	hand_triangle(h, 0, 1, 2);
	hand_triangle(h, 0, 2, 3);
	hand_triangle(h, copy, 3, 4);
	expect(h, true, "---");
	hand_free(h, NULL);
}

/* The definition's w of a lone quad; 0: the corners do not agree. */
static int sign_of_quad(const hand_mesh *h, const uint32_t quad[4])
{
	static const uint8_t size = 4;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = h->mesh.vertex_count,
		.face_sizes = &size, .indices = quad, .positions = h->mesh.positions, .normals = h->mesh.normals,
		.texcoords = h->mesh.texcoords};
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF};
	float tangents[4][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	for (size_t k = 1; k < 4; k++)
		if (tangents[k][3] != tangents[0][3])
			return 0;
	return (int)tangents[0][3];
}

/* Corners on a coarse lattice of texture coordinates, so that halves of equal area are there too. */
TEST(folded_quads_have_the_sign_that_mikktspace_gives_them)
{
	static const uint32_t cuts[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
	const uint32_t quad[] = {0, 1, 2, 3};
	nt_random random = nt_random_seed(1);
	size_t folded = 0, ties = 0;
	for (int i = 0; i < 4000; i++) {
		hand_mesh *h = points(4);
		float diagonals[2] = {0}, areas[2];
		for (size_t v = 0; v < 4; v++)
			for (size_t k = 0; k < 2; k++)
				h->texcoords[v][k] = (float)nt_random_below(&random, 5);
		for (size_t k = 0; k < 2; k++)
			for (size_t cut = 0; cut < 2; cut++)
				diagonals[cut] += powf(h->texcoords[cut][k] - h->texcoords[cut + 2][k], 2);
		const size_t cut = diagonals[1] < diagonals[0];
		uint8_t halves[2];
		for (size_t t = 0; t < 2; t++) {
			const uint32_t *c = cuts[cut][t];
			const float *uv = h->texcoords[0];
			hand_triangle(h, c[0], c[1], c[2]);
			areas[t] = (uv[2 * c[1]] - uv[2 * c[0]]) * (uv[2 * c[2] + 1] - uv[2 * c[0] + 1]) -
				   (uv[2 * c[1] + 1] - uv[2 * c[0] + 1]) * (uv[2 * c[2]] - uv[2 * c[0]]);
		}
		assert_int_equal(nt_pair_quads(&h->mesh, false, halves), 1);
		const bool is_folded = areas[0] * areas[1] < 0;
		for (size_t t = 0; t < 2 && diagonals[0] != diagonals[1]; t++)
			assert_int_equal(nt_folded_orientation(&h->mesh, halves, t),
				!is_folded ? 0 : areas[0] == -areas[1] ? NT_FOLDED_EITHER : sign_of_quad(h, quad));
		for (size_t t = 0; t < 2; t++)
			assert_int_equal(nt_folded_orientation(&h->mesh, NULL, t), 0);
		folded += is_folded;
		ties += is_folded && areas[0] == -areas[1] && diagonals[0] != diagonals[1];
		hand_free(h, NULL);
	}
	assert_true(folded > 100 && ties > 10);
}
