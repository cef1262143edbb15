#include "singularity_names.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "screwline/kinematics/singularity.h"
#include "screwline/trajectory/branch_following.h"

namespace screwline {
namespace {

constexpr double kNear = 0.05;  ///< Closeness that is worth a word.
constexpr double kMet = 1e-6;

/// Least over greatest singular value of the task Jacobian, lengths in characteristic lengths.
class Closeness {
 public:
  Closeness(const SerialChain& chain, const Task& task, const PiecewisePolynomial& curve)
      : chain_(chain), task_(task), curve_(curve), J_(6, chain.size()), q_(chain.size()) {}

  const VectorX& configuration(double arc) {
    std::size_t k = 0;
    while (k + 1 < curve_.segments() && arc >= curve_.breaks[k + 1]) ++k;
    const double x = (arc - curve_.breaks[k]) / curve_.length(k);
    for (int i = 0; i < chain_.size(); ++i) q_[i] = curve_.piece(k, i)(x);
    return q_;
  }

  double operator()(double arc) {
    geometricJacobian(chain_, configuration(arc), J_);
    Matrix6X scaled = J_;
    scaled.topRows<3>() /= chain_.characteristicLength();
    for (int i = 0; i < chain_.size(); ++i) {
      if (!chain_.joint(i).isRevolute()) scaled.col(i) *= chain_.characteristicLength();
    }
    const VectorX values = singularValues(task_.select(scaled));
    return values[values.size() - 1] / values[0];
  }

 private:
  const SerialChain& chain_;
  const Task& task_;
  const PiecewisePolynomial& curve_;
  Matrix6X J_;
  VectorX q_;
};

/// The least value in [from, to], where there is one minimum: golden section.
double minimum(Closeness& closeness, double from, double to) {
  constexpr double kGolden = 0.6180339887498949;
  double a = to - kGolden * (to - from);
  double b = from + kGolden * (to - from);
  double at_a = closeness(a);
  double at_b = closeness(b);
  for (int i = 0; i < 50; ++i) {
    if (at_a < at_b) {
      to = b;
      b = a;
      at_b = at_a;
      a = to - kGolden * (to - from);
      at_a = closeness(a);
    } else {
      from = a;
      a = b;
      at_a = at_b;
      b = from + kGolden * (to - from);
      at_b = closeness(b);
    }
  }
  return 0.5 * (from + to);
}

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

namespace {

double uAt(const PiecewisePolynomial& curve, double arc) {
  std::size_t k = 0;
  while (k + 1 < curve.segments() && arc >= curve.breaks[k + 1]) ++k;
  return curve.piece(k, curve.joints - 1)((arc - curve.breaks[k]) / curve.length(k));
}

}  // namespace

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
    place.arc = minimum(closeness, arcs[least > 0 ? least - 1 : 0], arcs[std::min(least + 1, arcs.size() - 1)]);
    place.closeness = closeness(place.arc);
    place.met = place.closeness < kMet;
    place.name = names.nearest(closeness.configuration(place.arc));
    place.u = place.until_u = uAt(curve, place.arc);
    std::size_t from = least;
    std::size_t to = least;
    while (from > k && values[from - 1] < kMet) --from;
    while (to + 1 < end && values[to + 1] < kMet) ++to;
    if (place.met && to > from) {
      place.u = uAt(curve, arcs[from]);
      place.until_u = uAt(curve, arcs[to]);
    }
    if (place.closeness <= kNear) passed.push_back(place);
    k = end;
  }
  return passed;
}

}  // namespace screwline
