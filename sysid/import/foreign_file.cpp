#include "sysid/import/table_readers.h"

#include <zlib.h>

#include <filesystem>

#include "base/files.h"
#include "base/sha256.h"
#include "sysid/import/mcap_table.h"
#include "sysid/import/moments.h"
#include "sysid/import/table.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t largest_file_bytes = std::size_t{1} << 30;
constexpr const char* too_long_hint = "split the file into several files";
constexpr std::string_view hdf5_signature{"\x89HDF\r\n\x1a\n"};

/// Returns true if the bytes are HDF5 data. HDF5 data begin at byte 0 or after a user block of 512, 1024, ...
/// bytes.
bool is_hdf5(std::string_view bytes) {
  if (bytes.starts_with(hdf5_signature)) return true;
  for (std::size_t at = 512; at < bytes.size(); at *= 2) {
    if (bytes.substr(at).starts_with(hdf5_signature)) return true;
  }
  return false;
}

/// Returns the name of a file format that the import recognises but cannot read; empty if the data have no
/// such format.
std::string_view known_but_unread(std::string_view bytes) {
  constexpr std::string_view encrypted{"E\0n\0c\0r\0y\0p\0t\0e\0d\0P\0a\0c\0k\0a\0g\0e", 31};
  if (bytes.starts_with("\xd0\xcf\x11\xe0"))
    return bytes.find(encrypted) == std::string_view::npos ? "an old spreadsheet (.xls)"
                                                           : "a workbook with a password";
  if (bytes.starts_with("PAR1")) return "a Parquet file";
  if (bytes.starts_with("BZh")) return "compressed with bzip2";
  if (bytes.starts_with("\xfd"
                        "7zXZ"))
    return "compressed with xz";
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return "compressed with zstd";
  return {};
}

/// Reads a text file: a LabVIEW measurement, or a table with any separator.
std::optional<ForeignTable> read_text(const std::string& path, std::string_view bytes,
                                      const TableOptions& options, document::Problems& problems) {
  return is_lvm(bytes) ? read_lvm(path, bytes, options, problems)
                       : parse_text_table(path, bytes, options, problems);
}

/// Reads a MATLAB file of version 4 or 5.
std::optional<ForeignTable> read_matlab(const std::string& path, const std::string& opened,
                                        std::string_view bytes, document::Problems& problems) {
  constexpr std::size_t most_parts = 100'000;
  const auto variables = mat_variables(path, bytes, most_parts, most_values * sizeof(double), problems);
  return variables ? read_mat_table(path, opened, *variables, problems) : std::nullopt;
}

/// Reads the file in the format that its first bytes indicate.
/// @param opened  path that leads to the file from which `bytes` were read, even if the file at `path` has
/// been replaced since.
std::optional<ForeignTable> read_bytes(const std::string& path, const std::string& opened,
                                       std::string_view bytes, const TableOptions& options,
                                       document::Problems& problems) {
  if (bytes.starts_with("MATLAB 5.0")) return read_matlab(path, opened, bytes, problems);
  if (is_hdf5(bytes)) return read_hdf5_table(path, opened, bytes.starts_with("MATLAB 7.3"), problems);
  if (is_matlab_4(bytes)) return read_matlab(path, opened, bytes, problems);
  if (bytes.starts_with(mcap_magic)) return read_mcap_table(path, bytes, options, problems);
  if (bytes.starts_with("TDSm")) return read_tdms_table(path, bytes, problems);
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06"))
    return read_xlsx_table(path, bytes, options, problems);
  if (const std::string_view known = known_but_unread(bytes); !known.empty()) {
    problems.add({path, {1, 1}, {}, "this is " + std::string(known), "export the data as CSV"});
    return std::nullopt;
  }
  return read_text(path, bytes, options, problems);
}

}  // namespace

tl::expected<std::string, std::string> gunzipped(std::string_view bytes, std::size_t bound) {
  z_stream stream{};
  constexpr int gzip_window = 15 + 16;
  if (inflateInit2(&stream, gzip_window) != Z_OK)
    return tl::unexpected(std::string("zlib cannot be initialised"));
  // zlib only reads these bytes, although its interface requires a pointer that is not const.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string text;
  std::string chunk(std::size_t{1} << 18, '\0');
  int state = Z_OK;
  while (state == Z_OK && text.size() <= bound) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = inflate(&stream, Z_NO_FLUSH);
    text.append(chunk, 0, chunk.size() - stream.avail_out);
    // A gzip file can contain several members; their texts are concatenated.
    if (state == Z_STREAM_END && stream.avail_in > 0) state = inflateReset(&stream);
  }
  inflateEnd(&stream);
  if (text.size() > bound)
    return tl::unexpected("after decompression, the gzip file has more than " + std::to_string(bound) +
                          " bytes");
  if (state == Z_BUF_ERROR) return tl::unexpected(std::string("the gzip file is cut off"));
  if (state != Z_STREAM_END) return tl::unexpected(std::string("the gzip file is damaged"));
  return text;
}

std::optional<ForeignTable> read_foreign_file(const std::string& given, const TableOptions& options,
                                              document::Problems& problems, bool& unreadable) {
  const auto log_file = log_file_of(given);
  if (!log_file) {
    unreadable = true;
    problems.add({given, {1, 1}, {}, log_file.error(), {}});
    return std::nullopt;
  }
  const std::string& path = *log_file;
  const auto file = open_regular(path);
  const auto bytes = file ? read_start(*file, largest_file_bytes + 1) : tl::unexpected(file.error());
  if (!bytes) {
    unreadable = true;
    problems.add({path, {1, 1}, {}, "cannot open " + path + ": " + bytes.error(), {}});
    return std::nullopt;
  }
  if (bytes->size() > largest_file_bytes) {
    problems.add(
        {path, {1, 1}, {}, "larger than " + std::to_string(largest_file_bytes) + " bytes", too_long_hint});
    return std::nullopt;
  }
  std::optional<ForeignTable> table;
  if (bytes->starts_with("\x1f\x8b")) {
    const auto text = gunzipped(*bytes, most_text_bytes);
    if (!text) {
      problems.add({path, {1, 1}, {}, text.error(), {}});
      return std::nullopt;
    }
    table = read_text(path, *text, options, problems);
    if (table) table->format = "gzip, " + table->format;
  } else {
    const std::string opened = "/proc/self/fd/" + std::to_string(file->descriptor.get());
    table = read_bytes(path, opened, *bytes, options, problems);
  }
  if (!table) return std::nullopt;
  combine_split_times(table->columns, table->notes);
  table->sha256 = sha256(*bytes);
  return table;
}

}  // namespace softgrip::sysid
