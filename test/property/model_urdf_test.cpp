// Laws of the URDF reader and writer over random robots.

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "property/model_random.h"
#include "screwline/exception.h"
#include "screwline/kinematics/forward.h"
#include "screwline/model/dh_reader.h"
#include "screwline/model/urdf_reader.h"

namespace screwline {
namespace {

double difference(const Pose& a, const Pose& b) {
  return std::max((a.p - b.p).cwiseAbs().maxCoeff(), (a.R - b.R).cwiseAbs().maxCoeff());
}

TEST(UrdfLaw, WrittenChainsAreReadBack) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(1, 9), random.chance(0.5));
    const SerialChain again = readUrdf(toUrdf(chain), {"base", "tip"});
    ASSERT_EQ(again.jointNames().size(), chain.jointNames().size()) << "seed " << seed;
    for (int k = 0; k < 3; ++k) {
      const VectorX q = random.configuration(chain.size());
      EXPECT_LT(difference(forwardByExponentials(again, q), forwardByExponentials(chain, q)), 1e-12) << "seed " << seed;
      for (const Link& link : chain.links()) {
        const Link* same = again.findLink(link.name);
        ASSERT_NE(same, nullptr) << "seed " << seed << ", link " << link.name;
        EXPECT_EQ(same->axis_count, link.axis_count);
        EXPECT_LT(difference(linkPose(again, *same, q), linkPose(chain, link, q)), 1e-12)
            << "seed " << seed << ", link " << link.name;
      }
    }
  }
}

TEST(UrdfLaw, LimitsAreReadBack) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    RandomModel random(seed);
    const SerialChain chain = random.chain(random.integer(1, 9));
    const SerialChain again = readUrdf(toUrdf(chain), {"base", "tip"});
    for (int i = 0; i < chain.size(); ++i) {
      EXPECT_EQ(again.joint(i).name, chain.joint(i).name) << "seed " << seed;
      EXPECT_EQ(again.joint(i).type, chain.joint(i).type) << "seed " << seed;
      EXPECT_EQ(again.lower()[i], chain.lower()[i]) << "seed " << seed;
      EXPECT_EQ(again.upper()[i], chain.upper()[i]) << "seed " << seed;
      EXPECT_EQ(again.joint(i).limits.velocity, chain.joint(i).limits.velocity) << "seed " << seed;
    }
  }
}

/// A random URDF in text, together with its forward kinematics by the format's own definition: the second way.
class RandomUrdf {
 public:
  explicit RandomUrdf(unsigned seed) : random_(seed) {
    const int count = random_.integer(1, 12);
    body_ = "<link name=\"l0\"/>";
    for (int i = 0; i < count; ++i) addJoint(i);
    if (names_.empty()) addJoint(count, "revolute");
  }

  std::string text() const { return "<robot name=\"random\">" + body_ + "</robot>"; }
  const std::vector<std::string>& names() const { return names_; }
  RandomModel& random() { return random_; }

  Pose tip(const std::map<std::string, double>& q) const {
    Pose X;
    for (const Part& part : parts_) {
      X = X * part.origin;
      if (part.type == "fixed") continue;
      const double value = part.mimic.empty() ? q.at(part.name) : part.multiplier * q.at(part.mimic) + part.offset;
      const Vector3 u = part.axis.normalized();
      X = X * (part.type == "prismatic" ? Pose{Matrix3::Identity(), value * u}
                                        : Pose{Eigen::AngleAxisd(value, u).toRotationMatrix(), Vector3::Zero()});
    }
    return X;
  }

 private:
  struct Part {
    std::string name;
    std::string type;
    Pose origin;
    Vector3 axis = Vector3::UnitX();
    std::string mimic;
    double multiplier = 1.0;
    double offset = 0.0;
  };

  static std::string text(const Vector3& v) {
    std::ostringstream out;
    out.precision(17);
    out << v.x() << " " << v.y() << " " << v.z();
    return out.str();
  }

  void addJoint(int i, std::string type = "") {
    const char* const types[] = {"fixed", "revolute", "continuous", "prismatic"};
    if (type.empty()) type = types[random_.integer(0, 3)];
    Part part;
    part.name = "j" + std::to_string(i);
    part.type = type;
    const Vector3 rpy = random_.chance(0.3) ? Vector3(0.0, kPi / 2, 1.0) : Vector3(3.0 * random_.point());
    part.origin.p = random_.point();
    part.origin.R = (Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Vector3::UnitX()))
                        .toRotationMatrix();
    part.axis = random_.uniform(0.1, 9.0) * random_.direction();
    const std::string child = "l" + std::to_string(parts_.size() + 1);
    body_ += "<link name=\"" + child + "\"/><joint name=\"" + part.name + "\" type=\"" + type + "\"><parent link=\"l" +
             std::to_string(parts_.size()) + "\"/><child link=\"" + child + "\"/><origin xyz=\"" + text(part.origin.p) +
             "\" rpy=\"" + text(rpy) + "\"/><axis xyz=\"" + text(part.axis) +
             "\"/><limit lower=\"-99\" upper=\"99\" velocity=\"1\" effort=\"1\"/>";
    if (type != "fixed" && !names_.empty() && random_.chance(0.2)) {
      part.mimic = names_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(names_.size()) - 1))];
      part.multiplier = random_.integer(1, 3) * 0.5;
      part.offset = random_.integer(-2, 2) * 0.25;
      body_ += "<mimic joint=\"" + part.mimic + "\" multiplier=\"" + std::to_string(part.multiplier) + "\" offset=\"" +
               std::to_string(part.offset) + "\"/>";
    } else if (type != "fixed") {
      names_.push_back(part.name);
    }
    body_ += "</joint>";
    parts_.push_back(part);
  }

  RandomModel random_;
  std::string body_;
  std::vector<Part> parts_;
  std::vector<std::string> names_;
};

TEST(UrdfLaw, KinematicsAreThoseOfTheFormat) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    RandomUrdf robot(seed);
    const SerialChain chain = readUrdf(robot.text());
    ASSERT_EQ(chain.jointNames(), robot.names()) << "seed " << seed;
    const VectorX q = robot.random().configuration(chain.size());
    std::map<std::string, double> values;
    for (int i = 0; i < chain.size(); ++i) values[chain.joint(i).name] = q[i];
    EXPECT_LT(difference(forwardKinematics(chain, q), robot.tip(values)), 1e-12) << "seed " << seed;
  }
}

TEST(UrdfLaw, CheckerSeesOneWrongJointValue) {
  RandomUrdf robot(5);
  const SerialChain chain = readUrdf(robot.text());
  std::map<std::string, double> values;
  for (const std::string& name : robot.names()) values[name] = 0.5;
  values.begin()->second += 1e-9;
  const VectorX q = VectorX::Constant(chain.size(), 0.5);
  EXPECT_GT(difference(forwardKinematics(chain, q), robot.tip(values)), 1e-11);
}

/// Damages a text at a random place: takes off, doubles or exchanges a piece of it.
std::string damaged(RandomModel& random, std::string text) {
  const char* const pieces[] = {"nan", "1e999", "-1e9", "0",      "\"",
                                "<",   ">",     "/>",   "link",   "0 0 0",
                                "-",   "fixed", "l0",   "planar", "<mimic joint=\"j0\"/>"};
  for (int k = random.integer(1, 3); k > 0; --k) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
    const auto length = static_cast<std::size_t>(random.integer(1, 12));
    switch (random.integer(0, 2)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(at, 4 * length));
        break;
      default:
        text.replace(at, length, pieces[random.integer(0, 14)]);
    }
    if (text.empty()) text = " ";
  }
  return text;
}

TEST(UrdfLaw, TenThousandDamagedRobotsAreReadOrRefused) {
  int refused = 0;
  for (unsigned seed = 1; seed <= 10000; ++seed) {
    RandomUrdf robot(seed % 500);
    RandomModel random(seed);
    const std::string text = damaged(random, robot.text());
    try {
      const SerialChain chain = readUrdf(text);
      const Pose X = forwardKinematics(chain, VectorX::Constant(chain.size(), 0.5));
      EXPECT_TRUE(X.p.allFinite() && X.R.allFinite()) << "seed " << seed << "\n" << text;
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()), "") << "seed " << seed;
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 10000);
}

TEST(UrdfLaw, DamagedTablesAreReadOrRefused) {
  const std::string table =
      "name: arm\njoints:\n"
      "  - {name: j0, type: revolute, alpha: pi/2, a: 0, d: 0.3, theta: 0, lower: -3, upper: 3, velocity: 2}\n"
      "  - {name: j1, type: prismatic, alpha: -2*pi/3, a: 0, d: 0, theta: 0, lower: 0, upper: 1}\n"
      "base: {xyz: [0, 0, 0], rpy: [0, 0, 0]}\ntool: {xyz: [0.1, 0, 0], rpy: [0, 0, 0]}\n";
  int refused = 0;
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    RandomModel random(seed);
    try {
      const SerialChain chain = readDhYaml(damaged(random, table));
      EXPECT_TRUE(chain.home().p.allFinite()) << "seed " << seed;
    } catch (const ModelError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace screwline
