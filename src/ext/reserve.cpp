// SPDX-License-Identifier: MIT
//
// The operators new and delete of the whole program: see module.h. They are the program's, not a module's, so that
// all C++ libraries use them, in whatever order modules are opened. The program itself has no C++ library: what
// takes one is asked of the module that brings it.
//
// The block is a stack of pieces that is empty again when all of them are freed: what is taken from it is needed
// shortly, by one call into a library that will be reported as failed.
#include "ext/module.h"

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

// Address space: pages that are not used are not there. Destroying during unwinding needs more: nlohmann's destructors
// list the members of what they destroy, 16 bytes each, in a vector that doubles.
constexpr size_t reserve_bytes = size_t(32) << 20, kept_for_unwinding = size_t(28) << 20;
constexpr size_t alignment = alignof(std::max_align_t);

alignas(alignment) unsigned char block[reserve_bytes];
size_t top;   // bytes in use, holes included
size_t alive; // pieces
std::atomic_flag busy = ATOMIC_FLAG_INIT;

thread_local unsigned depth;
thread_local bool needed;

std::atomic<const nt_cxx *> runtime;
void (*end_exhausted)() = std::abort;

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
	const nt_cxx *cxx = runtime.load(std::memory_order_acquire);
	const size_t most = cxx && cxx->is_unwinding() ? reserve_bytes : reserve_bytes - kept_for_unwinding;
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

void *allocate(size_t size) noexcept
{
	void *memory = std::malloc(size ? size : 1);
	if (!memory && depth) {
		needed = true;
		memory = take(size);
	}
	return memory;
}

// ---- the end ----

void end_if_exhausted(bool of_bad_alloc)
{
	if (of_bad_alloc || (depth && needed))
		end_exhausted();
}

// An assertion in a library. The handler gone, abort() does what it would have done.
void on_abort(int)
{
	end_if_exhausted(false);
	std::signal(SIGABRT, SIG_DFL);
}

} // namespace

void nt_on_exhausted(void (*end)(void))
{
	end_exhausted = end;
	std::signal(SIGABRT, on_abort);
}

void nt_reserve_serve(const nt_cxx *cxx)
{
	const nt_cxx *none = nullptr;
	if (runtime.compare_exchange_strong(none, cxx, std::memory_order_acq_rel))
		cxx->on_terminate(end_if_exhausted);
}

void nt_reserve_begin()
{
	if (depth++ == 0)
		needed = false;
}

void nt_reserve_end()
{
	depth--;
}

bool nt_reserve_was_needed()
{
	return needed;
}

void *operator new(size_t size)
{
	void *memory = allocate(size);
	if (memory)
		return memory;
	if (const nt_cxx *cxx = runtime.load(std::memory_order_acquire))
		cxx->throw_bad_alloc();
	end_exhausted(); // in a constructor of a library, while its module is opened
	__builtin_unreachable();
}

void *operator new[](size_t size)
{
	return operator new(size);
}

/* std::stable_sort() asks for its buffer in this way and gives it back by the delete below. */
void *operator new(size_t size, const std::nothrow_t &) noexcept
{
	return allocate(size);
}

void *operator new[](size_t size, const std::nothrow_t &) noexcept
{
	return allocate(size);
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
