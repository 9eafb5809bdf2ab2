#pragma once
// The pressure in the finger: what the delay and the valve's lag of a structure make of a record's drive.

#include <cstddef>
#include <vector>

#include "model/segment.h"
#include "sysid/logs/record.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// One record's, as the segments that delay and lag cut it into, exact for a drive that is straight between
/// samples or held.
struct DrivenPressure {
  double first_kpa = 0;                          ///< at the first sample
  std::vector<model::Segment<double>> segments;  ///< [s], [kPa]
  std::vector<std::size_t> until;                ///< per sample: how many of them end there or before

  [[nodiscard]] double at_kpa(std::size_t sample) const {
    return until[sample] == 0 ? first_kpa : segments[until[sample] - 1].end;
  }
};

/// Writes into `driven`. Its memory is used again, because a search calls this thousands of times.
/// @param numbers  those of the delay, the lag and the regulator count, as far as `structure` has them.
void drive(const Record& record, const BaseStructure& structure, const NonlinearNumbers& numbers,
           DrivenPressure& driven);

}  // namespace softgrip::sysid
