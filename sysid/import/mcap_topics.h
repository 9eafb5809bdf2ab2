#pragma once
// Combines the messages of the topics of an MCAP recording into one table. The topics either describe one
// finger each, or contain one signal each.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// A topic with its messages. Element i of a column belongs to message i of the topic.
struct McapTopic {
  std::string name;
  std::vector<TableColumn> columns;
  std::map<std::string, std::size_t> places;  ///< for each key, the index of its column
  std::vector<std::size_t> rows;              ///< for each message, the row of the table that contains it

  [[nodiscard]] bool offers(Role role) const;
  /// Returns true if the messages of this topic alone describe a finger. Such messages contain a
  /// displacement, and a command or a pressure.
  [[nodiscard]] bool is_finger() const;
  /// Returns the column of a key if this column contains a finite time for each message, otherwise nullptr.
  [[nodiscard]] const TableColumn* time(const std::string& key) const;
};

/// The messages of a recording. Each message becomes a row of the table.
struct McapMessages {
  std::vector<McapTopic> topics;
  std::vector<std::uint64_t> log_times;  ///< for each row, the time at which its message was recorded [ns]
};

/// Reason why topics cannot be merged.
struct MergeProblem {
  std::string message;
  std::string hint;
};

/// Returns true if no single topic contains all signals of a finger, but all topics together do contain them.
[[nodiscard]] bool has_topics_of_signals(const McapMessages& messages);

/// Combines topics that each describe a finger into one table. Columns with the same key become one column.
void join_fingers(McapMessages& messages, ForeignTable& table);

/// Merges topics that each contain one signal. The messages are ordered by the time key that all messages
/// have, or by log_time if there is no such key. Returns a problem if the topics have different clocks.
[[nodiscard]] std::optional<MergeProblem> merge_signals(McapMessages& messages, ForeignTable& table);

}  // namespace softgrip::sysid
