/* SPDX-License-Identifier: MIT */
/*
 * make_meshopt FILE.glb: a unit quad whose attributes and indices are packed by meshoptimizer, with a material that
 * needs tangents.
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
	static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
	static const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	static const float texcoords[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
	static const unsigned indices[6] = {0, 1, 2, 0, 2, 3};
	size_t at[5] = {0};
	add(positions, 4, 12);
	at[1] = used;
	add(normals, 4, 12);
	at[2] = used;
	add(texcoords, 4, 8);
	at[3] = used;
	used += meshopt_encodeIndexSequence(chunk + used, sizeof chunk - used, indices, 6);
	at[4] = used;
	used = (used + 3) / 4 * 4;

	static const struct {
		size_t offset, size, stride, count;
		const char *mode;
	} views[4] = {{0, 48, 12, 4, "ATTRIBUTES"}, {48, 48, 12, 4, "ATTRIBUTES"}, {96, 32, 8, 4, "ATTRIBUTES"},
		{128, 24, 4, 6, "INDICES"}};
	char json[8192];
	int length = snprintf(json, sizeof json, "{\"asset\":{\"version\":\"2.0\"},"
		"\"extensionsUsed\":[\"EXT_meshopt_compression\"],\"extensionsRequired\":[\"EXT_meshopt_compression\"],"
		"\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":152,\"extensions\":"
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
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4,\"min\":[0,0,0],"
		"\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4},"
		"{\"bufferView\":2,\"componentType\":5126,\"type\":\"VEC2\",\"count\":4},"
		"{\"bufferView\":3,\"componentType\":5125,\"type\":\"SCALAR\",\"count\":6}],"
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
