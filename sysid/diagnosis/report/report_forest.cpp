#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/pages/canvas.h"
#include "sysid/pages/chart_scale.h"

namespace softgrip::sysid {
namespace {

constexpr double label_px = 12;
constexpr double plot_left = 240;
constexpr double plot_right = 520;
constexpr double number_px = 540;
constexpr double inclusion_px = 742;
constexpr double row_px = 24;
constexpr double top_px = 34;

/// A row of the forest plot.
struct Row {
  std::string name;
  bool alternative = false;
  /// Error reduction by the cause; nullptr: the reduction was not computed. An example is a cause that no
  /// command separates from the named cause.
  const Spread* gain = nullptr;
  double inclusion = 0;  ///< NaN: not computed
};

const Spread* gain_of(const NamedCause& named, const Cause& alternative) {
  for (const CandidateScore& c : named.candidates) {
    if (c.cause == alternative && std::isfinite(c.heldout_rmse_mm) &&
        c.gain_percent.upper > c.gain_percent.lower)
      return &c.gain_percent;
  }
  return nullptr;
}

std::vector<Row> rows_of(const Diagnosis& d) {
  std::vector<Row> rows;
  for (const NamedCause* named : shown_causes(d)) {
    rows.push_back({std::string(named->cause.title), false,
                    named->only_in_loop ? nullptr : &named->gain_percent, named->inclusion});
    for (const Cause& alternative : named->alternatives)
      rows.push_back({"or " + alternative_title(alternative, d.causes), true, gain_of(*named, alternative)});
  }
  return rows;
}

void draw_interval(Canvas& canvas, const Row& row, const Scale& x, double y) {
  const Spread& gain = *row.gain;
  const Colour colour = row.alternative ? Colour::muted : Colour::model;
  canvas.line({x.px(gain.lower), y}, {x.px(gain.upper), y}, colour, " stroke-width=\"2\"");
  for (const double end : {gain.lower, gain.upper})
    canvas.line({x.px(end), y - 4}, {x.px(end), y + 4}, colour, " stroke-width=\"1.4\"");
  canvas.framed_box(x.px(gain.value) - 4, y - 4, 8, 8, row.alternative ? Colour::paper : colour, colour,
                    " stroke-width=\"1.4\"");
}

}  // namespace

Figure forest_figure(const Diagnosis& d) {
  const std::vector<Row> rows = rows_of(d);
  double lowest = 0;
  double highest = 0;
  for (const Row& row : rows) {
    if (row.gain == nullptr) continue;
    lowest = std::min(lowest, row.gain->lower);
    highest = std::max(highest, row.gain->upper);
  }
  const Axis axis;
  const Scale x(axis, lowest, highest, plot_left, plot_right, true);
  const double bottom = top_px + row_px * static_cast<double>(rows.size());
  Canvas canvas;
  constexpr std::string_view bold = " font-weight=\"600\"";
  canvas.words({label_px, 18}, Anchor::start, "Cause", Colour::text, bold);
  canvas.words({number_px, 18}, Anchor::start, "reduction (95 %)", Colour::text, bold);
  canvas.words({inclusion_px, 18}, Anchor::end, "inclusion", Colour::text, bold);
  for (const Tick& tick : x.ticks(5)) {
    canvas.line({x.px(tick.at), top_px - 6}, {x.px(tick.at), bottom},
                tick.at == 0 ? Colour::axis : Colour::grid);
    canvas.words({x.px(tick.at), bottom + 14}, Anchor::middle, tick.text);
  }
  canvas.words({(plot_left + plot_right) / 2, bottom + 31}, Anchor::middle,
               "reduction of the held-out error [%]");
  Drawing drawing;
  drawing.header = {"cause",          "alternative",    "error reduction [%]",
                    "lower 95 % [%]", "upper 95 % [%]", "inclusion"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double y = top_px + row_px * (static_cast<double>(i) + 0.5);
    canvas.words({label_px + (row.alternative ? 14 : 0), y + 4}, Anchor::start, row.name,
                 row.alternative ? Colour::muted : Colour::text);
    if (row.gain != nullptr) {
      draw_interval(canvas, row, x, y);
      canvas.words({number_px, y + 4}, Anchor::start, percent_range(*row.gain),
                   row.alternative ? Colour::muted : Colour::text);
    } else {
      canvas.words({number_px, y + 4}, Anchor::start, "not computed separately", Colour::muted);
    }
    const bool has_inclusion = !row.alternative && !std::isnan(row.inclusion);
    if (has_inclusion) canvas.words({inclusion_px, y + 4}, Anchor::end, fixed(row.inclusion, 2));
    std::vector<std::string> cells{
        row.name, row.alternative ? "yes" : "no", "", "", "", has_inclusion ? fixed(row.inclusion, 4) : ""};
    if (row.gain != nullptr) {
      cells[2] = shortest(row.gain->value);
      cells[3] = shortest(row.gain->lower);
      cells[4] = shortest(row.gain->upper);
    }
    drawing.rows.push_back(std::move(cells));
  }
  drawing.markup = canvas.markup();
  drawing.height = static_cast<int>(bottom) + 40;
  const bool alternatives =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.alternative; });
  return {"error reduction by cause",
          std::string("Reduction of the held-out error by each cause, with 95 % interval. ") +
              "Inclusion frequency: share of bootstrap resamples in which the model with the cause predicts "
              "better than the model without the cause." +
              (alternatives ? " Hollow symbol: alternative that these logs cannot separate from the cause in "
                              "the row above."
                            : ""),
          {},
          std::move(drawing)};
}

}  // namespace softgrip::sysid
