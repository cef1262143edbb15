#include "lost_finder.h"

#include <algorithm>
#include <cmath>

#include "choices.h"
#include "completed_jacobian.h"
#include "lost_check.h"

namespace screwline {
namespace {

constexpr std::size_t kMixed = 20;        ///< Characters that a direction of both f and n may be shorter and lose.
constexpr std::size_t kMostPlaces = 16;   ///< Where a direction is worked out.
constexpr std::size_t kMostReduced = 3;   ///< Directions that are brought to their shortest form.
constexpr std::size_t kLargestRows = 60;  ///< Terms of columns whose minors are worked out.
constexpr std::size_t kLargestMinor = 4 * kMostWrenchTerms;  ///< Terms of what a minor is made of.
constexpr std::size_t kMostChoices = 4;                      ///< Of columns, at each of them.
constexpr int kMostRows = 4;                                 ///< Of directions where there are several.
constexpr double kLost = 1e-7;                               ///< Of the largest singular value.
constexpr double kZero = 1e-7;                               ///< Of a direction's length.

bool isMixed(const std::vector<int>& rows) {
  return !rows.empty() && rows.front() < 3 && rows.back() >= 3;
}

/// Wrenches [f; n] moved by r, the old point seen from the new one, and turned.
MatrixX moved(const MatrixX& wrenches, const Vector3& r, const Matrix3& R) {
  MatrixX result = wrenches;
  for (Eigen::Index k = 0; k < wrenches.cols(); ++k) {
    const Vector3 f = wrenches.col(k).head<3>();
    result.col(k).head<3>() = R * f;
    result.col(k).tail<3>() = R * (wrenches.col(k).tail<3>() + r.cross(f));
  }
  return result;
}

std::vector<int> complementOf(const std::vector<int>& rows) {
  std::vector<int> others;
  for (int i = 0; i < 6; ++i) {
    if (std::find(rows.begin(), rows.end(), i) == rows.end()) others.push_back(i);
  }
  return others;
}

/// The one vector of the span that is zero in the rows, if there is just one.
std::optional<Vector6> vectorWithout(const MatrixX& span, const std::vector<int>& rows) {
  MatrixX some(span.cols(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) some.col(static_cast<Eigen::Index>(i)) = span.row(rows[i]).transpose();
  const MatrixX shares = leftNull(some, 0.0, kZero);
  if (shares.cols() != 1) return std::nullopt;
  return Vector6(span * shares);
}

/// Rows of the columns that are not zero at all of the configurations.
std::vector<int> supportOf(const std::vector<Vector6>& columns) {
  std::vector<int> rows;
  for (int i = 0; i < 6; ++i) {
    if (std::any_of(columns.begin(), columns.end(),
                    [i](const Vector6& column) { return std::abs(column[i]) > kZero * column.norm(); }))
      rows.push_back(i);
  }
  return rows;
}

}  // namespace

LossFinder::LossFinder(const ExactChain& exact, const SerialChain& chain, const Task& task)
    : exact_(exact), chain_(chain), task_(task), writer_(exact, chain) {
  for (int frame = 0; frame <= exact.size + 1; ++frame) frames_.push_back(exact.pose(0, frame));
}

std::vector<LostDirection> LossFinder::find(const HeldConditions& held, double& deviation) {
  held_ = &held;
  writer_.begin(held.conditions);
  const int tip = exact_.size + 1;
  const int lost = task_.size() - held.rank;
  const Columns columns = [this](int axes, int point) {
    auto known = completed_.find({axes, point});
    if (known == completed_.end())
      known = completed_.emplace(std::pair(axes, point), completedJacobian(exact_, task_, axes, point)).first;
    return known->second;
  };
  if (lost <= 0 || !sample(columns, tip, lost)) return {};
  std::vector<LostDirection> found;
  const std::vector<Place> places = placesOf(referencePoints());
  if (lost == 1 && !places.empty() && places.front().mixed) {
    if (const std::optional<LostDirection> at_rest = ofWristAtRest()) {
      found = {*at_rest};
      deviation = lossDeviation({exact_, chain_, task_, held.points}, found, lost);
      if (deviation <= kLossAgreement) return found;
      deviation = 0.0;
    }
    if (!sample(columns, tip, lost)) return {};
  }
  found = directionsOf(columns, places, lost);
  if (found.empty()) return {};
  deviation = lossDeviation({exact_, chain_, task_, held.points}, found, lost);
  if (deviation <= kLossAgreement) return found;
  deviation = 0.0;
  return {};
}

bool LossFinder::sample(const Columns& columns, int reference, int lost) {
  samples_.clear();
  const double length = chain_.characteristicLength();
  const TrigMatrix J = columns(0, reference);
  for (const VectorX& q : held_->points) {
    Sample here;
    for (const TrigPose& X : frames_) here.frames.push_back({valuesOf(exact_, X.R, q), valuesOf(exact_, X.p, q)});
    MatrixX scaled = valuesOf(exact_, J, q);
    scaled.bottomRows<3>() *= length;
    here.lost = leftNull(scaled, kLost);
    if (here.lost.cols() != lost) return false;
    here.lost.bottomRows<3>() *= length;
    const Vector3 from_tip = here.frames[static_cast<std::size_t>(reference)].p - here.frames.back().p;
    here.lost = moved(here.lost, from_tip, Matrix3::Identity());
    samples_.push_back(std::move(here));
  }
  return !samples_.empty();
}

void LossFinder::addPlaces(int point, int axes, std::vector<Place>& places) const {
  std::vector<MatrixX> spans;
  for (const Sample& here : samples_) {
    const Pose& at = here.frames[static_cast<std::size_t>(point)];
    const Matrix3& R = here.frames[static_cast<std::size_t>(axes)].R;
    spans.push_back(moved(here.lost, here.frames.back().p - at.p, R.transpose()));
    spans.back().bottomRows<3>() /= chain_.characteristicLength();
  }
  const Eigen::Index lost = spans.front().cols();
  std::vector<std::vector<int>> taken;
  for (int count = lost == 1 ? 6 : 1; count <= (lost == 1 ? 6 : kMostRows); ++count) {
    for (const std::vector<int>& rows : choicesOf(6, count)) {
      const bool contains_one = std::any_of(taken.begin(), taken.end(), [&rows](const std::vector<int>& known) {
        return std::includes(rows.begin(), rows.end(), known.begin(), known.end());
      });
      if (contains_one) continue;
      std::vector<Vector6> vectors;
      for (const MatrixX& span : spans) {
        const std::optional<Vector6> vector = vectorWithout(span, complementOf(rows));
        if (!vector) break;
        vectors.push_back(*vector);
      }
      if (vectors.size() != spans.size()) continue;
      const std::vector<int> support = supportOf(vectors);
      taken.push_back(support);
      Vector6 at_first = vectors.front();
      at_first.tail<3>() *= chain_.characteristicLength();
      const Sample& first = samples_.front();
      const Matrix3& R = first.frames[static_cast<std::size_t>(axes)].R;
      const Vector3 from_tip = first.frames[static_cast<std::size_t>(point)].p - first.frames.back().p;
      at_first = moved(moved(at_first, Vector3::Zero(), R), from_tip, Matrix3::Identity());
      at_first.tail<3>() /= chain_.characteristicLength();
      places.push_back({point, axes, support, at_first.normalized(), isMixed(support)});
    }
  }
}

/// The tip, then the frames' origins from the last on; of those that coincide the first frame's.
std::vector<int> LossFinder::referencePoints() const {
  std::vector<int> points = {exact_.size + 1};
  const auto coincide = [this](int a, int b) {
    return (frames_[static_cast<std::size_t>(a)].p - frames_[static_cast<std::size_t>(b)].p).termCount() == 0;
  };
  for (int point = exact_.size; point > 0; --point) {
    if (point > 1 && coincide(point, point - 1)) continue;
    points.push_back(point);
  }
  return points;
}

std::vector<LossFinder::Place> LossFinder::placesOf(const std::vector<int>& references) const {
  std::vector<Place> places;
  for (const int point : references) {
    for (int axes = 0; axes <= exact_.size + 1; ++axes) addPlaces(point, axes, places);
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.cost() < b.cost(); });
  return places;
}

std::vector<LostDirection> LossFinder::directionsOf(const Columns& columns, const std::vector<Place>& places,
                                                    int lost) {
  struct Found {
    std::size_t length;
    const Place* place;
    ExactWrench wrench;
  };
  std::vector<Found> given;
  std::size_t tried = 0;
  for (const Place& place : places) {
    const bool axis = std::any_of(given.begin(), given.end(), [&place](const Found& other) {
      return other.place->cost() == 1 && std::abs(other.place->at_first.dot(place.at_first)) > 1.0 - kZero;
    });
    if (axis) continue;
    if (++tried > kMostPlaces) break;
    for (ExactWrench& wrench : formulasAt(columns, place))
      given.push_back({termsOf(wrench.entries), &place, std::move(wrench)});
  }
  const auto by_length = [](const Found& a, const Found& b) { return a.length < b.length; };
  std::stable_sort(given.begin(), given.end(), by_length);
  std::vector<Found> found;
  for (Found& one : given) {
    if (found.size() == kMostReduced || one.length > kMostWrenchTerms) break;
    if (!isFactorable(one.wrench.entries)) continue;
    one.wrench = writer_.shortened(one.wrench);
    one.length = writer_.lengthOf(one.wrench) + (one.place->mixed ? kMixed : 0);
    if (one.length <= kLongestWrench + kMixed) found.push_back(std::move(one));
  }
  std::stable_sort(found.begin(), found.end(), by_length);
  std::vector<LostDirection> directions;
  MatrixX chosen(6, 0);
  for (const Found& one : found) {
    MatrixX with(6, chosen.cols() + 1);
    with << chosen, one.place->at_first;
    if (static_cast<int>(chosen.cols()) == lost || !hasFullRank(with)) continue;
    chosen = with;
    ExactWrench wrench = one.wrench;
    wrench.point = preferredPoint(places, *one.place);
    directions.push_back(writer_.written(wrench));
  }
  return static_cast<int>(directions.size()) == lost ? directions : std::vector<LostDirection>();
}

/// Of a force along a line, or a couple, the first of the points where it is the same.
int LossFinder::preferredPoint(const std::vector<Place>& places, const Place& place) const {
  if (place.mixed) return place.point;
  const auto first = std::find_if(places.begin(), places.end(), [&place](const Place& other) {
    return other.axes == place.axes && other.rows == place.rows &&
           std::abs(other.at_first.dot(place.at_first)) > 1.0 - kZero;
  });
  return first->point;
}

std::vector<ExactWrench> LossFinder::formulasAt(const Columns& columns, const Place& place) const {
  ExactWrench wrench{place.point, place.axes, Entries(6, TrigPolynomial(exact_.ring))};
  if (place.rows.size() == 1) {
    wrench.entries[static_cast<std::size_t>(place.rows.front())] = TrigPolynomial::number(exact_.ring, 1);
    return {wrench};
  }
  const TrigMatrix given = columns(place.axes, place.point).selected(place.rows);
  std::vector<MatrixX> values;
  for (const VectorX& q : held_->points) values.push_back(valuesOf(exact_, given, q));
  const TrigMatrix rows = withoutZeros(given, values);
  std::vector<ExactWrench> formulas;
  for (const std::vector<int>& choice : columnChoices(rows, values)) {
    const Entries minors = minorsOf(rows, choice);
    if (minors.empty()) continue;
    for (std::size_t i = 0; i < place.rows.size(); ++i)
      wrench.entries[static_cast<std::size_t>(place.rows[i])] = minors[i];
    formulas.push_back(wrench);
  }
  return formulas;
}

/// Columns that the rows' direction follows from, those with fewest terms.
std::vector<std::vector<int>> LossFinder::columnChoices(const TrigMatrix& rows,
                                                        const std::vector<MatrixX>& values) const {
  std::vector<int> every_row;
  for (int i = 0; i < rows.rows(); ++i) every_row.push_back(i);
  std::vector<int> nonzero;
  for (int j = 0; j < rows.columns(); ++j) {
    if (rows.column(j).termCount() > 0) nonzero.push_back(j);
  }
  std::vector<std::pair<std::size_t, std::vector<int>>> sized;
  const int count = rows.rows() - 1;
  if (static_cast<int>(nonzero.size()) < count) return {};
  for (const std::vector<int>& choice : choicesOf(static_cast<int>(nonzero.size()), count)) {
    std::vector<int> columns;
    for (const int k : choice) columns.push_back(nonzero[static_cast<std::size_t>(k)]);
    if (hasFullRank(selected(values.front(), every_row, columns)))
      sized.emplace_back(selected(rows, every_row, columns).termCount(), columns);
  }
  std::stable_sort(sized.begin(), sized.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::vector<int>> choices;
  for (const auto& [size, columns] : sized) {
    if (choices.size() == kMostChoices || size > kLargestRows) break;
    const bool everywhere = std::all_of(values.begin(), values.end(), [&, &columns = columns](const MatrixX& at) {
      return hasFullRank(selected(at, every_row, columns));
    });
    if (everywhere) choices.push_back(columns);
  }
  return choices;
}

/// What is across the columns, by their largest minors; empty where these are too long to be read.
LossFinder::Entries LossFinder::minorsOf(const TrigMatrix& rows, const std::vector<int>& columns) const {
  std::vector<int> every_row;
  for (int i = 0; i < rows.rows(); ++i) every_row.push_back(i);
  // In binary order of the rows kept: the minor without the last row comes first.
  std::optional<Entries> found = largestMinors(selected(rows, every_row, columns), kLargestMinor);
  if (!found) return {};
  Entries minors = std::move(*found);
  std::reverse(minors.begin(), minors.end());
  for (std::size_t i = 1; i < minors.size(); i += 2) minors[i] = -minors[i];
  return minors;
}

/// Of three axes that meet in a point: the turn that is lost while it is at rest.
std::optional<LostDirection> LossFinder::ofWristAtRest() {
  if (task_.size() != 6) return std::nullopt;
  for (int point = 1; point <= exact_.size; ++point) {
    const TrigMatrix v = exact_.jacobian(point, point).selected({0, 1, 2});
    std::vector<int> arm;
    std::vector<int> wrist;
    for (int joint = 0; joint < exact_.joints; ++joint)
      (v.column(joint).termCount() == 0 ? wrist : arm).push_back(joint);
    if (wrist.size() != 3 || arm.size() != 3) continue;
    if (!hasFullRank(selected(valuesOf(exact_, v, held_->points.front()), {0, 1, 2}, arm))) return std::nullopt;
    const Columns columns = [this, &wrist](int axes, int reference) {
      TrigMatrix turns(exact_.ring, 6, 6);
      turns.setBlock(3, 0, selected(exact_.jacobian(axes, reference), {3, 4, 5}, wrist));
      turns.setBlock(0, 3, TrigMatrix::identity(exact_.ring, 3));
      return turns;
    };
    if (!sample(columns, point, 1)) return std::nullopt;
    std::vector<LostDirection> directions = directionsOf(columns, placesOf({point}), 1);
    if (directions.size() != 1) return std::nullopt;
    directions.front().at_rest = true;
    return directions.front();
  }
  return std::nullopt;
}

}  // namespace screwline
