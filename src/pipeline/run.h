/* SPDX-License-Identifier: MIT */
/*
 * One input from file to file: read, select, load, make normals, solve, split, write; its settings and results, the
 * time that it may take, and where reports go. The entry point for any front end; nothing here prints or exits.
 */
#ifndef NT_PIPELINE_RUN_H
#define NT_PIPELINE_RUN_H

#include <pthread.h>
#include "base/deadline.h"
#include "base/hash_index.h"
#include "file/input.h"
#include "file/output.h"
#include "image/textures.h"
#include "report/render/render.h"
#include "report/report.h"
#include "scene/format.h"
#include "scene/scene.h"

/* ---- settings and results ---- */

/* If normals are missing; the last three replace authored ones, too. */
typedef enum nt_normals {
	NT_NORMALS_AUTO,
	NT_NORMALS_FLAT,
	NT_NORMALS_SMOOTH,
	NT_NORMALS_ANGLE,
	NT_NORMALS_REPLACE_FLAT,
	NT_NORMALS_REPLACE_SMOOTH,
	NT_NORMALS_REPLACE_ANGLE
} nt_normals;

/* Kinds of images that map_Bump and bump name. */
typedef enum nt_bump {
	NT_BUMP_AUTO,   /* grey images are height maps, others normal maps: also of norm and map_Kn */
	NT_BUMP_HEIGHT,
	NT_BUMP_NORMAL,
	NT_BUMP_IGNORE
} nt_bump;

/* Images that the user names. */
typedef enum nt_given {
	NT_GIVEN_BASE_COLOR,
	NT_GIVEN_NORMAL,
	NT_GIVEN_METALLIC_ROUGHNESS,
	NT_GIVEN_OCCLUSION,
	NT_GIVEN_EMISSIVE,
	NT_GIVEN_COUNT
} nt_given;

/* Whether normal maps are decoded to be examined. */
typedef enum nt_check_maps {
	NT_CHECK_MAPS_AUTO, /* for a report, files of at most 16 MB */
	NT_CHECK_MAPS_ON,
	NT_CHECK_MAPS_OFF
} nt_check_maps;

/* Stages as --timing prints them. */
typedef enum nt_stage {
	NT_STAGE_MAP,
	NT_STAGE_PARSE,
	NT_STAGE_INDEX,    /* corners with indices of their own become vertices: OBJ */
	NT_STAGE_DECODE,   /* small meshes that are solved as soon as they are loaded, too */
	NT_STAGE_TEXTURES, /* images are looked for; they are made beside the solve */
	NT_STAGE_NORMALS,  /* normals, weld and split are of large meshes; small ones count as tangents */
	NT_STAGE_WELD,
	NT_STAGE_TANGENTS,
	NT_STAGE_SPLIT,
	NT_STAGE_WRITE,
	NT_STAGE_VERIFY,
	NT_STAGE_REPORT,
	NT_STAGE_COUNT
} nt_stage;

/* Everything a run can be told. Zero-initialised means the defaults of the command line, but for
 * io.texcoord_set, whose default is -1, and io.outside, whose default is root. */
typedef struct nt_settings {
	nt_format_options io; /* of readers and writers; the run fills the rest in its copy */
	nmtan_method method;
	nmtan_repair repair;
	nt_only only;
	nt_existing existing;
	bool fix;      /* repair what a check of the input calls error or warning, as far as that is proven: fix.c */
	nt_normals normals;
	int normals_degrees; /* of those by ANGLE: faces that meet at less share a normal */
	nt_quads quads;
	nt_format output_format; /* NT_FORMAT_UNKNOWN: by name; with check: see writer.c */
	nt_texture_choice textures;
	nt_bump bump;
	double bump_height;      /* 0: the default */
	nt_flip flip_green;
	nt_check_maps check_maps;
	const char *const *texture_paths; /* [texture_path_count] folders */
	size_t texture_path_count;
	const char *given_maps[NT_GIVEN_COUNT]; /* paths; NULL: none */
	bool verify;   /* read the output back before it takes its name, and have tinygltf open it */
	bool dry_run;  /* do everything but write */
	bool check;    /* a report only: no output */
	bool converts; /* with check: a glTF is judged as it would be written, not as it is */
	bool sync;
	bool no_clobber;
	bool list_meshes; /* summary->lines is wanted */
	bool digests;     /* summary->tangents_digest is wanted */
	bool in_place;
	const char *root; /* with NT_OUTSIDE_ROOT: the folder of the user's that the input is below; NULL: none */
	bool own_input;   /* the one input that the user names: see options.c */
	nt_equal_choice equal; /* what becomes of an output that has its bytes already */

	/* Limits; 0: none. See nmtan(1). */
	uint64_t max_triangles; /* of what is read */
	uint64_t max_pixels;    /* of images that are decoded and made; 0: as nt_check_pixels() has it */
	uint64_t max_memory;    /* bytes, of which a front end has the system refuse more */
	double max_seconds;     /* of a run */
	uint64_t need;          /* bytes that a run may take, as far as was guessed; 0: not known */
	/* Ends the process, for a front end that is it: the run is late and does not end by itself. NULL: it may. */
	void (*too_late)(const nt_error *error);

	nt_readers *readers; /* what the other runs of a batch read is protected, too; NULL: there are none */

	/* Options of the report; NULL: none is made. `written` is set by the run. */
	const nt_report_options *report;

	/* Called when a stage begins, from the thread that called nt_run; NULL: nobody looks. */
	void (*on_stage)(void *user, nt_stage stage);
	void *on_stage_user;
} nt_settings;

/* The outcome of one mesh (glTF: primitive). */
typedef struct nt_mesh_line {
	nt_place place;
	nt_decision decision;
	bool same;             /* the geometry of an earlier one, whose tangents it shares */
	size_t triangle_count; /* of skipped ones: as the source claims; of points and lines 0 */
	size_t vertex_count;   /* before; 0 where nothing was loaded */
	size_t appended;       /* vertices added */
} nt_mesh_line;

/* The results of a run. */
typedef struct nt_summary {
	nt_format input_format;
	size_t mesh_count;       /* meshes (glTF: primitives) in the input */
	size_t solved_count;     /* of them, those that got tangents */
	struct {
		size_t count, solved, skipped[NT_DECISION_COUNT], copies;
	} made;                  /* the same of the primitives of a new glTF; count 0: it is none */
	size_t repaired;         /* tangents of corners: what repair made of computed or, with --existing=repair, of the
	                            input's own */
	size_t quad_count;       /* pairs of these triangles that were solved as quads */
	double origin[3];        /* of the scene */
	size_t same_count;       /* of the solved ones, those that took the result of another: they have the
	                            same geometry */
	size_t skipped[NT_DECISION_COUNT]; /* of them, by reason */
	size_t triangle_count;   /* of the solved ones, after triangulation */
	size_t vertex_count;     /* of the solved ones, before */
	size_t appended_normals; /* vertices added because normals were made */
	size_t appended_tangents;/* vertices added because tangents differ */
	nmtan_counts counts;     /* of all solves */
	nt_rounding rounding;    /* of tangents that were stored as integers */
	nt_morph_cost morph_cost; /* of the targets whose tangents were written */
	size_t made_maps;        /* images of a glTF that --flip-green, --bump or --fix turned or made normal maps */
	nt_weld_result welded;   /* vertices of the pools that --weld looked at, before and after */
	nt_block_result packed;  /* what Draco's blocks have of them */
	nt_finding_list findings;
	uint64_t bytes_read;     /* of the inputs, as far as known; what is only copied is not */
	uint64_t bytes_copied;   /* from an input to the output as they are */
	uint64_t bytes_written;  /* those too */
	double seconds[NT_STAGE_COUNT];
	double total_seconds;
	nt_report *report; /* NULL unless asked for; of a failed run it says why */
	nt_mesh_line *lines; /* [line_count] in the order of the input; NULL unless asked for */
	size_t line_count;
	nt_trace trace;  /* which files were read, missed and written, after a failure too */
	uint64_t tangents_digest; /* of those that were computed, in the order of the meshes; 0: none, or not wanted */
	size_t fixed[NT_CODE_COUNT]; /* with fix: primitives and images repaired, by the code of the finding */
	bool unfixed[NT_CODE_COUNT]; /* with fix: errors and warnings that another option repairs */
	size_t shaded_count, shaded_copies; /* those that got normals and no tangents, and vertices added for that */
	size_t made_normals, kept_normals; /* meshes that got some; meshes that keep all of theirs */
	size_t without_normals; /* meshes: of a glTF, although normals were asked for; else, because they were not */
	bool keeps_wrong; /* tangents of the output are known to be wrong */
	bool left;       /* the file has what it would get, and was left as it is */
	bool unchanged;  /* the output says what the input says, in the same format */
	size_t bare_materials;   /* that name images, none of which is in the output */
	char bare_material[100]; /* the first of them */
	char *note;      /* which files of the output have other names than they would, and why: "; ..."; NULL: none */
} nt_summary;

/* ---- the run: run.c ---- */

/*
 * Runs one input.
 *
 *   input     path, or "-" for standard input
 *   output    path, or "-" for standard output; with settings->check where it would be, NULL: nowhere in particular
 *   settings  required
 *   summary   required; freed by nt_summary_free, after failure too
 *   error     required
 *
 * Returns any status.
 */
nt_status nt_run(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error);

void nt_summary_free(nt_summary *summary);

/* How a stage is called: "tangents". */
const char *nt_stage_name(nt_stage stage);

/* ---- the time that a run may take: timer.c ---- */

/* When it is over, memory is refused to the run's threads (base/deadline.h), so that the run fails at its next step;
 * where a front end is the whole process, the process ends soon after, whatever a library or a long loop is about, with
 * no temporary file left. */

typedef struct nt_timer {
	nt_deadline deadline;
	double end; /* as nt_seconds() has it; 0: the run may take any time */
	void (*too_late)(void *user);
	void *user;
	const nt_deadline *outer;
	pthread_t thread;
	pthread_mutex_t lock; /* of what follows */
	pthread_cond_t changed;
	bool held, over;
} nt_timer;

/*
 * Begins the time of the calling thread; 0 seconds: no bound. The timer must not move.
 *
 *   too_late  ends the process, from a thread of its own, if the run has not ended by itself shortly after its time;
 *             NULL: only the run's own steps end it
 *
 * Without a thread to be had there is no bound, and the result is false.
 */
bool nt_timer_begin(nt_timer *timer, double seconds, void (*too_late)(void *user), void *user);

/* Stops the time while an output takes its place, which happens whole. False: the time is over, nothing is to be
 * placed. */
bool nt_timer_hold(nt_timer *timer);
void nt_timer_release(nt_timer *timer);

/* Ends it; memory can be had again. Returns whether the time was over. More than once is allowed. */
bool nt_timer_end(nt_timer *timer);

/* ---- reports to files and folders, and the baseline from a file: report_file.c ---- */

/* The target of a report. */
typedef struct nt_report_target {
	const char *path;        /* "-" is standard output */
	nt_report_format format;
	nt_report_style style;
	bool no_clobber;
	const char *const *inputs; /* [input_count] files that must not be replaced */
	size_t input_count;
	bool folder;               /* path is one, for a page of each input and an index */
	const nt_report_diff *diff; /* written in place of the reports; NULL: they are */
} nt_report_target;

/* Writes one document about all reports: whole or not at all. NULLs among the reports are passed over. Returns
 * NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_report_to_file(nt_report *const *reports, size_t count, const nt_report_target *target,
	nt_error *error);

/* Reads the findings of a JSON report. The error names the report. */
nt_status nt_baseline_open(nt_baseline *baseline, const char *path, nt_error *error);

/* ---- a folder ---- */

/*
 * A report as a folder: a page of each input, and index.html, which lists them. Shared files are written first, each
 * page when its input is done, and the index at the end, so that no file refers to one that is not there yet. Memory
 * holds one row of the index for each page.
 */
typedef struct nt_report_folder {
	const nt_report_target *target;
	char **pages;   /* [target->input_count] file names in the folder */
	nt_key_set inputs; /* nt_file_id of those that are there */
	nt_buffer rows; /* of the index */
} nt_report_folder;

/*
 * Names the page of each input of the target, which must outlive the folder, makes the folder target->path where it
 * is missing (not its parents), and writes the parts that its pages share, where they are missing. A page is named
 * after the last part of its input's name: what is not a letter, a digit or one of ".-_" becomes "_"; where two would
 * have the same name, but for the case of letters, the later one has a hash of its input's path too.
 *
 * Returns NT_OK, NT_ERROR_IO, also where a file would replace what nmtan did not make, or an input, or NT_ERROR_MEMORY.
 * The folder is to be freed after failure too.
 */
nt_status nt_report_folder_begin(nt_report_folder *folder, const nt_report_target *target, nt_error *error);

/* Writes the page of an input, and notes its row for the index. Statuses as above; errors name the page. */
nt_status nt_report_folder_add(nt_report_folder *folder, size_t input, nt_report *report, nt_error *error);

/* Writes the index of the pages so far. */
nt_status nt_report_folder_end(nt_report_folder *folder, nt_error *error);

void nt_report_folder_free(nt_report_folder *folder);

#endif
