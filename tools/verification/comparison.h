#pragma once
// Compares the results of two runs of the same command, number by number.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "model/model.h"

namespace softgrip::tools {

/// One value that differs.
struct Difference {
  std::string where;  ///< "identify.json: rmse_mm.tp1", "tp1/series.csv: residual_identified_mm, line 17"
  std::string reported;
  std::string recomputed;
};

/// The number of compared values, and the list of the differences.
struct Comparison {
  double tolerance = 0;  ///< relative tolerance; numbers that differ by less count as equal
  std::size_t numbers = 0;
  std::vector<Difference> differences;

  void compare(const std::string& where, double reported, double recomputed);
  void compare(const std::string& where, const std::string& reported, const std::string& recomputed);
};

/// Compares all numbers, texts and Booleans except durations, versions and paths.
void compare_json(const std::string& file, const nlohmann::ordered_json& reported,
                  const nlohmann::ordered_json& recomputed, Comparison& comparison);

/// Compares all cells and reports, for each column, the line with the largest difference. Different columns
/// or different numbers of lines count as one difference.
void compare_csv(const std::string& file, const std::string& reported, const std::string& recomputed,
                 Comparison& comparison);

/// Compares the blocks and their parameters.
void compare_models(const std::string& file, const model::Model& reported, const model::Model& recomputed,
                    Comparison& comparison);

}  // namespace softgrip::tools
