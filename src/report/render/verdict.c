/* SPDX-License-Identifier: MIT */
/*
 * The verdict of a report, in one sentence.
 *
 * Errors count before warnings. Order of actions: export again comes first, since all else is made from it, then bake
 * again, then repairs of a conversion.
 */
#include <string.h>
#include "report/render/inside.h"

static nt_advice advice_of(const nt_report_finding *finding)
{
	const nt_advice advice = nt_code_info(finding->code)->advice;
	return advice == NT_ADVICE_CONVERT && !finding->repair ? NT_ADVICE_EXPORT : advice;
}

/* The finding that has to be seen to first, of the new ones of the worst severity; NULL: there are infos alone, or none
 * was kept. */
static const nt_report_finding *find_first(const nt_report *report)
{
	const nt_severity severity = report->by_severity[NT_SEVERITY_ERROR] ? NT_SEVERITY_ERROR : NT_SEVERITY_WARNING;
	const nt_report_finding *first = NULL;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->known || f->severity != severity)
			continue;
		if (!first || advice_of(f) > advice_of(first))
			first = f;
	}
	return first;
}

/* "Nothing new: 1 known error, 2 known warnings"; nothing where there are none. */
static void append_counts(const char *before, const size_t counts[3], const char *which, nt_buffer *out)
{
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_WARNING; severity--) {
		if (!counts[severity])
			continue;
		nt_buffer_format(out, "%s%zu %s%s%s", before, counts[severity], which,
			nt_severity_name((nt_severity)severity), counts[severity] == 1 ? "" : "s");
		before = ", ";
	}
}

/* There is no new error or warning. */
static void append_nothing_new(const nt_report *report, nt_buffer *out)
{
	const size_t before = out->size;
	bool judged = false;
	for (size_t i = 0; i < report->mesh_count; i++)
		judged |= report->meshes[i].analysed;
	append_counts("Nothing new: ", report->known, "known ", out);
	append_counts(out->size > before ? "; not shown: " : "Not shown by --min-severity: ", report->hidden, "", out);
	if (out->size == before)
		nt_buffer_text(out, judged ? "Ready to use" : "Nothing to judge: there are no triangles");
}

/* ---- several commands ---- */

/* The commands that are joined. */
typedef struct chosen {
	nt_severity least;
	bool conditions; /* those that are right under a condition alone, too */
} chosen;

/* Whether a finding's command is one of several that the user may want together: not if it names a file, of which there
 * may be a choice, and not that of the pair, which is right as it is. */
static bool joins_in(const nt_report_finding *f, chosen which)
{
	return f->repair && f->severity >= which.least && strncmp(f->repair, "--normal-map", 12) != 0 &&
	       f->code != NT_CODE_TAN_GREEN_PAIR && (which.conditions || !nt_code_condition(f->code));
}

/* Adds those of the options that are not there yet, but for a repair if `replaces`. */
static void add_options(const char *options, bool replaces, nt_buffer *all)
{
	static const char repairs[] = "--existing=repair";
	for (size_t length; *options; options += length + (options[length] == ' ')) {
		length = strcspn(options, " ");
		const char *found = all->data ? strstr(all->data, options) : NULL;
		if (replaces && length == sizeof repairs - 1 && strncmp(options, repairs, length) == 0)
			continue;
		if (!found || (found[length] != ' ' && found[length] != '\0'))
			nt_buffer_format(all, "%s%.*s", all->size ? " " : "", (int)length, options);
	}
}

/* The options of the command that does what the commands of all new findings do, from a severity on. False: they have
 * one, or no command does all. */
static bool join_options(const nt_report *report, chosen which, nt_buffer *all)
{
	const char *first = NULL;
	bool differ = false, fixes = false, turns = false, drops = false, repairs = false, replaces = false;
	for (size_t i = 0; i < report->new_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (!joins_in(f, which))
			continue;
		const bool is_fix = strcmp(f->repair, "--fix") == 0;
		first = first ? first : f->repair;
		differ |= strcmp(f->repair, first) != 0;
		drops |= strstr(f->repair, "=drop") != NULL;
		repairs |= strstr(f->repair, "--existing=re") != NULL;
		replaces |= strstr(f->repair, "--existing=replace") != NULL;
		fixes |= is_fix;
		turns |= is_fix && f->code == NT_CODE_NMAP_GREEN_DOWN;
	}
	if (!differ || (drops && (fixes || repairs)))
		return false;
	/* --fix and --existing exclude each other; what repairs all tangents leaves none that --fix would choose */
	for (size_t i = 0; i < report->new_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (joins_in(f, which) && !(repairs && strcmp(f->repair, "--fix") == 0))
			add_options(f->repair, replaces, all);
	}
	if (turns && repairs)
		add_options("--flip-green=auto", false, all);
	return true;
}

/* ---- the verdict ---- */

/* The options of the command that the verdict names, which repairs the first finding and what else is no info; *count
 * (NULL: is not asked): how many new errors and warnings that are, dropped ones too. False: it names none. */
static bool find_options(const nt_report *report, const nt_report_finding *first, nt_buffer *options, size_t *count)
{
	bool counted[NT_CODE_COUNT] = {false};
	if (!first || !first->repair)
		return false;
	const chosen which = {NT_SEVERITY_WARNING, nt_code_condition(first->code) != NULL};
	const bool joined = joins_in(first, which) && join_options(report, which, options);
	if (!joined)
		nt_buffer_text(options, first->repair);
	for (size_t i = 0; count && i < report->new_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->severity < which.least || !f->repair ||
			!(joined ? joins_in(f, which) : strcmp(f->repair, first->repair) == 0))
			continue;
		*count += 1 + (counted[f->code] ? 0 : report->dropped_by_code[f->code]);
		counted[f->code] = true;
	}
	return true;
}

static void append_verdict(const nt_report *report, nt_buffer *out)
{
	static const char *const verbs[] = {"Look at this", "Convert with nmtan", "Bake again",
		"A file is missing", "Export again"};
	const size_t errors = report->by_severity[NT_SEVERITY_ERROR];
	const size_t all = errors + report->by_severity[NT_SEVERITY_WARNING];
	if (report->failure) {
		nt_put(out, NT_PLAIN, "Not judged: %p", nt_failure_text(report, true));
		return;
	}
	if (report->conversion)
		nt_buffer_format(out, "After conversion%s%s: ", *report->conversion ? " with " : "",
			report->conversion);
	if (!all) {
		append_nothing_new(report, out);
		return;
	}
	nt_buffer options = {0};
	const nt_report_finding *first = find_first(report);
	size_t repaired = 0;
	const bool names = find_options(report, first, &options, &repaired);
	const size_t more = (names && repaired < all ? repaired : all) - 1;
	const char *verb = verbs[first ? advice_of(first) : 0];
	nt_buffer_format(out, "%s: %s", report->conversion && verb == verbs[1] ? "Repair with nmtan" : verb,
		first ? first->message : "findings that are not shown");
	if (more)
		nt_buffer_format(out, "; and %zu more", more);
	if (names) {
		const char *condition = nt_code_condition(first->code);
		nt_buffer_format(out, condition ? "; %s: " : ": ", condition);
		nt_command_text(options.data ? options.data : "", report->given, report->path, NULL, out);
	}
	nt_buffer_free_into(&options, out);
}

void nt_put_together(const nt_report *report, const char *before, nt_syntax syntax, nt_buffer *out)
{
	nt_buffer all = {0}, told = {0}, command = {0};
	const bool names = find_options(report, find_first(report), &told, NULL);
	bool infos = false, conditions = false;
	for (size_t i = 0; i < report->new_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		const bool joins = joins_in(f, (chosen){NT_SEVERITY_INFO, true});
		infos |= joins && names && f->severity == NT_SEVERITY_INFO;
		conditions |= joins && nt_code_condition(f->code);
	}
	if (join_options(report, (chosen){NT_SEVERITY_INFO, true}, &all) && all.data &&
		!(names && told.data && strcmp(all.data, told.data) == 0)) {
		nt_command_text(all.data, report->given, report->path, NULL, &command);
		nt_put(out, syntax, "%-sAll commands in one%-s%-s: %p\n", before, infos ? ", those of infos too" : "",
			conditions ? ", if their conditions hold" : "", nt_text_of(&command));
	}
	nt_buffer_free_into(&all, out);
	nt_buffer_free_into(&told, out);
}

char *nt_verdict(const nt_report *report)
{
	nt_buffer verdict = {0};
	append_verdict(report, &verdict);
	return nt_text_of(&verdict);
}
