#include "tools/commands/diagnose_change.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/numbers.h"
#include "base/result/result.h"
#include "model/file/model_file.h"
#include "sysid/changes/change_report.h"
#include "sysid/changes/next_steps.h"
#include "sysid/pages/page.h"
#include "tools/command_line/command.h"
#include "tools/command_line/progress_line.h"
#include "tools/figures/figure_files.h"
#include "tools/investigation/diagnosis_folder.h"

namespace softgrip::tools {
namespace {

result::Value sources_of(const std::vector<sysid::Log>& logs) {
  return result::list_of(logs, [](const sysid::Log& log) -> result::Fields {
    return {{"path", log.path}, {"sha256", log.sha256}};
  });
}

void print_cause(const sysid::ChangeCause& cause) {
  std::printf("  %-26s %s, 95 %%: %s (%s %s at full pressure)\n", cause.id.c_str(), size_text(cause).c_str(),
              interval_text(cause).c_str(), significant(cause.full_pressure_mm, 3).c_str(),
              unit_of(cause.judged, cause.output_unit).c_str());
  for (const std::string& alternative : cause.alternatives)
    std::printf("      alternative cause: %s explains the change too\n", alternative.c_str());
  for (const std::string_view step : sysid::next_steps(cause.id))
    std::printf("      - %s\n", std::string(step).c_str());
}

void print_explanation(const sysid::JudgedChange& judged) {
  std::printf("\n%s: model \"%s\", %zu healthy run%s\n", name_of(judged.judged), judged.base.c_str(),
              judged.healthy_runs, judged.healthy_runs == 1 ? "" : "s");
  std::printf(
      "  error of held-out healthy runs %s %s; limit for a further healthy run %s; error of the later logs "
      "%s\n",
      significant(judged.healthy_mm, 3).c_str(), unit_of(judged.judged, judged.output_unit).c_str(),
      significant(judged.allowed_mm, 3).c_str(), significant(judged.later_mm, 3).c_str());
  std::printf("  whitened squared error of the later logs %s (1: equal to the error of healthy runs)\n",
              significant(judged.loss_before, 3).c_str());
  std::printf("%s\n%s", result::text_of(sysid::run_table(judged)).c_str(),
              result::text_of(sysid::tried_table(judged)).c_str());
  for (const auto& [id, recording] : judged.not_tested)
    std::printf("  %-26s not tested: %s\n", id.c_str(), recording.c_str());
}

void print_summary(const sysid::ChangeDiagnosis& d, const std::string& out) {
  std::printf("%s\n\n", sysid::change_sentence(d).c_str());
  for (const sysid::ChangeCause& cause : d.causes) print_cause(cause);
  if (!d.partial.empty()) std::puts("  Partial explanations, too small to be reported as the cause:");
  for (const sysid::ChangeCause& cause : d.partial) print_cause(cause);
  for (const sysid::JudgedChange& judged : d.readings) {
    std::printf(
        "  %-12s noise %s; residual of the baseline model: %s on baseline logs, %s on later logs, %s with "
        "the causes %s\n",
        name_of(judged.judged), significant(judged.noise_mm, 2).c_str(),
        significant(judged.healthy_mm, 3).c_str(), significant(judged.later_mm, 3).c_str(),
        significant(judged.explained_mm, 3).c_str(), unit_of(judged.judged, judged.output_unit).c_str());
  }
  for (const std::string& warning : d.warnings) std::printf("warning: %s\n", warning.c_str());
  std::printf("%s s; report: %s\n", significant(d.wall_s, 3).c_str(),
              (std::filesystem::path(out) / "report.html").c_str());
}

}  // namespace

ExitCode run_change(ChangeQuestion question) {
  question.options.given = question.given;
  const auto diagnosis = [&] {
    ProgressLine line;
    question.options.progress = line.show();
    return sysid::diagnose_change(question.healthy, question.later, question.options);
  }();
  if (!diagnosis) return fail(ExitCode::input_refused, diagnosis.error());
  result::Fields fields = sysid::fields_of(*diagnosis);
  const result::Fields given{{"name", question.given.name}, {"hash", model::model_hash(question.given)}};
  fields.emplace_back("made_of", result::Fields{{"software", sysid::software_and_version()},
                                                {"call", question.call},
                                                {"model", question.given.name},
                                                {"given", given},
                                                {"healthy", sources_of(question.healthy)},
                                                {"data", sources_of(question.later)}});
  const std::string text = result::json_text(fields);
  remove_results_of_a_model(question.out);
  const sysid::Page page = sysid::change_page(*diagnosis, question.healthy, question.later, question.given);
  if (const auto written = write_report(question.out, {{"diagnosis.json", text}}, page, question.figures);
      !written)
    return fail(ExitCode::io, written.error());
  if (question.json) {
    std::fputs(text.c_str(), stdout);
  } else {
    print_summary(*diagnosis, question.out);
    if (question.explain) std::ranges::for_each(diagnosis->readings, print_explanation);
  }
  return ExitCode::done;
}

}  // namespace softgrip::tools
