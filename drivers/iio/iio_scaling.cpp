#include "drivers/iio/iio_scaling.h"

#include <string_view>

#include "drivers/iio/iio_attribute.h"
#include "drivers/iio/iio_device.h"
#include "drivers/iio/iio_settings.h"

namespace softgrip::drivers {
namespace {

/// Returns the factor from the unit of the kernel to V, mA or kPa. The kernel gives voltages in mV, currents
/// in mA and pressures in kPa.
double per_unit(std::string_view channel) noexcept {
  return unit_of_channel(channel) == ElectricalUnit::volt ? 1e-3 : 1;
}

/// Returns the number in the attribute `what` of one channel. If this channel has no such attribute, returns
/// the number in the attribute `what` that all channels of this type share. If neither attribute exists,
/// returns `otherwise`.
double shared_number(const std::filesystem::path& folder, const std::string& direction,
                     const std::string& channel, const std::string& what, double otherwise) {
  for (const std::string& whose : {channel, type_of(channel)}) {
    IioAttribute attribute;
    if (attribute.open((folder / (direction + whose + what)).string(), false) != 0) continue;
    if (const auto value = attribute.read()) return *value;
  }
  return otherwise;
}

}  // namespace

IioScaling scaling_of(const std::filesystem::path& folder, const std::string& channel, bool output) {
  const std::string direction = output ? "out_" : "in_";
  const double scale = shared_number(folder, direction, channel, "_scale", 0);
  return {scale * per_unit(channel), shared_number(folder, direction, channel, "_offset", 0)};
}

IioScaling scaling_of_processed(const std::string& channel) noexcept {
  return {per_unit(channel), 0};
}

}  // namespace softgrip::drivers
