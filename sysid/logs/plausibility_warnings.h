#pragma once
// Plausibility warnings about a readable log: signs, scales and units that are probably wrong.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The source column of a log's pressure, and its role in an import.
struct PressureColumn {
  std::string name = "pressure_command_kpa";
  std::string role = "command";
};

/// Returns sentences, each with its evidence (a number) and a remedy. They report: a reading that decreases
/// when the pressure increases, or that precedes it; a grip that was recorded as free motion; a command and a
/// measured pressure that differ by the factor of a unit; a measured pressure that precedes the command;
/// absolute pressure; spans that are impossible for a soft finger; and samples that are too far apart.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const Log& log,
                                                             const PressureColumn& column = {});

/// Returns the warnings of each log, with the log's name if there are several logs. Also reports logs that
/// repeat the samples of an earlier log, and logs whose motion differs from the others by the ratio of two
/// units.
[[nodiscard]] std::vector<std::string> plausibility_warnings_among(const std::vector<Log>& logs);

/// Returns a sentence if the readings differ from the prediction of a model by the ratio of two units,
/// otherwise "". NaN: no reading.
[[nodiscard]] std::string scale_warning(const std::string& log_name, const std::vector<double>& prediction_mm,
                                        const std::vector<double>& reading_mm, model::OutputUnit unit);

}  // namespace softgrip::sysid
