#pragma once
// Writes the Prometheus metrics of the daemon, its channels, its events and the health of its fingers.
// docs/reference/metrics.md lists the metrics. Their names and units are part of the public format.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::web {

using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

/// Writes metric families with their samples. A sample is omitted if its value is not finite, because its
/// quantity is unknown.
class MetricText {
 public:
  enum class Type : unsigned char { gauge, counter, summary };

  /// Begins a metric family. The name of a counter must end with `_total`.
  void family(std::string_view name, Type type, std::string_view help);
  /// Adds a sample to the family that family() has begun last. For a summary, `suffix` is "_sum" or "_count".
  void sample(const Labels& labels, double value, std::string_view suffix = {});
  void sample(double value) { sample({}, value); }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
  std::string name_;
};

/// Writes the metrics of the daemon. `status` is a status of the socket API; null if the daemon does not
/// respond. If `status` is null, the metric `softgrip_up` with the value 0 is the only output. `statistics`
/// is the statistics object of the socket API; null if it has not been received.
void add_daemon_metrics(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                        MetricText& metrics);

/// Writes the metrics of each finger. `channels` is the list in a status of the socket API.
void add_channel_metrics(const nlohmann::ordered_json& channels, MetricText& metrics);

/// Writes the numbers of events. `events` is a member of the statistics of the socket API, and `channels` is
/// a member of its status. Every possible result of each finger has a sample, even if the result has not
/// occurred: Prometheus cannot compute an increase from the first sample of a series.
void add_event_metrics(const nlohmann::ordered_json& events, const nlohmann::ordered_json& channels,
                       MetricText& metrics);

/// Writes the metrics of a health result. `health` is the content of health.json. If it is null, writes
/// nothing.
void add_health_metrics(const nlohmann::ordered_json& health, MetricText& metrics);

}  // namespace softgrip::web
