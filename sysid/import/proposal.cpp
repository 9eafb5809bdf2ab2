#include "sysid/import/proposal.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/import/clock.h"
#include "sysid/import/fingers.h"
#include "sysid/import/missing_codes.h"
#include "sysid/import/motion.h"
#include "sysid/import/role_fit.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

bool supplies(const ColumnMapping& column, const ForeignTable& table, std::size_t index) {
  return std::any_of(column.columns.begin(), column.columns.end(),
                     [&](const std::string& word) { return column_index(table, word) == index; });
}

bool taken(const Mapping& mapping, const ForeignTable& table, std::size_t index) {
  return std::any_of(mapping.columns.begin(), mapping.columns.end(),
                     [&](const ColumnMapping& column) { return supplies(column, table, index); });
}

/// Returns true if the column contains a number that is not a code for a missing value, or if the table has
/// no rows.
bool has_value(const ForeignTable& table, const Mapping& mapping, std::size_t index) {
  return table.rows() == 0 || finite_count(without_codes(table, mapping, index)) > 0;
}

/// Returns the first role other than the time that uses the column.
std::optional<Role> value_role(const Mapping& mapping, const ForeignTable& table, std::size_t index) {
  for (const RoleSpec& spec : roles) {
    if (spec.role != Role::time && supplies(mapping[spec.role], table, index)) return spec.role;
  }
  return std::nullopt;
}

}  // namespace

std::string epoch_unit(const TableColumn& column) {
  const auto first =
      std::find_if(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); });
  if (first == column.values.end() || column.moments > 0) return {};
  constexpr double earliest_s = 6e8;  // earliest plausible time since 1970 [s]: the year 1989
  constexpr double latest_s = 4e9;    // latest plausible time since 1970 [s]: the year 2096
  double factor = 1;
  for (const char* unit : {"s", "ms", "us", "ns"}) {
    if (*first >= earliest_s * factor && *first <= latest_s * factor) return unit;
    factor *= 1000;
  }
  return {};
}

namespace {

/// The fingers to which the columns belong, and the finger that the user selected. `meant` is empty if the
/// table has only one finger or if the user selected none.
struct FingerChoice {
  std::vector<std::string> fingers;
  std::string meant;
  std::vector<std::string> of_none;  ///< result of columns_of_no_finger()

  [[nodiscard]] bool offers(const TableColumn& column) const {
    const std::string of = finger_of(column, fingers);
    return of.empty() ? std::ranges::count(of_none, column.name) == 0 : of == meant;
  }
};

std::string quoted(const std::vector<std::string>& names) {
  return with_commas(names, [](const std::string& name) { return "'" + document::shown(name) + "'"; });
}

/// Returns the fingers whose columns are in the mapping.
std::vector<std::string> given_fingers(const ForeignTable& table, const Mapping& mapping,
                                       const std::vector<std::string>& fingers) {
  std::vector<std::string> given;
  for (const ColumnMapping& column : mapping.columns) {
    for (const std::string& word : column.columns) {
      const std::size_t index = column_index(table, word);
      const std::string of = index < table.columns.size() ? finger_of(table.columns[index], fingers) : "";
      if (!of.empty() && std::find(given.begin(), given.end(), of) == given.end()) given.push_back(of);
    }
  }
  return given;
}

/// Returns the fingers that have a displacement column.
std::vector<std::string> read_fingers(const ForeignTable& table, const std::vector<std::string>& fingers) {
  std::vector<std::string> read;
  for (const TableColumn& column : table.columns) {
    const std::string of = fitness_for(column, Role::displacement) > 0 ? finger_of(column, fingers) : "";
    if (!of.empty() && std::find(read.begin(), read.end(), of) == read.end()) read.push_back(of);
  }
  return read;
}

FingerChoice choose_finger(const ForeignTable& table, const Mapping& given, Proposal& proposal) {
  FingerChoice choice{fingers_of(table), lower_case(given.channel), {}};
  choice.of_none = columns_of_no_finger(table, choice.fingers);
  const bool by_rows = table.channels.size() > (given.channel.empty() ? 1 : 0);
  if (by_rows) return {};
  const std::vector<std::string> said = given_fingers(table, given, choice.fingers);
  if (!given.channel.empty() && std::ranges::count(choice.fingers, choice.meant) == 0) {
    const std::string name = "'" + document::shown(given.channel) + "'";
    proposal.questions.push_back(
        choice.fingers.size() > 1
            ? Proposal::Question{"no finger has the name " + name + ": the columns belong to " +
                                     quoted(choice.fingers),
                                 "select one with --channel"}
            : Proposal::Question{
                  "--channel " + name +
                      ": the file has no column 'channel' and contains the columns of only one finger",
                  "omit --channel"});
  } else if (!given.channel.empty()) {
    for (const std::string& other : said) {
      if (other != choice.meant)
        proposal.questions.push_back(
            {"--channel '" + choice.meant + "': a column of finger '" + other + "' is given",
             "give only columns of the selected finger"});
    }
  } else if (choice.fingers.size() > 1) {
    const std::vector<std::string> read = read_fingers(table, choice.fingers);
    if (said.size() > 1)
      proposal.warnings.push_back("the given columns belong to " + std::to_string(said.size()) +
                                  " fingers: " + quoted(said));
    if (said.size() == 1) choice.meant = said.front();
    if (said.empty() && read.size() == 1) choice.meant = read.front();
    if (choice.meant.empty() && !given.complete())
      proposal.questions.push_back(
          {"the columns belong to " + std::to_string(choice.fingers.size()) +
               " fingers: " + quoted(choice.fingers) +
               (choice.of_none.empty() ? "" : "; no displacement belongs to " + quoted(choice.of_none)),
           "select one finger with --channel, or give --command and --displacement"});
  }
  return choice;
}

/// If the time columns of the table contain different times, assigns each time column to its value columns.
/// If the assignment is not clear, adds a question for the user.
void choose_times(const ForeignTable& table, const FingerChoice& choice, Proposal& proposal) {
  ColumnMapping& time = proposal.mapping[Role::time];
  if (!time.given() || time.columns.size() > 1) return;
  const std::size_t chosen = column_index(table, time.columns.front());
  std::vector<std::size_t> times;
  Mapping unscaled = proposal.mapping;  // the scale applies to the mapped columns only
  unscaled[Role::time].scale.reset();
  for (const std::size_t index : time_columns(table)) {
    const bool differs = index == chosen || !same_clock(table, unscaled, chosen, index);
    if (differs && choice.offers(table.columns[index]) &&
        (index == chosen || !taken(proposal.mapping, table, index)))
      times.push_back(index);
  }
  if (times.size() < 2) return;
  std::vector<std::string> words;
  for (const std::size_t index : times) words.push_back(word_of(table, index));
  const auto of_roles = times_of_roles(table, proposal.mapping, times);
  // The chosen column has the name of a time. If the assignment by the order of the columns does not contain
  // the chosen column, the user is asked.
  if (!of_roles || std::find(of_roles->begin(), of_roles->end(), chosen) == of_roles->end()) {
    proposal.questions.push_back(
        {"the times of the columns " + quoted(words) + " differ",
         "use --time COLUMN to select one time column for all value columns. To use two time columns, give "
         "--time twice: a time column applies to the values that its name mentions, or to the columns on its "
         "right"});
    return;
  }
  time.columns.clear();
  for (const std::size_t index : times) {
    if (std::find(of_roles->begin(), of_roles->end(), index) != of_roles->end())
      time.columns.push_back(word_of(table, index));
  }
}

/// Interprets codes such as 999 in the mapped columns as missing values. A code applies only to the column in
/// which it was found, because the same number can be a value of another column. Columns for which the user
/// states codes are not searched.
void choose_codes(const ForeignTable& table, const Mapping& given, Proposal& proposal) {
  const auto column_of = [&](const ColumnCode& code) { return column_index(table, code.column); };
  for (const ColumnCode& code : given.missing_in) {
    const std::size_t index = column_of(code);
    if (index < table.columns.size() && taken(proposal.mapping, table, index))
      proposal.notes.push_back(cells_with(table.columns[index], code.value) + " with " +
                               shortest(code.value) + " count as missing");
  }
  if (!given.missing.empty()) return;
  for (std::size_t index = 0; index < table.columns.size(); ++index) {
    const TableColumn& column = table.columns[index];
    const bool is_stated = std::ranges::count(given.missing_in, index, column_of) > 0;
    const auto role = value_role(proposal.mapping, table, index);
    if (is_stated || !role) continue;
    for (const double code : codes_for(column, *role)) {
      proposal.mapping.missing_in.push_back({word_of(table, index), code});
      proposal.warnings.push_back(cells_with(column, code) + " with " + shortest(code) +
                                  ", far from all other values, count as missing; to keep these values as "
                                  "readings, use --missing NA");
    }
  }
}

/// Selects the displacement from the columns that fit this role. If a better-fitting column does not move,
/// the first of the best-fitting columns that move is selected. A warning states each choice among several
/// columns.
/// @param fits  score of each column for the role; 0: the column cannot have the role.
std::size_t choose_displacement(const ForeignTable& table, const std::vector<int>& fits, std::size_t first,
                                Proposal& proposal) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i] > 0) candidates.push_back(i);
  }
  const std::vector<std::size_t> moving = moving_columns(table, candidates);
  if (candidates.size() < 2 || moving.empty()) return first;
  const auto chosen = *std::max_element(moving.begin(), moving.end(),
                                        [&](std::size_t a, std::size_t b) { return fits[a] < fits[b]; });
  std::vector<std::string> also;
  std::vector<std::string> resting;
  for (const std::size_t index : candidates) {
    const bool moves = std::find(moving.begin(), moving.end(), index) != moving.end();
    if (moves && index != chosen && fits[index] == fits[chosen]) also.push_back(word_of(table, index));
    if (!moves && fits[index] >= fits[chosen]) resting.push_back(word_of(table, index));
  }
  const std::string name =
      "'" + document::shown(word_of(table, chosen), 40) + "' is proposed as the displacement";
  if (!resting.empty())
    proposal.warnings.push_back(name + ", because its values move and the values of " + quoted(resting) +
                                " do not. To use another column, state it with --displacement");
  if (!also.empty())
    proposal.warnings.push_back(
        name + (also.size() == 1 ? ", but " : ", but each of ") + quoted(also) +
        " fits and moves too. The first of these columns is proposed. State the correct column with "
        "--displacement");
  return chosen;
}

void choose(const ForeignTable& table, const RoleSpec& spec, const FingerChoice& choice, Proposal& proposal) {
  std::vector<int> fits;
  const std::vector<std::size_t> times = time_columns(table);
  const auto is_time = [&](std::size_t i) {
    return spec.role != Role::time && names_role(table.columns[i].name, Role::time) &&
           std::find(times.begin(), times.end(), i) != times.end();
  };
  std::string empty;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool out = taken(proposal.mapping, table, i) || !choice.offers(table.columns[i]) || is_time(i);
    fits.push_back(out ? 0 : fitness_for(table.columns[i], spec.role));
    if (fits.back() == 0 || has_value(table, proposal.mapping, i)) continue;
    fits.back() = 0;
    if (empty.empty()) empty = word_of(table, i);
  }
  const auto best = std::max_element(fits.begin(), fits.end());
  if (best == fits.end() || *best == 0) {
    if (!empty.empty())
      proposal.notes.push_back("'" + document::shown(empty, 40) +
                               "' has no value, so it is not used as the " + std::string(spec.word));
    return;
  }
  auto chosen = static_cast<std::size_t>(best - fits.begin());
  if (spec.role == Role::displacement) chosen = choose_displacement(table, fits, chosen, proposal);
  ColumnMapping& column = proposal.mapping[spec.role];
  column.columns = {word_of(table, chosen)};
  proposal.guessed.push_back(spec.role);
}

/// Returns a text about the first time column whose times have an unknown format. Returns "" if there is no
/// such column.
std::string unread_time(const ForeignTable& table) {
  for (const TableColumn& column : table.columns) {
    if (!column.bad.empty() && names_role(column.name, Role::time))
      return " ('" + document::shown(column.name, 40) + "' has '" +
             document::shown(column.bad.front().text, 40) +
             "', which is in an unknown format; an example of a known format is 2024-05-31 12:00:00.25)";
  }
  return {};
}

/// Returns a text about the first column that could have one of the roles if it had a value, or if its name
/// did not state a derived value. Returns "" if there is no such column.
std::string unfit_column(const ForeignTable& table, const Mapping& mapping,
                         std::initializer_list<Role> of_roles) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    const bool fits = std::any_of(of_roles.begin(), of_roles.end(),
                                  [&](Role role) { return fitness_for(column, role) > 0; });
    if (fits && !has_value(table, mapping, i))
      return " ('" + document::shown(column.name, 40) + "' has no value)";
    const bool may_be = std::any_of(of_roles.begin(), of_roles.end(), [&](Role role) {
      const Quantity quantity = spec_of(role).quantity;
      const std::string unit = stated_unit(column, quantity);
      return names_role(column.name, role) || unit_named(unit, quantity).has_value();
    });
    if (may_be && names_derived_value(column.name))
      return " ('" + document::shown(column.name, 40) +
             "' is not proposed, because its name states an error, a difference, a rate or another derived "
             "value)";
  }
  return {};
}

void say_what_is_missing(const ForeignTable& table, Proposal& proposal) {
  if (!proposal.questions.empty()) return;
  const Mapping& mapping = proposal.mapping;
  if (!mapping[Role::time].given() && !mapping.rate_hz)
    proposal.missing.emplace_back("a time: --time COLUMN, or --rate-hz R" + unread_time(table));
  if (!mapping[Role::command].given() && !mapping[Role::pressure].given())
    proposal.missing.emplace_back("a pressure: --command COLUMN (commanded) or --pressure COLUMN (measured)" +
                                  unfit_column(table, mapping, {Role::command, Role::pressure}));
  if (!mapping[Role::displacement].given())
    proposal.missing.emplace_back("a displacement or a bending angle: --displacement COLUMN" +
                                  unfit_column(table, mapping, {Role::displacement}));
}

/// Returns the first, the middle and the last value of a column as text. For a column of dates or times of
/// day, returns a phrase that states this.
std::string glimpse(const TableColumn& column) {
  std::string text;
  const std::size_t rows = column.values.size();
  for (const std::size_t at : {std::size_t{0}, rows / 2, rows - 1}) {
    const double value = rows == 0 ? std::nan("") : column.values[at];
    text += (text.empty() ? "" : " .. ") + (std::isfinite(value) ? significant(value, 5) : std::string("-"));
  }
  return column.moments > 0 ? "dates or times of day" : text;
}

}  // namespace

std::string unit_of(const TableColumn& column, const ColumnMapping& mapped, Quantity quantity) {
  if (!mapped.unit.empty()) return mapped.unit;
  return !column.unit.empty() ? column.unit : split_unit(column.name, quantity).unit;
}

std::string unit_text(const ForeignTable& table, const ColumnMapping& column, Quantity quantity) {
  if (!column.unit.empty()) return column.unit;
  std::vector<std::string> units;
  for (const std::string& word : column.columns) {
    const std::size_t index = column_index(table, word);
    if (index == table.columns.size()) continue;
    std::string unit = unit_of(table.columns[index], column, quantity);
    if (!unit.empty() && std::ranges::count(units, unit) == 0) units.push_back(std::move(unit));
  }
  return with_commas(units, [](const std::string& unit) { return unit; });
}

Proposal propose(const ForeignTable& table, const Mapping& given, bool optional_too) {
  Proposal proposal{given, {}, {}, {}, {}, {}};
  const FingerChoice choice = choose_finger(table, given, proposal);
  const auto open = [&](Role role) { return !proposal.mapping[role].given(); };
  // Assign the command before the measured pressure. In the opposite order, the column of the command could
  // be mistaken for the measured pressure.
  for (const Role role :
       {Role::time, Role::displacement, Role::supply, Role::command, Role::pressure, Role::temperature}) {
    const bool needed = (role == Role::time && !given.rate_hz) || role == Role::displacement ||
                        ((role == Role::command || role == Role::pressure) && !given[Role::command].given() &&
                         !given[Role::pressure].given());
    if (open(role) && (needed || optional_too) && !(role == Role::time && given.rate_hz))
      choose(table, spec_of(role), choice, proposal);
  }
  if (!given[Role::time].given()) choose_times(table, choice, proposal);
  choose_codes(table, given, proposal);
  ColumnMapping& time = proposal.mapping[Role::time];
  if (time.columns.size() == 1 && time.unit.empty() && !time.scale &&
      unit_text(table, time, Quantity::time).empty()) {
    const std::size_t index = column_index(table, time.columns.front());
    if (index < table.columns.size()) time.unit = epoch_unit(table.columns[index]);
  }
  say_what_is_missing(table, proposal);
  return proposal;
}

std::string mapping_table(const ForeignTable& table, const Mapping& mapping) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    std::string use = column.is_part_of_time ? "the column is a part of the time" : "-";
    for (const RoleSpec& spec : roles) {
      const ColumnMapping& mapped = mapping[spec.role];
      const bool here = std::any_of(mapped.columns.begin(), mapped.columns.end(),
                                    [&](const std::string& word) { return column_index(table, word) == i; });
      if (!here) continue;
      const std::string unit = unit_of(column, mapped, spec.quantity);
      use = std::string(spec.word) + (column.moments > 0 ? "" : unit.empty() ? " (no unit)" : " in " + unit);
    }
    std::string name = column.name.empty() ? "(no name)" : document::shown(column.name, 40);
    std::string line = "  " + std::to_string(i + 1) + "  " + name;
    line.resize(std::max<std::size_t>(line.size() + 2, 34), ' ');
    line += glimpse(column);
    line.resize(std::max<std::size_t>(line.size() + 2, 68), ' ');
    text += line + use + "\n";
  }
  return text;
}

}  // namespace softgrip::sysid
