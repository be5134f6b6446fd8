/* SPDX-License-Identifier: MIT */
/*
 * make_meshopt FILE.glb: two unit quads that mirror each other's texture coordinates, so that two vertices are split.
 * Attributes and indices are packed by meshoptimizer, normals by the octahedral filter. The material needs tangents.
 */
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned char chunk[4096];
static size_t used;

static size_t add(const void *values, size_t count, size_t stride)
{
	const size_t size = meshopt_encodeVertexBuffer(chunk + used, sizeof chunk - used, values, count, stride);
	used += size;
	return size;
}

int main(int count, char **arguments)
{
	static const float positions[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
	static const signed char normals[6][4] = {{0, 0, 127}, {0, 0, 127}, {0, 0, 127}, {0, 0, 127}, {0, 0, 127},
		{0, 0, 127}};
	static const float texcoords[6][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}};
	static const unsigned indices[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
	size_t at[5] = {0};
	add(positions, 6, 12);
	at[1] = used;
	add(normals, 6, 4);
	at[2] = used;
	add(texcoords, 6, 8);
	at[3] = used;
	meshopt_encodeIndexVersion(1);
	used += meshopt_encodeIndexBuffer(chunk + used, sizeof chunk - used, indices, 12);
	at[4] = used;
	used = (used + 3) / 4 * 4;

	static const struct {
		size_t offset, size, stride, count;
		const char *mode;
	} views[4] = {{0, 72, 12, 6, "ATTRIBUTES"}, {72, 24, 4, 6, "ATTRIBUTES\",\"filter\":\"OCTAHEDRAL"},
		{96, 48, 8, 6, "ATTRIBUTES"}, {144, 24, 2, 12, "TRIANGLES"}};
	char json[8192];
	int length = snprintf(json, sizeof json, "{\"asset\":{\"version\":\"2.0\"},"
		"\"extensionsUsed\":[\"EXT_meshopt_compression\",\"KHR_mesh_quantization\"],"
		"\"extensionsRequired\":[\"EXT_meshopt_compression\",\"KHR_mesh_quantization\"],"
		"\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":168,\"extensions\":"
		"{\"EXT_meshopt_compression\":{\"fallback\":true}}}],\"bufferViews\":[", used);
	for (int i = 0; i < 4; i++) {
		char stride[40] = "";
		if (i < 3)
			snprintf(stride, sizeof stride, "\"byteStride\":%zu,", views[i].stride);
		length += snprintf(json + length, sizeof json - (size_t)length, "%s{\"buffer\":1,\"byteOffset\":%zu,"
			"\"byteLength\":%zu,%s\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"
			"\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,\"mode\":\"%s\"}}}",
			i ? "," : "", views[i].offset, views[i].size, stride, at[i], at[i + 1] - at[i], views[i].stride,
			views[i].count, views[i].mode);
	}
	length += snprintf(json + length, sizeof json - (size_t)length, "],\"accessors\":["
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":6,\"min\":[0,0,0],"
		"\"max\":[2,1,0]},{\"bufferView\":1,\"componentType\":5120,\"normalized\":true,\"type\":\"VEC3\","
		"\"count\":6},{\"bufferView\":2,\"componentType\":5126,\"type\":\"VEC2\",\"count\":6},"
		"{\"bufferView\":3,\"componentType\":5123,\"type\":\"SCALAR\",\"count\":12}],"
		"\"images\":[{\"uri\":\"bumps.png\"}],\"textures\":[{\"source\":0}],"
		"\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
		"\"indices\":3,\"material\":0}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}");
	while (length % 4)
		json[length++] = ' ';

	FILE *f = count == 2 ? fopen(arguments[1], "wb") : NULL;
	if (!f)
		return 2;
	const unsigned head[5] = {0x46546c67, 2, (unsigned)(12 + 8 + (size_t)length + 8 + used), (unsigned)length,
		0x4e4f534a};
	const unsigned bin[2] = {(unsigned)used, 0x004e4942};
	fwrite(head, sizeof head, 1, f);
	fwrite(json, (size_t)length, 1, f);
	fwrite(bin, sizeof bin, 1, f);
	fwrite(chunk, used, 1, f);
	return fclose(f) ? 2 : 0;
}
