// SPDX-License-Identifier: MIT
//
// What the program asks of the C++ library (module.h); each module with C++ has it.
#include "ext/modules/guard.hpp"

#include <exception>
#include <new>

// A thread's exceptions are in thread-local memory of the C++ library. The loader gives a library that is opened late
// such memory when a thread first asks for it, and ends the process where there is none. A thread-local variable that
// is referred to by its offset has its place from the start of each thread; so one of the library's variables is, and
// the rest lies beside it.
extern __thread void *with_fixed_offset __asm__("_ZSt15__once_callable") __attribute__((tls_model("initial-exec")));

namespace {

void (*look)(bool of_bad_alloc);
std::terminate_handler usual_end;

void throw_bad_alloc()
{
	throw std::bad_alloc();
}

bool is_unwinding()
{
	return std::uncaught_exceptions() > 0;
}

bool is_bad_alloc() noexcept
{
	if (std::current_exception())
		try {
			throw;
		} catch (const std::bad_alloc &) {
			return true;
		} catch (...) {
		}
	return false;
}

void end()
{
	look(is_bad_alloc());
	usual_end();
}

void on_terminate(void (*before)(bool of_bad_alloc))
{
	static_cast<void>(*static_cast<void *volatile *>(&with_fixed_offset));
	look = before;
	usual_end = std::set_terminate(end);
}

} // namespace

const nt_cxx nt::cxx = {throw_bad_alloc, is_unwinding, on_terminate};
