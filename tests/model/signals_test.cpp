#include "model/signals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace softgrip::model::signals_test {
namespace {

TEST(Signals, SignalNamesRoundTrip) {
  EXPECT_EQ(signal_names.size(), 6u);
  for (const auto& [signal, name] : signal_names) {
    EXPECT_EQ(name_of(signal), name);
    EXPECT_EQ(signal_names.find(name), signal);
  }
  EXPECT_FALSE(signal_names.find("tp3"));
  EXPECT_FALSE(signal_names.find(""));
}

TEST(Signals, StartAndEndAtZeroAndStayWithinSixtyKilopascal) {
  for (const auto& [signal, name] : signal_names) {
    SCOPED_TRACE(name);
    const double end = duration_s(signal);
    EXPECT_EQ(value_kpa(signal, 0), 0);
    EXPECT_EQ(value_kpa(signal, end), 0);
    EXPECT_EQ(value_kpa(signal, -1), 0);
    EXPECT_EQ(value_kpa(signal, end + 1), 0);
    EXPECT_EQ(value_kpa(signal, std::nan("")), 0);
    double peak = 0;
    double steepest = 0;
    for (int i = 1; i * 1e-3 <= end; ++i) {
      const double value = value_kpa(signal, i * 1e-3);
      ASSERT_GE(value, 0);
      peak = std::fmax(peak, value);
      steepest = std::fmax(steepest, std::fabs(value - value_kpa(signal, (i - 1) * 1e-3)) * 1e3);
    }
    EXPECT_LE(peak, 60);
    EXPECT_GE(peak, 50);
    EXPECT_LE(steepest, 61) << "the signal must have no jump: " << name_of(signal);
    EXPECT_NEAR(value_kpa(signal, end - 1e-9), 0, 1e-6);
  }
}

TEST(Signals, TwoCyclesAreTheSame) {
  for (const SignalName signal : {SignalName::tp1, SignalName::tp2, SignalName::sp1, SignalName::sp2}) {
    const double cycle = duration_s(signal) / 2;
    for (double t = 0.05; t < cycle; t += 0.1) {
      ASSERT_NEAR(value_kpa(signal, t), value_kpa(signal, t + cycle), 1e-9);
    }
  }
}

TEST(Signals, TrianglesAndSinusoidsShareTheirPeaks) {
  for (const auto& [triangle, sinusoid] :
       {std::pair{SignalName::tp1, SignalName::sp1}, std::pair{SignalName::tp2, SignalName::sp2}}) {
    EXPECT_EQ(duration_s(triangle), duration_s(sinusoid));
    std::multiset<int> peaks;
    double last = 0, before = 0;
    for (int i = 1; i * 1e-3 < duration_s(triangle); ++i) {
      const double value = value_kpa(triangle, i * 1e-3);
      if (last > before && last > value) {
        peaks.insert(static_cast<int>(std::lround(last)));
        EXPECT_NEAR(value_kpa(sinusoid, (i - 1) * 1e-3), last, 1e-3);
      }
      before = last;
      last = value;
    }
    EXPECT_EQ(peaks.size(), 10u);
    EXPECT_EQ(std::set<int>(peaks.begin(), peaks.end()).size(), 5u)
        << "one cycle of the signal has 5 different amplitudes";
  }
}

TEST(Signals, CornersLieOnTheGridsOfOneKilohertzAndTwoHundredHertz) {
  // All corners of the signals are at multiples of 5 ms. Linear interpolation between samples at 200 Hz must
  // therefore give the original signal.
  for (const SignalName signal : {SignalName::tp1, SignalName::tp2, SignalName::steps, SignalName::hold}) {
    for (int i = 0; (i + 1) * 5e-3 <= duration_s(signal); ++i) {
      const double a = value_kpa(signal, i * 5e-3), b = value_kpa(signal, (i + 1) * 5e-3);
      ASSERT_NEAR(value_kpa(signal, (i + 0.4) * 5e-3), a + 0.4 * (b - a), 1e-9)
          << name_of(signal) << " " << i;
    }
  }
}

}  // namespace
}  // namespace softgrip::model::signals_test
