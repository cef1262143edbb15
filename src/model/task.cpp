#include "screwline/model/task.h"

#include <algorithm>

#include "screwline/exception.h"

namespace screwline {
namespace {

const std::array<const char*, 9> kRowNames = {"x", "y", "z", "rx", "ry", "rz", "tx", "ty", "tz"};
const char* const kKnownRows = "; known rows are x, y, z, rx, ry, rz, tx, ty, tz";

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(AnswerCode::kInvalidGoal, message);
}

void requireNoToolAxes(const Task& task) {
  if (task.usesToolAxes()) throw Exception("internal error: rows about the tool's axes need the tool's orientation");
}

}  // namespace

Task::Task() : rows_{0, 1, 2, 3, 4, 5}, size_(6) {}

Task Task::fromRows(const std::vector<int>& rows) {
  Task task;
  task.rows_ = {};
  task.size_ = 0;
  for (int row : rows) task.rows_[static_cast<std::size_t>(task.size_++)] = row;
  return task;
}

Task Task::pointing(int axis) {
  std::vector<int> rows = {0, 1, 2};
  for (int other = 0; other < 3; ++other) {
    if (other != axis) rows.push_back(kFirstToolRow + other);
  }
  return fromRows(rows);
}

Task Task::parse(const std::vector<std::string>& names) {
  if (names.empty()) refuse(std::string("task has no row") + kKnownRows);
  std::vector<int> rows;
  for (const std::string& name : names) {
    const auto found = std::find(kRowNames.begin(), kRowNames.end(), name);
    if (found == kRowNames.end()) refuse("task row '" + name + "' is unknown" + kKnownRows);
    const int row = static_cast<int>(found - kRowNames.begin());
    if (std::find(rows.begin(), rows.end(), row) != rows.end()) refuse("task row '" + name + "' is given twice");
    const auto is_other = [row](int other) {
      return row >= 3 && other >= 3 && (row < kFirstToolRow) != (other < kFirstToolRow);
    };
    const auto other = std::find_if(rows.begin(), rows.end(), is_other);
    if (other != rows.end()) {
      refuse("task row '" + name + "' stands beside '" + kRowNames[static_cast<std::size_t>(*other)] +
             "'; rotation rows are along the base's axes (rx ry rz) or the tool's (tx ty tz), not both");
    }
    rows.push_back(row);
  }
  return fromRows(rows);
}

bool Task::contains(int row) const {
  return std::find(rows_.begin(), rows_.begin() + size_, row) != rows_.begin() + size_;
}

int Task::translationCount() const {
  return static_cast<int>(std::count_if(rows_.begin(), rows_.begin() + size_, [](int row) { return row < 3; }));
}

int Task::rotationCount() const {
  return size_ - translationCount();
}

std::vector<std::string> Task::names() const {
  std::vector<std::string> names;
  for (int i = 0; i < size_; ++i) names.emplace_back(kRowNames[static_cast<std::size_t>(row(i))]);
  return names;
}

bool Task::usesToolAxes() const {
  return std::any_of(rows_.begin(), rows_.begin() + size_, [](int row) { return row >= kFirstToolRow; });
}

int Task::pointingAxis() const {
  if (!usesToolAxes() || rotationCount() != 2) return -1;
  int axis = 0;
  while (contains(kFirstToolRow + axis)) ++axis;
  return axis;
}

MatrixX Task::select(const Matrix6X& J, const Matrix3& R) const {
  MatrixX selected(size_, J.cols());
  selectInto(J, R, selected);
  return selected;
}

VectorX Task::select(const Vector6& v, const Matrix3& R) const {
  VectorX selected(size_);
  for (int i = 0; i < size_; ++i)
    selected[i] = row(i) < kFirstToolRow ? v[row(i)] : R.col(row(i) - kFirstToolRow).dot(v.tail<3>());
  return selected;
}

Vector6 Task::spread(const VectorX& values, const Matrix3& R) const {
  Vector6 v = Vector6::Zero();
  for (int i = 0; i < size_; ++i) {
    if (row(i) < kFirstToolRow) {
      v[row(i)] = values[i];
    } else {
      v.tail<3>() += values[i] * R.col(row(i) - kFirstToolRow);
    }
  }
  return v;
}

MatrixX Task::select(const Matrix6X& J) const {
  requireNoToolAxes(*this);
  return select(J, Matrix3::Identity());
}

VectorX Task::select(const Vector6& v) const {
  requireNoToolAxes(*this);
  return select(v, Matrix3::Identity());
}

}  // namespace screwline
