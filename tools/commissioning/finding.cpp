#include "tools/commissioning/finding.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/enum_table.h"

namespace softgrip::tools::doctor {
namespace {

constexpr std::size_t mark_width = 6;
constexpr std::size_t narrowest = 40;

std::string mark(Verdict verdict, bool colour) {
  constexpr std::string_view reset = "\033[0m";
  switch (verdict) {
    case Verdict::ok:
      return colour ? fmt::format("\033[32m{}{}", " ok   ", reset) : " ok   ";
    case Verdict::not_judged:
      return colour ? fmt::format("\033[2m{}{}", " --   ", reset) : " --   ";
    case Verdict::warn:
      return colour ? fmt::format("\033[33m{}{}", " warn ", reset) : " warn ";
    case Verdict::fail:
      return colour ? fmt::format("\033[1;31m{}{}", " FAIL ", reset) : " FAIL ";
  }
  return "?";
}

/// Wraps `text` at spaces into lines of at most `width` characters. Indents all lines except the first by
/// `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t at = 0;
  while (text.size() - at > width) {
    std::size_t end = text.rfind(' ', at + width);
    if (end == std::string::npos || end <= at) end = at + width;
    result += text.substr(at, end - at) + "\n" + std::string(indent, ' ');
    at = end + (end < text.size() && text[end] == ' ' ? 1 : 0);
  }
  return result + text.substr(at);
}

std::string verdict_line(const Examination& examination, const Findings& findings) {
  const std::size_t fails = findings.count(Verdict::fail);
  const std::size_t warnings = findings.count(Verdict::warn);
  const std::size_t open = findings.count(Verdict::not_judged);
  std::string line;
  if (fails > 0) {
    line = fmt::format("NOT FIT: {}{}", counted(fails, "failure"),
                       warnings > 0 ? " and " + counted(warnings, "warning") : "");
  } else {
    line = warnings > 0 ? fmt::format("fit to run, with {}", counted(warnings, "warning")) : "fit to run";
  }
  if (open > 0) line += fmt::format("; {} not judged", open);
  if (examination.simulated) line += ". SIMULATED: no board, valve, finger or sensor was examined";
  return line + "\n";
}

}  // namespace

std::string_view name_of(Verdict verdict) noexcept {
  static constexpr auto names = enum_names<Verdict>({{Verdict::ok, "ok"},
                                                     {Verdict::not_judged, "not_judged"},
                                                     {Verdict::warn, "warn"},
                                                     {Verdict::fail, "fail"}});
  return names[verdict];
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::size_t Findings::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      list_.begin(), list_.end(), [verdict](const Finding& finding) { return finding.verdict == verdict; }));
}

Verdict Findings::worst() const {
  Verdict worst = Verdict::ok;
  for (const Finding& finding : list_) worst = std::max(worst, finding.verdict);
  return worst;
}

std::string text_of(const Examination& examination, const Findings& findings, std::size_t columns,
                    bool colour) {
  std::size_t name_width = 0;
  for (const Finding& finding : findings.list()) name_width = std::max(name_width, finding.name.size());
  const std::size_t indent = mark_width + name_width + 2;
  const std::size_t width = std::max(columns > indent ? columns - indent : 0, narrowest);
  std::string text = fmt::format("rig {} ({}){}: {}\n", examination.rig, examination.rig_file,
                                 examination.simulated ? ", SIMULATED" : "",
                                 examination.daemon_runs ? "status from the running softgripd"
                                 : examination.moved     ? "softgripd not running; checked with motion"
                                                         : "softgripd not running; checked without motion");
  for (const Finding& finding : findings.list()) {
    text += fmt::format("{}{:{}}  {}\n", mark(finding.verdict, colour), finding.name, name_width,
                        wrapped(finding.text, indent, width));
    if (finding.advice.empty()) continue;
    text += fmt::format("{}{}\n", std::string(indent, ' '),
                        wrapped("-> " + finding.advice, indent + 3, width - 3));
  }
  return text + verdict_line(examination, findings);
}

result::Fields fields_of(const Examination& examination, const Findings& findings) {
  const auto of_finding = [](const Finding& finding) -> result::Fields {
    return {{"name", finding.name},
            {"verdict", name_of(finding.verdict)},
            {"text", finding.text},
            {"advice", finding.advice}};
  };
  return {{"rig", examination.rig},
          {"rig_file", examination.rig_file},
          {"daemon_runs", examination.daemon_runs},
          {"moved", examination.moved},
          {"simulated", examination.simulated},
          {"verdict", name_of(findings.worst())},
          {"findings", result::list_of(findings.list(), of_finding)}};
}

}  // namespace softgrip::tools::doctor
