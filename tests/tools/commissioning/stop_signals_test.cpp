#include "tools/commissioning/stop_signals.h"

#include <gtest/gtest.h>

#include <csignal>

namespace softgrip::tools::stop_signals_test {
namespace {

TEST(StopSignals, ASignalThatWouldEndTheProcessIsRememberedInstead) {
  StopSignals signals;
  EXPECT_FALSE(signals.came());
  std::raise(SIGTERM);
  EXPECT_TRUE(signals.came());
  EXPECT_TRUE(signals.came()) << "from the first of them on";
}

}  // namespace
}  // namespace softgrip::tools::stop_signals_test
