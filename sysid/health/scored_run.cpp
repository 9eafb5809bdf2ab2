#include "sysid/health/scored_run.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/json.h"

namespace softgrip::sysid::health {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

tl::expected<std::string, std::string> earlier_scores(const std::string& path) {
  if (!is_there(path)) return std::string();
  return read_file(path, largest_health_file);
}

std::vector<ScoredRun> read_scores(std::string_view text) {
  std::vector<ScoredRun> runs;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    begin = end + 1;
    if (!line.is_object()) continue;
    ScoredRun run{json_text(line, "run"),    json_text(line, "finger"),   json_text(line, "started_at"),
                  json_text(line, "recipe"), json_text(line, "baseline"), {}};
    for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
      const Json& value = json_member(line, sysid::health_number_infos[i].id);
      if (value.is_number()) run.score.values[i] = value.get<double>();
    }
    const Json& temperature = json_member(line, "temperature_c");
    if (temperature.is_number()) run.temperature_c = temperature.get<double>();
    runs.push_back(std::move(run));
  }
  return runs;
}

std::string line_of(const ScoredRun& run) {
  Json line{{"run", run.run},
            {"finger", run.finger},
            {"started_at", run.started_at},
            {"recipe", run.recipe},
            {"baseline", run.baseline}};
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    const double value = run.score.values[i];
    line[std::string(sysid::health_number_infos[i].id)] = std::isfinite(value) ? Json(value) : Json(nullptr);
  }
  if (std::isfinite(run.temperature_c)) line["temperature_c"] = run.temperature_c;
  return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace softgrip::sysid::health
