#pragma once
// Ends a long computation early. The request to end is stored in the thread budget of the computation. All
// threads of the computation can read this request there, so no function needs an argument for it.

#include "base/thread_budget.h"

namespace softgrip {

/// Thrown by end_if_cancelled(). Only the function that created the budget catches it.
struct WorkCancelled {};

/// Returns true if the computation of the calling thread must end early.
[[nodiscard]] inline bool is_cancelled() noexcept {
  const ThreadBudget* const budget = ThreadBudget::current();
  return budget != nullptr && budget->stop_requested();
}

/// Throws WorkCancelled if the computation of the calling thread must end early. The loops of a fit call this
/// function, so the fit ends within the time of one simulation of the model on its recordings.
inline void end_if_cancelled() {
  if (is_cancelled()) throw WorkCancelled{};
}

}  // namespace softgrip
