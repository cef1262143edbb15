#include "screwline/ik/branch_name.h"

#include <algorithm>
#include <iterator>

namespace screwline {
namespace {

const char* const kNeutralWords[] = {"straight", "centred", "aligned", "between"};

std::string what(const std::string& part) {
  return part.substr(0, part.find(' '));
}
std::string which(const std::string& part) {
  return part.substr(part.find(' ') + 1);
}

bool isNeutral(const std::string& part) {
  return std::find(std::begin(kNeutralWords), std::end(kNeutralWords), which(part)) != std::end(kNeutralWords);
}

}  // namespace

std::vector<std::string> branchPartsOf(const std::string& branch) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin < branch.size()) {
    std::size_t end = branch.find(',', begin);
    if (end == std::string::npos) end = branch.size();
    const std::size_t first = branch.find_first_not_of(' ', begin);
    const std::size_t last = branch.find_last_not_of(' ', end - 1);
    if (first != std::string::npos && first < end) parts.push_back(branch.substr(first, last - first + 1));
    begin = end + 1;
  }
  return parts;
}

bool matchesBranch(const std::string& branch, const std::string& wish) {
  const std::vector<std::string> has = branchPartsOf(branch);
  for (const std::string& wished : branchPartsOf(wish)) {
    const bool met = std::any_of(has.begin(), has.end(), [&](const std::string& part) {
      return part == wished || (what(part) == what(wished) && isNeutral(part));
    });
    if (!met) return false;
  }
  return true;
}

}  // namespace screwline
