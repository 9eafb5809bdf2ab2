#include "sysid/import/conversion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/enumerated.h"
#include "base/numbers.h"
#include "sysid/import/proposal.h"
#include "sysid/import/samples.h"

namespace softgrip::sysid {
namespace {

/// One role's columns and what comes of their values.
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
    ImportedLog result;
    ForeignSamples samples = samples_of_table();
    if (const auto problem = order_in_time(mapping_, samples, result.notes)) {
      refuse_row(*problem);
      return std::nullopt;
    }
    subtract_first(samples);
    check_any_value(samples);
    if (problems_.size() != before) return std::nullopt;
    complete_drive(samples, result.notes);
    cut_at_holes(samples, result.notes);
    result.log = log_of(std::move(samples));
    return result;
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
    for (const std::string& missing : proposal.missing)
      refuse("the columns show no part of a log: " + missing);
    for (const Role role : proposal.guessed)
      refuse("nothing says which column is the " + std::string(spec_of(role).word),
             "--" + std::string(spec_of(role).word) + " COLUMN");
    if (table_.channels.size() > 1 && mapping_.channel.empty()) {
      std::string names;
      for (const std::string& name : table_.channels) names += (names.empty() ? "'" : ", '") + name + "'";
      refuse("the file holds " + std::to_string(table_.channels.size()) + " channels: " + names,
             "say which one with --channel");
    } else if (!mapping_.channel.empty() && table_.rows() == 0) {
      refuse("no row is of channel '" + document::shown(mapping_.channel) + "'");
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
           same > 1       ? "give its number, counted from 1"
           : near.empty() ? "the columns are " + all.substr(0, 400)
                          : "is '" + document::shown(near) + "' meant?");
  }

  void check_cells(const RoleSpec& spec, const TableColumn& column) {
    for (const BadCell& cell : column.bad) {
      problems_.add({table_.file, cell.at, cell.line_text,
                     std::string(spec.word) + ": '" + document::shown(cell.text, 40) + "' is no number",
                     "--missing says what stands where nothing was read"});
    }
    if (column.bad_count > column.bad.size())
      refuse(std::string(spec.word) + ": " + std::to_string(column.bad_count - column.bad.size()) +
             " more of these");
    const bool time = spec.role == Role::time;
    const auto numbers = static_cast<std::size_t>(
        std::count_if(column.values.begin(), column.values.end(), [](double v) { return std::isfinite(v); }));
    if (column.moments > 0 && (!time || numbers != column.moments))
      refuse(std::string(spec.word) + ": '" + document::shown(column.name) + "' has dates or times of day" +
             (time ? " and numbers" : ""));
  }

  void find_unit(const RoleSpec& spec, const ColumnMapping& mapped, Source& source) {
    const bool moments = table_.columns[source.columns.front()].moments > 0;
    const std::string text = unit_text(table_, mapped, spec.quantity);
    const std::string word(spec.word);
    if (mapped.scale) {
      source.factor = *mapped.scale;
    } else if (const auto unit = moments ? Unit{} : unit_named(text, spec.quantity); unit) {
      source.factor = unit->factor;
      source.offset = unit->offset;
    } else if (text.empty()) {
      refuse(
          word + ": '" + document::shown(mapped.columns.front()) + "' says no unit",
          "--unit " + word + "=" + std::string(spec.unit) + " (known are " + unit_names(spec.quantity) + ")");
    } else {
      refuse(
          word + ": '" + document::shown(text) + "' is no unit of a " + std::string(name_of(spec.quantity)),
          "--scale " + word + "=X, " + std::string(spec.unit) + " per " + document::shown(text) +
              "; known are " + unit_names(spec.quantity));
    }
    if (mapped.zero) source.offset -= source.factor * *mapped.zero;
  }

  [[nodiscard]] double value_at(const Source& source, std::size_t row) const {
    double sum = 0;
    for (const std::size_t column : source.columns) sum += table_.columns[column].values[row];
    return source.factor * (sum / static_cast<double>(source.columns.size())) + source.offset;
  }

  [[nodiscard]] ForeignSamples samples_of_table() const {
    ForeignSamples samples;
    const std::size_t rows = table_.rows();
    for (std::size_t i = 0; i < rows; ++i) samples.row.push_back(i);
    for (const RoleSpec& spec : roles) {
      const Source& source = sources_[static_cast<std::size_t>(spec.role)];
      if (source.columns.empty()) continue;
      std::vector<double>& values = samples[spec.role];
      values.reserve(rows);
      for (std::size_t i = 0; i < rows; ++i) values.push_back(value_at(source, i));
    }
    for (std::size_t i = 0; i < rows && samples[Role::time].size() < rows; ++i)
      samples[Role::time].push_back(static_cast<double>(i) / *mapping_.rate_hz);
    return samples;
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
               "' holds no value");
    }
  }

  static Log log_of(ForeignSamples samples) {
    Log log;
    for (const RoleSpec& spec : roles) log.*spec.values = std::move(samples[spec.role]);
    return log;
  }

  const ForeignTable& table_;
  const Mapping& mapping_;
  document::Problems& problems_;
  std::array<Source, role_count> sources_;
};

}  // namespace

std::optional<ImportedLog> convert(const ForeignTable& table, const Mapping& mapping,
                                   document::Problems& problems) {
  auto result = Converter(table, mapping, problems).run();
  if (!result) return std::nullopt;
  result->log.path = table.file;
  result->log.channel = mapping.channel;
  // What no other command would read is not written.
  document::Problems refused;
  LogOptions options;
  options.channel = mapping.channel;
  auto read = parse_log(table.file, format_log(result->log), refused, options);
  for (const document::Problem& problem : refused.list())
    problems.add({table.file, {1, 1}, {}, "no log comes of it: " + problem.message, problem.hint});
  if (!read) return std::nullopt;
  result->log.notes = std::move(read->notes);
  return result;
}

}  // namespace softgrip::sysid
