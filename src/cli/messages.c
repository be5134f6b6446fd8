/* SPDX-License-Identifier: MIT */
/*
 * Messages: see messages.h.
 */
#include "cli/messages.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/structs.h"
#include "file/input.h"
#include "report/report.h"

/* So many places of one code are shown without -v; the rest is counted. */
enum { PLACES_SHOWN = 5 };

static const double DEGREES = 57.29577951308232; /* of a radian */

static const char *colour(nt_style style, const char *code)
{
	return style.colour ? code : "";
}

/* "1 primitive", "2 primitives". */
static void append_count(nt_buffer *out, size_t count, const char *noun)
{
	nt_buffer_format(out, "%zu%s%s%s", count, *noun ? " " : "", noun, *noun && count != 1 ? "s" : "");
}

void nt_message_phrases(nt_buffer *out, const nt_phrase *phrases, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		const nt_phrase *p = &phrases[i];
		if (!p->count)
			continue;
		nt_buffer_text(out, p->before);
		if (p->noun)
			append_count(out, p->count, p->noun);
		nt_buffer_text(out, p->after);
	}
}

/* "file:line: ", "file: at byte N: ", "file: /pointer: ", then "mesh "head": ". */
static void append_place(nt_buffer *out, const nt_place_view *place, const char *file)
{
	const char *name = place->file[0] ? place->file : file;
	if (name && *name) {
		nt_buffer_clean(out, strcmp(name, "-") == 0 ? "standard input" : name);
		if (place->line)
			nt_buffer_format(out, ":%zu", place->line);
		nt_buffer_text(out, ": ");
	}
	if (place->offset != NT_NO_OFFSET)
		nt_buffer_format(out, "at byte %" PRIu64 ": ", place->offset);
	if (place->pointer[0]) {
		nt_buffer_clean(out, place->pointer);
		nt_buffer_text(out, ": ");
	}
	if (place->object[0]) {
		nt_buffer_clean(out, place->object);
		nt_buffer_text(out, ": ");
	}
}

void nt_message_error(nt_buffer *out, const nt_error *error, nt_style style)
{
	nt_buffer_format(out, "%snmtan:%s ", colour(style, "\033[1;31m"), colour(style, "\033[0m"));
	const nt_place_view place = nt_view_place(&error->place);
	append_place(out, &place, NULL);
	nt_buffer_clean(out, error->message[0] ? error->message : nt_status_text(error->status));
	nt_buffer_text(out, "\n");
}

static void append_sentence(nt_buffer *out, const nt_place_view *place, const char *file, nt_code code,
	nt_severity severity, const char *sentence, size_t more, const char *command, nt_style style)
{
	static const char *const colours[] = {
		[NT_SEVERITY_INFO] = "\033[36m", [NT_SEVERITY_WARNING] = "\033[1;33m",
		[NT_SEVERITY_ERROR] = "\033[1;31m"};
	nt_buffer_text(out, "nmtan: ");
	append_place(out, place, file);
	nt_buffer_format(out, "%s%s:%s ", colour(style, colours[severity]), nt_severity_name(severity),
		colour(style, "\033[0m"));
	nt_buffer_clean(out, sentence);
	if (more)
		nt_buffer_format(out, " (more at %zu other place%s)", more, more == 1 ? "" : "s");
	nt_buffer_format(out, " [%s]%s\n", nt_code_info(code)->name, command ? command : "");
}

/* How many findings of one code are printed; a quiet run says in that line how many there are more. */
static size_t places_shown(nt_style style)
{
	return style.verbosity < 0 ? 1 : style.verbosity ? SIZE_MAX : PLACES_SHOWN;
}

/* The rest, but for a quiet run. */
static void append_more(nt_buffer *out, nt_code code, nt_severity severity, size_t left_out, nt_style style)
{
	if (left_out && style.verbosity >= 0)
		nt_buffer_format(out, "nmtan: %s: and %zu more [%s]; -v shows all\n", nt_severity_name(severity),
			left_out, nt_code_info(code)->name);
}

/* As the user says (options, NULL: does not). A run that succeeds has met no error. */
static nt_severity shown_severity(const nt_finding *finding, const nt_report_options *options, nt_style style)
{
	const uint8_t said = options ? options->severity[finding->code] : 0;
	const nt_severity severity = said ? (nt_severity)(said - 1) : nt_finding_severity(finding);
	return style.fails || severity < NT_SEVERITY_ERROR ? severity : NT_SEVERITY_WARNING;
}

/* Infos that are printed without -v: the file does not say what was to be done, and nmtan chose; or the output has no
 * room for what it says. */
static bool is_chosen(nt_code code)
{
	static const nt_code codes[] = {NT_CODE_NMAP_BESIDE, NT_CODE_TAN_QUADS_LIKELY, NT_CODE_POS_ORIGIN,
		NT_CODE_NORMALS_MADE, NT_CODE_BUMP_AS_NORMAL, NT_CODE_MATERIAL_FIRST, NT_CODE_POLYGON_CUT,
		NT_CODE_POLYGONS_DROPPED, NT_CODE_DRACO_SEQUENTIAL};
	bool chosen = false;
	for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
		chosen |= codes[i] == code;
	return chosen;
}

/* However they are spelled. */
static bool are_one_file(const char *a, const char *b)
{
	struct stat one, other;
	return strcmp(a, b) == 0 || (strcmp(a, "-") != 0 && strcmp(b, "-") != 0 && stat(a, &one) == 0 &&
		stat(b, &other) == 0 && nt_same_file(&one, &other));
}

/* ": nmtan --fix a.glb b.glb", and before it when that is right. */
static void append_command(nt_buffer *out, nt_code code, const char *repair, const nt_report_options *options,
	const char *file, const char *output)
{
	const char *condition = nt_code_condition(code);
	const bool same = output && are_one_file(file, output), in_place = same && options->in_place;
	nt_buffer all = {0};
	nt_buffer_format(&all, "%s%s", repair, in_place ? " --in-place" : "");
	nt_buffer_format(out, condition ? "; %s: " : ": ", condition);
	nt_command_text(all.data ? all.data : "", options->given, file, in_place ? "" : same ? NULL : output, out);
	nt_buffer_free_into(&all, out);
}

/* Whether finding i is one of a code and severity, and not an old one. */
static bool is_shown(const nt_finding_list *findings, size_t i, const bool *old, const nt_report_options *options,
	nt_code code, nt_severity severity, nt_style style)
{
	const nt_finding *finding = &findings->items[i];
	return finding->code == code && shown_severity(finding, options, style) == severity && !(old && old[i]);
}

/* All findings of one code and severity but for `old` ones (NULL: there are none), those beyond places_shown() as a
 * number. The first has the command. */
static void append_code(nt_buffer *out, const nt_finding_list *findings, const bool *old,
	const nt_report_options *options, nt_code code, nt_severity severity, const char *file, const char *output,
	nt_style style)
{
	size_t count = 0, shown = 0;
	for (size_t i = 0; i < findings->count; i++)
		count += is_shown(findings, i, old, options, code, severity, style);
	for (size_t i = 0; i < findings->count && shown < count && shown < places_shown(style); i++) {
		const nt_finding *finding = &findings->items[i];
		if (!is_shown(findings, i, old, options, code, severity, style))
			continue;
		nt_buffer sentence = {0}, command = {0};
		nt_code_sentence(code, finding->count, finding->detail, &sentence);
		const char *repair = finding->repair ? finding->repair : nt_code_info(code)->repair;
		if (!shown && repair && !finding->stays && (severity > NT_SEVERITY_INFO || is_chosen(code)))
			append_command(&command, code, repair, options, file, output);
		append_sentence(out, &finding->place, file, code, severity, sentence.data ? sentence.data : "",
			style.verbosity < 0 ? count - 1 : 0, command.data, style);
		nt_buffer_free_into(&sentence, out);
		nt_buffer_free_into(&command, out);
		shown++;
	}
	append_more(out, code, severity, count - shown, style);
}

/* Which findings a report knows from its baseline: those that it has as they are, and those of codes of which a check
 * finds the places, if all are known. */
static void find_known(const nt_finding_list *findings, const nt_report *report, bool *old)
{
	bool has_known[NT_CODE_COUNT] = {false}, has_new[NT_CODE_COUNT] = {false};
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->noted != NT_NONE)
			old[f->noted] = f->known;
		else
			*(f->known ? &has_known[f->code] : &has_new[f->code]) = true;
	}
	for (size_t i = 0; i < findings->count; i++)
		old[i] |= has_known[findings->items[i].code] && !has_new[findings->items[i].code];
}

void nt_message_findings(nt_buffer *out, const nt_finding_list *findings, const nt_report *report,
	const nt_report_options *options, const char *file, const char *output,
	nt_shown_infos infos, int most, nt_style style)
{
	const bool judged = report && !report->failure && findings->count;
	bool *old = judged ? nt_calloc(findings->count, sizeof *old) : NULL;
	if (judged && !old) {
		out->failed = true;
		return;
	}
	if (old && options->baseline)
		find_known(findings, report, old);
	/* nt_message_checked() has them with their places */
	for (size_t i = 0; old && i < findings->count; i++)
		old[i] |= nt_is_found_again(&findings->items[i]) &&
			shown_severity(&findings->items[i], options, style) > NT_SEVERITY_INFO;
	for (int severity = most; severity >= (int)options->min_severity; severity--)
		for (int code = 0; code < NT_CODE_COUNT; code++)
			if ((severity || infos == NT_INFOS_ALL || (infos && is_chosen((nt_code)code))) &&
				!options->ignore[code])
				append_code(out, findings, old, options, (nt_code)code, (nt_severity)severity, file,
					output, style);
	free(old);
}

bool nt_message_has(const nt_finding_list *findings, const nt_report_options *options, nt_code code, nt_style style)
{
	bool has = false;
	for (size_t i = 0; i < findings->count && !options->ignore[code]; i++) {
		const nt_finding *finding = &findings->items[i];
		const nt_severity severity = shown_severity(finding, options, style);
		has |= finding->code == code && severity > NT_SEVERITY_INFO && severity >= options->min_severity;
	}
	return has;
}

/* A finding of a report, with its command if that was not told before. */
static void append_found(nt_buffer *out, const nt_report_finding *f, nt_severity severity, size_t more, bool *told,
	const nt_report_options *options, const char *file, const char *output, nt_style style)
{
	nt_buffer command = {0};
	if (f->repair && !told[f->code])
		append_command(&command, f->code, f->repair, options, file, output);
	told[f->code] = true;
	append_sentence(out, &f->place, file, f->code, severity, f->message, more, command.data, style);
	nt_buffer_free_into(&command, out);
}

/* Whether a finding of a report gets a line. A quiet run has those of kept tangents alone. */
static bool is_told(const nt_report_finding *f, int most, bool quiet)
{
	return f->severity > NT_SEVERITY_INFO && (int)f->severity <= most &&
		(quiet ? f->mesh != NT_NONE && nt_code_is_of_kept(f->code) : f->noted == NT_NONE);
}

void nt_message_checked(nt_buffer *out, const nt_finding_list *findings, const nt_report *report,
	const nt_report_options *options, const char *file, const char *output, int most, nt_style style)
{
	const bool quiet = style.verbosity < 0;
	bool told[NT_CODE_COUNT] = {false};
	size_t found[NT_CODE_COUNT] = {0}, shown[NT_CODE_COUNT] = {0};
	size_t left_out[NT_CODE_COUNT][NT_SEVERITY_ERROR + 1] = {{0}};
	for (int code = 0; quiet && !report && code < NT_CODE_COUNT; code++)
		if (nt_code_is_of_kept((nt_code)code) && !options->ignore[code])
			append_code(out, findings, NULL, options, (nt_code)code, NT_SEVERITY_WARNING, file, output,
				style);
	for (size_t i = 0; report && i < report->new_count; i++)
		found[report->findings[i].code] += is_told(&report->findings[i], most, quiet);
	for (size_t i = 0; report && i < report->new_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (!is_told(f, most, quiet))
			continue;
		const nt_severity severity = style.fails ? f->severity : NT_SEVERITY_WARNING;
		if (shown[f->code]++ < places_shown(style))
			append_found(out, f, severity, quiet ? found[f->code] - 1 : 0, told, options, file, output,
				style);
		else
			left_out[f->code][severity]++;
	}
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_WARNING; severity--)
		for (int code = 0; code < NT_CODE_COUNT; code++)
			append_more(out, (nt_code)code, (nt_severity)severity, left_out[code][severity], style);
}

/* Materials that have lost all of their images. */
static void append_bare(nt_buffer *out, const char *before, const nt_summary *s)
{
	if (!s->bare_materials)
		return;
	if (!s->bare_material[0] && s->bare_materials == 1) {
		nt_buffer_format(out, "%sthe material has none of its images", before);
		return;
	}
	nt_buffer_format(out, "%smaterial \"", before);
	nt_buffer_clean(out, s->bare_material);
	if (s->bare_materials == 1)
		nt_buffer_text(out, "\" has none of its images");
	else
		nt_buffer_format(out, "\" and %zu more have none of their images", s->bare_materials - 1);
}

void nt_message_left_out(nt_buffer *out, const nt_job *job, const bool *ignore)
{
	static const nt_code codes[] = {NT_CODE_MTL_MISSING, NT_CODE_MATERIAL_UNKNOWN, NT_CODE_IMAGE_MISSING,
		NT_CODE_IMAGE_TYPE, NT_CODE_IMAGE_DAMAGED, NT_CODE_MATERIAL_LOST, NT_CODE_REFERENCE_LOST};
	const nt_finding_list *findings = &job->outcome->summary.findings;
	size_t told = 0;
	for (size_t c = 0; c < sizeof codes / sizeof *codes; c++) {
		size_t count = 0;
		for (size_t i = 0; i < findings->count; i++)
			count += findings->items[i].code == codes[c] ? findings->items[i].count : 0;
		if (!count || ignore[codes[c]])
			continue;
		nt_buffer_text(out, told ? ", " : "nmtan: ");
		if (!told++) {
			nt_buffer_clean(out, job->input);
			nt_buffer_text(out, ": missing from the output: ");
		}
		nt_buffer_format(out, "%zu %s", count, nt_code_info(codes[c])->name);
	}
	if (told)
		append_bare(out, "; ", &job->outcome->summary);
	nt_buffer_text(out, told ? "\n" : "");
}

void nt_message_failure(nt_buffer *out, const nt_report *report, const nt_report_options *options, const char *file,
	const char *output, const bool *known, int least_failure, nt_style style)
{
	bool told[NT_CODE_COUNT] = {false};
	size_t shown = 0, more = 0;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *found = &report->findings[i];
		if ((known ? known[i] : found->known) || (int)found->severity < least_failure)
			continue;
		if (shown++ < PLACES_SHOWN || style.verbosity > 0)
			append_found(out, found, found->severity, 0, told, options, file, output, style);
		else
			more++;
	}
	if (more)
		nt_buffer_format(out, "nmtan: and %zu more findings that fail; --report shows all\n", more);
}

/* "0.1 ms" at least, "12.3 ms", "1.23 s": three digits of what takes longer. */
static void append_seconds(nt_buffer *out, double seconds)
{
	const bool short_time = seconds < 0.9995;
	const double shown = seconds < 1e-4 ? 0.1 : short_time ? seconds * 1e3 : seconds;
	const int digits = shown < 9.995 && !short_time ? 2 : shown < 99.95 ? 1 : 0;
	nt_buffer_format(out, ", %.*f %s", digits, shown, short_time ? "ms" : "s");
}

static void append_vertices(nt_buffer *out, const nt_summary *s)
{
	const size_t split = s->appended_normals + s->appended_tangents, added = split + s->made.copies;
	const nt_phrase phrases[] = {
		{added, " -> ", NULL, ""},
		{added ? s->vertex_count + added : 0, "", "", ""},
		{1, " vertices", NULL, ""},
		{s->appended_tangents, " (+", "", " where tangents differ"},
		{s->appended_normals, s->appended_tangents ? ", +" : " (+", "", " where made normals differ"},
		{s->made.copies, split ? ", +" : " (+", "", " where primitives meet"},
		{added, ")", NULL, ""}};
	nt_buffer_format(out, ", %zu", s->vertex_count);
	nt_message_phrases(out, phrases, sizeof phrases / sizeof *phrases);
}

/* Options that came to nothing, and others with which they would not. */
static void append_unused(nt_buffer *out, const nt_summary *s, const nt_settings *settings)
{
	static const char *const makes[] = {
		[NT_NORMALS_FLAT] = "flat", [NT_NORMALS_SMOOTH] = "smooth", [NT_NORMALS_ANGLE] = "angle"};
	const nt_normals normals = settings->normals;
	if (normals != NT_NORMALS_AUTO && normals < NT_NORMALS_REPLACE_FLAT && s->kept_normals && !s->made_normals) {
		nt_buffer_format(out, ", all have normals: --normals=replace-%s", makes[normals]);
		if (normals == NT_NORMALS_ANGLE)
			nt_buffer_format(out, ":%d", settings->normals_degrees);
		nt_buffer_text(out, " makes new ones");
	}
	const bool no_maps = nt_format_is_gltf(s->input_format) && !s->made_maps;
	const nt_phrase phrases[] = {
		{settings->existing == NT_EXISTING_REPLACE ? s->skipped[NT_SKIP_NO_SLOT] : 0,
			", --only=all makes new tangents for all", NULL, ""},
		{settings->existing == NT_EXISTING_DROP ? s->skipped[NT_SKIP_HAS_TANGENTS] : 0,
			", a material uses the tangents of ", "primitive", ", which stay"},
		{s->without_normals, ", ", "primitive", normals == NT_NORMALS_AUTO
			? " without normals (--normals=smooth makes them)" : " still without normals"},
		{s->shaded_count, ", made the normals of ", "primitive", " without tangents"},
		{s->shaded_copies, " (+", "", " vertices where they differ)"},
		{settings->bump == NT_BUMP_HEIGHT && no_maps, ", nothing that --bump=height converts", NULL, ""},
		{settings->flip_green == NT_FLIP_ON && no_maps, ", nothing that --flip-green turns", NULL, ""},
		{settings->io.draco > NT_DRACO_OFF && !s->solved_count,
			", nothing compressed, as no primitive got tangents: --existing=replace --only=all", NULL, ""}};
	nt_message_phrases(out, phrases, sizeof phrases / sizeof *phrases);
}

static void append_skipped(nt_buffer *out, const nt_summary *s)
{
	const size_t *skipped = s->made.count ? s->made.skipped : s->skipped;
	bool first = true;
	for (int reason = 0; reason < NT_DECISION_COUNT; reason++) {
		if (!skipped[reason])
			continue;
		nt_buffer_text(out, first ? ", skipped " : ", ");
		append_count(out, skipped[reason], "primitive");
		nt_buffer_format(out, " (%s)", nt_decision_text((nt_decision)reason));
		first = false;
	}
}

static void append_findings_count(nt_buffer *out, const nt_summary *s)
{
	size_t counts[3] = {0};
	if (s->report)
		memcpy(counts, s->report->by_severity, sizeof counts);
	size_t known = 0, hidden = 0;
	for (int severity = 0; s->report && severity < 3; severity++) {
		known += s->report->known[severity];
		hidden += s->report->hidden[severity];
	}
	if (!counts[0] && !counts[1] && !counts[2] && (known || !hidden))
		nt_buffer_format(out, known ? ", nothing new, %zu known" : ", no findings", known);
	const nt_phrase phrases[] = {
		{counts[NT_SEVERITY_ERROR], ", ", "error", ""},
		{counts[NT_SEVERITY_WARNING], ", ", "warning", ""},
		{counts[NT_SEVERITY_INFO], ", ", "info", ""},
		{hidden, ", ", "finding", " below --min-severity"}};
	nt_message_phrases(out, phrases, sizeof phrases / sizeof *phrases);
}

/* Repairs of --fix, by the codes of the findings, and what it leaves to other options. */
static void append_fixed(nt_buffer *out, const nt_summary *s, const nt_settings *settings)
{
	bool first = true;
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		if (!s->fixed[code])
			continue;
		nt_buffer_format(out, "%s%s in ", first ? ", fixed " : ", ", nt_code_info((nt_code)code)->name);
		append_count(out, s->fixed[code], code == NT_CODE_NMAP_GREEN_DOWN ? "normal map" : "primitive");
		first = false;
	}
	if (!settings->fix)
		return;
	if (first)
		nt_buffer_text(out, ", the input has nothing that --fix repairs");
	for (unsigned code = 0; code < NT_CODE_COUNT; code++)
		if (s->unfixed[code])
			nt_buffer_format(out, ", left %s (%s repairs it)", nt_code_info((nt_code)code)->name,
				nt_code_info((nt_code)code)->repair);
}

/* "nmtan: a.obj -> b.glb" */
static void append_job(nt_buffer *out, const nt_job *job)
{
	nt_buffer_text(out, "nmtan: ");
	nt_buffer_clean(out, strcmp(job->input, "-") == 0 ? "standard input" : job->input);
	if (job->output) {
		nt_buffer_text(out, " -> ");
		nt_buffer_clean(out, strcmp(job->output, "-") == 0 ? "standard output" : job->output);
	}
}

void nt_message_current(nt_buffer *out, const nt_job *job)
{
	append_job(out, job);
	nt_buffer_format(out, ": up to date%s\n",
		job->outcome->summary.keeps_wrong ? ", keeps wrong tangents" : "");
}

/* Options of tangents that are computed, in a glTF that has them all. */
static void append_idle(nt_buffer *out, const nt_job *job, const nt_settings *settings)
{
	const nt_summary *s = &job->outcome->summary;
	const struct {
		bool given;
		const char *name;
	} options[] = {{settings->method != NMTAN_METHOD_MIKKTSPACE, "--method"},
		{settings->repair == NMTAN_REPAIR_OFF, "--raw"},
		{settings->io.across == NT_ACROSS_MESH, "--across=mesh"},
		{settings->quads == NT_QUADS_PAIRS, "--quads=pairs"},
		{settings->io.precision != NT_PRECISION_AUTO, "--precision"},
		{settings->io.bitangents, "--bitangents"}};
	size_t count = 0;
	if (!s->unchanged || settings->check || settings->fix || settings->existing != NT_EXISTING_KEEP ||
		!s->mesh_count || s->skipped[NT_SKIP_HAS_TANGENTS] != s->mesh_count ||
		!nt_format_is_gltf(s->input_format))
		return;
	for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
		if (!options[i].given)
			continue;
		if (!count) {
			nt_buffer_text(out, "nmtan: ");
			nt_buffer_clean(out, strcmp(job->input, "-") == 0 ? "standard input" : job->input);
		}
		nt_buffer_format(out, "%s%s", count++ ? ", " : ": ", options[i].name);
	}
	if (count)
		nt_buffer_format(out, " %s nothing: the primitives have tangents; --existing=replace makes them new\n",
			count == 1 ? "changes" : "change");
}

void nt_message_success(nt_buffer *out, const nt_job *job, const nt_settings *settings)
{
	const nt_summary *s = &job->outcome->summary;
	append_job(out, job);
	const bool check = settings->check;
	const nt_phrase begin[] = {
		{1, ": ", NULL, check ? "checked, " : settings->dry_run ? "dry run, nothing written, " : ""},
		{s->left, "left as it is, ", NULL, ""}};
	nt_message_phrases(out, begin, sizeof begin / sizeof *begin);
	const bool made = s->made.count && !check;
	const size_t all = made ? s->made.count : s->mesh_count, solved = made ? s->made.solved : s->solved_count;
	if (check && !nt_format_is_gltf(s->input_format)) /* materials make one or several primitives of a mesh */
		nt_buffer_format(out, "%zu %s", all, all == 1 ? "mesh" : "meshes");
	else if (check || solved == all)
		append_count(out, all, "primitive");
	else
		nt_buffer_format(out, "%zu of %zu primitives", solved, all);
	const bool solves = s->solved_count && !check;
	const size_t quads = solves ? s->quad_count : 0;
	const nt_phrase counts[] = {
		{s->same_count, " (", "", " the same as others)"},
		{solves ? s->triangle_count : 0, ", ", "triangle", ""},
		{quads, " (as ", "quad", ""},
		{quads && s->triangle_count > 2 * quads ? s->triangle_count - 2 * quads : 0, " and ", "triangle", ""},
		{quads, ")", NULL, ""}};
	nt_message_phrases(out, counts, sizeof counts / sizeof *counts);
	if (solves)
		append_vertices(out, s);
	if (s->welded.before > s->welded.after)
		nt_buffer_format(out, ", welded %zu vertices to %zu", s->welded.before, s->welded.after);
	else if (settings->io.weld)
		nt_buffer_text(out, s->welded.before ? ", no vertices are equal" : nt_format_is_gltf(s->input_format)
			? ", nothing that --weld welds" : ", --weld welds glTF made from glTF");
	if (s->packed.before)
		nt_buffer_format(out, ", Draco makes %zu vertices of %zu", s->packed.after, s->packed.before);
	const nt_phrase repaired[] = {
		{s->packed.dropped, ", Draco leaves out ", "triangle", " without area in its grid"},
		{s->repaired, check ? ", would repair the tangents of " : ", repaired the tangents of ", "corner", ""}};
	nt_message_phrases(out, repaired, sizeof repaired / sizeof *repaired);
	append_fixed(out, s, settings);
	/* append_fixed() has those whose green --fix turned */
	const size_t turned = settings->fix ? s->fixed[NT_CODE_NMAP_GREEN_DOWN] : 0;
	const bool converts = s->made_maps > turned && (!settings->fix || settings->bump == NT_BUMP_HEIGHT);
	const nt_phrase ways[] = {
		{converts ? s->made_maps - turned : 0, check ? ", would convert " : ", converted ", "normal map", ""},
		{s->counts.summed_instead, ", ", "corner", " of hubs with one sum"},
		{s->counts.sorted_instead, ", ", "", " solved as mikktspace-sorted"}};
	nt_message_phrases(out, ways, sizeof ways / sizeof *ways);
	if (s->rounding.count && s->rounding.worst_radians > 0)
		nt_buffer_format(out, ", rounded tangents by %.2g degrees at most, %.2g on average",
			s->rounding.worst_radians * DEGREES,
			s->rounding.sum_radians / (double)s->rounding.count * DEGREES);
	if (s->morph_cost.bytes > s->morph_cost.mesh_bytes) {
		nt_buffer_text(out, ", tangents of ");
		append_count(out, s->morph_cost.targets, "morph target");
		nt_buffer_format(out, " take %.3g MB, their meshes %.3g", (double)s->morph_cost.bytes * 1e-6,
			(double)s->morph_cost.mesh_bytes * 1e-6);
	}
	if (check)
		append_findings_count(out, s);
	else
		append_skipped(out, s);
	if (!check)
		append_unused(out, s, settings);
	append_bare(out, ", ", s);
	append_seconds(out, s->total_seconds);
	if (s->note && !check && !settings->dry_run)
		nt_buffer_clean(out, s->note);
	nt_buffer_text(out, "\n");
	append_idle(out, job, settings);
}

void nt_message_meshes(nt_buffer *out, const nt_job *job)
{
	const nt_summary *s = &job->outcome->summary;
	for (size_t i = 0; i < s->line_count; i++) {
		const nt_mesh_line *line = &s->lines[i];
		const bool solved = line->decision > NT_DECISION_OPEN && line->decision <= NT_DECISION_NORMALS;
		nt_buffer_text(out, "nmtan: ");
		const nt_place_view place = nt_view_place(&line->place);
		append_place(out, &place, job->input);
		nt_buffer_format(out, "%s%s%s%s", solved ? "" : "skipped (", nt_decision_text(line->decision),
			solved ? "" : ")", line->same ? " (the same as an earlier one's)" : "");
		if (line->decision == NT_SKIP_NOT_TRIANGLES) {
			nt_buffer_text(out, "\n");
			continue;
		}
		nt_buffer_text(out, ", ");
		append_count(out, line->triangle_count, "triangle");
		if (solved)
			nt_buffer_format(out, ", %zu", line->vertex_count);
		if (solved && line->appended)
			nt_buffer_format(out, " -> %zu", line->vertex_count + line->appended);
		nt_buffer_text(out, solved ? " vertices\n" : "\n");
	}
}

void nt_message_timing(nt_buffer *out, const nt_summary *summary)
{
	double known = 0;
	nt_buffer_text(out, "stage           ms\n");
	for (int stage = 0; stage < NT_STAGE_COUNT; stage++) {
		known += summary->seconds[stage];
		nt_buffer_format(out, "%-9s %8.3f\n", nt_stage_name((nt_stage)stage),
			summary->seconds[stage] * 1e3);
	}
	const double rest = summary->total_seconds - known;
	nt_buffer_format(out, "%-9s %8.3f\n%-9s %8.3f\n", "other", (rest > 0 ? rest : 0) * 1e3, "total",
		summary->total_seconds * 1e3);
	nt_buffer_format(out, "%" PRIu64 " bytes read, ", summary->bytes_read);
	if (summary->bytes_copied)
		nt_buffer_format(out, "%" PRIu64 " copied as they are, ", summary->bytes_copied);
	nt_buffer_format(out, "%" PRIu64 " bytes written\n", summary->bytes_written);
	const nt_phrase same = {summary->same_count, "not solved again: ", "primitive",
		" (the same geometry as another)\n"};
	nt_message_phrases(out, &same, 1);
	for (int reason = 0; reason < NT_DECISION_COUNT; reason++) {
		const nt_phrase skipped[] = {
			{summary->skipped[reason], "not decoded: ", "primitive", " ("},
			{summary->skipped[reason], nt_decision_text((nt_decision)reason), NULL, ")\n"}};
		nt_message_phrases(out, skipped, sizeof skipped / sizeof *skipped);
	}
}
