/* SPDX-License-Identifier: MIT */
/*
 * The mesh's faces of the columns of polygons. Triangles and quads of the file are faces as they stand; larger polygons
 * are cut into triangles, and how they were cut is kept for the writer. Triangle strips (element tristrips, -1 starts a
 * new one) become triangles first.
 *
 * Texture coordinates may belong to corners (MeshLab's per-wedge ones): a vertex is then a row of the file with one
 * pair of coordinates. The first pair of a row keeps the row's number, further ones are appended in the order they
 * come. Most corners of a row agree, so the first pair is compared directly; only copies go through a hash table, which
 * keeps a fan of any size linear. Pairs are equal if their bits are.
 */
#include "ply/parts.h"

#include <stdlib.h>
#include "base/hash_index.h"
#include "scene/origin.h"
#include "scene/polygon.h"

/* ---- rows ---- */

/* Texture coordinates that are not finite become 0; how many rows have any, and the first of them. */
static size_t mend_texcoords(const ply_rows *rows, ply_column *texcoords, size_t *first)
{
	size_t unsound = 0, at = 0;
	for (size_t row = 0; row < rows->element->count; row++) {
		bool sound = true;
		for (const size_t end = at + ply_list_size(texcoords, row); at < end; at++) {
			sound &= isfinite(texcoords->floats[at]) != 0;
			texcoords->floats[at] = isfinite(texcoords->floats[at]) ? texcoords->floats[at] : 0.0f;
		}
		if (!sound && !unsound++)
			*first = row;
	}
	return unsound;
}

/* Says what of the rows is not as it should be. */
static nt_status tell_rows(nt_scene *scene, const ply_source *source, const ply_rows *rows)
{
	const ply_column *indices = &rows->columns[source->face_indices];
	enum { UNSOUND, SMALL, LONGER, KINDS };
	size_t counts[KINDS] = {[LONGER] = rows->longer}, firsts[KINDS] = {[LONGER] = rows->first_longer};
	if (rows->unsound)
		counts[UNSOUND] = mend_texcoords(rows, &rows->columns[source->face_texcoords], &firsts[UNSOUND]);
	for (size_t row = 0; (indices->counts || indices->size < 3) && row < rows->element->count; row++)
		if (!source->strips && ply_list_size(indices, row) < 3 && !counts[SMALL]++)
			firsts[SMALL] = row;
	for (int kind = 0; kind < KINDS; kind++) {
		if (!counts[kind])
			continue;
		const unsigned char *const at = ply_find_row(rows, firsts[kind]);
		if (!at)
			return rows->error->status;
		const nt_place place = ply_place(&source->header, at);
		if (kind == UNSOUND)
			nt_finding_add(&scene->findings, NT_CODE_UV_NOT_FINITE, &place, counts[kind], "faces");
		else
			nt_scene_leave_out(scene, place.line, counts[kind], kind == SMALL
					? "faces of fewer than three corners (%zu)"
					: "values of faces beyond those that the header names (%zu)", counts[kind]);
	}
	return NT_OK;
}

nt_status ply_read_faces(nt_scene *scene, const ply_source *source, ply_rows *rows)
{
	const int texture = source->header.texture_count && source->face
		? ply_find_property(source->face, "texnumber") : PLY_NO_PROPERTY;
	rows->may_be_longer = true;
	rows->columns[source->face_indices] = (ply_column){.use = PLY_INDICES, .limit = source->vertex->count,
		.restarts = source->strips != NULL};
	if (source->face_texcoords != PLY_NO_PROPERTY)
		rows->columns[source->face_texcoords] =
			(ply_column){.use = PLY_FLOATS, .divisor = 1, .other = PLY_MENDED};
	if (texture != PLY_NO_PROPERTY && !source->face->properties[texture].list)
		rows->columns[texture] = (ply_column){.use = PLY_CHOICES, .stride = 1,
			.values = nt_arena_alloc(&scene->arena, rows->element->count, sizeof(uint32_t)),
			.limit = source->header.texture_count};
	if (texture != PLY_NO_PROPERTY && rows->columns[texture].use && !rows->columns[texture].values)
		return nt_fail_memory(rows->error);
	const nt_status status = ply_read_rows(rows);
	return status ? status : tell_rows(scene, source, rows);
}

/* ---- building ---- */

typedef struct builder {
	nt_scene *scene;
	nt_mesh *mesh;
	ply_source *source;
	ply_rows *rows;
	ply_column *indices;
	size_t row_count;
	uint32_t *textures;         /* [row_count] NULL: none have */
	size_t small, large;        /* rows of fewer than three corners, and of more than four */
	bool quads;
	size_t unsound, first_unsound; /* polygons that could be cut by a guess alone: how many, the row of the first */
} builder;

/* Triangles with a doubled corner join strips and are no faces. */
static nt_status expand_strips(builder *b)
{
	ply_column *strips = b->indices;
	uint32_t *const triangles = nt_alloc(strips->used, 3 * sizeof *triangles), *to = triangles;
	const uint32_t *c = strips->integers;
	if (!triangles)
		return nt_fail_memory(b->rows->error);
	for (size_t row = 0; row < b->row_count; row++) {
		const size_t count = ply_list_size(strips, row);
		size_t begin = 0;
		for (size_t i = 0; i < count; i++, c++) {
			if (*c == NT_NONE)
				begin = i + 1;
			if (*c == NT_NONE || i < begin + 2 || c[0] == c[-1] || c[0] == c[-2] || c[-1] == c[-2])
				continue;
			const bool odd = (i - begin) & 1;
			*to++ = c[odd ? -1 : -2];
			*to++ = c[odd ? -2 : -1];
			*to++ = c[0];
		}
	}
	free(strips->values);
	free(strips->counts);
	*strips = (ply_column){.integers = triangles, .size = 3, .used = (size_t)(to - triangles)};
	b->row_count = strips->used / 3;
	return NT_OK;
}

/* ---- wedges ---- */

typedef enum wedge_state { WEDGE_UNUSED, WEDGE_HAS, WEDGE_LACKS } wedge_state;

typedef struct wedge {
	float uv[2];
	uint32_t row;
	wedge_state state;
} wedge;

typedef struct wedges {
	wedge *rows;       /* [row_count] the first one of each row */
	size_t row_count;
	nt_key_set copies; /* wedges of vertices row_count and so on */
	bool any, any_lacks; /* some corner has, some has no coordinates */
} wedges;

/* The vertex for a row with coordinates; uv NULL: with none. NT_NONE: memory or vertex numbers are exhausted. */
static uint32_t wedge_vertex(wedges *w, uint32_t row, const float *uv)
{
	wedge new = {.row = row, .state = uv ? WEDGE_HAS : WEDGE_LACKS};
	memcpy(new.uv, uv ? uv : new.uv, sizeof new.uv);
	w->any |= uv != NULL;
	w->any_lacks |= uv == NULL;
	if (w->rows[row].state == WEDGE_UNUSED)
		w->rows[row] = new;
	if (memcmp(&w->rows[row], &new, sizeof new) == 0)
		return row;
	const uint32_t copy = nt_key_add(&w->copies, &new, sizeof new);
	return copy == NT_NONE || w->row_count + copy >= NT_NONE ? NT_NONE : (uint32_t)(w->row_count + copy);
}

/* Gives the corners vertices that have their coordinates. */
static nt_status find_wedges(builder *b, const ply_column *texcoords, wedges *w)
{
	uint32_t *corners = b->indices->integers;
	const float *uv = texcoords->floats;
	for (size_t row = 0; row < b->row_count; row++) {
		const size_t size = ply_list_size(b->indices, row), count = ply_list_size(texcoords, row);
		if (size > 2 && count != 0 && count != 2 * size) {
			const unsigned char *const at = ply_find_row(b->rows, row);
			return !at ? b->rows->error->status : ply_fail_at(b->rows->header, at, b->rows->error,
				"%s %zu: list \"texcoord\" has %zu values, expected %zu for %zu corners, or none",
				b->rows->element->name, row, count, 2 * size, size);
		}
		for (size_t k = 0; size > 2 && k < size; k++) {
			corners[k] = wedge_vertex(w, corners[k], count ? uv + 2 * k : NULL);
			if (corners[k] == NT_NONE)
				return nt_fail_memory(b->rows->error);
		}
		corners += size;
		uv += count;
	}
	return NT_OK;
}

/* A copy of an array of rows with the copies' rows behind it. */
static bool append_copies(const wedges *w, nt_arena *arena, float **array, size_t width)
{
	const wedge *copies = (const wedge *)(const void *)w->copies.keys;
	if (!*array || !w->copies.count)
		return true;
	float *grown = nt_arena_alloc(arena, w->row_count + w->copies.count, width * sizeof *grown);
	if (!grown)
		return false;
	memcpy(grown, *array, w->row_count * width * sizeof *grown);
	for (size_t i = 0; i < w->copies.count; i++)
		memcpy(grown + (w->row_count + i) * width, *array + copies[i].row * width, width * sizeof *grown);
	*array = grown;
	return true;
}

/* Gives the mesh its texture coordinates, and its copies all other attributes. Nothing happens if no corner had
 * coordinates. */
static bool apply_wedges(const wedges *w, nt_arena *arena, nt_mesh *mesh, ply_source *source)
{
	const wedge *copies = (const wedge *)(const void *)w->copies.keys;
	const size_t count = w->row_count + w->copies.count;
	if (!w->any)
		return true;
	if (!append_copies(w, arena, &mesh->positions, 3) || !append_copies(w, arena, &mesh->normals, 3) ||
		!append_copies(w, arena, &mesh->colors, 4) || !append_copies(w, arena, &mesh->tangents, 4))
		return false;
	mesh->texcoords = nt_arena_alloc(arena, count, 2 * sizeof *mesh->texcoords);
	mesh->vertex_lacks = w->any_lacks ? nt_arena_alloc(arena, count, 1) : NULL;
	source->wedge_rows = nt_arena_alloc(arena, w->copies.count, sizeof *source->wedge_rows);
	if (!mesh->texcoords || !source->wedge_rows || (w->any_lacks && !mesh->vertex_lacks))
		return false;
	for (size_t v = 0; v < count; v++) {
		const wedge *own = v < w->row_count ? &w->rows[v] : &copies[v - w->row_count];
		memcpy(mesh->texcoords + 2 * v, own->uv, sizeof own->uv);
		if (mesh->vertex_lacks)
			mesh->vertex_lacks[v] = own->state == WEDGE_LACKS ? NT_LACKS_TEXCOORD : 0;
		if (v >= w->row_count)
			source->wedge_rows[v - w->row_count] = own->row;
	}
	mesh->vertex_count = count;
	source->wedge_count = w->copies.count;
	return true;
}

static nt_status make_wedges(builder *b, const ply_column *texcoords)
{
	wedges w = {.row_count = b->source->vertex->count};
	w.rows = nt_calloc(w.row_count, sizeof *w.rows);
	for (size_t i = 0; w.rows && i < w.row_count; i++)
		w.rows[i].row = (uint32_t)i;
	nt_status status = w.rows ? find_wedges(b, texcoords, &w) : nt_fail_memory(b->rows->error);
	if (!status && !apply_wedges(&w, &b->scene->arena, b->mesh, b->source))
		status = nt_fail_memory(b->rows->error);
	free(w.rows);
	nt_key_set_free(&w.copies);
	return status;
}

/* ---- faces of polygons ---- */

/* Primitives of textures that no face uses are left out. The numbers of textures become those of primitives. */
static nt_status make_primitives(const builder *b)
{
	nt_mesh *mesh = b->mesh;
	uint32_t *numbers = mesh->face_primitive;
	const size_t textures = b->source->header.texture_count, most = numbers ? textures + 1 : 1;
	mesh->primitives = nt_arena_alloc(&b->scene->arena, most, sizeof *mesh->primitives);
	uint32_t *counts = nt_calloc(most, sizeof *counts);
	if (!mesh->primitives || !counts) {
		free(counts);
		return nt_fail_memory(b->rows->error);
	}
	for (size_t f = 0; numbers && f < mesh->face_count; f++)
		counts[numbers[f]]++;
	for (size_t i = 0; i < most; i++) {
		if (numbers && !counts[i])
			continue;
		mesh->primitives[mesh->primitive_count] = (nt_primitive){
			.material = i < textures ? (uint32_t)i : NT_NONE,
			.face_count = numbers ? counts[i] : mesh->face_count};
		counts[i] = (uint32_t)mesh->primitive_count++;
	}
	for (size_t f = 0; numbers && f < mesh->face_count; f++)
		numbers[f] = counts[numbers[f]];
	mesh->face_primitive = mesh->primitive_count > 1 ? numbers : NULL;
	free(counts);
	return NT_OK;
}

/* Cuts a polygon: the corner numbers of its triangles go to `cut`. */
static nt_status cut_polygon(const builder *b, const uint32_t *vertices, size_t size, uint32_t *cut, bool *sound)
{
	float (*points)[3] = nt_alloc(size, sizeof *points);
	for (size_t k = 0; points && k < size; k++)
		memcpy(points[k], b->mesh->positions + 3 * (size_t)vertices[k], sizeof *points);
	const bool done = points && !nt_polygon_triangulate((const float(*)[3])points, size, cut, sound);
	free(points);
	return done ? NT_OK : nt_fail_memory(b->rows->error);
}

/* Counts faces, and makes arrays for them. If rows are faces as they stand, the mesh takes over their columns. */
static nt_status start_faces(builder *b)
{
	nt_mesh *mesh = b->mesh;
	nt_arena *arena = &b->scene->arena;
	b->source->most_corners = 4;
	const size_t alike = b->indices->counts ? 1 : b->row_count;
	for (size_t row = 0; row < b->row_count; row += alike) {
		const size_t size = ply_list_size(b->indices, row), faces = size < 3 ? 0 : size > 4 ? size - 2 : 1;
		b->source->most_corners = size > b->source->most_corners ? size : b->source->most_corners;
		b->small += size < 3;
		b->quads |= size == 4;
		b->large += size > 4;
		mesh->face_count += alike * faces;
		mesh->corner_count += alike * (size > 4 ? 3 * faces : faces * size);
		b->source->cut_count += size > 4 ? alike * 3 * faces : 0;
	}
	if (mesh->face_count > NMTAN_MAX_FACES)
		return nt_fail(b->rows->error, NT_ERROR_TOO_LARGE, "more than %zu faces", NMTAN_MAX_FACES);
	const bool plain = !b->small && !b->large;
	if (plain) {
		mesh->indices = b->indices->integers;
		b->indices->values = NULL;
		if (!nt_arena_adopt(arena, mesh->indices))
			return nt_fail_memory(b->rows->error);
	} else {
		mesh->indices = nt_arena_alloc(arena, mesh->corner_count, sizeof *mesh->indices);
	}
	mesh->face_polygon = b->large ? nt_arena_alloc(arena, mesh->face_count, sizeof *mesh->face_polygon) : NULL;
	mesh->face_sizes = b->quads ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	mesh->face_primitive = plain || !b->textures ? b->textures
		: nt_arena_alloc(arena, mesh->face_count, sizeof *b->textures);
	b->source->cuts = nt_arena_alloc(arena, b->source->cut_count, sizeof *b->source->cuts);
	const bool all = mesh->indices && b->source->cuts && (mesh->face_polygon || !b->large) &&
		(mesh->face_sizes || !b->quads) && (mesh->face_primitive || !b->textures);
	return all ? NT_OK : nt_fail_memory(b->rows->error);
}

/* Fills them; once more if positions have changed, by which large polygons are cut. */
static nt_status fill_faces(builder *b)
{
	nt_mesh *mesh = b->mesh;
	const uint32_t *from = b->indices->integers;
	uint32_t *to = mesh->indices, *cut = b->source->cuts;
	size_t face = 0, polygon = 0;
	nt_status status = NT_OK;
	b->unsound = 0;
	if (!b->small && !b->large) {
		for (size_t row = 0; mesh->face_sizes && row < b->row_count; row++)
			mesh->face_sizes[row] = (uint8_t)ply_list_size(b->indices, row);
		return NT_OK;
	}
	for (size_t row = 0; !status && row < b->row_count; row++) {
		const size_t size = ply_list_size(b->indices, row);
		const size_t end = face + (size < 3 ? 0 : size > 4 ? size - 2 : 1);
		bool sound = true;
		if (size > 4)
			status = cut_polygon(b, from, size, cut, &sound);
		if (!sound && !b->unsound++)
			b->first_unsound = row;
		for (size_t k = 0; !status && size > 2 && k < (size > 4 ? 3 * (size - 2) : size); k++)
			to[k] = from[size > 4 ? cut[k] : k];
		for (; face < end; face++) {
			if (mesh->face_polygon)
				mesh->face_polygon[face] = (uint32_t)polygon;
			if (mesh->face_sizes)
				mesh->face_sizes[face] = size == 4 ? 4 : 3;
			if (mesh->face_primitive)
				mesh->face_primitive[face] = b->textures[row];
		}
		polygon += size > 2;
		from += size;
		to += size > 4 ? 3 * (size - 2) : size > 2 ? size : 0;
		cut += size > 4 ? 3 * (size - 2) : 0;
	}
	return status;
}

/* ---- positions that float cannot hold ---- */

size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths)
{
	const size_t step = mesh->face_count / most + 1;
	size_t count = 0, corner = 0;
	for (size_t f = 0; f < mesh->face_count; f += step) {
		const size_t k = count % 3, from = corner + (k < 2 ? k : 0), to = corner + (k < 2 ? k + 1 : 2);
		const size_t a = mesh->indices ? mesh->indices[from] : from;
		const size_t b = mesh->indices ? mesh->indices[to] : to;
		lengths[count] = nt_edge_length(mesh->positions, exact, a, b);
		count += lengths[count] > 0 || !exact;
		for (size_t i = f; i < f + step && i < mesh->face_count && mesh->face_sizes; i++)
			corner += mesh->face_sizes[i];
		corner += mesh->face_sizes ? 0 : 3 * step;
	}
	return count;
}

/* Whether positions are of a type that float does not hold. */
static bool has_wide_positions(const ply_source *source)
{
	bool wide = false;
	for (size_t k = 0; k < 3; k++) {
		const ply_type type = source->vertex->properties[source->roles[PLY_POSITION][k]].type;
		wide |= type == PLY_FLOAT64 || type == PLY_INT32 || type == PLY_UINT32;
	}
	return wide;
}

/* Reads the rows of vertices again, into doubles; and copies that texture coordinates of faces made. */
static nt_status read_exact(const nt_mesh *mesh, const ply_source *source, double *exact, nt_error *error)
{
	const size_t count = source->vertex->count;
	ply_rows rows;
	nt_status status = ply_begin_rows(&rows, &source->header, source->vertex,
		source->header.bytes + source->vertex->rows.begin, error);
	for (size_t k = 0; !status && k < 3; k++)
		rows.columns[source->roles[PLY_POSITION][k]] =
			(ply_column){.use = PLY_DOUBLES, .doubles = exact + k, .stride = 3};
	if (!has_wide_positions(source))
		for (size_t i = 0; i < 3 * count; i++)
			exact[i] = mesh->positions[i];
	else if (!status)
		status = ply_read_rows(&rows);
	for (size_t i = 0; i < source->wedge_count; i++)
		memcpy(exact + 3 * (count + i), exact + 3 * (size_t)source->wedge_rows[i], 3 * sizeof *exact);
	ply_free_rows(&rows);
	return status;
}

/* Gives the scene an origin if it needs one, or the user names one: positions are then others. The rule is that of
 * scene/origin.h. It is asked when all floats and faces have been read, and only if the properties are doubles or
 * integers of 32 bits, or the user names an origin. */
static nt_status settle_origin(nt_scene *scene, nt_mesh *mesh, const ply_source *source, const nt_origin *wished,
	nt_error *error)
{
	if (!mesh->face_count || (!has_wide_positions(source) && !nt_origin_is_given(wished)))
		return NT_OK;
	double *lengths = nt_alloc(NT_ORIGIN_SAMPLED, sizeof *lengths), *exact = NULL;
	nt_status status = lengths ? NT_OK : nt_fail_memory(error);
	const float largest = nt_largest_of(mesh->positions, 3 * mesh->vertex_count, 0);
	const size_t tried = lengths ? ply_sample_edges(mesh, NULL, NT_ORIGIN_TRIED, lengths) : 0;
	if (!status && (nt_origin_is_given(wished) ||
			       nt_origin_is_suspected(largest, lengths, tried, NT_ORIGIN_DOUBT))) {
		exact = nt_calloc(mesh->vertex_count, 3 * sizeof *exact);
		status = exact ? read_exact(mesh, source, exact, error) : nt_fail_memory(error);
		if (!status)
			nt_origin_settle(scene, wished, &(nt_exact){.positions = exact,
				.vertex_count = mesh->vertex_count, .edges = lengths, .edge_count =
				ply_sample_edges(mesh, exact, NT_ORIGIN_SAMPLED, lengths), .stored = wished->to_ply,
				.needless = wished->to_ply && wished->keeps && mesh->normals && mesh->tangents},
				mesh->positions);
		nt_origin_matrix(scene, scene->instances->matrix);
	}
	free(lengths);
	free(exact);
	return status;
}

/* ---- all of it ---- */

nt_status ply_make_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_rows *rows, const nt_origin *origin)
{
	const int texture = ply_find_property(rows->element, "texnumber");
	builder b = {.scene = scene, .mesh = mesh, .source = source, .rows = rows, .row_count = rows->element->count,
		.indices = &rows->columns[source->face_indices],
		.textures = texture != PLY_NO_PROPERTY && rows->columns[texture].use == PLY_CHOICES
			? rows->columns[texture].integers : NULL};
	nt_status status = source->strips ? expand_strips(&b) : NT_OK;
	if (!status && !source->strips && source->face_texcoords != PLY_NO_PROPERTY)
		status = make_wedges(&b, &rows->columns[source->face_texcoords]);
	if (!status)
		status = start_faces(&b);
	if (!status)
		status = fill_faces(&b);
	if (!status)
		status = settle_origin(scene, mesh, source, origin, rows->error);
	if (!status && b.large && nt_scene_has_origin(scene))
		status = fill_faces(&b);
	const unsigned char *const at = !status && b.unsound ? ply_find_row(rows, b.first_unsound) : NULL;
	if (!status && b.unsound && !at)
		return rows->error->status;
	if (at) {
		const nt_place place = ply_place(&source->header, at);
		nt_finding_add(&scene->findings, NT_CODE_POLYGON_DEGENERATE, &place, b.unsound, NULL);
	}
	return status ? status : make_primitives(&b);
}
