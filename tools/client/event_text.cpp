#include "tools/client/event_text.h"

#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "document/problem.h"

namespace softgrip::tools {

std::string line_of_event(const nlohmann::ordered_json& event) {
  constexpr std::size_t time_columns = 11;
  constexpr std::size_t severity_columns = 13;
  constexpr std::size_t longest_text = 1000;
  std::string time = fixed(event.value("time_s", 0.0), 3);
  if (time.size() < time_columns) time.insert(0, time_columns - time.size(), ' ');
  std::string severity = event.value("severity", "");
  severity.resize(severity_columns, ' ');
  return time + " s  " + severity + document::shown(event.value("text", ""), longest_text);
}

}  // namespace softgrip::tools
