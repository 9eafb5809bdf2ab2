#include "control/sequences/sequence_file.h"

#include "control/sequences/parameters.h"
#include "control/sequences/sequence_plans.h"

namespace softgrip::control {

namespace {

using document::Problems;

/// Fits a sequence to a rig with other values of its parameters, to find the problems that these values
/// cause. Computes no plan.
class Variation {
 public:
  Variation(const Sequence& sequence, const RigSettings& settings) : settings_(settings) {
    Problems told;  // problems that were reported when the sequence was read with its defaults
    document_ = document::parse(sequence.file, sequence.text, told);
  }

  [[nodiscard]] const document::Document& document() const { return document_; }
  [[nodiscard]] Judge judge() const {
    return [this](const std::vector<Parameter>& parameters) {
      Problems found;
      const auto sequence = read_with(document_, parameters, found);
      if (sequence) static_cast<void>(fit_to_rig(*sequence, settings_, found));
      return found;
    };
  }

 private:
  const RigSettings& settings_;
  document::Document document_;
};

void report_misfits(const Sequence& sequence, const RigSettings& settings, const Problems& found,
                    Problems& problems) {
  if (sequence.parameters.empty()) {
    for (const document::Problem& problem : found.list()) problems.add(problem);
    return;
  }
  const Variation variation(sequence, settings);
  blame_values(variation.document(), sequence.parameters, variation.judge(), problems);
}

}  // namespace

std::optional<PreparedSequence> prepare(const Sequence& sequence, const RigSettings& settings,
                                        document::Problems& problems, const std::stop_token& stop) {
  const std::size_t before = problems.size();
  Problems found;
  PreparedSequence result = fit_to_rig(sequence, settings, found);
  if (!found.empty()) {
    report_misfits(sequence, settings, found, problems);
    return std::nullopt;
  }
  plan_motion(sequence, settings, result, problems, stop);
  if (problems.size() != before) return std::nullopt;
  return result;
}

void check_ranges(const Sequence& sequence, const RigSettings& settings, document::Problems& problems) {
  if (sequence.parameters.empty()) return;
  const Variation variation(sequence, settings);
  blame_ends(variation.document(), sequence.parameters, variation.judge(), problems);
}

}  // namespace softgrip::control
