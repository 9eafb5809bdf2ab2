#pragma once
// Defines the conditions that a cause must meet before it is reported. They apply even to a cause with a
// large error reduction.

#include <optional>
#include <string_view>

#include "sysid/fitting/interval.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Evidence that decides whether a cause is reported.
struct Claim {
  /// 95 % interval of the size of the cause; empty: the data do not determine the size, and the conditions on
  /// the size are not tested.
  std::optional<Interval> size;
  /// Largest possible size of the cause (largest_possible_size()), in the unit of `size`.
  double largest_size = 0;
  /// True: the sizes of all causes that were found before remain certain if the cause is added.
  bool keeps_other_sizes = true;
  double error_without = 0;  ///< RMSE of the model without the cause, over the evaluated readings
  double error_with = 0;     ///< RMSE of the model with the cause, over the evaluated readings
  /// Share of the remaining error that the cause explains, at most 1.
  double explained_share = 1;
  /// True: the cause increases the prediction error on readings that were left out of the fit.
  bool predicts_worse = false;
  bool condition_met = true;  ///< true: the data meet the condition under which the cause acts
  /// True: the cause reduces the error of those readings that meet the condition under which it acts.
  bool shown_there = true;
};

/// Returns the largest possible size of a cause, in the given unit. It is the range of the signal on which
/// the cause acts: the span of the displacement [mm], the largest pressure [kPa] or the length of the longest
/// log [s]. For all other units it is infinite, so every size is possible.
/// @param neutral  value of the parameter for which the cause has no effect. The neutral value of a limit,
/// such as a saturation, is far above all signals, so the distance from it is not compared with a range.
[[nodiscard]] double largest_possible_size(const CampaignSize& range, std::string_view unit, double neutral);

enum class Veto {
  none,
  size_uncertain,
  size_beyond_range,
  other_size_uncertain,
  error_not_reduced,
  explains_too_little,
  not_predictive,
  not_tested,
  absent_where_required,
};

/// Returns the first condition that the evidence does not meet. Returns Veto::none if the evidence meets all
/// conditions.
[[nodiscard]] Veto veto_of(const Claim& claim);
/// Returns the reason why a cause is rejected, as a part of a sentence. Returns an empty text for Veto::none.
[[nodiscard]] std::string_view reason_of(Veto veto);

}  // namespace softgrip::sysid
