#include "sysid/import/mat_table.h"

#include <matio.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "sysid/import/array_table.h"

namespace softgrip::sysid {
namespace {

constexpr int deepest_structure = 4;

using MatFile = std::unique_ptr<mat_t, int (*)(mat_t*)>;
using MatVariable = std::unique_ptr<matvar_t, void (*)(matvar_t*)>;

template <class T>
std::vector<double> as_doubles(const matvar_t& variable, std::size_t count) {
  const auto* data = static_cast<const T*>(variable.data);
  return {data, data + count};
}

/// The values of a real array; empty of everything else.
std::vector<double> values_of(const matvar_t& variable, std::size_t count) {
  if (variable.data == nullptr || variable.isComplex != 0 || variable.data_size <= 0 ||
      variable.nbytes / static_cast<std::size_t>(variable.data_size) < count)
    return {};
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return as_doubles<double>(variable, count);
    case MAT_T_SINGLE:
      return as_doubles<float>(variable, count);
    case MAT_T_INT8:
      return as_doubles<std::int8_t>(variable, count);
    case MAT_T_UINT8:
      return as_doubles<std::uint8_t>(variable, count);
    case MAT_T_INT16:
      return as_doubles<std::int16_t>(variable, count);
    case MAT_T_UINT16:
      return as_doubles<std::uint16_t>(variable, count);
    case MAT_T_INT32:
      return as_doubles<std::int32_t>(variable, count);
    case MAT_T_UINT32:
      return as_doubles<std::uint32_t>(variable, count);
    case MAT_T_INT64:
      return as_doubles<std::int64_t>(variable, count);
    case MAT_T_UINT64:
      return as_doubles<std::uint64_t>(variable, count);
    default:
      return {};
  }
}

bool is_numeric(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
}

const char* what_it_is(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_CELL:
      return "a cell array";
    case MAT_C_STRUCT:
      return "an array of structures";
    case MAT_C_CHAR:
      return "a text";
    case MAT_C_SPARSE:
      return "a sparse matrix";
    case MAT_C_OBJECT:
    case MAT_C_FUNCTION:
    case MAT_C_OPAQUE:
      return "an object of MATLAB's (a timetable, a table?); save its columns as arrays";
    default:
      return variable.isComplex != 0 ? "complex numbers" : "no array of numbers in two dimensions";
  }
}

/// Reads the values of an array, and of the fields of a structure. Of all else, and of what is too large,
/// libmatio reads only the header: a compressed variable of some bytes can hold some gigabytes.
void collect(mat_t* file, matvar_t& variable, const std::string& name, int depth, ArrayCollector& arrays) {
  const bool flat = variable.rank == 2 && variable.dims != nullptr;
  const std::size_t rows = flat ? variable.dims[0] : 0;
  const std::size_t columns = flat ? variable.dims[1] : 0;
  if (variable.class_type == MAT_C_STRUCT && rows == 1 && columns == 1 && depth < deepest_structure) {
    char* const* fields = Mat_VarGetStructFieldnames(&variable);
    const unsigned count = Mat_VarGetNumberOfFields(&variable);
    for (unsigned i = 0; i < count && fields != nullptr; ++i) {
      matvar_t* field = Mat_VarGetStructFieldByName(&variable, fields[i], 0);
      if (field != nullptr) collect(file, *field, name + "." + fields[i], depth + 1, arrays);
    }
    return;
  }
  if (!is_numeric(variable) || !flat || variable.isComplex != 0)
    return arrays.pass_over(name, what_it_is(variable));
  if (rows == 0 || columns == 0) return;
  if (!arrays.has_room(rows, columns)) return arrays.pass_over(name, too_large);
  const bool read = Mat_VarReadDataAll(file, &variable) == 0;
  const std::vector<double> values = read ? values_of(variable, rows * columns) : std::vector<double>{};
  if (values.empty()) return arrays.pass_over(name, "it cannot be read");
  arrays.add(name, {}, rows, columns, values);
}

}  // namespace

std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                           document::Problems& problems) {
  // What it says of broken files goes into our own message. Its text is const on Debian 13 only.
  Mat_LogInitFunc("softgrip", [](int /*level*/, auto* /*message*/) {});
  const MatFile file{Mat_Open(opened.c_str(), MAT_ACC_RDONLY), Mat_Close};
  if (!file) {
    problems.add({path, {1, 1}, {}, "a MATLAB file that cannot be read: broken, or cut off", {}});
    return std::nullopt;
  }
  const mat_ft version = Mat_GetVersion(file.get());
  ArrayCollector arrays(path);
  while (true) {
    const MatVariable variable{Mat_VarReadNextInfo(file.get()), Mat_VarFree};
    if (!variable) break;
    if (variable->name == nullptr || variable->name[0] == '#') continue;  // what MATLAB refers to by itself
    collect(file.get(), *variable, variable->name, 0, arrays);
  }
  return arrays.table(version == MAT_FT_MAT4 ? "MATLAB 4" : "MATLAB 5", problems);
}

}  // namespace softgrip::sysid
