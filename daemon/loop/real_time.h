#pragma once
// Requests real-time settings from the operating system and verifies each setting by reading its value.

#include <string>
#include <string_view>
#include <vector>

#include "rig/daemon_settings.h"

namespace softgrip::daemon {

/// A requested real-time setting and its result.
struct RealTimeStep {
  enum class Outcome { verified, failed, not_requested };
  std::string name;
  Outcome outcome = Outcome::not_requested;
  std::string detail;  ///< value of the setting that was read back; after a failure, the reason of the
                       ///< failure and the usual remedy
  std::string cost;    ///< consequence for the daemon if the setting failed, in one sentence
};
/// Returns "verified", "failed" or "not_requested".
[[nodiscard]] std::string_view name_of(RealTimeStep::Outcome outcome) noexcept;

/// The results of all real-time settings of one thread, or of the whole process.
class RealTimeReport {
 public:
  void add(RealTimeStep step) { steps_.push_back(std::move(step)); }
  void append(const RealTimeReport& other);
  [[nodiscard]] const std::vector<RealTimeStep>& steps() const noexcept { return steps_; }
  /// Returns true if a setting was requested but could not be verified.
  [[nodiscard]] bool degraded() const noexcept;
  /// Returns one line per setting. For a failed setting, adds a second line with the consequence of the
  /// failure.
  [[nodiscard]] std::string format() const;

 private:
  std::vector<RealTimeStep> steps_;
};

/// Request to the kernel to keep the processors out of deep sleep states. The request applies while this
/// object exists.
class ProcessorLatencyRequest {
 public:
  ProcessorLatencyRequest() = default;
  explicit ProcessorLatencyRequest(int descriptor) noexcept : descriptor_(descriptor) {}
  ProcessorLatencyRequest(const ProcessorLatencyRequest&) = delete;
  ProcessorLatencyRequest& operator=(const ProcessorLatencyRequest&) = delete;
  ProcessorLatencyRequest(ProcessorLatencyRequest&& other) noexcept;
  ProcessorLatencyRequest& operator=(ProcessorLatencyRequest&& other) noexcept;
  ~ProcessorLatencyRequest();

 private:
  int descriptor_ = -1;
};

/// Prepares the process before its threads start: heap, memory lock and processor latency.
[[nodiscard]] ProcessorLatencyRequest prepare_process(const rig::RealTimeSettings& settings,
                                                      RealTimeReport& report);

/// Prepares the calling thread: its set of processors, its scheduling with `priority`, and its stack. `who`
/// is the name of the thread in the report.
void prepare_thread(const rig::RealTimeSettings& settings, int priority, std::string_view who,
                    RealTimeReport& report);

/// Returns an entry that states if the running kernel is a PREEMPT_RT kernel. This entry never counts as a
/// failure.
[[nodiscard]] RealTimeStep kernel_step();

}  // namespace softgrip::daemon
