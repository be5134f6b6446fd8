/* SPDX-License-Identifier: MIT */
/*
 * The functions of draco.h, meshopt.h, openmesh.h and tinygltf.h: they are in modules, which the first call opens.
 */
#include "ext/module.h"
#include "ext/tables.h"

nt_status nt_draco_decode(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	*result = NULL;
	return draco ? draco->decode(result, bytes, size, max_faces, error) : status;
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

nt_status nt_meshopt_check(const nt_meshopt_view *view, uint64_t size, const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->check(view, size, pointer, error) : status;
}

nt_status nt_meshopt_unpack(const nt_meshopt_view *view, const unsigned char *packed, unsigned char *bytes,
	const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->unpack(view, packed, bytes, pointer, error) : status;
}

nt_status nt_meshopt_filter(const nt_meshopt_view *view, unsigned char *bytes, const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->filter(view, bytes, pointer, error) : status;
}

nt_status nt_meshopt_pack(const nt_meshopt_view *view, const unsigned char *bytes, unsigned char **packed, size_t *size,
	nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->pack(view, bytes, packed, size, error) : status;
}

nt_status nt_walk_marked(const nt_walked_mesh *mesh, nt_walk_taker *take, void *context, size_t *left_out,
	nt_error *error)
{
	nt_status status;
	const nt_openmesh_table *openmesh = nt_module_open(NT_MODULE_OPENMESH, &status, error);
	return openmesh ? openmesh->walk(mesh, take, context, left_out, error) : status;
}

nt_status nt_tinygltf_accept(const unsigned char *bytes, size_t size, nt_tinygltf_find find, void *user,
	nt_error *error)
{
	nt_status status;
	const nt_tinygltf_table *tinygltf = nt_module_open(NT_MODULE_TINYGLTF, &status, error);
	return tinygltf ? tinygltf->accept(bytes, size, find, user, error) : status;
}
