#pragma once
// Defines the parameters of changes since the healthy logs. These changes are added to a constant baseline
// model.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Pressure d that is lost while the valve does not move and is recovered while it moves: d' = rate p/largest
/// - d (1/recovery + |command'|/way). p is the pressure.
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

/// Softening at pressures p below the largest pressure m so far; the response at p = m does not change. The
/// displacement is multiplied by 1 + share m/largest tanh((m - p)/range) (after Ogden and Roxburgh, Proc. R.
/// Soc. A 455, 1999). If the range is 0, tanh() is replaced by 1, and the factor is equal at all pressures.
struct Softening {
  double share = 0;
  double range_kpa = 10;  ///< range [kPa]; 0: the factor does not depend on the pressure
};

/// A loop between the loading curve (p/largest)^exponent and the unloading curve p/largest. The difference
/// between the loop and the mean of both curves is added to the displacement, as a share of the span (a
/// generalised play: Al Janaideh, Rakheja and Su, IEEE/ASME Transactions on Mechatronics 16, 2011).
struct Crescent {
  double share = 0;
  double exponent = 3;
};

/// Faults of a regulator: ports that leak although they are closed, and a tube with a reduced conductance.
struct RegulatorFault {
  double leak_per_s = 0;  ///< conductance of the leak, defined like Regulator::leak_per_s
  double blocked = 0;     ///< share of the conductance of the tube that is lost, below 1
  [[nodiscard]] bool operator==(const RegulatorFault&) const = default;
};

struct Extension {
  std::vector<model::BlockSpec> valve;  ///< blocks between the command and the baseline model
  RegulatorFault fault;                 ///< faults of the regulator, if the baseline model has one
  std::vector<model::BlockSpec> chain;  ///< blocks within the model of the finger or after it
  double gain = 1;                      ///< factor that multiplies the displacement
  /// Relative change of the gain per degree above the mean temperature of the healthy logs.
  double gain_per_c = 0;
  Softening softening;
  Crescent crescent;
  PressureLoss loss;
  SlowLine line;
};

/// Returns the pressure of a record after the valve blocks, at each sample.
[[nodiscard]] std::vector<double> drive_behind(const std::vector<model::BlockSpec>& valve,
                                               const Record& record);

/// Returns a model that contains these valve blocks and whose input is the command. Returns nullopt if the
/// model already contains such a block and the two blocks cannot be combined.
[[nodiscard]] std::optional<model::Model> with_valve(model::Model model,
                                                     const std::vector<model::BlockSpec>& valve);

/// Returns the factor by which the softening multiplies the displacement, at each sample.
[[nodiscard]] std::vector<double> softened(const Softening& softening, const Record& record,
                                           double largest_kpa);

/// Returns the contribution of the loop to the displacement at each sample, as a share of the span.
[[nodiscard]] std::vector<double> added_by(const Crescent& crescent, const Record& record,
                                           double largest_kpa);

/// Returns the pressure after the effects of a slow line and a pressure loss.
[[nodiscard]] std::vector<double> pressure_behind(const SlowLine& line, const PressureLoss& loss,
                                                  const Record& record, std::vector<double> pressure_kpa);

}  // namespace softgrip::sysid
