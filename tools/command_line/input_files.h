#pragma once
// Finds and reads the input files of commands: configuration and models.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "document/problem.h"
#include "model/model.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

/// Returns the path of a file or folder of the configuration, for example "rig.yaml" or "boards". The file or
/// folder in ./config is used if it exists, otherwise the file or folder in the installed configuration.
[[nodiscard]] std::string configuration_path(const std::string& name);
/// Returns the path of the folder with the installed configuration.
[[nodiscard]] std::string installed_configuration();
/// Returns the sorted names of the YAML files in a folder, without their extension. Returns an empty list if
/// the folder is unreadable.
[[nodiscard]] std::vector<std::string> document_names(const std::filesystem::path& folder);

/// Returns nullopt if `path` is readable. Otherwise prints a sentence to the standard error and returns
/// ExitCode::io.
[[nodiscard]] std::optional<ExitCode> unreadable(const std::string& path);

/// Returns nullopt if `path` is not a folder. Otherwise prints a sentence and returns ExitCode::io. If the
/// folder contains a file `usual`, the sentence names this file.
[[nodiscard]] std::optional<ExitCode> refuse_folder(const std::string& path, const std::string& usual = "");

/// Returns the result of read(path, problems). If the file cannot be opened or is refused, prints the reason
/// and returns the exit code.
/// @param usual  see refuse_folder().
template <class Read>
auto read_input(const std::string& path, Read read, const std::string& usual = "")
    -> tl::expected<typename decltype(read(path, std::declval<document::Problems&>()))::value_type,
                    ExitCode> {
  if (const auto code = refuse_folder(path, usual)) return tl::unexpected(*code);
  if (const auto code = unreadable(path)) return tl::unexpected(*code);
  document::Problems problems;
  auto result = read(path, problems);
  if (!result) return tl::unexpected(refuse(problems));
  return std::move(*result);
}

/// Reads a model file. If the file is refused, prints all problems and returns the exit code.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_model(const std::string& path);
/// Reads a model file for a rig. Refuses an output unit other than mm.
[[nodiscard]] tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path);

}  // namespace softgrip::tools
