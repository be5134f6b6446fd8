/* SPDX-License-Identifier: MIT */
/*
 * Numbers of the glTF specification, for the wrappers in ext and for src/gltf.
 */
#ifndef NT_EXT_GLTF_NUMBERS_H
#define NT_EXT_GLTF_NUMBERS_H

/* Values of componentType. */
enum nt_gltf_component {
	NT_GLTF_BYTE = 5120,
	NT_GLTF_UBYTE = 5121,
	NT_GLTF_SHORT = 5122,
	NT_GLTF_USHORT = 5123,
	NT_GLTF_INT = 5124, /* not in glTF, but in Draco */
	NT_GLTF_UINT = 5125,
	NT_GLTF_FLOAT = 5126
};

/* Bytes of a component; 0: not a component type. */
static inline unsigned nt_component_size(int component_type)
{
	switch (component_type) {
	case NT_GLTF_BYTE:
	case NT_GLTF_UBYTE:
		return 1;
	case NT_GLTF_SHORT:
	case NT_GLTF_USHORT:
		return 2;
	case NT_GLTF_INT:
	case NT_GLTF_UINT:
	case NT_GLTF_FLOAT:
		return 4;
	default:
		return 0;
	}
}

/* Values of a view's target. */
enum nt_gltf_target {
	NT_GLTF_NO_TARGET = 0,
	NT_GLTF_ARRAY_BUFFER = 34962,
	NT_GLTF_ELEMENT_ARRAY_BUFFER = 34963
};

/* Values of a sampler's wrapS and wrapT that are not the default. */
enum nt_gltf_wrap { NT_GLTF_CLAMP_TO_EDGE = 33071, NT_GLTF_MIRRORED_REPEAT = 33648 };

/* Values of a primitive's mode that have faces. */
enum nt_gltf_mode { NT_GLTF_TRIANGLES = 4, NT_GLTF_STRIP = 5, NT_GLTF_FAN = 6 };

#endif
