/* SPDX-License-Identifier: MIT */
/*
 * Writing PLY begins and ends here: see write.h.
 */
#include "ply/ply.h"

#include "ply/encode.h"

nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error)
{
	ply_output out = {.encoding = PLY_LITTLE};
	nt_status status = nt_output_add(output, options->path, NT_ROLE_MAIN, &out.sink, error);
	if (status)
		return status;
	status = scene->format == NT_FORMAT_PLY ? ply_write_source(scene, options, &out, error)
						: ply_write_scene(scene, options, &out, output, error);
	if (!status)
		status = ply_put_bytes(&out, NULL, 0, error);
	nt_buffer_free(&out.buffer);
	return status;
}
