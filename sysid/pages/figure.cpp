#include "sysid/pages/figure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/numbers.h"
#include "base/result/table.h"
#include "sysid/logs/csv_text.h"
#include "sysid/pages/palette.h"

namespace softgrip::sysid {
namespace {

/// A column of the CSV file of a figure.
struct Column {
  std::string name;
  const std::vector<double>* values;
  const std::vector<std::string>* categories = nullptr;
};

std::string cell(const Column& column, std::size_t row) {
  if (row >= column.values->size()) return {};
  const double value = (*column.values)[row];
  if (!std::isfinite(value)) return {};
  if (column.categories != nullptr && !column.categories->empty()) {
    const double nearest = std::round(value);
    if (nearest == value && value >= 0 && value < static_cast<double>(column.categories->size()))
      return as_cell((*column.categories)[static_cast<std::size_t>(value)]);
  }
  return shortest(value);
}

std::string joined(const std::string& before, const std::string& label) {
  return before.empty() ? label : label.empty() ? before : before + ": " + label;
}

std::vector<Column> columns_of(const ChartRows& rows) {
  std::vector<Column> columns;
  const std::vector<double>* last_x = nullptr;
  for (const auto& row : rows) {
    for (const Chart& chart : row) {
      // If charts are stacked, only the lowest chart has a label on its x axis. In the CSV file, the x
      // columns of all charts use this label.
      const std::string& x_label = chart.x.label.empty() ? rows.back().front().x.label : chart.x.label;
      for (const Series& s : chart.series) {
        if (last_x == nullptr || *last_x != s.x) columns.push_back({x_label, &s.x, &chart.x.categories});
        last_x = &s.x;
        const std::string name = joined(joined(chart.title, s.label), chart.y.label);
        columns.push_back({name, &s.y, &chart.y.categories});
        if (s.style == Series::Style::band) columns.push_back({name + ", upper", &s.y_upper});
      }
    }
  }
  return columns;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i == 0 ? "" : ",") + as_cell(cells[i]);
  return line + '\n';
}

std::string svg(const Figure& figure, std::string_view style) {
  const Drawing* drawing = figure.drawing ? &*figure.drawing : nullptr;
  const Extent size = drawing != nullptr ? Extent{drawing->width, drawing->height} : extent_of(figure.charts);
  const std::string box = std::to_string(size.width) + ' ' + std::to_string(size.height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + box + "\" width=\"" +
         std::to_string(size.width) + "\" height=\"" + std::to_string(size.height) +
         "\" role=\"img\" aria-label=\"" + result::escaped(figure.name.empty() ? "chart" : figure.name) +
         "\" font-family=\"system-ui,sans-serif\" font-size=\"11\">" + std::string(style) +
         "<rect width=\"100%\" height=\"100%\"" + filled(Colour::paper) +
         "/><g fill=\"none\" stroke-linejoin=\"round\">" +
         (drawing != nullptr ? drawing->markup : markup_of(figure.charts)) + "</g></svg>\n";
}

}  // namespace

std::string svg_of(const Figure& figure) {
  return svg(figure, "");
}

std::string svg_file_of(const Figure& figure) {
  return svg(figure, "<style>" + scheme_css("svg") + "</style>");
}

std::string csv_of(const Figure& figure) {
  if (figure.drawing) {
    std::string text = line_of(figure.drawing->header);
    for (const auto& row : figure.drawing->rows) text += line_of(row);
    return text;
  }
  const std::vector<Column> columns = columns_of(figure.charts);
  std::vector<std::string> header;
  std::size_t rows = 0;
  for (const Column& column : columns) {
    header.push_back(column.name);
    rows = std::max(rows, column.values->size());
  }
  std::string text = line_of(header);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i == 0 ? "" : ",") + cell(columns[i], row);
    text += '\n';
  }
  return text;
}

}  // namespace softgrip::sysid
