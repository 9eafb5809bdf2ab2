#pragma once
// A model that steps: the blocks of a Model, walked once per sample from the command to the reading.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/model.h"
#include "model/registry.h"
#include "model/segment.h"

namespace softgrip::model {

/// A stepping chain over the number type T. Construction allocates; reset() and step() do not (a chain
/// prepared with sample_time_s = 0, for irregular logs, may grow its delay line).
///
/// The command is piecewise linear: step(dt, u) takes it from where it was to `u` over `dt`. A held output
/// of a board is step(0, u) followed by step(dt, u). Within that convention Bouc-Wen, Kelvin-Voigt, delay
/// and lag are exact for any dt.
template <class T>
class Chain {
 public:
  /// @param values  all parameters of all blocks, in the order of parameter_count()/flat_values(model);
  ///                empty: the model's own numbers.
  /// @param sample_time_s  nominal sample time for precomputed coefficients, 0 when irregular.
  /// @param seed  of the sensor's random numbers; the same seed gives the same noise.
  explicit Chain(const Model& model, std::span<const T> values = {}, double sample_time_s = 0,
                 std::uint64_t seed = 0);

  /// At rest with `command` applied for ever (hysteresis unloaded, creep settled at that pressure only when
  /// it is 0; see reset_at() of the blocks). The usual start is reset(T(0)).
  void reset(const T& command);

  /// Moves on by `duration_s` >= 0 while the command goes linearly to `command`; returns the reading [mm].
  T step(const T& duration_s, const T& command, const Surroundings& surroundings);

  /// The signal behind the last block of the given station after the last step: pressure at the actuator
  /// for Station::valve [kPa], displacement in mm for the others. Without blocks there: what came in.
  [[nodiscard]] T after(Station station) const;
  [[nodiscard]] T reading_mm() const { return after(Station::sensor); }
  [[nodiscard]] T pressure_kpa() const { return after(Station::valve); }

  [[nodiscard]] std::size_t size() const noexcept { return blocks_.size(); }
  /// Access for the control side, which inverts block by block.
  [[nodiscard]] const AnyBlock<T>& block(std::size_t index) const { return blocks_[index]; }

 private:
  std::vector<AnyBlock<T>> blocks_;
  // the rest belongs to the implementation
};

/// All parameters of a model's blocks in chain order, as Chain's `values` expects them.
[[nodiscard]] std::vector<double> flat_values(const Model& model);

}  // namespace softgrip::model
