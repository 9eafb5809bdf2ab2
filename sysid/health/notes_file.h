#pragma once
// Reads the maintenance records from notes.yaml, for example:
//
//   notes:
//     - {date: 2026-11-03, finger: left, action: finger replaced}
//     - {date: 2026-11-20T14:30:00Z, action: "sensors clamped again"}

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid::health {

struct Note {
  std::string date;    ///< date in UTC: "2026-11-03" (start of the day) or "2026-11-03T14:30:00Z"
  std::string finger;  ///< name of the finger; empty: the note applies to all fingers
  std::string action;  ///< maintenance action, in a few words
};

/// Returns the notes in order of their dates. Returns nullopt if the text has problems, and adds all of them
/// to `problems`.
[[nodiscard]] std::optional<std::vector<Note>> read_notes(const std::string& path, std::string text,
                                                          document::Problems& problems);

/// Reads the file and returns its notes. The error is a sentence if the file cannot be read. The error is
/// empty if the text has problems, which are all added to `problems`.
[[nodiscard]] tl::expected<std::vector<Note>, std::string> load_notes(const std::string& path,
                                                                      document::Problems& problems);

}  // namespace softgrip::sysid::health
