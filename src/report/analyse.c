/* SPDX-License-Identifier: MIT */
/*
 * One report from one scene: see report.h. Each mesh is checked by itself, in one order of checks; the
 * scene's own findings are added, everything is sorted, and the reader is asked for the lines of what is left.
 *
 * Time is linear in the size of the mesh; a million triangles take a fraction of a second beside the
 * solve that authored tangents are compared with.
 */
#include "report/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "scene/scene.h"
#include "scene/values.h"

/* ---- facts that need no check ---- */

static double determinant_of(const double m[16])
{
	return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
		m[8] * (m[1] * m[6] - m[5] * m[2]);
}

static void count_instances(nt_report *report, const nt_scene *scene)
{
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_instance *instance = &scene->instances[i];
		if (instance->mesh >= report->mesh_count)
			continue;
		nt_report_mesh *mesh = &report->meshes[instance->mesh];
		const double determinant = determinant_of(instance->matrix), scale = cbrt(fabs(determinant));
		if (mesh->instance_count++ == 0) {
			mesh->is_scaled = (scale > 0.0 && fabs(scale - 1.0) > 1e-6) || nt_scene_has_origin(scene);
			memcpy(mesh->world, instance->matrix, sizeof mesh->world);
		}
		mesh->negative_instances += determinant < 0.0;
	}
}

static const char *copy_text(nt_arena *arena, const char *text)
{
	return nt_arena_text(arena, text ? text : "", text ? strlen(text) : 0);
}

/* Shortens a name, since each of thousands of primitives may have it. */
static const char *copy_name(nt_arena *arena, const char *name)
{
	enum { MOST = 240, WITH_LENGTH = MOST + 40 };
	const size_t length = strlen(name), cut = length > MOST ? nt_utf8_cut(name, MOST) : length;
	if (cut == length)
		return copy_text(arena, name);
	char text[WITH_LENGTH];
	snprintf(text, sizeof text, "%.*s... (%zu bytes)", (int)cut, name, length);
	return copy_text(arena, text);
}

/* "normal texture, anisotropy: tangents are computed" */
static const char *describe_why(nt_arena *arena, const nt_mesh *mesh, const char *decision)
{
	static const struct {
		unsigned slot;
		const char *text;
	} slots[] = {{NT_SLOT_NORMAL, "normal texture"}, {NT_SLOT_CLEARCOAT_NORMAL, "clearcoat normal texture"},
		{NT_SLOT_ANISOTROPY, "anisotropy"}};
	char text[256] = "";
	size_t length = 0;
	for (size_t i = 0; i < sizeof slots / sizeof slots[0]; i++)
		if (mesh->slots & slots[i].slot)
			length += (size_t)snprintf(text + length, sizeof text - length, "%s%s",
				length ? ", " : "", slots[i].text);
	snprintf(text + length, sizeof text - length, "%s%s", length ? ": " : "", decision);
	return copy_text(arena, text);
}

static bool describe_mesh(nt_report *report, const nt_mesh *mesh, const nt_report_options *options,
	nt_report_mesh *facts)
{
	const bool solve = mesh->decision == NT_DECISION_SOLVE && options->written == NT_FORMAT_UNKNOWN;
	*facts = (nt_report_mesh){
		.name = copy_name(&report->arena, mesh->name),
		.why = describe_why(&report->arena, mesh,
			solve ? "tangents would be computed" : nt_decision_text(mesh->decision)),
		.same_as = NT_NONE, .gltf_mesh = mesh->gltf_mesh, .gltf_primitive = mesh->gltf_primitive,
		.slots = mesh->slots, .texcoord_set = mesh->texcoord_set, .wrap = {mesh->wrap[0], mesh->wrap[1]},
		.has_normals = mesh->normals != NULL, .has_texcoords = mesh->texcoords != NULL,
		.worst_orthogonality = NAN, .relative_determinant = {NAN, NAN, NAN},
		.box = nt_box_empty()};
	nt_place place;
	const nt_place_view view = nt_view_place(nt_mesh_place(mesh, &place));
	return facts->name && facts->why && nt_keep_place(&report->arena, &view, &facts->place);
}

/* If the file itself is judged, its own data counts, although a solve may have run too. */
static nt_stored stored_tangents(const nt_mesh *mesh, bool written)
{
	if (written && mesh->split.vertex_tangents)
		return NT_STORED_SPLIT;
	if (written && mesh->corner_tangents && nt_mesh_is_wanted(mesh))
		return NT_STORED_CORNERS;
	return mesh->tangents ? NT_STORED_AUTHORED : NT_STORED_NONE;
}

static nt_status describe_surface(nt_check *check)
{
	nt_report_mesh *facts = check->facts;
	facts->face_count = check->mesh->face_count;
	facts->triangle_count = check->surface.triangle_count;
	facts->vertices_before = check->mesh->unused_vertices + (check->mesh->vertex_sources
		? check->mesh->source_vertex_count : check->mesh->vertex_count);
	check->stored = stored_tangents(check->mesh, nt_is_written(check));
	facts->checked_tangents = check->stored != NT_STORED_NONE;
	facts->maker.agreement = -1.0;
	facts->analysed = true;
	return nt_digest_surface(&check->surface, check->scratch, &facts->digest);
}

/* ---- what pictures need ---- */

static void *copy_block(nt_arena *arena, const void *block, size_t count, size_t size, bool *failed)
{
	if (!block)
		return NULL;
	void *copy = nt_arena_alloc(arena, count, size);
	*failed |= !copy;
	return copy ? memcpy(copy, block, count * size) : NULL;
}

/* Vertices as pictures have them: those of the mesh, and the copies that a split appends. */
typedef struct picture_vertices {
	const uint32_t *indices;  /* [mesh corner_count]; NULL: the mesh's own */
	const uint32_t *sources;  /* [source_count] */
	size_t source_count;
	const float *tangents;    /* [vertex_count + source_count][4] that nmtan computes; NULL: none */
} picture_vertices;

/* Solves a mesh that no stage solved, for its picture. */
static nt_status solve_for_picture(const nt_check *check, picture_vertices *picture)
{
	const nt_mesh *mesh = check->mesh;
	uint32_t *indices = nt_scratch_alloc(check->scratch, mesh->corner_count, sizeof *indices);
	uint32_t *sources = nt_scratch_alloc(check->scratch, mesh->corner_count, sizeof *sources);
	float *tangents =
		nt_scratch_alloc(check->scratch, mesh->vertex_count + mesh->corner_count, 4 * sizeof *tangents);
	if (!indices || !sources || !tangents)
		return NT_ERROR_MEMORY;
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	const nmtan_options options = {.struct_bytes = sizeof options, .threads = check->options->threads};
	nmtan_split_output output = {.struct_bytes = sizeof output, .indices = indices, .sources = sources,
		.source_capacity = mesh->corner_count, .vertex_tangents = tangents};
	const nt_status status = nt_status_of(nmtan_vertex_tangents(&view, &options, &output, NULL));
	*picture = (picture_vertices){indices, sources, output.source_count, tangents};
	return status;
}

static nt_status find_picture(const nt_check *check, picture_vertices *picture)
{
	const nt_mesh *mesh = check->mesh;
	*picture = (picture_vertices){0};
	if (check->stored == NT_STORED_SPLIT)
		*picture = (picture_vertices){mesh->split.indices, mesh->split.sources, mesh->split.source_count,
			mesh->split.vertex_tangents};
	else if (check->options->keep_frames && mesh->normals && mesh->texcoords)
		return solve_for_picture(check, picture);
	return NT_OK;
}

/* Copies rows of `width` floats of the picture's vertices; NULL where there are none. */
static float *copy_rows(const nt_check *check, const picture_vertices *picture, const float *rows, size_t width,
	bool *failed)
{
	const size_t own = check->mesh->vertex_count;
	if (!rows)
		return NULL;
	float *copy = nt_arena_alloc(&check->report->arena, own + picture->source_count, width * sizeof *copy);
	*failed |= !copy;
	if (!copy)
		return NULL;
	memcpy(copy, rows, own * width * sizeof *copy);
	for (size_t i = 0; i < picture->source_count; i++)
		memcpy(copy + width * (own + i), rows + width * picture->sources[i], width * sizeof *copy);
	return copy;
}

static nt_status keep_geometry(nt_check *check)
{
	const nt_mesh *mesh = check->mesh;
	const nt_surface *s = &check->surface;
	nt_arena *arena = &check->report->arena;
	picture_vertices picture;
	nt_status status = find_picture(check, &picture);
	nt_report_geometry *g = nt_arena_alloc(arena, 1, sizeof *g);
	if (status || !g)
		return status ? status : NT_ERROR_MEMORY;
	bool failed = false;
	*g = (nt_report_geometry){.triangle_count = s->triangle_count,
		.vertex_count = mesh->vertex_count + picture.source_count};
	g->positions = copy_rows(check, &picture, mesh->positions, 3, &failed);
	g->normals = copy_rows(check, &picture, mesh->normals, 3, &failed);
	g->texcoords = copy_rows(check, &picture, mesh->texcoords, 2, &failed);
	g->authored = copy_rows(check, &picture, mesh->tangents, 4, &failed);
	g->computed = copy_block(arena, picture.tangents, g->vertex_count, 4 * sizeof(float), &failed);
	g->tangents = check->stored == NT_STORED_SPLIT ? g->computed : g->authored;
	g->orientation = copy_block(arena, s->orientation, s->triangle_count, 1, &failed);
	g->islands = copy_block(arena, check->islands, s->triangle_count, sizeof(uint32_t), &failed);
	g->indices = nt_arena_alloc(arena, 3 * s->triangle_count, sizeof *g->indices);
	if (failed || !g->indices)
		return NT_ERROR_MEMORY;
	for (size_t v = 0; v < g->vertex_count && g->texcoords; v++)
		nt_source_texcoord(check->scene, g->texcoords + 2 * v, g->texcoords + 2 * v);
	for (size_t c = 0; c < 3 * s->triangle_count; c++)
		g->indices[c] = picture.indices ? picture.indices[nt_side_corner(s, c)] : nt_side_vertex(s, c);
	check->facts->geometry = g;
	return NT_OK;
}

/* Bytes of all normal maps of a report together, and of all other images. */
static const size_t MOST_IMAGE_BYTES = 16000000;

static nt_status keep_pictures(nt_check *check, size_t most_bytes[NT_PICTURE_COUNT])
{
	const nt_report_options *options = check->options;
	nt_status status = NT_OK;
	for (nt_picture p = 0; p < NT_PICTURE_COUNT && options->find_picture && !status; p++) {
		status = options->find_picture(options->find_user, &check->report->arena, check->scene, check->mesh, p,
			most_bytes[p], &check->facts->pictures[p]);
		if (!check->facts->pictures[p].again)
			most_bytes[p] -= check->facts->pictures[p].size;
	}
	return status;
}

/* ---- one mesh ---- */

static nt_status run_checks(nt_check *check)
{
	static nt_status (*const checks[])(nt_check *) = {nt_check_geometry, nt_check_edges, nt_check_islands,
		nt_check_seams, nt_check_hard_edges, nt_check_rims, nt_check_measures, nt_check_tangents,
		nt_check_growth};
	nt_status status = NT_OK;
	for (size_t i = 0; i < sizeof checks / sizeof *checks && !status; i++)
		status = checks[i](check);
	return status ? status : check->failed ? NT_ERROR_MEMORY : NT_OK;
}

/* most_image_bytes: how much of images may still be kept. */
static nt_status check_mesh(nt_check *check, size_t most_image_bytes[NT_PICTURE_COUNT])
{
	nt_status status = nt_surface_build(&check->surface, check->mesh, check->scratch);
	if (status || check->surface.triangle_count == 0)
		return status;
	status = describe_surface(check);
	if (!status)
		status = run_checks(check);
	nt_surface_free_sides(&check->surface);
	if (!status && check->options->keep_geometry)
		status = keep_geometry(check);
	if (!status)
		status = keep_pictures(check, most_image_bytes);
	return status;
}

/* Points and lines, empty meshes and ones that were never loaded have nothing to be checked. */
static bool is_checked(const nt_mesh *mesh)
{
	return mesh->triangles && mesh->positions && mesh->face_count > 0;
}

/* Whether two meshes of one geometry are also used alike: all that checks ask besides the geometry. */
static bool same_uses(const nt_mesh *a, const nt_mesh *b)
{
	return a->slots == b->slots && a->reachable == b->reachable && a->decision == b->decision &&
		!a->pair == !b->pair && a->doubt == b->doubt &&
		a->targets_without_tangents == b->targets_without_tangents && a->wrap[0] == b->wrap[0] &&
		a->wrap[1] == b->wrap[1] && a->wrap_offset[0] == b->wrap_offset[0] &&
		a->wrap_offset[1] == b->wrap_offset[1];
}

/* Faces of other meshes that are looked at, for all meshes together: some 0.1 s. */
static const size_t MOST_FOREIGN_FACES = 4000000;

/* Meshes of the same geometry that are used alike are checked together. */
typedef struct checked_mesh {
	uint32_t first; /* the one that is checked in its place; NT_NONE: nobody */
	uint32_t next;  /* another first one of the same geometry; NT_NONE: none */
	size_t alike;   /* of a first one: how many it stands for */
	bool untextured; /* of a first one: all of these are */
} checked_mesh;

static uint32_t find_first(const nt_scene *scene, checked_mesh *checked, uint32_t mesh)
{
	const nt_mesh *same_as = scene->meshes[mesh].plan.same_as;
	if (!same_as)
		return mesh;
	uint32_t at = (uint32_t)(same_as - scene->meshes);
	while (checked[at].first == at && !same_uses(&scene->meshes[at], &scene->meshes[mesh])) {
		if (checked[at].next == NT_NONE) {
			checked[at].next = mesh;
			return mesh;
		}
		at = checked[at].next;
	}
	return checked[at].first == at ? at : mesh;
}

static void find_checked(const nt_scene *scene, checked_mesh *checked)
{
	for (uint32_t i = 0; i < scene->mesh_count; i++) {
		checked[i] = (checked_mesh){NT_NONE, NT_NONE, 0, true};
		if (!is_checked(&scene->meshes[i]))
			continue;
		checked[i].first = find_first(scene, checked, i);
		checked_mesh *first = &checked[checked[i].first];
		first->alike++;
		first->untextured &= scene->meshes[i].untextured;
	}
}

/* The facts of a mesh are those of the one that was checked in its place; seams, islands and geometry stay there. */
static void share_facts(nt_report *report, uint32_t mesh, uint32_t first)
{
	const nt_report_mesh own = report->meshes[mesh];
	nt_report_mesh *facts = &report->meshes[mesh];
	*facts = report->meshes[first];
	facts->same_as = first;
	facts->name = own.name;
	facts->place = own.place;
	facts->gltf_mesh = own.gltf_mesh;
	facts->gltf_primitive = own.gltf_primitive;
	facts->texcoord_set = own.texcoord_set;
	facts->instance_count = own.instance_count;
	facts->is_scaled = own.is_scaled;
	memcpy(facts->world, own.world, sizeof facts->world);
	facts->negative_instances = own.negative_instances;
	facts->seams = NULL;
	facts->islands = NULL;
	facts->geometry = NULL;
	memset(facts->pictures, 0, sizeof facts->pictures);
	facts->texture_size[0] = facts->texture_size[1] = 0; /* its islands are not told either */
}

static nt_status check_meshes(const nt_check *check, const checked_mesh *checked)
{
	const nt_scene *scene = check->scene;
	nt_status status = NT_OK;
	size_t image_bytes[NT_PICTURE_COUNT] = {MOST_IMAGE_BYTES, MOST_IMAGE_BYTES};
	for (uint32_t i = 0; i < scene->mesh_count && !status; i++) {
		if (checked[i].first == NT_NONE)
			continue;
		if (checked[i].first != i) {
			share_facts(check->report, i, checked[i].first);
			continue;
		}
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_check one = *check;
		one.mesh_index = i;
		one.alike = checked[i].alike;
		one.untextured = checked[i].untextured;
		one.mesh = &scene->meshes[i];
		one.facts = &check->report->meshes[i];
		one.scratch = &scratch;
		status = check_mesh(&one, image_bytes);
		nt_scratch_free(&scratch);
	}
	return status;
}

static nt_status check_scene(const nt_scene *scene, const nt_report_options *options,
	nt_report *report, nt_error *error)
{
	size_t finding_capacity = 0;
	nt_others others = {.faces = MOST_FOREIGN_FACES};
	nt_rims rims = {0};
	nt_check check = {.scene = scene, .options = options, .report = report, .error = error,
		.finding_capacity = &finding_capacity, .rims = &rims, .others = &others};
	checked_mesh *checked = nt_alloc(scene->mesh_count, sizeof *checked);
	nt_status status = NT_ERROR_MEMORY;
	if (checked) {
		find_checked(scene, checked);
		status = check_meshes(&check, checked);
	}
	if (!status)
		status = nt_check_across(&check);
	free(rims.sides);
	nt_others_free(&others);
	free(checked);
	if (!status)
		status = nt_report_add_findings(&check, &scene->findings);
	return status ? status : check.failed ? NT_ERROR_MEMORY : NT_OK;
}

/* ---- lines ---- */

static int compare_faces(const void *a, const void *b)
{
	const nt_face_place *x = a, *y = b;
	if (x->mesh != y->mesh)
		return x->mesh < y->mesh ? -1 : 1;
	return x->face < y->face ? -1 : x->face > y->face;
}

/* Asks the reader where the faces of all spots stand. */
static nt_status locate_spots(nt_report *report, const nt_scene *scene)
{
	nt_face_place *faces = nt_alloc(report->finding_count * NT_SPOT_COUNT, sizeof *faces);
	if (!faces)
		return NT_ERROR_MEMORY;
	size_t count = 0;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		for (unsigned k = 0; k < finding->spot_count && finding->mesh != NT_NONE; k++)
			if (finding->spots[k].face != NT_NONE)
				faces[count++] = (nt_face_place){finding->mesh,
					finding->spots[k].face, 0, NULL};
	}
	qsort(faces, count, sizeof *faces, compare_faces);
	const nt_status status = scene->locate_faces(scene, faces, count, &report->arena);
	for (size_t i = 0; i < report->finding_count && !status; i++) {
		nt_report_finding *finding = &report->findings[i];
		for (unsigned k = 0; k < finding->spot_count; k++) {
			nt_spot *spot = &finding->spots[k];
			const nt_face_place wanted = {finding->mesh, spot->face, 0, NULL};
			const nt_face_place *found = bsearch(&wanted, faces, count, sizeof *faces, compare_faces);
			spot->line = found ? found->line : 0;
			spot->source = found ? found->corners : NULL;
		}
	}
	free(faces);
	return status;
}

/* ---- the whole ---- */

void nt_report_show_path(const nt_report *report, const char *path, nt_buffer *out)
{
	nt_shown_path(report->paths, path, out);
}

static nt_report *new_report(const char *path, const nt_report_options *options)
{
	nt_report *report = nt_calloc(1, sizeof *report);
	nt_buffer shown = {0};
	if (!report)
		return NULL;
	report->paths = options ? options->paths : NULL;
	report->conversion = options ? options->conversion : NULL;
	report->given = options ? options->given : NULL;
	report->path = copy_text(&report->arena, path);
	nt_report_show_path(report, path, &shown);
	if (!shown.failed)
		report->shown = copy_text(&report->arena, shown.data ? shown.data : "");
	nt_buffer_free(&shown);
	if (!report->path || !report->shown) {
		nt_report_free(report);
		return NULL;
	}
	return report;
}

static nt_status build(const nt_scene *scene, const nt_report_options *options, nt_report *report, nt_error *error)
{
	report->format = scene->format;
	memcpy(report->origin, scene->origin, sizeof report->origin);
	char text[NT_ORIGIN_TEXT];
	if (nt_scene_has_origin(scene))
		report->origin_text = copy_text(&report->arena, nt_origin_text(scene->origin, text));
	report->mesh_count = scene->mesh_count;
	report->meshes = nt_arena_alloc(&report->arena, scene->mesh_count, sizeof *report->meshes);
	if (!report->meshes || (nt_scene_has_origin(scene) && !report->origin_text))
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (!describe_mesh(report, &scene->meshes[i], options, &report->meshes[i]))
			return NT_ERROR_MEMORY;
	count_instances(report, scene);
	nt_status status = check_scene(scene, options, report, error);
	if (!status)
		status = nt_report_complete(report, options);
	if (!status && scene->locate_faces)
		status = locate_spots(report, scene);
	return status;
}

nt_status nt_report_build(const nt_scene *scene, const nt_report_options *options,
	nt_report **report, nt_error *error)
{
	static const nt_report_options defaults;
	*report = new_report(scene->path, options);
	if (!*report)
		return nt_fail_memory(error);
	const nt_status status = build(scene, options ? options : &defaults, *report, error);
	if (status == NT_OK)
		return NT_OK;
	nt_report_free(*report);
	*report = NULL;
	if (status == NT_ERROR_MODULE)
		return status;
	return status == NT_ERROR_MEMORY
		? nt_fail_memory(error)
		: nt_fail(error, status, "the report cannot be made: %s", nt_status_text(status));
}

/* Keeps findings from before an input failed, such as a buffer that is not there; none if memory lacks. */
static void keep_found(const nt_scene *scene, const nt_report_options *options, nt_report *report)
{
	static const nt_report_options defaults;
	size_t finding_capacity = 0;
	nt_check check = {.scene = scene, .options = options ? options : &defaults, .report = report,
		.finding_capacity = &finding_capacity};
	report->format = scene->format;
	if (nt_report_add_findings(&check, &scene->findings) || check.failed ||
		nt_report_complete(report, check.options))
		report->finding_count = 0;
}

nt_report *nt_report_of_error(const char *path, const nt_scene *scene, const nt_report_options *options,
	const nt_error *failure)
{
	nt_report *report = new_report(path, options);
	if (!report)
		return NULL;
	report->failure = copy_text(&report->arena, failure->message);
	const nt_place_view place = nt_view_place(&failure->place);
	if (!report->failure || !nt_keep_place(&report->arena, &place, &report->failure_place)) {
		nt_report_free(report);
		return NULL;
	}
	if (scene && scene->findings.count)
		keep_found(scene, options, report);
	return report;
}

void nt_report_free(nt_report *report)
{
	if (!report)
		return;
	free(report->findings);
	nt_arena_free(&report->arena);
	free(report);
}
