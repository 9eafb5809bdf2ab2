#pragma once
// Reads configuration files of any kind and reports their errors: `softgrip check FILE...`.
// Compares the limits of a rig file with the models, and warns of values that are permitted but implausible.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

enum class FileKind : std::uint8_t { unknown, rig, board_map, model, sequence, plc, web };
/// Returns the name of a kind: "rig", "board map", "model", "sequence", "PLC gateway", "page" or "unknown".
[[nodiscard]] std::string_view name_of(FileKind kind) noexcept;

/// Determines the kind of a document from the keys at its top level. A misspelt key has half the weight of a
/// correct key. If the document has no known key, a problem is reported.
[[nodiscard]] FileKind kind_of(const document::Document& document, document::Problems& problems);

/// A checked file and the result of its check.
struct CheckedFile {
  std::string path;
  FileKind kind = FileKind::unknown;
  std::string name;        ///< value of the key `name` in the file; empty if the file has no such key
  std::size_t errors = 0;  ///< number of errors in this file; errors in a file to which this file refers are
                           ///< not counted
  std::size_t warnings = 0;  ///< number of warnings in this file; warnings in a file to which this file
                             ///< refers are not counted
  bool passed_over = false;  ///< true: the file was skipped, because it was found in a folder and its kind is
                             ///< unknown
};

/// The result of check_files().
struct CheckReport {
  std::vector<CheckedFile> files;
  /// Problems of all checked files, and of the files to which they refer. Each problem occurs once.
  document::Problems problems;
  bool has_rig = false;  ///< true: one of the files is a rig, so the sequences were checked with this rig

  /// Returns true if there are no errors. In this case, the exit code of `softgrip check` is 0, otherwise 3.
  [[nodiscard]] bool accepted() const noexcept { return problems.empty(); }
};

/// Reads each file as a file of the kind that its keys show. If the files include rigs and sequences, checks
/// each sequence with each rig. The rig must have the channels of the sequence, and the targets must be
/// within the limits of the rig. The check is made for the default values of the parameters, and for the ends
/// of their ranges. If a rig has errors, its readable part is used. Values that are permitted but implausible
/// cause warnings (compare_limits()). `arguments` replace the defaults in each sequence, and each
/// sequence must have these parameters. In a folder, all files *.yaml and *.yml at any depth are read. Files
/// of an unknown kind in a folder are not reported, and names that begin with a dot are skipped.
[[nodiscard]] CheckReport check_files(std::span<const std::string> paths,
                                      std::span<const control::Argument> arguments = {});

/// In each of the following cases, adds a warning with a proposed value at the key that should be changed:
/// - at a pressure limit, the free finger of the model goes more than twice as far as its displacement limit;
/// - `max_speed_mm_per_s` is at least ten times the speed of the model within its slew limits;
/// - a burst pressure line would not be detected, because the channel has no pressure monitor, or because the
///   measured pressure is not compared with the command.
///
/// The function simulates several seconds of each model. `document` is the document from which `rig` was
/// read.
void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems);

/// Returns true if a burst pressure line or a lost supply of this channel would cause a fault.
[[nodiscard]] bool sees_burst_line(const RigFile& rig, std::size_t channel);

/// Adds a warning at the first grip step that verifies its result by displacement or detection, if a burst
/// pressure line is not detected on the channel of the step. With a burst line, this step would report
/// HOLDING. Adds at most one warning per sequence.
void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems);

}  // namespace softgrip::rig
