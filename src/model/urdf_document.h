#ifndef SCREWLINE_SRC_MODEL_URDF_DOCUMENT_H
#define SCREWLINE_SRC_MODEL_URDF_DOCUMENT_H

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "screwline/spatial/pose.h"

namespace screwline {

/// <mimic>: the joint's value is multiplier * value of `joint` + offset.
struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

/// A <joint> as it stands in the document; its numbers are finite, but not checked otherwise.
struct UrdfJoint {
  std::string name;
  std::string type;  ///< revolute, continuous, prismatic, fixed, floating or planar.
  std::string parent;
  std::string child;
  Pose origin;  ///< Of the child link in the parent link, at zero.
  Vector3 axis = Vector3::UnitX();
  bool has_range = false;  ///< lower or upper is given.
  double lower = 0.0;
  double upper = 0.0;
  double velocity = 0.0;  ///< 0: not given.
  std::optional<UrdfMimic> mimic;
};

/// A robot whose links form one tree.
struct UrdfDocument {
  std::string name;
  std::string root;
  std::vector<std::string> links;  ///< In the document's order.
  std::vector<UrdfJoint> joints;
  std::map<std::string, std::size_t> joint_above;                ///< By link: the joint that carries it.
  std::map<std::string, std::vector<std::size_t>> joints_below;  ///< By link: the joints that it carries.

  bool hasLink(const std::string& link) const { return joints_below.count(link) > 0; }
};

/// Reads a document by urdfdom, whose complaints go into the exception instead of to the console, after the checks that
/// urdfdom leaves out: well-formed XML, names given once, one tree. Missing velocity and effort limits, which urdfdom
/// refuses, are let pass. Numbers have a decimal point whatever the locale. Thread-safe.
/// @throws ModelError
UrdfDocument parseUrdf(const std::string& xml);

}  // namespace screwline

#endif  // SCREWLINE_SRC_MODEL_URDF_DOCUMENT_H
