#pragma once
// Counts the allocations of a thread. In a test program it replaces operator new and, unless a sanitizer has
// its own allocator, malloc. It is a separate translation unit, so that the compiler cannot optimise across
// it.

#include <cstddef>

namespace softgrip::test {

/// Starts or stops counting this thread's allocations; initially they are not counted.
void count_allocations(bool on) noexcept;
/// Returns the number of counted allocations of this thread.
[[nodiscard]] std::size_t allocations() noexcept;

/// Returns the number of allocations that `work` makes in this thread.
template <class Work>
std::size_t allocations_of(const Work& work) {
  const std::size_t before = allocations();
  count_allocations(true);
  work();
  count_allocations(false);
  return allocations() - before;
}

}  // namespace softgrip::test
