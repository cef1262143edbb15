#include "singularity_names.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/golden_section.h"
#include "screwline/trajectory/branch_following.h"

namespace screwline {
namespace {

constexpr double kNear = 0.05;  ///< Closeness that is worth a word.
constexpr double kMet = 1e-6;
constexpr int kGoldenSteps = 50;

/// Least over greatest singular value of the task Jacobian, lengths in characteristic lengths.
class Closeness {
 public:
  Closeness(const SerialChain& chain, const Task& task, const PiecewisePolynomial& curve)
      : chain_(chain), task_(task), curve_(curve), J_(6, chain.size()), q_(chain.size()) {}

  const VectorX& configuration(double arc) {
    for (int i = 0; i < chain_.size(); ++i) q_[i] = curve_.valueAt(arc, i);
    return q_;
  }

  double operator()(double arc) {
    const Matrix3 R_BT = geometricJacobian(chain_, configuration(arc), J_).R;
    Matrix6X scaled = J_;
    scaled.topRows<3>() /= chain_.characteristicLength();
    for (int i = 0; i < chain_.size(); ++i) {
      if (!chain_.joint(i).isRevolute()) scaled.col(i) *= chain_.characteristicLength();
    }
    const VectorX values = singularValues(task_.select(scaled, R_BT));
    return values[values.size() - 1] / values[0];
  }

 private:
  const SerialChain& chain_;
  const Task& task_;
  const PiecewisePolynomial& curve_;
  Matrix6X J_;
  VectorX q_;
};

}  // namespace

std::string SingularityNames::nearest(const VectorX& q) const {
  const SingularityFactor* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SingularityFactor& factor : factors_) {
    if (!factor.isExplicit()) continue;
    const double value = std::abs(factor.value(q)) / factor.scale;
    if (value >= least) continue;
    least = value;
    best = &factor;
  }
  return best != nullptr ? best->name + " (" + best->expression + ")" : "rank";
}

std::vector<PassedSingularity> singularitiesAlong(const SerialChain& chain, const Task& task,
                                                  const PiecewisePolynomial& curve) {
  constexpr int kEach = 4;  // Places in a piece.
  std::vector<PassedSingularity> passed;
  if (curve.segments() == 0) return passed;
  Closeness closeness(chain, task, curve);
  std::vector<double> arcs;
  for (std::size_t k = 0; k < curve.segments(); ++k) {
    for (int i = 0; i < kEach; ++i) arcs.push_back(curve.breaks[k] + curve.length(k) * i / kEach);
  }
  arcs.push_back(curve.duration());
  std::vector<double> values;
  for (const double arc : arcs) values.push_back(closeness(arc));
  const SingularityNames names(chain, task);
  for (std::size_t k = 0; k < arcs.size();) {
    // Near means below the threshold somewhere around here: a quick dip may lie between two places.
    std::size_t end = k;
    while (end < arcs.size() && values[end] <= 2.0 * kNear) ++end;
    if (end == k) {
      ++k;
      continue;
    }
    const auto first = values.begin() + static_cast<long>(k);
    const std::size_t least =
        static_cast<std::size_t>(std::min_element(first, values.begin() + static_cast<long>(end)) - values.begin());
    PassedSingularity place;
    place.arc = goldenMinimum(closeness, arcs[least > 0 ? least - 1 : 0], arcs[std::min(least + 1, arcs.size() - 1)],
                              kGoldenSteps);
    place.closeness = closeness(place.arc);
    place.met = place.closeness < kMet;
    place.name = names.nearest(closeness.configuration(place.arc));
    place.u = place.until_u = curve.valueAt(place.arc, chain.size());
    std::size_t from = least;
    std::size_t to = least;
    while (from > k && values[from - 1] < kMet) --from;
    while (to + 1 < end && values[to + 1] < kMet) ++to;
    if (place.met && to > from) {
      place.u = curve.valueAt(arcs[from], chain.size());
      place.until_u = curve.valueAt(arcs[to], chain.size());
    }
    if (place.closeness <= kNear) passed.push_back(place);
    k = end;
  }
  return passed;
}

}  // namespace screwline
