#pragma once
// Formats a status of the daemon as text. `softgrip status` prints it once, `softgrip watch` repeatedly.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/styled_line.h"
#include "tools/client/trend.h"

namespace softgrip::tools {

/// The parts of a status that a screen can arrange, as lines. A missing value is shown as "-".
struct StatusParts {
  std::vector<std::string> head;  ///< state and sequence, pressurised fingers, the fault
  std::vector<std::vector<std::string>> channels;
  std::vector<std::string> board;      ///< connection to the board, and the attempts to restore it
  std::vector<std::string> machinery;  ///< control loop and recording
};
/// Formats the parts. With `trends` (one per channel), bars are replaced by the trends.
[[nodiscard]] StatusParts parts_of(const nlohmann::ordered_json& status, const ViewStyle& style,
                                   const std::vector<ChannelTrends>* trends = nullptr);

/// Returns all parts, one below the other.
[[nodiscard]] std::vector<std::string> view_of(const nlohmann::ordered_json& status, const ViewStyle& style);

/// Returns the status in one line, for logs and pipes.
[[nodiscard]] std::string line_of_status(const nlohmann::ordered_json& status);

}  // namespace softgrip::tools
