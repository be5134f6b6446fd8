/* SPDX-License-Identifier: MIT */
#include "golden.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int nt_golden_read(nt_golden *golden, const char *path)
{
	*golden = (nt_golden){0};
	FILE *file = fopen(path, "rb");
	if (!file)
		return 0;
	fseek(file, 0, SEEK_END);
	const long size = ftell(file);
	rewind(file);
	unsigned char *bytes = size > 0 ? malloc((size_t)size) : NULL;
	const int whole = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size;
	fclose(file);
	uint32_t header[3] = {0};
	if (whole && size >= 16)
		memcpy(header, bytes + 4, sizeof header);
	const size_t padded = ((size_t)header[1] + 3) / 4 * 4;
	if (!whole || size < 16 || memcmp(bytes, "NMTG", 4) != 0 || header[0] != 1 ||
		(size_t)size != 16 + padded + (size_t)header[2] * 12 * sizeof(float)) {
		free(bytes);
		return 0;
	}
	golden->block = bytes;
	golden->face_count = header[1];
	golden->corner_count = header[2];
	golden->face_sizes = bytes + 16;
	golden->positions = (float *)(bytes + 16 + padded);
	golden->normals = golden->positions + 3 * (size_t)header[2];
	golden->texcoords = golden->normals + 3 * (size_t)header[2];
	golden->tangents = golden->texcoords + 2 * (size_t)header[2];
	return 1;
}

void nt_golden_free(nt_golden *golden)
{
	free(golden->block);
	*golden = (nt_golden){0};
}

nmtan_mesh nt_golden_mesh(const nt_golden *golden)
{
	return (nmtan_mesh){
		.struct_bytes = sizeof(nmtan_mesh),
		.face_count = golden->face_count,
		.vertex_count = golden->corner_count,
		.face_sizes = golden->face_sizes,
		.positions = golden->positions,
		.normals = golden->normals,
		.texcoords = golden->texcoords,
	};
}

static int is_golden(const struct dirent *entry)
{
	const size_t length = strlen(entry->d_name);
	return length > 5 && strcmp(entry->d_name + length - 5, ".nmtg") == 0;
}

size_t nt_golden_each(const char *folder, void (*visit)(const char *path, const nt_golden *golden,
	void *context), void *context)
{
	struct dirent **entries;
	const int count = scandir(folder, &entries, is_golden, alphasort);
	size_t visited = 0;
	for (int i = 0; i < count; i++) {
		char path[4096];
		snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
		nt_golden golden;
		if (nt_golden_read(&golden, path)) {
			visit(path, &golden, context);
			visited++;
		}
		nt_golden_free(&golden);
		free(entries[i]);
	}
	if (count >= 0)
		free(entries);
	return visited;
}
