#pragma once
// Determines which faults are active at a time. A fault begins at its scheduled time, or when it is
// triggered. It ends after its duration, or by a control command.

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

  /// Sets the time that counts as 0 for at_s. Only the first call has an effect.
  void start(Nanoseconds now);
  [[nodiscard]] bool started() const noexcept { return started_at_.has_value(); }
  /// Begins and ends all faults that are due at or before `now`. Returns true if a fault began or ended.
  bool advance(Nanoseconds now);
  /// Returns the next scheduled time at which a fault begins or ends.
  [[nodiscard]] std::optional<Nanoseconds> next_change() const;

  /// Begins a fault now, independent of its at_s. Returns false if no fault has this name.
  bool trigger(std::string_view name, Nanoseconds now);
  /// Ends a fault. After that, only trigger() can begin it. Returns false if no fault has this name.
  bool clear(std::string_view name);

  /// Counts a reply that was affected by a fault of the transmission. The fault ends after FaultSpec::replies
  /// such replies.
  void count_reply(std::size_t index);

  [[nodiscard]] const std::vector<FaultSpec>& faults() const noexcept { return faults_; }
  [[nodiscard]] bool active(std::size_t index) const { return states_[index].active; }
  /// Returns the time at which an active fault began.
  [[nodiscard]] Nanoseconds since(std::size_t index) const { return states_[index].since; }
  /// Returns the index of the first active fault of this kind; nullopt if none is active.
  [[nodiscard]] std::optional<std::size_t> first_active(FaultKind kind) const;

 private:
  struct State {
    bool active = false;
    bool spent = false;  ///< true: the scheduled start of the fault has passed, or was cancelled
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
