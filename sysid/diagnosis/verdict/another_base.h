#pragma once
// Decides when a richer base is searched for, and if it explains the data better (base_findings.h searches
// for it).

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/base_findings.h"

namespace softgrip::sysid {

/// An unexplained error below this multiple of the noise is negligible.
inline constexpr double worth_a_look = 0.2;
/// Largest share of the mean square that remains if a missing base is added.
inline constexpr double left_by_what_was_missing = 0.25;

/// Returns true if the base may be incomplete. One cause can then compensate for most of the error, but never
/// for nearly all of it.
/// @param one_cause  the best selection of one cause on the given base.
[[nodiscard]] bool may_lack_a_base(const Selection& one_cause, double noise_mm);

/// Returns true if the rejected base has hysteresis of another shape, no asymmetric loop, and about the same
/// loss as the selection on the given base.
/// @param selected  held-out losses of the selection.
[[nodiscard]] bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected);
/// Adds hysteresis of another shape as an alternative to an asymmetric loop, if one is named.
void add_another_shape(std::vector<NamedCause>& named);

/// Searches for another base, at most once. Refers to its data, which must outlive it.
class AnotherBase {
 public:
  AnotherBase(const SearchData& data, BaseQuestion question);

  /// Searches for another base if no cause on the given base explains the data. Returns a sentence, without a
  /// search, if the logs come from different fingers.
  [[nodiscard]] std::optional<std::string> ask(const Selection& selection, const StructureFit& recalibrated);
  /// Continues the search for causes on the found base. Keeps the base only if it then explains more than the
  /// selection.
  void go_on(const Selection& selection);
  void drop() { found_.reset(); }
  /// Adds the alternatives that the rejected base supports to the named causes; see another_shape_will_do().
  void add_alternatives(std::vector<NamedCause>& named) const;

  [[nodiscard]] bool is_found() const { return found_.has_value(); }
  /// Requires is_found().
  [[nodiscard]] BaseFindings& found() { return *found_; }
  /// Returns the mean square of the found base [mm^2], or infinity without one.
  [[nodiscard]] double mean_square_mm2() const;
  /// Returns true if a base is found that explains the data and leaves far less unexplained error than the
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
