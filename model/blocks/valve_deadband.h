#pragma once
// The valve ignores changes smaller than a band: stiction of its spool, dead band of its regulator.

#include "model/block.h"
#include "model/play.h"

namespace softgrip::model {

/// Play: after a reversal the pressure stays where it is until the command has come back by the band.
template <class T>
class ValveDeadband {
 public:
  static constexpr BlockInfo info{.id = "valve_deadband",
                                  .station = Station::valve,
                                  .kind = Kind::pressure,
                                  .inverse = Inverse::ignored,
                                  .title = "Valve dead band",
                                  .meaning = "The valve ignores changes of the command smaller than a band.",
                                  .equation = "|u - p| <= band/2, p moves only when it must"};
  static constexpr std::array parameters{ParameterSpec{.name = "band_kpa",
                                                       .unit = "kPa",
                                                       .default_value = 1.0,
                                                       .lower = 0.0,
                                                       .upper = 1000.0,
                                                       .scale = 0.5,
                                                       .meaning = "change after a reversal that is ignored",
                                                       .neutral = 0.0}};

  ValveDeadband(std::span<const T> values, const Preparation&) : play_(T(values[0] * 0.5)) {}

  void reset(const T& input) { play_.reset(input); }
  [[nodiscard]] T output() const { return play_.output(); }

  template <class Next>
  void step(const Segment<T>& in, const Surroundings&, Next&& next) {
    play_.step(in, next);
  }

 private:
  Play<T> play_;
};

}  // namespace softgrip::model
