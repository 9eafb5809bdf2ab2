#pragma once
// Counts what a thread allocates. Linked into a test program it replaces operator new and, where no sanitizer
// has its own allocator, malloc. A translation unit of its own, so that the compiler does not look through
// it.

#include <cstddef>

namespace softgrip::test {

/// Whether this thread's allocations are counted from now on; at first they are not.
void count_allocations(bool on) noexcept;
/// How many were counted in this thread so far.
[[nodiscard]] std::size_t allocations() noexcept;

/// How many allocations `work` makes in this thread.
template <class Work>
std::size_t allocations_of(const Work& work) {
  const std::size_t before = allocations();
  count_allocations(true);
  work();
  count_allocations(false);
  return allocations() - before;
}

}  // namespace softgrip::test
