#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/diagnosis/experiments/experiment.h"

namespace softgrip::sysid {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel) {
  const JudgedWaveform& best = experiment.best.value();
  return "# Proposed by softgrip diagnose to separate " + enumerated(experiment.separates, " and ") + " by " +
         significant(experiment.predicted_separation_sigma, 3) + " standard deviations (predicted), in " +
         significant(best.minutes, 3) + " minutes of motion on the rig.\n" +
         sequence_yaml(best.waveform, channel);
}

std::string sequence_yaml(const Waveform& waveform, const std::string& channel) {
  std::string yaml = "name: " + waveform.name + "\nabout: \"" + waveform.about + "\"\n";
  if (!channel.empty()) yaml += "channels: [" + channel + "]\n";
  yaml += "steps:\n  - pressure:\n      points:\n";
  for (const Corner& corner : waveform.corners) {
    yaml += "        - {time_s: " + shortest(corner.time_s) +
            ", pressure_kpa: " + shortest(corner.pressure_kpa) + "}\n";
  }
  return yaml;
}

void add_experiment(Json& json, const NextExperiment& experiment, const std::string& file) {
  json["next_experiment"] = nullptr;
  if (experiment.best) {
    const JudgedWaveform& best = *experiment.best;
    Json separations = Json::array();
    for (const Separation& s : best.separations)
      separations.push_back({{"pair", {s.one, s.other}}, {"sigma", s.sigma}});
    json["next_experiment"] = {{"file", file},
                               {"separates", experiment.separates},
                               {"predicted_separation_sigma", experiment.predicted_separation_sigma},
                               {"minutes", best.minutes},
                               {"waveform", best.waveform.name},
                               {"separations", std::move(separations)}};
  }
  json["gauge_check"] = nullptr;
  if (const auto& check = experiment.gauge_check) {
    json["gauge_check"] = {{"file", gauge_positions_file},
                           {"separates", check->separates},
                           {"readings", check->positions_mm.size()},
                           {"minutes", check->minutes}};
  }
  Json menu = Json::array();
  for (const JudgedWaveform& judged : experiment.menu) {
    double least = judged.separations.empty() ? 0 : judged.separations.front().sigma;
    for (const Separation& s : judged.separations) least = std::min(least, s.sigma);
    menu.push_back({{"waveform", judged.waveform.name}, {"minutes", judged.minutes}, {"least_sigma", least}});
  }
  json["experiments_judged"] = std::move(menu);
  json["experiment_advice"] = experiment.advice;
}

}  // namespace softgrip::sysid
