#pragma once

#include <cstdlib>

// Counts every allocation of a test's process, where COUNTS_ALLOCATIONS is defined after this:
// Eigen's do not use operator new. For one source file of a program. Sanitizers bring a malloc of
// their own: gcc says so by macros, clang by features.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAS_OWN_MALLOC
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAS_OWN_MALLOC
#endif
#if defined(__GLIBC__) && !defined(HAS_OWN_MALLOC)
#define COUNTS_ALLOCATIONS
static long allocation_count = 0;
static thread_local long allocations_here = 0;  // by this thread alone
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocation_count;
  ++allocations_here;
  return __libc_malloc(size);
}
#endif
