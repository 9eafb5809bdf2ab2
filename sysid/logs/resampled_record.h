#pragma once
// Resampling of records. Only this file removes, averages or adds samples.
//
// Each function returns another record of the same run. If no sample has to be removed, it returns the record
// unchanged.

#include <cstddef>
#include <span>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A number of readings that describes a finger completely: one hour at 10 Hz, or seven minutes at 100 Hz.
/// The duration of a diagnosis and of a choice of structure increases with this number.
inline constexpr std::size_t enough_readings = 40'000;

/// Returns the samples at `kept` (ascending, the first is 0) with the durations between them. The sampling of
/// the result counts as irregular.
[[nodiscard]] Record thinned_record(const Record& record, std::span<const std::size_t> kept);
/// Returns every `stride`-th sample, beginning with the first, for a coarse fit from many starting points. A
/// held command is replaced by its mean over the removed samples. If the command jumps between two kept
/// samples, these have the local mean of the command; otherwise the jump would be early or late by up to one
/// interval. Corners without a jump are unchanged.
[[nodiscard]] Record thinned_record(const Record& record, std::size_t stride);
/// Thins a record as far as the samples remain at most `interval_s` apart.
[[nodiscard]] Record thinned_to(const Record& record, double interval_s);
/// Thins a record like thinned_to() and replaces each reading by the mean of the readings that are nearest to
/// it. The noise decreases with the square root of their number. A motion is preserved if it is almost linear
/// within `interval_s`.
[[nodiscard]] Record averaged_to(const Record& record, double interval_s);
/// Averages all records so that about `most` readings remain in total. No mean covers more than `longest_s`,
/// so more readings remain of a very long campaign.
[[nodiscard]] std::vector<Record> averaged_to_count(std::vector<Record> records, std::size_t most,
                                                    double longest_s);
/// Returns the first sample, and the sample that is nearest to the middle of each interval of length
/// `interval_s` after it. A value computed there approximates the mean of the interval, except for its
/// curvature. A record with larger intervals is returned unchanged.
[[nodiscard]] Record thinned_to_centres(const Record& record, double interval_s);
/// Divides each step into `parts` equal parts. Between samples, drive and surroundings are linear; a held
/// drive is constant. Only the original samples have readings.
/// @param parts  at least 1: sample i of the record is sample i * parts of the result.
[[nodiscard]] Record finer_record(const Record& record, std::size_t parts);
/// Keeps all samples, but only every k-th reading of each record, so that at most about `most` readings
/// remain in total.
[[nodiscard]] std::vector<Record> with_fewer_readings(std::vector<Record> records, std::size_t most);
/// Returns every `stride`-th row of a log: times, pressures, readings and supply. Other columns remain
/// unchanged.
[[nodiscard]] Log thinned_log(const Log& log, std::size_t stride);

}  // namespace softgrip::sysid
