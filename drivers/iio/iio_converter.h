#pragma once
// One terminal of an industrial I/O board: the attributes of a converter's channel, and the scaling of its
// raw number.

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/iio/iio_device.h"
#include "drivers/iio/iio_settings.h"

namespace softgrip::drivers {

/// One wired terminal. The functions that return a text return "" on success, and the reason after a failure.
struct IioConverter {
  static constexpr const char* stays_off_text =
      "this attribute is still 1 after 0 was written, so the output remains switched off";

  std::string name;  ///< name of the converter in messages
  std::string path;  ///< path of the attribute that contains the raw number
  std::string identity;
  std::string first_identity;  ///< identity of the converter in the first complete session; "": no complete
                               ///< session yet, or the identity is not checked
  IioAttribute raw;            ///< closed: the terminal cannot be used in this session
  double scale = 1;            ///< factor from the raw number to V, mA or kPa
  double offset = 0;           ///< number that is added to the raw number
  std::string powerdown_path;
  IioAttribute powerdown;
  IioAttribute wake;  ///< powerdown attribute of the output, open for writing
  bool is_off = false;
  bool stays_off = false;  ///< true: an earlier attempt to switch on the output had no effect

  /// Finds the converter of a terminal among the converters `there` in the folder `root`, opens the attribute
  /// of its raw number, and reads the scaling. After a failure, `raw` may be open.
  [[nodiscard]] std::string attach(const std::vector<ComputerDevice>& there, const std::string& root,
                                   const IioTerminal& terminal, bool output);
  /// Reads if the output is switched off, and opens the attribute that switches it on. Fails if the process
  /// may not switch the output on, or if an earlier attempt to switch it on had no effect.
  [[nodiscard]] std::string look_at_powerdown(const std::string& channel);
  /// Switches the output on, and sets `is_off` and `stays_off`. Returns the errno of the write.
  int switch_on() noexcept;

 private:
  [[nodiscard]] std::string open_number(const std::filesystem::path& folder, const std::string& channel,
                                        bool output);
};

}  // namespace softgrip::drivers
