#pragma once
// Parameters of a change since the healthy logs, added to a constant base.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Pressure that is lost while the valve does not move, and recovered when it moves:
/// d' = rate p/largest - d (1/recovery + |command'|/way).
struct PressureLoss {
  double rate_kpa_per_s = 0;
  double recovery_s = 5;
  double way_kpa = 2;
};

/// A slow line between valve and finger, with a time constant for filling and one for venting.
struct SlowLine {
  double filling_s = 0;
  double venting_s = 0;
};

/// Softening below the largest pressure so far, m; the response at m does not change. Multiplies y by 1 +
/// share m/largest tanh((m - p)/range) (after Ogden and Roxburgh, Proc. R. Soc. A 455, 1999). With a range of
/// 0, the factor is equal at all pressures.
struct Softening {
  double share = 0;
  double range_kpa = 10;  ///< 0: no range
};

/// A loop with the loading curve (p/largest)^exponent and the unloading curve p/largest. It adds the
/// difference from the mean of both curves, as a share of the span (a generalised play: Al Janaideh, Rakheja
/// and Su, IEEE/ASME Transactions on Mechatronics 16, 2011).
struct Crescent {
  double share = 0;
  double exponent = 3;
};

/// Faults of a regulator: ports that leak when closed, a tube with a lower conductance.
struct RegulatorFault {
  double leak_per_s = 0;  ///< defined like Regulator::leak_per_s
  double blocked = 0;     ///< lost share of the conductance of the tube, below 1
  [[nodiscard]] bool operator==(const RegulatorFault&) const = default;
};

struct Extension {
  std::vector<model::BlockSpec> valve;  ///< blocks between the command and the base
  RegulatorFault fault;                 ///< faults of a base with a regulator
  std::vector<model::BlockSpec> chain;  ///< blocks within the base's model or after it
  double gain = 1;                      ///< factor of the displacement
  double gain_per_c = 0;  ///< relative gain per degree above the temperature of the healthy logs
  Softening softening;
  Crescent crescent;
  PressureLoss loss;
  SlowLine line;
};

/// Returns the drive of a record after blocks of the valve.
[[nodiscard]] std::vector<double> drive_behind(const std::vector<model::BlockSpec>& valve,
                                               const Record& record);

/// Returns a model that is driven by the command and contains these blocks of the valve. Returns nullopt if
/// the model already has such a block and the two cannot be combined.
[[nodiscard]] std::optional<model::Model> with_valve(model::Model model,
                                                     const std::vector<model::BlockSpec>& valve);

/// Returns the factor of the displacement at each sample.
[[nodiscard]] std::vector<double> softened(const Softening& softening, const Record& record,
                                           double largest_kpa);

/// Returns the contribution of a crescent at each sample, as a share of the span.
[[nodiscard]] std::vector<double> added_by(const Crescent& crescent, const Record& record,
                                           double largest_kpa);

/// Returns a pressure after a slow line and a pressure loss.
[[nodiscard]] std::vector<double> pressure_behind(const SlowLine& line, const PressureLoss& loss,
                                                  const Record& record, std::vector<double> pressure_kpa);

}  // namespace softgrip::sysid
