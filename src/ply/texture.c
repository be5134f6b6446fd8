/* SPDX-License-Identifier: MIT */
/*
 * The image that a PLY names in a comment, "TextureFile NAME", from the folder of the PLY; and a finding of what of the
 * materials is lost.
 */
#include "ply/parts.h"

#include <string.h>
#include <unistd.h>
#include "base/hash_index.h"
#include "file/input.h"
#include "file/path.h"

/* MeshLab drops all other characters of a name. */
static bool is_read_by_all(char c)
{
	return c > 32 && c < 125;
}

/* Puts the image beside the output, under its own name as far as all read it; an embedded one is called after the
 * output. name: appended. */
static nt_status copy_image(nt_buffer *name, const nt_texture_file *image, const char *folder, const char *output,
	nt_output *set, nt_error *error)
{
	static const char *const endings[] = {[NT_IMAGE_PNG] = ".png", [NT_IMAGE_JPEG] = ".jpg",
		[NT_IMAGE_WEBP] = ".webp", [NT_IMAGE_EXR] = NULL};
	const char *own = nt_last_part(image->path ? image->path : output), *dot = strrchr(own, '.');
	const char *ending = image->path ? NULL : endings[nt_image_type_of_bytes(image->bytes, image->size)];
	nt_buffer path = {0};
	nt_sink *sink;
	nt_buffer_format(&path, "%s/", folder);
	const size_t begin = path.size;
	nt_buffer_append(&path, own, ending && dot ? (size_t)(dot - own) : strlen(own));
	nt_buffer_text(&path, ending ? ending : "");
	for (size_t i = begin; i < path.size && !path.failed; i++)
		path.data[i] = is_read_by_all(path.data[i]) ? path.data[i] : '_';
	nt_status status = path.failed ? nt_fail_memory(error)
		: nt_output_add(set, path.data, NT_ROLE_IMAGE, &sink, error);
	nt_buffer_free(&path);
	if (!status)
		status = nt_sink_write(sink, image->bytes, image->size, error);
	if (!status)
		status = nt_output_settle(set, sink, error);
	if (!status)
		nt_buffer_text(name, nt_sink_name(sink, false));
	return status;
}

/* The name of the image in the PLY: of its file if that is in the output's folder, else of a copy there; "": there is
 * none. */
static nt_status settle_image(nt_buffer *name, const nt_texture_file *image, const nt_write_options *options,
	nt_output *set, nt_error *error)
{
	nt_buffer folder = {0}, path = {0};
	nt_status status = nt_link_folder(&folder, options->path, error);
	if (!status && image->path)
		status = nt_path_place(&path, image->path, error);
	bool inside = !status && image->path && nt_link_is_inside(path.data, folder.data);
	for (const char *c = inside ? path.data + folder.size : ""; *c && inside; c++)
		inside = is_read_by_all(*c);
	if (!status && image->path && (options->images == NT_IMAGES_LINK ||
		(inside && options->images != NT_IMAGES_COPY))) {
		nt_path_relative(name, folder.data, path.data);
		status = nt_output_protect(set, image->path, NULL, error);
	} else if (!status) {
		status = copy_image(name, image, folder.data, options->path, set, error);
	}
	nt_buffer_free(&folder);
	nt_buffer_free(&path);
	return status || !name->failed ? status : nt_fail_memory(error);
}

/* Counts the files that an OBJ's materials name, but for base colours if the output has those. *first: a normal map, if
 * there is any. */
static size_t count_maps(const nt_scene *scene, bool but_colors, const char **first)
{
	nt_name_table names = {0};
	for (size_t i = 0; i < scene->material_count; i++) {
		const nt_material *m = &scene->materials[i];
		for (size_t k = 0; k < NT_MATERIAL_MAPS; k++) {
			const char *name = but_colors && &m->maps[k] == &m->base_color_map ? NULL : m->maps[k].name;
			if (name)
				nt_name_add(&names, name, strlen(name)); /* without memory there are fewer */
			if (name && (!*first || &m->maps[k] == &m->normal_map))
				*first = name;
		}
	}
	const size_t count = names.count;
	nt_name_table_free(&names);
	return count;
}

/* Says what of the materials is not there. image: name of the one that is; NULL: none. */
static void tell_lost(nt_scene *scene, const char *image, const char *obstacle)
{
	const char *first = NULL;
	const size_t textures = scene->left_out_textures - (image && scene->left_out_textures) +
		count_maps(scene, image != NULL, &first);
	const size_t count = scene->material_count + textures + scene->left_out_count;
	const nt_place place = nt_line_place(scene->path, scene->left_out_line);
	nt_buffer text = {0};
	if (scene->material_count)
		nt_buffer_format(&text, "materials (%zu)", scene->material_count);
	if (scene->left_out.size)
		nt_buffer_format(&text, "%s%s", text.size ? ", " : "", scene->left_out.data);
	if (textures)
		nt_buffer_format(&text, "%stextures (%zu%s%.*s%s)", text.size ? ", " : "", textures, first ? ": " : "",
			NT_CUT(60, first ? first : ""), first && textures > 1 ? " and others" : "");
	if (image)
		nt_buffer_format(&text, "; %.*s stays: comment TextureFile", NT_CUT(100, image));
	else if (obstacle)
		nt_buffer_format(&text, "; no TextureFile: %s", obstacle);
	if (count)
		nt_finding_add(&scene->findings, NT_CODE_REFERENCE_LOST, &place, count, "%s",
			text.data && !text.failed ? text.data : "");
	scene->findings.failed |= text.failed || scene->left_out.failed;
	nt_buffer_free(&text);
}

nt_status ply_settle_texture(nt_buffer *name, nt_scene *scene, const nt_write_options *options, nt_output *set,
	nt_error *error)
{
	const nt_texture_file *image = options->texture_file;
	const bool stream = nt_output_is_stream(options->path);
	nt_status status = NT_OK;
	if (image && image->bytes && !stream)
		status = settle_image(name, image, options, set, error);
	tell_lost(scene, name->size ? name->data : NULL, !image ? NULL : image->bytes && stream
		? "there are no files beside a stream" : image->obstacle);
	return status;
}

/* Whether there is a file of this name in the folder of another. */
static bool lies_beside(const char *path, const char *name)
{
	nt_buffer text = {0};
	nt_path_beside(&text, path, name);
	const bool lies = !text.failed && access(text.data, R_OK) == 0;
	nt_buffer_free(&text);
	return lies;
}

void ply_tell_left(nt_scene *scene, const nt_write_options *options)
{
	size_t count = 0;
	const char *first = NULL;
	for (size_t i = 0; i < scene->material_count && !nt_output_is_stream(options->path); i++) {
		const char *name = scene->materials[i].name;
		if (!lies_beside(scene->path, name) || lies_beside(options->path, name))
			continue;
		first = first ? first : name;
		count++;
	}
	if (count)
		nt_finding_add(&scene->findings, NT_CODE_REFERENCE_LOST, NULL, count,
			"TextureFile is %.*s, which lies beside the input alone", NT_CUT(100, first));
}
