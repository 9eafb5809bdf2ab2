#pragma once
// Creates records with given commands for the tests of regulators.

#include <cmath>
#include <vector>

#include "sysid/logs/record.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::test {

inline Record record_of(const std::vector<double>& command_kpa, double interval_s) {
  Log log;
  for (std::size_t i = 0; i < command_kpa.size(); ++i) {
    log.time_s.push_back(static_cast<double>(i) * interval_s);
    log.displacement_mm.push_back(0);
  }
  log.pressure_command_kpa = command_kpa;
  return make_records({log}, {}).front();
}

inline double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace softgrip::sysid::test
