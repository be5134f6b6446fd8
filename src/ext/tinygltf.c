/* SPDX-License-Identifier: MIT */
/*
 * The functions of tinygltf.h: they are in the module.
 */
#include "ext/tinygltf.h"

#include "ext/module.h"
#include "ext/tables.h"

static const nt_tinygltf_table *opened(void)
{
	return nt_module_opened(NT_MODULE_TINYGLTF);
}

nt_status nt_reread_open(nt_reread **model, const unsigned char *bytes, size_t size, nt_reread_find find, void *user,
	nt_error *error)
{
	nt_status status;
	const nt_tinygltf_table *tinygltf = nt_module_open(NT_MODULE_TINYGLTF, &status, error);
	*model = NULL;
	return tinygltf ? tinygltf->open(model, bytes, size, find, user, error) : status;
}

void nt_reread_free(nt_reread *model)
{
	if (model)
		opened()->free(model);
}

size_t nt_reread_mesh_count(const nt_reread *model)
{
	return opened()->mesh_count(model);
}

size_t nt_reread_primitive_count(const nt_reread *model, size_t mesh)
{
	return opened()->primitive_count(model, mesh);
}

nt_status nt_reread_attribute(nt_reread *model, size_t mesh, size_t primitive, const char *name, nt_reread_array *array,
	nt_error *error)
{
	return opened()->attribute(model, mesh, primitive, name, array, error);
}

nt_status nt_reread_target(nt_reread *model, size_t mesh, size_t primitive, size_t target, const char *name,
	nt_reread_array *array, nt_error *error)
{
	return opened()->target(model, mesh, primitive, target, name, array, error);
}

nt_status nt_reread_block(nt_reread *model, size_t mesh, size_t primitive, bool *has_block, const unsigned char **bytes,
	size_t *size, nt_error *error)
{
	return opened()->block(model, mesh, primitive, has_block, bytes, size, error);
}

bool nt_reread_block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name, uint32_t *id)
{
	return opened()->block_id(model, mesh, primitive, name, id);
}
