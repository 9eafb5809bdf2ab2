#pragma once
// Counts the memory allocations of a thread. The functions replace operator new in a test program. They also
// replace malloc(), except in a build with a sanitizer that has its own allocator. The functions are in a
// separate source file, so that the compiler cannot remove their calls.

#include <cstddef>

namespace softgrip::test {

/// Starts or stops the count of the allocations of this thread. Initially, the count is stopped.
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
