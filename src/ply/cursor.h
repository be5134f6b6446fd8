/* SPDX-License-Identifier: MIT */
/*
 * A place in the body of a PLY file: moving over rows, and errors that name the place.
 */
#ifndef NT_PLY_CURSOR_H
#define NT_PLY_CURSOR_H

#include "ply/header.h"

/* The source of the values: a position in the input with what is needed to check it. */
typedef struct ply_cursor {
	const unsigned char *begin, *at, *end; /* of the input */
	size_t body_line;                      /* line that body is on */
	const unsigned char *body;
	ply_encoding encoding;
	unsigned threads; /* of plain rows of text; 0 and 1: the caller alone */
} ply_cursor;

/* Line (1-based) of a position in an ASCII body: counted when an error needs it. */
size_t ply_line_of(const ply_cursor *cursor, const unsigned char *at);

/* An error at a position: with its line in ASCII, with its offset in binary. */
nt_status ply_fail_at(const ply_cursor *cursor, const unsigned char *at, nt_error *error,
	const char *format, ...) NT_PRINTF(4, 5);

/* An error for a row that is not there. */
nt_status ply_fail_end(const ply_cursor *cursor, const ply_element *element, size_t row, nt_error *error);

/* "the rest of the line, shortened", for messages: fills text. */
const char *ply_show(const ply_cursor *cursor, const unsigned char *at, char text[40]);

/* Moves behind the rows of an element, whose count is checked against the input first. */
nt_status ply_skip_element(ply_cursor *cursor, const ply_element *element, nt_error *error);

/* Moves to the first value of the next ASCII row, or to the end of the input. */
void ply_next_row(ply_cursor *cursor);

/* After the last value of an ASCII row: that nothing follows on its line. */
nt_status ply_check_row_end(const ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error);

/* Skips the row at the cursor of a binary element with lists; no further than the input reaches. */
nt_status ply_skip_binary_row(ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error);

/* Refuses an element that cannot fit into the rest of the input, whatever its values are. */
nt_status ply_check_count(const ply_cursor *cursor, const ply_element *element, nt_error *error);

#endif
