#include "tools/figures/figure_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"

namespace softgrip::tools::figure_files_test {
namespace {

TEST(FigureFiles, WritesEachFigureAsSvgPdfAndCsv) {
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path();
  sysid::Chart chart;
  chart.x.label = "time [s]";
  chart.y.label = "error [mm]";
  chart.series = {sysid::Series{.label = "model", .x = {0, 1}, .y = {0.5, 0.25}, .y_upper = {}}};
  sysid::Drawing drawing;
  drawing.header = {"cause", "gain"};
  drawing.rows = {{"Valve lag, first order", "61"}};
  const std::vector<sysid::Figure> figures{{"error over time", "", {{chart}}}, {"forest", "", {}, drawing}};
  ASSERT_TRUE(write_figures(folder.string(), figures));
  for (const std::string stem : {"figure-1-error-over-time", "figure-2-forest"}) {
    for (const char* ending : {".svg", ".pdf", ".csv"})
      EXPECT_TRUE(std::filesystem::is_regular_file(folder / (stem + ending))) << stem << ending;
  }
  EXPECT_EQ(*read_file((folder / "figure-1-error-over-time.csv").string(), 10000),
            "time [s],model: error [mm]\n0,0.5\n1,0.25\n");
  EXPECT_EQ(*read_file((folder / "figure-2-forest.csv").string(), 10000),
            "cause,gain\n\"Valve lag, first order\",61\n");
}

TEST(FigureFiles, SucceedsWithoutAFolder) {
  EXPECT_TRUE(write_figures("", {sysid::Figure{}}));
}

TEST(FigureFiles, AReportConsistsOfFilesPageAndFigures) {
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path();
  sysid::Page page("Title", "Verdict", sysid::Tone::good);
  page.figure({"forest", "", {}, sysid::Drawing{.markup = "", .header = {"cause"}, .rows = {{"leak"}}}});
  ASSERT_TRUE(write_report((folder / "out").string(), {{"result.json", "{}\n"}}, page,
                           (folder / "figures").string()));
  EXPECT_EQ(*read_file((folder / "out/result.json").string(), 10000), "{}\n");
  EXPECT_EQ(*read_file((folder / "out/report.html").string(), 100000), page.to_html());
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "figures/figure-1-forest.csv"));
  ASSERT_TRUE(write_report("", {{"result.json", "{}\n"}}, page, ""));
  EXPECT_FALSE(std::filesystem::exists("result.json"));
}

}  // namespace
}  // namespace softgrip::tools::figure_files_test
