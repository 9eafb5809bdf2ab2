#include "sysid/import/conversion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/import/clock.h"
#include "sysid/import/fingers.h"
#include "sysid/import/missing_codes.h"
#include "sysid/import/role_fit.h"

namespace softgrip::sysid {
namespace {

class UnusedParts {
 public:
  UnusedParts(const ForeignTable& table, const Mapping& mapping, const RoleSources& sources,
              ImportRemarks& remarks, document::Problems& problems)
      : table_(table), mapping_(mapping), sources_(sources), remarks_(remarks), problems_(problems) {}

  void report() {
    name_unused_times();
    refuse_rows_of_fingers();
    name_unused_columns();
    name_equal_columns();
    name_idle_options();
  }

 private:
  void refuse(std::string message, std::string hint) {
    problems_.add({table_.file, {1, 1}, {}, std::move(message), std::move(hint)});
  }

  void name_unused_times() {
    const std::vector<std::size_t> times = time_columns(table_);
    const std::vector<std::size_t>& used = sources_.of_roles[static_cast<std::size_t>(Role::time)].columns;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      if (sources_.uses(i)) continue;
      const TableColumn& column = table_.columns[i];
      const std::string name = "the column '" + document::shown(column.name, 40) + "' looks like a time";
      const bool is_time = std::find(times.begin(), times.end(), i) != times.end();
      if (is_time && used.empty()) {
        remarks_.warnings.push_back(name + " and is not used, because --rate-hz replaces this column");
      } else if (is_time && same_clock(table_, mapping_, used.front(), i)) {
        remarks_.notes.push_back(name +
                                 " and is not used, because the time column in use contains the same times");
      } else if (is_time) {
        remarks_.warnings.push_back(name + " and is not used, because its times differ from the times of '" +
                                    document::shown(table_.columns[used.front()].name, 40) + "'");
      } else if (names_role(column.name, Role::time) && column.bad_count * 2 > column.values.size()) {
        remarks_.warnings.push_back(name + " and cannot be read ('" +
                                    document::shown(column.bad.front().text, 30) +
                                    "'), so the column is not used");
      }
    }
  }

  /// Refuses a table that contains rows of several fingers, if a column of numbers identifies the finger of
  /// each row.
  void refuse_rows_of_fingers() {
    for (std::size_t i = 0; i < table_.columns.size() && !table_.is_text; ++i) {
      const TableColumn& column = table_.columns[i];
      if (sources_.uses(i) || !names_channel(column.name)) continue;
      std::vector<std::string> fingers;
      for (const double value : column.values) {
        const std::string finger = std::isfinite(value) ? shortest(value) : "";
        const bool is_new = std::find(fingers.begin(), fingers.end(), finger) == fingers.end();
        if (!finger.empty() && is_new) fingers.push_back(finger);
        if (fingers.size() > most_fingers) break;
      }
      if (fingers.size() > 1 && fingers.size() <= most_fingers)
        refuse("the rows belong to " + std::to_string(fingers.size()) + " fingers: '" +
                   document::shown(column.name, 40) + "' has " +
                   with_commas(fingers, [](const std::string& finger) { return finger; }),
               "export the rows of each finger to a separate file, or export a text file that contains this "
               "column");
    }
  }

  void name_unused_columns() {
    constexpr std::size_t names_a_note = 8;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const bool is_channel = !table_.channels.empty() && table_.columns[i].name == table_.channel_column;
      if (!sources_.uses(i) && !is_channel && !table_.columns[i].is_part_of_time)
        names.push_back("'" + document::shown(word_of(table_, i), 40) + "'");
    }
    for (std::size_t i = 0; i < names.size(); i += names_a_note) {
      const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(i + names_a_note, names.size()));
      remarks_.notes.push_back(
          "unused columns: " +
          with_commas(std::vector<std::string>(names.begin() + static_cast<std::ptrdiff_t>(i), end),
                      [](const std::string& name) { return name; }));
    }
  }

  /// Adds a warning for each unused column that has the same name as a column of readings. The guess takes
  /// the first of them. name_unused_times() reports repeated time columns.
  void name_equal_columns() {
    for (const RoleSpec& spec : roles) {
      if (spec.role == Role::time) continue;
      for (const std::size_t used : sources_.of_roles[static_cast<std::size_t>(spec.role)].columns) {
        const std::string& name = table_.columns[used].name;
        for (std::size_t i = 0; i < table_.columns.size() && !name.empty(); ++i) {
          if (table_.columns[i].name != name || sources_.uses(i)) continue;
          remarks_.warnings.push_back("column " + std::to_string(i + 1) +
                                      " is not used, but has the name of column " + std::to_string(used + 1) +
                                      ": '" + document::shown(name, 40) +
                                      "'. State the correct column by its number");
        }
      }
    }
  }

  /// Returns the reason why --unit has no effect on the time columns; "" if it has an effect.
  [[nodiscard]] std::string why_no_unit_of_time() const {
    const std::vector<std::size_t>& times = sources_.of_roles[static_cast<std::size_t>(Role::time)].columns;
    const auto has_moments = [&](std::size_t i) {
      return table_.columns[i].moments > 0 && table_.columns[i].short_clocks == 0;
    };
    const auto states_unit = [&](std::size_t i) {
      return has_moments(i) || !stated_unit(table_.columns[i], Quantity::time).empty();
    };
    if (std::ranges::all_of(times, has_moments)) return "the column has dates or times of day";
    const bool all_state = times.size() > 1 && std::ranges::all_of(times, states_unit);
    return all_state ? "each time column states its unit" : "";
  }

  void idle(const std::string& option, const std::string& why) {
    remarks_.warnings.push_back(option + " has no effect: " + why);
  }

  /// Adds a warning for each option that has no effect on this file.
  void name_idle_options() {
    for (const RoleSpec& spec : roles) {
      const ColumnMapping& mapped = mapping_[spec.role];
      const std::string word = " " + std::string(spec.word) + "=";
      const bool time = spec.role == Role::time;
      const std::string stated = time && mapped.given() ? why_no_unit_of_time() : "";
      const std::string why =
          mapped.given() ? "" : "no column is assigned to the role " + std::string(spec.word);
      const bool scaled = mapped.scale && !angle_of_scale(spec, mapped);
      if (!mapped.unit.empty() && (!mapped.given() || scaled || !stated.empty()))
        idle("--unit" + word + mapped.unit, !why.empty() ? why
                                            : scaled     ? "--scale replaces the unit"
                                                         : stated);
      if (mapped.scale && !mapped.given()) idle("--scale" + word + shortest(*mapped.scale), why);
      if ((mapped.zero || mapped.zero_first) && (!mapped.given() || time))
        idle("--zero" + word + (mapped.zero ? shortest(*mapped.zero) : "first"),
             !why.empty() ? why : "times count from the first sample");
    }
    name_idle_words();
    if (mapping_.separator != 0 && !table_.has_separators)
      idle("--separator", table_.is_text ? "the file itself states the separator" : "the file is not a text");
    if (!mapping_.sheet.empty() && table_.sheet.empty()) idle("--sheet", "the file is not a workbook");
    if (mapping_.skip_bad_lines &&
        remarks_.account.left_out[static_cast<std::size_t>(LeftOut::bad_line)] == 0)
      remarks_.notes.emplace_back("--skip-bad-lines had no effect, because all lines are readable");
    const bool cuts = mapping_.from_s > 0 || std::isfinite(mapping_.to_s);
    if (cuts && remarks_.account.left_out[static_cast<std::size_t>(LeftOut::outside_stretch)] == 0)
      idle("--from-s or --to-s", "all samples are between these two times");
  }

  /// Returns true if a role uses the column, and the column contains the number.
  [[nodiscard]] bool supplies(std::size_t column, double number) const {
    return supplies_numbers(column) && std::ranges::count(table_.columns[column].values, number) > 0;
  }

  /// Returns true if a role uses the column, and the column does not contain dates or times of day.
  [[nodiscard]] bool supplies_numbers(std::size_t column) const {
    return table_.columns[column].moments == 0 &&
           std::any_of(roles.begin(), roles.end(), [&](const RoleSpec& spec) {
             const RoleSource& source = sources_.of_roles[static_cast<std::size_t>(spec.role)];
             return std::ranges::count(source.columns, column) > 0;
           });
  }

  /// Names the columns in which a number of --missing occurs, and the words of --missing that do not occur.
  void name_idle_words() {
    std::size_t text_word = 0;
    for (const std::string& word : mapping_.missing) {
      bool occurs = false;
      if (const auto number = missing_number(word)) {
        std::vector<std::string> found;
        for (std::size_t i = 0; i < table_.columns.size(); ++i) {
          if (supplies(i, *number)) found.push_back(cells_with(table_.columns[i], *number));
        }
        occurs = !found.empty();
        if (occurs)
          remarks_.notes.push_back("--missing " + word + " applies to " +
                                   with_commas(found, [](const std::string& cells) { return cells; }));
      } else if (text_word < table_.missing_cells.size()) {
        occurs = table_.missing_cells[text_word++] > 0;
      }
      if (!occurs)
        idle("--missing " + document::shown(word, 40), "no cell of the used columns contains this text");
    }
    for (const ColumnCode& code : mapping_.missing_in) {
      const std::size_t column = column_index(table_, code.column);
      const bool is_used = column < table_.columns.size() && supplies_numbers(column);
      if (!is_used || !supplies(column, code.value))
        idle("--missing-in " + document::shown(code.column, 40) + "=" + shortest(code.value),
             is_used ? "no cell of this column contains this number"
                     : "the import does not use numbers of this column");
    }
  }

  const ForeignTable& table_;
  const Mapping& mapping_;
  const RoleSources& sources_;
  ImportRemarks& remarks_;
  document::Problems& problems_;
};

}  // namespace

void report_unused(const ForeignTable& table, const Mapping& mapping, const RoleSources& sources,
                   ImportRemarks& remarks, document::Problems& problems) {
  UnusedParts(table, mapping, sources, remarks, problems).report();
}

}  // namespace softgrip::sysid
