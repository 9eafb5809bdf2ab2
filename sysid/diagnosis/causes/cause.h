#pragma once
// Causes: what a diagnosis may name. All that is known of one stands in its own file in this folder (form.h
// says what that is), and registry.h lists them; here is what the rest of the diagnosis asks.

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

/// A block by which a cause extends a model.
struct CauseForm {
  std::size_t type = 0;    ///< index in model::catalogue()
  bool free_form = false;  ///< as many numbers as it takes to follow anything slow: a fit finds each of them
                           ///< from zero, so that no look at a start tells what it is worth
  /// Where fits begin, spread over what is plausible at these scales, within the declared bounds.
  std::vector<model::BlockSpec> (*starts)(const Scales& scales) = nullptr;
  /// Whether a block of the type has this form; nullptr: any has.
  bool (*holds)(const model::BlockSpec& block) = nullptr;
  /// Whether a fit may move value `index`. A calibration range or a ceiling that the data do not reach stays
  /// where the start put it.
  bool (*is_fitted)(std::size_t index) = nullptr;
  /// Within what a fit may move value `index`, besides its declared bounds: as far as the block is still what
  /// it is called.
  Range (*range)(std::size_t index, const Scales& scales, const model::Model& model) = nullptr;
  /// What a sensor of this shape shows at a displacement [mm]; nullptr where it is none (sensor_shape).
  double (*shown_mm)(const model::BlockSpec& block, double displacement_mm) = nullptr;
};

/// One cause, as its file declares it (form.h).
struct Cause {
  std::string_view id;
  std::string_view title;
  model::Station station = model::Station::valve;
  std::span<const CauseForm> forms;
  bool found_by_fitting = true;
  Column needs = Column::none;
  std::span<const Advice> advice;
  std::string_view twin;  ///< id; empty: none
  std::span<const std::string_view> counterparts;
  std::span<const std::string_view> confounded_with;
  bool is_stop = false;
  bool parts_twins = false;
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  std::string_view sensor_shape;  ///< empty: no sensor without memory
  WhenChanged when_changed;

  [[nodiscard]] constexpr bool is_static_sensor() const { return !sensor_shape.empty(); }
  /// Whether its numbers may hold a share of the other's.
  [[nodiscard]] constexpr bool is_confounded_with(const Cause& other) const {
    return std::find(confounded_with.begin(), confounded_with.end(), other.id) != confounded_with.end();
  }
  constexpr bool operator==(const Cause& other) const { return id == other.id; }
};

/// All causes, in the order in which the signal meets their first forms.
[[nodiscard]] std::span<const Cause> all_causes();
[[nodiscard]] std::optional<Cause> find_cause(std::string_view id);
/// The cause of which this block type is a form, or nullptr: the base structure and the sensor's random error
/// are no causes.
[[nodiscard]] const Cause* cause_of(std::size_t block_type);

/// The form in which a block of one of the cause's types stands.
[[nodiscard]] const CauseForm& form_of(const Cause& cause, const model::BlockSpec& block);
/// The same of a block of any of these causes; nullptr: it is of none of them.
[[nodiscard]] const CauseForm* form_among(std::span<const Cause> causes, const model::BlockSpec& block);

/// Where the cause stands in a model, in whichever form, or nothing.
[[nodiscard]] std::optional<std::size_t> position_of(const model::Model& model, const Cause& cause);
/// The model without it.
[[nodiscard]] model::Model without(model::Model model, const Cause& cause);

/// Why the data cannot answer for this cause ("needs a temperature_c column that varies"), or empty.
[[nodiscard]] std::string unanswerable(const Cause& cause, const Scales& scales);

/// The starts of all forms. Empty for a cause that is not found by fitting a trajectory.
[[nodiscard]] std::vector<model::BlockSpec> starts_of(const Cause& cause, const Scales& scales);

}  // namespace softgrip::sysid
