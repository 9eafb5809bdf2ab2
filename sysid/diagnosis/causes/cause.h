#pragma once
// Declares the causes that a diagnosis may name. Each cause is defined in its own file in this folder (form.h
// documents the format), and registry.h lists them. This header is the interface to the rest of the
// diagnosis.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/causes/form.h"
#include "sysid/diagnosis/causes/scales.h"

namespace softgrip::sysid {

/// A form of a cause: a block that extends a model.
struct CauseForm {
  std::size_t type = 0;  ///< index in model::catalogue()
  /// True: the form has as many parameters as are necessary to follow any slow signal. A fit starts with all
  /// of them at zero, so a scan of the start point does not show how well the form fits.
  bool free_form = false;
  /// Returns the start points of fits. They cover the plausible range for data of these scales, within the
  /// declared bounds.
  std::vector<model::BlockSpec> (*starts)(const Scales& scales) = nullptr;
  /// Returns true if a block of this type has this form. nullptr: every block of the type has it.
  bool (*holds)(const model::BlockSpec& block) = nullptr;
  /// Returns true if a fit may change value `index`. The others keep their start value, such as a calibrated
  /// range or a limit that the data do not reach.
  bool (*is_fitted)(std::size_t index) = nullptr;
  /// Returns the range in which a fit may change value `index`, in addition to the declared bounds. Outside
  /// this range the block would represent a different effect.
  Range (*range)(std::size_t index, const Scales& scales, const model::Model& model) = nullptr;
  /// Returns the reading of a sensor of this shape at a displacement [mm]. nullptr: the form is not a static
  /// sensor (sensor_shape).
  double (*shown_mm)(const model::BlockSpec& block, double displacement_mm) = nullptr;
};

/// A cause, as declared in its file (form.h).
struct Cause {
  std::string_view id;
  std::string_view title;
  model::Station station = model::Station::valve;
  std::span<const CauseForm> forms;
  bool found_by_fitting = true;
  Column needs = Column::none;
  std::span<const Advice> advice;
  std::string_view indistinguishable;  ///< id of a cause with equal readings for every command; empty: none
  std::span<const std::string_view> counterparts;
  std::span<const std::string_view> confounded_with;
  bool is_stop = false;
  bool makes_distinguishable = false;
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  std::string_view sensor_shape;  ///< description of the static sensor shape; empty: not a static sensor
  WhenChanged when_changed;

  [[nodiscard]] constexpr bool is_static_sensor() const { return !sensor_shape.empty(); }
  /// Returns true if the parameters of this cause may absorb part of the effect of `other`.
  [[nodiscard]] constexpr bool is_confounded_with(const Cause& other) const {
    return std::find(confounded_with.begin(), confounded_with.end(), other.id) != confounded_with.end();
  }
  constexpr bool operator==(const Cause& other) const { return id == other.id; }
};

/// Returns all causes, sorted by the position of their first form in the signal path.
[[nodiscard]] std::span<const Cause> all_causes();
[[nodiscard]] std::optional<Cause> find_cause(std::string_view id);
/// Returns the cause that has this block type as a form. Returns nullptr for blocks that belong to the base
/// structure or are the random error of the sensor, because these are not causes.
[[nodiscard]] const Cause* cause_of(std::size_t block_type);

/// Returns the form of the cause that matches the block.
[[nodiscard]] const CauseForm& form_of(const Cause& cause, const model::BlockSpec& block);
/// Returns the form of the block, searched among the forms of all these causes, or nullptr if none of them
/// has it.
[[nodiscard]] const CauseForm* form_among(std::span<const Cause> causes, const model::BlockSpec& block);

/// Returns the position in a model of the block of this cause, in any of its forms, or an empty value.
[[nodiscard]] std::optional<std::size_t> position_of(const model::Model& model, const Cause& cause);
/// Returns the model without the block of the cause.
[[nodiscard]] model::Model without(model::Model model, const Cause& cause);

/// Returns the reason why the data cannot test this cause ("needs a temperature_c column that varies"), or an
/// empty string.
[[nodiscard]] std::string unanswerable(const Cause& cause, const Scales& scales);

/// Returns the start points of all forms. The list is empty for a cause that a fit of a trajectory cannot
/// find.
[[nodiscard]] std::vector<model::BlockSpec> starts_of(const Cause& cause, const Scales& scales);

}  // namespace softgrip::sysid
