#pragma once
// Runs computations of the library that a request through a std::stop_token can end early.

#include <stop_token>
#include <utility>

#include "base/thread_budget.h"
#include "library/include/softgrip/error.h"

namespace softgrip::library {

/// Calls work() and returns its result. work() may use `threads` threads (0: one per processor core). Throws
/// Cancelled if a request through `stop` ended work() early.
template <class Work>
auto cancellable(unsigned threads, const std::stop_token& stop, Work&& work) {
  const ThreadBudget budget(threads, stop);
  try {
    return std::forward<Work>(work)();
  } catch (const WorkCancelled&) {
    throw Cancelled("the computation ended early, because its stop token requested a stop");
  }
}

}  // namespace softgrip::library
