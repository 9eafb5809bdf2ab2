#pragma once
// Lists the causes that a diagnosis may correctly report for a world without a hidden effect. The valve and
// the finger of the world have these mechanisms, so the report of such a cause is not a false alarm.

#include <map>
#include <string>
#include <vector>

#include "world.h"

namespace textbook {

/// Maps the id of a cause to the displacement change by this cause [mm RMS]. The map contains the causes that
/// change the displacement by more than `visible_mm`. To compute the change, the function removes the
/// mechanism from the world or fits a competing model. The function does not use the results of a diagnosis.
/// The list states the displacement change of each cause. "Beyond zero and gain" means: without the part that
/// a change of zero and gain can explain.
///
///   slow_creep             creep slower than `slowest_twin_s`, beyond zero and gain
///   hysteresis_shape       the loops as a whole, beyond zero and gain (no make has a Bouc-Wen element)
///   stiffening, sensor_nonlinearity  distance of the middle of the settled loop from a line
///   asymmetric_hysteresis  difference in width between the lower and the upper half of the settled loop
///   valve_lag              the valve, compared with one whose pressure equals the command
///   transport_delay        a dead time in addition to the best first-order lag of the valve's pressure
///   valve_deadband         the valve, compared with one without overlap and pilot hysteresis
///   supply_sag             the varying supply, compared with a constant supply
std::map<std::string, double> own_physics(const World& world, const std::vector<Log>& logs,
                                          std::uint64_t seed, double visible_mm);

/// Time constant [s] above which creep counts as slow. The model given.yaml has two creep branches that were
/// identified from logs of a simulated world. Both time constants are below this value; the larger one is 10
/// s.
inline constexpr double slowest_twin_s = 15;

}  // namespace textbook
