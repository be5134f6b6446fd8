/* SPDX-License-Identifier: MIT */
/*
 * The way of a path: see way.h. As the system goes it, component by component; a link's text takes the place of the
 * component.
 */
#include "file/way.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "file/lookup.h"
#include "file/trace.h"

/* As many as Linux follows. */
enum { MOST_LINKS = 40 };

typedef struct way {
	nt_buffer *real;  /* so far; "" is the root */
	const char *root; /* real; nothing but what is below is looked at. NULL: no bound */
	nt_way_link link;
	void *user;
	unsigned links;
	bool outside;
} way;

static void cut(nt_buffer *text, size_t size)
{
	if (!text->failed && text->data)
		text->data[text->size = size] = '\0';
}

static void step_up(nt_buffer *real)
{
	const char *slash = real->size ? strrchr(real->data, '/') : NULL;
	cut(real, slash ? (size_t)(slash - real->data) : 0);
}

/* Whether `path` is `folder` or below. */
static bool is_within(const char *path, const char *folder)
{
	const size_t size = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
	return strncmp(path, folder, size) == 0 && (path[size] == '/' || path[size] == '\0');
}

/* Takes one component. *rest receives what its link says, if it is one. */
static void step(way *w, const char *part, size_t length, nt_buffer *rest)
{
	const size_t before = w->real->size;
	char target[PATH_MAX];
	nt_buffer_text(w->real, "/");
	nt_buffer_append(w->real, part, length);
	/* the root is real, and so is what leads to it */
	if (w->real->failed || (w->root && is_within(w->root, w->real->data)))
		return;
	w->outside = w->root && !is_within(w->real->data, w->root);
	const ssize_t size = w->outside ? -1 : readlink(w->real->data, target, sizeof target - 1);
	if (size < 0 || ++w->links > MOST_LINKS)
		return;
	target[size] = '\0';
	if (w->link)
		w->link(w->user, w->real->data, target);
	cut(w->real, target[0] == '/' ? 0 : before);
	nt_buffer_format(rest, "%s/", target);
}

static nt_status follow(way *w, const char *path, nt_error *error)
{
	nt_buffer text = {0};
	nt_buffer_text(&text, path);
	for (size_t at = 0; !w->outside && !w->real->failed && !text.failed && at < text.size;) {
		const char *part = text.data + at;
		const size_t length = strcspn(part, "/");
		nt_buffer rest = {0};
		at += length + (part[length] == '/');
		if (length == 2 && memcmp(part, "..", 2) == 0)
			step_up(w->real);
		else if (length && !(length == 1 && *part == '.'))
			step(w, part, length, &rest);
		if (!rest.size && !rest.failed)
			continue;
		nt_buffer_append(&rest, text.data + at, text.size - at);
		nt_buffer_free_into(&text, &rest);
		text = rest;
		at = 0;
	}
	const bool failed = text.failed || w->real->failed;
	nt_buffer_free(&text);
	return failed ? nt_fail_memory(error) : NT_OK;
}

nt_status nt_way_follow(
	nt_buffer *real, const char *path, nt_way_link link, void *user, nt_error *error)
{
	if (nt_name_is_too_long(path))
		return nt_lookup_failed(path, ENAMETOOLONG, error);
	way w = {.real = real, .link = link, .user = user};
	char *current = path[0] == '/' ? NULL : getcwd(NULL, 0);
	if (path[0] != '/' && !current)
		return nt_lookup_failed(".", errno, error);
	nt_buffer_text(real, current && strcmp(current, "/") != 0 ? current : "");
	free(current);
	const nt_status status = follow(&w, path, error);
	if (!status && !real->size)
		nt_buffer_text(real, "/");
	return status || !real->failed ? status : nt_fail_memory(error);
}

nt_status nt_way_is_inside(const char *folder, const char *name, bool *inside, nt_error *error)
{
	nt_buffer real = {0};
	way w = {.real = &real, .root = folder};
	if (strcmp(folder, "/") != 0)
		nt_buffer_text(&real, folder);
	const size_t begin = real.size;
	nt_status status = follow(&w, name, error);
	*inside = !status && !w.outside && real.size > begin;
	if (!status && !*inside) {
		cut(&real, 0);
		nt_buffer_format(&real, "%s/%s", folder, name);
		if (!real.failed)
			nt_trace_way(real.data);
		else
			status = nt_fail_memory(error);
	}
	nt_buffer_free(&real);
	return status;
}
