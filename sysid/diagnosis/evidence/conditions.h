#pragma once
// Computes the conditions at a sample on which an error may depend.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// State of the pressure at a sample.
enum class Branch : std::uint8_t { rest, loading, hold, unloading };
[[nodiscard]] const char* name_of(Branch branch);

/// History of a record's drive, by sample.
struct DriveHistory {
  std::vector<double> rate_kpa_per_s;  ///< slope over 0.1 s, 0 at constant pressure
  std::vector<Branch> branch;
  std::vector<bool> falling;          ///< the last motion was downwards
  std::vector<double> dwell_s;        ///< time since the pressure stopped; NaN while it moves
  std::vector<double> since_turn_s;   ///< time since the pressure last turned, started or stopped
  std::vector<double> turn_kpa;       ///< pressure at that moment
  std::vector<double> amplitude_kpa;  ///< peak of the present excursion from rest, at rest of the last one
  std::vector<double> largest_kpa;    ///< largest pressure so far, in the whole campaign
  std::vector<std::size_t> cycle;     ///< 0, 1, ...; see cycle_starts()
};
[[nodiscard]] DriveHistory history_of(const Record& record);

/// Samples of all records that have a reading, thinned evenly and concatenated.
struct Samples {
  std::vector<std::size_t> record;
  std::vector<std::size_t> index;  ///< index in its record
  std::vector<double> campaign_s;

  [[nodiscard]] std::size_t size() const noexcept { return record.size(); }
};
/// Returns about `most` samples. Samples with a NaN in `residual_mm` are omitted.
[[nodiscard]] Samples pooled_samples(const std::vector<Record>& records,
                                     const std::vector<std::vector<double>>& residual_mm, std::size_t most);
/// Returns the values of `by_record` at the samples.
[[nodiscard]] std::vector<double> pooled(const Samples& samples,
                                         const std::vector<std::vector<double>>& by_record);

/// One condition at all samples.
struct Condition {
  std::string id;             ///< "rate"
  std::string axis;           ///< "rate of the pressure [kPa/s]"
  std::string phrase;         ///< completes "the error depends on ..."
  std::vector<double> value;  ///< value at each sample; NaN: does not apply
  bool logarithmic = false;
  std::vector<std::string> categories;  ///< names of the values 0, 1, ...; empty: a number
  /// The element of `groups` to which a sample belongs. The curves of the groups are kept separate (loading,
  /// unloading).
  std::vector<std::uint8_t> group;
  std::vector<std::string> groups;
  std::string why_not;  ///< reason why the condition was not tested, or empty
};

/// Returns the conditions branch, cycle, amplitude, rate, dwell, history, position, loop (position by the
/// direction of the last motion), campaign_time, temperature and supply, in this order.
/// @param prediction_mm  by record. The position is that of the model, because the reading and the residual
/// share their error.
[[nodiscard]] std::vector<Condition> conditions_of(const std::vector<Record>& records,
                                                   const std::vector<std::vector<double>>& prediction_mm,
                                                   const Samples& samples);

}  // namespace softgrip::sysid
