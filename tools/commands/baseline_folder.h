#pragma once
// What `softgrip baseline` leaves and `softgrip diagnose --baseline` reads: healthy_1.csv ..., second_1.csv
// ... of the run that checked them, gauge.csv, model.yaml, and baseline.json with where they came from.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/changes/change.h"

namespace softgrip::tools {

struct Baseline {
  std::vector<std::string> logs;    ///< paths inside the folder, in order
  std::vector<std::string> second;  ///< of the second run; empty: there was none
  std::string model;                ///< path of model.yaml
  std::string gauge;                ///< path of gauge.csv; empty: the sensor was not checked
};

/// A file that goes into the folder.
struct BaselineFile {
  std::string source;  ///< where it came from, for people
  std::string bytes;
};

struct BaselineContents {
  std::vector<BaselineFile> healthy;
  std::vector<BaselineFile> second;
  std::optional<BaselineFile> gauge;
  model::Model model;
};

/// The files of logs, byte by byte.
[[nodiscard]] tl::expected<std::vector<BaselineFile>, std::string> files_of(
    const std::vector<sysid::Log>& logs);
/// Any one file.
[[nodiscard]] tl::expected<BaselineFile, std::string> baseline_file(const std::string& path);

/// Names of the files that write_baseline() writes or replaces; `*` is a number.
[[nodiscard]] std::vector<std::string> baseline_files();

/// Writes the folder. One that was not there appears whole or not at all, and Ctrl-C waits for it. Returns
/// the text of baseline.json.
/// @param about  what baseline.json says besides.
[[nodiscard]] tl::expected<std::string, std::string> write_baseline(const std::string& folder,
                                                                    const BaselineContents& contents,
                                                                    nlohmann::ordered_json about);

/// Reads baseline.json and compares the hashes of what it names; a folder that is none, or in which something
/// was changed, is refused with a sentence.
[[nodiscard]] tl::expected<Baseline, std::string> read_baseline(const std::string& folder);

}  // namespace softgrip::tools
