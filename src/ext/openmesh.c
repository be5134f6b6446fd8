/* SPDX-License-Identifier: MIT */
/*
 * The function of openmesh.h: it is in the module.
 */
#include "ext/module.h"
#include "ext/tables.h"

nt_status nt_walk_marked(const nt_walked_mesh *mesh, nt_walk_taker *take, void *context, size_t *left_out,
	nt_error *error)
{
	nt_status status;
	const nt_openmesh_table *openmesh = nt_module_open(NT_MODULE_OPENMESH, &status, error);
	return openmesh ? openmesh->walk(mesh, take, context, left_out, error) : status;
}
