/* SPDX-License-Identifier: MIT */
/*
 * The functions of openmesh.h: they are in the module.
 */
#include "ext/openmesh.h"

#include "ext/module.h"
#include "ext/tables.h"

static const nt_openmesh_table *opened(void)
{
	return nt_module_opened(NT_MODULE_OPENMESH);
}

nt_status nt_halfedges_build(nt_halfedges **mesh, size_t vertex_count, const uint32_t *triangles, size_t triangle_count,
	nt_error *error)
{
	nt_status status;
	const nt_openmesh_table *openmesh = nt_module_open(NT_MODULE_OPENMESH, &status, error);
	*mesh = NULL;
	return openmesh ? openmesh->build(mesh, vertex_count, triangles, triangle_count, error) : status;
}

void nt_halfedges_free(nt_halfedges *mesh)
{
	if (mesh)
		opened()->free(mesh);
}

size_t nt_halfedges_left_out(const nt_halfedges *mesh, const uint32_t **triangles)
{
	return opened()->left_out(mesh, triangles);
}

nt_status nt_halfedges_chains(const nt_halfedges *mesh, const uint8_t *marked, nt_walks *walks, nt_error *error)
{
	return opened()->chains(mesh, marked, walks, error);
}
