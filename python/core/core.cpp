// Binds the functions of the C++ library, with NumPy arrays, to the Python module softgrip._core. The modules
// of the Python package, such as python/softgrip/models.py, check the types of arguments and convert the
// results to typed objects.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <softgrip/softgrip.h>

#include "python/core/interruptible.h"
#include "python/core/values.h"

namespace py = pybind11;

namespace softgrip::python {
namespace {

Unit unit_named(const std::string& name) {
  if (name == "mm") return Unit::mm;
  if (name == "deg") return Unit::deg;
  throw InvalidArgument("unit", "'" + name + "' is not 'mm' or 'deg'");
}

Log log_of(const py::dict& columns) {
  const auto column = [&](const char* name) { return vector_of(columns[name].cast<Array>()); };
  Log log;
  log.name = columns["name"].cast<std::string>();
  log.unit = unit_named(columns["unit"].cast<std::string>());
  log.time_s = column("time_s");
  log.pressure_command_kpa = column("pressure_command_kpa");
  log.displacement = column("displacement");
  log.pressure_kpa = column("pressure_kpa");
  log.temperature_c = column("temperature_c");
  log.supply_kpa = column("supply_kpa");
  log.path = columns["path"].cast<std::string>();
  log.sha256 = columns["sha256"].cast<std::string>();
  return log;
}

std::vector<Log> logs_of(const py::list& list) {
  std::vector<Log> logs;
  for (const py::handle& one : list) logs.push_back(log_of(one.cast<py::dict>()));
  return logs;
}

py::dict dict_of(Log log) {
  py::dict columns;
  columns["name"] = log.name;
  columns["unit"] = name_of(log.unit);
  columns["time_s"] = array_of(std::move(log.time_s));
  columns["pressure_command_kpa"] = array_of(std::move(log.pressure_command_kpa));
  columns["displacement"] = array_of(std::move(log.displacement));
  columns["pressure_kpa"] = array_of(std::move(log.pressure_kpa));
  columns["temperature_c"] = array_of(std::move(log.temperature_c));
  columns["supply_kpa"] = array_of(std::move(log.supply_kpa));
  columns["path"] = log.path;
  columns["sha256"] = log.sha256;
  columns["notes"] = log.notes;
  return columns;
}

LogUse use_of(const std::string& drive, const std::string& begin, bool held) {
  return {chosen<Drive>("drive", drive, {{"command", Drive::command}, {"measured", Drive::measured}}),
          chosen<Begin>("begin", begin,
                        {{"auto", Begin::automatic}, {"rest", Begin::rest}, {"unknown", Begin::unknown}}),
          held};
}

py::object interval_of(const std::optional<Interval>& interval) {
  if (!interval) return py::none();
  return py::make_tuple(interval->lower, interval->upper);
}

/// Returns the keyword arguments of the Python class softgrip.Estimate for each estimate.
py::list dicts_of(const std::vector<Estimate>& estimates) {
  py::list all;
  for (const Estimate& one : estimates) {
    py::dict dict;
    dict["name"] = one.name;
    dict["unit"] = one.unit;
    dict["value"] = one.value;
    dict["ci95"] = interval_of(one.ci95);
    dict["free"] = one.free;
    dict["note"] = one.note;
    all.append(dict);
  }
  return all;
}

/// Returns the keyword arguments of the Python class softgrip.Prediction for each prediction.
py::list dicts_of(std::vector<Prediction> predictions) {
  py::list all;
  for (Prediction& one : predictions) {
    py::dict dict;
    dict["log"] = one.log;
    dict["unit"] = name_of(one.unit);
    dict["time_s"] = array_of(std::move(one.time_s));
    dict["prediction"] = array_of(std::move(one.prediction));
    dict["error"] = array_of(std::move(one.error));
    dict["rmse"] = one.rmse;
    dict["rmse_percent_of_span"] = one.rmse_percent_of_span;
    dict["largest_error"] = one.largest_error;
    dict["diverges"] = one.diverges;
    all.append(dict);
  }
  return all;
}

/// Returns the keyword arguments of the Python class softgrip.Cause for each cause.
py::list dicts_of(const std::vector<Cause>& causes) {
  py::list all;
  for (const Cause& one : causes) {
    py::dict dict;
    dict["id"] = one.id;
    dict["title"] = one.title;
    dict["error_reduction_percent"] = one.error_reduction_percent;
    dict["error_reduction_ci95"] = interval_of(one.error_reduction_ci95);
    dict["parameters"] = dicts_of(one.parameters);
    dict["alternatives"] = one.alternatives;
    all.append(dict);
  }
  return all;
}

py::list parameters_of(const Model& model) {
  py::list all;
  for (const Parameter& one : model.parameters())
    all.append(py::make_tuple(one.name, one.value, one.unit, one.lower, one.upper, one.about));
  return all;
}

py::array_t<double> simulate(const Model& model, const Array& time_s, const Array& pressure_kpa, bool held,
                             double noise, std::uint64_t seed, const Array& supply_kpa,
                             const Array& temperature_c) {
  const SimulateOptions options{held, noise, seed, span_of(supply_kpa), span_of(temperature_c)};
  std::vector<double> displacement;
  {
    const py::gil_scoped_release others_may_run;
    displacement = model.simulate(span_of(time_s), span_of(pressure_kpa), options);
  }
  return array_of(std::move(displacement));
}

py::tuple inverse(const Model& model, const Array& time_s, const Array& displacement, double pressure_min_kpa,
                  double pressure_max_kpa, double slew_up_kpa_per_s, double slew_down_kpa_per_s,
                  double start_kpa) {
  Inverse result;
  {
    const py::gil_scoped_release others_may_run;
    result = model.inverse(
        span_of(time_s), span_of(displacement),
        {pressure_min_kpa, pressure_max_kpa, slew_up_kpa_per_s, slew_down_kpa_per_s, start_kpa});
  }
  return py::make_tuple(array_of(std::move(result.pressure_kpa)), array_of(std::move(result.out_of_reach)));
}

py::dict read_columns(const std::string& path, const std::string& channel, bool import_file,
                      const std::map<std::string, std::string>& columns,
                      const std::map<std::string, std::string>& units, std::optional<double> rate_hz,
                      const std::string& sheet) {
  Log log;
  {
    const py::gil_scoped_release others_may_run;
    log = read_log(path, {channel, import_file, columns, units, rate_hz, sheet});
  }
  return dict_of(std::move(log));
}

py::dict identified(const py::list& logs, const std::string& structure, const std::optional<Model>& start,
                    std::size_t branches, const std::vector<std::string>& fixed,
                    const std::vector<std::string>& free, std::size_t starts, std::uint64_t seed, bool robust,
                    double fit_share, unsigned threads, const std::string& drive, const std::string& begin,
                    bool held, const py::list& validation, const py::object& progress) {
  const std::vector<Log> given = logs_of(logs);
  IdentifyOptions options;
  options.structure = chosen<Structure>("structure", structure,
                                        {{"start", Structure::start},
                                         {"auto", Structure::automatic},
                                         {"bouc_wen", Structure::bouc_wen},
                                         {"prandtl_ishlinskii", Structure::prandtl_ishlinskii}});
  options.start = start;
  options.branches = branches;
  options.fixed = fixed;
  options.free = free;
  options.starts = starts;
  options.seed = seed;
  options.robust = robust;
  options.fit_share = fit_share;
  options.threads = threads;
  options.use = use_of(drive, begin, held);
  options.validation = logs_of(validation);
  Identification found = interruptible(progress, options, [&] { return identify(given, options); });
  py::dict dict;
  dict["model"] = found.model;
  dict["rmse"] = found.rmse;
  dict["converged"] = found.converged;
  dict["verdict"] = found.verdict;
  dict["warnings"] = found.warnings;
  dict["parameters"] = dicts_of(found.parameters);
  dict["combinations"] = dicts_of(found.combinations);
  dict["fit"] = dicts_of(std::move(found.fit));
  dict["held_out"] = dicts_of(std::move(found.held_out));
  dict["validation"] = dicts_of(std::move(found.validation));
  dict["json"] = found.json;
  dict["html"] = found.html;
  return dict;
}

py::dict validated(const Model& model, const py::list& logs, const std::string& drive,
                   const std::string& begin, bool held) {
  const std::vector<Log> given = logs_of(logs);
  const LogUse use = use_of(drive, begin, held);
  struct {
    std::stop_token stop;
    Progress progress;
  } options;
  Validation found =
      interruptible(py::none(), options, [&] { return validate(model, given, use, options.stop); });
  py::dict dict;
  dict["verdict"] = found.verdict;
  dict["warnings"] = found.warnings;
  dict["predictions"] = dicts_of(std::move(found.predictions));
  dict["json"] = found.json;
  dict["html"] = found.html;
  return dict;
}

DiagnoseOptions options_of(std::uint64_t seed, unsigned threads, std::size_t null_campaigns, LogUse use) {
  DiagnoseOptions options;
  options.seed = seed;
  options.threads = threads;
  options.null_campaigns = null_campaigns;
  options.use = use;
  return options;
}

py::dict diagnosed(const Model& model, const py::list& logs, std::uint64_t seed, unsigned threads,
                   std::size_t null_campaigns, const std::string& drive, const std::string& begin, bool held,
                   const py::object& progress) {
  const std::vector<Log> given = logs_of(logs);
  DiagnoseOptions options = options_of(seed, threads, null_campaigns, use_of(drive, begin, held));
  const Diagnosis found = interruptible(progress, options, [&] { return diagnose(model, given, options); });
  py::dict dict;
  dict["verdict"] = found.verdict;
  dict["sentence"] = found.sentence;
  dict["warnings"] = found.warnings;
  dict["causes"] = dicts_of(found.causes);
  dict["unit"] = name_of(found.unit);
  dict["noise"] = found.noise;
  dict["rmse_given"] = found.rmse_given;
  dict["rmse_refitted"] = found.rmse_refitted;
  dict["rmse_extended"] = found.rmse_extended;
  dict["unexplained_percent"] = found.unexplained_percent;
  dict["refitted"] = found.refitted;
  dict["extended"] = found.extended;
  dict["json"] = found.json;
  dict["html"] = found.html;
  return dict;
}

py::dict changed(const Model& model, const py::list& healthy, const py::list& later, std::uint64_t seed,
                 unsigned threads, bool held, const py::object& progress) {
  const std::vector<Log> before = logs_of(healthy);
  const std::vector<Log> now = logs_of(later);
  DiagnoseOptions options = options_of(seed, threads, 0, {Drive::command, Begin::automatic, held});
  const Change found =
      interruptible(progress, options, [&] { return diagnose_change(model, before, now, options); });
  py::dict dict;
  dict["verdict"] = found.verdict;
  dict["sentence"] = found.sentence;
  dict["warnings"] = found.warnings;
  dict["causes"] = dicts_of(found.causes);
  dict["unit"] = name_of(found.unit);
  dict["json"] = found.json;
  dict["html"] = found.html;
  return dict;
}

/// Raises the exception of softgrip.errors that has this name.
void raise(const char* name, const py::tuple& arguments) {
  const py::object type = py::module_::import("softgrip.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void translate(std::exception_ptr failure) {
  if (!failure) return;
  try {
    std::rethrow_exception(failure);
  } catch (const InvalidArgument& error) {
    raise("InvalidArgument", py::make_tuple(error.argument(), error.what()));
  } catch (const FileError& error) {
    raise("MalformedFile", py::make_tuple(error.what()));
  } catch (const Error& error) {
    raise("NoResult", py::make_tuple(error.what()));
  }
}

}  // namespace
}  // namespace softgrip::python

PYBIND11_MODULE(_core, module) {
  using namespace softgrip::python;
  using softgrip::Model;
  py::register_local_exception_translator(translate);
  module.def("version", softgrip::version);
  py::class_<Model>(module, "Model")
      .def_static("load", &Model::load)
      .def_static("parse", &Model::parse)
      .def("save", &Model::save)
      .def("yaml", &Model::yaml)
      .def("name", &Model::name)
      .def("source", &Model::source)
      .def("hash", &Model::hash)
      .def("unit", [](const Model& model) { return name_of(model.unit()); })
      .def("parameters", parameters_of)
      .def("with_parameter", &Model::with)
      .def("simulate", simulate)
      .def("inverse", inverse);
  module.def("read_log", read_columns);
  module.def("write_log",
             [](const std::string& path, const py::dict& log) { softgrip::write_log(path, log_of(log)); });
  module.def("check", [](const py::dict& log) { softgrip::check(log_of(log)); });
  module.def("identify", identified);
  module.def("validate", validated);
  module.def("diagnose", diagnosed);
  module.def("diagnose_change", changed);
  add_health(module);
  add_control(module);
}
