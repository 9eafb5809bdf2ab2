#pragma once
// Declares the causes that a diagnosis may name. Each cause is defined in a file of this folder (form.h
// documents its format), and registry.h lists all causes. The rest of the diagnosis includes only this
// header.

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

/// One form of a cause: a block that extends a model by the effect of the cause.
struct CauseForm {
  std::size_t type = 0;  ///< index of the block type in model::catalogue()
  /// True: the form has enough parameters to follow any slow signal. Its start point has all parameters at
  /// zero, so a scan of start points does not show how well the form fits.
  bool free_form = false;
  /// Returns the start points of fits. They lie within the declared bounds and cover the plausible range for
  /// data of these scales.
  std::vector<model::BlockSpec> (*starts)(const Scales& scales) = nullptr;
  /// Returns true if a block of this type has this form. If the pointer is null, every block of the type has
  /// this form.
  bool (*holds)(const model::BlockSpec& block) = nullptr;
  /// Returns true if a fit may change the parameter `index`. The other parameters keep their start values,
  /// such as the calibrated range of a sensor or a limit that the data do not reach.
  bool (*is_fitted)(std::size_t index) = nullptr;
  /// Returns the range in which a fit may change the parameter `index`, in addition to its declared bounds.
  /// Outside this range, the block would represent a different effect.
  Range (*range)(std::size_t index, const Scales& scales, const model::Model& model) = nullptr;
  /// Returns the reading of a sensor with this block at a displacement [mm]. If the pointer is null, the form
  /// is not a static sensor (sensor_shape).
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
  /// Id of the cause that gives the same readings as this cause for every command; empty: there is no such
  /// cause.
  std::string_view indistinguishable;
  std::span<const std::string_view> counterparts;
  std::span<const std::string_view> confounded_with;
  bool is_stop = false;
  bool makes_distinguishable = false;
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Description of the static shape of the sensor; empty: the cause is not a static sensor.
  std::string_view sensor_shape;
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
/// Returns the cause that has a form with this block type. Returns nullptr if the block belongs to the base
/// structure or describes the random error of the sensor, because such blocks are not causes.
[[nodiscard]] const Cause* cause_of(std::size_t block_type);

/// Returns the form of `cause` that `block` represents.
[[nodiscard]] const CauseForm& form_of(const Cause& cause, const model::BlockSpec& block);
/// Returns the form that `block` represents, from the forms of all `causes`. Returns nullptr if none of the
/// causes has a form that matches the block.
[[nodiscard]] const CauseForm* form_among(std::span<const Cause> causes, const model::BlockSpec& block);

/// Returns the index of the block in `model` that is a form of `cause`, or nullopt if there is no such block.
[[nodiscard]] std::optional<std::size_t> position_of(const model::Model& model, const Cause& cause);
/// Returns `model` without the block of `cause`.
[[nodiscard]] model::Model without(model::Model model, const Cause& cause);

/// Returns the reason why the data cannot test this cause, such as "needs a temperature_c column that
/// varies". Returns an empty string if the data can test the cause.
[[nodiscard]] std::string unanswerable(const Cause& cause, const Scales& scales);

/// Returns the start points of all forms of a cause. The list is empty if a fit cannot find the cause.
[[nodiscard]] std::vector<model::BlockSpec> starts_of(const Cause& cause, const Scales& scales);

}  // namespace softgrip::sysid
