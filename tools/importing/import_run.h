#pragma once
// The command `softgrip import`: reading, confirmation, conversion and output.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/import/mapping.h"

namespace softgrip::tools {

/// The options of the command line, before they are interpreted.
struct ImportOptions {
  std::vector<std::string> files;
  std::string out;
  std::array<std::vector<std::string>, sysid::role_count> columns;
  std::vector<std::string> units;   ///< "pressure=psi"
  std::vector<std::string> scales;  ///< "displacement=-2.5"
  std::vector<std::string> zeros;   ///< "displacement=first"
  std::optional<double> rate_hz;
  std::vector<std::string> missing;
  std::string separator;
  std::string channel;
  std::string sheet;
  bool skip_bad_lines = false;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::string map;
  bool yes = false;
  bool json = false;
};

/// Imports the files. It reads all files before it writes any. If there is a problem, nothing is written. If
/// column roles were guessed, the mapping is shown with the equivalent options. Without --yes, the user must
/// confirm the mapping on a terminal. If there is no terminal, the exit code is 2.
ExitCode run_import(const ImportOptions& options);

/// Returns the output paths of the logs of `files`. For one file, this is `out` itself, unless `out` is a
/// folder. Otherwise it is one path per log in the folder `out`. The error is a sentence.
[[nodiscard]] tl::expected<std::vector<std::string>, std::string> import_targets(
    const std::vector<std::string>& files, const std::string& out);

/// Returns the mapping `begun` with the settings of the options applied. The error is a sentence.
[[nodiscard]] tl::expected<sysid::Mapping, std::string> mapping_of(const ImportOptions& options,
                                                                   sysid::Mapping begun);

}  // namespace softgrip::tools
