// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
//
// To be preloaded: makes the n-th call of one kind in main() fail. The environment says which.
//   EXCAVPLAN_FAULT=write:3    the third write; write:3+ also all later ones
//   EXCAVPLAN_FAULT_SEEN=9     file descriptor that gets a byte when a call fails
// Kinds: open, read, write, fsync, rename, close, mkdir, thread, malloc. What the C library does
// inside, as for standard output, is not reached; writes to standard error do not count.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

char kind[16] = "";
long nth = 0;
bool and_later = false;
int seen = -1;
bool in_main = false;
std::atomic<long> calls{0};
int (*real_main)(int, char**, char**) = nullptr;

__attribute__((constructor)) void read_environment() {
  const char* const fault = std::getenv("EXCAVPLAN_FAULT");
  const char* const descriptor = std::getenv("EXCAVPLAN_FAULT_SEEN");
  if (fault == nullptr || descriptor == nullptr) return;
  const char* const colon = std::strchr(fault, ':');
  if (colon == nullptr || colon - fault >= static_cast<long>(sizeof kind)) return;
  std::memcpy(kind, fault, static_cast<std::size_t>(colon - fault));
  char* end = nullptr;
  nth = std::strtol(colon + 1, &end, 10);
  and_later = *end == '+';
  seen = std::atoi(descriptor);
}

/// Whether this call of a kind is to fail, and with what.
bool fails(const char* what, int reason) {
  if (!in_main || nth == 0 || std::strcmp(what, kind) != 0) return false;
  const long call = ++calls;
  if (call != nth && !(and_later && call > nth)) return false;
  if (call == nth) ::syscall(SYS_write, seen, "x", 1);
  errno = reason;
  return true;
}

template <typename Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int counted_main(int count, char** words, char** environment) {
  in_main = true;
  const int code = real_main(count, words, environment);
  in_main = false;
  return code;
}

mode_t mode_of(int flags, std::va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}

}  // namespace

// NOLINTBEGIN: these are the names and types of the C library
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

int __libc_start_main(int (*main)(int, char**, char**), int count, char** words, void (*init)(),
                      void (*fini)(), void (*ends)(), void* stack) {
  real_main = main;
  using Start =
      int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = real(static_cast<Start*>(nullptr), "__libc_start_main");
  return start(counted_main, count, words, init, fini, ends, stack);
}

#define FAIL_NTH(KIND, REASON, FAILED, RESULT, NAME, PARAMETERS, ARGUMENTS)      \
  RESULT NAME PARAMETERS {                                                       \
    static const auto next = real(static_cast<decltype(&NAME)>(nullptr), #NAME); \
    if (fails(KIND, REASON)) return FAILED;                                      \
    return next ARGUMENTS;                                                       \
  }

#define FAIL_NTH_OPEN(NAME)                                                      \
  int NAME(const char* path, int flags, ...) {                                   \
    static const auto next = real(static_cast<decltype(&NAME)>(nullptr), #NAME); \
    std::va_list rest;                                                           \
    va_start(rest, flags);                                                       \
    const mode_t mode = mode_of(flags, rest);                                    \
    va_end(rest);                                                                \
    return fails("open", EMFILE) ? -1 : next(path, flags, mode);                 \
  }

#define FAIL_NTH_OPENAT(NAME)                                                    \
  int NAME(int folder, const char* path, int flags, ...) {                       \
    static const auto next = real(static_cast<decltype(&NAME)>(nullptr), #NAME); \
    std::va_list rest;                                                           \
    va_start(rest, flags);                                                       \
    const mode_t mode = mode_of(flags, rest);                                    \
    va_end(rest);                                                                \
    return fails("open", EMFILE) ? -1 : next(folder, path, flags, mode);         \
  }

FAIL_NTH_OPEN(open)
FAIL_NTH_OPEN(open64)
FAIL_NTH_OPENAT(openat)
FAIL_NTH_OPENAT(openat64)
FAIL_NTH("open", EMFILE, nullptr, FILE*, fopen, (const char* a, const char* b), (a, b))
FAIL_NTH("open", EMFILE, nullptr, FILE*, fopen64, (const char* a, const char* b), (a, b))
FAIL_NTH("open", EMFILE, nullptr, DIR*, opendir, (const char* a), (a))
FAIL_NTH("open", EMFILE, -1, int, mkstemp, (char* a), (a))
FAIL_NTH("open", EMFILE, -1, int, mkstemp64, (char* a), (a))
FAIL_NTH("open", EMFILE, -1, int, pipe2, (int* a, int b), (a, b))

FAIL_NTH("read", EIO, -1, ssize_t, read, (int a, void* b, size_t c), (a, b, c))
FAIL_NTH("read", EIO, -1, ssize_t, readv, (int a, const iovec* b, int c), (a, b, c))
FAIL_NTH("read", EIO, -1, ssize_t, pread, (int a, void* b, size_t c, off_t d), (a, b, c, d))
FAIL_NTH("read", EIO, -1, ssize_t, pread64, (int a, void* b, size_t c, off64_t d), (a, b, c, d))

ssize_t write(int file, const void* bytes, size_t count) {
  static const auto next = real(static_cast<decltype(&write)>(nullptr), "write");
  return file != STDERR_FILENO && fails("write", ENOSPC) ? -1 : next(file, bytes, count);
}
ssize_t writev(int file, const iovec* parts, int count) {
  static const auto next = real(static_cast<decltype(&writev)>(nullptr), "writev");
  return file != STDERR_FILENO && fails("write", ENOSPC) ? -1 : next(file, parts, count);
}
FAIL_NTH("write", ENOSPC, -1, ssize_t, pwrite, (int a, const void* b, size_t c, off_t d),
         (a, b, c, d))
FAIL_NTH("write", ENOSPC, -1, ssize_t, pwrite64, (int a, const void* b, size_t c, off64_t d),
         (a, b, c, d))

// The names by which _FORTIFY_SOURCE calls them.
ssize_t __read_chk(int a, void* b, size_t c, size_t) { return read(a, b, c); }
ssize_t __pread_chk(int a, void* b, size_t c, off_t d, size_t) { return pread(a, b, c, d); }
ssize_t __pread64_chk(int a, void* b, size_t c, off64_t d, size_t) { return pread64(a, b, c, d); }
int __open_2(const char* a, int b) { return open(a, b); }
int __open64_2(const char* a, int b) { return open64(a, b); }

FAIL_NTH("fsync", EIO, -1, int, fsync, (int a), (a))
FAIL_NTH("fsync", EIO, -1, int, fdatasync, (int a), (a))
FAIL_NTH("rename", EACCES, -1, int, rename, (const char* a, const char* b), (a, b))
FAIL_NTH("rename", EACCES, -1, int, renameat, (int a, const char* b, int c, const char* d),
         (a, b, c, d))
FAIL_NTH("rename", EACCES, -1, int, link, (const char* a, const char* b), (a, b))
FAIL_NTH("rename", EACCES, -1, int, linkat, (int a, const char* b, int c, const char* d, int e),
         (a, b, c, d, e))
FAIL_NTH("mkdir", ENOSPC, -1, int, mkdir, (const char* a, mode_t b), (a, b))
FAIL_NTH("thread", EAGAIN, EAGAIN, int, pthread_create,
         (pthread_t * a, const pthread_attr_t* b, void* (*c)(void*), void* d), (a, b, c, d))

int close(int file) {
  static const auto next = real(static_cast<decltype(&close)>(nullptr), "close");
  const int result = next(file);  // as Linux does, also if it reports an error
  return fails("close", EIO) ? -1 : result;
}
int fclose(FILE* file) {
  static const auto next = real(static_cast<decltype(&fclose)>(nullptr), "fclose");
  const int result = next(file);
  return fails("close", EIO) ? EOF : result;
}

void* malloc(std::size_t size) { return fails("malloc", ENOMEM) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return fails("malloc", ENOMEM) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  return fails("malloc", ENOMEM) ? nullptr : __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return fails("malloc", ENOMEM) ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails("malloc", ENOMEM) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** place, std::size_t alignment, std::size_t size) {
  if (fails("malloc", ENOMEM)) return ENOMEM;
  *place = __libc_memalign(alignment, size);
  return *place == nullptr ? ENOMEM : 0;
}

}  // extern "C"
// NOLINTEND
