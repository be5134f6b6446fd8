/* SPDX-License-Identifier: MIT */
/*
 * A fresh folder for the files of a test, or of a group of them, and what tests put into it. There is one at a time.
 */
#ifndef NT_TEST_FOLDER_H
#define NT_TEST_FOLDER_H

#include <stddef.h>

/* A name in $TMPDIR, or in /tmp, as mkstemp() and mkdtemp() take it; good for the next three calls. */
char *in_tmpdir(const char *name);

/* For cmocka's setup and teardown; the folder goes with all that is in it. */
int make_folder(void **state);
int remove_folder(void **state);

/* The same, and it is the current folder meanwhile. */
int enter_folder(void **state);
int leave_folder(void **state);

/* The path of a file in it, "" for the folder itself; good for the next seven calls. */
const char *in_folder(const char *name);

/* How many files and folders it has. */
size_t count_in_folder(void);

/* Writes a file into it; the parts of a .glb without our writer. */
void put_file(const char *name, const void *bytes, size_t size);
void put_text_file(const char *name, const char *text);
void put_glb_file(const char *name, const char *json, const void *bin, size_t bin_size);

#endif
