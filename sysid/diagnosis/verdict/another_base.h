#pragma once
// Decides when to search for a richer base structure, and whether it explains the data better than the given
// base structure. A base structure is a model structure without causes. base_findings.h contains the search.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/base_findings.h"

namespace softgrip::sysid {

/// Limit below which an unexplained error is negligible, as a multiple of the noise.
inline constexpr double worth_a_look = 0.2;
/// Largest ratio of two unexplained mean squares, after and before an addition to the model. If the ratio is
/// larger, the addition is not accepted as the missing component.
inline constexpr double left_by_what_was_missing = 0.25;

/// Returns true if the base structure may be incomplete. In this case, the best single cause leaves a larger
/// error than the true cause would leave on a complete base structure.
/// @param one_cause  best selection of one cause on the given base structure.
[[nodiscard]] bool may_lack_a_base(const Selection& one_cause, double noise_mm);

/// Returns true if the rejected base structure supports the alternative that the hysteresis has a different
/// shape. The rejected base structure must contain hysteresis of a different shape but no asymmetric loop.
/// Its loss must be at most slightly larger than that of the selection on the given base structure.
/// @param selected  held-out losses of this selection.
[[nodiscard]] bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected);
/// Adds the cause "hysteresis of another shape" as an alternative to each named asymmetric loop.
void add_another_shape(std::vector<NamedCause>& named);

/// Searches for another base structure, at most once. The object keeps a reference to `data`, which must
/// outlive it.
class AnotherBase {
 public:
  AnotherBase(const SearchData& data, BaseQuestion question);

  /// Searches for another base structure and stores the result if there is one. If the logs seem to come from
  /// different fingers, returns a sentence with this reason instead of searching.
  [[nodiscard]] std::optional<std::string> ask(const Selection& selection, const StructureFit& recalibrated);
  /// Continues the search for causes on the base structure that was found. Keeps this base structure only if
  /// has_lower_loss() is true.
  void go_on(const Selection& selection);
  void drop() { found_.reset(); }
  /// Adds alternatives to the named causes if the rejected base structure supports them
  /// (another_shape_will_do()).
  void add_alternatives(std::vector<NamedCause>& named) const;

  [[nodiscard]] bool is_found() const { return found_.has_value(); }
  /// Returns the base structure that was found. is_found() must be true.
  [[nodiscard]] BaseFindings& found() { return *found_; }
  /// Returns the mean square of the residual of the base structure that was found [mm^2]. Returns infinity if
  /// none was found.
  [[nodiscard]] double mean_square_mm2() const;
  /// Returns true if a base structure was found whose unexplained mean square is at most 25 % of that of the
  /// selection.
  [[nodiscard]] bool settles(const Selection& selection) const;

 private:
  const SearchData& data_;
  BaseQuestion question_;
  bool asked_ = false;
  std::optional<BaseFindings> found_;
  bool another_shape_will_do_ = false;
};

}  // namespace softgrip::sysid
