// Compares the measured rate of exchanges with the rate that the driver predicts before it connects. The
// exchanges use a pseudo-terminal. Its other end delays the bytes like a real serial line. If the system
// permits it, both ends run at real-time priority on one processor, so that other programs do not change the
// measured rate. A kernel thread transfers the bytes of a pseudo-terminal. On a busy machine, this transfer
// took up to 0.7 ms per transaction. Therefore the modules on the fastest line have a response time, like
// real modules.

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "rig/board_map_file.h"
#include "tests/simulation/emulator/running_rig.h"

namespace softgrip::simulation::line_rate_test {
namespace {

using namespace std::chrono_literals;
using drivers::BusStatus;

struct Rate {
  std::uint32_t baud;
  double turnaround_s;
  int exchanges;
};

/// While an object of this class exists, this thread and the threads that it starts run on processor 0 with
/// real-time priority. If the system does not permit this, granted() returns false.
class RealTime {
 public:
  RealTime() {
    sched_param parameters{};
    parameters.sched_priority = 40;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(0, &one);
    granted_ = ::sched_getaffinity(0, sizeof before_, &before_) == 0 &&
               ::sched_setaffinity(0, sizeof one, &one) == 0 &&
               ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
  }
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;
  RealTime(RealTime&&) = delete;
  RealTime& operator=(RealTime&&) = delete;
  ~RealTime() {
    const sched_param ordinary{};
    ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
    ::sched_setaffinity(0, sizeof before_, &before_);
  }
  [[nodiscard]] bool granted() const { return granted_; }

 private:
  cpu_set_t before_{};
  bool granted_ = false;
};

class LineRate : public testing::TestWithParam<Rate> {};

TEST_P(LineRate, IsWithinATenthOfTheBudget) {
  const RealTime real_time;
  if (!real_time.granted()) GTEST_SKIP() << "this test requires the right to real-time priority";
  test::RunningRigSettings settings;
  settings.wire = Wire::rtu;
  settings.line.baud = GetParam().baud;
  settings.line.turnaround_s = GetParam().turnaround_s;
  for (const std::string name : {"waveshare-ao8-b", "waveshare-ai8-b"}) {
    document::Problems problems;
    settings.maps.push_back(
        *rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/" + name + ".yaml", problems));
    settings.names.push_back(name);
  }
  test::RunningRig rig(settings);
  drivers::ModbusBoard board(rig.board());
  const drivers::Board::Budget budget = board.budget();
  ASSERT_EQ(board.connect(10s), BusStatus::ok) << board.detail();

  const std::array<double, 2> commands{10, 20};
  std::array<model::Reading, 2> readings;
  std::vector<double> took_s;
  for (int i = 0; i < GetParam().exchanges; ++i) {
    const auto before = std::chrono::steady_clock::now();
    ASSERT_EQ(board.exchange(commands, readings, 10s), BusStatus::ok) << board.detail();
    took_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
  }
  // The test compares the median of the measured durations, because a busy machine delays single exchanges.
  std::nth_element(took_s.begin(), took_s.begin() + static_cast<std::ptrdiff_t>(took_s.size() / 2),
                   took_s.end());
  const double median_s = took_s[took_s.size() / 2];
  std::printf("%s\nachieved: %.3g ms, %.4g Hz; off by %+.1f %%\n", budget.explanation.c_str(), 1e3 * median_s,
              1 / median_s, 100 * (median_s / budget.exchange_s - 1));
  EXPECT_NEAR(median_s, budget.exchange_s, 0.1 * budget.exchange_s) << budget.explanation;
  const drivers::Board::Budget measured = board.budget();
  EXPECT_NE(measured.explanation.find("measured when connecting"), std::string::npos);
  EXPECT_NEAR(measured.exchange_s, budget.exchange_s, 0.1 * budget.exchange_s) << measured.explanation;
}

std::string name_of_rate(const testing::TestParamInfo<Rate>& info) {
  return std::to_string(info.param.baud) + "_" +
         std::to_string(static_cast<int>(1e3 * info.param.turnaround_s)) + "ms";
}

INSTANTIATE_TEST_SUITE_P(Baud, LineRate,
                         testing::Values(Rate{115200, 0.005, 60}, Rate{9600, 0, 20}, Rate{19200, 0.002, 30}),
                         name_of_rate);

}  // namespace
}  // namespace softgrip::simulation::line_rate_test
