#include "sysid/health/scored_run.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.h"

namespace softgrip::sysid::health {
namespace {

using Json = nlohmann::ordered_json;

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

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
    ScoredRun run{text_at(line, "run"),    text_at(line, "finger"),   text_at(line, "started_at"),
                  text_at(line, "recipe"), text_at(line, "baseline"), {}};
    for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
      const auto value = line.find(sysid::health_number_infos[i].id);
      if (value != line.end() && value->is_number()) run.score.values[i] = value->get<double>();
    }
    const auto temperature = line.find("temperature_c");
    if (temperature != line.end() && temperature->is_number()) run.temperature_c = temperature->get<double>();
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
