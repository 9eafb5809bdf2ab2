#include "sysid/import/mcap_table.h"

#include <zlib.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "base/text.h"
#include "sysid/import/byte_scanner.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/moments.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_mcap_columns = 10'000;
constexpr std::size_t largest_message = std::size_t{1} << 20U;
constexpr std::size_t deepest_object = 8;

class McapReader {
 public:
  McapReader(const std::string& file, const TableOptions& options, document::Problems& problems)
      : options_(options), problems_(problems) {
    table_.file = file;
    table_.format = "MCAP, messages in JSON";
    table_.missing_cells.resize(options.missing.size());
  }

  std::optional<ForeignTable> read(std::string_view bytes) {
    const bool is_complete = bytes.ends_with(mcap_magic);
    bytes.remove_prefix(mcap_magic.size());
    find_topic(bytes);
    records(bytes, false);
    if (cut_off_bytes_ > 0 && is_complete) refuse("a record is longer than the file");
    if (table_.channels.empty()) refuse("no topic has messages in JSON");
    if (refused_) return std::nullopt;
    if (cut_off_bytes_ > 0)
      table_.notes.push_back("the file is cut off: its last " + std::to_string(cut_off_bytes_) +
                             " bytes are left out");
    for (const auto& [topic, said] : skipped_)
      table_.notes.push_back("topic '" + document::shown(topic, 40) +
                             "' is skipped: " + std::to_string(said.second) + " messages are in '" +
                             document::shown(said.first, 40) + "', not in JSON");
    for (const std::string& name : arrays_)
      table_.notes.push_back("'" + document::shown(name, 40) +
                             "' is skipped, because this value is an array");
    for (McapTopic& topic : read_.topics) {
      for (TableColumn& column : topic.columns) column.values.resize(topic.rows.size(), missing_value);
      combine_split_times(topic.columns, table_.notes);
      topic.columns.erase(std::remove_if(topic.columns.begin(), topic.columns.end(),
                                         [](const TableColumn& column) { return column.is_part_of_time; }),
                          topic.columns.end());
    }
    if (!has_channel_ && has_topics_of_signals(read_)) {
      if (const auto problem = merge_signals(read_, table_)) refuse(problem->message, problem->hint);
    } else if (rows_ == 0 || (!options_.channel.empty() && !has_channel_)) {
      refuse("no topic has the name '" + document::shown(options_.channel) + "'",
             "the topics are " + with_commas(table_.channels));
    } else {
      if (table_.channels == std::vector<std::string>{"signals"}) table_.channels.clear();
      join_fingers(read_, table_);
    }
    if (refused_) return std::nullopt;
    return std::move(table_);
  }

 private:
  struct Topic {
    std::string name;
    std::string encoding;
  };

  void refuse(const std::string& message, const std::string& hint = "export the data as CSV") {
    if (!refused_) problems_.add({table_.file, {1, 1}, {}, message, hint});
    refused_ = true;
  }

  /// Searches for a topic whose name is the requested channel. If there is no such topic, the channel may be
  /// a finger whose name is a part of several topic names.
  void find_topic(std::string_view bytes) {
    if (options_.channel.empty()) return;
    looks_for_topics_ = true;
    records(bytes, false);
    looks_for_topics_ = false;
    has_channel_ = std::any_of(topics_.begin(), topics_.end(),
                               [&](const auto& topic) { return topic.second.name == options_.channel; });
  }

  void records(std::string_view bytes, bool in_chunk) {
    while (!bytes.empty() && !refused_) {
      ByteScanner scan(bytes);
      const auto kind = scan.value<McapOpcode>();
      const auto size = scan.value<std::uint64_t>();
      const std::string_view rest = scan.rest();
      if (!scan.good() || size > rest.size()) return cut_off(kind, bytes, rest, in_chunk);
      const std::string_view content = rest.substr(0, size);
      if (kind == McapOpcode::data_end && !in_chunk) return;
      if (kind == McapOpcode::chunk && !in_chunk) chunk(content, true);
      if (kind == McapOpcode::channel) topic(content);
      if (kind == McapOpcode::message && !looks_for_topics_) message(content);
      bytes = rest.substr(size);
    }
  }

  /// Handles a record that is cut off by the end of the file. If the record is a chunk, reads the complete
  /// records in the chunk. Otherwise counts the bytes of the record.
  void cut_off(McapOpcode kind, std::string_view bytes, std::string_view content, bool in_chunk) {
    if (kind == McapOpcode::chunk && !in_chunk) return chunk(content, false);
    if (looks_for_topics_) return;
    cut_off_bytes_ += bytes.size();
    if (kind != McapOpcode::message) return;
    ++table_.account.rows;
    table_.account.leave_out(LeftOut::cut_off_line);
  }

  void chunk(std::string_view content, bool complete) {
    ByteScanner scan(content);
    scan.skip(3 * sizeof(std::uint64_t));
    const auto checksum = scan.value<std::uint32_t>();
    const std::string_view packing = scan.text();
    const auto size = scan.value<std::uint64_t>();
    const std::string_view inside = scan.rest();
    if (!scan.good() && !complete) {
      if (!looks_for_topics_) cut_off_bytes_ += content.size();
      return;
    }
    if (!scan.good() || (complete && size != inside.size()))
      return refuse("a chunk of the file is shorter than the length that its header states");
    if (!packing.empty())
      return refuse("the chunks of the file are compressed with " + document::shown(packing, 20) +
                    ", which is not supported; write the file without compression");
    const auto* const data = reinterpret_cast<const Bytef*>(inside.data());
    if (complete && checksum != 0 && checksum != ::crc32_z(0, data, inside.size()))
      return refuse("a chunk does not match its checksum");
    records(inside, true);
  }

  void topic(std::string_view content) {
    ByteScanner scan(content);
    const auto id = scan.value<std::uint16_t>();
    scan.skip(sizeof(std::uint16_t));
    std::string_view name = scan.text();
    const std::string_view encoding = scan.text();
    if (!scan.good()) return refuse("a channel record is shorter than the length that its header states");
    if (name.starts_with('/')) name.remove_prefix(1);
    topics_[id] = {std::string(name), std::string(encoding)};
  }

  void message(std::string_view content) {
    ByteScanner scan(content);
    const auto id = scan.value<std::uint16_t>();
    scan.skip(sizeof(std::uint32_t));
    const auto log_time = scan.value<std::uint64_t>();
    scan.skip(sizeof(std::uint64_t));
    const auto found = topics_.find(id);
    if (!scan.good() || found == topics_.end()) return refuse("a message refers to an unknown channel");
    const Topic& of = found->second;
    if (of.encoding != "json") {
      auto& said = skipped_[of.name];
      said.first = of.encoding;
      ++said.second;
      return;
    }
    ++messages_;
    if (std::find(table_.channels.begin(), table_.channels.end(), of.name) == table_.channels.end())
      table_.channels.push_back(of.name);
    if (has_channel_ && of.name != options_.channel) return leave_out(LeftOut::other_channel);
    const std::string_view text = scan.rest();
    const auto json = text.size() > largest_message ? nlohmann::json(nlohmann::json::value_t::discarded)
                                                    : nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object() && options_.skip_bad_lines) return leave_out(LeftOut::bad_line);
    if (!json.is_object())
      return refuse("message " + std::to_string(messages_) + " is not a JSON object of at most " +
                    std::to_string(largest_message) + " bytes; --skip-bad-lines leaves such messages out");
    if (++rows_ > most_rows)
      return refuse("the file has more than " + std::to_string(most_rows) + " messages");
    read_.log_times.push_back(log_time);
    McapTopic& topic = topic_of(of.name);
    topic.rows.push_back(rows_ - 1);
    object(topic, json, "", 0);
    if (rows_ > most_values / std::max<std::size_t>(column_count_, 1))
      refuse("the file has more than " + std::to_string(most_values) + " values");
  }

  McapTopic& topic_of(const std::string& name) {
    const auto found = std::find_if(read_.topics.begin(), read_.topics.end(),
                                    [&](const McapTopic& topic) { return topic.name == name; });
    if (found != read_.topics.end()) return *found;
    read_.topics.push_back({name, {}, {}, {}});
    return read_.topics.back();
  }

  void leave_out(LeftOut reason) {
    ++table_.account.rows;
    table_.account.leave_out(reason);
  }

  void object(McapTopic& topic, const nlohmann::json& json, const std::string& path, std::size_t depth) {
    for (const auto& [key, value] : json.items()) {
      const std::string name = path + key;
      if (value.is_object() && depth < deepest_object) {
        object(topic, value, name + ".", depth + 1);
      } else if (value.is_structured()) {
        if (arrays_.size() < most_mcap_columns) arrays_.insert(name);
      } else if (!value.is_null()) {
        add(topic, name, value);
      }
    }
  }

  void add(McapTopic& topic, const std::string& name, const nlohmann::json& value) {
    const auto place = topic.places.try_emplace(name, topic.columns.size());
    if (place.second) {
      if (column_count_++ == most_mcap_columns)
        return refuse("the messages of the file have more than " + std::to_string(most_mcap_columns) +
                      " keys");
      topic.columns.emplace_back().name = name;
    }
    if (refused_) return;
    TableColumn& column = topic.columns[place.first->second];
    column.values.resize(topic.rows.size(), missing_value);
    column.values.back() = number(column, value);
  }

  double number(TableColumn& column, const nlohmann::json& value) {
    if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
    if (value.is_number()) return value.get<double>();
    const auto text = value.get<std::string>();
    const CellValue cell = cell_value(text, options_.missing);
    if (cell.missing_word >= 0) ++table_.missing_cells[static_cast<std::size_t>(cell.missing_word)];
    if (cell.kind == CellKind::number) return cell.number;
    if (cell.kind == CellKind::missing) return missing_value;
    constexpr std::size_t bad_kept = 3;
    if (options_.skip_bad_lines) column.bad_rows.push_back(rows_ - 1);
    if (++column.bad_count <= bad_kept)
      column.bad.push_back({rows_ - 1, {1, 1}, {}, text, "of message " + std::to_string(messages_)});
    return missing_value;
  }

  const TableOptions& options_;
  document::Problems& problems_;
  ForeignTable table_;
  std::map<std::uint16_t, Topic> topics_;
  McapMessages read_;
  /// Encoding and number of messages of each skipped topic.
  std::map<std::string, std::pair<std::string, std::size_t>> skipped_;
  std::set<std::string> arrays_;
  std::size_t rows_ = 0;
  std::size_t column_count_ = 0;
  std::size_t messages_ = 0;
  std::size_t cut_off_bytes_ = 0;
  bool looks_for_topics_ = false;
  bool has_channel_ = false;  ///< true: a topic has the name of the requested channel
  bool refused_ = false;
};

}  // namespace

std::optional<ForeignTable> read_mcap_table(const std::string& file, std::string_view bytes,
                                            const TableOptions& options, document::Problems& problems) {
  return McapReader(file, options, problems).read(bytes);
}

}  // namespace softgrip::sysid
