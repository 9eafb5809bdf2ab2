#pragma once
// Writes metrics in the text format of Prometheus, version 0.0.4.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softgrip::web {

using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

/// Writes metric families, each with its samples. A sample whose value is not finite is omitted, because the
/// quantity is unknown.
class MetricText {
 public:
  enum class Type : unsigned char { gauge, counter, summary };

  /// Begins a metric family. The name of a counter must end with `_total`.
  void family(std::string_view name, Type type, std::string_view help);
  /// Adds a sample to the family that was begun last. For a summary, `suffix` is "_sum" or "_count".
  void sample(const Labels& labels, double value, std::string_view suffix = {});
  void sample(double value) { sample({}, value); }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
  std::string name_;
};

}  // namespace softgrip::web
