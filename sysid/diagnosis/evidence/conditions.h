#pragma once
// Computes conditions on which a model error may depend, such as the rate of the pressure. Each condition has
// a value at each sample.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Phase of the pressure curve at a sample.
enum class Branch : std::uint8_t { rest, loading, hold, unloading };

/// History of the drive of a record. Each vector has one value per sample.
struct DriveHistory {
  std::vector<double> rate_kpa_per_s;  ///< slope of the pressure over a window of 0.1 s; 0 while the pressure
                                       ///< is constant
  std::vector<Branch> branch;
  std::vector<bool> falling;    ///< true: the last change of the pressure was a fall
  std::vector<double> dwell_s;  ///< time since the pressure became constant; NaN while the pressure changes
  /// Peak pressure of the current load cycle. While the finger rests, this is the peak pressure of the
  /// previous load cycle.
  std::vector<double> amplitude_kpa;
  std::vector<double> largest_kpa;  ///< largest pressure up to this sample; all earlier records are included
  std::vector<std::size_t> cycle;   ///< index of the load cycle, from 0; see cycle_starts()
};
[[nodiscard]] DriveHistory history_of(const Record& record);

/// Samples of all records in one list. Samples without a reading are left out, and the remaining samples are
/// thinned evenly.
struct Samples {
  std::vector<std::size_t> record;
  std::vector<std::size_t> index;  ///< for each sample, its index in its record
  std::vector<double> campaign_s;

  [[nodiscard]] std::size_t size() const noexcept { return record.size(); }
};
/// Returns about `most` samples of all records, or fewer. Samples with the residual NaN are left out.
[[nodiscard]] Samples pooled_samples(const std::vector<Record>& records,
                                     const std::vector<std::vector<double>>& residual_mm, std::size_t most);
/// Returns the values that belong to these samples, in one list. `by_record` has one vector per record.
[[nodiscard]] std::vector<double> pooled(const Samples& samples,
                                         const std::vector<std::vector<double>>& by_record);

/// A condition on which the error may depend, and its value at each sample.
struct Condition {
  std::string id;    ///< id of the condition, for example "rate"
  std::string axis;  ///< axis label, for example "rate of the pressure [kPa/s]"
  /// Text that completes the sentence "the error depends on ...", for example "the rate of the pressure".
  std::string phrase;
  std::vector<double> value;  ///< value of the condition at each sample; NaN: the sample has no value
  bool logarithmic = false;
  /// Names of the categories if the values 0, 1, ... denote categories; empty: the values are numbers.
  std::vector<std::string> categories;
  /// Index in `groups` for each sample. Each group, for example loading or unloading, gets its own curve.
  std::vector<std::uint8_t> group;
  std::vector<std::string> groups;
  std::string why_not;  ///< reason why the condition was not tested; empty: the condition was tested
};

/// Returns the conditions branch, cycle, amplitude, rate, dwell, history, position, loop (position and
/// direction of the last motion), campaign_time, temperature and supply, in this order.
/// @param prediction_mm  output of the model, one vector per record. The position is taken from this output,
/// because a measured position contains the same errors as the residual.
[[nodiscard]] std::vector<Condition> conditions_of(const std::vector<Record>& records,
                                                   const std::vector<std::vector<double>>& prediction_mm,
                                                   const Samples& samples);

}  // namespace softgrip::sysid
