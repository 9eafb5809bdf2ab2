#include "tools/client/event_text.h"

#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "document/problem.h"

namespace softgrip::tools {
namespace {

/// "2026-11-21T08:32:05.123Z" in local time; empty of what is no such time.
std::string local_time(const std::string& utc) {
  tm parts{};
  const char* const end = ::strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
  if (end == nullptr) return {};
  const time_t moment = ::timegm(&parts);
  tm local{};
  std::array<char, 32> text{};
  if (::localtime_r(&moment, &local) == nullptr) return {};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S", &local);
  std::string fraction(end);
  if (fraction.ends_with('Z')) fraction.pop_back();
  return text.data() + document::shown(fraction, 10);
}

}  // namespace

std::string line_of_event(const nlohmann::ordered_json& event) {
  constexpr std::size_t time_columns = 11;
  constexpr std::size_t severity_columns = 13;
  constexpr std::size_t longest_text = 1000;
  std::string severity = event.value("severity", "");
  severity.resize(severity_columns, ' ');
  const std::string text = severity + document::shown(event.value("text", ""), longest_text);
  if (const std::string at = local_time(event.value("at", "")); !at.empty()) return at + "  " + text;
  std::string time = fixed(event.value("time_s", 0.0), 3);
  if (time.size() < time_columns) time.insert(0, time_columns - time.size(), ' ');
  return time + " s  " + text;
}

}  // namespace softgrip::tools
