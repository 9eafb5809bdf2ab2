#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "base/numbers.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/canvas.h"

namespace softgrip::sysid {
namespace {

constexpr double left = 10;
constexpr double right = 750;
constexpr double bar_px = 30;
constexpr double line_px = 19;
constexpr double fan_px = 22;

std::string letter(std::size_t i) {
  return {static_cast<char>('A' + static_cast<char>(i))};
}

/// Returns a mean square as text, for example "0.012 mm²". The unit is the square of the unit of the
/// readings.
std::string square_text(double mm2, model::OutputUnit unit) {
  return significant(mm2, 3) + model::in_unit(" mm\xc2\xb2", unit);
}

std::string amount(double mm2, double whole_mm2, model::OutputUnit unit) {
  return square_text(mm2, unit) + ", " + fixed(100 * mm2 / whole_mm2, 1) + " %";
}

/// Draws the error of the given model as a bar, with connecting lines to a second bar below. The second bar
/// shows the error after the refit, at a larger scale. The title of the second bar is above it, between the
/// lines. Returns the vertical position of the top of the second bar.
double given_bar(Canvas& canvas, const Budget& budget, model::OutputUnit unit, double top) {
  const double kept = std::clamp(budget.recalibrated / budget.as_given, 0.0, 1.0);
  const double split = right - kept * (right - left);
  canvas.words({left, top - 6}, Anchor::start,
               "Given model, mean square error " + square_text(budget.as_given, unit) +
                   ": refitted parameters explain " + fixed(100 * (1 - kept), kept < 0.01 ? 1 : 0) +
                   " % of this error");
  canvas.box(left, top, split - left, bar_px / 2, Colour::grid);
  canvas.box(split, top, right - split, bar_px / 2, Colour::axis);
  const double below = top + bar_px / 2, spread = below + fan_px, bar = spread + line_px + 4;
  constexpr std::string_view dotted = " stroke-dasharray=\"2 3\"";
  canvas.line({split, below}, {left, spread}, Colour::axis, dotted);
  canvas.line({left, spread}, {left, bar}, Colour::axis, dotted);
  canvas.line({right, below}, {right, bar}, Colour::axis, dotted);
  return bar;
}

void parts_bar(Canvas& canvas, const std::vector<BudgetPart>& parts, double whole, double top) {
  double x = left;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double width = parts[i].mm2 / whole * (right - left);
    canvas.framed_box(x, top, width, bar_px, parts[i].colour, Colour::paper);
    if (width > 14)
      canvas.words({x + width / 2, top + bar_px / 2 + 4}, Anchor::middle, letter(i), Colour::paper,
                   " font-weight=\"600\"");
    x += width;
  }
}

void key(Canvas& canvas, const std::vector<BudgetPart>& parts, double whole, model::OutputUnit unit,
         double top) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double y = top + line_px * static_cast<double>(i);
    canvas.box(left, y - 10, 12, 12, parts[i].colour);
    canvas.words({left + 20, y}, Anchor::start, letter(i) + "  " + parts[i].name);
    canvas.words({left + 360, y}, Anchor::start, amount(parts[i].mm2, whole, unit));
    if (!parts[i].interval.empty())
      canvas.words({left + 520, y}, Anchor::start, "95 % interval " + parts[i].interval, Colour::muted);
  }
}

}  // namespace

std::vector<BudgetPart> budget_parts(const Diagnosis& d) {
  const Budget budget = budget_of(d);
  const double taken = std::max(0.0, budget.recalibrated - budget.extended);
  double one_by_one = 0;
  for (const NamedCause& named : d.causes)
    if (!named.only_in_loop) one_by_one += std::max(0.0, named.gain_mm2.value);
  const double scale = one_by_one > taken && one_by_one > 0 ? taken / one_by_one : 1;
  constexpr Colour colours[]{Colour::model, Colour::good, Colour::other};
  std::vector<BudgetPart> parts;
  for (const NamedCause& named : d.causes) {
    if (named.only_in_loop) continue;
    const Spread& gain = named.gain_mm2;
    parts.push_back({std::string(named.cause.title), scale * std::max(0.0, gain.value),
                     colours[parts.size() % std::size(colours)],
                     significant(gain.lower, 3) + " to " + significant(gain.upper, 3)});
  }
  const double together = taken - scale * one_by_one;
  // A part with less than 0.1 % of the total would not be visible in the bar, so it is left out.
  if (together > 1e-3 * budget.recalibrated)
    parts.push_back({d.causes.empty() || d.loop_bands_kpa
                         ? (d.base.empty() ? "Explained by causes that are not reported"
                                           : "Explained by another model structure")
                         : "Explained only by the combination of several causes",
                     together, Colour::muted, ""});
  const double noise = std::min(budget.noise, budget.recalibrated - taken);
  parts.push_back({"Unexplained", budget.recalibrated - taken - noise, Colour::error, ""});
  parts.push_back({"Noise of the readings", noise, Colour::faint, ""});
  std::erase_if(parts, [](const BudgetPart& part) { return !(part.mm2 > 0); });
  return parts;
}

Figure budget_figure(const Diagnosis& d) {
  const Budget budget = budget_of(d);
  const std::vector<BudgetPart> parts = budget_parts(d);
  const bool moved = std::isfinite(budget.as_given) && budget.as_given > 1.02 * budget.recalibrated;
  const model::OutputUnit unit = d.extended_model.output_unit;
  Drawing drawing;
  Canvas canvas;
  double top = 24;
  if (moved) top = given_bar(canvas, budget, unit, top);
  canvas.words({moved ? left + 8 : left, top - 6}, Anchor::start,
               std::string(moved ? "Recalibrated model" : "Model") + ", mean square error " +
                   square_text(budget.recalibrated, unit));
  parts_bar(canvas, parts, budget.recalibrated, top);
  key(canvas, parts, budget.recalibrated, unit, top + bar_px + 20);
  drawing.markup = canvas.markup();
  drawing.height = static_cast<int>(top + bar_px + 20 + line_px * static_cast<double>(parts.size()));
  drawing.header = {"part", model::in_unit("mean square [mm^2]", unit),
                    "share of the recalibrated model's error [%]",
                    model::in_unit("95 % interval [mm^2]", unit)};
  if (moved) drawing.rows.push_back({"given model", shortest(budget.as_given), "", ""});
  drawing.rows.push_back({"recalibrated model", shortest(budget.recalibrated), "100", ""});
  for (const BudgetPart& part : parts)
    drawing.rows.push_back(
        {part.name, shortest(part.mm2), fixed(100 * part.mm2 / budget.recalibrated, 2), part.interval});
  return {"error budget",
          std::string("Error budget: mean square errors on held-out readings.") +
              (d.causes.empty() ? ""
                                : " The share of a cause is the increase of the error when the cause is "
                                  "removed from the extended model."),
          {},
          std::move(drawing)};
}

}  // namespace softgrip::sysid
