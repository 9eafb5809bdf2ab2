#pragma once
// Determines which faults are active at a time. A fault begins at its scheduled time, or when a control
// command triggers it. A fault ends after its duration, or when a control command clears it.

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "model/reading.h"
#include "simulation/emulator/fault.h"

namespace softgrip::simulation {

class FaultSchedule {
 public:
  explicit FaultSchedule(std::vector<FaultSpec> faults);

  /// Sets the time from which the key at_s of the faults is measured. Only the first call has an effect.
  void start(Nanoseconds now);
  [[nodiscard]] bool started() const noexcept { return started_at_.has_value(); }
  /// Begins and ends the faults whose scheduled times are at or before `now`. Returns true if a fault began
  /// or ended.
  bool advance(Nanoseconds now);
  /// Returns the next scheduled time at which a fault begins or ends.
  [[nodiscard]] std::optional<Nanoseconds> next_change() const;

  /// Begins a fault at `now`, independent of the key at_s of this fault. Returns false if no fault has the
  /// name `name`.
  bool trigger(std::string_view name, Nanoseconds now);
  /// Ends a fault. After clear(), only trigger() can begin the fault. Returns false if no fault has the name
  /// `name`.
  bool clear(std::string_view name);

  /// Counts a reply that a fault of the transmission has changed or suppressed. The fault ends after
  /// FaultSpec::replies of these replies.
  void count_reply(std::size_t index);

  [[nodiscard]] const std::vector<FaultSpec>& faults() const noexcept { return faults_; }
  [[nodiscard]] bool active(std::size_t index) const { return states_[index].active; }
  /// Returns the time at which an active fault began.
  [[nodiscard]] Nanoseconds since(std::size_t index) const { return states_[index].since; }
  /// Returns the index of the first active fault of this kind; nullopt if no fault of this kind is active.
  [[nodiscard]] std::optional<std::size_t> first_active(FaultKind kind) const;

 private:
  struct State {
    bool active = false;
    bool spent = false;  ///< true: the scheduled start of the fault has passed or was cancelled, so only
                         ///< trigger() can begin the fault
    Nanoseconds since = 0;
    std::uint32_t replies = 0;
  };

  void begin(std::size_t index, Nanoseconds now);
  [[nodiscard]] std::optional<Nanoseconds> begins_at(std::size_t index) const;
  [[nodiscard]] std::optional<Nanoseconds> ends_at(std::size_t index) const;
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

  std::vector<FaultSpec> faults_;
  std::vector<State> states_;
  std::optional<Nanoseconds> started_at_;
};

}  // namespace softgrip::simulation
