#pragma once
// Plausibility warnings: signs, scales and units of a log that are probably wrong although the log can be
// read.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The column that the pressure of a log is from, and its role in an import.
struct PressureColumn {
  std::string name = "pressure_command_kpa";
  std::string role = "command";
};

/// Returns sentences, each with its evidence (a number) and its remedy. They report a reading that falls when
/// the pressure rises or moves before it, a grip taken for free motion, a command and a measured pressure
/// that differ by the factor of a unit or where the measured one comes first, absolute pressure, spans that
/// no soft finger has, and samples too far apart.
[[nodiscard]] std::vector<std::string> plausibility_warnings(const Log& log,
                                                             const PressureColumn& column = {});

/// Returns the warnings of every log, each with the log's name if there are several. It also reports logs
/// with the samples of an earlier one, and logs in which the motion of the finger differs from the others by
/// the factor of two units.
[[nodiscard]] std::vector<std::string> plausibility_warnings_among(const std::vector<Log>& logs);

/// Returns a sentence if the readings differ from the prediction of a model by the factor of two units, else
/// "". NaN: no reading.
[[nodiscard]] std::string scale_warning(const std::string& log_name, const std::vector<double>& prediction_mm,
                                        const std::vector<double>& reading_mm, model::OutputUnit unit);

}  // namespace softgrip::sysid
