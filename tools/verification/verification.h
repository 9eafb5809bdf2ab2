#pragma once
// Recomputes a report of identify, validate or diagnose from the inputs that the report names.
// Compares the results of two runs of the same command, value by value.

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "model/model.h"

namespace softgrip::tools {

/// A command that writes a report, and the name of its result file.
struct ReportKind {
  const char* command;
  const char* json;
};
inline constexpr std::array report_kinds{ReportKind{"identify", "identify.json"},
                                         ReportKind{"validate", "validate.json"},
                                         ReportKind{"diagnose", "diagnosis.json"}};

/// One value that differs between the two runs.
struct Difference {
  std::string where;  ///< file and position, for example "identify.json: rmse_mm.tp1" or "tp1/series.csv:
                      ///< residual_identified_mm, line 17"
  std::string reported;
  std::string recomputed;
};

/// The number of compared values, and the list of the differences.
struct Comparison {
  double tolerance = 0;  ///< relative tolerance; two numbers with a smaller relative difference count as
                         ///< equal
  std::size_t numbers = 0;
  std::vector<Difference> differences;

  void compare(const std::string& where, double reported, double recomputed);
  void compare(const std::string& where, const std::string& reported, const std::string& recomputed);
};

/// Compares all numbers, texts and Booleans of two JSON files, except durations, versions and paths.
void compare_json(const std::string& file, const nlohmann::ordered_json& reported,
                  const nlohmann::ordered_json& recomputed, Comparison& comparison);

/// Compares all cells of two CSV files. For each column, reports the line with the largest difference.
/// Different columns or different numbers of lines count as one difference.
void compare_csv(const std::string& file, const std::string& reported, const std::string& recomputed,
                 Comparison& comparison);

/// Compares the blocks of two models and the parameters of these blocks.
void compare_models(const std::string& file, const model::Model& reported, const model::Model& recomputed,
                    Comparison& comparison);

struct Verification {
  /// Sentences about inputs that prevent the comparison: a log that is missing or has changed, or a report
  /// that does not state its command line. If the list is not empty, nothing was compared.
  std::vector<std::string> missing;
  std::string reported_by;  ///< software and version that wrote the report
  std::string recomputed_by;
  Comparison comparison;
};

/// Repeats the command that wrote `folder` in a temporary folder, and compares the JSON result, the series
/// and the model of the two runs. Looks for each input file (log, model or gauge file) at its original path,
/// in `folder`, and in the folder that contains `folder`. The hash of each input file must equal the hash
/// that the report states for this file.
/// @param program    path of the program softgrip.
/// @param tolerance  relative tolerance.
[[nodiscard]] Verification verify_report(const std::string& folder, const std::string& program,
                                         double tolerance);

}  // namespace softgrip::tools
