#include "sysid/structure/driven_pressure.h"

#include "model/blocks/transport_delay.h"
#include "model/two_way_lag.h"

namespace softgrip::sysid {

DrivenPressure driven_pressure(const Record& record, const BaseStructure& structure,
                               const NonlinearNumbers& numbers) {
  using Segment = model::Segment<double>;
  DrivenPressure driven;
  driven.first_kpa = record.drive_kpa.front();
  driven.segments.reserve(3 * record.size());
  driven.until.reserve(record.size());
  model::TwoWayLag<double> lag(structure.lag ? numbers.filling_s : 0, structure.lag ? numbers.venting_s : 0,
                               record.sample_time_s);
  model::TransportDelay<double> delay(std::vector<double>{structure.delay ? numbers.delay_s : 0},
                                      {.sample_time_s = record.sample_time_s});
  delay.reset(driven.first_kpa);
  lag.reset(driven.first_kpa);
  const auto step = [&](double duration_s, double from_kpa, double to_kpa) {
    delay.step(Segment::straight(duration_s, from_kpa, to_kpa), {}, [&](const Segment& delayed) {
      lag.step(delayed, [&](const Segment& q) { driven.segments.push_back(q); });
    });
  };
  driven.until.push_back(0);
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double end = record.held ? record.drive_kpa[i - 1] : record.drive_kpa[i];
    const double begin = i > 1 && record.held ? record.drive_kpa[i - 2] : record.drive_kpa[i - 1];
    if (record.held && i > 1) step(0, begin, end);
    step(record.duration_s[i], record.held ? end : begin, end);
    driven.until.push_back(driven.segments.size());
  }
  return driven;
}

}  // namespace softgrip::sysid
