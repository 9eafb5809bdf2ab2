#include "sysid/import/text_dialect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "sysid/import/cell_value.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {
namespace {

constexpr std::array separators{',', ';', '\t', '|', ' '};
/// Number of lines that are read to determine the separator, once in the middle of the text and once at its
/// end.
constexpr std::size_t looked_at = 40;
/// Largest number of lines above the first row of numbers; empty lines and comments are not counted.
constexpr std::size_t longest_preamble = 1000;

struct Row {
  std::size_t cells = 0;
  std::size_t values = 0;   ///< number of cells with a number, a timestamp or a missing value
  std::size_t numbers = 0;  ///< number of cells with a number or a timestamp
};

Row row_of(const std::vector<Cell>& cells, const TableOptions& options) {
  Row row;
  row.cells = cells.size();
  for (const Cell& cell : cells) {
    const CellKind kind = cell_value(cell.text, options.missing).kind;
    row.values += kind == CellKind::text ? 0 : 1;
    row.numbers += kind == CellKind::number || kind == CellKind::moment ? 1 : 0;
  }
  return row;
}

Row row_of(std::string_view line, char separator, const TableOptions& options, std::vector<Cell>& cells) {
  return split_line(line, separator, cells) ? row_of(cells, options) : Row{};
}

bool is_data(const Row& row, std::size_t width) {
  return row.cells == width && row.numbers > 0 && 2 * row.values > row.cells;
}

/// Result for one separator: `width` is the probable number of columns, `cells` is the number of cells in the
/// rows of this width, and `values` is the number of these cells that have a value.
struct Fit {
  std::size_t values = 0;
  std::size_t cells = 0;
  std::size_t width = 0;

  /// Returns true if this separator fits better than the other separator. If both give equally many values,
  /// the separator that gives fewer other cells fits better.
  [[nodiscard]] bool is_better_than(const Fit& other) const {
    return values > other.values || (values == other.values && cells < other.cells);
  }
};
Fit fit_of(char separator, const std::vector<TextLine>& sample, const TableOptions& options) {
  std::map<std::size_t, Fit> by_width;
  std::vector<Cell> cells;
  for (const TextLine& line : sample) {
    const Row row = row_of(line.text, separator, options, cells);
    if (row.cells < 2 || !is_data(row, row.cells)) continue;
    Fit& fit = by_width[row.cells];
    fit.values += row.values;
    fit.cells += row.cells;
    fit.width = row.cells;
  }
  Fit best;
  for (const auto& [width, fit] : by_width) {
    if (fit.values > best.values) best = fit;
  }
  return best;
}

std::vector<TextLine> sample_of(const std::vector<TextLine>& content) {
  std::vector<TextLine> sample;
  const std::size_t middle = content.size() / 2;
  for (std::size_t i = middle; i < content.size() && i < middle + looked_at; ++i)
    sample.push_back(content[i]);
  const std::size_t tail = std::max(middle + looked_at, content.size() - std::min(content.size(), looked_at));
  for (std::size_t i = tail; i < content.size(); ++i) sample.push_back(content[i]);
  return sample;
}

std::vector<std::string> texts_of(const std::vector<Cell>& cells) {
  std::vector<std::string> texts;
  texts.reserve(cells.size());
  for (const Cell& cell : cells) texts.emplace_back(trimmed(cell_text(cell.text)));
  return texts;
}

/// Returns true if all texts are units, with or without brackets. A text in brackets always counts as a unit.
/// "-" or an empty text means that the column has no unit. At least one text must be a unit.
bool are_units(const std::vector<std::string>& texts) {
  bool any = false;
  for (const std::string& text : texts) {
    if (text.empty() || text == "-") continue;
    std::string_view bare = text;
    if (bare.size() > 2 && (bare.front() == '[' || bare.front() == '('))
      bare = bare.substr(1, bare.size() - 2);
    const bool known = is_raw_unit(bare) || unit_named(bare, Quantity::time) ||
                       unit_named(bare, Quantity::pressure) || unit_named(bare, Quantity::displacement) ||
                       unit_named(bare, Quantity::temperature);
    if (!known && bare.size() == text.size()) return false;
    any = true;
  }
  return any;
}

std::string unbracketed(const std::string& text) {
  const bool bracketed = text.size() > 2 && (text.front() == '[' || text.front() == '(');
  if (bracketed) return text.substr(1, text.size() - 2);
  return text == "-" ? std::string() : text;
}

/// Reads names and units above the first row of numbers.
class Heading {
 public:
  Heading(const std::string& file, const TextLines& lines, Dialect& dialect, document::Problems& problems)
      : file_(file), lines_(lines), dialect_(dialect), problems_(problems) {}

  bool read() {
    if (dialect_.first_row == 0) {
      from_comment();
      return true;
    }
    std::size_t above = dialect_.first_row - 1;
    std::vector<std::string> texts = split_names(lines_.content[above]);
    if (texts.size() == 1) {
      from_comment();
      return true;
    }
    if (above > 0 && texts.size() == dialect_.width && are_units(texts)) {
      const std::vector<std::string> names = split_names(lines_.content[above - 1]);
      if (names.size() == dialect_.width && !are_units(names)) {
        dialect_.units = texts;
        std::transform(texts.begin(), texts.end(), dialect_.units.begin(), unbracketed);
        texts = names;
        --above;
      }
    }
    if (texts.size() == dialect_.width + 1 && texts.back().empty()) texts.pop_back();
    if (texts.size() + 1 == dialect_.width && rows_end_empty()) {
      --dialect_.width;
      dialect_.extra_cell = true;
    }
    if (texts.size() != dialect_.width) return refuse(lines_.content[above], texts.size());
    dialect_.names = std::move(texts);
    dialect_.names_line = lines_.content[above].number;
    return true;
  }

 private:
  /// Returns true if all rows end with an empty cell.
  [[nodiscard]] bool rows_end_empty() const {
    std::vector<Cell> cells;
    for (std::size_t i = dialect_.first_row; i < lines_.content.size(); ++i) {
      split_line(lines_.content[i].text, dialect_.separator, cells);
      if (cells.size() == dialect_.width && !trimmed(cells.back().text).empty()) return false;
    }
    return true;
  }

  /// Splits the line of the column names. If blanks separate the columns and a name contains a blank, the
  /// names must be separated by two blanks or a tab.
  std::vector<std::string> split_names(const TextLine& line) const {
    std::vector<Cell> cells;
    split_line(line.text, dialect_.separator, cells);
    if (dialect_.separator != ' ' || cells.size() == dialect_.width) return texts_of(cells);
    std::vector<std::string> texts;
    std::string_view left = trimmed(line.text);
    while (!left.empty()) {
      const std::size_t gap = std::min(left.find("  "), left.find('\t'));
      texts.emplace_back(trimmed(left.substr(0, gap)));
      left = gap == std::string_view::npos ? std::string_view{} : trimmed(left.substr(gap));
    }
    return texts.size() == dialect_.width ? texts : texts_of(cells);
  }

  /// Reads the column names from a comment. For example, numpy.savetxt writes "# time, pressure".
  void from_comment() {
    const int first = lines_.content[dialect_.first_row].number;
    const TextLine* last = nullptr;
    for (const TextLine& comment : lines_.comments) {
      if (comment.number < first) last = &comment;
    }
    if (last == nullptr) return;
    std::vector<std::string> names = split_names(*last);
    const bool fits =
        names.size() == dialect_.width && std::none_of(names.begin(), names.end(), [](const auto& name) {
          return name.empty() || cell_value(name, {}).kind == CellKind::number;
        });
    if (!fits) return;
    dialect_.names = std::move(names);
    dialect_.names_line = last->number;
  }

  bool refuse(const TextLine& line, std::size_t names) {
    const bool commas = dialect_.width == 2 * names && dialect_.separator == ',';
    problems_.add(
        {file_,
         {line.number, 1},
         std::string(line.text.substr(0, 200)),
         std::to_string(names) + " column names above " + std::to_string(dialect_.width) +
             " columns of numbers",
         commas ? "decimal commas and commas between the columns cannot be distinguished: export the file "
                  "with ';' between the columns"
                : ""});
    return false;
  }

  const std::string& file_;
  const TextLines& lines_;
  Dialect& dialect_;
  document::Problems& problems_;
};

/// Returns the number of a cell; NaN if the cell is not a number.
double number_in(const Cell& cell, const TableOptions& options) {
  const CellValue value = cell_value(cell.text, options.missing);
  return value.kind == CellKind::number ? value.number : missing_value;
}

/// Returns true if the cells are the numbers 0, 1, 2, ..., with or without an empty cell before them.
bool are_indices(const std::vector<Cell>& cells) {
  const std::size_t first = !cells.empty() && trimmed(cells.front().text).empty() ? 1 : 0;
  for (std::size_t i = first; i < cells.size(); ++i) {
    if (cell_text(trimmed(cells[i].text)) != std::to_string(i - first)) return false;
  }
  return cells.size() > first + 1;
}

/// Returns true if the first row contains the indices of the columns instead of values. Such a row begins
/// with an empty cell, or more than half of the columns do not continue this row. A column does not continue
/// it if the first step is longer than twice the longest of the later steps, or if only the first step is 0.
bool has_indices_as_names(const std::vector<TextLine>& content, const Dialect& dialect,
                          const TableOptions& options) {
  std::vector<std::vector<double>> rows;
  std::vector<Cell> cells;
  for (std::size_t i = dialect.first_row; i < content.size() && rows.size() < looked_at; ++i) {
    split_line(content[i].text, dialect.separator, cells);
    if (rows.empty() && !are_indices(cells)) return false;
    if (cells.size() != dialect.width) continue;
    rows.emplace_back();
    for (const Cell& cell : cells) rows.back().push_back(number_in(cell, options));
  }
  if (rows.size() < 3) return false;
  if (std::isnan(rows[0][0])) return !std::isnan(rows[1][0]);
  std::size_t breaks = 0;
  for (std::size_t column = 0; column < dialect.width; ++column) {
    const auto step = [&](std::size_t i) { return std::abs(rows[i + 1][column] - rows[i][column]); };
    double longest = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
      longest = std::max(longest, step(i));
      shortest = std::min(shortest, step(i));
    }
    const bool continues = step(0) <= 2 * longest && (step(0) > 0 || shortest == 0);
    breaks += continues ? 0 : 1;
  }
  return 2 * breaks > dialect.width;
}

}  // namespace

TextLines text_lines(std::string_view text) {
  TextLines lines;
  int number = 0;
  int empty = 0;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    const std::string_view said = trimmed(line);
    const bool comment = said.starts_with('#') || said.starts_with('%') || said.starts_with("//");
    // A line that begins with "#N/A" is a row, because "#N/A" is a cell and not the beginning of a comment.
    const bool cell = said.starts_with("#N/A") || said.starts_with("#n/a");
    if (said.empty()) {
      ++empty;
    } else if (comment && !cell) {
      lines.comments.push_back({number, said.substr(std::min(said.find_first_not_of("#%/"), said.size()))});
    } else {
      lines.content.push_back({number, line, std::exchange(empty, 0)});
    }
  }
  return lines;
}

bool begins_other_table(const std::vector<Cell>& cells, const Dialect& dialect, const TableOptions& options) {
  std::set<std::string> texts;
  bool has_known_name = false;
  for (const Cell& cell : cells) {
    const CellKind kind = cell_value(cell.text, options.missing).kind;
    if (kind == CellKind::missing) continue;
    const std::string text(trimmed(cell_text(cell.text)));
    if (kind != CellKind::text || !texts.insert(text).second) return false;
    has_known_name = has_known_name || std::ranges::count(dialect.names, text) > 0;
  }
  const bool fills_row = cells.size() == dialect.width && texts.size() == cells.size();
  if (texts.size() < 2 || !(has_known_name || fills_row)) return false;
  std::vector<std::string> line = texts_of(cells);
  if (line == dialect.names) return false;
  std::transform(line.begin(), line.end(), line.begin(), unbracketed);
  return line != dialect.units;
}

bool reorders_names(const std::vector<Cell>& cells, const Dialect& dialect) {
  const std::vector<std::string> line = texts_of(cells);
  return line != dialect.names && std::ranges::is_permutation(line, dialect.names);
}

bool is_row(const std::vector<Cell>& cells, std::size_t width, const TableOptions& options) {
  return is_data(row_of(cells, options), width);
}

bool split_line(std::string_view line, char separator, std::vector<Cell>& cells) {
  if (separator != ' ') return split(line, cells, separator);
  cells.clear();
  std::size_t at = 0;
  const auto blank = [&](std::size_t i) { return line[i] == ' ' || line[i] == '\t'; };
  while (at < line.size()) {
    while (at < line.size() && blank(at)) ++at;
    const std::size_t begin = at;
    bool quoted = false;
    for (; at < line.size() && (quoted || !blank(at)); ++at) quoted = quoted != (line[at] == '"');
    if (at > begin) cells.push_back({line.substr(begin, at - begin), static_cast<int>(begin) + 1});
    if (quoted) return false;
  }
  return true;
}

std::optional<Dialect> dialect_of(const std::string& file, const TextLines& lines,
                                  const TableOptions& options, document::Problems& problems) {
  Dialect dialect;
  Fit best;
  const std::vector<TextLine> sample = sample_of(lines.content);
  for (const char separator : separators) {
    if (options.separator != 0 && separator != options.separator) continue;
    const Fit fit = fit_of(separator, sample, options);
    if (!fit.is_better_than(best)) continue;
    best = fit;
    dialect.separator = separator;
  }
  std::vector<Cell> cells;
  std::size_t first = 0;
  const std::size_t end = std::min(lines.content.size(), longest_preamble);
  while (first < end &&
         !(best.width > 0 &&
           is_data(row_of(lines.content[first].text, dialect.separator, options, cells), best.width)))
    ++first;
  if (first == end) {
    const TextLine at = lines.content.empty() ? TextLine{1, {}} : lines.content.front();
    problems.add({file,
                  {at.number, 1},
                  std::string(at.text.substr(0, 200)),
                  lines.content.empty() ? "the file is empty"
                                        : "the file contains no rows of numbers in two or more columns",
                  lines.content.empty() ? "" : "state the separator of the columns with --separator"});
    return std::nullopt;
  }
  dialect.width = best.width;
  dialect.first_row = first;
  if (!Heading(file, lines, dialect, problems).read()) return std::nullopt;
  if (dialect.names.empty() && has_indices_as_names(lines.content, dialect, options)) {
    const TextLine& indices = lines.content[first];
    problems.add({file,
                  {indices.number, 1},
                  std::string(indices.text.substr(0, 200)),
                  "this line has the numbers of the columns instead of their names",
                  "replace the numbers by names such as time_s, command_kpa and tip_mm. If the numbers are "
                  "values, add a line with the names above this line"});
    return std::nullopt;
  }
  return dialect;
}

}  // namespace softgrip::sysid
