#pragma once
// Reads JSON messages from MCAP recordings (https://mcap.dev/spec, version 0). `softgrip export` writes such
// recordings.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
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

}  // namespace softgrip::sysid
