#pragma once
// Ends a fuzz target with an error.

#include <cstdlib>

namespace softgrip::test {

/// Aborts the program unless the condition holds.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace softgrip::test
