/* SPDX-License-Identifier: MIT */
/*
 * One input from file to file: see run.h. The order of the stages, and nothing else.
 */
#include "pipeline/run.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/clock.h"
#include "file/watch.h"
#include "format/format.h"
#include "format/normal_map.h"
#include "gltf/companion.h"
#include "gltf/verify.h"
#include "pipeline/joins.h"
#include "pipeline/stages.h"

/* What the stages of one run share. */
typedef struct run {
	const char *input_path, *output_path;
	const nt_settings *settings;
	nt_summary *summary;
	nt_error *error;
	nt_file input;
	nt_scene scene;
	const nt_format_entry *reader, *writer; /* writer: NULL with --check */
	nt_read_options read_options;
	double stage_begin;
	nt_stage stage;
	bool input_is_open;
	nt_output_result result;
} run;

/* A name of an output can be taken by another run between its choice and its use; how often that may happen. */
enum { MOST_ATTEMPTS = 20 };

/* Books the time since the last call on the stage that ends. */
static void end_stage(run *r)
{
	const double time = nt_seconds();
	r->summary->seconds[r->stage] += time - r->stage_begin;
	r->stage_begin = time;
}

static void begin_stage(run *r, nt_stage stage)
{
	end_stage(r);
	r->stage = stage;
	if (r->settings->on_stage)
		r->settings->on_stage(r->settings->on_stage_user, stage);
}

/* Whether the output is standard output, a pipe or a device, whose name need not say a format. */
static bool is_stream(const char *path)
{
	struct stat info;
	return strcmp(path, "-") == 0 ||
	       (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode));
}

/* What cp would write into. */
static bool is_folder(const char *path)
{
	struct stat info;
	const size_t length = strlen(path);
	return (length && path[length - 1] == '/') || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
}

/* Before anything is read, by the name; a stream without one gets PLY for PLY, else GLB. */
static nt_status choose_writer(run *r)
{
	const bool unnamed = !r->settings->check && r->settings->output_format == NT_FORMAT_UNKNOWN &&
			     is_stream(r->output_path) && !nt_format_of_path(r->output_path);
	if (r->settings->check || (unnamed && !r->reader))
		return NT_OK;
	if (unnamed)
		r->writer = nt_format_find(
			r->reader->format == NT_FORMAT_PLY ? NT_FORMAT_PLY : NT_FORMAT_GLB);
	else if (r->settings->output_format != NT_FORMAT_UNKNOWN)
		r->writer = nt_format_find(r->settings->output_format);
	else
		r->writer = nt_format_of_path(r->output_path);
	if (!r->writer && is_folder(r->output_path))
		return nt_fail(r->error, NT_ERROR_USAGE, "\"%s\" is a folder: to write into it use -d",
			r->output_path);
	if (!r->writer)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"cannot tell the output format from the name \"%s\": expected .gltf, .glb or .ply, "
			"or --output-format", r->output_path);
	if (!r->writer->write)
		return nt_fail(r->error, NT_ERROR_USAGE, "\"%s\": %s cannot be written, only read",
			r->output_path, r->writer->name);
	if (r->settings->verify && r->writer->format == NT_FORMAT_PLY)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--verify reads glTF back; \"%s\" will be PLY", r->output_path);
	if (r->settings->precision != NT_PRECISION_FLOAT && r->writer->format == NT_FORMAT_PLY)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--precision is about glTF; \"%s\" will be PLY, whose tangents are floats",
			r->output_path);
	return NT_OK;
}

static nt_status open_scene(run *r)
{
	begin_stage(r, NT_STAGE_MAP);
	nt_status status = NT_OK;
	if (!r->input_is_open)
		status = nt_file_open(&r->input, r->input_path, r->error);
	if (status)
		return status;
	r->input_is_open = true;
	r->summary->bytes_read = r->input.size;
	r->scene.bytes = r->input.data;
	r->scene.file = &r->input;
	r->scene.byte_count = r->input.size;

	begin_stage(r, NT_STAGE_PARSE);
	r->reader = nt_format_of_input(r->input.data, r->input.size, r->input_path);
	if (!r->reader)
		return nt_fail(r->error, NT_ERROR_INPUT,
			"not recognised: expected OBJ, PLY, glTF, GLB or Draco");
	r->scene.format = r->reader->format;
	status = r->reader->open(&r->scene, &r->read_options, r->error);
	end_stage(r);
	r->summary->seconds[NT_STAGE_INDEX] += r->scene.index_seconds;
	r->summary->seconds[NT_STAGE_PARSE] -= r->scene.index_seconds;
	return status;
}

static bool is_wanted(const nt_mesh *mesh)
{
	return mesh->decision == NT_DECISION_SOLVE || mesh->decision == NT_DECISION_REPAIR;
}

/* Writers of other formats than the input's need every mesh, solved or not. */
static bool needs_all(const run *r)
{
	if (!r->writer)
		return false;
	const bool gltf_in = r->reader->format == NT_FORMAT_GLTF || r->reader->format == NT_FORMAT_GLB;
	const bool gltf_out = r->writer->format == NT_FORMAT_GLTF || r->writer->format == NT_FORMAT_GLB;
	return !(gltf_in && gltf_out) && r->reader->format != r->writer->format;
}

/* For the report alone: a mesh that cannot be read fails a check, but no conversion that does not need
 * it. */
static nt_status load_for_report(run *r, nt_mesh *mesh)
{
	if (mesh->same_as && !mesh->same_as->positions) /* that one could not be read */
		return NT_OK;
	const nt_status status = r->reader->load(&r->scene, mesh, &r->read_options, r->error);
	if (!status || r->settings->check || status == NT_ERROR_MEMORY)
		return status;
	mesh->positions = NULL;
	nt_error_clear(r->error);
	return NT_OK;
}

/* Finds what is to be solved together, or, for a report, what could be. */
static nt_status find_joins(run *r)
{
	nt_scene *scene = &r->scene;
	const bool across = r->settings->across == NT_ACROSS_MESH;
	if (!r->reader->find_joins || !(across || r->settings->report))
		return NT_OK;
	const bool checks_kept = across && r->settings->check && r->settings->report;
	const nt_status status = r->reader->find_joins(scene, checks_kept, r->error);
	for (size_t i = 0; !status && across && i < scene->join_count; i++)
		for (size_t k = 0; k < scene->joins[i].part_count; k++)
			scene->joins[i].parts[k]->join = &scene->joins[i];
	return status;
}

/* For a report alone, the comparison of a join costs at most some times what is solved anyway: primitives that lie
 * on each other, as copies of one set of accessors do, are no surface that was cut by material. */
static void leave_out_large_joins(run *r)
{
	enum { MOST_TIMES = 4, ALWAYS = 65536 };
	nt_scene *scene = &r->scene;
	if (r->settings->across == NT_ACROSS_MESH)
		return;
	size_t solved = 0, kept = 0;
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (is_wanted(&scene->meshes[i]) && !scene->meshes[i].same_as)
			solved += scene->meshes[i].face_count;
	for (size_t i = 0; i < scene->join_count; i++) {
		size_t faces = 0;
		for (size_t k = 0; k < scene->joins[i].part_count; k++)
			faces += scene->joins[i].parts[k]->face_count;
		if (faces <= MOST_TIMES * solved + ALWAYS)
			scene->joins[kept++] = scene->joins[i];
	}
	scene->join_count = kept;
}

/* Loads the copies in joins. For a report alone, what cannot be read is left out. */
static nt_status load_copies(run *r)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < r->scene.join_count; i++)
		for (size_t k = 0; !status && k < r->scene.joins[i].part_count; k++) {
			nt_mesh *mesh = r->scene.joins[i].parts[k];
			if (!mesh->transform_of)
				continue;
			status = r->reader->load(&r->scene, mesh, &r->read_options, r->error);
			if (!status || mesh->join || status == NT_ERROR_MEMORY)
				continue;
			mesh->positions = NULL;
			nt_error_clear(r->error);
			status = NT_OK;
		}
	return status;
}

static nt_status load_meshes(run *r)
{
	begin_stage(r, NT_STAGE_DECODE);
	const bool all = needs_all(r);
	nt_status status = find_joins(r);
	if (status)
		return status;
	if (r->reader->find_same) {
		status = r->reader->find_same(&r->scene, &r->read_options, r->error);
		if (status)
			return status;
	}
	leave_out_large_joins(r);
	for (size_t i = 0; r->reader->load && i < r->scene.mesh_count; i++) {
		nt_mesh *mesh = &r->scene.meshes[i];
		const bool loadable = mesh->triangles && mesh->has_positions;
		const bool needed = is_wanted(mesh) || (all && loadable);
		if (!needed && !(r->settings->report && loadable))
			continue;
		status = needed
			? r->reader->load(&r->scene, mesh, &r->read_options, r->error)
			: load_for_report(r, mesh);
		if (status)
			return status;
	}
	return load_copies(r);
}

/* Copies in joins have their own normals, whatever the others get. */
static nt_status make_normals_of_copies(run *r)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < r->scene.join_count; i++)
		for (size_t k = 0; !status && k < r->scene.joins[i].part_count; k++) {
			nt_mesh *mesh = r->scene.joins[i].parts[k];
			if (!is_wanted(mesh) && mesh->positions)
				status = nt_stage_normals(&r->scene, mesh, NT_NORMALS_AUTO, r->error);
		}
	return status;
}

static nt_status make_normals(run *r)
{
	begin_stage(r, NT_STAGE_NORMALS);
	for (size_t i = 0; i < r->scene.mesh_count; i++) {
		nt_mesh *mesh = &r->scene.meshes[i];
		if (!is_wanted(mesh))
			continue;
		if (mesh->same_as) {
			nt_mesh_share(mesh);
			if (mesh->normals_made)
				nt_report_normals(&r->scene, mesh);
			continue;
		}
		const nt_status status =
			nt_stage_normals(&r->scene, mesh, r->settings->normals, r->error);
		if (status)
			return status;
	}
	return make_normals_of_copies(r);
}

static void count_decisions(run *r)
{
	r->summary->mesh_count = r->scene.mesh_count;
	for (size_t i = 0; i < r->scene.mesh_count; i++)
		if (!is_wanted(&r->scene.meshes[i]))
			r->summary->skipped[r->scene.meshes[i].decision]++;
}

/* What only a glTF made from a glTF can have. */
static nt_status check_document_options(const run *r)
{
	const bool edits = r->writer && r->writer->format != NT_FORMAT_PLY &&
		(r->scene.format == NT_FORMAT_GLTF || r->scene.format == NT_FORMAT_GLB);
	if (r->writer && !edits && r->settings->draco > NT_DRACO_OFF)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--draco=%s compresses only glTF that is made from glTF, not %s made from %s",
			r->settings->draco == NT_DRACO_AS_SEQUENTIAL ? "sequential" : "edgebreaker",
			r->writer->name, r->reader->name);
	/* taking images away would renumber what refers to them */
	if (edits && r->settings->images == NT_IMAGES_NONE)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--images=none: a glTF made from a glTF keeps its images; use link, embed or copy");
	return NT_OK;
}

static nt_status read_scene(run *r)
{
	nt_status status = open_scene(r);
	if (status)
		return nt_error_in_file(r->error, r->input_path);
	status = choose_writer(r);
	if (!status)
		status = check_document_options(r);
	if (status)
		return status;

	/* glTF without normals is left alone unless normals are asked for; the other formats get them */
	const bool gltf = r->reader->format == NT_FORMAT_GLTF || r->reader->format == NT_FORMAT_GLB;
	nt_select(&r->scene, r->settings->only, r->settings->existing,
		!gltf || r->settings->normals != NT_NORMALS_AUTO);
	count_decisions(r);
	status = load_meshes(r);
	return status ? nt_error_in_file(r->error, r->input_path) : NT_OK;
}

static nt_status write_scene(run *r)
{
	begin_stage(r, NT_STAGE_WRITE);
	const nt_settings *s = r->settings;
	const nt_output_options output_options = {.no_clobber = s->no_clobber, .sync = s->sync,
		.dry_run = s->dry_run, .in_place = s->in_place ? r->input_path : NULL, .result = &r->result,
		.find_claims = r->writer->format != NT_FORMAT_PLY ? nt_gltf_find_claims : NULL};
	const nt_write_options options = {
		.format = r->writer->format,
		.path = r->output_path,
		.embed = s->embed || s->buffers == NT_BUFFERS_EMBED,
		.bitangents = s->bitangents,
		.images = s->images,
		.buffers = s->buffers,
		.draco = s->draco,
		.morphs = s->morphs,
		.draco_bits = {s->draco_bits[0], s->draco_bits[1], s->draco_bits[2], s->draco_bits[3]},
		.precision = s->precision,
		.allow_outside = s->allow_outside,
	};
	nt_output *output = NULL;
	nt_status status = nt_output_create(&output, &output_options, r->error);
	if (!status && r->writer->format != NT_FORMAT_PLY)
		status = nt_stage_quads(&r->scene, r->error);
	if (!status && !s->in_place)
		status = nt_output_protect(output, r->input_path, "--in-place allows that", r->error);
	if (!status)
		status = r->writer->write(&r->scene, &options, output, r->error);
	/* the input may still be read here, and its faults are its own */
	if (status && r->error->place.pointer[0])
		nt_error_in_file(r->error, r->input_path);
	if (!status)
		r->summary->bytes_written = nt_output_size(output);
	if (!status)
		r->summary->bytes_copied = nt_output_copied(output);
	if (!status && s->verify && !s->dry_run) {
		begin_stage(r, NT_STAGE_VERIFY);
		status = nt_verify_gltf(&r->scene, output, r->output_path, r->error);
	}
	if (!status)
		status = nt_watch_check(r->error);
	if (status || s->dry_run) {
		nt_output_abort(output);
		return status;
	}
	return nt_output_commit(output, r->error);
}

static nt_status run_stages(run *r)
{
	nt_status status = choose_writer(r);
	/* a PLY is one mesh in the world, so the reader has to say where the meshes stand */
	r->read_options.world = r->writer && r->writer->format == NT_FORMAT_PLY;
	if (!status)
		status = read_scene(r);
	if (!status)
		status = make_normals(r);
	if (!status) {
		begin_stage(r, NT_STAGE_TANGENTS);
		status = nt_stage_tangents(&r->scene, r->settings,
			r->writer ? r->writer->format : NT_FORMAT_UNKNOWN, r->summary, r->error);
		nt_error_in_file(r->error, r->input_path);
	}
	if (!status && r->settings->list_meshes)
		status = nt_stage_listing(&r->scene, r->summary, r->error);
	if (!status && r->writer)
		status = write_scene(r);
	return status;
}

/* A copy of a mesh's normal map for the report. */
static nt_status copy_normal_map(nt_arena *arena, const nt_scene *scene, const nt_mesh *mesh, size_t most_bytes,
	nt_image *image)
{
	nt_normal_map map;
	nt_error error;
	nt_status status = nt_normal_map_open(&map, scene, mesh, &error);
	*image = (nt_image){0};
	if (!status && map.bytes && map.size <= most_bytes) {
		void *copy = nt_arena_alloc(arena, map.size, 1);
		if (copy)
			*image = (nt_image){memcpy(copy, map.bytes, map.size), map.size, map.type};
		else
			status = NT_ERROR_MEMORY;
	}
	nt_normal_map_close(&map);
	return status;
}

/* What is wrong with an input that became shorter is that, whatever was made of it and found in it. */
static nt_status check_inputs(run *r, nt_status status)
{
	const nt_status watched = nt_watch_check(r->error);
	if (!watched)
		return status;
	nt_finding_list_free(&r->scene.findings);
	r->scene.findings = (nt_finding_list){0};
	return watched;
}

/* A report that could not be made says why, if that much can be said. */
static nt_status build_report(run *r, const nt_report_options *options)
{
	nt_status status = nt_report_build(&r->scene, options, &r->summary->report, r->error);
	if (status || r->settings->check)
		status = check_inputs(r, status);
	if (!status)
		return NT_OK;
	nt_report_free(r->summary->report);
	r->summary->report = nt_report_of_error(r->input_path, r->error);
	return status;
}

/* The report of the scene as it now is, or of what went wrong. */
static nt_status make_report(run *r, nt_status status)
{
	if (!r->settings->report)
		return status;
	begin_stage(r, NT_STAGE_REPORT);
	if (!status && r->settings->across == NT_ACROSS_PRIMITIVE)
		status = nt_stage_borders(&r->scene, r->settings, r->error);
	if (status) {
		r->summary->report = nt_report_of_error(r->input_path, r->error);
		return status;
	}
	nt_report_options options = *r->settings->report;
	options.converted = r->writer != NULL;
	if (options.keep_geometry)
		options.find_normal_map = copy_normal_map;
	options.threads = r->settings->threads;
	return build_report(r, &options);
}

/* What a run that is to be done again has found and made so far; the times it took stay. */
static void forget_attempt(run *r)
{
	nt_summary *s = r->summary;
	double seconds[NT_STAGE_COUNT];
	memcpy(seconds, s->seconds, sizeof seconds);
	nt_scene_free(&r->scene);
	nt_summary_free(s);
	memset(s, 0, sizeof *s);
	memcpy(s->seconds, seconds, sizeof seconds);
	nt_buffer_free(&r->result.note);
	r->result = (nt_output_result){0};
	nt_error_clear(r->error);
	nt_scene_init(&r->scene, r->input_path);
}

nt_status nt_run(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error)
{
	memset(summary, 0, sizeof *summary);
	nt_error_clear(error);
	run r = {.input_path = input, .output_path = output, .settings = settings, .summary = summary,
		.error = error};
	r.read_options = (nt_read_options){.texcoord_set = settings->texcoord_set,
		.allow_outside = settings->allow_outside, .morphs = settings->morphs,
		.report = settings->report != NULL, .threads = settings->threads};
	const double begin = nt_seconds();
	r.stage_begin = begin;
	nt_scene_init(&r.scene, input);

	nt_watch_forget();
	nt_status status = run_stages(&r);
	for (unsigned attempt = 1; r.result.again && attempt < MOST_ATTEMPTS; attempt++) {
		forget_attempt(&r);
		status = run_stages(&r);
	}
	if (status || !r.writer)
		status = check_inputs(&r, status);
	summary->left = r.result.left;
	if (!status && r.result.note.failed)
		status = nt_fail_memory(error);
	summary->note = r.result.note.data;
	status = make_report(&r, status);

	/* what was found belongs to the caller, also after a failure */
	end_stage(&r);
	if (r.scene.read_of_source)
		summary->bytes_read = r.scene.read_of_source(r.scene.source);
	summary->findings = r.scene.findings;
	summary->rounding = r.scene.rounding;
	r.scene.findings = (nt_finding_list){0};
	nt_scene_free(&r.scene);
	nt_file_close(&r.input);
	summary->total_seconds = nt_seconds() - begin;
	if (!status && summary->findings.failed)
		status = nt_fail_memory(error);
	if (status && status != NT_ERROR_USAGE)
		nt_error_in_file(error, input);
	return status;
}

void nt_summary_free(nt_summary *summary)
{
	nt_finding_list_free(&summary->findings);
	nt_report_free(summary->report);
	free(summary->lines);
	free(summary->note);
	summary->lines = NULL;
	summary->note = NULL;
	summary->report = NULL;
}

void nt_run_catch_signals(void)
{
	nt_output_catch_signals();
}

void nt_run_catch_exhaustion(void (*end)(void))
{
	nt_output_catch_exhaustion(end);
}
