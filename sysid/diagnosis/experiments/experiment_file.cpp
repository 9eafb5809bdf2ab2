#include <algorithm>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/diagnosis/experiments/experiment.h"

namespace softgrip::sysid {

using result::Fields, result::list_of, result::or_null, result::Value;

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

Fields fields_of(const NextExperiment& experiment) {
  const auto of_pair = [](const Separation& s) -> Fields {
    return {{"pair", Value::List{s.one, s.other}}, {"sigma", s.sigma}};
  };
  const auto of_best = [&](const JudgedWaveform& best) -> Fields {
    return {{"file", experiment_file},
            {"separates", experiment.separates},
            {"predicted_separation_sigma", experiment.predicted_separation_sigma},
            {"minutes", best.minutes},
            {"waveform", best.waveform.name},
            {"separations", list_of(best.separations, of_pair)}};
  };
  const auto of_check = [](const ProposedGaugeCheck& check) -> Fields {
    return {{"file", gauge_positions_file},
            {"separates", check.separates},
            {"readings", check.positions_mm.size()},
            {"minutes", check.minutes}};
  };
  const auto of_waveform = [](const JudgedWaveform& judged) -> Fields {
    double least = judged.separations.empty() ? 0 : judged.separations.front().sigma;
    for (const Separation& s : judged.separations) least = std::min(least, s.sigma);
    return {{"waveform", judged.waveform.name}, {"minutes", judged.minutes}, {"least_sigma", least}};
  };
  return {{"next_experiment", or_null(experiment.best, of_best)},
          {"gauge_check", or_null(experiment.gauge_check, of_check)},
          {"experiments_judged", list_of(experiment.menu, of_waveform)},
          {"experiment_advice", experiment.advice}};
}

}  // namespace softgrip::sysid
