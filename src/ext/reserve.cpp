// SPDX-License-Identifier: MIT
//
// The operators new and delete of the whole program: see reserve.hpp. The linker lets C++ libraries use them too.
//
// The block is a stack of pieces that is empty again when all of them are freed: what is taken from it is needed
// shortly, by one call into a library that will be reported as failed.
#include "ext/reserve.hpp"
#include "ext/exhausted.h"

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>

namespace {

// Address space: pages that are not used are not there. What unwinding destroys needs the more: nlohmann's destructors
// list the members of what they destroy, 16 bytes each, in a vector that doubles.
constexpr size_t reserve_bytes = size_t(32) << 20, kept_for_unwinding = size_t(28) << 20;
constexpr size_t alignment = alignof(std::max_align_t);

alignas(alignment) unsigned char block[reserve_bytes];
size_t top;   // bytes in use, holes included
size_t alive; // pieces
std::atomic_flag busy = ATOMIC_FLAG_INIT;

thread_local unsigned depth;
thread_local bool needed;

class lock {
public:
	lock()
	{
		while (busy.test_and_set(std::memory_order_acquire))
			continue;
	}
	~lock()
	{
		busy.clear(std::memory_order_release);
	}
};

bool is_inside(const void *memory)
{
	const auto at = reinterpret_cast<uintptr_t>(memory), begin = reinterpret_cast<uintptr_t>(block);
	return at >= begin && at < begin + reserve_bytes;
}

void *take(size_t size) noexcept
{
	const size_t most = std::uncaught_exceptions() ? reserve_bytes : reserve_bytes - kept_for_unwinding;
	if (size > most)
		return nullptr;
	size = size ? (size + alignment - 1) / alignment * alignment : alignment;
	const lock held;
	if (top > most || size > most - top)
		return nullptr;
	void *memory = block + top;
	top += size;
	alive++;
	return memory;
}

void give_back() noexcept
{
	const lock held;
	if (--alive == 0)
		top = 0;
}

// ---- the end ----

void (*end_exhausted)();
std::terminate_handler usual_end;

bool is_exhausted() noexcept
{
	if (depth && needed)
		return true;
	if (std::current_exception())
		try {
			throw;
		} catch (const std::bad_alloc &) {
			return true;
		} catch (...) {
		}
	return false;
}

void on_terminate()
{
	if (is_exhausted())
		end_exhausted();
	usual_end();
}

// An assertion in a library. The handler gone, abort() does what it would have done.
void on_abort(int)
{
	if (depth && needed)
		end_exhausted();
	std::signal(SIGABRT, SIG_DFL);
}

} // namespace

void nt_on_exhausted(void (*end)(void))
{
	end_exhausted = end;
	usual_end = std::set_terminate(on_terminate);
	std::signal(SIGABRT, on_abort);
}

nt::reserve::reserve() noexcept
{
	if (depth++ == 0)
		needed = false;
}

nt::reserve::~reserve()
{
	depth--;
}

bool nt::reserve::was_needed() const noexcept
{
	return needed;
}

void *operator new(size_t size)
{
	void *memory = std::malloc(size ? size : 1);
	if (!memory && depth) {
		needed = true;
		memory = take(size);
	}
	if (!memory)
		throw std::bad_alloc();
	return memory;
}

void *operator new[](size_t size)
{
	return operator new(size);
}

/* std::stable_sort() asks for its buffer in this way and gives it back by the delete below. */
void *operator new(size_t size, const std::nothrow_t &) noexcept
{
	try {
		return operator new(size);
	} catch (const std::bad_alloc &) {
		return nullptr;
	}
}

void *operator new[](size_t size, const std::nothrow_t &nothrow) noexcept
{
	return operator new(size, nothrow);
}

void operator delete(void *memory) noexcept
{
	if (is_inside(memory))
		give_back();
	else
		std::free(memory);
}

void operator delete[](void *memory) noexcept
{
	operator delete(memory);
}

void operator delete(void *memory, size_t) noexcept
{
	operator delete(memory);
}

void operator delete[](void *memory, size_t) noexcept
{
	operator delete(memory);
}

void operator delete(void *memory, const std::nothrow_t &) noexcept
{
	operator delete(memory);
}

void operator delete[](void *memory, const std::nothrow_t &) noexcept
{
	operator delete(memory);
}
