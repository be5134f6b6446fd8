/* SPDX-License-Identifier: MIT */
/*
 * From occurrences to findings: tallies keep the count, the box and the first few places; a reported
 * tally gets its sentence, its severity and its fingerprint. At the end findings are compared with the
 * baseline, sorted and cut to the number asked for.
 */
#include "report/check.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/hash_index.h"
#include "base/parallel.h"
#include "report/report.h"

/* ---- digests of geometry, the same in every run ---- */

/* Exporters rename objects and leave out their names; positions stay. They are compared exactly: a digest is for what
 * was not changed but for its name. */

static uint64_t mix(uint64_t a, uint64_t b)
{
	return nt_hash_unkeyed(a, &b, sizeof b);
}

static uint64_t mix_text(uint64_t hash, const char *text)
{
	return nt_hash_unkeyed(hash, text, strlen(text));
}

/* 0 and -0 are one. */
static uint64_t mix_position(uint64_t hash, const float *p)
{
	const float values[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
	return nt_hash_unkeyed(hash, values, sizeof values);
}

/* Vertices may lie anywhere: what is asked of a corner's is fetched before it is its turn. */
static void prefetch(const nt_surface *s, const uint64_t *points, size_t corner)
{
	enum { AHEAD = 24 };
	const size_t corners = 3 * s->triangle_count;
	for (size_t k = corner; k < corner + 3 && k + 2 * AHEAD < corners; k++) {
		__builtin_prefetch(&s->points[nt_side_vertex(s, k + 2 * AHEAD)]);
		__builtin_prefetch(&points[nt_side_point(s, k + AHEAD)]);
	}
}

/* A turned triangle is the same, a reversed one is not: each corner is mixed with the one after it. */
nt_status nt_digest_surface(const nt_surface *surface, nt_scratch *scratch, uint64_t *digest)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	uint64_t *points = nt_scratch_alloc(scratch, surface->point_count, sizeof *points), sum = 0;
	if (!points)
		return NT_ERROR_MEMORY;
	memset(points, 0, surface->point_count * sizeof *points);
	for (size_t v = 0; v < surface->mesh->vertex_count; v++) {
		const uint32_t point = surface->points[v];
		if (point != NT_NONE && !points[point])
			points[point] = mix_position(1, surface->mesh->positions + 3 * v);
	}
	for (size_t t = 0; t < surface->triangle_count; t++) {
		prefetch(surface, points, 3 * t);
		const uint64_t a = points[nt_side_point(surface, 3 * t)], b = points[nt_side_point(surface, 3 * t + 1)];
		const uint64_t c = points[nt_side_point(surface, 3 * t + 2)];
		sum += mix(a, b) + mix(b, c) + mix(c, a);
	}
	*digest = mix(sum, surface->triangle_count) | 1;
	nt_scratch_back(scratch, mark);
	return NT_OK;
}

static bool has_places(const nt_report_finding *finding)
{
	return finding->box.minimum[0] <= finding->box.maximum[0];
}

/* The digest of a finding, before its mesh is known as a whole: its code and its places, or, without places, its
 * detail. */
static uint64_t digest_of_finding(const nt_report_finding *finding, const char *detail)
{
	uint64_t hash = mix_text(0, nt_code_info(finding->code)->name);
	if (!has_places(finding))
		return mix_text(hash, detail ? detail : "");
	hash = mix_position(mix_position(hash, finding->box.minimum), finding->box.maximum);
	for (unsigned i = 0; i < finding->spot_count; i++)
		for (unsigned k = 0; k < finding->spots[i].corner_count; k++)
			hash = mix_position(hash, finding->spots[i].positions[k]);
	return hash;
}

/* Completes the digests of findings without places, which are about a mesh or the file: 0 where that has no
 * triangles. */
static void complete_digests(nt_report *report)
{
	uint64_t file = 0;
	for (size_t i = 0; i < report->mesh_count; i++)
		file += report->meshes[i].digest;
	for (size_t i = 0; i < report->finding_count; i++) {
		nt_report_finding *finding = &report->findings[i];
		const uint64_t whole = finding->mesh == NT_NONE ? file : report->meshes[finding->mesh].digest;
		if (!has_places(finding))
			finding->geometry = whole ? mix(finding->geometry, whole) : 0;
	}
}

/* ---- findings ---- */

/* Counts an occurrence and returns the spot to fill, NULL when there are enough. */
static nt_spot *count_one(nt_tally *tally, double value)
{
	if (tally->count++ == 0)
		tally->box = nt_box_empty();
	if (tally->spot_count == NT_SPOT_COUNT)
		return NULL;
	nt_spot *spot = &tally->spots[tally->spot_count++];
	*spot = (nt_spot){.triangle = NT_NONE, .face = NT_NONE, .value = value};
	return spot;
}

static void add_vertex(const nt_check *check, nt_tally *tally, nt_spot *spot, uint32_t vertex)
{
	const float *position = check->mesh->positions + 3 * (size_t)vertex;
	nt_box_add(&tally->box, position);
	if (!spot)
		return;
	const unsigned k = spot->corner_count++;
	spot->vertices[k] = nt_source_vertex(check->mesh, vertex);
	memcpy(spot->positions[k], position, sizeof spot->positions[k]);
	spot->has_texcoords = check->mesh->texcoords != NULL;
	if (spot->has_texcoords)
		nt_source_texcoord(check->scene, check->mesh->texcoords + 2 * (size_t)vertex,
			spot->texcoords[k]);
}

static void set_face(const nt_check *check, nt_spot *spot, size_t triangle, uint32_t face)
{
	if (!spot)
		return;
	spot->triangle = (uint32_t)triangle;
	spot->face = check->mesh->face_polygon ? check->mesh->face_polygon[face] : face;
}

void nt_tally_triangle(const nt_check *check, nt_tally *tally, size_t triangle, double value)
{
	nt_spot *spot = count_one(tally, value);
	set_face(check, spot, triangle, nt_triangle_face(&check->surface, triangle));
	for (size_t k = 0; k < 3; k++)
		add_vertex(check, tally, spot, nt_side_vertex(&check->surface, 3 * triangle + k));
}

void nt_tally_edge(const nt_check *check, nt_tally *tally, uint32_t triangle, uint32_t face, const uint32_t ends[2],
	double value)
{
	nt_spot *spot = count_one(tally, value);
	set_face(check, spot, triangle, face);
	add_vertex(check, tally, spot, ends[0]);
	add_vertex(check, tally, spot, ends[1]);
}

void nt_tally_side(const nt_check *check, nt_tally *tally, uint32_t side, double value)
{
	const nt_surface *s = &check->surface;
	const uint32_t ends[2] = {nt_side_vertex(s, side), nt_side_vertex(s, nt_side_next(side))};
	nt_tally_edge(check, tally, side / 3, nt_triangle_face(s, side / 3), ends, value);
}

void nt_tally_vertex(const nt_check *check, nt_tally *tally, uint32_t vertex, double value)
{
	const uint32_t source = nt_source_vertex(check->mesh, vertex);
	for (unsigned i = 0; i < tally->spot_count; i++)
		if (tally->spots[i].vertices[0] == source) {
			tally->count++; /* of another corner: one spot is enough */
			return;
		}
	add_vertex(check, tally, count_one(tally, value), vertex);
}

/* Adds another tally of the same code, whose occurrences come after those of the first. */
static void join_tally(nt_tally *tally, const nt_tally *other)
{
	if (other->count == 0)
		return;
	if (tally->count == 0)
		tally->box = nt_box_empty();
	tally->count += other->count;
	tally->area += other->area;
	nt_box_join(&tally->box, &other->box);
	for (unsigned i = 0; i < other->spot_count && tally->spot_count < NT_SPOT_COUNT; i++)
		tally->spots[tally->spot_count++] = other->spots[i];
}

typedef struct part_work {
	size_t count, size;
	nt_part_check *part_check;
	void *context;
	nt_part *parts;
} part_work;

static void check_part(void *context, size_t item, unsigned slot)
{
	const part_work *work = context;
	const size_t end = (item + 1) * work->size;
	work->part_check(work->context, item * work->size, end < work->count ? end : work->count, slot,
		&work->parts[item]);
}

nt_status nt_check_parts(const nt_check *check, size_t count, size_t size, const nt_code *codes, size_t code_count,
	nt_part_check *part_check, void *context, nt_part *all)
{
	*all = (nt_part){.greatest = {-INFINITY, -INFINITY}};
	for (size_t k = 0; k < code_count; k++)
		all->tallies[k].code = codes[k];
	if (count <= size) {
		part_check(context, 0, count, 0, all);
		return NT_OK;
	}
	const size_t parts = (count + size - 1) / size;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	part_work work = {count, size, part_check, context,
		nt_scratch_alloc(check->scratch, parts, sizeof *work.parts)};
	for (size_t i = 0; i < parts && work.parts; i++)
		work.parts[i] = *all;
	if (work.parts)
		nt_parallel_items(nt_thread_count(check->options->threads), parts, check_part, &work);
	for (size_t i = 0; i < parts && work.parts; i++) {
		for (size_t k = 0; k < code_count; k++)
			join_tally(&all->tallies[k], &work.parts[i].tallies[k]);
		for (size_t k = 0; k < NT_PART_SUMS; k++)
			all->sums[k] += work.parts[i].sums[k];
		for (size_t k = 0; k < 2; k++)
			all->greatest[k] = fmax(all->greatest[k], work.parts[i].greatest[k]);
	}
	nt_scratch_back(check->scratch, mark);
	return work.parts ? NT_OK : NT_ERROR_MEMORY;
}

void nt_tally_number(nt_tally *tally, const char *name, double value)
{
	if (tally->number_count < NT_NUMBER_COUNT)
		tally->numbers[tally->number_count++] = (nt_number){name, value};
}

/* FNV-1a. */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
	const unsigned char *p = bytes;
	for (size_t i = 0; i < size; i++)
		hash = (hash ^ p[i]) * UINT64_C(0x100000001b3);
	return hash;
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
	return hash_bytes(hash, text, strlen(text) + 1);
}

/*
 * Code, mesh and where in the mesh: the box in steps of 1/128 of the mesh's own largest extent. Numbers
 * of vertices and triangles do not enter, nor does the count, so that an unrelated edit leaves it.
 */
static uint64_t fingerprint_of(const nt_report_finding *finding, const nt_report_mesh *mesh, const char *detail)
{
	uint64_t hash = hash_text(UINT64_C(0xcbf29ce484222325), nt_code_info(finding->code)->name);
	hash = hash_text(hash, mesh ? mesh->name : "");
	if (!mesh || !(finding->box.minimum[0] <= finding->box.maximum[0]))
		return hash_text(hash, detail);
	const double extent = nt_box_extent(&mesh->box);
	for (int i = 0; i < 6; i++) {
		const double value = i < 3 ? finding->box.minimum[i] : finding->box.maximum[i - 3];
		const double steps = extent > 0.0 ? (value - mesh->box.minimum[i % 3]) / extent * 128.0 : 0.0;
		/* from 0 to 128; not so along an axis on which no coordinate of the finding is finite */
		const int32_t step = isfinite(steps) && fabs(steps) < 1e6 ? (int32_t)lround(steps) : 0;
		const unsigned char bytes[4] = {(unsigned char)step, (unsigned char)(step >> 8),
			(unsigned char)(step >> 16), (unsigned char)(step >> 24)};
		hash = hash_bytes(hash, bytes, sizeof bytes);
	}
	return hash;
}

/* The options in the code's row, if the mesh has what they take. `severity` is that of a command without --severity. */
static const char *repair_of(nt_check *check, const nt_report_finding *finding, nt_severity severity)
{
	nt_report *report = check->report;
	const char *repair = nt_code_info(finding->code)->repair;
	const nt_report_mesh *mesh = finding->mesh == NT_NONE ? NULL : &report->meshes[finding->mesh];
	if (!repair || !mesh || finding->code == NT_CODE_NMAP_GREEN_DOWN)
		return repair;
	if (finding->code == NT_CODE_TAN_UNUSED && !check->mesh->has_tangents)
		return check->mesh->lost_map ? NULL : "--only=needed";
	if (finding->code == NT_CODE_TAN_UNUSED)
		return nt_format_is_gltf(check->scene->format) ? repair : NULL;
	if (nt_code_mends(finding->code)) {
		/* what is not there, or cannot be read, is made of texture coordinates */
		const bool computed = finding->code == NT_CODE_TAN_MISSING_REQUIRED ||
			finding->code == NT_CODE_TAN_ACCESSOR;
		if (!mesh->has_normals || (!mesh->has_texcoords && computed))
			return mesh->has_texcoords ? nt_code_info(NT_CODE_TAN_NO_NORMAL)->repair : NULL;
		if (severity > NT_SEVERITY_INFO)
			return repair;
		/* --fix does nothing over an info */
		repair = mesh->checked_tangents ? "--existing=repair" : "";
	}
	if (mesh->slots || !nt_format_is_gltf(check->scene->format))
		return repair;
	/* what no material asks for stays as it is, unless it is asked for */
	nt_buffer all = {0};
	nt_buffer_format(&all, "%s%s--only=all", repair, *repair ? " " : "");
	repair = all.failed ? NULL : nt_arena_text(&report->arena, all.data, all.size);
	check->failed |= !repair;
	nt_buffer_free(&all);
	return repair;
}

/* A file as reports show it, if it is not the input: a material library; NULL. */
static const char *elsewhere(nt_check *check, const char *file)
{
	nt_report *report = check->report;
	nt_buffer shown = {0};
	if (!*file || strcmp(file, report->path) == 0)
		return NULL;
	nt_shown_path(report->paths, file, &shown);
	const char *kept =
		shown.failed ? NULL : nt_arena_text(&report->arena, shown.data ? shown.data : "", shown.size);
	nt_buffer_free(&shown);
	check->failed |= !kept;
	return kept;
}

/* Completes and appends a finding whose code, place, count, box, numbers and spots are set. */
static void add_finding(nt_check *check, nt_report_finding *finding, nt_severity severity, const char *detail)
{
	nt_report *report = check->report;
	const uint8_t wish = check->options->severity[finding->code];
	finding->severity = wish ? (nt_severity)(wish - 1) : severity;
	const bool hidden = finding->severity < check->options->min_severity;
	if (check->options->ignore[finding->code] || hidden) {
		report->hidden[finding->severity] += !check->options->ignore[finding->code];
		return;
	}
	nt_buffer sentence = {0};
	nt_code_sentence(finding->code, finding->count, detail, &sentence);
	if (finding->alike > 1)
		nt_buffer_format(&sentence, ", and in %zu more of the same geometry", finding->alike - 1);
	finding->message = sentence.failed ? NULL
					 : nt_arena_text(&report->arena, sentence.data, sentence.size);
	nt_buffer_free(&sentence);
	finding->file = elsewhere(check, finding->place.file);
	finding->fingerprint = fingerprint_of(finding,
		finding->mesh == NT_NONE ? NULL : &report->meshes[finding->mesh], detail);
	finding->geometry = digest_of_finding(finding, detail);
	if (!finding->message || !nt_grow((void **)&report->findings, check->finding_capacity,
				       report->finding_count + 1, sizeof *finding)) {
		check->failed = true;
		return;
	}
	if (!finding->repair && !finding->stays)
		finding->repair = repair_of(check, finding, severity);
	finding->order = report->finding_count;
	report->findings[report->finding_count++] = *finding;
}

void nt_check_report_as(nt_check *check, const nt_tally *tally, nt_severity severity, const char *detail_format, ...)
{
	if (tally->count == 0)
		return;
	char detail[256] = "";
	va_list arguments;
	va_start(arguments, detail_format);
	if (detail_format)
		vsnprintf(detail, sizeof detail, detail_format, arguments);
	va_end(arguments);
	nt_report_finding finding = {.code = tally->code,
		.mesh = check->mesh_index,
		.count = tally->count,
		.alike = check->alike,
		.place = check->facts->place,
		.share = tally->share > 0.0 ? tally->share
					    : fmin(1.0, (double)tally->count / (double)check->surface.triangle_count),
		.box = tally->box,
		.noted = NT_NONE,
		.repair = tally->repair,
		.rank = tally->rank,
		.seam = tally->seam ? tally->seam - 1 : NT_NONE,
		.island = tally->island ? tally->island - 1 : NT_NONE,
		.number_count = tally->number_count,
		.spot_count = tally->spot_count};
	nt_arena *arena = &check->report->arena;
	finding.numbers = nt_arena_alloc(arena, tally->number_count, sizeof *finding.numbers);
	finding.spots = nt_arena_alloc(arena, tally->spot_count, sizeof *finding.spots);
	if (!finding.numbers || !finding.spots) {
		check->failed = true;
		return;
	}
	memcpy(finding.numbers, tally->numbers, tally->number_count * sizeof *finding.numbers);
	memcpy(finding.spots, tally->spots, tally->spot_count * sizeof *finding.spots);
	add_finding(check, &finding, severity, detail);
}

/* The key of a place: a JSON pointer, or an object of a text. */
static const char *key_of(const nt_place_view *place)
{
	return place->pointer[0] ? place->pointer : place->object;
}

/* The meshes by the keys of their places, a key's number in the table being its place in `meshes`. */
typedef struct mesh_table {
	nt_name_table keys;
	uint32_t *meshes;
} mesh_table;

static bool make_mesh_table(const nt_report *report, mesh_table *table)
{
	table->meshes = nt_alloc(report->mesh_count, sizeof *table->meshes);
	for (size_t i = 0; table->meshes && i < report->mesh_count; i++) {
		const char *key = key_of(&report->meshes[i].place);
		const size_t before = table->keys.count;
		if (*key && nt_name_add(&table->keys, key, strlen(key)) == UINT32_MAX)
			return false;
		if (table->keys.count > before)
			table->meshes[before] = (uint32_t)i;
	}
	return table->meshes != NULL;
}

static uint32_t find_mesh(const mesh_table *table, const nt_place_view *place)
{
	const char *key = key_of(place);
	const uint32_t number = nt_name_find(&table->keys, key, strlen(key));
	return number == UINT32_MAX ? NT_NONE : table->meshes[number];
}

bool nt_is_found_again(const nt_finding *found)
{
	return found->code == NT_CODE_UV_DEGENERATE_TRIANGLE || found->code == NT_CODE_UV_UNMAPPED ||
		(found->code == NT_CODE_UV_MISSING && isdigit((unsigned char)found->detail[0])); /* of some */
}

static void add_scene_finding(nt_check *check, const mesh_table *table, const nt_finding_list *all, uint32_t noted)
{
	const nt_finding *found = &all->items[noted];
	if (nt_is_found_again(found))
		return;
	const char *repair = found->repair; /* its text goes with the scene */
	if (repair)
		repair = nt_arena_text(&check->report->arena, repair, strlen(repair));
	nt_report_finding finding = {.code = found->code,
		.mesh = find_mesh(table, &found->place),
		.count = found->count,
		.repair = repair,
		.stays = found->stays,
		.share = 1.0,
		.noted = noted,
		.box = nt_box_empty(),
		.seam = NT_NONE,
		.island = NT_NONE};
	if (found->mesh && check->report->mesh_count) /* which a failed input has not */
		finding.mesh = (uint32_t)(found->mesh - check->scene->meshes);
	finding.alike = finding.mesh != NT_NONE;
	if (finding.mesh != NT_NONE && found->count > 1)
		finding.share = fmin(1.0, (double)found->count /
			fmax(1.0, (double)check->report->meshes[finding.mesh].triangle_count));
	if (found->votes) {
		const size_t count = (size_t)found->votes_side * found->votes_side;
		int8_t *votes = nt_arena_alloc(&check->report->arena, count, sizeof *votes);
		finding.votes = votes ? memcpy(votes, found->votes, count) : NULL;
		finding.votes_side = found->votes_side;
		check->failed |= !votes;
	}
	if (!nt_keep_place(&check->report->arena, &found->place, &finding.place) || (found->repair && !repair)) {
		check->failed = true;
		return;
	}
	add_finding(check, &finding, nt_finding_severity(found), found->detail);
}

nt_status nt_report_add_findings(nt_check *check, const nt_finding_list *all)
{
	mesh_table table = {0};
	const bool made = make_mesh_table(check->report, &table);
	for (size_t i = 0; made && i < all->count; i++)
		add_scene_finding(check, &table, all, (uint32_t)i);
	nt_name_table_free(&table.keys);
	free(table.meshes);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

/* ---- which come first, and which are kept ---- */

static void weigh_findings(nt_report *report)
{
	double most[2][3][NT_CODE_COUNT] = {{{0}}}, triangles = 0.0;
	for (size_t i = 0; i < report->mesh_count; i++)
		triangles += (double)report->meshes[i].triangle_count;
	for (size_t i = 0; i < report->finding_count; i++) {
		nt_report_finding *f = &report->findings[i];
		if (f->mesh != NT_NONE && triangles > 0.0)
			f->share *= (double)report->meshes[f->mesh].triangle_count / triangles;
		double *group = &most[f->known][f->severity][f->code];
		*group = fmax(*group, f->share);
	}
	for (size_t i = 0; i < report->finding_count; i++) {
		nt_report_finding *f = &report->findings[i];
		f->code_share = most[f->known][f->severity][f->code];
	}
}

static int by_weight(const void *a, const void *b)
{
	const nt_report_finding *x = a, *y = b;
	if (x->known != y->known)
		return x->known ? 1 : -1;
	if (x->severity != y->severity)
		return x->severity > y->severity ? -1 : 1;
	if (x->code_share != y->code_share)
		return x->code_share > y->code_share ? -1 : 1;
	if (x->code != y->code)
		return x->code < y->code ? -1 : 1;
	if (x->rank != y->rank)
		return x->rank > y->rank ? -1 : 1;
	if (x->share != y->share)
		return x->share > y->share ? -1 : 1;
	return x->order < y->order ? -1 : x->order > y->order;
}

static bool same_class(const nt_report_finding *a, const nt_report_finding *b)
{
	return a->known == b->known && a->severity == b->severity;
}

/* Keeps the first `most` findings, fewer than there are; of the last severity that is kept the first one of each code,
 * then the second ones, so that a hundred seams do not hide what else there is. False: out of memory. */
static bool keep_findings(nt_report *report, size_t most)
{
	nt_report_finding *f = report->findings;
	const size_t count = report->finding_count;
	size_t *ranks = nt_calloc(count, sizeof *ranks); /* [rank in its code] how many */
	size_t begin = most, end, limit = 0;
	if (!ranks)
		return false;
	while (begin > 0 && same_class(&f[begin - 1], &f[most]))
		begin--;
	for (end = begin; end < count && same_class(&f[end], &f[most]); end++) {
		f[end].order = end > begin && f[end].code == f[end - 1].code ? f[end - 1].order + 1 : 0;
		ranks[f[end].order]++;
	}
	size_t left = most - begin;
	while (ranks[limit] <= left)
		left -= ranks[limit++];
	report->finding_count = begin;
	for (size_t i = begin; i < count; i++) {
		const bool last = i < end && f[i].order == limit && left > 0;
		left -= last;
		if (last || (i < end && f[i].order < limit)) {
			f[report->finding_count++] = f[i];
		} else if (!f[i].known) {
			report->dropped_by_code[f[i].code]++;
			report->dropped++;
		}
	}
	free(ranks);
	return true;
}

nt_status nt_report_complete(nt_report *report, const nt_report_options *options)
{
	complete_digests(report);
	report->compared = options->baseline != NULL;
	if (options->baseline && !nt_baseline_apply(options->baseline, report))
		return NT_ERROR_MEMORY;
	weigh_findings(report);
	if (report->finding_count)
		qsort(report->findings, report->finding_count, sizeof *report->findings, by_weight);
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		++*(f->known ? &report->known[f->severity] : &report->by_severity[f->severity]);
		report->counts[f->code] += f->count * (f->noted == NT_NONE && f->alike ? f->alike : 1);
	}
	if (options->max_findings && report->finding_count > options->max_findings &&
		!keep_findings(report, options->max_findings))
		return NT_ERROR_MEMORY;
	while (report->new_count < report->finding_count && !report->findings[report->new_count].known)
		report->new_count++;
	return NT_OK;
}

bool nt_report_worst(const nt_report *report, nt_severity *worst)
{
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_INFO; severity--) {
		if (report->by_severity[severity]) {
			*worst = (nt_severity)severity;
			return true;
		}
	}
	return false;
}
