#pragma once
// MCAP recordings (https://mcap.dev/spec, version 0): the messages in JSON, as `softgrip export` writes them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// The first and the last bytes of a file.
inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n"};

/// Kinds of records.
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

/// Reads each JSON message as a row. The keys are the columns; those of an object in an object are joined by
/// points ("pose.x"). A topic is a channel: "/left" is "left", and "/signals" alone is none. Without a key
/// for the time there is a column "log_time" in seconds after the first message.
///
/// If no topic has a drive and a reading, but all together have, each topic is a signal: "/pressure" with
/// {"data": 1} is the column "pressure", and {"x": 1} of "/tip" is "tip.x". All messages are rows, in the
/// order of the time that all of them have, or of log_time. The times of two topics that differ by more than
/// 1 s against log_time are a problem. Topics in other encodings, arrays and bytes behind the last complete
/// record are left out and named. Packed chunks, wrong checksums and more than `most_values` (table.h) are
/// problems.
[[nodiscard]] std::optional<ForeignTable> read_mcap_table(const std::string& file, std::string_view bytes,
                                                          const TableOptions& options,
                                                          document::Problems& problems);

}  // namespace softgrip::sysid
