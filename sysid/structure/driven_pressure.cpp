#include "sysid/structure/driven_pressure.h"

#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/play.h"
#include "model/regulated_pressure.h"
#include "model/two_way_lag.h"

namespace softgrip::sysid {
namespace {

using Segment = model::Segment<double>;

/// The delay of a structure, followed by its lags and its rate limit or by its regulator. A component that
/// the structure does not have passes its input on unchanged.
class Valve {
 public:
  Valve(const Record& record, const BaseStructure& structure, const NonlinearNumbers& n, double first_kpa)
      : regulates_(structure.lag && structure.regulator),
        delay_(std::vector<double>{structure.delay ? n.delay_s : 0}, {.sample_time_s = record.sample_time_s}),
        second_(second_s(structure, n), second_s(structure, n), record.sample_time_s),
        lag_(structure.lag ? n.filling_s : 0, structure.lag ? n.venting_s : 0, record.sample_time_s),
        limit_(std::vector<double>{limits(structure) ? n.filling_s_per_kpa : 0,
                                   limits(structure) ? n.venting_s_per_kpa : 0},
               {}),
        pilot_(n.pilot_band_kpa / 2),
        regulator_({n.filling_s, n.venting_s, n.overlap_kpa, n.integral_s, n.full_open_kpa}) {
    delay_.reset(first_kpa);
    second_.reset(first_kpa);
    lag_.reset(first_kpa);
    limit_.reset(first_kpa);
    pilot_.reset(first_kpa);
    regulator_.reset(pilot_.output());
  }

  template <class Next>
  void step(const Segment& command, Next&& next) {
    delay_.step(command, {}, [&](const Segment& delayed) {
      if (!regulates_) {
        return second_.step(delayed, [&](const Segment& slower) {
          lag_.step(slower, [&](const Segment& q) { limit_.step(q, {}, next); });
        });
      }
      pilot_.step(delayed, [&](const Segment& asked) { regulator_.step(asked, next); });
    });
  }

 private:
  static double second_s(const BaseStructure& structure, const NonlinearNumbers& n) {
    return structure.lag && structure.second_lag ? n.second_s : 0;
  }

  static bool limits(const BaseStructure& structure) { return structure.lag && structure.rate_limit; }

  bool regulates_;
  model::TransportDelay<double> delay_;
  model::TwoWayLag<double> second_;
  model::TwoWayLag<double> lag_;
  model::RateLimit<double> limit_;
  model::Play<double> pilot_;
  model::RegulatedPressure<double> regulator_;
};

}  // namespace

void drive(const Record& record, std::size_t index, const BaseStructure& structure,
           const NonlinearNumbers& numbers, DrivenPressure& driven) {
  const bool jumps = structure.linear && index < numbers.jumped_from_kpa.size();
  driven.first_kpa = jumps ? numbers.jumped_from_kpa[index] : record.drive_kpa.front();
  driven.segments.clear();
  driven.until.clear();
  driven.segments.reserve(3 * record.size());
  driven.until.reserve(record.size());
  Valve valve(record, structure, numbers, driven.first_kpa);
  const auto step = [&](double duration_s, double from_kpa, double to_kpa) {
    valve.step(Segment::straight(duration_s, from_kpa, to_kpa),
               [&](const Segment& q) { driven.segments.push_back(q); });
  };
  if (jumps) step(0, driven.first_kpa, record.drive_kpa.front());
  driven.until.push_back(driven.segments.size());
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double end = record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
    const double begin = i > 1 && record.held ? record.drive_kpa[i - 2] : record.drive_kpa[i - 1];
    if (record.held && i > 1) step(0, begin, end);
    step(record.duration_s[i], record.held ? end : begin, end);
    driven.until.push_back(driven.segments.size());
  }
}

}  // namespace softgrip::sysid
