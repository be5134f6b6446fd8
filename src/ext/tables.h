/* SPDX-License-Identifier: MIT */
/*
 * The symbol of a module: one table of functions, which begins with a head. Functions do what the headers of their
 * names say; what those do without the library (releasing plain arrays, say) is in no table.
 */
#ifndef NT_EXT_TABLES_H
#define NT_EXT_TABLES_H

#include "base/text.h"
#include "ext/draco.h"
#include "ext/meshopt.h"
#include "ext/module.h"
#include "ext/openmesh.h"
#include "ext/tinygltf.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_module_head {
	size_t struct_bytes; /* of the whole table */
	const char *version; /* of nmtan */
	const char *library, *library_version; /* that it was built with; version NULL: the library does not say */
	const char *licence; /* of the library: an SPDX expression */
	const nt_cxx *cxx;   /* NULL: nothing in it is C++ */
} nt_module_head;

#define NT_MODULE_HEAD(table, library, version, licence, cxx) \
	{sizeof(table), NMTAN_VERSION_STRING, library, version, licence, cxx}

typedef struct nt_draco_table {
	nt_module_head head;
	__typeof__(nt_draco_decode) *decode;
	__typeof__(nt_draco_encode) *encode;
	__typeof__(nt_draco_quantize) *quantize;
} nt_draco_table;

typedef struct nt_meshopt_table {
	nt_module_head head;
	__typeof__(nt_meshopt_check) *check;
	__typeof__(nt_meshopt_unpack) *unpack;
	__typeof__(nt_meshopt_filter) *filter;
	__typeof__(nt_meshopt_pack) *pack;
} nt_meshopt_table;

typedef struct nt_openmesh_table {
	nt_module_head head;
	__typeof__(nt_walk_marked) *walk;
} nt_openmesh_table;

typedef struct nt_tinygltf_table {
	nt_module_head head;
	__typeof__(nt_tinygltf_accept) *accept;
} nt_tinygltf_table;

/* The image formats have one kind of table; see ext/codec/pixels.h. */
struct nt_pixels;
typedef struct nt_codec_table {
	nt_module_head head;
	nt_status (*decode)(const unsigned char *bytes, size_t size, uint32_t rows, struct nt_pixels *pixels,
		nt_error *error);
	/* or NULL */
	nt_status (*encode)(const struct nt_pixels *pixels, unsigned char **bytes, size_t *size, nt_error *error);
} nt_codec_table;

/* The tables by name, as the loader finds them. Weak: a program may have them linked in (unit tests do) or not. */
#define NT_MODULE_TABLE extern __attribute__((weak, visibility("default")))
NT_MODULE_TABLE const nt_draco_table nt_draco_module;
NT_MODULE_TABLE const nt_meshopt_table nt_meshopt_module;
NT_MODULE_TABLE const nt_openmesh_table nt_openmesh_module;
NT_MODULE_TABLE const nt_tinygltf_table nt_tinygltf_module;
NT_MODULE_TABLE const nt_codec_table nt_png_module, nt_tiff_module, nt_webp_module;

#ifdef __cplusplus
}
#endif
#endif
