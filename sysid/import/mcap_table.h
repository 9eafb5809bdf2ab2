#pragma once
// Reads JSON messages from MCAP recordings (https://mcap.dev/spec, version 0). `softgrip export` writes such
// recordings. The messages of the topics are combined into one table. The topics either describe one finger
// each, or contain one signal each.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/import/mapping.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Byte sequence at the beginning and at the end of an MCAP file.
inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n"};

/// Kinds of records in an MCAP file.
enum class McapOpcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

/// Reads each JSON message as a row of the table. The keys are the columns; keys of nested objects are joined
/// by points ("pose.x"). Each topic is a channel of the log: "/left" is the channel "left". If "/signals" is
/// the only topic, the table has no channel. If no key contains a time, a column "log_time" contains the
/// seconds since the first message.
///
/// A topic can also be a single signal. The reader assumes single signals if two conditions are met: no topic
/// has both a displacement and a drive (a command or a pressure), and all topics together have both. The
/// topic "/pressure" with {"data": 1} then gives the column "pressure", and {"x": 1} in "/tip" gives "tip.x".
/// The rows are ordered by the time key that all messages have, or by log_time if there is no such key. It is
/// a problem if the offsets of two topics' times from log_time differ by more than 1 s. Topics in other
/// encodings, arrays and bytes after the last complete record are left out, and a note names them. Compressed
/// chunks, wrong checksums and more than `most_values` values (table.h) are problems.
[[nodiscard]] std::optional<ForeignTable> read_mcap_table(const std::string& file, std::string_view bytes,
                                                          const TableOptions& options,
                                                          document::Problems& problems);

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
