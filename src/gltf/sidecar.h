/* SPDX-License-Identifier: MIT */
/*
 * Members of a document about the buffers that were written beside it: their names, and in "extras" the digest by
 * which a later run knows them for ours (output.h).
 *
 *   "extras": {"nmtan:xxh128": DIGEST}                             we wrote these bytes, for this document
 *   "extras": {"nmtan:xxh128": DIGEST, "nmtan:replaces": DIGEST}   under a staging name, to replace that
 */
#ifndef NT_GLTF_SIDECAR_H
#define NT_GLTF_SIDECAR_H

#include "file/output.h"
#include "json/json.h"

/* For nt_output_options.find_ownership. */
nt_status nt_gltf_find_ownership(nt_output *output, const char *path, nt_error *error);

/* Gives a buffer the uri and the digest of a settled sidecar. Extras that are no object stay as they are. */
nt_status nt_gltf_record(nt_json *json, nt_json_value *buffer, const nt_sink *sidecar, bool staging,
	nt_error *error);

/* Takes the digest away: the buffer is not, or no longer, a file that was written for this document. */
void nt_gltf_forget_record(nt_json *json, nt_json_value *buffer);

#endif
