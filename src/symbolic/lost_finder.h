#ifndef SCREWLINE_SRC_SYMBOLIC_LOST_FINDER_H
#define SCREWLINE_SRC_SYMBOLIC_LOST_FINDER_H

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "exact_conditions.h"
#include "wrench_writer.h"

namespace screwline {

/// What is lost where conditions hold together.
struct HeldConditions {
  std::vector<ExactCondition> conditions;
  std::vector<VectorX> points;  ///< Configurations where all of them hold and the rank is `rank`.
  int rank = 0;
};

/// Finds lost directions as formulas. A lost direction is a wrench that does no work on the columns of the completed
/// Jacobian; how many entries it has depends on the point and the axes in which it is written. So: numbers tell where
/// it has fewest (and which of the Jacobian's entries vanish where the conditions hold), and there it is the minors of
/// as many columns as it takes.
class LossFinder {
 public:
  /// Keeps references.
  LossFinder(const ExactChain& exact, const SerialChain& chain, const Task& task);

  /// rows - rank directions, each compared with the numeric Jacobian; none where no short formulas are found.
  /// @throws DerivationStopped
  std::vector<LostDirection> find(const HeldConditions& held, double& deviation);

 private:
  using Entries = std::vector<TrigPolynomial>;
  using Columns = std::function<TrigMatrix(int axes, int point)>;

  /// Rows of a frame in which a lost direction can be written.
  struct Place {
    int point = 0;
    int axes = 0;
    std::vector<int> rows;
    Vector6 at_first = Vector6::Zero();  ///< The direction at the first configuration, in the base at the tip.
    bool mixed = false;                  ///< Has rows of both f and n.
    std::size_t cost() const { return rows.size() + (mixed ? 1 : 0); }
  };

  /// Of one configuration: the frames, and the lost directions as columns in the base at the tip.
  struct Sample {
    std::vector<Pose> frames;
    MatrixX lost;
  };

  std::vector<LostDirection> directionsOf(const Columns& columns, const std::vector<Place>& places, int lost);
  std::optional<LostDirection> ofWristAtRest();
  bool sample(const Columns& columns, int reference, int lost);
  std::vector<int> referencePoints() const;
  std::vector<Place> placesOf(const std::vector<int>& references) const;
  void addPlaces(int point, int axes, std::vector<Place>& places) const;
  int preferredPoint(const std::vector<Place>& places, const Place& place) const;
  std::vector<ExactWrench> formulasAt(const Columns& columns, const Place& place) const;
  std::vector<std::vector<int>> columnChoices(const TrigMatrix& rows, const std::vector<MatrixX>& values) const;
  Entries minorsOf(const TrigMatrix& rows, const std::vector<int>& columns) const;

  const ExactChain& exact_;
  const SerialChain& chain_;
  const Task& task_;
  std::vector<TrigPose> frames_;  ///< In the base, by number.
  std::map<std::pair<int, int>, TrigMatrix> completed_;
  WrenchWriter writer_;
  const HeldConditions* held_ = nullptr;
  std::vector<Sample> samples_;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_LOST_FINDER_H
