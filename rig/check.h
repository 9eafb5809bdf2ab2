#pragma once
// Reads configuration files of any kind and reports their errors: `softgrip check FILE...`.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::rig {

enum class FileKind : std::uint8_t { unknown, rig, board_map, model, sequence, plc, web };
/// Returns "rig", "board map", "model", "sequence", "PLC gateway", "page" or "unknown".
[[nodiscard]] std::string_view name_of(FileKind kind) noexcept;

/// Determines the kind of a document from the keys at its top level. A misspelt key has half the weight of a
/// correct one. A document without any known key is reported as a problem.
[[nodiscard]] FileKind kind_of(const document::Document& document, document::Problems& problems);

/// One file that was checked.
struct CheckedFile {
  std::string path;
  FileKind kind = FileKind::unknown;
  std::string name;          ///< the value of its key `name`, or empty
  std::size_t errors = 0;    ///< number of errors in this file, without files to which it refers
  std::size_t warnings = 0;  ///< number of warnings in this file, without files to which it refers
  bool passed_over = false;  ///< skipped: found in a folder, and of no known kind
};

/// The result of check_files().
struct CheckReport {
  std::vector<CheckedFile> files;
  /// Problems of all files and of the files to which they refer, each problem once.
  document::Problems problems;
  bool has_rig = false;  ///< a rig was given, so the sequences were compared with it

  /// Returns true if there are no errors. The exit code of `softgrip check` is then 0, otherwise 3.
  [[nodiscard]] bool accepted() const noexcept { return problems.empty(); }
};

/// Reads each file as a file of the kind that its keys show. If the files include rigs and sequences, each
/// sequence is checked with each rig: the rig must have the channels of the sequence, and targets must be
/// within the limits of the rig. This check is made with the default values of the parameters and with the
/// ends of their ranges. If a rig has errors, its readable part is used. Values that are permitted but
/// implausible cause warnings (rig/rig_comparison.h). `arguments` replace the defaults in each sequence, and
/// each sequence must have these parameters. In a folder, all files *.yaml and *.yml at any depth are read.
/// Files of no known kind in a folder are not reported, and names that begin with a dot are skipped.
[[nodiscard]] CheckReport check_files(std::span<const std::string> paths,
                                      std::span<const control::Argument> arguments = {});

}  // namespace softgrip::rig
