/* SPDX-License-Identifier: MIT */
/*
 * The function of tinygltf.h: it is in the module.
 */
#include "ext/tinygltf.h"

#include "ext/module.h"
#include "ext/tables.h"

nt_status nt_tinygltf_accept(const unsigned char *bytes, size_t size, nt_tinygltf_find find, void *user,
	nt_error *error)
{
	nt_status status;
	const nt_tinygltf_table *tinygltf = nt_module_open(NT_MODULE_TINYGLTF, &status, error);
	return tinygltf ? tinygltf->accept(bytes, size, find, user, error) : status;
}
