#include "tools/client/daemon_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::tools::sequence_view_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(SequenceView, ListsParametersWithRangesAndTheProblemsOfSequences) {
  const Json sequences = Json::parse(R"([
    {"name": "pick", "about": "closes", "problems": [], "parameters": [
      {"name": "squeeze_kpa", "unit": "kpa", "lower": 3, "upper": 10, "default": 5, "about": "how hard"},
      {"name": "rounds", "unit": "", "lower": 1, "upper": 20, "default": 1, "about": "how often"},
      {"name": "rise", "unit": "kpa_per_s", "lower": 0.5, "upper": 2, "default": 1, "about": "how fast"}]},
    {"name": "bad\u001b", "about": "", "parameters": [], "problems": [
      {"file": "bad.yaml", "line": 2, "column": 1, "line_text": "x", "message": "wrong", "hint": "right"}]}])");
  EXPECT_EQ(view_of_sequences(sequences),
            (std::vector<std::string>{"pick: closes", "  squeeze_kpa  3 to 10 kPa, default 5: how hard",
                                      "  rounds       1 to 20, default 1: how often",
                                      "  rise         0.5 to 2 kPa/s, default 1: how fast", "bad\\x1b",
                                      "  cannot be started:\nbad.yaml:2:1: wrong (right)"}));
  EXPECT_EQ(names_of_sequences(sequences), (std::vector<std::string>{"pick", "bad\\x1b"}));
}

}  // namespace
}  // namespace softgrip::tools::sequence_view_test
