#pragma once
// Resamples records. Only this file removes, averages or adds samples.
//
// Each function returns a new record of the same recorded run. If no sample has to be removed, the result is
// an unchanged copy.

#include <cstddef>
#include <span>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Number of readings that is sufficient for a diagnosis: about 1000 readings for each parameter of the
/// largest structures. With more readings, a diagnosis or the choice of a model structure takes more time but
/// does not become more accurate.
inline constexpr std::size_t enough_readings = 20'000;

/// Returns the samples with the indices `kept`, with the durations between these samples. The sampling of the
/// result counts as irregular.
/// @param kept  ascending indices; the first is 0.
[[nodiscard]] Record thinned_record(const Record& record, std::span<const std::size_t> kept);
/// Returns every `stride`-th sample, beginning with the first, for a coarse fit from many starting points. A
/// held command is replaced by its mean from the kept sample to the next kept sample. If the command jumps
/// between two kept samples, each of the two gets the local mean of the command. Without this mean, the jump
/// would be early or late by up to one interval of the kept samples. A command whose slope changes without a
/// jump keeps its values.
[[nodiscard]] Record thinned_record(const Record& record, std::size_t stride);
/// Keeps every n-th sample of a record. n is the largest number for which the mean interval between kept
/// samples is at most `interval_s`; it is at least 1.
[[nodiscard]] Record thinned_to(const Record& record, double interval_s);
/// Removes samples of a record as thinned_to() does, and replaces each kept reading by the mean of the
/// readings around this reading. The noise decreases with the square root of the number of averaged readings.
/// A motion is preserved if it is almost linear within `interval_s`.
[[nodiscard]] Record averaged_to(const Record& record, double interval_s);
/// Averages all records so that about `most` readings remain in total. Each mean covers at most `longest_s`.
/// If the campaign is very long, more than `most` readings therefore remain.
[[nodiscard]] std::vector<Record> averaged_to_count(std::vector<Record> records, std::size_t most,
                                                    double longest_s);
/// Returns the first sample of the record and one sample from each following interval of length `interval_s`:
/// the sample that is nearest to the middle of the interval. If the signal is nearly linear in the interval,
/// the value at this sample approximates the mean over the interval. If the mean interval between samples is
/// at least `interval_s`, the record is returned unchanged.
[[nodiscard]] Record thinned_to_centres(const Record& record, double interval_s);
/// Divides each step into `parts` equal parts. The drive, the temperature and the supply are interpolated
/// linearly; a held drive is constant within a step. Only the original samples have readings.
/// @param parts  at least 1; sample i of the record becomes sample i * parts of the result.
[[nodiscard]] Record finer_record(const Record& record, std::size_t parts);
/// Keeps all samples, but removes all readings of each record except every k-th reading, so that about `most`
/// readings or fewer remain in total.
[[nodiscard]] std::vector<Record> with_fewer_readings(std::vector<Record> records, std::size_t most);
/// Shortens all records by the same factor so that at most about `most` samples remain in total. Keeps the
/// first samples of each record, and at least two.
[[nodiscard]] std::vector<Record> first_samples(std::vector<Record> records, std::size_t most);
/// Returns a log with every `stride`-th sample, beginning with the first.
/// @param stride  at least 1.
[[nodiscard]] Log thinned_log(const Log& log, std::size_t stride);

}  // namespace softgrip::sysid
