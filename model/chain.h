#pragma once
// Simulates a model. In each step, the signal passes through the blocks of the model, from the command to the
// reading.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "base/random.h"
#include "model/catalogue.h"
#include "model/model.h"
#include "model/registry.h"
#include "model/segment.h"

namespace softgrip::model {

/// A chain of blocks over the number type T. The constructor allocates memory; reset(), step() and peek() do
/// not. Exception: step() may allocate memory if sample_time_s is 0 (for irregular logs) or much longer than
/// the steps, because the delay line of a transport delay may then grow.
///
/// The command is piecewise linear: step(dt, u) moves the command linearly from its last value to `u` over
/// `dt`. For a board that holds its output, call step(0, u) and then step(dt, u). Accuracy:
///
/// - With a piecewise linear input, Bouc-Wen (exponent 1), Kelvin-Voigt, delay and lag are exact for any dt.
/// - After a lag, Bouc-Wen receives the exact turning points, and Kelvin-Voigt receives a parabola with the
///   exact mean. If the command does not jump, the error of the displacement is below 1e-6 mm for dt up to
///   the time constant of the lag, and below 1e-8 mm for dt up to a tenth of this time constant.
/// - Inertia and sensor lag receive one parabola for each part of a step with a pressure change of at most 5
///   kPa. Example: for an inertia with a period of 45 ms and a rise of 44 kPa within 10 ms, the error is
///   about 1e-4 mm.
template <class T>
class Chain {
 public:
  /// @param model  a valid model, for which validate(model) is empty.
  /// @param values  all parameters of all blocks, in the order of flat_values(model). Empty: the values in
  /// `model` are used.
  /// @param sample_time_s  nominal sample time for precomputed coefficients [s]; 0 if the sample time is
  /// irregular. A duration whose relative difference from the sample time is at most 1e-9 is replaced by the
  /// sample time.
  /// @param seed  seed of the random numbers of the sensor blocks. Equal seeds give equal noise.
  explicit Chain(const Model& model, std::span<const T> values = {}, double sample_time_s = 0,
                 std::uint64_t seed = 0);
  // chain_walk.h defines these functions. If the compiler generated them, each file that contains a chain
  // would compile them for all types of blocks.
  Chain(const Chain& other);
  Chain(Chain&& other) noexcept;
  Chain& operator=(const Chain& other);
  Chain& operator=(Chain&& other) noexcept;
  ~Chain();

  /// Sets the state of rest after the command rose from 0 to `command` once and was then held for a long time
  /// (see block.h).
  void reset(const T& command);

  /// Sets the state of rest as reset() does, with one difference: blocks with a memory over the measurement
  /// campaign, such as the largest load so far, keep this memory. Call rest() at the start of a log that was
  /// recorded on the same rig after a pause.
  void rest(const T& command);

  /// Simulates a step of `duration_s` [s], >= 0, in which the command changes linearly to `command`. Returns
  /// the reading [mm].
  T step(const T& duration_s, const T& command, Surroundings surroundings = {});

  /// Predicts the displacement before the sensor, for a pressure that changes linearly to `end_kpa` over
  /// `duration_s`. The signal passes only through the blocks with Inverse::implicit, and the state does not
  /// change. The result is exact, except if the pressure has a corner within the sample, for example at a
  /// threshold. In this case, the result is approximate. To invert a model, create a chain that contains only
  /// the blocks with Inverse::implicit. In each step, find the pressure for which peek() returns the
  /// reference, and call step() with this pressure. U is T, or Dual<T> for the derivative with respect to the
  /// pressure.
  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, Surroundings surroundings = {}) const;

  /// Returns the output of a station at the end of the last step. The output of Station::valve is the
  /// pressure at the actuator [kPa]. The output of every other station is a displacement [mm]. If a station
  /// has no blocks, its output is its input.
  [[nodiscard]] const T& after(Station station) const { return after_[static_cast<std::size_t>(station)]; }
  [[nodiscard]] const T& reading_mm() const { return after(Station::sensor); }
  [[nodiscard]] const T& pressure_kpa() const { return after(Station::valve); }
  /// Returns the command of the last step [kPa].
  [[nodiscard]] const T& command_kpa() const { return command_kpa_; }

  [[nodiscard]] std::size_t size() const noexcept { return blocks_.size(); }
  /// Returns the block with this index. The feedforward needs this function, because the feedforward inverts
  /// each block separately.
  [[nodiscard]] const AnyBlock<T>& block(std::size_t index) const { return blocks_[index]; }
  /// Returns the block with this index, which the caller may change. A simulation uses this function to
  /// change a block over time, for example a contact.
  [[nodiscard]] AnyBlock<T>& block(std::size_t index) { return blocks_[index]; }
  /// Returns the first block of the type Block (BoucWen<T>, ...); nullptr if the chain has no block of this
  /// type.
  template <class Block>
  [[nodiscard]] const Block* find() const noexcept {
    for (const AnyBlock<T>& block : blocks_) {
      if (const Block* found = std::get_if<Block>(&block)) return found;
    }
    return nullptr;
  }

 private:
  using Index = std::size_t;

  template <bool campaign_goes_on>
  void settle(const T& command);
  void walk_pressure(Index i, const Segment<T>& segment, const Surroundings& surroundings);
  void walk_elements(const Segment<T>& segment, const Surroundings& surroundings);
  void add_elements(const Segment<T>& segment, const Surroundings& surroundings);
  void walk_displacement(Index i, const Segment<T>& segment, const Surroundings& surroundings);
  void walk_readings(const T& duration_s, const Surroundings& surroundings);
  // Stores `value`, the signal before block i, as the output of each station whose last block precedes block
  // i.
  void note_displacement(Index i, const T& value) {
    if (i == end_[1]) after_[1] = value;
    if (i == end_[2]) after_[2] = value;
    if (i == first_reading_) at_sensor_ = value;
  }

  std::vector<AnyBlock<T>> blocks_;
  std::array<Index, 4> end_{};  // for each station: index of the first block behind the station
  Index first_element_ = 0, first_displacement_ = 0, first_reading_ = 0;
  bool leaps_in_parts_ = false;  // true: large pressure changes are divided, see longest_way_kpa
  double sample_time_s_;
  double clock_s_ = 0;  // sum of the step durations since reset()
  T command_kpa_{0.0};
  T at_sensor_{0.0};  // input of the reading blocks (blocks of the sensor)
  std::array<T, 4> after_{T(0.0), T(0.0), T(0.0), T(0.0)};
};

extern template class Chain<double>;

}  // namespace softgrip::model
