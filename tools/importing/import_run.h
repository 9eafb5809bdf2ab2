#pragma once
// `softgrip import` as a whole: what is asked, what is said, what is written.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "sysid/import/mapping.h"

namespace softgrip::tools {

/// The command line as it stands.
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

/// Reads all files before it writes any; with a problem nothing is written. What was proposed and not said is
/// shown and asked for on a terminal; elsewhere, without --yes, the options that say it are printed and the
/// exit code is 2.
ExitCode run_import(const ImportOptions& options);

/// Where the logs of `files` go: `out` itself of one file that does not name a folder, else a file per log in
/// it. The error is a sentence.
[[nodiscard]] tl::expected<std::vector<std::string>, std::string> import_targets(
    const std::vector<std::string>& files, const std::string& out);

/// The mapping that options say upon `begun`. The error is a sentence.
[[nodiscard]] tl::expected<sysid::Mapping, std::string> mapping_of(const ImportOptions& options,
                                                                   sysid::Mapping begun);

}  // namespace softgrip::tools
