#pragma once
// Reading configuration files of any kind only to say what is wrong with them: `softgrip check FILE...`.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "control/tick/parameter.h"
#include "document/node.h"

namespace softgrip::rig {

enum class FileKind : std::uint8_t { unknown, rig, board_map, model, sequence, plc, web };
/// "rig", "board map", "model", "sequence", "PLC gateway", "page"; "unknown"
[[nodiscard]] std::string_view name_of(FileKind kind) noexcept;

/// What a document is, by the keys at its top; misspelt ones count too, but less. A document without any is a
/// problem.
[[nodiscard]] FileKind kind_of(const document::Document& document, document::Problems& problems);

/// One file that was checked.
struct CheckedFile {
  std::string path;
  FileKind kind = FileKind::unknown;
  std::string name;        ///< what it calls itself, or empty
  std::size_t errors = 0;  ///< in this file, not in those that it names
  std::size_t warnings = 0;
  bool passed_over = false;  ///< found in a folder and of no kind
};

/// What check_files() found.
struct CheckReport {
  std::vector<CheckedFile> files;
  /// Of all files and of those that they name, each once; format() prints them.
  document::Problems problems;
  bool has_rig = false;  ///< sequences were fitted to something

  /// No errors: exit code 0, else 3.
  [[nodiscard]] bool accepted() const noexcept { return problems.empty(); }
};

/// Reads every file as what it is. When rigs and sequences are among them, each sequence is also fitted to
/// each rig: names of channels, targets within limits, with its parameters at their defaults and at the ends
/// of their ranges; to a rig with errors as far as it could be read. What is allowed but cannot be meant is
/// warned of (rig/rig_comparison.h). `arguments` take the place of defaults in every sequence; each sequence
/// must have them. Of a folder every file *.yaml and *.yml below it is read; those that are of no kind are
/// left out of the problems. Names that begin with a dot are passed over.
[[nodiscard]] CheckReport check_files(std::span<const std::string> paths,
                                      std::span<const control::Argument> arguments = {});

}  // namespace softgrip::rig
