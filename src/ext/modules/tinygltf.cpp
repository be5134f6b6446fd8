// SPDX-License-Identifier: MIT
//
// tinygltf behind a C header: its loader, as a second opinion on files that we wrote. It searches the current
// directory, decodes images, overflows its stack on deep JSON and knows no compression: so it gets its files through
// callbacks, an image loader that does nothing and text made for it (tinygltf_text.cpp).
#include "ext/modules/guard.hpp"
#include "ext/modules/tinygltf_text.hpp"
#include "ext/tables.h"

#include <cstring>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace {

const char library[] = "tinygltf";

struct finder {
	nt_tinygltf_find find;
	void *user;

	// tinygltf asks for "./name" after "name".
	bool operator()(const std::string &name, const unsigned char **bytes, size_t *size) const
	{
		return find && find(user, name.c_str(), bytes, size);
	}
};

bool file_exists(const std::string &name, void *user)
{
	const unsigned char *bytes;
	size_t size;
	return (*static_cast<const finder *>(user))(name, &bytes, &size);
}

std::string same_path(const std::string &name, void *)
{
	return name;
}

bool read_file(std::vector<unsigned char> *out, std::string *message, const std::string &name,
	void *user)
{
	const unsigned char *bytes;
	size_t size;
	if (!(*static_cast<const finder *>(user))(name, &bytes, &size)) {
		*message += "not found";
		return false;
	}
	out->assign(bytes, bytes + size);
	return true;
}

bool write_nothing(std::string *, const std::string &, const std::vector<unsigned char> &, void *)
{
	return false;
}

bool decode_nothing(tinygltf::Image *, int, std::string *, std::string *, int, int,
	const unsigned char *, int, void *)
{
	return true;
}

nt_status load(const unsigned char *bytes, size_t size, finder files, nt_error *error)
{
	const nt::gltf_text text(bytes, size);
	if (text.is_too_deep())
		return nt_fail(error, NT_ERROR_INPUT, "JSON is nested deeper than %d levels",
			nt::gltf_text::max_depth);
	if (size > 0xffffffffu)
		return nt_fail(error, NT_ERROR_UNSUPPORTED,
			"tinygltf cannot read a file of %zu bytes back, the limit is 4294967295", size);

	tinygltf::Model document;
	tinygltf::TinyGLTF loader;
	loader.SetImageLoader(decode_nothing, nullptr);
	loader.SetFsCallbacks({file_exists, same_path, read_file, write_nothing, &files});
	std::string message, warning;
	const std::string eased = text.eased();
	const char *begin = eased.empty() ? reinterpret_cast<const char *>(bytes) : eased.data();
	const unsigned length = static_cast<unsigned>(eased.empty() ? size : eased.size());
	bool loaded = false;
	try {
		loaded = text.is_binary()
			? loader.LoadBinaryFromMemory(&document, &message, &warning,
				reinterpret_cast<const unsigned char *>(begin), length)
			: loader.LoadASCIIFromString(&document, &message, &warning, begin, length, "");
	} catch (const std::bad_alloc &) {
		throw;
	} catch (const std::exception &thrown) { // it looks for some things behind the end of their array
		message = thrown.what();
	}
	if (loaded && message.empty())
		return NT_OK;
	for (char &c : message)
		c = c == '\n' ? ' ' : c;
	return nt_fail(error, NT_ERROR_INPUT, "tinygltf refuses the document: %s", message.c_str());
}

} // namespace

static nt_status accept(const unsigned char *bytes, size_t size, nt_tinygltf_find find, void *user, nt_error *error)
{
	return nt::guard(error, library, [&] { return load(bytes, size, {find, user}, error); });
}

const nt_tinygltf_table nt_tinygltf_module = {NT_MODULE_HEAD(nt_tinygltf_table, "tinygltf", nullptr, "MIT",
	&nt::cxx), accept};
