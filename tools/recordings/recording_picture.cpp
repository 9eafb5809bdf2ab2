#include "tools/recordings/recording_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"

namespace softgrip::tools {
namespace {

using sysid::Chart;
using sysid::Colour;
using sysid::Mark;
using sysid::Series;

constexpr int picture_width = 960;
constexpr int tall = 230;
constexpr int low = 190;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

Series line(std::string label, const sysid::Log& log, std::vector<double> y, Colour colour) {
  Series series;
  series.label = std::move(label);
  series.x = log.time_s;
  series.y = std::move(y);
  series.colour = colour;
  return series;
}

bool any_number(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string title_of(const std::string& what, const sysid::Log& log) {
  return log.channel.empty() ? what : log.channel + ": " + what;
}

Chart chart(std::string title, std::string y_label, int height) {
  Chart chart;
  chart.title = std::move(title);
  chart.x.label = "time [s]";
  chart.y.label = std::move(y_label);
  chart.width = picture_width;
  chart.height = height;
  return chart;
}

/// Returns vertical lines that mark the grip results and faults of a channel in its charts.
std::vector<Mark> marks_of(const sysid::Recording& recording, const std::string& channel) {
  std::vector<Mark> marks;
  for (const sysid::RecordedEvent& event : recording.events) {
    const bool told = event.kind == "grip_result" || event.kind == "fault_latched";
    if (!told || (!event.channel.empty() && event.channel != channel)) continue;
    marks.push_back({Mark::Direction::vertical, event.time_s, event.code});
  }
  return marks;
}

Chart pressure_chart(const sysid::Log& log) {
  Chart pressure = chart(title_of("pressure", log), "pressure [kPa]", tall);
  Series command = line("command", log, log.pressure_command_kpa, Colour::model);
  command.style = Series::Style::steps;
  if (any_number(log.pressure_kpa)) {
    pressure.series.push_back(line("measured", log, log.pressure_kpa, Colour::measured));
  }
  pressure.series.push_back(std::move(command));
  return pressure;
}

Chart displacement_chart(const sysid::Recording& recording, const sysid::Log& log) {
  Chart displacement = chart(title_of(model::in_unit("displacement", log.output_unit), log),
                             model::in_unit("displacement [mm]", log.output_unit), tall);
  displacement.series.push_back(line("measured", log, log.displacement_mm, Colour::measured));
  if (std::vector<double> reference = sysid::numbers_of(log, "reference_mm"); any_number(reference)) {
    Series wanted = line("reference", log, std::move(reference), Colour::model);
    wanted.dash = sysid::Dash::dashed;
    displacement.series.push_back(std::move(wanted));
  }
  displacement.marks = marks_of(recording, log.channel);
  return displacement;
}

Chart error_chart(const sysid::Log& log, const std::vector<double>& errors) {
  const Tracking tracking = tracking_of(log);
  const std::string rated = tracking.grips_known ? ", in free motion" : "";
  const std::string figures = tracking.free_samples > 0
                                  ? rated + " RMSE " + significant(tracking.free_rmse_mm, 3) +
                                        " mm, largest " + significant(tracking.free_largest_mm, 3) + " mm"
                                  : std::string();
  Chart error = chart(title_of("reference minus displacement" + figures, log), "error [mm]", low);
  const std::vector<char> gripping = gripping_of(log);
  std::vector<double> free = errors;
  std::vector<double> held = errors;
  for (std::size_t i = 0; i < errors.size(); ++i) (gripping[i] != 0 ? free : held)[i] = nothing;
  const bool both = tracking.gripping_samples > 0;
  if (both) error.series.push_back(line("gripping", log, std::move(held), Colour::faint));
  error.series.push_back(line(both ? "free motion" : "", log, std::move(free), Colour::error));
  return error;
}

/// Adds a column of texts to a chart as a step curve between named levels. The levels are in the order in
/// which the texts first appear.
void add_words(Chart& chart, const sysid::Log& log, const std::string& column) {
  const std::vector<std::string> words = sysid::texts_of(log, column);
  if (words.empty()) return;
  std::vector<double> levels(words.size(), nothing);
  for (std::size_t i = 0; i < words.size(); ++i) {
    auto& names = chart.y.categories;
    auto place = std::find(names.begin(), names.end(), words[i]);
    if (place == names.end()) place = names.insert(names.end(), words[i]);
    levels[i] = static_cast<double>(place - names.begin());
  }
  Series steps = line("", log, std::move(levels), Colour::other);
  steps.style = Series::Style::steps;
  chart.series.push_back(std::move(steps));
}

void add_states(const sysid::Recording& recording, std::vector<Chart>& charts) {
  Chart states = chart("state", "", low);
  add_words(states, recording.channels.front(), "state");
  if (!states.series.empty()) charts.push_back(std::move(states));
}

std::vector<Chart> charts_of(const sysid::Recording& recording) {
  std::vector<Chart> charts;
  for (const sysid::Log& log : recording.channels) {
    charts.push_back(pressure_chart(log));
    charts.push_back(displacement_chart(recording, log));
    if (const std::vector<double> errors = errors_of(log); any_number(errors)) {
      charts.push_back(error_chart(log, errors));
    }
  }
  add_states(recording, charts);
  return charts;
}

std::string called(const sysid::Recording& recording) {
  return recording.sequence.empty() ? recording.name : recording.sequence + ", " + recording.name;
}

/// Returns the title of a chart up to the first comma. The statistics follow this comma.
std::string subject_of(const Chart& chart) {
  return chart.title.substr(0, chart.title.find(','));
}

Colour of_the_second(Colour colour) {
  switch (colour) {
    case Colour::measured:
      return Colour::error;
    case Colour::model:
      return Colour::good;
    default:
      return Colour::other;
  }
}

void lay_over(Chart& below, Chart above, const std::string& name) {
  for (Series& series : above.series) {
    series.label = series.label.empty() ? name : series.label + ", " + name;
    series.colour = of_the_second(series.colour);
    series.dash = sysid::Dash::dashed;
    below.series.push_back(std::move(series));
  }
  below.title = subject_of(below);
}

}  // namespace

sysid::Figure figure_of(const sysid::Recording& recording) {
  std::vector<Chart> charts = charts_of(recording);
  charts.front().title = called(recording) + " · " + charts.front().title;
  return {called(recording), "Recording " + called(recording) + ".", sysid::stacked(std::move(charts))};
}

sysid::Figure figure_of(const sysid::Recording& first, const sysid::Recording& second, Pairing pairing) {
  std::vector<Chart> charts = charts_of(first);
  std::vector<Chart> others = charts_of(second);
  sysid::Figure figure{called(first) + " and " + called(second), {}, {}};
  if (pairing == Pairing::over) {
    figure.caption = "Recordings " + called(first) + " and, dashed, " + called(second) + ".";
    for (Chart& chart : charts) {
      const auto same = std::find_if(others.begin(), others.end(), [&](const Chart& other) {
        return subject_of(other) == subject_of(chart) && other.y.categories == chart.y.categories;
      });
      if (same == others.end()) continue;
      lay_over(chart, std::move(*same), second.name);
      others.erase(same);
    }
    for (Chart& chart : others) {
      chart.title += ", " + second.name;
      charts.push_back(std::move(chart));
    }
    charts.front().title = figure.name + " · " + charts.front().title;
    figure.charts = sysid::stacked(std::move(charts));
    return figure;
  }
  figure.caption = "Recordings " + called(first) + " (left) and " + called(second) + " (right).";
  charts.front().title = called(first) + " · " + charts.front().title;
  others.front().title = called(second) + " · " + others.front().title;
  for (std::size_t i = 0; i < std::max(charts.size(), others.size()); ++i) {
    figure.charts.emplace_back();
    for (std::vector<Chart>* column : {&charts, &others}) {
      Chart chart = i < column->size() ? std::move((*column)[i]) : Chart{};
      chart.width = picture_width * 3 / 4;
      chart.height = tall;
      figure.charts.back().push_back(std::move(chart));
    }
  }
  return figure;
}

/// Returns a text such as " from 2 to 3 s"; an infinite end of the interval is omitted.
std::string interval_text(double from_s, double to_s) {
  if (!std::isfinite(from_s)) return std::isfinite(to_s) ? " up to " + significant(to_s) + " s" : "";
  return " from " + significant(from_s) + (std::isfinite(to_s) ? " to " + significant(to_s) + " s" : " s on");
}

tl::expected<sysid::Recording, std::string> part_of(const sysid::Recording& recording,
                                                    const std::string& channel, double from_s, double to_s) {
  sysid::Recording part = recording;
  part.channels.clear();
  std::string known;
  for (const sysid::Log& log : recording.channels) {
    known += (known.empty() ? "" : ", ") + log.channel;
    if (!channel.empty() && log.channel != channel) continue;
    const auto first = std::lower_bound(log.time_s.begin(), log.time_s.end(), from_s);
    const auto last = std::upper_bound(log.time_s.begin(), log.time_s.end(), to_s);
    if (last - first < 2)
      return tl::unexpected(recording.name + " has no samples" + interval_text(from_s, to_s) +
                            ": the recording lasts from " + significant(log.time_s.front()) + " to " +
                            significant(log.time_s.back()) + " s");
    sysid::Log cut = sysid::slice(log, static_cast<std::size_t>(first - log.time_s.begin()),
                                  static_cast<std::size_t>(last - log.time_s.begin()));
    cut.time_s.assign(first, last);
    part.channels.push_back(std::move(cut));
  }
  if (part.channels.empty())
    return tl::unexpected(recording.name + " has no channel " + channel +
                          (known.empty() ? "" : "; it has " + known));
  std::erase_if(part.events,
                [&](const sysid::RecordedEvent& e) { return e.time_s < from_s || e.time_s > to_s; });
  return part;
}

std::vector<double> errors_of(const sysid::Log& log) {
  std::vector<double> errors = sysid::numbers_of(log, "reference_mm");
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= log.displacement_mm[i];
  return errors;
}

std::vector<char> gripping_of(const sysid::Log& log) {
  std::vector<char> gripping(log.size(), 0);
  const std::vector<std::string> steps = sysid::texts_of(log, "step");
  const std::vector<std::string> results = sysid::texts_of(log, "result");
  if (steps.empty() || results.empty()) return gripping;
  for (std::size_t begin = 0; begin < steps.size();) {
    std::size_t end = begin;
    bool held = false;
    for (; end < steps.size() && steps[end] == steps[begin]; ++end) held = held || results[end] == "holding";
    // The log states the result of a step at the first sample of the next step.
    held = held || (end < steps.size() && results[end] == "holding");
    if (held)
      std::fill(gripping.begin() + static_cast<std::ptrdiff_t>(begin),
                gripping.begin() + static_cast<std::ptrdiff_t>(end), char{1});
    begin = end;
  }
  return gripping;
}

Tracking tracking_of(const sysid::Log& log) {
  Tracking tracking;
  tracking.grips_known = !sysid::texts_of(log, "step").empty() && !sysid::texts_of(log, "result").empty();
  const std::vector<double> errors = errors_of(log);
  const std::vector<char> gripping = gripping_of(log);
  double squares = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    if (gripping[i] != 0) {
      ++tracking.gripping_samples;
      tracking.gripping_largest_mm = std::max(tracking.gripping_largest_mm, errors[i]);
      continue;
    }
    ++tracking.free_samples;
    squares += errors[i] * errors[i];
    tracking.free_largest_mm = std::max(tracking.free_largest_mm, std::abs(errors[i]));
  }
  if (tracking.free_samples > 0) {
    tracking.free_rmse_mm = std::sqrt(squares / static_cast<double>(tracking.free_samples));
  }
  return tracking;
}

std::string to_text(const Tracking& tracking) {
  std::string text;
  if (tracking.free_samples > 0) {
    text = std::string(tracking.grips_known ? "free motion" : "tracking") + ": RMSE " +
           significant(tracking.free_rmse_mm, 3) + " mm, largest " +
           significant(tracking.free_largest_mm, 3) + " mm";
  }
  if (tracking.gripping_samples > 0) {
    text += (text.empty() ? "" : "; ") + std::string("gripping: up to ") +
            significant(tracking.gripping_largest_mm, 3) + " mm below the reference";
  }
  return text;
}

}  // namespace softgrip::tools
