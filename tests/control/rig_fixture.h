#pragma once
// Simulates a rig for tests: two fingers of the model bench_twin, a board without delay, an optional stone
// between the fingers, and the faults that the tests inject.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "control/tick/rig_controller.h"
#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "model/chain.h"
#include "tests/control/settings_fixture.h"

namespace softgrip::control {

/// Simulates fingers and board in virtual time, together with the controller of the rig.
class SimulatedRig {
 public:
  /// Creates the rig. `truth` is the model of the simulated fingers. The controller uses the models in the
  /// settings, which may differ from `truth`.
  explicit SimulatedRig(const RigSettings& settings, std::uint64_t seed = 1,
                        const model::Model& truth = twin());

  /// Places a stone at `position_mm`, which stops both fingers. With nullopt, removes the stone at the speed
  /// at which a person pulls it out by hand.
  void stone(std::optional<double> position_mm);
  bool stone_only_left = false;  ///< true: the stone stops only the left finger
  double yields = 0.1;           ///< motion of the finger after contact with the stone, as a fraction of its
                                 ///< free motion

  // The injected faults and the behaviour of the board. Each value except overrun_cycles remains until the
  // test changes it.
  bool wire_cut = false;    ///< true: no exchange succeeds, so the watchdog of the board trips
  bool board_vents = true;  ///< true: a watchdog trip of the board sets the outputs to the rest pressures
  bool bus_quiet = false;   ///< true: the bus thread has sent no report since the last tick
  bool emergency_stop = false;
  bool inputs_lost = false;
  bool interlock_open = false;
  std::uint32_t overrun_cycles = 0;  ///< number of overrun cycles to report in the next tick; after this
                                     ///< tick, it is 0
  FaultCode bus_fault = FaultCode::none;
  std::vector<double> outputs_kpa;  ///< outputs that the bus thread reports [kPa]; empty: it reports no
                                    ///< outputs
  struct OfChannel {
    std::optional<model::Validity> validity;  ///< validity that the driver reports; nullopt: the validity of
                                              ///< the simulated sensor
    double offset_mm = 0;                     ///< value to add to the reading of the sensor [mm]
    std::optional<double> frozen_mm;          ///< constant reading of a frozen sensor [mm]; nullopt: the
                                              ///< sensor is not frozen
    double readback_offset_kpa = 0;
    double pressure_offset_kpa = 0;
    bool no_pressure = false;  ///< true: the pressure reading is missing (NaN)
  };
  std::array<OfChannel, 2> fault;

  /// Called immediately before every RigController::tick with `begins` = true, and immediately after the tick
  /// with `begins` = false.
  void (*around_tick)(bool begins) = [](bool) {};

  /// Sends a request of this kind in the next tick. The function assigns the next request number.
  void request(Request::Kind kind, const PreparedSequence* sequence = nullptr);
  /// Sends this request in the next tick. The request keeps its number.
  void request(const Request& request) { request_ = request; }
  /// Simulates a pause of the whole control process for this duration.
  void pause(double seconds) { now_ += static_cast<Nanoseconds>(std::llround(seconds * 1e9)); }
  /// Runs one control period and checks all invariants of the commands.
  const TickOutput& tick();
  void run(double seconds);
  /// Runs ticks until the rig is in this state, for at most `seconds`. Returns true if the rig has reached
  /// the state.
  bool run_until(State state, double seconds);
  /// Runs ticks until the sequence is in the step with this index, for at most `seconds`. Returns true if the
  /// sequence has reached the step.
  bool run_until_step(std::uint16_t step, double seconds);
  /// Waits until the rig is idle and starts the sequence. Returns true if the sequence runs.
  bool start(const PreparedSequence& sequence);
  /// Waits until the rig is idle and starts the sequence. Then runs ticks until the sequence is in the step
  /// with this index.
  bool start_until_step(const PreparedSequence& sequence, std::uint16_t step, double seconds = 20);

  [[nodiscard]] const TickOutput& output() const { return output_; }
  [[nodiscard]] double time_s() const { return static_cast<double>(now_) * 1e-9; }
  [[nodiscard]] double plant_mm(std::size_t channel) const { return plants_[channel].true_mm; }
  [[nodiscard]] double board_kpa(std::size_t channel) const { return plants_[channel].board_kpa; }
  [[nodiscard]] GripResult result(std::size_t channel) const { return output_.channels[channel].result; }
  [[nodiscard]] std::uint32_t last_request() const { return next_request_ - 1; }

  /// All events since the creation of the rig.
  std::vector<Event> events;
  [[nodiscard]] std::size_t count(Event::Kind kind) const;
  /// Returns the last event of this kind that refers to the last request. Returns nullopt if no such event
  /// exists.
  [[nodiscard]] std::optional<Event> answer(Event::Kind kind) const;

 private:
  struct Plant {
    model::Chain<double> chain;
    double board_kpa = 0;
    double true_mm = 0;
  };
  void step_plants();
  void read();
  void check_commands(const TickOutput& before);

  RigSettings settings_;
  RigController controller_;
  std::vector<Plant> plants_;
  std::vector<model::Reading> readings_;
  std::mt19937_64 random_;
  std::optional<double> stone_mm_;
  bool pulling_out_ = false;
  Nanoseconds now_ = 1'000'000'000;
  double silent_s_ = 0;
  std::uint32_t failures_ = 0;
  std::uint32_t next_request_ = 1;
  Request request_;
  TickOutput output_;
  bool first_ = true;
};

}  // namespace softgrip::control
