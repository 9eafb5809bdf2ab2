// softgrip export: converts recordings, logs and series for other programs.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/numbers.h"
#include "base/version.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/commands/commands.h"
#include "tools/exporting/c_source.h"
#include "tools/exporting/signals.h"

namespace softgrip::tools {
namespace {

struct ExportOptions {
  std::string input;
  std::string out;
  std::string format;
  std::optional<double> rate_hz;
  double pressure_max_kpa = 100;
  bool json = false;
};

const std::vector<std::string>& formats() {
  static const std::vector<std::string> names{"csv", "mat", "mcap", "c"};
  return names;
}

/// Returns the format that the user requested. If the user requested no format, returns the format for the
/// extension of the output file, or "" if this extension is unknown.
std::string format_of(const ExportOptions& options) {
  if (!options.format.empty()) return options.format;
  std::string ending = std::filesystem::path(options.out).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  const bool known = std::find(formats().begin(), formats().end(), ending) != formats().end();
  return known ? ending : std::string();
}

void report(const ExportOptions& options, const std::string& format, const std::vector<SignalGroup>& groups,
            const std::vector<std::string>& left_out) {
  std::FILE* const stream = report_stream(options.out);
  std::size_t signals = 0;
  std::size_t samples = 0;
  for (const SignalGroup& group : groups) {
    signals += group.signals.size();
    samples += group.time_s.size();
  }
  if (options.json) {
    const nlohmann::ordered_json json{{"out", options.out}, {"format", format},   {"groups", groups.size()},
                                      {"signals", signals}, {"samples", samples}, {"left_out", left_out}};
    std::fprintf(stream, "%s\n", json_dump(json).c_str());
    return;
  }
  for (const std::string& name : left_out)
    std::fprintf(stream, "skipped, because the columns are not numeric: %s\n", name.c_str());
  std::fprintf(stream, "%zu signals, %zu samples -> %s\n", signals, samples, options.out.c_str());
}

ExitCode export_c(const ExportOptions& options) {
  if (!options.rate_hz)
    return fail(
        ExitCode::usage,
        "--format c needs --rate-hz, the number of times per second at which the C function will be called");
  const auto model = read_model(options.input);
  if (!model) return model.error();
  const auto source = c_source(*model, 1 / *options.rate_hz, options.pressure_max_kpa,
                               "softgrip " + std::string(software_version()));
  if (!source) return fail(ExitCode::input_refused, options.input + ": " + source.error());
  if (const auto written = write_output(options.out, source->text); !written)
    return fail(ExitCode::io, written.error());
  std::FILE* const stream = report_stream(options.out);
  if (options.json) {
    const nlohmann::ordered_json json{{"out", options.out},
                                      {"format", "c"},
                                      {"function", source->name + "_step"},
                                      {"inverse", source->no_inverse.empty()},
                                      {"no_inverse", source->no_inverse}};
    std::fprintf(stream, "%s\n", json_dump(json).c_str());
    return ExitCode::done;
  }
  if (!source->no_inverse.empty()) std::fprintf(stream, "no inverse: %s\n", source->no_inverse.c_str());
  std::fprintf(stream, "%s_step(), %s Hz -> %s\n", source->name.c_str(),
               significant(*options.rate_hz).c_str(), options.out.c_str());
  return ExitCode::done;
}

bool is_yaml(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".yaml" || ending == ".yml";
}

/// Returns an exit code if the options contradict each other.
std::optional<ExitCode> refused(const ExportOptions& options, const std::string& format) {
  if (const auto code = refuse_overwriting({options.out}, {options.input})) return code;
  if (format == "c") return std::nullopt;
  if (is_yaml(options.input))
    return fail(ExitCode::usage, options.input +
                                     " is a YAML file, not a recording, log or series. If it is a model, it "
                                     "can only be exported as .c");
  if (options.rate_hz)
    return fail(ExitCode::usage,
                "--rate-hz is permitted only with --format c, because the samples of a recording or log keep "
                "their own times");
  return std::nullopt;
}

ExitCode run(const ExportOptions& options) {
  const std::string format = format_of(options);
  if (format.empty())
    return fail(ExitCode::usage, "the extension of " + options.out +
                                     " is not a known format: use --format csv, mat, mcap or c");
  if (const auto code = refused(options, format)) return *code;
  if (format == "c") return export_c(options);
  if (format == "mat" && is_stream(options.out))
    return fail(ExitCode::usage, "a .mat file cannot be written to " + options.out);
  const auto groups = read_signals(options.input);
  if (!groups) return groups.error();
  std::vector<std::string> left_out;
  tl::expected<void, std::string> written;
  if (format == "mat") {
    auto mat = mat_bytes(wide(*groups));
    if (!mat) return fail(ExitCode::io, options.out + ": " + mat.error());
    left_out = std::move(mat->left_out);
    written = write_output(options.out, mat->bytes);
  } else if (format == "mcap") {
    written = write_output(options.out, mcap_bytes(*groups, "softgrip " + std::string(software_version())));
  } else {
    written = write_output(options.out, wide_csv(wide(*groups)));
  }
  if (!written) return fail(ExitCode::io, written.error());
  report(options, format, *groups, left_out);
  return ExitCode::done;
}

}  // namespace

void add_export(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<ExportOptions>(
      program, outcome, "export", "Export a recording, log or series (wide CSV, MATLAB, MCAP) or a model (C)",
      run);
  command
      ->add_option("INPUT", options->input,
                   "Folder of a recording, a log, or a series.csv; for --format c, a model file")
      ->required();
  command
      ->add_option("--format", options->format,
                   "csv (a column per signal and finger), mat, mcap or c [by the file extension]")
      ->check(CLI::IsMember(formats()));
  command->add_option("--out", options->out, "File to write ('-': standard output)")->required();
  command->add_option("--rate-hz", options->rate_hz, "Calls per second of the C function")
      ->check(number_between(0.1, 100000));
  command
      ->add_option("--pressure-max-kpa", options->pressure_max_kpa,
                   "Highest pressure up to which the inverse of the model must exist")
      ->check(number_between(0.1, 10000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print a summary as JSON");
}

}  // namespace softgrip::tools
