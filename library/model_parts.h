#pragma once
// Defines the internal data of a public Model, and the checks of arguments that all public functions share.
// Runs computations of the library that a request through a std::stop_token can end early.
// Converts limits and readings between the public interface and the types of control/ and drivers/.

#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "base/thread_budget.h"
#include "control/elements/limits.h"
#include "document/problem.h"
#include "library/include/softgrip/board.h"
#include "library/include/softgrip/control.h"
#include "library/include/softgrip/error.h"
#include "library/include/softgrip/model.h"
#include "model/model.h"
#include "model/reading.h"

namespace softgrip {

struct Model::Parts {
  model::Model value;  ///< a valid model
};

namespace library {

/// Returns a public Model that contains a valid model.
[[nodiscard]] Model wrapped(model::Model model);
[[nodiscard]] model::OutputUnit unit_of(Unit unit) noexcept;
[[nodiscard]] Unit unit_of(model::OutputUnit unit) noexcept;

/// Throws FileError. The text of the exception contains all problems.
[[noreturn]] void refuse(const document::Problems& problems);

/// Returns the name of a unit for messages: "mm" or "deg".
[[nodiscard]] std::string in_brackets(model::OutputUnit unit);

/// Returns the sentence for a parameter that a model does not have.
[[nodiscard]] std::string unknown_parameter(const model::Model& model, const std::string& name);

/// Shortest usual duration of a step of a simulation [s]. The memory of a delay line increases with the delay
/// divided by this duration.
inline constexpr double shortest_simulated_step_s = 1e-6;

// Each of the following functions throws InvalidArgument if its requirement is not met.
/// Requires one value for each of `count` times.
void require_size(const std::string& argument, std::size_t size, std::size_t count, const std::string& unit);
/// Requires that all values are finite.
void require_finite(const std::string& argument, std::span<const double> values, const std::string& unit);
/// Requires at least `fewest` times, which must be finite and increasing.
void require_times(const std::string& argument, std::span<const double> time_s, std::size_t fewest);
/// Requires a number from `lower` to `upper`.
void require_between(const std::string& argument, double value, double lower, double upper,
                     const std::string& unit);
/// Requires a finite number above 0.
void require_positive(const std::string& argument, double value, const std::string& unit);

[[nodiscard]] control::LimitSettings settings_of(const Limits& limits) noexcept;
/// Checks limits and converts them. Throws InvalidArgument if a limit is invalid.
control::LimitSettings checked(const Limits& limits);

[[nodiscard]] Validity validity_of(model::Validity validity) noexcept;
[[nodiscard]] model::Reading reading_of(const Reading& reading) noexcept;
[[nodiscard]] Reading reading_of(const model::Reading& reading) noexcept;

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

}  // namespace library
}  // namespace softgrip
