// SPDX-License-Identifier: MIT
//
// The module of Draco: its table.
#include "ext/modules/draco_parts.hpp"
#include "ext/modules/guard.hpp"
#include "ext/tables.h"

#include <draco/core/draco_version.h>

static const nt_draco_mesh *get(const nt_draco *result)
{
	return &result->mesh;
}

const nt_draco_table nt_draco_module = {NT_MODULE_HEAD(nt_draco_table, "Draco", draco::kDracoVersion,
	"Apache-2.0", &nt::cxx),
	nt::decode_checked, nt::free_decoded, get, nt::encode_draco, nt::quantize_draco};
