#include "base/enum_table.h"
#include "tools/web/metrics/metrics.h"

#include <cmath>

#include "base/numbers.h"

namespace softgrip::web {

namespace {

/// Escapes backslash, quote and line break for a label.
std::string escaped(std::string_view value) {
  std::string text;
  for (const char character : value) {
    if (character == '\\' || character == '"') text += '\\';
    if (character == '\n') {
      text += "\\n";
    } else {
      text += character;
    }
  }
  return text;
}

}  // namespace

void MetricText::family(std::string_view name, Type type, std::string_view help) {
  static constexpr auto types =
      enum_names<Type>({{Type::gauge, "gauge"}, {Type::counter, "counter"}, {Type::summary, "summary"}});
  name_ = name;
  text_.append("# HELP ").append(name).append(" ").append(help).append("\n# TYPE ").append(name).append(" ");
  text_.append(types[type]).append("\n");
}

void MetricText::sample(const Labels& labels, double value, std::string_view suffix) {
  if (!std::isfinite(value)) return;
  text_.append(name_).append(suffix);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    text_.append(i == 0 ? "{" : ",").append(labels[i].first).append("=\"");
    text_.append(escaped(labels[i].second)).append("\"");
  }
  text_.append(labels.empty() ? " " : "} ").append(written(value)).append("\n");
}

}  // namespace softgrip::web
