/* SPDX-License-Identifier: MIT */
#include "ext/draco.h"
#include "gltf/load.h"
#include "test.h"

/* w is -1 or 1 in every file, and bytes of 1 say so to every decoder. */
TEST(the_grid_of_tangents_has_both_signs)
{
	static const float tangents[3][4] = {{1, 0, 0, 1}, {0, -1, 0, -1}, {0.6f, 0, -0.8f, 1}};
	static const uint32_t face[3] = {0, 1, 2};
	for (int bits = 2; bits <= 24; bits++) {
		const int choice[NT_DRACO_BITS_COUNT] = {0, 0, 0, bits};
		const nt_draco_quantization grid = nt_gltf_draco_tangent_grid(NULL, choice);
		const nt_draco_attribute attribute = {.kind = NT_DRACO_GENERIC, .component_type = NT_GLTF_FLOAT,
			.components = 4, .quantization = grid, .data = tangents};
		const nt_draco_mesh mesh = {.point_count = 3, .face_count = 1, .indices = face,
			.attributes = &attribute, .attribute_count = 1};
		float decoded[3][4], *values = decoded[0];
		assert_int_equal(nt_draco_quantize(&mesh, &values, NULL), NT_OK);
		assert_true(decoded[0][3] == 1 && decoded[1][3] == -1 && decoded[0][0] == 1 && decoded[1][1] == -1);
		/* it stays the next time; one that begins beside -1 does not, but for its bits */
		nt_draco_quantization source = grid, next = nt_gltf_draco_tangent_grid(&source, choice);
		assert_true(next.bits == grid.bits && next.range == grid.range && next.origin[0] == grid.origin[0]);
		source.origin[3] = -0.99f;
		source.bits = 14;
		next = nt_gltf_draco_tangent_grid(&source, choice);
		assert_true(next.origin[3] == -1 && next.range == 2 && next.bits >= 14);
	}
}
