#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/pages/canvas.h"

namespace softgrip::sysid {
namespace {

constexpr int width_px = 760;
constexpr double gap_px = 24;
constexpr double number_line_px = 15;
constexpr double ends_px = 24;
constexpr std::size_t values_shown = 6;

double box_width(std::size_t boxes) {
  const auto count = static_cast<double>(boxes);
  return (width_px - 2 * ends_px - (count - 1) * gap_px) / count;
}

/// Returns the name of a parameter without its unit, for example "alpha" for "alpha_mm_per_kpa".
std::string without_unit(std::string name, std::string_view unit) {
  std::string tail = "_";
  for (const char c : unit) {
    if (c == '/') {
      tail += tail == "_1" ? "" : "_per_";
    } else {
      tail += c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  if (tail.starts_with("_1")) tail = "_per_" + tail.substr(2);
  if (!unit.empty() && name.size() > tail.size() && name.ends_with(tail))
    name.resize(name.size() - tail.size());
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::vector<std::string> lines_of(const model::BlockSpec& block, model::OutputUnit output_unit) {
  const model::BlockDescriptor& descriptor = model::catalogue()[block.type];
  std::vector<std::string> lines;
  const std::size_t shown = block.values.size() > values_shown ? values_shown - 1 : block.values.size();
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string unit(descriptor.spec(i).unit);
    lines.push_back(without_unit(descriptor.name(i), unit) + " = " + significant(block.values[i], 3) +
                    (unit.empty() ? "" : " " + model::in_unit(unit, output_unit)));
  }
  if (shown < block.values.size())
    lines.push_back("and " + std::to_string(block.values.size() - shown) + " more");
  return lines;
}

/// Returns the number of boxes in a row of the diagram for which the texts fit into the boxes.
std::size_t boxes_in_a_row(const model::Model& model) {
  double widest = 0;
  for (const model::BlockSpec& block : model.blocks) {
    widest = std::max(widest, 1.1 * text_width(model::catalogue()[block.type].info.title));
    for (const std::string& line : lines_of(block, model.output_unit))
      widest = std::max(widest, text_width(line));
  }
  std::size_t boxes = 4;
  while (boxes > 2 && box_width(boxes) < 0.9 * widest + 16) --boxes;
  return boxes;
}

void arrow(Canvas& canvas, double from, double to, double y) {
  canvas.line({from, y}, {to, y}, Colour::axis, " stroke-width=\"1.4\"");
  canvas.line({to - 5, y - 4}, {to, y}, Colour::axis, " stroke-width=\"1.4\"");
  canvas.line({to - 5, y + 4}, {to, y}, Colour::axis, " stroke-width=\"1.4\"");
}

}  // namespace

Figure chain_figure(const model::Model& model, const model::Model& given) {
  Canvas canvas;
  Drawing drawing;
  drawing.header = {"station", "block", "parameter", "value", "unit", "added"};
  std::vector<std::size_t> seen(model::catalogue().size());
  bool any_added = false;
  double top = 22;
  const std::size_t boxes = boxes_in_a_row(model);
  const double box_px = box_width(boxes);
  for (std::size_t first = 0; first < model.blocks.size(); first += boxes) {
    const std::size_t last = std::min(model.blocks.size(), first + boxes);
    std::size_t lines = 1;
    for (std::size_t i = first; i < last; ++i)
      lines = std::max(lines, lines_of(model.blocks[i], model.output_unit).size());
    const double height = 30 + number_line_px * static_cast<double>(lines);
    for (std::size_t i = first; i < last; ++i) {
      const model::BlockSpec& block = model.blocks[i];
      const model::BlockDescriptor& descriptor = model::catalogue()[block.type];
      const auto present = static_cast<std::size_t>(
          std::count_if(given.blocks.begin(), given.blocks.end(),
                        [&](const model::BlockSpec& other) { return other.type == block.type; }));
      const bool added = ++seen[block.type] > present;
      any_added = any_added || added;
      const double x = ends_px + static_cast<double>(i - first) * (box_px + gap_px);
      const std::string station(model::name_of(descriptor.info.station));
      canvas.words({x, top - 6}, Anchor::start, added ? station + ", added" : station,
                   added ? Colour::good : Colour::muted);
      canvas.framed_box(x, top, box_px, height, Colour::panel, added ? Colour::good : Colour::axis,
                        added ? " stroke-width=\"2.4\"" : " stroke-width=\"1\"");
      canvas.words({x + 8, top + 17}, Anchor::start, descriptor.info.title, Colour::text,
                   " font-weight=\"600\"");
      double y = top + 34;
      for (const std::string& line : lines_of(block, model.output_unit)) {
        canvas.words({x + 8, y}, Anchor::start, line);
        y += number_line_px;
      }
      arrow(canvas, i == first ? 2 : x - gap_px, x, top + height / 2);
      if (i + 1 == last && last == model.blocks.size())
        arrow(canvas, x + box_px, std::min(x + box_px + gap_px - 6, width_px - 2.0), top + height / 2);
      for (std::size_t v = 0; v < block.values.size(); ++v)
        drawing.rows.push_back(
            {station, std::string(descriptor.info.title), descriptor.name(v), shortest(block.values[v]),
             model::in_unit(descriptor.spec(v).unit, model.output_unit), added ? "yes" : "no"});
    }
    top += height + 30;
  }
  drawing.markup = canvas.markup();
  drawing.width = width_px;
  drawing.height = static_cast<int>(top) - 14;
  return {"block diagram",
          model.name + ": blocks and parameters from the commanded pressure (left) to the reading (right)." +
              (any_added ? " Green: block that the given model lacks." : ""),
          {},
          std::move(drawing)};
}

}  // namespace softgrip::sysid
