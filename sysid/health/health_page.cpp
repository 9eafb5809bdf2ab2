#include "sysid/health/health_page.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ranges>
#include <set>

#include "base/numbers.h"
#include "sysid/health/health_result.h"

namespace softgrip::sysid::health {
namespace {

using sysid::HealthNumber;

constexpr double band_spreads = 3;
constexpr std::size_t most_recipes = 4;
constexpr sysid::Colour recipe_colours[most_recipes] = {sysid::Colour::measured, sysid::Colour::other,
                                                        sysid::Colour::error, sysid::Colour::muted};

/// Returns the day that a label contains, such as "2026-11-22"; nullopt if the label is the name of a run.
std::optional<std::chrono::sys_days> day_of(const std::string& label) {
  if (label.size() != 10) return std::nullopt;
  const auto year = to_number(label.substr(0, 4)), month = to_number(label.substr(5, 2)),
             of_month = to_number(label.substr(8, 2));
  if (!year || !month || !of_month) return std::nullopt;
  return std::chrono::sys_days(std::chrono::year(static_cast<int>(*year)) /
                               std::chrono::month(static_cast<unsigned>(*month)) /
                               std::chrono::day(static_cast<unsigned>(*of_month)));
}

bool has_days(const FingerHealth& health) {
  return std::all_of(health.points.begin(), health.points.end(),
                     [](const HealthPoint& point) { return day_of(point.label).has_value(); });
}

/// Returns the horizontal position of a point in the charts. If the labels are days, the position is the
/// number of days since the first point. Otherwise the position is the index of the point.
double place_of(const FingerHealth& health, std::size_t point) {
  const auto first = day_of(health.points.front().label), now = day_of(health.points[point].label);
  if (!first || !now) return static_cast<double>(point);
  return static_cast<double>((*now - *first).count());
}

sysid::Axis time_axis(const FingerHealth& health) {
  sysid::Axis axis;
  axis.label = (has_days(health) ? "days since " : "grips since ") + health.points.front().label;
  axis.lower = -1;
  axis.upper = place_of(health, health.points.size() - 1) + 1;
  return axis;
}

std::vector<std::string> recipes_of(const FingerHealth& health, std::size_t number) {
  std::set<std::string> recipes;
  for (const HealthPoint& point : health.points) {
    for (const auto& [recipe, value] : point.values[number]) recipes.insert(recipe);
  }
  return {recipes.begin(), recipes.end()};
}

void add_reference(const FingerHealth& health, std::size_t number, sysid::Chart& chart) {
  const auto& reference = health.references[number];
  if (!reference || reference->points < 2) return;
  sysid::Series band;
  band.label = reference->slope ? "reference value at this temperature ± 3 standard deviations"
                                : "reference value ± 3 standard deviations";
  band.style = sysid::Series::Style::band;
  band.colour = sysid::Colour::faint;
  for (std::size_t p = 0; p < health.points.size(); ++p) {
    if (health.points[p].epoch != health.epoch()) continue;
    band.x.push_back(place_of(health, p));
    const double usual = reference->at(health.points[p].temperature_c);
    band.y.push_back(usual - band_spreads * reference->spread);
    band.y_upper.push_back(usual + band_spreads * reference->spread);
  }
  chart.series.push_back(std::move(band));
}

void add_marks(const FingerHealth& health, std::size_t number, sysid::Chart& chart) {
  using Direction = sysid::Mark::Direction;
  for (const auto& [before, note] : health.notes) {
    if (before < health.points.size())
      chart.marks.push_back({Direction::vertical, place_of(health, before) - 0.5, note.action});
  }
  for (const HealthAlarm& alarm : health.alarms) {
    if (static_cast<std::size_t>(alarm.number) != number) continue;
    chart.marks.push_back({Direction::vertical, place_of(health, alarm.noticed), "alarm"});
  }
}

std::optional<sysid::Chart> chart_of(const FingerHealth& health, std::size_t number) {
  const sysid::HealthNumberInfo& info = sysid::health_number_infos[number];
  const std::vector<std::string> recipes = recipes_of(health, number);
  if (recipes.empty()) return std::nullopt;
  sysid::Chart chart;
  chart.title = std::string(info.title);
  chart.x = time_axis(health);
  chart.y.label = "[" + model::in_unit(info.unit, health.output_unit) + "]";
  chart.height = 190;
  add_reference(health, number, chart);
  for (std::size_t r = 0; r < std::min(recipes.size(), most_recipes); ++r) {
    sysid::Series series;
    series.label = recipes[r];
    series.style = sysid::Series::Style::points;
    series.colour = recipe_colours[r];
    series.width = 2;
    for (std::size_t p = 0; p < health.points.size(); ++p) {
      const auto value = health.points[p].values[number].find(recipes[r]);
      if (value == health.points[p].values[number].end()) continue;
      series.x.push_back(place_of(health, p));
      series.y.push_back(value->second.value);
    }
    chart.series.push_back(std::move(series));
  }
  add_marks(health, number, chart);
  return chart;
}

/// Returns the chart of the difference from the peer fingers, minus the reference of this difference.
std::optional<sysid::Chart> chart_beside(const FingerHealth& health, std::size_t number) {
  const sysid::HealthNumberInfo& info = sysid::health_number_infos[number];
  sysid::Series series;
  series.label = "difference from the other fingers, minus the reference value of this difference";
  series.style = sysid::Series::Style::points;
  series.width = 2;
  for (std::size_t p = 0; p < health.points.size(); ++p) {
    if (!health.points[p].beside[number]) continue;
    series.x.push_back(place_of(health, p));
    series.y.push_back(*health.points[p].beside[number]);
  }
  if (series.x.empty()) return std::nullopt;
  sysid::Chart chart;
  chart.title = std::string(info.title) + ", compared with the other fingers";
  chart.x = time_axis(health);
  chart.y.label = "[" + model::in_unit(info.unit, health.output_unit) + "]";
  chart.height = 130;
  chart.series.push_back(std::move(series));
  add_marks(health, number, chart);
  return chart;
}

std::string slope_text(const FingerHealth& health, std::size_t number) {
  const sysid::HealthNumberInfo& info = sysid::health_number_infos[number];
  const TemperatureSlope& slope = *health.references[number]->slope;
  std::string text = std::string(info.title) + ": " + significant(slope.per_c, 3) + " " +
                     model::in_unit(info.unit, health.output_unit) + " per °C, standard error " +
                     significant(slope.standard_error, 2) + ", measured at temperatures from " +
                     fixed(slope.lowest_c, 1) + " to " + fixed(slope.highest_c, 1) + " °C";
  const auto& now_c = health.points.back().temperature_c;
  if (now_c && (*now_c < slope.lowest_c || *now_c > slope.highest_c))
    text += "; the temperature of the last point, " + fixed(*now_c, 1) +
            " °C, is outside this temperature range. Half of the extrapolated correction therefore counts as "
            "uncertainty of the correction";
  return text;
}

/// Returns true if a point since the last maintenance record was compared with peer fingers.
bool has_peers(const FingerHealth& health) {
  return std::any_of(health.points.begin(), health.points.end(), [&](const HealthPoint& point) {
    return point.epoch == health.epoch() && std::any_of(point.beside.begin(), point.beside.end(),
                                                        [](const auto& by) { return by.has_value(); });
  });
}

void add_allowances(sysid::Page& page, const FingerHealth& health, const std::vector<SharedChange>& shared) {
  page.section("Corrections");
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    if (health.references[i] && health.references[i]->slope) lines.push_back(slope_text(health, i));
  }
  const bool warm = !health.points.empty() && health.points.back().temperature_c.has_value();
  if (!warm)
    lines.emplace_back("The temperature is not recorded, so its effect is unknown.");
  else if (lines.empty())
    lines.emplace_back(
        "The temperature is recorded, but no indicator is known to depend on the temperature.");
  lines.emplace_back(
      has_peers(health)
          ? "If a change also appears at the other fingers in the same recordings, the change is not "
            "attributed to this finger."
          : "The same recordings contain no other healthy finger for a comparison. An unrecorded change of "
            "the environment, such as temperature, may therefore look like a change of this finger.");
  page.list(lines);
  for (const SharedChange& change : shared) {
    if (change.stands) page.paragraph(shared_sentence(change));
  }
  for (const HealthAlarm& unclear : health.unclear) page.paragraph(unclear_sentence(health, unclear));
}

void add_suspicion(sysid::Page& page, const Suspicion& suspicion, const std::string& baseline) {
  page.section("Possible causes, and how to confirm each cause");
  for (const Suspect& suspect : suspicion.suspects) {
    page.subsection(suspect.id + ": " + suspect.words);
    page.list(suspect.next_steps);
  }
  if (!suspicion.advice.empty()) page.list(suspicion.advice);
  page.paragraph("To confirm the cause, record the commissioning experiment again and run this command:");
  page.code(settling_command(baseline));
}

void add_numbers(sysid::Page& page, const FingerHealth& health) {
  const auto of_alarm = [&](const HealthAlarm& alarm) { return alarm_fields(health, alarm); };
  const auto of_number = [&](std::size_t number) { return number_fields(health, number); };
  if (!health.alarms.empty())
    page.table(result::table_of("All alarms, including those closed by a repair", health.alarms, of_alarm));
  page.table(result::table_of("Latest value, and reference value from the points since the last maintenance",
                              std::views::iota(std::size_t{0}, sysid::health_numbers), of_number));
}

}  // namespace

std::string settling_command(const std::string& baseline) {
  return "softgrip diagnose --baseline " + baseline + " --data TODAY.csv --out diagnosis";
}

sysid::Page health_page(const FingerHealth& health, const Suspicion& suspicion, const HealthSource& source) {
  const bool alarm = health.state == FingerState::alarm;
  sysid::Page page("Health of " + name_in_text(health), health_sentence(health, suspicion),
                   alarm                                   ? sysid::Tone::bad
                   : health.state == FingerState::learning ? sysid::Tone::doubtful
                                                           : sysid::Tone::good);
  const ChartLimits limits = source.options.limits();
  page.provenance(
      {{"software", sysid::software_and_version()},
       {"baseline", source.baseline},
       {"full pressure", significant(source.base.full_kpa, 4) + " kPa; the baseline model reaches " +
                             significant(source.base.full_mm, 4) + " " +
                             std::string(name_of(health.output_unit)) + " at this pressure"},
       {"false alarms", "on average one in " + significant(source.options.false_alarm_points, 4) +
                            " points of a healthy finger, counted over all indicators"},
       {"limits", "CUSUM " + significant(limits.cusum, 3) + " with allowance " +
                      significant(limits.allowance, 2) + ", single value " + significant(limits.single, 3) +
                      " standard deviations"}});
  if (!suspicion.suspects.empty()) add_suspicion(page, suspicion, source.baseline);
  page.section("Indicators");
  add_numbers(page, health);
  add_allowances(page, health, source.shared);
  page.section("Trends");
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    auto chart = chart_of(health, i);
    if (!chart) continue;
    const sysid::HealthNumberInfo& info = sysid::health_number_infos[i];
    std::vector<sysid::Chart> charts{std::move(*chart)};
    std::string caption =
        std::string(info.title) + (has_days(health) ? ": median of all grips of each day, by recipe."
                                                    : ": value of each grip, by recipe.");
    if (auto beside = chart_beside(health, i)) {
      charts.push_back(std::move(*beside));
      caption +=
          " Lower chart: difference from the other fingers in the same recordings, minus the reference value "
          "of this difference.";
    }
    page.figure({std::string(info.id), caption, sysid::stacked(std::move(charts))});
  }
  return page;
}

}  // namespace softgrip::sysid::health
