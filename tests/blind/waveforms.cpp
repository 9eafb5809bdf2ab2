#include "waveforms.h"

#include <cmath>
#include <numbers>
#include <random>

#include "variation.h"

namespace blind {
namespace {

constexpr double rate_hz = 100;
constexpr double log_s = 80;
constexpr double working_kpa = 58;
constexpr double pi = std::numbers::pi;

// Appends segments to a command that is stored as samples.
class Pen {
 public:
  explicit Pen(std::vector<double>& out) : out_(out) { out_.push_back(0); }
  void line(double to, double seconds) {
    const int n = std::max(1, static_cast<int>(std::lround(seconds * rate_hz)));
    const double from = out_.back();
    for (int i = 1; i <= n; ++i) out_.push_back(from + (to - from) * i / n);
  }
  void hold(double seconds) { line(out_.back(), seconds); }
  void sine(double amplitude, double frequency, int cycles) {
    const int n = static_cast<int>(std::lround(cycles / frequency * rate_hz));
    for (int i = 1; i <= n; ++i)
      out_.push_back(amplitude * (1 - std::cos(2 * pi * frequency * i / rate_hz)) / 2);
  }
  double seconds() const { return static_cast<double>(out_.size() - 1) / rate_hz; }
  void finish() {
    line(0, 1);
    while (seconds() < log_s) hold(std::min(1.0, log_s - seconds() + 0.5 / rate_hz));
    out_.resize(static_cast<std::size_t>(log_s * rate_hz));
  }

 private:
  std::vector<double>& out_;
};

std::vector<double> triangles(std::mt19937_64& random) {
  std::vector<double> out;
  Pen pen(out);
  std::uniform_real_distribution<double> unit(0, 1);
  pen.hold(1.5);
  // Each of these four triangles has a higher peak pressure than the triangles before it.
  for (const double peak : {14.0, 25.0, 36.0, 47.0}) {
    pen.line(peak * (1 + 0.1 * (unit(random) - 0.5)), 1.5);
    pen.line(0, 1.5);
  }
  for (int k = 0; pen.seconds() < log_s - 14; ++k) {
    const double peak = 15 + 43 * (k % 3 == 0 ? 1 - 0.2 * unit(random) : unit(random));
    const double half_s = std::exp(std::log(0.7) + unit(random) * std::log(7.0));
    pen.line(peak, half_s);
    if (k % 3 == 1) {
      pen.line(peak * (0.3 + 0.3 * unit(random)), half_s * 0.7);
      pen.line(peak, half_s * 0.7);
    }
    pen.line(k % 4 == 2 ? 5 : 0, half_s);
    if (k % 4 == 3) pen.hold(3);
  }
  pen.finish();
  return out;
}

std::vector<double> staircase(std::mt19937_64& random) {
  std::vector<double> out;
  Pen pen(out);
  std::uniform_real_distribution<double> unit(0, 1);
  pen.hold(1.5);
  for (const double level : {12.0, 25.0, 40.0, 56.0, 33.0, 17.0}) {
    pen.line(level + 4 * (unit(random) - 0.5), 0.3);
    pen.hold(level > 50 ? 14 : 4 + 2 * unit(random));
  }
  pen.line(0, 0.3);
  pen.hold(12);
  pen.line(50, 0.5);
  pen.hold(3);
  pen.line(0, 0.5);
  pen.finish();
  return out;
}

std::vector<double> sines_and_steps(std::mt19937_64& random) {
  std::vector<double> out;
  Pen pen(out);
  std::uniform_real_distribution<double> unit(0, 1);
  pen.hold(1);
  pen.sine(40 + 15 * unit(random), 0.08 + 0.03 * unit(random), 1);
  pen.sine(35 + 20 * unit(random), 0.3 + 0.1 * unit(random), 4);
  pen.sine(25 + 20 * unit(random), 0.9 + 0.3 * unit(random), 5);
  pen.hold(2);
  pen.line(30 + 20 * unit(random), 0.01);
  pen.hold(4);
  pen.line(10, 0.01);
  pen.hold(3);
  pen.line(0, 0.01);
  pen.hold(8);
  pen.line(55, 2.5);
  pen.line(0, 2.5);
  pen.hold(6);
  pen.line(55, 2.5);
  pen.line(0, 2.5);
  pen.finish();
  return out;
}

}  // namespace

LogInput surrounded(std::vector<double> command_kpa, double rate, double campaign_start_s,
                    std::uint64_t seed) {
  std::mt19937_64 random(seed ^ 0xA5A5A5A5ULL);
  std::uniform_real_distribution<double> unit(0, 1);
  const double warm = 3 + 4 * unit(random), phase = 6 * unit(random), dip = 40 + 60 * unit(random);
  LogInput log;
  log.rate_hz = rate;
  log.command_kpa = std::move(command_kpa);
  for (std::size_t k = 0; k < log.command_kpa.size(); ++k) {
    const double t = campaign_start_s + static_cast<double>(k) / rate;
    log.temperature_c.push_back(20 + warm * (1 - std::exp(-t / 90)) +
                                1.5 * std::sin(2 * pi * t / 70 + phase));
    log.supply_kpa.push_back(500 - dip * 0.5 * (1 - std::cos(2 * pi * t / 37 + phase)));
  }
  return log;
}

namespace {

// Returns the log of a run at the sample rate of the run. The pulse that is not recorded precedes the
// command.
LogInput varied(std::vector<double> command, const variation::Run& run, double start_s,
                const Campaign& campaign) {
  const double rate = run.rate_hz > 0 ? run.rate_hz : rate_hz;
  for (double& u : command) u *= run.amplitude;
  std::vector<double> all = variation::pulse(run, working_kpa, rate);
  const std::size_t unrecorded = all.size();
  command = variation::resampled(command, rate_hz, rate);
  all.insert(all.end(), command.begin(), command.end());
  LogInput log = surrounded(std::move(all), rate, start_s, campaign.seed);
  log.unrecorded = unrecorded;
  log.gain = run.gain;
  log.offset_mm = run.offset_share * campaign.span_mm;
  for (double& t : log.temperature_c) t += run.warmer_c;
  for (double& s : log.supply_kpa) s *= run.supply;
  return log;
}

}  // namespace

std::vector<LogInput> draw_campaign(const Campaign& campaign) {
  using Draw = std::vector<double> (*)(std::mt19937_64&);
  constexpr Draw kinds[] = {triangles, staircase, sines_and_steps};
  std::mt19937_64 random(campaign.seed * 7919 + 5);
  const std::size_t first = variation::first_kind(campaign.variation, campaign.seed, std::size(kinds));
  std::vector<LogInput> logs;
  double start_s = 0;
  for (std::size_t i = 0; i < campaign.runs; ++i) {
    const variation::Run run = variation::draw_run(campaign.variation, campaign.seed, i);
    logs.push_back(varied(kinds[(first + i) % std::size(kinds)](random), run, start_s, campaign));
    start_s += static_cast<double>(logs.back().command_kpa.size()) / logs.back().rate_hz;
  }
  return logs;
}

}  // namespace blind
