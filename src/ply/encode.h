/* SPDX-License-Identifier: MIT */
/*
 * Values on their way into a PLY file, in any of the three encodings.
 */
#ifndef NT_PLY_ENCODE_H
#define NT_PLY_ENCODE_H

#include "base/buffer.h"
#include "file/output.h"
#include "ply/parts.h"
#include "scene/scene.h"

typedef struct ply_output {
	nt_buffer buffer; /* what has not been written yet */
	nt_sink *sink;
	ply_encoding encoding;
} ply_output;

/* Most values of one ply_put_floats: normal, tangent, bitangent. */
enum { PLY_MOST_FLOATS = 3 + 4 + 3 };

/* Append floats; ASCII: a blank and the text of each. */
void ply_put_floats(ply_output *out, const float *values, size_t count);

/* Appends doubles, which are binary. */
void ply_put_doubles(ply_output *out, const double *values, size_t count);

/* Appends a value that a property of that type holds; of an integer type 1 is its largest number, as of normals. ASCII:
 * its text alone. */
void ply_put_value(ply_output *out, float value, ply_type type);

/* Appends an integer that fits its type; ASCII: its text alone. */
void ply_put_integer(ply_output *out, uint32_t value, ply_type type);

/* Writes the buffer when it has become long; reports what failed since the last call. */
nt_status ply_drain(ply_output *out, nt_error *error);

/* Writes the buffer and then these bytes. */
nt_status ply_put_bytes(ply_output *out, const void *bytes, size_t size, nt_error *error);

/* Writes a scene that was read from a PLY as the file was, with the tangents added. Sets out->encoding. rewrite.c */
nt_status ply_write_source(nt_scene *scene, const nt_write_options *options, ply_output *out,
	nt_error *error);

/* Writes any other scene, binary, little endian, in world space. export.c */
nt_status ply_write_scene(nt_scene *scene, const nt_write_options *options, ply_output *out, nt_output *set,
	nt_error *error);

#endif
