#include "tools/client/daemon_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string with_decimals(std::optional<double> value, int decimals) {
  return value ? fixed(*value, decimals) : "-";
}

Tone tone_of_state(const std::string& state) {
  if (state == "running") return Tone::good;
  if (state == "faulted") return Tone::bad;
  if (state == "idle") return Tone::plain;
  return Tone::warning;
}

Tone tone_of_result(const std::string& result) {
  if (result == "HOLDING" || result == "RELEASED") return Tone::good;
  if (result == "-") return Tone::faint;
  return Tone::bad;
}

/// The value of a bar, the value of the mark on this bar, and the range of their common scale.
struct Bar {
  double lower = 0;
  double upper = 1;
  std::optional<double> value;
  std::optional<double> mark;
};

/// Returns the position of a value on a bar of `cells` characters, in eighths of a character.
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
constexpr std::size_t min_bar_cells = 10;
/// Column in which a trend begins, to the right of the numbers. If the screen has fewer than
/// min_trend_columns columns, the trend is not placed there.
constexpr std::size_t trend_column = 56;
constexpr std::size_t min_trend_columns = 72;

/// Adds "  pressure       [######|   ]  32.10 kPa, command 32.40". If the line is too long, the numbers are
/// on a second line.
void add_bar_lines(std::vector<std::string>& lines, const ViewStyle& style, std::string_view label,
                   const Bar& bar, const std::string& numbers) {
  Line line(style);
  line.add("  ").add(label).to_column(label_columns);
  const std::size_t wide = style.columns - std::min(style.columns, label_columns + numbers_columns);
  const bool fits = label_columns + std::max(min_bar_cells, wide) + 4 + numbers.size() <= style.columns;
  const std::size_t alone = style.columns - std::min(style.columns, label_columns + 2);
  add_bar(line, bar, fits ? std::max(min_bar_cells, wide) : std::max(min_bar_cells, alone));
  if (fits) line.add("  ").add(numbers);
  lines.push_back(line.text());
  if (!fits) lines.push_back(Line(style).to_column(label_columns).add(numbers).text());
}

void add_glyphs(Line& line, const Trend& trend, std::size_t cells, double min_span) {
  for (const std::string& glyph : trend.glyphs(cells, min_span, line.style().unicode)) line.add_glyph(glyph);
}

/// Adds "  pressure      32.10 kPa, command 32.40         ▁▂▃▅▇". The trend is omitted if the screen is too
/// narrow.
void add_trend_line(std::vector<std::string>& lines, const ViewStyle& style, std::string_view label,
                    const std::string& numbers, const Trend& trend, double min_span) {
  Line line(style);
  line.add("  ").add(label).to_column(label_columns).add(numbers);
  if (style.columns >= min_trend_columns) {
    line.add(" ").to_column(trend_column);
    add_glyphs(line, trend, style.columns - std::min(style.columns, line.columns()), min_span);
  }
  lines.push_back(line.text());
}

/// Adds "                ▁▂▃▅▇ kPa  ▁▂▃▅▇ mm" for a narrow screen: a line with both trends below the numbers.
void add_trends_below(std::vector<std::string>& lines, const ViewStyle& style, const ChannelTrends& trends,
                      double least_kpa, double least_mm) {
  constexpr std::size_t units_columns = 9;
  const std::size_t cells = (style.columns - std::min(style.columns, label_columns + units_columns)) / 2;
  Line line(style);
  line.to_column(label_columns);
  add_glyphs(line, trends.pressure_kpa, cells, least_kpa);
  line.add(" kPa  ");
  add_glyphs(line, trends.displacement_mm, cells, least_mm);
  line.add(" mm");
  lines.push_back(line.text());
}

/// If the status reports a limit that restricts the pressure of the channel, adds a line with the name of
/// this limit.
void add_limit(std::vector<std::string>& lines, const Json& channel, const ViewStyle& style) {
  const std::string words = text_at(channel, "limit_text");
  if (words == "-") return;
  const std::string text = std::string(label_columns, ' ') + words;
  for (const std::string& line : wrap_text(style, text, Tone::warning, label_columns)) lines.push_back(line);
}

void add_channel_head(std::vector<std::string>& lines, const Json& channel, const ViewStyle& style) {
  const std::string result = text_at(channel, "result");
  const std::string validity = text_at(channel, "validity");
  const std::string health = text_at(channel, "health");
  std::string name = text_at(channel, "name");
  if (name.size() < label_columns) name.resize(label_columns, ' ');
  std::string by = text_at(channel, "evidence");
  by = by == "none" || by == "-" ? "" : " by " + by;
  std::string reading = validity;
  if (const auto age = number_at(channel, "age_s")) reading += ", " + fixed(1000 * *age, 0) + " ms old";
  std::vector<Span> spans{{name, Tone::strong},
                          {result, tone_of_result(result)},
                          {by, Tone::plain},
                          {"  reading " + reading, validity == "valid" ? Tone::plain : Tone::bad},
                          {"  model " + health, health == "unfit" ? Tone::bad : Tone::plain}};
  if (channel.value("saturated", false)) spans.push_back({"  saturated", Tone::warning});
  if (channel.value("slewing", false)) spans.push_back({"  slewing", Tone::warning});
  for (const std::string& line : wrap_spans(style, spans, label_columns)) lines.push_back(line);
}

/// Smallest span of the scale of a trend, as a share of the channel's permitted range. It prevents that noise
/// looks like motion.
constexpr double min_span_share = 0.1;

void add_channel(std::vector<std::string>& lines, const Json& channel, const ViewStyle& style,
                 const ChannelTrends* trends) {
  add_channel_head(lines, channel, style);
  const Json& limits = object_at(channel, "limits");
  const auto pressure = number_at(channel, "pressure_kpa");
  const auto command = number_at(channel, "command_kpa");
  const Bar pressures{number_at(limits, "pressure_min_kpa").value_or(0),
                      number_at(limits, "pressure_max_kpa").value_or(100), pressure ? pressure : command,
                      command};
  std::string numbers = with_decimals(pressure, 2) + " kPa, command " + with_decimals(command, 2);
  if (const auto squeeze = number_at(channel, "squeeze_kpa")) numbers += ", squeeze " + fixed(*squeeze, 1);
  const auto min_span = [](const Bar& bar) { return min_span_share * (bar.upper - bar.lower); };
  const auto add = [&](std::string_view label, const Bar& bar, const Trend* trend) {
    if (trend == nullptr) return add_bar_lines(lines, style, label, bar, numbers);
    add_trend_line(lines, style, label, numbers, *trend, min_span(bar));
  };
  add("pressure", pressures, trends != nullptr ? &trends->pressure_kpa : nullptr);
  add_limit(lines, channel, style);
  const auto displacement = number_at(channel, "displacement_mm");
  const auto reference = number_at(channel, "reference_mm");
  const Bar displacements{number_at(limits, "displacement_min_mm").value_or(0),
                          number_at(limits, "displacement_max_mm").value_or(50), displacement, reference};
  numbers = with_decimals(displacement, 2) + " mm, reference " + with_decimals(reference, 2);
  if (displacement && reference) numbers += ", error " + fixed(*reference - *displacement, 2);
  if (const auto temperature = number_at(channel, "temperature_c"))
    numbers += ", " + fixed(*temperature, 1) + " C";
  add("displacement", displacements, trends != nullptr ? &trends->displacement_mm : nullptr);
  if (trends != nullptr && style.columns < min_trend_columns) {
    add_trends_below(lines, style, *trends, min_span(pressures), min_span(displacements));
  }
}

void add_head(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const std::string state = text_at(status, "state");
  std::vector<Span> spans{{"softgrip ", Tone::faint},
                          {text_at(status, "rig"), Tone::strong},
                          {"  " + state, tone_of_state(state)}};
  if (!object_at(status, "under_pressure").empty()) spans.push_back({", UNDER PRESSURE", Tone::bad});
  const Json& sequence = object_at(status, "sequence");
  if (!sequence.empty()) {
    const std::string name = "  " + text_at(sequence, "name") + ": ";
    if (sequence.contains("ended") && sequence["ended"].is_string()) {
      spans.push_back({name + text_at(sequence, "ended"), Tone::plain});
    } else {
      spans.push_back({name + "step " + std::to_string(sequence.value("step", 0) + 1) + "/" +
                           std::to_string(sequence.value("steps", 0)) + " " + text_at(sequence, "step_name"),
                       Tone::plain});
    }
  }
  spans.push_back({"  " + with_decimals(number_at(status, "time_s"), 1) + " s", Tone::faint});
  for (const std::string& line : wrap_spans(style, spans, 2)) lines.push_back(line);
}

/// Returns a title such as "F202 of left".
std::string fault_title(const Json& fault) {
  const std::string channel = text_at(fault, "channel");
  return text_at(fault, "code") + (channel == "-" ? "" : " of " + channel);
}

void add_fault(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const Json& fault = object_at(status, "fault");
  if (fault.empty()) return;
  const auto add = [&](const std::string& text, Tone tone) {
    for (const std::string& line : wrap_text(style, text, tone, 2)) lines.push_back(line);
  };
  add("fault " + fault_title(fault) + "  " + text_at(fault, "name") + ": " + text_at(fault, "meaning"),
      Tone::bad);
  add("  usual cause: " + text_at(fault, "cause"), Tone::plain);
  add("  remedy: " + text_at(fault, "remedy"), Tone::plain);
  if (const std::string next = text_at(fault, "next"); next != "-") {
    add("  " + next, object_at(fault, "present").empty() ? Tone::good : Tone::warning);
  }
}

/// Adds a list of the pressurised fingers in a prominent colour, with the command that vents them.
void add_pressure(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const std::string text = text_at(object_at(status, "under_pressure"), "text");
  if (text == "-") return;
  for (const std::string& line : wrap_text(style, text, Tone::bad, 0)) lines.push_back(line);
}

/// If the board does not respond, adds the number of connection attempts and the last failure.
void add_no_response(std::vector<std::string>& lines, const Json& bus, const ViewStyle& style) {
  const auto attempts = number_at(bus, "attempts");
  const auto retry_s = number_at(bus, "retry_s");
  const bool answered = bus.value("answered", false);
  std::string text(label_columns, ' ');
  text += answered ? "lost" : "no response yet";
  if (attempts && *attempts > 0) {
    text += ": " + fixed(*attempts, 0) + (*attempts == 1 ? " connection attempt" : " connection attempts");
    if (retry_s && *retry_s > 0) text += ", one every " + significant(*retry_s, 2) + " s";
  }
  text += ".";
  if (const std::string failure = text_at(bus, "failure"); failure != "-") text += " " + failure;
  for (const std::string& line : wrap_text(style, text, Tone::bad, label_columns)) lines.push_back(line);
}

void add_labelled(std::vector<std::string>& lines, const ViewStyle& style, std::string label,
                  std::vector<Span> spans) {
  label.resize(label_columns, ' ');
  spans.insert(spans.begin(), Span{label, Tone::plain});
  for (const std::string& line : wrap_spans(style, spans, label_columns)) lines.push_back(line);
}

void add_board(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const Json& bus = object_at(status, "bus");
  const bool connected = bus.value("connected", false);
  add_labelled(lines, style, "board",
               {{text_at(bus, "board"), Tone::plain},
                {connected ? "  connected" : "  NOT CONNECTED", connected ? Tone::good : Tone::bad}});
  if (!connected) add_no_response(lines, bus, style);
}

void add_internals(std::vector<std::string>& lines, const Json& status, const ViewStyle& style) {
  const Json& loop = object_at(status, "loop");
  const auto overruns = number_at(loop, "slips");
  std::vector<Span> timing{
      {with_decimals(number_at(status, "rate_hz"), 0) + " Hz, ", Tone::plain},
      {with_decimals(number_at(loop, "ticks"), 0) + " ticks, ", Tone::plain},
      {with_decimals(overruns, 0) + " overruns, ", overruns.value_or(0) > 0 ? Tone::warning : Tone::plain},
      {"wake-up p99 " + with_decimals(number_at(loop, "wake_up_p99_us"), 0) + " us, ", Tone::plain},
      {"max " + with_decimals(number_at(loop, "wake_up_max_us"), 0) + " us", Tone::plain}};
  if (object_at(status, "real_time").value("degraded", false))
    timing.push_back({"  real time degraded", Tone::warning});
  add_labelled(lines, style, "loop", timing);

  const Json& recording = object_at(status, "recording");
  std::vector<Span> rows{{recording.value("active", false) ? "on   " : "off  ", Tone::plain},
                         {text_at(recording, "folder"), Tone::plain}};
  if (const std::string error = text_at(recording, "error"); error != "-")
    rows.push_back({"  " + error, Tone::bad});
  add_labelled(lines, style, "recording", rows);
}

}  // namespace

StatusParts parts_of(const Json& status, const ViewStyle& style, const std::vector<ChannelTrends>* trends) {
  StatusParts parts;
  add_head(parts.head, status, style);
  add_pressure(parts.head, status, style);
  add_fault(parts.head, status, style);
  const auto channels = status.find("channels");
  if (channels != status.end() && channels->is_array()) {
    for (std::size_t i = 0; i < channels->size(); ++i) {
      if (!(*channels)[i].is_object()) continue;
      const bool known = trends != nullptr && i < trends->size();
      add_channel(parts.channels.emplace_back(), (*channels)[i], style, known ? &(*trends)[i] : nullptr);
    }
  }
  add_board(parts.board, status, style);
  add_internals(parts.internals, status, style);
  return parts;
}

std::vector<std::string> view_of(const Json& status, const ViewStyle& style) {
  StatusParts parts = parts_of(status, style);
  std::vector<std::string> lines = std::move(parts.head);
  for (const std::vector<std::string>& channel : parts.channels) {
    lines.emplace_back();
    lines.insert(lines.end(), channel.begin(), channel.end());
  }
  lines.emplace_back();
  lines.insert(lines.end(), parts.board.begin(), parts.board.end());
  lines.insert(lines.end(), parts.internals.begin(), parts.internals.end());
  return lines;
}

std::string line_of_status(const Json& status) {
  std::string line = with_decimals(number_at(status, "time_s"), 2) + " s  " + text_at(status, "state");
  if (!object_at(status, "under_pressure").empty()) line += ", UNDER PRESSURE";
  if (const Json& fault = object_at(status, "fault"); !fault.empty()) line += " " + fault_title(fault);
  const Json& bus = object_at(status, "bus");
  if (!bus.empty() && !bus.value("connected", false)) line += ", board NOT CONNECTED";
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
