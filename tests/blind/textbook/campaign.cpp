// Draws the commands, the temperature and the supply pressure of a campaign at random.
#include <algorithm>
#include <cmath>
#include <random>

#include "variation.h"
#include "world.h"

namespace textbook {
namespace {

constexpr double pi = 3.14159265358979;
using Points = std::vector<std::pair<double, double>>;  // time [s], pressure [kPa]

std::vector<double> joined(const Points& points, double rate_hz) {
  std::vector<double> out;
  std::size_t i = 0;
  const auto count = static_cast<std::size_t>(points.back().first * rate_hz);
  for (std::size_t k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    while (i + 2 < points.size() && t > points[i + 1].first) ++i;
    const auto& [t0, p0] = points[i];
    const auto& [t1, p1] = points[i + 1];
    out.push_back(p0 + (p1 - p0) * std::clamp((t - t0) / (t1 - t0), 0.0, 1.0));
  }
  return out;
}

// Returns triangles of many amplitudes and rates. Every third triangle contains a minor loop.
std::vector<double> triangles(std::mt19937_64& random, double rate_hz) {
  std::uniform_real_distribution<double> peak(20, 60), half(1.2, 5);
  Points points{{0, 0}, {1, 0}};
  const auto to = [&points](double after, double p) { points.emplace_back(points.back().first + after, p); };
  for (int i = 0; i < 8; ++i) {
    const double top = i == 2 ? 60 : peak(random), s = half(random);
    to(s, top);
    if (i % 3 == 2) {
      to(s / 2, top * 0.5);
      to(s / 2, top * 0.85);
    }
    to(s, i % 4 == 1 ? 8 : 0);
  }
  to(points.back().second > 0 ? 1 : 0.5, 0);
  to(3, 0);
  return joined(points, rate_hz);
}

std::vector<double> stairs(std::mt19937_64& random, double rate_hz) {
  std::uniform_real_distribution<double> hold(3, 8);
  Points points{{0, 0}, {1, 0}};
  for (const double p : {15.0, 32.0, 60.0, 40.0, 18.0, 50.0, 0.0}) {
    points.emplace_back(points.back().first + 0.05, p);
    points.emplace_back(points.back().first + hold(random), p);
  }
  return joined(points, rate_hz);
}

// Returns sums of two sines with frequencies between 0.05 and 0.6 Hz. The pressure is never below 0 kPa.
std::vector<double> sines(std::mt19937_64& random, double rate_hz) {
  std::uniform_real_distribution<double> slow(0.05, 0.12), fast(0.25, 0.6);
  const double f = slow(random), g = fast(random);
  std::vector<double> out;
  for (std::size_t k = 0; k < static_cast<std::size_t>(50 * rate_hz); ++k) {
    const double t = static_cast<double>(k) / rate_hz,
                 edge = std::clamp(std::min(t - 0.5, 48 - t) / 4, 0.0, 1.0);
    out.push_back(edge * (22 * (1 - std::cos(2 * pi * f * t)) + 7.5 * (1 - std::cos(2 * pi * g * t))));
  }
  return out;
}

using Draw = std::vector<double> (*)(std::mt19937_64&, double);
constexpr Draw kinds[] = {triangles, stairs, sines};

// The random parameters of one run: its variation, sample rate and command.
struct Drawn {
  variation::Run run;
  double rate_hz;
  std::vector<double> command;
};

Log surrounded(const Drawn& drawn, double start_s, double phase, double span_mm) {
  Log log;
  log.rate_hz = drawn.rate_hz;
  log.command_kpa = variation::pulse(drawn.run, working_kpa, drawn.rate_hz);
  log.unrecorded = log.command_kpa.size();
  for (const double u : drawn.command) log.command_kpa.push_back(drawn.run.amplitude * u);
  for (std::size_t k = 0; k < log.command_kpa.size(); ++k) {
    const double t = start_s + static_cast<double>(k) / drawn.rate_hz;
    log.temperature_c.push_back(22 + 3 * std::sin(2 * pi * t / 140 + phase) + drawn.run.warmer_c);
    // The supply pressure follows the on-off cycle of a compressor.
    log.supply_kpa.push_back(drawn.run.supply * (200 - 25 * std::abs(std::sin(pi * t / 23 + phase))));
  }
  log.gain = drawn.run.gain;
  log.offset_mm = drawn.run.offset_share * span_mm;
  return log;
}

}  // namespace

std::vector<Log> draw_campaign(const Campaign& campaign) {
  std::mt19937_64 random(campaign.seed * 1299709 + 41);
  const std::size_t first = variation::first_kind(campaign.variation, campaign.seed, std::size(kinds));
  std::vector<Drawn> runs;
  for (std::size_t i = 0; i < campaign.runs; ++i) {
    const variation::Run run = variation::draw_run(campaign.variation, campaign.seed, i);
    const double rate_hz = run.rate_hz > 0 ? run.rate_hz : campaign.rate_hz;
    runs.push_back({run, rate_hz, kinds[(first + i) % std::size(kinds)](random, rate_hz)});
  }
  std::vector<Log> logs;
  double start_s = 0;
  const double phase = std::uniform_real_distribution<double>(0, 2 * pi)(random);
  for (const Drawn& drawn : runs) {
    logs.push_back(surrounded(drawn, start_s, phase, campaign.span_mm));
    start_s += static_cast<double>(logs.back().command_kpa.size()) / drawn.rate_hz;
  }
  return logs;
}

}  // namespace textbook
