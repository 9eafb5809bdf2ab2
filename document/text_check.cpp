#include "document/text_check.h"

#include <optional>
#include <string_view>

#include "document/characters.h"

namespace softgrip::document {

namespace {

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

}  // namespace

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

}  // namespace softgrip::document
