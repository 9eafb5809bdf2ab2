#include "drivers/modbus/exception_text.h"

#include <modbus/modbus.h>

namespace softgrip::drivers {

const char* text_of_exception(unsigned code) noexcept {
  // The texts of libmodbus are used only for known codes. For an unknown code, libmodbus would call
  // strerror(), which allocates memory.
  const bool known = code >= MODBUS_EXCEPTION_ILLEGAL_FUNCTION && code < MODBUS_EXCEPTION_MAX &&
                     code != MODBUS_EXCEPTION_NOT_DEFINED;
  return known ? ::modbus_strerror(MODBUS_ENOBASE + static_cast<int>(code)) : "not a standard exception";
}

}  // namespace softgrip::drivers
