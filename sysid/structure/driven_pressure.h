#pragma once
// Computes the pressure in the finger: the drive of a record after the delay and the valve lag of a
// structure.

#include <cstddef>
#include <vector>

#include "model/segment.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Pressure in the finger for one record, as a sequence of segments. The result is exact if the drive is
/// linear or constant between the samples.
struct DrivenPressure {
  double first_kpa = 0;                          ///< pressure at the first sample
  std::vector<model::Segment<double>> segments;  ///< segments with durations in s and pressures in kPa
  std::vector<std::size_t> until;                ///< for each sample: number of segments that end at or
                                                 ///< before this sample

  [[nodiscard]] double at_kpa(std::size_t sample) const {
    return until[sample] == 0 ? first_kpa : segments[until[sample] - 1].end;
  }
};

/// Computes the pressure and stores it in `driven`. The memory of `driven` is reused, because a search calls
/// this function thousands of times.
/// @param numbers  parameters of the parts (delay, lag, regulator) that `structure` has; others are ignored.
void drive(const Record& record, const BaseStructure& structure, const NonlinearNumbers& numbers,
           DrivenPressure& driven);

}  // namespace softgrip::sysid
