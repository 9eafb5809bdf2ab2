#pragma once
// A mapping as YAML: kept beside every imported log, and read again with `softgrip import --map`.

#include <optional>
#include <string>

#include "document/problem.h"
#include "sysid/import/mapping.h"

namespace softgrip::sysid {

/// The file that was imported, for whoever reads the mapping later.
struct ImportSource {
  std::string file;
  std::string sha256;
  std::string format;
};

/// The text; parse_mapping() of it gives the same mapping. `remarks` stand above it as comments.
[[nodiscard]] std::string mapping_yaml(const Mapping& mapping, const ImportSource& source,
                                       const std::string& software, const std::vector<std::string>& remarks);

/// All problems are added to `problems`; with one there is no mapping. `file` names it in messages.
[[nodiscard]] std::optional<Mapping> parse_mapping(const std::string& file, const std::string& text,
                                                   document::Problems& problems);
/// The same from a file. A file that cannot be read is a problem too.
[[nodiscard]] std::optional<Mapping> read_mapping(const std::string& path, document::Problems& problems);

}  // namespace softgrip::sysid
