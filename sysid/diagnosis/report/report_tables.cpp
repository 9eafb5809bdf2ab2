#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/identification/log_report.h"

namespace softgrip::sysid {
namespace {

constexpr const char* dash = "\xe2\x80\x93";

std::string p_text(double p) {
  return p < 0.001 ? "< 0.001" : fixed(p, 3);
}

const ConditionEvidence* find(const ResidualEvidence& evidence, const std::string& id) {
  for (const ConditionEvidence& e : evidence.conditions) {
    if (e.condition.id == id && e.condition.why_not.empty()) return &e;
  }
  return nullptr;
}

std::string outcome_of(const CandidateScore& c, const NamedCause* chosen, double chosen_rmse_mm,
                       model::OutputUnit unit) {
  if (chosen != nullptr) {
    if (c.cause == chosen->cause) return "named";
    if (std::find(chosen->alternatives.begin(), chosen->alternatives.end(), c.cause) !=
        chosen->alternatives.end())
      return "equivalent";
  }
  if (!c.why_not.empty()) return c.why_not;
  if (std::isnan(c.heldout_rmse_mm)) return "fit much worse than the best fit";
  if (c.gain_percent.lower <= 0) return "not significant";
  if (chosen == nullptr) return "the error reduction is too small";
  return "larger error: " + significant(c.heldout_rmse_mm, 3) + " instead of " +
         significant(chosen_rmse_mm, 3) + " " + std::string(model::name_of(unit));
}

/// Returns a table of the candidates with their errors and the reasons why they were rejected.
/// @param chosen  cause that the candidates were tested to replace; nullptr: the candidates were tested as an
/// additional cause.
Table candidate_table(const std::vector<CandidateScore>& candidates, const NamedCause* chosen,
                      double chosen_rmse_mm, model::OutputUnit unit, std::string caption) {
  Table table;
  table.caption = std::move(caption);
  table.header = {"cause",
                  "station",
                  model::in_unit("fitted [mm]", unit),
                  model::in_unit("held out [mm]", unit),
                  "held-out error reduction [%]",
                  "outcome"};
  table.numeric = {false, false, true, true, true, false};
  for (const CandidateScore& c : candidates) {
    const bool judged = std::isfinite(c.heldout_rmse_mm) && c.heldout_rmse_mm > 0;
    table.rows.push_back(
        {std::string(c.cause.id), std::string(model::name_of(c.cause.station)),
         c.rmse_mm > 0 ? or_dash(c.rmse_mm, 3) : dash, judged ? or_dash(c.heldout_rmse_mm, 3) : dash,
         judged ? percent_range(c.gain_percent) : dash, outcome_of(c, chosen, chosen_rmse_mm, unit)});
  }
  return table;
}

std::string value_at(const model::Model& model, const std::string& path) {
  const auto index = model::find_path(model, path);
  return index ? significant(model::flat_values(model)[*index], 4) : dash;
}

}  // namespace

std::string percent_range(const Spread& share) {
  return fixed(share.value, 1) + " (" + fixed(share.lower, 1) + " to " + fixed(share.upper, 1) + ")";
}

Table rmse_table(const Diagnosis& d) {
  Table table;
  table.caption = "RMSE of the models (measurement noise " + significant(d.noise_mm, 3) + " " +
                  std::string(model::name_of(d.extended_model.output_unit)) + ")";
  table.header = {"model", "fitted, RMSE [mm]", "held-out blocks [mm]", "held-out logs [mm]",
                  "unexplained [mm]"};
  for (std::string& title : table.header) title = model::in_unit(title, d.extended_model.output_unit);
  table.numeric = {false, true, true, true, true};
  const auto fitted = [](const StructureFit& fit) { return or_dash(std::sqrt(fit.mean_square_mm2), 3); };
  const auto excess = [&](const StructureFit& fit) {
    return or_dash(std::sqrt(std::max(0.0, fit.mean_square_mm2 - d.noise_mm * d.noise_mm)), 3);
  };
  const auto other = [](const std::optional<double>& value) {
    return value ? or_dash(*value, 3) : std::string(dash);
  };
  table.rows.push_back({"given model (not fitted)", fitted(d.as_given), or_dash(d.as_given_rmse_mm, 3),
                        d.records.size() > 1 ? or_dash(d.as_given_rmse_mm, 3) : dash, excess(d.as_given)});
  table.rows.push_back({"recalibrated model", fitted(d.recalibrated), or_dash(d.recalibrated_rmse_mm, 3),
                        other(d.recalibrated_other_logs_rmse_mm), excess(d.recalibrated)});
  if (is_extended(d)) {
    table.rows.push_back({"extended model", fitted(d.extended), or_dash(d.extended_rmse_mm, 3),
                          other(d.extended_other_logs_rmse_mm), excess(d.extended)});
  }
  return table;
}

Table condition_table(const Evidence& evidence, bool extended) {
  Table table;
  table.caption = "Share of the residual variance explained by each condition, with adjusted p-value";
  table.header = {"condition", "given [%]", "recalibrated [%]", "p", "extended [%]", "p", "note"};
  table.numeric = {false, true, true, true, true, true, false};
  for (const ConditionEvidence& e : evidence.recalibrated.conditions) {
    std::string name = e.condition.id;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (!e.condition.why_not.empty()) {
      table.rows.push_back({name, dash, dash, dash, dash, dash, e.condition.why_not});
      continue;
    }
    const ConditionEvidence* before = find(evidence.as_given, e.condition.id);
    const ConditionEvidence* after = find(evidence.extended, e.condition.id);
    table.rows.push_back({name, before != nullptr ? fixed(before->share_percent, 1) : dash,
                          fixed(e.share_percent, 1), p_text(e.p_adjusted),
                          after != nullptr ? fixed(after->share_percent, 1) : dash,
                          after != nullptr ? p_text(after->p_adjusted) : dash, e.clear ? "clear" : ""});
  }
  if (extended) return table;
  constexpr long first = 4, count = 2;  // index of the first column of the extended model, and number of its
                                        // columns
  table.header.erase(table.header.begin() + first, table.header.begin() + first + count);
  table.numeric.erase(table.numeric.begin() + first, table.numeric.begin() + first + count);
  for (auto& row : table.rows) row.erase(row.begin() + first, row.begin() + first + count);
  return table;
}

std::vector<Table> candidate_tables(const Diagnosis& d) {
  std::vector<Table> tables;
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      if (!named.candidates.empty())
        tables.push_back(candidate_table(named.candidates, &named, d.extended_rmse_mm,
                                         d.extended_model.output_unit,
                                         "Causes tested as alternatives to " + std::string(named.cause.id)));
    }
  }
  if (!d.rejected.empty())
    tables.push_back(
        candidate_table(d.rejected, nullptr, d.extended_rmse_mm, d.extended_model.output_unit,
                        d.causes.empty() && d.partial.empty()
                            ? "Tested causes: no cause reduced the held-out error sufficiently"
                            : "Further causes: no further cause reduced the held-out error sufficiently"));
  return tables;
}

Table run_table(const Diagnosis& d) {
  Table table;
  table.caption = model::in_unit(
      "RMSE of each run [mm]; the recalibrated and the extended model are fitted to the other runs",
      d.extended_model.output_unit);
  table.header = {"run", "given", "recalibrated", "extended"};
  table.numeric = {false, true, true, true};
  for (const RunError& one : d.runs)
    table.rows.push_back({one.run, or_dash(one.given, 3), or_dash(one.recalibrated, 3),
                          is_extended(d) ? or_dash(one.extended, 3) : dash});
  return table;
}

std::vector<const NamedCause*> shown_causes(const Diagnosis& d) {
  std::vector<const NamedCause*> causes;
  for (const NamedCause& named : d.causes) causes.push_back(&named);
  for (const NamedCause& named : d.partial) {
    if (named.heldout_gain_percent.lower > 0) causes.push_back(&named);
  }
  return causes;
}

Table cause_parameter_table(const Diagnosis& d, std::size_t most) {
  Table table;
  table.caption = "Parameters of the causes";
  table.header = {"cause", "parameter", "value", "95 % interval", "unit"};
  table.numeric = {false, false, true, true, false};
  const auto row = [](const NamedCause& named, const CauseParameter& p) -> std::vector<std::string> {
    return {std::string(named.cause.title), p.name, significant(p.value, 4),
            p.has_interval ? text_of(p.ci95, p.value, " to ") : "not fitted", p.unit};
  };
  for (const NamedCause* named : shown_causes(d)) {
    const std::size_t size = named->parameters.size();
    const bool short_enough = size <= most;
    std::size_t shown = 0;
    for (const CauseParameter& p : named->parameters) {
      // If a cause has more than `most` parameters, only parameters with a determined interval are listed.
      if (!short_enough && (!p.determined() || shown + 1 >= most)) continue;
      table.rows.push_back(row(*named, p));
      ++shown;
    }
    if (shown < size)
      table.rows.push_back({std::string(named->cause.title),
                            (shown > 0 ? "and " : "no parameter determined: ") +
                                std::to_string(size - shown) +
                                (shown > 0 ? " more, listed in the appendix" : " in the appendix")});
  }
  return table;
}

Table moved_table(const Diagnosis& d, const model::Model& given) {
  const bool extended = is_extended(d);
  Table table;
  table.header = {"parameter", "unit", "given", "recalibrated"};
  table.numeric = {false, false, true, true};
  if (extended) {
    table.header.insert(table.header.end(), {"extended", "change from the given value"});
    table.numeric.insert(table.numeric.end(), {true, true});
  } else {
    table.header.emplace_back("change");
    table.numeric.push_back(true);
  }
  const std::vector<double> values = model::flat_values(d.extended_model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string path = model::parameter_path(d.extended_model, i);
    const auto before = model::find_path(given, path);
    const double old = before ? model::flat_values(given)[*before] : 0;
    const std::string moved = old != 0 ? fixed(100 * (values[i] / old - 1), 1) + " %" : dash;
    std::vector<std::string> row{
        path, model::in_unit(model::parameter_spec(d.extended_model, i).unit, d.extended_model.output_unit),
        value_at(given, path), value_at(d.recalibrated_model, path)};
    if (extended) row.push_back(significant(values[i], 4));
    row.push_back(moved);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace softgrip::sysid
