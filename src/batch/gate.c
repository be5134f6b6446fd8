/* SPDX-License-Identifier: MIT */
/*
 * A bound of memory: see inside.h. First come, first served, so that small jobs do not keep a large one waiting for
 * ever.
 */
#include "batch/inside.h"

#include <string.h>
#include <sys/stat.h>

#include "file/input.h"
#include "format/format.h"

void nt_gate_init(nt_gate *gate, uint64_t limit)
{
	*gate = (nt_gate){.limit = limit ? limit : 1, .lock = PTHREAD_MUTEX_INITIALIZER,
		.changed = PTHREAD_COND_INITIALIZER};
}

void nt_gate_end(nt_gate *gate)
{
	pthread_cond_destroy(&gate->changed);
	pthread_mutex_destroy(&gate->lock);
}

static uint64_t share_of(const nt_gate *gate, uint64_t need)
{
	return need < gate->limit ? need : gate->limit;
}

bool nt_gate_enter(nt_gate *gate, uint64_t need)
{
	const uint64_t share = share_of(gate, need);
	pthread_mutex_lock(&gate->lock);
	const uint64_t turn = gate->arrived++;
	while (gate->entered != turn || share > gate->limit - gate->used)
		pthread_cond_wait(&gate->changed, &gate->lock);
	gate->entered++;
	gate->used += share;
	pthread_cond_broadcast(&gate->changed); /* the next in turn may fit, too */
	pthread_mutex_unlock(&gate->lock);
	return need > gate->limit;
}

void nt_gate_leave(nt_gate *gate, uint64_t need)
{
	pthread_mutex_lock(&gate->lock);
	gate->used -= share_of(gate, need);
	pthread_cond_broadcast(&gate->changed);
	pthread_mutex_unlock(&gate->lock);
}

/* ---- guesses ---- */

/*
 * A factor for each byte, measured with --verify and a report beside a megabyte: an
 * OBJ or a PLY takes 0.2 to 6, Draco 130 to 145. Bytes of glTF say less: buffers may be elsewhere, or shared. There it
 * is 12 for each byte of JSON, 1 for each other byte, and 46 for each "count" in the JSON, which is that of accessors;
 * 112 where there is or will be Draco.
 *
 * "make bench-need" prints what is taken and what is guessed. Files take more in which every corner is a vertex of its
 * own (an OBJ 26, a PLY with indices of a byte 90); images, instances that become one mesh, and accessors that morph
 * targets share are not seen.
 */

/* Bytes for any run, and for each byte of an OBJ or a PLY, of JSON, of Draco, and of a GLB at most. */
enum { LEAST = 1 << 20, BYTE_COST = 8, JSON_BYTE_COST = 12, DRACO_BYTE_COST = 160, MOST_BYTE_COST = 256 };

/* sum + cost * count; UINT64_MAX where that overflows: counts come from the file. */
static uint64_t plus(uint64_t sum, uint64_t cost, uint64_t count)
{
	uint64_t product;
	return __builtin_mul_overflow(cost, count, &product) || __builtin_add_overflow(sum, product, &sum)
		? UINT64_MAX : sum;
}

/* The number behind a key of JSON; 0: none. */
static uint64_t number_after(const char *text, const char *end)
{
	uint64_t number = 0;
	while (text < end && *text && strchr(": \t\r\n", *text))
		text++;
	for (; text < end && *text >= '0' && *text <= '9'; text++)
		number = plus((uint64_t)(*text - '0'), 10, number);
	return number;
}

static uint64_t gltf_need(const nt_file *file, const nt_settings *settings)
{
	static const char count[] = "\"count\"", draco[] = "KHR_draco_mesh_compression";
	enum { HEAD = 20, LENGTH_AT = 12 };
	const char *text = (const char *)file->data;
	size_t size = file->size;
	if (size >= HEAD && memcmp(text, "glTF", 4) == 0) {
		/* the JSON is the first chunk */
		const unsigned char *b = file->data + LENGTH_AT;
		const size_t length = b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
		text += HEAD;
		size = length < size - HEAD ? length : size - HEAD;
	}
	const char *const end = text + size;
	const bool compressed = settings->io.draco == NT_DRACO_AS_SEQUENTIAL ||
		settings->io.draco == NT_DRACO_AS_EDGEBREAKER || memmem(text, size, draco, sizeof draco - 1);
	uint64_t counts = 0;
	for (const char *at = text; (at = memmem(at, (size_t)(end - at), count, sizeof count - 1));) {
		at += sizeof count - 1;
		counts = plus(counts, 1, number_after(at, end));
	}
	return plus(LEAST + (JSON_BYTE_COST - 1) * (uint64_t)size + file->size, compressed ? 112 : 46, counts);
}

uint64_t nt_need_of(const char *input, const nt_settings *settings, uint64_t enough)
{
	struct stat info;
	nt_file file;
	nt_error error; /* the run meets it again */
	if (strcmp(input, "-") == 0)
		return UINT64_MAX;
	if (stat(input, &info) != 0)
		return 0;
	if (!S_ISREG(info.st_mode))
		return UINT64_MAX;
	const nt_format_entry *named = nt_format_of_path(input);
	const nt_format format = named ? named->format : NT_FORMAT_UNKNOWN;
	const uint64_t size = (uint64_t)info.st_size;
	if (!nt_format_is_gltf(format))
		return LEAST + (format == NT_FORMAT_DRC ? DRACO_BYTE_COST : BYTE_COST) * size;
	if (format == NT_FORMAT_GLB && LEAST + MOST_BYTE_COST * size <= enough)
		return LEAST + MOST_BYTE_COST * size;
	nt_file_open(&file, input, NT_NAMED_BY_US, &error); /* of a failure there are no bytes */
	const uint64_t need = gltf_need(&file, settings);
	nt_file_close(&file);
	return need;
}
