/* SPDX-License-Identifier: MIT */
/*
 * How tangents must change when a mesh does: each property on each method, on the goldens, meshes of data/,
 * jittered surfaces, random soups and, of signs, meshes at the edges of floating point. If arithmetic and order are
 * untouched, floats are equal; elsewhere they are within a bound. A mesh that breaks a property is shrunk, printed as
 * OBJ and left in build/properties; files in data/properties are tried again every time.
 *
 * Left out: corners whose answer is no sum of frames (perpendiculars that repair chose from the normal), which need
 * not turn with the mesh.
 */
#include "test.h"
#include <dirent.h>
#include <math.h>
#include <sys/stat.h>
#include "extremes.h"
#include "oracle128.h"
#include "soup.h"

enum { MOST_FACES = 120 };

typedef struct solution {
	float (*raw)[4], (*t)[4], (*b)[3]; /* [corner_count]; raw: before repair, b its bitangents */
} solution;

static void *room(size_t count, size_t size)
{
	void *block = calloc(count ? count : 1, size);
	assert_non_null(block);
	return block;
}

static bool is_mikktspace(nmtan_method method)
{
	return method == NMTAN_METHOD_MIKKTSPACE || method == NMTAN_METHOD_MIKKTSPACE_SORTED;
}

static oracle_weight weight_of(nmtan_method method)
{
	return method == NMTAN_METHOD_AREA      ? ORACLE_AREA
	       : method == NMTAN_METHOD_LENGYEL ? ORACLE_NONE
						: ORACLE_ANGLE;
}

static solution solve_mesh(const nmtan_mesh *mesh, size_t corners, nmtan_method method)
{
	solution s = {room(corners, 16), room(corners, 16), room(corners, 12)};
	nmtan_options options = {.struct_bytes = sizeof options, .method = method,
		.repair = NMTAN_REPAIR_OFF, .threads = 1};
	const nmtan_output raw = {.struct_bytes = sizeof raw, .tangents = &s.raw[0][0],
		.bitangents = &s.b[0][0]};
	const nmtan_output mended = {.struct_bytes = sizeof mended, .tangents = &s.t[0][0]};
	assert_int_equal(nmtan_tangents(mesh, &options, &raw, NULL), NMTAN_OK);
	options.repair = NMTAN_REPAIR_ON;
	assert_int_equal(nmtan_tangents(mesh, &options, &mended, NULL), NMTAN_OK);
	return s;
}

static solution solve(const soup *s, nmtan_method method)
{
	const nmtan_mesh mesh = soup_mesh(s);
	return solve_mesh(&mesh, s->corner_count, method);
}

static void release(solution *s)
{
	free(s->raw);
	free(s->t);
	free(s->b);
}

/* The oracle's answer on the tried mesh, kept for all properties. */
static oracle_corner *known[3];

static void forget(void)
{
	for (int i = 0; i < 3; i++) {
		free(known[i]);
		known[i] = NULL;
	}
}

static const oracle_corner *exact_of(const soup *s, nmtan_method method)
{
	oracle_corner **at = &known[weight_of(method)];
	const nmtan_mesh mesh = soup_mesh(s);
	if (!*at) {
		*at = room(s->corner_count, sizeof **at);
		assert_true(oracle_solve(&mesh, weight_of(method), *at));
	}
	return *at;
}

/* Whether a corner's tangent is made of frames. */
static bool is_framed(const solution *s, const oracle_corner *exact, size_t c)
{
	if (memcmp(s->raw[c], s->t[c], 16) == 0)
		return true;
	return exact[c].sign != 0 && exact[c].condition < 1e6;
}

static bool equal3(const float *a, float x, float y, float z)
{
	return a[0] == x && a[1] == y && a[2] == z;
}

static bool within(const float *a, const double *b, double bound)
{
	for (int i = 0; i < 3; i++)
		if (!(fabs(a[i] - b[i]) <= bound))
			return false;
	return true;
}

static bool within3(const float *a, const float *b, double bound)
{
	const double exact[3] = {b[0], b[1], b[2]};
	return within(a, exact, bound);
}

/* Properties: true where it holds on this mesh. */

typedef struct property {
	const char *name;
	bool (*holds)(const soup *s, nmtan_method method);
	bool regular; /* only asked of surfaces: bounds that need well-conditioned frames */
	bool signs;   /* signs of floats alone change, or none: asked of extremes, too */
	bool moves;   /* vertices or faces change places: which edges mikktspace.c leaves unsorted depends on that, so
	                 that NMTAN_METHOD_MIKKTSPACE is not asked */
} property;

/* Tangents of `changed` are those of `s` with x, y and z times the given signs, and w times `w`. */
static bool follows(const soup *s, const soup *changed, nmtan_method method, float x, float y, float z, float w)
{
	const oracle_corner *exact = exact_of(s, method);
	solution a = solve(s, method), b = solve(changed, method);
	bool holds = true;
	for (size_t c = 0; c < s->corner_count; c++) {
		if (is_framed(&a, exact, c) && is_framed(&b, exact, c))
			holds = holds && equal3(b.t[c], x * a.t[c][0], y * a.t[c][1], z * a.t[c][2]);
		/* a face without orientation and with nothing around it that has one is not mirrored in any image */
		const bool unknown = exact[c].sign == 0 && a.t[c][3] == 1 && b.t[c][3] == 1;
		holds = holds && (b.t[c][3] == w * a.t[c][3] || unknown);
	}
	release(&a);
	release(&b);
	return holds;
}

static soup flipped(const soup *s, int x, int y, int v)
{
	soup r = soup_copy(s);
	for (size_t c = 0; c < s->corner_count; c++) {
		r.positions[c][0] *= (float)x;
		r.normals[c][0] *= (float)x;
		r.positions[c][1] *= (float)y;
		r.normals[c][1] *= (float)y;
		r.texcoords[c][1] *= (float)v;
	}
	return r;
}

static bool half_a_turn_turns_tangents(const soup *s, nmtan_method method)
{
	soup turned = flipped(s, -1, -1, 1);
	const bool holds = follows(s, &turned, method, -1, -1, 1, 1);
	soup_free(&turned);
	return holds;
}

static bool mirroring_in_space_mirrors_tangents(const soup *s, nmtan_method method)
{
	soup mirrored = flipped(s, -1, 1, 1);
	const bool holds = follows(s, &mirrored, method, -1, 1, 1, 1);
	soup_free(&mirrored);
	return holds;
}

static bool flipping_v_flips_w_alone(const soup *s, nmtan_method method)
{
	soup upside = flipped(s, 1, 1, -1);
	const bool holds = follows(s, &upside, method, 1, 1, 1, -1);
	soup_free(&upside);
	return holds;
}

/* The mirrored twin. */
static bool flipping_u_turns_t_and_flips_w(const soup *s, nmtan_method method)
{
	soup twin = soup_copy(s);
	for (size_t c = 0; c < s->corner_count; c++)
		twin.texcoords[c][0] *= -1;
	const bool holds = follows(s, &twin, method, -1, -1, -1, -1);
	soup_free(&twin);
	return holds;
}

/* Scales at which no product of floats that MikkTSpace takes is left: the frame is that of the formula all the same. */
static bool tiny_meshes_have_the_exact_frame(const soup *s, nmtan_method method)
{
	oracle_corner *exact = room(s->corner_count, sizeof *exact);
	bool holds = true;
	for (int i = 0; i < 2; i++) {
		soup tiny = soup_copy(s);
		bool fits = true;
		for (size_t c = 0; c < s->corner_count; c++) {
			float *values = i ? tiny.positions[c] : tiny.texcoords[c];
			for (int k = 0; k < 2 + i; k++) {
				const float scaled = values[k] * 0x1p-90f;
				fits = fits && scaled * 0x1p90f == values[k] && fabsf(values[k]) < 1e8f;
				values[k] = scaled;
			}
		}
		const nmtan_mesh mesh = soup_mesh(&tiny);
		assert_true(oracle_solve(&mesh, weight_of(method), exact)); /* quads may be cut otherwise */
		solution b = solve(&tiny, method);
		for (size_t c = 0; fits && c < s->corner_count; c++)
			if (exact[c].sign != 0 && exact[c].condition < 1e6)
				holds = holds && within(b.t[c], exact[c].t, 1.2e-7) &&
					b.t[c][3] == (float)exact[c].sign;
		release(&b);
		soup_free(&tiny);
	}
	free(exact);
	return holds;
}

/* The bytes of two meshes that differ in what no result may see. */
static bool equal_bytes(const nmtan_mesh *a, const nmtan_mesh *b, size_t corners, nmtan_method method)
{
	solution x = solve_mesh(a, corners, method), y = solve_mesh(b, corners, method);
	const bool holds = memcmp(x.t, y.t, 16 * corners) == 0 && memcmp(x.raw, y.raw, 16 * corners) == 0;
	release(&x);
	release(&y);
	return holds;
}

static bool equal_soups(const soup *a, const soup *b, nmtan_method method)
{
	const nmtan_mesh x = soup_mesh(a), y = soup_mesh(b);
	return equal_bytes(&x, &y, a->corner_count, method);
}

/* Positions become multiples of 2^-12 below 2^9, so that adding 37, -5 and 111 is exact. */
static bool exact_translation_changes_nothing(const soup *s, nmtan_method method)
{
	static const float by[3] = {37, -5, 111};
	soup a = soup_copy(s);
	bool fits = true;
	for (size_t c = 0; c < s->corner_count; c++) {
		for (int i = 0; i < 3; i++) {
			fits = fits && fabsf(a.positions[c][i]) < 512;
			a.positions[c][i] = roundf(a.positions[c][i] * 4096) / 4096 + 0.0f;
		}
	}
	soup b = soup_copy(&a);
	for (size_t c = 0; c < s->corner_count; c++)
		for (int i = 0; i < 3; i++)
			b.positions[c][i] += by[i];
	const bool holds = !fits || equal_soups(&a, &b, method);
	soup_free(&a);
	soup_free(&b);
	return holds;
}

/* Not asked where MikkTSpace's own thresholds (FLT_MIN) are near. */
static bool powers_of_two_change_nothing(const soup *s, nmtan_method method)
{
	soup b = soup_copy(s);
	bool fits = true;
	for (size_t c = 0; c < s->corner_count; c++) {
		for (int i = 0; i < 3; i++) {
			fits = fits && fabsf(b.positions[c][i]) < 1e8f;
			b.positions[c][i] *= 64;
		}
		for (int i = 0; i < 2; i++) {
			fits = fits && fabsf(b.texcoords[c][i]) < 1e8f;
			b.texcoords[c][i] /= 16;
		}
	}
	const bool holds = !fits || equal_soups(s, &b, method);
	soup_free(&b);
	return holds;
}

static bool indexing_changes_nothing(const soup *s, nmtan_method method)
{
	const nmtan_mesh mesh = soup_mesh(s);
	soup_indexed indexed = soup_index(s);
	const bool holds = equal_bytes(&mesh, &indexed.mesh, s->corner_count, method);
	soup_indexed_free(&indexed);
	return holds;
}

/* Vertices of the indexed mesh in reverse. */
static bool numbering_vertices_anew_changes_nothing(const soup *s, nmtan_method method)
{
	soup_indexed a = soup_index(s), b = soup_index(s);
	const size_t n = a.mesh.vertex_count;
	for (size_t v = 0; v < n; v++) {
		memcpy(b.positions[n - 1 - v], a.positions[v], 12);
		memcpy(b.normals[n - 1 - v], a.normals[v], 12);
		memcpy(b.texcoords[n - 1 - v], a.texcoords[v], 8);
	}
	for (size_t c = 0; c < s->corner_count; c++)
		b.indices[c] = (uint32_t)(n - 1 - a.indices[c]);
	const bool holds = equal_bytes(&a.mesh, &b.mesh, s->corner_count, method);
	soup_indexed_free(&a);
	soup_indexed_free(&b);
	return holds;
}

/* Faces in reverse: w of oriented faces stays. Sums in double stay within rounding; MikkTSpace's groups may
 * depend on the order, so its vectors are asked of surfaces alone (see reordered_surface). */
static bool reordered(const soup *s, nmtan_method method, double bound, double condition)
{
	soup r = soup_copy(s);
	size_t *from = room(s->corner_count, sizeof *from), at = s->corner_count, first = 0;
	for (size_t f = 0; f < s->face_count; f++) {
		const size_t size = s->sizes[f];
		at -= size;
		r.sizes[s->face_count - 1 - f] = s->sizes[f];
		for (size_t k = 0; k < size; k++) {
			from[at + k] = first + k;
			memcpy(r.positions[at + k], s->positions[first + k], 12);
			memcpy(r.normals[at + k], s->normals[first + k], 12);
			memcpy(r.texcoords[at + k], s->texcoords[first + k], 8);
		}
		first += size;
	}
	solution a = solve(s, method), b = solve(&r, method);
	bool holds = true;
	for (size_t c = 0; c < s->corner_count; c++) {
		const oracle_corner *exact = &exact_of(s, method)[from[c]];
		if (exact->sign == 0)
			continue;
		holds = holds && a.t[from[c]][3] == b.t[c][3];
		if (exact->condition < condition)
			holds = holds && within3(a.t[from[c]], b.t[c], bound);
	}
	release(&a);
	release(&b);
	free(from);
	soup_free(&r);
	return holds;
}

static bool order_of_faces_hardly_matters(const soup *s, nmtan_method method)
{
	return reordered(s, method, 1.2e-7, is_mikktspace(method) ? 0 : 16777216.0);
}

static bool order_of_faces_of_surfaces_hardly_matters(const soup *s, nmtan_method method)
{
	return reordered(s, method, 2e-6, 1e3);
}

/* T becomes B. MikkTSpace's B is in its output; what the other methods' B would be, the oracle knows. */
static bool swapping_u_and_v_swaps_t_and_b(const soup *s, nmtan_method method)
{
	soup swapped = soup_copy(s);
	for (size_t c = 0; c < s->corner_count; c++) {
		swapped.texcoords[c][0] = s->texcoords[c][1];
		swapped.texcoords[c][1] = s->texcoords[c][0];
	}
	const oracle_corner *exact = exact_of(s, method);
	solution a = solve(s, method), b = solve(&swapped, method);
	bool holds = true;
	for (size_t c = 0; c < s->corner_count; c++) {
		if (exact[c].sign != 0)
			holds = holds && b.t[c][3] == -a.t[c][3];
		const bool untouched = memcmp(a.raw[c], a.t[c], 16) == 0 && memcmp(b.raw[c], b.t[c], 16) == 0;
		if (is_mikktspace(method) && untouched && is_framed(&a, exact, c) &&
			is_framed(&b, exact, c))
			holds = holds && equal3(b.t[c], a.b[c][0], a.b[c][1], a.b[c][2]) &&
				equal3(a.t[c], b.b[c][0], b.b[c][1], b.b[c][2]);
		if (!is_mikktspace(method) && exact[c].sign != 0 &&
			exact[c].condition_b < 16777216.0)
			holds = holds && within(b.t[c], exact[c].b, 1.2e-7);
	}
	release(&a);
	release(&b);
	soup_free(&swapped);
	return holds;
}

/* Sums in double are those of the 113-bit formula to the last bit of a float; repair changes nothing there. */
static bool sums_in_double_are_exact(const soup *s, nmtan_method method)
{
	if (is_mikktspace(method))
		return true;
	const oracle_corner *exact = exact_of(s, method);
	solution a = solve(s, method);
	bool holds = true;
	for (size_t c = 0; c < s->corner_count; c++)
		if (exact[c].sign != 0 && exact[c].condition < 16777216.0)
			holds = holds && within(a.t[c], exact[c].t, 1.0 / 8388608);
	release(&a);
	return holds;
}

/* Unit, perpendicular to a unit normal within 2^-10, for sums in double as good as a float can be, one w on each face,
 * and the exact one. */
static bool results_are_usable(const soup *s, nmtan_method method)
{
	const oracle_corner *exact = exact_of(s, method);
	solution a = solve(s, method);
	bool holds = true;
	for (size_t f = 0, first = 0; f < s->face_count; first += s->sizes[f++]) {
		for (size_t c = first; c < first + s->sizes[f]; c++) {
			const float *t = a.t[c], *n = s->normals[c];
			const double squared = (double)t[0] * t[0] + (double)t[1] * t[1] + (double)t[2] * t[2];
			const double along = (double)t[0] * n[0] + (double)t[1] * n[1] + (double)t[2] * n[2];
			const double normal = (double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2];
			holds = holds && (fabs(normal - 1) > 1.0 / 2048 || fabs(along) <= 1.0 / 1024 + 1e-9);
			holds = holds && fabs(squared - 1) <= 4e-6 && fabsf(t[3]) == 1 && t[3] == a.t[first][3];
			holds = holds && (exact[c].sign == 0 || t[3] == (float)exact[c].sign);
			holds = holds && (method != NMTAN_METHOD_ROBUST || !(fabs(along) > 4.0 / 8388608));
		}
	}
	release(&a);
	return holds;
}

/* A general rotation: positions and normals are rounded anew. */
static bool rotation_turns_tangents(const soup *s, nmtan_method method)
{
	/* by 1.1 about (1, 2, 2) / 3 */
	const double c = cos(1.1), si = sin(1.1), x = 1.0 / 3, y = 2.0 / 3, z = 2.0 / 3, d = 1 - c;
	const double m[3][3] = {{c + x * x * d, x * y * d - z * si, x * z * d + y * si},
		{y * x * d + z * si, c + y * y * d, y * z * d - x * si},
		{z * x * d - y * si, z * y * d + x * si, c + z * z * d}};
	soup r = soup_copy(s);
	for (size_t k = 0; k < s->corner_count; k++) {
		for (int i = 0; i < 3; i++) {
			const float *p = s->positions[k], *n = s->normals[k];
			r.positions[k][i] = (float)(m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2]);
			r.normals[k][i] = (float)(m[i][0] * n[0] + m[i][1] * n[1] + m[i][2] * n[2]);
		}
	}
	solution a = solve(s, method), b = solve(&r, method);
	bool holds = true;
	for (size_t k = 0; k < s->corner_count; k++) {
		double expected[3];
		for (int i = 0; i < 3; i++)
			expected[i] = m[i][0] * a.t[k][0] + m[i][1] * a.t[k][1] + m[i][2] * a.t[k][2];
		/* cells are about 0.1 wide, rounding moves corners by 1e-7, frames by some 1e-6 */
		holds = holds && within(b.t[k], expected, 2e-5) && a.t[k][3] == b.t[k][3];
	}
	release(&a);
	release(&b);
	soup_free(&r);
	return holds;
}

static const property properties[] = {
	{"half_a_turn_turns_tangents", half_a_turn_turns_tangents, false, true, true},
	{"rotation_turns_tangents", rotation_turns_tangents, true, false, true},
	{"exact_translation_changes_nothing", exact_translation_changes_nothing, false, false, true},
	{"powers_of_two_change_nothing", powers_of_two_change_nothing, false, false, false},
	{"numbering_vertices_anew_changes_nothing", numbering_vertices_anew_changes_nothing, false, true, false},
	{"order_of_faces_hardly_matters", order_of_faces_hardly_matters, false, false, true},
	{"order_of_faces_of_surfaces_hardly_matters", order_of_faces_of_surfaces_hardly_matters, true, false, true},
	{"mirroring_in_space_mirrors_tangents", mirroring_in_space_mirrors_tangents, false, true, true},
	{"flipping_v_flips_w_alone", flipping_v_flips_w_alone, false, true, false},
	{"flipping_u_turns_t_and_flips_w", flipping_u_turns_t_and_flips_w, false, true, false},
	{"tiny_meshes_have_the_exact_frame", tiny_meshes_have_the_exact_frame, false, false, false},
	{"swapping_u_and_v_swaps_t_and_b", swapping_u_and_v_swaps_t_and_b, false, false, false},
	{"indexing_changes_nothing", indexing_changes_nothing, false, true, false},
	{"sums_in_double_are_exact", sums_in_double_are_exact, false, false, false},
	{"results_are_usable", results_are_usable, false, false, false},
};
enum { PROPERTIES = sizeof properties / sizeof *properties };

static const char *const method_names[] = {"mikktspace", "area", "lengyel", "robust", "mikktspace-sorted"};

/* Shrinking: drops runs of faces, ever shorter ones, as long as the property stays broken. */
static soup shrink(const soup *s, const property *p, nmtan_method method)
{
	soup least = soup_copy(s);
	for (size_t run = least.face_count / 2; run > 0; run = run > 1 ? (run + 1) / 2 : 0) {
		for (size_t begin = 0; begin < least.face_count && least.face_count > 1;) {
			bool *keep = room(least.face_count, 1);
			for (size_t f = 0; f < least.face_count; f++)
				keep[f] = f < begin || f >= begin + run;
			soup smaller = soup_select(&least, keep);
			forget();
			const bool broken = smaller.face_count > 0 && !p->holds(&smaller, method);
			free(keep);
			if (broken) {
				soup_free(&least);
				least = smaller;
			} else {
				soup_free(&smaller);
				begin += run;
			}
		}
	}
	return least;
}

static void report(const soup *s, const char *mesh_name, const property *p, nmtan_method method)
{
	soup least = shrink(s, p, method);
	forget();
	char path[256], comment[256];
	snprintf(comment, sizeof comment, "%s is broken with %s, found on %s", p->name, method_names[method],
		mesh_name);
	snprintf(path, sizeof path, "build/properties/%s-%s.obj", p->name, method_names[method]);
	mkdir("build", 0777);
	mkdir("build/properties", 0777);
	FILE *f = fopen(path, "w");
	if (f) {
		soup_write_obj(&least, f, comment);
		fclose(f);
	}
	print_error("%s; shrunk to %zu faces in %s (move it to data/properties to keep it):\n", comment,
		least.face_count, path);
	if (least.face_count <= 12)
		soup_write_obj(&least, stderr, comment);
	soup_free(&least);
}

static size_t broken;

/* Properties are looked at without sanitizers; these see on which memory they are computed. */
#ifdef __SANITIZE_ADDRESS__
enum { STEP = 5 };
#else
enum { STEP = 1 };
#endif

typedef enum mesh_kind { PLAIN, REGULAR, EXTREME } mesh_kind;

static void try_mesh(const soup *s, const char *name, mesh_kind kind)
{
	forget();
	for (int i = 0; i < PROPERTIES && s->face_count > 0; i++) {
		if ((properties[i].regular && kind != REGULAR) || (kind == EXTREME && !properties[i].signs))
			continue;
		for (int m = NMTAN_METHOD_MIKKTSPACE; m <= NMTAN_METHOD_MIKKTSPACE_SORTED; m++) {
			/* of extremes one method is asked for each kind of sum: in float and in double */
			if ((properties[i].moves && m == NMTAN_METHOD_MIKKTSPACE) ||
				(kind == EXTREME && (m == NMTAN_METHOD_AREA || m == NMTAN_METHOD_LENGYEL)) ||
				properties[i].holds(s, (nmtan_method)m))
				continue;
			broken++;
			report(s, name, &properties[i], (nmtan_method)m);
		}
	}
	forget();
}

TEST(properties_hold_on_surfaces)
{
	broken = 0;
	for (int surface = 0; surface < NT_SURFACE_COUNT; surface++) {
		nt_owned grid = nt_surface_grid((nt_surface)surface, 10, 8, 0.2, 7);
		soup s = soup_from_mesh(&grid.mesh, MOST_FACES);
		try_mesh(&s, nt_surface_names[surface], REGULAR);
		soup_free(&s);
		nt_owned_free(&grid);
	}
	assert_int_equal(broken, 0);
}

TEST(properties_hold_on_random_soups)
{
	broken = 0;
	for (uint64_t seed = 0; seed < 40; seed += STEP) {
		char name[32];
		snprintf(name, sizeof name, "soup %d", (int)seed);
		soup s = soup_random(seed);
		try_mesh(&s, name, PLAIN);
		soup_free(&s);
	}
	assert_int_equal(broken, 0);
}

TEST(properties_of_signs_hold_at_the_edges_of_floating_point)
{
	broken = 0;
	for (const family *f = families; f < families + family_count; f++)
		for (size_t l = 0; !f->linear && l < f->level_count; l += STEP) {
			char name[64];
			snprintf(name, sizeof name, "%s %g", f->name, f->levels[l]);
			nt_owned mesh = f->make(f->levels[l], 1000 * l);
			soup s = soup_from_mesh(&mesh.mesh, MOST_FACES);
			try_mesh(&s, name, EXTREME);
			soup_free(&s);
			nt_owned_free(&mesh);
		}
	assert_int_equal(broken, 0);
}

static void try_golden(const char *path, const nt_golden *golden, void *context)
{
	size_t *number = context;
	if ((*number)++ % STEP != 0)
		return;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	soup s = soup_from_mesh(&mesh, MOST_FACES);
	try_mesh(&s, path, PLAIN);
	soup_free(&s);
}

TEST(properties_hold_on_golden_meshes)
{
	size_t number = 0;
	broken = 0;
	nt_golden_each(NT_DATA_DIR "/golden", try_golden, &number);
	assert_int_equal(broken, 0);
}

/* Every OBJ of a folder. */
static size_t try_folder(const char *folder)
{
	size_t count = 0;
	DIR *d = opendir(folder);
	for (struct dirent *e; d && (e = readdir(d));) {
		const size_t length = strlen(e->d_name);
		if (length < 4 || strcmp(e->d_name + length - 4, ".obj") != 0)
			continue;
		char path[512];
		snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
		soup s = soup_read_obj(path, MOST_FACES);
		count += s.face_count > 0;
		try_mesh(&s, path, PLAIN);
		soup_free(&s);
	}
	if (d)
		closedir(d);
	return count;
}

TEST(properties_hold_on_meshes_of_data_and_kept_cases)
{
	broken = 0;
	assert_true(try_folder(NT_DATA_DIR) > 0);
	try_folder(NT_DATA_DIR "/properties");
	assert_int_equal(broken, 0);
}

TEST(properties_hold_on_real_models)
{
	broken = 0;
	if (try_folder("../shared/models/obj") == 0) {
		print_message("no models in ../shared/models/obj\n");
		skip();
	}
	assert_int_equal(broken, 0);
}
