// SPDX-License-Identifier: MIT
//
// Memory for C++ libraries when there is none left. What they do then cannot be relied on: destructors allocate
// (nlohmann's) and end the process when that fails, streams swallow the failure and lose text, assertions meet
// half-made values. So while a `reserve` is in scope, an allocation that malloc refuses comes from a block that the
// process has from its start, and the scope remembers that it was needed: its owner lets the library come to its end
// and reports NT_ERROR_MEMORY then. Only when the block is used up is bad_alloc thrown; a part of it is kept
// for what runs meanwhile.
#ifndef NT_EXT_RESERVE_HPP
#define NT_EXT_RESERVE_HPP

namespace nt {

// Scopes nest, each within one thread.
class reserve {
public:
	reserve() noexcept;
	~reserve();
	reserve(const reserve &) = delete;
	reserve &operator=(const reserve &) = delete;

	// Whether malloc refused anything in this thread since the outermost scope began.
	bool was_needed() const noexcept;
};

} // namespace nt

#endif
