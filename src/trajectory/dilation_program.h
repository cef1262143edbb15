#ifndef SCREWLINE_SRC_TRAJECTORY_DILATION_PROGRAM_H
#define SCREWLINE_SRC_TRAJECTORY_DILATION_PROGRAM_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "dilation.h"
#include "pentadiagonal.h"

namespace screwline {

/// -top <= c . (b0, b1, b2) <= top for neighbouring control points, with its two multipliers. One of acceleration has
/// the top 1, one of jerk r^(-1/2).
struct DilationRow {
  double c[3];
  double above = 1.0;
  double below = 1.0;
};

/// top and its derivative by the two control points whose mean is r.
struct DilationTop {
  double value = 1.0;
  double slope = 0.0;
  std::size_t first = 0;  ///< Of the two points, in 0, 1, 2.
};

inline double valueOf(const DilationRow& row, const double* b) {
  return row.c[0] * b[0] + row.c[1] * b[1] + row.c[2] * b[2];
}

/// The interior point method's state.
class DilationProgram {
 public:
  explicit DilationProgram(const Dilation& problem);
  DilationResult solve();

 private:
  static constexpr std::size_t kKinds = 3;  ///< Acceleration at the node; jerk at the start and at the end of the cell.
  struct Node {
    double ceiling = 1.0;
    double multiplier = 1.0;
    bool bounded = false;
    bool free = true;
  };

  DilationRow& row(std::size_t node, std::size_t kind, std::size_t joint) {
    return rows_[(node * kKinds + kind) * joints_ + joint];
  }
  const double* at(std::size_t node) const { return points_.data() + node; }
  /// Rows are left out where nothing is free, and jerk beyond the last node.
  bool holds(std::size_t node, std::size_t kind) const {
    return kind == 0 ? nodes_[node].free : node < cells_ && (kind == 1 ? nodes_[node].free : nodes_[node + 1].free);
  }
  DilationTop topOf(const double* b, std::size_t kind) const;
  void fillRows(const Dilation& problem);
  void placeStart();
  void startMultipliers(double complementarity);
  double complementarity();
  void assemble(double target);
  void tieEnds();
  void addRows(std::size_t node, std::size_t kind, double target);
  void takeStep(double target);
  std::array<double, 2> stepLengths(double target);
  template <typename Visit>
  void eachRow(const Visit& visit);
  /// visit(slack, by, multiplier): each bound's slack, and by how much the step changes it.
  template <typename Visit>
  void eachSlack(const Visit& visit);
  double duration() const;

  std::size_t joints_, cells_;
  double step_;
  /// A given r at an end: the point that has to reach it, and the node that is then out of our hands.
  struct End {
    std::size_t point;
    std::size_t node;
    std::optional<double> wanted;
    bool met = false;
  };
  bool isReaching() const {
    return std::any_of(ends_.begin(), ends_.end(), [](const End& end) { return end.wanted && !end.met; });
  }
  void addReach();
  double untilMet(double along) const;
  void meetEnds();

  std::array<End, 2> ends_{};
  std::vector<double> points_, change_;
  std::vector<bool> fixed_;
  std::vector<Node> nodes_;
  std::vector<DilationRow> rows_;
  Pentadiagonal matrix_;
};

template <typename Visit>
void DilationProgram::eachRow(const Visit& visit) {
  for (std::size_t i = 0; i <= cells_; ++i) {
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      if (!holds(i, kind)) continue;
      for (std::size_t j = 0; j < joints_; ++j) visit(i, kind, row(i, kind, j));
    }
  }
}

template <typename Visit>
void DilationProgram::eachSlack(const Visit& visit) {
  for (std::size_t i = 0; i <= cells_; ++i) {
    Node& node = nodes_[i];
    const double* db = change_.data() + i;
    if (!node.bounded || !node.free) continue;
    visit(1.0 - 0.5 * (at(i)[0] + at(i)[1]) / node.ceiling, -0.5 * (db[0] + db[1]) / node.ceiling, node.multiplier);
  }
  eachRow([&](std::size_t i, std::size_t kind, DilationRow& each) {
    const double* db = change_.data() + i;
    const DilationTop top = topOf(at(i), kind);
    const double value = valueOf(each, at(i));
    const double by = valueOf(each, db);
    const double by_top = top.slope * (db[top.first] + db[top.first + 1]);
    visit(top.value - value, by_top - by, each.above);
    visit(top.value + value, by_top + by, each.below);
  });
}

}  // namespace screwline

#endif  // SCREWLINE_SRC_TRAJECTORY_DILATION_PROGRAM_H
