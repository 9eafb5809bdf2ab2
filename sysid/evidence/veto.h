#pragma once
// The conditions that every named cause meets, whatever improvement it shows.

#include <optional>
#include <string_view>

#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

/// What is claimed of one cause.
struct Claim {
  std::optional<Interval> size;  ///< 95 % interval; none: the data do not determine it
  double largest_size = 0;       ///< span or range of the signal that the cause acts on, in the size's unit
  double error_without = 0;      ///< plain RMSE of all readings that are said to show it
  double error_with = 0;
  bool predicts_worse = false;  ///< readings to which the cause was not fitted
  bool condition_met = true;    ///< the data meet the condition under which the cause acts
  bool shown_there = true;      ///< and the error is smaller there
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

/// The first condition that the claim fails.
[[nodiscard]] Veto veto_of(const Claim& claim);
/// Why it was rejected, as a part of a sentence. Empty for Veto::none.
[[nodiscard]] std::string_view reason_of(Veto veto);

}  // namespace softgrip::sysid
