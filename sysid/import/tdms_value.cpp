#include "sysid/import/tdms_value.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace softgrip::sysid {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the values are copied from the file without a conversion");

template <class T>
T copied(const char* at) {
  T value{};
  std::memcpy(&value, at, sizeof(T));
  return value;
}

}  // namespace

std::size_t size_of(TdmsType type) {
  switch (type) {
    case TdmsType::i8:
    case TdmsType::u8:
    case TdmsType::boolean:
      return 1;
    case TdmsType::i16:
    case TdmsType::u16:
      return 2;
    case TdmsType::i32:
    case TdmsType::u32:
    case TdmsType::f32:
    case TdmsType::f32_unit:
      return 4;
    case TdmsType::i64:
    case TdmsType::u64:
    case TdmsType::f64:
    case TdmsType::f64_unit:
      return 8;
    case TdmsType::time:
      return 16;
    default:
      return 0;
  }
}

TdmsStamp tdms_stamp_at(const char* at) {
  return {copied<std::int64_t>(at + 8), std::ldexp(static_cast<double>(copied<std::uint64_t>(at)), -64)};
}

double seconds_between(const TdmsStamp& from, const TdmsStamp& to) {
  // A damaged file can contain any number of seconds. The difference of two doubles cannot overflow, but the
  // difference of two integers can.
  return (static_cast<double>(to.seconds) - static_cast<double>(from.seconds)) +
         (to.fraction - from.fraction);
}

double number_at(TdmsType type, const char* at) {
  switch (type) {
    case TdmsType::i8:
      return copied<std::int8_t>(at);
    case TdmsType::i16:
      return copied<std::int16_t>(at);
    case TdmsType::i32:
      return copied<std::int32_t>(at);
    case TdmsType::i64:
      return static_cast<double>(copied<std::int64_t>(at));
    case TdmsType::u8:
      return copied<std::uint8_t>(at);
    case TdmsType::boolean:
      return copied<std::uint8_t>(at) != 0 ? 1 : 0;
    case TdmsType::u16:
      return copied<std::uint16_t>(at);
    case TdmsType::u32:
      return copied<std::uint32_t>(at);
    case TdmsType::u64:
      return static_cast<double>(copied<std::uint64_t>(at));
    case TdmsType::f32:
    case TdmsType::f32_unit:
      return static_cast<double>(copied<float>(at));
    default:
      return copied<double>(at);
  }
}

}  // namespace softgrip::sysid
