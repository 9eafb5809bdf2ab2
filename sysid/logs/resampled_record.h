#pragma once
// A record with other samples: the only place that leaves samples out, averages them or adds some.
//
// Every function takes a record as it is and returns another one of the same run. Where nothing has to be
// left out it returns the record unchanged.

#include <cstddef>
#include <span>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Readings that show a finger completely: an hour at 10 Hz, or seven minutes at 100 Hz. The time of a
/// diagnosis and of a choice of structure grows with their number.
inline constexpr std::size_t enough_readings = 40'000;

/// The samples at `kept` (ascending, the first is 0), with durations between them; of irregular sampling
/// where nothing else is said.
[[nodiscard]] Record thinned_record(const Record& record, std::span<const std::size_t> kept);
/// Every `stride`-th sample of a record, from the first on: for a first look at many starts. A command that
/// is held is the mean of what was held; one that jumps between two samples keeps its mean around them, since
/// the jump would come up to a whole interval early or late; corners without a jump stay as sharp as they
/// are.
[[nodiscard]] Record thinned_record(const Record& record, std::size_t stride);
/// Thinned so that samples are at most `interval_s` apart, unless they are farther apart already.
[[nodiscard]] Record thinned_to(const Record& record, double interval_s);
/// Thinned likewise, and each reading the mean of those that are nearer to it than to any other that is left:
/// their noise falls with the root of their number. A motion is not blurred as long as it bends little within
/// `interval_s`.
[[nodiscard]] Record averaged_to(const Record& record, double interval_s);
/// All records averaged so that about `most` readings are left in all. No mean covers more than `longest_s`,
/// so of a very long campaign more readings are left.
[[nodiscard]] std::vector<Record> averaged_to_count(std::vector<Record> records, std::size_t most,
                                                    double longest_s);
/// The first sample, and of every interval of such a length, counted from it, the sample that is nearest to
/// its middle: what is reckoned there stands for the interval's mean, but for how much it bends in it. A
/// record that is coarser already stays as it is.
[[nodiscard]] Record thinned_to_centres(const Record& record, double interval_s);
/// Divides every step into `parts` equal parts. Between samples drive and surroundings go straight, a held
/// drive stays where it was; readings are known at the samples alone.
/// @param parts  1 and more: sample i of the record is sample i parts of the finer one.
[[nodiscard]] Record finer_record(const Record& record, std::size_t parts);
/// All samples, and of the readings every k-th of each record, so that at most about `most` are left in all.
[[nodiscard]] std::vector<Record> with_fewer_readings(std::vector<Record> records, std::size_t most);
/// Every `stride`-th row of a log: times, pressures, readings and supply. Other columns stay as they are.
[[nodiscard]] Log thinned_log(const Log& log, std::size_t stride);

}  // namespace softgrip::sysid
