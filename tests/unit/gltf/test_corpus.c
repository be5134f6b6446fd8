/* SPDX-License-Identifier: MIT */
/*
 * Every glTF and GLB of ../shared goes through the reader: valid or not, it is read or refused with a
 * reason and a place, and nothing else happens.
 */
#include "test.h"
#include <dirent.h>
#include <stdio.h>
#include <strings.h>
#include <sys/stat.h>
#include "gltf/document.h"
#include "gltf/load.h"

static const char *const roots[] = {"../shared/models/gltf", "../shared/corpus"};

typedef struct counts {
	size_t files, opened, meshes, loaded, refused;
	bool verbose;
} counts;

static bool ends_with(const char *text, const char *end)
{
	const size_t length = strlen(text), end_length = strlen(end);
	return length >= end_length && strcasecmp(text + length - end_length, end) == 0;
}

static void check_error(const char *path, const nt_error *error, nt_status status)
{
	assert_int_equal(error->status, status);
	if (strlen(error->message) < 10 ||
		(!error->place.pointer[0] && error->place.offset == NT_NO_OFFSET &&
			!strstr(error->message, "expected an object")))
		fail_msg("%s: no place in: %s", path, error->message);
}

static void read_file(const char *path, counts *tally)
{
	nt_file file;
	nt_error error;
	nt_error_clear(&error);
	assert_int_equal(nt_file_open(&file, path, NT_NAMED_BY_USER, &error), NT_OK);
	nt_scene scene;
	nt_scene_init(&scene, path);
	scene.bytes = file.data;
	scene.byte_count = file.size;
	scene.format = ends_with(path, ".glb") ? NT_FORMAT_GLB : NT_FORMAT_GLTF;
	const nt_read_options options = {.texcoord_set = -1, .world = true};
	tally->files++;
	nt_status status = nt_gltf_open(&scene, &options, &error);
	if (status) {
		check_error(path, &error, status);
		if (tally->verbose)
			print_message("%s: %s (%s)\n", path, error.message, error.place.pointer);
		tally->refused++;
	} else {
		tally->opened++;
		for (size_t i = 0; i < scene.mesh_count; i++) {
			if (!scene.meshes[i].triangles)
				continue;
			tally->meshes++;
			status = nt_gltf_load(&scene, &scene.meshes[i], &options, &error);
			if (status)
				check_error(path, &error, status);
			else
				tally->loaded++;
			if (status && tally->verbose)
				print_message("%s: %s (%s)\n", path, error.message, error.place.pointer);
		}
	}
	nt_scene_free(&scene);
	nt_file_close(&file);
}

static void walk_folder(const char *folder, counts *tally)
{
	DIR *directory = opendir(folder);
	if (!directory)
		return;
	for (struct dirent *entry; (entry = readdir(directory));) {
		if (entry->d_name[0] == '.')
			continue;
		char path[1024];
		snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
		struct stat info;
		if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
			walk_folder(path, tally);
		else if (ends_with(path, ".gltf") || ends_with(path, ".glb"))
			read_file(path, tally);
	}
	closedir(directory);
}

TEST(every_file_is_read_or_refused_with_a_place)
{
	counts tally = {.verbose = getenv("NT_VERBOSE") != NULL};
	for (size_t i = 0; i < 2; i++)
		walk_folder(roots[i], &tally);
	if (tally.files == 0) {
		print_message("skipped: ../shared is not there\n");
		skip();
	}
	print_message("%zu files: %zu opened, %zu refused; %zu meshes of triangles, %zu loaded\n",
		tally.files, tally.opened, tally.refused, tally.meshes, tally.loaded);
	assert_true(tally.opened > 150);
	assert_true(tally.loaded > 20);
}
