#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/identification/log_report.h"

namespace softgrip::sysid {
namespace {

using result::Fields, result::shown, result::Value;

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
  if (std::isnan(c.heldout_rmse_mm)) return "fitted error larger than that of the best candidates";
  if (c.gain_percent.lower <= 0) return "not significant";
  if (chosen == nullptr) return "the error reduction is too small";
  return "larger error: " + significant(c.heldout_rmse_mm, 3) + " instead of " +
         significant(chosen_rmse_mm, 3) + " " + std::string(model::name_of(unit));
}

Value value_at(const model::Model& model, const std::string& path) {
  const auto index = model::find_path(model, path);
  return index ? result::number(model::flat_values(model)[*index]) : shown({}, dash, true);
}

}  // namespace

std::string percent_range(const Spread& share, int decimals) {
  return fixed(share.value, decimals) + " (" + fixed(share.lower, decimals) + " to " +
         fixed(share.upper, decimals) + ")";
}

Value spread_value(const Spread& spread, int decimals) {
  if (std::isnan(spread.value)) return shown(Fields{{"value", Value()}, {"ci95", Value()}}, dash, true);
  const Fields fields{{"value", spread.value}, {"ci95", Value::List{spread.lower, spread.upper}}};
  return shown(fields, percent_range(spread, decimals), true);
}

Table rmse_table(const Diagnosis& d) {
  const model::OutputUnit unit = d.extended_model.output_unit;
  const double noise_mm2 = d.noise_mm * d.noise_mm;
  const auto row = [&](const char* name, const StructureFit& fit, double blocks_mm,
                       const std::optional<double>& logs_mm) -> Fields {
    const double excess_mm2 = std::max(0.0, fit.mean_square_mm2 - noise_mm2);
    return {{"", "model", name},
            {"", model::in_unit("fitted, RMSE [mm]", unit), or_dash(std::sqrt(fit.mean_square_mm2))},
            {"", model::in_unit("held-out blocks [mm]", unit), or_dash(blocks_mm)},
            {"", model::in_unit("held-out logs [mm]", unit), or_dash(logs_mm)},
            {"", model::in_unit("unexplained [mm]", unit), or_dash(std::sqrt(excess_mm2))}};
  };
  std::vector<Fields> rows{
      row("given model (not fitted)", d.as_given, d.as_given_rmse_mm,
          d.records.size() > 1 ? std::optional(d.as_given_rmse_mm) : std::nullopt),
      row("recalibrated model", d.recalibrated, d.recalibrated_rmse_mm, d.recalibrated_other_logs_rmse_mm)};
  if (is_extended(d))
    rows.push_back(row("extended model", d.extended, d.extended_rmse_mm, d.extended_other_logs_rmse_mm));
  return result::table_of("RMSE of the models (measurement noise " + significant(d.noise_mm, 3) + " " +
                              std::string(model::name_of(unit)) + ")",
                          rows.front(), rows);
}

Table condition_table(const Evidence& evidence, bool extended) {
  const auto share = [](const ConditionEvidence* e) {
    return shown({}, e != nullptr ? fixed(e->share_percent, 1) : dash, true);
  };
  const auto p = [](const ConditionEvidence* e) {
    return shown({}, e != nullptr ? p_text(e->p_adjusted) : dash, true);
  };
  const auto of_condition = [&](const ConditionEvidence& e) {
    const bool judged = e.condition.why_not.empty();
    const auto in = [&](const ResidualEvidence& residual) {
      return judged ? find(residual, e.condition.id) : nullptr;
    };
    const ConditionEvidence* const here = judged ? &e : nullptr;
    std::string name = e.condition.id;
    std::replace(name.begin(), name.end(), '_', ' ');
    Fields fields{{"", "condition", name},
                  {"", "given [%]", share(in(evidence.as_given))},
                  {"", "recalibrated [%]", share(here)},
                  {"", "p", p(here)}};
    if (extended) {
      fields.emplace_back("", "extended [%]", share(in(evidence.extended)));
      fields.emplace_back("", "p", p(in(evidence.extended)));
    }
    fields.emplace_back("", "note", judged ? (e.clear ? "significant" : "") : e.condition.why_not);
    return fields;
  };
  return result::table_of(
      "Share of the residual variance above the noise that each condition explains, with adjusted p-value",
      evidence.recalibrated.conditions, of_condition);
}

std::vector<Fields> candidate_rows(const Diagnosis& d, const NamedCause* chosen) {
  const model::OutputUnit unit = d.extended_model.output_unit;
  std::vector<Fields> rows;
  for (const CandidateScore& c : chosen != nullptr ? chosen->candidates : d.rejected) {
    const bool fitted = c.rmse_mm > 0;
    const bool judged = std::isfinite(c.heldout_rmse_mm) && c.heldout_rmse_mm > 0;
    const bool has_errors = fitted || c.why_not.empty();
    const auto error = [](double value_mm, bool known) {
      return known ? or_dash(value_mm) : shown(value_mm, dash, true);
    };
    rows.push_back(
        {{"id", "cause", c.cause.id},
         {c.why_not.empty() ? ""
          : fitted          ? "rejected"
                            : "not_fitted",
          c.why_not},
         {"", "station", model::name_of(c.cause.station)},
         {has_errors ? "rmse_mm" : "", model::in_unit("fitted [mm]", unit), error(c.rmse_mm, fitted)},
         {has_errors ? "heldout_rmse_mm" : "", model::in_unit("held out [mm]", unit),
          error(c.heldout_rmse_mm, judged)},
         {"", "held-out error reduction [%]", judged ? spread_value(c.gain_percent) : shown({}, dash, true)},
         {"", "outcome", outcome_of(c, chosen, d.extended_rmse_mm, unit)}});
  }
  return rows;
}

std::vector<Table> candidate_tables(const Diagnosis& d) {
  std::vector<Table> tables;
  const auto add = [&](const NamedCause* chosen, std::string caption) {
    const std::vector<Fields> rows = candidate_rows(d, chosen);
    if (!rows.empty()) tables.push_back(result::table_of(std::move(caption), rows.front(), rows));
  };
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list)
      add(&named, "Causes tested as alternatives to " + std::string(named.cause.id));
  }
  add(nullptr, d.causes.empty() && d.partial.empty()
                   ? "Tested causes: no cause reduced the held-out error sufficiently"
                   : "Further causes: no further cause reduced the held-out error sufficiently");
  return tables;
}

Fields run_fields(const Diagnosis& d, const RunError& run) {
  return {{"run", "run", run.run},
          {"as_given_rmse_mm", "given", or_dash(run.given)},
          {"recalibrated_rmse_mm", "recalibrated", or_dash(run.recalibrated)},
          {"extended_rmse_mm", "extended",
           is_extended(d) ? or_dash(run.extended) : shown(run.extended, dash, true)}};
}

Table run_table(const Diagnosis& d) {
  return result::table_of(
      model::in_unit(
          "RMSE of each run [mm]; the recalibrated and the extended model are fitted to the other runs",
          d.extended_model.output_unit),
      d.runs, [&](const RunError& run) { return run_fields(d, run); });
}

std::vector<const NamedCause*> shown_causes(const Diagnosis& d) {
  std::vector<const NamedCause*> causes;
  for (const NamedCause& named : d.causes) causes.push_back(&named);
  for (const NamedCause& named : d.partial) {
    if (named.gain_percent.lower > 0) causes.push_back(&named);
  }
  return causes;
}

Fields parameter_fields(std::string_view cause, const CauseParameter& p) {
  const Value interval = p.has_interval ? Value(Value::List{p.ci95.lower, p.ci95.upper}) : Value();
  return {{"", "cause", cause},
          {"", "parameter", p.name},
          {"value", "value", result::number(p.value)},
          {"ci95", "95 % interval",
           shown(interval, p.has_interval ? text_of(p.ci95, p.value, " to ") : "not fitted", true)},
          {"", "unit", p.unit}};
}

Table cause_parameter_table(const Diagnosis& d, std::size_t most) {
  std::vector<Fields> rows;
  for (const NamedCause* named : shown_causes(d)) {
    const std::size_t size = named->parameters.size();
    const bool short_enough = size <= most;
    std::size_t listed = 0;
    for (const CauseParameter& p : named->parameters) {
      // If a cause has more than `most` parameters, only parameters with a determined interval are listed.
      if (!short_enough && (!p.determined() || listed + 1 >= most)) continue;
      rows.push_back(parameter_fields(named->cause.title, p));
      ++listed;
    }
    if (listed < size)
      rows.push_back({{"", "cause", named->cause.title},
                      {"", "parameter",
                       (listed > 0 ? "and " : "no parameter determined: ") + std::to_string(size - listed) +
                           (listed > 0 ? " more, listed in the appendix" : " in the appendix")}});
  }
  return result::table_of("Parameters of the causes", parameter_fields("", {}), rows);
}

Table moved_table(const Diagnosis& d, const model::Model& given) {
  const bool extended = is_extended(d);
  std::vector<Fields> rows;
  const std::vector<double> values = model::flat_values(d.extended_model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string path = model::parameter_path(d.extended_model, i);
    const auto before = model::find_path(given, path);
    const double old = before ? model::flat_values(given)[*before] : 0;
    Fields& row = rows.emplace_back(Fields{
        {"", "parameter", path},
        {"", "unit",
         model::in_unit(model::parameter_spec(d.extended_model, i).unit, d.extended_model.output_unit)},
        {"", "given", value_at(given, path)},
        {"", "recalibrated", value_at(d.recalibrated_model, path)}});
    if (extended) row.emplace_back("", "extended", result::number(values[i]));
    row.emplace_back("", extended ? "change from the given value" : "change",
                     shown({}, old != 0 ? fixed(100 * (values[i] / old - 1), 1) + " %" : dash, true));
  }
  return result::table_of("", rows.empty() ? Fields() : rows.front(), rows);
}

}  // namespace softgrip::sysid
