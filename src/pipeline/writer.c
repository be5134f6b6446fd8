/* SPDX-License-Identifier: MIT */
/*
 * Chooses the writer of the output: see stages.h.
 */
#include "pipeline/stages.h"

#include <string.h>
#include "file/input.h"

/* Whether cp would write into it. */
static bool is_folder(const char *path)
{
	const size_t length = strlen(path);
	return (length && path[length - 1] == '/') || nt_is_folder(path);
}

/* The format of an output without a name, as a check without -o and -d has it. A glTF that is not to be converted is
 * judged as it is, since it can hold tangents already. */
static const nt_format_entry *find_unnamed(const nt_settings *settings, const nt_format_entry *reader)
{
	if (!settings->check || !nt_format_is_gltf(reader->format))
		return nt_format_unnamed(reader);
	return settings->converts ? nt_format_find(reader->format) : NULL;
}

static nt_status choose(const nt_settings *settings, const char *path, const nt_format_entry *reader,
	const nt_format_entry **writer, nt_error *error)
{
	/* a name that says a format needs no look; that of a stream need not say one */
	const bool unnamed = settings->output_format == NT_FORMAT_UNKNOWN && !nt_format_of_path(path) &&
		nt_output_is_stream(path);
	if (unnamed && !reader)
		return NT_OK;
	if (unnamed)
		*writer = find_unnamed(settings, reader);
	else if (settings->output_format != NT_FORMAT_UNKNOWN)
		*writer = nt_format_find(settings->output_format);
	else
		*writer = nt_format_of_path(path);
	if (!*writer && unnamed)
		return NT_OK;
	if (!*writer && is_folder(path))
		return nt_fail_file(error, NT_ERROR_USAGE, path, "is a folder: to write into it use -d");
	if (!*writer)
		return nt_fail_file(error, NT_ERROR_USAGE, path,
			"cannot tell the output format from the name: expected .gltf, .glb or .ply, "
			"or --output-format");
	if (!(*writer)->write)
		return nt_fail_file(error, NT_ERROR_USAGE, path,
			"%s can only be read; an output is .gltf, .glb or .ply%s", (*writer)->name,
			settings->in_place ? ": -d DIR writes them elsewhere" : "");
	if (settings->verify && (*writer)->format == NT_FORMAT_PLY)
		return nt_fail_file(error, NT_ERROR_USAGE, path, "--verify reads glTF back; this will be PLY");
	if (settings->io.precision > NT_PRECISION_FLOAT && (*writer)->format == NT_FORMAT_PLY)
		return nt_fail_file(error, NT_ERROR_USAGE, path,
			"--precision is about glTF; this will be PLY, whose tangents are floats");
	return NT_OK;
}

/* Options for a glTF made from a glTF only. */
static nt_status check_edit(const nt_settings *settings, const char *path, const nt_format_entry *reader,
	const nt_format_entry *writer, nt_error *error)
{
	const bool edits = writer && writer->format != NT_FORMAT_PLY && nt_format_is_gltf(reader->format);
	if (writer && !edits && settings->io.draco > NT_DRACO_OFF)
		return nt_fail(error, NT_ERROR_USAGE,
			writer->format == NT_FORMAT_PLY ? "--draco=%s compresses glTF, not PLY" :
			"--draco=%s compresses glTF that is made from glTF: convert to .glb without it, and then that "
			"with --existing=replace --only=all and it",
			settings->io.draco == NT_DRACO_AS_SEQUENTIAL ? "sequential" : "edgebreaker");
	if (writer && writer->format == NT_FORMAT_PLY && reader->format != NT_FORMAT_PLY &&
		settings->io.images == NT_IMAGES_EMBED)
		return nt_fail(error, NT_ERROR_USAGE,
			"--images=embed: a PLY names a file; use link, copy or none");
	if (writer && !settings->check && writer->format != NT_FORMAT_PLY && nt_output_is_stream(path) &&
		(settings->io.images == NT_IMAGES_COPY || settings->io.buffers == NT_BUFFERS_COPY))
		return nt_fail(error, NT_ERROR_USAGE, "--%s=copy: there are no files beside \"%s\"; use link or embed",
			settings->io.images == NT_IMAGES_COPY ? "images" : "buffers", path);
	if (writer && settings->io.weld && !edits && reader->format != NT_FORMAT_OBJ)
		return nt_fail(error, NT_ERROR_USAGE,
			"--weld: only glTF made from glTF is welded, not %s made from %s",
			writer->name, reader->name);
	/* taking images away would renumber what refers to them */
	if (edits && settings->io.images == NT_IMAGES_NONE)
		return nt_fail(error, NT_ERROR_USAGE,
			"--images=none: a glTF made from a glTF keeps its images; use link, embed or copy");
	return NT_OK;
}

nt_status nt_choose_writer(const nt_settings *settings, const char *path, const nt_format_entry *reader,
	const nt_format_entry **writer, nt_error *error)
{
	const nt_status status = choose(settings, path, reader, writer, error);
	return status || !reader ? status : check_edit(settings, path, reader, *writer, error);
}
