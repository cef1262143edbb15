#include "screwline/ik/algebraic/algebraic_solver.h"

#include <algorithm>

#include "elimination.h"

namespace screwline {
namespace {

constexpr std::size_t kMaxEliminations = 3;

}  // namespace

struct AlgebraicSolver::Implementation {
  explicit Implementation(const SerialChain& chain_in) : chain(chain_in), loop(chain) {
    eliminations = chooseEliminations(chain, loop);
    if (eliminations.size() > kMaxEliminations) {
      eliminations.erase(eliminations.begin() + static_cast<std::ptrdiff_t>(kMaxEliminations), eliminations.end());
    }
    if (!eliminations.empty()) {
      const Labelling& best = eliminations.front().labelling();
      method = "algebraic: " + chain.joint(best.hidden()).name + " hidden, " + chain.joint(best.pair(0)).name +
               " and " + chain.joint(best.pair(1)).name + " eliminated linearly";
    }
  }

  SerialChain chain;
  Loop loop;
  std::vector<Elimination> eliminations;
  std::string method;
};

AlgebraicSolver::AlgebraicSolver(std::shared_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}

std::optional<AlgebraicSolver> AlgebraicSolver::compile(const SerialChain& chain) {
  const auto isSlide = [](const Axis& axis) { return axis.prismatic; };
  if (chain.size() != 6 || chain.hasMimic()) return std::nullopt;
  if (std::count_if(chain.axes().begin(), chain.axes().end(), isSlide) > 1) return std::nullopt;
  auto implementation = std::make_shared<const Implementation>(chain);
  if (implementation->eliminations.empty()) return std::nullopt;
  return AlgebraicSolver(std::move(implementation));
}

void AlgebraicSolver::solve(const Pose& target, AlgebraicSolutions& solutions) const {
  const Implementation& self = *implementation_;
  solutions.count = 0;
  solutions.complete = false;
  solutions.degenerate = false;
  RootRefiner refiner(self.chain, self.loop.length, target, solutions);
  const DualQuaternion closure = self.loop.closure(target);
  bool vanishing = true;
  // Solutions that are not double come in pairs: an odd number is reason to look again.
  for (const Elimination& elimination : self.eliminations) {
    const Eliminated result = elimination.solve(closure, refiner);
    vanishing = vanishing && result == Eliminated::kVanishing;
    solutions.complete = solutions.complete || result == Eliminated::kAll;
    if (result == Eliminated::kAll && solutions.count % 2 == 0) break;
  }
  refiner.findContinua();
  solutions.degenerate = solutions.degenerate || vanishing;
  solutions.complete = solutions.complete && !solutions.degenerate;
}

const std::string& AlgebraicSolver::method() const {
  return implementation_->method;
}

}  // namespace screwline
