#include "sysid/import/fingers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "sysid/import/role_fit.h"

namespace softgrip::sysid {
namespace {

constexpr std::array<std::string_view, 26> finger_words{
    "left",  "right", "l",     "r",   "thumb",  "index", "middle", "ring",   "little",
    "pinky", "upper", "lower", "top", "bottom", "links", "rechts", "daumen", "inner",
    "outer", "front", "back",  "a",   "b",      "north", "south",  "centre"};

bool is_finger_word(const std::string& token) {
  return std::find(finger_words.begin(), finger_words.end(), token) != finger_words.end() ||
         std::all_of(token.begin(), token.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_role_word(const std::string& token) {
  return std::any_of(roles.begin(), roles.end(),
                     [&](const RoleSpec& spec) { return names_role(token, spec.role); });
}

bool fits_a_pressure(const TableColumn& column) {
  return fitness_for(column, Role::command) > 0 || fitness_for(column, Role::pressure) > 0;
}

bool fits_a_displacement(const TableColumn& column) {
  return fitness_for(column, Role::displacement) > 0;
}

/// Returns the words that distinguish columns: two column names differ in one such word, and all other words
/// of the two names are equal. Considers only the columns for which `of_kind` returns true.
template <class OfKind>
std::set<std::string> words_apart(const ForeignTable& table, OfKind of_kind) {
  std::map<std::string, std::set<std::string>> by_pattern;
  for (const TableColumn& column : table.columns) {
    if (!of_kind(column)) continue;
    // Remove the unit before the name is split into words, because 'A' may be a finger or the unit ampere.
    const std::vector<std::string> tokens = tokens_of(split_unit(column.name).name);
    for (std::size_t k = 0; k < tokens.size(); ++k) {
      if (is_role_word(tokens[k])) continue;
      std::string pattern;
      for (std::size_t i = 0; i < tokens.size(); ++i) pattern += (i == k ? "*" : tokens[i]) + " ";
      by_pattern[pattern].insert(tokens[k]);
    }
  }
  std::set<std::string> words;
  for (const auto& [pattern, apart] : by_pattern) {
    if (apart.size() > 1) words.insert(apart.begin(), apart.end());
  }
  return words;
}

std::set<std::string> both(const std::set<std::string>& a, const std::set<std::string>& b) {
  std::set<std::string> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(common, common.end()));
  return common;
}

std::set<std::string> finger_set(const ForeignTable& table) {
  const std::set<std::string> pressures = words_apart(table, fits_a_pressure);
  const std::set<std::string> readings = words_apart(table, fits_a_displacement);
  const std::set<std::string> common = both(pressures, readings);
  if (common.size() > 1) return common;
  std::set<std::string> known;
  for (const std::string& word : readings) {
    if (is_finger_word(word)) known.insert(word);
  }
  if (known.size() > 1) return known;
  // The table may contain the pressures of two fingers, but the displacement of only one of these fingers.
  for (const TableColumn& column : table.columns) {
    if (!fits_a_displacement(column)) continue;
    for (const std::string& token : tokens_of(column.name)) {
      if (pressures.count(token) > 0) return pressures;
    }
  }
  return {};
}

}  // namespace

std::vector<std::string> tokens_of(std::string_view name) {
  enum class Kind : std::uint8_t { mark, lower, upper, digit };
  const auto kind_of = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isdigit(byte) != 0) return Kind::digit;
    if (std::isupper(byte) != 0) return Kind::upper;
    return std::isalpha(byte) != 0 || byte >= 0x80 ? Kind::lower : Kind::mark;
  };
  std::vector<std::string> tokens;
  Kind last = Kind::mark;
  for (const char c : name) {
    const Kind kind = kind_of(c);
    const bool joins = last == kind || (last == Kind::upper && kind == Kind::lower);
    if (kind != Kind::mark && !joins) tokens.emplace_back();
    if (kind != Kind::mark) tokens.back() += c;
    last = kind;
  }
  for (std::string& token : tokens) token = lower_case(token);
  return tokens;
}

bool names_channel(std::string_view name) {
  constexpr std::array<std::string_view, 3> channels{"channel", "finger", "actuator"};
  constexpr std::array<std::string_view, 6> fillers{"id", "no", "nr", "num", "number", "name"};
  const auto is_one_of = [](const auto& words, const std::string& token) {
    return std::find(words.begin(), words.end(), token) != words.end();
  };
  const std::vector<std::string> tokens = tokens_of(name.substr(name.find_last_of("/.") + 1));
  return std::count_if(tokens.begin(), tokens.end(),
                       [&](const std::string& token) { return is_one_of(channels, token); }) == 1 &&
         std::all_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
           return is_one_of(channels, token) || is_one_of(fillers, token);
         });
}

std::vector<std::string> fingers_of(const ForeignTable& table) {
  const std::set<std::string> words = finger_set(table);
  std::vector<std::string> fingers;
  for (const TableColumn& column : table.columns) {
    for (const std::string& token : tokens_of(column.name)) {
      const bool is_new =
          words.count(token) > 0 && std::find(fingers.begin(), fingers.end(), token) == fingers.end();
      if (is_new) fingers.push_back(token);
    }
  }
  return fingers;
}

std::string finger_of(const TableColumn& column, const std::vector<std::string>& fingers) {
  for (const std::string& token : tokens_of(column.name)) {
    if (std::find(fingers.begin(), fingers.end(), token) != fingers.end()) return token;
  }
  return {};
}

std::vector<std::string> columns_of_no_finger(const ForeignTable& table,
                                              const std::vector<std::string>& fingers) {
  const auto is_number = [](const std::string& token) {
    return std::all_of(token.begin(), token.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  // Returns the name without the number at one place, such as {"pd", "", "psi"}.
  const auto without = [](std::vector<std::string> tokens, std::size_t place) {
    tokens[place].clear();
    return tokens;
  };
  std::set<std::vector<std::string>> of_fingers;
  for (const TableColumn& column : table.columns) {
    const std::vector<std::string> tokens = tokens_of(column.name);
    const auto place = std::find(tokens.begin(), tokens.end(), finger_of(column, fingers));
    if (place != tokens.end() && is_number(*place))
      of_fingers.insert(without(tokens, static_cast<std::size_t>(place - tokens.begin())));
  }
  std::vector<std::string> names;
  for (const TableColumn& column : table.columns) {
    const std::vector<std::string> tokens = tokens_of(column.name);
    bool found = false;
    for (std::size_t i = 0; i < tokens.size(); ++i)
      found = found || (is_number(tokens[i]) && of_fingers.count(without(tokens, i)) > 0);
    if (found && finger_of(column, fingers).empty()) names.push_back(column.name);
  }
  return names;
}

}  // namespace softgrip::sysid
