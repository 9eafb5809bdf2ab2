#include "tools/client/daemon_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "document/problem.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json, const char* key) {
  return document::shown(json.value(key, std::string()), 400);
}

std::string written_at(const Json& json, const char* key) {
  return written(json.value(key, 0.0));
}

/// Formats a unit: " kPa" for "kpa", " mm/s" for "mm_per_s".
std::string unit_of(const Json& parameter) {
  std::string unit = text_of(parameter, "unit");
  if (const std::size_t per = unit.find("_per_"); per != std::string::npos) unit.replace(per, 5, "/");
  if (unit.starts_with("kpa")) unit[1] = 'P';
  if (unit == "hz") unit = "Hz";
  return unit.empty() ? unit : " " + unit;
}

void add_parameters(const Json& parameters, std::vector<std::string>& lines) {
  std::size_t longest = 0;
  for (const Json& parameter : parameters) longest = std::max(longest, text_of(parameter, "name").size());
  for (const Json& parameter : parameters) {
    std::string name = text_of(parameter, "name");
    name.resize(longest, ' ');
    lines.push_back("  " + name + "  " + written_at(parameter, "lower") + " to " +
                    written_at(parameter, "upper") + unit_of(parameter) + ", default " +
                    written_at(parameter, "default") + ": " + text_of(parameter, "about"));
  }
}

}  // namespace

std::vector<std::string> view_of_sequences(const Json& sequences) {
  std::vector<std::string> lines;
  for (const Json& sequence : sequences) {
    const std::string about = text_of(sequence, "about");
    lines.push_back(text_of(sequence, "name") + (about.empty() ? "" : ": " + about));
    add_parameters(sequence.value("parameters", Json::array()), lines);
    const Json problems = sequence.value("problems", Json::array());
    if (!problems.empty()) lines.push_back("  cannot be started:" + problem_list(problems));
  }
  return lines;
}

std::vector<std::string> names_of_sequences(const Json& sequences) {
  std::vector<std::string> names;
  for (const Json& sequence : sequences) names.push_back(text_of(sequence, "name"));
  return names;
}

}  // namespace softgrip::tools
