#include "sysid/import/conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/numbers.h"
#include "sysid/import/clock.h"
#include "sysid/import/missing_codes.h"
#include "sysid/import/proposal.h"
#include "sysid/import/role_sources.h"
#include "sysid/import/row_groups.h"
#include "sysid/import/samples.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

class Converter {
 public:
  Converter(const ForeignTable& table, const Mapping& mapping, document::Problems& problems)
      : table_(table), mapping_(mapping), problems_(problems) {}

  std::optional<ImportedLog> run() {
    const std::size_t before = problems_.size();
    sources_ = resolve_sources(table_, mapping_, problems_);
    if (problems_.size() != before) return std::nullopt;
    remarks_.account = table_.account;
    remarks_.warnings = table_.warnings;
    ForeignSamples samples = samples_of_table();
    if (problems_.size() != before) return std::nullopt;
    // Before --from-s removes samples: `--zero ROLE=first` means the first value of the whole column.
    subtract_first(samples);
    if (const auto problem = order_in_time(mapping_, samples, remarks_, groups_in(samples))) {
      refuse_row(*problem);
      return std::nullopt;
    }
    check_any_value(samples);
    if (problems_.size() != before) return std::nullopt;
    complete_drive(samples, remarks_);
    cut_at_holes(samples, remarks_);
    check_account(samples.size());
    if (problems_.size() != before) return std::nullopt;
    report_unused(table_, mapping_, sources_, remarks_, problems_);
    return ImportedLog{log_of(std::move(samples)), std::move(remarks_.notes), std::move(remarks_.warnings),
                       remarks_.account};
  }

 private:
  void refuse(std::string message, std::string hint = {}) {
    problems_.add({table_.file, {1, 1}, {}, std::move(message), std::move(hint)});
  }
  void refuse_row(const SampleProblem& problem) {
    const bool has_lines = problem.row < table_.line.size();
    problems_.add({table_.file,
                   {has_lines ? table_.line[problem.row] : 1, 1},
                   {},
                   problem.message + (has_lines ? "" : " (sample " + std::to_string(problem.row + 1) + ")"),
                   problem.hint});
  }

  /// Returns the codes for missing values of each column of the table.
  [[nodiscard]] std::vector<std::vector<double>> codes_of_columns() const {
    std::vector<std::vector<double>> codes;
    for (std::size_t i = 0; i < table_.columns.size(); ++i)
      codes.push_back(missing_codes(table_, mapping_, i));
    return codes;
  }

  /// Returns the number in a cell; NaN if the cell is empty or contains a code for a missing value.
  [[nodiscard]] double cell_at(std::size_t column, std::size_t row) const {
    const double value = table_.columns[column].values[row];
    return std::ranges::count(missing_[column], value) > 0 ? missing_value : value;
  }

  [[nodiscard]] double value_at(const RoleSource& source, std::size_t row) const {
    double sum = 0;
    for (std::size_t k = 0; k < source.columns.size(); ++k) {
      sum += source.conversions[k](cell_at(source.columns[k], row));
    }
    return sum / static_cast<double>(source.columns.size());
  }

  ForeignSamples samples_of_table() {
    if (!table_.is_text) remarks_.account.rows += table_.rows();
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < table_.rows(); ++i) {
      if (sources_.bad_rows.count(i) == 0) rows.push_back(i);
    }
    remarks_.account.leave_out(LeftOut::bad_line, table_.rows() - rows.size());
    if (rows.size() < table_.rows())
      remarks_.notes.push_back("--skip-bad-lines leaves out " + std::to_string(table_.rows() - rows.size()) +
                               (table_.rows() - rows.size() == 1 ? " row" : " rows") +
                               " with a cell that is not a number");
    const bool by_times = mapping_[Role::time].columns.size() > 1;
    if (table_.has_rows_of_signals && !by_times) leave_out_unused(rows);
    return by_times ? samples_by_times(rows) : samples_of_rows(rows);
  }

  /// Removes the rows that have no value in any of the used columns. In an MCAP recording, these rows are
  /// messages of unused topics.
  void leave_out_unused(std::vector<std::size_t>& rows) {
    const auto unused = [&](std::size_t row) {
      return std::none_of(roles.begin(), roles.end(), [&](const RoleSpec& spec) {
        const RoleSource& source = sources_.of_roles[static_cast<std::size_t>(spec.role)];
        return spec.role != Role::time && !source.columns.empty() && std::isfinite(value_at(source, row));
      });
    };
    const auto kept = std::remove_if(rows.begin(), rows.end(), unused);
    remarks_.account.leave_out(LeftOut::empty, static_cast<std::size_t>(rows.end() - kept));
    rows.erase(kept, rows.end());
  }

  ForeignSamples samples_of_rows(const std::vector<std::size_t>& rows) {
    ForeignSamples samples;
    samples.row = rows;
    for (const RoleSpec& spec : roles) {
      const RoleSource& source = sources_.of_roles[static_cast<std::size_t>(spec.role)];
      if (source.columns.empty()) continue;
      std::vector<double>& values = samples[spec.role];
      values.reserve(rows.size());
      for (const std::size_t row : rows)
        values.push_back(spec.role == Role::time ? cell_at(source.columns.front(), row)
                                                 : value_at(source, row));
    }
    std::vector<double>& time = samples[Role::time];
    const auto& conversions = sources_.of_roles[static_cast<std::size_t>(Role::time)].conversions;
    if (!time.empty()) continue_clock(time, conversions.front().factor, rows);
    for (double& value : time) value = conversions.front()(value);
    for (std::size_t i = 0; i < rows.size() && time.size() < rows.size(); ++i) {
      const std::size_t at = table_.position.empty() ? rows[i] : table_.position[rows[i]];
      time.push_back(static_cast<double>(at) / *mapping_.rate_hz);
    }
    return samples;
  }

  /// Returns about_groups(), if a column separates the rows of several runs or devices and the times repeat
  /// or decrease. If only the readings show the groups, adds a warning and returns "".
  std::string groups_in(const ForeignSamples& samples) {
    if (mapping_[Role::time].columns.size() != 1) return {};
    const auto groups = row_groups(table_, sources_, samples);
    if (!groups) return {};
    if (groups->by_times) return about_groups(table_, *groups);
    remarks_.warnings.push_back(about_groups(table_, *groups));
    return {};
  }

  /// Corrects the overflows of a clock and adds a note about this correction.
  /// @param rows  row of the table for each time.
  void continue_clock(std::vector<double>& time, double unit_s, const std::vector<std::size_t>& rows) {
    const std::size_t column = sources_.of_roles[static_cast<std::size_t>(Role::time)].columns.front();
    // The reader of the text has corrected dates and times of day.
    if (table_.columns[column].moments > 0) return;
    const auto overflow = continue_overflows(time, unit_s);
    if (!overflow) return;
    remarks_.notes.push_back(about_overflow(table_, column, *overflow, rows[overflow->first]));
  }

  /// A time in one of several time columns.
  struct Entry {
    double time_s = 0;
    std::size_t clock = 0;
    std::size_t row = 0;
  };

  /// Returns one sample for each row and each time column, sorted by time. Each sample contains only the
  /// values that belong to the time column of this sample.
  ForeignSamples samples_by_times(const std::vector<std::size_t>& rows) {
    const std::vector<std::size_t>& clocks = sources_.of_roles[static_cast<std::size_t>(Role::time)].columns;
    const auto of_roles = times_of_roles(table_, mapping_, clocks);
    std::vector<Entry> entries;
    bool good = of_roles.has_value();
    if (!good)
      refuse("neither the names nor the order of the columns show which time belongs to which column",
             "give one --time COLUMN");
    for (std::size_t k = 0; good && k < clocks.size(); ++k) good = add_entries(rows, clocks[k], entries);
    ForeignSamples samples;
    if (!good) return samples;
    remarks_.account.rows += (clocks.size() - 1) * table_.rows();
    // A skipped line counts once for each time column. The account already contains one of these counts.
    remarks_.account.leave_out(LeftOut::bad_line, (clocks.size() - 1) * (table_.rows() - rows.size()));
    leave_out_empty(*of_roles, entries);
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.time_s < b.time_s || (std::isfinite(a.time_s) && !std::isfinite(b.time_s));
    });
    for (const Entry& entry : entries) {
      samples.row.push_back(entry.row);
      samples[Role::time].push_back(entry.time_s);
      for (const RoleSpec& spec : roles) {
        const auto role = static_cast<std::size_t>(spec.role);
        if (spec.role == Role::time || sources_.of_roles[role].columns.empty()) continue;
        const bool here = (*of_roles)[role] == entry.clock;
        samples[spec.role].push_back(here ? value_at(sources_.of_roles[role], entry.row) : std::nan(""));
      }
    }
    remarks_.notes.push_back(
        "each row has " + std::to_string(clocks.size()) +
        " times, so the values are merged by time, and each different time becomes one sample");
    return samples;
  }

  bool add_entries(const std::vector<std::size_t>& rows, std::size_t clock, std::vector<Entry>& entries) {
    const TableColumn& column = table_.columns[clock];
    std::optional<Overflow> overflow;
    const auto time_s = seconds_of(table_, mapping_, clock, &overflow);
    const std::string name = "time: '" + document::shown(column.name, 40) + "' ";
    if (!time_s || column.short_clocks > 0) {
      refuse(name + "has no unit", "--unit time=s (known units: " + unit_names(Quantity::time) + ")");
      return false;
    }
    if (overflow) remarks_.notes.push_back(about_overflow(table_, clock, *overflow, overflow->first));
    double last = -std::numeric_limits<double>::infinity();
    double first = std::nan("");
    for (const std::size_t row : rows) {
      const double now = (*time_s)[row];
      if (now < last) {
        refuse_row({row,
                    name + "goes back, from " + significant(last, 9) + " s to " + significant(now, 9) + " s",
                    {}});
        return false;
      }
      if (std::isfinite(now)) last = now;
      if (!std::isfinite(first)) first = now;
      entries.push_back({now, clock, row});
    }
    const bool apart = clocks_end_s_ < first || last < clocks_begin_s_;
    if (apart)
      refuse(name + "does not overlap with the time range of the other column", "give one --time COLUMN");
    clocks_begin_s_ = std::max(clocks_begin_s_, first);
    clocks_end_s_ = std::min(clocks_end_s_, last);
    return !apart;
  }

  /// Removes entries that have neither a time nor a value. Such entries occur if one time column ends before
  /// another time column, because the remaining cells of the shorter column are empty.
  void leave_out_empty(const std::array<std::size_t, role_count>& of_roles, std::vector<Entry>& entries) {
    const auto empty = [&](const Entry& entry) {
      if (std::isfinite(entry.time_s)) return false;
      for (const RoleSpec& spec : roles) {
        const auto role = static_cast<std::size_t>(spec.role);
        if (spec.role != Role::time && of_roles[role] == entry.clock &&
            !sources_.of_roles[role].columns.empty() &&
            std::isfinite(value_at(sources_.of_roles[role], entry.row)))
          return false;
      }
      return true;
    };
    const auto kept = std::remove_if(entries.begin(), entries.end(), empty);
    remarks_.account.leave_out(LeftOut::empty, static_cast<std::size_t>(entries.end() - kept));
    entries.erase(kept, entries.end());
  }

  /// Checks that each row is either used or counted as left out, and that the share of lost rows is not too
  /// large.
  void check_account(std::size_t samples) {
    RowAccount& account = remarks_.account;
    account.used = samples;
    if (!account.balanced()) {
      refuse("the import does not account for all rows: " + account.sentence(),
             "report this error as a defect of softgrip");
    } else if (account.lost_share() > refused_share) {
      refuse("too few rows can be used: " + account.sentence(),
             remarks_.warnings.empty() ? std::string() : remarks_.warnings.front());
    } else if (account.lost_share() > warned_share) {
      remarks_.warnings.insert(remarks_.warnings.begin(), account.sentence());
    }
  }

  void subtract_first(ForeignSamples& samples) const {
    for (const RoleSpec& spec : roles) {
      if (!mapping_[spec.role].zero_first || spec.role == Role::time) continue;
      std::vector<double>& values = samples[spec.role];
      const auto first =
          std::find_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
      const double zero = first == values.end() ? 0 : *first;
      for (double& value : values) value -= zero;
    }
  }

  /// Refuses a role without a value. An optional role whose column has values in other rows is left out
  /// instead.
  void check_any_value(ForeignSamples& samples) {
    for (const RoleSpec& spec : roles) {
      std::vector<double>& values = samples[spec.role];
      const bool none = !values.empty() &&
                        std::none_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
      if (!none) continue;
      const std::string column = document::shown(mapping_[spec.role].columns.front());
      if (is_optional(spec.role) && has_value_in_table(spec.role)) {
        values.clear();
        remarks_.notes.push_back("'" + column +
                                 "' has no value in the rows that are used, so the log has no " +
                                 std::string(spec.word));
      } else {
        refuse(std::string(spec.word) + ": '" + column + "' has no value");
      }
    }
  }

  [[nodiscard]] bool is_optional(Role role) const {
    return role == Role::temperature || role == Role::supply ||
           (role == Role::pressure && mapping_[Role::command].given());
  }

  [[nodiscard]] bool has_value_in_table(Role role) const {
    const RoleSource& source = sources_.of_roles[static_cast<std::size_t>(role)];
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (std::isfinite(value_at(source, row))) return true;
    }
    return false;
  }

  [[nodiscard]] Log log_of(ForeignSamples samples) const {
    Log log;
    log.output_unit = sources_.output_unit;
    for (const RoleSpec& spec : roles) log.*spec.values = std::move(samples[spec.role]);
    return log;
  }

  const ForeignTable& table_;
  const Mapping& mapping_;
  document::Problems& problems_;
  RoleSources sources_;
  std::vector<std::vector<double>> missing_ = codes_of_columns();
  ImportRemarks remarks_;
  double clocks_begin_s_ = -std::numeric_limits<double>::infinity();
  double clocks_end_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                   document::Problems& problems) {
  auto result = Converter(table, mapping, problems).run();
  if (!result) return std::nullopt;
  result->log.path = table.file;
  result->log.channel = mapping.channel;
  // The import does not write a log that the other commands would refuse.
  document::Problems refused;
  LogOptions options;
  options.channel = mapping.channel;
  const Role of_command = mapping[Role::command].given() ? Role::command : Role::pressure;
  options.command_unit = unit_text(table, mapping[of_command], spec_of(of_command).quantity);
  auto read = parse_log(table.file, format_log(result->log), refused, options);
  for (const document::Problem& problem : refused.list())
    problems.add({table.file, {1, 1}, {}, "the result is not a valid log: " + problem.message, problem.hint});
  if (!read) return std::nullopt;
  // The notes state the corrections of the values, so the log must contain the corrected values.
  for (const RoleSpec& spec : roles) result->log.*spec.values = std::move((*read).*spec.values);
  result->log.notes = std::move(read->notes);
  return result;
}

}  // namespace softgrip::sysid
