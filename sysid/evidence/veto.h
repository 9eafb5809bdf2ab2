#pragma once
// Defines the conditions that a cause must fulfil to be reported. They apply to every error reduction, even
// to a large one.

#include <optional>
#include <string_view>

#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// Evidence that decides whether a cause is reported.
struct Claim {
  /// 95 % interval of the size of the cause; empty: the data do not determine the size.
  std::optional<Interval> size;
  /// Largest possible size of the cause, in the unit of `size`: the span of the displacement [mm], the
  /// largest pressure [kPa] or the length of the longest log [s]. For other units, it is infinity: every size
  /// is possible.
  double largest_size = 0;
  double error_without = 0;  ///< RMSE without the cause, over all readings that should show the cause
  double error_with = 0;     ///< RMSE with the cause, over all readings that should show the cause
  /// True: with the cause, the error of readings that were left out of the fit is larger.
  bool predicts_worse = false;
  bool condition_met = true;  ///< true: the data fulfil the condition under which the cause acts
  /// True: the cause reduces the error of the readings that fulfil this condition.
  bool shown_there = true;
};

enum class Veto {
  none,
  size_uncertain,
  size_beyond_range,
  error_not_reduced,
  not_predictive,
  not_tested,
  absent_where_required,
};

/// Returns the first condition that the evidence does not fulfil; Veto::none if it fulfils all of them.
[[nodiscard]] Veto veto_of(const Claim& claim);
/// Returns the reason of a rejection as a part of a sentence. Returns an empty text for Veto::none.
[[nodiscard]] std::string_view reason_of(Veto veto);

}  // namespace softgrip::sysid
