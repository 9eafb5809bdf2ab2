#pragma once
// Writes the folder of `softgrip baseline`, which sysid/changes/baseline_folder.h reads.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/changes/change.h"

namespace softgrip::tools {

/// A file for the baseline folder, with its origin.
struct BaselineFile {
  std::string source;  ///< origin of the file, for example its path, as text
  std::string bytes;
};

struct BaselineContents {
  std::vector<BaselineFile> healthy;
  std::vector<BaselineFile> second;
  std::optional<BaselineFile> gauge;
  model::Model model;
};

/// Reads log files and returns their content unchanged.
[[nodiscard]] tl::expected<std::vector<BaselineFile>, std::string> files_of(
    const std::vector<sysid::Log>& logs);
/// Reads one file of any format and returns its content unchanged.
[[nodiscard]] tl::expected<BaselineFile, std::string> baseline_file(const std::string& path);

/// Returns the names of the files that write_baseline() writes. In a name, `*` represents a number.
[[nodiscard]] std::vector<std::string> baseline_files();

/// Writes the baseline folder, which must not contain a baseline. A new folder appears completely or not at
/// all. Ctrl-C takes effect only after the folder is written. Returns the text of baseline.json.
/// @param about  further members of baseline.json.
[[nodiscard]] tl::expected<std::string, std::string> write_baseline(const std::string& folder,
                                                                    const BaselineContents& contents,
                                                                    nlohmann::ordered_json about);

}  // namespace softgrip::tools
