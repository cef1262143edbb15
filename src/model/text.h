#ifndef SCREWLINE_SRC_MODEL_TEXT_H
#define SCREWLINE_SRC_MODEL_TEXT_H

#include <filesystem>
#include <fstream>
#include <iterator>
#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace screwline {

inline std::string inQuotes(const std::string& text) {
  return "'" + text + "'";
}

/// A number for a message or, with 17 digits, for a file that is read back: a decimal point whatever the locale.
inline std::string numberText(double value, int digits = 12) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << value;
  return out.str();
}

/// The finite number that is all of `text`, or none; a decimal point whatever the locale.
inline std::optional<double> numberOf(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0.0;
  in >> std::noskipws >> value;
  if (in.fail() || in.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
  return value;
}

/// All of a file, or none where it cannot be read.
inline std::optional<std::string> textOfFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  if (!file || std::filesystem::is_directory(path, error)) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_MODEL_TEXT_H
