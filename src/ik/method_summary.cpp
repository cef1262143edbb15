#include "screwline/ik/method_summary.h"

#include <optional>
#include <utility>

#include "screwline/model/structure.h"

namespace screwline {

std::vector<std::string> summaryOf(const InverseKinematics& ik) {
  std::vector<std::string> lines = describeStructure(ik.chain(), structureOf(ik.chain()));
  lines.push_back("method: " + ik.method());
  lines.push_back(ik.complete() ? "it finds every solution" : "it does not prove that it finds every solution");
  for (const std::string& branch : ik.branches()) lines.push_back("branch: " + branch);
  return lines;
}

InverseSolver everySolution(const InverseKinematics& ik) {
  const std::optional<InverseOutline> outline = ik.outline();
  return [&ik, parameter = outline ? outline->given : -1](const Pose& target, const VectorX& given) {
    IkRequest request;
    if (parameter >= 0) request.redundancy = {given[parameter]};
    request.target = target;
    request.ignore_limits = true;
    request.find_closest = false;
    std::vector<VectorX> all;
    for (const IkAnswer& answer : ik.solve(request).solutions) all.push_back(answer.position);
    return all;
  };
}

InverseMethod inverseMethodOf(std::shared_ptr<const InverseKinematics> ik) {
  const InverseSolver solver = everySolution(*ik);
  return {summaryOf(*ik), ik->outline(),
          [ik = std::move(ik), solver](const Pose& target, const VectorX& given) { return solver(target, given); }};
}

}  // namespace screwline
