#include "screwline/model/task.h"

#include <algorithm>

#include "screwline/exception.h"

namespace screwline {
namespace {

const std::array<const char*, 6> kRowNames = {"x", "y", "z", "rx", "ry", "rz"};

}  // namespace

Task::Task() : rows_{0, 1, 2, 3, 4, 5}, size_(6) {}

Task Task::fromRows(const std::vector<int>& rows) {
  Task task;
  task.rows_ = {};
  task.size_ = 0;
  for (int row : rows) task.rows_[static_cast<std::size_t>(task.size_++)] = row;
  return task;
}

Task Task::parse(const std::vector<std::string>& names) {
  if (names.empty()) throw InputError(AnswerCode::kInvalidGoal, "task has no row; known rows are x, y, z, rx, ry, rz");
  std::vector<int> rows;
  for (const std::string& name : names) {
    const auto found = std::find(kRowNames.begin(), kRowNames.end(), name);
    if (found == kRowNames.end()) {
      throw InputError(AnswerCode::kInvalidGoal,
                       "task row '" + name + "' is unknown; known rows are x, y, z, rx, ry, rz");
    }
    const int row = static_cast<int>(found - kRowNames.begin());
    if (std::find(rows.begin(), rows.end(), row) != rows.end()) {
      throw InputError(AnswerCode::kInvalidGoal, "task row '" + name + "' is given twice");
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

MatrixX Task::select(const Matrix6X& J) const {
  MatrixX selected(size_, J.cols());
  for (int i = 0; i < size_; ++i) selected.row(i) = J.row(row(i));
  return selected;
}

VectorX Task::select(const Vector6& v) const {
  VectorX selected(size_);
  for (int i = 0; i < size_; ++i) selected[i] = v[row(i)];
  return selected;
}

}  // namespace screwline
