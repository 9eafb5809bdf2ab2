#pragma once
// Declares the causes that a diagnosis may name. Each cause is defined in a file of this folder (form.h
// documents the format), and registry.h lists all causes. Other parts of the diagnosis include only this
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

/// One form of a cause: a block that adds the effect of the cause to a model.
struct CauseForm {
  std::size_t type = 0;  ///< index of the block type in model::catalogue()
  /// True: the form has enough parameters to follow any slow signal. The start point sets all parameters to
  /// zero, so a scan of start points gives no information about the form.
  bool free_form = false;
  /// Function that returns the start points of the fits. They lie within the bounds of the parameters and
  /// cover the plausible values for data with these scales.
  std::vector<model::BlockSpec> (*starts)(const Scales& scales) = nullptr;
  /// Function that returns true if the block represents this form. Null: every block of the type represents
  /// this form.
  bool (*holds)(const model::BlockSpec& block) = nullptr;
  /// Function that returns true if a fit may change the parameter `index`. Every other parameter keeps its
  /// start value, for example the calibrated range of a sensor or a limit that the data do not reach.
  bool (*is_fitted)(std::size_t index) = nullptr;
  /// Function that returns the range in which a fit may change the parameter `index`. The bounds of the
  /// parameter apply too. Outside the returned range, the block would represent a different effect.
  Range (*range)(std::size_t index, const Scales& scales, const model::Model& model) = nullptr;
  /// Function that returns the reading of a sensor with this block [mm] at a displacement [mm]. Null: the
  /// form does not describe the static curve of a sensor (sensor_shape).
  double (*shown_mm)(const model::BlockSpec& block, double displacement_mm) = nullptr;
};

/// A cause as it is declared in its file (see form.h).
struct Cause {
  std::string_view id;
  std::string_view title;
  model::Station station = model::Station::valve;
  std::span<const CauseForm> forms;
  bool found_by_fitting = true;
  Column needs = Column::none;
  std::span<const Advice> advice;
  /// Id of a cause that leads to the same readings as this cause for every command; empty: there is no such
  /// cause.
  std::string_view indistinguishable;
  std::span<const std::string_view> counterparts;
  std::span<const std::string_view> confounded_with;
  bool is_stop = false;
  bool makes_distinguishable = false;
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Description of the static curve of the sensor, for example "a nonlinear sensor scale"; empty: the cause
  /// does not change this curve.
  std::string_view sensor_shape;
  WhenChanged when_changed;

  [[nodiscard]] constexpr bool is_static_sensor() const { return !sensor_shape.empty(); }
  /// Returns true if a fit of this cause may absorb part of the effect of `other`.
  [[nodiscard]] constexpr bool is_confounded_with(const Cause& other) const {
    return std::find(confounded_with.begin(), confounded_with.end(), other.id) != confounded_with.end();
  }
  constexpr bool operator==(const Cause& other) const { return id == other.id; }
};

/// Returns all causes, sorted by the position of their first form in the signal path.
[[nodiscard]] std::span<const Cause> all_causes();
[[nodiscard]] std::optional<Cause> find_cause(std::string_view id);
/// Returns the cause that has a form with this block type. Returns nullptr if the block belongs to the base
/// structure or describes the random error of the sensor, because such a block is not a cause.
[[nodiscard]] const Cause* cause_of(std::size_t block_type);

/// Returns the form of `cause` to which `block` belongs, or the last form if no form matches.
[[nodiscard]] const CauseForm& form_of(const Cause& cause, const model::BlockSpec& block);
/// Returns the form to which `block` belongs. Only the forms of `causes` are considered. Returns nullptr if
/// no form matches the block.
[[nodiscard]] const CauseForm* form_among(std::span<const Cause> causes, const model::BlockSpec& block);

/// Returns the index of the block in `model` that belongs to a form of `cause`, or nullopt if the model has
/// no such block.
[[nodiscard]] std::optional<std::size_t> position_of(const model::Model& model, const Cause& cause);
/// Returns `model` without the block of `cause`.
[[nodiscard]] model::Model without(model::Model model, const Cause& cause);

/// Returns the reason why the data cannot test this cause, for example "needs a temperature_c column that
/// varies". Returns an empty string if the data can test the cause.
[[nodiscard]] std::string unanswerable(const Cause& cause, const Scales& scales);

/// Returns the start points of all forms of a cause. The list is empty for a cause that is not found by fits,
/// such as outliers.
[[nodiscard]] std::vector<model::BlockSpec> starts_of(const Cause& cause, const Scales& scales);

/// Returns the cause in another component that leads to the same readings as `cause` for every command.
/// Example: stiffening of the finger and a nonlinear sensor are both unknown functions of the displacement,
/// so a fit cannot show which one is present. Returns nullopt if there is no such cause. Returns nullopt too
/// if `model` has a block with memory between the two components, because the readings then differ
/// (Cause::makes_distinguishable).
[[nodiscard]] std::optional<Cause> indistinguishable_from(const Cause& cause, const model::Model& model);

/// Returns the causes that may explain the effect of `cause` in its place, in the order of testing. An
/// actuator or load cause has sensor causes as counterparts. A sensor cause has actuator and load causes as
/// counterparts. The list is empty if `cause` is not a static nonlinearity.
[[nodiscard]] std::vector<Cause> sensor_counterparts(const Cause& cause);

/// Returns true if no command can separate the two causes. The function assumes that all other blocks of
/// `model` are correct.
[[nodiscard]] bool are_indistinguishable(const Cause& one, const Cause& other, const model::Model& model);

}  // namespace softgrip::sysid
