#include "control/elements/grip_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/control/rig_fixture.h"

namespace softgrip::control::grip_detector_test {
namespace {

constexpr double tick_s = 0.005;

TEST(Contact, HasHysteresis) {
  Contact contact(1);
  contact.observe(0.99);
  EXPECT_FALSE(contact.touching());
  contact.observe(1);
  EXPECT_TRUE(contact.touching());
  contact.observe(0.5);
  EXPECT_TRUE(contact.touching());
  contact.observe(0.49);
  EXPECT_FALSE(contact.touching());
}

TEST(Contact, AnUnknownShortfallKeepsTheContactState) {
  Contact contact(1);
  contact.observe(2);
  contact.observe(std::nan(""));
  EXPECT_TRUE(contact.touching());
}

TEST(EvidenceWindow, VerifiesOnlyAfterAWholeWindowOfEvidence) {
  EvidenceWindow window;
  window.start(0, 0.3);
  double verified_at = -1;
  for (int i = 0; verified_at < 0 && i < 1000; ++i) {
    const double t = i * tick_s;
    const bool evidence = t > 0.5 || (i % 10 != 0);  // during the first 0.5 s, the evidence is missing for
                                                     // one sample every 50 ms
    if (window.observe(t, true, evidence) == EvidenceWindow::Verdict::verified) {
      verified_at = t;
    }
  }
  EXPECT_NEAR(verified_at, 0.8, 0.06);
}

TEST(EvidenceWindow, RefutesOnlyAfterAWholeWindowWithoutEvidence) {
  EvidenceWindow window;
  window.start(0, 0.3);
  EXPECT_EQ(window.observe(0, true, false), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.29, true, true), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.3, true, false), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.59, true, false), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.61, true, false), EvidenceWindow::Verdict::refuted);
}

TEST(EvidenceWindow, AnUnusableSampleRestartsTheWindow) {
  EvidenceWindow window;
  window.start(0, 0.3);
  (void)window.observe(0, true, true);
  EXPECT_EQ(window.observe(0.2, false, true), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.35, true, true), EvidenceWindow::Verdict::pending);
  EXPECT_EQ(window.observe(0.66, true, true), EvidenceWindow::Verdict::verified);
}

TEST(EvidenceWindow, IsBlindedForOneWindowAfterAnUnusableSample) {
  EvidenceWindow window;
  window.start(0, 0.3);
  (void)window.observe(0.1, true, false);
  EXPECT_FALSE(window.blinded(0.1));
  (void)window.observe(0.2, false, false);
  (void)window.observe(0.25, true, false);
  EXPECT_TRUE(window.blinded(0.49));
  EXPECT_FALSE(window.blinded(0.51));
  window.start(0.3, 0.3);
  EXPECT_FALSE(window.blinded(0.3));
}

TEST(HoldWatch, ReportsALossWithinTwoIntervals) {
  for (double gone_at = 1; gone_at < 1.5; gone_at += 0.013) {
    HoldWatch watch;
    watch.start(0, 0.25, 0.5);
    double told_at = -1;
    for (int i = 0; told_at < 0 && i < 2000; ++i) {
      const double t = i * tick_s;
      if (watch.observe(t, true, t < gone_at ? 4.0 : 0.0)) {
        told_at = t;
      }
    }
    EXPECT_GT(told_at, gone_at);
    EXPECT_LE(told_at - gone_at, 2 * 0.25 + 2 * tick_s);
  }
}

TEST(HoldWatch, IntervalsWithoutReadingsReportNoLoss) {
  HoldWatch watch;
  watch.start(0, 0.25, 0.5);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(watch.observe(i * tick_s, false, 0));
  }
}

/// Returns the model bench_twin. Each parameter is multiplied by its own random factor between 1 - share and
/// 1 + share.
model::Model perturbed(double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> off(1 - share, 1 + share);
  model::Model model = twin();
  for (model::BlockSpec& block : model.blocks) {
    for (double& value : block.values) {
      value *= std::round(value) == value && value < 10 ? 1 : off(random);  // the exponent, which is the only
                                                                            // whole number below 10, must
                                                                            // stay unchanged
    }
  }
  return model;
}

/// Returns the RMS residual [mm] of the left finger while the pressure signal tp1 moves the finger without
/// contact.
double free_rmse_mm(const RigSettings& settings, const model::Model& truth) {
  const PreparedSequence tp1 =
      sequence_of("name: x\nsteps:\n  - pressure: {signal: tp1, scale: 0.9}\n", settings);
  SimulatedRig rig(settings, 1, truth);
  EXPECT_TRUE(rig.run_until(State::idle, 1));
  rig.request(Request::Kind::start, &tp1);
  EXPECT_TRUE(rig.run_until(State::running, 2));
  double sum = 0;
  int count = 0;
  while (rig.tick().state == State::running) {
    sum += std::pow(rig.output().channels[0].residual_mm, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

/// The detection margin must be at least three times the RMS error of the model. With this margin, even an
/// inaccurate model must cause no wrong grip result.
TEST(GripDetection, AMarginOf3RmseGivesRightResultsWithInaccurateModels) {
  double worst_mm = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const model::Model truth = perturbed(0.05, seed);
    RigSettings settings = two_finger_settings();
    settings.detection.model_rmse_mm = free_rmse_mm(settings, truth);
    settings.detection.margin_mm = 3 * settings.detection.model_rmse_mm;
    worst_mm = std::max(worst_mm, settings.detection.model_rmse_mm);
    ASSERT_EQ(settings_problems(settings), std::vector<std::string>{});
    for (const char* name : {"empty_grip", "pick_stone", "pick_screw"}) {
      const PreparedSequence sequence = example_sequence(name, settings);
      for (const bool stone : {false, true}) {
        SimulatedRig rig(settings, seed, truth);
        if (stone) {
          rig.stone(11);
        }
        ASSERT_TRUE(rig.start(sequence));
        ASSERT_TRUE(rig.run_until(State::idle, 60));
        EXPECT_EQ(rig.result(0), stone ? GripResult::released : GripResult::no_part)
            << name << (stone ? " with" : " without") << " a stone";
      }
    }
  }
  RecordProperty("worst_rmse_um", static_cast<int>(1e3 * worst_mm));
}

}  // namespace
}  // namespace softgrip::control::grip_detector_test
