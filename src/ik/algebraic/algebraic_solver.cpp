#include "screwline/ik/algebraic/algebraic_solver.h"

#include <algorithm>

#include "elimination.h"
#include "three_slides.h"

namespace screwline {
struct AlgebraicSolver::Implementation {
  explicit Implementation(const SerialChain& chain_in)
      : chain(chain_in), loop(chain), three_slides(ThreeSlides::compile(chain)) {
    if (three_slides) {
      method = "algebraic: three turns make the orientation, three slides the position";
      return;
    }
    eliminations = chooseEliminations(chain, loop);
    if (!eliminations.usable.empty()) {
      const Labelling& best = eliminations.usable.front().labelling();
      method = "algebraic: " + chain.joint(best.hidden()).name + " hidden, " + chain.joint(best.pair(0)).name +
               " and " + chain.joint(best.pair(1)).name + " eliminated linearly";
    }
  }

  SerialChain chain;
  Loop loop;
  std::optional<ThreeSlides> three_slides;
  EliminationChoice eliminations;
  std::string method;
};

AlgebraicSolver::AlgebraicSolver(std::shared_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}

std::optional<AlgebraicSolver> AlgebraicSolver::compile(const SerialChain& chain) {
  const auto isSlide = [](const Axis& axis) { return axis.prismatic; };
  if (chain.size() != 6 || chain.hasMimic()) return std::nullopt;
  if (std::count_if(chain.axes().begin(), chain.axes().end(), isSlide) > 3) return std::nullopt;
  auto implementation = std::make_shared<const Implementation>(chain);
  if (implementation->method.empty()) return std::nullopt;
  return AlgebraicSolver(std::move(implementation));
}

void AlgebraicSolver::solve(const Pose& target, AlgebraicSolutions& solutions) const {
  const Implementation& self = *implementation_;
  solutions.count = 0;
  solutions.complete = false;
  solutions.degenerate = false;
  RootRefiner refiner(self.chain, self.loop.length, target, solutions);
  if (self.three_slides) {
    solutions.complete = self.three_slides->solve(self.chain, target, refiner);
    solutions.degenerate = !solutions.complete;
    return;
  }
  const DualQuaternion closure = self.loop.closure(target);
  bool clean = false;
  bool vanishing = true;
  // Solutions that are not double come in pairs: an odd number is reason to look again.
  for (const Elimination& elimination : self.eliminations.usable) {
    const Eliminated result = elimination.solve(closure, refiner);
    vanishing = vanishing && result == Eliminated::kVanishing;
    solutions.complete = solutions.complete || result == Eliminated::kAll;
    clean = result == Eliminated::kAll && solutions.count % 2 == 0;
    if (clean) break;
  }
  for (const Elimination& elimination : self.eliminations.reserves) {
    if (clean || vanishing || (solutions.complete && solutions.count % 2 == 0)) break;
    elimination.solve(closure, refiner);
  }
  refiner.findContinua();
  solutions.degenerate = solutions.degenerate || vanishing;
  solutions.complete = solutions.complete && !solutions.degenerate;
}

const std::string& AlgebraicSolver::method() const {
  return implementation_->method;
}

}  // namespace screwline
