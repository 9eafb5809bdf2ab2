#include "sysid/import/table_readers.h"

#include <matio.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {
namespace {

constexpr int deepest_structure = 8;
constexpr const char* unread_array = "this array cannot be read";

using MatFile = std::unique_ptr<mat_t, int (*)(mat_t*)>;
using MatVariable = std::unique_ptr<matvar_t, void (*)(matvar_t*)>;

template <class T>
std::vector<double> as_doubles(const matvar_t& variable, std::size_t count) {
  const auto* data = static_cast<const T*>(variable.data);
  return {data, data + count};
}

/// Returns the values of an array of real numbers; empty for any other variable.
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
      return "an empty cell array, or a cell array with too many levels";
    case MAT_C_STRUCT:
      return "an empty array of structures, or an array with too many levels";
    case MAT_C_CHAR:
      return "a text";
    case MAT_C_SPARSE:
      return "a sparse matrix";
    case MAT_C_OBJECT:
    case MAT_C_FUNCTION:
    case MAT_C_OPAQUE:
      return "a MATLAB object (such as a timetable or a table); save the columns of the object as arrays";
    default:
      return variable.isComplex != 0 ? "complex numbers" : "not an array of numbers in two dimensions";
  }
}

constexpr std::size_t longest_text = 200;

/// Numbers of rows and columns of a two-dimensional array. Both are 0 for other arrays.
struct Shape {
  std::size_t rows = 0;
  std::size_t columns = 0;

  [[nodiscard]] std::size_t count() const { return rows * columns; }
};
Shape shape_of(const matvar_t& variable) {
  const bool flat = variable.rank == 2 && variable.dims != nullptr;
  return flat ? Shape{variable.dims[0], variable.dims[1]} : Shape{};
}

/// Returns the text that a variable contains, in ASCII characters; empty if the variable is not a text of one
/// row with at most `longest_text` characters.
std::string text_of(mat_t* file, matvar_t* variable) {
  if (variable == nullptr || variable->class_type != MAT_C_CHAR) return {};
  const Shape shape = shape_of(*variable);
  if (shape.rows != 1 || shape.columns > longest_text || Mat_VarReadDataAll(file, variable) != 0) return {};
  if (variable->data == nullptr || variable->data_size <= 0) return {};
  std::string text;
  const auto* bytes = static_cast<const char*>(variable->data);
  for (std::size_t i = 0; i < variable->nbytes; i += static_cast<std::size_t>(variable->data_size))
    text += bytes[i];
  return text;
}

/// Collects the arrays that the variables, structures and cells of a file contain.
class MatCollector {
 public:
  MatCollector(mat_t* file, ArrayCollector& arrays) : file_(file), arrays_(arrays) {}

  /// Adds the values of an array. For a structure, an array of structures or a cell, adds the arrays that it
  /// contains. libmatio reads only the header of any other variable and of an array that is too large,
  /// because a compressed variable of a few bytes can expand to gigabytes.
  void collect(matvar_t& variable, const std::string& name, const std::string& unit, int depth) {
    const Shape shape = shape_of(variable);
    const bool nests =
        (variable.class_type == MAT_C_STRUCT || variable.class_type == MAT_C_CELL) && shape.count() > 0;
    if (nests && depth < deepest_structure) {
      for (std::size_t i = 0; i < shape.count(); ++i) element(variable, name, i, shape.count(), depth);
      return;
    }
    if (!is_numeric(variable) || shape.rows * shape.columns == 0) {
      if (!is_numeric(variable) || variable.rank != 2) arrays_.skip(name, what_it_is(variable));
      return;
    }
    if (variable.isComplex != 0) return arrays_.skip(name, what_it_is(variable));
    if (!arrays_.has_room(shape.rows, shape.columns)) return arrays_.skip(name, too_large);
    const bool read = Mat_VarReadDataAll(file_, &variable) == 0;
    const std::vector<double> values = read ? values_of(variable, shape.count()) : std::vector<double>{};
    if (values.empty()) return arrays_.skip(name, unread_array);
    arrays_.add(name, unit, shape.rows, shape.columns, values);
  }

 private:
  void element(matvar_t& variable, const std::string& name, std::size_t index, std::size_t count, int depth) {
    const std::string number = std::to_string(index + 1);
    if (variable.class_type == MAT_C_CELL) {
      matvar_t* cell = Mat_VarGetCell(&variable, static_cast<int>(index));
      const std::string here = name + "{" + number + "}";
      return cell == nullptr ? arrays_.skip(here, unread_array) : collect(*cell, here, {}, depth + 1);
    }
    const std::string here = count == 1 ? name : name + "(" + number + ")";
    const NamedSignal signal = named_signal(variable, index);
    if (signal.data != nullptr)
      arrays_.note("'" + document::shown(here) + "' is the column '" + document::shown(signal.name) + "'");
    char* const* fields = Mat_VarGetStructFieldnames(&variable);
    const unsigned fields_count = Mat_VarGetNumberOfFields(&variable);
    for (unsigned i = 0; i < fields_count && fields != nullptr; ++i) {
      matvar_t* field = Mat_VarGetStructFieldByName(&variable, fields[i], index);
      const std::string inside = here + "." + fields[i];
      if (field == nullptr) {
        arrays_.skip(inside, unread_array);
      } else if (field == signal.data) {
        collect(*field, signal.name, signal.unit, depth + 1);
      } else if (!signal.describes(field)) {
        collect(*field, inside, {}, depth + 1);
      }
    }
  }

  /// The fields of a structure that contains a signal and its name.
  struct NamedSignal {
    matvar_t* data = nullptr;  ///< values of the signal; null: the structure is no named signal
    const matvar_t* name_field = nullptr;
    const matvar_t* unit_field =
        nullptr;  ///< field with the unit; null: the structure has no text with a unit
    std::string name;
    std::string unit;

    /// Returns true if the field contains the name or the unit of the signal.
    [[nodiscard]] bool describes(const matvar_t* field) const {
      return field == name_field || field == unit_field;
    }
  };

  /// Finds the signal of a structure. dSPACE writes such structures with the fields Name, Data and Unit, and
  /// Simulink with label and values.
  NamedSignal named_signal(matvar_t& variable, std::size_t index) {
    constexpr std::array<std::pair<const char*, const char*>, 2> kinds{
        {{"Name", "Data"}, {"label", "values"}}};
    for (const auto& [name_field, data_field] : kinds) {
      matvar_t* data = Mat_VarGetStructFieldByName(&variable, data_field, index);
      matvar_t* named = Mat_VarGetStructFieldByName(&variable, name_field, index);
      const std::string name = text_of(file_, named);
      if (data == nullptr || !is_numeric(*data) || name.empty()) continue;
      matvar_t* unit_field = Mat_VarGetStructFieldByName(&variable, "Unit", index);
      const std::string unit = text_of(file_, unit_field);
      return {data, named, unit.empty() ? nullptr : unit_field, name, unit == "-" ? std::string() : unit};
    }
    return {};
  }

  mat_t* file_;
  ArrayCollector& arrays_;
};

}  // namespace

std::optional<ForeignTable> read_mat_table(const std::string& path, const std::string& opened,
                                           std::size_t variables, document::Problems& problems) {
  // Prevents libmatio from printing errors, because this function reports them as problems. The parameter
  // `message` has the type `auto*`, because only the libmatio of Debian 13 declares it as const.
  Mat_LogInitFunc("softgrip", [](int /*level*/, auto* /*message*/) {});
  const MatFile file{Mat_Open(opened.c_str(), MAT_ACC_RDONLY), Mat_Close};
  if (!file) {
    problems.add({path, {1, 1}, {}, "this MATLAB file cannot be read: it is broken or cut off", {}});
    return std::nullopt;
  }
  const mat_ft version = Mat_GetVersion(file.get());
  ArrayCollector arrays(path);
  std::size_t read = 0;
  for (; read < variables; ++read) {
    const MatVariable variable{Mat_VarReadNextInfo(file.get()), Mat_VarFree};
    if (!variable) break;
    // Variables whose names begin with # are internal variables of MATLAB.
    if (variable->name == nullptr || variable->name[0] == '#') continue;
    MatCollector(file.get(), arrays).collect(*variable, variable->name, {}, 0);
  }
  if (const std::size_t rest = variables - read; rest > 0)
    arrays.note(std::to_string(rest) + (rest == 1 ? " variable" : " variables") +
                " at the end of the file cannot be read");
  return arrays.table(version == MAT_FT_MAT4 ? "MATLAB 4" : "MATLAB 5", problems);
}

}  // namespace softgrip::sysid
