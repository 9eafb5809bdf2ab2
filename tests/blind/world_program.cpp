#include "world_program.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>

namespace worlds {

void drop_unrecorded(Log& log, Answer& answer) {
  for (std::vector<double>* values :
       {&log.command_kpa, &log.temperature_c, &log.supply_kpa, &log.reference_mm, &answer.command_kpa,
        &answer.pressure_kpa, &answer.displacement_mm})
    if (!values->empty())
      values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(log.unrecorded));
  log.unrecorded = 0;
}

double duration_s(const std::vector<Log>& logs) {
  double sum = 0;
  for (const Log& log : logs) sum += static_cast<double>(log.command_kpa.size()) / log.rate_hz;
  return sum;
}

double recorded_change_mm(const std::vector<Log>& logs, const std::vector<Answer>& changed,
                          const std::vector<Answer>& unchanged) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::vector<double>& with = changed[i].displacement_mm;
    const std::vector<double>& without = unchanged[i].displacement_mm;
    const auto samples = static_cast<double>(with.size() - logs[i].unrecorded);
    double mean = 0, squares = 0;
    for (std::size_t k = logs[i].unrecorded; k < with.size(); ++k) {
      const double change = with[k] - without[k];
      mean += change / samples;
      squares += change * change;
    }
    sum += std::max(0.0, squares - samples * mean * mean);
    count += with.size() - logs[i].unrecorded;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

std::vector<std::string> ids_in(const std::string& list) {
  std::vector<std::string> ids;
  std::stringstream text(list);
  for (std::string id; std::getline(text, id, ',');) ids.push_back(id);
  return ids;
}

void Options::read(int argc, char** argv) const {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (const auto flag = flags_.find(name); flag != flags_.end()) {
      flag->second();
      continue;
    }
    if (i + 1 >= argc) throw std::invalid_argument("no value for " + name);
    const auto value = values_.find(name);
    if (value == values_.end()) throw std::invalid_argument("unknown option " + name);
    value->second(argv[++i]);
  }
}

void write_effects(std::ostream& file, const std::map<std::string, Scaled>& hidden, double change_mm) {
  file << "\"recorded_change_mm\": " << change_mm << ", \"effects\": {";
  const char* comma = "";
  for (const auto& [id, scaled] : hidden) {
    file << comma << "\"" << id << "\": {\"excess_mm\": " << scaled.excess_mm
         << ", \"reachable\": " << (scaled.reachable ? "true" : "false") << ", \"parameters\": {";
    const char* inner = "";
    for (const auto& [name, value] : scaled.numbers) {
      file << inner << "\"" << name << "\": " << value;
      inner = ", ";
    }
    file << "}}";
    comma = ", ";
  }
  file << "}}\n";
}

int exit_code_of(const char* program, const std::function<int()>& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << "\n";
    return 2;
  }
}

}  // namespace worlds
