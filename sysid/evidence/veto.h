#pragma once
// Conditions that a cause must meet before it is reported, regardless of its improvement.

#include <optional>
#include <string_view>

#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// Evidence for one cause.
struct Claim {
  std::optional<Interval> size;  ///< 95 % interval; nullopt: the data do not determine it
  double largest_size = 0;   ///< span or range of the signal that the cause acts on, in the unit of the size
  double error_without = 0;  ///< RMSE of all readings that should show the cause, without it
  double error_with = 0;
  bool predicts_worse = false;  ///< the cause increases the error of readings to which it was not fitted
  bool condition_met = true;    ///< the data meet the condition under which the cause acts
  bool shown_there = true;      ///< the cause reduces the error where the condition is met
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
/// Returns the reason of the rejection as a part of a sentence. Returns an empty text for Veto::none.
[[nodiscard]] std::string_view reason_of(Veto veto);

}  // namespace softgrip::sysid
