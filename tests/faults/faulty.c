/* SPDX-License-Identifier: MIT */
/*
 * Preloaded into the tool: the n-th allocation, whoever makes it, or the n-th system call that the tool itself
 * makes, fails. Counting begins with main(), since what fails before it is the loader's and the C++ libraries'
 * affair; so is what the loader allocates while it opens a module, without which it may end the process:
 * the tool asks for as much before. NT_FAULTY_FILE in the environment names a file that sweep.py and this map;
 * NT_FAULTY_TRACE shows where the fault hits.
 */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

typedef enum faulty_kind {
	FAULTY_MEMORY,
	FAULTY_CALLS,
	FAULTY_SHORTEN /* the n-th system call succeeds, but a file has become empty before it */
} faulty_kind;

/* As sweep.py packs it. */
typedef struct faulty {
	faulty_kind kind;
	size_t target; /* the number of the call that fails, from 0; SIZE_MAX: none */
	bool onwards;  /* and of all later ones */
	int number;    /* errno, of FAULTY_CALLS */
	char shortened[512]; /* the file, of FAULTY_SHORTEN */
	size_t count;  /* calls seen so far */
	bool fired;
	char name[32]; /* of the function that failed first */
} faulty;

static faulty *shared;
static bool armed;
static __thread bool loading __attribute__((tls_model("initial-exec")));

static void trace(const char *name)
{
	void *frames[30];
	armed = false;
	if (write(2, name, strlen(name)) > 0 && write(2, " fails in\n", 10) > 0)
		backtrace_symbols_fd(frames, backtrace(frames, 30), 2);
	armed = true;
}

static bool fails(faulty_kind kind, const char *name)
{
	if (!armed || loading || (shared->kind != kind && !(shared->kind == FAULTY_SHORTEN && kind == FAULTY_CALLS)))
		return false;
	const size_t number = __atomic_fetch_add(&shared->count, 1, __ATOMIC_RELAXED);
	if (number < shared->target || (number > shared->target && !shared->onwards))
		return false;
	if (!shared->fired) {
		shared->fired = true;
		strncpy(shared->name, name, sizeof shared->name - 1);
		if (getenv("NT_FAULTY_TRACE"))
			trace(name);
	}
	if (shared->kind == FAULTY_SHORTEN) {
		const int kept = errno;
		if (truncate(shared->shortened, 0) != 0)
			_exit(70);
		errno = kept;
		return false;
	}
	errno = kind == FAULTY_MEMORY ? ENOMEM : shared->number;
	return true;
}

/* ---- memory ---- */

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
	return fails(FAULTY_MEMORY, "malloc") ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
	return fails(FAULTY_MEMORY, "calloc") ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
	return fails(FAULTY_MEMORY, "realloc") ? NULL : __libc_realloc(block, size);
}

void *memalign(size_t alignment, size_t size)
{
	return fails(FAULTY_MEMORY, "memalign") ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
	return fails(FAULTY_MEMORY, "aligned_alloc") ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
	if (fails(FAULTY_MEMORY, "posix_memalign"))
		return ENOMEM;
	*block = __libc_memalign(alignment, size);
	return *block ? 0 : ENOMEM;
}

/* ---- system calls ---- */

#define REAL(name) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))

/* A function that the tool calls: it fails, or the real one runs. */
#define WATCH(type, name, parameters, arguments) \
	type name parameters \
	{ \
		return fails(FAULTY_CALLS, #name) ? (type)-1 : REAL(name) arguments; \
	}

int open(const char *path, int flags, ...)
{
	va_list list;
	va_start(list, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
	va_end(list);
	return fails(FAULTY_CALLS, "open") ? -1 : REAL(open)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
	va_list list;
	va_start(list, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
	va_end(list);
	return fails(FAULTY_CALLS, "openat") ? -1 : REAL(openat)(folder, path, flags, mode);
}

void *mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset)
{
	return fails(FAULTY_CALLS, "mmap") ? MAP_FAILED : REAL(mmap)(address, size, protection, flags, fd, offset);
}

WATCH(int, stat, (const char *path, struct stat *info), (path, info))
WATCH(int, lstat, (const char *path, struct stat *info), (path, info))
WATCH(int, fstat, (int fd, struct stat *info), (fd, info))
WATCH(int, access, (const char *path, int mode), (path, mode))
WATCH(ssize_t, readlink, (const char *path, char *text, size_t size), (path, text, size))
WATCH(ssize_t, read, (int fd, void *bytes, size_t size), (fd, bytes, size))
WATCH(ssize_t, pread, (int fd, void *bytes, size_t size, off_t offset), (fd, bytes, size, offset))
WATCH(ssize_t, write, (int fd, const void *bytes, size_t size), (fd, bytes, size))
WATCH(ssize_t, writev, (int fd, const struct iovec *pieces, int count), (fd, pieces, count))
WATCH(ssize_t, pwritev, (int fd, const struct iovec *pieces, int count, off_t offset), (fd, pieces, count, offset))
WATCH(off_t, lseek, (int fd, off_t offset, int whence), (fd, offset, whence))
WATCH(int, madvise, (void *address, size_t size, int advice), (address, size, advice))
WATCH(int, munmap, (void *address, size_t size), (address, size))
WATCH(int, ftruncate, (int fd, off_t size), (fd, size))
WATCH(int, fallocate, (int fd, int mode, off_t offset, off_t size), (fd, mode, offset, size))
WATCH(int, fsync, (int fd), (fd))
WATCH(int, fchmod, (int fd, mode_t mode), (fd, mode))
WATCH(int, rename, (const char *from, const char *to), (from, to))
WATCH(int, renameat2, (int a, const char *from, int b, const char *to, unsigned flags), (a, from, b, to, flags))
WATCH(int, link, (const char *from, const char *to), (from, to))
WATCH(int, mkdir, (const char *path, mode_t mode), (path, mode))

int close(int fd)
{
	const int result = REAL(close)(fd); /* it is closed whatever close() says */
	return fails(FAULTY_CALLS, "close") ? -1 : result;
}

void *dlopen(const char *path, int flags)
{
	loading = true;
	void *handle = REAL(dlopen)(path, flags);
	loading = false;
	return handle;
}

/* ---- from main on ---- */

typedef int main_function(int, char **, char **);
static main_function *real_main;

static int watched_main(int count, char **arguments, char **environment)
{
	const char *path = getenv("NT_FAULTY_FILE");
	const int fd = path ? open(path, O_RDWR) : -1;
	if (fd >= 0)
		shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
	if (!shared || shared == MAP_FAILED)
		_exit(70);
	close(fd);
	alarm(300);
	void *frame;
	if (getenv("NT_FAULTY_TRACE"))
		(void)backtrace(&frame, 1); /* loads what it needs */
	armed = true;
	const int code = real_main(count, arguments, environment);
	return code;
}

int __libc_start_main(main_function *main, int count, char **arguments, void (*init)(void), void (*fini)(void),
	void (*loader)(void), void *stack);

int __libc_start_main(main_function *main, int count, char **arguments, void (*init)(void), void (*fini)(void),
	void (*loader)(void), void *stack)
{
	real_main = main;
	__typeof__(__libc_start_main) *real = (__typeof__(__libc_start_main) *)dlsym(RTLD_NEXT, "__libc_start_main");
	return real(watched_main, count, arguments, init, fini, loader, stack);
}
