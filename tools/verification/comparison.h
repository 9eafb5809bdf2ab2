#pragma once
// Two results of the same call, number by number.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "model/model.h"

namespace softgrip::tools {

/// One thing that is not what it was.
struct Difference {
  std::string where;  ///< "identify.json: rmse_mm.tp1", "tp1/series.csv: residual_identified_mm, line 17"
  std::string reported;
  std::string recomputed;
};

/// What was compared, and what differs.
struct Comparison {
  double tolerance = 0;  ///< relative; numbers within it are the same
  std::size_t numbers = 0;
  std::vector<Difference> differences;

  void compare(const std::string& where, double reported, double recomputed);
  void compare(const std::string& where, const std::string& reported, const std::string& recomputed);
};

/// All numbers, words and truths, but how long it took, by which version and where files lay.
void compare_json(const std::string& file, const nlohmann::ordered_json& reported,
                  const nlohmann::ordered_json& recomputed, Comparison& comparison);

/// All cells; of each column the line that differs most. Texts of other columns or lengths are one
/// difference.
void compare_csv(const std::string& file, const std::string& reported, const std::string& recomputed,
                 Comparison& comparison);

/// The blocks and their parameters.
void compare_models(const std::string& file, const model::Model& reported, const model::Model& recomputed,
                    Comparison& comparison);

}  // namespace softgrip::tools
