#include "tools/client/daemon_text.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "document/problem.h"

namespace softgrip::tools {
namespace {

constexpr std::size_t longest_text = 1000;

/// Converts a UTC time such as "2026-11-21T08:32:05.123Z" to local time. Returns "" for a text that is not
/// such a time.
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
  std::string severity = event.value("severity", "");
  severity.resize(severity_columns, ' ');
  const std::string text = severity + document::shown(event.value("text", ""), longest_text);
  if (const std::string at = local_time(event.value("at", "")); !at.empty()) return at + "  " + text;
  std::string time = fixed(event.value("time_s", 0.0), 3);
  if (time.size() < time_columns) time.insert(0, time_columns - time.size(), ' ');
  return time + " s  " + text;
}

std::string sentence_of_acknowledged(const nlohmann::ordered_json& result) {
  constexpr std::size_t longest_name = 100;
  const auto fault = result.find("acknowledged");
  if (fault == result.end() || !fault->is_object()) return "acknowledged; the grip results are cleared";
  const auto text = [&](const char* key) {
    const auto found = fault->find(key);
    const bool is_text = found != fault->end() && found->is_string();
    return is_text ? document::shown(found->get<std::string>(), longest_name) : std::string();
  };
  const std::string channel = text("channel");
  return "acknowledged " + text("code") + " " + text("name") + (channel.empty() ? "" : " of " + channel) +
         "; nothing moves until the next start";
}

std::string failure_reason(const nlohmann::ordered_json& event) {
  const std::string kind = event.value("kind", "");
  if (kind != "not_at_rest" && kind != "fault_latched") return {};
  const std::string channel = event.value("channel", "");
  const std::string text = document::shown(event.value("text", ""), longest_text);
  return channel.empty() || text.starts_with(channel) ? text : channel + ": " + text;
}

std::string brief_line_of_event(const nlohmann::ordered_json& event) {
  constexpr std::size_t date_columns = 11;
  constexpr std::size_t clock_columns = 8;
  const std::string at = local_time(event.value("at", ""));
  const std::string time =
      at.empty() ? fixed(event.value("time_s", 0.0), 1) + " s" : at.substr(date_columns, clock_columns);
  const std::string severity = event.value("severity", "");
  const char* const mark = severity == "error" ? " !! " : severity == "warning" ? " !  " : "    ";
  return time + mark + document::shown(event.value("text", ""), longest_text);
}

}  // namespace softgrip::tools
