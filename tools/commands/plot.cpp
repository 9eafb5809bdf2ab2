// softgrip plot: draws a recording or compares two recordings.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "sysid/recordings/recording.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/commands/commands.h"
#include "tools/figures/figure_files.h"
#include "tools/log_input/log_input.h"
#include "tools/recordings/recording_picture.h"

namespace softgrip::tools {
namespace {

struct PlotOptions {
  std::vector<std::string> recordings;
  std::string out;
  std::string channel;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  bool beside = false;
  bool json = false;
};

nlohmann::ordered_json told_of(const PlotOptions& options, const sysid::Recording& recording) {
  std::FILE* const stream = report_stream(options.out);
  nlohmann::ordered_json channels = nlohmann::ordered_json::array();
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
    channels.push_back(std::move(entry));
    if (options.json) continue;
    const std::string told = to_text(tracking);
    std::fprintf(stream, "%s: %zu samples%s%s\n", name.c_str(), log.size(), told.empty() ? "" : "; ",
                 told.c_str());
  }
  return channels;
}

void report(const PlotOptions& options, const std::vector<sysid::Recording>& recordings) {
  std::FILE* const stream = report_stream(options.out);
  nlohmann::ordered_json json{{"out", options.out}};
  json["channels"] = told_of(options, recordings.front());
  if (recordings.size() > 1) json["second"] = {{"channels", told_of(options, recordings.back())}};
  if (options.json) {
    std::fprintf(stream, "%s\n", json_dump(json).c_str());
  } else {
    std::fprintf(stream, "-> %s\n", options.out.c_str());
  }
}

ExitCode run(const PlotOptions& options) {
  // A stream has no file extension, so its format is SVG.
  const auto format = is_stream(options.out) ? PictureFormat::svg : picture_format_of(options.out);
  if (!format)
    return fail(ExitCode::usage, "plot writes " + std::string(picture_formats()) +
                                     ", selected by the extension: " + options.out +
                                     " has a different extension");
  if (const auto code = refuse_overwriting({options.out}, options.recordings)) return *code;
  if (!(options.from_s < options.to_s)) return fail(ExitCode::usage, "--from must be below --to");
  std::vector<sysid::Recording> recordings;
  for (const std::string& path : options.recordings) {
    document::Problems problems;
    const auto recording = sysid::read_recording(path, problems);
    if (!recording) return problems.empty() ? fail(ExitCode::io, recording.error()) : refuse_logs(problems);
    auto part = part_of(*recording, options.channel, options.from_s, options.to_s);
    if (!part) return fail(ExitCode::usage, part.error());
    recordings.push_back(std::move(*part));
  }
  const sysid::Figure figure =
      recordings.size() == 1
          ? figure_of(recordings.front())
          : figure_of(recordings[0], recordings[1], options.beside ? Pairing::beside : Pairing::over);
  const auto bytes = bytes_of(figure, *format);
  if (!bytes) return fail(ExitCode::failed, bytes.error());
  if (const auto written = write_output(options.out, *bytes); !written)
    return fail(ExitCode::io, written.error());
  report(options, recordings);
  return ExitCode::done;
}

}  // namespace

void add_plot(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<PlotOptions>(
      program, outcome, "plot", "Plot a recording: pressure, displacement, error, states", run);
  command
      ->add_option("RECORDING", options->recordings,
                   "Folder of a recording, or a log (CSV); if two recordings or logs are given, the second "
                   "is drawn over the first")
      ->required()
      ->expected(1, 2);
  command
      ->add_option("--out", options->out,
                   "File to write: .svg, .pdf, .png or .html ('-': SVG to the standard output)")
      ->required();
  command->add_option("--channel", options->channel, "Draw only this channel");
  command->add_option("--from", options->from_s, "Begin at this time [s]");
  command->add_option("--to", options->to_s, "End at this time [s]");
  command->add_flag("--beside", options->beside,
                    "Draw two recordings side by side instead of over each other");
  command->add_flag("--json", options->json, "Print a summary as JSON");
}

}  // namespace softgrip::tools
