#include "sysid/diagnosis/report/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "model/catalogue.h"
#include "sysid/diagnosis/report/report_sections.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/pages/canvas.h"
#include "tests/support/text.h"
#include "tests/sysid/diagnosis/campaign.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::report_test {
namespace {

StructureFit fit_of(const model::Model& model, const std::vector<Record>& records) {
  StructureFit fit;
  fit.point = {model, std::vector<StartState>(records.size())};
  for (std::size_t k = 0; k < records.size(); ++k) {
    fit.residual_mm.push_back(records[k].reading_mm);
    const std::vector<double> predicted = predict(model, records[k], fit.point.starts[k]);
    for (std::size_t i = 0; i < predicted.size(); ++i) fit.residual_mm.back()[i] -= predicted[i];
  }
  return fit;
}

NamedCause named(const char* id, double gain_mm2) {
  NamedCause cause;
  cause.cause = *find_cause(id);
  cause.block_type = *model::find_block(id);
  cause.parameters = {{"time_constant_s", "s", 0.08, {0.07, 0.09}, true}};
  cause.gain_percent = {40, 5, 30, 50};
  cause.gain_mm2 = {gain_mm2, 0.001, 0.9 * gain_mm2, 1.1 * gain_mm2};
  cause.inclusion = 0.97;
  return cause;
}

/// Returns a diagnosis that names a lag.
/// @param given  given model. The extended model is bench_twin, which also contains a delay and a lag.
Diagnosis a_diagnosis(const model::Model& given) {
  Diagnosis d;
  d.verdict = Verdict::ambiguous;
  d.records = known_campaign(2);
  d.as_given = fit_of(given, d.records);
  d.recalibrated = fit_of(given, d.records);
  d.recalibrated_model = d.extended_model = loaded("bench_twin");
  d.recalibrated_model.name = "zhang2025_recalibrated";
  d.extended_model.name = "zhang2025_extended";
  d.extended = fit_of(d.extended_model, d.records);
  d.causes = {named("valve_lag", 0.05)};
  d.causes.front().alternatives = {*find_cause("sensor_lag")};
  CandidateScore alternative;
  alternative.cause = *find_cause("sensor_lag");
  alternative.heldout_rmse_mm = 0.21;
  alternative.gain_percent = {38, 5, 28, 48};
  d.causes.front().candidates = {alternative};
  d.extended.causes = {d.causes.front().cause};
  d.as_given_rmse_mm = 0.5;
  d.recalibrated_rmse_mm = 0.3;
  d.extended_rmse_mm = 0.2;
  d.runs = {{"log_1", 0.5, 0.31, 0.2}, {"log_2", 0.5, 0.29, 0.2}};
  d.noise_mm = 0.1;
  return d;
}

/// Returns the left-aligned texts of the drawing that a line crosses. Other texts are not tested.
std::vector<std::string> crossed_words(const std::string& markup) {
  const std::regex words(R"re(<text x="([0-9.]+)" y="([0-9.]+)" text-anchor="start"[^>]*>([^<]+))re");
  const std::regex line(R"re(<path d="M(-?[0-9.]+) ?(-?[0-9.]+)l(-?[0-9.]+) ?(-?[0-9.]+)")re");
  std::vector<std::string> crossed;
  for (std::sregex_iterator word(markup.begin(), markup.end(), words), end; word != end; ++word) {
    const double left = std::stod((*word)[1]), baseline = std::stod((*word)[2]);
    const double right = left + text_width((*word)[3].str());
    for (std::sregex_iterator one(markup.begin(), markup.end(), line); one != end; ++one) {
      const Pixel from{std::stod((*one)[1]), std::stod((*one)[2])};
      for (int i = 0; i <= 100; ++i) {
        const double x = from.x + 0.01 * i * std::stod((*one)[3]);
        const double y = from.y + 0.01 * i * std::stod((*one)[4]);
        if (x <= left || x >= right || y <= baseline - 10 || y >= baseline + 2) continue;
        crossed.push_back((*word)[3]);
        break;
      }
    }
  }
  return crossed;
}

class ReportTest : public ::testing::Test {
 protected:
  model::Model given = loaded("zhang2025");
  Diagnosis diagnosis = a_diagnosis(given);
  std::vector<Log> logs;

  [[nodiscard]] Page page() const { return diagnosis_page({diagnosis, logs, given, 1, {}, {}}); }
};

TEST_F(ReportTest, ErrorBudgetPartsSumToTheRefittedMeanSquare) {
  const std::vector<BudgetPart> parts = budget_parts(diagnosis);
  ASSERT_EQ(parts.size(), 3U) << "the budget must have three parts: explained by the lag, unexplained, noise";
  double sum = 0;
  for (const BudgetPart& part : parts) sum += part.mm2;
  EXPECT_NEAR(sum, 0.09, 1e-12);
  EXPECT_NEAR(parts.front().mm2, 0.05, 1e-12);
  EXPECT_NEAR(parts[1].mm2, 0.04 - 0.01, 1e-12);
}

TEST_F(ReportTest, JointlyExplainedErrorIsAPartOfTheBudget) {
  diagnosis.causes = {named("valve_lag", 0.02), named("transport_delay", 0.01)};
  const std::vector<BudgetPart> parts = budget_parts(diagnosis);
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_EQ(parts[2].name, "Explained only by the combination of several causes");
  EXPECT_NEAR(parts[2].mm2, 0.02, 1e-12);
}

TEST_F(ReportTest, OverlappingCausesShareTheJointReduction) {
  diagnosis.causes = {named("valve_lag", 0.05), named("transport_delay", 0.05)};
  const std::vector<BudgetPart> parts = budget_parts(diagnosis);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_NEAR(parts[0].mm2, 0.025, 1e-12);
  EXPECT_NEAR(parts[1].mm2, 0.025, 1e-12);
}

TEST_F(ReportTest, NoLineCrossesAWordInAFigure) {
  Canvas canvas;
  canvas.words({10, 50}, Anchor::start, "crossed");
  canvas.words({10, 80}, Anchor::start, "not");
  canvas.line({90, 40}, {0, 48}, Colour::axis);
  EXPECT_EQ(crossed_words(canvas.markup()), std::vector<std::string>{"crossed"});
  for (const double as_given_mm : {0.31, 0.4, 0.9, 20.0}) {
    diagnosis.as_given_rmse_mm = as_given_mm;
    EXPECT_EQ(crossed_words(budget_figure(diagnosis).drawing->markup), std::vector<std::string>{});
  }
  EXPECT_EQ(crossed_words(chain_figure(diagnosis.extended_model, given).drawing->markup),
            std::vector<std::string>{});
}

TEST_F(ReportTest, ForestPlotHasARowPerCauseAndAlternative) {
  const Figure forest = forest_figure(diagnosis);
  ASSERT_TRUE(forest.drawing);
  ASSERT_EQ(forest.drawing->rows.size(), 2U);
  EXPECT_EQ(forest.drawing->rows[0][2], "40");
  EXPECT_EQ(forest.drawing->rows[1][1], "yes");
  EXPECT_EQ(forest.drawing->rows[1][3], "28");
  EXPECT_NE(forest.drawing->markup.find("38.0 (28.0 to 48.0)"), std::string::npos);
  EXPECT_NE(forest.drawing->markup.find("0.97"), std::string::npos);
}

TEST_F(ReportTest, ValveOfAClosedLoopHasNoErrorReduction) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  diagnosis.partial = {named("valve_lag", 0.05)};
  diagnosis.causes = {named("valve_deadband", unknown)};
  diagnosis.causes.front().gain_percent = {unknown, unknown, unknown, unknown};
  diagnosis.causes.front().inclusion = unknown;
  diagnosis.causes.front().only_in_loop = true;
  diagnosis.verdict = Verdict::partly_explained;
  diagnosis.loop_bands_kpa = {2.7};
  const Figure forest = forest_figure(diagnosis);
  ASSERT_EQ(forest.drawing->rows.size(), 2U);
  for (const std::size_t column : {2U, 3U, 4U, 5U}) EXPECT_EQ(forest.drawing->rows[0][column], "") << column;
  const std::vector<BudgetPart> parts = budget_parts(diagnosis);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts.front().name, "Explained by causes that are not reported");
  EXPECT_NEAR(parts.front().mm2, 0.05, 1e-12);
  const std::string html = page().to_html();
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("too small a part"), std::string::npos);
  EXPECT_NE(html.find("the test of the closed loop shows that the valve sticks"), std::string::npos);
}

TEST_F(ReportTest, InsignificantPartialCauseIsNotInTheForestPlot) {
  diagnosis.causes.clear();
  diagnosis.partial = {named("valve_lag", 0.02), named("transport_delay", 0.01)};
  diagnosis.partial.back().gain_percent = {7, 10, -8, 36};
  EXPECT_EQ(forest_figure(diagnosis).drawing->rows.size(), 1U);
  EXPECT_EQ(cause_parameter_table(diagnosis, 6).rows.size(), 1U);
  diagnosis.partial.erase(diagnosis.partial.begin());
  EXPECT_EQ(page().to_html().find("error reduction by cause"), std::string::npos);
}

TEST_F(ReportTest, BlockDiagramMarksAddedBlocks) {
  const Figure chain = chain_figure(diagnosis.extended_model, given);
  EXPECT_EQ(test::count_of(chain.drawing->markup, ", added<"), 2U) << "added blocks: delay and lag";
  EXPECT_NE(chain.drawing->markup.find("time constant = 0.044 s"), std::string::npos);
  EXPECT_NE(chain.drawing->markup.find("alpha = 0.211 mm/kPa"), std::string::npos);
  EXPECT_NE(chain.drawing->markup.find("gamma = 0.0163 1/kPa"), std::string::npos);
  EXPECT_EQ(test::count_of(chain_figure(given, given).drawing->markup, ", added<"), 0U);
}

TEST_F(ReportTest, OpensWithTheVerdictAndEndsWithTheAppendix) {
  const std::string html = page().to_html();
  std::size_t at = 0;
  for (const char* part :
       {"The model lacks", "Results", "error budget", "error reduction by cause", "Parameters of the causes",
        "block diagram", "error over time", "loops log_", "Method and evidence", "class=\"appendix\"",
        "Causes tested as alternatives to", "name: &quot;zhang2025_extended"}) {
    const std::size_t next = html.find(part, at);
    ASSERT_NE(next, std::string::npos) << part;
    at = next;
  }
  EXPECT_LT(html.size(), Page::most_bytes);
}

TEST_F(ReportTest, EveryFigureHasACaptionANumberAndData) {
  const Page report = page();
  const std::string html = report.to_html();
  ASSERT_GE(report.figures().size(), 5U);
  for (std::size_t i = 0; i < report.figures().size(); ++i) {
    const Figure& figure = report.figures()[i];
    EXPECT_GT(figure.caption.size(), 20U) << figure.name;
    EXPECT_GT(test::count_of(csv_of(figure), "\n"), 1U) << figure.name;
    EXPECT_NE(html.find("<b>Figure " + std::to_string(i + 1) + ".</b>"), std::string::npos) << figure.name;
  }
}

// Each model in the report must have its own name, so that readers can assign each result to its model.
TEST_F(ReportTest, EachModelHasADistinctName) {
  const std::string html = page().to_html();
  for (const char* name : {">given model<", ">recalibrated model<", ">extended model<", "zhang2025_extended"})
    EXPECT_NE(html.find(name), std::string::npos) << name;
}

TEST_F(ReportTest, InsignificantConditionsAreNotDrawn) {
  diagnosis.evidence.emplace();
  ConditionEvidence rate;
  rate.condition.id = "rate";
  rate.condition.axis = "rate of the pressure [kPa/s]";
  rate.bins = {{1, "", 0, 30, 0.1, 0.05, 0.15, 0.1}, {9, "", 0, 30, -0.1, -0.15, -0.05, 0.1}};
  diagnosis.evidence->recalibrated.conditions = {rate};
  diagnosis.evidence->recalibrated.spectrum.why_not = "too short";
  EXPECT_EQ(page().to_html().find("error by condition"), std::string::npos);
  diagnosis.evidence->recalibrated.conditions.front().clear = true;
  EXPECT_NE(page().to_html().find("rate of the pressure in kilopascals per second"), std::string::npos);
}

TEST_F(ReportTest, LogWithoutHysteresisLoopsGetsNoLoopFigure) {
  EXPECT_TRUE(has_loops(diagnosis.records.front()));
  for (Record& record : diagnosis.records) {
    for (std::size_t i = 0; i < record.size(); ++i) record.drive_kpa[i] = i < record.size() / 2 ? 0 : 40;
  }
  EXPECT_FALSE(has_loops(diagnosis.records.front())) << "a single pressure step has no hysteresis loops";
  EXPECT_EQ(page().to_html().find("\"loops log_"), std::string::npos);
}

TEST_F(ReportTest, ClosedLoopIsDrawnOnlyWithAModelBasedController) {
  ClosedLoopCurves curves{
      "13 ± 7 mm", {0, 1, 2}, {13, 20, 13}, {}, {"the extended model has no usable feedforward"}};
  curves.schemes = {{"PID alone", 1.5, {12, 18, 14}}};
  const std::string alone = diagnosis_page({diagnosis, logs, given, 1, {}, curves}).to_html();
  EXPECT_EQ(alone.find("In closed loop, "), std::string::npos);
  EXPECT_NE(alone.find("the extended model has no usable feedforward"), std::string::npos);
  EXPECT_NE(alone.find("No controller with a model was simulated in closed loop (13 ± 7 mm)"),
            std::string::npos);
  curves.schemes.push_back({"extended model", 0.02, {13, 20, 13.01}});
  EXPECT_NE(diagnosis_page({diagnosis, logs, given, 1, {}, curves}).to_html().find("In closed loop, "),
            std::string::npos);
}

TEST_F(ReportTest, LongParameterTablesShowOnlyMeasuredParameters) {
  NamedCause& many = diagnosis.causes.front();
  many.parameters.clear();
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"})
    many.parameters.push_back({name, "mm", 1, {0.9, 1.1}, name[0] > 'b' && name[0] < 'e'});
  const Table table = cause_parameter_table(diagnosis, 6);
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0][1], "c");
  EXPECT_EQ(table.rows[1][1], "d");
  EXPECT_EQ(table.rows[2][1], "and 5 more, listed in the appendix");
}

TEST_F(ReportTest, TheClosedLoopIsDrawnOverTime) {
  ClosedLoopCurves curves{"13 ± 7 mm", {0, 1, 2}, {13, 20, 13}, {}, {"simulated"}};
  curves.schemes = {{"PID alone", 1.5, {12, 18, 14}}, {"extended model", 0.02, {13, 20, 13.01}}};
  const Figure figure = closed_loop_figure(curves);
  ASSERT_EQ(figure.charts.size(), 2U);
  EXPECT_EQ(figure.charts[1].front().series.front().y[1], -2)
      << "the tracking error is displacement minus reference";
  EXPECT_NE(figure.caption.find("PID alone 1.5 mm, extended model 0.02 mm"), std::string::npos);
  const std::vector<Series>& drawn = figure.charts[0].front().series;
  EXPECT_EQ(drawn[1].colour, Colour::other)
      << "the colour of the recalibrated model is not used, because this model is missing";
  EXPECT_EQ(drawn[1].dash, Dash::dotted);
  EXPECT_EQ(drawn[2].colour, Colour::good);
}

}  // namespace
}  // namespace softgrip::sysid::report_test
