#include "tools/health/health_page.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "base/numbers.h"

namespace softgrip::tools::health {
namespace {

using sysid::HealthNumber;

constexpr double band_spreads = 3;
constexpr std::size_t most_recipes = 4;
constexpr sysid::Colour recipe_colours[most_recipes] = {sysid::Colour::measured, sysid::Colour::other,
                                                        sysid::Colour::error, sysid::Colour::muted};

/// Days since the first point where both are days; else how many points lie between.
double place_of(const FingerHealth& health, std::size_t point) {
  const auto day = [](const std::string& label) -> std::optional<std::chrono::sys_days> {
    const auto year = to_number(label.substr(0, 4));
    const auto month = label.size() == 10 ? to_number(label.substr(5, 2)) : std::nullopt;
    const auto of_month = label.size() == 10 ? to_number(label.substr(8, 2)) : std::nullopt;
    if (!year || !month || !of_month) return std::nullopt;
    return std::chrono::sys_days(std::chrono::year(static_cast<int>(*year)) /
                                 std::chrono::month(static_cast<unsigned>(*month)) /
                                 std::chrono::day(static_cast<unsigned>(*of_month)));
  };
  const auto first = day(health.points.front().label), now = day(health.points[point].label);
  if (!first || !now) return static_cast<double>(point);
  return static_cast<double>((*now - *first).count());
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
  band.label = "usual since the last note, three spreads";
  band.style = sysid::Series::Style::band;
  band.colour = sysid::Colour::faint;
  for (std::size_t p = 0; p < health.points.size(); ++p) {
    if (health.points[p].epoch != health.epoch()) continue;
    band.x.push_back(place_of(health, p));
    band.y.push_back(reference->mean - band_spreads * reference->spread);
    band.y_upper.push_back(reference->mean + band_spreads * reference->spread);
  }
  chart.series.push_back(std::move(band));
}

void add_marks(const FingerHealth& health, std::size_t number, sysid::Chart& chart) {
  using Direction = sysid::Mark::Direction;
  for (const auto& [before, note] : health.notes) {
    if (before < health.points.size())
      chart.marks.push_back({Direction::vertical, place_of(health, before) - 0.5, note.mended});
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
  chart.x.label = "days since " + health.points.front().label;
  chart.y.label = "[" + std::string(info.unit) + "]";
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
      series.y.push_back(value->second);
    }
    chart.series.push_back(std::move(series));
  }
  add_marks(health, number, chart);
  return chart;
}

void add_suspicion(sysid::Page& page, const Suspicion& suspicion, const std::string& baseline) {
  page.section("What is suspected, and what settles it");
  for (const Suspect& suspect : suspicion.suspects) {
    page.subsection(suspect.id + ": " + suspect.words);
    page.list(suspect.next_steps);
  }
  if (!suspicion.advice.empty()) page.list(suspicion.advice);
  page.paragraph("Record the commissioning experiment again and ask what changed:");
  page.code(settling_command(baseline));
}

void add_alarms(sysid::Page& page, const FingerHealth& health) {
  sysid::Table table{"All alarms, those too that ended with what was mended",
                     {"number", "change", "since", "noticed", "grips until then", "stands"},
                     {false, true, false, false, true, false},
                     {}};
  for (const HealthAlarm& alarm : health.alarms) {
    const sysid::HealthNumberInfo& info = sysid::info_of(alarm.number);
    table.rows.push_back({std::string(info.title),
                          significant(alarm.change, 3) + " " + std::string(info.unit),
                          health.points[alarm.since].label, health.points[alarm.noticed].label,
                          std::to_string(alarm.grips), alarm.epoch == health.epoch() ? "yes" : "no"});
  }
  if (!table.rows.empty()) page.table(table);
}

void add_numbers(sysid::Page& page, const FingerHealth& health) {
  sysid::Table table{"The last point beside what is usual since the last note",
                     {"number", "last", "usual", "spread", "points", "unit"},
                     {false, true, true, true, true, false},
                     {}};
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    const sysid::HealthNumberInfo& info = sysid::health_number_infos[i];
    const auto last = health.latest(static_cast<HealthNumber>(i));
    const auto& reference = health.references[i];
    const bool usual = reference && reference->points > 1;
    table.rows.push_back({std::string(info.title), last ? significant(*last, 4) : "-",
                          reference ? significant(reference->mean, 4) : "-",
                          usual ? significant(reference->spread, 2) : "-",
                          reference ? std::to_string(reference->points) : "0", std::string(info.unit)});
  }
  page.table(table);
}

}  // namespace

std::string settling_command(const std::string& baseline) {
  return "softgrip diagnose --baseline " + baseline + " --data TODAY.csv --out diagnosis";
}

sysid::Page health_page(const FingerHealth& health, const Suspicion& suspicion, const HealthSource& source) {
  const bool alarm = health.state == FingerState::alarm;
  sysid::Page page("Health of " + health.finger, health_sentence(health, suspicion),
                   alarm                                   ? sysid::Tone::bad
                   : health.state == FingerState::learning ? sysid::Tone::doubtful
                                                           : sysid::Tone::good);
  const ChartLimits limits = source.options.limits();
  page.provenance({{"software", sysid::software_and_version()},
                   {"baseline", source.baseline},
                   {"full pressure", significant(source.base.full_kpa, 4) + " kPa, where the base comes to " +
                                         significant(source.base.full_mm, 4) + " mm"},
                   {"false alarms", "one in " + significant(source.options.false_alarm_points, 4) +
                                        " points of a healthy finger, over all its numbers"},
                   {"limits", "CUSUM " + significant(limits.cusum, 3) + " with allowance " +
                                  significant(limits.allowance, 2) + ", single value " +
                                  significant(limits.single, 3) + " standard deviations"}});
  if (!suspicion.suspects.empty()) add_suspicion(page, suspicion, source.baseline);
  page.section("The numbers");
  add_alarms(page, health);
  add_numbers(page, health);
  page.section("Over time");
  for (std::size_t i = 0; i < sysid::health_numbers; ++i) {
    auto chart = chart_of(health, i);
    if (!chart) continue;
    const sysid::HealthNumberInfo& info = sysid::health_number_infos[i];
    page.figure({std::string(info.id), std::string(info.title) + ", the median of each day by recipe.",
                 sysid::stacked({std::move(*chart)})});
  }
  return page;
}

}  // namespace softgrip::tools::health
