#include "bench/studies/published.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "bench/studies/invertible_match.h"
#include "bench/studies/models.h"
#include "model/file/model_file.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::studies::published_test {
namespace {

model::Model configured(const std::string& name) {
  document::Problems problems;
  auto model = model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/" + name + ".yaml", problems);
  EXPECT_TRUE(model) << problems.format();
  return *model;
}

TEST(StudyModels, EqualTheShippedModels) {
  EXPECT_EQ(published_model(2).blocks, configured("zhang2025").blocks);
  EXPECT_EQ(bench_twin().blocks, configured("bench_twin").blocks);
}

TEST(StudyModels, OnlyThePublishedModelHasAnInverseResponse) {
  EXPECT_NEAR(wrong_way_ratio(ordinary_model(0.1, 0.05)), 0.5666, 1e-4);
  EXPECT_NEAR(wrong_way_ratio(published_model(2)), 2.33, 0.005);
}

TEST(Triangles, StartAndEndAtRestAndStayInRange) {
  for (const Triangles choice : {Triangles::mixed, Triangles::rising}) {
    const sysid::Log log = triangles(choice, 100);
    EXPECT_EQ(log.pressure_command_kpa.front(), 0);
    EXPECT_EQ(log.pressure_command_kpa.back(), 0);
    for (std::size_t i = 1; i < log.size(); ++i) {
      ASSERT_GT(log.time_s[i], log.time_s[i - 1]);
      ASSERT_GE(log.pressure_command_kpa[i], 0);
      ASSERT_LE(log.pressure_command_kpa[i], 60);
    }
  }
}

TEST(InvertibleMatch, FindsTheTrueModelWithinTheBound) {
  const model::Model truth = ordinary_model(0.08, 0.05);
  sysid::Log log = triangles(Triangles::rising, 50);
  simulate(truth, {}, log);
  const model::Model found = invertible_match({log}, ordinary_model(0.05, 0.1), {0.8, 2, 1, 1});
  EXPECT_NEAR(value_of(found, "valve_lag.time_constant_s"), 0.08, 1e-3);
  EXPECT_NEAR(value_of(found, "transport_delay.delay_s"), 0.05, 1e-3);
  EXPECT_NEAR(wrong_way_ratio(found), wrong_way_ratio(truth), 1e-3);
}

TEST(InvertibleMatch, KeepsTheRatioAtTheBoundForAnInverseResponse) {
  sysid::Log log = triangles(Triangles::rising, 50);
  simulate(published_model(2), {}, log);
  const model::Model found = invertible_match({log}, ordinary_model(0.06, 0.06), {0.8, 2, 1, 1});
  EXPECT_LE(wrong_way_ratio(found), 0.8 * (1 + 1e-4));
  EXPECT_GT(wrong_way_ratio(found), 0.79);
}

/// Returns a short study for the tests in this file.
const PublishedStudy& quick_study() {
  static const PublishedStudy study = [] {
    PublishedOptions options;
    options.rate_hz = 50;
    options.starts = 3;
    options.most_cases = 3;
    options.threads = 1;
    return study_published(options);
  }();
  return study;
}

TEST(PublishedStudy, LatencyRaisesTheFittedRatioBeyondOneAtASmallError) {
  const PublishedStudy& study = quick_study();
  ASSERT_EQ(study.latency.size(), 3U);
  EXPECT_NEAR(study.latency[0].ratio, study.latency[0].true_ratio, 0.02);
  EXPECT_GT(study.latency[1].ratio, study.latency[0].ratio + 0.1);
  EXPECT_GT(study.latency[2].ratio, 1);
  EXPECT_TRUE(study.latency[2].refused);
  EXPECT_FALSE(study.latency[0].refused);
  EXPECT_LT(study.latency[2].rmse_mm, 0.005 * study.latency[2].span_mm);
}

TEST(PublishedStudy, AnInvertibleModelWithLatencyFitsThePublishedResponse) {
  for (const PublishedMatch& row : quick_study().matches) {
    EXPECT_LT(row.rmse_mm, 0.08) << row.eta_per_bar;
    EXPECT_LE(row.ratio, 0.8 * (1 + 1e-4)) << row.eta_per_bar;
    EXPECT_NEAR(row.lag_s + row.delay_s, 0.17, 0.04) << row.eta_per_bar;
  }
}

TEST(PublishedStudy, TheImplicitInverseIsExactForRatiosBelowOne) {
  for (const InverseTrial& row : quick_study().inverses) {
    EXPECT_NEAR(row.growth, row.ratio, 1e-4);
    EXPECT_EQ(row.refused, row.ratio >= 1) << row.ratio;
    if (row.ratio < 1) {
      EXPECT_LT(row.implicit_error_kpa, 1e-8) << row.ratio;
      // The explicit inverse is a fixed-point iteration with the contraction factor `ratio`. If `ratio` is
      // below 1 and the target moves by at most d per sample, the error is at most d ratio / (1 - ratio).
      EXPECT_LT(row.explicit_error_kpa, row.ratio / (1 - row.ratio) * row.true_jump_kpa) << row.ratio;
    } else if (row.ratio > 1) {
      EXPECT_GT(row.explicit_error_kpa, 20) << row.ratio;
      EXPECT_GT(row.implicit_jump_kpa, 10 * row.true_jump_kpa) << row.ratio;
    }
  }
  EXPECT_NEAR(quick_study().inverses.back().ratio, 2.43, 0.005);
}

TEST(PublishedStudy, WritesValidJsonAndASelfContainedPage) {
  const auto json = nlohmann::json::parse(published_json(quick_study()));
  EXPECT_EQ(json.at("hidden_latency").size(), 3U);
  EXPECT_EQ(json.at("hidden_latency")[1].at("ratio").get<double>(), quick_study().latency[1].ratio);
  EXPECT_EQ(json.at("inverse").size(), quick_study().inverses.size());
  const std::string page = published_page(quick_study()).to_html();
  EXPECT_LT(page.size(), 1500000U);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/2000/svg"));
}

TEST(PaperTable, LatencyIncreasesTheErrorAboveTheNoise) {
  const std::vector<PaperRow> rows = paper_table({1, 100, 0.05, 4, 1});
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].signal, model::SignalName::tp1);
  EXPECT_EQ(rows[2].paper_mm, 0.540);
  for (const PaperRow& row : rows) {
    EXPECT_NEAR(row.published.rmse_mm, 0.05, 0.05 * 0.05) << model::name_of(row.signal);
    EXPECT_GT(row.twin.rmse_mm, 1.05 * row.published.rmse_mm) << model::name_of(row.signal);
    EXPECT_LT(row.twin.rmse_mm, row.paper_mm) << model::name_of(row.signal);
  }
}

}  // namespace
}  // namespace softgrip::studies::published_test
