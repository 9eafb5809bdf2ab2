#include "tools/exporting/signals.h"

#include <matio.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "base/descriptor.h"
#include "base/files.h"

namespace softgrip::tools {
namespace {

using MatFile = std::unique_ptr<mat_t, int (*)(mat_t*)>;
using MatVariable = std::unique_ptr<matvar_t, void (*)(matvar_t*)>;

bool put(mat_t* file, const std::string& name, const std::vector<double>& values) {
  std::array<std::size_t, 2> size{values.size(), 1};
  // libmatio only reads the values, although its interface requires a pointer that is not const.
  const MatVariable variable{Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(),
                                           const_cast<double*>(values.data()), MAT_F_DONT_COPY_DATA),
                             Mat_VarFree};
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_ZLIB) == 0;
}

struct Column {
  std::string name;
  const std::vector<double>* values;
};

/// Returns the columns with names that MATLAB accepts. Columns of texts are omitted.
std::vector<Column> columns_of(const SignalGroup& group, std::vector<std::string>& left_out) {
  std::vector<Column> columns{{"time_s", &group.time_s}};
  std::set<std::string> used{"time_s"};
  for (const Signal& signal : group.signals) {
    if (signal.is_text()) {
      left_out.push_back(signal.name);
      continue;
    }
    const std::string plain = matlab_name(signal.name);
    std::string name = plain;
    for (int count = 2; !used.insert(name).second; ++count)
      name = matlab_name(plain.substr(0, 58) + "_" + std::to_string(count));
    columns.push_back({std::move(name), &signal.values});
  }
  return columns;
}

bool put_all(const std::string& path, const std::vector<Column>& columns) {
  // Use a fixed header, because the default header of libmatio contains the current time.
  const MatFile file{Mat_CreateVer(path.c_str(), "MATLAB 5.0 MAT-file, softgrip export", MAT_FT_MAT5),
                     Mat_Close};
  return file && std::all_of(columns.begin(), columns.end(), [&](const Column& column) {
           return put(file.get(), column.name, *column.values);
         });
}

/// Returns true if the file contains exactly these values in this order. This check is needed because
/// libmatio 1.5 does not check its writes.
bool holds(const std::string& path, const std::vector<Column>& columns) {
  const MatFile file{Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close};
  if (!file) return false;
  for (const Column& column : columns) {
    const MatVariable read{Mat_VarReadNext(file.get()), Mat_VarFree};
    const std::size_t bytes = column.values->size() * sizeof(double);
    if (!read || column.name != read->name || read->data_type != MAT_T_DOUBLE || read->nbytes != bytes ||
        (bytes > 0 && std::memcmp(read->data, column.values->data(), bytes) != 0))
      return false;
  }
  return MatVariable{Mat_VarReadNext(file.get()), Mat_VarFree} == nullptr;
}

}  // namespace

std::string matlab_name(const std::string& name) {
  constexpr std::size_t longest = 63;
  std::string valid;
  for (const char c : name) valid += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (valid.empty() || std::isalpha(static_cast<unsigned char>(valid.front())) == 0) valid.insert(0, "x_");
  return valid.substr(0, longest);
}

tl::expected<MatBytes, std::string> mat_bytes(const SignalGroup& group) {
  MatBytes mat;
  const std::vector<Column> columns = columns_of(group, mat.left_out);
  // libmatio can write only to a path and does not detect a failed write. Therefore this function lets
  // libmatio write to a file in memory, and then checks this file.
  const Descriptor memory(::memfd_create("softgrip-export", MFD_CLOEXEC));
  const std::string path = "/proc/self/fd/" + std::to_string(memory.get());
  constexpr std::size_t unbounded = std::numeric_limits<std::size_t>::max() - 1;
  if (memory && put_all(path, columns) && holds(path, columns))
    mat.bytes = read_file(path, unbounded).value_or("");
  if (mat.bytes.empty()) return tl::unexpected(std::string("libmatio cannot make the .mat file in memory"));
  return mat;
}

}  // namespace softgrip::tools
