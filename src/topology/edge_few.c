/* SPDX-License-Identifier: MIT */
/*
 * The question of edge_tail.c, asked of the last triangles alone: it is nearly always answered with no. No pass goes
 * over all triangles, unless they are few and an old vertex shares its cell.
 *
 * The last run has one edge of each triangle with X, the vertex of the largest lower end, and a vertex above. Its order
 * can only matter if X is in two triangles with one above, and in a third one with one above: the same, or another that
 * no triangle has with the first, because none has two above X. The corners around these vertices are in the adjacency,
 * which the sums have made. This file looks for three such vertices of the last triangles, and finds representatives,
 * which are between first and last corners, as long as they decide it.
 */
#include "topology/inside.h"

#include <math.h>
#include <string.h>
#include "base/compiler.h"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

enum {
	MOST_ROWS = 3 * NT_EDGE_FEW,
	FIRST = 4, /* triangles at the end that are looked at first, and at most */
	MOST = 10,
	MOST_SLOTS = 3 * MOST,
	PLACES = 2048,     /* of vertices, by their lowest bits */
	MOST_IN_CELL = 511, /* vertices; and of a part that is halved */
	MOST_IN_PART = 63,
	MOST_FINDS = 3,    /* cells of which all corners are listed */
	BLOCK = 32,        /* rows that are cleared, or compared, at a time */
	LANES = 4
};

/* Corners have the numbers 4 * triangle + k. Vertices of the last triangles have slots, from 1 on, and bits of slots
 * are sets of them. */
typedef struct few {
	const nt_welded_mesh *mesh;
	const uint32_t *ids;
	nt_grid grid;
	bool is_grid_of_used, are_many;
	uint32_t count, first;       /* triangles; the first of the last ones */
	uint32_t least;              /* what the largest lower end is at least */
	uint32_t slot_count, finds;
	uint32_t high_ones;          /* those that may be the largest lower end, or above */
	uint32_t vertices[MOST_SLOTS + 1];
	uint32_t low[MOST_SLOTS + 1], high[MOST_SLOTS + 1]; /* the representative is between */
	uint32_t seen[MOST_SLOTS + 1]; /* corners in the last triangles: how many, and a bit for each */
	uint64_t corners[MOST_SLOTS + 1];
	uint32_t most[MOST_SLOTS + 1]; /* what the largest lower end is at least if this one is above it */
	uint32_t beside[MOST_SLOTS + 1][NT_LEAST_EDGES]; /* neighbours in so many triangles, or more */
	uint32_t bits[PLACES];       /* of vertices, of which many have one place: 1: in no last triangle */
} few;

/* The slot of a vertex of the last triangles. */
static uint32_t last_slot(const few *f, uint32_t vertex)
{
	return (uint32_t)nt_trailing_zeros(f->bits[vertex % PLACES]);
}

static uint32_t slot_of(const few *f, uint32_t vertex)
{
	const uint32_t slot = last_slot(f, vertex);
	return f->vertices[slot] == vertex ? slot : 0;
}

/* Gives slots to the vertices of the last triangles, and finds their last corners, and the first ones of those that are
 * in no other triangle. */
static bool NT_NOINLINE take_last(few *f, uint32_t triangles)
{
	f->first = f->count > triangles ? f->count - triangles : 0;
	for (size_t v = 0; v < f->mesh->vertex_count && v < PLACES; v += BLOCK)
		for (size_t i = v; i < v + BLOCK; i++)
			f->bits[i] = 1;
	uint32_t count = 0;
	const uint32_t *v = f->ids + 3 * f->first;
	for (uint32_t c = 4 * f->first; c < 4 * f->count; c += 4, v += 3)
		for (uint32_t k = 0; k < 3; k++) {
			uint32_t *bit = &f->bits[v[k] % PLACES];
			if (*bit == 1) {
				count++;
				*bit = (uint32_t)1 << count;
				f->vertices[count] = v[k];
				f->seen[count] = 0;
				f->corners[count] = 0;
			}
			const uint32_t slot = (uint32_t)nt_trailing_zeros(*bit);
			if (f->are_many && f->vertices[slot] != v[k])
				return false;
			f->high[slot] = c + k;
			f->seen[slot]++;
			f->corners[slot] |= (uint64_t)1 << (c + k - 4 * f->first);
		}
	f->slot_count = count;
	f->vertices[0] = f->seen[0] = 0; /* of slot 0 nothing else is read */
	const nt_adjacency *a = f->mesh->adjacency;
	for (uint32_t i = 1; i <= count; i++) {
		const uint32_t cursor = a->cursors[f->vertices[i]];
		const uint32_t end = nt_adjacency_first(a, f->vertices[i]) + f->seen[i] * a->step;
		f->low[i] = cursor == end || cursor == (NT_CURSOR_HUB | f->seen[i])
			? 4 * f->first + (uint32_t)nt_trailing_zeros(f->corners[i]) : 0;
	}
	return true;
}

/* False: older triangles may have it. */
static bool find_least(few *f)
{
	uint32_t least = 0;
	/* the middle corner of a triangle is not above its second one */
	for (uint32_t t = f->count; t-- > f->first && 4 * t + 1 > least;) {
		const uint32_t *v = f->ids + 3 * t;
		const uint32_t low[3] = {
			f->low[last_slot(f, v[0])], f->low[last_slot(f, v[1])], f->low[last_slot(f, v[2])]};
		const uint32_t middle = nt_middle_of(low);
		if (middle > least && !nt_welded_is_degenerate(f->mesh, t, v))
			least = middle;
	}
	f->least = least;
	return least >= 4 * f->first;
}

/* Vertices that are in a triangle with one, or in two or three. */
typedef struct neighbours {
	uint32_t once, twice, often;
} neighbours;

static inline NT_ALWAYS_INLINE void add_neighbours(neighbours *n, uint32_t others)
{
	n->often |= n->twice & others;
	n->twice |= n->once & others;
	n->once |= others;
}

/* The neighbours of a vertex; none of a hub. */
static neighbours neighbours_of(const few *f, uint32_t vertex)
{
	const nt_adjacency *const a = f->mesh->adjacency;
	const uint32_t *const bits = f->bits;
	const uint32_t cursor = a->cursors[vertex], end = cursor & NT_CURSOR_HUB ? 0 : cursor, step = a->step;
	neighbours n = {0, 0, 0};
	uint32_t at = nt_adjacency_first(a, vertex);
#ifndef NT_SMALL_CODE
	/* few vertices have numbers below PLACES */
	for (; nt_adjacency_is_narrow(a) && !f->are_many && at < end; at += step) {
		const uint32_t both = a->narrow[at];
		if (!(both & NT_ENTRY_VOID >> 16))
			add_neighbours(&n, bits[both % PLACES] | bits[(both >> 16) % PLACES]);
	}
#endif
	for (; at < end; at += step) {
		nt_fan_entry entry;
		if (!nt_adjacency_load(a, at, &entry))
			continue;
		uint32_t others = bits[entry.next % PLACES] | bits[entry.previous % PLACES];
		if (f->are_many && others != 1)
			others = (uint32_t)1 << slot_of(f, entry.next) | (uint32_t)1 << slot_of(f, entry.previous);
		add_neighbours(&n, others);
	}
	return n;
}

/* Finds the neighbours of those that may be the largest lower end, or above. */
static void NT_NOINLINE find_beside(few *f)
{
	uint32_t high = 0, above = 0; /* certainly */
	for (uint32_t i = 1; i <= f->slot_count; i++) {
		high |= (uint32_t)(f->high[i] >= f->least) << i;
		above |= (uint32_t)(f->low[i] > f->least) << i;
	}
	f->high_ones = high;
	for (uint32_t left = high; left; left &= left - 1) {
		const uint32_t i = (uint32_t)nt_trailing_zeros(left);
		uint32_t most = f->least;
		const neighbours n = neighbours_of(f, f->vertices[i]);
		f->beside[i][0] = n.once & high;
		f->beside[i][1] = n.twice & high;
		f->beside[i][2] = n.often & high;
		for (uint32_t some = n.once & above; some; some &= some - 1)
			most = nt_most_of(most, f->low[nt_trailing_zeros(some)]);
		f->most[i] = most;
	}
}

/* A cell, as representatives.c halves it. Its vertices have numbers from 1 on. */
typedef struct few_cell {
	uint32_t count, wanted;               /* vertices; the one that is asked for */
	uint32_t names[MOST_IN_CELL + 1];     /* of vertices */
	nt_cell_vertex vertices[MOST_IN_CELL + 1];
	nt_cell_corner corners[MOST_ROWS + 1];
	uint32_t order[MOST_IN_CELL], swaps[MOST_ROWS];
	uint8_t below[MOST_IN_CELL + 1];
	nt_part parts[2 * MOST_IN_PART];
} few_cell;

/* Compares LANES rows, or the rest, with a coordinate: a bit for each that is near. */
static inline NT_ALWAYS_INLINE uint32_t near_rows(const float *x, size_t step, size_t left, float at, float reach)
{
#if defined(__SSE2__)
	if (left >= LANES) {
		const __m128 rows = _mm_setr_ps(x[0], x[step], x[2 * step], x[3 * step]);
		const __m128 distance = _mm_andnot_ps(_mm_set1_ps(-0.0f), _mm_sub_ps(rows, _mm_set1_ps(at)));
		return (uint32_t)_mm_movemask_ps(_mm_cmple_ps(distance, _mm_set1_ps(reach)));
	}
#endif
	uint32_t near = 0;
	for (size_t i = 0; i < LANES && i < left; i++)
		near |= (uint32_t)(fabsf(x[step * i] - at) <= reach) << i;
	return near;
}

/* Whether all vertices have corners. */
static bool are_used(const nt_adjacency *a, size_t vertices)
{
	bool used = true;
	size_t v = 0;
#if defined(__SSE2__)
	__m128i places = _mm_setr_epi32(0, 1, 2, 3), unused = _mm_setzero_si128();
	for (; nt_adjacency_is_narrow(a) && v + LANES <= vertices; v += LANES) {
		const __m128i cursors = _mm_loadu_si128((const __m128i *)(a->cursors + v));
		unused = _mm_or_si128(unused, _mm_cmpeq_epi32(cursors, places));
		places = _mm_add_epi32(places, _mm_set1_epi32(LANES));
	}
	used = _mm_movemask_epi8(unused) == 0;
#endif
	for (; v < vertices; v++)
		used &= a->cursors[v] != nt_adjacency_first(a, (uint32_t)v);
	return used;
}

/* Lists the vertices of a vertex's cell. False: they are too many. */
static bool list_vertices(few *f, uint32_t vertex, few_cell *cell)
{
	if (!f->is_grid_of_used && !are_used(f->mesh->adjacency, f->mesh->vertex_count))
		(void)nt_grid_of_used(f->mesh, &f->grid);
	f->is_grid_of_used = true;
	const nt_grid grid = f->grid;
	const size_t step = f->mesh->step, rows = f->mesh->vertex_count;
	const nt_adjacency *const a = f->mesh->adjacency;
	/* places of a vertex are few enough for floats to be divided as integers are */
	const float corners_a_place = 1.0f / (float)a->step;
	const float *x = f->mesh->positions + grid.axis, at = x[step * vertex];
	/* vertices farther apart are in two cells, whatever is rounded; if a box is so thin that this is 0, each float
	 * has a cell of its own */
	const float reach = (grid.high - grid.low) * (2.0f / (float)NT_CELLS);
	uint32_t count = 0;
	for (size_t row = 0; row < rows; row += LANES, x += LANES * step)
		for (uint32_t left = near_rows(x, step, rows - row, at, reach); left; left &= left - 1) {
			const uint32_t lane = (uint32_t)nt_trailing_zeros(left), v = (uint32_t)row + lane;
			const uint32_t cursor = a->cursors[v], places = cursor - nt_adjacency_first(a, v);
			const uint32_t corners = cursor & NT_CURSOR_HUB ? cursor & NT_CURSOR_PLACE
				: (uint32_t)(int)(((float)(int)places + 0.5f) * corners_a_place);
			const float other = x[step * lane];
			if (corners == 0 || (other != at && nt_grid_cell(&grid, other) != nt_grid_cell(&grid, at)))
				continue;
			if (count == MOST_IN_CELL)
				return false;
			cell->order[count] = count + 1;
			count++;
			/* a float more than a position, which is a vector then */
			memcpy(&cell->vertices[count], nt_welded_position(f->mesh, v), 4 * sizeof(float));
			cell->vertices[count].corners = corners;
			cell->names[count] = v;
			if (v == vertex)
				cell->wanted = count;
		}
	cell->count = count;
	return true;
}

/* Lists the corners of a cell's vertices. */
static void list_corners(const few *f, few_cell *cell)
{
	uint8_t owners[PLACES]; /* a vertex of the cell, or 0 */
	nt_cell_corner *corner = cell->corners;
	const uint32_t *v = f->ids;
	for (size_t i = 0; i < f->mesh->vertex_count; i += BLOCK)
		memset(owners + i, 0, BLOCK);
	for (uint32_t i = 1; i <= cell->count; i++)
		owners[cell->names[i]] = (uint8_t)i;
	for (uint32_t c = 0; c < 4 * f->count; c += 4, v += 3) {
		const uint32_t of[3] = {owners[v[0]], owners[v[1]], owners[v[2]]};
		if (!(of[0] | of[1] | of[2]))
			continue;
		for (uint32_t k = 0; k < 3; k++) {
			*corner = (nt_cell_corner){of[k], c + k};
			corner += of[k] != 0;
		}
	}
}

/* Lists the corners of a part of a cell, in which the vertex that is asked for, which only the last triangles have, is
 * in the same order: those below leave it, as long as none of these has a corner there and those corners stay where
 * they are. False: it is not known in which order older corners of several vertices are. */
static bool list_last_corners(const few *f, few_cell *cell, const nt_cells *cells, nt_part *part)
{
	uint32_t numbers[MOST_SLOTS + 1] = {0}, last = 0, older = 0, count = 0;
	for (uint32_t i = 1; i <= cell->count; i++)
		last += f->seen[slot_of(f, cell->names[i])];
	while (nt_cells_find_middle(cells, part)) {
		uint32_t kept = 0, below = 0, parted = 0;
		for (uint32_t i = 0; i < part->vertex_count; i++) {
			const uint32_t one = cell->order[i];
			if (cell->vertices[one].position[part->axis] < part->middle) {
				below += cell->vertices[one].corners;
				parted |= f->seen[slot_of(f, cell->names[one])];
			} else {
				cell->order[i] = cell->order[kept];
				cell->order[kept++] = one;
			}
		}
		if (parted || below + last > part->corner_count)
			break;
		part->vertex_count = kept;
		part->corner_count -= below;
	}
	for (uint32_t i = 0; i < part->vertex_count; i++) {
		const uint32_t one = cell->order[i], slot = slot_of(f, cell->names[one]);
		numbers[slot] = one;
		if (f->seen[slot] == cell->vertices[one].corners)
			continue;
		if (older)
			return false;
		older = one;
	}
	numbers[0] = 0;
	if (part->vertex_count > MOST_IN_PART || part->corner_count > MOST_ROWS)
		return false;
	for (; count + last < part->corner_count; count++)
		cell->corners[count] = (nt_cell_corner){older, 0};
	const uint32_t *v = f->ids + 3 * f->first;
	for (uint32_t c = 4 * f->first; c < 4 * f->count; c += 4, v += 3)
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t number = numbers[last_slot(f, v[k])];
			cell->corners[count] = (nt_cell_corner){number, c + k};
			count += number != 0;
		}
	return true;
}

/* Finds the representative of a vertex, from the last triangles' corners alone or from all. False: the cell has too
 * many vertices, or has to be halved too often, or the last triangles do not say. */
static bool NT_NOINLINE find(few *f, uint32_t slot, bool of_last)
{
	few_cell cell;
	/* many rows are not gone over more than once, nor for an old vertex, which they are unlikely to decide */
	if (f->are_many && (f->low[slot] < 4 * f->first || f->finds++ > 0))
		return false;
	if (!list_vertices(f, f->vertices[slot], &cell))
		return false;
	nt_part all = {.vertex_count = cell.count};
	nt_cells cells = {.vertices = cell.vertices, .corners = cell.corners, .order = cell.order,
		.below = cell.below, .swaps = cell.swaps, .parts = cell.parts, .part_count = 2 * MOST_IN_PART};
	for (uint32_t i = 1; i <= cell.count; i++)
		all.corner_count += cell.vertices[i].corners;
	if (cell.count == 1) {
		f->high[slot] = f->low[slot]; /* its first corner */
		return true;
	}
	if (!of_last && cell.count <= MOST_IN_PART)
		list_corners(f, &cell);
	else if (!of_last || f->low[slot] < 4 * f->first || !list_last_corners(f, &cell, &cells, &all))
		return false;
	if (!nt_cells_find(&cells, &all, cell.wanted))
		return false;
	f->low[slot] = f->high[slot] = nt_cells_found(&cells, cell.wanted);
	return true;
}

/* Whether a vertex may be the largest lower end, and two others above: one is in two triangles with it, and the other
 * in a third one. */
static bool may_be(const few *f, uint32_t middle, uint32_t end, uint32_t other)
{
	const uint32_t to = nt_least_of(f->high[end], f->high[other]);
	const uint32_t c = nt_most_of(nt_most_of(f->most[end], f->most[other]), f->low[middle]);
	if (c > f->high[middle] || c >= to)
		return false;
	/* both are of the last triangles, of which a word has all corners */
	const uint64_t below = ((uint64_t)1 << (to - 4 * f->first)) - 1;
	return f->high[middle] < to || (f->corners[middle] & below) >> (c - 4 * f->first);
}

/* The same once representatives that decide it are known. */
static bool NT_NOINLINE are(few *f, uint32_t middle, uint32_t end, uint32_t other)
{
	const uint32_t three[3] = {middle, end, other};
	for (int of_last = 1; of_last >= f->are_many; of_last--)
		for (int i = 0; i < 3; i++) {
			if (f->low[three[i]] == f->high[three[i]])
				continue;
			if ((!of_last && ++f->finds > MOST_FINDS) || (!find(f, three[i], of_last) && !of_last))
				return true;
			if (!may_be(f, middle, end, other))
				return false;
		}
	return true;
}

/* Whether the order may matter. */
static bool may_matter(few *f)
{
	for (uint32_t left = f->high_ones; left; left &= left - 1) {
		const uint32_t i = (uint32_t)nt_trailing_zeros(left);
		if (f->mesh->adjacency->cursors[f->vertices[i]] & NT_CURSOR_HUB) {
			if ((f->low[i] != f->high[i] && !find(f, i, f->are_many)) || f->high[i] >= f->least)
				return true;
			continue;
		}
		for (uint32_t ends = f->beside[i][1]; ends; ends &= ends - 1) {
			const uint32_t end = (uint32_t)nt_trailing_zeros(ends);
			if (f->high[end] <= f->most[end])
				continue;
			uint32_t others = f->beside[i][0] & ~f->beside[end][0] & ~((uint32_t)1 << end);
			others |= f->beside[i][2] & (uint32_t)1 << end;
			for (; others; others &= others - 1) {
				const uint32_t other = (uint32_t)nt_trailing_zeros(others);
				if (may_be(f, i, end, other) && are(f, i, end, other))
					return true;
			}
		}
	}
	return false;
}

bool nt_edges_are_sorted(const nt_welded_mesh *mesh, nt_grid grid, bool is_grid_of_used)
{
	few f;
	f.mesh = mesh;
	f.ids = mesh->triangles->ids;
	f.grid = grid;
	f.is_grid_of_used = is_grid_of_used;
	f.count = (uint32_t)mesh->triangle_count;
	f.are_many = mesh->vertex_count > PLACES || mesh->triangle_count > NT_EDGE_FEW;
	f.finds = 0;
	for (uint32_t triangles = FIRST; !take_last(&f, triangles) || !find_least(&f); triangles = MOST)
		if (triangles == MOST)
			return false;
	find_beside(&f);
	return !may_matter(&f);
}
