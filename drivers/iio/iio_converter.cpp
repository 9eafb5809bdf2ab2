#include "drivers/iio/iio_converter.h"

#include <cerrno>
#include <cmath>
#include <optional>

#include "base/text.h"

namespace softgrip::drivers {
namespace {

/// Returns the name and the bus address of the converter, which must not change while a rig runs. Returns an
/// empty text if the rig file selects the converter by its label or serial number, because these already
/// identify the converter.
std::string identity_behind(const std::string& word, const ComputerDevice& device) {
  const bool says_which = device.has("label", word) || device.has("serial number", word);
  return says_which ? std::string{} : identity_of(device);
}

}  // namespace

std::string IioConverter::attach(const std::vector<ComputerDevice>& there, const std::string& root,
                                 const IioTerminal& terminal, bool output) {
  raw.close();
  is_off = false;
  name = terminal.device + " " + terminal.channel;
  const auto device = only_device(there, terminal.device, "converter");
  if (!device) return device.error().message + ": " + device.error().hint + ", under " + root;
  identity = identity_behind(terminal.device, *device);
  if (!first_identity.empty() && identity != first_identity) {
    return name + ": it was " + first_identity + ", but now it is " + identity +
           ": restart softgripd if this change is intended";
  }
  return open_number(std::filesystem::path(root) / device->node, terminal.channel, output);
}

/// Opens the attribute that contains the raw number of a channel, and reads the scaling of this number.
std::string IioConverter::open_number(const std::filesystem::path& folder, const std::string& channel,
                                      bool output) {
  const std::string stem = (output ? "out_" : "in_") + channel;
  path = (folder / (stem + "_raw")).string();
  const int error = raw.open(path, output);
  // Some drivers have no raw number; their number is already in mV, mA or kPa.
  const bool processed =
      error == ENOENT && !output && raw.open((folder / (stem + "_input")).string(), false) == 0;
  if (error != 0 && !processed) return path + ": " + text_of_errno(error);
  const IioScaling scaling = processed ? scaling_of_processed(channel) : scaling_of(folder, channel, output);
  scale = scaling.scale;
  offset = scaling.offset;
  if (!(std::abs(scale) > 0) || !std::isfinite(scale) || !std::isfinite(offset)) {
    return name + ": the converter has no valid attribute `scale`, so its raw values cannot be converted";
  }
  return {};
}

std::string IioConverter::look_at_powerdown(const std::string& channel) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::string attribute = powerdown_of(folder, channel);
  if (attribute.empty()) return {};
  powerdown_path = (folder / attribute).string();
  const int error = powerdown.open(powerdown_path, false);
  const auto state = error == 0 ? powerdown.read() : std::nullopt;
  if (!state) return powerdown_path + ": " + (error != 0 ? text_of_errno(error) : "no number");
  is_off = *state != 0;
  stays_off = stays_off && is_off;
  if (stays_off) return powerdown_path + ": " + stays_off_text;
  const int denied = is_off ? wake.open(powerdown_path, true) : 0;
  if (denied == 0) return {};
  return powerdown_path + " is 1 and cannot be cleared: " + text_of_errno(denied);
}

int IioConverter::switch_on() noexcept {
  const int error = wake.write(0);
  const std::optional<double> state = powerdown.read();
  is_off = error != 0 || !state || *state != 0;
  stays_off = is_off;
  return error;
}

}  // namespace softgrip::drivers
