#pragma once
// What a world has without an effect, as causes of the vocabulary: to name it is a finding, not a false name.

#include <map>
#include <string>
#include <vector>

#include "world.h"

namespace textbook {

/// id -> what it changes of the displacement [mm RMS], for everything that changes more than `visible_mm`.
/// Found by taking the mechanism out of the world (or by fitting its rival), never by what a diagnosis likes
/// to say:
///
///   slow_creep             creep slower than `slowest_twin_s`, beyond zero and gain
///   hysteresis_shape       the loops as a whole (none of the makes is a Bouc-Wen element), beyond zero and
///   gain stiffening, sensor_nonlinearity  how far the middle of the settled loop is from a straight line
///   asymmetric_hysteresis  how unlike the lower and the upper half of the settled loop are in width
///   valve_lag              the valve against one whose pressure is the command
///   transport_delay        what a dead time brings beside the best first-order lag for the valve's pressure
///   valve_deadband         the valve against one without overlap and pilot hysteresis
///   supply_sag             the supply's swing against a steady supply
std::map<std::string, double> own_physics(const World& world, const std::vector<Log>& logs,
                                          std::uint64_t seed, double visible_mm);

/// Slower than any branch of a twin of two branches that was identified from such logs (given.yaml: 10 s).
inline constexpr double slowest_twin_s = 15;

}  // namespace textbook
