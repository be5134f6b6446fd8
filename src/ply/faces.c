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
#include "scene/values.h"

/* So many rows of faces with texture coordinates are read at a time. */
enum { WEDGE_ROWS = 1 << 14 };

/* ---- wedges ---- */

typedef enum wedge_state { WEDGE_UNUSED, WEDGE_HAS, WEDGE_LACKS } wedge_state;

/* A row of the file with coordinates: a vertex. */
typedef struct wedge {
	float uv[2];
	uint32_t row;
	wedge_state state;
} wedge;

static bool start_wedges(ply_faces *f)
{
	f->wedges = nt_calloc(f->source->vertex->count, sizeof *f->wedges);
	for (size_t i = 0; f->wedges && i < f->source->vertex->count; i++)
		f->wedges[i].row = (uint32_t)i;
	return f->wedges != NULL;
}

/* The vertex for a row with coordinates; uv NULL: with none. NT_NONE: memory or vertex numbers are exhausted. */
static uint32_t wedge_vertex(ply_faces *f, uint32_t row, const float *uv)
{
	wedge new = {.row = row, .state = uv ? WEDGE_HAS : WEDGE_LACKS};
	memcpy(new.uv, uv ? uv : new.uv, sizeof new.uv);
	f->any_has |= uv != NULL;
	f->any_lacks |= uv == NULL;
	if (f->wedges[row].state == WEDGE_UNUSED)
		f->wedges[row] = new;
	if (memcmp(&f->wedges[row], &new, sizeof new) == 0)
		return row;
	const uint32_t copy = nt_key_add(&f->copies, &new, sizeof new);
	const size_t vertex = f->source->vertex->count + copy;
	return copy == NT_NONE || vertex >= NT_NONE ? NT_NONE : (uint32_t)vertex;
}

static void tally(ply_tally *t, size_t row)
{
	t->first = t->count++ ? t->first : row;
}

/* Gives the corners of rows, which begin at `corners`, vertices that have their coordinates; those that are not finite
 * become 0. */
static nt_status find_wedges(ply_faces *f, size_t row, uint32_t *corners)
{
	const ply_rows *rows = &f->rows;
	ply_column *texcoords = &rows->columns[f->source->face_texcoords];
	float *uv = texcoords->floats;
	for (; row < rows->row; row++) {
		const size_t size = ply_list_size(f->indices, row), count = ply_list_size(texcoords, row);
		bool sound = true;
		for (size_t k = 0; rows->unsound && k < count; k++) {
			sound &= isfinite(uv[k]) != 0;
			uv[k] = isfinite(uv[k]) ? uv[k] : 0.0f;
		}
		if (!sound)
			tally(&f->unsound, row);
		if (size > 2 && count != 0 && count != 2 * size) {
			const unsigned char *const at = ply_find_row(rows, row);
			return !at ? rows->error->status : ply_fail_at(rows->header, at, rows->error,
				"%s %zu: list \"texcoord\" has %zu values, expected %zu for %zu corners, or none",
				rows->element->name, row, count, 2 * size, size);
		}
		for (size_t k = 0; size > 2 && k < size; k++) {
			corners[k] = wedge_vertex(f, corners[k], count ? uv + 2 * k : NULL);
			if (corners[k] == NT_NONE)
				return nt_fail_memory(rows->error);
		}
		corners += size;
		uv += count;
	}
	return NT_OK;
}

/* Gives the mesh its texture coordinates, and its copies all other attributes. Nothing happens if no corner had
 * coordinates. */
static nt_status apply_wedges(ply_faces *f)
{
	nt_mesh *mesh = f->mesh;
	nt_arena *arena = &f->scene->arena;
	const wedge *copies = (const wedge *)(const void *)f->copies.keys;
	const size_t rows = f->source->vertex->count, count = rows + f->copies.count;
	float **const arrays[] = {&mesh->positions, &mesh->normals, &mesh->colors, &mesh->tangents};
	static const size_t widths[] = {3, 3, 4, 4};
	if (!f->any_has)
		return NT_OK;
	for (size_t a = 0; a < 4 && f->copies.count; a++) {
		const size_t bytes = widths[a] * sizeof(float);
		char *grown = *arrays[a] ? nt_arena_alloc(arena, count, bytes) : NULL;
		if (*arrays[a] && !grown)
			return nt_fail_memory(f->rows.error);
		if (grown)
			memcpy(grown, *arrays[a], rows * bytes);
		for (size_t i = 0; grown && i < f->copies.count; i++)
			memcpy(grown + (rows + i) * bytes, *arrays[a] + copies[i].row * widths[a], bytes);
		*arrays[a] = (float *)(void *)grown;
	}
	mesh->texcoords = nt_arena_alloc(arena, count, 2 * sizeof *mesh->texcoords);
	mesh->vertex_lacks = f->any_lacks ? nt_arena_alloc(arena, count, 1) : NULL;
	f->source->wedge_rows = nt_arena_alloc(arena, f->copies.count, sizeof *f->source->wedge_rows);
	if (!mesh->texcoords || !f->source->wedge_rows || (f->any_lacks && !mesh->vertex_lacks))
		return nt_fail_memory(f->rows.error);
	for (size_t v = 0; v < count; v++) {
		const wedge *own = v < rows ? &f->wedges[v] : &copies[v - rows];
		memcpy(mesh->texcoords + 2 * v, own->uv, sizeof own->uv);
		if (mesh->vertex_lacks)
			mesh->vertex_lacks[v] = own->state == WEDGE_LACKS ? NT_LACKS_TEXCOORD : 0;
		if (v >= rows)
			f->source->wedge_rows[v - rows] = own->row;
	}
	mesh->vertex_count = count;
	f->source->wedge_count = f->copies.count;
	return NT_OK;
}

/* ---- rows ---- */

/* Says what of the rows is not as it should be: left out, or a finding. */
static nt_status tell(const ply_faces *f, const ply_tally *t, const nt_code *code, const char *text)
{
	const unsigned char *const at = t->count ? ply_find_row(&f->rows, t->first) : f->rows.at;
	if (!t->count || !at)
		return at ? NT_OK : f->rows.error->status;
	const nt_place place = ply_place(f->rows.header, at);
	if (code)
		nt_finding_add(&f->scene->findings, *code, &place, t->count, "%s", text);
	else
		nt_scene_leave_out(f->scene, place.line, t->count, "%s (%zu)", text, t->count);
	return NT_OK;
}

nt_status ply_read_faces(ply_faces *f)
{
	const ply_source *source = f->source;
	ply_rows *rows = &f->rows;
	const size_t count = f->row_count = rows->element->count;
	const int texture = source->header.texture_count && source->face
		? ply_find_property(source->face, "texnumber") : PLY_NO_PROPERTY;
	ply_column *texcoords = source->face_texcoords < 0 ? NULL : &rows->columns[source->face_texcoords];
	rows->may_be_longer = true;
	f->indices = &rows->columns[source->face_indices];
	*f->indices = (ply_column){.use = PLY_INDICES, .limit = source->vertex->count,
		.restarts = source->strips != NULL};
	if (texcoords)
		*texcoords = (ply_column){.use = PLY_FLOATS, .divisor = 1, .other = PLY_MENDED};
	if (texture != PLY_NO_PROPERTY && !source->face->properties[texture].list) {
		f->textures = nt_arena_alloc(&f->scene->arena, count, sizeof *f->textures);
		rows->columns[texture] = (ply_column){.use = PLY_CHOICES, .integers = f->textures, .stride = 1,
			.limit = source->header.texture_count};
		if (!f->textures)
			return nt_fail_memory(rows->error);
	}
	nt_status status = !texcoords || start_wedges(f) ? NT_OK : nt_fail_memory(rows->error);
	/* coordinates of corners are many: some rows at a time */
	while (!status && rows->row < count) {
		const size_t first = rows->row, corners = f->indices->used;
		rows->stop = texcoords && count - first > WEDGE_ROWS ? first + WEDGE_ROWS : count;
		status = ply_read_rows(rows);
		if (!status && texcoords)
			status = find_wedges(f, first, f->indices->integers + corners);
		if (texcoords)
			texcoords->used = 0;
	}
	for (size_t row = 0; !status && (f->indices->counts || f->indices->size < 3) && row < count; row++)
		if (!source->strips && ply_list_size(f->indices, row) < 3)
			tally(&f->small, row);
	if (!status)
		status = tell(f, &f->unsound, &(nt_code){NT_CODE_UV_NOT_FINITE}, "faces");
	if (!status)
		status = tell(f, &f->small, NULL, "faces of fewer than three corners");
	if (!status)
		status = tell(f, &rows->longer, NULL, "values of faces beyond those that the header names");
	return status;
}

/* Triangles with a doubled corner join strips and are no faces. */
static nt_status expand_strips(ply_faces *f)
{
	ply_column *strips = f->indices;
	uint32_t *const triangles = nt_alloc(strips->used, 3 * sizeof *triangles), *to = triangles;
	const uint32_t *c = strips->integers;
	if (!triangles)
		return nt_fail_memory(f->rows.error);
	for (size_t row = 0; row < f->rows.element->count; row++) {
		const size_t count = ply_list_size(strips, row);
		size_t begin = 0;
		for (size_t i = 0; i < count; i++, c++) {
			if (*c == NT_NONE)
				begin = i + 1;
			if (*c == NT_NONE || i < begin + 2 || c[0] == c[-1] || c[0] == c[-2] || c[-1] == c[-2])
				continue;
			const bool odd = (i ^ begin) & 1;
			*to++ = c[odd ? -1 : -2];
			*to++ = c[odd ? -2 : -1];
			*to++ = c[0];
		}
	}
	free(strips->values);
	free(strips->counts);
	*strips = (ply_column){.integers = triangles, .size = 3, .used = (size_t)(to - triangles)};
	f->row_count = strips->used / 3;
	return NT_OK;
}

/* ---- faces of polygons ---- */

/* Primitives of textures that no face uses are left out. The numbers of textures become those of primitives. */
static nt_status make_primitives(const ply_faces *f)
{
	nt_mesh *mesh = f->mesh;
	uint32_t *numbers = mesh->face_primitive;
	const size_t textures = f->source->header.texture_count, most = numbers ? textures + 1 : 1;
	mesh->primitives = nt_arena_alloc(&f->scene->arena, most, sizeof *mesh->primitives);
	uint32_t *counts = nt_calloc(most, sizeof *counts);
	if (!mesh->primitives || !counts) {
		free(counts);
		return nt_fail_memory(f->rows.error);
	}
	for (size_t face = 0; numbers && face < mesh->face_count; face++)
		counts[numbers[face]]++;
	for (size_t i = 0; i < most; i++) {
		if (numbers && !counts[i])
			continue;
		mesh->primitives[mesh->primitive_count] = (nt_primitive){
			.material = i < textures ? (uint32_t)i : NT_NONE,
			.face_count = numbers ? counts[i] : mesh->face_count};
		counts[i] = (uint32_t)mesh->primitive_count++;
	}
	for (size_t face = 0; numbers && face < mesh->face_count; face++)
		numbers[face] = counts[numbers[face]];
	mesh->face_primitive = mesh->primitive_count > 1 ? numbers : NULL;
	free(counts);
	return NT_OK;
}

/* Counts faces, and makes arrays for them. If rows are faces as they stand, the mesh takes over their columns. */
static nt_status start_faces(ply_faces *f)
{
	nt_mesh *mesh = f->mesh;
	nt_arena *arena = &f->scene->arena;
	f->source->most_corners = 4;
	const size_t alike = f->indices->counts ? 1 : f->row_count;
	for (size_t row = 0; row < f->row_count; row += alike) {
		const size_t size = ply_list_size(f->indices, row), faces = size < 3 ? 0 : size > 4 ? size - 2 : 1;
		f->source->most_corners = size > f->source->most_corners ? size : f->source->most_corners;
		f->quads |= size == 4;
		f->large += size > 4;
		mesh->face_count += alike * faces;
		mesh->corner_count += alike * (size > 4 ? 3 * faces : faces * size);
		f->source->cut_count += size > 4 ? alike * 3 * faces : 0;
	}
	if (mesh->face_count > NMTAN_MAX_FACES)
		return nt_fail(f->rows.error, NT_ERROR_TOO_LARGE, "more than %zu faces", NMTAN_MAX_FACES);
	const bool plain = !f->small.count && !f->large;
	if (plain) {
		mesh->indices = f->indices->integers;
		f->indices->values = NULL;
		if (!nt_arena_adopt(arena, mesh->indices))
			return nt_fail_memory(f->rows.error);
	} else {
		mesh->indices = nt_arena_alloc(arena, mesh->corner_count, sizeof *mesh->indices);
	}
	mesh->face_polygon = f->large ? nt_arena_alloc(arena, mesh->face_count, sizeof *mesh->face_polygon) : NULL;
	mesh->face_sizes = f->quads ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	mesh->face_primitive = plain || !f->textures ? f->textures
		: nt_arena_alloc(arena, mesh->face_count, sizeof *f->textures);
	f->source->cuts = nt_arena_alloc(arena, f->source->cut_count, sizeof *f->source->cuts);
	const bool all = mesh->indices && f->source->cuts && (mesh->face_polygon || !f->large) &&
		(mesh->face_sizes || !f->quads) && (mesh->face_primitive || !f->textures);
	return all ? NT_OK : nt_fail_memory(f->rows.error);
}

/* Fills them; once more if positions have changed, by which large polygons are cut. */
static nt_status fill_faces(ply_faces *f)
{
	nt_mesh *mesh = f->mesh;
	const uint32_t *from = f->indices->integers;
	uint32_t *to = mesh->indices, *cut = f->source->cuts;
	size_t face = 0, polygon = 0;
	nt_status status = NT_OK;
	f->guessed.count = 0;
	if (!f->small.count && !f->large) {
		for (size_t row = 0; mesh->face_sizes && row < f->row_count; row++)
			mesh->face_sizes[row] = (uint8_t)ply_list_size(f->indices, row);
		return NT_OK;
	}
	for (size_t row = 0; !status && row < f->row_count; row++) {
		const size_t size = ply_list_size(f->indices, row);
		const size_t end = face + (size < 3 ? 0 : size > 4 ? size - 2 : 1);
		bool sound = true;
		if (size > 4)
			status = nt_polygon_triangulate((const float(*)[3])mesh->positions, from, size, cut, &sound);
		if (!sound)
			tally(&f->guessed, row);
		for (size_t k = 0; !status && size > 2 && k < (size > 4 ? 3 * (size - 2) : size); k++)
			to[k] = from[size > 4 ? cut[k] : k];
		for (; face < end; face++) {
			if (mesh->face_polygon)
				mesh->face_polygon[face] = (uint32_t)polygon;
			if (mesh->face_sizes)
				mesh->face_sizes[face] = size == 4 ? 4 : 3;
			if (mesh->face_primitive)
				mesh->face_primitive[face] = f->textures[row];
		}
		polygon += size > 2;
		from += size;
		to += size > 4 ? 3 * (size - 2) : size > 2 ? size : 0;
		cut += size > 4 ? 3 * (size - 2) : 0;
	}
	return status ? nt_fail_memory(f->rows.error) : NT_OK;
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
 * scene/values.h. It is asked when all floats and faces have been read, and only if the properties are doubles or
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

nt_status ply_make_faces(ply_faces *f, const nt_origin *origin)
{
	nt_status status = f->source->strips ? expand_strips(f) : apply_wedges(f);
	if (!status)
		status = start_faces(f);
	if (!status)
		status = fill_faces(f);
	if (!status)
		status = settle_origin(f->scene, f->mesh, f->source, origin, f->rows.error);
	if (!status && f->large && nt_scene_has_origin(f->scene))
		status = fill_faces(f);
	if (!status)
		status = tell(f, &f->guessed, &(nt_code){NT_CODE_POLYGON_DEGENERATE}, "");
	return status ? status : make_primitives(f);
}

void ply_free_faces(ply_faces *f)
{
	ply_free_rows(&f->rows);
	free(f->wedges);
	nt_key_set_free(&f->copies);
}
