#pragma once
// Parameters of a change since the healthy logs, added to a constant base.

#include <optional>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Pressure that is lost while the valve does not move and recovered when it does:
/// d' = rate p/largest - d (1/recovery + |command'|/way).
struct PressureLoss {
  double rate_kpa_per_s = 0;
  double recovery_s = 5;
  double way_kpa = 2;
};

/// Behind the valve: a line that fills and empties more slowly.
struct SlowLine {
  double filling_s = 0;
  double venting_s = 0;
};

/// Softer below the largest pressure so far m, as before at it: y times 1 + share m/largest tanh((m -
/// p)/range) (after Ogden and Roxburgh, Proc. R. Soc. A 455, 1999); without a range, at it as below.
struct Softening {
  double share = 0;
  double range_kpa = 10;  ///< 0: none
};

/// Up along (p/largest)^exponent, down along p/largest, between them only where it must: what a loop of that
/// shape adds to the mean of the two ways, as a share of the span (a generalised play: Al Janaideh, Rakheja
/// and Su, IEEE/ASME Transactions on Mechatronics 16, 2011).
struct Crescent {
  double share = 0;
  double exponent = 3;
};

/// Faults behind a regulator: ports that leak when closed, a tube with less conductance.
struct RegulatorFault {
  double leak_per_s = 0;  ///< as Regulator::leak_per_s
  double blocked = 0;     ///< share of the tube's conductance that is gone, below 1
  [[nodiscard]] bool operator==(const RegulatorFault&) const = default;
};

struct Extension {
  std::vector<model::BlockSpec> valve;  ///< what happens to the command, before the base sees it
  RegulatorFault fault;                 ///< of a base with a regulator
  std::vector<model::BlockSpec> chain;  ///< blocks of the base's model, or behind what it says
  double gain = 1;                      ///< of the displacement
  double gain_per_c = 0;                ///< beside the temperature of the healthy logs
  Softening softening;
  Crescent crescent;
  PressureLoss loss;
  SlowLine line;
};

/// The drive of a record behind blocks of the valve.
[[nodiscard]] std::vector<double> drive_behind(const std::vector<model::BlockSpec>& valve,
                                               const Record& record);

/// A model driven by the command with these blocks of the valve in front, walked as exactly as the rest of
/// it; nothing where it has such a block of its own that both cannot be one.
[[nodiscard]] std::optional<model::Model> with_valve(model::Model model,
                                                     const std::vector<model::BlockSpec>& valve);

/// By what softening multiplies the displacement, sample by sample.
[[nodiscard]] std::vector<double> softened(const Softening& softening, const Record& record,
                                           double largest_kpa);

/// Contribution of a crescent at each sample, as a share of the span.
[[nodiscard]] std::vector<double> added_by(const Crescent& crescent, const Record& record,
                                           double largest_kpa);

/// A pressure behind a line and a leak.
[[nodiscard]] std::vector<double> pressure_behind(const SlowLine& line, const PressureLoss& loss,
                                                  const Record& record, std::vector<double> pressure_kpa);

}  // namespace softgrip::sysid
