/* SPDX-License-Identifier: MIT */
/*
 * The edited document as files: .gltf with its buffers, .gltf with everything in it, or .glb. Data URIs are encoded
 * while the text is written: the JSON has their heads alone, as strings that are left open, and a new document has open
 * arrays, whose elements are text already. In the JSON a buffer would take its size four times over: its bytes, their
 * base64, the string's copy, and the text.
 *
 * A buffer stays what it was where it can: a data URI remains one, an external file that nothing
 * changed is linked to, several buffers remain several. A changed external buffer becomes a sidecar of
 * the output, so that no file of the input is ever written. A .glb from a .gltf is one file unless files
 * are asked for: buffer 0 is the BIN chunk and the others are data URIs. Their bytes could be one chunk, as
 * other tools have it, but only with other buffer numbers and offsets, to which extensions that we do not
 * know may refer.
 */
#include "gltf/bytes/bytes.h"

#include <stdio.h>
#include <string.h>
#include "file/path.h"
#include "gltf/document.h"
#include "gltf/edit/edit.h"

/* An edited document on its way into files. */
typedef struct writing {
	nt_scene *scene;
	nt_gltf *document;
	nt_json *json;
	nt_gltf_output output;
	const nt_write_options *options; /* the output's */
	nt_file input;                   /* the document's own file, to stream from */
	nt_buffer_edits *edits;
	nt_sink *main;
	nt_sink **sidecars;            /* [buffer count] the files that buffers are written to; NULL: none */
	nt_arena *arena;
	nt_error *error;
	bool to_glb, same_container, embed, in_place;
} writing;

/* Treatment of a buffer. */
typedef enum destination {
	KEPT,   /* its JSON stays as it is */
	LINKED, /* the same file, seen from the output's folder */
	TO_DATA_URI,
	TO_BIN_CHUNK,
	TO_SIDECAR /* a file beside the output */
} destination;

/* Zeros that a .glb may begin with because the source's first buffer has no data. */
enum { EMPTY_BYTES = 1 << 24 };

/* ---- the input as it is ---- */

/* The document's own file, to stream from. */
static nt_file input_file(const nt_scene *scene)
{
	if (scene->file)
		return *scene->file;
	return (nt_file){.data = scene->bytes, .size = scene->byte_count, .fd = -1};
}

static bool has_external(const nt_gltf *document, const char *array)
{
	const nt_json_value *elements = nt_gltf_root_member(document, array);
	size_t length;
	for (size_t i = 0; i < nt_json_count(elements); i++)
		if (nt_gltf_external_uri(nt_json_at(elements, i), &length))
			return true;
	return false;
}

nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error)
{
	const nt_gltf *document = scene->source;
	const bool same_container = (options->format == NT_FORMAT_GLB) == document->is_glb;
	const bool buffers = has_external(document, "buffers"), images = has_external(document, "images");
	const nt_images choice = nt_gltf_images_choice(options, document);
	nt_arena arena = {0};
	const char *prefix = "";
	nt_status status = NT_OK;
	*written = false;
	if (buffers || images)
		status = nt_gltf_link_prefix(&arena, options->path, scene->path, &prefix, error);
	const bool moves = *prefix && (buffers || images);
	const bool embeds = (options->buffers == NT_BUFFERS_EMBED && buffers) || (choice == NT_IMAGES_EMBED && images);
	nt_arena_free(&arena);
	if (status || !same_container || moves || embeds)
		return status;
	*written = true;
	status = nt_gltf_look_for_images(scene, true, error);
	if (status)
		return status;
	if (nt_output_is_in_place(output, options->path)) {
		nt_output_leave(output);
		return NT_OK;
	}
	const nt_file file = input_file(scene);
	nt_sink *sink;
	status = nt_output_add(output, options->path, NT_ROLE_MAIN, &sink, error);
	return status ? status : nt_sink_copy(sink, &file, 0, file.size, error);
}

/* ---- the text ---- */

static const char plain_head[] = "data:application/octet-stream;base64,";

/* The length of a data URI before its data; 0: it has none that could stay. */
static size_t head_length(const char *uri, size_t length)
{
	static const char ending[] = ";base64,";
	const char *comma = uri && nt_uri_is_data(uri, length) ? memchr(uri, ',', length) : NULL;
	const size_t head = comma ? (size_t)(comma - uri) + 1 : 0;
	return head >= strlen(ending) && memcmp(uri + head - strlen(ending), ending, strlen(ending)) == 0 ? head : 0;
}

/* Gives a buffer a uri without its data. */
static void leave_open(writing *c, uint32_t index)
{
	nt_json_value *object = nt_json_at(nt_gltf_root_member(c->document, "buffers"), index);
	size_t length = 0;
	const char *uri = nt_json_find_string(object, "uri", &length);
	const size_t head = head_length(uri, length);
	c->edits->buffers[index].encoded = true;
	nt_json_set_open(c->json, nt_json_put(c->json, object, "uri"), head ? uri : plain_head,
		head ? head : sizeof plain_head - 1);
}

/* The length of the text with the data. */
static nt_status measure_text(const writing *c, uint64_t *length)
{
	const nt_buffer_edits *edits = c->edits;
	const nt_status status = nt_json_measure(c->json, length, c->error);
	for (size_t i = 0; !status && i < edits->list_count; i++)
		*length += edits->lists[i].size;
	for (size_t i = 0; !status && i < edits->buffer_count; i++)
		*length += edits->buffers[i].encoded ? nt_base64_length(edits->buffers[i].length) : 0;
	return status;
}

typedef struct text_sink {
	const writing *c;
	nt_sink *sink;
	uint32_t next, list; /* buffers come in their order, wherever the array stands; lists before them */
} text_sink;

static nt_status put_text(void *user, const char *text, size_t size)
{
	text_sink *to = user;
	nt_buffer_edits *edits = to->c->edits;
	while (!size && to->list < edits->list_count) {
		const nt_buffer *list = &edits->lists[to->list++];
		text = list->data;
		size = list->size;
	}
	if (size)
		return nt_sink_write(to->sink, text, size, to->c->error);
	while (!edits->buffers[to->next].encoded)
		to->next++;
	nt_base64 base64 = {.sink = to->sink};
	const nt_status status = nt_edits_encode(edits, to->next++, &base64, to->c->error);
	return status ? status : nt_base64_end(&base64, to->c->error);
}

static nt_status write_text(const writing *c, nt_sink *sink)
{
	return nt_json_write(c->json, put_text, &(text_sink){c, sink, 0, 0}, c->error);
}

/* ---- what happens to each buffer ---- */

static bool link_leaves(const writing *c, uint32_t index)
{
	const nt_json_value *buffer = nt_json_at(nt_gltf_root_member(c->document, "buffers"), index);
	return !c->output.is_stream && nt_gltf_link_leaves(buffer, c->output.link_prefix);
}

static destination choose_destination(const writing *c, uint32_t index)
{
	const nt_gltf *document = c->document;
	const bool edited = nt_is_edited(&c->edits->buffers[index]);
	/* The BIN chunk can be buffer 0 only, and only when the source's own chunk is not something else. */
	const bool chunk_is_other = document->is_glb && document->glb.has_bin &&
		document->buffer_count && document->buffers[0].storage != NT_GLTF_STORED_BIN;
	/* beside the output, if the user wants that; standard output has none */
	const nt_buffers wish = c->options->buffers;
	const bool files = (wish == NT_BUFFERS_LINK || wish == NT_BUFFERS_COPY) && !c->output.is_stream;
	const destination in_glb = index == 0 && !chunk_is_other ? TO_BIN_CHUNK : files ? TO_SIDECAR : TO_DATA_URI;
	const destination moved = c->to_glb ? in_glb : c->embed ? TO_DATA_URI : TO_SIDECAR;
	if (index >= document->buffer_count)
		return moved;
	const nt_gltf_buffer *buffer = &document->buffers[index];
	const bool into_glb = c->to_glb && !c->same_container;
	size_t length;
	if (!buffer->described) /* something is wrong with one that nobody wants: the name of a file stays right */
		return nt_gltf_external_uri(nt_json_at(nt_gltf_root_member(document, "buffers"), index), &length) ?
			LINKED : KEPT;
	switch (buffer->storage) {
	case NT_GLTF_STORED_BIN:
		return moved;
	case NT_GLTF_STORED_DATA:
		if (into_glb && index == 0)
			return TO_BIN_CHUNK;
		return edited ? TO_DATA_URI : KEPT;
	case NT_GLTF_STORED_FILE:
		if (edited || c->embed || (into_glb && !files))
			return moved;
		/* where the folder stays the same it is there already, as with images */
		if (wish == NT_BUFFERS_COPY && *c->output.link_prefix && files)
			return TO_SIDECAR;
		return wish == NT_BUFFERS_DEFAULT && link_leaves(c, index) ? TO_SIDECAR : LINKED;
	default:
		/* Buffer 0 of a .glb without a uri is the BIN chunk, so there has to be one. */
		return into_glb && index == 0 && buffer->length <= EMPTY_BYTES ? TO_BIN_CHUNK : KEPT;
	}
}

/* "out.bin", "out-1.bin" for the others, where those names are to be had. */
static nt_status name_sidecar(writing *c, uint32_t index, bool first, const char **path)
{
	const char *out = c->options->path;
	const char *slash = strrchr(out, '/'), *dot = strrchr(out, '.');
	const size_t stem = dot && (!slash || dot > slash + 1) && dot != out ? (size_t)(dot - out) :
									       strlen(out);
	char *name = nt_arena_alloc(c->arena, stem + 40, 1);
	if (!name)
		return nt_fail_memory(c->error);
	memcpy(name, out, stem);
	if (first)
		strcpy(name + stem, ".bin");
	else
		snprintf(name + stem, 40, "-%u.bin", index);
	*path = name;
	return NT_OK;
}

static nt_status write_sidecar(writing *c, uint32_t index, bool first)
{
	const char *path = NULL;
	nt_sink *sink = NULL;
	nt_status status = name_sidecar(c, index, first, &path);
	if (!status)
		status = nt_output_add(c->output.set, path, NT_ROLE_BUFFER, &sink, c->error);
	if (!status) {
		nt_sink_expect(sink, c->edits->buffers[index].length);
		status = nt_edits_write(c->edits, index, &c->input, sink, c->error);
	}
	if (!status)
		status = nt_output_settle(c->output.set, sink, c->error);
	c->sidecars[index] = sink;
	return status;
}

/* A .glb ends at 4 GiB. Said of the source's buffers before data URIs are made of those that cannot fit, and before a
 * file is begun; nt_glb_begin() adds the JSON's own length and a new buffer, of which the source has no place. */
static nt_status check_room(writing *c)
{
	uint64_t sum = 0;
	for (uint32_t i = 0; c->to_glb && i < c->document->buffer_count; i++) {
		const uint64_t length = c->edits->buffers[i].length;
		const destination what = choose_destination(c, i);
		if (what != TO_BIN_CHUNK && what != TO_DATA_URI)
			continue;
		/* no sum of lengths below 2^32 wraps */
		if (length <= UINT32_MAX)
			sum += what == TO_DATA_URI ? nt_base64_length(length) : length;
		if (length <= UINT32_MAX && sum <= UINT32_MAX)
			continue;
		char pointer[NT_GLTF_POINTER];
		snprintf(pointer, sizeof pointer, "/buffers/%u", i);
		return nt_fail_pointer(c->error, NT_ERROR_UNSUPPORTED, pointer,
			"with this buffer of %llu bytes the output would take 4 GiB or more, which GLB cannot "
			"hold; write .gltf", (unsigned long long)length);
	}
	return NT_OK;
}

/* A buffer that will be written must be open before its uri changes, and have its length before room is made for it. */
static nt_status open_source(writing *c, uint32_t index, destination what)
{
	if (what == KEPT || what == LINKED || index >= c->document->buffer_count ||
		c->document->buffers[index].storage == NT_GLTF_STORED_NOWHERE)
		return NT_OK;
	nt_gltf_buffer *buffer;
	const nt_status status = nt_gltf_open_buffer(c->document, index, "/buffers", &buffer, c->error);
	/* A wrong length must not become that many zeros; padding may be missing. */
	if (status || buffer->length - buffer->size < NT_EDITS_ALIGNMENT)
		return status;
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/buffers/%u", index);
	return nt_fail_pointer(c->error, NT_ERROR_INPUT, pointer, "byteLength is %llu, but only %zu bytes are there",
		(unsigned long long)buffer->length, buffer->size);
}

/* Whether a buffer is copied only so that its uri stays in the output's folder. */
static bool can_stay(const writing *c, uint32_t index)
{
	return index < c->document->buffer_count && c->document->buffers[index].storage == NT_GLTF_STORED_FILE &&
		!nt_is_edited(&c->edits->buffers[index]) && !c->embed && c->options->buffers == NT_BUFFERS_DEFAULT;
}

/* Opens what will be written. A buffer that nothing needs does not fail the input: if it cannot be read, it stays a
 * link. */
static nt_status open_or_link(writing *c, uint32_t index, destination *what)
{
	nt_status status = open_source(c, index, *what);
	if (status && status != NT_ERROR_MEMORY && *what == TO_SIDECAR && can_stay(c, index)) {
		nt_gltf_tell(c->scene, "buffers", index, NT_CODE_LINK_LEAVES,
			c->error ? c->error->message : "it cannot be read");
		nt_error_clear(c->error);
		*what = LINKED;
		status = NT_OK;
	} else if (*what == LINKED && c->options->buffers == NT_BUFFERS_LINK && link_leaves(c, index)) {
		nt_gltf_tell(c->scene, "buffers", index, NT_CODE_LINK_LEAVES, "as --buffers=link asks");
	}
	return status;
}

/* Settles every buffer but the BIN chunk; *bin receives whether there is one. */
static nt_status settle_buffers(writing *c, bool *bin)
{
	bool first = true;
	nt_status status = NT_OK;
	*bin = false;
	for (uint32_t i = 0; !status && i < c->edits->buffer_count; i++) {
		nt_json_value *json = nt_json_at(nt_gltf_root_member(c->document, "buffers"), i);
		destination what = choose_destination(c, i);
		status = open_or_link(c, i, &what);
		if (status)
			break;
		/* in place, what is linked to is what it was */
		if (what != TO_SIDECAR && !(what == LINKED && c->in_place))
			nt_gltf_forget_record(c->json, json);
		switch (what) {
		case KEPT:
			break;
		case LINKED:
			status = nt_gltf_link(c->json, json, c->output.link_prefix, c->error);
			break;
		case TO_DATA_URI:
			leave_open(c, i);
			break;
		case TO_BIN_CHUNK:
			nt_json_remove(c->json, json, "uri");
			*bin = true;
			break;
		case TO_SIDECAR:
			status = write_sidecar(c, i, first);
			first = false;
			break;
		}
	}
	return status;
}

/* ---- the main file ---- */

static uint64_t other_bytes(const nt_gltf *document)
{
	uint64_t sum = 0;
	for (size_t i = 0; document->is_glb && i < document->glb.other_count; i++)
		sum += nt_glb_chunk_bytes(document->glb.others[i].size);
	return sum;
}

/* bin: the BIN chunk is buffer 0. */
static nt_status write_glb(const writing *c, uint64_t length, bool bin, nt_sink *sink)
{
	const nt_gltf *document = c->document;
	const bool raw = !bin && document->is_glb && document->glb.has_bin; /* it is no buffer, and stays */
	const uint64_t size = bin ? c->edits->buffers[0].length : raw ? document->glb.bin.size : 0;
	nt_status status = nt_glb_begin(sink, length, bin || raw, size, other_bytes(document), c->error);
	if (!status)
		status = write_text(c, sink);
	if (!status)
		status = nt_glb_end_json(sink, length, bin || raw, size, c->error);
	if (!status && bin)
		status = nt_edits_write(c->edits, 0, &c->input, sink, c->error);
	if (!status && raw)
		status = nt_sink_copy(sink, &c->input, document->glb.bin.offset, document->glb.bin.size, c->error);
	if (!status && (bin || raw))
		status = nt_glb_end_bin(sink, size, c->error);
	for (size_t i = 0; !status && document->is_glb && i < document->glb.other_count; i++) {
		const nt_glb_chunk *chunk = &document->glb.others[i];
		status = nt_glb_write_chunk(sink, chunk->type, document->bytes + chunk->offset, chunk->size, c->error);
	}
	return status;
}

/* The document with the names that its sidecars have in it. */
static nt_status write_document(writing *c, bool bin, bool staging, nt_sink *sink)
{
	uint64_t length;
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && i < c->edits->buffer_count; i++) {
		nt_json_value *json = nt_json_at(nt_gltf_root_member(c->document, "buffers"), i);
		if (c->sidecars[i])
			status = nt_gltf_record(c->json, json, c->sidecars[i], staging, c->error);
	}
	if (!status && !c->to_glb)
		return write_text(c, sink);
	if (!status)
		status = measure_text(c, &length);
	return status ? status : write_glb(c, length, bin, sink);
}

static nt_status write_main(writing *c, bool bin)
{
	nt_sink *sink;
	nt_status status = NT_OK;
	if (nt_output_has_staging(c->output.set)) {
		status = nt_output_add(c->output.set, c->options->path, NT_ROLE_STAGING, &sink, c->error);
		if (!status)
			status = write_document(c, bin, true, sink);
	}
	return status ? status : write_document(c, bin, false, c->main);
}

/* The output's files, all edits done. */
static nt_status write_files(writing *c)
{
	bool bin;
	const size_t count = c->edits->buffer_count;
	c->sidecars = nt_arena_alloc(c->arena, count, sizeof *c->sidecars);
	if (!c->sidecars)
		return nt_fail_memory(c->error);
	memset(c->sidecars, 0, count * sizeof *c->sidecars);
	nt_status status = check_room(c);
	if (!status)
		status = settle_buffers(c, &bin);
	if (!status)
		status = write_main(c, bin);
	return status;
}

nt_status nt_gltf_save(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	const char *link_prefix, nt_output *output, nt_sink *main, nt_error *error)
{
	nt_gltf *document = edits->document;
	const bool is_stream = nt_output_is_stream(options->path), to_glb = options->format == NT_FORMAT_GLB;
	writing c = {.scene = scene, .edits = edits, .document = document, .json = document->json,
		.output = {options, output, link_prefix, is_stream}, .options = options, .input = input_file(scene),
		.main = main, .arena = &edits->arena, .error = error,
		.to_glb = to_glb, .same_container = to_glb == document->is_glb,
		.embed = options->buffers == NT_BUFFERS_EMBED || (!to_glb && is_stream),
		.in_place = nt_output_is_in_place(output, options->path)};
	nt_status status = nt_edits_end(edits, error);
	if (!status)
		status = nt_gltf_check_dangling(document, error);
	return status ? status : write_files(&c);
}

/* ---- a document that was edited ---- */

/* In a .glb a buffer 0 without a uri is the BIN chunk. Bytes that exist nowhere cannot be put there: zeros would
 * be other data, and faulty where bounds or matrices are asked for. */
static nt_status check_first_buffer(nt_buffer_edits *edits, nt_format format, nt_error *error)
{
	const nt_gltf *document = edits->document;
	const nt_gltf_buffer *first = document->buffers;
	if (format != NT_FORMAT_GLB || document->is_glb || !document->buffer_count || !first->described ||
		first->storage != NT_GLTF_STORED_NOWHERE || nt_segments_before(edits, 1, 0) == 0)
		return NT_OK;
	return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, "/buffers/0",
		"no uri, so that a .glb would need its bytes as BIN chunk, which are not there; "
		"write .gltf");
}

/* Names that the output must not take: everything the document refers to. */
static nt_status protect_inputs(const nt_gltf *document, nt_arena *arena, nt_output *output, nt_error *error)
{
	const char *const arrays[] = {"buffers", "images"};
	nt_status status = NT_OK;
	for (size_t k = 0; k < 2; k++) {
		const nt_json_value *elements = nt_gltf_root_member(document, arrays[k]);
		for (size_t i = 0; !status && i < nt_json_count(elements); i++) {
			size_t length;
			const char *file, *uri = nt_gltf_external_uri(nt_json_at(elements, i), &length);
			if (uri && nt_uri_resolve(arena, document->path, uri, length, true, &file, NULL) == NT_OK)
				status = nt_output_protect(output, file, NULL, error);
		}
	}
	return status;
}

nt_status nt_gltf_write_document(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	nt_output *output, nt_error *error)
{
	const nt_gltf *document = edits->document;
	nt_gltf_output to = {options, output, "", nt_output_is_stream(options->path)};
	nt_open_images images = {0};
	nt_sink *main = NULL;
	nt_status status = NT_OK;
	if (has_external(document, "buffers") || has_external(document, "images"))
		status = nt_gltf_link_prefix(&edits->arena, options->path, document->path, &to.link_prefix, error);
	if (!status)
		status = check_first_buffer(edits, options->format, error);
	if (!status)
		status = protect_inputs(document, &edits->arena, output, error);
	/* The main file comes first, so that it is refused before anything is written. */
	if (!status)
		status = nt_output_add(output, options->path, NT_ROLE_MAIN, &main, error);

	/* The last edits: images move into the document. */
	if (!status)
		status = nt_gltf_move_images(scene, edits, &to, &images, error);
	if (!status)
		status = nt_gltf_save(scene, edits, options, to.link_prefix, output, main, error);
	nt_open_images_close(&images);
	return status;
}
