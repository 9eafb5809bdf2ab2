#pragma once
// The base of a finger: a model that is fitted to its healthy logs and then kept constant, with its
// uncertainty.

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

/// The column that is compared with the base. For `pressure`, the model leads from the command to
/// pressure_kpa, and every name below that ends with _mm is in kPa.
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
  std::string description;  ///< description of the selected model
  model::Model model;       ///< without blocks: only the regulator, or only the filter bank
  FilterKind kind = FilterKind::finger;
  std::optional<Regulator> regulator;  ///< between the command and the model
  double largest_kpa = 0;
  Eigen::VectorXd filter_weights;
  double temperature_c = 20;  ///< mean of the healthy logs
  double gain_per_c = 0;      ///< temperature coefficient of the gain in the healthy logs
  double noise_mm = 0;        ///< sample-to-sample noise of the readings
  Units units;                ///< units of the healthy records
  double left_mm = 0;         ///< RMS residual of left-out units about their means
  double span_mm = 0;
  double gain_spread = 0;  ///< spread between units of the healthy logs, relative
  double zero_mm = 0;      ///< mean of the healthy readings minus the prediction
  double zero_spread_mm = 0;
  double bin_s = 0.05;
  Whitener whitener;
  std::vector<Record> records;  ///< healthy records, thinned
  Binned left;                  ///< residual of each left-out unit
};

struct BaseOptions {
  std::optional<model::Model> given;  ///< the model in use; one of the candidates for the base
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// Fits the base.
/// @param records  healthy, at the full sampling rate.
[[nodiscard]] Base fit_base(const std::vector<Record>& records, Judged judged, Drive drive,
                            const BaseOptions& options);

/// Returns the bin length for a finger with a measured pressure [s].
[[nodiscard]] double finger_bin_s(const std::vector<Record>& records);
/// Returns the reading minus the prediction of play operators and creep, in bins. They are fitted without the
/// unit of the reading. The first readings of a record, from which its start is estimated, are NaN.
/// @param records  healthy, with the drive that `drive` names.
[[nodiscard]] Binned left_out_by_play(const std::vector<Record>& records, Drive drive, double bin_s,
                                      unsigned threads);

/// A record behind the valve of a base, with the predictions of the model and the filter bank.
struct Driven {
  Record record;       ///< its drive is the input of the finger at the samples
  Record walked;       ///< record with which `model` is simulated: the same, or that of the command
  model::Model model;  ///< model of the base; it contains the valve blocks if that is possible
  Eigen::VectorXd filters;
  StartState start;  ///< initial state of the model, without offset
  std::vector<double> plain;
};
/// Simulates the valve of the base.
/// @param valve  additional blocks between the command and the base. @param fault  of the base's regulator.
/// @param start  initial state of the record; nullptr: it is estimated from the first readings.
[[nodiscard]] Driven driven_by(const Base& base, const Record& record,
                               const std::vector<model::BlockSpec>& valve = {},
                               const RegulatorFault& fault = {}, const StartState* start = nullptr);

/// Returns the prediction of the base with `extension`, without an offset.
/// @param driven  driven_by() of the record, if it is already known.
[[nodiscard]] std::vector<double> predict_base(const Base& base, const Record& record,
                                               const Extension& extension, const Driven* driven = nullptr);

/// Returns the record for a search for changes, with several samples in every bin. A valve responds faster
/// than a finger.
[[nodiscard]] Record thinned_for(const Base& base, const Record& record);

/// Returns the reading minus the prediction of the unchanged base for each sample.
[[nodiscard]] std::vector<std::vector<double>> residuals_of(const Base& base,
                                                            const std::vector<Record>& records);

/// Returns records whose reading is the measured pressure [kPa] and whose drive is the command.
[[nodiscard]] std::vector<Record> pressure_records(const std::vector<Log>& logs, bool held);

}  // namespace softgrip::sysid
