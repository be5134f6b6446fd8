/* SPDX-License-Identifier: MIT */
/*
 * Extensions of gcc and clang to C11, by names that mean the same or nothing elsewhere: the compute library compiles
 * as C11 that has no extensions, as MSVC's, and as C++. NMTAN_PLAIN_C makes any compiler such a one.
 */
#ifndef NT_BASE_COMPILER_H
#define NT_BASE_COMPILER_H

#include <assert.h>
#include <stdint.h>

/* Hints, which change no results. */
#if defined(__GNUC__)
#define NT_ALWAYS_INLINE __attribute__((always_inline))
#define NT_NOINLINE __attribute__((noinline))
#define NT_RESTRICT __restrict
#define NT_PRAGMA(text) _Pragma(#text)
#define NT_UNROLL(times) NT_PRAGMA(GCC unroll times)
#elif defined(_MSC_VER)
#define NT_ALWAYS_INLINE __forceinline
#define NT_NOINLINE __declspec(noinline)
#define NT_RESTRICT __restrict
#define NT_UNROLL(times)
#else
#define NT_ALWAYS_INLINE
#define NT_NOINLINE
#define NT_RESTRICT
#define NT_UNROLL(times)
#endif

#if defined(__GNUC__) && !defined(NMTAN_PLAIN_C)
#define NT_PREFETCH(at) __builtin_prefetch(at)
#define NT_PREFETCH_TO_WRITE(at) __builtin_prefetch(at, 1)
#define NT_EXPECT(condition, value) __builtin_expect(condition, value)
#define NT_UNREACHABLE __builtin_unreachable()
#else
#define NT_PREFETCH(at) ((void)(at))
#define NT_PREFETCH_TO_WRITE(at) ((void)(at))
#define NT_EXPECT(condition, value) (condition)
#define NT_UNREACHABLE ((void)0)
#endif

/* Thread-local memory that is there from the start of each thread, of a module too: it cannot be missing later. */
#ifdef __ELF__
#define NT_STATIC_TLS __attribute__((tls_model("initial-exec")))
#else
#define NT_STATIC_TLS
#endif

#if defined(__BYTE_ORDER__) && defined(__ORDER_BIG_ENDIAN__)
#define NT_BIG_ENDIAN (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__)
#else
#define NT_BIG_ENDIAN 0
#endif

#if defined(__cplusplus)
#define NT_ALIGNED(bytes) alignas(bytes)
#else
#define NT_ALIGNED(bytes) _Alignas(bytes)
#endif

/* A pointer that converts to any type, in C++ too. */
#if defined(__cplusplus)
struct nt_memory {
	void *at;
	nt_memory(void *memory) : at(memory) {}
	template <class type> operator type *() const { return (type *)at; }
};
#else
typedef void *nt_memory;
#endif

/* Vectors: gcc from 12 on, and clang. Lanes are single values elsewhere, and compilers make of them what they can. */
#if defined(__has_builtin) && !defined(NMTAN_PLAIN_C)
#if __has_builtin(__builtin_shufflevector)
#define NT_VECTORS 1
#endif
#endif
#ifndef NT_VECTORS
#define NT_VECTORS 0
#endif

/* Owners of other threads: the pool's, or those of the caller's jobs. One thread needs no atomic operations, and
 * plain C has none that C++ has too. */
#if defined(NT_NO_THREADS) && !defined(NMTAN_JOBS)
#define NT_ONE_THREAD 1
#else
#define NT_ONE_THREAD 0
#endif
#if defined(__GNUC__) && !NT_ONE_THREAD
#define nt_atomic_load(from, order) __atomic_load_n(from, __ATOMIC_##order)
#define nt_atomic_store(to, value, order) __atomic_store_n(to, value, __ATOMIC_##order)
#define nt_atomic_add(to, value, order) __atomic_fetch_add(to, value, __ATOMIC_##order)
#define nt_atomic_sub(to, value, order) __atomic_fetch_sub(to, value, __ATOMIC_##order)
#define nt_atomic_or(to, value, order) __atomic_fetch_or(to, value, __ATOMIC_##order)
#elif NT_ONE_THREAD
#define nt_atomic_load(from, order) (*(from))
#define nt_atomic_store(to, value, order) ((void)(*(to) = (value)))
#define nt_atomic_add(to, value, order) ((*(to) += (value)) - (value))
#define nt_atomic_or(to, value, order) ((void)(*(to) |= (value)))
#else
#error "threads need gcc or clang"
#endif

/* How many zeros are below the lowest bit that is set; there is one. */
static inline int nt_trailing_zeros(uint64_t bits)
{
#if defined(__GNUC__) && !defined(NMTAN_PLAIN_C)
	return __builtin_ctzll(bits);
#else
	int count = 0;
	for (int half = 32; half > 0; half /= 2)
		if (!(bits & (((uint64_t)1 << half) - 1))) {
			bits >>= half;
			count += half;
		}
	return count;
#endif
}

static inline int nt_count_bits(uint64_t bits)
{
#if defined(__GNUC__) && !defined(NMTAN_PLAIN_C)
	return __builtin_popcountll(bits);
#else
	bits -= bits >> 1 & 0x5555555555555555u;
	bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
	return (int)(((bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
#endif
}

/* The product of two words: returns its lower half, and the upper one in `high`. Compilers for WebAssembly call a
 * function if a product has 128 bits. */
static inline uint64_t nt_multiply(uint64_t a, uint64_t b, uint64_t *high)
{
#if defined(__SIZEOF_INT128__) && !defined(NMTAN_PLAIN_C) && !defined(__wasm__)
	const unsigned __int128 product = (unsigned __int128)a * b;
	*high = (uint64_t)(product >> 64);
	return (uint64_t)product;
#else
	const uint64_t al = (uint32_t)a, ah = a >> 32, bl = (uint32_t)b, bh = b >> 32;
	const uint64_t low = al * bl, middle = ah * bl + (low >> 32), other = al * bh + (uint32_t)middle;
	*high = ah * bh + (middle >> 32) + (other >> 32);
	return other << 32 | (uint32_t)low;
#endif
}

#endif
