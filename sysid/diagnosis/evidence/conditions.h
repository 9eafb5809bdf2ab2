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

/// History of a record's drive, with one value per sample.
struct DriveHistory {
  std::vector<double> rate_kpa_per_s;  ///< slope over 0.1 s; 0 at constant pressure
  std::vector<Branch> branch;
  std::vector<bool> falling;          ///< true: the last pressure change was a decrease
  std::vector<double> dwell_s;        ///< time since the pressure became constant; NaN while it changes
  std::vector<double> since_turn_s;   ///< time since the pressure last changed direction, started or stopped
  std::vector<double> turn_kpa;       ///< pressure at the last change of direction, start or stop
  std::vector<double> amplitude_kpa;  ///< peak pressure of the current excursion from rest; at rest, of the
                                      ///< previous one
  std::vector<double> largest_kpa;    ///< largest pressure so far, in the whole campaign
  std::vector<std::size_t> cycle;     ///< number of the load cycle, from 0; see cycle_starts()
};
[[nodiscard]] DriveHistory history_of(const Record& record);

/// Samples of all records that have a reading, evenly thinned and concatenated.
struct Samples {
  std::vector<std::size_t> record;
  std::vector<std::size_t> index;  ///< index of the sample in its record
  std::vector<double> campaign_s;

  [[nodiscard]] std::size_t size() const noexcept { return record.size(); }
};
/// Returns about `most` samples of all records. Samples with a NaN in `residual_mm` are omitted.
[[nodiscard]] Samples pooled_samples(const std::vector<Record>& records,
                                     const std::vector<std::vector<double>>& residual_mm, std::size_t most);
/// Returns the values of `by_record` at these samples.
[[nodiscard]] std::vector<double> pooled(const Samples& samples,
                                         const std::vector<std::vector<double>>& by_record);

/// A condition, evaluated at all samples.
struct Condition {
  std::string id;             ///< "rate"
  std::string axis;           ///< "rate of the pressure [kPa/s]"
  std::string phrase;         ///< end of the sentence "the error depends on ..."
  std::vector<double> value;  ///< value at each sample; NaN: the condition does not apply
  bool logarithmic = false;
  std::vector<std::string> categories;  ///< names of the values 0, 1, ...; empty: the values are numbers
  /// Index in `groups` for each sample. The groups (such as loading and unloading) have separate curves.
  std::vector<std::uint8_t> group;
  std::vector<std::string> groups;
  std::string why_not;  ///< reason why the condition was not tested; empty: it was tested
};

/// Returns the conditions branch, cycle, amplitude, rate, dwell, history, position, loop (position and
/// direction of the last motion), campaign_time, temperature and supply, in this order.
/// @param prediction_mm  one vector per record. The position is that of the model, because a measured
/// position contains the same errors as the residual.
[[nodiscard]] std::vector<Condition> conditions_of(const std::vector<Record>& records,
                                                   const std::vector<std::vector<double>>& prediction_mm,
                                                   const Samples& samples);

}  // namespace softgrip::sysid
