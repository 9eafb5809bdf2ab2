#pragma once
// Runs `softgrip import`: reads and converts files, requests confirmation and writes logs.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/import/mapping.h"

namespace softgrip::tools {

/// The options of the command line as text, before they are interpreted.
struct ImportOptions {
  std::vector<std::string> files;
  std::string out;
  std::array<std::vector<std::string>, sysid::role_count> columns;
  std::vector<std::string> units;   ///< units of columns by role, for example "pressure=psi"
  std::vector<std::string> scales;  ///< factors of columns by role, for example "displacement=-2.5"
  std::vector<std::string> zeros;   ///< zeros of columns by role, for example "displacement=first"
  std::optional<double> rate_hz;
  std::vector<std::string> missing;
  std::vector<std::string> missing_in;  ///< codes of single columns, for example "tip (mm)=999"
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

/// Imports the files. Reads all files before the first log is written. If there is a problem, writes nothing.
/// If column roles were guessed, shows the mapping and the equivalent options. Without --yes, the user must
/// confirm this mapping on a terminal. If there is no terminal, the exit code is 2.
ExitCode run_import(const ImportOptions& options);

/// Checks that no input file is a value such as "displacement=3", which belongs to an option. On failure,
/// returns a sentence that describes the error.
[[nodiscard]] tl::expected<void, std::string> check_files(const ImportOptions& options);

/// Returns the output paths of the logs. If there is one file and `out` is not a folder, the path is `out`.
/// Otherwise each log gets a path in the folder `out`. On failure, returns a sentence that describes the
/// error.
[[nodiscard]] tl::expected<std::vector<std::string>, std::string> import_targets(
    const std::vector<std::string>& files, const std::string& out);

/// Returns the mapping `begun`, completed with the settings of the options. If the options give other columns
/// for a role, its unit, scale and zero in `begun` are not used. A rate in the options replaces the time
/// columns of `begun`, and time columns in the options replace its rate. On failure, returns a sentence that
/// describes the error.
[[nodiscard]] tl::expected<sysid::Mapping, std::string> mapping_of(const ImportOptions& options,
                                                                   sysid::Mapping begun);

}  // namespace softgrip::tools
