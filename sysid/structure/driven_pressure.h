#pragma once
// The pressure in the finger: the drive of a record after the delay and the valve's lag of a structure.

#include <cstddef>
#include <vector>

#include "model/segment.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// The pressure for one record, as segments. It is exact for a drive that is linear or constant between
/// samples.
struct DrivenPressure {
  double first_kpa = 0;                          ///< pressure at the first sample
  std::vector<model::Segment<double>> segments;  ///< [s], [kPa]
  std::vector<std::size_t> until;                ///< per sample: number of segments that end there or before

  [[nodiscard]] double at_kpa(std::size_t sample) const {
    return until[sample] == 0 ? first_kpa : segments[until[sample] - 1].end;
  }
};

/// Computes `driven`. Its memory is reused, because a search calls this function thousands of times.
/// @param numbers  the parameters of delay, lag and regulator are used if `structure` has these parts.
void drive(const Record& record, const BaseStructure& structure, const NonlinearNumbers& numbers,
           DrivenPressure& driven);

}  // namespace softgrip::sysid
