#pragma once
// Simulates the surroundings of a program that drives a rig: board, line, fingers, a second Modbus client and
// the clock. Also contains the monitor that checks the invariants.

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/world/hardware.h"
#include "tests/world/incident.h"
#include "tests/world/monitor.h"
#include "tests/world/rig_shape.h"
#include "tests/world/scheduler.h"

namespace softgrip::world {

class Surroundings {
 public:
  /// Creates the surroundings of a rig. If `tracing` is true, all events are recorded as text.
  Surroundings(RigShape rig_shape, bool tracing);
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;
  Surroundings(Surroundings&&) = delete;
  Surroundings& operator=(Surroundings&&) = delete;
  ~Surroundings() = default;

  /// Adds a simulated thread that begins and ends each of these incidents at its time. The incidents must
  /// exist longer than this thread.
  void let_happen(const std::vector<Incident>& incidents,
                  std::function<void(const Incident& incident, bool begins)> carry_out);
  /// Begins or ends an incident that concerns the clock, the line, the board or the fingers.
  void carry_out(const Incident& incident, bool begins);
  [[nodiscard]] static bool concerns(Incident::Kind kind) noexcept {
    return kind == Incident::Kind::clock_stalls ||
           (kind >= Incident::Kind::line && kind <= Incident::Kind::part_gone);
  }
  /// Records a write that has reached the board. `outputs_kpa` are the outputs before the write.
  void note_write(std::span<const double> outputs_kpa, std::span<const double> commands_kpa);
  /// Called when a program starts, and when an unusual property of the board has made an exchange fail. The
  /// line counts as disturbed until the next write reaches the board.
  void nobody_spoke() noexcept { good_since_ = false; }
  /// Returns the disturbances that the line and the second Modbus client cause at this moment.
  [[nodiscard]] Excuse excuse() const noexcept;

  template <class... Values>
  void trace(fmt::format_string<Values...> text, Values&&... values) {
    if (!tracing) return;
    traced.push_back(fmt::format("{:9.4f} s  ", seconds(scheduler.now() - begin)) +
                     fmt::format(text, std::forward<Values>(values)...));
  }

  /// Called before a request of the program takes effect on the board.
  WorldBoard::OnWrite on_write = [](auto, auto) {};
  std::function<void()> on_exchange = [] {};
  std::function<void()> on_trip = [] {};
  std::function<void()> on_hindered = [] {};  ///< function to call when an unusual property of the board has
                                              ///< made an exchange fail

  RigShape shape;
  bool tracing;
  std::vector<std::string> traced;
  Scheduler scheduler;
  Nanoseconds begin;
  Line line;
  Hardware hardware;
  WorldBoard board;
  Monitor monitor;
  std::uint64_t fingerprint = 0;  ///< hash of all writes to the board and their times
  std::uint64_t writes = 0;
  std::uint64_t trips = 0;

 private:
  [[nodiscard]] HardwareSettings hardware_settings();
  void to_line(const Incident& incident, bool begins);
  void to_fingers(const Incident& incident, bool begins);
  void write_as_another(const Incident& incident);

  int hindered_ = 0;  // number of active incidents that disturb the Modbus line
  bool good_since_ = false;
  const Incident* foreign_ = nullptr;
};

}  // namespace softgrip::world
