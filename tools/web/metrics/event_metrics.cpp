#include "tools/web/metrics/metrics.h"

#include <map>

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using enum MetricText::Type;

/// Converts a title to a label: "PART LOST" becomes "part_lost".
std::string label_of(std::string_view title) {
  std::string label;
  for (const char character : title) {
    label += character == ' '
                 ? '_'
                 : static_cast<char>(character >= 'A' && character <= 'Z' ? character + 32 : character);
  }
  return label;
}

constexpr const char* results[] = {"HOLDING", "NO PART", "PART LOST", "RELEASED", "ERROR"};

/// Numbers of the events of one kind, by code and channel.
class Counts {
 public:
  Counts(const Json& events, std::string_view kind) : events_(events), kind_(kind) {}

  [[nodiscard]] double of(std::string_view code, std::string_view channel) const {
    double count = 0;
    for (const Json& event : events_) {
      if (json_text(event, "kind") == kind_ && json_text(event, "code") == code &&
          json_text(event, "channel") == channel)
        count += json_number(event, "count");
    }
    return count;
  }
  /// Returns the number of events per code, summed over the channels.
  [[nodiscard]] std::map<std::string, double> by_code() const {
    std::map<std::string, double> counts;
    for (const Json& event : events_) {
      if (json_text(event, "kind") == kind_) counts[json_text(event, "code")] += json_number(event, "count");
    }
    return counts;
  }

 private:
  const Json& events_;
  std::string_view kind_;
};

void add_grip_metrics(const Json& events, const Json& channels, MetricText& metrics) {
  const Counts grips(events, "grip_result");
  metrics.family("softgrip_grip_results_total", counter, "Number of grip results, by finger and result.");
  for (const Json& channel : channels) {
    const std::string name = json_text(channel, "name");
    for (const char* result : results)
      metrics.sample({{"channel", name}, {"result", label_of(result)}}, grips.of(result, name));
  }
  const Counts rigs(events, "overall_result");
  metrics.family("softgrip_results_total", counter,
                 "Number of overall results of all fingers of a sequence, by result.");
  for (const char* result : results) metrics.sample({{"result", label_of(result)}}, rigs.of(result, {}));
}

void add_counts_by_code(const Json& events, MetricText& metrics, const char* kind, const char* name,
                        const char* label, const char* help) {
  metrics.family(name, counter, help);
  for (const auto& [code, count] : Counts(events, kind).by_code()) metrics.sample({{label, code}}, count);
}

}  // namespace

void add_event_metrics(const Json& events, const Json& channels, MetricText& metrics) {
  if (!events.is_array()) return;
  add_grip_metrics(events, channels, metrics);
  const auto started = Counts(events, "sequence_started").by_code();
  metrics.family("softgrip_sequences_started_total", counter, "Number of sequences that were started.");
  metrics.sample(started.empty() ? 0 : started.begin()->second);
  metrics.family("softgrip_sequences_ended_total", counter, "Number of sequences that ended, by outcome.");
  for (const char* end : {"done", "failed", "stopped", "faulted"})
    metrics.sample({{"end", end}}, Counts(events, "sequence_finished").of(end, {}));
  add_counts_by_code(events, metrics, "fault_latched", "softgrip_faults_total", "code",
                     "Number of faults that were latched, by code.");
  add_counts_by_code(events, metrics, "request_refused", "softgrip_requests_refused_total", "code",
                     "Number of refused requests, by reason.");
  add_counts_by_code(events, metrics, "bus_failed", "softgrip_bus_failures_total", "cause",
                     "Number of losses of communication with the board, by cause.");
  add_counts_by_code(events, metrics, "reading_invalid", "softgrip_readings_invalid_total", "validity",
                     "Number of times that a reading became invalid, by reason.");
}

}  // namespace softgrip::web
