// Derives a robot's kinematics as formulas and prints them as a document. Needs no ROS master.

#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "pdf.h"
#include "screwline/exception.h"
#include "screwline/ik/method_summary.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/model/dh_reader.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/symbolic/cpp_header.h"
#include "screwline/symbolic/derivation.h"
#include "screwline/symbolic/drawing.h"

namespace {

constexpr int kUsageError = 2;

constexpr const char* kUsage =
    "usage: derive ROBOT.urdf|TABLE.yaml [--format text|markdown|latex|html|pdf|svg|cpp] [--drawing FILE.svg]\n"
    "              [--quantities drawing,fk,jacobian,propagation,determinant,singularities,statics,ik]\n"
    "              [--task x,y,z,rx,ry,rz] [--base LINK] [--tip LINK] [--share-lengths] [--keep-angles]\n"
    "Prints forward kinematics, Jacobian, propagation, the task determinant in factors, the singular conditions,\n"
    "statics and inverse kinematics as formulas, checked against numbers. Progress is told on standard error; Ctrl-C\n"
    "ends it.\n"
    "  TABLE.yaml       a modified Denavit-Hartenberg table as dh_to_urdf reads it; it has no links to choose\n"
    "  --format cpp     a C++17 header of the robot's own forward kinematics, Jacobian and inverse kinematics\n"
    "  --format pdf     needs pdflatex (texlive-latex-base); svg is the drawing of the frames alone\n"
    "  --drawing        where the drawing is written that a Markdown document refers to\n"
    "  --keep-angles    1.5708 is not taken as a right angle\n"
    "  --share-lengths  lengths of equal size become one symbol\n";

struct Arguments {
  std::string file;
  screwline::ChainChoice choice;
  std::vector<std::string> task;
  std::string format = "markdown";
  std::string drawing;  ///< The file to write it to; empty: none.
  screwline::DerivationOptions options;
};

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// False where the arguments are not as the usage says.
bool parse(const std::vector<std::string>& words, Arguments& arguments) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--keep-angles") {
      arguments.options.right_angles = 0.0;
      continue;
    }
    if (word == "--share-lengths") {
      arguments.options.symbolic.share_equal_lengths = true;
      continue;
    }
    if (word.rfind("--", 0) != 0) {
      if (!arguments.file.empty()) return false;
      arguments.file = word;
      continue;
    }
    if (i + 1 == words.size()) return false;
    const std::string& value = words[++i];
    if (word == "--format") {
      arguments.format = value;
      const bool is_document = value != "svg" && value != "cpp";
      if (is_document) arguments.options.format = screwline::documentFormatOf(value == "pdf" ? "latex" : value);
    } else if (word == "--drawing") {
      arguments.drawing = value;
      arguments.options.drawing_file = value.substr(value.find_last_of('/') + 1);
    } else if (word == "--quantities") {
      arguments.options.quantities = splitAtCommas(value);
    } else if (word == "--task") {
      arguments.task = splitAtCommas(value);
    } else if (word == "--base") {
      arguments.choice.base_link = value;
    } else if (word == "--tip") {
      arguments.choice.tip_link = value;
    } else {
      return false;
    }
  }
  return !arguments.file.empty();
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

screwline::SerialChain chainOf(const Arguments& arguments) {
  const bool table = endsWith(arguments.file, ".yaml") || endsWith(arguments.file, ".yml");
  if (!table) return screwline::readUrdfFile(arguments.file, arguments.choice);
  if (!arguments.choice.base_link.empty() || !arguments.choice.tip_link.empty())
    throw screwline::Exception("--base and --tip: '" + arguments.file + "' is a table, it has no links to choose");
  return screwline::readDhYamlFile(arguments.file);
}

std::string headerOf(const screwline::SerialChain& chain, const screwline::Task& task,
                     const screwline::DerivationOptions& options) {
  const screwline::InverseDerivation inverse = screwline::deriveInverse(
      chain, task, options.inverse(chain), options.check_configurations, options.symbolic, options.progress);
  if (!inverse.formulas) std::cerr << "derive: inverse kinematics: " << inverse.reason << std::endl;
  return screwline::cppHeaderOf(chain, inverse.formulas, options.symbolic, options.progress);
}

void derive(Arguments& arguments) {
  const screwline::SerialChain chain = chainOf(arguments);
  const screwline::Task task =
      arguments.task.empty() ? screwline::deriveTask(chain) : screwline::Task::parse(arguments.task);
  arguments.options.progress.report = [](const std::string& stage) { std::cerr << "derive: " << stage << std::endl; };
  if (arguments.format == "svg") {
    std::cout << screwline::svgOf(screwline::drawingOf(chain, screwline::SymbolicChain(chain))) << std::flush;
    return;
  }
  arguments.options.inverse = [&task](const screwline::SerialChain& described) {
    return screwline::inverseMethodOf(std::make_shared<const screwline::InverseKinematics>(described, task));
  };
  if (arguments.format == "cpp") {  // Of the chain as it is, rounded angles too.
    std::cout << headerOf(chain, task, arguments.options) << std::flush;
    return;
  }
  const screwline::Derivation derivation = screwline::deriveDocument(chain, task, arguments.options);
  if (!arguments.drawing.empty() && !(std::ofstream(arguments.drawing) << derivation.drawing << std::flush))
    throw screwline::Exception("--drawing: '" + arguments.drawing + "' cannot be written");
  std::cout << (arguments.format == "pdf" ? screwline::pdfOf(derivation.document) : derivation.document) << std::flush;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 1 && (words.front() == "-h" || words.front() == "--help")) {
    std::cout << kUsage;
    return 0;
  }
  try {
    Arguments arguments;
    if (!parse(words, arguments)) {
      std::cerr << kUsage;
      return kUsageError;
    }
    derive(arguments);
  } catch (const screwline::Exception& error) {
    std::cerr << "derive: " << error.what() << "\n";
    return 1;
  }
  if (!std::cout) {
    std::cerr << "derive: standard output cannot be written\n";
    return 1;
  }
  return 0;
}
