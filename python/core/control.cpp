
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <softgrip/softgrip.h>

#include "python/core/values.h"

namespace py = pybind11;

namespace softgrip::python {
namespace {

/// Limits as (pressure_min, pressure_max, slew_up, slew_down, displacement_min, displacement_max, rest).
using LimitsTuple = std::tuple<double, double, double, double, double, double, double>;
/// PID settings as (kp, ki, kd, derivative_filter, setpoint_weight, anti_windup, tracking_time).
using PidTuple = std::tuple<double, double, double, double, double, std::string, double>;
/// A reading as (displacement, pressure, temperature, sampled_at, sequence, validity).
using ReadingTuple = std::tuple<double, double, double, double, std::uint32_t, std::string>;
/// An object in the grip as (position, yielding).
using ObjectTuple = std::pair<double, double>;
/// A simulated finger as (model, object, noise, pressure_min, pressure_max, seed).
using FingerTuple = std::tuple<Model, std::optional<ObjectTuple>, double, double, double, std::uint64_t>;

constexpr std::pair<const char*, Validity> validities[] = {{"valid", Validity::valid},
                                                           {"none_yet", Validity::none_yet},
                                                           {"out_of_range", Validity::out_of_range},
                                                           {"sensor_error", Validity::sensor_error},
                                                           {"jumped", Validity::jumped},
                                                           {"frozen", Validity::frozen},
                                                           {"stale", Validity::stale}};

std::string word_of(Validity validity) {
  for (const auto& [word, value] : validities) {
    if (value == validity) return word;
  }
  return "none_yet";
}

Validity validity_of(const std::string& word) {
  for (const auto& [name, value] : validities) {
    if (word == name) return value;
  }
  throw InvalidArgument("validity", "'" + word + "' is not the validity of a reading");
}

/// Longest time that the clock of a board can show [s], about 30 years.
constexpr double longest_s = 1e9;

std::chrono::nanoseconds duration_of(const char* argument, double seconds) {
  if (!(seconds >= 0 && seconds <= longest_s))
    throw InvalidArgument(argument, "the duration must be between 0 and 1e9 s");
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

double seconds_of(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

Limits limits_of(const LimitsTuple& values) {
  const auto& [pressure_min, pressure_max, slew_up, slew_down, lowest, highest, rest] = values;
  return {pressure_min, pressure_max, slew_up, slew_down, lowest, highest, rest};
}

PidSettings pid_of(const PidTuple& values) {
  const auto& [kp, ki, kd, filter_s, weight, anti_windup, tracking_s] = values;
  return {kp,
          ki,
          kd,
          filter_s,
          weight,
          chosen<AntiWindup>("anti_windup", anti_windup,
                             {{"none", AntiWindup::none},
                              {"conditional", AntiWindup::conditional},
                              {"back_calculation", AntiWindup::back_calculation}}),
          tracking_s};
}

py::tuple limited(const LimitsTuple& limits, double wanted_kpa, double last_kpa, double elapsed_s) {
  const LimitedCommand command = limit(limits_of(limits), wanted_kpa, last_kpa, elapsed_s);
  return py::make_tuple(command.command_kpa, command.saturated, command.slewing, command.invalid);
}

/// Raises InvalidArgument with the possible reasons if the reference did not append a segment.
void require_appended(bool appended, const Reference& reference) {
  if (!appended)
    throw InvalidArgument(
        "segment",
        "a value is not finite, a duration, frequency or number of cycles is not above 0, "
        "the segment overflows, or the reference already has 8 segments. The last segment ends at " +
            std::to_string(reference.end_s()) + " s");
}

Controller controller_of(const Model& model, const LimitsTuple& limits, const PidTuple& pid,
                         const std::string& feedforward, double extra_latency_s, double tick_s,
                         double sensor_noise, double reading_max_age_s) {
  return Controller({model, limits_of(limits), pid_of(pid),
                     chosen<FeedforwardKind>("feedforward", feedforward,
                                             {{"none", FeedforwardKind::none},
                                              {"bouc_wen", FeedforwardKind::bouc_wen},
                                              {"full_model", FeedforwardKind::full_model}}),
                     extra_latency_s, tick_s, sensor_noise, reading_max_age_s});
}

py::tuple controller_tick(Controller& controller, double now_s, const ReadingTuple& values) {
  const auto& [displacement, pressure_kpa, temperature_c, sampled_at_s, sequence, validity] = values;
  const Reading reading{displacement,  pressure_kpa,
                        temperature_c, duration_of("sampled_at", sampled_at_s),
                        sequence,      validity_of(validity)};
  const ControlOutput output = controller.tick(duration_of("now", now_s), reading);
  return py::make_tuple(output.command_kpa, output.reference, output.displacement, output.feedforward_kpa,
                        output.feedback_kpa, output.residual, word_of(output.validity), output.saturated,
                        output.slewing, output.out_of_reach);
}

std::optional<SimulatedObject> object_of(const std::optional<ObjectTuple>& object) {
  if (!object) return std::nullopt;
  return SimulatedObject{object->first, object->second};
}

/// A simulated board for Python. A call after a long time on the board's clock can take seconds, so the calls
/// release the global interpreter lock (GIL). A mutex protects the board from other Python threads.
class SharedBoard {
 public:
  SharedBoard(std::vector<SimulatedFinger> fingers, double tick_s) : board_(std::move(fingers), tick_s) {}

  /// Returns the result of call(board).
  template <class Call>
  auto with_board(Call call) {
    const py::gil_scoped_release others_may_run;
    const std::lock_guard lock(mutex_);
    return call(board_);
  }

 private:
  SimulatedBoard board_;
  std::mutex mutex_;
};

std::unique_ptr<SharedBoard> board_of(const std::vector<FingerTuple>& fingers, double tick_s) {
  std::vector<SimulatedFinger> all;
  for (const auto& [model, object, noise, pressure_min_kpa, pressure_max_kpa, seed] : fingers)
    all.push_back({model, object_of(object), noise, pressure_min_kpa, pressure_max_kpa, seed});
  return std::make_unique<SharedBoard>(std::move(all), tick_s);
}

std::size_t channels_of(SharedBoard& shared) {
  return shared.with_board([](SimulatedBoard& board) { return board.channels(); });
}

/// Returns the readings of an exchange. If the exchange fails, returns the name of its status and the reason.
py::tuple exchanged(SharedBoard& shared, const std::vector<double>& commands_kpa, double deadline_s) {
  const std::size_t channels = channels_of(shared);
  if (commands_kpa.size() != channels)
    throw InvalidArgument("commands", std::to_string(commands_kpa.size()) + " values, but there are " +
                                          std::to_string(channels) +
                                          " channels. One value per channel is required, in kPa");
  const std::chrono::nanoseconds deadline = duration_of("deadline", deadline_s);
  std::vector<Reading> readings(channels);
  const auto [status, detail] = shared.with_board([&](SimulatedBoard& board) {
    const BusStatus result = board.exchange(commands_kpa, readings, deadline);
    return std::pair(result, board.detail());
  });
  py::list all;
  if (status == BusStatus::ok) {
    for (const Reading& reading : readings)
      all.append(py::make_tuple(reading.displacement, reading.pressure_kpa, reading.temperature_c,
                                seconds_of(reading.sampled_at), reading.sequence, word_of(reading.validity)));
  }
  return py::make_tuple(name_of(status), detail, all);
}

py::tuple connected(SharedBoard& shared, double deadline_s) {
  const std::chrono::nanoseconds deadline = duration_of("deadline", deadline_s);
  const auto [status, detail] = shared.with_board([&](SimulatedBoard& board) {
    const BusStatus result = board.connect(deadline);
    return std::pair(result, board.detail());
  });
  return py::make_tuple(name_of(status), detail);
}

void require_channel(SharedBoard& shared, std::size_t channel) {
  if (const std::size_t channels = channels_of(shared); channel >= channels)
    throw InvalidArgument("channel", std::to_string(channel) + " is not below the number of channels, " +
                                         std::to_string(channels));
}

void advance(SharedBoard& shared, double duration_s) {
  const std::chrono::nanoseconds duration = duration_of("duration", duration_s);
  shared.with_board([&](SimulatedBoard& board) { board.advance(duration); });
}

void set_object(SharedBoard& shared, std::size_t channel, const std::optional<ObjectTuple>& object) {
  require_channel(shared, channel);
  if (object && !(std::isfinite(object->first) && object->second >= 0 && object->second <= 1))
    throw InvalidArgument("object",
                          "the position must be finite, and the share by which the object yields must be "
                          "from 0 to 1");
  shared.with_board([&](SimulatedBoard& board) { board.set_object(channel, object_of(object)); });
}

double displacement(SharedBoard& shared, std::size_t channel) {
  require_channel(shared, channel);
  return shared.with_board([&](const SimulatedBoard& board) { return board.displacement(channel); });
}

}  // namespace

void add_control(py::module_& module) {
  module.def("limit", limited);
  py::class_<Pid>(module, "Pid")
      .def(py::init([](const PidTuple& settings, double tick_s) { return Pid(pid_of(settings), tick_s); }))
      .def("align", &Pid::align)
      .def("step", &Pid::step)
      .def("hold", &Pid::hold)
      .def("sent", &Pid::sent);
  py::class_<Reference>(module, "Reference")
      .def(py::init<double>())
      .def("start", &Reference::start)
      .def("ramp_to", [](Reference& r, double value,
                         double duration_s) { require_appended(r.ramp_to(value, duration_s), r); })
      .def("hold_for", [](Reference& r, double duration_s) { require_appended(r.hold_for(duration_s), r); })
      .def("sine", [](Reference& r, double mean, double amplitude, double frequency_hz,
                      double cycles) { require_appended(r.sine(mean, amplitude, frequency_hz, cycles), r); })
      .def("at", &Reference::at)
      .def("end", &Reference::end_s);
  py::class_<Controller>(module, "Controller")
      .def(py::init(&controller_of))
      .def("start", &Controller::start)
      .def("follow", &Controller::follow)
      .def("hold", &Controller::hold)
      .def("vent", &Controller::vent)
      .def("pressure", &Controller::pressure)
      .def("tick", controller_tick);
  py::class_<SharedBoard>(module, "SimulatedBoard")
      .def(py::init(&board_of))
      .def("channels", channels_of)
      .def("connect", connected)
      .def("exchange", exchanged)
      .def("describe",
           [](SharedBoard& shared) {
             return shared.with_board([](const SimulatedBoard& board) { return board.describe(); });
           })
      .def("now",
           [](SharedBoard& shared) {
             return seconds_of(shared.with_board([](const SimulatedBoard& board) { return board.now(); }));
           })
      .def("advance", advance)
      .def("set_object", set_object)
      .def("displacement", displacement);
}

}  // namespace softgrip::python
