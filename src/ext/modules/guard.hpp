// SPDX-License-Identifier: MIT
//
// The door of every C++ wrapper. A wrapper's entry runs its body inside guard(), so that nothing is
// thrown past it: exhausted memory becomes NT_ERROR_MEMORY, everything else, which would be a
// mistake of ours or of the library behind the door, NT_ERROR_INTERNAL with the exception's words.
// Memory that runs out is not always thrown (see module.h), so the status may be NT_ERROR_MEMORY though the body
// came to its end: what it has made by then is the caller's to free.
#ifndef NT_EXT_MODULES_GUARD_HPP
#define NT_EXT_MODULES_GUARD_HPP

#include <exception>
#include <new>
#include <utility>
#include "base/text.h"
#include "ext/module.h"

namespace nt {

extern const nt_cxx cxx; // cxx.cpp

// The reserve, as long as it is in scope.
class reserve {
public:
	reserve() noexcept { nt_reserve_begin(); }
	~reserve() { nt_reserve_end(); }
	reserve(const reserve &) = delete;
	reserve &operator=(const reserve &) = delete;

	bool was_needed() const noexcept { return nt_reserve_was_needed(); }
};

// Runs body(), which returns a status, and returns that or the status of what it threw. error may be
// NULL; body fills it itself for the statuses it returns.
template <typename Body>
nt_status guard(nt_error *error, const char *library, Body &&body) noexcept
{
	const reserve memory;
	try {
		const nt_status status = std::forward<Body>(body)();
		return memory.was_needed() ? nt_fail_memory(error) : status;
	} catch (const std::bad_alloc &) {
		return nt_fail_memory(error);
	} catch (const std::exception &thrown) {
		return memory.was_needed()
			? nt_fail_memory(error) : nt_fail(error, NT_ERROR_INTERNAL, "%s: %s", library, thrown.what());
	} catch (...) {
		return nt_fail(error, NT_ERROR_INTERNAL, "%s: unknown exception", library);
	}
}

} // namespace nt

#endif
