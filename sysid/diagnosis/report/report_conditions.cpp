#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

namespace softgrip::sysid {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Adds the mean errors of one group to a chart. If `whiskers` is true, adds their confidence intervals too.
void add_bins(Chart& chart, const ConditionEvidence& e, std::size_t group, const std::string& label,
              Colour colour, bool whiskers) {
  Series means, intervals;
  means.label = label;
  means.colour = intervals.colour = colour;
  means.style = e.condition.categories.empty() ? Series::Style::line : Series::Style::points;
  means.width = e.condition.categories.empty() ? 1.4 : 3.5;
  means.dash = whiskers ? Dash::solid : Dash::dashed;
  intervals.width = 1.2;
  for (const ConditionBin& bin : e.bins) {
    if (bin.group != group) continue;
    means.x.push_back(bin.value);
    means.y.push_back(bin.mean_mm);
    intervals.x.insert(intervals.x.end(), {bin.value, bin.value, none});
    intervals.y.insert(intervals.y.end(), {bin.lower_mm, bin.upper_mm, none});
  }
  if (whiskers && e.condition.categories.empty()) {
    Series dots = means;
    dots.label.clear();
    dots.style = Series::Style::points;
    dots.width = 2.5;
    chart.series.push_back(dots);
  }
  if (whiskers) chart.series.push_back(intervals);
  chart.series.push_back(means);
}

Chart condition_chart(const ConditionEvidence& recalibrated, const ConditionEvidence* extended,
                      model::OutputUnit unit) {
  const Condition& condition = recalibrated.condition;
  Chart chart;
  chart.width = 380;
  chart.height = 250;
  chart.title = condition.id;
  std::replace(chart.title.begin(), chart.title.end(), '_', ' ');
  chart.x.label = condition.axis;
  chart.x.logarithmic = condition.logarithmic;
  chart.x.categories = condition.categories;
  if (!condition.categories.empty()) {
    std::size_t used = 0;
    for (const ConditionBin& bin : recalibrated.bins)
      used = std::max(used, static_cast<std::size_t>(bin.value) + 1);
    chart.x.categories.resize(used);
    chart.x.lower = -0.5;
    chart.x.upper = static_cast<double>(used) - 0.5;
  }
  chart.y.label = model::in_unit("mean error [mm]", unit);
  const std::size_t groups = std::max<std::size_t>(1, condition.groups.size());
  if (extended != nullptr && extended->condition.why_not.empty()) {
    for (std::size_t g = 0; g < groups; ++g)
      add_bins(chart, *extended, g, g == 0 ? "extended model" : "", Colour::good, false);
  }
  for (std::size_t g = 0; g < groups; ++g) {
    const std::string label = condition.groups.empty() ? "recalibrated model" : condition.groups[g];
    add_bins(chart, recalibrated, g, label, g == 0 ? Colour::model : Colour::error, true);
  }
  return chart;
}

}  // namespace

Figure conditions_figure(const Diagnosis& d) {
  constexpr std::size_t most = 4;
  Figure figure{"error by condition",
                "Mean error with its 95 % interval, for at most four conditions on which the error depends "
                "significantly. A position is a predicted displacement and not a reading, because a reading "
                "and its error contain the same noise." +
                    std::string(is_extended(d) ? " Dashed: extended model. Where the dashed curve is flat, "
                                                 "the extended model explains the dependence."
                                               : ""),
                {}};
  std::size_t charts = 0;
  for (const ConditionEvidence& e : d.evidence->recalibrated.conditions) {
    if (!e.condition.why_not.empty() || !e.clear || charts == most) continue;
    const auto& after = d.evidence->extended.conditions;
    const auto same = std::find_if(after.begin(), after.end(), [&](const ConditionEvidence& other) {
      return other.condition.id == e.condition.id;
    });
    if (charts % 2 == 0) figure.charts.emplace_back();
    figure.charts.back().push_back(condition_chart(
        e, is_extended(d) && same != after.end() ? &*same : nullptr, d.extended_model.output_unit));
    ++charts;
  }
  return figure;
}

}  // namespace softgrip::sysid
