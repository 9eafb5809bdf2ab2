#include "document/syntax.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace softgrip::document {
namespace {

std::string opened(const Node* open) {
  if (open == nullptr) return {};
  return " that starts at " + text_of(open->at);
}

/// Returns true if a space is missing after a colon in `line`, as in `rate_hz:200`.
bool has_glued_colon(std::string_view line) {
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] != ':' || std::isspace(static_cast<unsigned char>(line[i + 1])) != 0) continue;
    const auto before = static_cast<unsigned char>(line[i - 1]);
    if (std::isalnum(before) != 0 || before == '_') return true;
  }
  return false;
}

SyntaxMessage misplaced(const Document& document, const Node* open, Location at, std::string_view what) {
  const std::string_view line = line_of(document.text, at.line);
  SyntaxMessage result;
  result.message = "this line does not belong to the " + std::string(what) + opened(open);
  if (has_glued_colon(line)) {
    result.hint = "a space is missing after the colon";
  } else if (line.find(':') == std::string_view::npos && what == "map") {
    result.hint = "a colon is missing after the key, or the indentation is wrong";
  } else {
    result.hint = "keys and items of one level start in the same column";
  }
  return result;
}

/// Returns a message if the key at the location `at` does not start in the same column as the other keys of
/// its map; otherwise returns nothing.
std::optional<SyntaxMessage> misaligned(const Document& document, const Node* open, Location at) {
  if (open == nullptr || open->kind != Node::Kind::map || at.line <= open->at.line) return std::nullopt;
  const std::string_view first = line_of(document.text, open->at.line);
  const auto start = static_cast<std::size_t>(open->at.column) - 1;
  if (start >= first.size() || first[start] == '{') return std::nullopt;
  const std::size_t column = line_of(document.text, at.line).find_first_not_of(' ');
  if (column == std::string_view::npos || column == start) return std::nullopt;
  return SyntaxMessage{"this key starts in column " + std::to_string(column + 1) +
                           ", but the other keys of the same map start in column " +
                           std::to_string(open->at.column),
                       "keys of one level start in the same column"};
}

/// Returns the message for a closing bracket that has no opening bracket, or whose opening bracket is of the
/// other type.
SyntaxMessage wrong_end(const Document& document, Location at) {
  const std::vector<Bracket> open = open_brackets(document.text, at);
  if (open.empty()) return {"this closing bracket has no opening bracket", ""};
  const Bracket& bracket = open.back();
  const std::string opener(1, bracket.character);
  const std::string closer = bracket.character == '[' ? "]" : "}";
  return {"the `" + opener + "` at " + text_of(bracket.at) + " is not closed: expected `" + closer + "` here",
          "`" + closer + "` is missing where the " + (opener == "[" ? "list" : "map") + " ends"};
}

struct Translation {
  std::string_view said;
  std::string_view message;
  std::string_view hint;
};

constexpr std::array translations{
    Translation{"illegal map value", "the value contains a second `: `",
                "put the value in quotes if the colon belongs to the value, or start a new line"},
    Translation{"illegal map key", "a key is not permitted here", "write the key on a separate line"},
    Translation{"illegal block entry", "a list item `- ` is not permitted here",
                "write each item of a list on a separate line, below the key of the list"},
    Translation{"illegal EOF in scalar", "a quotation mark is opened but never closed", ""},
    Translation{"illegal document indicator in scalar",
                "a quotation mark is not closed before the document ends", ""},
    Translation{"unknown escape character", "a text in double quotes contains an unknown escape",
                "write a backslash as \\\\, or use single quotes"},
    Translation{"bad character found while scanning hex number",
                "an escape in a text in double quotes lacks its hexadecimal digits", ""},
    Translation{"invalid unicode", "an escape in a text in double quotes names no character", ""},
    Translation{"illegal tab when looking for indentation", "the indentation contains a tab",
                "YAML indents with spaces only"},
    Translation{"unknown token", "this character cannot start a value",
                "put the text in quotes if the character is a part of the text"},
    Translation{"the referenced anchor is not defined", "an alias (`*name`) is not accepted here",
                "write the value itself, or put a text that starts with `*` in quotes"},
    Translation{"alias not found after *", "an alias (`*name`) is not accepted here",
                "put a text that starts with `*` in quotes"},
    Translation{"illegal character found while scanning alias", "an alias (`*name`) is not accepted here",
                "put a text that starts with `*` in quotes"},
    Translation{"anchor not found after &", "an anchor (`&name`) is not accepted here",
                "put a text that starts with `&` in quotes"},
    Translation{"illegal character found while scanning anchor", "an anchor (`&name`) is not accepted here",
                "put a text that starts with `&` in quotes"},
    Translation{"cannot assign multiple anchors", "an anchor (`&name`) is not accepted here", "remove it"},
    Translation{"cannot assign multiple tags", "a tag (`!name`) is not accepted here", "remove it"},
    Translation{"illegal character found while scanning tag", "a tag (`!name`) is not accepted here",
                "put a text that starts with `!` in quotes"},
    Translation{"tag handle with no suffix", "a tag (`!name`) is not accepted here",
                "put a text that starts with `!` in quotes"},
    Translation{"end of verbatim tag not found", "a tag (`!name`) is not accepted here",
                "put a text that starts with `!` in quotes"},
    Translation{"bad file", "the document is nested too deeply", ""},
};

SyntaxMessage translated(const Document& document, std::string_view said, const Node* open, Location at) {
  if (said == "illegal flow end") return wrong_end(document, at);
  if (said == "end of map not found") return misplaced(document, open, at, "map");
  if (said == "end of sequence not found") return misplaced(document, open, at, "list");
  if (said == "end of map flow not found") {
    return {"the map `{...}`" + opened(open) + " is not closed here: expected `,` or `}`", ""};
  }
  if (said == "end of sequence flow not found") {
    return {"the list `[...]`" + opened(open) + " is not closed here: expected `,` or `]`", ""};
  }
  const bool glued_above = at.line > 1 && has_glued_colon(line_of(document.text, at.line - 1));
  if (said == "illegal map value" && glued_above) {
    return {"this is not a key: the line above has no `: ` and continues here",
            "a space is missing after the colon in line " + std::to_string(at.line - 1)};
  }
  if (said == "illegal map value") {
    if (auto message = misaligned(document, open, at)) return *message;
  }
  for (const Translation& translation : translations) {
    if (said.substr(0, translation.said.size()) == translation.said) {
      return {std::string(translation.message), std::string(translation.hint)};
    }
  }
  return {"this is not YAML: " + shown(said), ""};
}

/// The first location of one kind of problem, and the number of its occurrences.
struct Trouble {
  std::optional<Location> first;
  std::string what;
  std::size_t count = 0;

  void note(Location at, std::string_view text) {
    if (!first) {
      first = at;
      what = shown(text);
    }
    ++count;
  }
};

struct Troubles {
  Trouble not_utf8;
  Trouble control;
  Trouble tab;
};

std::string more(const Trouble& trouble, std::string_view things) {
  if (trouble.count < 2) return {};
  return " (and " + std::to_string(trouble.count - 1) + " more " + std::string(things) + ")";
}

void scan_line(std::string_view line, int number, Troubles& troubles) {
  const std::string_view whole = line;
  const auto at = [&] { return Location{number, static_cast<int>(whole.size() - line.size()) + 1}; };
  while (!line.empty()) {
    const std::size_t length = character_length(line);
    if (length == 0) {
      troubles.not_utf8.note(at(), line.substr(0, 1));
    } else if (line[0] != '\t' && is_control(line.substr(0, length))) {
      troubles.control.note(at(), line.substr(0, length));
    }
    line.remove_prefix(length == 0 ? 1 : length);
  }
  const std::size_t content = whole.find_first_not_of(" \t");
  if (content == std::string_view::npos) return;
  const std::size_t tab = whole.substr(0, content).find('\t');
  if (tab != std::string_view::npos) troubles.tab.note({number, static_cast<int>(tab) + 1}, "\t");
}

/// Calls `see(line, number)` for each line of the text, without its line break (\n or \r\n).
template <class See>
void for_each_line(std::string_view text, See&& see) {
  int number = 1;
  while (true) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (end != std::string_view::npos && !line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (!see(line, number)) return;
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
    ++number;
  }
}

/// Returns the location of a directive, such as `%YAML 1.2`; nothing if the text has no directive. A
/// directive can only precede the document.
std::optional<Location> find_directive(std::string_view text) {
  std::optional<Location> found;
  for_each_line(text, [&](std::string_view line, int number) {
    const std::size_t content = line.find_first_not_of(" \t");
    if (content == std::string_view::npos || line[content] == '#') return true;
    if (line[0] == '%') found = Location{number, 1};
    return false;
  });
  return found;
}

bool check_size(const Document& document, const Bounds& bounds, Problems& problems) {
  if (document.text.size() <= bounds.bytes) return true;
  Problem problem;
  problem.file = document.file;
  problem.message = "the file is larger than " + std::to_string(bounds.bytes) +
                    " bytes, the largest permitted size of a configuration file";
  problems.add(std::move(problem));
  return false;
}

/// Reads a text line by line and keeps the list of open brackets.
class Scan {
 public:
  void line(std::string_view text, int number) {
    const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
    const bool blank = indent == text.size();
    if (open_.empty() && quote_ == 0 && folded_ && (blank || indent > folded_indent_)) return;
    folded_ = false;
    begins_value_ = true;
    for (std::size_t i = indent; i < text.size(); ++i) {
      if (quote_ == 0 && text[i] == '#' && (i == 0 || text[i - 1] == ' ')) break;
      i += step(text, i, number);
    }
    const std::size_t last = text.find_last_not_of(" +-0123456789");
    if (open_.empty() && quote_ == 0 && !blank && last != std::string_view::npos && last > 1 &&
        (text[last] == '|' || text[last] == '>') && text[last - 1] == ' ') {
      folded_ = true;
      folded_indent_ = indent;
    }
  }

  [[nodiscard]] std::vector<Bracket> open() const { return open_; }

 private:
  /// Reads the character at index `i`. Returns the number of characters after this character that are read
  /// together with it: 1 for the backslash of `\"`.
  std::size_t step(std::string_view text, std::size_t i, int number) {
    const char c = text[i];
    if (quote_ != 0) {
      if (c == '\\' && quote_ == '"') return 1;
      if (c != quote_) return 0;
      if (c == '\'' && i + 1 < text.size() && text[i + 1] == c) return 1;
      quote_ = 0;
      return 0;
    }
    const bool value_begins = begins_value_;
    if (c == ' ') return 0;
    const bool before_blank = i + 1 == text.size() || text[i + 1] == ' ';
    begins_value_ = c == ',' || c == '[' || c == '{' || ((c == ':' || c == '-') && before_blank);
    if ((c == '"' || c == '\'') && value_begins) quote_ = c;
    if ((c == '[' || c == '{') && (value_begins || !open_.empty())) {
      open_.push_back({c, {number, static_cast<int>(i) + 1}});
    }
    const char opener = c == ']' ? '[' : c == '}' ? '{' : '\0';
    if (opener != '\0' && !open_.empty() && open_.back().character == opener) open_.pop_back();
    return 0;
  }

  std::vector<Bracket> open_;
  char quote_ = 0;
  bool begins_value_ = true;
  bool folded_ = false;  // true: the text is inside a `|` or `>` block; folded_indent_ is the indentation of
                         // the line that opened the block
  std::size_t folded_indent_ = 0;
};

}  // namespace

SyntaxMessage syntax_message(const Document& document, std::string_view said, const Node* open, Location at) {
  SyntaxMessage result = translated(document, said, open, at);
  // If a closing bracket is missing, the parser often reports a different error several lines below the
  // bracket.
  const std::vector<Bracket> brackets = open_brackets(document.text, at);
  if (!result.hint.empty() || brackets.empty()) return result;
  if (result.message.find(" is not closed") != std::string::npos) return result;
  result.hint = std::string("the `") + brackets.back().character + "` at " + text_of(brackets.back().at) +
                " is not closed before this position";
  return result;
}

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

bool check_text(const Document& document, const Bounds& bounds, Problems& problems) {
  if (!check_size(document, bounds, problems)) return false;
  const std::string_view text = document.text;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") {
    problems.add(document.problem({1, 1}, "the file starts with a byte order mark",
                                  "save the file as UTF-8 without a byte order mark"));
    return false;
  }
  Troubles troubles;
  for_each_line(text, [&](std::string_view line, int number) {
    scan_line(line, number, troubles);
    return true;
  });
  bool good = true;
  const auto refuse = [&](const Trouble& trouble, std::string message, std::string hint) {
    if (!trouble.first) return;
    good = false;
    problems.add(document.problem(*trouble.first, std::move(message), std::move(hint)));
  };
  const Trouble& bytes = troubles.not_utf8;
  refuse(bytes, "the byte " + bytes.what + " is not UTF-8" + more(bytes, "such bytes"),
         "save the file as UTF-8");
  const Trouble& control = troubles.control;
  refuse(control, "the text contains the control character " + control.what + more(control, "of them"),
         "remove this character; lines must end with a line feed");
  refuse(troubles.tab, "the indentation contains a tab" + more(troubles.tab, "lines"),
         "YAML indents with spaces only");
  if (const auto directive = find_directive(text)) {
    good = false;
    problems.add(document.problem(*directive, "a YAML directive is not accepted here", "remove this line"));
  }
  return good;
}

std::vector<Bracket> open_brackets(std::string_view text, Location place) {
  Scan scan;
  for (int number = 1; number <= place.line; ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (number == place.line) {
      line = line.substr(0, std::min(line.size(), static_cast<std::size_t>(std::max(place.column, 1)) - 1));
    }
    scan.line(line, number);
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return scan.open();
}

}  // namespace softgrip::document
