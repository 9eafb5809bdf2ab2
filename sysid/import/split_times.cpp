#include "sysid/import/split_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "document/problem.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {
namespace {

constexpr double ns_per_second = 1e9;
constexpr std::array<std::string_view, 5> second_words{"sec", "secs", "s", "second", "seconds"};
constexpr std::array<std::string_view, 7> nanosecond_words{"nanosec", "nanosecs",   "nsec",       "nsecs",
                                                           "ns",      "nanosecond", "nanoseconds"};

struct LastWord {
  std::string before;  ///< text before the last word, without the separator between them
  std::string word;    ///< last word, in lower case
};

/// Splits off the last word of a name: "header.stamp.sec" gives "header.stamp" and "sec".
LastWord last_word(std::string_view name) {
  const std::size_t at = name.find_last_of("._/ [(");
  std::string_view word = at == std::string_view::npos ? name : name.substr(at + 1);
  while (!word.empty() && (word.back() == ']' || word.back() == ')')) word.remove_suffix(1);
  std::string_view before = at == std::string_view::npos ? std::string_view() : name.substr(0, at);
  while (!before.empty() && std::string_view("._/ [(").find(before.back()) != std::string_view::npos)
    before.remove_suffix(1);
  return {std::string(before), lower_case(word)};
}

template <class Words>
bool is_one_of(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns true if all values of the column are whole numbers from 0 to below `end`.
bool whole_below(const TableColumn& column, double end) {
  bool any = false;
  for (const double value : column.values) {
    if (!std::isfinite(value)) continue;
    if (value != std::floor(value) || value < 0 || value >= end) return false;
    any = true;
  }
  return any && column.bad_count == 0 && column.moments == 0;
}

/// Returns the index of the column that contains the nanoseconds for the column `seconds`.
std::optional<std::size_t> rest_of_seconds(const std::vector<TableColumn>& columns, std::size_t seconds) {
  constexpr double latest_s = 1e11;
  const LastWord name = last_word(columns[seconds].name);
  if (!is_one_of(second_words, name.word) || !whole_below(columns[seconds], latest_s)) return std::nullopt;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const LastWord other = last_word(columns[i].name);
    const bool paired = other.before == name.before && is_one_of(nanosecond_words, other.word);
    if (paired && whole_below(columns[i], ns_per_second)) return i;
  }
  return std::nullopt;
}

}  // namespace

void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto rest = rest_of_seconds(columns, i);
    if (!rest) continue;
    TableColumn& seconds = columns[i];
    TableColumn& nanoseconds = columns[*rest];
    for (std::size_t row = 0; row < seconds.values.size(); ++row)
      seconds.values[row] += nanoseconds.values[row] / ns_per_second;
    seconds.unit = "s";
    nanoseconds.is_part_of_time = true;
    std::string note = "'" + document::shown(seconds.name, 40) + "' and '" +
                       document::shown(nanoseconds.name, 40) + "' are combined into one time";
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
  }
}

}  // namespace softgrip::sysid
