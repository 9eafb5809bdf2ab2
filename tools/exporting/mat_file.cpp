#include "tools/exporting/mat_file.h"

#include <matio.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <set>

namespace softgrip::tools {
namespace {

using MatVariable = std::unique_ptr<matvar_t, void (*)(matvar_t*)>;

bool put(mat_t* file, const std::string& name, const std::vector<double>& values) {
  std::array<std::size_t, 2> size{values.size(), 1};
  // libmatio reads through a pointer that is not const.
  const MatVariable variable{Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(),
                                           const_cast<double*>(values.data()), MAT_F_DONT_COPY_DATA),
                             Mat_VarFree};
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_ZLIB) == 0;
}

bool put_all(const std::string& path, const SignalGroup& group, std::vector<std::string>& left_out) {
  // Its own header would hold the time of day.
  mat_t* const file = Mat_CreateVer(path.c_str(), "MATLAB 5.0 MAT-file, softgrip export", MAT_FT_MAT5);
  if (file == nullptr) return false;
  bool good = put(file, "time_s", group.time_s);
  std::set<std::string> used{"time_s"};
  for (const Signal& signal : group.signals) {
    if (!signal.texts.empty()) {
      left_out.push_back(signal.name);
      continue;
    }
    std::string name = matlab_name(signal.name);
    while (!used.insert(name).second) name = matlab_name(name.substr(0, 60) + "_2");
    good = good && put(file, name, signal.values);
  }
  return Mat_Close(file) == 0 && good;
}

}  // namespace

std::string matlab_name(const std::string& name) {
  constexpr std::size_t longest = 63;
  std::string valid;
  for (const char c : name) valid += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (valid.empty() || std::isalpha(static_cast<unsigned char>(valid.front())) == 0) valid.insert(0, "x_");
  return valid.substr(0, longest);
}

tl::expected<std::vector<std::string>, std::string> write_mat(const std::string& path,
                                                              const SignalGroup& group) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::path(path).has_parent_path()) fs::create_directories(fs::path(path).parent_path(), error);
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  std::vector<std::string> left_out;
  if (put_all(temporary, group, left_out)) {
    fs::rename(temporary, path, error);
    if (!error) return left_out;
  }
  std::error_code ignored;
  fs::remove(temporary, ignored);
  return tl::unexpected("cannot write " + path + (error ? ": " + error.message() : std::string()));
}

}  // namespace softgrip::tools
