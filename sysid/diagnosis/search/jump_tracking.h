#pragma once
// Where a sticking valve stood, sample by sample, as the readings show it.
//
// A valve that sticks and jumps starts each jump from where the last one ended, so small differences in the
// moments of jumps add up: after some tens of them nobody can tell from the command alone where in its
// staircase it is. The readings tell. Several courses of the valve are followed side by side, each with a
// chain of its own behind it, and those that meet the readings best are kept (a beam search through jump or
// no jump, as in Viterbi's algorithm).

#include <cstddef>
#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Shares of the band between which a valve breaks loose: it never jumps before the first, always by the
/// second. A command that differs by less leaves it where it is; when it jumps it goes to the command.
inline constexpr double breaks_loose_from = 0.7;
inline constexpr double breaks_loose_by = 1.4;

/// A course of the valve through one record.
struct ValveCourse {
  std::vector<double> held_kpa;  ///< at the end of every sample's step
  /// How far the command had gone from where the valve stood when it jumped [kPa]: of jumps whose moment the
  /// readings resolve well (the command moved little during their sample).
  std::vector<double> distances_kpa;
  double sum_of_squares_mm2 = 0;  ///< reading minus the answer of the chain behind the valve
};

/// The course that meets the readings best.
/// @param point  the chain behind the valve and its start in every record; without a dead band of its own.
/// @param index  of the record.
/// @param band_kpa  > 0.
/// @param resolution_kpa  > 0: differences in pressure that the readings cannot show.
/// @param worth_mm2  a course that leaves more is not followed to its end: an infinite sum of squares, and
///                   nothing else.
[[nodiscard]] ValveCourse track_jumps(const Record& record, std::size_t index, const FitPoint& point,
                                      double band_kpa, double resolution_kpa,
                                      double worth_mm2 = std::numeric_limits<double>::infinity());

/// The record with where the valve stood as its drive.
[[nodiscard]] Record driven_by(const Record& record, const ValveCourse& course);

}  // namespace softgrip::sysid
