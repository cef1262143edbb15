#include "ik_request_check.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "screwline/exception.h"
#include "screwline/ik/branch_name.h"

namespace screwline {
namespace {

constexpr double kRotationTolerance = 1e-6;  // Of R R^T from the identity.

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

void requireAtLeast(double value, double bound, bool strictly, const std::string& field) {
  if (std::isfinite(value) && value <= kMaxMagnitude && (strictly ? value > bound : value >= bound)) return;
  refuse(field + " is " + text(value) + ", it must be " + (strictly ? "above " : "at least ") + text(bound) +
         " and at most " + text(kMaxMagnitude));
}

void checkTarget(const SerialChain& chain, const Task& task, const Pose& target) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(target.p[i]) || std::abs(target.p[i]) > kMaxMagnitude) {
      refuse("pose.position." + std::string(1, "xyz"[i]) + " is " + text(target.p[i]) +
             ", it must be finite and at most " + text(kMaxMagnitude) + " in magnitude");
    }
  }
  if (task.rotationCount() == 0) return;
  const double error = (target.R * target.R.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kRotationTolerance) || target.R.determinant() < 0.0) refuse("pose.orientation is not a rotation");
  if (task.rotationCount() != 1) return;
  for (int row = 3; row < 6; ++row) {
    if (!task.contains(row)) continue;
    // A heading is counted from the tip's orientation at zero joint values: turned about the row's axis only.
    const Vector3 axis = Vector3::Unit(row - 3);
    const Vector3 image = target.R * (chain.home().R.transpose() * axis);
    const double off = std::atan2(axis.cross(image).norm(), axis.dot(image));
    if (off > kOffAxisTolerance) {
      refuse("pose.orientation is turned off the base's " + std::string(1, "xyz"[row - 3]) + " axis by " + text(off) +
             " rad; a task with that one rotation row allows " + text(kOffAxisTolerance));
    }
  }
}

void checkBranch(const std::string& branch, const std::vector<std::string>& known) {
  for (const std::string& part : branchPartsOf(branch)) {
    if (std::find(known.begin(), known.end(), part) != known.end()) continue;
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    refuse("branch '" + part + "' is unknown" +
           (names.empty() ? "; this chain's branches have no names" : "; known are " + names));
  }
}

}  // namespace

void checkRequest(const SerialChain& chain, const Task& task, const IkRequest& request,
                  const std::vector<std::string>& branches, int parameter_joint) {
  if (request.seed.size() > 0) requireConfiguration(chain, request.seed, "seed.position");
  checkTarget(chain, task, request.target);
  checkBranch(request.branch, branches);
  requireAtLeast(request.max_solutions, 0.0, false, "max_solutions");
  requireAtLeast(request.timeout, 0.0, true, "timeout");
  requireAtLeast(request.rotation_weight, 0.0, true, "rotation_weight");
  const std::size_t taken = parameter_joint >= 0 ? 1 : 0;
  if (!request.redundancy.empty() && request.redundancy.size() != taken) {
    refuse("redundancy has " + std::to_string(request.redundancy.size()) + " values; this chain's method takes " +
           (taken == 0
                ? "none (its degree of redundancy is " + std::to_string(std::max(0, chain.size() - task.size())) + ")"
                : "one, the value of joint '" + chain.joint(parameter_joint).name + "'"));
  }
  for (double value : request.redundancy) {
    if (!std::isfinite(value) || std::abs(value) > kMaxMagnitude)
      refuse("redundancy[0] is " + text(value) + ", it must be finite and at most " + text(kMaxMagnitude) +
             " in magnitude");
  }
}

}  // namespace screwline
