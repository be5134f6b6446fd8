/* SPDX-License-Identifier: MIT */
/*
 * The functions of draco.h: Draco's are in the module.
 */
#include "ext/draco.h"

#include "ext/module.h"
#include "ext/tables.h"

nt_status nt_draco_decode(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces,
	nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	*result = NULL;
	return draco ? draco->decode(result, bytes, size, max_faces, error) : status;
}

void nt_draco_free(nt_draco *result)
{
	if (result)
		((const nt_draco_table *)nt_module_opened(NT_MODULE_DRACO))->free(result);
}

const nt_draco_mesh *nt_draco_get(const nt_draco *result)
{
	return ((const nt_draco_table *)nt_module_opened(NT_MODULE_DRACO))->get(result);
}

nt_status nt_draco_encode(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	*block = (nt_draco_block){0};
	return draco ? draco->encode(mesh, block, error) : status;
}

nt_status nt_draco_quantize(const nt_draco_mesh *mesh, float *const *values, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	return draco ? draco->quantize(mesh, values, error) : status;
}

const nt_draco_attribute *nt_draco_find(const nt_draco_mesh *mesh, uint32_t unique_id)
{
	for (size_t i = 0; i < mesh->attribute_count; i++)
		if (mesh->attributes[i].unique_id == unique_id)
			return &mesh->attributes[i];
	return NULL;
}
