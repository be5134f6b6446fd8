/* SPDX-License-Identifier: MIT */
/*
 * The table of options: see options.h. It is read by the parser in options.c, and by --help, the completions and
 * what a record says of options in option_texts.c.
 */
#include "cli/options.h"

#define FIELD(name)   offsetof(nt_command, name)
#define SETTING(name) offsetof(nt_command, settings.name)

/* Enumerations are stored through int; the words of a choice are in the order of its constants. */
_Static_assert(sizeof(nt_only) == sizeof(int) && sizeof(nmtan_method) == sizeof(int), "enum is int");
_Static_assert(SETTING(normals_degrees) == SETTING(normals) + sizeof(int), "angle:N has its number behind it");
_Static_assert(NMTAN_METHOD_MIKKTSPACE_SORTED == NMTAN_METHOD_MIKKTSPACE + 4, "the words of --method");

const nt_option_row nt_option_rows[] = {
	{.kind = NT_OPTION_HEADING, .name = "Tangents", .first = NT_SHAPES_OUTPUT},
	{"only", 0, NT_OPTION_CHOICE, "auto|needed|all", NT_ONLY_AUTO, 0, "auto",
		"which primitives get tangents; auto: of glTF those whose material needs them, of OBJ and PLY all "
		"that have texture coordinates; needed: only those whose material needs them; all: all that can "
		"have them", SETTING(only), false},
	{"existing", 0, NT_OPTION_CHOICE, "keep|repair|replace|drop", NT_EXISTING_KEEP, 0, "keep",
		"tangents of the input; keep: keep them; repair: replace invalid ones; replace: replace all; drop: "
		"remove those that no material uses",
		SETTING(existing), true},
	{"fix", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"repair what --check calls an error or a warning, if it is proven: tangents, and normal maps whose "
		"green points down", SETTING(fix), true},
	{"method", 0, NT_OPTION_CHOICE, "mikktspace|area|lengyel|robust|mikktspace-sorted", NMTAN_METHOD_MIKKTSPACE, 0,
		"mikktspace", "how to average the triangles around a vertex", SETTING(method), true},
	{"raw", 0, NT_OPTION_SET, NULL, NMTAN_REPAIR_OFF, 0, NULL,
		"write the method's raw result, unusable tangents too; use it if the map was baked on folded quads",
		SETTING(repair), true},
	{"normals", 0, NT_OPTION_CHOICE, "auto|flat|smooth|angle:N|replace-flat|replace-smooth|replace-angle:N",
		NT_NORMALS_AUTO, 180, "auto",
		"how to make missing normals; auto: if tangents need them, of OBJ by smoothing group, of PLY and "
		"Draco smooth, of glTF none; angle: smooth between faces that meet at less than N degrees; replace-: "
		"replace the input's too",
		SETTING(normals), true},
	{"across", 0, NT_OPTION_CHOICE, "primitive|mesh", NT_ACROSS_PRIMITIVE, 0, "primitive",
		"glTF: solve each primitive alone, or all primitives of a mesh that share texture coordinates as "
		"one, as bakers do", SETTING(io.across), false},
	{"transform", 0, NT_OPTION_CHOICE, "bake|keep", NT_TRANSFORM_BAKE, 0, "bake",
		"if a material transforms texture coordinates; bake: tangents follow the result; keep: they follow "
		"those of the file, for a renderer that turns TANGENT itself",
		SETTING(io.transform), false},
	{"quads", 0, NT_OPTION_CHOICE, "auto|off|pairs", NT_QUADS_AUTO, 0, "auto",
		"glTF: which triangles to solve as quads, as bakers do; auto: if FB_ngon_encoding or the input's "
		"tangents show them; pairs: each triangle with the next one if both make a quad",
		SETTING(quads), false},
	{"uv", 0, NT_OPTION_AUTO_NUMBER, "auto|N", 0, 999, "auto",
		"the set of texture coordinates; auto: the one that the material uses",
		SETTING(io.texcoord_set), false},
	{"origin", 0, NT_OPTION_TEXT, "auto|keep|X,Y,Z", 0, 0, "auto",
		"OBJ and PLY: store positions relative to an origin, which the nodes of a glTF add again; auto: if "
		"float would move vertices by more than a hundredth of an edge; keep: round them",
		FIELD(origin), false},
	{"outside", 0, NT_OPTION_CHOICE, "no|root|yes", NT_OUTSIDE_NO, 0, "root",
		"files outside the input's folder; no: refuse them; root: allow images of an OBJ below the folder "
		"above it and below a folder that is named with -r or --keep-tree; yes: allow all",
		SETTING(io.outside), false},

	{.kind = NT_OPTION_HEADING, .name = "Many inputs"},
	{"directory", 'd', NT_OPTION_TEXT, "DIR", 0, 0, NULL,
		"write each input into DIR under its own name", FIELD(directory), true},
	{"keep-tree", 0, NT_OPTION_TEXT, "ROOT", 0, 0, NULL,
		"with -d: give each output the place below DIR that its input has below ROOT",
		FIELD(keep_tree), true},
	{"files-from", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"read the names of more inputs from FILE, one a line or each followed by NUL; - is standard input",
		FIELD(files_from), false},
	{"recursive", 'r', NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"take a folder as the meshes in it and in the folders below", FIELD(recursive), false},
	{"include", 0, NT_OPTION_LIST, "GLOB", 0, 0, NULL,
		"with -r: take only files that match GLOB; may be given several times", FIELD(include), false},
	{"exclude", 0, NT_OPTION_LIST, "GLOB", 0, 0, NULL,
		"with -r: skip files and folders that match GLOB; may be given several times",
		FIELD(exclude), false},
	{"fail-fast", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL, "start no more inputs after one has failed",
		FIELD(fail_fast), false},
	{"jobs", 'J', NT_OPTION_NUMBER, "N", 0, 1024, "0",
		"how many inputs to convert at a time; they share the threads; 0: as many as threads",
		FIELD(jobs), false},
	{"memory", 0, NT_OPTION_SIZE, "SIZE", 0, 0, "half of the free memory",
		"start an input only if its estimated memory fits into what is left of SIZE (64M, 2G); one that "
		"never fits runs alone", FIELD(memory), false},

	{.kind = NT_OPTION_HEADING, .name = "Incremental runs"},
	{"update", 0, NT_OPTION_MAYBE_CHOICE, "time|content", 1 + NT_UPDATE_BY_TIME, 0, NULL,
		"skip inputs if the output is up to date with the input, its files, the options and nmtan; time (or "
		"no value): a file is unchanged if its size, times and inode are; content: if its bytes are",
		FIELD(update), true},
	{"record", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"note in FILE what outputs are made of (with --update the default is .nmtan-record beside them)",
		FIELD(record), true},
	{"write-if-changed", 0, NT_OPTION_SET, NULL, NT_EQUAL_KEEP, 0, NULL,
		"keep an output's time of change if its bytes are the same", SETTING(equal), true},
	{"depfile", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"write to FILE, as a rule of make, which files an output depends on", FIELD(depfile), true},

	{.kind = NT_OPTION_HEADING, .name = "Output", .first = NT_SHAPES_OUTPUT},
	{"output", 'o', NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"name the output, in place of the second name", FIELD(output), true},
	{"output-format", 0, NT_OPTION_CHOICE, "ply|gltf|glb", NT_FORMAT_PLY, 0, "by name",
		"format of the output; with --check: judge the conversion to it; without it a PLY is judged as ply, an "
		"OBJ or Draco file as glb", SETTING(output_format), true},
	{"in-place", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"replace each input by its output; with -d: allow outputs to replace inputs",
		SETTING(in_place), true},
	{"buffers", 0, NT_OPTION_CHOICE, "link|copy|embed", NT_BUFFERS_LINK, 0,
		"embed for .glb from .gltf, else by folder",
		"embed: write all buffers into the output, in .gltf as data URIs; link, copy: refer to glTF's "
		"unchanged .bin files, or copy them; by folder: link those in the output's folder, copy others",
		SETTING(io.buffers), true},
	{"images", 0, NT_OPTION_CHOICE, "link|embed|copy|none", NT_IMAGES_LINK, 0,
		"embed for .glb, else by folder",
		"how the output refers to its images; by folder: link those in the output's folder, copy others",
		SETTING(io.images), true},
	{"textures", 0, NT_OPTION_CHOICE, "auto|keep|png", NT_TEXTURES_AUTO, 0, "auto",
		"images of an OBJ; auto: convert to PNG if glTF does not carry them; keep: leave those out; png: "
		"convert all that can be decoded; height maps, and maps that share an image in glTF, become PNG in any "
		"case", SETTING(textures), true},
	{"texture-path", 0, NT_OPTION_LIST, "DIR", 0, 0, NULL,
		"search DIR for images of an OBJ too; may be given several times", FIELD(texture_paths), false},
	{"base-color", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"OBJ, PLY and Draco with at most one material: use FILE as the base colour, with alpha",
		SETTING(given_maps[NT_GIVEN_BASE_COLOR]), false},
	{"normal-map", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"the same: use FILE as the normal map", SETTING(given_maps[NT_GIVEN_NORMAL]), false},
	{"metallic-roughness", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"the same: use FILE for roughness (green) and metallic (blue), as glTF does",
		SETTING(given_maps[NT_GIVEN_METALLIC_ROUGHNESS]), false},
	{"occlusion", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"the same: use FILE for occlusion (red)", SETTING(given_maps[NT_GIVEN_OCCLUSION]), false},
	{"emissive", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"the same: use FILE as the emitted colour", SETTING(given_maps[NT_GIVEN_EMISSIVE]), false},
	{"bump", 0, NT_OPTION_CHOICE, "auto|height|normal|ignore", NT_BUMP_AUTO, 0, "auto",
		"how to read the images of an OBJ's map_Bump and bump; auto: as heights if all pixels are grey, else "
		"as a normal map; height: as heights, and grey normal maps of a glTF too; normal: as normal maps; "
		"ignore: leave them out. Heights become a normal map", SETTING(bump), true},
	{"bump-height", 0, NT_OPTION_TEXT, "SHARE", 0, 0, "1/64",
		"height of white above black in a height map, as a share of its width; -bm multiplies it",
		FIELD(bump_height), true},
	{"flip-green", 0, NT_OPTION_CHOICE, "off|auto|on", NT_FLIP_OFF, 0, "off",
		"convert normal maps whose green points down, PNG and JPEG of glTF too; auto: if that is certain; "
		"on: convert all", SETTING(flip_green), true},
	{"draco", 0, NT_OPTION_CHOICE, "keep|off|sequential|edgebreaker", NT_DRACO_KEEP, 0, "keep",
		"glTF primitives that get tangents; keep: compress compressed ones again; off: write them "
		"uncompressed; sequential, edgebreaker: compress all", SETTING(io.draco), true},
	{"draco-bits", 0, NT_OPTION_TEXT, "POS,NRM,UV,TAN", 0, 0, "14,12,12,12",
		"quantize attributes that were not quantized before; tangents get 12 bits or more",
		FIELD(draco_bits), true},
	{"morph", 0, NT_OPTION_CHOICE, "bake|keep|drop", NT_MORPH_BAKE, 0, "bake",
		"glTF morph targets of primitives that get tangents; bake: compute their TANGENT; keep: leave it; "
		"drop: remove it", SETTING(io.morphs), true},
	{"precision", 0, NT_OPTION_CHOICE, "auto|float|short|byte", NT_PRECISION_AUTO, 0, "auto",
		"how glTF stores tangents; short and byte need KHR_mesh_quantization; auto: float, or as normals if "
		"meshopt compresses these", SETTING(io.precision), true},
	{"meshopt", 0, NT_OPTION_CHOICE, "keep|off", NT_MESHOPT_KEEP, 0, "keep",
		"meshopt-compressed buffer views that change; keep: compress them again, and new data too; off: "
		"write them uncompressed", SETTING(io.meshopt), true},
	{"weld", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"glTF from glTF: make one vertex of those that are equal in everything, and write indices",
		SETTING(io.weld), true},
	{"bitangents", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"write bitangents too: bx by bz in PLY, _BITANGENT in glTF", SETTING(io.bitangents), true},
	{"no-clobber", 'n', NT_OPTION_FLAG, NULL, 0, 0, NULL, "never replace a file",
		SETTING(no_clobber), true},
	{"sync", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"fsync files and folders, so that a power cut leaves the old or the new output",
		SETTING(sync), true},
	{"verify", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"read a glTF output back with tinygltf before it replaces anything", SETTING(verify), true},
	{"dry-run", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"do everything except writing", SETTING(dry_run), true},

	{.kind = NT_OPTION_HEADING, .name = "Checks and reports"},
	{"check", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"read and judge the inputs, write no mesh", SETTING(check), false},
	{"diff", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"with --check OLD NEW: report what changed in tangents, seams and findings; only new findings "
		"decide the exit code", FIELD(diff), false},
	{"check-maps", 0, NT_OPTION_CHOICE, "auto|on|off", NT_CHECK_MAPS_AUTO, 0, "auto",
		"decode and examine normal maps; auto: for a report or --normal-map, files of at most 16 MB",
		SETTING(check_maps), false},
	{"fail-on", 0, NT_OPTION_CHOICE, "error|warning|info|never", NT_FAIL_ON_ERROR, 0,
		"error with --check, else never",
		"exit with 6 if a finding has this severity or a higher one", FIELD(fail_on), false},
	{"report", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"write a report to FILE; - is standard output, DIR/ gets a page for each input",
		FIELD(report), false},
	{"report-format", 0, NT_OPTION_CHOICE,
		"text|json|sarif|junit|csv|markdown|html|lines|github", 1, 0,
		"by name",
		"format of the report", FIELD(report_format), false},
	{"ignore", 0, NT_OPTION_LIST, "CODE,...", 0, 0, NULL,
		"do not report these findings; 'UV_*' means all codes that begin with UV_", FIELD(ignore), false},
	{"severity", 0, NT_OPTION_LIST, "CODE=LEVEL,...", 0, 0, NULL,
		"count these findings as error, warning, info or off, as TAN_*=error", FIELD(severity), false},
	{"baseline", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"count only findings that FILE, an earlier JSON report, does not have", FIELD(baseline), false},
	{"path-prefix", 0, NT_OPTION_TEXT, "DIR", 0, 0, NULL,
		"put DIR before the names of files in reports", FIELD(path_prefix), false},
	{"min-severity", 0, NT_OPTION_CHOICE, "error|warning|info", NT_FAIL_ON_ERROR, 0, "info",
		"neither report nor count findings below this severity", FIELD(min_severity), false},
	{"max-issues", 0, NT_OPTION_NUMBER, "N", 0, 1000000000, "10 in text and Markdown, else 0",
		"report at most N findings of each file, some of each code; 0: all", FIELD(max_issues), false},
	{"list-codes", 0, NT_OPTION_SET, NULL, NT_ACTION_LIST_CODES, 0, NULL,
		"print all codes of findings and exit", FIELD(action), false},
	{"explain", 0, NT_OPTION_LIST, "CODE,...", 0, 0, NULL,
		"print the meaning, the remedy and the smallest example of codes and exit", FIELD(explain), false},

	{.kind = NT_OPTION_HEADING, .name = "Limits"},
	{"max-triangles", 0, NT_OPTION_SIZE, "N", 0, 0, "none",
		"refuse an input that has more triangles; a triangle counts once for each primitive that has it",
		SETTING(max_triangles), false},
	{"max-pixels", 0, NT_OPTION_SIZE, "N", 0, 0, "16G, or 256 for each byte of the images",
		"refuse an input if it makes nmtan decode and make images of more pixels",
		SETTING(max_pixels), false},
	{"max-memory", 0, NT_OPTION_SIZE, "SIZE", 0, 0, "none",
		"use at most SIZE of memory, not counting mapped files", SETTING(max_memory), false},
	{"max-seconds", 0, NT_OPTION_TEXT, "N", 0, 0, "none",
		"stop an input that takes longer than N seconds, as 30 or 0.5", FIELD(max_seconds), false},

	{.kind = NT_OPTION_HEADING, .name = "Run"},
	{"threads", 'j', NT_OPTION_NUMBER, "N", 0, 1024, "0",
		"how many threads to use; 0: one for each processor", SETTING(io.threads), false},
	{"quiet", 'q', NT_OPTION_SET, NULL, -1, 0, NULL,
		"print only errors, findings that fail the run, what an output lacks of its input, and that it keeps "
		"wrong tangents",
		FIELD(verbosity), false},
	{"verbose", 'v', NT_OPTION_SET, NULL, 1, 0, NULL,
		"print every finding, and a line for each mesh", FIELD(verbosity), false},
	{"progress", 0, NT_OPTION_CHOICE, "auto|on|off", NT_PROGRESS_AUTO, 0, "auto",
		"show progress; auto: on a terminal, after one second", FIELD(progress), false},
	{"manifest", 0, NT_OPTION_TEXT, "FILE", 0, 0, NULL,
		"write a JSON line to FILE when an input ends; - is standard output", FIELD(manifest), false},
	{"timing", 0, NT_OPTION_FLAG, NULL, 0, 0, NULL,
		"print how long each stage took", FIELD(timing), false},
	{"version", 0, NT_OPTION_SET, NULL, NT_ACTION_VERSION, 0, NULL,
		"print the version and exit; with -v: the libraries too", FIELD(action), false},
	{"help", 'h', NT_OPTION_SET, NULL, NT_ACTION_HELP, 0, NULL,
		"print all options and exit; -h: print one screen", FIELD(action), false},
	/* Hidden: for the Makefile. */
	{"completion", 0, NT_OPTION_CHOICE, "bash|zsh", NT_ACTION_COMPLETION_BASH, 0, NULL, NULL,
		FIELD(action), false},
};
const size_t nt_option_row_count = sizeof nt_option_rows / sizeof *nt_option_rows;
_Static_assert(sizeof nt_option_rows / sizeof *nt_option_rows <= NT_MOST_OPTIONS, "more rows than foreseen");
