/* SPDX-License-Identifier: MIT */
/*
 * Normal maps of a glTF turned: see maps.h. An image is decoded once, however many materials have it as a
 * normal map. Other materials keep the image: textures are counted by who refers to them, as normal map and at all,
 * and where the two differ the material gets a texture of its own. VRM 0 says in the root what shaders sample, normal
 * maps once more. Other extensions whose textures are not called ...Texture are not seen; a texture that nobody is seen
 * to use counts as theirs.
 */
#include "format/maps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "ext/gltf_numbers.h"
#include "gltf/document.h"
#include "image/image.h"

/* Places and names of slots. */
enum { CLEARCOAT = 1, VRM, SLOT_COUNT };
static const char *const slots[SLOT_COUNT][3] = {{"materials", "", "normalTexture"},
	{"materials", "extensions/KHR_materials_clearcoat/", "clearcoatNormalTexture"},
	{"extensions/VRM/materialProperties", "textureProperties/", "_BumpMap"}};

/* A normal map of a material. */
typedef struct use {
	uint32_t material, texture, image;
	int slot;   /* of slots */
	bool clamp; /* its sampler does */
} use;

/* An image of them. */
typedef struct job {
	use first;
	bool shared;   /* something else uses it */
	uint32_t copy; /* its number then; 0: none yet */
	nt_normal_map map;
	nt_conversion how;
	nt_converted made;
	nt_error error;
} job;

typedef struct turning {
	nt_scene *scene;
	nt_gltf *document;
	const nt_turning *how;
	use *uses;
	job *jobs, **job_of; /* job_of: [image_count] NULL: no normal map */
	size_t use_count, job_count, texture_count, image_count;
	size_t *all, *turned; /* [texture_count] who refers to a texture; of them, normal maps that are turned */
	size_t *twins;        /* [texture_count] what these refer to instead, where all are not turned; 0: none yet */
	nt_turned_images *images;
} turning;

static nt_json_value *texture_at(const turning *t, uint32_t index)
{
	return nt_json_at(nt_gltf_root_member(t->document, "textures"), index);
}

/* The texture's number of a slot. */
static nt_json_value *number_at(const turning *t, uint32_t material, int slot)
{
	nt_json_value *m = nt_json_at(nt_gltf_root_member(t->document, "materials"), material);
	if (slot == VRM) {
		m = nt_json_find(nt_gltf_root_member(t->document, "extensions"), "VRM");
		m = nt_json_find(nt_json_at(nt_json_find(m, "materialProperties"), material), "textureProperties");
		return nt_json_find(m, slots[slot][2]);
	}
	if (slot == CLEARCOAT)
		m = nt_json_find(nt_json_find(m, "extensions"), "KHR_materials_clearcoat");
	return nt_json_find(nt_json_find(m, slots[slot][2]), "index");
}

/* The index that a value is, below a count. */
static bool get_index(const nt_json_value *number, size_t count, uint32_t *index)
{
	uint64_t value;
	if (!nt_json_get_uint64(number, &value) || value >= count)
		return false;
	*index = (uint32_t)value;
	return true;
}

static void tell(const turning *t, const use *u, nt_code code, const char *what)
{
	nt_place place;
	nt_place_clear(&place);
	const char *const *slot = slots[u->slot];
	snprintf(place.pointer, sizeof place.pointer, "/%s/%u/%s%s", slot[0], u->material, slot[1], slot[2]);
	nt_finding_add(&t->scene->findings, code, &place, 1, "%.*s", NT_CUT(200, what));
}

/* ---- which ---- */

static bool clamps(const turning *t, const nt_json_value *texture)
{
	const nt_json_value *samplers = nt_gltf_root_member(t->document, "samplers");
	uint32_t sampler;
	uint64_t wrap = 0;
	if (get_index(nt_json_find(texture, "sampler"), nt_json_count(samplers), &sampler))
		nt_json_get_uint64(nt_json_find(nt_json_at(samplers, sampler), "wrapS"), &wrap);
	return wrap == NT_GLTF_CLAMP_TO_EDGE;
}

static bool may_be_flipped(const turning *t, uint32_t image)
{
	return !t->how->images || (image < t->how->image_count && t->how->images[image]);
}

static void find_use(turning *t, uint32_t material, int slot)
{
	use u = {.material = material, .slot = slot};
	if (!get_index(number_at(t, material, slot), t->texture_count, &u.texture))
		return;
	const nt_json_value *texture = texture_at(t, u.texture);
	const bool has_source = get_index(nt_json_find(texture, "source"), t->image_count, &u.image);
	if (!t->how->heights && !(has_source ? may_be_flipped(t, u.image) : !t->how->images))
		return;
	for (nt_image_type type = NT_IMAGE_KTX2; type <= NT_IMAGE_WEBP; type++)
		if (nt_json_find(nt_json_find(texture, "extensions"), nt_image_extension(type))) {
			tell(t, &u, NT_CODE_NMAP_NOT_TURNED, nt_image_type_name(type));
			return;
		}
	if (!has_source)
		return;
	u.clamp = clamps(t, texture);
	if (!t->job_of[u.image]) {
		t->jobs[t->job_count].first = u;
		t->job_of[u.image] = &t->jobs[t->job_count++];
	}
	t->uses[t->use_count++] = u;
}

/* Counts who refers to textures, below one value; whether its members are numbers of textures, as VRM's are. */
static void count_users(const turning *t, const nt_json_value *value, bool numbers)
{
	static const char ending[] = "Texture";
	for (size_t i = 0; i < nt_json_count(value); i++) {
		size_t length = 0;
		const char *key = nt_json_key(value, i, &length);
		const nt_json_value *member = nt_json_at(value, i);
		uint32_t texture;
		const bool info = key && length >= sizeof ending - 1 &&
			strcmp(key + length + 1 - sizeof ending, ending) == 0;
		const nt_json_value *number = numbers ? member : info ? nt_json_find(member, "index") : NULL;
		if (get_index(number, t->texture_count, &texture))
			t->all[texture]++;
		count_users(t, member, key && (!strcmp(key, "textureProperties") || !strcmp(key, "meta")));
	}
}

/* ---- pixels ---- */

static nt_status open_jobs(const turning *t, nt_error *error)
{
	uint64_t pixels = 0, bytes = 0;
	nt_status status = NT_OK;
	for (size_t j = 0; j < t->job_count && !status; j++) {
		job *x = &t->jobs[j];
		status = nt_normal_map_open_image(&x->map, t->document, x->first.image, error);
		const uint64_t work = status ? 0 : nt_image_work(x->map.bytes, x->map.size);
		pixels += 2 * work;
		bytes += x->map.size;
		if (!status)
			status = nt_check_image(work, t->how->max_pixels, x->map.size, NULL, error);
	}
	return status ? status : nt_check_pixels(pixels, t->how->max_pixels, bytes, error);
}

static void make(void *context, size_t item, unsigned slot)
{
	(void)slot;
	const turning *t = context;
	job *x = &t->jobs[item];
	bool grey = false;
	nt_error_clear(&x->error);
	if (!x->map.bytes || !nt_image_is_converted(x->map.type) ||
		nt_image_is_grey(x->map.bytes, x->map.size, &grey, &x->error))
		return;
	x->how = (nt_conversion){.channels = {{.used = true, .map = {.channel = NT_CHANNEL_LUMINANCE, .gain = 1}}},
		.flip = grey || !may_be_flipped(t, x->first.image) ? NT_FLIP_OFF : t->how->flip,
		.heights = grey && t->how->heights, .height = t->how->height, .clamp = x->first.clamp};
	const nt_file file = nt_file_of_bytes(x->map.bytes, x->map.size);
	if (x->how.heights || x->how.flip)
		nt_conversion_make(&x->how, (const nt_file *const[4]){&file}, false, &x->made, &x->error);
}

static nt_status tell_job(const turning *t, const job *x, nt_error *error)
{
	char text[80];
	const bool fatal = x->error.status == NT_ERROR_MEMORY || x->error.status == NT_ERROR_MODULE;
	if (fatal)
		*error = x->error;
	else if (x->error.status)
		tell(t, &x->first, NT_CODE_IMAGE_DAMAGED, x->error.message);
	else if (x->map.bytes && !nt_image_is_converted(x->map.type))
		tell(t, &x->first, NT_CODE_NMAP_NOT_TURNED, nt_image_type_name(x->map.type));
	snprintf(text, sizeof text, "%s", x->how.heights ? "height map to normal map" : "green turned up");
	if (x->made.made)
		tell(t, &x->first, NT_CODE_IMAGE_CONVERTED, text);
	return fatal ? x->error.status : NT_OK;
}

/* ---- the document ---- */

/* Images keep what they have unless every texture of theirs is of turned normal maps alone. */
static void find_shared(const turning *t)
{
	uint32_t image;
	for (const use *u = t->uses; u < t->uses + t->use_count; u++)
		t->turned[u->texture] += t->job_of[u->image]->made.made;
	for (uint32_t i = 0; i < t->texture_count; i++)
		if (get_index(nt_json_find(texture_at(t, i), "source"), t->image_count, &image) && t->job_of[image] &&
			(!t->all[i] || t->all[i] != t->turned[i]))
			t->job_of[image]->shared = true;
}

/* Appends a copy of an element to an array of the root; its number. */
static uint32_t append_copy(const turning *t, const char *array, uint32_t of)
{
	nt_json *json = t->document->json;
	nt_json_value *elements = nt_gltf_root_member(t->document, array);
	nt_json_append(json, elements);
	const size_t last = nt_json_count(elements) - 1;
	nt_json_set_copy(json, nt_json_at(elements, last), nt_json_at(elements, of));
	return (uint32_t)last;
}

/* The texture takes the image's copy; one that others use, too, stays, and gets a twin. */
static void refer(const turning *t, const use *u)
{
	nt_json *json = t->document->json;
	size_t *twin = &t->twins[u->texture];
	if (t->all[u->texture] != t->turned[u->texture] && !*twin)
		*twin = append_copy(t, "textures", u->texture);
	nt_json_set_uint64(json, nt_json_put(json, texture_at(t, *twin ? (uint32_t)*twin : u->texture), "source"),
		t->job_of[u->image]->copy);
	if (*twin)
		nt_json_set_uint64(json, number_at(t, u->material, u->slot), *twin);
}

static nt_status take_job(const turning *t, job *x, nt_error *error)
{
	nt_turned_images *images = t->images;
	const nt_status status = tell_job(t, x, error);
	if (status || !x->made.made)
		return status;
	if (!nt_grow((void **)&images->items, &images->capacity, images->count + 1, sizeof *images->items))
		return nt_fail_memory(error);
	nt_turned_image *image = &images->items[images->count++];
	*image = (nt_turned_image){.image = x->first.image, .replaces = !x->shared,
		.suffix = x->how.heights ? "-normal" : "-green-up", .bytes = x->made.bytes, .size = x->made.size};
	x->made.bytes = NULL;
	if (x->shared)
		image->image = x->copy = append_copy(t, "images", x->first.image);
	return NT_OK;
}

nt_status nt_turned_maps_make(nt_scene *scene, const nt_turning *how, nt_turned_images *turned, nt_error *error)
{
	turning t = {.scene = scene, .document = scene->source, .how = how, .images = turned};
	const nt_json_value *materials = nt_gltf_root_member(t.document, "materials");
	const size_t count = nt_json_count(materials);
	t.texture_count = nt_json_count(nt_gltf_root_member(t.document, "textures"));
	t.image_count = nt_json_count(nt_gltf_root_member(t.document, "images"));
	t.uses = nt_calloc(SLOT_COUNT * count, sizeof *t.uses);
	t.jobs = nt_calloc(SLOT_COUNT * count, sizeof *t.jobs);
	t.job_of = nt_calloc(t.image_count, sizeof *t.job_of);
	t.all = nt_calloc(3 * t.texture_count, sizeof *t.all);
	nt_status status = t.uses && t.jobs && t.job_of && t.all ? NT_OK : nt_fail_memory(error);
	for (uint32_t m = 0; m < count && !status; m++)
		for (int slot = 0; slot < SLOT_COUNT; slot++)
			find_use(&t, m, slot);
	if (!status)
		status = open_jobs(&t, error);
	if (!status) {
		t.turned = t.all + t.texture_count;
		t.twins = t.turned + t.texture_count;
		count_users(&t, materials, false);
		count_users(&t, nt_json_find(nt_gltf_root_member(t.document, "extensions"), "VRM"), false);
		nt_parallel_items(nt_thread_count(how->threads), t.job_count, make, &t);
		find_shared(&t);
	}
	for (size_t j = 0; j < t.job_count && !status; j++)
		status = take_job(&t, &t.jobs[j], error);
	for (const use *u = t.uses; u < t.uses + t.use_count && !status; u++)
		if (t.job_of[u->image]->copy)
			refer(&t, u);
	status = !status && nt_json_failed(t.document->json) ? nt_fail_memory(error) : status;
	for (size_t j = 0; j < t.job_count; j++) {
		nt_normal_map_close(&t.jobs[j].map);
		free(t.jobs[j].made.bytes);
	}
	free(t.uses);
	free(t.jobs);
	free(t.job_of);
	free(t.all);
	return status;
}

void nt_turned_maps_free(nt_turned_images *turned)
{
	for (size_t i = 0; i < turned->count; i++)
		free(turned->items[i].bytes);
	free(turned->items);
	*turned = (nt_turned_images){0};
}
