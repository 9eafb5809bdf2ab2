#pragma once
// Decides when a richer base structure is searched, and if it explains the data better than the given base
// structure. A base structure is a model structure without causes. base_findings.h contains the search.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/base_findings.h"

namespace softgrip::sysid {

/// Unexplained error below which no other base structure is searched, as a multiple of the noise.
inline constexpr double worth_a_look = 0.2;
/// Largest ratio of the unexplained mean squares after and before an addition to the model. An addition with
/// a larger ratio is not accepted as the missing component.
inline constexpr double left_by_what_was_missing = 0.25;

/// Returns true if the base structure may be incomplete. This is the case if the best single cause leaves a
/// larger error than the true cause would leave on a complete base structure.
/// @param one_cause  best selection with one cause on the given base structure.
[[nodiscard]] bool may_lack_a_base(const Selection& one_cause, double noise_mm);

/// Returns true if a rejected base structure supports the alternative "hysteresis of another shape". Two
/// conditions must hold. The rejected base structure contains hysteresis of a different shape, but no
/// asymmetric loop. Its held-out RMSE exceeds that of the selection on the given base structure by less than
/// 10 %.
/// @param selected  held-out losses of the selection.
[[nodiscard]] bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected);
/// Adds "hysteresis of another shape" to the alternatives of each named asymmetric loop.
void add_another_shape(std::vector<NamedCause>& named);

/// Searches at most once for another base structure. The object keeps a reference to `data`, so `data` must
/// outlive the object.
class AnotherBase {
 public:
  AnotherBase(const SearchData& data, BaseQuestion question);

  /// Searches for another base structure and stores the result. If the logs seem to come from different
  /// fingers, does not search and returns a sentence with this reason.
  [[nodiscard]] std::optional<std::string> ask(const Selection& selection, const StructureFit& recalibrated);
  /// Searches for causes on the base structure that was found. Drops this base structure if has_lower_loss()
  /// is false.
  void go_on(const Selection& selection);
  void drop() { found_.reset(); }
  /// Adds alternatives to the named causes if another_shape_will_do() is true for the rejected base
  /// structure.
  void add_alternatives(std::vector<NamedCause>& named) const;

  [[nodiscard]] bool is_found() const { return found_.has_value(); }
  /// Returns the base structure that was found. Call this function only if is_found() is true.
  [[nodiscard]] BaseFindings& found() { return *found_; }
  /// Returns the mean square of the residual of the base structure that was found [mm^2], or infinity if no
  /// base structure was found.
  [[nodiscard]] double mean_square_mm2() const;
  /// Returns true if a base structure was found that explains the data better than the selection. Its
  /// unexplained mean square must be less than 25 % of that of the selection. In addition, it must not leave
  /// too large an error (leaves_too_much()).
  [[nodiscard]] bool settles(const Selection& selection) const;

 private:
  const SearchData& data_;
  BaseQuestion question_;
  bool asked_ = false;
  std::optional<BaseFindings> found_;
  bool another_shape_will_do_ = false;
};

}  // namespace softgrip::sysid
