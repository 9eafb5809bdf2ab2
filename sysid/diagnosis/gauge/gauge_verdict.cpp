#include "sysid/diagnosis/gauge/gauge_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// One of the causes between which the gauge check decides: a named cause, or another cause in its place.
struct Standing {
  Cause cause;
  StructureFit fit;
  /// True: the logs do not list the cause as an alternative; the gauge check may add it.
  bool implied = false;
};

/// A possible explanation of the logs: for each named cause, either this cause or its replacement.
struct Explanation {
  /// for each named cause, what this explanation contains; 0: the named cause, i > 0: its i-th replacement
  std::vector<std::size_t> standing;
  std::size_t shape = 0;
};

std::string in_words(const SensorShape& shape) {
  std::string text;
  for (const model::BlockSpec& block : shape.blocks) {
    text += (text.empty() ? "" : " with ") + std::string(cause_of(block.type)->sensor_shape);
  }
  return text.empty() ? "a linear sensor" : text;
}

double mean_offset_mm(const FitPoint& point) {
  double sum = 0;
  for (const StartState& start : point.starts) sum += start.offset_mm;
  return point.starts.empty() ? 0 : sum / static_cast<double>(point.starts.size());
}

class Weighing {
 public:
  Weighing(const GaugeQuestion& question, const SearchData& data, const Division& division,
           Selection& selection, std::vector<std::string>& warnings)
      : question_(question), data_(data), division_(division), selection_(selection), warnings_(warnings) {}

  GaugeEvidence run() {
    evidence_.file = question_.file;
    for (std::size_t place = 0; place < selection_.chosen.size(); ++place) add_place(place);
    asked_ = is_asked();
    const GaugeScales scales = gauge_scales(data_.records, question_.noise_mm);
    explain(false);
    evidence_.check = check_gauge(question_.file.readings, shapes_, scales);
    // Causes that the logs do not list are considered only if no other explanation fits.
    const std::size_t left_by_logs = shapes_.size();
    if (evidence_.check.outcome == GaugeOutcome::unexplained) explain(true);
    if (shapes_.size() > left_by_logs)
      evidence_.check = check_gauge(question_.file.readings, shapes_, scales);
    if (evidence_.check.outcome != GaugeOutcome::uncovered) settle();
    speak();
    return std::move(evidence_);
  }

 private:
  void add_place(std::size_t place) {
    const ChosenCause& chosen = selection_.chosen[place];
    std::vector<Standing> standing{{chosen.cause, selection_.extended, false}};
    std::vector<Cause> others = chosen.alternatives;
    const std::size_t alternatives = others.size();
    for (const Cause& cause : sensor_counterparts(chosen.cause)) {
      if (std::find(others.begin(), others.end(), cause) == others.end()) others.push_back(cause);
    }
    // A gauge check has an influence only if one of the causes is a nonlinear or saturated sensor.
    std::vector<Cause> all = others;
    all.push_back(chosen.cause);
    const bool matters =
        std::any_of(all.begin(), all.end(), [](const Cause& c) { return c.is_static_sensor(); });
    const bool fitted = position_of(selection_.extended.point.model, chosen.cause).has_value();
    if (matters && fitted && question_.may_replace) {
      for (Candidate& candidate : fit_candidates(data_, without(place), {.only = others})) {
        if (!candidate.fit) continue;
        const auto at = std::find(others.begin(), others.end(), candidate.cause);
        const bool implied = static_cast<std::size_t>(at - others.begin()) >= alternatives;
        standing.push_back({candidate.cause, std::move(*candidate.fit), implied});
      }
    }
    places_.push_back(std::move(standing));
  }

  [[nodiscard]] StructureFit without(std::size_t place) const {
    if (selection_.extended.causes.size() == 1) return selection_.base;
    return fit_without_cause(data_.records, selection_.extended, selection_.chosen[place].cause);
  }

  /// Lists every combination in which each named cause is kept or replaced, with its sensor shapes.
  /// @param with_implied  true: replacements are included even if the logs do not list them as alternatives.
  void explain(bool with_implied) {
    std::vector<std::size_t> at(places_.size(), 0);
    explanations_.clear();
    while (true) {
      bool implied = false;
      for (std::size_t place = 0; place < at.size(); ++place) implied |= places_[place][at[place]].implied;
      if (!implied || with_implied) {
        if (auto shape = shape_of(at)) explanations_.push_back({at, number_of(std::move(*shape))});
      }
      std::size_t place = 0;
      while (place < at.size() && ++at[place] == places_[place].size()) at[place++] = 0;
      if (place == at.size()) return;
    }
  }

  [[nodiscard]] std::optional<SensorShape> shape_of(const std::vector<std::size_t>& at) const {
    const StructureFit& extended = selection_.extended;
    model::Model sensor;
    sensor.blocks = static_sensor_blocks(extended.point.model);
    for (const ChosenCause& chosen : selection_.chosen)
      sensor = sysid::without(std::move(sensor), chosen.cause);
    double offset_mm = mean_offset_mm(extended.point);
    for (std::size_t place = 0; place < at.size(); ++place) {
      const Standing& standing = places_[place][at[place]];
      if (!standing.cause.is_static_sensor()) continue;
      const auto position = position_of(standing.fit.point.model, standing.cause);
      if (!position || position_of(sensor, standing.cause)) return std::nullopt;
      sensor = model::with_block(std::move(sensor), standing.fit.point.model.blocks[*position]);
      offset_mm = mean_offset_mm(standing.fit.point);
    }
    return SensorShape{std::move(sensor.blocks), offset_mm};
  }

  std::size_t number_of(SensorShape shape) {
    const auto known = std::find_if(shapes_.begin(), shapes_.end(),
                                    [&](const SensorShape& s) { return s.id() == shape.id(); });
    if (known != shapes_.end()) return static_cast<std::size_t>(known - shapes_.begin());
    shapes_.push_back(std::move(shape));
    return shapes_.size() - 1;
  }

  /// Returns true if the gauge readings permit at least one explanation that contains this cause.
  /// @param place  index of the named cause.
  /// @param candidate  index of the cause that the explanation contains in its place.
  [[nodiscard]] bool survives(std::size_t place, std::size_t candidate) const {
    return std::any_of(explanations_.begin(), explanations_.end(), [&](const Explanation& e) {
      return e.standing[place] == candidate && !evidence_.check.fits[e.shape].ruled_out;
    });
  }

  void settle() {
    const std::vector<GaugeFit>& fits = evidence_.check.fits;
    if (std::none_of(fits.begin(), fits.end(), [](const GaugeFit& fit) { return fit.ruled_out; })) return;
    std::vector<std::size_t> now(places_.size(), 0);
    std::vector<bool> brought_in(places_.size(), false);
    for (std::size_t place = 0; place < places_.size(); ++place) {
      const std::vector<Standing>& standing = places_[place];
      std::vector<std::size_t> left;
      for (std::size_t i = 0; i < standing.size(); ++i) {
        if (survives(place, i)) {
          if (!standing[i].implied) left.push_back(i);
        } else if (!standing[i].implied) {
          evidence_.ruled_out.emplace_back(standing[i].cause.id);
        }
      }
      for (std::size_t i = 0; left.empty() && i < standing.size(); ++i) {
        if (!survives(place, i)) continue;
        left.push_back(i);
        brought_in[place] = true;
      }
      if (left.empty()) return;
      now[place] = left.front();
      keep(place, left, brought_in[place]);
    }
    replace(now);
  }

  /// Removes those alternatives of a named cause that contradict the gauge readings. If the gauge check has
  /// added a cause, the added cause comes first, and the named cause becomes its alternative.
  void keep(std::size_t place, const std::vector<std::size_t>& left, bool brought_in) {
    ChosenCause& chosen = selection_.chosen[place];
    const std::vector<Standing>& standing = places_[place];
    std::vector<Cause> alternatives;
    for (const Cause& alternative : chosen.alternatives) {
      const auto fitted = std::find_if(standing.begin(), standing.end(),
                                       [&](const Standing& s) { return s.cause == alternative; });
      // An alternative that was not fitted was not tested, so it is kept.
      const bool stays = fitted == standing.end() ||
                         std::find(left.begin() + 1, left.end(),
                                   static_cast<std::size_t>(fitted - standing.begin())) != left.end();
      if (stays) alternatives.push_back(alternative);
    }
    if (brought_in) {
      alternatives.push_back(chosen.cause);
      warnings_.push_back("the logs indicate " + std::string(chosen.cause.id) +
                          ", but the gauge readings contradict this cause. The gauge readings indicate " +
                          std::string(standing[left.front()].cause.id) +
                          ", but this cause explains the logs less well than the first cause. Check that "
                          "nothing was changed between the logs and the gauge check");
    }
    chosen.alternatives = std::move(alternatives);
  }

  void replace(const std::vector<std::size_t>& now) {
    std::vector<std::size_t> changed;
    for (std::size_t place = 0; place < now.size(); ++place) {
      if (now[place] != 0) changed.push_back(place);
    }
    if (changed.empty()) return;
    const bool left_too_much =
        leaves_too_much(selection_.left, selection_.base_unexplained, question_.noise_mm);
    if (changed.size() == 1) {
      selection_.extended = places_[changed.front()][now[changed.front()]].fit;
    } else {
      selection_.extended = joined(changed, now);
    }
    for (const std::size_t place : changed) selection_.chosen[place].cause = places_[place][now[place]].cause;
    selection_.extended_losses = held_out_losses(data_.records, division_, selection_.extended);
    selection_.left =
        unexplained_error_of(selection_.extended.residual_mm, question_.noise_mm, data_.scales.step_mm);
    for (std::size_t place = 0; place < now.size(); ++place) {
      const StructureFit rest = without(place);
      selection_.chosen[place].gain_percent = gain_percent(held_out_losses(data_.records, division_, rest),
                                                           selection_.extended_losses, question_.seed);
    }
    evidence_.replaced = true;
    if (!left_too_much && leaves_too_much(selection_.left, selection_.base_unexplained, question_.noise_mm)) {
      warnings_.push_back(
          "the gauge check shows which component is nonlinear, but the model block for this nonlinearity "
          "leaves an unexplained error of " +
          with_unit(selection_.left.excess_mm));
    }
  }

  [[nodiscard]] StructureFit joined(const std::vector<std::size_t>& changed,
                                    const std::vector<std::size_t>& now) const {
    FitPoint point = selection_.extended.point;
    std::vector<Cause> causes = selection_.extended.causes;
    for (const std::size_t place : changed) {
      const Standing& standing = places_[place][now[place]];
      const Cause& old = selection_.chosen[place].cause;
      const model::Model& from = standing.fit.point.model;
      point.model = model::with_block(sysid::without(point.model, old),
                                      from.blocks[*position_of(from, standing.cause)]);
      std::replace(causes.begin(), causes.end(), old, standing.cause);
    }
    return fit_structure(data_.records, std::move(causes), point);
  }

  [[nodiscard]] std::string unit() const { return " " + std::string(name_of(question_.file.output_unit)); }
  [[nodiscard]] std::string with_unit(double value) const { return significant(value, 2) + unit(); }

  [[nodiscard]] std::string covered() const {
    const std::vector<double> positions = distinct_positions(question_.file.readings);
    return "over " + significant(positions.front(), 3) + " to " + significant(positions.back(), 3) + unit();
  }

  /// Returns a description of the deviation of the sensor from a straight line.
  [[nodiscard]] std::string bend_in_words() const {
    const GaugeCheck::Departure departure = evidence_.check.departure();
    if (!departure.clips) return "nonlinear by up to " + with_unit(departure.largest_mm);
    const GaugeFit& end = evidence_.check.free_end;
    return "saturated at " + significant(end.shape.at(1e6), 3) + unit();
  }

  /// Returns true if the logs alone do not decide between different static curves of the sensor.
  [[nodiscard]] bool is_asked() const {
    return std::any_of(places_.begin(), places_.end(), [](const std::vector<Standing>& standing) {
      return std::any_of(standing.begin(), standing.end(), [&](const Standing& s) {
        return !s.implied && gauge_tells_apart(s.cause, standing.front().cause);
      });
    });
  }

  [[nodiscard]] std::string sentence_decided() const {
    const GaugeFit& best = evidence_.check.fits[evidence_.check.best];
    if (best.shape.blocks.empty()) {
      return "The gauge check shows that the sensor is linear " + covered() + ", within " +
             with_unit(best.rms_mm) +
             ". The finger or a contact therefore causes the nonlinearity in these logs, not the sensor.";
    }
    return "The gauge check shows that the sensor is " + bend_in_words() +
           ". This nonlinearity agrees with the nonlinearity in these logs within " + with_unit(best.rms_mm) +
           ", so the sensor is the cause, not the finger.";
  }

  /// Returns the sentence on the result of the check if several sensor shapes remain possible.
  [[nodiscard]] std::string sentence_open(bool bent) const {
    const GaugeCheck& check = evidence_.check;
    std::string left, out;
    for (const GaugeFit& fit : check.fits) {
      std::string& list = fit.ruled_out ? out : left;
      list += (list.empty() ? "" : ", ") + in_words(fit.shape);
    }
    const std::string besides = out.empty() ? "" : " The gauge check rules out: " + out + ".";
    if (check.outcome != GaugeOutcome::unexplained) {
      return "The gauge check does not decide between the explanations. The gauge readings fit these "
             "explanations equally well: " +
             left + " (" + with_unit(check.noise_mm) +
             " of noise in the gauge readings). Take gauge readings beyond the largest reading of the logs, "
             "take more gauge readings, or use a more accurate gauge." +
             besides;
    }
    return "The gauge check contradicts all explanations of these logs" +
           (bent ? ". The sensor is " + bend_in_words() +
                       ", but the shape of this nonlinearity does not agree with the nonlinearity in these "
                       "logs."
                 : std::string(".")) +
           besides;
  }

  void speak() {
    const GaugeCheck& check = evidence_.check;
    if (check.outcome == GaugeOutcome::uncovered) {
      evidence_.sentence =
          "The gauge check is not conclusive, because its readings cover only " +
          significant(100 * check.covered_share, 2) +
          " % of the range of the readings in these logs. Check that the sensor follows the target.";
      warnings_.push_back(evidence_.sentence);
      return;
    }
    const GaugeCheck::Departure departure = check.departure();
    const bool bent = departure.clear && departure.rms_mm > limits::tolerated_noise * question_.noise_mm;
    const auto left = std::count_if(check.fits.begin(), check.fits.end(),
                                    [](const GaugeFit& fit) { return !fit.ruled_out; });
    const bool settled = left == 1 && check.fits.size() > 1;
    if (settled) {
      evidence_.sentence = sentence_decided();
    } else if (asked_) {
      evidence_.sentence = sentence_open(bent);
    } else {
      evidence_.sentence = bent ? "The gauge check shows that the sensor is " + bend_in_words() + "."
                                : "The gauge check shows that the sensor is linear " + covered() + ".";
    }
    if (!settled && bent) add_sensor_alternatives();
    if (bent && check.fits[check.best].shape.blocks.empty()) tell_of_bend();
    if (asked_ && !settled && check.outcome == GaugeOutcome::unexplained) {
      warnings_.push_back(
          "the gauge readings fit no explanation of these logs (" + with_unit(check.fits[check.best].rms_mm) +
          " is the RMS error of the best explanation, but the noise of the gauge readings is only " +
          with_unit(check.noise_mm) + "), so the gauge check does not change the verdict");
    }
  }

  /// Adds the sensor causes as alternatives to named causes in other components. It is called if the sensor
  /// is nonlinear and no named cause describes this nonlinearity.
  void add_sensor_alternatives() {
    for (ChosenCause& chosen : selection_.chosen) {
      if (!chosen.alternatives.empty() || chosen.cause.is_static_sensor()) continue;
      chosen.alternatives = sensor_counterparts(chosen.cause);
    }
  }

  void tell_of_bend() {
    warnings_.push_back(
        model::in_unit("the gauge check shows that the displacement sensor is " + bend_in_words() +
                           ", but no named cause explains this nonlinearity. The nonlinearity affects every "
                           "displacement in these logs. Calibrate the sensor first",
                       question_.file.output_unit));
  }

  const GaugeQuestion& question_;
  const SearchData& data_;
  const Division& division_;
  Selection& selection_;
  std::vector<std::string>& warnings_;
  std::vector<std::vector<Standing>> places_;
  std::vector<SensorShape> shapes_;
  std::vector<Explanation> explanations_;
  bool asked_ = false;
  GaugeEvidence evidence_;
};

}  // namespace

bool gauge_tells_apart(const Cause& one, const Cause& other) {
  return one.is_static_sensor() != other.is_static_sensor() || (one.is_static_sensor() && one != other);
}

GaugeScales gauge_scales(const std::vector<Record>& records, double noise_mm) {
  GaugeScales scales{noise_mm, std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity()};
  for (const Record& record : records) {
    const auto extent = extent_of(record.reading_mm);
    if (!extent) continue;
    scales.lowest_mm = std::min(scales.lowest_mm, extent->lowest);
    scales.highest_mm = std::max(scales.highest_mm, extent->highest);
  }
  return scales;
}

GaugeEvidence weigh_gauge(const GaugeQuestion& question, const SearchData& data, const Division& division,
                          Selection& selection, std::vector<std::string>& warnings) {
  return Weighing(question, data, division, selection, warnings).run();
}

}  // namespace softgrip::sysid
