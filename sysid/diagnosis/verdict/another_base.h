#pragma once
// Decides when to search for a richer base structure (the model structure without causes), and whether that
// structure explains the data better than the given one. base_findings.h contains the search.

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/base_findings.h"

namespace softgrip::sysid {

/// An unexplained error below this multiple of the noise is negligible.
inline constexpr double worth_a_look = 0.2;
/// Largest ratio of the unexplained mean squares after and before a missing component of the model is added.
inline constexpr double left_by_what_was_missing = 0.25;

/// Returns true if the base structure may be incomplete: the best single cause leaves more error than the
/// correct cause would leave on a complete base structure.
/// @param one_cause  the best selection of one cause on the given base structure.
[[nodiscard]] bool may_lack_a_base(const Selection& one_cause, double noise_mm);

/// Returns true if the rejected base structure has hysteresis of another shape but no asymmetric loop, and
/// its loss is at most slightly larger than that of the selection on the given base structure.
/// @param selected  held-out losses of that selection.
[[nodiscard]] bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected);
/// Adds hysteresis of another shape as an alternative to an asymmetric loop, if an asymmetric loop is named.
void add_another_shape(std::vector<NamedCause>& named);

/// Searches for another base structure, at most once. Keeps a reference to `data`, which must outlive the
/// object.
class AnotherBase {
 public:
  AnotherBase(const SearchData& data, BaseQuestion question);

  /// Searches for another base structure and stores it if one is found. Does not search if the logs seem to
  /// come from different fingers, and then returns a sentence that says so.
  [[nodiscard]] std::optional<std::string> ask(const Selection& selection, const StructureFit& recalibrated);
  /// Continues the search for causes on the found base structure. Keeps that structure only if it has a lower
  /// loss than the selection; see has_lower_loss().
  void go_on(const Selection& selection);
  void drop() { found_.reset(); }
  /// Adds the alternatives that the rejected base structure supports to the named causes; see
  /// another_shape_will_do().
  void add_alternatives(std::vector<NamedCause>& named) const;

  [[nodiscard]] bool is_found() const { return found_.has_value(); }
  /// Returns the found base structure. Requires is_found().
  [[nodiscard]] BaseFindings& found() { return *found_; }
  /// Returns the mean square of the residual of the found base structure [mm^2], or infinity if none was
  /// found.
  [[nodiscard]] double mean_square_mm2() const;
  /// Returns true if a base structure was found that explains the data and leaves at most 25 % of the
  /// unexplained mean square of the selection.
  [[nodiscard]] bool settles(const Selection& selection) const;

 private:
  const SearchData& data_;
  BaseQuestion question_;
  bool asked_ = false;
  std::optional<BaseFindings> found_;
  bool another_shape_will_do_ = false;
};

}  // namespace softgrip::sysid
