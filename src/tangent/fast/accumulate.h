/* SPDX-License-Identifier: MIT */
/*
 * The first pass: frames and weights of 32 triangles (lanes.h), their flags (parts.h), then, one triangle after the
 * other, the addition to the records of the vertices and the entry in each vertex's fan. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_ACCUMULATE_H
#define NT_TANGENT_FAST_ACCUMULATE_H

#include <math.h>
#include <stdbool.h>
#include "tangent/fast/lanes.h"
#include "topology/corners.h"

/* ---- flags: orientation, "any", degenerate, uncertain ---- */

/* Both halves of a quad take the orientation of one of them: step 4. */
static void orient_quads(uint8_t *flags, size_t count, const float *area)
{
	for (size_t i = 0; i + 1 < count; i++) {
		uint8_t *a = &flags[i], *b = &flags[i + 1];
		if (!(*b & NT_TRIANGLE_SECOND) || ((*a | *b) & NT_TRIANGLE_DEGENERATE) ||
			!((*a ^ *b) & NT_TRIANGLE_ORIENT))
			continue;
		*a |= NT_TRIANGLE_UNCERTAIN, *b |= NT_TRIANGLE_UNCERTAIN; /* folded */
		if ((*b & NT_TRIANGLE_ANY) || fabsf(area[i]) >= fabsf(area[i + 1]))
			*b ^= NT_TRIANGLE_ORIENT;
		else
			*a ^= NT_TRIANGLE_ORIENT;
	}
}

/* Clears triangles whose UV area is exactly 0, whatever is rounded and as stored too: two texture coordinates are the
 * same, or all lie along an axis. Others stay uncertain. */
static void NT_NOINLINE clear_flat(const lanes_in *in, uint8_t *flags, size_t count)
{
	const float (*a)[NT_TRIANGLES] = in->row[0] + 6, (*b)[NT_TRIANGLES] = in->row[1] + 6,
		(*c)[NT_TRIANGLES] = in->row[2] + 6;
	for (size_t i = 0; i < count; i++) {
		const int ab_u = a[0][i] == b[0][i], ac_u = a[0][i] == c[0][i], bc_u = b[0][i] == c[0][i];
		const int ab_v = a[1][i] == b[1][i], ac_v = a[1][i] == c[1][i], bc_v = b[1][i] == c[1][i];
		const int flat = (ab_u & ab_v) | (ac_u & ac_v) | (bc_u & bc_v) | (ab_u & ac_u) | (ab_v & ac_v);
		flags[i] &= (uint8_t)~(flat ? NT_TRIANGLE_UNCERTAIN : 0);
	}
}

/* Flags of lanes that are not plain; true where all of them are ordinary triangles with a frame. */
static bool NT_NOINLINE classify_special(uint8_t *flags, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	int special = 0;
	for (size_t i = 0; i < count; i++)
		special |= out->degenerate[i] | !out->sound[i];
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) | (out->area[i] > 0.0f ? NT_TRIANGLE_ORIENT : 0) |
				     (out->frameless[i] ? NT_TRIANGLE_ANY : 0) |
				     (out->degenerate[i] ? NT_TRIANGLE_DEGENERATE : 0) |
				     (out->doubt[i] < 0.0f && !out->frameless[i] ? 0 : NT_TRIANGLE_UNCERTAIN));
	if (special)
		clear_flat(in, flags, count);
	return !special;
}

static inline NT_ALWAYS_INLINE void classify_plain(uint8_t *NT_RESTRICT flags, size_t count,
	const lanes_out *NT_RESTRICT out)
{
	for (size_t i = 0; i < count; i++)
		flags[i] = (uint8_t)((flags[i] & NT_TRIANGLE_SECOND) |
			(bits_of(out->area[i]) >> 31 ^ NT_TRIANGLE_ORIENT) |
				     (~bits_of(out->doubt[i]) >> 24 & NT_TRIANGLE_UNCERTAIN));
}

/* Flags of the lanes; true where all of them are ordinary triangles with a frame. */
static inline bool classify_lanes(const nt_fast *fast, size_t first, size_t count, const lanes_in *in,
	const lanes_out *out)
{
	uint8_t *flags = fast->flags + first;
	bool ordinary = out->plain;
	if (!ordinary)
		ordinary = classify_special(flags, count, in, out);
	else if (count == NT_TRIANGLES)
		classify_plain(flags, NT_TRIANGLES, out);
	else
		classify_plain(flags, count, out);
	if (fast->triangles.cuts)
		orient_quads(flags, count, out->area);
	return ordinary;
}

/* ---- records and fans ---- */

/* Corners by which a place in a bin is prefetched before it is written: some cache lines. */
enum { BIN_AHEAD = 12 };

static inline void add_record(nt_record *record, const float *add)
{
	nt_int4 sum;
	memcpy(&sum, add, sizeof sum);
	nt_record_add(record, sum);
}

/* The contribution of a corner: that of corner k of the triangle whose rows lie at `place`. */
typedef struct addition {
	const float *sum, *more[2];
} addition;

static inline addition addition_of(const lanes_out *out, size_t k, size_t place)
{
	return (addition){out->add[k] + 4 * place, {out->more[k][0] + 4 * place, out->more[k][1] + 4 * place}};
}

static inline nt_record_more more_of(const addition *add)
{
	nt_record_more more;
	memcpy(&more, add->more[0], sizeof more / 2);
	memcpy((char *)&more + sizeof more / 2, add->more[1], sizeof more / 2);
	return more;
}

static inline void add_more(nt_record_more *record, const addition *add)
{
	const nt_record_more more = more_of(add);
	nt_record_more_add(record, &more);
}

/* A corner of a hub, or of a vertex that an earlier range adds to. */
static void NT_NOINLINE add_unusual(nt_fast *fast, unsigned range, uint32_t vertex,
	uint32_t cursor, int orient, nt_fan_entry entry, const addition *add)
{
	if (!(cursor & NT_CURSOR_HUB))
		nt_adjacency_store(&fast->adjacency, cursor, entry);
	if (fast->deferred && cursor & NT_CURSOR_SHARED) {
		nt_deferred *d = &fast->deferred[range];
		const size_t i = d->count++;
		d->to[i] = vertex | (uint32_t)orient << 31;
		memcpy(&d->add[i], add->sum, sizeof *d->add);
		if (d->more)
			d->more[i] = more_of(add);
		return;
	}
	add_record(&fast->records[orient][vertex], add->sum);
	if (fast->wants_more)
		add_more(&fast->more[orient][vertex], add);
}

/* Writes a corner down in its vertex's bin. */
static inline void bin_corner(const nt_bins *bins, uint32_t *cursors, uint32_t vertex, uint32_t orient,
	uint32_t next, uint32_t previous, const float *add)
{
	const uint32_t lane = vertex & (((uint32_t)1 << bins->vertex_bits) - 1);
	const size_t at = cursors[vertex >> bins->vertex_bits]++;
	const nt_int4 tag = {0, 0, 0, (int)(orient << 31 | lane << NT_BINNED_SHIFT)};
	nt_int4 sum;
	memcpy(&sum, add, sizeof sum);
	sum = nt_or4(sum, tag);
	NT_PREFETCH_TO_WRITE(&bins->sums[at + BIN_AHEAD]);
	NT_PREFETCH_TO_WRITE(&bins->entries[NT_BINNED_ENTRY * (at + 2 * BIN_AHEAD)]);
	memcpy(&bins->sums[at], &sum, sizeof sum);
	nt_binned_store(bins->entries + NT_BINNED_ENTRY * at, next, previous);
}

/* One corner, whatever its vertex is. */
static void add_corner(nt_fast *fast, unsigned range, uint32_t vertex, int orient, nt_fan_entry entry,
	addition add)
{
	const nt_adjacency *a = &fast->adjacency;
	if (fast->bins.cursors) {
		bin_corner(&fast->bins, fast->bins.cursors + range * fast->bins.count, vertex, (uint32_t)orient,
			entry.next & NT_ENTRY_VERTEX, entry.previous & NT_ENTRY_VERTEX, add.sum);
		return;
	}
	const uint32_t place = nt_adjacency_next(a, &a->cursors[range * a->vertex_count + vertex]);
	if (place >= NT_CURSOR_SHARED) {
		add_unusual(fast, range, vertex, place, orient, entry, &add);
		return;
	}
	nt_adjacency_store(a, place, entry);
	add_record(&fast->records[orient][vertex], add.sum);
	if (fast->wants_more)
		add_more(&fast->more[orient][vertex], &add);
}

/* Orientation of the record that takes note of an "any" triangle: any that exists. */
static int any_record(const nt_fast *fast, int orient)
{
	return fast->records[orient] || !fast->records[!orient] ? orient : !orient;
}

/* A triangle of vertices v and one of change_special()'s orientations. */
static void add_triangle(nt_fast *fast, unsigned range, unsigned orient, const uint32_t *v, size_t lane,
	const lanes_out *out)
{
	const uint32_t bit = orient << 31;
	for (size_t k = 0; k < 3; k++)
		add_corner(fast, range, v[k], any_record(fast, (int)orient),
			(nt_fan_entry){v[(k + 1) % 3] | bit, v[(k + 2) % 3] | bit},
			addition_of(out, k, turned_place(lane)));
}

/* Adds a corner to its vertex's record, or puts it aside if an earlier range has the vertex. */
static inline NT_ALWAYS_INLINE void add_or_defer(nt_record *records, uint32_t vertex, uint32_t cursor, uint32_t bit,
	const float *add, nt_deferred *deferred)
{
	if (!deferred->to || !(cursor & NT_CURSOR_SHARED)) {
		add_record(records + vertex, add);
		return;
	}
	deferred->to[deferred->count] = vertex | bit;
	memcpy(&deferred->add[deferred->count++], add, sizeof *deferred->add);
}

/* Triangles that are not degenerate, lanes [i, end), up to the first with a corner that has no narrow entry left, or
 * whose cursor has a flag, if these are not looked at one by one: its lane, or `end`. Entries are moved as words, and
 * nothing is called, so that nearly all the loop needs is in registers: all of it if there is one orientation only. */
static inline NT_ALWAYS_INLINE size_t add_usual(const nt_fast *fast, unsigned range, const uint8_t *flags,
	size_t i, size_t end, const uint32_t *ids, const lanes_out *out, bool is_narrow, bool are_flagged,
	bool are_alike)
{
	nt_deferred deferred = {.to = NULL};
	if (are_flagged && fast->deferred)
		deferred = fast->deferred[range];
	const nt_adjacency *const adjacency = &fast->adjacency;
	const uint32_t step = is_narrow ? adjacency->step : NT_FAN_LANES, full = NT_FAN_DEPTH * step;
	uint32_t *const narrow = adjacency->narrow;
	uint32_t *const cursors = adjacency->cursors + range * adjacency->vertex_count;
	nt_fan_entry *const entries = adjacency->entries;
	nt_record *const records[2] = {fast->records[!fast->records[0]], fast->records[1]}; /* any_record() */
	const size_t first_orient = flags[i] & NT_TRIANGLE_ORIENT;
	nt_record *const first_to = records[first_orient];
	for (ids += 3 * i; i < end; i++, ids += 3) {
		const uint32_t a = ids[0], b = ids[1], c = ids[2];
		const uint32_t pa = cursors[a], pb = cursors[b], pc = cursors[c];
		if (is_narrow ? pa >= full || pb >= full || pc >= full
			: are_flagged == ((pa | pb | pc) < NT_CURSOR_FLAGGED))
			break;
		cursors[a] = pa + (are_flagged && pa & NT_CURSOR_HUB ? 0 : step);
		cursors[b] = pb + (are_flagged && pb & NT_CURSOR_HUB ? 0 : step);
		cursors[c] = pc + (are_flagged && pc & NT_CURSOR_HUB ? 0 : step);
		const size_t orient = are_alike ? first_orient : flags[i] & NT_TRIANGLE_ORIENT;
		nt_record *const to = are_alike ? first_to : records[orient];
		const float *add = out->add[0] + turned_rows[i];
		if (are_flagged) {
			const uint32_t bit = (uint32_t)(to == fast->records[1]) << 31;
			add_or_defer(to, a, pa, bit, add, &deferred);
			add_or_defer(to, b, pb, bit, add + 4 * NT_TRIANGLES, &deferred);
			add_or_defer(to, c, pc, bit, add + 8 * NT_TRIANGLES, &deferred);
		} else {
			add_record(to + a, add);
			add_record(to + b, add + 4 * NT_TRIANGLES);
			add_record(to + c, add + 8 * NT_TRIANGLES);
		}
		if (is_narrow) {
			const uint64_t all = (-(uint64_t)orient & 0x8000800080008000u) | (a | b << 16) |
				(uint64_t)(c | a << 16) << 32;
			narrow[pa] = (uint32_t)(all >> 16);
			narrow[pb] = (uint32_t)(all >> 32);
			narrow[pc] = (uint32_t)all;
			continue;
		}
		const uint64_t bits = -(uint64_t)orient & ((uint64_t)NT_ENTRY_ORIENT << 32 | NT_ENTRY_ORIENT);
		uint64_t ab, bc;
		memcpy(&ab, ids, sizeof ab);
		memcpy(&bc, ids + 1, sizeof bc);
		ab |= bits;
		bc |= bits;
		const uint64_t ca = NT_BIG_ENDIAN ? bc << 32 | ab >> 32 : bc >> 32 | ab << 32;
		if (!(are_flagged && pa & NT_CURSOR_HUB))
			memcpy(&entries[are_flagged ? pa & NT_CURSOR_PLACE : pa], &bc, sizeof bc);
		if (!(are_flagged && pb & NT_CURSOR_HUB))
			memcpy(&entries[are_flagged ? pb & NT_CURSOR_PLACE : pb], &ca, sizeof ca);
		if (!(are_flagged && pc & NT_CURSOR_HUB))
			memcpy(&entries[are_flagged ? pc & NT_CURSOR_PLACE : pc], &ab, sizeof ab);
	}
	if (are_flagged && fast->deferred)
		fast->deferred[range].count = deferred.count;
	return i;
}

typedef size_t usual_adder(const nt_fast *fast, unsigned range, const uint8_t *flags, size_t i, size_t end,
	const uint32_t *ids, const lanes_out *out);

#define ADD_USUAL(name, ...) \
	static size_t NT_NOINLINE name(const nt_fast *fast, unsigned range, const uint8_t *flags, size_t i, \
		size_t end, const uint32_t *ids, const lanes_out *out) \
	{ \
		return add_usual(fast, range, flags, i, end, ids, out, __VA_ARGS__); \
	}
ADD_USUAL(add_here, false, false, false)
ADD_USUAL(add_flagged, false, true, false)
ADD_USUAL(add_narrow, true, false, false)
#ifndef NT_SMALL_CODE
ADD_USUAL(add_alike_here, false, false, true)
ADD_USUAL(add_alike_narrow, true, false, true)

/* Whether triangles [i, end) have one orientation. */
static bool are_one_sided(const uint8_t *flags, size_t i, size_t end)
{
	const uint64_t ones = 0x0101010101010101u, first = ones * (flags[i] & NT_TRIANGLE_ORIENT);
	uint64_t others = 0;
	for (uint64_t eight; i + sizeof eight <= end; i += sizeof eight) {
		memcpy(&eight, flags + i, sizeof eight);
		others |= eight ^ first;
	}
	for (; i < end; i++)
		others |= flags[i] ^ first;
	return !(others & ones * NT_TRIANGLE_ORIENT);
}
#endif

/* Triangles that are not degenerate, lanes [begin, end). */
static void add_ordinary(nt_fast *fast, unsigned range, const uint8_t *flags, size_t begin, size_t end,
	const uint32_t *ids, const lanes_out *out)
{
	const bool is_narrow = nt_adjacency_is_narrow(&fast->adjacency);
	usual_adder *here = is_narrow ? add_narrow : add_here;
	size_t i = begin;
	if (begin == end)
		return;
#ifndef NT_SMALL_CODE
	/* not where each byte is sent to a browser */
	if (NT_NARROW_LIMIT > 0 && are_one_sided(flags, begin, end))
		here = is_narrow ? add_alike_narrow : add_alike_here;
#endif
	if (!is_narrow && !fast->wants_more) {
		while (i < end) {
			i = here(fast, range, flags, i, end, ids, out);
			if (i < end)
				i = add_flagged(fast, range, flags, i, end, ids, out);
		}
		return;
	}
	for (; i < end; i++) {
		if (!fast->wants_more)
			i = here(fast, range, flags, i, end, ids, out);
		if (i < end)
			add_triangle(fast, range, flags[i] & NT_TRIANGLE_ORIENT, ids + 3 * i, i, out);
	}
}

/* The same into bins. */
static void NT_NOINLINE bin_ordinary(const nt_fast *fast, unsigned range, size_t first, size_t begin,
	size_t end, const uint32_t *ids, const lanes_out *out)
{
	const nt_bins bins = fast->bins;
	uint32_t *const cursors = bins.cursors + range * bins.count;
	unsigned seen = 0;
	for (size_t i = begin; i < end; i++) {
		const uint32_t *v = ids + 3 * i;
		const uint32_t orient = fast->flags[first + i] & NT_TRIANGLE_ORIENT;
		const size_t place = 4 * turned_place(i);
		bin_corner(&bins, cursors, v[0], orient, v[1], v[2], out->add[0] + place);
		bin_corner(&bins, cursors, v[1], orient, v[2], v[0], out->add[1] + place);
		bin_corner(&bins, cursors, v[2], orient, v[0], v[1], out->add[2] + place);
		seen |= fast->flags[first + i] & NT_TRIANGLE_ANY ? NT_SEEN_ANY : NT_SEEN(orient);
	}
	/* stored where it changes: those of other ranges are in the same cache line */
	if (seen & ~(unsigned)bins.seen[range])
		bins.seen[range] |= (uint8_t)seen;
}

/* Changes what triangles add that are not ordinary: one without a frame adds a note, and of others the bounds of the
 * lanes may not hold. `flags` receives theirs, without an orientation where there is no frame. */
static void NT_NOINLINE change_special(const nt_fast *fast, size_t first, size_t count, lanes_out *out, uint8_t *flags)
{
	static const nt_record note = {.state = NT_STATE_BASE | (NT_STATE_ALL & ~NT_STATE_NO_ANY)};
	static const uint32_t unsound = NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL;
	int sound = 1;
	uint64_t any = nt_fast_flagged(fast->flags + first, count, NT_TRIANGLE_ANY);
	for (size_t i = 0; i < count; i++) {
		flags[i] = (uint8_t)(fast->flags[first + i] & ~(any >> i & NT_TRIANGLE_ORIENT));
		sound &= out->sound[i] | (int)(any >> i & 1);
	}
	for (size_t i = 0; !sound && i < count; i++)
		for (int k = 0; k < 3 && !out->sound[i]; k++)
			memcpy(out->add[k] + 4 * turned_place(i) + 3, &unsound, sizeof unsound);
	for (; any; any &= any - 1) {
		const size_t place = 4 * turned_place((size_t)nt_trailing_zeros(any));
		for (int k = 0; k < 3; k++)
			memcpy(out->add[k] + place, &note, sizeof note);
		for (int k = 0; k < 3 && fast->wants_more; k++) {
			memset(out->more[k][0] + place, 0, sizeof note);
			memset(out->more[k][1] + place, 0, sizeof note);
		}
	}
}

/* Puts voids into the fans at the corners of a degenerate triangle. */
static void NT_NOINLINE add_voids(const nt_fast *fast, unsigned range, const uint32_t *v)
{
	const nt_adjacency *a = &fast->adjacency;
	for (int k = 0; k < 3 && !fast->bins.cursors; k++) {
		const uint32_t place = nt_adjacency_next(a, &a->cursors[range * a->vertex_count + v[k]]);
		const uint32_t number = NT_ENTRY_VOID | 2 * ((place & NT_CURSOR_PLACE) / a->step);
		if (!(place & NT_CURSOR_HUB))
			nt_adjacency_store(a, place, (nt_fan_entry){number, number + 1});
	}
}

/* The orientation of a record array that these triangles need and that does not exist; -1: none. */
static int missing_record(const nt_fast *fast, size_t first, size_t count)
{
	if (fast->bins.cursors || (fast->records[0] && fast->records[1]))
		return -1;
	/* nearly always all have the one orientation that there are records of: eight flags at a time */
	const uint64_t ones = 0x0101010101010101u, there = ones * (fast->records[1] ? NT_TRIANGLE_ORIENT : 0);
	const uint64_t others = ones * (NT_TRIANGLE_ORIENT | NT_TRIANGLE_ANY | NT_TRIANGLE_DEGENERATE);
	size_t i = 0;
	for (uint64_t eight; fast->records[there != 0] && count - i >= sizeof eight;
		i += sizeof eight) {
		memcpy(&eight, fast->flags + first + i, sizeof eight);
		if ((eight ^ there) & others)
			break;
	}
	for (; i < count; i++) {
		const uint8_t flags = fast->flags[first + i];
		int orient = flags & NT_TRIANGLE_ORIENT;
		if (flags & NT_TRIANGLE_DEGENERATE)
			continue;
		if (flags & NT_TRIANGLE_ANY)
			orient = any_record(fast, orient);
		if (!fast->records[orient])
			return orient;
	}
	return -1;
}

/* Scattered vertices: the rows of corner k of the batch after the next. A third at a time, since no more misses
 * than that can be under way. Always inline: to gcc 12 a function of prefetches alone has no effect, and goes. */
static inline NT_ALWAYS_INLINE void prefetch_rows(const nt_fast *fast, size_t first, size_t end, size_t k)
{
	const size_t far = first + 2 * NT_TRIANGLES < end ? first + 2 * NT_TRIANGLES : end;
	const size_t count = end - far < NT_TRIANGLES ? end - far : NT_TRIANGLES;
	uint32_t copy[3 * NT_TRIANGLES];
	const uint32_t *ids = nt_triangle_vertices(&fast->triangles, far, count, copy) + k;
	for (size_t i = 0; i < count; i++)
		NT_PREFETCH(&fast->rows[ids[3 * i]]);
}

/* Which triangles have a corner near the last ones (topology/edge_sort.h). */
static inline uint32_t near_triangles(const nt_edge_tail *tail, const lanes_in *in, size_t count)
{
	uint32_t near = 0;
#if WIDTH == 16
	const __m512 low = _mm512_set1_ps(tail->grid.low), scale = _mm512_set1_ps(tail->scale);
	const __m512i half = _mm512_loadu_si512(tail->bins), other = _mm512_loadu_si512(tail->bins + 16);
	const __m512i in_word = _mm512_set1_epi32(31), one = _mm512_set1_epi32(1);
	for (size_t i = 0; i < count; i += WIDTH) {
		__m512i bits = _mm512_setzero_si512();
		for (int k = 0; k < 3; k++) {
			const __m512 x = _mm512_load_ps(in->row[k][tail->grid.axis] + i);
			const __m512i bin = _mm512_cvttps_epi32(_mm512_mul_ps(_mm512_sub_ps(x, low), scale));
			const __m512i word = _mm512_permutex2var_epi32(half, _mm512_srli_epi32(bin, 5), other);
			bits = _mm512_or_si512(bits, _mm512_srlv_epi32(word, _mm512_and_si512(bin, in_word)));
		}
		near |= (uint32_t)_mm512_test_epi32_mask(bits, one) << i;
	}
#else
	for (size_t i = 0; i < count; i++)
		for (int k = 0; k < 3; k++)
			near |= (uint32_t)nt_edge_is_near(tail, in->row[k][tail->grid.axis][i]) << i;
#endif
	return near & UINT32_MAX >> (NT_EDGE_NOTE_MOST - count);
}

static void kernel_accumulate(nt_fast *fast, size_t begin, size_t end, unsigned range, nt_record_maker *make,
	void *context)
{
	lanes_in in;
	lanes_out out;
	const float offset = nt_stored_v_offset(fast->solve->mesh);
	const bool scattered = fast->scattered;
	const unsigned part = fast->sweep * fast->ranges.count + range;
	nt_edge_note *note = fast->tail->notes ? nt_edge_notes(fast->tail, part) : NULL;
	static_assert((int)NT_EDGE_NOTE_MOST == NT_TRIANGLES && (int)NT_EDGE_NOTE_LEAST == NT_TRIANGLES - 1, "a batch");
	for (size_t first = begin, count; first < end; first += count) {
		count = end - first < NT_TRIANGLES ? end - first : NT_TRIANGLES;
		if (first + count < end && (fast->flags[first + count] & NT_TRIANGLE_SECOND))
			count--; /* halves of a quad stay together */
		if (scattered)
			prefetch_rows(fast, first, end, 0);
		uint32_t copy[3 * NT_TRIANGLES];
		const uint32_t *ids = nt_triangle_vertices(&fast->triangles, first, count, copy);
		gather_lanes(fast->rows, ids, count, whole_lanes(count), in.row[0][0], NT_TRIANGLES);
		if (note) {
			*note = (nt_edge_note){(uint32_t)first, near_triangles(fast->tail, &in, count)};
			note += note->triangles != 0;
		}
		if (scattered)
			prefetch_rows(fast, first, end, 1);
		solve_lanes(&in, &out, count);
		if (fast->wants_more)
			solve_more(&in, &out, count);
		judge(&in, &out, offset, fast->wants_more, count);
		if (scattered)
			prefetch_rows(fast, first, end, 2);
		const bool ordinary = classify_lanes(fast, first, count, &in, &out);
		uint8_t changed[NT_TRIANGLES];
		const uint8_t *const flags = ordinary ? fast->flags + first : changed;
		if (!ordinary)
			change_special(fast, first, count, &out, changed);
		for (int missing; (missing = missing_record(fast, first, count)) >= 0;)
			if (!make(fast, missing, range, context))
				return;
		for (size_t i = 0; i < count; i++) {
			const size_t from = i;
			i = ordinary ? count : nt_next_flagged(flags, i, count, NT_TRIANGLE_DEGENERATE);
			if (fast->bins.cursors)
				bin_ordinary(fast, range, first, from, i, ids, &out);
			else
				add_ordinary(fast, range, flags, from, i, ids, &out);
			if (i < count)
				add_voids(fast, range, ids + 3 * i);
		}
	}
	if (note)
		note->triangles = 0;
}

#endif
