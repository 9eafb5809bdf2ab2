#pragma once
// Computes the pressure in the finger: the drive of a record after the delay, the lags and the rate limit of
// a structure. A regulator may replace the lags and the rate limit.

#include <cstddef>
#include <vector>

#include "model/segment.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Pressure in the finger during one record, as a sequence of segments. The segments contain no approximation
/// if the drive is linear or constant between samples.
struct DrivenPressure {
  double first_kpa = 0;                          ///< pressure at the first sample
  std::vector<model::Segment<double>> segments;  ///< segments with durations in s and pressures in kPa
  /// For each sample: number of segments that end at the time of this sample or before.
  std::vector<std::size_t> until;

  [[nodiscard]] double at_kpa(std::size_t sample) const {
    return until[sample] == 0 ? first_kpa : segments[until[sample] - 1].end;
  }
};

/// Computes the pressure and stores it in `driven`. The function reuses the memory of `driven`, because a
/// search calls it thousands of times.
/// @param index  index of the record in `numbers.jumped_from_kpa`.
/// @param numbers  nonlinear parameters. The function reads only the parameters of delay, lags, rate limit,
/// regulator and initial jump.
void drive(const Record& record, std::size_t index, const BaseStructure& structure,
           const NonlinearNumbers& numbers, DrivenPressure& driven);

}  // namespace softgrip::sysid
