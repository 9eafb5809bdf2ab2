#include "document/syntax.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "document/brackets.h"

namespace softgrip::document {

namespace {

std::string opened(const Node* open) {
  if (open == nullptr) return {};
  return " that starts at " + std::to_string(open->at.line) + ":" + std::to_string(open->at.column);
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

std::string place(Location at) {
  return std::to_string(at.line) + ":" + std::to_string(at.column);
}

/// Returns the message for a closing bracket that has no opening bracket, or whose opening bracket is of the
/// other type.
SyntaxMessage wrong_end(const Document& document, Location at) {
  const std::vector<Bracket> open = open_brackets(document.text, at);
  if (open.empty()) return {"this closing bracket has no opening bracket", ""};
  const Bracket& bracket = open.back();
  const std::string opener(1, bracket.character);
  const std::string closer = bracket.character == '[' ? "]" : "}";
  return {"the `" + opener + "` at " + place(bracket.at) + " is not closed: expected `" + closer + "` here",
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

}  // namespace

SyntaxMessage syntax_message(const Document& document, std::string_view said, const Node* open, Location at) {
  SyntaxMessage result = translated(document, said, open, at);
  // If a closing bracket is missing, the parser often reports a different error several lines below the
  // bracket.
  const std::vector<Bracket> brackets = open_brackets(document.text, at);
  if (!result.hint.empty() || brackets.empty()) return result;
  if (result.message.find(" is not closed") != std::string::npos) return result;
  result.hint = std::string("the `") + brackets.back().character + "` at " + place(brackets.back().at) +
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

}  // namespace softgrip::document
