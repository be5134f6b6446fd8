/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "folder.h"

#include <dirent.h>
#include <ftw.h>
#include <unistd.h>

static char folder[300];

char *in_tmpdir(const char *name)
{
	static char names[4][sizeof folder];
	static unsigned turn;
	char *path = names[turn++ % 4];
	const char *set = getenv("TMPDIR");
	const int length = snprintf(path, sizeof names[0], "%s/%s", set && *set ? set : "/tmp", name);
	assert_in_range(length, 1, sizeof names[0] - 1);
	return path;
}

int make_folder(void **state)
{
	(void)state;
	strcpy(folder, in_tmpdir("nmtan-test-XXXXXX"));
	return mkdtemp(folder) ? 0 : -1;
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *place)
{
	(void)status;
	(void)kind;
	(void)place;
	return remove(path);
}

int remove_folder(void **state)
{
	(void)state;
	return nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

int enter_folder(void **state)
{
	return make_folder(state) || chdir(folder);
}

int leave_folder(void **state)
{
	return chdir("/") || remove_folder(state);
}

const char *in_folder(const char *name)
{
	static char paths[8][512];
	static unsigned turn;
	char *path = paths[turn++ % 8];
	snprintf(path, sizeof paths[0], *name ? "%s/%s" : "%s%s", folder, name);
	return path;
}

size_t count_in_folder(void)
{
	DIR *stream = opendir(folder);
	assert_non_null(stream);
	size_t count = 0;
	for (const struct dirent *entry; (entry = readdir(stream));)
		count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
	closedir(stream);
	return count;
}

static FILE *begin_file(const char *name)
{
	FILE *stream = fopen(in_folder(name), "wb");
	assert_non_null(stream);
	return stream;
}

static void end_file(FILE *stream)
{
	assert_int_equal(ferror(stream), 0);
	assert_int_equal(fclose(stream), 0);
}

void put_file(const char *name, const void *bytes, size_t size)
{
	FILE *stream = begin_file(name);
	fwrite(bytes, 1, size, stream);
	end_file(stream);
}

void put_text_file(const char *name, const char *text)
{
	put_file(name, text, strlen(text));
}

static void put_word(FILE *stream, size_t word)
{
	for (int shift = 0; shift < 32; shift += 8)
		fputc((int)(word >> shift & 0xff), stream);
}

static void put_chunk(FILE *stream, const char *kind, const void *bytes, size_t size, char fill)
{
	put_word(stream, (size + 3) / 4 * 4);
	fwrite(kind, 1, 4, stream);
	fwrite(bytes, 1, size, stream);
	for (; size % 4; size++)
		fputc(fill, stream);
}

void put_glb_file(const char *name, const char *json, const void *bin, size_t bin_size)
{
	FILE *stream = begin_file(name);
	fwrite("glTF", 1, 4, stream);
	put_word(stream, 2);
	put_word(stream, 12 + 8 + (strlen(json) + 3) / 4 * 4 + 8 + (bin_size + 3) / 4 * 4);
	put_chunk(stream, "JSON", json, strlen(json), ' ');
	put_chunk(stream, "BIN", bin, bin_size, '\0');
	end_file(stream);
}
