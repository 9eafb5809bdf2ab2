#pragma once
// Counts what a thread allocates. Linked into a test program it replaces operator new and, where no sanitizer
// has its own allocator, malloc. A translation unit of its own, so that the compiler does not look through
// it.

#include <cstddef>

namespace softgrip::drivers::test {

/// From now on this thread's allocations are counted, from 0.
void start_counting() noexcept;
/// How many there were; counting ends.
[[nodiscard]] std::size_t stop_counting() noexcept;

/// How many allocations `work` makes in this thread.
template <class Work>
std::size_t allocations_of(const Work& work) {
  start_counting();
  work();
  return stop_counting();
}

}  // namespace softgrip::drivers::test
