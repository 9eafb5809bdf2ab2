#pragma once
// A status of the daemon as text for people: `softgrip status` prints it once, `softgrip watch` again and
// again.

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::tools {

struct ViewStyle {
  std::size_t columns = 80;  ///< no line is longer
  bool colour = false;       ///< ANSI colours
  bool unicode = false;      ///< block characters in bars
};

/// The whole status, a line each, without line breaks. A status that lacks something shows "-" there.
[[nodiscard]] std::vector<std::string> view_of(const nlohmann::ordered_json& status, const ViewStyle& style);

/// The status in one line, for logs and pipes.
[[nodiscard]] std::string line_of_status(const nlohmann::ordered_json& status);

}  // namespace softgrip::tools
