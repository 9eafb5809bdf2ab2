#pragma once
// Defines the parameters of changes since the healthy logs. The changes are added to a baseline model whose
// own parameters stay constant.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Pressure loss d. It increases while the valve does not move and decreases while the valve moves. The
/// equation is d' = rate p/largest - d (1/recovery + |command'|/way), where p is the pressure (negative for a
/// vacuum) and `largest` is the largest command in the record.
struct PressureLoss {
  double rate_kpa_per_s = 0;
  double recovery_s = 5;
  double way_kpa = 2;
};

/// A line that delays the flow between valve and finger. It has one time constant for filling and another for
/// venting.
struct SlowLine {
  double filling_s = 0;
  double venting_s = 0;
};

/// Softening at pressures p below the previous maximum m of the pressure. The response at p = m does not
/// change. The displacement is multiplied by 1 + share m/largest tanh((m - p)/range) (after Ogden and
/// Roxburgh, Proc. R. Soc. A 455, 1999). If the range is 0, the factor 1 replaces tanh(), so the softening is
/// equal at all pressures.
struct Softening {
  double share = 0;
  double range_kpa = 10;  ///< range [kPa]; 0: the softening does not depend on the pressure
};

/// A hysteresis loop between the loading curve (p/largest)^exponent and the unloading curve p/largest. The
/// loop minus the mean of both curves is added to the displacement, as a share of the span. The loop is a
/// generalised play (Al Janaideh, Rakheja and Su, IEEE/ASME Transactions on Mechatronics 16, 2011).
struct Crescent {
  double share = 0;
  double exponent = 3;
};

/// Faults of a regulator: a leak from the finger, and a tube with a reduced conductance.
struct RegulatorFault {
  double leak_per_s = 0;  ///< conductance of a leak from the finger to the atmosphere; unit as in
                          ///< Regulator::leak_per_s
  double blocked = 0;     ///< share of the conductance of the tube that is lost, below 1
  [[nodiscard]] bool operator==(const RegulatorFault&) const = default;
};

/// A different load line of the finger: the model of the finger receives factor * p - weight_kpa instead of
/// the pressure p. The displacement x of a finger obeys an equilibrium of the form
/// stiffness f(x) = area p - weight, so a stiffness that changes by 1/factor and a weight change only the
/// pressure. If f is linear, the factor is a gain, and the weight is a zero offset.
struct Load {
  double factor = 1;
  double weight_kpa = 0;
  [[nodiscard]] bool operator==(const Load&) const = default;
};

struct Extension {
  std::vector<model::BlockSpec> valve;  ///< blocks between the command and the baseline model
  RegulatorFault fault;                 ///< faults of the regulator, if the baseline model has one
  Load load;                            ///< change of the load line of the finger
  std::vector<model::BlockSpec> chain;  ///< blocks within the model of the finger or after it
  double gain = 1;                      ///< factor that multiplies the displacement
  /// Relative change of the gain per degree above the mean temperature of the healthy logs.
  double gain_per_c = 0;
  Softening softening;
  Crescent crescent;
  PressureLoss loss;
  SlowLine line;
  double lead_s = 0;  ///< time by which the readings lead the motion, >= 0
};

/// Returns the pressure at the output of the valve blocks at each sample of the record.
[[nodiscard]] std::vector<double> drive_behind(const std::vector<model::BlockSpec>& valve,
                                               const Record& record);

/// Returns the model with these valve blocks in addition. The input of the result is the command. Returns
/// nullopt if the model already contains a block of the same type and the two blocks cannot be combined.
[[nodiscard]] std::optional<model::Model> with_valve(model::Model model,
                                                     const std::vector<model::BlockSpec>& valve);

/// Returns the factor by which the softening multiplies the displacement, at each sample.
[[nodiscard]] std::vector<double> softened(const Softening& softening, const Record& record,
                                           double largest_kpa);

/// Returns the displacement that the hysteresis loop adds at each sample, as a share of the span.
[[nodiscard]] std::vector<double> added_by(const Crescent& crescent, const Record& record,
                                           double largest_kpa);

/// Returns the series that leads another series by a time: at each sample, the value of the other series
/// `lead_s` later, with linear interpolation. Near the end of the record, the last value is returned.
[[nodiscard]] std::vector<double> leading_by(double lead_s, const Record& record,
                                             const std::vector<double>& series);

/// Returns the pressure at each sample after the effects of a slow line and of a pressure loss. The argument
/// is the pressure without these effects.
[[nodiscard]] std::vector<double> pressure_behind(const SlowLine& line, const PressureLoss& loss,
                                                  const Record& record, std::vector<double> pressure_kpa);

}  // namespace softgrip::sysid
