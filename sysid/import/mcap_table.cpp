#include "sysid/import/mcap_table.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/enumerated.h"
#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/import/byte_scanner.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/proposal.h"
#include "sysid/import/split_times.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_mcap_columns = 10'000;
constexpr std::size_t largest_message = std::size_t{1} << 20U;
constexpr std::size_t deepest_object = 8;
constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

/// Two topics have a common clock if their offsets differ by at most this time [s]. The offset of a topic is
/// the time in its messages minus the time of the recording.
constexpr double clock_tolerance_s = 1;

/// A topic with its messages. Element i of a column belongs to message i of the topic.
struct McapTopic {
  std::string name;
  std::vector<TableColumn> columns;
  std::map<std::string, std::size_t> places;  ///< for each key, the index of its column
  std::vector<std::size_t> rows;              ///< for each message, the row of the table that contains it

  [[nodiscard]] bool offers(Role role) const {
    return std::any_of(columns.begin(), columns.end(), [&](const TableColumn& column) {
      return names_role(column.name, role) && fitness_for(column, role) > 0;
    });
  }
  /// Returns true if the messages of this topic alone describe a finger: they contain a displacement, and a
  /// command or a pressure.
  [[nodiscard]] bool is_finger() const {
    return offers(Role::displacement) && (offers(Role::command) || offers(Role::pressure));
  }
  /// Returns the column of a key if this column contains a finite time for each message, otherwise nullptr.
  [[nodiscard]] const TableColumn* time(const std::string& key) const {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const TableColumn& column) { return column.name == key; });
    const bool whole = found != columns.end() && fitness_for(*found, Role::time) > 0 &&
                       std::all_of(found->values.begin(), found->values.end(),
                                   [](double value) { return std::isfinite(value); });
    return whole ? &*found : nullptr;
  }
};

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
                             "' is skipped: " + std::to_string(said.second) + " messages in '" +
                             document::shown(said.first, 40) + "', not in JSON");
    for (const std::string& name : arrays_)
      table_.notes.push_back("'" + document::shown(name, 40) + "' is skipped: an array");
    for (McapTopic& topic : read_) {
      for (TableColumn& column : topic.columns) column.values.resize(topic.rows.size(), missing_value);
      combine_split_times(topic.columns, table_.notes);
      topic.columns.erase(std::remove_if(topic.columns.begin(), topic.columns.end(),
                                         [](const TableColumn& column) { return column.is_part_of_time; }),
                          topic.columns.end());
    }
    if (has_topics_of_signals()) {
      merge_signals();
    } else if (rows_ == 0 || (!options_.channel.empty() && !has_channel_)) {
      refuse("no topic has the name '" + document::shown(options_.channel) + "'",
             "the topics are " + with_commas(table_.channels));
    } else {
      if (table_.channels == std::vector<std::string>{"signals"}) table_.channels.clear();
      join_fingers();
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

  /// Counts a record that ends after the end of the file. If this record is a chunk, the complete records in
  /// it are read.
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
    log_times_.push_back(log_time);
    McapTopic& topic = topic_of(of.name);
    topic.rows.push_back(rows_ - 1);
    object(topic, json, "", 0);
    if (rows_ > most_values / std::max<std::size_t>(column_count_, 1))
      refuse("the file has more than " + std::to_string(most_values) + " values");
  }

  McapTopic& topic_of(const std::string& name) {
    const auto found =
        std::find_if(read_.begin(), read_.end(), [&](const McapTopic& topic) { return topic.name == name; });
    if (found != read_.end()) return *found;
    read_.push_back({name, {}, {}, {}});
    return read_.back();
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

  /// Combines topics that each describe a finger into one table. Columns with the same key become one column.
  void join_fingers() {
    for (McapTopic& topic : read_) {
      for (TableColumn& column : topic.columns) place(topic, std::move(column), rows_);
    }
    const bool has_time =
        std::any_of(table_.columns.begin(), table_.columns.end(), [](const TableColumn& column) {
          return column.bad_count == 0 && (names_role(column.name, Role::time) || !column.unit.empty());
        });
    if (!has_time) table_.columns.push_back(log_time_column());
  }

  /// Copies the values of a topic's column to the column of the same name in the table.
  void place(const McapTopic& topic, TableColumn column, std::size_t rows) {
    auto found = std::find_if(table_.columns.begin(), table_.columns.end(),
                              [&](const TableColumn& other) { return other.name == column.name; });
    if (found == table_.columns.end()) {
      found = table_.columns.insert(found, TableColumn{});
      found->name = column.name;
      found->unit = column.unit;
      found->values.assign(rows, missing_value);
    }
    for (std::size_t i = 0; i < column.values.size(); ++i) found->values[topic.rows[i]] = column.values[i];
    found->bad.insert(found->bad.end(), column.bad.begin(), column.bad.end());
    found->bad_count += column.bad_count;
    found->bad_rows.insert(found->bad_rows.end(), column.bad_rows.begin(), column.bad_rows.end());
  }

  [[nodiscard]] double log_time_s(std::size_t row) const {
    return 1e-9 * static_cast<double>(static_cast<std::int64_t>(log_times_[row] - log_times_.front()));
  }

  [[nodiscard]] TableColumn log_time_column() const {
    TableColumn column;
    column.name = "log_time";
    column.unit = "s";
    for (std::size_t row = 0; row < rows_; ++row) column.values.push_back(log_time_s(row));
    return column;
  }

  /// Returns the column name of a topic that contains one signal. "/pressure" with {"data": 1} gives
  /// "pressure".
  static std::string signal_name(const McapTopic& topic, const std::string& key) {
    std::string name = topic.name;
    std::replace(name.begin(), name.end(), '/', '.');
    return key == "data" || key == "value" ? name : name + "." + key;
  }

  /// Returns true if no single topic describes a finger, but all topics together do.
  [[nodiscard]] bool has_topics_of_signals() const {
    if (has_channel_ || read_.size() < 2 ||
        std::any_of(read_.begin(), read_.end(), [](const McapTopic& topic) { return topic.is_finger(); }))
      return false;
    McapTopic all;
    for (const McapTopic& topic : read_) {
      for (const TableColumn& column : topic.columns) {
        all.columns.emplace_back().name = signal_name(topic, column.name);
        all.columns.back().unit = column.unit;
      }
    }
    return all.is_finger();
  }

  /// Returns the key of a time that every message of every topic contains; empty if no key does.
  [[nodiscard]] std::string common_time() const {
    for (const TableColumn& column : read_.front().columns) {
      const bool common = std::all_of(read_.begin(), read_.end(), [&](const McapTopic& topic) {
        return topic.time(column.name) != nullptr;
      });
      if (common) return column.name;
    }
    return {};
  }

  void merge_signals() {
    const std::string key = common_time();
    TableColumn time = log_time_column();
    if (!key.empty()) {
      time.name = key;
      time.unit = read_.front().time(key)->unit;
      for (const McapTopic& topic : read_) {
        const TableColumn& own = *topic.time(key);
        for (std::size_t i = 0; i < topic.rows.size(); ++i) time.values[topic.rows[i]] = own.values[i];
      }
      check_clocks(time);
    }
    sort_rows(time.values);
    table_.columns.push_back(std::move(time));
    for (McapTopic& topic : read_) {
      for (TableColumn& column : topic.columns) {
        if (column.name == key) continue;
        column.name = signal_name(topic, column.name);
        place(topic, std::move(column), rows_);
      }
    }
    table_.notes.push_back("the messages of " + std::to_string(read_.size()) + " topics are merged by " +
                           (key.empty() ? "log_time" : "'" + key + "'") + ": each message is a row");
    table_.channels.clear();
    table_.has_rows_of_signals = true;
  }

  /// Refuses the file if the topics have different clocks. To find this, compares the times of each topic
  /// with the times of the recording.
  void check_clocks(const TableColumn& time) {
    const std::string name = time.unit.empty() ? split_unit(time.name, Quantity::time).unit : time.unit;
    const auto unit = unit_named(name.empty() ? epoch_unit(time) : name, Quantity::time);
    if (!unit) return;
    std::vector<double> offsets_s;
    for (const McapTopic& topic : read_) {
      std::vector<double> differences_s;
      for (const std::size_t row : topic.rows)
        differences_s.push_back(unit->factor * time.values[row] - log_time_s(row));
      offsets_s.push_back(median_of(std::span<double>(differences_s)));
    }
    const auto [least, most] = std::minmax_element(offsets_s.begin(), offsets_s.end());
    if (*most - *least <= clock_tolerance_s) return;
    const auto topic = [&](auto at) {
      return "'" + document::shown(read_[static_cast<std::size_t>(at - offsets_s.begin())].name, 40) + "'";
    };
    refuse("the times '" + document::shown(time.name, 40) + "' of the topics " + topic(least) + " and " +
               topic(most) +
               " come from two clocks: relative to log_time, the difference of these times is " +
               significant(*most - *least) + " s",
           "record the times of only one clock. If the messages contain no times, log_time is used");
  }

  /// Sorts the rows by time. If the times of a single topic decrease, the order is kept, and order_in_time()
  /// reports the backward step.
  void sort_rows(std::vector<double>& time) {
    for (const McapTopic& topic : read_) {
      for (std::size_t i = 1; i < topic.rows.size(); ++i) {
        if (time[topic.rows[i]] < time[topic.rows[i - 1]]) return;
      }
    }
    std::vector<std::size_t> order(rows_);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return time[a] < time[b]; });
    std::vector<std::size_t> place(rows_);
    for (std::size_t i = 0; i < rows_; ++i) place[order[i]] = i;
    std::stable_sort(time.begin(), time.end());
    for (McapTopic& topic : read_) {
      for (std::size_t& row : topic.rows) row = place[row];
      for (TableColumn& column : topic.columns) {
        for (BadCell& cell : column.bad) cell.row = place[cell.row];
        for (std::size_t& row : column.bad_rows) row = place[row];
      }
    }
  }

  const TableOptions& options_;
  document::Problems& problems_;
  ForeignTable table_;
  std::map<std::uint16_t, Topic> topics_;
  /// Topics whose messages become rows of the table.
  std::vector<McapTopic> read_;
  /// Per skipped topic: encoding and number of messages.
  std::map<std::string, std::pair<std::string, std::size_t>> skipped_;
  std::set<std::string> arrays_;
  std::vector<std::uint64_t> log_times_;
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
