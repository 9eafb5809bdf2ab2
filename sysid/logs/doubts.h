#pragma once
// What is probably not meant in a log that can be read: signs, scales, units.

#include <string>
#include <vector>

#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The column that the pressure of a log is from, and its role in an import.
struct PressureColumn {
  std::string name = "pressure_command_kpa";
  std::string role = "command";
};

/// Sentences, each with the number that gave it away and what would mend it: a reading that falls when the
/// pressure rises or moves before it, a grip taken for free motion, a command and a measured pressure that
/// differ by the factor of a unit or where the measured one comes first, absolute pressure, spans that no
/// soft finger has, samples too far apart.
[[nodiscard]] std::vector<std::string> doubts_about(const Log& log, const PressureColumn& column = {});

/// Those about every log, each with the log's name where there are several, logs with
/// the samples of an earlier one, and logs in which the finger moves as much farther or less far than in the
/// others as two units are apart.
[[nodiscard]] std::vector<std::string> doubts_among(const std::vector<Log>& logs);

/// That the readings are as many times what a model says as two units are apart; "" where they are not. NaN:
/// no reading.
[[nodiscard]] std::string doubt_about_scale(const std::string& log_name,
                                            const std::vector<double>& prediction_mm,
                                            const std::vector<double>& reading_mm, model::OutputUnit unit);

}  // namespace softgrip::sysid
