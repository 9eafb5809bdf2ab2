#pragma once
// Counts the memory allocations of a thread. The functions replace operator new in a test program. They also
// replace malloc if no sanitizer brings its own allocator. They are in a separate translation unit, so that
// the compiler cannot optimise the calls away.

#include <cstddef>

namespace softgrip::test {

/// Starts or stops the count of this thread's allocations. The count is initially stopped.
void count_allocations(bool on) noexcept;
/// Returns the number of allocations of this thread that have been counted so far.
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
