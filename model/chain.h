#pragma once
// Simulates a model. Each step passes the signal through the blocks of a Model, from the command to the
// reading.

#include <array>
#include <cmath>
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

/// A chain of blocks over the number type T. Construction allocates memory; reset(), step() and peek() do
/// not. Exceptions are a chain with sample_time_s = 0 (for irregular logs) and a chain whose steps are much
/// shorter than sample_time_s, because the delay line of such a chain may grow.
///
/// The command is piecewise linear: step(dt, u) moves it linearly from its last value to `u` over `dt`. An
/// output that a board holds is step(0, u) followed by step(dt, u). For such commands, Bouc-Wen (exponent 1),
/// Kelvin-Voigt, delay and lag are exact for any dt. After a lag, Bouc-Wen receives the exact turning points
/// and Kelvin-Voigt receives a parabola with the exact mean. The error is below 1e-6 mm if dt is at most the
/// time constant of the lag and the command does not jump, and below 1e-8 mm for a tenth of that dt. After
/// the elements, inertia and sensor lag receive parabolas for at most 5 kPa each. The error of these two
/// blocks is 1e-4 mm after a step of 44 kPa within a sample.
template <class T>
class Chain {
 public:
  /// @param model  must be valid: validate(model) is empty.
  /// @param values  all parameters of all blocks, in the order of flat_values(model). Empty: the values of
  /// the model.
  /// @param sample_time_s  nominal sample time for precomputed coefficients [s]; 0 if it is irregular. A
  /// duration that differs from the sample time by a relative 1e-9 or less is replaced by the sample time.
  /// @param seed  seed of the random numbers of the sensor blocks. Equal seeds give equal noise.
  explicit Chain(const Model& model, std::span<const T> values = {}, double sample_time_s = 0,
                 std::uint64_t seed = 0);

  /// Sets the state of rest that follows after the command rose from 0 to `command` once and was then held
  /// (see block.h).
  void reset(const T& command);

  /// Sets the state of rest as reset() does, but blocks with a memory over the campaign, such as the largest
  /// load so far, keep this memory. Use it for a new log of the same rig after a rest.
  void rest(const T& command);

  /// Advances by `duration_s` >= 0 while the command changes linearly to `command`. Returns the reading [mm].
  T step(const T& duration_s, const T& command, Surroundings surroundings = {});

  /// Predicts the displacement before the sensor for a pressure that changes linearly to `end_kpa` over
  /// `duration_s`. The signal passes only through the blocks with Inverse::implicit. The state does not
  /// change. The result is exact unless the pressure has a corner within the sample (at a threshold). To
  /// invert a model, construct a chain of only the implicit blocks, and step it with the pressure that solves
  /// peek() = reference. U is T, or Dual<T> for the derivative with respect to the pressure.
  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, Surroundings surroundings = {}) const;

  /// Returns the output of the given station at the end of the last step: for Station::valve the pressure at
  /// the actuator [kPa], for the other stations a displacement [mm]. The output of a station without blocks
  /// is its input.
  [[nodiscard]] const T& after(Station station) const { return after_[static_cast<std::size_t>(station)]; }
  [[nodiscard]] const T& reading_mm() const { return after(Station::sensor); }
  [[nodiscard]] const T& pressure_kpa() const { return after(Station::valve); }
  /// Returns the command of the last step [kPa].
  [[nodiscard]] const T& command_kpa() const { return command_kpa_; }

  [[nodiscard]] std::size_t size() const noexcept { return blocks_.size(); }
  /// Returns a block, for the feedforward, which inverts each block separately.
  [[nodiscard]] const AnyBlock<T>& block(std::size_t index) const { return blocks_[index]; }
  /// Returns a block, for a simulation that changes a block while it runs, for example a contact.
  [[nodiscard]] AnyBlock<T>& block(std::size_t index) { return blocks_[index]; }
  /// Returns the first block of type Block (BoucWen<T>, ...), or nullptr.
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
  // Stores the signal before block i as the output of each station whose last block precedes block i.
  void note_displacement(Index i, const T& value) {
    if (i == end_[1]) after_[1] = value;
    if (i == end_[2]) after_[2] = value;
    if (i == first_reading_) at_sensor_ = value;
  }

  std::vector<AnyBlock<T>> blocks_;
  std::array<Index, 4> end_{};  // for each station: index after its last block
  Index first_element_ = 0, first_displacement_ = 0, first_reading_ = 0;
  bool leaps_in_parts_ = false;  // divide large pressure changes, see longest_way_kpa
  double sample_time_s_;
  double clock_s_ = 0;  // sum of the durations since reset()
  T command_kpa_{0.0};
  T at_sensor_{0.0};  // input of the reading blocks
  std::array<T, 4> after_{T(0.0), T(0.0), T(0.0), T(0.0)};
};

extern template class Chain<double>;

}  // namespace softgrip::model

#include "model/chain_walk.h"  // IWYU pragma: keep
