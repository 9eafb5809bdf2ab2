// Creates the page of the control study.

#include <limits>

#include "base/numbers.h"
#include "base/text.h"
#include "bench/studies/control_study.h"
#include "bench/studies/models.h"

namespace softgrip::studies {
namespace {

using sysid::Colour;

/// Returns the RMSE of the scheme `worse` divided by the RMSE of the scheme `better`; NaN if the study has no
/// result of one of them.
double gain_of(const ControlStudy& study, const std::string& worse, const std::string& better,
               double frequency_hz, double mismatch) {
  const ControlFigure* const a = study.find(worse, frequency_hz, mismatch);
  const ControlFigure* const b = study.find(better, frequency_hz, mismatch);
  if (a == nullptr || b == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return a->rmse_mm.median / b->rmse_mm.median;
}

std::string gains_in_words(const ControlStudy& study, const std::string& worse, const std::string& better,
                           double mismatch) {
  return with_commas(study.options.frequencies_hz, [&](double frequency) {
    return significant(gain_of(study, worse, better, frequency, mismatch), 3) + " at " +
           significant(frequency) + " Hz";
  });
}

std::string verdict(const ControlStudy& study) {
  const double mismatch = study.options.mismatches.front();
  return "With model errors of up to " + significant(100 * mismatch) +
         " %, the full inverse of the extended structure reduces the tracking error of the best PID alone by "
         "a factor of " +
         gains_in_words(study, "pid", "full_extended", mismatch) +
         "; the published scheme cannot be computed.";
}

sysid::Chart chart_of(const ControlStudy& study, double mismatch) {
  sysid::Chart chart;
  chart.x.label = "frequency [Hz]";
  chart.y.label = "RMSE [mm]: median and 90 % interval of the simulated fingers";
  chart.x.logarithmic = chart.y.logarithmic = true;
  chart.height = 360;
  const auto add = [&](const char* id, Colour colour, bool dashed) {
    sysid::Series line, band;
    line.label = id;
    line.colour = band.colour = colour;
    line.dash = dashed ? sysid::Dash::dashed : sysid::Dash::solid;
    band.style = sysid::Series::Style::band;
    for (const double frequency : study.options.frequencies_hz) {
      const ControlFigure* const figure = study.find(id, frequency, mismatch);
      if (figure == nullptr) continue;
      for (sysid::Series* series : {&line, &band}) series->x.push_back(frequency);
      line.y.push_back(figure->rmse_mm.median);
      band.y.push_back(figure->rmse_mm.low);
      band.y_upper.push_back(figure->rmse_mm.high);
    }
    if (line.x.empty()) return;
    chart.series.push_back(std::move(band));
    chart.series.push_back(std::move(line));
  };
  add("pid", Colour::measured, false);
  add("published_cut", Colour::bad, false);
  add("planned_identified", Colour::other, false);
  add("full_extended", Colour::good, false);
  add("planned_extended", Colour::model, true);
  return chart;
}

sysid::Table table_of(const ControlScheme& scheme) {
  sysid::Table table;
  table.header = {"f [Hz]",
                  "± [mm]",
                  "model error [%]",
                  "RMSE [mm]",
                  "RMSE of 90 % of the fingers [mm]",
                  "RMSE [% of stroke]",
                  "largest error [mm]",
                  "pressure: mean, largest [kPa]",
                  "kp, ki, kd",
                  "Ms"};
  table.numeric = {true, true, true, true, true, true, true, true, false, true};
  for (const ControlFigure& f : scheme.figures) {
    table.rows.push_back({significant(f.frequency_hz), significant(f.amplitude_mm),
                          significant(100 * f.mismatch), fixed(f.rmse_mm.median, 3),
                          fixed(f.rmse_mm.low, 3) + " .. " + fixed(f.rmse_mm.high, 3),
                          fixed(f.percent_of_stroke, 2), fixed(f.most_mm.median, 3),
                          fixed(f.pressure_mean_kpa, 0) + ", " + fixed(f.pressure_most_kpa, 0),
                          significant(f.pid.kp_kpa_per_mm, 2) + ", " + significant(f.pid.ki_kpa_per_mm_s, 2) +
                              ", " + significant(f.pid.kd_kpa_s_per_mm, 1),
                          fixed(f.sensitivity, 2)});
  }
  return table;
}

}  // namespace

sysid::Page control_page(const ControlStudy& study) {
  const ControlStudyOptions& options = study.options;
  const double mismatch = options.mismatches.front();
  sysid::Page page("Study of control", verdict(study), sysid::Tone::good);
  page.provenance(
      {{"Software", sysid::software_and_version()},
       {"Command", "softgrip study control --draws " + std::to_string(options.draws) + " --seed " +
                       std::to_string(options.seed)},
       {"Reference",
        significant(options.mean_mm) + " ± " + significant(options.amplitude_mm) +
            " mm, or less if the finger cannot follow this amplitude; stroke: twice the amplitude"},
       {"Loop",
        significant(options.rate_hz) + " Hz, noise " + significant(options.noise_mm) + " mm, 0 to 60 kPa"},
       {"Gains", "the gains of all schemes were tuned by the same criterion: smallest RMSE on " +
                     std::to_string(options.search_draws) + " other fingers, sensitivity peak Ms at most " +
                     significant(options.most_sensitivity)},
       {"Fingers", std::to_string(options.draws) +
                       " fingers for each result; each parameter of a finger has a separate random error"},
       {"Time", significant(study.wall_s, 3) + " s"}});
  page.section("Results by scheme");
  for (const double each : options.mismatches) {
    page.figure({"tracking error by frequency " + significant(100 * each) + " percent error",
                 "Model errors of up to " + significant(100 * each) +
                     " %: RMSE of the true displacement of the finger, not of the noisy reading.",
                 {{chart_of(study, each)}}});
  }
  page.list(
      {"Compared with PID alone, the full inverse of the extended structure reduces the RMSE by a factor "
       "of " +
           gains_in_words(study, "pid", "full_extended", mismatch) + ".",
       "For a finger that follows the published model, which has no inverse, the plan reduces the RMSE of "
       "PID alone by a factor of " +
           gains_in_words(study, "pid_on_published", "planned_on_published", mismatch) + ".",
       "The plan with the published structure, identified on the simulated rig, reduces the RMSE of PID "
       "alone by a factor of " +
           gains_in_words(study, "pid", "planned_identified", mismatch) + "."});
  page.section("Models that the controllers use");
  page.paragraph(
      "Both structures were identified from the responses of the simulated rig to tp1 and sp1 with 0.05 mm "
      "of noise. "
      "Published structure: RMSE " +
      fixed(study.identified_rmse_mm, 3) + " mm, beta/(alpha + 1/k0) " +
      significant(wrong_way_ratio(study.identified), 3) + ". With valve lag and dead time: RMSE " +
      fixed(study.extended_rmse_mm, 3) + " mm, " + significant(wrong_way_ratio(study.extended), 3) + ".");
  page.section("Tables of the schemes");
  for (const ControlScheme& scheme : study.schemes) {
    page.subsection(scheme.id + ": " + scheme.about);
    if (!scheme.refusal.empty()) {
      page.paragraph("Refused before the start: " + scheme.refusal + ".");
      continue;
    }
    page.table(table_of(scheme));
    page.paragraph("At " + significant(scheme.figures.front().frequency_hz) +
                   " Hz, the accuracy is limited by " + scheme.figures.front().limited_by + ".");
  }
  return page;
}

}  // namespace softgrip::studies
