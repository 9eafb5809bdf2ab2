#pragma once
// Models a pressure regulator with spool overlap and integral control.

#include <string_view>

#include "model/block.h"
#include "model/regulated_pressure.h"

namespace softgrip::model {

/// Computes the regulated pressure. RegulatedPressure (model/regulated_pressure.h) describes the equations.
template <class T>
class PressureRegulator : public OnePartBlock<T, RegulatedPressure<T>> {
 public:
  static constexpr BlockInfo info = block_info(
      "pressure_regulator", Station::valve, Kind::pressure, Inverse::lead, "Pressure regulator",
      "Pressure regulator whose spool has an overlap, with integral control of the pressure.",
      "tau p' = v -+ overlap beyond the overlap, else 0; v = u - p + integral of (u - p) / Ti, |v| <= full");
  static constexpr std::array parameters{
      parameter("filling_time_constant_s", "s", "time constant of the lag while the pressure rises",
                Typical{0.03}, Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{}),
      parameter("venting_time_constant_s", "s",
                "time constant of the lag while the pressure falls, at a pressure of 50 kPa", Typical{0.05},
                Within{0.0, 1e4}, Scale{0.05}, Neutral{0.0}, Latency{}),
      parameter("overlap_kpa", "kPa", "largest pressure error at which no port of the valve opens",
                Typical{0.5}, Within{0.0, 100.0}, Scale{0.5}, Placed{}, Neutral{0.0}),
      parameter("integral_time_s", "s",
                "integral time of the regulator; 0 for a regulator without integral action", Typical{0.4},
                Within{0.0, 1000.0}, Scale{0.5}, Placed{}, Neutral{0.0}),
      parameter("full_open_kpa", "kPa",
                "pressure error at which a port of the valve is fully open; 0 for an unlimited flow",
                Typical{12.0}, Within{0.0, 1000.0}, Scale{10.0}, Placed{}, Neutral{0.0})};

  static std::string_view objection(std::span<const double> values) {
    if (values[4] > 0 && values[4] <= values[2]) return "full_open_kpa must be above overlap_kpa, or 0";
    return {};
  }

  PressureRegulator(std::span<const T> values, const Preparation&)
      : OnePartBlock<T, RegulatedPressure<T>>(
            RegulatedPressure<T>({values[0], values[1], values[2], values[3], values[4]})) {}

  [[nodiscard]] const RegulatedPressure<T>& regulated() const { return this->part_; }
};

}  // namespace softgrip::model
