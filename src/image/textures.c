/* SPDX-License-Identifier: MIT */
/*
 * The images of one output: see textures.h. A source is a file; a wish is for a source and what it is to become; a result
 * is what wishes for the same bytes share. Whether a source is a height map is known when its first rows are, so
 * that wishes become results in nt_textures_make().
 *
 * Files are opened to see their type and closed again, so that a thousand images do not need a thousand
 * descriptors; whoever reads them later checks that they are still the same.
 */
#include "image/textures.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/name_table.h"
#include "base/parallel.h"
#include "file/relative_path.h"
#include "image/examine.h"
#include "image/heights.h"

typedef struct source {
	char *path;
	nt_image_found found;
	nt_image_type type;
	nt_file identity;
	bool in_question; /* somebody wants to know whether it is grey */
	bool grey;
	nt_error error;   /* of looking whether it is grey */
} source;

typedef struct wish {
	uint32_t source;
	nt_texture_wish what;
	uint32_t result;
} wish;

/* How a result comes from its source. */
typedef struct recipe {
	uint32_t source;
	bool png;      /* glTF does not carry the file, or PNG is wanted */
	nt_flip flip;  /* OFF with heights */
	bool heights;
	double height; /* these two only with heights */
	bool clamp;
} recipe;

typedef struct result {
	recipe how;
	nt_texture texture;
	unsigned char *bytes;
	char *name;
	nt_error error;
} result;

struct nt_textures {
	nt_arena arena;      /* of the keys in names */
	nt_name_table names; /* document and name, which lead to a source */
	uint32_t *name_sources;
	size_t name_capacity;
	source *sources;
	size_t source_count, source_capacity;
	wish *wishes;
	size_t wish_count, wish_capacity;
	result *results;
	size_t result_count, result_capacity;
	nt_hash_index by_path, by_wish, by_recipe; /* sources, wishes and results */
	nt_texture_rules rules;
};

nt_textures *nt_textures_create(void)
{
	return nt_calloc(1, sizeof(nt_textures));
}

void nt_textures_free(nt_textures *t)
{
	if (!t)
		return;
	for (size_t i = 0; i < t->source_count; i++)
		free(t->sources[i].path);
	for (size_t i = 0; i < t->result_count; i++) {
		free(t->results[i].bytes);
		free(t->results[i].name);
	}
	free(t->sources);
	free(t->wishes);
	free(t->results);
	free(t->name_sources);
	nt_hash_index_free(&t->by_path);
	nt_hash_index_free(&t->by_wish);
	nt_hash_index_free(&t->by_recipe);
	nt_name_table_free(&t->names);
	nt_arena_free(&t->arena);
	free(t);
}

/* ---- wishes ---- */

/* Looks into the file for its type and identity, if there is one. */
static nt_status inspect(source *s, nt_error *error)
{
	nt_file file;
	if (s->found == NT_IMAGE_MISSING)
		s->type = nt_image_type_of_name(s->path);
	if (s->found > NT_IMAGE_FOUND_ELSEWHERE)
		return NT_OK;
	const nt_status status = nt_file_open(&file, s->path, error);
	if (status)
		return status;
	s->type = nt_image_type_of_bytes(file.data, file.size);
	s->identity = (nt_file){.size = file.size, .fd = -1, .device = file.device, .inode = file.inode};
	nt_file_close(&file);
	return NT_OK;
}

/* The source of a path; UINT32_MAX: none. */
static uint32_t source_of_path(const nt_textures *t, const char *path, uint64_t hash)
{
	uint32_t number;
	for (size_t at = NT_HASH_BEGIN; (number = nt_hash_index_next(&t->by_path, hash, &at)) != UINT32_MAX;)
		if (strcmp(t->sources[number].path, path) == 0)
			break;
	return number;
}

static nt_status add_source(nt_textures *t, const nt_image_places *places, const char *name, uint32_t *number,
	nt_error *error)
{
	nt_buffer path = {0};
	nt_image_found found;
	const nt_status status = nt_image_find(places, name, &path, &found, error);
	const uint64_t hash = status ? 0 : nt_hash_bytes(0, path.data, path.size);
	*number = status ? UINT32_MAX : source_of_path(t, path.data, hash);
	if (status || *number != UINT32_MAX) {
		nt_buffer_free(&path);
		return status;
	}
	*number = (uint32_t)t->source_count;
	if (!nt_grow((void **)&t->sources, &t->source_capacity, t->source_count + 1, sizeof *t->sources) ||
		!nt_hash_index_add(&t->by_path, hash, *number)) {
		nt_buffer_free(&path);
		return nt_fail_memory(error);
	}
	source *s = &t->sources[t->source_count++];
	*s = (source){.path = path.data, .found = found};
	return inspect(s, error);
}

/* A name is looked for once for each document. */
static nt_status find_source(nt_textures *t, const nt_image_places *places, const char *name, uint32_t *number,
	nt_error *error)
{
	nt_buffer key = {0};
	nt_buffer_format(&key, "%s\n%s", places->document, name);
	const char *kept = key.failed ? NULL : nt_arena_text(&t->arena, key.data, key.size);
	const size_t length = key.size, known = t->names.count;
	nt_buffer_free(&key);
	if (!kept || !nt_grow((void **)&t->name_sources, &t->name_capacity, known + 1, sizeof *t->name_sources))
		return nt_fail_memory(error);
	const uint32_t id = nt_name_add(&t->names, kept, length);
	if (id == UINT32_MAX)
		return nt_fail_memory(error);
	const nt_status status = id < known ? NT_OK : add_source(t, places, name, &t->name_sources[id], error);
	*number = status ? 0 : t->name_sources[id];
	return status;
}

static bool equal_wishes(const nt_texture_wish *a, const nt_texture_wish *b)
{
	const bool heights = a->kind >= NT_TEXTURE_HEIGHTS;
	return a->kind == b->kind && (!heights || (a->height == b->height && a->clamp == b->clamp));
}

/* Of a source and what is made of it; adding 0 makes 0 of -0. */
static uint64_t hash_of(uint32_t from, int kind, double height, bool clamp)
{
	const double numbers[] = {from, kind, height + 0.0, clamp};
	return nt_hash_bytes(0, numbers, sizeof numbers);
}

nt_status nt_textures_wish(nt_textures *t, const nt_image_places *places, const char *name,
	const nt_texture_wish *what, uint32_t *number, nt_error *error)
{
	uint32_t from = 0;
	const nt_status status = find_source(t, places, name, &from, error);
	if (status)
		return status;
	t->sources[from].in_question |= what->kind == NT_TEXTURE_NORMALS_OR_HEIGHTS;
	const bool heights = what->kind >= NT_TEXTURE_HEIGHTS;
	const uint64_t hash = hash_of(from, (int)what->kind, heights ? what->height : 0, heights && what->clamp);
	for (size_t at = NT_HASH_BEGIN; (*number = nt_hash_index_next(&t->by_wish, hash, &at)) != UINT32_MAX;)
		if (t->wishes[*number].source == from && equal_wishes(&t->wishes[*number].what, what))
			return NT_OK;
	*number = (uint32_t)t->wish_count;
	if (!nt_grow((void **)&t->wishes, &t->wish_capacity, t->wish_count + 1, sizeof *t->wishes) ||
		!nt_hash_index_add(&t->by_wish, hash, *number))
		return nt_fail_memory(error);
	t->wishes[t->wish_count++] = (wish){.source = from, .what = *what};
	return NT_OK;
}

/* ---- sources ---- */

static bool is_there(const source *s)
{
	return s->found <= NT_IMAGE_FOUND_ELSEWHERE;
}

/* Opens a source that was looked at before. What becomes shorter while it is read has to be asked for: see
 * close_source(). */
static nt_status open_source(const source *s, nt_file *file, nt_error *error)
{
	const nt_status status = nt_file_open_untraced(file, s->path, error);
	if (status)
		return status;
	if (file->size == s->identity.size && file->device == s->identity.device && file->inode == s->identity.inode)
		return NT_OK;
	nt_file_close(file);
	nt_fail(error, NT_ERROR_IO, "the image changed while it was read");
	return nt_error_in_file(error, s->path);
}

static nt_status close_source(const source *s, nt_file *file, nt_status status, nt_error *error)
{
	const bool intact = nt_file_is_intact(file);
	nt_file_close(file);
	if (intact)
		return status;
	nt_fail(error, NT_ERROR_IO, "the image became shorter while it was read");
	return nt_error_in_file(error, s->path);
}

static void look_for_grey(void *context, size_t item, unsigned slot)
{
	(void)slot;
	nt_textures *t = context;
	source *s = &t->sources[item];
	nt_file file;
	nt_error_clear(&s->error);
	if (!s->in_question || !is_there(s) || !nt_image_is_decoded(s->type) || open_source(s, &file, &s->error))
		return;
	const nt_status status = nt_image_is_grey(file.data, file.size, &s->grey, &s->error);
	close_source(s, &file, status, &s->error);
}

/* ---- results ---- */

/* What a wish comes to. */
static recipe recipe_of(const nt_textures *t, const wish *w)
{
	const source *s = &t->sources[w->source];
	const nt_texture_choice choice = t->rules.choice;
	const nt_texture_kind kind = w->what.kind;
	const bool decodable = is_there(s) && nt_image_is_decoded(s->type);
	const bool heights = decodable &&
		(kind == NT_TEXTURE_HEIGHTS || (kind == NT_TEXTURE_NORMALS_OR_HEIGHTS && s->grey));
	const bool png = decodable && choice != NT_TEXTURES_KEEP &&
		(choice == NT_TEXTURES_PNG ? s->type != NT_IMAGE_PNG : !nt_image_is_carried(s->type));
	const bool may_flip = decodable && !heights && kind != NT_TEXTURE_COLOR && (png || nt_image_is_carried(s->type));
	return (recipe){w->source, png, may_flip ? t->rules.flip : NT_FLIP_OFF, heights, heights ? w->what.height : 0,
		heights && w->what.clamp};
}

static bool decodes(const recipe *how)
{
	return how->png || how->heights || how->flip != NT_FLIP_OFF;
}

/* The file's name; of what was made, with another ending. NULL: out of memory. */
static char *name_of(const nt_texture *texture)
{
	const char *name = nt_last_part(texture->path), *dot = strrchr(name, '.');
	nt_buffer text = {0};
	nt_buffer_append(&text, name, texture->bytes && dot > name ? (size_t)(dot - name) : strlen(name));
	if (texture->bytes)
		nt_buffer_text(&text, texture->from_heights ? "-normal.png" : texture->flipped ? "-green-up.png" : ".png");
	if (text.failed)
		nt_buffer_free(&text);
	return text.data;
}

static nt_status add_result(nt_textures *t, const recipe *how, nt_error *error)
{
	const source *s = &t->sources[how->source];
	if (!nt_grow((void **)&t->results, &t->result_capacity, t->result_count + 1, sizeof *t->results))
		return nt_fail_memory(error);
	const bool made = how->png || how->heights;
	const bool usable = s->found != NT_IMAGE_OUTSIDE && (made || nt_image_is_carried(s->type));
	t->results[t->result_count++] = (result){.how = *how, .texture = {
		.path = s->path, .found = s->found, .source_type = s->type, .from_heights = how->heights,
		.type = !usable ? NT_IMAGE_OTHER : made ? NT_IMAGE_PNG : s->type,
		.identity = s->identity, .failure = s->error.status ? s->error.message : NULL}};
	return NT_OK;
}

static bool equal_recipes(const recipe *a, const recipe *b)
{
	return a->source == b->source && a->png == b->png && a->flip == b->flip && a->heights == b->heights &&
	       a->height == b->height && a->clamp == b->clamp;
}

static nt_status plan_results(nt_textures *t, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < t->wish_count && !status; i++) {
		const recipe how = recipe_of(t, &t->wishes[i]);
		uint32_t *number = &t->wishes[i].result;
		const uint64_t hash = hash_of(how.source, how.png + 2 * how.heights + 4 * how.flip, how.height, how.clamp);
		for (size_t at = NT_HASH_BEGIN; (*number = nt_hash_index_next(&t->by_recipe, hash, &at)) != UINT32_MAX;)
			if (equal_recipes(&t->results[*number].how, &how))
				break;
		if (*number != UINT32_MAX)
			continue;
		*number = (uint32_t)t->result_count;
		status = add_result(t, &how, error);
		if (!status && !nt_hash_index_add(&t->by_recipe, hash, *number))
			status = nt_fail_memory(error);
	}
	return status;
}

static void flip_green(nt_pixels *p)
{
	const size_t count = (size_t)p->width * p->height * p->channels;
	for (size_t i = 1; i < count; i += p->channels)
		if (p->bits == 8)
			((uint8_t *)p->samples)[i] = (uint8_t)(UINT8_MAX - ((uint8_t *)p->samples)[i]);
		else
			((uint16_t *)p->samples)[i] = (uint16_t)(UINT16_MAX - ((uint16_t *)p->samples)[i]);
}

/* Turns green around if the recipe says so. */
static nt_status flip(const recipe *how, nt_pixels *pixels, bool *flipped, nt_error *error)
{
	nt_normal_facts facts;
	nt_status status = NT_OK;
	*flipped = how->flip == NT_FLIP_ON && pixels->channels >= 3;
	if (how->flip == NT_FLIP_AUTO) {
		status = nt_examine_normals(pixels, &facts, error);
		*flipped = !status && facts.green == NT_GREEN_DOWN;
	}
	if (*flipped)
		flip_green(pixels);
	return status;
}

static nt_status convert(const recipe *how, const nt_file *file, result *r)
{
	nt_pixels pixels, normals;
	nt_status status = nt_image_decode(file->data, file->size, &pixels, &r->error);
	if (!status && how->heights) {
		status = nt_heights_to_normals(&pixels, how->height, how->clamp, &normals, &r->error);
		nt_pixels_free(&pixels);
		pixels = normals;
	}
	if (!status)
		status = flip(how, &pixels, &r->texture.flipped, &r->error);
	if (!status && (how->png || how->heights || r->texture.flipped))
		status = nt_encode_png(&pixels, &r->bytes, &r->texture.size, &r->error);
	nt_pixels_free(&pixels);
	return status;
}

static nt_status decode_result(const source *s, result *r)
{
	nt_file file;
	nt_status status = open_source(s, &file, &r->error);
	if (status)
		return status;
	status = close_source(s, &file, convert(&r->how, &file, r), &r->error);
	if (status) {
		const bool as_it_is = !r->how.png && !r->how.heights;
		r->texture.type = as_it_is ? s->type : NT_IMAGE_OTHER;
		r->texture.failure = r->error.message;
	} else if (r->bytes) {
		r->texture.bytes = r->bytes;
		r->texture.type = NT_IMAGE_PNG;
	}
	return status;
}

static void make_result(void *context, size_t item, unsigned slot)
{
	(void)slot;
	nt_textures *t = context;
	result *r = &t->results[item];
	nt_error_clear(&r->error);
	if (decodes(&r->how))
		decode_result(&t->sources[r->how.source], r);
	r->texture.name = r->name = name_of(&r->texture);
	if (!r->name)
		nt_fail_memory(&r->error);
}

/* Passes on what is the system's fault. */
static nt_status fatal(const nt_error *failure, nt_error *error)
{
	if (failure->status != NT_ERROR_MEMORY && failure->status != NT_ERROR_IO && failure->status != NT_ERROR_MISSING)
		return NT_OK;
	*error = *failure;
	return failure->status;
}

nt_status nt_textures_make(nt_textures *t, const nt_texture_rules *rules, nt_error *error)
{
	t->rules = *rules;
	const unsigned threads = nt_thread_count(rules->threads);
	nt_parallel_items(threads, t->source_count, look_for_grey, t);
	nt_status status = NT_OK;
	for (size_t i = 0; i < t->source_count && !status; i++)
		status = fatal(&t->sources[i].error, error);
	if (!status)
		status = plan_results(t, error);
	if (status)
		return status;
	nt_parallel_items(threads, t->result_count, make_result, t);
	for (size_t i = 0; i < t->result_count && !status; i++)
		status = fatal(&t->results[i].error, error);
	return status;
}

size_t nt_textures_count(const nt_textures *t)
{
	return t->result_count;
}

const nt_texture *nt_textures_at(const nt_textures *t, size_t number)
{
	return &t->results[number].texture;
}

size_t nt_textures_result(const nt_textures *t, uint32_t number)
{
	return t->wishes[number].result;
}
