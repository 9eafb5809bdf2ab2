#pragma once
// The base of a finger: what its healthy logs say it does, frozen, and how far that is to be trusted.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/extension.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/changes/regulator.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The column that is judged. For `pressure` the model leads from the command to pressure_kpa, and each name
/// below that ends with _mm is in kPa.
enum class Judged { displacement, pressure };
[[nodiscard]] constexpr const char* name_of(Judged judged) {
  return judged == Judged::pressure ? "pressure" : "displacement";
}
[[nodiscard]] inline std::string unit_of(Judged judged, model::OutputUnit output_unit) {
  return judged == Judged::pressure ? "kPa" : std::string(model::name_of(output_unit));
}

struct Base {
  Judged judged = Judged::displacement;
  Drive drive = Drive::command;
  std::string description;  ///< of the model that was chosen
  model::Model model;       ///< without blocks: the regulator's pressure, or the filter bank alone
  FilterKind kind = FilterKind::finger;
  std::optional<Regulator> regulator;  ///< between the command and the model
  double largest_kpa = 0;
  Eigen::VectorXd filter_weights;
  double temperature_c = 20;  ///< of the healthy logs, mean
  double gain_per_c = 0;      ///< that the healthy logs show
  double noise_mm = 0;        ///< of the readings, sample to sample
  Units units;                ///< of the healthy records
  double left_mm = 0;         ///< what the base leaves of units that are left out, about their means
  double span_mm = 0;
  double gain_spread = 0;  ///< from unit to unit of the healthy logs, relative
  double zero_mm = 0;      ///< mean of the healthy readings minus the prediction
  double zero_spread_mm = 0;
  double bin_s = 0.05;
  Whitener whitener;
  std::vector<Record> records;  ///< the healthy ones, thinned
  Binned left;                  ///< residual of each unit while it was left out
};

struct BaseOptions {
  std::optional<model::Model> given;  ///< as it is used today: one of the models that may be the base
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// @param records  healthy, at full rate.
[[nodiscard]] Base fit_base(const std::vector<Record>& records, Judged judged, Drive drive,
                            const BaseOptions& options);

/// Length of a bin in which a finger behind a measured pressure is judged [s].
[[nodiscard]] double finger_bin_s(const std::vector<Record>& records);
/// Reading minus the prediction of play operators and creep that were fitted without the unit of the reading,
/// in bins. NaN in the first readings of a record, from which its start is estimated.
/// @param records  healthy, driven as `drive` says.
[[nodiscard]] Binned left_out_by_play(const std::vector<Record>& records, Drive drive, double bin_s,
                                      unsigned threads);

/// A record behind the valve of a base, the model's prediction there, and what the filter bank adds to it.
struct Driven {
  Record record;       ///< driven by what the finger sees at the samples
  Record walked;       ///< what `model` is walked along: that, or the command itself
  model::Model model;  ///< the base's, with what happens to the command in front where it can carry it
  Eigen::VectorXd filters;
  StartState start;  ///< of the model, without offset
  std::vector<double> plain;
};
/// @param valve  what happens to the command before the base sees it. @param fault  of the base's regulator.
/// @param start  where the record begins; without it, estimated from the record's first readings.
[[nodiscard]] Driven driven_by(const Base& base, const Record& record,
                               const std::vector<model::BlockSpec>& valve = {},
                               const RegulatorFault& fault = {}, const StartState* start = nullptr);

/// Prediction of the base with `extension`, without an offset.
/// @param driven  driven_by() of the record, where it is known already.
[[nodiscard]] std::vector<double> predict_base(const Base& base, const Record& record,
                                               const Extension& extension, const Driven* driven = nullptr);

/// As a search for changes walks it, some samples in every bin: a valve answers sooner than a finger.
[[nodiscard]] Record thinned_for(const Base& base, const Record& record);

/// Reading minus prediction of the unchanged base, sample by sample.
[[nodiscard]] std::vector<std::vector<double>> residuals_of(const Base& base,
                                                            const std::vector<Record>& records);

/// Records whose reading is the measured pressure [kPa] and whose drive the command.
[[nodiscard]] std::vector<Record> pressure_records(const std::vector<Log>& logs, bool held);

}  // namespace softgrip::sysid
