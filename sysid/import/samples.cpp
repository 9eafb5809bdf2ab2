#include "sysid/import/samples.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/numbers.h"
#include "base/statistics.h"
#include "base/text.h"

namespace softgrip::sysid {
namespace {

constexpr double finest_s = 1e-9;
constexpr double hole_s = 0.5;
constexpr double hole_intervals = 20;
constexpr double hole_change = 0.02;

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + (count == 1 ? " sample " : " samples ") + what;
}

/// Keeps only the samples with the given indices, in the given order.
void keep(ForeignSamples& samples, const std::vector<std::size_t>& kept) {
  if (kept.size() == samples.size()) return;
  const auto of = [&](const auto& all) {
    std::decay_t<decltype(all)> chosen;
    chosen.reserve(kept.size());
    for (const std::size_t i : kept) chosen.push_back(all[i]);
    return chosen;
  };
  for (std::vector<double>& values : samples.values) {
    if (!values.empty()) values = of(values);
  }
  samples.row = of(samples.row);
}

void keep_range(ForeignSamples& samples, std::size_t first, std::size_t last) {
  std::vector<std::size_t> kept;
  for (std::size_t i = first; i < last; ++i) kept.push_back(i);
  keep(samples, kept);
}

/// Returns the resolution of times up to `largest_s` as a power of 10 [s], at least 1e-9 s. Times in seconds
/// since 1970 are stored as doubles in steps of 0.24 us, so smaller digits of a time difference are rounding
/// errors.
double resolution_s(double largest_s) {
  const double step = std::nextafter(largest_s, 2 * largest_s + 1) - largest_s;
  return std::max(finest_s, std::pow(10.0, std::ceil(std::log10(step) - 1e-9)));
}

double rounded(double value, double step) {
  const double per_second = std::round(1 / step);
  return step < 1 ? std::round(value * per_second) / per_second : value;
}

/// Subtracts the time of the first sample from all times.
void from_zero(std::vector<double>& time_s, std::vector<std::string>& notes) {
  const double first = time_s.front();
  double largest = 0;
  for (const double time : time_s) largest = std::max(largest, std::abs(time));
  const double step = resolution_s(largest);
  for (double& time : time_s) time = rounded(time - first, step);
  if (first != 0)
    notes.push_back("times are relative to the first sample, which is at " + significant(first, 12) + " s");
}

/// Makes the times relative to the first sample after earlier samples were left out.
void begin_at_first(ForeignSamples& samples) {
  std::vector<double>& time_s = samples[Role::time];
  const double begin_s = time_s.front();
  for (double& time : time_s) time = rounded(time - begin_s, finest_s);
  samples.begin_s = rounded(samples.begin_s + begin_s, finest_s);
}

double width_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() ? 0 : *high - *low;
}

double usual_interval_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return median_of(std::span<double>(steps));
}

/// Returns true if two samples with the same time can be merged: no role has two different values. Two
/// samples with the same values are not merged, because they can be two measurements of a finger at rest.
bool complete_each_other(const ForeignSamples& samples, std::size_t a, std::size_t b) {
  bool completes = false;
  bool repeats = false;
  for (const RoleSpec& spec : roles) {
    const std::vector<double>& values = samples[spec.role];
    if (spec.role == Role::time || values.empty()) continue;
    const bool both = std::isfinite(values[a]) && std::isfinite(values[b]);
    if (both && values[a] != values[b]) return false;
    repeats = repeats || both;
    completes = completes || std::isfinite(values[a]) != std::isfinite(values[b]);
  }
  return completes || !repeats;
}

void join(ForeignSamples& samples, std::size_t into, std::size_t from) {
  for (std::vector<double>& values : samples.values) {
    if (!values.empty() && !std::isfinite(values[into])) values[into] = values[from];
  }
}

/// Returns a sentence about repeated times. The sentence states how many rows repeat a time, the step of the
/// time stamps, and the remedy.
std::string about_repeats(const std::vector<double>& time_s, std::size_t repeated) {
  std::vector<double> steps;
  std::vector<std::size_t> changes;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] <= time_s[i - 1]) continue;
    steps.push_back(time_s[i] - time_s[i - 1]);
    changes.push_back(i);
  }
  if (steps.empty())
    return "all rows have the same time. To compute the times from the row numbers, use --rate-hz R instead "
           "of --time";
  // The first and the last time stamp may have fewer rows than the other time stamps, so these two are not
  // used for the rate.
  const std::size_t rows = changes.size() > 1 ? changes.back() - changes.front() : time_s.size() - 1;
  const double rows_s =
      changes.size() > 1 ? time_s[changes.back()] - time_s[changes.front()] : time_s.back() - time_s.front();
  const double rate = static_cast<double>(rows) / rows_s;
  return std::to_string(repeated) + " of " + std::to_string(time_s.size()) +
         " rows have the time of the previous row, because the time stamps have steps of " +
         significant(median_of(std::span<double>(steps))) + " s. If the rows are evenly spaced, --rate-hz " +
         significant(rate) + " instead of --time keeps every row";
}

/// Returns the index of the first sample of each segment between two gaps, and then the number of samples.
std::vector<std::size_t> edges_at_holes(const ForeignSamples& samples) {
  const std::vector<double>& time_s = samples[Role::time];
  const std::vector<double>& command = samples[Role::command];
  const double long_s = std::max(hole_s, hole_intervals * usual_interval_s(time_s));
  const double change_kpa = hole_change * width_of(command);
  std::vector<std::size_t> edges{0};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (time_s[i] - time_s[i - 1] > long_s && std::abs(command[i] - command[i - 1]) > change_kpa)
      edges.push_back(i);
  }
  edges.push_back(samples.size());
  return edges;
}

/// Returns the index of the longest segment.
/// @param edges  result of edges_at_holes().
std::size_t longest_segment(const std::vector<double>& time_s, const std::vector<std::size_t>& edges) {
  const auto length_s = [&](std::size_t k) { return time_s[edges[k + 1] - 1] - time_s[edges[k]]; };
  std::size_t longest = 0;
  for (std::size_t k = 1; k + 1 < edges.size(); ++k) {
    if (length_s(k) > length_s(longest)) longest = k;
  }
  return longest;
}

/// Times of the first and the last sample of a segment, relative to the first sample of the file [s].
struct Segment {
  double begin_s = 0;
  double end_s = 0;

  [[nodiscard]] std::string text() const { return written(begin_s) + " to " + written(end_s) + " s"; }
};

/// Returns the segment from sample `first` to the sample before `last`.
Segment segment_of(const ForeignSamples& samples, std::size_t first, std::size_t last) {
  // The options count from the first sample of the file.
  const auto in_file = [&](std::size_t i) {
    return rounded(samples.begin_s + samples[Role::time][i], finest_s);
  };
  return {in_file(first), in_file(last - 1)};
}

}  // namespace

std::optional<SampleProblem> order_in_time(const Mapping& mapping, ForeignSamples& samples,
                                           ImportRemarks& remarks, const std::string& groups) {
  std::vector<std::size_t> timed;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::isfinite(samples[Role::time][i])) timed.push_back(i);
  }
  if (timed.empty()) return SampleProblem{0, "no sample has a time", {}};
  if (timed.size() < samples.size())
    remarks.notes.push_back(counted(samples.size() - timed.size(), "without a time (left out)"));
  remarks.account.leave_out(LeftOut::no_time, samples.size() - timed.size());
  keep(samples, timed);
  from_zero(samples[Role::time], remarks.notes);
  const std::vector<double>& time_s = samples[Role::time];
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (time_s[i] < time_s[i - 1])
      return SampleProblem{
          samples.row[i],
          "the time goes back, from " + significant(time_s[i - 1], 7) + " s to " + significant(time_s[i], 7) +
              " s after the first sample",
          !groups.empty() ? groups
                          : "if the file contains two runs, split the file here and import each run. If the "
                            "clock was set during the recording, use --rate-hz R instead of --time"};
  }
  std::vector<std::size_t> kept;
  std::size_t repeated = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (time_s[i] < mapping.from_s || time_s[i] > mapping.to_s) {
      remarks.account.leave_out(LeftOut::outside_stretch);
    } else if (kept.empty() || time_s[i] != time_s[kept.back()]) {
      kept.push_back(i);
    } else if (complete_each_other(samples, kept.back(), i)) {
      join(samples, kept.back(), i);
      ++remarks.account.joined;
    } else {
      ++repeated;
    }
  }
  if (kept.empty())
    return SampleProblem{0, "the file has no samples between --from-s and --to-s",
                         "the file lasts " + significant(time_s.back()) + " s"};
  remarks.account.leave_out(LeftOut::repeated_time, repeated);
  if (repeated > 0)
    remarks.notes.push_back(counted(repeated, "with the time of the previous sample (left out)"));
  if (static_cast<double>(repeated) > warned_share * static_cast<double>(samples.size()))
    remarks.warnings.push_back(groups.empty()
                                   ? about_repeats(time_s, repeated)
                                   : std::to_string(repeated) + " of " + std::to_string(time_s.size()) +
                                         " rows have the time of the previous row: " + groups);
  keep(samples, kept);
  samples.begin_s = samples[Role::time].front();
  if (samples.begin_s != 0) from_zero(samples[Role::time], remarks.notes);
  return std::nullopt;
}

void complete_drive(ForeignSamples& samples, ImportRemarks& remarks) {
  if (samples[Role::command].empty()) {
    samples[Role::command] = samples[Role::pressure];
    remarks.notes.emplace_back(
        "no command column, so the measured pressure is used instead (for a fit, use --drive measured)");
  }
  std::vector<double>& command = samples[Role::command];
  const auto first = std::find_if(command.begin(), command.end(), [](double v) { return std::isfinite(v); });
  if (const auto before = static_cast<std::size_t>(first - command.begin());
      before > 0 && first != command.end()) {
    remarks.notes.push_back(counted(before, "before the first command (left out)"));
    remarks.account.leave_out(LeftOut::before_command, before);
    keep_range(samples, before, samples.size());
    begin_at_first(samples);
  }
  std::size_t carried = 0;
  std::vector<double>& whole = samples[Role::command];
  for (std::size_t i = 1; i < whole.size(); ++i) {
    if (std::isfinite(whole[i])) continue;
    whole[i] = whole[i - 1];
    ++carried;
  }
  if (carried > 0)
    remarks.notes.push_back(
        counted(carried, "without a command (the command of the previous sample is used)"));
}

void cut_at_holes(ForeignSamples& samples, ImportRemarks& remarks) {
  std::vector<Segment> others;
  std::size_t gaps = 0;
  for (auto edges = edges_at_holes(samples); edges.size() > 2; edges = edges_at_holes(samples)) {
    gaps += edges.size() - 2;
    const std::size_t longest = longest_segment(samples[Role::time], edges);
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      if (k != longest) others.push_back(segment_of(samples, edges[k], edges[k + 1]));
    }
    remarks.account.leave_out(LeftOut::hole, samples.size() - (edges[longest + 1] - edges[longest]));
    keep_range(samples, edges[longest], edges[longest + 1]);
    begin_at_first(samples);
  }
  if (gaps == 0) return;
  std::ranges::sort(others, {}, &Segment::begin_s);
  remarks.notes.push_back(
      "the command changed during " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
      ", so only the longest segment is kept: " + segment_of(samples, 0, samples.size()).text() +
      "; to select another segment, use --from-s and --to-s: " + with_commas(others, &Segment::text));
}

}  // namespace softgrip::sysid
