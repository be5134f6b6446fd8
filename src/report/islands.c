/* SPDX-License-Identifier: MIT */
/*
 * UV islands: which are mirrored, which overlap others, which are folded.
 *
 * A mirrored island that shares its texture with an unmirrored one is how symmetric models are made. To
 * tell it from a lone one, centroids of its triangles are looked up among the unmirrored triangles of
 * the whole mesh, both as the sampler wraps them: a mirrored half that was moved by a whole tile for baking
 * still lies on the other half. The points (about SAMPLE_COUNT of them, at least one of each island) go into a
 * grid and the triangles stream over it, once for each tile that they reach into; a point that is found leaves
 * its cell, so that many stacked layers cost no more than one. Triangles whose materials have other images share no
 * texture. Points that are not found are looked up among the other meshes: halves of a model may be objects.
 *
 * An island with both windings is a fold, unless its mirrored part lies point by point on its own
 * unmirrored part: then it is a symmetric model whose halves share the coordinates of the middle line, or a doubled
 * sheet.
 */
#include "report/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"

enum { SAMPLE_COUNT = 16384, MOST_GRID = 128, SMALL_GRID = 16 };

/* Cells that the streaming triangles may visit: some 10 ms for a mesh and 3 us for each of its triangles, at most 0.3
 * s. Beyond, points count as not found. */
static const size_t MESH_VISITS = 1 << 22, TRIANGLE_VISITS = 1 << 10, MOST_VISITS = 100000000;

/* Shares from which on an island overlaps another, and overlaps it exactly. */
static const double COVERED_SHARE = 0.5, EXACT_SHARE = 0.95;

/* ---- what each island is made of ---- */

static void add_triangle(const nt_check *check, nt_island *island, size_t t)
{
	const nt_surface *s = &check->surface;
	island->triangles[s->orientation[t] + 1]++;
	island->area += nt_triangle_area(s, t);
	if (t < island->first_triangle)
		island->first_triangle = (uint32_t)t;
	for (size_t side = 3 * t; side < 3 * t + 3; side++) {
		const size_t vertex = nt_side_vertex(s, side);
		nt_range_add(island->minimum, island->maximum, check->mesh->texcoords + 2 * vertex);
		nt_box_add(&island->box, check->mesh->positions + 3 * vertex);
	}
}

static void add_block(const nt_check *check, nt_island *island, size_t b)
{
	const nt_block *block = &check->surface.blocks[b];
	for (int i = 0; i < 3; i++) {
		island->triangles[i] += block->triangles[i];
		island->area += block->areas[i];
	}
	if (b * NT_BLOCK < island->first_triangle)
		island->first_triangle = (uint32_t)(b * NT_BLOCK);
	nt_range_add(island->minimum, island->maximum, block->minimum);
	nt_range_add(island->minimum, island->maximum, block->maximum);
	nt_box_join(&island->box, &block->box);
}

/* The island of all triangles of a block; NT_NONE: there is no such one. */
static uint32_t island_of_block(const nt_check *check, size_t b)
{
	const uint32_t island = check->islands[b * NT_BLOCK];
	for (size_t t = b * NT_BLOCK; t < nt_block_end(&check->surface, b); t++)
		if (check->islands[t] != island)
			return NT_NONE;
	return island;
}

/* Blocks of one island are added as they are, then the triangles of the others. */
static void measure_islands(nt_check *check)
{
	nt_report_mesh *facts = check->facts;
	const size_t blocks = nt_block_count(&check->surface);
	for (size_t i = 0; i < facts->island_count; i++)
		facts->islands[i] = (nt_island){.minimum = {INFINITY, INFINITY},
			.maximum = {-INFINITY, -INFINITY}, .covered = NAN, .texel_density = {NAN, NAN},
			.stretch = {NAN, NAN}, .first_triangle = NT_NONE,
			.box = nt_box_empty()};
	for (size_t b = 0; b < blocks; b++) {
		const uint32_t island = island_of_block(check, b);
		if (island != NT_NONE)
			add_block(check, &facts->islands[island], b);
	}
	for (size_t b = 0; b < blocks; b++) {
		if (island_of_block(check, b) != NT_NONE)
			continue;
		for (size_t t = b * NT_BLOCK; t < nt_block_end(&check->surface, b); t++)
			if (check->islands[t] != NT_NONE)
				add_triangle(check, &facts->islands[check->islands[t]], t);
	}
	for (size_t i = 0; i < facts->island_count; i++)
		nt_source_range(check->scene, facts->islands[i].minimum, facts->islands[i].maximum);
}

/* Without what is flipped in it, unless that is all. */
static nt_island_kind kind_of(const nt_island *island)
{
	const bool mirrored = island->triangles[0] > island->flipped[0];
	const bool normal = island->triangles[2] > island->flipped[2];
	if (mirrored != normal)
		return mirrored ? NT_ISLAND_MIRRORED : NT_ISLAND_NORMAL;
	if (mirrored)
		return NT_ISLAND_MIXED;
	if (island->triangles[0])
		return NT_ISLAND_MIRRORED;
	return island->triangles[2] ? NT_ISLAND_NORMAL : NT_ISLAND_DEGENERATE;
}

/* Mirrored triangles that are not flipped alone. */
static size_t mirrored_in(const nt_island *island)
{
	return island->triangles[0] - island->flipped[0];
}

/* ---- which mirrored triangles lie on unmirrored ones ---- */

typedef struct sample {
	double uv[2];
	double weight;     /* area in UV space */
	uint32_t island;
	uint32_t next;     /* in its cell, NT_NONE at the end */
	uint32_t texture;  /* number of the image that its material has */
	bool found;
} sample;

typedef struct grid {
	const nt_check *check;
	double minimum[2], scale[2];
	uint32_t cells[MOST_GRID * MOST_GRID]; /* [size * size] first sample */
	int size;
	sample *samples;
	size_t sample_count, left; /* not found yet */
	size_t visits, most_visits;
} grid;

/* The first map of a material, a normal map before others; "": none. A glTF's meshes are told apart by their
 * materials. */
static const char *texture_name(const nt_material *material)
{
	const char *name = material->normal_map.name;
	for (size_t i = 0; !name && i < NT_MATERIAL_MAPS; i++)
		name = material->maps[i].name;
	return name ? name : "";
}

/* Numbers the images of all materials, and last that of none. False: out of memory. */
static bool number_textures(const nt_scene *scene, nt_others *others)
{
	const size_t count = scene->material_count + 1;
	nt_name_table names = {0};
	others->textures = nt_alloc(count, sizeof *others->textures);
	others->met = nt_calloc(count, sizeof *others->met);
	bool done = others->textures && others->met;
	for (size_t i = 0; i < count && done; i++) {
		const char *name = i + 1 < count ? texture_name(&scene->materials[i]) : "";
		others->textures[i] = nt_name_add(&names, name, strlen(name));
		done = others->textures[i] != UINT32_MAX;
	}
	nt_name_table_free(&names);
	return done;
}

static uint32_t texture_of_primitive(const nt_check *check, const nt_mesh *mesh, size_t primitive)
{
	const size_t count = check->scene->material_count;
	const uint32_t material = mesh->primitive_count ? mesh->primitives[primitive].material : NT_NONE;
	return check->others->textures[material < count ? material : count];
}

static uint32_t texture_of(const nt_check *check, const nt_mesh *mesh, size_t face)
{
	return texture_of_primitive(check, mesh, mesh->face_primitive ? mesh->face_primitive[face] : 0);
}

static double uv_area(const float *a, const float *b, const float *c)
{
	return ((double)b[0] - a[0]) * ((double)c[1] - a[1]) -
		((double)b[1] - a[1]) * ((double)c[0] - a[0]);
}

/* Coordinates that a material scales beyond what float holds are no numbers then: the first cell has them. */
static int cell_of(const grid *g, int axis, double value)
{
	const double cell = (value - g->minimum[axis]) * g->scale[axis];
	return !(cell >= 0.0) ? 0 : cell >= g->size ? g->size - 1 : (int)cell;
}

/* Takes every n-th mirrored triangle, at most SAMPLE_COUNT, and the first one of every island. `met` is
 * cleared memory, one byte for each island. */
static void take_samples(grid *g, size_t mirrored_count, uint8_t *met)
{
	const nt_check *check = g->check;
	const nt_surface *s = &check->surface;
	const size_t stride = (mirrored_count + SAMPLE_COUNT - 1) / SAMPLE_COUNT;
	size_t seen = 0;
	for (size_t t = 0; t < s->triangle_count; t++) {
		if (nt_settled_orientation(check, t) >= 0 || check->islands[t] == NT_NONE)
			continue;
		const bool first = !met[check->islands[t]];
		met[check->islands[t]] = 1;
		if (seen++ % stride != 0 && !first)
			continue;
		const float *a = nt_side_texcoord(s, 3 * t), *b = nt_side_texcoord(s, 3 * t + 1);
		const float *c = nt_side_texcoord(s, 3 * t + 2);
		sample *p = &g->samples[g->sample_count++];
		*p = (sample){.weight = -uv_area(a, b, c), .island = check->islands[t],
			.texture = texture_of(check, check->mesh, nt_triangle_face(s, t)),
			.found = check->twins && nt_bit(check->twins, t)};
		for (int axis = 0; axis < 2; axis++)
			p->uv[axis] = nt_wrap_coordinate(check->mesh, axis,
				((double)a[axis] + b[axis] + c[axis]) / 3.0);
	}
}

/* A scene may have thousands of small meshes, for which clearing a large grid is half of a report's time. */
static void fill_grid(grid *g)
{
	g->size = g->sample_count > SMALL_GRID * SMALL_GRID ? MOST_GRID : SMALL_GRID;
	for (int axis = 0; axis < 2; axis++) {
		double maximum = -INFINITY;
		g->minimum[axis] = INFINITY;
		for (size_t i = 0; i < g->sample_count; i++) {
			g->minimum[axis] = fmin(g->minimum[axis], g->samples[i].uv[axis]);
			maximum = fmax(maximum, g->samples[i].uv[axis]);
		}
		const double extent = maximum - g->minimum[axis];
		g->scale[axis] = extent > 0.0 ? g->size / extent : 0.0;
	}
	memset(g->cells, 0xff, (size_t)(g->size * g->size) * sizeof *g->cells);
	for (size_t i = g->sample_count; i-- > 0;) {
		sample *p = &g->samples[i];
		uint32_t *cell = &g->cells[cell_of(g, 1, p->uv[1]) * g->size + cell_of(g, 0, p->uv[0])];
		p->next = *cell;
		*cell = (uint32_t)i;
	}
	g->left = g->sample_count;
}

/* A triangle in UV space, counterclockwise. */
typedef struct uv_triangle {
	double uv[2][3];
	uint32_t texture;
} uv_triangle;

static bool is_inside(const sample *p, const uv_triangle *t)
{
	const double *u = t->uv[0], *v = t->uv[1];
	for (int k = 0; k < 3; k++) {
		const int next = (k + 1) % 3;
		if (!((u[next] - u[k]) * (p->uv[1] - v[k]) - (v[next] - v[k]) * (p->uv[0] - u[k]) >= 0.0))
			return false;
	}
	return true;
}

static double least(const double x[3])
{
	const double first = x[0] < x[1] ? x[0] : x[1];
	return first < x[2] ? first : x[2];
}

static double greatest(const double x[3])
{
	const double first = x[0] > x[1] ? x[0] : x[1];
	return first > x[2] ? first : x[2];
}

/* Takes the samples that lie in an unmirrored triangle out of their cells. */
static void search_cells(grid *g, const uv_triangle *t)
{
	const int x0 = cell_of(g, 0, least(t->uv[0])), x1 = cell_of(g, 0, greatest(t->uv[0]));
	const int y0 = cell_of(g, 1, least(t->uv[1])), y1 = cell_of(g, 1, greatest(t->uv[1]));
	for (int y = y0; y <= y1; y++) {
		for (int x = x0; x <= x1; x++) {
			g->visits++;
			for (uint32_t *link = &g->cells[y * g->size + x]; *link != NT_NONE;) {
				sample *p = &g->samples[*link];
				g->visits++;
				if (p->texture == t->texture && is_inside(p, t)) {
					p->found = true;
					g->left--;
					*link = p->next;
				} else {
					link = &p->next;
				}
			}
		}
	}
}

/* Searches in one of the tiles that a triangle reaches into, moved to the first one: that may turn it over. */
static void search_tile(grid *g, uv_triangle t, const double tile[2])
{
	bool turned = false;
	for (int axis = 0; axis < 2; axis++) {
		const bool folded = g->check->mesh->wrap[axis] == NT_WRAP_MIRRORED && fmod(tile[axis], 2.0) != 0.0;
		for (int k = 0; k < 3; k++)
			t.uv[axis][k] = folded ? 1.0 - (t.uv[axis][k] - tile[axis]) : t.uv[axis][k] - tile[axis];
		turned ^= folded;
	}
	for (int axis = 0; axis < 2 && turned; axis++) {
		const double x = t.uv[axis][1];
		t.uv[axis][1] = t.uv[axis][2];
		t.uv[axis][2] = x;
	}
	g->visits++;
	search_cells(g, &t);
}

static bool goes_on(const grid *g)
{
	return g->left && g->visits < g->most_visits;
}

/* An unmirrored triangle, in the tiles that it reaches into: one if coordinates are not wrapped. */
static void search_triangle(grid *g, const float *const texcoords[3], uint32_t texture)
{
	const nt_mesh *mesh = g->check->mesh;
	uv_triangle t = {.texture = texture};
	double first[2], last[2];
	for (int axis = 0; axis < 2; axis++) {
		for (int k = 0; k < 3; k++)
			t.uv[axis][k] = (double)texcoords[k][axis] + mesh->wrap_offset[axis];
		const bool wrapped = mesh->wrap[axis] == NT_WRAP_REPEAT || mesh->wrap[axis] == NT_WRAP_MIRRORED;
		first[axis] = wrapped ? floor(least(t.uv[axis])) : 0.0;
		last[axis] = wrapped ? floor(greatest(t.uv[axis])) : 0.0;
	}
	for (double v = first[1]; v <= last[1] && g->visits < g->most_visits; v += 1.0)
		for (double u = first[0]; u <= last[0] && g->visits < g->most_visits; u += 1.0)
			search_tile(g, t, (const double[2]){u, v});
}

/* Returns whether to go on: as long as the scene's budget for it lasts, as thousands may have mirrored islands. */
static bool search_other(void *context, const nt_mesh *other)
{
	grid *g = context;
	const nt_check *check = g->check;
	size_t *faces = &check->others->faces;
	bool shared = false;
	if (other == check->mesh)
		return true;
	for (size_t p = 0; p <= other->primitive_count && !shared; p++)
		if (p < other->primitive_count || !p)
			shared = check->others->met[texture_of_primitive(check, other, p)] == check->mesh_index + 1;
	const size_t cost = 1 + other->primitive_count + (shared ? other->face_count : 0);
	if (cost <= *faces && shared) {
		nt_mesh_triangles at = {.mesh = other};
		const float *texcoords[3];
		while (goes_on(g) && nt_next_unmirrored(&at, texcoords))
			search_triangle(g, texcoords, texture_of(check, other, at.face));
	}
	*faces -= cost <= *faces ? cost : 1;
	return goes_on(g) && *faces;
}

static nt_status search_others(grid *g)
{
	const nt_check *check = g->check;
	double minimum[2] = {INFINITY, INFINITY}, maximum[2] = {-INFINITY, -INFINITY};
	if (!g->left || !check->others->faces)
		return NT_OK;
	for (size_t p = 0; p < check->mesh->primitive_count || !p; p++)
		check->others->met[texture_of_primitive(check, check->mesh, p)] = check->mesh_index + 1;
	for (size_t i = 0; i < g->sample_count; i++)
		for (int axis = 0; axis < 2 && !g->samples[i].found; axis++) {
			minimum[axis] = fmin(minimum[axis], g->samples[i].uv[axis]);
			maximum[axis] = fmax(maximum[axis], g->samples[i].uv[axis]);
		}
	return nt_others_ask(check->others, check->scene, check->mesh, minimum, maximum, search_other, g);
}

/* Sets `covered` of every island with mirrored triangles. */
static nt_status find_covered(nt_check *check, size_t mirrored_count)
{
	const nt_surface *s = &check->surface;
	const size_t islands = check->facts->island_count, triangles = s->triangle_count;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	grid *g = nt_scratch_alloc(check->scratch, 1, sizeof *g);
	const size_t most = (mirrored_count < SAMPLE_COUNT ? mirrored_count : SAMPLE_COUNT) + islands;
	sample *samples = nt_scratch_alloc(check->scratch, most, sizeof *samples);
	uint8_t *met = nt_scratch_alloc(check->scratch, islands, sizeof *met);
	double *sums = nt_scratch_alloc(check->scratch, 2 * islands, sizeof *sums);
	if (!g || !samples || !sums || !met ||
		(!check->others->met && !number_textures(check->scene, check->others)))
		return NT_ERROR_MEMORY;
	memset(met, 0, islands * sizeof *met);
	g->check = check;
	g->samples = samples;
	g->sample_count = g->visits = 0;
	g->most_visits = triangles < MOST_VISITS / TRIANGLE_VISITS
		? MESH_VISITS + TRIANGLE_VISITS * triangles : MOST_VISITS;
	take_samples(g, mirrored_count, met);
	fill_grid(g);
	for (size_t t = 0; t < triangles && goes_on(g); t++)
		if (s->orientation[t] > 0)
			search_triangle(g, (const float *const[3]){nt_side_texcoord(s, 3 * t),
				nt_side_texcoord(s, 3 * t + 1), nt_side_texcoord(s, 3 * t + 2)},
				texture_of(check, check->mesh, nt_triangle_face(s, t)));
	const nt_status status = search_others(g);
	memset(sums, 0, 2 * islands * sizeof *sums);
	for (size_t i = 0; i < g->sample_count; i++) {
		const sample *p = &samples[i];
		sums[2 * p->island] += p->weight;
		sums[2 * p->island + 1] += p->found ? p->weight : 0.0;
	}
	for (size_t i = 0; i < islands; i++)
		if (sums[2 * i] > 0.0)
			check->facts->islands[i].covered = sums[2 * i + 1] / sums[2 * i];
	nt_scratch_back(check->scratch, mark);
	return status;
}

/* ---- folds and overlapping islands ---- */

/* An unmirrored corner, in a table by texture coordinates and island. */
typedef struct corner {
	float uv[2];
	uint32_t island; /* NT_NONE: the place is free */
	uint32_t point;
} corner;

typedef struct corner_table {
	corner *corners; /* [size] */
	size_t size, count; /* size: 0 or a power of two, at least twice the count */
} corner_table;

static size_t place_of(const corner_table *table, const corner *c)
{
	return (size_t)nt_hash_words(nt_hash_floats(c->uv[0], c->uv[1]), c->island) & (table->size - 1);
}

static bool grow_table(corner_table *table)
{
	corner_table larger = {.size = table->size ? 2 * table->size : 1024, .count = table->count};
	larger.corners = nt_alloc(larger.size, sizeof *larger.corners);
	if (!larger.corners)
		return false;
	memset(larger.corners, 0xff, larger.size * sizeof *larger.corners);
	for (size_t i = 0; i < table->size; i++) {
		if (table->corners[i].island == NT_NONE)
			continue;
		size_t at = place_of(&larger, &table->corners[i]);
		while (larger.corners[at].island != NT_NONE)
			at = (at + 1) & (larger.size - 1);
		larger.corners[at] = table->corners[i];
	}
	free(table->corners);
	*table = larger;
	return true;
}

/* Notes an unmirrored corner, of two points at most, or counts a mirrored one: in counts[1] when an unmirrored corner
 * at another point has its coordinates, in counts[0] when none has. Points of the fold itself say nothing, but of a
 * twin. False: out of memory. */
static bool meet_corner(const nt_check *check, uint32_t side, uint32_t island, bool mirrored, corner_table *table,
	size_t *counts)
{
	const float *uv = nt_side_texcoord(&check->surface, side);
	const corner own = {{uv[0], uv[1]}, island, nt_side_point(&check->surface, side)};
	if (2 * (table->count + 1) > table->size && !grow_table(table))
		return false;
	size_t at = place_of(table, &own), met = 0;
	bool other = false;
	for (; table->corners[at].island != NT_NONE; at = (at + 1) & (table->size - 1)) {
		const corner *c = &table->corners[at];
		if (c->uv[0] != uv[0] || c->uv[1] != uv[1] || c->island != island)
			continue;
		met++;
		other |= c->point != own.point;
	}
	if (!mirrored && met < 2 && (other || !met)) {
		table->corners[at] = own;
		table->count++;
	}
	if (mirrored && (other || !met || (check->twins && nt_bit(check->twins, side / 3))))
		counts[2 * island + (met > 0)]++;
	return true;
}

/* Sets `overlaps_itself` of mixed islands: mirrored corners lie on unmirrored corners of the same island, and the
 * triangles on its triangles. Each vertex counts once for each island, as long as the island's triangles follow each
 * other. */
static nt_status find_overlapping(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const size_t islands = check->facts->island_count, vertices = check->mesh->vertex_count;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	uint32_t *last = nt_scratch_alloc(check->scratch, vertices, sizeof *last);
	size_t *counts = nt_scratch_alloc(check->scratch, 2 * islands, sizeof *counts);
	corner_table table = {0};
	bool done = last && counts;
	if (done)
		memset(counts, 0, 2 * islands * sizeof *counts);
	for (int mirrored = 0; mirrored < 2 && done; mirrored++) {
		memset(last, 0xff, vertices * sizeof *last);
		for (size_t t = 0; t < s->triangle_count && done; t++) {
			const uint32_t island = check->islands[t];
			if (nt_settled_orientation(check, t) != (mirrored ? -1 : 1) || island == NT_NONE ||
				check->facts->islands[island].kind != NT_ISLAND_MIXED)
				continue;
			for (uint32_t side = (uint32_t)(3 * t); side < 3 * t + 3; side++) {
				uint32_t *before = &last[nt_side_vertex(s, side)];
				if (*before != island)
					done &= meet_corner(check, side, island, mirrored, &table, counts);
				*before = island;
			}
		}
	}
	for (size_t i = 0; i < islands && done; i++) {
		nt_island *island = &check->facts->islands[i];
		const double corners = (double)(counts[2 * i] + counts[2 * i + 1]);
		island->overlaps_itself = island->kind == NT_ISLAND_MIXED && island->covered >= EXACT_SHARE &&
			counts[2 * i + 1] > 0 && (double)counts[2 * i + 1] >= EXACT_SHARE * corners;
	}
	free(table.corners);
	nt_scratch_back(check->scratch, mark);
	return done ? NT_OK : NT_ERROR_MEMORY;
}

/* ---- findings ---- */

static nt_code code_of(const nt_island *island)
{
	if (island->kind == NT_ISLAND_MIXED && !island->overlaps_itself)
		return NT_CODE_UV_MIXED_WINDING_ISLAND;
	return island->kind == NT_ISLAND_MIXED || island->covered >= COVERED_SHARE
		? NT_CODE_UV_MIRROR_OVERLAP
		: NT_CODE_UV_MIRROR_LONE;
}

/* Count for a finding of this island: all its triangles for a fold, else the mirrored ones. */
static size_t size_of(const nt_island *island)
{
	return code_of(island) == NT_CODE_UV_MIXED_WINDING_ISLAND
		? island->triangles[0] + island->triangles[1] + island->triangles[2]
		: mirrored_in(island);
}

static void tally_island(const nt_check *check, nt_tally *tally, size_t index)
{
	const nt_island *island = &check->facts->islands[index];
	const size_t before = tally->count;
	nt_tally_triangle(check, tally, island->first_triangle, island->covered);
	nt_box_join(&tally->box, &island->box);
	tally->count = before + size_of(island);
	tally->share += check->total_area > 0.0 ? island->area / check->total_area : 0.0;
}

static void report_island(nt_check *check, size_t index, nt_severity severity)
{
	const nt_island *island = &check->facts->islands[index];
	nt_tally tally = {.code = code_of(island), .island = (uint32_t)index + 1};
	tally_island(check, &tally, index);
	nt_tally_number(&tally, "mirrored_triangles", (double)island->triangles[0]);
	nt_tally_number(&tally, "unmirrored_triangles", (double)island->triangles[2]);
	nt_tally_number(&tally, "covered_share", island->covered);
	nt_check_report_as(check, &tally, severity, "island %zu", index);
}

/* Islands that share texels are meant: one finding, which counts them. */
static void report_overlapping(nt_check *check)
{
	nt_tally tally = {.code = NT_CODE_UV_MIRROR_OVERLAP};
	size_t count = 0, mirrored = 0;
	for (size_t k = 0; k < check->facts->island_count; k++) {
		const nt_island *island = &check->facts->islands[k];
		if (mirrored_in(island) == 0 || code_of(island) != tally.code)
			continue;
		tally.island = count++ ? 0 : (uint32_t)k + 1;
		mirrored += mirrored_in(island);
		tally_island(check, &tally, k);
	}
	tally.count = count;
	tally.share *= 0.1; /* there is nothing to be done */
	nt_tally_number(&tally, "mirrored_triangles", (double)mirrored);
	nt_check_report(check, &tally, NULL);
}

static bool is_of(const nt_island *island, nt_code code)
{
	return mirrored_in(island) != 0 && code_of(island) == code;
}

/* One finding per island, or one of all if there are no others; many of a kind beyond the first are one finding
 * together. */
static void report_islands_of(nt_check *check, nt_code code)
{
	const nt_report_mesh *facts = check->facts;
	size_t all = 0, seen = 0;
	double area = 0.0;
	for (size_t k = 0; k < facts->island_count; k++) {
		const nt_island *island = &facts->islands[k];
		all += is_of(island, code);
		area += is_of(island, code) ? island->area : 0.0;
	}
	const size_t others = facts->island_count - facts->island_kinds[NT_ISLAND_DEGENERATE] - all;
	const bool together = code == NT_CODE_UV_MIRROR_LONE && all > 1 && others == 0;
	const nt_severity severity = code == NT_CODE_UV_MIRROR_LONE ? NT_SEVERITY_INFO : nt_area_severity(check, area);
	nt_tally rest = {.code = code};
	for (size_t k = 0; k < facts->island_count; k++) {
		if (!is_of(&facts->islands[k], code))
			continue;
		if (!together && seen++ < NT_SINGLE_FINDINGS)
			report_island(check, k, severity);
		else
			tally_island(check, &rest, k);
	}
	if (together)
		nt_check_report_as(check, &rest, severity, "each of all %zu islands", all);
	else if (seen > NT_SINGLE_FINDINGS)
		nt_check_report_as(check, &rest, severity, "each of %zu further islands beyond the first %d",
			seen - NT_SINGLE_FINDINGS, NT_SINGLE_FINDINGS);
}

nt_status nt_check_islands(nt_check *check)
{
	nt_report_mesh *facts = check->facts;
	if (!check->mesh->texcoords || facts->island_count == 0)
		return NT_OK;
	facts->islands = nt_arena_alloc(&check->report->arena, facts->island_count,
		sizeof *facts->islands);
	if (!facts->islands)
		return NT_ERROR_MEMORY;
	measure_islands(check);
	nt_status status = nt_check_flips(check);
	size_t mirrored = 0;
	for (size_t i = 0; i < facts->island_count; i++) {
		nt_island *island = &facts->islands[i];
		island->kind = kind_of(island);
		facts->island_kinds[island->kind]++;
		mirrored += mirrored_in(island);
	}
	if (!status && mirrored)
		status = find_covered(check, mirrored);
	if (!status && facts->island_kinds[NT_ISLAND_MIXED])
		status = find_overlapping(check);
	if (!status) {
		report_overlapping(check);
		report_islands_of(check, NT_CODE_UV_MIRROR_LONE);
		report_islands_of(check, NT_CODE_UV_MIXED_WINDING_ISLAND);
	}
	return status;
}
