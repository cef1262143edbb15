#include "screwline/kinematics/task_selection.h"

#include <algorithm>
#include <tuple>

#include "sampling.h"
#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"

namespace screwline {
namespace {

constexpr int kSamples = 15;
constexpr double kRegular = 1e-6;  ///< Smallest over largest singular value of a regular sample.

std::vector<int> rowsOf(unsigned mask) {
  std::vector<int> rows;
  for (int row = 0; row < 6; ++row) {
    if ((mask >> row) & 1U) rows.push_back(row);
  }
  return rows;
}

/// Order in which sets of the same size are tried, smallest first: the whole position, the whole orientation, two
/// positions with the heading in their plane, then more positions, then x y z rz ry rx.
using Preference = std::tuple<bool, bool, bool, int, std::vector<int>>;

Preference preferenceOf(const std::vector<int>& rows) {
  static constexpr int kOrder[6] = {0, 1, 2, 5, 4, 3};
  const auto has = [&rows](int row) { return std::find(rows.begin(), rows.end(), row) != rows.end(); };
  const auto all = [&has](int first, int second, int third) { return has(first) && has(second) && has(third); };
  const bool planar = rows.size() == 3 && (all(0, 1, 5) || all(0, 2, 4) || all(1, 2, 3));
  const int translations = static_cast<int>(has(0)) + static_cast<int>(has(1)) + static_cast<int>(has(2));
  std::vector<int> order;
  for (int row : rows) order.push_back(kOrder[row]);
  std::sort(order.begin(), order.end());
  return {!all(0, 1, 2), !all(3, 4, 5), !planar, -translations, order};
}

std::vector<std::vector<int>> candidates(int size) {
  std::vector<std::vector<int>> sets;
  for (unsigned mask = 1; mask < 64; ++mask) {
    const std::vector<int> rows = rowsOf(mask);
    if (static_cast<int>(rows.size()) == size) sets.push_back(rows);
  }
  std::sort(sets.begin(), sets.end(),
            [](const std::vector<int>& a, const std::vector<int>& b) { return preferenceOf(a) < preferenceOf(b); });
  return sets;
}

bool isRegular(const MatrixX& J_task) {
  const VectorX sigma = singularValues(J_task);
  return sigma.size() == J_task.rows() && sigma[sigma.size() - 1] > kRegular * sigma[0];
}

struct Sample {
  Matrix6X J;
  Matrix3 R_BT;
};

bool isMostlyRegular(const std::vector<Sample>& samples, const Task& task) {
  const auto regular = std::count_if(samples.begin(), samples.end(), [&task](const Sample& sample) {
    const MatrixX J_task = taskJacobian(task, sample.J, sample.R_BT);
    return J_task.norm() > kRegular * sample.J.norm() && isRegular(J_task);
  });
  return 2 * regular > static_cast<std::ptrdiff_t>(samples.size());
}

}  // namespace

Task deriveTask(const SerialChain& chain) {
  if (chain.size() >= 6) return Task();
  std::vector<Sample> samples(kSamples);
  for (int k = 0; k < kSamples; ++k) {
    Sample& sample = samples[static_cast<std::size_t>(k)];
    sample.R_BT = geometricJacobian(chain, sampleConfiguration(chain, k), sample.J).R;
  }
  // Two of rx ry rz are no orientation: five joints have the direction of an axis of the tool, z rather than others.
  for (int axis : {2, 0, 1}) {
    const Task task = Task::pointing(axis);
    if (chain.size() == 5 && isMostlyRegular(samples, task)) return task;
  }
  for (int size = chain.size(); size > 1; --size) {
    for (const std::vector<int>& rows : candidates(size)) {
      const Task task = Task::fromRows(rows);
      if (isMostlyRegular(samples, task)) return task;
    }
  }
  // Some row always moves: a chain has at least one joint.
  for (const std::vector<int>& rows : candidates(1)) {
    if (isMostlyRegular(samples, Task::fromRows(rows))) return Task::fromRows(rows);
  }
  return Task();
}

}  // namespace screwline
