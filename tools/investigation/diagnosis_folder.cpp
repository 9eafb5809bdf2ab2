#include "tools/investigation/diagnosis_folder.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "base/result/result.h"
#include "base/text.h"
#include "model/file/model_file.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/identification/log_report.h"
#include "sysid/pages/page.h"

namespace softgrip::tools {
namespace {

using result::Fields;

/// Name of the file with the invertible part of an extended model. The file is written if the complete model
/// has no inverse.
constexpr const char* feedforward_file = "feedforward_model.yaml";

std::string complete_json(const sysid::Diagnosis& diagnosis, const DiagnosisSource& source,
                          const Consequences& consequences) {
  Fields fields = sysid::fields_of(diagnosis);
  fields.emplace_back("software", sysid::software_and_version());
  fields.emplace_back("call", source.call);
  fields.emplace_back("given",
                      Fields{{"name", source.given.name}, {"hash", model::model_hash(source.given)}});
  fields.emplace_back("model",
                      Fields{{"hash", model::model_hash(diagnosis.extended_model)}, {"file", "model.yaml"}});
  fields.emplace_back("logs", sysid::logs_value(source.logs));
  for (result::Field& field : sysid::fields_of(consequences.experiment)) fields.push_back(std::move(field));
  if (consequences.closed_loop) fields.emplace_back("closed_loop", fields_of(*consequences.closed_loop));
  return result::json_text(fields);
}

}  // namespace

ClosedLoopQuestion closed_loop_question(const sysid::Diagnosis& diagnosis, std::uint64_t seed) {
  ClosedLoopQuestion question;
  question.recalibrated = diagnosis.recalibrated_model;
  question.extended = diagnosis.extended_model;
  question.noise_mm = diagnosis.noise_mm;
  question.seed = seed;
  const sysid::CampaignSize extent = sysid::campaign_size(diagnosis.records);
  question.span_mm = extent.span_mm;
  question.pressure_max_kpa = extent.largest_kpa;
  return question;
}

Consequences consequences_of(const sysid::Diagnosis& diagnosis, const ConsequenceOptions& options) {
  Consequences consequences;
  consequences.experiment = sysid::design_experiment(diagnosis, options.experiment);
  const bool extended = sysid::is_extended(diagnosis);
  if (options.closed_loop && extended)
    consequences.closed_loop = measure_closed_loop(closed_loop_question(diagnosis, options.seed));
  return consequences;
}

std::vector<std::string> diagnosis_files() {
  return {"diagnosis.json", "model.yaml", sysid::experiment_file, feedforward_file};
}

void remove_results_of_a_model(const std::string& folder) {
  const std::filesystem::path out(folder);
  std::error_code ignored;
  if (!std::filesystem::exists(out / "diagnosis.json", ignored)) return;
  for (const std::string& name : diagnosis_files()) {
    if (name != "diagnosis.json") std::filesystem::remove(out / name, ignored);
  }
}

tl::expected<std::string, std::string> write_diagnosis_folder(const std::string& folder,
                                                              const sysid::Diagnosis& diagnosis,
                                                              const DiagnosisSource& source,
                                                              const Consequences& consequences,
                                                              const std::string& channel) {
  const std::filesystem::path out(folder);
  std::vector<std::pair<const char*, std::string>> files{
      {"diagnosis.json", complete_json(diagnosis, source, consequences)},
      {"model.yaml", model::to_yaml(diagnosis.extended_model)}};
  std::error_code ignored;
  if (consequences.experiment.best) {
    files.emplace_back(sysid::experiment_file, sysid::sequence_yaml(consequences.experiment, channel));
  } else {
    std::filesystem::remove(out / sysid::experiment_file, ignored);
  }
  if (consequences.closed_loop && consequences.closed_loop->extended.part) {
    files.emplace_back(feedforward_file, model::to_yaml(consequences.closed_loop->extended.part->model));
  } else {
    std::filesystem::remove(out / feedforward_file, ignored);
  }
  // An existing file is not overwritten or removed, because it may contain readings of the user.
  if (const auto& check = consequences.experiment.gauge_check;
      check && !std::filesystem::exists(out / sysid::gauge_positions_file, ignored)) {
    files.emplace_back(sysid::gauge_positions_file,
                       sysid::positions_csv(check->positions_mm, check->output_unit));
  }
  for (const auto& [name, text] : files) {
    if (const auto written = write_file((out / name).string(), text); !written)
      return tl::unexpected(written.error());
  }
  return std::move(files.front().second);
}

std::string text_of(const Consequences& consequences, const std::string& folder) {
  std::string text;
  const sysid::NextExperiment& next = consequences.experiment;
  if (next.best) {
    text += "next experiment: " + next.best->waveform.name + ", " + significant(next.best->minutes, 2) +
            " minutes, separates " + with_commas(next.separates) + " by " +
            significant(next.predicted_separation_sigma, 3) +
            " standard deviations: " + (std::filesystem::path(folder) / sysid::experiment_file).string() +
            "\n";
  }
  for (const std::string& sentence : next.advice) text += "to separate the causes: " + sentence + "\n";
  if (consequences.closed_loop) {
    const ClosedLoopGain& gain = *consequences.closed_loop;
    const std::string unit = " " + std::string(model::name_of(gain.output_unit));
    text += "in closed loop, " + gain.reference() + ": refitted model " +
            significant(gain.recalibrated.rmse_mm, 3) + unit + ", extended model " +
            significant(gain.extended.rmse_mm, 3) + unit + ", PID alone " +
            significant(gain.pid_alone.rmse_mm, 3) + unit + "\n";
    for (const std::string& note : gain.notes()) text += "  " + note + "\n";
  }
  return text;
}

}  // namespace softgrip::tools
