#pragma once
// A model that steps: the blocks of a Model, walked once per sample from the command to the reading.

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

/// A stepping chain over the number type T. Construction allocates; reset(), step() and peek() do not (a
/// chain prepared with sample_time_s = 0, for irregular logs, may grow its delay line; so may one that is
/// stepped much finer than it was prepared for).
///
/// The command is piecewise linear: step(dt, u) takes it from where it was to `u` over `dt`. A held output
/// of a board is step(0, u) followed by step(dt, u). Within that convention Bouc-Wen (exponent 1),
/// Kelvin-Voigt, delay and lag are exact for any dt. Behind a lag Bouc-Wen sees the exact turning points and
/// Kelvin-Voigt the parabola with the exact mean: below 1e-6 mm while dt does not exceed the lag's time
/// constant and the command does not jump, below 1e-8 mm at a tenth of it. Behind the elements inertia and a
/// sensor's lag see parabolas, of at most 5 kPa each: 1e-4 mm behind a leap of 44 kPa within a sample.
template <class T>
class Chain {
 public:
  /// @param model  a valid one: validate(model) is empty.
  /// @param values  all parameters of all blocks, in the order of flat_values(model);
  ///                empty: the model's own numbers.
  /// @param sample_time_s  nominal sample time for precomputed coefficients, 0 when irregular. Durations
  ///                within 1e-9 of it count as it.
  /// @param seed  of the sensor's random numbers; the same seed gives the same noise.
  explicit Chain(const Model& model, std::span<const T> values = {}, double sample_time_s = 0,
                 std::uint64_t seed = 0);

  /// At rest: as if the command had risen from 0 to `command` once and been held ever since (see block.h).
  void reset(const T& command);

  /// Like reset(), but what runs through a campaign (the largest load so far) is kept: a new log of the same
  /// rig, which rested in between.
  void rest(const T& command);

  /// Moves on by `duration_s` >= 0 while the command goes linearly to `command`; returns the reading [mm].
  T step(const T& duration_s, const T& command, Surroundings surroundings = {});

  /// What after(Station::load) would be if the pressure at the actuator went straight to `end_kpa` over
  /// `duration_s`, through the blocks that are undone implicitly and past all others; nothing changes.
  /// Exact but for a corner of the pressure inside the sample (a threshold that is passed).
  /// For an inverse: step a chain of only those blocks with the pressure that solves peek() = reference.
  /// U is T, or Dual<T> for the derivative with respect to the pressure.
  template <class U>
  [[nodiscard]] U peek(const T& duration_s, const U& end_kpa, Surroundings surroundings = {}) const;

  /// The signal behind the last block of the given station after the last step: pressure at the actuator
  /// for Station::valve [kPa], displacement in mm for the others. Without blocks there: what came in.
  [[nodiscard]] const T& after(Station station) const { return after_[static_cast<std::size_t>(station)]; }
  [[nodiscard]] const T& reading_mm() const { return after(Station::sensor); }
  [[nodiscard]] const T& pressure_kpa() const { return after(Station::valve); }
  /// The command of the last step [kPa].
  [[nodiscard]] const T& command_kpa() const { return command_kpa_; }

  [[nodiscard]] std::size_t size() const noexcept { return blocks_.size(); }
  /// Access for the control side, which inverts block by block.
  [[nodiscard]] const AnyBlock<T>& block(std::size_t index) const { return blocks_[index]; }
  /// For a simulation whose surroundings change while it runs: another contact in the place of one.
  [[nodiscard]] AnyBlock<T>& block(std::size_t index) { return blocks_[index]; }
  /// The first block of type Block (BoucWen<T>, ...), or nullptr.
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
  // Notes the signal that leaves the stations which end before block i.
  void note_displacement(Index i, const T& value) {
    if (i == end_[1]) after_[1] = value;
    if (i == end_[2]) after_[2] = value;
    if (i == first_reading_) at_sensor_ = value;
  }

  std::vector<AnyBlock<T>> blocks_;
  std::array<Index, 4> end_{};  // of each station: the index behind its last block
  Index first_element_ = 0, first_displacement_ = 0, first_reading_ = 0;
  bool leaps_in_parts_ = false;  // see walk_elements()
  double sample_time_s_;
  double clock_s_ = 0;  // the durations since reset()
  T command_kpa_{0.0};
  T at_sensor_{0.0};  // what the reading blocks sample
  std::array<T, 4> after_{T(0.0), T(0.0), T(0.0), T(0.0)};
};

extern template class Chain<double>;

}  // namespace softgrip::model

#include "model/chain_walk.h"  // IWYU pragma: keep
