/* SPDX-License-Identifier: MIT */
/*
 * Finds the file of a name in a material. Names may be paths of another machine, of a system without case, or of a
 * folder that was moved. Unless the user allows it, files outside of the folders that are listed below are not found,
 * also not through a symbolic link, and nobody looks whether they are there.
 */
#ifndef NT_IMAGE_FIND_H
#define NT_IMAGE_FIND_H

#include <stdbool.h>
#include "base/text.h"

/* Places to search. */
typedef struct nt_image_places {
	const char *document;       /* the file that has the name (MTL): names are relative to its folder */
	const char *input;          /* the file that has the document (OBJ); NULL: none */
	const char *const *folders; /* [folder_count] of the user's choice */
	size_t folder_count;
	const char *root;           /* a folder of the user's in and below which images may be; NULL: none */
	bool confined;              /* neither there nor in the folder above the input's */
	bool allow_outside;         /* anywhere */
	bool given;                 /* names are paths of the user's, and nothing else is looked for */
} nt_image_places;

typedef enum nt_image_found {
	NT_IMAGE_FOUND,           /* as it is named */
	NT_IMAGE_FOUND_ELSEWHERE, /* by a part of its name, in another folder, or in another case */
	NT_IMAGE_MISSING,
	NT_IMAGE_OUTSIDE          /* where nobody may look */
} nt_image_found;

/*
 * Looks for a file in this order; the first that exists is it.
 *
 * 1. the name as it is, from the document's folder
 * 2. in the document's folder, the input's and `folders`, in this order: the name's last parts, as many as lead to a
 *    file (of C:\art\tex\n.png: art/tex/n.png, tex/n.png, n.png)
 * 3. both without regard to case (of ASCII); of several files the first in the order of bytes
 *
 * A file counts if its real path is in or below the folder where the name is looked for, `root`, or the folder above
 * the input's; there it has to be an image by its content, since all else that lies there is not told from what does
 * not. The root of the file system is neither.
 *
 *   path   appended: absolute, links kept; of what is missing, where it would be by the document
 *   found  receives how it was found
 *
 * Returns NT_OK, also for what is not found, NT_ERROR_IO or NT_ERROR_MEMORY.
 */
nt_status nt_image_find(const nt_image_places *places, const char *name, nt_buffer *path, nt_image_found *found,
	nt_error *error);

#endif
