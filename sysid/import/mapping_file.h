#pragma once
// A mapping as YAML: it is written next to each imported log, and `softgrip import --map` reads it.

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// The imported file, which the mapping file states for documentation.
struct ImportSource {
  std::string file;
  std::string sha256;
  std::string format;
};

/// Returns the YAML text. parse_mapping() of this text gives the same mapping. `remarks` are written above
/// the mapping as comments.
[[nodiscard]] std::string mapping_yaml(const Mapping& mapping, const ImportSource& source,
                                       const std::string& software, const std::vector<std::string>& remarks);

/// Parses a mapping. Returns nullopt if there is a problem; all problems are added to `problems`. `file`
/// names the text in messages.
[[nodiscard]] std::optional<Mapping> parse_mapping(const std::string& file, const std::string& text,
                                                   document::Problems& problems);
/// Reads and parses a mapping file. A file that cannot be read is a problem too.
[[nodiscard]] std::optional<Mapping> read_mapping(const std::string& path, document::Problems& problems);

}  // namespace softgrip::sysid
