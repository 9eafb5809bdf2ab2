#pragma once
// Ends a long computation early. The request is in the thread budget of the computation, so that all of its
// threads see it, and functions in between need no argument for it.

#include "base/thread_budget.h"

namespace softgrip {

/// Thrown by end_if_cancelled(). Only the function that made the budget catches it.
struct WorkCancelled {};

/// True if the computation of the calling thread shall end early.
[[nodiscard]] inline bool is_cancelled() noexcept {
  const ThreadBudget* const budget = ThreadBudget::current();
  return budget != nullptr && budget->stop_requested();
}

/// Throws WorkCancelled if the computation of the calling thread shall end early. Loops of a fit call it, so
/// that a computation ends within the time that the model needs for its logs.
inline void end_if_cancelled() {
  if (is_cancelled()) throw WorkCancelled{};
}

}  // namespace softgrip
