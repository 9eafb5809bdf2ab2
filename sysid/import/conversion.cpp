#include "sysid/import/conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/enumerated.h"
#include "base/numbers.h"
#include "sysid/import/clock.h"
#include "sysid/import/fingers.h"
#include "sysid/import/proposal.h"
#include "sysid/import/samples.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

/// Columns of one role and the conversion of their values. The value in the log is factor * value + offset.
struct Source {
  std::vector<std::size_t> columns;
  double factor = 1;
  double offset = 0;
};

class Converter {
 public:
  Converter(const ForeignTable& table, const Mapping& mapping, document::Problems& problems)
      : table_(table), mapping_(mapping), problems_(problems) {}

  std::optional<ImportedLog> run() {
    const std::size_t before = problems_.size();
    check_completeness();
    for (const RoleSpec& spec : roles) resolve(spec);
    if (problems_.size() != before) return std::nullopt;
    remarks_.account = table_.account;
    ForeignSamples samples = samples_of_table();
    if (problems_.size() != before) return std::nullopt;
    if (const auto problem = order_in_time(mapping_, samples, remarks_)) {
      refuse_row(*problem);
      return std::nullopt;
    }
    subtract_first(samples);
    check_any_value(samples);
    if (problems_.size() != before) return std::nullopt;
    complete_drive(samples, remarks_);
    cut_at_holes(samples, remarks_);
    check_account(samples.size());
    if (problems_.size() != before) return std::nullopt;
    name_unused_times();
    refuse_rows_of_fingers();
    name_unused_columns();
    name_idle_options();
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
    Source& source = sources_[static_cast<std::size_t>(spec.role)];
    for (const std::string& word : mapped.columns) {
      const std::size_t index = column_index(table_, word);
      if (index < table_.columns.size()) {
        source.columns.push_back(index);
        check_cells(spec, table_.columns[index]);
      } else {
        refuse_column(spec, word);
      }
    }
    if (!source.columns.empty()) find_unit(spec, mapped, source);
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

  void check_cells(const RoleSpec& spec, const TableColumn& column) {
    if (mapping_.skip_bad_lines) {
      bad_rows_.insert(column.bad_rows.begin(), column.bad_rows.end());
    } else {
      refuse_bad_cells(spec, column);
    }
    const bool time = spec.role == Role::time;
    const auto numbers = static_cast<std::size_t>(
        std::count_if(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); }));
    if (column.moments > 0 && (!time || numbers != column.moments))
      refuse(std::string(spec.word) + ": '" + document::shown(column.name) + "' has dates or times of day" +
             (time ? " and numbers" : ""));
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
             " more of these");
  }

  void find_unit(const RoleSpec& spec, const ColumnMapping& mapped, Source& source) {
    // Samples_by_times() converts the time columns one by one.
    if (spec.role == Role::time && source.columns.size() > 1) return;
    if (spec.role == Role::time && !find_clock(table_.columns[source.columns.front()], mapped, source))
      return;
    const bool moments = table_.columns[source.columns.front()].moments > 0;
    const std::string text = unit_text(table_, mapped, spec.quantity);
    const std::string word(spec.word);
    if (mapped.scale) {
      source.factor = *mapped.scale;
      if (const auto angle = angle_of_scale(spec, mapped)) {
        source.factor *= angle->factor;
        output_unit_ = angle->output;
      }
    } else if (const auto unit =
                   moments ? Unit{"s", Quantity::time, source.factor} : unit_named(text, spec.quantity);
               unit) {
      source.factor = unit->factor;
      source.offset = unit->offset;
      if (spec.role == Role::displacement) output_unit_ = unit->output;
    } else if (text.empty()) {
      refuse(
          word + ": '" + document::shown(mapped.columns.front()) + "' has no unit",
          "--unit " + word + "=" + std::string(spec.unit) + " (known are " + unit_names(spec.quantity) + ")");
    } else {
      refuse(
          word + ": '" + document::shown(text) + "' is not a unit of " + std::string(name_of(spec.quantity)),
          "--scale " + word + "=X, " + std::string(spec.unit) + " per " + document::shown(text) +
              "; known are " + unit_names(spec.quantity));
    }
    if (mapped.zero) source.offset -= source.factor * *mapped.zero;
  }

  [[nodiscard]] std::vector<double> missing_codes() const {
    std::vector<double> codes;
    for (const std::string& word : mapping_.missing) {
      if (const auto number = missing_number(word)) codes.push_back(*number);
    }
    return codes;
  }

  /// Returns the unit of the angle if the options contain --scale and --unit displacement=deg or rad.
  static std::optional<Unit> angle_of_scale(const RoleSpec& spec, const ColumnMapping& mapped) {
    if (spec.role != Role::displacement || !mapped.scale || mapped.unit.empty()) return std::nullopt;
    auto unit = unit_named(mapped.unit, spec.quantity);
    if (unit && unit->output == model::OutputUnit::mm) unit.reset();
    return unit;
  }

  /// Determines how times with two fields are read. "12:34" can be hh:mm or mm:ss, so the unit of the column
  /// decides.
  bool find_clock(const TableColumn& column, const ColumnMapping& mapped, Source& source) {
    if (column.short_clocks == 0) return true;
    const std::string unit = lower_case(unit_text(table_, mapped, Quantity::time));
    const bool hours = unit == "hh:mm";
    if (hours && !column.surely_minutes && column.short_clocks == column.moments) source.factor = 60;
    if (source.factor == 60 || (!hours && (column.surely_minutes || unit == "mm:ss"))) return true;
    refuse("time: '" + document::shown(column.name, 40) +
               (hours ? "' contains times that cannot be hours and minutes"
                      : "' contains times that can be hours and minutes, or minutes and seconds"),
           "--unit time=mm:ss" + std::string(hours ? "" : ", or --unit time=hh:mm"));
    return false;
  }

  [[nodiscard]] bool is_missing(double value) const {
    return std::find(missing_.begin(), missing_.end(), value) != missing_.end();
  }

  [[nodiscard]] double value_at(const Source& source, std::size_t row) const {
    double sum = 0;
    for (const std::size_t column : source.columns) {
      const double value = table_.columns[column].values[row];
      sum += is_missing(value) ? std::nan("") : value;
    }
    return source.factor * (sum / static_cast<double>(source.columns.size())) + source.offset;
  }

  ForeignSamples samples_of_table() {
    if (!table_.is_text) remarks_.account.rows += table_.rows();
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < table_.rows(); ++i) {
      if (bad_rows_.count(i) == 0) rows.push_back(i);
    }
    remarks_.account.leave_out(LeftOut::bad_line, table_.rows() - rows.size());
    if (rows.size() < table_.rows())
      remarks_.notes.push_back("--skip-bad-lines leaves out " + std::to_string(table_.rows() - rows.size()) +
                               " rows with a cell that is not a number");
    const bool by_times = mapping_[Role::time].columns.size() > 1;
    if (table_.has_rows_of_signals && !by_times) leave_out_unused(rows);
    return by_times ? samples_by_times(rows) : samples_of_rows(rows);
  }

  /// Removes the rows without a value in any used column. In an MCAP recording, these rows are messages of
  /// unused topics.
  void leave_out_unused(std::vector<std::size_t>& rows) {
    const auto unused = [&](std::size_t row) {
      return std::none_of(roles.begin(), roles.end(), [&](const RoleSpec& spec) {
        const Source& source = sources_[static_cast<std::size_t>(spec.role)];
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
      const Source& source = sources_[static_cast<std::size_t>(spec.role)];
      if (source.columns.empty()) continue;
      std::vector<double>& values = samples[spec.role];
      values.reserve(rows.size());
      for (const std::size_t row : rows)
        values.push_back(spec.role == Role::time ? table_.columns[source.columns.front()].values[row]
                                                 : value_at(source, row));
    }
    std::vector<double>& time = samples[Role::time];
    const Source& source = sources_[static_cast<std::size_t>(Role::time)];
    if (!time.empty()) continue_clock(time, source.factor, rows);
    for (double& value : time) value = source.factor * value + source.offset;
    for (std::size_t i = 0; i < rows.size() && time.size() < rows.size(); ++i)
      time.push_back(static_cast<double>(rows[i]) / *mapping_.rate_hz);
    return samples;
  }

  /// Corrects the overflows of a clock and adds a note about them.
  /// @param rows  row of the table for each time.
  void continue_clock(std::vector<double>& time, double unit_s, const std::vector<std::size_t>& rows) {
    const auto overflow = continue_overflows(time, unit_s);
    if (!overflow) return;
    const std::size_t row = rows[overflow->first];
    const bool has_lines = row < table_.line.size();
    remarks_.notes.push_back("the clock overflows at " + written(overflow->period) + ", " +
                             std::to_string(overflow->count) + (overflow->count == 1 ? " time" : " times") +
                             ", first in " + (has_lines ? "line " : "sample ") +
                             std::to_string(has_lines ? table_.line[row] : static_cast<int>(row) + 1) +
                             ": the clock is corrected");
  }

  /// A time in one of several time columns.
  struct Entry {
    double time_s = 0;
    std::size_t clock = 0;
    std::size_t row = 0;
  };

  /// Returns one sample for each row and time column, sorted by time. Each sample contains only the values
  /// that belong to its time column.
  ForeignSamples samples_by_times(const std::vector<std::size_t>& rows) {
    const std::vector<std::size_t>& clocks = sources_[static_cast<std::size_t>(Role::time)].columns;
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
    // A skipped line counts once per time column. Its first count is already in the account.
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
        if (spec.role == Role::time || sources_[role].columns.empty()) continue;
        const bool here = (*of_roles)[role] == entry.clock;
        samples[spec.role].push_back(here ? value_at(sources_[role], entry.row) : std::nan(""));
      }
    }
    remarks_.notes.push_back(
        "each row has " + std::to_string(clocks.size()) +
        " times: the values are merged by time, and each different time counts as one row");
    return samples;
  }

  bool add_entries(const std::vector<std::size_t>& rows, std::size_t clock, std::vector<Entry>& entries) {
    const TableColumn& column = table_.columns[clock];
    const auto time_s = seconds_of(table_, mapping_, clock);
    const std::string name = "time: '" + document::shown(column.name, 40) + "' ";
    if (!time_s || column.short_clocks > 0) {
      refuse(name + "has no unit", "--unit time=s (known are " + unit_names(Quantity::time) + ")");
      return false;
    }
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

  /// Removes entries that have neither a time nor a value. They occur because a time column that ends earlier
  /// than another one continues with empty cells.
  void leave_out_empty(const std::array<std::size_t, role_count>& of_roles, std::vector<Entry>& entries) {
    const auto empty = [&](const Entry& entry) {
      if (std::isfinite(entry.time_s)) return false;
      for (const RoleSpec& spec : roles) {
        const auto role = static_cast<std::size_t>(spec.role);
        if (spec.role != Role::time && of_roles[role] == entry.clock && !sources_[role].columns.empty() &&
            std::isfinite(value_at(sources_[role], entry.row)))
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

  [[nodiscard]] bool is_used(std::size_t column) const {
    return std::any_of(sources_.begin(), sources_.end(), [&](const Source& source) {
      return std::find(source.columns.begin(), source.columns.end(), column) != source.columns.end();
    });
  }

  void name_unused_times() {
    const std::vector<std::size_t> times = time_columns(table_);
    const std::vector<std::size_t>& used = sources_[static_cast<std::size_t>(Role::time)].columns;
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      if (is_used(i)) continue;
      const TableColumn& column = table_.columns[i];
      const std::string name = "the column '" + document::shown(column.name, 40) + "' looks like a time";
      const bool is_time = std::find(times.begin(), times.end(), i) != times.end();
      if (is_time && used.empty()) {
        remarks_.warnings.push_back(name + " and is not used, because --rate-hz replaces this column");
      } else if (is_time && same_clock(table_, mapping_, used.front(), i)) {
        remarks_.notes.push_back(name + " and contains the same times as the time column that is used");
      } else if (is_time) {
        remarks_.warnings.push_back(name + " and is not used, because its times differ from those of '" +
                                    document::shown(table_.columns[used.front()].name, 40) + "'");
      } else if (names_role(column.name, Role::time) && column.bad_count * 2 > column.values.size()) {
        remarks_.warnings.push_back(name + " and cannot be read ('" +
                                    document::shown(column.bad.front().text, 30) +
                                    "'), so this column is not used");
      }
    }
  }

  /// Refuses a table that contains rows of several fingers, if a column of numbers identifies the finger of
  /// each row.
  void refuse_rows_of_fingers() {
    for (std::size_t i = 0; i < table_.columns.size() && !table_.is_text; ++i) {
      const TableColumn& column = table_.columns[i];
      if (is_used(i) || !names_channel(column.name)) continue;
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
      if (!is_used(i) && !is_channel && !table_.columns[i].is_part_of_time)
        names.push_back("'" + document::shown(word_of(table_, i), 40) + "'");
    }
    for (std::size_t i = 0; i < names.size(); i += names_a_note) {
      const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(i + names_a_note, names.size()));
      remarks_.notes.push_back(
          "not used: " +
          with_commas(std::vector<std::string>(names.begin() + static_cast<std::ptrdiff_t>(i), end),
                      [](const std::string& name) { return name; }));
    }
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
      const bool dates = time && mapped.given() && table_.columns[sources_[0].columns.front()].moments > 0 &&
                         table_.columns[sources_[0].columns.front()].short_clocks == 0;
      const std::string why =
          mapped.given() ? "" : "no column is assigned to the role " + std::string(spec.word);
      const bool scaled = mapped.scale && !angle_of_scale(spec, mapped);
      if (!mapped.unit.empty() && (!mapped.given() || scaled || dates))
        idle("--unit" + word + mapped.unit, !why.empty() ? why
                                            : scaled     ? "--scale replaces the unit"
                                                         : "the column has dates or times of day");
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

  void name_idle_words() {
    std::size_t text_word = 0;
    for (const std::string& word : mapping_.missing) {
      std::size_t cells = 0;
      if (const auto number = missing_number(word)) {
        for (std::size_t i = 0; i < table_.columns.size(); ++i) {
          const std::vector<double>& values = table_.columns[i].values;
          if (is_used(i))
            cells += static_cast<std::size_t>(std::count(values.begin(), values.end(), *number));
        }
      } else if (text_word < table_.missing_cells.size()) {
        cells = table_.missing_cells[text_word++];
      }
      if (cells == 0)
        idle("--missing " + document::shown(word, 40), "no cell of the used columns contains this text");
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

  void check_any_value(const ForeignSamples& samples) {
    for (const RoleSpec& spec : roles) {
      const std::vector<double>& values = samples[spec.role];
      const bool none = !values.empty() &&
                        std::none_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
      if (none)
        refuse(std::string(spec.word) + ": '" + document::shown(mapping_[spec.role].columns.front()) +
               "' has no value");
    }
  }

  [[nodiscard]] Log log_of(ForeignSamples samples) const {
    Log log;
    log.output_unit = output_unit_;
    for (const RoleSpec& spec : roles) log.*spec.values = std::move(samples[spec.role]);
    return log;
  }

  const ForeignTable& table_;
  const Mapping& mapping_;
  document::Problems& problems_;
  std::array<Source, role_count> sources_;
  std::set<std::size_t> bad_rows_;
  std::vector<double> missing_ = missing_codes();
  ImportRemarks remarks_;
  model::OutputUnit output_unit_ = model::OutputUnit::mm;
  double clocks_begin_s_ = -std::numeric_limits<double>::infinity();
  double clocks_end_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<double> missing_number(const std::string& word) {
  return to_number(word);
}

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
  auto read = parse_log(table.file, format_log(result->log), refused, options);
  for (const document::Problem& problem : refused.list())
    problems.add({table.file, {1, 1}, {}, "the result is not a valid log: " + problem.message, problem.hint});
  if (!read) return std::nullopt;
  result->log.notes = std::move(read->notes);
  return result;
}

}  // namespace softgrip::sysid
