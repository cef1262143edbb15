#ifndef SCREWLINE_MODEL_TASK_H
#define SCREWLINE_MODEL_TASK_H

#include <array>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

/// The rows of a twist that a question is about, in the caller's order: x y z of the tip's origin and rx ry rz along
/// the base frame's axes, tx ty tz about the tool's (the tip link's) own. Rows tx ty are the direction of the tool's z
/// axis: what they leave free is a turn about it. ty tz point the x axis, tx tz the y axis.
class Task {
 public:
  static constexpr int kFirstToolRow = 6;  ///< Rows 0..2: x y z, 3..5: rx ry rz, 6..8: tx ty tz.

  /// All six rows along the base's axes.
  Task();

  /// @throws InputError (kInvalidGoal) where a name is unknown or repeated, none is given, or rows of rx ry rz stand
  /// beside rows of tx ty tz.
  static Task parse(const std::vector<std::string>& names);

  /// @pre rows are distinct, at least one, each in 0..5 or 6..8, not both of 3..5 and of 6..8.
  static Task fromRows(const std::vector<int>& rows);

  /// The position and the direction of one of the tool's axes (0..2): x y z and the two others of tx ty tz.
  static Task pointing(int axis);

  int size() const { return size_; }
  int row(int i) const { return rows_[static_cast<std::size_t>(i)]; }  ///< 0..8.
  bool contains(int row) const;
  int translationCount() const;  ///< How many of x y z.
  int rotationCount() const;     ///< How many of the others.
  bool usesToolAxes() const;     ///< Any of tx ty tz.
  /// The tool's axis (0..2) whose direction two of tx ty tz are; -1 where there are not two of them.
  int pointingAxis() const;
  std::vector<std::string> names() const;

  /// The task's rows of a 6xn matrix of twists, in task order: size() x n. `R` turns tool coordinates into those of J,
  /// read only where usesToolAxes(). Allocates.
  MatrixX select(const Matrix6X& J, const Matrix3& R) const;
  /// The same without allocation, into `rows` of that size.
  template <typename Matrix>
  void selectInto(const Matrix6X& J, const Matrix3& R, Matrix& rows) const {
    for (int i = 0; i < size_; ++i) {
      if (row(i) < kFirstToolRow) {
        rows.row(i) = J.row(row(i));
      } else {
        rows.row(i).noalias() = R.col(row(i) - kFirstToolRow).transpose() * J.bottomRows<3>();
      }
    }
  }
  /// The same of a 6-vector.
  VectorX select(const Vector6& v, const Matrix3& R) const;
  /// @pre task row i turns. The axis that it turns about, in the frame that R turns tool coordinates into.
  Vector3 axisOf(int i, const Matrix3& R) const {
    return row(i) < kFirstToolRow ? Vector3(Vector3::Unit(row(i) - 3)) : Vector3(R.col(row(i) - kFirstToolRow));
  }
  /// The transpose: the twist (or wrench) whose components along the task's rows are `values`, zero across them.
  Vector6 spread(const VectorX& values, const Matrix3& R) const;

  /// Of a task without rows about the tool's axes. @throws Exception for others.
  MatrixX select(const Matrix6X& J) const;
  VectorX select(const Vector6& v) const;

  bool operator==(const Task& other) const { return size_ == other.size_ && rows_ == other.rows_; }

 private:
  std::array<int, 6> rows_{};
  int size_ = 0;
};

}  // namespace screwline

#endif  // SCREWLINE_MODEL_TASK_H
