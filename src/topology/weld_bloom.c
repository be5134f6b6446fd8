/* SPDX-License-Identifier: MIT */
/*
 * The weld of a large indexed mesh, or of one whose corners have a vertex each. Nearly always no vertex is equal to
 * another, and the whole weld is to find that out: a Bloom filter does so without a table of the vertices.
 *
 *   load    each vertex's row; its hash marks two bits of a word in a bitmap (a Bloom filter of one word). A
 *           vertex that finds both marked already may equal an earlier one: the bits are marked in a second bitmap
 *   list    the vertices whose bits the second bitmap has: all that are equal to another, those with a NaN,
 *           and some by chance
 *   weld    the listed ones, by the table (weld_table.c)
 *
 * A bitmap is a quarter of the table at most and stays in the second-level cache where the table does not.
 * A mesh that turns out to have many equal vertices is left
 * to the table. Threads have bitmaps of their own for their ranges of vertices; what two of them have marked
 * counts as marked again. Equality does not depend on threads, nor on whether a vertex is listed by chance.
 */
#include "base/parallel.h"
#include "topology/inside.h"

/* Threads that fill filters: each takes up to 8 bytes a vertex for its bitmaps. */
enum { MOST_RANGES = 8 };

/* Listed vertices that one thread welds alone: a table of all threads takes as long. */
enum { FEW = 1 << 16 };

/* Vertices found marked, beside an eighth of those met, with which the filter is given up: it would only be work beside
 * that of the table. */
enum { MANY = 4096 };

/* The place of a vertex is its hash: the word of a bitmap above, two of its bits below. Beyond 8 million vertices more
 * than two share a word, and more are listed by chance. */
enum { BIT_BITS = 5, MOST_WORD_BITS = 32 - 2 * BIT_BITS };

typedef struct bloom_filter {
	nt_welder *w;
	unsigned ranges;
	unsigned word_bits; /* log2 of the words of a bitmap */
	uint32_t *bitmaps;  /* marked and again of each range; the second of range 0 becomes that of all */
	bool in_room;       /* the bitmaps and places are, not in the scratch */
	uint32_t *places;   /* [vertex_count]; then, from where a range begins, its listed vertices */
	bool many;          /* atomic: it is left to the table */
	/* of a range: its first vertex, how many it found marked, how many it lists */
	size_t begins[MOST_RANGES], found[MOST_RANGES], listed[MOST_RANGES];
} bloom_filter;

static inline uint32_t *marked_of(const bloom_filter *f, unsigned range)
{
	return f->bitmaps + ((size_t)2 * range << f->word_bits);
}

static inline uint32_t *again_of(const bloom_filter *f, unsigned range)
{
	return marked_of(f, range) + ((size_t)1 << f->word_bits);
}

static inline size_t word_of(uint32_t place, unsigned word_bits)
{
	return place >> (32 - word_bits);
}

static inline uint32_t bits_of(uint32_t place)
{
	return (uint32_t)1 << (place & 31) | (uint32_t)1 << (place >> BIT_BITS & 31);
}

/* Load */

/* Rows of vertices [begin, end), and the upper bits of their hashes. Returns the flags of nt_weld_load(). */
static nt_weld_flags load_rows(const nt_welder *w, size_t begin, size_t end, uint32_t *hashes)
{
	/* copies, which no store changes */
	const nmtan_mesh mesh = *w->mesh;
	const nt_weld_key key = w->key;
	nt_weld_flags unordered = {0};
	for (size_t v = begin; v < end; v++) {
		unordered |= nt_weld_load(&mesh, v, &w->rows[v]);
		hashes[v] = (uint32_t)(nt_weld_hash(&key, &w->rows[v]) >> 32);
	}
	return unordered;
}

/* A vertex with a NaN gets place 0, as if it had been found. */
static void find_unordered(const bloom_filter *f, size_t begin, size_t end, uint32_t *marked)
{
	marked[0] |= bits_of(0);
	for (size_t v = begin; v < end; v++)
		if (!nt_weld_row_ordered(&f->w->rows[v]))
			f->places[v] = 0;
}

/* Marks the places of a batch. Returns how many were marked already. */
static size_t mark_batch(const bloom_filter *f, const uint32_t *places, size_t count, uint32_t *marked, uint32_t *again)
{
	const unsigned word_bits = f->word_bits; /* a copy, which no store changes */
	size_t found = 0;
	for (size_t i = 0; i < count; i++) {
		const size_t at = word_of(places[i], word_bits);
		const uint32_t bits = bits_of(places[i]), word = marked[at];
		marked[at] = word | bits;
		if ((word & bits) == bits) {
			again[at] |= bits;
			found++;
		}
	}
	return found;
}

static void load_range(void *context, size_t begin, size_t end, unsigned thread)
{
	bloom_filter *f = context;
	uint32_t *const marked = marked_of(f, thread), *const again = again_of(f, thread);
	memset(marked, 0, 2 * sizeof *marked << f->word_bits);
	size_t found = 0;
	for (size_t first = begin, last; first < end; first = last) {
		last = end - first < NT_WELD_BATCH ? end : first + NT_WELD_BATCH;
		if (!nt_weld_ordered(load_rows(f->w, first, last, f->places)))
			find_unordered(f, first, last, marked);
		found += mark_batch(f, f->places + first, last - first, marked, again);
		if (found > MANY + (last - begin) / 8)
			nt_atomic_store(&f->many, true, RELAXED);
		if (nt_atomic_load(&f->many, RELAXED))
			break;
	}
	f->begins[thread] = begin;
	f->found[thread] = found;
}

/* List */

/* Vertices that two ranges have marked, or one again. */
static void join_range(void *context, size_t begin, size_t end, unsigned thread)
{
	const bloom_filter *f = context;
	(void)thread;
	for (size_t i = begin; i < end; i++) {
		uint32_t marked = 0, again = 0;
		for (unsigned r = 0; r < f->ranges; r++) {
			again |= again_of(f, r)[i] | (marked & marked_of(f, r)[i]);
			marked |= marked_of(f, r)[i];
		}
		again_of(f, 0)[i] = again;
	}
}

static void list_range(void *context, size_t begin, size_t end, unsigned thread)
{
	bloom_filter *f = context;
	const uint32_t *const again = again_of(f, 0);
	uint32_t *const places = f->places, *list = places + begin;
	const unsigned word_bits = f->word_bits;
	for (size_t v = begin; v < end; v++) {
		const uint32_t place = places[v], word = again[word_of(place, word_bits)];
		*list = (uint32_t)v;
		list += word >> (place & 31) & word >> (place >> BIT_BITS & 31) & 1; /* both of bits_of() */
	}
	f->listed[thread] = (size_t)(list - (places + begin));
}

/* Lists the vertices that may be equal to another, ascending, and those with a NaN. Returns how many. */
static size_t list_vertices(bloom_filter *f)
{
	if (f->ranges == 1 && f->found[0] == 0)
		return 0; /* usual in small meshes */
	if (f->ranges > 1)
		nt_parallel_ranges(f->ranges, (size_t)1 << f->word_bits, 1, join_range, f);
	nt_parallel_ranges(f->ranges, f->w->item_count, 1, list_range, f);
	size_t count = f->listed[0];
	for (unsigned r = 1; r < f->ranges; r++) {
		memmove(f->places + count, f->places + f->begins[r], f->listed[r] * sizeof *f->places);
		count += f->listed[r];
	}
	return count;
}

/* Number */

/* Listed vertices get the number of the first that is equal. Rows stay where they are, and those of the others are
 * nobody's. */
static void number_listed(nt_welder *w, const nt_welder *listed)
{
	uint32_t *const firsts = listed->numbers; /* takes the place of what has been read */
	size_t classes = 0;
	for (size_t l = 0; l < listed->item_count; l++) {
		const uint32_t found = listed->numbers[l], v = listed->items[l];
		if (found == classes)
			firsts[classes++] = v;
		w->numbers[v] = firsts[found];
	}
}

/* Numbers vertices whose rows are there: a vertex on the list, which has all that are equal to another or hold a NaN,
 * gets the number of the first equal one on it; the others keep their own. False when out of memory. */
static bool number_vertices(nt_welder *w, const uint32_t *list, size_t count, unsigned ranges)
{
	if (count == 0)
		return true;
	nt_welder listed = {.mesh = w->mesh, .key = w->key, .row_memory = w->memory, .memory = w->memory, .items = list,
		.item_count = count, .row_guess = count};
	listed.numbers = nt_borrowed_alloc(w->memory, count, sizeof *listed.numbers);
	if (!listed.numbers || !nt_weld_items(&listed, ranges))
		return false;
	w->unordered = listed.unordered;
	if (listed.row_count == count && !w->unordered)
		return true;
	w->numbers = nt_borrowed_alloc(w->memory, w->item_count, sizeof *w->numbers);
	if (!w->numbers)
		return false;
	for (size_t v = 0; v < w->item_count; v++)
		w->numbers[v] = (uint32_t)v;
	number_listed(w, &listed);
	return true;
}

/* The whole */

/* Memory for rows, places and bitmaps of at least 16 bits a vertex; few vertices get more, so that they are hardly
 * ever listed by chance. */
static bool make_filter(bloom_filter *f)
{
	nt_welder *w = f->w;
	const size_t count = w->item_count, words = count < 128 ? 2 * count : 256;
	f->word_bits = nt_weld_bits_for(count / 2 > words ? count / 2 : words);
	if (f->word_bits > MOST_WORD_BITS)
		f->word_bits = MOST_WORD_BITS;
	if (!nt_weld_grow_rows(w, count + 1))
		return false;
	const size_t bitmap_words = (size_t)2 * f->ranges << f->word_bits;
	f->in_room = nt_borrowed_has(w->memory, bitmap_words + count, sizeof *f->bitmaps);
	f->bitmaps = nt_borrowed_alloc(w->memory, bitmap_words + count, sizeof *f->bitmaps);
	if (f->bitmaps)
		f->places = f->bitmaps + bitmap_words;
	return f->bitmaps;
}

nt_weld_outcome nt_weld_by_filter(nt_welder *w, unsigned ranges)
{
	bloom_filter f;
	f.w = w;
	f.many = false;
	f.ranges = nt_parallel_slots(ranges < MOST_RANGES ? ranges : MOST_RANGES, w->item_count, 1);
	if (!make_filter(&f))
		return NT_WELD_NO_MEMORY;
	nt_parallel_ranges(f.ranges, w->item_count, 1, load_range, &f);
	if (f.many)
		return NT_WELD_MANY;
	const size_t count = list_vertices(&f);
	w->row_count = w->item_count;
	/* a table in fresh pages would be 2 MB more of an output that is hardly begun */
	if (f.in_room)
		nt_borrowed_trim(w->memory, f.bitmaps, ((size_t)(f.places - f.bitmaps) + count) * sizeof *f.places);
	return number_vertices(w, f.places, count, count < FEW ? 1 : ranges) ? NT_WELD_DONE : NT_WELD_NO_MEMORY;
}
