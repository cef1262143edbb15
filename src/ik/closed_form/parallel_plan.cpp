#include "screwline/ik/closed_form/parallel_plan.h"

#include <algorithm>
#include <cmath>

#include "screwline/ik/closed_form/roots.h"
#include "screwline/spatial/turn_batch.h"

namespace screwline {
namespace {

constexpr double kRounding = 4e-15;    // Of a length over the chain's.
constexpr double kNegligible = 1e-13;  // The same: terms below it are rounding.
constexpr double kTightError = 1e-9;   // [rad] of the pair: below it what is out of reach is so but for a little.
constexpr double kMostError = 1e-2;    // [rad] that is carried on: what is worse is left to other methods.
constexpr double kHardlyKnown = 0.5;   // [rad] of a turn of the pair; what it is in fact is a tenth of it or so.

/// Its loose turn is.
DirectionSolution movedBy(double way, const DirectionSolution& pair) {
  DirectionSolution moved = pair;
  Turn& loose = pair.first_loose ? moved.first : moved.second;
  loose = turnBy(way) * loose;
  moved.clamped = true;
  return moved;
}

}  // namespace

/// A pose on its way through the stages.
struct ParallelPlan::Question {
  Pose G;         ///< What the six turns have to do to the base frame.
  Vector3 image;  ///< Parallel axes' direction, seen from behind the last axis.
  const double* preferred;
};

/// A turn of the single joint.
struct ParallelPlan::Root {
  Turn turn;
  int sign = 0;        ///< Of the slope.
  bool free = false;   ///< Any turn does.
  double error = 0.0;  ///< [rad]
};

struct ParallelPlan::Roots {
  std::array<Root, 2> roots;
  int count = 0;
};

/// Solutions, and the turns of their six axes in order: the angles are taken at the end.
struct ParallelPlan::Answer {
  explicit Answer(ParallelSolutions& to) : solutions(to) {}
  ParallelSolutions& solutions;
  TurnBatch turns;
};

double ParallelPlan::preferredAngle(const Question& question, int axis) const {
  return sense_[static_cast<std::size_t>(axis)] * question.preferred[jointOf(axis)];
}

ParallelPlan::Question ParallelPlan::questionOf(const Pose& target, const double* preferred) const {
  Question question{target * home_inverse_, Vector3::Zero(), preferred};
  if (reversed_) question.G = question.G.inverse();
  question.image = question.G.R.transpose() * direction_[static_cast<std::size_t>(first_parallel_)];
  return question;
}

/// The parallel axes leave the meeting point's height along them: u . R(q) v = height in the single joint's turn.
ParallelPlan::Roots ParallelPlan::singleRoots(const Question& question) const {
  const auto i = static_cast<std::size_t>(single_axis_);
  const Vector3& axis = direction_[i];
  const Vector3& point = point_[i];
  const Vector3& h = direction_[static_cast<std::size_t>(first_parallel_)];
  Vector3 u = h;
  Vector3 v = h;
  double height = 0.0;
  switch (single_) {
    case Single::kBeforeParallel:
      u = question.G * meeting_ - point;
      height = h.dot(meeting_ - point);
      break;
    case Single::kBetween:
      v = meeting_ - point;
      height = h.dot(question.G * meeting_ - point);
      break;
    case Single::kBehindPair:
      u = meeting_ - point;
      v = question.image;
      height = h.dot(meeting_ - question.G * point);
      break;
  }
  const double along = axis.dot(u) * axis.dot(v);
  const double a = u.dot(v) - along;
  const double b = axis.dot(v.cross(u));
  const double k = along - height;
  const double amplitude = std::sqrt(a * a + b * b);
  const double scale = std::max(length_, std::abs(height));
  Roots roots;
  Root root;
  if (amplitude <= kNegligible * scale && std::abs(k) <= kNegligible * scale) {
    root.free = true;
    root.turn = turnBy(preferredAngle(question, single_axis_));
    roots.roots[0] = root;
    roots.count = 1;
    return roots;
  }
  const double distance = squareRootOrNone((amplitude - k) * (amplitude + k), amplitude * std::max(amplitude, scale));
  if (distance < 0.0 || amplitude <= kNegligible * scale) return roots;
  const double least = std::sqrt(kDoubleRootTolerance * amplitude * std::max(amplitude, scale));
  root.error = kRounding * scale / std::max(distance, least);
  if (distance == 0.0) {
    root.turn = normalized({-k * a, -k * b});
    roots.roots[0] = root;
    roots.count = 1;
    return roots;
  }
  for (int sign : {1, -1}) {
    root.sign = sign;
    root.turn = normalized({-k * a + sign * b * distance, -k * b - sign * a * distance});
    roots.roots[static_cast<std::size_t>(roots.count++)] = root;
  }
  return roots;
}

/// The pair has to turn `start` to `goal`: the parallel axes' direction seen from both sides.
void ParallelPlan::directions(const Question& question, const Turn& single, Vector3& start, Vector3& goal) const {
  const Vector3& axis = direction_[static_cast<std::size_t>(single_axis_)];
  const Vector3& h = direction_[static_cast<std::size_t>(first_parallel_)];
  start = question.image;
  goal = h;
  switch (single_) {
    case Single::kBeforeParallel:
      start = question.G.R.transpose() * turned(axis, single, h);
      break;
    case Single::kBetween:
      goal = turned(axis, single.inverse(), h);
      break;
    case Single::kBehindPair:
      start = turned(axis, single, question.image);
      break;
  }
}

void ParallelPlan::solvePair(const Question& question, const Root& root, Answer& answer) const {
  ParallelSolutions& solutions = answer.solutions;
  Vector3 start;
  Vector3 goal;
  directions(question, root.turn, start, goal);
  DirectionSolutions pairs;
  pair_->solve(start, goal, std::min(root.error, kMostError), preferredAngle(question, pair_axis_),
               preferredAngle(question, pair_axis_ + 1), pairs);
  for (const DirectionSolution& pair : pairs) {
    if (root.free) solutions.open |= bitOf(single_axis_);
    if (pair.first_free) solutions.open |= bitOf(pair_axis_);
    if (pair.second_free) solutions.open |= bitOf(pair_axis_ + 1);
    const bool free = root.free || pair.first_free || pair.second_free;
    solutions.loose = solutions.loose || (!free && root.error + pair.tight_error > kMostError);
    solutions.indistinct = solutions.indistinct || (!free && pair.error > kHardlyKnown);
    if (free || pair.error <= kTightError) {
      solvePlane(question, root, pair, root.error + pair.error, answer);
    } else if (!solvePlane(question, root, pair, 0.0, answer)) {
      solveLoosely(question, root, pair, answer);
    }
  }
}

/// Near alignment one turn of the pair is hardly known: within its rounding it goes where the plane has a solution, as
/// far behind the end of the reach as that is away, where the elbow's two signs are apart. What it does not bring into
/// reach is out of reach, but for the errors of the other turns.
void ParallelPlan::solveLoosely(const Question& question, const Root& root, const DirectionSolution& pair,
                                Answer& answer) const {
  const double most = std::min(pair.error, 0.5 * kPi);  // What is farther is nearer to the other way to turn the pair.
  const double way = wayIntoReach(question, root, pair);
  if (solvePlane(question, root, movedBy(std::clamp(2.0 * way, -most, most), pair), 0.0, answer)) return;
  ParallelSolutions& solutions = answer.solutions;
  const int known = solutions.count;
  const double carried = root.error + pair.tight_error;
  solvePlane(question, root, movedBy(std::clamp(way, -most, most), pair), carried, answer);
  for (int k = known; k < solutions.count; ++k) solutions.unlikely |= std::abs(way) > most ? 1U << k : 0U;
}

/// By the squared distance of the third parallel axis from the first as a function of the loose turn: a + b cos + c
/// sin, with the same first two derivatives (exact where the turn's axis is parallel as well). To where it comes
/// nearest to the reach if it does not come into it.
double ParallelPlan::wayIntoReach(const Question& question, const Root& root, const DirectionSolution& pair) const {
  const auto placeAt = [&](double way) {
    const DirectionSolution moved = movedBy(way, pair);
    Turn place;
    Turn heading;
    placeOf(question, root.turn, moved.first, moved.second, place, heading);
    return Eigen::Vector2d(place.c, place.s);
  };
  const Eigen::Vector2d here = placeAt(0.0);
  const Eigen::Vector2d ahead = placeAt(0.5 * kPi);
  const Eigen::Vector2d behind = placeAt(-0.5 * kPi);
  const Eigen::Vector2d slope = 0.5 * (ahead - behind);
  const double first = here.dot(slope);
  const double second = slope.squaredNorm() - here.dot(here - 0.5 * (ahead + behind));
  const double distance = here.norm();
  const double goal = std::clamp(distance, plane_->least(), plane_->most());
  const double half = 0.5 * (goal - distance) * (goal + distance);
  if (half == 0.0) return 0.0;
  // first sin + second (1 - cos) = half
  const double radicand = first * first + (2.0 * second - half) * half;
  if (radicand < 0.0) return half > 0.0 ? std::atan2(first, -second) : std::atan2(-first, second);
  return 2.0 * std::atan(half / (first + std::copysign(std::sqrt(radicand), first)));
}

/// Where the other joints leave the third parallel axis from the first, and the heading behind it.
void ParallelPlan::placeOf(const Question& question, const Turn& single, const Turn& first, const Turn& second,
                           Turn& place, Turn& heading) const {
  const auto k = static_cast<std::size_t>(first_parallel_);
  Vector3 point = point_[k + 2];
  Vector3 side = x_;
  const auto undo = [&](int axis, const Turn& turn) {
    const auto i = static_cast<std::size_t>(axis);
    point = point_[i] + turned(direction_[i], turn.inverse(), point - point_[i]);
    side = turned(direction_[i], turn.inverse(), side);
  };
  if (single_ == Single::kBetween) undo(single_axis_, single);
  undo(pair_axis_, first);
  undo(pair_axis_ + 1, second);
  if (single_ == Single::kBehindPair) undo(single_axis_, single);
  point = question.G * point;
  side = question.G.R * side;
  if (single_ == Single::kBeforeParallel) undo(single_axis_, single);
  point -= point_[k];
  place = {point.dot(x_), point.dot(y_)};
  heading = normalized({side.dot(x_), side.dot(y_)});
}

/// @param carried [rad] error of the stages before. False where there is no solution.
bool ParallelPlan::solvePlane(const Question& question, const Root& root, const DirectionSolution& pair, double carried,
                              Answer& answer) const {
  ParallelSolutions& solutions = answer.solutions;
  const auto k = static_cast<std::size_t>(first_parallel_);
  Turn place;
  Turn heading;
  placeOf(question, root.turn, pair.first, pair.second, place, heading);
  const double error = std::min(carried, kMostError);
  PlanarSolutions planes;
  plane_->solve(place.c, place.s, heading, error * reach_, preferredAngle(question, first_parallel_), planes);
  for (const PlanarSolution& plane : planes) {
    if (plane.free) solutions.open |= bitOf(first_parallel_);
    PlanSolution solution;
    std::array<Turn, 6> turns;
    for (std::size_t i = 0; i < 3; ++i) turns[k + i] = plane.turns[i];
    turns[static_cast<std::size_t>(single_axis_)] = root.turn;
    turns[static_cast<std::size_t>(pair_axis_)] = pair.first;
    turns[static_cast<std::size_t>(pair_axis_) + 1] = pair.second;
    for (const Turn& turn : turns) answer.turns.add(turn);
    if (root.free) solution.free |= bitOf(single_axis_);
    if (pair.first_free) solution.free |= bitOf(pair_axis_);
    if (pair.second_free) solution.free |= bitOf(pair_axis_ + 1);
    if (plane.free) solution.free |= bitOf(first_parallel_);
    solution.sign = {root.sign, plane.sign, pair.sign};
    if (pair.clamped || plane.clamped) solutions.clamped |= 1U << solutions.count;
    solutions.solutions[static_cast<std::size_t>(solutions.count++)] = solution;
  }
  return planes.count > 0;
}

void ParallelPlan::takeAngles(const Question& question, Answer& answer) const {
  answer.turns.takeAngles();
  std::size_t place = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(answer.solutions.count); ++k) {
    PlanSolution& solution = answer.solutions.solutions[k];
    for (int axis = 0; axis < 6; ++axis, ++place) {
      const auto joint = static_cast<std::size_t>(jointOf(axis));
      const bool free = (solution.free & bitOf(axis)) != 0U;
      solution.q[joint] =
          free ? question.preferred[joint] : sense_[static_cast<std::size_t>(axis)] * answer.turns[place];
    }
  }
}

void ParallelPlan::solve(const Pose& target, const double* preferred, ParallelSolutions& solutions) const {
  solutions.count = 0;
  solutions.open = 0;
  solutions.clamped = 0;
  solutions.unlikely = 0;
  solutions.loose = false;
  solutions.indistinct = false;
  const Question question = questionOf(target, preferred);
  const Roots roots = singleRoots(question);
  Answer answer(solutions);
  for (int i = 0; i < roots.count; ++i) solvePair(question, roots.roots[static_cast<std::size_t>(i)], answer);
  takeAngles(question, answer);
}

/// The place runs on a circle, a + b e^(+-i angle), known from three of its points.
ParallelSheet ParallelPlan::sheetOf(const Question& question, const Root& root, const DirectionSolution& pair) const {
  std::array<Turn, 3> places;
  std::array<Turn, 3> headings;
  for (std::size_t k = 0; k < 3; ++k) {
    const Turn turn = turnBy(0.5 * kPi * static_cast<double>(k));
    placeOf(question, root.turn, pair.first_free ? turn : pair.first, pair.second_free ? turn : pair.second, places[k],
            headings[k]);
  }
  const int axis = pair.first_free ? pair_axis_ : pair_axis_ + 1;
  ParallelSheet::Circle circle;
  circle.heading = headings[0];
  circle.middle = {0.5 * (places[0].c + places[2].c), 0.5 * (places[0].s + places[2].s)};
  circle.radius = {places[0].c - circle.middle.c, places[0].s - circle.middle.s};
  const Turn quarter = headings[1] * headings[0].inverse();
  circle.sense = std::copysign(1.0, quarter.s * sense_[static_cast<std::size_t>(axis)]);
  PlanSolution fixed;
  fixed.free = bitOf(axis);
  fixed.sign = {root.sign, 0, pair.sign};
  const auto fix = [&](int place, const Turn& turn) {
    fixed.q[static_cast<std::size_t>(jointOf(place))] = sense_[static_cast<std::size_t>(place)] * turn.angle();
  };
  fix(single_axis_, root.turn);
  fix(pair_axis_, pair.first);
  fix(pair_axis_ + 1, pair.second);
  ParallelSheet::PlaneJoints joints;
  for (std::size_t i = 0; i < 3; ++i) {
    const int place = first_parallel_ + static_cast<int>(i);
    joints.joint[i] = static_cast<std::size_t>(jointOf(place));
    joints.sense[i] = sense_[static_cast<std::size_t>(place)];
  }
  return ParallelSheet(*plane_, length_, joints, circle, fixed);
}

std::vector<ParallelSheet> ParallelPlan::sheets(const Pose& target) const {
  std::vector<ParallelSheet> found;
  const std::array<double, 6> preferred{};
  const Question question = questionOf(target, preferred.data());
  const Roots roots = singleRoots(question);
  for (int i = 0; i < roots.count; ++i) {
    const Root& root = roots.roots[static_cast<std::size_t>(i)];
    if (root.free) continue;
    Vector3 start;
    Vector3 goal;
    directions(question, root.turn, start, goal);
    DirectionSolutions pairs;
    pair_->solve(start, goal, std::min(root.error, kMostError), 0.0, 0.0, pairs);
    for (const DirectionSolution& pair : pairs) {
      if (pair.first_free || pair.second_free) found.push_back(sheetOf(question, root, pair));
    }
  }
  return found;
}

std::array<int, 3> ParallelPlan::signsAt(const Pose& target, const double* q) const {
  const Question question = questionOf(target, q);
  const auto signOfValue = [](double value) { return (value > 0.0) - (value < 0.0); };
  std::array<int, 3> signs{};
  const Turn single = turnBy(preferredAngle(question, single_axis_));
  const Roots roots = singleRoots(question);
  double nearest = -2.0;
  for (int i = 0; i < roots.count; ++i) {
    const Root& root = roots.roots[static_cast<std::size_t>(i)];
    const double alike = (root.turn * single.inverse()).c;
    if (alike <= nearest) continue;
    nearest = alike;
    signs[0] = root.sign;
  }
  signs[1] = signOfValue(plane_->elbowSine(turnBy(preferredAngle(question, first_parallel_ + 1))));
  Vector3 start;
  Vector3 goal;
  directions(question, single, start, goal);
  const auto i = static_cast<std::size_t>(pair_axis_);
  const Vector3 between = turned(direction_[i], turnBy(preferredAngle(question, pair_axis_)).inverse(), goal);
  signs[2] = signOfValue(direction_[i].cross(direction_[i + 1]).dot(between));
  return signs;
}

bool ParallelPlan::isDouble(const PlanSolution& solution) const {
  return std::any_of(solution.sign.begin(), solution.sign.end(), [](int sign) { return sign == 0; });
}

std::string ParallelPlan::branchName(const PlanSolution& solution) const {
  std::string name;
  for (const BranchPart& part : parts_) {
    int sign = part.orientation;
    for (std::size_t i = 0; i < 3; ++i) {
      if (part.signs[i]) sign *= solution.sign[i];
    }
    name += (name.empty() ? "" : ", ") + (sign > 0 ? part.positive : sign < 0 ? part.negative : part.neutral);
  }
  return name;
}

}  // namespace screwline
