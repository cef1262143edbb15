#ifndef SCREWLINE_SRC_KINEMATICS_FACTOR_SEARCH_H
#define SCREWLINE_SRC_KINEMATICS_FACTOR_SEARCH_H

#include <utility>
#include <vector>

#include "factor_fit.h"

namespace screwline {

/// Splits a function of the joints into factors, comparing with its value at a base configuration where it is large.
class FactorSearch {
 public:
  /// Keeps a reference to the chain.
  FactorSearch(const SerialChain& chain, VectorX base) : chain_(chain), base_(std::move(base)) {}

  /// Adds the factors of f, which depends on `joints` at most. f(base) is not zero.
  void split(const JointFunction& f, const std::vector<int>& joints);

  const std::vector<SingularityFactor>& factors() const { return factors_; }  ///< Explicit ones, not named yet.
  bool isComplete() const { return !incomplete_; }  ///< No part of the function has stayed without an explicit form.

 private:
  /// q with sample `number` of some joints.
  VectorX moved(VectorX q, const std::vector<int>& joints, int number) const;

  /// Joints that matter, in sets that multiply: f(a, b) f(a', b') = f(a', b) f(a, b') parts a from b.
  std::vector<std::vector<int>> blocksOf(const JointFunction& f, const std::vector<int>& joints) const;
  bool matters(const JointFunction& f, double f_base, int joint) const;
  bool interact(const JointFunction& f, double f_base, int a, int b) const;

  std::vector<double> rootsAlong(const JointFunction& f, int joint) const;
  /// Zeros along one joint that stay zeros wherever the block's other joints are.
  std::vector<double> commonRoots(const JointFunction& f, const std::vector<int>& block, int joint) const;

  /// Takes factors in one joint out of a block of several; what remains is split again or, as it is, fitted.
  void peel(const JointFunction& f, const std::vector<int>& block);
  void fit(const JointFunction& f, const std::vector<int>& block);
  void add(const std::vector<SingularityFactor>& found);

  const SerialChain& chain_;
  VectorX base_;
  std::vector<SingularityFactor> factors_;
  bool incomplete_ = false;
};

}  // namespace screwline

#endif  // SCREWLINE_SRC_KINEMATICS_FACTOR_SEARCH_H
