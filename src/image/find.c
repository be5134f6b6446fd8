/* SPDX-License-Identifier: MIT */
/*
 * Finding images: see textures.h. A candidate is a folder that we may look into and a relative name in it; whatever
 * it leads to is resolved and compared with the folder before it counts.
 */
#include "image/textures.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "file/input.h"
#include "file/path.h"

/* So many last parts of a name are looked for: each is one more look into every folder. */
enum { MOST_PARTS = 32 };

typedef struct search {
	const nt_image_places *places;
	nt_buffer *path;
	nt_buffer above, root; /* folders in and below which images may be, too; empty: none, or not asked for */
	bool bounded;          /* they have been asked for */
	bool outside; /* a name leads to where nobody may look */
	bool foreign; /* the name is a path of another system */
	nt_error *error;
} search;

static nt_status is_file(const char *path, bool *is, nt_error *error)
{
	struct stat info;
	const nt_status status = nt_lookup_found(path, &info, is, error);
	if (*is && !S_ISREG(info.st_mode)) {
		*is = false;
		nt_trace_note(NT_TRACE_MISSING, path, NULL, NULL);
	}
	return status;
}

/* Whether a file is an image by its content; what cannot be opened is none, but for Git LFS's pointer to it. */
static nt_status is_image(const char *path, bool *is, nt_error *error)
{
	nt_file file;
	nt_error unused;
	*is = false;
	const nt_status status = nt_file_open(&file, path, NT_NAMED_BY_DOCUMENT, &unused);
	*is = status == NT_ERROR_MISSING;
	if (status)
		return status == NT_ERROR_MEMORY ? nt_fail_memory(error) : NT_OK;
	*is = nt_image_type_of_bytes(file.data, file.size) != NT_IMAGE_OTHER;
	nt_file_close(&file);
	return NT_OK;
}

/* The folders in and below which images may be beside the one where they are looked for; asked for by the first name
 * that leaves that. */
static nt_status find_bounds(search *s)
{
	const nt_image_places *p = s->places;
	nt_error failure;
	nt_status status = NT_OK;
	if (s->bounded || p->confined)
		return NT_OK;
	s->bounded = true;
	if (p->input)
		status = nt_link_folder(&s->above, p->input, &failure);
	char *slash = !status && s->above.size ? strrchr(s->above.data, '/') : NULL;
	if (slash)
		*slash = '\0';
	if (!slash || slash == s->above.data)
		nt_buffer_free(&s->above);
	if (p->root && (!status || status == NT_ERROR_MISSING))
		status = nt_path_real(&s->root, p->root, &failure);
	if (s->root.size == 1)
		nt_buffer_free(&s->root);
	if (s->root.failed || s->above.failed)
		return nt_fail_memory(s->error);
	if (status && status != NT_ERROR_MISSING)
		*s->error = failure;
	return status == NT_ERROR_MISSING ? NT_OK : status;
}

/* A folder by whose leave one may look at the path, which was found from `folder`; NULL: there is none. A path
 * that leaves a folder by its text does so before anybody looks: what is said must not tell whether something is there.
 * A link that leaves one may lead to another one. */
static nt_status find_bound(search *s, const char *folder, const char *path, const char **bound)
{
	nt_status status = NT_OK;
	*bound = NULL;
	for (int i = 0; i < 3 && !*bound && !status; i++) {
		if (i == 1)
			status = find_bounds(s);
		const char *leave = status ? NULL : i == 0 ? folder : i == 1 ? s->root.data : s->above.data;
		bool inside = leave && nt_link_is_inside(path, leave);
		if (inside)
			status = nt_path_stays_inside(leave, path + strlen(leave), &inside, s->error);
		if (!status && inside)
			*bound = leave;
	}
	return status;
}

/* Whether the file at s->path, named from `folder`, may be the one. */
static nt_status accept(search *s, const char *folder, bool *accepted)
{
	const char *bound = folder;
	*accepted = false;
	nt_status status = s->places->allow_outside ? NT_OK : find_bound(s, folder, s->path->data, &bound);
	s->outside |= !bound;
	if (!status && bound)
		status = is_file(s->path->data, accepted, s->error);
	if (!status && *accepted && bound == s->above.data)
		status = is_image(s->path->data, accepted, s->error);
	return status;
}

static nt_status try_name(search *s, const char *folder, const char *name, bool *accepted)
{
	s->path->size = 0;
	nt_path_join(s->path, folder, name);
	return s->path->failed ? nt_fail_memory(s->error) : accept(s, folder, accepted);
}

/* ---- without case ---- */

/* As try_name(), part by part. No folder is searched that a link leads out to. */
static nt_status try_any_case(search *s, const char *folder, const char *name, bool *accepted)
{
	const char *bound = folder;
	*accepted = false;
	s->path->size = 0;
	nt_buffer_text(s->path, strcmp(folder, "/") == 0 ? "" : folder);
	nt_status status = NT_OK;
	while (*name && !status) {
		const size_t length = strcspn(name, "/");
		char *entry;
		if (s->path->failed)
			return nt_fail_memory(s->error);
		status = nt_lookup_any_case(
			s->path->data ? s->path->data : "", name, length, &entry, s->error);
		if (status || !entry)
			return status;
		nt_buffer_format(s->path, "/%s", entry);
		free(entry);
		name += length;
		name += strspn(name, "/");
		if (*name && !s->path->failed && !s->places->allow_outside) {
			status = find_bound(s, folder, s->path->data, &bound);
			s->outside |= !bound;
			if (status || !bound)
				return status;
		}
	}
	if (!status)
		status = s->path->failed ? nt_fail_memory(s->error) : accept(s, folder, accepted);
	return status;
}

/* ---- parts of names ---- */

typedef nt_status (*try_fn)(search *s, const char *folder, const char *name, bool *accepted);

/* The suffixes of a name, which has "/" alone and begins with its first part. */
static nt_status try_suffixes(search *s, const char *folder, const char *name, try_fn try, bool *accepted)
{
	nt_status status = NT_OK;
	size_t parts = 1;
	for (const char *c = name; *c; c++)
		parts += *c == '/';
	for (; parts > MOST_PARTS; parts--)
		name = strchr(name, '/') + 1;
	*accepted = false;
	while (name && *name && !status && !*accepted) {
		status = try(s, folder, name, accepted);
		name = strchr(name, '/');
		if (name)
			name += strspn(name, "/");
	}
	return status;
}

/* A name without what its own machine means alone: drive, host, scheme, the way up and down; in a malloc'ed block.
 * NULL: out of memory. */
static char *portable_part(const char *name)
{
	nt_buffer text = {0}, joined = {0};
	const char *colon = nt_link_is_absolute(name) ? strchr(name, ':') : NULL;
	nt_path_join(&joined, "/", colon ? colon + 1 : name);
	nt_buffer_text(&text, joined.data ? joined.data + strspn(joined.data, "/") : "");
	nt_buffer_free_into(&joined, &text);
	if (text.failed)
		nt_buffer_free(&text);
	return text.data;
}

/* The folders in which parts of names are looked for, one a call. False: no more. */
static nt_status folder_at(const nt_image_places *places, size_t index, nt_buffer *folder, bool *more, nt_error *error)
{
	nt_error failure;
	nt_status status;
	folder->size = 0;
	*more = index < places->folder_count + 2;
	if (!*more)
		return NT_OK;
	if (index < 2) {
		const char *file = index == 0 ? places->document : places->input;
		status = file ? nt_link_folder(folder, file, &failure) : NT_ERROR_MISSING;
	} else {
		status = nt_path_real(folder, places->folders[index - 2], &failure);
	}
	if (!status && folder->failed)
		return nt_fail_memory(error);
	if (status && status != NT_ERROR_MISSING)
		*error = failure;
	return status == NT_ERROR_MISSING ? NT_OK : status;
}

static nt_status try_folders(search *s, const char *name, try_fn try, bool *accepted)
{
	nt_buffer folder = {0};
	nt_status status = NT_OK;
	*accepted = false;
	nt_buffer first = {0};
	for (size_t i = 0; !status && !*accepted; i++) {
		bool more;
		status = folder_at(s->places, i, &folder, &more, s->error);
		if (status || !more)
			break;
		if (i == 0)
			nt_buffer_append(&first, folder.data ? folder.data : "", folder.size);
		/* the input is mostly beside its document */
		if (folder.size && (i != 1 || first.failed || !first.size || strcmp(first.data, folder.data) != 0))
			status = try_suffixes(s, folder.data, name, try, accepted);
	}
	nt_buffer_free(&folder);
	nt_buffer_free(&first);
	return status;
}

/* ---- the order ---- */

/* The first step; `folder` receives the document's, "" where that does not exist. */
static nt_status try_as_named(search *s, const char *name, nt_buffer *folder, bool *accepted)
{
	bool more;
	*accepted = false;
	nt_status status = folder_at(s->places, 0, folder, &more, s->error);
	if (status || !folder->size)
		return status;
	if (nt_link_is_absolute(name) && (s->foreign || s->places->confined) && !s->places->allow_outside) {
		s->outside = !s->foreign; /* other systems' names are nowhere here */
		return NT_OK;
	}
	return try_name(s, folder->data, name, accepted);
}

/* The same without regard to case, for a name that leaves the document's folder: from the folder that it is below. */
static nt_status try_as_named_any_case(search *s, const char *name, const char *folder, bool *accepted)
{
	nt_buffer joined = {0};
	*accepted = false;
	if (s->foreign)
		return NT_OK;
	nt_path_join(&joined, folder, name);
	/* below the folder itself try_folders() looks, which lists no folder above: each run may write there */
	if (!joined.failed && nt_link_is_inside(joined.data, folder)) {
		nt_buffer_free(&joined);
		return NT_OK;
	}
	nt_status status = joined.failed ? nt_fail_memory(s->error) : s->places->allow_outside ? NT_OK : find_bounds(s);
	const char *const folders[] = {s->root.data, s->above.data};
	for (size_t i = 0; i < 2 && !*accepted && !status; i++)
		if (folders[i] && nt_link_is_inside(joined.data, folders[i]))
			status = try_any_case(s, folders[i], joined.data + strlen(folders[i]) + 1, accepted);
	nt_buffer_free(&joined);
	return status;
}

nt_status nt_image_find(const nt_image_places *places, const char *spelled, nt_buffer *path, nt_image_found *found,
	nt_error *error)
{
	nt_buffer folder = {0};
	search s = {.places = places, .path = path, .error = error};
	bool accepted;
	nt_status status = NT_OK;
	if (places->given) {
		*found = NT_IMAGE_FOUND;
		return nt_path_place(path, spelled, error);
	}
	/* no folder has a file of such a name, and to follow it part by part would take long */
	if (nt_name_is_too_long(spelled)) {
		*found = NT_IMAGE_MISSING;
		path->size = 0;
		nt_buffer_text(path, spelled);
		return path->failed ? nt_fail_memory(error) : NT_OK;
	}
	char *const name = strdup(spelled);
	if (!name)
		return nt_fail_memory(error);
	s.foreign = nt_link_is_absolute(name) && *name != '/';
	for (char *c = name; *c; c++)
		*c = *c == '\\' ? '/' : *c;
	status = try_as_named(&s, name, &folder, &accepted);
	*found = NT_IMAGE_FOUND;
	if (!status && !accepted) {
		*found = NT_IMAGE_FOUND_ELSEWHERE;
		char *part = portable_part(name);
		status = part ? try_folders(&s, part, try_name, &accepted) : nt_fail_memory(error);
		if (!status && !accepted && folder.size)
			status = try_as_named_any_case(&s, name, folder.data, &accepted);
		if (!status && !accepted)
			status = try_folders(&s, part, try_any_case, &accepted);
		if (!status && !accepted) {
			*found = s.outside ? NT_IMAGE_OUTSIDE : NT_IMAGE_MISSING;
			path->size = 0;
			nt_path_join(path, folder.size ? folder.data : "/",
				nt_link_is_absolute(name) ? nt_last_part(part) : name);
			status = path->failed ? nt_fail_memory(error) : NT_OK;
		}
		free(part);
	}
	free(name);
	nt_buffer_free(&folder);
	nt_buffer_free(&s.above);
	nt_buffer_free(&s.root);
	return status;
}
