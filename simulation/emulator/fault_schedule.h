#pragma once
// Which faults are there at a moment: by the clock, by trigger, until their end.

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

  /// The moment from which at_s counts. Only the first call counts.
  void start(Nanoseconds now);
  [[nodiscard]] bool started() const noexcept { return started_at_.has_value(); }
  /// Begins and ends what is due by `now`. True if something changed.
  bool advance(Nanoseconds now);
  /// The next moment at which something begins or ends by the clock.
  [[nodiscard]] std::optional<Nanoseconds> next_change() const;

  /// Begins a fault now, whatever its at_s. False: there is none of that name.
  bool trigger(std::string_view name, Nanoseconds now);
  /// Ends a fault, for good unless triggered again. False: there is none of that name.
  bool clear(std::string_view name);

  /// A fault of the wire that touched a reply counts it, and ends with its last one.
  void count_reply(std::size_t index);

  [[nodiscard]] const std::vector<FaultSpec>& faults() const noexcept { return faults_; }
  [[nodiscard]] bool active(std::size_t index) const { return states_[index].active; }
  /// When the active fault began.
  [[nodiscard]] Nanoseconds since(std::size_t index) const { return states_[index].since; }
  /// The first active fault of this kind, or nothing.
  [[nodiscard]] std::optional<std::size_t> first_active(FaultKind kind) const;

 private:
  struct State {
    bool active = false;
    bool spent = false;  ///< its at_s was used
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
