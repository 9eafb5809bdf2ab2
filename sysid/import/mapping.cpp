#include "sysid/import/mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "base/text.h"
#include "document/node.h"
#include "document/reader.h"

namespace softgrip::sysid {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> separator_words{
    {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"space", ' '}, {"bar", '|'}}};

constexpr double longest_s = 1e9;
constexpr std::size_t most_mapping_bytes = std::size_t{64} * 1024;
/// Largest size of the comments with the messages of the import [bytes].
constexpr std::size_t most_comment_bytes = most_mapping_bytes / 2;

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\t') {
      out += "\\t";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out + '"';
}

std::string list_of(const std::vector<std::string>& words) {
  return "[" + with_commas(words, in_quotes) + "]";
}

std::string column_yaml(const ColumnMapping& column) {
  std::string text = "{columns: " + list_of(column.columns);
  if (!column.unit.empty()) text += ", unit: " + in_quotes(column.unit);
  if (column.scale) text += ", scale: " + shortest(*column.scale);
  if (column.zero) text += ", zero: " + shortest(*column.zero);
  if (column.zero_first) text += ", zero: first";
  return text + "}";
}

/// Returns one line for each column that has codes for missing values.
std::string codes_yaml(const std::vector<ColumnCode>& codes) {
  std::string text = codes.empty() ? "" : "missing_in:\n";
  for (auto code = codes.begin(); code != codes.end(); ++code) {
    const auto same_column = [&](const ColumnCode& other) { return other.column == code->column; };
    if (std::find_if(codes.begin(), code, same_column) != code) continue;
    std::vector<double> values;
    for (const ColumnCode& other : codes) {
      if (same_column(other)) values.push_back(other.value);
    }
    text += "  - {column: " + in_quotes(code->column) + ", values: [" +
            with_commas(values, [](double value) { return shortest(value); }) + "]}\n";
  }
  return text;
}

/// Returns `text` as a YAML comment on one line; line breaks are replaced.
std::string comment(std::string_view text) {
  return "# " + document::shown(text, 400) + "\n";
}

/// Returns the remarks as comments. Remarks that would exceed `most_comment_bytes` are counted instead.
std::string comments(const std::vector<std::string>& remarks) {
  std::string text;
  for (std::size_t i = 0; i < remarks.size(); ++i) {
    const std::string line = comment(remarks[i]);
    if (text.size() + line.size() > most_comment_bytes)
      return text + comment("messages that are not in this file: " + std::to_string(remarks.size() - i));
    text += line;
  }
  return text;
}

class MappingReader {
 public:
  MappingReader(const document::Document& document, document::Problems& problems)
      : document_(document), problems_(problems) {}

  Mapping read() {
    document::MapReader map(document_, document_.root, problems_, "the mapping");
    Mapping mapping;
    (void)map.integer("schema", {1, 1});
    for (const RoleSpec& spec : roles) {
      if (const document::Node* node = map.child(spec.word, false)) column(*node, spec, mapping[spec.role]);
    }
    mapping.skip_bad_lines = map.optional_boolean("skip_bad_lines").value_or(false);
    mapping.rate_hz = map.optional_number("rate_hz", {1e-3, 1e7});
    mapping.from_s = map.optional_number("from_s", {0, longest_s}).value_or(0);
    mapping.to_s = map.optional_number("to_s", {0, longest_s}).value_or(mapping.to_s);
    mapping.channel = map.optional_text("channel").value_or("");
    mapping.sheet = map.optional_text("sheet").value_or("");
    if (const auto word = map.optional_text("separator")) {
      mapping.separator = separator_named(*word);
      if (mapping.separator == 0)
        map.report("separator", document::in_backticks(*word) + " separates no columns",
                   "write comma, semicolon, tab, space or bar");
    }
    for (const document::Node* item : map.sequence("missing", false)) mapping.missing.push_back(item->scalar);
    for (const document::Node* item : map.sequence("missing_in", false)) codes(*item, mapping.missing_in);
    map.finish();
    if (problems_.empty() && !mapping.complete())
      problems_.add(document_.problem({1, 1}, "the mapping is incomplete",
                                      "required: time (or rate_hz), displacement, and command or pressure"));
    return mapping;
  }

 private:
  void codes(const document::Node& node, std::vector<ColumnCode>& codes) {
    document::MapReader map(document_, node, problems_, "missing_in");
    const std::string column = map.text("column");
    constexpr double largest = std::numeric_limits<double>::max();
    for (const document::Node* item : map.sequence("values", true))
      codes.push_back(
          {column,
           document::number_in(document_, *item, {-largest, largest}, problems_, "values").value_or(0)});
    map.finish();
  }

  void column(const document::Node& node, const RoleSpec& spec, ColumnMapping& column) {
    document::MapReader map(document_, node, problems_, std::string(spec.word));
    for (const document::Node* item : map.sequence("columns", true)) {
      if (item->kind == document::Node::Kind::scalar && !item->scalar.empty()) {
        column.columns.push_back(item->scalar);
      } else {
        problems_.add(
            document_.problem(item->at, "give the name of the column, or its number counted from 1"));
      }
    }
    if (map.good("columns") && column.columns.empty()) map.report("columns", "the list of columns is empty");
    column.unit = map.optional_text("unit").value_or("");
    column.scale = map.optional_number("scale", {-1e12, 1e12});
    if (map.good("scale") && column.scale == 0.0) map.report("scale", "a scale must not be 0");
    const document::Node* zero = map.child("zero", false);
    if (zero != nullptr && zero->scalar == "first") {
      column.zero_first = true;
    } else if (zero != nullptr) {
      column.zero = document::number_in(document_, *zero, {-1e18, 1e18}, problems_, "zero");
    }
    map.finish();
  }

  const document::Document& document_;
  document::Problems& problems_;
};

}  // namespace

bool Mapping::complete() const {
  const Mapping& here = *this;
  return (here[Role::time].given() || rate_hz) && here[Role::displacement].given() &&
         (here[Role::command].given() || here[Role::pressure].given());
}

std::string options_of(const Mapping& mapping) {
  std::string text;
  const auto say = [&](std::string_view option, std::string_view value) {
    text += (text.empty() ? "--" : " --") + std::string(option) + " " + shell_word(value);
  };
  for (const RoleSpec& spec : roles) {
    const ColumnMapping& column = mapping[spec.role];
    for (const std::string& name : column.columns) say(spec.word, name);
  }
  for (const RoleSpec& spec : roles) {
    const ColumnMapping& column = mapping[spec.role];
    const std::string word = std::string(spec.word) + "=";
    if (!column.unit.empty()) say("unit", word + column.unit);
    if (column.scale) say("scale", word + shortest(*column.scale));
    if (column.zero) say("zero", word + shortest(*column.zero));
    if (column.zero_first) say("zero", word + "first");
  }
  if (mapping.rate_hz) say("rate-hz", shortest(*mapping.rate_hz));
  if (mapping.separator != 0) say("separator", word_of_separator(mapping.separator));
  for (const std::string& word : mapping.missing) say("missing", word);
  for (const ColumnCode& code : mapping.missing_in)
    say("missing-in", code.column + "=" + shortest(code.value));
  if (!mapping.channel.empty()) say("channel", mapping.channel);
  if (!mapping.sheet.empty()) say("sheet", mapping.sheet);
  if (mapping.skip_bad_lines) text += text.empty() ? "--skip-bad-lines" : " --skip-bad-lines";
  if (mapping.from_s > 0) say("from-s", shortest(mapping.from_s));
  if (std::isfinite(mapping.to_s)) say("to-s", shortest(mapping.to_s));
  return text;
}

char separator_named(std::string_view word) {
  for (const auto& [name, character] : separator_words) {
    if (word == name || word == std::string_view(&character, 1)) return character;
  }
  return 0;
}

std::string_view word_of_separator(char separator) {
  for (const auto& [name, character] : separator_words) {
    if (separator == character) return name;
  }
  return {};
}

std::string mapping_yaml(const Mapping& mapping, const ImportSource& source, const std::string& software,
                         const std::vector<std::string>& remarks) {
  std::string text =
      "# Columns and units of an import. To repeat the import: softgrip import FILE --map THIS --out LOG\n";
  text += comment("file: " + source.file + " (" + source.format + ")");
  text += comment("sha256: " + source.sha256);
  text += comment("by " + software);
  text += comments(remarks);
  text += "schema: 1\n";
  for (const RoleSpec& spec : roles) {
    if (mapping[spec.role].given())
      text += std::string(spec.word) + ": " + column_yaml(mapping[spec.role]) + "\n";
  }
  if (mapping.rate_hz) text += "rate_hz: " + shortest(*mapping.rate_hz) + "\n";
  if (mapping.separator != 0)
    text += "separator: " + std::string(word_of_separator(mapping.separator)) + "\n";
  if (!mapping.missing.empty()) text += "missing: " + list_of(mapping.missing) + "\n";
  text += codes_yaml(mapping.missing_in);
  if (!mapping.channel.empty()) text += "channel: " + in_quotes(mapping.channel) + "\n";
  if (!mapping.sheet.empty()) text += "sheet: " + in_quotes(mapping.sheet) + "\n";
  if (mapping.skip_bad_lines) text += "skip_bad_lines: true\n";
  if (mapping.from_s > 0) text += "from_s: " + shortest(mapping.from_s) + "\n";
  if (std::isfinite(mapping.to_s)) text += "to_s: " + shortest(mapping.to_s) + "\n";
  return text;
}

std::optional<Mapping> parse_mapping(const std::string& file, const std::string& text,
                                     document::Problems& problems) {
  const std::size_t before = problems.size();
  const document::Document document = document::parse(file, text, problems);
  if (problems.size() != before) return std::nullopt;
  Mapping mapping = MappingReader(document, problems).read();
  if (problems.size() != before) return std::nullopt;
  return mapping;
}

std::optional<Mapping> read_mapping(const std::string& path, document::Problems& problems) {
  const auto text = read_file(path, most_mapping_bytes);
  if (text) return parse_mapping(path, *text, problems);
  problems.add({path, {1, 1}, {}, text.error(), {}});
  return std::nullopt;
}

}  // namespace softgrip::sysid
