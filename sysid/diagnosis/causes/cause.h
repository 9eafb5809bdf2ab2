#pragma once
// Causes: what a diagnosis may name. They are the blocks of the catalogue, but for the base structure and the
// sensor's random error; what is added here is only where a search for each begins.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/residual/spectrum_peaks.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A block type that can be the cause of a misfit.
struct Cause {
  std::size_t type = 0;  ///< index in model::catalogue()
  std::string_view id;
  model::Station station = model::Station::valve;
};

/// All causes, in the order of the catalogue.
[[nodiscard]] const std::vector<Cause>& all_causes();
[[nodiscard]] std::optional<Cause> find_cause(std::string_view id);

/// What the data say about the sizes at which causes can work.
struct Scales {
  double span_mm = 0;             ///< of the displacement
  double largest_kpa = 0;         ///< of the drive
  double campaign_s = 0;          ///< all records together
  double sample_s = 0;            ///< shortest usual interval
  double largest_supply_kpa = 0;  ///< 0: no such column
  bool has_temperature = false;   ///< and it varies
  bool has_supply = false;        ///< and it varies
  bool has_valve = true;          ///< false: the measured pressure drives the model
  /// What stands out of the residual's spectrum, the clearest first.
  std::vector<Line> residual_lines;
};

/// A block of the cause's type from which a fit may start.
struct CauseStart {
  model::BlockSpec block;
};

/// Why the data cannot answer for this cause ("needs the column temperature_c"), or empty.
[[nodiscard]] std::string unanswerable(const Cause& cause, const Scales& scales);

/// The starts of a cause's fit, spread over what is plausible at these scales. Empty for a cause that is not
/// found by fitting a trajectory (outliers).
[[nodiscard]] std::vector<CauseStart> cause_starts(const Cause& cause, const Scales& scales);

/// Whether the block has parts (a zero that goes from knot to knot): as many numbers as it takes to follow
/// anything slow. A fit finds each of them from zero, so that no look at a start tells what it is worth.
[[nodiscard]] bool has_free_form(const Cause& cause, const model::BlockSpec& block);

/// Whether a fit may move value `index` of the cause's block. A calibration range or a ceiling that the data
/// do not reach stays where the start put it; of a block with several forms only those move that the start
/// has (the others stand at their neutral values).
[[nodiscard]] bool is_fitted(const Cause& cause, const model::BlockSpec& block, std::size_t index);

/// Between what a value may be.
struct Range {
  double lower = 0;
  double upper = 0;
};

/// Within what a fit may move value `index` of the cause's block in `model`, besides its declared bounds: as
/// far as the block is still what it is called. Beyond, it would pass as a form of something else (a
/// hysteresis wider than all pressures is a viscous branch) and stand as a rival that is none.
[[nodiscard]] Range fit_range(const Cause& cause, std::size_t index, const model::Model& model,
                              const Scales& scales);

/// The scales of a campaign, but for the residual's peaks.
[[nodiscard]] Scales scales_of(const std::vector<Record>& records);

}  // namespace softgrip::sysid
