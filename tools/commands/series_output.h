#pragma once
// The series.csv of every log, beside what else identify, validate and diagnose write.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"
#include "sysid/logs/series.h"

namespace softgrip::tools {

/// Of logs that a model predicted, with the scores of these records; `held_out`: it was fitted to none of
/// them.
[[nodiscard]] std::vector<sysid::LogSeries> series_of(const std::vector<sysid::Log>& logs,
                                                      const std::vector<sysid::Record>& records,
                                                      const std::vector<sysid::Score>& scores,
                                                      const std::string& model, bool held_out);

/// Of a diagnosis: the model as it was given, recalibrated, and extended where it is; each as fitted to all
/// readings (what diagnosis.json says of held-out blocks was judged on others).
[[nodiscard]] std::vector<sysid::LogSeries> series_of(const sysid::Diagnosis& diagnosis,
                                                      const std::vector<sysid::Log>& logs);

/// Writes FOLDER/LOG/series.csv for each. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> write_series(const std::string& folder,
                                                           const std::vector<sysid::LogSeries>& series);

}  // namespace softgrip::tools
