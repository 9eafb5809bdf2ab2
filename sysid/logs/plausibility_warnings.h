#pragma once
// Warns about a log that can be read, but whose signs, scales or units are probably wrong.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The file column that supplies a pressure of the log, and the name of this pressure in the options of
/// `softgrip import`.
struct PressureColumn {
  std::string name = "pressure_command_kpa";
  std::string role = "command";
};

/// Sign of the factor by which an import has multiplied the readings.
enum class ReadingSign { kept, reversed };

/// Returns sentences about implausible data. Each sentence contains a number as evidence, and a remedy. The
/// sentences are about these findings: the reading decreases when the pressure increases; the reading
/// precedes the pressure; a single sample has a command outside the range of all others; the finger holds a
/// part; command and measured pressure differ by the ratio of two units; the measured pressure precedes the
/// command; the pressure is absolute; the range of the values is implausible for a soft finger; the sampling
/// interval is too long or too short.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const Log& log,
                                                             const PressureColumn& column = {},
                                                             ReadingSign sign = ReadingSign::kept);

/// Returns the notes about values that were replaced or removed when the logs were read. Each one begins with
/// the name of its log.
[[nodiscard]] std::vector<std::string> corrections_of(const std::vector<Log>& logs);

/// The effect of repeated samples on a result with confidence intervals.
inline constexpr std::string_view repeated_in_fit =
    "Repeated samples make the confidence intervals too narrow";

/// Returns the corrections and the warnings about each log. If there are several logs, each warning begins
/// with the name of the log. Also reports logs that repeat the samples of an earlier log, and logs whose
/// motion differs from the motion of the other logs by the ratio of two units.
/// @param repeated  sentence without a full stop: the effect of repeated samples on the result.
[[nodiscard]] std::vector<std::string> plausibility_warnings_among(
    const std::vector<Log>& logs, std::string_view repeated = repeated_in_fit);

/// Returns one warning for each log with the same samples as a log in `earlier`.
/// @param kind  name of the logs in `earlier`, for example "the healthy log".
/// @param repeated  sentence without a full stop: the effect of repeated samples on the result.
[[nodiscard]] std::vector<std::string> repetition_warnings(const std::vector<Log>& logs,
                                                           const std::vector<Log>& earlier,
                                                           const std::string& kind,
                                                           std::string_view repeated);

/// Returns a sentence if the readings and the predictions of a model differ by the ratio of two units, or by
/// more than a factor of 3; otherwise "". NaN is a missing reading.
[[nodiscard]] std::string scale_warning(const std::string& log_name, const std::vector<double>& prediction_mm,
                                        const std::vector<double>& reading_mm, model::OutputUnit unit);

}  // namespace softgrip::sysid
