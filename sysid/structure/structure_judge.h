#pragma once
// Fits single structures to records and evaluates them on held-out readings. choose_structure() and
// ablation_of() use the class StructureJudge. A further test evaluates the predictions beyond the data. In a
// fit to a single stroke, large terms of the model may cancel each other. During a second stroke, the same
// terms may no longer cancel.

#include <cstddef>
#include <limits>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/held_out.h"
#include "sysid/logs/record.h"
#include "sysid/structure/resonance.h"
#include "sysid/structure/structure_choice.h"
#include "sysid/structure/structure_fit.h"

namespace softgrip::sysid {

/// Simulates the drive of each record twice in succession. Returns true if the response to each record stays
/// within the range of its readings, extended on both sides by the width of this range. Only creep and
/// training can make the second stroke differ from the first one, and both effects are smaller than a stroke.
[[nodiscard]] bool stays_bounded(const FitPoint& point, const std::vector<Record>& records);

/// Value `yes`: between any two neighbouring time constants, the chain of creep branches has one additional
/// time constant.
enum class RungsBetween { no, yes };

class StructureJudge {
 public:
  /// Largest number of iterations in a fold. A few iterations are sufficient, because the nonlinear
  /// parameters of a fold differ little from those of the fit to all readings.
  static constexpr int fold_iterations = 5;

  /// `records` and `options` must outlive the object.
  StructureJudge(const std::vector<Record>& records, const StructureChoiceOptions& options,
                 RungsBetween rungs = RungsBetween::no);

  [[nodiscard]] std::size_t blocks() const { return division_.blocks.size(); }

  /// Fits a structure to all readings. The fit starts from the parameters `near`, or from the default start
  /// points.
  [[nodiscard]] FittedStructure fit(const BaseStructure& structure, double ridge,
                                    const NonlinearNumbers* near = nullptr) const;

  /// Evaluates a structure. The fit starts from the default start points.
  [[nodiscard]] StructureTrial judge(const BaseStructure& structure, double ridge) const;
  /// Evaluates a fitted structure on held-out blocks.
  /// @param iterations  maximum number of iterations in each fold. The fit of a fold starts from the
  /// parameters of `whole`. 0: the nonlinear parameters stay fixed.
  [[nodiscard]] StructureTrial judge(const FittedStructure& whole, int iterations) const;
  /// Evaluates a structure. The fit starts from the nonlinear parameters `numbers` of a similar structure.
  /// @param below_mm  if the RMSE of the fit to all readings is not below this limit, the structure is not
  /// evaluated on held-out blocks.
  [[nodiscard]] StructureTrial judge_near(const BaseStructure& structure, double ridge,
                                          const NonlinearNumbers& numbers,
                                          double below_mm = std::numeric_limits<double>::infinity()) const;
  /// Evaluates a structure in which a regulator replaces the lag. The fit starts at the parameters of the
  /// trial with the lag.
  [[nodiscard]] StructureTrial judge_regulated(BaseStructure structure, const StructureTrial& lagging,
                                               double below_mm) const;
  /// Returns true if the held-out error of a trial is at most 1.1 times the noise of the readings (the lowest
  /// noise of all records). No further component can then reduce this error significantly.
  [[nodiscard]] bool is_noise(const StructureTrial& trial) const;
  /// Evaluates a trial after a resonance is added to it. The member `numbers` of the result keeps the values
  /// from the fit without the resonance.
  [[nodiscard]] StructureTrial judge_resonant(const StructureTrial& still, ResonanceFit resonance_fit) const;

 private:
  /// Returns the trial of a fit, without an evaluation on held-out blocks.
  [[nodiscard]] StructureTrial trial_with(const FittedStructure& whole) const;
  [[nodiscard]] StructureTrial judge_published(const BaseStructure& structure) const;
  void judge_held_out(StructureTrial& trial, const Refit& refit) const;

  const std::vector<Record>& records_;
  const StructureChoiceOptions& options_;
  StructureGrid grid_;
  Division division_;
};

}  // namespace softgrip::sysid
