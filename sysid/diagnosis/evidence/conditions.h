#pragma once
// Computes, for each sample, the conditions on which an error may depend.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Phase of the pressure curve at a sample.
enum class Branch : std::uint8_t { rest, loading, hold, unloading };
[[nodiscard]] const char* name_of(Branch branch);

/// History of the drive of a record. Each vector has one value per sample.
struct DriveHistory {
  std::vector<double> rate_kpa_per_s;  ///< slope of the pressure over 0.1 s; 0 at constant pressure
  std::vector<Branch> branch;
  std::vector<bool> falling;    ///< true: the last change of the pressure was a decrease
  std::vector<double> dwell_s;  ///< time since the pressure became constant; NaN while the pressure changes
  /// Time since the pressure last reversed, started to change or stopped changing.
  std::vector<double> since_turn_s;
  std::vector<double> turn_kpa;  ///< pressure at the last reversal, start or stop of a change
  /// Peak pressure of the current excursion from rest; at rest, peak pressure of the previous excursion.
  std::vector<double> amplitude_kpa;
  std::vector<double> largest_kpa;  ///< largest pressure so far, in this record and in all records before
  std::vector<std::size_t> cycle;   ///< index of the load cycle, from 0; see cycle_starts()
};
[[nodiscard]] DriveHistory history_of(const Record& record);

/// Samples of all records in one list. Only samples with a reading are included, and the list is thinned
/// evenly.
struct Samples {
  std::vector<std::size_t> record;
  std::vector<std::size_t> index;  ///< for each sample, its index in its record
  std::vector<double> campaign_s;

  [[nodiscard]] std::size_t size() const noexcept { return record.size(); }
};
/// Returns about `most` samples of all records. Samples whose residual is NaN are omitted.
[[nodiscard]] Samples pooled_samples(const std::vector<Record>& records,
                                     const std::vector<std::vector<double>>& residual_mm, std::size_t most);
/// Returns the values of `by_record` at these samples, in one list. `by_record` has one vector per record.
[[nodiscard]] std::vector<double> pooled(const Samples& samples,
                                         const std::vector<std::vector<double>>& by_record);

/// A condition on which the error may depend, with its value at each sample.
struct Condition {
  std::string id;    ///< id of the condition: "rate"
  std::string axis;  ///< axis label: "rate of the pressure [kPa/s]"
  /// End of the sentence "the error depends on ...", such as "the rate of the pressure".
  std::string phrase;
  std::vector<double>
      value;  ///< value of the condition at each sample; NaN: the condition is not defined for the sample
  bool logarithmic = false;
  /// Names of the categories if the condition has the values 0, 1, ... for categories; empty: the values are
  /// numbers.
  std::vector<std::string> categories;
  /// For each sample, the index of its group in `groups`. Each group, such as loading or unloading, gets its
  /// own curve.
  std::vector<std::uint8_t> group;
  std::vector<std::string> groups;
  std::string why_not;  ///< reason why the condition was not tested; empty: it was tested
};

/// Returns the conditions branch, cycle, amplitude, rate, dwell, history, position, loop (position and
/// direction of the last motion), campaign_time, temperature and supply, in this order.
/// @param prediction_mm  output of the model, one vector per record. The position is taken from this output,
/// because a measured position contains the same errors as the residual.
[[nodiscard]] std::vector<Condition> conditions_of(const std::vector<Record>& records,
                                                   const std::vector<std::vector<double>>& prediction_mm,
                                                   const Samples& samples);

}  // namespace softgrip::sysid
