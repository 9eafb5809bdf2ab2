#pragma once
// Emulates a rig: board, fingers and faults. The class Emulator has no sockets and no clock. The caller
// passes each request together with its time of arrival.

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/emulator/emulated_board.h"
#include "simulation/emulator/fault_schedule.h"
#include "simulation/emulator/finger.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {

/// One module of the board, with its unit id and its link.
struct EmulatedModule {
  drivers::BoardMap map;
  std::uint8_t unit = 1;
  std::size_t link = 0;  ///< index of the link that leads to the module
};

struct EmulatorSettings {
  /// Modules of the board. A request to a unit id that no module has gets exception 11 on a network, and no
  /// reply on a serial line.
  std::vector<EmulatedModule> modules;
  Wire wire = Wire::tcp;
  std::vector<drivers::ChannelWiring> wiring;
  std::vector<simulation::PlantSettings> plants;  ///< settings of the simulated fingers, one entry per
                                                  ///< channel
  std::vector<FaultSpec> faults;
};

class Emulator {
 public:
  /// Longest time step of the simulated fingers [ns]. A time step ends at each multiple of this value, at
  /// each request, and at each start or end of a fault.
  static constexpr Nanoseconds grid = 1'000'000;
  /// Name of a fault that always exists. While this fault is active, the object is removed.
  static constexpr std::string_view object_out = "object_out";

  /// Creates the rig at the time 0.
  explicit Emulator(EmulatorSettings settings);

  /// Advances the rig to the time `now`, which must not decrease from call to call.
  void advance(Nanoseconds now);
  /// Processes a request that arrives on a link at `now`, over a connection that was opened at `opened_at`.
  /// Returns the reply, or an empty reply if the board does not respond.
  [[nodiscard]] Reply serve(Nanoseconds now, const Request& request, std::size_t link = 0,
                            Nanoseconds opened_at = 0);
  /// Sets the number of clients that are connected to a link.
  void count_clients(std::size_t clients, std::size_t link);
  /// Returns true if the emulator accepts new connections.
  [[nodiscard]] bool reachable() const { return !faults_.first_active(FaultKind::disconnect); }

  /// trigger() begins a fault, and clear() ends it. Both return false if no fault has this name.
  bool trigger(std::string_view name, Nanoseconds now);
  bool clear(std::string_view name, Nanoseconds now);
  /// Puts an object between the fingers of all channels. If `object` is empty, removes the object.
  void set_object(const std::optional<simulation::PlantObject>& object);

  /// Sets a function that is called at each multiple of the time `grid`.
  void on_grid(std::function<void()> observer) { observer_ = std::move(observer); }

  [[nodiscard]] Wire wire() const noexcept { return wire_; }
  [[nodiscard]] Nanoseconds now() const noexcept { return now_; }
  [[nodiscard]] const std::vector<Finger>& fingers() const noexcept { return fingers_; }
  [[nodiscard]] const std::vector<EmulatedBoard>& modules() const noexcept { return boards_; }
  /// Returns true if a client has written an output since the rig was created.
  [[nodiscard]] bool commanded() const noexcept;
  /// Returns true while the watchdog of at least one module holds the outputs of this module.
  [[nodiscard]] bool tripped() const noexcept;
  [[nodiscard]] const FaultSchedule& faults() const noexcept { return faults_; }
  [[nodiscard]] std::uint64_t requests() const noexcept { return requests_; }
  [[nodiscard]] std::uint64_t watchdog_trips() const noexcept { return watchdog_trips_; }

 private:
  [[nodiscard]] Nanoseconds next_stop(Nanoseconds now) const;
  [[nodiscard]] std::optional<std::size_t> wire_fault(const Request& request,
                                                      Nanoseconds connected_for) const;
  void move_to(Nanoseconds moment);
  void take_commands();
  void apply_faults();
  void apply_faults(std::size_t channel);

  struct Place {
    std::uint8_t unit;
    std::size_t link;
  };
  [[nodiscard]] EmulatedBoard* board_at(std::size_t link, std::uint8_t unit) noexcept;

  std::vector<EmulatedBoard> boards_;
  std::vector<Place> places_;  // unit id and link of each board
  Wire wire_;
  std::vector<Finger> fingers_;
  FaultSchedule faults_;
  std::function<void()> observer_;
  Nanoseconds now_ = 0;
  std::uint64_t requests_ = 0;
  std::uint64_t watchdog_trips_ = 0;
};

/// Writes the true state of the emulated rig to a log. The log has a row per channel, with the name of the
/// channel in the column `channel`:
///
///   time_s,channel,pressure_command_kpa,displacement_mm,pressure_kpa,reading_mm,object,watchdog_tripped
///
/// displacement_mm and pressure_kpa are true values without noise. reading_mm is the sensor reading; its cell
/// is empty if there is no valid reading.
class TruthLog {
 public:
  /// Creates the log file. Only every `decimation`-th call of add() writes rows: one row per channel.
  TruthLog(const std::string& path, std::uint32_t decimation);

  void add(const Emulator& emulator);
  /// Writes all rows in the buffer to the file.
  void flush() { file_.flush(); }
  /// Returns false if a write has failed.
  [[nodiscard]] bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
  std::string row_;
  std::uint32_t decimation_;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::simulation
