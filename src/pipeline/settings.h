/* SPDX-License-Identifier: MIT */
/*
 * Settings and results of a run.
 */
#ifndef NT_PIPELINE_SETTINGS_H
#define NT_PIPELINE_SETTINGS_H

#include "file/input.h"
#include "file/output.h"
#include "image/textures.h"
#include "report/report.h"
#include "scene/format.h"
#include "scene/scene.h"

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
		size_t count, solved, skipped[NT_DECISION_COUNT];
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

#endif
