#include "tools/verification/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/numbers.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Keys that may differ between two runs with the same result.
constexpr std::array<std::string_view, 8> not_compared{"wall_s", "stages_s", "software", "path",
                                                       "file",   "call",     "hash",     "source"};

double relative_difference(double a, double b) {
  const double scale = std::max(std::abs(a), std::abs(b));
  return scale > 0 ? std::abs(a - b) / scale : 0;
}

std::string text_of(const Json& value) {
  return value.is_number() ? shortest(value.get<double>()) : value.dump();
}

void compare_values(const std::string& where, const Json& reported, const Json& recomputed,
                    Comparison& comparison) {
  if (reported.is_number() && recomputed.is_number())
    return comparison.compare(where, reported.get<double>(), recomputed.get<double>());
  if (reported.is_object() && recomputed.is_object()) {
    std::set<std::string> keys;
    for (const Json* one : {&reported, &recomputed}) {
      for (const auto& [key, value] : one->items()) keys.insert(key);
    }
    for (const std::string& key : keys) {
      if (std::find(not_compared.begin(), not_compared.end(), key) != not_compared.end()) continue;
      const std::string at = where + (where.ends_with(": ") ? "" : ".") + key;
      compare_values(at, reported.value(key, Json()), recomputed.value(key, Json()), comparison);
    }
    return;
  }
  if (reported.is_array() && recomputed.is_array() && reported.size() == recomputed.size()) {
    for (std::size_t i = 0; i < reported.size(); ++i)
      compare_values(where + "[" + std::to_string(i) + "]", reported[i], recomputed[i], comparison);
    return;
  }
  comparison.compare(where, text_of(reported), text_of(recomputed));
}

}  // namespace

void Comparison::compare(const std::string& where, double reported, double recomputed) {
  ++numbers;
  constexpr double next_to_nothing = 1e-12;
  if (reported == recomputed || std::abs(reported - recomputed) < next_to_nothing) return;
  if (relative_difference(reported, recomputed) <= tolerance) return;
  differences.push_back({where, shortest(reported), shortest(recomputed)});
}

void Comparison::compare(const std::string& where, const std::string& reported,
                         const std::string& recomputed) {
  if (reported != recomputed) differences.push_back({where, reported, recomputed});
}

void compare_json(const std::string& file, const Json& reported, const Json& recomputed,
                  Comparison& comparison) {
  compare_values(file + ": ", reported, recomputed, comparison);
}

void compare_csv(const std::string& file, const std::string& reported, const std::string& recomputed,
                 Comparison& comparison) {
  const auto before = sysid::lines_of(reported), after = sysid::lines_of(recomputed);
  if (before.size() != after.size())
    return comparison.compare(file + ": lines", static_cast<double>(before.size()),
                              static_cast<double>(after.size()));
  std::map<std::size_t, std::pair<double, Difference>> worst;  // largest relative difference of each column,
                                                               // by index of the column
  std::vector<sysid::Cell> names, was, is;
  for (std::size_t line = 0; line < before.size(); ++line) {
    const bool whole = sysid::split(before[line], was) && sysid::split(after[line], is);
    if (line == 0) names = was;
    if (!whole || was.size() != is.size() || was.size() != names.size())
      return comparison.compare(file + ": line " + std::to_string(line + 1), std::string(before[line]),
                                std::string(after[line]));
    for (std::size_t i = 0; i < was.size(); ++i) {
      Comparison one{comparison.tolerance, 0, {}};
      const std::string where =
          file + ": " + std::string(names[i].text) + ", line " + std::to_string(line + 1);
      const auto a = to_number(was[i].text), b = to_number(is[i].text);
      if (a && b) {
        one.compare(where, *a, *b);
      } else {
        one.compare(where, std::string(was[i].text), std::string(is[i].text));
      }
      comparison.numbers += one.numbers;
      if (one.differences.empty()) continue;
      const double size = a && b ? std::abs(*a - *b) : HUGE_VAL;
      auto& largest = worst[i];
      if (size > largest.first) largest = {size, std::move(one.differences.front())};
    }
  }
  for (auto& [column, difference] : worst) comparison.differences.push_back(std::move(difference.second));
}

void compare_models(const std::string& file, const model::Model& reported, const model::Model& recomputed,
                    Comparison& comparison) {
  const auto names_of = [](const model::Model& model) {
    std::string names;
    for (std::size_t i = 0; i < model::flat_values(model).size(); ++i)
      names += (i == 0 ? "" : ", ") + model::parameter_path(model, i);
    return names;
  };
  const std::string names = names_of(reported);
  if (names != names_of(recomputed))
    return comparison.compare(file + ": parameters", names, names_of(recomputed));
  const std::vector<double> was = model::flat_values(reported), is = model::flat_values(recomputed);
  for (std::size_t i = 0; i < was.size(); ++i)
    comparison.compare(file + ": " + model::parameter_path(reported, i), was[i], is[i]);
}

}  // namespace softgrip::tools
