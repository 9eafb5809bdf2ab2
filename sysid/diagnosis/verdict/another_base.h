#pragma once
// When a richer base is asked for, and whether it is the answer (base_findings.h looks for it).

#include <optional>
#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/base_findings.h"

namespace softgrip::sysid {

/// Structure below so many times the noise is none that matters.
inline constexpr double worth_a_look = 0.2;
/// What was missing leaves, once it is there, no more than so much of the mean square that stood without it.
inline constexpr double left_by_what_was_missing = 0.25;

/// Where another base is what is missing, one cause may make up for most of it, never for nearly all.
/// @param one_cause  the best selection of one cause on the given base.
[[nodiscard]] bool may_lack_a_base(const Selection& one_cause, double noise_mm);

/// Whether a base that is not kept does about as well as what was selected upon the given one, with
/// hysteresis of another shape and without an asymmetric loop.
/// @param selected  held-out losses of the selection.
[[nodiscard]] bool another_shape_will_do(const BaseFindings& base, const BlockLosses& selected);
/// Makes hysteresis of another shape a rival of an asymmetric loop, where one is named.
void add_another_shape(std::vector<NamedCause>& named);

/// A base that is asked for at most once. Refers to its data, which outlive it.
class AnotherBase {
 public:
  AnotherBase(const SearchData& data, BaseQuestion question);

  /// Where no cause on the given base explains the data, the base itself may be the finding. A sentence where
  /// logs are of different fingers, for which none is looked for.
  [[nodiscard]] std::optional<std::string> ask(const Selection& selection, const StructureFit& recalibrated);
  /// Goes on upon what was found, and keeps it where it then explains more than the selection does.
  void go_on(const Selection& selection);
  void drop() { found_.reset(); }
  /// What the base that was not kept has to say of the names upon the given one: another_shape_will_do().
  void add_rivals(std::vector<NamedCause>& named) const;

  [[nodiscard]] bool is_found() const { return found_.has_value(); }
  /// Of one that is found.
  [[nodiscard]] BaseFindings& found() { return *found_; }
  /// Infinite where none is found [mm^2].
  [[nodiscard]] double mean_square_mm2() const;
  /// Whether one is found that explains the data and leaves far less structure than the selection does.
  [[nodiscard]] bool settles(const Selection& selection) const;

 private:
  const SearchData& data_;
  BaseQuestion question_;
  bool asked_ = false;
  std::optional<BaseFindings> found_;
  bool another_shape_will_do_ = false;
};

}  // namespace softgrip::sysid
