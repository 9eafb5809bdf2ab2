#pragma once
// Reads single values of LabVIEW TDMS files: numbers and time stamps.

#include <cstddef>
#include <cstdint>

namespace softgrip::sysid {

/// Types of the values in a TDMS file.
enum class TdmsType : std::uint32_t {
  i8 = 1,
  i16,
  i32,
  i64,
  u8,
  u16,
  u32,
  u64,
  f32,
  f64,
  f32_unit = 0x19,
  f64_unit = 0x1a,
  string = 0x20,
  boolean = 0x21,
  time = 0x44
};

/// Returns the size of one value of this type [bytes]; 0 for a text or an unknown type.
[[nodiscard]] std::size_t size_of(TdmsType type);

/// A time stamp: whole seconds since 1904 and the fraction of a second. A single double has too few digits
/// for the sum.
struct TdmsStamp {
  std::int64_t seconds = 0;
  double fraction = 0;
};

/// Reads a time stamp of 16 bytes.
[[nodiscard]] TdmsStamp tdms_stamp_at(const char* at);

/// Returns the time from one time stamp to another [s].
[[nodiscard]] double seconds_between(const TdmsStamp& from, const TdmsStamp& to);

/// Reads a value as a number. The type must not be a time stamp.
[[nodiscard]] double number_at(TdmsType type, const char* at);

}  // namespace softgrip::sysid
