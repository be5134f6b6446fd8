/* SPDX-License-Identifier: MIT */
/*
 * Damaged files: see mutate.h. The text of JSON is walked once, which gives the span of every value; a change replaces
 * one span by other text, so that nothing has to be written anew. The replacement comes half of the time from the
 * document itself, under the same key: indices and counts that fit somewhere lead further than any others.
 */
#include "mutate.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_VALUES = 4096, MOST_DEPTH = 64, NO_VALUE = -1 };

/* ---- the document ---- */

typedef struct value {
	size_t begin, end;   /* of the text */
	size_t key, key_end; /* of a member's name with its quotes; equal: it is an element, or the document */
	int parent;
	size_t children;
} value;

typedef struct document {
	char *text;
	size_t size, room;
	uint32_t *seed;
	size_t at; /* of the walk */
	value values[MOST_VALUES];
	int count;
} document;

static void skip_space(document *d)
{
	while (d->at < d->size && d->text[d->at] && strchr(" \t\r\n", d->text[d->at]))
		d->at++;
}

static bool take(document *d, char c)
{
	skip_space(d);
	const bool there = d->at < d->size && d->text[d->at] == c;
	d->at += there;
	return there;
}

static bool take_string(document *d)
{
	if (!take(d, '"'))
		return false;
	while (d->at < d->size && d->text[d->at] != '"')
		d->at += d->text[d->at] == '\\' ? 2 : 1;
	return take(d, '"');
}

static bool take_word(document *d)
{
	const size_t begin = d->at;
	while (d->at < d->size && (unsigned char)d->text[d->at] > ' ' && !strchr(",]}:\"[{", d->text[d->at]))
		d->at++;
	return d->at > begin;
}

static bool walk(document *d, int parent, size_t key, size_t key_end, int depth);

static bool walk_children(document *d, int self, bool named, int depth)
{
	const char close = named ? '}' : ']';
	if (take(d, close))
		return true;
	do {
		skip_space(d);
		const size_t key = d->at;
		if (named && !take_string(d))
			return false;
		const size_t key_end = d->at;
		if (named && !take(d, ':'))
			return false;
		d->values[self].children++;
		if (!walk(d, self, key, key_end, depth + 1))
			return false;
	} while (take(d, ','));
	return take(d, close);
}

static bool walk(document *d, int parent, size_t key, size_t key_end, int depth)
{
	if (d->count == MOST_VALUES || depth == MOST_DEPTH)
		return false;
	skip_space(d);
	const int self = d->count++;
	d->values[self] = (value){.begin = d->at, .key = key, .key_end = key_end, .parent = parent};
	bool good;
	if (d->at < d->size && d->text[d->at] == '"')
		good = take_string(d);
	else if (take(d, '{'))
		good = walk_children(d, self, true, depth);
	else if (take(d, '['))
		good = walk_children(d, self, false, depth);
	else
		good = take_word(d);
	d->values[self].end = d->at;
	return good && d->at <= d->size;
}

static bool read_document(document *d)
{
	if (!walk(d, NO_VALUE, 0, 0, 0))
		return false;
	skip_space(d);
	return d->at == d->size;
}

/* ---- chance ---- */

uint32_t mutate_random(uint32_t *seed, uint32_t limit)
{
	*seed = *seed * 1664525u + 1013904223u;
	return limit ? (uint32_t)((uint64_t)(*seed >> 4) * limit >> 28) : 0;
}

#define ONE_OF(list) (list)[mutate_random(d->seed, sizeof(list) / sizeof *(list))]

static char kind_of(const document *d, int i)
{
	const char c = d->text[d->values[i].begin];
	return c == '"' || c == '{' || c == '[' ? c : (c >= '0' && c <= '9') || c == '-' ? '0' : 'w';
}

static bool is_named(const document *d, int i, const char *name, size_t length)
{
	const value *v = &d->values[i];
	return v->key_end - v->key == length && memcmp(d->text + v->key, name, length) == 0;
}

/* A value of a kind; NO_VALUE where there is none. `like`: with that value's name, NO_VALUE: any. Elements of an
 * array are seldom chosen for themselves: matrices, weights and extents would be most of it. */
static int choose(const document *d, char kind, int like)
{
	int chosen = NO_VALUE;
	uint32_t seen = 0;
	for (int i = 1; i < d->count; i++) {
		const value *v = &d->values[i], *l = like == NO_VALUE ? NULL : &d->values[like];
		if (i == like || (kind && kind_of(d, i) != kind) ||
			(l && !is_named(d, i, d->text + l->key, l->key_end - l->key)))
			continue;
		if (kind == '0' && v->key == v->key_end && mutate_random(d->seed, 4))
			continue;
		if (mutate_random(d->seed, ++seen) == 0)
			chosen = i;
	}
	return chosen;
}

/* ---- changes ---- */

/* Bytes [begin, end) become others. Returns the new size; the old one where there is no room. */
static size_t splice(document *d, size_t begin, size_t end, const char *by, size_t length)
{
	const size_t size = d->size - (end - begin) + length;
	if (size > d->room)
		return d->size;
	memmove(d->text + begin + length, d->text + end, d->size - end);
	memcpy(d->text + begin, by, length);
	return d->size = size;
}

static size_t replace(document *d, int i, const char *by, size_t length)
{
	return splice(d, d->values[i].begin, d->values[i].end, by, length);
}

/* By a copy of another value. */
static size_t replace_by_value(document *d, int to, int from)
{
	const size_t length = d->values[from].end - d->values[from].begin;
	char *copy = malloc(length + 1);
	if (!copy)
		abort();
	memcpy(copy, d->text + d->values[from].begin, length);
	replace(d, to, copy, length);
	free(copy);
	return d->size;
}

static size_t change_number(document *d)
{
	static const char *const numbers[] = {"0", "-1", "1", "2", "3", "4", "5", "6", "7", "8", "12", "16",
		"36", "252",
		"255", "256", "65535", "65536", "2147483647", "4294967295", "4294967296", "9007199254740993",
		"18446744073709551615", "1e308", "1e400", "0.5", "-0", "1.0", "3e0", "5120", "5121", "5122",
		"5123", "5125",
		"5126", "34962", "34963"};
	const int i = choose(d, '0', NO_VALUE);
	if (i == NO_VALUE)
		return d->size;
	char by[40];
	const double old = strtod(d->text + d->values[i].begin, NULL);
	const int other = choose(d, '0', mutate_random(d->seed, 2) ? i : NO_VALUE);
	switch (mutate_random(d->seed, 6)) {
	case 0:
		snprintf(by, sizeof by, "%.9g", old + 1);
		break;
	case 1:
		snprintf(by, sizeof by, "%.9g", old - 1);
		break;
	case 2:
		snprintf(by, sizeof by, "%.9g", mutate_random(d->seed, 2) ? old * 2 : old / 2);
		break;
	case 3:
		if (other != NO_VALUE)
			return replace_by_value(d, i, other);
		/* fall through */
	case 4:
		snprintf(by, sizeof by, "%u", (unsigned)mutate_random(d->seed, 32));
		break;
	default:
		snprintf(by, sizeof by, "%s", ONE_OF(numbers));
	}
	return replace(d, i, by, strlen(by));
}

/* Bytes within a data URI; mostly as many as before. */
static size_t change_data(document *d, int i)
{
	static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	const char *comma = memchr(d->text + d->values[i].begin, ',', d->values[i].end - d->values[i].begin);
	const size_t begin = comma ? (size_t)(comma + 1 - d->text) : 0, end = d->values[i].end;
	if (!comma || end < begin + 8)
		return d->size;
	for (uint32_t k = 1 + mutate_random(d->seed, 6); k-- > 0;)
		d->text[begin + mutate_random(d->seed, (uint32_t)(end - begin - 4))] =
			letters[mutate_random(d->seed, 64)];
	return mutate_random(d->seed, 8) ? d->size : splice(d, begin, begin, "AAAA", 4);
}

static size_t change_string(document *d)
{
	static const char *const strings[] = {"\"\"", "\"../plates.bin\"", "\"link/plates.bin\"", "\"plates.bin\"",
		"\"bumps.png\"", "\"a%20b\"", "\"../canary.bin\"", "\"%2e%2e/canary.bin\"",
		"\"link/canary.bin\"", "\"C:\\\\x\"", "\"../../../etc/passwd\"", "\"file:///etc/passwd\"",
		"\"a\\u0000b\"", "\"\\ud800\"", "\"\\u00e9\"", "\"data:;base64,AAAA\"", "\"data:,x\"", "\"SCALAR\"",
		"\"VEC2\"", "\"VEC3\"", "\"VEC4\"", "\"MAT4\"", "\"BLEND\"", "\"MASK\"", "\"ATTRIBUTES\"",
		"\"TRIANGLES\"",
		"\"INDICES\"", "\"OCTAHEDRAL\"", "\"QUATERNION\"", "\"EXPONENTIAL\"", "\"image/png\"",
		"\"KHR_mesh_quantization\"", "\"KHR_draco_mesh_compression\"", "\"EXT_meshopt_compression\"",
		"\"KHR_texture_transform\"", "\"EXT_mesh_gpu_instancing\""};
	const int i = choose(d, '"', NO_VALUE);
	if (i == NO_VALUE)
		return d->size;
	if (d->values[i].end - d->values[i].begin > 6 && memcmp(d->text + d->values[i].begin, "\"data:", 6) == 0 &&
		mutate_random(d->seed, 16))
		return change_data(d, i);
	const int other = choose(d, '"', mutate_random(d->seed, 2) ? i : NO_VALUE);
	if (other != NO_VALUE && mutate_random(d->seed, 2))
		return replace_by_value(d, i, other);
	const char *by = ONE_OF(strings);
	return replace(d, i, by, strlen(by));
}

/* A member gets another one's name: NORMAL becomes TANGENT. */
static size_t change_name(document *d)
{
	static const char *const names[] = {"\"POSITION\"", "\"NORMAL\"", "\"TANGENT\"", "\"TEXCOORD_0\"",
		"\"TEXCOORD_1\"", "\"COLOR_0\"", "\"JOINTS_0\"", "\"_CUSTOM\"", "\"x\"", "\"\""};
	const int i = choose(d, 0, NO_VALUE), other = choose(d, 0, NO_VALUE);
	if (i == NO_VALUE || d->values[i].key == d->values[i].key_end)
		return d->size;
	const value *v = &d->values[i], *o = &d->values[other];
	char by[64];
	const size_t length = o->key_end - o->key;
	if (length > 0 && length < sizeof by && mutate_random(d->seed, 2))
		snprintf(by, sizeof by, "%.*s", (int)length, d->text + o->key);
	else
		snprintf(by, sizeof by, "%s", ONE_OF(names));
	return splice(d, v->key, v->key_end, by, strlen(by));
}

/* Without a member or an element, and a comma. */
static size_t remove_value(document *d)
{
	const int i = choose(d, 0, NO_VALUE);
	if (i == NO_VALUE)
		return d->size;
	const value *v = &d->values[i];
	size_t begin = v->key < v->key_end ? v->key : v->begin, end = v->end;
	if (d->values[v->parent].children > 1) {
		size_t comma = end;
		while (strchr(" \t\r\n", d->text[comma]))
			comma++;
		if (d->text[comma] == ',')
			end = comma + 1;
		else
			while (d->text[begin] != ',')
				begin--;
	}
	return splice(d, begin, end, "", 0);
}

/* An element stands twice. */
static size_t double_element(document *d)
{
	const int i = choose(d, mutate_random(d->seed, 4) ? '{' : 0, NO_VALUE);
	if (i == NO_VALUE || d->values[i].key < d->values[i].key_end)
		return d->size;
	const value v = d->values[i];
	const size_t before = d->size, length = v.end - v.begin;
	if (before + length + 1 > d->room)
		return before;
	memmove(d->text + v.end + 1 + length, d->text + v.end, d->size - v.end);
	d->text[v.end] = ',';
	memcpy(d->text + v.end + 1, d->text + v.begin, length);
	return d->size = before + length + 1;
}

static size_t copy_value(document *d)
{
	const int i = choose(d, 0, NO_VALUE);
	const int from = i == NO_VALUE ? NO_VALUE : choose(d, kind_of(d, i), mutate_random(d->seed, 8) ? i : NO_VALUE);
	return from == NO_VALUE ? d->size : replace_by_value(d, i, from);
}

static size_t change_kind(document *d)
{
	static const char *const values[] = {"null", "true", "{}", "[]", "\"x\"", "0", "[0,0,0]", "{\"x\":1}",
		"[[[[0]]]]"};
	const int i = choose(d, 0, NO_VALUE);
	const char *by = ONE_OF(values);
	return i == NO_VALUE ? d->size : replace(d, i, by, strlen(by));
}

/* Members that documents may have, and the object or array that has it. */
static const struct {
	const char *owner, *member;
} members[] = {
	{"accessors", "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5121},"
		"\"values\":{\"bufferView\":0}}"},
	{"accessors", "\"byteOffset\":4"},
	{"accessors", "\"normalized\":true"},
	{"accessors", "\"componentType\":5123"},
	{"bufferViews", "\"byteStride\":16"},
	{"bufferViews", "\"byteOffset\":4"},
	{"bufferViews", "\"target\":34962"},
	{"bufferViews", "\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteLength\":64,\"byteStride\":12,"
		"\"mode\":\"ATTRIBUTES\",\"count\":4,\"filter\":\"OCTAHEDRAL\"}}"},
	{"primitives", "\"mode\":5"},
	{"primitives", "\"mode\":6"},
	{"primitives", "\"indices\":0"},
	{"primitives", "\"material\":0"},
	{"primitives", "\"targets\":[{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":1}]"},
	{"primitives",
		"\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{\"POSITION\":0}}}"},
	{"primitives",
		"\"extensions\":{\"KHR_materials_variants\":{\"mappings\":[{\"material\":0,\"variants\":[0]}]}}"},
	{"primitives", "\"extensions\":{\"CESIUM_primitive_outline\":{\"indices\":0}}"},
	{"primitives", "\"extensions\":{\"EXT_x\":{\"indices\":0,\"POSITION\":0}}"},
	{"attributes", "\"TANGENT\":0"},
	{"attributes", "\"TEXCOORD_1\":0"},
	{"attributes", "\"COLOR_0\":0"},
	{"attributes", "\"_CUSTOM\":0"},
	{"materials", "\"normalTexture\":{\"index\":0,\"texCoord\":0,\"scale\":-1}"},
	{"materials", "\"extensions\":{\"KHR_materials_anisotropy\":{\"anisotropyStrength\":1}}"},
	{"materials", "\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatNormalTexture\":{\"index\":0}}}"},
	{"normalTexture",
		"\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,-2],\"rotation\":1,\"texCoord\":1}}"},
	{"meshes", "\"weights\":[0.5]"},
	{"nodes", "\"mesh\":0"},
	{"nodes", "\"matrix\":[1,0,0,0,0,-1,0,0,0,0,1,0,0,0,0,1]"},
	{"nodes", "\"scale\":[-1,0,1]"},
	{"nodes", "\"children\":[0]"},
	{"nodes", "\"skin\":0"},
	{"nodes", "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}"},
	{"", "\"extras\":{\"a\":[1.0E+03,1e400],\"a\":\"\\u00e9\"}"},
	{"", "\"name\":\"x\""},
};

/* A member that its owner may have, in place of the one that is there. */
static size_t add_member(document *d)
{
	const int i = choose(d, '{', NO_VALUE);
	if (i == NO_VALUE)
		return d->size;
	const value *v = &d->values[i], *named = v->key < v->key_end ? v : &d->values[v->parent];
	const bool anything = mutate_random(d->seed, 16) == 0;
	const char *member = NULL;
	uint32_t seen = 0;
	for (size_t k = 0; k < sizeof members / sizeof *members; k++) {
		const size_t length = strlen(members[k].owner);
		const bool fits = length == 0 || anything || (named->key_end - named->key == length + 2 &&
			memcmp(d->text + named->key + 1, members[k].owner, length) == 0);
		if (fits && mutate_random(d->seed, ++seen) == 0)
			member = members[k].member;
	}
	const size_t key = (size_t)(strchr(member + 1, '"') + 1 - member);
	for (int k = 1; k < d->count; k++)
		if (d->values[k].parent == i && is_named(d, k, member, key))
			return splice(d, d->values[k].key, d->values[k].end, member, strlen(member));
	char by[400];
	snprintf(by, sizeof by, "%s%s", member, v->children > 0 ? "," : "");
	return splice(d, v->begin + 1, v->begin + 1, by, strlen(by));
}

size_t mutate_json(char *text, size_t size, size_t room, uint32_t *seed)
{
	static size_t (*const changes[])(document *) = {change_number, change_number, change_number, change_number,
		change_string, change_string, copy_value, copy_value, add_member, add_member, remove_value,
		double_element, change_name, change_kind};
	static document d;
	for (uint32_t k = 1 + mutate_random(seed, 3); k-- > 0;) {
		d.text = text, d.size = size, d.room = room, d.seed = seed;
		d.at = 0, d.count = 0;
		if (!read_document(&d))
			return 0;
		size = changes[mutate_random(seed, sizeof changes / sizeof *changes)](&d);
	}
	return size;
}

/* ---- .glb ---- */

enum { HEAD = 20 }; /* of the file and of its first chunk */

static uint32_t load_u32(const char *at)
{
	const unsigned char *b = (const unsigned char *)at;
	return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void store_u32(char *at, size_t number)
{
	for (int i = 0; i < 4; i++)
		at[i] = (char)(number >> 8 * i);
}

size_t mutate_glb(char *file, size_t size, size_t room, uint32_t *seed)
{
	if (size < HEAD || room < size + 4 || memcmp(file, "glTF", 4) != 0)
		return 0;
	const size_t length = load_u32(file + 12);
	if (length > size - HEAD)
		return 0;
	const size_t rest = size - HEAD - length;
	if (rest > 8 && mutate_random(seed, 4) == 0) { /* as long as before */
		for (uint32_t k = 1 + mutate_random(seed, 4); k-- > 0;)
			file[size - 1 - mutate_random(seed, (uint32_t)(rest - 8))] = (char)mutate_random(seed, 256);
		return size;
	}
	char *json = malloc(room);
	if (!json)
		abort();
	memcpy(json, file + HEAD, length);
	size_t changed = length;
	while (changed > 0 && json[changed - 1] == ' ')
		changed--;
	changed = mutate_json(json, changed, room - HEAD - rest - 4, seed);
	if (changed > 0) {
		while (changed % 4 != 0)
			json[changed++] = ' ';
		memmove(file + HEAD + changed, file + HEAD + length, rest);
		memcpy(file + HEAD, json, changed);
		store_u32(file + 8, HEAD + changed + rest);
		store_u32(file + 12, changed);
		changed += HEAD + rest;
	}
	free(json);
	return changed;
}

/* ---- any file ---- */

size_t mutate(char *file, size_t size, uint32_t *seed)
{
	const size_t begin = mutate_random(seed, (uint32_t)size), room = size + MUTATE_ROOM;
	size_t end = begin + mutate_random(seed, 40), changed = 0;
	const uint32_t choice = mutate_random(seed, 10);
	if (choice > 1)
		changed = file[0] == '{' ? mutate_json(file, size, room, seed) : mutate_glb(file, size, room, seed);
	if (changed)
		return changed;
	if (choice == 1) { /* the end or a piece is missing */
		end = mutate_random(seed, 2) || end > size ? size : end;
		memmove(file + begin, file + end, size - end);
		return size - (end - begin);
	}
	/* a byte; of the head, half of the time */
	const uint32_t range = (uint32_t)(size > 64 && mutate_random(seed, 2) ? 64 : size);
	file[choice ? mutate_random(seed, range) : begin] = (char)mutate_random(seed, 256);
	return size;
}
