#include "pdf.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "screwline/exception.h"

namespace screwline {
namespace {

namespace fs = std::filesystem;

/// A fresh folder that goes when this does.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "screwline_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw Exception("no folder can be made in " + fs::temp_directory_path().string());
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string contentsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string firstError(const std::string& log) {
  const std::size_t begin = log.find("\n! ");
  if (begin == std::string::npos) return "pdflatex gave no error message";
  return log.substr(begin + 3, log.find('\n', begin + 3) - begin - 3);
}

}  // namespace

std::string pdfOf(const std::string& latex) {
  if (std::system("command -v pdflatex > /dev/null 2>&1") != 0)
    throw Exception("format pdf needs pdflatex, which is not installed (Debian and Ubuntu: texlive-latex-base)");
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "report.tex") << latex;
  const std::string command = "cd '" + folder.path().string() +
                              "' && pdflatex -interaction=nonstopmode -halt-on-error report.tex > /dev/null 2>&1";
  if (std::system(command.c_str()) != 0)
    throw Exception("pdflatex failed: " + firstError(contentsOf(folder.path() / "report.log")));
  return contentsOf(folder.path() / "report.pdf");
}

}  // namespace screwline
