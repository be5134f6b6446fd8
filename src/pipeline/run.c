/* SPDX-License-Identifier: MIT */
/*
 * One input from file to file: see run.h. The order of the stages and their times, and what --fix adds to the options:
 * it runs the stages twice. summary.c counts and lists what comes of them.
 */
#include "pipeline/run.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/deadline.h"
#include "file/input.h"
#include "format/format.h"
#include "format/maps.h"
#include "gltf/document.h"
#include "gltf/verify/verify.h"
#include "pipeline/stages.h"
#include "scene/values.h"

/* Shared data of the stages of one run. */
typedef struct run {
	const char *input_path, *output_path;
	const nt_settings *settings;
	nt_summary *summary;
	nt_error *error;
	nt_file input;
	nt_scene scene;
	bool nowhere; /* judged as if written to a stream */
	const nt_format_entry *reader, *writer; /* writer: NULL where --check judges the input as it is */
	nt_read_options options; /* of reader and writer */
	nt_textures *textures; /* NULL: the output has none */
	nt_turned_images turned;
	nt_fixes fixes; /* empty without --fix */
	double stage_begin;
	_Atomic(nt_stage) stage; /* the timer asks, too */
	nt_timer timer;
	bool input_is_open, placed; /* placed: the output */
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

static void begin_stage(void *user, nt_stage stage)
{
	run *r = user;
	end_stage(r);
	r->stage = stage;
	if (r->settings->on_stage)
		r->settings->on_stage(r->settings->on_stage_user, stage);
}

/* As the source says, before most of the work: each primitive has its own, once more for each morph target that is
 * baked, and each instance where all become one mesh. */
static nt_status check_triangles(const run *r)
{
	const nt_scene *scene = &r->scene;
	const bool placed = r->options.world && scene->instance_count;
	const uint64_t most = r->settings->max_triangles;
	const bool bakes = r->writer && !r->settings->check && !r->options.world &&
		r->settings->io.morphs == NT_MORPH_BAKE;
	uint64_t count = 0, of_targets = 0;
	for (size_t i = 0; most && i < (placed ? scene->instance_count : scene->mesh_count); i++) {
		const nt_mesh *mesh = &scene->meshes[placed ? scene->instances[i].mesh : i];
		uint64_t triangles = mesh->triangles ? mesh->face_count : 0;
		for (size_t f = 0; mesh->face_sizes && f < mesh->face_count; f++)
			triangles += mesh->face_sizes[f] == 4;
		count += triangles;
		of_targets += bakes && nt_mesh_gets_tangents(mesh) ? triangles * mesh->moving_targets : 0;
	}
	if (count + of_targets <= most)
		return NT_OK;
	nt_fail(r->error, NT_ERROR_LIMIT, of_targets
		? "%" PRIu64 " triangles with those of morph targets, --max-triangles is %" PRIu64
		: "%" PRIu64 " triangles, --max-triangles is %" PRIu64, count + of_targets, most);
	return nt_error_in_file(r->error, r->input_path);
}

static nt_status open_scene(run *r)
{
	begin_stage(r, NT_STAGE_MAP);
	nt_status status = NT_OK;
	if (!r->input_is_open)
		status = nt_file_open(&r->input, r->input_path, NT_NAMED_BY_USER, r->error);
	if (status && nt_is_folder(r->input_path))
		strncat(r->error->message, r->settings->own_input && !r->settings->check
			? "; -r with -d DIR takes the meshes in it" : "; -r takes the meshes in it",
			sizeof r->error->message - strlen(r->error->message) - 1);
	if (status)
		return status;
	r->input_is_open = true;
	r->summary->bytes_read = r->input.size;
	r->scene.bytes = r->input.data;
	r->scene.file = &r->input;
	r->scene.byte_count = r->input.size;

	begin_stage(r, NT_STAGE_PARSE);
	r->reader = nt_format_of_input(r->input.data, r->input.size, r->input_path);
	if (!r->reader) {
		const char *advice = nt_foreign_advice(r->input.data, r->input.size, r->input_path);
		return nt_fail(r->error, advice ? NT_ERROR_UNSUPPORTED : NT_ERROR_INPUT, "%s",
			advice ? advice : "not recognised: expected OBJ, PLY, glTF, GLB or Draco");
	}
	r->scene.format = r->reader->format;
	status = r->reader->open(&r->scene, &r->options, r->error);
	end_stage(r);
	r->summary->seconds[NT_STAGE_INDEX] += r->scene.index_seconds;
	r->summary->seconds[NT_STAGE_PARSE] -= r->scene.index_seconds;
	return status;
}

/* Nothing takes its name if it is too late for that, or if a record could not say of what it was made. */
static nt_status check_placing(void *user, nt_error *error)
{
	run *r = user;
	return r->summary->trace.failed || !nt_timer_hold(&r->timer) ? nt_fail_memory(error) : NT_OK;
}

static nt_output_options output_options_of(run *r)
{
	const nt_settings *s = r->settings;
	return (nt_output_options){.no_clobber = s->no_clobber, .sync = s->sync, .equal = s->equal,
		.dry_run = s->dry_run || s->check,
		.in_place = s->in_place ? r->input_path : NULL, .result = &r->result,
		.find_ownership = r->writer->format != NT_FORMAT_PLY ? nt_gltf_find_ownership : NULL,
		.placing = check_placing, .placing_user = r};
}

/* Settings that the plan depends on, now that reader and writer are known. */
static void plan_options_of(run *r)
{
	const nt_settings *s = r->settings;
	nt_read_options *o = &r->options;
	o->edits = nt_writer_edits(r->reader, r->writer);
	o->checks_kept = o->across && s->report && (o->edits || !r->writer);
	o->only_results = o->edits && !s->check && !s->report && !s->verify && !s->io.bitangents && !o->across &&
		s->io.draco <= NT_DRACO_OFF && s->normals == NT_NORMALS_AUTO && !s->list_meshes;
	/* primitives, or normals that are made for some that are compressed */
	o->compresses = o->edits && (s->io.draco > NT_DRACO_OFF ||
		(s->io.draco == NT_DRACO_KEEP && s->normals != NT_NORMALS_AUTO));
}

/* Whether materials become those of a new glTF. */
static bool makes_document(const run *r)
{
	return r->writer && r->writer->format != NT_FORMAT_PLY && !nt_format_is_gltf(r->scene.format);
}

/* A glTF without normals is left alone unless normals are asked for; the other formats get them for tangents. With
 * --draco, what gets tangents is compressed, and nothing else touched. */
static nt_making_normals making_normals(const run *r)
{
	const nt_settings *s = r->settings;
	if (s->normals == NT_NORMALS_AUTO)
		return nt_format_is_gltf(r->reader->format) ? NT_MAKING_NONE : NT_MAKING_MISSING;
	if (!r->writer || s->io.draco > NT_DRACO_OFF)
		return NT_MAKING_MISSING;
	return s->normals >= NT_NORMALS_REPLACE_FLAT ? NT_MAKING_ALL : NT_MAKING_ALL_MISSING;
}

static void apply_fixes(run *r)
{
	for (size_t i = 0; i < r->fixes.mesh_count && i < r->scene.mesh_count; i++) {
		nt_mesh *mesh = &r->scene.meshes[i];
		const nt_mesh_fix *fix = &r->fixes.meshes[i];
		mesh->fix = fix->existing;
		mesh->keeps_inverted = fix->keeps_inverted;
		/* of those that are not solved, the stage that looks at kept tangents says so */
		if (mesh->fix == NT_EXISTING_REPAIR && mesh->keeps_inverted && fix->doubtful)
			nt_finding_put(&r->scene.findings, (nt_finding){.code = NT_CODE_TAN_KEPT_SIGN,
				.count = fix->doubtful, .repair = "--existing=replace",
				.detail = nt_doubt_text(NT_DOUBT_UNDECODABLE) + 2},
				nt_mesh_place(mesh, &(nt_place){0}));
	}
	r->scene.turned_images = r->fixes.images;
	r->scene.turned_image_count = r->fixes.image_count;
}

static nt_status read_scene(run *r)
{
	nt_status status = open_scene(r);
	if (status)
		return nt_error_in_file(r->error, r->input_path);
	status = nt_choose_writer(r->settings, r->output_path, r->reader, &r->writer, r->error);
	if (status)
		return status;
	r->scene.judged = r->writer ? r->writer->format : r->scene.format;
	/* a cloud of points goes from PLY to PLY, but is no mesh that could be judged */
	if (r->scene.format == NT_FORMAT_PLY && r->settings->check && !r->settings->converts &&
		!nt_scene_has_triangles(&r->scene))
		return nt_fail(r->error, NT_ERROR_UNSUPPORTED, "found no faces, expected a mesh");

	status = nt_stage_given_maps(&r->scene, r->settings, makes_document(r), r->error);
	if (status)
		return status;

	if (r->settings->existing == NT_EXISTING_DROP && !nt_format_is_gltf(r->scene.format))
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--existing=drop is for glTF, whose materials say which tangents are used");
	if (r->settings->io.texcoord_set > 0 && !nt_format_is_gltf(r->scene.format))
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--uv=%d is for glTF: an OBJ, PLY or Draco file has one set of texture coordinates, 0",
			r->settings->io.texcoord_set);
	if (nt_origin_is_given(&r->settings->io.origin) && r->reader->format != NT_FORMAT_OBJ &&
		r->reader->format != NT_FORMAT_PLY)
		return nt_fail(r->error, NT_ERROR_USAGE,
			"--origin=X,Y,Z is for OBJ and PLY: the positions of this file are floats already");
	memcpy(r->summary->origin, r->scene.origin, sizeof r->summary->origin);
	apply_fixes(r);
	const nt_settings *s = r->settings;
	/* tangents go with the normals that they were made for */
	const bool replaces = s->normals >= NT_NORMALS_REPLACE_FLAT && s->existing != NT_EXISTING_DROP;
	nt_select(&r->scene, s->only, replaces ? NT_EXISTING_REPLACE : s->existing, making_normals(r));
	status = check_triangles(r);
	if (status)
		return status;
	/* what needs nothing may be left alone wherever it is */
	if (nt_count_decisions(r->summary, &r->scene) && r->settings->in_place) {
		const nt_output_options options = output_options_of(r);
		status = nt_output_check_in_place(&options, r->output_path, r->error);
		if (status)
			return status;
	}
	begin_stage(r, NT_STAGE_DECODE);
	plan_options_of(r);
	status = r->reader->plan ? r->reader->plan(&r->scene, &r->options, r->error) : NT_OK;
	return status ? nt_error_in_file(r->error, r->input_path) : NT_OK;
}

/* Files that were read must not be overwritten: the input, and what it refers to. */
static nt_status protect_inputs(const run *r, nt_output *output)
{
	nt_status status = nt_output_protect(output, r->input_path, "--in-place allows that", r->error);
	for (size_t i = 0; i < r->summary->trace.count && !status; i++) {
		const nt_trace_file *file = &r->summary->trace.files[i];
		if (file->kind == NT_TRACE_READ && strcmp(file->path, r->input_path) != 0)
			status = nt_output_protect(output, file->path, NULL, r->error);
	}
	return status;
}

/* The image that a PLY names. It is closed by the caller. */
static nt_status find_texture_file(run *r, nt_normal_map *map, nt_texture_file *file)
{
	const nt_settings *s = r->settings;
	const nt_image_places searched = nt_searched_places(s);
	*file = (nt_texture_file){0};
	if (r->writer->format != NT_FORMAT_PLY || r->scene.format == NT_FORMAT_PLY || s->io.images == NT_IMAGES_NONE)
		return NT_OK;
	const nt_status status = nt_color_image_open(map, &file->obstacle, &r->scene, &searched, r->error);
	if (status || !map->bytes)
		return status;
	file->path = map->path;
	file->bytes = map->bytes;
	file->size = map->size;
	return NT_OK;
}

/* A check does all but write, for what writers leave out is found there. */
static nt_status write_scene(run *r)
{
	begin_stage(r, NT_STAGE_WRITE);
	const nt_settings *s = r->settings;
	const nt_output_options output_options = output_options_of(r);
	const bool dry = output_options.dry_run;
	nt_normal_map colors = {0};
	nt_texture_file texture_file;
	nt_status status = find_texture_file(r, &colors, &texture_file);
	nt_write_options *options = &r->options;
	options->format = r->writer->format;
	options->texture_file = &texture_file;
	options->path = r->nowhere && texture_file.bytes ? r->input_path : r->output_path; /* the image lies beside */
	options->textures = r->textures;
	options->turned = &r->turned;
	if (r->nowhere)
		options->buffers = NT_BUFFERS_EMBED;
	nt_output *output = NULL;
	if (!status && s->report && nt_format_is_gltf(r->scene.format) && !r->turned.count)
		status = nt_normal_map_keep_uris(&r->scene, r->error);
	if (!status)
		status = nt_output_create(&output, &output_options, r->error);
	if (!status && r->writer->format != NT_FORMAT_PLY)
		status = nt_stage_quads(&r->scene, r->error);
	if (!status && !s->in_place && !r->nowhere)
		status = protect_inputs(r, output);
	if (!status)
		status = r->writer->write(&r->scene, options, output, r->error);
	nt_normal_map_close(&colors);
	/* the input may still be read here, and its faults are its own */
	if (status && r->error->place.pointer[0])
		nt_error_in_file(r->error, r->input_path);
	if (!status && !s->check) {
		r->summary->bytes_written = nt_output_size(output);
		r->summary->bytes_copied = nt_output_copied(output);
	}
	if (!status && s->verify && !dry) {
		begin_stage(r, NT_STAGE_VERIFY);
		status = nt_verify_gltf(&r->scene, output, r->output_path, options, r->error);
	}
	if (!status)
		status = nt_watch_check(r->error);
	/* what there is to say of an output has its memory before that appears */
	if (!status && (r->scene.findings.failed || r->result.note.failed))
		status = nt_fail_memory(r->error);
	if (status || dry) {
		nt_output_abort(output);
		return status;
	}
	status = nt_output_commit(output, r->error);
	nt_timer_release(&r->timer);
	r->placed = !status;
	return status;
}

static nt_status turn_maps(run *r)
{
	const nt_settings *s = r->settings;
	begin_stage(r, NT_STAGE_TEXTURES);
	const nt_status status = nt_turned_maps_make(&r->scene, &(nt_turning){.flip = s->flip_green,
		.heights = s->bump == NT_BUMP_HEIGHT, .height = nt_bump_height(s), .max_pixels = s->max_pixels,
		.images = r->fixes.images, .image_count = r->fixes.image_count, .threads = s->io.threads}, &r->turned,
		r->error);
	r->summary->made_maps = r->turned.count;
	return status;
}

static nt_status run_stages(run *r)
{
	nt_status status = nt_choose_writer(r->settings, r->output_path, NULL, &r->writer, r->error);
	/* an output of a folder is likely to be one, too */
	if (status && nt_is_folder(r->input_path))
		return open_scene(r);
	/* a PLY is one mesh in the world, so the reader has to say where the meshes stand */
	r->options.world = r->writer && r->writer->format == NT_FORMAT_PLY;
	r->options.origin.to_ply = !r->writer || r->options.world;
	r->options.origin.keeps = r->settings->existing == NT_EXISTING_KEEP && !r->settings->fix &&
		r->settings->normals < NT_NORMALS_REPLACE_FLAT;
	if (!status && r->writer) {
		const nt_output_options options = output_options_of(r);
		status = nt_output_check_clobber(&options, r->output_path, r->error);
	}
	if (!status)
		status = read_scene(r);
	if (!status && makes_document(r)) {
		nt_propose_normal_map(&r->scene, r->settings);
		begin_stage(r, NT_STAGE_TEXTURES);
		status = nt_stage_textures(&r->scene, r->settings, r->output_path, &r->textures, r->error);
	}
	const nt_tasks tasks = {.scene = &r->scene, .reader = r->reader, .writer = r->writer,
		.written = r->writer ? r->writer->format : NT_FORMAT_UNKNOWN, .settings = r->settings,
		.options = &r->options, .textures = r->textures, .summary = r->summary,
		.begin_stage = begin_stage, .run = r};
	if (!status) {
		status = nt_stage_jobs(&tasks, r->error);
		nt_error_in_file(r->error, r->input_path);
	}
	if (!status)
		status = nt_tell_textures(&r->scene, r->settings, r->textures, r->summary, r->error);
	/* a writer finds out which of them it cannot read */
	if (!status && !r->writer)
		status = nt_look_for_images(&r->scene, r->error);
	if (!status)
		status = nt_stage_maps(&r->scene, r->settings, r->writer ? r->writer->format : NT_FORMAT_UNKNOWN,
			r->textures, r->error);
	if (!status && r->settings->quads == NT_QUADS_PAIRS && r->summary->solved_count && !r->summary->quad_count)
		nt_finding_add(&r->scene.findings, NT_CODE_TAN_QUADS_NONE, &(nt_place){.offset = NT_NO_OFFSET}, 1, "%s",
			nt_format_is_gltf(r->scene.format) ? "no two triangles that follow each other are a quad"
				: "it is for glTF; the faces of this file are solved as they are");
	if (!status && r->settings->list_meshes)
		status = nt_list_meshes(r->summary, &r->scene, r->error);
	if (!status && r->writer && nt_writer_edits(r->reader, r->writer) &&
		(r->settings->flip_green || r->settings->bump == NT_BUMP_HEIGHT))
		status = turn_maps(r);
	if (!status && r->writer)
		status = write_scene(r);
	for (size_t i = 0; !status && i < r->scene.mesh_count; i++)
		if (r->scene.meshes[i].decision == NT_DECISION_NORMALS) /* no report takes them for tangents */
			r->scene.meshes[i].split = (nt_split){0};
	return status;
}

/* Drops the findings and data of a run that is to be done again; the times it took stay, and what it read (the
 * input is still open). */
static void forget_attempt(run *r)
{
	nt_summary *s = r->summary;
	double seconds[NT_STAGE_COUNT];
	nt_trace trace = s->trace;
	memcpy(seconds, s->seconds, sizeof seconds);
	s->trace = (nt_trace){0};
	nt_scene_free(&r->scene);
	nt_textures_free(r->textures);
	r->textures = NULL;
	nt_turned_maps_free(&r->turned);
	nt_summary_free(s);
	memset(s, 0, sizeof *s);
	memcpy(s->seconds, seconds, sizeof seconds);
	nt_trace_forget_written(&trace);
	s->trace = trace;
	nt_buffer_free(&r->result.note);
	r->result = (nt_output_result){0};
	nt_error_clear(r->error);
	nt_scene_init(&r->scene, r->input_path);
}

static void set_options(run *r, const nt_settings *s)
{
	r->settings = s;
	r->options = s->io;
	r->options.report = s->report != NULL;
}

/* A later stage judges an input that changed. */
static nt_status make_report(run *r, nt_status status)
{
	if (status || r->settings->check)
		status = nt_check_inputs(&r->scene, status, r->error);
	if (!r->settings->report)
		return status;
	begin_stage(r, NT_STAGE_REPORT);
	return nt_stage_report(&r->scene, r->settings, r->writer ? r->writer->format : NT_FORMAT_UNKNOWN, r->textures,
		status, r->summary, r->error);
}

/* --fix: the input is judged as --check does, and what is to be repaired becomes settings and marks of meshes.
 * Findings that the user ignores, or calls an info, are left. */
static nt_status plan_fixes(run *r, nt_settings *fixed)
{
	const nt_settings *wished = r->settings;
	nt_report_options options = {0};
	if (wished->report) {
		memcpy(options.ignore, wished->report->ignore, sizeof options.ignore);
		memcpy(options.severity, wished->report->severity, sizeof options.severity);
	}
	nt_settings judged = *wished;
	judged.check = true;
	judged.converts = false;
	judged.report = &options;
	judged.check_maps = NT_CHECK_MAPS_ON;
	judged.list_meshes = judged.digests = judged.in_place = judged.verify = judged.no_clobber = false;
	judged.output_format = NT_FORMAT_UNKNOWN;
	const char *output = r->output_path;
	r->output_path = "-";
	r->nowhere = true;
	set_options(r, &judged);
	nt_status status = make_report(r, run_stages(r));
	r->output_path = output;
	r->nowhere = false;
	if (!status && nt_fixes_make(&r->fixes, &r->scene, r->summary->report))
		status = nt_fail_memory(r->error);
	*fixed = *wished;
	if (status) {
		nt_report_free(r->summary->report);
		r->summary->report = NULL;
	} else {
		forget_attempt(r);
	}
	if (r->fixes.turns_maps)
		fixed->flip_green = NT_FLIP_AUTO;
	r->fixes.left[NT_CODE_NMAP_HEIGHTS] &= wished->bump != NT_BUMP_HEIGHT; /* which the check did not convert */
	set_options(r, fixed);
	return status;
}

/* Whether the output has what the input has: nobody's tangents or normals were made or dropped, no image was turned, no
 * vertices welded. */
static bool is_unchanged(const run *r)
{
	bool same = r->writer && (nt_writer_edits(r->reader, r->writer) || r->reader == r->writer) &&
		!r->turned.count && r->scene.welded.before == r->scene.welded.after && !r->summary->solved_count &&
		!r->summary->skipped[NT_SKIP_DROPPED];
	for (size_t i = 0; i < r->scene.mesh_count; i++)
		same &= !r->scene.meshes[i].normals_made;
	return same;
}

/* ---- limits ---- */

static nt_status fail_late(const run *r, nt_error *error)
{
	return nt_fail(error, NT_ERROR_LIMIT, "not done after --max-seconds=%.9g (%s)%s", r->settings->max_seconds,
		nt_stage_name(r->stage), r->placed ? "; the output stands" : "");
}

static void end_late(void *user)
{
	const run *r = user;
	nt_error error;
	fail_late(r, &error);
	nt_error_in_file(&error, r->input_path);
	r->settings->too_late(&error);
}

/* The failure as the user sees it: that there was no memory can be a limit. */
static nt_status name_limit(run *r, nt_status status)
{
	const nt_settings *s = r->settings;
	if (!status)
		return NT_OK;
	if (!r->error->status) /* a failure that nobody described is one, too */
		nt_fail(r->error, status, "%s", nt_status_text(status));
	if (nt_timer_end(&r->timer)) {
		fail_late(r, r->error);
	} else if (status == NT_ERROR_MEMORY && s->max_memory) {
		nt_fail_memory_limit(s->max_memory, r->error);
		/* the program takes up to 32 MB before it reads anything: less than that says nothing */
		if (s->need > s->max_memory && s->need >= 32 << 20 && s->need != UINT64_MAX)
			snprintf(r->error->message + strlen(r->error->message), 120,
				": %" PRIu64 "M is the most that such a file needs: try half of it first",
				(s->need >> 20) + 1);
	}
	return r->error->status;
}

nt_status nt_run(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error)
{
	memset(summary, 0, sizeof *summary);
	nt_error_clear(error);
	nt_settings fixed;
	run r = {.input_path = input, .output_path = output ? output : "-", .nowhere = !output, .summary = summary,
		.error = error};
	set_options(&r, settings);
	const double begin = nt_seconds();
	r.stage_begin = begin;
	nt_scene_init(&r.scene, input);

	nt_watch_forget();
	nt_trace_share(&summary->trace, settings->readers);
	nt_trace *outer = nt_trace_use(&summary->trace);
	nt_status status = nt_timer_begin(&r.timer, settings->max_seconds, settings->too_late ? end_late : NULL, &r)
		? NT_OK : nt_fail_memory(error);
	if (!status && settings->fix)
		status = plan_fixes(&r, &fixed);
	if (!status)
		status = run_stages(&r);
	for (unsigned attempt = 1; r.result.again && attempt < MOST_ATTEMPTS; attempt++) {
		forget_attempt(&r);
		status = run_stages(&r);
	}
	status = name_limit(&r, status);
	status = make_report(&r, status);
	if (settings->report && status == NT_ERROR_MEMORY && nt_timer_end(&r.timer))
		status = fail_late(&r, error);
	summary->left = r.result.left && !settings->check;
	summary->note = r.result.note.data;
	memcpy(summary->fixed, r.fixes.counts, sizeof summary->fixed);
	memcpy(summary->unfixed, r.fixes.left, sizeof summary->unfixed);
	nt_timer_end(&r.timer);

	/* what was found belongs to the caller, also after a failure */
	end_stage(&r);
	if (r.scene.read_of_source)
		summary->bytes_read = r.scene.read_of_source(r.scene.source);
	nt_summarise(summary, &r.scene, settings, status);
	summary->unchanged = !status && is_unchanged(&r);
	nt_scene_free(&r.scene);
	nt_textures_free(r.textures);
	nt_turned_maps_free(&r.turned);
	nt_fixes_free(&r.fixes);
	nt_file_close(&r.input);
	nt_trace_use(outer);
	summary->total_seconds = nt_seconds() - begin;
	if (!status && summary->findings.failed)
		status = nt_fail_memory(error);
	if (status && status != NT_ERROR_USAGE)
		nt_error_in_file(error, input);
	return status;
}
