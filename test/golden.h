#ifndef SCREWLINE_TEST_GOLDEN_H
#define SCREWLINE_TEST_GOLDEN_H

#include <map>
#include <string>
#include <vector>

#include "screwline/model/serial_chain.h"
#include "screwline/model/task.h"

namespace screwline {
namespace golden {

/// A configuration that reaches a case's pose over its ik task.
struct IkAnswer {
  VectorX q;
  bool full_pose_matches = false;  ///< It also reproduces the rows that are not in the task.
};

/// A continuum of solutions: free joints take any value, fixed ones the given; relation: sum coefficient * joint =
/// value mod 2 pi.
struct IkFamily {
  std::vector<std::string> free;
  std::map<std::string, double> fixed;
  std::map<std::string, double> relation;  ///< Coefficients by joint; empty: none.
  double relation_value = 0.0;
};

struct Ik {
  Task task;
  bool infinite = false;
  std::vector<IkAnswer> solutions;  ///< All of them; where infinite, samples of the families.
  std::vector<IkFamily> families;
};

/// One configuration and everything that is true at it. Rows of link_* belong to modified-DH frame i = 1..n, components
/// in that frame.
struct Case {
  std::string id;
  bool singular = false;
  VectorX q;
  Pose pose;
  Matrix6X jacobian_base;
  Matrix6X jacobian_tool;
  double det_task = 0.0;
  int rank_task = 0;
  int rank_full = 0;
  VectorX singular_values_task;
  VectorX singular_values_full;
  double manipulability_task = 0.0;
  MatrixX lost_task_directions;  ///< k x m rows; empty where none are lost.
  MatrixX null_joint_rates;      ///< k x n rows.
  VectorX qd;
  Vector6 twist_base;
  Vector6 twist_tool;
  MatrixX link_w;
  MatrixX link_v;
  Vector6 wrench;
  VectorX tau_if_wrench_in_tool;
  VectorX tau_if_wrench_in_base;
  MatrixX link_f;
  MatrixX link_n;
  Ik ik;
};

struct UnreachablePose {
  std::string reason;
  Pose pose;
};

struct File {
  std::string name;  ///< Of the file, without folder and ending.
  std::map<std::string, double> parameters;
  Task task;          ///< det_rows.
  SerialChain chain;  ///< From the screw axes and the home pose; no limits.
  SerialChain table;  ///< From the modified-DH table, whose frames are those of the cases' link_* rows.
  std::vector<Case> cases;
  std::vector<UnreachablePose> unreachable;
};

/// Names of all golden files, sorted.
const std::vector<std::string>& names();

/// Reads one; kept for later calls. @throws std::runtime_error where it is not as expected.
const File* load(const std::string& name);

/// Value of an expression such as "-pi/2", "L1 + L2", "2*(l1 - l2)**2" or "sqrt(3)/2".
/// @throws std::runtime_error for what it cannot read.
double evaluate(const std::string& expression, const std::map<std::string, double>& symbols);

}  // namespace golden
}  // namespace screwline

#endif  // SCREWLINE_TEST_GOLDEN_H
