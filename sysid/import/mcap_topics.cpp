#include "sysid/import/mcap_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "base/numbers.h"
#include "base/statistics.h"
#include "document/problem.h"
#include "sysid/import/proposal.h"
#include "sysid/import/role_fit.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {
namespace {

/// Largest difference between the offsets of two topics that have a common clock [s]. The offset of a topic
/// is the time that a message states minus the time at which this message was recorded.
constexpr double clock_tolerance_s = 1;

/// Copies the values of a topic's column to the column of the same name in the table.
void place_column(const McapTopic& topic, TableColumn column, std::size_t rows, ForeignTable& table) {
  auto found = std::find_if(table.columns.begin(), table.columns.end(),
                            [&](const TableColumn& other) { return other.name == column.name; });
  if (found == table.columns.end()) {
    found = table.columns.insert(found, TableColumn{});
    found->name = column.name;
    found->unit = column.unit;
    found->values.assign(rows, missing_value);
  }
  for (std::size_t i = 0; i < column.values.size(); ++i) found->values[topic.rows[i]] = column.values[i];
  found->bad.insert(found->bad.end(), column.bad.begin(), column.bad.end());
  found->bad_count += column.bad_count;
  found->bad_rows.insert(found->bad_rows.end(), column.bad_rows.begin(), column.bad_rows.end());
}

double log_time_s(const McapMessages& messages, std::size_t row) {
  return 1e-9 *
         static_cast<double>(static_cast<std::int64_t>(messages.log_times[row] - messages.log_times.front()));
}

TableColumn log_time_column(const McapMessages& messages) {
  TableColumn column;
  column.name = "log_time";
  column.unit = "s";
  for (std::size_t row = 0; row < messages.log_times.size(); ++row)
    column.values.push_back(log_time_s(messages, row));
  return column;
}

/// Returns the column name of a topic that contains one signal. "/pressure" with {"data": 1} gives
/// "pressure".
std::string signal_name(const McapTopic& topic, const std::string& key) {
  std::string name = topic.name;
  std::replace(name.begin(), name.end(), '/', '.');
  return key == "data" || key == "value" ? name : name + "." + key;
}

/// Returns the key that contains a time in every message of every topic; empty if there is no such key.
std::string common_time(const McapMessages& messages) {
  for (const TableColumn& column : messages.topics.front().columns) {
    const bool common =
        std::all_of(messages.topics.begin(), messages.topics.end(),
                    [&](const McapTopic& topic) { return topic.time(column.name) != nullptr; });
    if (common) return column.name;
  }
  return {};
}

/// Returns a problem if the topics have different clocks. For each topic, compares the times that its
/// messages state with the times at which the messages were recorded.
std::optional<MergeProblem> check_clocks(const McapMessages& messages, const TableColumn& time) {
  const std::string name = stated_unit(time, Quantity::time);
  const auto unit = unit_named(name.empty() ? epoch_unit(time) : name, Quantity::time);
  if (!unit) return std::nullopt;
  std::vector<double> offsets_s;
  for (const McapTopic& topic : messages.topics) {
    std::vector<double> differences_s;
    for (const std::size_t row : topic.rows)
      differences_s.push_back(unit->factor * time.values[row] - log_time_s(messages, row));
    offsets_s.push_back(median_of(std::span<double>(differences_s)));
  }
  const auto [least, most] = std::minmax_element(offsets_s.begin(), offsets_s.end());
  if (*most - *least <= clock_tolerance_s) return std::nullopt;
  const auto topic = [&](auto at) {
    return "'" + document::shown(messages.topics[static_cast<std::size_t>(at - offsets_s.begin())].name, 40) +
           "'";
  };
  return MergeProblem{
      "the times '" + document::shown(time.name, 40) + "' of the topics " + topic(least) + " and " +
          topic(most) + " come from two clocks. Relative to log_time, these times differ by " +
          significant(*most - *least) + " s",
      "record the times of only one clock, or record no times in the messages (log_time is then used)"};
}

/// Sorts the rows by time. If the times decrease within one topic, the rows keep their order, and
/// order_in_time() reports the decrease.
void sort_rows(McapMessages& messages, std::vector<double>& time) {
  for (const McapTopic& topic : messages.topics) {
    for (std::size_t i = 1; i < topic.rows.size(); ++i) {
      if (time[topic.rows[i]] < time[topic.rows[i - 1]]) return;
    }
  }
  std::vector<std::size_t> order(messages.log_times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return time[a] < time[b]; });
  std::vector<std::size_t> place(messages.log_times.size());
  for (std::size_t i = 0; i < messages.log_times.size(); ++i) place[order[i]] = i;
  std::stable_sort(time.begin(), time.end());
  for (McapTopic& topic : messages.topics) {
    for (std::size_t& row : topic.rows) row = place[row];
    for (TableColumn& column : topic.columns) {
      for (BadCell& cell : column.bad) cell.row = place[cell.row];
      for (std::size_t& row : column.bad_rows) row = place[row];
    }
  }
}

}  // namespace

bool McapTopic::offers(Role role) const {
  return std::any_of(columns.begin(), columns.end(), [&](const TableColumn& column) {
    return names_role(column.name, role) && fitness_for(column, role) > 0;
  });
}

bool McapTopic::is_finger() const {
  return offers(Role::displacement) && (offers(Role::command) || offers(Role::pressure));
}

const TableColumn* McapTopic::time(const std::string& key) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const TableColumn& column) { return column.name == key; });
  const bool whole = found != columns.end() && fitness_for(*found, Role::time) > 0 &&
                     std::all_of(found->values.begin(), found->values.end(),
                                 [](double value) { return std::isfinite(value); });
  return whole ? &*found : nullptr;
}

bool has_topics_of_signals(const McapMessages& messages) {
  if (messages.topics.size() < 2 || std::any_of(messages.topics.begin(), messages.topics.end(),
                                                [](const McapTopic& topic) { return topic.is_finger(); }))
    return false;
  McapTopic all;
  for (const McapTopic& topic : messages.topics) {
    for (const TableColumn& column : topic.columns) {
      all.columns.emplace_back().name = signal_name(topic, column.name);
      all.columns.back().unit = column.unit;
    }
  }
  return all.is_finger();
}

void join_fingers(McapMessages& messages, ForeignTable& table) {
  for (McapTopic& topic : messages.topics) {
    for (TableColumn& column : topic.columns)
      place_column(topic, std::move(column), messages.log_times.size(), table);
  }
  const bool has_time =
      std::any_of(table.columns.begin(), table.columns.end(), [](const TableColumn& column) {
        return column.bad_count == 0 && (names_role(column.name, Role::time) || !column.unit.empty());
      });
  if (!has_time) table.columns.push_back(log_time_column(messages));
}

std::optional<MergeProblem> merge_signals(McapMessages& messages, ForeignTable& table) {
  const std::string key = common_time(messages);
  TableColumn time = log_time_column(messages);
  if (!key.empty()) {
    time.name = key;
    time.unit = messages.topics.front().time(key)->unit;
    for (const McapTopic& topic : messages.topics) {
      const TableColumn& own = *topic.time(key);
      for (std::size_t i = 0; i < topic.rows.size(); ++i) time.values[topic.rows[i]] = own.values[i];
    }
    if (auto problem = check_clocks(messages, time)) return problem;
  }
  sort_rows(messages, time.values);
  table.columns.push_back(std::move(time));
  for (McapTopic& topic : messages.topics) {
    for (TableColumn& column : topic.columns) {
      if (column.name == key) continue;
      column.name = signal_name(topic, column.name);
      place_column(topic, std::move(column), messages.log_times.size(), table);
    }
  }
  table.notes.push_back("the messages of " + std::to_string(messages.topics.size()) +
                        " topics are merged by " + (key.empty() ? "log_time" : "'" + key + "'") +
                        ", so each message is a row");
  table.channels.clear();
  table.has_rows_of_signals = true;
  return std::nullopt;
}

}  // namespace softgrip::sysid
