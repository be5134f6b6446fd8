// SPDX-License-Identifier: MIT
//
// tinygltf does not know that a decoder brings what compressed documents leave out. It refuses primitives whose
// indices have no buffer view, which is how Draco has them, and buffers without bytes, which is what views packed by
// meshoptimizer are said to lie in. It gets a text without the former and with a byte for the latter. Nor does its
// parser take numbers beyond double, which extras may have: it gets zeros. And 8.0 is no integer to it, though it is
// one to JSON and glTF: it gets 8.
#include "ext/modules/tinygltf_text.hpp"
#include "ext/linked.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace {

using json = nlohmann::ordered_json;

constexpr char draco_extension[] = "KHR_draco_mesh_compression";
const char *const packings[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

uint32_t little_endian(const unsigned char *bytes)
{
	return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
		static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

void put_little_endian(std::string &out, uint32_t value)
{
	for (int shift = 0; shift < 32; shift += 8)
		out += static_cast<char>(value >> shift & 0xff);
}

// A member of an object; null where there is none.
const json *member(const json &object, const char *name)
{
	const auto found = object.is_object() ? object.find(name) : object.end();
	return found == object.end() ? nullptr : &*found;
}

// meshoptimizer's extension of a buffer; null where there is none.
const json *packing_of(const json &object)
{
	const json *extensions = member(object, "extensions");
	for (const char *name : packings)
		if (const json *found = extensions ? member(*extensions, name) : nullptr)
			return found;
	return nullptr;
}

// The closing quote of the string that begins at `at`, or the end.
size_t skip_string(const char *text, size_t size, size_t at)
{
	for (at++; at < size && text[at] != '"'; at++)
		at += text[at] == '\\';
	return at;
}

// Finds the beginning and the end of the next number from `at` on; false: there is none.
bool find_number(const char *text, size_t size, size_t at, size_t *begin, size_t *end)
{
	for (; at < size; at++) {
		if (text[at] == '"') {
			at = skip_string(text, size, at);
		} else if (text[at] == '-' || (text[at] >= '0' && text[at] <= '9')) {
			*begin = at;
			while (at < size && text[at] && std::strchr("+-.0123456789eE", text[at]))
				at++;
			*end = at;
			return true;
		}
	}
	return false;
}

// The text that the parser gets instead of a number; empty: the number as it stands.
std::string easier_number(const char *begin, const char *end)
{
	constexpr double exact = 9007199254740992; // up to here every integer is a double
	double value = 0;
	if (std::none_of(begin, end, [](char c) { return c == '.' || c == 'e' || c == 'E'; }) && end - begin < 300)
		return {};
	if (!nt_read_double(begin, end, &value))
		return {};
	if (std::isinf(value))
		return "0";
	if (value != std::floor(value) || std::fabs(value) > exact || (value == 0 && std::signbit(value)))
		return {};
	return std::to_string(static_cast<int64_t>(value));
}

// The text with easier numbers; empty: all are easy.
std::string ease_numbers(const char *text, size_t size)
{
	std::string eased;
	size_t begin, end = 0, copied = 0;
	while (find_number(text, size, end, &begin, &end)) {
		const std::string easier = easier_number(text + begin, text + end);
		if (easier.empty())
			continue;
		eased.append(text + copied, begin - copied).append(easier);
		copied = end;
	}
	return copied ? eased.append(text + copied, size - copied) : eased;
}

void drop_compressed_indices(json &document)
{
	if (!member(document, "meshes"))
		return;
	for (json &mesh : document["meshes"]) {
		if (!member(mesh, "primitives"))
			continue;
		for (json &primitive : mesh["primitives"]) {
			const json *extensions = member(primitive, "extensions");
			if (extensions && member(*extensions, draco_extension))
				primitive.erase("indices");
		}
	}
}

void fill_fallback_buffers(json &document, bool binary)
{
	if (!member(document, "buffers"))
		return;
	size_t index = 0;
	for (json &buffer : document["buffers"])
		if (!(index++ == 0 && binary) && packing_of(buffer) && !member(buffer, "uri"))
			buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
}

} // namespace

nt::gltf_text::gltf_text(const unsigned char *file, size_t file_size)
	: bytes(reinterpret_cast<const char *>(file)), text(bytes), size(file_size), text_size(file_size),
	  binary(file_size >= 20 && std::memcmp(file, "glTF", 4) == 0)
{
	if (binary) {
		text += 20;
		text_size = std::min<size_t>(little_endian(file + 12), size - 20);
	}
}

bool nt::gltf_text::is_too_deep() const
{
	int depth = 0;
	for (size_t i = 0; i < text_size; i++) {
		const char c = text[i];
		if (c == '"') {
			i = skip_string(text, text_size, i);
		} else if (c == '[' || c == '{') {
			if (++depth > max_depth)
				return true;
		} else if (c == ']' || c == '}') {
			depth--;
		}
	}
	return false;
}

std::string nt::gltf_text::with(std::string changed) const
{
	if (!binary)
		return changed;
	changed.append(-changed.size() & 3, ' ');
	const size_t rest = size - 20 - text_size;
	std::string out(bytes, 8);
	put_little_endian(out, static_cast<uint32_t>(20 + changed.size() + rest));
	put_little_endian(out, static_cast<uint32_t>(changed.size()));
	out.append(bytes + 16, 4);
	out += changed;
	return out.append(bytes + 20 + text_size, rest);
}

std::string nt::gltf_text::eased() const
{
	const std::string easy = ease_numbers(text, text_size);
	const char *const from = easy.empty() ? text : easy.data();
	const size_t length = easy.empty() ? text_size : easy.size();
	const auto has = [&](const char *word) { return memmem(from, length, word, std::strlen(word)) != nullptr; };
	if (!has(draco_extension) && !has(packings[0]) && !has(packings[1]))
		return easy.empty() ? easy : with(easy);
	json document = json::parse(from, from + length, nullptr, false);
	if (!document.is_object()) // tinygltf says what it is
		return {};
	drop_compressed_indices(document);
	fill_fallback_buffers(document, binary);
	return with(document.dump());
}
