#include "sysid/diagnosis/report/report_sections.h"

#include <string>

#include <gtest/gtest.h>

namespace softgrip::sysid::report_conditions_test {
namespace {

ConditionEvidence dependence_on(const std::string& id) {
  ConditionEvidence evidence;
  evidence.condition.id = id;
  evidence.condition.axis = "pressure [kPa]";
  evidence.bins = {{1, "", 0, 30, 0.1, 0.05, 0.15, 0.1}, {9, "", 0, 30, -0.1, -0.15, -0.05, 0.1}};
  evidence.clear = true;
  return evidence;
}

TEST(ReportConditions, EachSignificantConditionHasAChart) {
  Diagnosis diagnosis;
  diagnosis.evidence.emplace();
  diagnosis.evidence->recalibrated.conditions = {dependence_on("rate"), dependence_on("dwell"),
                                                 dependence_on("since_turn")};
  EXPECT_EQ(conditions_figure(diagnosis).charts.size(), 2U)
      << "a row has at most two charts, so three charts need two rows";
  diagnosis.evidence->recalibrated.conditions[1].clear = false;
  const Figure figure = conditions_figure(diagnosis);
  ASSERT_EQ(figure.charts.size(), 1U);
  ASSERT_EQ(figure.charts.front().size(), 2U);
  EXPECT_EQ(figure.charts.front()[0].title, "rate");
  EXPECT_EQ(figure.charts.front()[1].title, "since turn");
}

}  // namespace
}  // namespace softgrip::sysid::report_conditions_test
