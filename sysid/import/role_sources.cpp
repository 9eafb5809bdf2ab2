#include "sysid/import/role_sources.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/import/clock.h"
#include "sysid/import/proposal.h"

namespace softgrip::sysid {
namespace {

class SourceResolver {
 public:
  SourceResolver(const ForeignTable& table, const Mapping& mapping, document::Problems& problems)
      : table_(table), mapping_(mapping), problems_(problems) {}

  RoleSources run() {
    check_completeness();
    for (const RoleSpec& spec : roles) resolve(spec);
    return std::move(sources_);
  }

 private:
  void refuse(std::string message, std::string hint = {}) {
    problems_.add({table_.file, {1, 1}, {}, std::move(message), std::move(hint)});
  }

  void check_completeness() {
    const Proposal proposal = propose(table_, mapping_, false);
    for (const std::string& missing : proposal.missing) refuse("no column was recognised as " + missing);
    for (const Role role : proposal.guessed)
      refuse("no column is assigned to the role " + std::string(spec_of(role).word),
             "--" + std::string(spec_of(role).word) + " COLUMN");
    for (const Proposal::Question& question : proposal.questions) refuse(question.text, question.hint);
    if (table_.channels.size() > 1 && mapping_.channel.empty()) {
      std::string names;
      for (const std::string& name : table_.channels) names += (names.empty() ? "'" : ", '") + name + "'";
      refuse("the file has " + std::to_string(table_.channels.size()) + " channels: " + names,
             "select one finger with --channel");
    } else if (!mapping_.channel.empty() && table_.rows() == 0) {
      refuse("no row belongs to channel '" + document::shown(mapping_.channel) + "'");
    }
  }

  void resolve(const RoleSpec& spec) {
    const ColumnMapping& mapped = mapping_[spec.role];
    RoleSource& source = sources_.of_roles[static_cast<std::size_t>(spec.role)];
    for (const std::string& word : mapped.columns) {
      const std::size_t index = column_index(table_, word);
      if (index < table_.columns.size()) {
        source.columns.push_back(index);
        check_cells(spec, word, table_.columns[index]);
        // If there are several time columns, samples_by_times() converts each of them separately.
        if (spec.role != Role::time || mapped.columns.size() == 1) find_unit(spec, mapped, word, source);
      } else {
        refuse_column(spec, word);
      }
    }
  }

  void refuse_column(const RoleSpec& spec, const std::string& word) {
    const auto same = std::count_if(table_.columns.begin(), table_.columns.end(),
                                    [&](const TableColumn& column) { return column.name == word; });
    std::vector<std::string> names;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) names.push_back(word_of(table_, i));
    const std::string near = document::nearest(word, names);
    const std::string all = with_commas(names, [](const std::string& name) { return document::shown(name); });
    refuse(std::string(spec.word) + ": " + (same > 1 ? "more than one column '" : "no column '") +
               document::shown(word) + "'",
           same > 1       ? "give the number of the column, counted from 1"
           : near.empty() ? "the columns are " + all.substr(0, 400)
                          : "is '" + document::shown(near) + "' meant?");
  }

  void check_cells(const RoleSpec& spec, const std::string& named, const TableColumn& column) {
    if (mapping_.skip_bad_lines) {
      sources_.bad_rows.insert(column.bad_rows.begin(), column.bad_rows.end());
    } else {
      refuse_bad_cells(spec, column);
    }
    if (!column.ambiguous_mark.empty()) refuse_mark(spec, named, column.ambiguous_mark);
    const bool time = spec.role == Role::time;
    const auto numbers = static_cast<std::size_t>(
        std::count_if(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); }));
    if (column.moments > 0 && (!time || numbers != column.moments))
      refuse(std::string(spec.word) + ": '" + document::shown(column.name) + "' has dates or times of day" +
             (time ? " and numbers" : ""));
  }

  /// Refuses a column whose decimal mark can also separate thousands.
  /// @param cell  cell with such a mark.
  void refuse_mark(const RoleSpec& spec, const std::string& named, const std::string& cell) {
    const std::string mark = cell.find(',') != std::string::npos ? "comma" : "point";
    refuse(std::string(spec.word) + ": the " + mark + " in the cell '" + document::shown(cell, 40) +
               "' of '" + document::shown(named, 40) + "' can be a decimal " + mark +
               " or separate thousands, because the numbers of this column do not all have one " + mark,
           "export the file without thousands separators. If the " + mark + " is a decimal " + mark +
               ", export the same number of decimals in each cell");
  }

  void refuse_bad_cells(const RoleSpec& spec, const TableColumn& column) {
    for (const BadCell& cell : column.bad) {
      problems_.add({table_.file, cell.at, cell.line_text,
                     std::string(spec.word) + ": " + (cell.cell.empty() ? "" : "cell " + cell.cell + ": ") +
                         "'" + document::shown(cell.text, 40) + "' is not a number",
                     "state the text of missing readings with --missing, or leave out such lines with "
                     "--skip-bad-lines"});
    }
    if (column.bad_count > column.bad.size())
      refuse(std::string(spec.word) + ": " + std::to_string(column.bad_count - column.bad.size()) +
             " more cells are not numbers");
  }

  /// Adds the conversion of the last column of `source`.
  /// @param named  name or number of this column in the mapping.
  void find_unit(const RoleSpec& spec, const ColumnMapping& mapped, const std::string& named,
                 RoleSource& source) {
    const TableColumn& column = table_.columns[source.columns.back()];
    Conversion conversion;
    if (spec.role == Role::time && !find_clock(column, mapped, conversion)) return;
    const bool moments = column.moments > 0;
    const std::string text = unit_of(column, mapped, spec.quantity);
    const std::string word(spec.word);
    if (mapped.scale) {
      conversion.factor = *mapped.scale;
      if (const auto angle = angle_of_scale(spec, mapped)) {
        conversion.factor *= angle->factor;
        sources_.output_unit = angle->output;
      }
    } else if (const auto unit =
                   moments ? Unit{"s", Quantity::time, conversion.factor} : unit_named(text, spec.quantity);
               unit) {
      conversion = {unit->factor, unit->offset};
      if (spec.role == Role::displacement) set_output_unit(mapped, source, *unit);
    } else if (text.empty()) {
      refuse(word + ": '" + document::shown(named) + "' has no unit",
             "--unit " + word + "=" + std::string(spec.unit) + " (known units: " + unit_names(spec.quantity) +
                 ")");
    } else {
      refuse(
          word + ": '" + document::shown(text) + "' is not a unit of " + std::string(name_of(spec.quantity)),
          "--scale " + word + "=X, " + std::string(spec.unit) + " per " + document::shown(text) +
              "; known units: " + unit_names(spec.quantity));
    }
    if (mapped.zero) conversion.offset -= conversion.factor * *mapped.zero;
    source.conversions.push_back(conversion);
  }

  /// Refuses the mean of a length and an angle.
  void set_output_unit(const ColumnMapping& mapped, const RoleSource& source, const Unit& unit) {
    const auto shown = [&](std::size_t index) {
      const TableColumn& column = table_.columns[index];
      return "'" + document::shown(word_of(table_, index), 40) + "' in " +
             document::shown(unit_of(column, mapped, Quantity::displacement));
    };
    if (source.columns.size() > 1 && unit.output != sources_.output_unit)
      refuse("displacement: " + shown(source.columns.front()) + " and " + shown(source.columns.back()) +
                 " have no mean, because one column is a length and the other column is an angle",
             "give only one of the two columns");
    sources_.output_unit = unit.output;
  }

  /// Determines how times with two fields are read. "12:34" can be hh:mm or mm:ss, and the unit of the column
  /// determines which of the two applies.
  bool find_clock(const TableColumn& column, const ColumnMapping& mapped, Conversion& conversion) {
    if (column.short_clocks == 0) return true;
    const std::string unit = lower_case(unit_of(column, mapped, Quantity::time));
    const bool hours = unit == "hh:mm";
    if (hours && !column.surely_minutes && column.short_clocks == column.moments) conversion.factor = 60;
    if (conversion.factor == 60 || (!hours && (column.surely_minutes || unit == "mm:ss"))) return true;
    refuse("time: '" + document::shown(column.name, 40) +
               (hours ? "' contains times that cannot be hours and minutes"
                      : "' contains times that can be hours and minutes, or minutes and seconds"),
           "--unit time=mm:ss" + std::string(hours ? "" : ", or --unit time=hh:mm"));
    return false;
  }

  const ForeignTable& table_;
  const Mapping& mapping_;
  document::Problems& problems_;
  RoleSources sources_;
};

}  // namespace

bool RoleSources::uses(std::size_t column) const {
  return std::any_of(of_roles.begin(), of_roles.end(), [&](const RoleSource& source) {
    return std::find(source.columns.begin(), source.columns.end(), column) != source.columns.end();
  });
}

RoleSources resolve_sources(const ForeignTable& table, const Mapping& mapping, document::Problems& problems) {
  return SourceResolver(table, mapping, problems).run();
}

std::optional<Unit> angle_of_scale(const RoleSpec& spec, const ColumnMapping& mapped) {
  if (spec.role != Role::displacement || !mapped.scale || mapped.unit.empty()) return std::nullopt;
  auto unit = unit_named(mapped.unit, spec.quantity);
  if (unit && unit->output == model::OutputUnit::mm) unit.reset();
  return unit;
}

}  // namespace softgrip::sysid
