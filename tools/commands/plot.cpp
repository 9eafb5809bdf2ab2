// softgrip plot: a recording as a picture.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/command_line/log_input.h"
#include "tools/command_line/output.h"
#include "tools/commands/commands.h"
#include "tools/recordings/recording.h"
#include "tools/recordings/recording_picture.h"
#include "tools/recordings/recording_tracking.h"

namespace softgrip::tools {
namespace {

struct Options {
  std::string recording;
  std::string out;
  bool json = false;
};

void report(const Options& options, const Recording& recording) {
  std::FILE* const stream = report_stream(options.out);
  nlohmann::ordered_json json{{"out", options.out}, {"channels", nlohmann::ordered_json::array()}};
  for (const sysid::Log& log : recording.channels) {
    const Tracking tracking = tracking_of(log);
    const std::string name = log.channel.empty() ? recording.name : log.channel;
    nlohmann::ordered_json entry{{"channel", log.channel}, {"samples", log.size()}};
    if (tracking.free_samples > 0) {
      entry["tracking"] = {{"grips_known", tracking.grips_known},
                           {"samples", tracking.free_samples},
                           {"rmse_mm", tracking.free_rmse_mm},
                           {"largest_mm", tracking.free_largest_mm}};
    }
    if (tracking.gripping_samples > 0) {
      entry["gripping"] = {{"samples", tracking.gripping_samples},
                           {"short_of_reference_mm", tracking.gripping_largest_mm}};
    }
    json["channels"].push_back(std::move(entry));
    if (options.json) continue;
    const std::string told = to_text(tracking);
    std::fprintf(stream, "%s: %zu samples%s%s\n", name.c_str(), log.size(), told.empty() ? "" : "; ",
                 told.c_str());
  }
  if (options.json) {
    std::fprintf(stream, "%s\n", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    std::fprintf(stream, "-> %s\n", options.out.c_str());
  }
}

ExitCode run(const Options& options) {
  if (!is_stream(options.out) && std::filesystem::path(options.out).extension() != ".svg")
    return fail(ExitCode::usage, "plot writes SVG: " + options.out + " does not end in .svg");
  document::Problems problems;
  const auto recording = read_recording(options.recording, problems);
  if (!recording) return problems.empty() ? recording.error() : refuse_logs(problems);
  if (const auto written = write_output(options.out, picture_of(*recording)); !written) {
    return fail(ExitCode::io, written.error());
  }
  report(options, *recording);
  return ExitCode::done;
}

}  // namespace

void add_plot(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      program.add_subcommand("plot", "A recording as a picture: pressure, displacement, error, states");
  command->add_option("RECORDING", options->recording, "A recording's folder, or a log (CSV)")->required();
  command->add_option("--out", options->out, "SVG file to write ('-': standard output)")->required();
  command->add_flag("--json", options->json, "Say what was done as JSON");
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
