#pragma once
// A baseline model of the pressure for tests. The model is a filter bank without further parts, so its fit
// takes little time.

#include <gtest/gtest.h>

#include <vector>

#include "sysid/changes/base_prediction.h"
#include "sysid/changes/later_readings.h"
#include "tests/sysid/changes/finger.h"

namespace softgrip::sysid::test {

class PressureBase : public ::testing::Test {
 protected:
  PressureBase()
      : base_(fit_base(pressure_records(logs_of({}, 1, true), false), Judged::pressure, Drive::command, {})) {
  }

  LaterReadings readings(const Finger& finger, unsigned first_seed = 5) {
    const std::vector<Record> records = pressure_records(logs_of(finger, first_seed, true), false);
    return readings_of(base_, records, residuals_of(base_, records));
  }

  Base base_;
};

}  // namespace softgrip::sysid::test
