#include "sysid/diagnosis/verdict/another_base.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/statistics.h"
#include "sysid/diagnosis/causes/asymmetric_hysteresis.h"
#include "sysid/diagnosis/causes/hysteresis_shape.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/verdict/data_warnings.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Largest share of the mean square above the noise that may remain if the true cause is in the model. This
/// error remains because the equation of the cause is inexact. With softening, a share of 0.009 remains in
/// the test cases of tests/blind. A cause that only imitates a hysteresis loop of a different shape leaves a
/// share of 0.1 in the textbook test cases.
constexpr double left_by_its_own_cause = 0.03;

}  // namespace

bool may_lack_a_base(const Selection& one_cause, double noise_mm) {
  const double left_mm = one_cause.left.excess_mm;
  if (!one_cause.left.present || left_mm < worth_a_look * noise_mm) return false;
  return left_mm > noise_mm ||
         square(left_mm) > left_by_its_own_cause * square(one_cause.base_unexplained.excess_mm);
}

bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected) {
  return rmse_mm(base.losses) < (1 + limits::equal_error_share) * rmse_mm(selected) &&
         is_among(base.named, *find_cause(causes::HysteresisShape::id)) &&
         !is_among(base.named, *find_cause(causes::AsymmetricHysteresis::id));
}

void add_another_shape(std::vector<NamedCause>& named) {
  const Cause shape = *find_cause(causes::HysteresisShape::id);
  for (NamedCause& one : named) {
    const bool is_there =
        std::find(one.alternatives.begin(), one.alternatives.end(), shape) != one.alternatives.end();
    if (one.cause.id == causes::AsymmetricHysteresis::id && !is_there) one.alternatives.push_back(shape);
  }
}

AnotherBase::AnotherBase(const SearchData& data, BaseQuestion question)
    : data_(data), question_(std::move(question)) {}

std::optional<std::string> AnotherBase::ask(const Selection& selection, const StructureFit& recalibrated) {
  if (asked_) return std::nullopt;
  asked_ = true;
  if (auto inconsistent = inconsistent_among(data_.records, recalibrated, selection.extended.mean_square_mm2))
    return inconsistent;
  if (question_.progress) question_.progress("search for another model structure");
  found_ = find_base({data_, selection, question_});
  return std::nullopt;
}

void AnotherBase::go_on(const Selection& selection) {
  if (!found_) return;
  const BaseSearch search{data_, selection, question_};
  const UnexplainedError left =
      unexplained_error_of(found_->fit.residual_mm, question_.noise_mm, data_.scales.step_mm);
  if (leaves_too_much(left, selection.base_unexplained, question_.noise_mm)) {
    find_causes_upon(*found_, search, upon_much_left);
  } else if (left.present && left.excess_mm > limits::tolerated_noise * question_.noise_mm) {
    const bool measured = question_.drive == Drive::measured;
    find_causes_upon(*found_, search, measured ? upon_little_left_measured : upon_little_left);
  }
  const bool plain_explains =
      !leaves_too_much(selection.left, selection.base_unexplained, question_.noise_mm);
  if (has_lower_loss(*found_, selection, question_.noise_mm, plain_explains)) return;
  another_shape_will_do_ = another_shape_will_do(*found_, selection.extended_losses);
  found_.reset();
}

void AnotherBase::add_alternatives(std::vector<NamedCause>& named) const {
  if (another_shape_will_do_) add_another_shape(named);
}

double AnotherBase::mean_square_mm2() const {
  return found_ ? found_->fit.mean_square_mm2 : std::numeric_limits<double>::infinity();
}

bool AnotherBase::settles(const Selection& selection) const {
  if (!found_) return false;
  const UnexplainedError left =
      unexplained_error_of(found_->fit.residual_mm, question_.noise_mm, data_.scales.step_mm);
  return !leaves_too_much(left, selection.base_unexplained, question_.noise_mm) &&
         square(left.excess_mm) < left_by_what_was_missing * square(selection.left.excess_mm);
}

}  // namespace softgrip::sysid
