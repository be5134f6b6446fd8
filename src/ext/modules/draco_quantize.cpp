// SPDX-License-Identifier: MIT
//
// What quantization makes of the values of a mesh, before it is encoded: for who computes something from what a decoder
// will have.
#include "ext/modules/draco_parts.hpp"
#include "ext/modules/guard.hpp"

#include <cstring>

static nt_status quantize(const nt_draco_mesh &mesh, float *const *values, nt_error *error)
{
	const nt_status status = nt::check_mesh(mesh, error);
	if (status != NT_OK)
		return status;
	std::vector<uint32_t> numbers;
	const std::vector<uint32_t> sources = nt::compact(mesh, numbers);
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nt_draco_attribute &a = mesh.attributes[i];
		if (!values[i])
			continue;
		draco::Mesh alone;
		alone.set_num_points(static_cast<uint32_t>(sources.size()));
		nt::add_attribute(alone, a, sources);
		const auto back = nt::expected_values(*alone.attribute(0), a, sources.size());
		if (back.empty())
			return nt_fail(error, NT_ERROR_INTERNAL, "Draco cannot quantize attribute %u", a.unique_id);
		const size_t components = static_cast<size_t>(a.components), width = sizeof(float) * components;
		for (size_t p = 0; p < mesh.point_count && sources.size() < mesh.point_count; p++)
			std::memmove(values[i] + components * p, nt::value_of(a, p), width);
		for (size_t p = 0; p < sources.size(); p++)
			std::memcpy(values[i] + components * sources[p], back.data() + width * p, width);
	}
	return NT_OK;
}

nt_status nt::quantize_draco(const nt_draco_mesh *mesh, float *const *values, nt_error *error)
{
	return nt::guard(error, "Draco", [&] { return quantize(*mesh, values, error); });
}
