#pragma once
// Writes and reads a mapping as YAML. Each imported log gets such a mapping file, and `softgrip import --map`
// reads this file.

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// Data about the imported file. They are written to the mapping file for documentation only.
struct ImportSource {
  std::string file;
  std::string sha256;
  std::string format;
};

/// Returns the mapping as YAML text, which parse_mapping() converts back to the same mapping. `remarks` are
/// written above the mapping as comments.
[[nodiscard]] std::string mapping_yaml(const Mapping& mapping, const ImportSource& source,
                                       const std::string& software, const std::vector<std::string>& remarks);

/// Parses a mapping. Adds all problems to `problems`, and returns nullopt if there is a problem. `file` is
/// the name of the text in messages.
[[nodiscard]] std::optional<Mapping> parse_mapping(const std::string& file, const std::string& text,
                                                   document::Problems& problems);
/// Reads and parses a mapping file. A problem is added if the file cannot be read.
[[nodiscard]] std::optional<Mapping> read_mapping(const std::string& path, document::Problems& problems);

}  // namespace softgrip::sysid
