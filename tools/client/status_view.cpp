#include "tools/client/status_view.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/numbers.h"
#include "document/problem.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

enum class Tone { plain, strong, good, doubtful, bad, faint };

const char* escape_of(Tone tone) {
  switch (tone) {
    case Tone::strong:
      return "\x1b[1m";
    case Tone::good:
      return "\x1b[32m";
    case Tone::doubtful:
      return "\x1b[33m";
    case Tone::bad:
      return "\x1b[1;31m";
    case Tone::faint:
      return "\x1b[2m";
    case Tone::plain:
      break;
  }
  return "";
}

/// A line that knows how wide it is, whatever escapes and multi-byte characters it holds.
class Line {
 public:
  explicit Line(const ViewStyle& style) : style_(style) {}

  /// Adds ASCII text, cut where the line ends.
  Line& add(std::string_view text, Tone tone = Tone::plain) {
    const std::string_view visible = text.substr(0, left());
    if (visible.empty()) return *this;
    columns_ += visible.size();
    const char* escape = style_.colour ? escape_of(tone) : "";
    text_ += escape;
    text_ += visible;
    if (*escape != '\0') text_ += "\x1b[0m";
    return *this;
  }
  /// Adds one character that is one column wide.
  void add_glyph(std::string_view glyph) {
    if (left() == 0) return;
    text_ += glyph;
    ++columns_;
  }
  Line& to_column(std::size_t column) {
    if (columns_ < column) add(std::string(column - columns_, ' '));
    return *this;
  }
  [[nodiscard]] std::size_t left() const { return style_.columns - std::min(columns_, style_.columns); }
  [[nodiscard]] const ViewStyle& style() const { return style_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  const ViewStyle& style_;
  std::string text_;
  std::size_t columns_ = 0;
};

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? document::shown(found->get<std::string>(), 200) : "-";
}

std::optional<double> number_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string with_decimals(std::optional<double> value, int decimals) {
  return value ? fixed(*value, decimals) : "-";
}

/// An object at `key`, or an empty one.
const Json& object_at(const Json& json, const char* key) {
  static const Json empty = Json::object();
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : empty;
}

Tone tone_of_state(const std::string& state) {
  if (state == "running") return Tone::good;
  if (state == "faulted") return Tone::bad;
  if (state == "idle") return Tone::plain;
  return Tone::doubtful;
}

Tone tone_of_result(const std::string& result) {
  if (result == "HOLDING" || result == "RELEASED") return Tone::good;
  if (result == "-") return Tone::faint;
  return Tone::bad;
}

/// What a bar shows, on one scale.
struct Bar {
  double lower = 0;
  double upper = 1;
  std::optional<double> value;
  std::optional<double> mark;
};

/// Where a value lies on a bar of `cells` cells, in eighths of a cell.
std::optional<std::size_t> eighths(const Bar& bar, std::optional<double> value, std::size_t cells) {
  if (!value || !(bar.upper > bar.lower)) return std::nullopt;
  const double share = std::clamp((*value - bar.lower) / (bar.upper - bar.lower), 0.0, 1.0);
  return static_cast<std::size_t>(std::lround(share * static_cast<double>(8 * cells)));
}

void add_bar(Line& line, const Bar& bar, std::size_t cells) {
  constexpr const char* partial[] = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉", "█"};
  const std::size_t filled = eighths(bar, bar.value, cells).value_or(0);
  const auto mark = eighths(bar, bar.mark, cells);
  line.add("[", Tone::faint);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const bool marked = mark && std::min(*mark / 8, cells - 1) == cell;
    const std::size_t part = std::min<std::size_t>(filled - std::min(filled, 8 * cell), 8);
    if (line.style().unicode) {
      line.add_glyph(marked ? "│" : partial[part]);
    } else {
      line.add_glyph(marked ? "|" : part >= 4 ? "#" : " ");
    }
  }
  line.add("]", Tone::faint);
}

constexpr std::size_t label_columns = 16;
constexpr std::size_t numbers_columns = 46;
constexpr std::size_t shortest_bar = 10;

/// "  pressure       [######|   ]  32.10 kPa  command 32.40"
std::string bar_line(const ViewStyle& style, std::string_view label, const Bar& bar,
                     const std::string& numbers) {
  Line line(style);
  line.add("  ").add(label).to_column(label_columns);
  const std::size_t cells =
      std::max(shortest_bar, style.columns - std::min(style.columns, label_columns + numbers_columns));
  add_bar(line, bar, cells);
  line.add("  ").add(numbers);
  return line.text();
}

/// What has kept the pressure below what is wanted for longer than a moment.
void add_limit(std::vector<std::string>& lines, const Json& channel, const ViewStyle& style) {
  const std::string limit = text_at(channel, "limit");
  if (limit == "-") return;
  const char* key = limit == "rig_pressure"    ? "pressure_max_kpa of the rig"
                    : limit == "step_pressure" ? "pressure_max_kpa of the step"
                                               : "squeeze_max_kpa of the step";
  Line line(style);
  line.to_column(label_columns).add(std::string(key) + " keeps the pressure down", Tone::doubtful);
  lines.push_back(line.text());
}

void add_channel(std::vector<std::string>& lines, const Json& channel, const ViewStyle& style) {
  const std::string result = text_at(channel, "result");
  const std::string validity = text_at(channel, "validity");
  const std::string health = text_at(channel, "health");
  Line head(style);
  head.add(text_at(channel, "name"), Tone::strong).to_column(label_columns);
  head.add(result, tone_of_result(result));
  if (const std::string evidence = text_at(channel, "evidence"); evidence != "none" && evidence != "-") {
    head.add(" by " + evidence);
  }
  head.add("   reading ").add(validity, validity == "valid" ? Tone::plain : Tone::bad);
  if (const auto age = number_at(channel, "age_s")) head.add(", " + fixed(1000 * *age, 1) + " ms old");
  head.add("   model ").add(health, health == "unfit" ? Tone::bad : Tone::plain);
  if (channel.value("saturated", false)) head.add("   saturated", Tone::doubtful);
  if (channel.value("slewing", false)) head.add("   slewing", Tone::doubtful);
  lines.push_back(head.text());

  const Json& limits = object_at(channel, "limits");
  const auto pressure = number_at(channel, "pressure_kpa");
  const auto command = number_at(channel, "command_kpa");
  const Bar pressures{number_at(limits, "pressure_min_kpa").value_or(0),
                      number_at(limits, "pressure_max_kpa").value_or(100), pressure ? pressure : command,
                      command};
  std::string pressure_numbers = with_decimals(pressure, 2) + " kPa, command " + with_decimals(command, 2);
  if (const auto squeeze = number_at(channel, "squeeze_kpa"))
    pressure_numbers += ", squeeze " + fixed(*squeeze, 1);
  lines.push_back(bar_line(style, "pressure", pressures, pressure_numbers));
  add_limit(lines, channel, style);
  const auto displacement = number_at(channel, "displacement_mm");
  const auto reference = number_at(channel, "reference_mm");
  const Bar displacements{number_at(limits, "displacement_min_mm").value_or(0),
                          number_at(limits, "displacement_max_mm").value_or(50), displacement, reference};
  std::string numbers = with_decimals(displacement, 2) + " mm, reference " + with_decimals(reference, 2);
  if (displacement && reference) numbers += ", error " + fixed(*reference - *displacement, 2);
  lines.push_back(bar_line(style, "displacement", displacements, numbers));
}

std::string head_line(const Json& status, const ViewStyle& style) {
  const std::string state = text_at(status, "state");
  Line line(style);
  line.add("softgrip ", Tone::faint).add(text_at(status, "rig"), Tone::strong).add("  ");
  line.add(state, tone_of_state(state));
  if (!object_at(status, "under_pressure").empty()) line.add(", UNDER PRESSURE", Tone::bad);
  const Json& sequence = object_at(status, "sequence");
  if (!sequence.empty()) {
    line.add("  " + text_at(sequence, "name"));
    if (sequence.contains("ended") && sequence["ended"].is_string()) {
      line.add(": " + text_at(sequence, "ended"));
    } else {
      line.add(": step " + std::to_string(sequence.value("step", 0) + 1) + "/" +
               std::to_string(sequence.value("steps", 0)) + " " + text_at(sequence, "step_name"));
    }
  }
  line.add("  " + with_decimals(number_at(status, "time_s"), 1) + " s", Tone::faint);
  return line.text();
}

void add_fault(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const Json& fault = object_at(status, "fault");
  if (fault.empty()) return;
  lines.push_back(Line(style)
                      .add("fault " + text_at(fault, "code") + " ", Tone::bad)
                      .add(text_at(fault, "name") + ": " + text_at(fault, "meaning"))
                      .text());
  lines.push_back(Line(style).add("  usually: " + text_at(fault, "cause")).text());
  lines.push_back(Line(style).add("  do: " + text_at(fault, "remedy")).text());
}

/// Loud, with the command that ends it; as many lines as it takes.
void add_pressure(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  std::string text = text_at(object_at(status, "under_pressure"), "text");
  if (text == "-") return;
  while (!text.empty()) {
    std::size_t length = text.size();
    if (length > style.columns) {
      const std::size_t space = text.rfind(' ', style.columns);
      length = space == std::string::npos || space == 0 ? style.columns : space;
    }
    lines.push_back(Line(style).add(text.substr(0, length), Tone::bad).text());
    text.erase(0, length);
    if (text.starts_with(' ')) text.erase(0, 1);
  }
}

void add_machinery(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const Json& bus = object_at(status, "bus");
  const bool connected = bus.value("connected", false);
  Line board(style);
  board.add("board").to_column(label_columns).add(text_at(bus, "board") + "  ");
  board.add(connected ? "connected" : "NOT CONNECTED", connected ? Tone::good : Tone::bad);
  lines.push_back(board.text());

  const Json& loop = object_at(status, "loop");
  const auto slips = number_at(loop, "slips");
  Line timing(style);
  timing.add("loop").to_column(label_columns);
  timing.add(with_decimals(number_at(status, "rate_hz"), 0) + " Hz, " +
             with_decimals(number_at(loop, "ticks"), 0) + " ticks, ");
  timing.add(with_decimals(slips, 0) + " slips", slips.value_or(0) > 0 ? Tone::doubtful : Tone::plain);
  timing.add(", wake-up p99 " + with_decimals(number_at(loop, "wake_up_p99_us"), 0) + " us, max " +
             with_decimals(number_at(loop, "wake_up_max_us"), 0) + " us");
  if (object_at(status, "real_time").value("degraded", false))
    timing.add("  real time degraded", Tone::doubtful);
  lines.push_back(timing.text());

  const Json& recording = object_at(status, "recording");
  Line rows(style);
  rows.add("recording").to_column(label_columns);
  rows.add(recording.value("active", false) ? "on   " : "off  ").add(text_at(recording, "folder"));
  if (const std::string error = text_at(recording, "error"); error != "-") rows.add("  " + error, Tone::bad);
  lines.push_back(rows.text());
}

}  // namespace

std::vector<std::string> view_of(const Json& status, const ViewStyle& style) {
  std::vector<std::string> lines{head_line(status, style)};
  add_pressure(lines, status, style);
  add_fault(lines, status, style);
  const auto channels = status.find("channels");
  if (channels != status.end() && channels->is_array()) {
    for (const Json& channel : *channels) {
      lines.emplace_back();
      add_channel(lines, channel, style);
    }
  }
  lines.emplace_back();
  add_machinery(lines, status, style);
  return lines;
}

std::string line_of_status(const Json& status) {
  std::string line = with_decimals(number_at(status, "time_s"), 2) + " s  " + text_at(status, "state");
  if (!object_at(status, "under_pressure").empty()) line += ", UNDER PRESSURE";
  if (const Json& fault = object_at(status, "fault"); !fault.empty()) line += " " + text_at(fault, "code");
  const auto channels = status.find("channels");
  if (channels == status.end() || !channels->is_array()) return line;
  for (const Json& channel : *channels) {
    line += "  " + text_at(channel, "name") + " " + with_decimals(number_at(channel, "command_kpa"), 2) +
            " kPa " + with_decimals(number_at(channel, "displacement_mm"), 2) + " mm";
    if (const auto reference = number_at(channel, "reference_mm")) line += " of " + fixed(*reference, 2);
    line += " " + text_at(channel, "result");
  }
  return line;
}

}  // namespace softgrip::tools
