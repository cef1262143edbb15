#ifndef SCREWLINE_MODEL_TASK_H
#define SCREWLINE_MODEL_TASK_H

#include <array>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

/// The rows of a twist that a question is about, of x y z rx ry rz in the base frame, in the caller's order.
class Task {
 public:
  /// All six rows.
  Task();

  /// @throws InputError (kInvalidGoal) where a name is unknown or repeated, or none is given.
  static Task parse(const std::vector<std::string>& names);

  /// @pre rows are distinct, each in 0..5, at least one.
  static Task fromRows(const std::vector<int>& rows);

  int size() const { return size_; }
  int row(int i) const { return rows_[static_cast<std::size_t>(i)]; }  ///< Index 0..5 of task row i in a 6-vector.
  bool contains(int row) const;
  int translationCount() const;  ///< How many of x y z.
  int rotationCount() const;     ///< How many of rx ry rz.
  std::vector<std::string> names() const;

  /// The task's rows of a 6xn matrix, in task order: size() x n. Allocates.
  MatrixX select(const Matrix6X& J) const;
  /// The same of a 6-vector.
  VectorX select(const Vector6& v) const;

  bool operator==(const Task& other) const { return size_ == other.size_ && rows_ == other.rows_; }

 private:
  std::array<int, 6> rows_{};
  int size_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_MODEL_TASK_H
