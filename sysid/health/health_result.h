#pragma once
// States the fields of the result of `softgrip health`. health.json contains all fields, and the pages of the
// fingers show some of these fields in tables. User programs, `softgrip status`, `softgrip doctor` and
// Prometheus read health.json. docs/how-to/watch-a-finger.md lists its keys.

#include "base/result/result.h"
#include "base/time.h"
#include "sysid/health/recorded_health.h"

namespace softgrip::sysid::health {

/// Name of the result file in the output folder.
inline constexpr const char* health_file = "health.json";

/// Returns the fields of an alarm of the finger.
[[nodiscard]] result::Fields alarm_fields(const FingerHealth& health, const HealthAlarm& alarm);
/// Returns the latest value of an indicator of the finger, and the reference of this indicator.
[[nodiscard]] result::Fields number_fields(const FingerHealth& health, std::size_t number);
/// Returns the fields of one finger.
[[nodiscard]] result::Fields fields_of(const FingerHealth& health, const Suspicion& suspicion);
/// Returns the fields of a change that several fingers share.
[[nodiscard]] result::Fields fields_of(const SharedChange& shared);
/// Returns the content of health.json.
/// @param now  creation time that is written to the file.
[[nodiscard]] result::Fields fields_of(const RecordedHealth& health, Nanoseconds now);

}  // namespace softgrip::sysid::health
