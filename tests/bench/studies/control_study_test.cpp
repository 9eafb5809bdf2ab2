#include "bench/studies/control_study.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bench/studies/models.h"

namespace softgrip::studies::control_study_test {
namespace {

/// Returns a short study that all tests of this file use.
const ControlStudy& quick_study() {
  static const ControlStudy study = [] {
    ControlStudyOptions options;
    options.draws = 5;
    options.search_draws = 1;
    options.iterations = 5;
    options.frequencies_hz = {0.2};
    options.mismatches = {0.05};
    options.rate_hz = 100;
    options.starts = 4;
    options.threads = 1;
    return study_control(options);
  }();
  return study;
}

double rmse_mm(const std::string& id) {
  const ControlFigure* const figure = quick_study().find(id, 0.2, 0.05);
  EXPECT_NE(figure, nullptr) << id;
  return figure == nullptr ? 0 : figure->rmse_mm.median;
}

TEST(ControlStudy, OnlyTheExtendedStructureYieldsAnInvertibleModel) {
  EXPECT_GT(wrong_way_ratio(quick_study().identified), 1);
  EXPECT_LT(wrong_way_ratio(quick_study().extended), 1);
  EXPECT_LT(quick_study().extended_rmse_mm, 0.052);
}

TEST(ControlStudy, SchemesWithoutAnInverseAreRefusedWithTheReason) {
  for (const ControlScheme& scheme : quick_study().schemes) {
    const bool refused = scheme.id == "published" || scheme.id == "full_identified";
    EXPECT_EQ(!scheme.refusal.empty(), refused) << scheme.id << ": " << scheme.refusal;
    EXPECT_EQ(scheme.figures.empty(), refused) << scheme.id;
    if (!refused) continue;
    EXPECT_NE(scheme.refusal.find("inverse response"), std::string::npos);
  }
}

TEST(ControlStudy, TheExtendedInverseIsTenTimesBetterThanPidAlone) {
  EXPECT_GT(rmse_mm("pid"), 10 * rmse_mm("full_extended"));
}

TEST(ControlStudy, PlannedFeedforwardReducesThePidErrorByAFactorOfThree) {
  EXPECT_GT(rmse_mm("pid_on_published"), 3 * rmse_mm("planned_on_published"));
}

TEST(ControlStudy, EveryLoopKeepsTheMargin) {
  for (const ControlScheme& scheme : quick_study().schemes) {
    for (const ControlFigure& figure : scheme.figures) {
      EXPECT_LE(figure.sensitivity, quick_study().options.most_sensitivity) << scheme.id;
      EXPECT_LE(figure.rmse_mm.low, figure.rmse_mm.median);
      EXPECT_LE(figure.rmse_mm.median, figure.rmse_mm.high);
      EXPECT_LE(figure.pressure_most_kpa, 60);
      EXPECT_EQ(figure.draws_mm.size(), 5U);
    }
  }
}

TEST(ControlStudy, WritesValidJsonAndASelfContainedPage) {
  const auto json = nlohmann::json::parse(control_json(quick_study()));
  EXPECT_EQ(json.at("schemes").size(), quick_study().schemes.size());
  const std::string page = control_page(quick_study()).to_html();
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_LT(page.size(), 1500000U);
}

}  // namespace
}  // namespace softgrip::studies::control_study_test
