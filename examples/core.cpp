#include <iostream>

#include "screwline/ik/inverse_kinematics.h"
#include "screwline/kinematics/singularity.h"
#include "screwline/model/urdf_reader.h"

/// The core library alone, without ROS: every way for a SCARA to reach a pose.
int main(int argc, char** argv) {
  const screwline::SerialChain arm = screwline::readUrdfFile(argc > 1 ? argv[1] : "urdf/scara.urdf");
  const screwline::Task task = screwline::Task::parse({"x", "y", "z", "rz"});
  const screwline::InverseKinematics ik(arm, task);
  std::cout << arm.name() << ", " << ik.method() << '\n';

  screwline::VectorX q(4);
  q << 0.3, 0.8, -0.5, 0.1;
  screwline::IkRequest request;
  request.target = screwline::forwardKinematics(arm, q);
  for (const screwline::IkAnswer& solution : ik.solve(request).solutions) {
    std::cout << solution.branch << ": " << solution.position.transpose() << '\n';
  }
  std::cout << "manipulability " << screwline::analyzeSingularity(arm, q, task).manipulability << '\n';
  return 0;
}
