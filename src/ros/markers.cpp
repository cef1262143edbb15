#include "screwline/ros/markers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "screwline/kinematics/jacobian.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/spatial/svd.h"

namespace screwline {
namespace ros_bridge {
namespace {

using visualization_msgs::Marker;

struct Color {
  float r, g, b, a;
};
constexpr Color kRevoluteColor{0.16F, 0.40F, 0.86F, 0.9F};
constexpr Color kPrismaticColor{0.10F, 0.60F, 0.35F, 0.9F};
constexpr Color kEllipsoidColor{0.95F, 0.75F, 0.10F, 0.35F};
constexpr Color kLostLinearColor{0.86F, 0.10F, 0.12F, 1.0F};
constexpr Color kLostAngularColor{0.75F, 0.10F, 0.70F, 1.0F};
constexpr Color kPathColor{0.93F, 0.45F, 0.11F, 1.0F};

// Sizes as shares of the chain's characteristic length.
constexpr double kAxisHalfLength = 0.2;
constexpr double kRingRadius = 0.07;
constexpr double kLineWidth = 0.008;
constexpr double kThinnestEllipsoid = 0.004;
constexpr double kLostLength = 0.4;
constexpr int kRingSegments = 32;
constexpr int kLostSlots = 6;
constexpr double kSmallestPart = 0.05;  // Of a unit direction; below it an arrow tells nothing.
constexpr float kPalestLost = 0.3F;

Marker makeMarker(const char* space, int id, int type, const Color& color) {
  Marker marker;
  marker.ns = space;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.color.r = color.r;
  marker.color.g = color.g;
  marker.color.b = color.b;
  marker.color.a = color.a;
  return marker;
}

void setOrientation(const Quaternion& rotation, Marker& marker) {
  marker.pose.orientation.w = rotation.w();
  marker.pose.orientation.x = rotation.x();
  marker.pose.orientation.y = rotation.y();
  marker.pose.orientation.z = rotation.z();
}

Marker arrow(const char* space, int id, const Color& color, const Vector3& from, const Vector3& to, double width) {
  Marker marker = makeMarker(space, id, Marker::ARROW, color);
  marker.points = {toPoint(from), toPoint(to)};
  marker.scale.x = width;
  marker.scale.y = 2.5 * width;
  marker.scale.z = 4.0 * width;
  return marker;
}

/// A circle about `direction`.
Marker ring(int id, const Color& color, const Vector3& center, const Vector3& direction, double radius, double width) {
  Marker marker = makeMarker(kScrewAxesMarkers, id, Marker::LINE_STRIP, color);
  marker.pose.position = toPoint(center);
  setOrientation(Quaternion::FromTwoVectors(Vector3::UnitZ(), direction), marker);
  for (int i = 0; i <= kRingSegments; ++i) {
    const double angle = kTwoPi * (i % kRingSegments) / kRingSegments;
    marker.points.push_back(toPoint({radius * std::cos(angle), radius * std::sin(angle), 0.0}));
  }
  marker.scale.x = width;
  return marker;
}

/// Both arrows of a line that has no sense, or their removal where `half` is too short.
void addDoubleArrow(const char* space, int first_id, const Color& color, const Vector3& center, const Vector3& half,
                    double shortest, double width, std::vector<Marker>& markers) {
  for (const double sense : {1.0, -1.0}) {
    markers.push_back(arrow(space, first_id++, color, center, center + sense * half, width));
    if (half.norm() < shortest) {
      markers.back().action = Marker::DELETE;
      markers.back().points.clear();
    }
  }
}

}  // namespace

geometry_msgs::Point toPoint(const Vector3& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

std::vector<Marker> screwAxisMarkers(const SerialChain& chain, const ConstVectorRef& q) {
  const double length = chain.characteristicLength();
  const double width = kLineWidth * length;
  std::vector<Marker> markers;
  Link carrier;  // Parallel to the base at zero, carried by the axes before axis i.
  for (std::size_t i = 0; i < chain.axes().size(); ++i) {
    const Axis& axis = chain.axes()[i];
    carrier.axis_count = static_cast<int>(i);
    const Pose X_BC = linkPose(chain, carrier, q);
    const Vector3 point = X_BC * axis.point;
    const Vector3 half = X_BC.R * axis.direction * (kAxisHalfLength * length);
    const int id = 2 * carrier.axis_count;
    if (axis.prismatic) {
      addDoubleArrow(kScrewAxesMarkers, id, kPrismaticColor, point, half, 0.0, width, markers);
    } else {
      markers.push_back(arrow(kScrewAxesMarkers, id, kRevoluteColor, point - half, point + half, width));
      markers.push_back(ring(id + 1, kRevoluteColor, point, half.normalized(), kRingRadius * length, 0.7 * width));
    }
  }
  return markers;
}

Marker manipulabilityMarker(const Matrix6X& J, const Vector3& tool, double scale, double thinnest) {
  const MatrixX linear = J.topRows(3);
  const Svd svd(linear, Eigen::ComputeFullU);
  Matrix3 axes = svd.matrixU();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  Vector3 radii = Vector3::Zero();
  radii.head(svd.singularValues().size()) = scale * svd.singularValues();
  radii = radii.cwiseMax(thinnest);

  Marker marker = makeMarker(kManipulabilityMarkers, 0, Marker::SPHERE, kEllipsoidColor);
  marker.pose.position = toPoint(tool);
  setOrientation(Quaternion(axes).normalized(), marker);
  marker.scale.x = 2.0 * radii.x();
  marker.scale.y = 2.0 * radii.y();
  marker.scale.z = 2.0 * radii.z();
  return marker;
}

std::vector<Marker> lostDirectionMarkers(const Task& task, const Matrix6X& J, const Pose& tool, double near_singular,
                                         double length) {
  const Svd svd(taskJacobian(task, J, tool.R), Eigen::ComputeFullU);
  const VectorX& values = svd.singularValues();
  const double bound = std::max(near_singular * values[0], jacobianNoise(J));
  const double width = kLineWidth / kLostLength * length;
  std::vector<Marker> markers;
  for (int slot = 0; slot < kLostSlots; ++slot) {
    const Eigen::Index k = values.size() - 1 - slot;  // The smallest value has slot 0.
    const bool lost = k >= 0 && values[k] <= bound;
    const Vector6 twist = lost ? task.spread(svd.matrixU().col(k), tool.R) : Vector6::Zero();
    const float nearness = lost && bound > 0.0 ? 1.0F - static_cast<float>(values[k] / bound) : 1.0F;
    Color linear = kLostLinearColor;
    Color angular = kLostAngularColor;
    linear.a = angular.a = kPalestLost + (1.0F - kPalestLost) * nearness;
    const double shortest = kSmallestPart * length;
    addDoubleArrow(kLostDirectionMarkers, 4 * slot, linear, tool.p, length * twist.head<3>(), shortest, width, markers);
    addDoubleArrow(kLostDirectionMarkers, 4 * slot + 2, angular, tool.p, length * twist.tail<3>(), shortest, width,
                   markers);
  }
  return markers;
}

Marker toolPathMarker(const std::vector<geometry_msgs::Point>& points, double width) {
  Marker marker = makeMarker(kToolPathMarkers, 0, Marker::LINE_STRIP, kPathColor);
  marker.scale.x = width;
  if (points.size() < 2) {
    marker.action = Marker::DELETE;
  } else {
    marker.points = points;
  }
  return marker;
}

std::vector<Marker> configurationMarkers(const SerialChain& chain, const Task& task, const ConstVectorRef& q,
                                         const MarkerParams& params) {
  const double length = chain.characteristicLength();
  Matrix6X J;
  const Pose tool = geometricJacobian(chain, q, J);
  std::vector<Marker> markers = screwAxisMarkers(chain, q);
  markers.push_back(manipulabilityMarker(J, tool.p, params.ellipsoid_scale, kThinnestEllipsoid * length));
  const std::vector<Marker> lost = lostDirectionMarkers(task, J, tool, params.near_singular, kLostLength * length);
  markers.insert(markers.end(), lost.begin(), lost.end());
  return markers;
}

}  // namespace ros_bridge
}  // namespace screwline
