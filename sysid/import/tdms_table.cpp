#include "sysid/import/table_readers.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "sysid/import/byte_scanner.h"
#include "sysid/import/table.h"
#include "sysid/import/tdms_value.h"
#include "sysid/import/tdms_waveform.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t lead_in_bytes = 28;
constexpr std::size_t most_channels = 10'000;
/// Largest number of processing steps for all segments together. This limit is necessary because a segment of
/// 28 bytes can repeat a long list of channels.
constexpr std::size_t most_steps = 100'000'000;
constexpr std::size_t longest_label = 1000;
constexpr const char* has_daqmx =
    "has raw values of DAQmx, which cannot be converted without the scales of DAQmx";
/// Value that the length field of a segment has if the recording was interrupted before the end of the
/// segment.
constexpr std::uint64_t no_length = ~std::uint64_t{0};

// Flags in the header of a segment.
constexpr std::uint32_t has_metadata = 2;
constexpr std::uint32_t has_new_list = 4;
constexpr std::uint32_t has_raw_data = 8;
constexpr std::uint32_t is_interleaved = 32;
constexpr std::uint32_t is_big_endian = 64;
constexpr std::uint32_t is_daqmx = 128;

struct TdmsChannel {
  std::string name;
  std::string unit;
  TdmsType type = TdmsType::f64;
  bool has_index = false;   ///< true: a segment has stated how the values are stored
  std::uint64_t count = 0;  ///< number of values of this channel in a chunk
  std::uint64_t bytes = 0;  ///< size of the values of this channel in a chunk
  std::vector<double> values;
  std::optional<TdmsStamp> first;  ///< first value, if the channel contains time stamps
  TdmsWaveform waveform;
  bool needs_scale = false;
  std::size_t cut_off = 0;  ///< number of values in the incomplete chunk at the end of the file
};

/// Converts a TDMS path to a name: "/'group'/'channel'" gives "group/channel".
std::string name_in(std::string_view path) {
  std::string name;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '/' && !name.empty()) name += '/';
    if (path[i] != '\'') continue;
    for (++i; i < path.size(); ++i) {
      if (path[i] == '\'' && (i + 1 == path.size() || path[i + 1] != '\'')) break;
      if (path[i] == '\'') ++i;
      name += path[i];
    }
  }
  return name;
}

class TdmsReader {
 public:
  TdmsReader(std::string_view bytes, ArrayCollector& arrays) : bytes_(bytes), arrays_(arrays) {}

  /// Reads all segments. If the file is refused, returns false and stores the reason as a sentence in
  /// `refused`.
  bool read() {
    std::size_t at = 0;
    while (at < bytes_.size() && refused.empty()) {
      if (bytes_.size() - at < lead_in_bytes) {
        leave_out_segment(at, "in its first bytes");
        break;
      }
      at = segment(at);
    }
    if (refused.empty()) deliver();
    return refused.empty();
  }

  /// Returns the number of rows that have at least one value in the incomplete chunk at the end of the file.
  [[nodiscard]] std::size_t cut_off_rows(const ForeignTable& table) const {
    std::size_t rows = 0;
    for (const TdmsChannel& channel : channels_) {
      if (column_index(table, channel.name) < table.columns.size()) rows = std::max(rows, channel.cut_off);
    }
    return rows;
  }

  std::string refused;
  std::string hint = "export the data as CSV";  ///< what the user can do if the file is refused

 private:
  /// Reads the segment that begins at byte `at`. Returns the position of the next segment.
  std::size_t segment(std::size_t at) {
    ByteScanner lead(bytes_.substr(at, lead_in_bytes));
    const bool signed_so = std::string_view(lead.skip(4), 4) == "TDSm";
    const auto flags = lead.value<std::uint32_t>();
    lead.skip(4);
    const auto next = lead.value<std::uint64_t>();
    const auto raw = lead.value<std::uint64_t>();
    const std::string_view rest = bytes_.substr(at + lead_in_bytes);
    // If the recording was interrupted, the length field is not set, or it exceeds the number of remaining
    // bytes.
    const std::uint64_t size = std::min<std::uint64_t>(next, rest.size());
    if (!signed_so) refuse(at, "does not begin with TDSm");
    if ((flags & is_big_endian) != 0) refuse(at, "is big-endian");
    if ((flags & is_daqmx) != 0) refuse(at, has_daqmx);
    if (raw > next) refuse(at, "declares more bytes of metadata than the segment contains");
    if (raw > size && at == 0) refuse(at, "ends before the end of its metadata");
    if (!refused.empty()) return at;
    if (raw > size) {
      leave_out_segment(at, "in its metadata");
      return bytes_.size();
    }
    if ((flags & has_metadata) != 0 && !metadata(rest.substr(0, raw), (flags & has_new_list) != 0)) {
      refuse(at, unread_.empty() ? "has broken metadata" : unread_);
      return at;
    }
    if (size < next && next != no_length) missing_bytes_ = next - size;
    if ((flags & has_raw_data) != 0) raw_data(rest.substr(raw, size - raw), (flags & is_interleaved) != 0);
    return at + lead_in_bytes + size;
  }

  void refuse(std::size_t at, const std::string& why) {
    if (refused.empty()) refused = "the segment at byte " + std::to_string(at) + " " + why;
  }
  static std::string quoted(std::string_view name) { return "'" + document::shown(name, 40) + "'"; }
  /// Stores the reason for which a file with valid metadata is refused. Always returns false.
  bool unread(const std::string& why) {
    if (unread_.empty()) unread_ = why;
    return false;
  }
  bool unread_type(TdmsType type, const std::string& of) {
    return unread("has " + of + " of type " + std::to_string(static_cast<std::uint32_t>(type)) +
                  ", which is not supported");
  }

  /// Reports a segment whose end is missing, and skips it. The number of rows in this segment is unknown.
  void leave_out_segment(std::size_t at, const std::string& where) {
    arrays_.note("the segment at byte " + std::to_string(at) + " is cut off " + where + ": its " +
                 std::to_string(bytes_.size() - at) + " bytes are left out");
  }

  bool metadata(std::string_view bytes, bool new_list) {
    ByteScanner scan(bytes);
    if (new_list) listed_.clear();
    const auto objects = scan.value<std::uint32_t>();
    for (std::uint32_t i = 0; i < objects && scan.good(); ++i) {
      if (!object(scan)) return false;
    }
    return scan.good();
  }

  bool object(ByteScanner& scan) {
    const std::string path(scan.text());
    const auto found = by_path_.try_emplace(path, channels_.size());
    if (found.second) {
      if (channels_.size() == most_channels)
        return unread("exceeds the limit of " + std::to_string(most_channels) + " channels");
      channels_.emplace_back();
      channels_.back().name = name_in(path);
    }
    TdmsChannel& channel = channels_[found.first->second];
    const auto length = scan.value<std::uint32_t>();
    constexpr std::uint32_t no_values = 0xffffffff;
    constexpr std::uint32_t daqmx_formats = 0x1269;
    constexpr std::uint32_t daqmx_lines = 0x1369;
    if (length == daqmx_formats || length == daqmx_lines) return unread(has_daqmx);
    steps_ += listed_.size() + 1;
    if (steps_ > most_steps) return unread("exceeds the limit of " + std::to_string(most_steps) + " pieces");
    const bool is_listed = std::find(listed_.begin(), listed_.end(), found.first->second) != listed_.end();
    if (length == no_values) {
      listed_.erase(std::remove(listed_.begin(), listed_.end(), found.first->second), listed_.end());
    } else {
      if (length != 0 && !index(scan, channel)) return false;
      if (length == 0 && !channel.has_index) return false;
      if (!is_listed) listed_.push_back(found.first->second);
    }
    return properties(scan, channel);
  }

  bool index(ByteScanner& scan, TdmsChannel& channel) {
    const auto type = static_cast<TdmsType>(scan.value<std::uint32_t>());
    const auto dimension = scan.value<std::uint32_t>();
    channel.count = scan.value<std::uint64_t>();
    const std::size_t size = size_of(type);
    if (!scan.good()) return false;
    if (size == 0 && type != TdmsType::string) return unread_type(type, "values in " + quoted(channel.name));
    if (channel.has_index && channel.type != type)
      return unread("changes the type of the values of the channel in " + quoted(channel.name));
    if (size > 0 && channel.count > (std::uint64_t{1} << 40U)) return false;
    channel.bytes = size == 0 ? scan.value<std::uint64_t>() : channel.count * size;
    channel.type = type;
    channel.has_index = true;
    return scan.good() && dimension == 1 && channel.bytes <= (std::uint64_t{1} << 44U);
  }

  bool properties(ByteScanner& scan, TdmsChannel& channel) {
    const auto count = scan.value<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && scan.good(); ++i) {
      const std::string_view name = scan.text();
      const auto type = static_cast<TdmsType>(scan.value<std::uint32_t>());
      if (type == TdmsType::string) {
        const std::string_view text = scan.text();
        if (name == "unit_string") channel.unit = text.substr(0, longest_label);
        if (name == "NI_Scaling_Status" && text == "unscaled") channel.needs_scale = true;
        continue;
      }
      const std::size_t size = size_of(type);
      const char* const at = scan.skip(size);
      if (at == nullptr) return false;
      if (size == 0) return unread_type(type, "a property " + quoted(name));
      if (type == TdmsType::time)
        channel.waveform.state(name, tdms_stamp_at(at));
      else
        channel.waveform.state(name, number_at(type, at));
    }
    return scan.good();
  }

  void raw_data(std::string_view bytes, bool interleaved) {
    std::uint64_t chunk = 0;
    std::uint64_t row = 0;
    std::uint64_t values = 0;
    for (const std::size_t i : listed_) {
      const std::size_t size = size_of(channels_[i].type);
      chunk += channels_[i].bytes;
      row += size;
      values += size > 0 ? channels_[i].count : 0;
      if (interleaved && (size == 0 || channels_[i].count != channels_[listed_[0]].count))
        refused = "the interleaved channels of the segment contain texts, or have different lengths";
      refuse_waveform(channels_[i], channels_[i].waveform.begin_segment(channels_[i].values.size()));
    }
    if (!refused.empty() || chunk == 0) return;
    steps_ += listed_.size() * (bytes.size() / chunk + 1);
    if (steps_ > most_steps)
      refused = "the file has more than " + std::to_string(most_steps) + " pieces of channels";
    while (!bytes.empty() && refused.empty()) {
      const std::string_view piece = bytes.substr(0, chunk);
      if (interleaved && has_room(piece.size() / row * listed_.size())) rows(piece, row);
      if (!interleaved && piece.size() == chunk && has_room(values)) blocks(piece);
      if (!interleaved && piece.size() < chunk) leave_out_blocks(piece);
      bytes.remove_prefix(piece.size());
    }
  }

  /// Refuses the file if the text `why` is not empty. A channel that is skipped does not cause a refusal.
  void refuse_waveform(const TdmsChannel& channel, const std::string& why) {
    if (why.empty() || channel.needs_scale || !refused.empty()) return;
    refused = "the times of the waveform " + quoted(channel.name) + " are contradictory: " + why;
    hint = "export each part with its own times to a separate file";
  }

  bool has_room(std::uint64_t values) {
    values_ += values;
    if (values_ > most_values) refused = "the file has more than " + std::to_string(most_values) + " values";
    return refused.empty();
  }

  /// Reads interleaved values: the first value of every channel, then the second value of every channel, and
  /// so on.
  void rows(std::string_view piece, std::uint64_t row) {
    const std::size_t complete = piece.size() / row;
    const std::size_t rest = piece.size() % row;
    std::size_t offset = 0;
    for (const std::size_t i : listed_) {
      TdmsChannel& channel = channels_[i];
      for (std::size_t k = 0; k < complete; ++k) take(channel, piece.data() + k * row + offset);
      channel.cut_off += rest > 0 ? 1 : 0;
      offset += size_of(channel.type);
    }
    cut_off_bytes_ += rest;
  }

  /// Reads contiguous values: all values of the first channel, then all values of the next channel.
  void blocks(std::string_view piece) {
    for (const std::size_t i : listed_) {
      TdmsChannel& channel = channels_[i];
      const std::string_view block = piece.substr(0, channel.bytes);
      const std::size_t size = size_of(channel.type);
      for (std::size_t at = 0; size > 0 && at + size <= block.size(); at += size)
        take(channel, block.data() + at);
      piece.remove_prefix(block.size());
    }
  }

  /// Leaves out an incomplete chunk. Otherwise the first channels in the chunk would have more values than
  /// the last channels.
  void leave_out_blocks(std::string_view piece) {
    cut_off_bytes_ += piece.size();
    for (const std::size_t i : listed_) {
      TdmsChannel& channel = channels_[i];
      const std::string_view block = piece.substr(0, channel.bytes);
      const std::size_t size = size_of(channel.type);
      channel.cut_off += size > 0 ? (block.size() + size - 1) / size : 0;
      piece.remove_prefix(block.size());
    }
  }

  static void take(TdmsChannel& channel, const char* at) {
    if (channel.type != TdmsType::time) return channel.values.push_back(number_at(channel.type, at));
    const TdmsStamp stamp = tdms_stamp_at(at);
    if (!channel.first) channel.first = stamp;
    channel.values.push_back(seconds_between(*channel.first, stamp));
  }

  void deliver() {
    if (missing_bytes_ > 0)
      arrays_.note("the file is cut off: the last " + std::to_string(missing_bytes_) + " bytes are missing");
    if (cut_off_bytes_ > 0)
      arrays_.note("incomplete rows or blocks of values are left out: " + std::to_string(cut_off_bytes_) +
                   " bytes");
    std::map<std::tuple<double, double, std::size_t, std::vector<TdmsWaveform::Series>>, std::string> times;
    std::optional<TdmsStamp> first_start;
    for (TdmsChannel& channel : channels_) {
      if (channel.type == TdmsType::string && channel.has_index) arrays_.skip(channel.name, "a text");
      if (channel.values.empty()) continue;
      if (channel.needs_scale) {
        arrays_.skip(channel.name, "the values of this channel are not scaled");
        continue;
      }
      const std::size_t count = channel.values.size();
      if (channel.first) {
        arrays_.note("'" + document::shown(channel.name) +
                     "' has time stamps, which are converted to seconds after the first time stamp");
        channel.unit = "s";
      }
      TdmsWaveform& waveform = channel.waveform;
      refuse_waveform(channel, waveform.end(count));
      if (waveform.has_times()) {
        if (!first_start) first_start = waveform.start();
        const double start_s = waveform.start_s(first_start);
        std::string& time = times[{waveform.increment_s(), start_s, count, waveform.series()}];
        if (time.empty()) {
          time = times.size() == 1 ? "wf_time" : "wf_time " + std::to_string(times.size());
          add_time(time, waveform, waveform.times_s(count, start_s));
        }
      }
      arrays_.add(channel.name, channel.unit, count, 1, channel.values);
    }
  }

  void add_time(const std::string& name, const TdmsWaveform& waveform, const std::vector<double>& time_s) {
    arrays_.note("'" + name + "' is computed from wf_start_offset in steps of wf_increment");
    if (const std::size_t gaps = waveform.series().size() - 1; gaps > 0) {
      const std::size_t begin = waveform.series()[1].begin;
      arrays_.note(
          "'" + name + "' has " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
          " between segments, as their wf_start_time and wf_start_offset state; the first gap is from " +
          significant(time_s[begin - 1], 6) + " s to " + significant(time_s[begin], 6) + " s");
    }
    arrays_.add(name, "s", time_s.size(), 1, time_s);
  }

  std::string_view bytes_;
  ArrayCollector& arrays_;
  std::vector<TdmsChannel> channels_;
  std::map<std::string, std::size_t> by_path_;
  std::vector<std::size_t> listed_;  ///< indices of the channels that have values in this segment
  std::size_t steps_ = 0;
  std::size_t values_ = 0;
  /// Number of bytes that are missing at the end of the file, according to the length in the header of its
  /// last segment.
  std::uint64_t missing_bytes_ = 0;
  std::size_t cut_off_bytes_ = 0;
  std::string unread_;  ///< reason for which a file with valid metadata is refused
};

}  // namespace

std::optional<ForeignTable> read_tdms_table(const std::string& file, std::string_view bytes,
                                            document::Problems& problems) {
  ArrayCollector arrays(file);
  TdmsReader reader(bytes, arrays);
  if (reader.read()) {
    auto table = arrays.table("LabVIEW TDMS", problems);
    if (!table) return std::nullopt;
    table->account.rows = reader.cut_off_rows(*table);
    table->account.leave_out(LeftOut::cut_off_line, table->account.rows);
    return table;
  }
  problems.add(
      {file, {1, 1}, {}, "a LabVIEW file (.tdms) that cannot be read: " + reader.refused, reader.hint});
  return std::nullopt;
}

}  // namespace softgrip::sysid
