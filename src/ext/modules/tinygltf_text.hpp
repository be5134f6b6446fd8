// SPDX-License-Identifier: MIT
//
// The text of a document as tinygltf can read it.
#ifndef NT_EXT_MODULES_TINYGLTF_TEXT_HPP
#define NT_EXT_MODULES_TINYGLTF_TEXT_HPP

#include <cstddef>
#include <string>

namespace nt {

class gltf_text {
public:
	static constexpr int max_depth = 512;

	// A .glb or .gltf, which must stay.
	gltf_text(const unsigned char *bytes, size_t size);

	bool is_binary() const { return binary; }

	// Whether arrays and objects are nested deeper than max_depth, counted outside of strings. Whether the text
	// is JSON at all is not decided here.
	bool is_too_deep() const;

	// The file without what tinygltf refuses although it is legal; empty where it can stay as it is.
	std::string eased() const;

private:
	std::string with(std::string changed) const; // the file with another text

	const char *bytes, *text; // the text is all of a .gltf, and the JSON chunk of a .glb
	size_t size, text_size;
	bool binary;
};

} // namespace nt

#endif
