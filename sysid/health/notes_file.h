#pragma once
// The maintenance records: notes.yaml.
//
//   notes:
//     - {date: 2026-11-03, finger: left, action: finger replaced}
//     - {date: 2026-11-20T14:30:00Z, action: "sensors clamped again"}

#include <optional>
#include <string>
#include <vector>

#include "document/problem.h"

namespace softgrip::sysid::health {

struct Note {
  std::string date;    ///< UTC, "2026-11-03" (as the day begins) or "2026-11-03T14:30:00Z"
  std::string finger;  ///< empty: all
  std::string action;  ///< in a few words
};

/// In the order of their dates; nothing if there are problems, which are all added.
[[nodiscard]] std::optional<std::vector<Note>> read_notes(const std::string& path, std::string text,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid::health
