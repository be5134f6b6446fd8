/* SPDX-License-Identifier: MIT */
/*
 * The images of one output: see textures.h. A source is a file; a request names sources and what they become; requests
 * with the same bytes share a result. nt_textures_make() turns requests into results: whether a source is a height
 * map is known when its first rows are decoded.
 *
 * Files are opened to see their type and closed again, so that a thousand images do not need a thousand
 * descriptors; later readers check that they are still the same.
 */
#include "image/textures.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "file/output.h"
#include "file/path.h"

/* Results that are larger wait in files: a thousand smaller ones take less memory than one image being decoded. */
enum { FILED_BYTES = 256 * 1024 };

typedef struct source {
	nt_texture_source file;
	char *path;
	bool in_question; /* somebody wants to know whether it is grey */
	bool grey;
	nt_error error;   /* of looking whether it is grey */
	uint32_t result;  /* the first that is the file as it is; UINT32_MAX: none */
} source;

/* In the conversion stand the sources; whether it is one for heights is said by the kind. */
typedef struct request {
	nt_texture_kind kind;
	nt_conversion how;
	uint32_t result;
} request;

typedef struct result {
	nt_conversion how;
	nt_texture texture;
	char *name;
	nt_error error;
	uint32_t same; /* the first result that is the same file */
} result;

struct nt_textures {
	nt_arena arena;      /* of the keys in names */
	nt_name_table names; /* document and name, which lead to a source */
	uint32_t *name_sources;
	size_t name_capacity;
	source **sources;
	size_t source_count, source_capacity;
	request *requests;
	size_t request_count, request_capacity;
	result *results;
	size_t result_count, result_capacity;
	nt_name_table paths;      /* of sources, by their numbers */
	nt_key_set conversions;   /* of results, by theirs */
	nt_texture_rules rules;
	uint64_t pixels;    /* decoded and made */
	const char *beside; /* path next to which large results are in files; NULL: all are in memory */
};

nt_textures *nt_textures_create(const char *beside)
{
	nt_textures *t = nt_calloc(1, sizeof *t);
	if (t)
		t->beside = beside;
	return t;
}

void nt_textures_free(nt_textures *t)
{
	if (!t)
		return;
	for (size_t i = 0; i < t->source_count; i++) {
		free(t->sources[i]->path);
		free(t->sources[i]);
	}
	for (size_t i = 0; i < t->result_count; i++) {
		const nt_texture *texture = &t->results[i].texture;
		if (texture->mapped)
			munmap((void *)(uintptr_t)texture->bytes, texture->size);
		else
			free((void *)(uintptr_t)texture->bytes);
		free(t->results[i].name);
	}
	free(t->sources);
	free(t->requests);
	free(t->results);
	free(t->name_sources);
	nt_name_table_free(&t->paths);
	nt_key_set_free(&t->conversions);
	nt_name_table_free(&t->names);
	nt_arena_free(&t->arena);
	free(t);
}

/* ---- requests ---- */

/* Looks into the file for its type and identity, if there is one. */
static nt_status inspect(nt_textures *t, nt_texture_source *s, nt_error *error)
{
	nt_file file;
	nt_status status = NT_OK;
	if (s->found <= NT_IMAGE_FOUND_ELSEWHERE)
		status = nt_file_open(&file, s->path, NT_NAMED_BY_DOCUMENT, error);
	if (status == NT_ERROR_MISSING) {
		s->found = NT_IMAGE_MISSING;
		s->obstacle = nt_arena_text(&t->arena, error->message, strlen(error->message));
		status = s->obstacle ? NT_OK : nt_fail_memory(error);
	}
	if (s->found == NT_IMAGE_MISSING)
		s->type = nt_image_type_of_name(s->path);
	if (status || s->found > NT_IMAGE_FOUND_ELSEWHERE)
		return status;
	s->type = nt_image_type_of_bytes(file.data, file.size);
	uint32_t sides[2];
	nt_image_size(file.data, file.size, sides);
	s->pixels = (uint64_t)sides[0] * sides[1];
	s->identity = (nt_file){.size = file.size, .fd = -1, .device = file.device, .inode = file.inode};
	nt_file_close(&file);
	return NT_OK;
}

static nt_status add_source(nt_textures *t, const nt_image_places *places, const char *name, uint32_t *number,
	nt_error *error)
{
	nt_buffer path = {0};
	nt_image_found found;
	const nt_status status = nt_image_find(places, name, &path, &found, error);
	*number = status ? 0 : nt_name_add(&t->paths, path.data, path.size);
	if (status || *number < t->source_count) {
		nt_buffer_free(&path);
		return status;
	}
	source *s = nt_calloc(1, sizeof *s);
	if (*number == UINT32_MAX || !s ||
		!nt_grow((void **)&t->sources, &t->source_capacity, t->source_count + 1, sizeof *t->sources)) {
		nt_buffer_free(&path);
		free(s);
		return nt_fail_memory(error);
	}
	t->sources[t->source_count++] = s;
	s->path = path.data;
	s->result = UINT32_MAX;
	s->file = (nt_texture_source){.number = *number, .path = path.data, .found = found};
	return inspect(t, &s->file, error);
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

/* The parts of a request that make a difference, the others zero, so that equal conversions are one. */
static nt_conversion wanted(const nt_texture_request *what, const uint32_t sources[4])
{
	const bool packed = what->kind == NT_TEXTURE_PACKED;
	const bool heights = what->kind == NT_TEXTURE_HEIGHTS || what->kind == NT_TEXTURE_NORMALS_OR_HEIGHTS;
	nt_conversion how = {.packed = packed, .heights = heights, .height = heights ? what->height : 0,
		.clamp = (packed || heights) && what->clamp, .suffix = what->suffix};
	for (int k = 0; k < (packed ? 4 : 1); k++) {
		const nt_texture_channel *c = &what->channels[k];
		how.channels[k] = (nt_conversion_channel){.used = c->used || !packed, .source = sources[k]};
		if (packed || heights)
			how.channels[k].map = c->map;
	}
	return how;
}

nt_status nt_textures_request(nt_textures *t, const nt_image_places *places, const nt_texture_request *what,
	uint32_t *number, nt_error *error)
{
	static const nt_image_places given = {.document = "", .given = true};
	uint32_t sources[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
	nt_status status = NT_OK;
	for (int k = 0; k < (what->kind == NT_TEXTURE_PACKED ? 4 : 1) && !status; k++)
		if (what->channels[k].name)
			status = find_source(t, what->channels[k].given ? &given : places, what->channels[k].name,
				&sources[k], error);
	if (status)
		return status;
	const nt_conversion how = wanted(what, sources);
	if (what->kind == NT_TEXTURE_NORMALS_OR_HEIGHTS)
		t->sources[sources[0]]->in_question = true;
	*number = (uint32_t)t->request_count;
	if (!nt_grow((void **)&t->requests, &t->request_capacity, t->request_count + 1, sizeof *t->requests))
		return nt_fail_memory(error);
	t->requests[t->request_count++] = (request){.kind = what->kind, .how = how};
	return NT_OK;
}

/* ---- sources ---- */

static bool can_decode(const nt_texture_source *s)
{
	return s->found <= NT_IMAGE_FOUND_ELSEWHERE && nt_image_is_decoded(s->type);
}

/* Opens a source that was looked at before. The caller has to ask whether a file becomes shorter while it is read: see
 * close_source(). */
static nt_status open_source(const nt_texture_source *s, nt_file *file, nt_error *error)
{
	const nt_status status = nt_file_open(file, s->path, NT_NAMED_BY_US, error);
	if (status)
		return status;
	if (file->size == s->identity.size && file->device == s->identity.device && file->inode == s->identity.inode)
		return NT_OK;
	nt_file_close(file);
	return nt_fail_file(error, NT_ERROR_IO, s->path, "the image changed while it was read");
}

static nt_status close_source(const nt_texture_source *s, nt_file *file, nt_status status, nt_error *error)
{
	const bool intact = nt_file_is_intact(file);
	nt_file_close(file);
	if (intact)
		return status;
	return nt_fail_file(error, NT_ERROR_IO, s->path, "the image became shorter while it was read");
}

static void look_for_grey(void *context, size_t item, unsigned slot)
{
	(void)slot;
	nt_textures *t = context;
	source *s = t->sources[item];
	nt_file file;
	nt_error_clear(&s->error);
	if (!s->in_question || !can_decode(&s->file) || open_source(&s->file, &file, &s->error))
		return;
	const nt_status status = nt_image_is_grey(file.data, file.size, &s->grey, &s->error);
	close_source(&s->file, &file, status, &s->error);
}

/* ---- results ---- */

/* The conversion of one image, as it is requested or of heights. */
static nt_conversion conversion_of_one(const nt_textures *t, nt_texture_kind kind, const nt_conversion *wanted)
{
	const uint32_t from = wanted->channels[0].source;
	const nt_texture_source *s = &t->sources[from]->file;
	const nt_texture_choice choice = t->rules.choice;
	const bool decodable = can_decode(s);
	const bool heights = decodable &&
		(kind == NT_TEXTURE_HEIGHTS || (kind == NT_TEXTURE_NORMALS_OR_HEIGHTS && t->sources[from]->grey));
	if (heights) {
		nt_conversion how = *wanted;
		how.png = choice != NT_TEXTURES_KEEP;
		return how;
	}
	const bool converted = decodable && nt_image_is_converted(s->type);
	const bool png = converted && choice != NT_TEXTURES_KEEP &&
		(choice == NT_TEXTURES_PNG ? s->type != NT_IMAGE_PNG : !nt_image_is_carried(s->type));
	const bool normals = kind == NT_TEXTURE_NORMALS || kind == NT_TEXTURE_NORMALS_OR_HEIGHTS;
	const bool may_flip = converted && normals && (png || nt_image_is_carried(s->type));
	return (nt_conversion){.channels = {{.used = true, .source = from}}, .png = png,
		.flip = may_flip ? t->rules.flip : NT_FLIP_OFF};
}

/* The result of a request; *lost receives the channels that have no image. */
static nt_conversion conversion_of(const nt_textures *t, const request *w, unsigned *lost)
{
	*lost = 0;
	if (w->kind != NT_TEXTURE_PACKED)
		return conversion_of_one(t, w->kind, &w->how);
	if (nt_conversion_is_identity(&w->how))
		return conversion_of_one(t, NT_TEXTURE_COLOR, &w->how);
	nt_conversion how = w->how;
	how.png = t->rules.choice == NT_TEXTURES_PNG;
	for (int k = 0; k < 4; k++) {
		const uint32_t from = how.channels[k].source;
		if (!how.channels[k].used || from == UINT32_MAX || can_decode(&t->sources[from]->file))
			continue;
		*lost |= 1u << k;
		how.channels[k].source = UINT32_MAX;
	}
	return how;
}

/* The file's name; of what was made, with another ending. NULL: out of memory. */
static char *name_of(const nt_conversion *how, const nt_texture *texture)
{
	const char *name = nt_last_part(texture->sources[0]->path), *dot = strrchr(name, '.');
	nt_buffer text = {0};
	nt_buffer_append(&text, name, texture->made && dot > name ? (size_t)(dot - name) : strlen(name));
	if (texture->made)
		nt_buffer_format(&text, "%s.png",
			how->packed ? how->suffix
			: texture->from_heights ? "-normal" : texture->flipped ? "-green-up" : "");
	if (text.failed)
		nt_buffer_free(&text);
	return text.data;
}

/* The files that it takes, each once, in the order of the channels. */
static void list_sources(const nt_textures *t, const nt_conversion *how, nt_texture *texture)
{
	for (int k = 0; k < 4; k++) {
		const uint32_t from = how->channels[k].source;
		const nt_texture_source *s = how->channels[k].used && from != UINT32_MAX
			? &t->sources[from]->file : NULL;
		bool known = !s;
		for (size_t i = 0; i < texture->source_count && !known; i++)
			known = texture->sources[i] == s;
		if (!known)
			texture->sources[texture->source_count++] = s;
	}
}

static nt_status add_result(nt_textures *t, const nt_conversion *how, unsigned lost, nt_error *error)
{
	if (!nt_grow((void **)&t->results, &t->result_capacity, t->result_count + 1, sizeof *t->results))
		return nt_fail_memory(error);
	result *r = &t->results[t->result_count];
	*r = (result){.how = *how, .same = (uint32_t)t->result_count++,
		.texture = {.from_heights = how->heights, .packed = how->packed, .lost = lost, .type = NT_IMAGE_OTHER}};
	nt_texture *texture = &r->texture;
	list_sources(t, how, texture);
	if (how->packed || !texture->source_count)
		return NT_OK;
	/* what is decoded gets its type there */
	const source *s = t->sources[how->channels[0].source];
	if (s->file.found != NT_IMAGE_OUTSIDE && nt_image_is_carried(s->file.type))
		texture->type = s->file.type;
	texture->failure = s->error.status ? s->error.message : NULL;
	return NT_OK;
}

static nt_status plan_results(nt_textures *t, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < t->request_count && !status; i++) {
		unsigned lost;
		nt_conversion how = conversion_of(t, &t->requests[i], &lost);
		if (t->rules.judged_only)
			nt_conversion_simplify(&how);
		double key[NT_CONVERSION_KEY + 1];
		nt_conversion_key(&how, key);
		key[NT_CONVERSION_KEY] = lost;
		const uint32_t number = nt_key_add(&t->conversions, key, sizeof key);
		t->requests[i].result = number;
		if (number == UINT32_MAX)
			status = nt_fail_memory(error);
		else if (number == t->result_count)
			status = add_result(t, &how, lost, error);
	}
	return status;
}

/* ---- making ---- */

/* The files of a result while it is made: each is opened once. */
typedef struct opened {
	nt_file files[4];
	const nt_file *of_channels[4];
	size_t count;
} opened;

static nt_status open_sources(const nt_texture *texture, const nt_textures *t, const nt_conversion *how, opened *o,
	nt_error *error)
{
	*o = (opened){.count = 0};
	nt_status status = NT_OK;
	for (size_t i = 0; i < texture->source_count && !status; i++) {
		status = open_source(texture->sources[i], &o->files[i], error);
		o->count += !status;
	}
	for (int k = 0; k < 4 && !status; k++)
		for (size_t i = 0; i < o->count; i++)
			if (how->channels[k].used && how->channels[k].source != UINT32_MAX &&
				texture->sources[i] == &t->sources[how->channels[k].source]->file)
				o->of_channels[k] = &o->files[i];
	return status;
}

static void note_failure(result *r)
{
	nt_texture *texture = &r->texture;
	const bool as_it_is = !r->how.png && !r->how.heights && !r->how.packed;
	texture->type = as_it_is ? texture->sources[0]->type : NT_IMAGE_OTHER;
	for (int k = 0; k < 4 && r->how.packed; k++)
		if (r->how.channels[k].used && r->how.channels[k].source != UINT32_MAX)
			texture->damaged |= 1u << k;
	texture->lost |= texture->damaged;
	texture->failure = r->error.message;
}

/* The bytes in a file without a name, which take no memory. NULL: the system refuses one. */
static void *map_in_file(const char *beside, const unsigned char *bytes, size_t size)
{
	nt_temporary *temporary;
	const int fd = beside ? nt_temporary_create(beside, 0600, NULL, &temporary) : -1;
	if (fd < 0)
		return NULL;
	size_t done = 0;
	for (ssize_t count = 1; done < size && count > 0; done += count > 0 ? (size_t)count : 0)
		count = write(fd, bytes + done, size - done);
	void *map = done == size ? mmap(NULL, size, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
	nt_temporary_discard(temporary);
	return map == MAP_FAILED ? NULL : map;
}

static void decode_result(const nt_textures *t, result *r)
{
	nt_texture *texture = &r->texture;
	nt_converted made = {0};
	opened files;
	nt_status status = open_sources(texture, t, &r->how, &files, &r->error);
	if (!status)
		status = nt_conversion_make(&r->how, files.of_channels, t->rules.judged_only, &made, &r->error);
	for (size_t i = 0; i < files.count; i++)
		status = close_source(texture->sources[i], &files.files[i], status, &r->error);
	void *map = made.size >= FILED_BYTES ? map_in_file(t->beside, made.bytes, made.size) : NULL;
	texture->made = made.made;
	texture->mapped = map != NULL;
	texture->bytes = map ? map : made.bytes;
	texture->size = made.size;
	if (map)
		free(made.bytes);
	texture->damaged = made.damaged;
	texture->lost |= made.damaged;
	if (status) {
		note_failure(r);
		return;
	}
	if (made.damaged)
		texture->failure = r->error.message;
	else
		nt_error_clear(&r->error);
	texture->flipped = made.flipped;
	texture->alpha = made.alpha;
	texture->type = made.made ? NT_IMAGE_PNG : texture->sources[0]->type;
}

static void make_result(void *context, size_t item, unsigned slot)
{
	(void)slot;
	nt_textures *t = context;
	result *r = &t->results[item];
	nt_error_clear(&r->error);
	if (nt_conversion_decodes(&r->how) && r->texture.source_count)
		decode_result(t, r);
	if (!r->texture.source_count)
		return;
	r->texture.name = r->name = name_of(&r->how, &r->texture);
	if (!r->name)
		nt_fail_memory(&r->error);
}

/* Passes on what is not the image's fault. */
static nt_status fatal(const nt_error *failure, nt_error *error)
{
	if (failure->status != NT_ERROR_MEMORY && failure->status != NT_ERROR_IO &&
		failure->status != NT_ERROR_MISSING &&
		failure->status != NT_ERROR_MODULE)
		return NT_OK;
	*error = *failure;
	return failure->status;
}

/* Results that turned out to be a file as it is are one. */
static void join_results(nt_textures *t)
{
	for (size_t i = 0; i < t->result_count; i++) {
		result *r = &t->results[i];
		if (r->texture.made || r->texture.type == NT_IMAGE_OTHER)
			continue;
		source *s = t->sources[r->texture.sources[0]->number];
		if (s->result == UINT32_MAX)
			s->result = (uint32_t)i;
		r->same = s->result;
	}
}

uint64_t nt_textures_pixels(const nt_textures *t, uint64_t *bytes)
{
	*bytes = 0;
	for (size_t i = 0; i < t->source_count; i++)
		*bytes += t->sources[i]->file.identity.size;
	return t->pixels;
}

/* Pixels count as often as a decoder goes over them, for which the whole file has to be seen. */
static nt_status count_work(const nt_textures *t, nt_error *error)
{
	bool *decoded = nt_calloc(t->source_count, sizeof *decoded);
	nt_status status = decoded ? NT_OK : nt_fail_memory(error);
	for (size_t i = 0; i < t->source_count && !status; i++)
		decoded[i] = t->sources[i]->in_question;
	for (size_t i = 0; i < t->result_count && !status; i++)
		for (int k = 0; k < 4 && nt_conversion_decodes(&t->results[i].how); k++)
			if (t->results[i].how.channels[k].used && t->results[i].how.channels[k].source != UINT32_MAX)
				decoded[t->results[i].how.channels[k].source] = true;
	for (size_t i = 0; i < t->source_count && !status; i++) {
		nt_texture_source *s = &t->sources[i]->file;
		nt_file file;
		nt_error ignored; /* who decodes it meets it again, and says it */
		/* what is larger than any decoder takes is left out by its header */
		if (!decoded[i] || !can_decode(s) || s->pixels > NT_PIXELS_MOST)
			continue;
		if ((s->type == NT_IMAGE_JPEG || s->type == NT_IMAGE_TIFF) && !open_source(s, &file, &ignored)) {
			s->pixels = nt_image_work(file.data, file.size);
			nt_file_close(&file);
		}
		status = nt_check_image(s->pixels, t->rules.max_pixels, s->identity.size, s->path, error);
	}
	free(decoded);
	return status;
}

/* Each source counts for each result that it is decoded for, and where somebody wants to know whether it is grey. */
static nt_status check_pixels(nt_textures *t, nt_error *error)
{
	uint64_t bytes, pixels = 0;
	if (count_work(t, error))
		return error->status;
	nt_textures_pixels(t, &bytes);
	for (size_t i = 0; i < t->source_count; i++)
		pixels += t->sources[i]->in_question && can_decode(&t->sources[i]->file)
			? t->sources[i]->file.pixels : 0;
	for (size_t i = 0; i < t->result_count; i++)
		for (size_t k = 0; k < t->results[i].texture.source_count; k++)
			pixels += nt_conversion_decodes(&t->results[i].how)
				? t->results[i].texture.sources[k]->pixels : 0;
	t->pixels = pixels;
	return nt_check_pixels(pixels, t->rules.max_pixels, bytes, error);
}

nt_status nt_textures_make(nt_textures *t, const nt_texture_rules *rules, nt_error *error)
{
	t->rules = *rules;
	const unsigned threads = nt_thread_count(rules->threads);
	if (check_pixels(t, error))
		return error->status;
	nt_parallel_items(threads, t->source_count, look_for_grey, t);
	nt_status status = NT_OK;
	for (size_t i = 0; i < t->source_count && !status; i++)
		status = fatal(&t->sources[i]->error, error);
	if (!status)
		status = plan_results(t, error);
	if (!status)
		status = check_pixels(t, error);
	if (status)
		return status;
	nt_parallel_items(threads, t->result_count, make_result, t);
	for (size_t i = 0; i < t->result_count && !status; i++)
		status = fatal(&t->results[i].error, error);
	if (!status)
		join_results(t);
	return status;
}

size_t nt_textures_requests(const nt_textures *t)
{
	return t->request_count;
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
	return t->results[t->requests[number].result].same;
}

const nt_texture *nt_textures_of(const nt_textures *t, uint32_t number)
{
	return &t->results[t->requests[number].result].texture;
}

const nt_texture_source *nt_textures_source(const nt_textures *t, uint32_t number, int channel)
{
	return &t->sources[t->requests[number].how.channels[channel].source]->file;
}

void nt_texture_release_pages(const nt_texture *texture)
{
	if (texture->mapped)
		madvise((void *)(uintptr_t)texture->bytes, texture->size, MADV_DONTNEED);
}
