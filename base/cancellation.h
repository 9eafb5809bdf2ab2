#pragma once
// Ends a long computation early. The request to end is stored in the thread budget of the computation. All
// threads of the computation can read this request from the thread budget. Therefore, no function needs an
// argument for the request.

#include "base/thread_budget.h"

namespace softgrip {

/// Exception that end_if_cancelled() throws. Only the function that created the thread budget catches this
/// exception.
struct WorkCancelled {};

/// Returns true if the computation of the calling thread must end early.
[[nodiscard]] inline bool is_cancelled() noexcept {
  const ThreadBudget* const budget = ThreadBudget::current();
  return budget != nullptr && budget->stop_requested();
}

/// Throws WorkCancelled if the computation of the calling thread must end early. The loops of a fit call this
/// function. Therefore, the fit ends within the time that one simulation of the model takes.
inline void end_if_cancelled() {
  if (is_cancelled()) throw WorkCancelled{};
}

}  // namespace softgrip
