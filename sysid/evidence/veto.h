#pragma once
// Conditions that a cause must meet before it is reported, regardless of its error reduction.

#include <optional>
#include <string_view>

#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// Evidence for one cause.
struct Claim {
  std::optional<Interval> size;  ///< 95 % interval of the size; empty: the data do not determine the size
  double largest_size = 0;       ///< range of the signal on which the cause acts, in the unit of the size
  double error_without = 0;      ///< RMSE without the cause, over all readings that should show it
  double error_with = 0;         ///< RMSE with the cause, over the same readings
  bool predicts_worse = false;  ///< true: the cause increases the error of readings that were left out of the
                                ///< fit
  bool condition_met = true;    ///< true: the data meet the condition under which the cause acts
  bool shown_there = true;      ///< true: the cause reduces the error where this condition is met
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

/// Returns the first condition that the claim does not meet.
[[nodiscard]] Veto veto_of(const Claim& claim);
/// Returns the reason of the rejection as a part of a sentence, or an empty text for Veto::none.
[[nodiscard]] std::string_view reason_of(Veto veto);

}  // namespace softgrip::sysid
