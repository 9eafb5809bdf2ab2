#include <gtest/gtest.h>

#include <utility>

#include "base/clock.h"
#include "base/net/listener.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"
#include "tests/drivers/modbus/on_tcp.h"
#include "tests/drivers/modbus/two_fingers.h"
#include "tools/commissioning/examinations.h"

namespace softgrip::tools::doctor::bus_examination_test {
namespace {

TEST(BusExamination, EndsAfter4SecondsIfTheDeadlinesAreLonger) {
  document::Problems problems;
  auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/adam-6024.yaml", problems);
  ASSERT_TRUE(map) << problems.format();
  // The system accepts connections to this socket, but no program responds to requests.
  const auto silent = net::listen_tcp("127.0.0.1", 0);
  ASSERT_TRUE(silent) << silent.error();
  rig::RigFile rig;
  rig.board = drivers::test::on_tcp(silent->port, std::move(*map), drivers::test::two_fingers(), 0);
  rig.loop.exchange_deadline_s = 30;
  Findings findings;
  const Nanoseconds began = monotonic_now();
  examine_bus(rig, findings);
  EXPECT_NEAR(static_cast<double>(monotonic_now() - began) / static_cast<double>(ns_per_s), 4, 0.5);
  ASSERT_EQ(findings.list().size(), 1U);
  EXPECT_EQ(findings.list().front().name, "modbus board");
}

}  // namespace
}  // namespace softgrip::tools::doctor::bus_examination_test
