#pragma once
// A status of the daemon as text for people: `softgrip status` prints it once, `softgrip watch` again and
// again.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/client/styled_line.h"
#include "tools/client/trend.h"

namespace softgrip::tools {

/// The status in the pieces that a screen may arrange, a line each, without line breaks. What a status lacks
/// is shown as "-".
struct StatusParts {
  std::vector<std::string> head;  ///< state and sequence; pressure that stays on; the fault
  std::vector<std::vector<std::string>> channels;
  std::vector<std::string> board;      ///< and what is tried where it does not answer
  std::vector<std::string> machinery;  ///< loop, recording
};
/// With `trends` (one per channel) they take the place of the bars.
[[nodiscard]] StatusParts parts_of(const nlohmann::ordered_json& status, const ViewStyle& style,
                                   const std::vector<ChannelTrends>* trends = nullptr);

/// All of it, one below the other.
[[nodiscard]] std::vector<std::string> view_of(const nlohmann::ordered_json& status, const ViewStyle& style);

/// The status in one line, for logs and pipes.
[[nodiscard]] std::string line_of_status(const nlohmann::ordered_json& status);

}  // namespace softgrip::tools
