#pragma once
// Finds isolated values in a column of a log: single values that differ from their neighbours by more than
// the noise or a motion permits.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

/// Smallest distance of an isolated value from the median of its four neighbours, in standard deviations of
/// the noise. For a correct value, the distance has a standard deviation of about 1.15. It exceeds the limit
/// in less than 2 of 10 million values.
inline constexpr double isolated_beyond = 6.0;
/// Smallest distance of an isolated value from the median of its neighbours, as a multiple of the spread of
/// the neighbours.
inline constexpr double isolated_alone = 4.0;
/// Largest distance between a value and its neighbours, in samples.
inline constexpr std::size_t isolated_reach = 3;

/// Median and spread of the neighbours of a value. The spread is the second largest distance from the median,
/// because the neighbour with the largest distance may itself be isolated.
struct Neighbourhood {
  double median = 0;
  double spread = 0;
  bool known = false;  ///< false: there are fewer than two neighbours on one of the sides
};

/// Returns the neighbourhood of the value at index i. Values that are not finite are left out.
[[nodiscard]] Neighbourhood neighbourhood(const std::vector<double>& values, std::size_t i);

struct IsolatedValue {
  std::size_t sample = 0;
  double distance = 0;  ///< value minus the median of its four neighbours
};

/// Returns the isolated values of a column in the order of the samples. Samples without a finite value are
/// skipped. A value that a fast motion may explain is not isolated.
/// @param noise  standard deviation of the noise of the values.
[[nodiscard]] std::vector<IsolatedValue> isolated_values(const std::vector<double>& column, double noise);

/// Lower limit of the noise of a column as a share of its span. It is used if the values contain almost no
/// noise.
inline constexpr double least_noise_share = 1e-3;

/// Returns the distance from the 5 % quantile to the 95 % quantile of the finite values; 0 if there are none.
/// Single wrong values do not change this distance.
[[nodiscard]] double usual_span(const std::vector<double>& column);

/// Returns a list of values with their times, such as "500 kPa at 20 s, 0 kPa at 21 s". The list contains at
/// most three values, and then the number of the other ones (" and 4 more").
/// @param samples  indices of the values in `column` and `time_s`.
[[nodiscard]] std::string listed(const std::vector<double>& column, const std::vector<double>& time_s,
                                 const std::vector<std::size_t>& samples, std::string_view unit);

}  // namespace softgrip::sysid
