#pragma once
// Warns about a readable log whose signs, scales or units are probably wrong.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The column of a file from which a log's pressure was read, and its role in an import.
struct PressureColumn {
  std::string name = "pressure_command_kpa";
  std::string role = "command";
};

/// Returns sentences, each with its evidence (a number) and a remedy, about these findings: the reading
/// decreases when the pressure increases; the reading precedes the pressure; the finger touched an object;
/// command and measured pressure differ by the ratio of two units; the measured pressure precedes the
/// command; the pressure is absolute; a span is impossible for a soft finger; the samples are too far apart.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const Log& log,
                                                             const PressureColumn& column = {});

/// Returns the warnings about each log. If there are several logs, each warning begins with the log's name.
/// Also reports logs that repeat the samples of an earlier log, and logs whose motion differs from that of
/// the others by the ratio of two units.
[[nodiscard]] std::vector<std::string> plausibility_warnings_among(const std::vector<Log>& logs);

/// Returns a sentence if readings and predictions of a model differ by the ratio of two units, otherwise "".
/// A reading that is NaN is missing.
[[nodiscard]] std::string scale_warning(const std::string& log_name, const std::vector<double>& prediction_mm,
                                        const std::vector<double>& reading_mm, model::OutputUnit unit);

}  // namespace softgrip::sysid
