#include "screwline/ik/method_summary.h"

#include "screwline/model/structure.h"

namespace screwline {

std::vector<std::string> summaryOf(const InverseKinematics& ik) {
  std::vector<std::string> lines = describeStructure(ik.chain(), structureOf(ik.chain()));
  lines.push_back("method: " + ik.method());
  lines.push_back(ik.complete() ? "it finds every solution" : "it does not prove that it finds every solution");
  for (const std::string& branch : ik.branches()) lines.push_back("branch: " + branch);
  return lines;
}

}  // namespace screwline
