/* SPDX-License-Identifier: MIT */
/*
 * The functions of meshopt.h: they are in the module.
 */
#include "ext/meshopt.h"

#include "ext/module.h"
#include "ext/tables.h"

nt_status nt_meshopt_check(const nt_meshopt_view *view, uint64_t size, const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->check(view, size, pointer, error) : status;
}

nt_status nt_meshopt_unpack(const nt_meshopt_view *view, const unsigned char *packed, unsigned char *bytes,
	const char *pointer, nt_error *error)
{
	const nt_meshopt_table *meshopt = nt_module_opened(NT_MODULE_MESHOPT); /* the view was checked */
	return meshopt->unpack(view, packed, bytes, pointer, error);
}

nt_status nt_meshopt_filter(const nt_meshopt_view *view, unsigned char *bytes, const char *pointer, nt_error *error)
{
	const nt_meshopt_table *meshopt = nt_module_opened(NT_MODULE_MESHOPT);
	return meshopt->filter(view, bytes, pointer, error);
}

nt_status nt_meshopt_pack(const nt_meshopt_view *view, const unsigned char *bytes, unsigned char **packed,
	size_t *size, nt_error *error)
{
	const nt_meshopt_table *meshopt = nt_module_opened(NT_MODULE_MESHOPT);
	return meshopt->pack(view, bytes, packed, size, error);
}
