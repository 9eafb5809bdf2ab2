// The commands of a campaign and what surrounds them.
#include <algorithm>
#include <cmath>
#include <random>

#include "world.h"

namespace textbook {
namespace {

constexpr double pi = 3.14159265358979;
using Points = std::vector<std::pair<double, double>>;  // time, pressure

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

// Triangles of many amplitudes and rates, with minor loops on the larger ones.
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

// Sines on sines: rates from 0.05 to 0.6 Hz, never below zero.
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

}  // namespace

std::vector<Log> draw_campaign(std::uint64_t seed, bool poor, double rate_hz) {
  std::mt19937_64 random(seed * 1299709 + 41);
  std::vector<std::vector<double>> commands{triangles(random, rate_hz)};
  if (!poor) {
    commands.push_back(stairs(random, rate_hz));
    commands.push_back(sines(random, rate_hz));
  }
  std::vector<Log> logs;
  double start_s = 0;
  const double phase = std::uniform_real_distribution<double>(0, 2 * pi)(random);
  for (auto& command : commands) {
    Log log;
    log.rate_hz = rate_hz;
    for (std::size_t k = 0; k < command.size(); ++k) {
      const double t = start_s + static_cast<double>(k) / rate_hz;
      log.temperature_c.push_back(22 + 3 * std::sin(2 * pi * t / 140 + phase));
      log.supply_kpa.push_back(200 - 25 * std::abs(std::sin(pi * t / 23 + phase)));  // a compressor's cycle
    }
    start_s += static_cast<double>(command.size()) / rate_hz;
    log.command_kpa = std::move(command);
    logs.push_back(std::move(log));
  }
  return logs;
}

double duration_s(const std::vector<Log>& logs) {
  double sum = 0;
  for (const Log& log : logs) sum += static_cast<double>(log.command_kpa.size()) / log.rate_hz;
  return sum;
}

}  // namespace textbook
