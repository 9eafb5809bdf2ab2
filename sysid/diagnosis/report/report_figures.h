#pragma once
// The pictures of a diagnosis.

#include <cstddef>
#include <vector>

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// Measured, given, recalibrated and, if there is one, extended over time; below it the errors.
[[nodiscard]] std::vector<Chart> diagnosis_overlay(const Diagnosis& diagnosis, std::size_t record);
/// Displacement over pressure.
[[nodiscard]] Chart diagnosis_loops(const Diagnosis& diagnosis, std::size_t record);
/// Errors over pressure, recalibrated and, if there is one, extended.
[[nodiscard]] Chart errors_by_pressure(const Diagnosis& diagnosis, std::size_t record);
/// Conditional means with their intervals: recalibrated and, faintly, extended.
[[nodiscard]] Chart condition_chart(const ConditionEvidence& recalibrated, const ConditionEvidence* extended);
[[nodiscard]] Chart spectrum_chart(const Diagnosis& diagnosis);
/// Held-out errors of the three models.
[[nodiscard]] Chart gain_chart(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
