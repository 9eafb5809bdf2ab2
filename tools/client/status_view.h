#pragma once
// Formats a status of the daemon as text. `softgrip status` prints it once, `softgrip watch` repeatedly.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/styled_line.h"
#include "tools/client/trend.h"

namespace softgrip::tools {

/// The parts of a status as lines, so that a screen can arrange them. A missing value is shown as "-".
struct StatusParts {
  std::vector<std::string> head;  ///< lines with state, sequence, pressurised fingers and fault
  std::vector<std::vector<std::string>> channels;
  std::vector<std::string> board;      ///< lines with the connection to the board and the attempts to restore
                                       ///< it
  std::vector<std::string> machinery;  ///< lines with the state of the control loop and of the recording
};
/// Formats the parts of a status. If `trends` contains one element per channel, trends replace the bars.
[[nodiscard]] StatusParts parts_of(const nlohmann::ordered_json& status, const ViewStyle& style,
                                   const std::vector<ChannelTrends>* trends = nullptr);

/// Returns the lines of all parts in one list.
[[nodiscard]] std::vector<std::string> view_of(const nlohmann::ordered_json& status, const ViewStyle& style);

/// Returns the status in one line, for logs and pipes.
[[nodiscard]] std::string line_of_status(const nlohmann::ordered_json& status);

}  // namespace softgrip::tools
