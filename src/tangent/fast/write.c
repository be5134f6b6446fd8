/* SPDX-License-Identifier: MIT */
/*
 * Steps 6 and 8 of the fast path: results go from vertices to corners.
 */
#include "tangent/fast/parts.h"

#include <string.h>
#include "base/parallel.h"
#include "topology/corners.h"

/* Triangles that are written before those of them that need more are. */
enum { BATCH = 64 };

/* Triangles by which the records of a scattered mesh are prefetched before they are read. */
enum { WRITE_AHEAD = 16 };

static void put_more(const nt_solve *solve, size_t corner, const nt_record_more *more)
{
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * corner, &more->x, 3 * sizeof(float));
	if (solve->magnitudes)
		memcpy(solve->magnitudes + 2 * corner, &more->mag_s, 2 * sizeof(float));
}

static void write_corner(const nt_fast *fast, size_t corner, const nt_record *record,
	const nt_record_more *more, float sign)
{
	memcpy(fast->solve->tangents + 4 * corner, record, 3 * sizeof(float));
	fast->solve->tangents[4 * corner + 3] = sign;
	put_more(fast->solve, corner, more);
}

/* The w of a record's row: NT_RESULT_UNUSABLE stays, for usable.c. */
static inline float sign_of(int orient, uint32_t state)
{
	const uint32_t bits = (orient ? NT_RESULT_PLUS : NT_RESULT_MINUS) |
			      (state & NT_RESULT_COMPLEX ? 0 : state & NT_RESULT_UNUSABLE);
	float sign;
	memcpy(&sign, &bits, sizeof sign);
	return sign;
}

/* Whether the other half of a triangle's quad is sound. */
static bool has_sound_half(const nt_fast *fast, size_t t)
{
	if (fast->flags[t] & NT_TRIANGLE_SECOND)
		return !(fast->flags[t - 1] & NT_TRIANGLE_DEGENERATE);
	return nt_fast_quad_begins(fast, t) && !(fast->flags[t + 1] & NT_TRIANGLE_DEGENERATE);
}

static const nt_record unassigned = {.x = 1.0f};
static const nt_record_more unassigned_more = {.y = 1.0f, .mag_s = 1.0f, .mag_t = 1.0f};

void nt_fast_write_unassigned(const nt_fast *fast, size_t corner)
{
	write_corner(fast, corner, &unassigned, &unassigned_more, nt_unassigned_sign(fast->solve));
}

static void write_special(nt_fast *fast, size_t t)
{
	uint8_t *flags = &fast->flags[t];
	const bool degenerate = *flags & NT_TRIANGLE_DEGENERATE;
	if (degenerate && has_sound_half(fast, t)) {
		*flags |= NT_TRIANGLE_COPY;
		return;
	}
	const int first = !fast->records[0];
	const bool both = fast->records[!first];
	unsigned complex = 0, two = 0; /* two: a vertex of both orientations */
	for (size_t i = 3 * t; i < 3 * t + 3; i++) {
		const uint32_t v = nt_fast_vertex(fast, i);
		const nt_record *record = nt_fast_record(fast, first, v);
		int o = first;
		complex |= record->state & NT_RESULT_COMPLEX;
		if (both) {
			const nt_record *second = nt_fast_record(fast, 1, v);
			o = record->state == NT_RESULT_NONE;
			two |= !o & (second->state != NT_RESULT_NONE);
			record = o ? second : record;
		}
		const bool has = record->state != NT_RESULT_NONE;
		write_corner(fast, nt_fast_corner(fast, i), has ? record : &unassigned,
			has && fast->wants_more ? &fast->more[o][v] : &unassigned_more,
			has ? sign_of(o, record->state) : nt_unassigned_sign(fast->solve));
	}
	if (complex || (degenerate && two))
		*flags |= degenerate ? NT_TRIANGLE_COPY : NT_TRIANGLE_COMPLEX;
}

/* The records of a later triangle of a scattered mesh; the last ones of the range ask twice. Always in line: gcc 12
 * drops a call of what does nothing but prefetch. */
static inline NT_ALWAYS_INLINE void prefetch_records(const nt_fast *fast, size_t t, size_t end)
{
	const size_t later = t + WRITE_AHEAD < end ? t + WRITE_AHEAD : end - 1;
	const int orient = fast->flags[later] & NT_TRIANGLE_ORIENT;
	uint32_t copy[3];
	const uint32_t *v = nt_triangle_vertices(&fast->triangles, later, 1, copy);
	for (int k = 0; fast->records[orient] && k < 3; k++)
		NT_PREFETCH(nt_fast_record(fast, orient, v[k]));
}

/* Whether a corner is in a block of vertices with an open record. The blocks fit the first-level cache, or nearly so,
 * where records do not. */
static inline bool is_near_open(const nt_fast *fast, const uint32_t *v)
{
	return fast->open[v[0] / NT_LANES] | fast->open[v[1] / NT_LANES] | fast->open[v[2] / NT_LANES];
}

/* The signs of a triangle whose records have more than signs. */
static inline NT_ALWAYS_INLINE void write_signs(const nt_fast *fast, size_t t, const uint32_t *v)
{
	const int orient = fast->flags[t] & NT_TRIANGLE_ORIENT;
	for (unsigned k = 0; k < 3; k++)
		fast->solve->tangents[4 * nt_fast_corner(fast, 3 * t + k) + 3] =
			sign_of(orient, nt_fast_record(fast, orient, v[k])->state);
	fast->flags[t] |= NT_TRIANGLE_COMPLEX;
}

/* The optional outputs of a triangle. */
static void NT_NOINLINE write_more(const nt_fast *fast, size_t t, const uint32_t *v)
{
	for (unsigned k = 0; k < 3; k++) {
		const nt_record_more *more = &fast->more[fast->flags[t] & NT_TRIANGLE_ORIENT][v[k]];
		put_more(fast->solve, nt_fast_corner(fast, 3 * t + k), more);
	}
}

/* Every corner of [begin, end) gets its vertex's record and its orientation's sign, which complex.c takes as they are
 * where that is the result; in a sparse solve those of suspects only. */
static void write_triangles(nt_fast *fast, size_t begin, size_t end)
{
	/* copies, which no store changes */
	const nt_triangles triangles = {.ids = fast->triangles.ids, .cuts = fast->triangles.cuts};
	const nt_record *const records[2] = {fast->records[0], fast->records[1]};
	uint8_t *const flags = fast->flags;
	float *const tangents = fast->solve->tangents;
	const size_t step = fast->record_step;
	const bool scattered = fast->scattered, sparse = fast->sparse, more = fast->wants_more;
	for (size_t t = begin; t < end; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&triangles, t, 1, copy);
		if (sparse && !(flags[t] & NT_TRIANGLE_SUSPECT) && !is_near_open(fast, v))
			continue;
		if (scattered)
			prefetch_records(fast, t, end);
		if (flags[t] & (NT_TRIANGLE_ANY | NT_TRIANGLE_DEGENERATE)) {
			write_special(fast, t);
			continue;
		}
		const nt_record *const from = records[flags[t] & NT_TRIANGLE_ORIENT];
		nt_int4 a, b, c;
		memcpy(&a, &from[step * v[0]], sizeof a);
		memcpy(&b, &from[step * v[1]], sizeof b);
		memcpy(&c, &from[step * v[2]], sizeof c);
		const bool open = nt_state4(nt_or4(nt_or4(a, b), c)) & (NT_RESULT_COMPLEX | NT_RESULT_UNUSABLE);
		if (sparse && !open && !(flags[t] & NT_TRIANGLE_SUSPECT))
			continue;
		memcpy(tangents + 4 * nt_triangle_corner(&triangles, t, 0), &a, sizeof a);
		memcpy(tangents + 4 * nt_triangle_corner(&triangles, t, 1), &b, sizeof b);
		memcpy(tangents + 4 * nt_triangle_corner(&triangles, t, 2), &c, sizeof c);
		if (open)
			write_signs(fast, t, v);
		if (more)
			write_more(fast, t, v);
	}
}

/* A bit for each of four triangles one of whose records is not just a result; given is the union of their bits. */
static inline unsigned find_open(nt_int4 a, nt_int4 b, nt_int4 c, nt_int4 d)
{
	const uint32_t mask = NT_RESULT_COMPLEX | NT_RESULT_UNUSABLE;
	return (unsigned)((nt_state4(a) & mask) != 0) | (unsigned)((nt_state4(b) & mask) != 0) << 1 |
	       (unsigned)((nt_state4(c) & mask) != 0) << 2 | (unsigned)((nt_state4(d) & mask) != 0) << 3;
}

/* Copies the records of a triangle to its corners; returns the union of their bits. */
static inline nt_int4 copy_records(const char *from, unsigned shift, const uint32_t *v, float *out)
{
	nt_int4 a, b, c;
	memcpy(&a, from + ((size_t)v[0] << shift), sizeof a);
	memcpy(&b, from + ((size_t)v[1] << shift), sizeof b);
	memcpy(&c, from + ((size_t)v[2] << shift), sizeof c);
	memcpy(out, &a, sizeof a);
	memcpy(out + 4, &b, sizeof b);
	memcpy(out + 8, &c, sizeof c);
	return nt_or4(nt_or4(a, b), c);
}

/* A bit for each of four triangles whose flags say that it is no usual one. */
static inline unsigned find_special(const uint8_t *flags)
{
	/* moves the lowest bit of byte i, in the order of memory, to bit i of the highest byte */
	const uint32_t gather = NT_BIG_ENDIAN ? 0x08040201u : 0x01020408u;
	static_assert(NT_TRIANGLE_ANY >> 1 == 1 && NT_TRIANGLE_DEGENERATE >> 2 == 1, "both become the lowest bit");
	uint32_t four;
	memcpy(&four, flags, sizeof four);
	return ((four >> 1 | four >> 2) & 0x01010101u) * gather >> 24;
}

/* The same without quads, tangents only: no triangles share corners, so that what some of them need can wait. All
 * corners of BATCH triangles at a time get their records, without a branch, and then come those for which this was not
 * the result. On makehuman_body, where these are few, it takes 5.0 cycles a triangle instead of the 7.0 of one loop, on
 * Lantern 6.5 instead of 8.0; the 3 stores alone take 3 (Zen 4, in the cache). */
static void write_plain(nt_fast *fast, size_t begin, size_t end)
{
	static_assert(sizeof(nt_record) == 1 << 4, "what is shifted");
	const char *const records[2] = {(const char *)fast->records[!fast->records[0]],
		(const char *)fast->records[fast->records[1] != NULL]};
	const unsigned shift = fast->record_step == 1 ? 4 : 5;
	const uint32_t *v = fast->triangles.ids + 3 * begin;
	const uint8_t *const flags = fast->flags;
	float *out = fast->solve->tangents + 12 * begin;
	size_t t = begin;
	while (t + 4 <= end) {
		const size_t first = t, last = end - first < BATCH ? end - 3 : first + BATCH;
		uint64_t others = 0;
		for (; t < last; t += 4, v += 12, out += 48) {
			const nt_int4 a = copy_records(records[flags[t] & NT_TRIANGLE_ORIENT], shift, v, out);
			const nt_int4 b =
				copy_records(records[flags[t + 1] & NT_TRIANGLE_ORIENT], shift, v + 3, out + 12);
			const nt_int4 c =
				copy_records(records[flags[t + 2] & NT_TRIANGLE_ORIENT], shift, v + 6, out + 24);
			const nt_int4 d =
				copy_records(records[flags[t + 3] & NT_TRIANGLE_ORIENT], shift, v + 9, out + 36);
			others |= (uint64_t)(find_open(a, b, c, d) | find_special(flags + t)) << (t - first);
		}
		for (; others; others &= others - 1) {
			const size_t other = first + (size_t)nt_trailing_zeros(others);
			if (flags[other] & (NT_TRIANGLE_ANY | NT_TRIANGLE_DEGENERATE))
				write_special(fast, other);
			else
				write_signs(fast, other, fast->triangles.ids + 3 * other);
		}
	}
	write_triangles(fast, t, end);
}

/* For a sparse solve where each record is the result, and usable: suspects have their flags from step 4. Looking at all
 * triangles' records takes 6 of the 68 ms of processor time of a conversion of 980 000 triangles. */
static void write_suspects(nt_fast *fast, size_t begin, size_t end)
{
	for (size_t t = begin; (t = nt_next_flagged(fast->flags, t, end, NT_TRIANGLE_SUSPECT)) < end; t++)
		write_triangles(fast, t, t + 1);
}

typedef struct writing {
	nt_fast *fast;
	bool has_open; /* a record that is not the result, or not usable */
} writing;

static void write_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const writing *w = context;
	nt_fast *fast = w->fast;
	void (*write)(nt_fast *, size_t, size_t) = fast->sparse && !w->has_open ? write_suspects
		: fast->wants_more || fast->sparse || fast->triangles.cuts || fast->scattered ? write_triangles
		: write_plain;
	const unsigned ranges = fast->ranges.count;
	for (size_t range = begin; range < end; range++)
		for (size_t at = range; at < nt_sweeps(&fast->ranges) * ranges; at += ranges)
			write(fast, fast->ranges.bounds[at], fast->ranges.bounds[at + 1]);
}

void nt_fast_write(nt_fast *fast, const nt_settled *settled)
{
	const nt_known *known = fast->solve->known;
	writing w = {.fast = fast, .has_open = settled->complex_count > 0 || (known && known->open)};
	nt_parallel_ranges(fast->ranges.count, fast->ranges.count, 1, write_ranges, &w);
}

void nt_fast_write_rest(nt_fast *fast)
{
	fast->sparse = false;
	for (size_t t = 0; t < fast->triangle_count; t++)
		if (!(fast->flags[t] & NT_TRIANGLE_SUSPECT))
			write_triangles(fast, t, t + 1);
}

/* Without a sound triangle there is nothing but the default (step 10). */
void nt_fast_write_defaults(const nt_fast *fast)
{
	for (size_t c = 0; c < fast->solve->corner_count; c++)
		nt_fast_write_unassigned(fast, c);
}

/* The next triangle from t on that copies corners. */
static size_t next_copy(const nt_fast *fast, size_t t)
{
	return nt_next_flagged(fast->flags, t, fast->triangle_count, NT_TRIANGLE_COPY);
}

static void copy_corner(const nt_solve *solve, size_t to, size_t from)
{
	memcpy(solve->tangents + 4 * to, solve->tangents + 4 * from, 4 * sizeof(float));
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * to, solve->bitangents + 3 * from, 3 * sizeof(float));
	if (solve->magnitudes)
		memcpy(solve->magnitudes + 2 * to, solve->magnitudes + 2 * from, 2 * sizeof(float));
}

/* The first corners, among the sound triangles, of the vertices of all triangles that copy: [vertex_count], UINT32_MAX
 * where there is none. Results of other vertices are not there. */
static uint32_t *find_first_corners(const nt_fast *fast)
{
	uint32_t *first = nt_scratch_alloc(fast->solve->scratch, fast->vertex_count, sizeof *first);
	uint8_t *wanted = nt_scratch_alloc(fast->solve->scratch, fast->vertex_count, 1);
	if (!first || !wanted)
		return NULL;
	memset(wanted, 0, fast->vertex_count);
	size_t left = 0;
	for (size_t t = next_copy(fast, 0); t < fast->triangle_count; t = next_copy(fast, t + 1))
		for (size_t i = 3 * t; i < 3 * t + 3; i++) {
			const uint32_t v = nt_fast_vertex(fast, i);
			left += !wanted[v];
			wanted[v] = true;
			first[v] = UINT32_MAX;
		}
	for (size_t t = 0; left > 0 && t < fast->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		if (!(wanted[v[0]] | wanted[v[1]] | wanted[v[2]]) || fast->flags[t] & NT_TRIANGLE_DEGENERATE)
			continue;
		for (size_t k = 0; k < 3; k++) {
			if (wanted[v[k]])
				first[v[k]] = (uint32_t)nt_fast_corner(fast, 3 * t + k);
			left -= wanted[v[k]];
			wanted[v[k]] = 0;
		}
	}
	return first;
}

static bool same_position(const nt_fast *fast, size_t i, size_t j)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	const float *a = nt_position(mesh, nt_vertex_of(mesh, nt_fast_corner(fast, i)));
	const float *b = nt_position(mesh, nt_vertex_of(mesh, nt_fast_corner(fast, j)));
	return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* The vertex outside the sound half of a quad takes the result at its position. */
static void copy_from_half(const nt_fast *fast, size_t t)
{
	const size_t sound = fast->flags[t] & NT_TRIANGLE_SECOND ? t - 1 : t + 1;
	for (size_t i = 3 * t; i < 3 * t + 3; i++) {
		const size_t corner = nt_fast_corner(fast, i);
		size_t j = 3 * sound;
		while (j < 3 * sound + 3 && nt_fast_corner(fast, j) != corner)
			j++;
		if (j < 3 * sound + 3)
			continue;
		for (j = 3 * sound; j < 3 * sound + 3; j++)
			if (same_position(fast, i, j)) {
				copy_corner(fast->solve, corner, nt_fast_corner(fast, j));
				break;
			}
	}
}

/* Degenerate triangles whose answer depends on a corner. Sources are corners of sound triangles, so the
 * order of copying does not matter. */
nmtan_status nt_fast_write_copies(nt_fast *fast)
{
	const uint32_t *first = NULL;
	for (size_t t = next_copy(fast, 0); t < fast->triangle_count; t = next_copy(fast, t + 1)) {
		if (has_sound_half(fast, t)) {
			copy_from_half(fast, t);
			continue;
		}
		if (!first && !(first = find_first_corners(fast)))
			return NMTAN_ERROR_MEMORY;
		for (size_t i = 3 * t; i < 3 * t + 3; i++)
			if (first[nt_fast_vertex(fast, i)] != UINT32_MAX)
				copy_corner(fast->solve, nt_fast_corner(fast, i), first[nt_fast_vertex(fast, i)]);
	}
	return NMTAN_OK;
}
