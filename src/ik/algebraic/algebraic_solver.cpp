#include "screwline/ik/algebraic/algebraic_solver.h"

#include <algorithm>

#include "elimination.h"
#include "three_slides.h"
#include "two_slides.h"

namespace screwline {
namespace {

bool isSlide(const Axis& axis) {
  return axis.prismatic;
}

}  // namespace

struct AlgebraicSolver::Implementation {
  explicit Implementation(const SerialChain& chain_in)
      : chain(chain_in), loop(chain), three_slides(ThreeSlides::compile(chain)) {
    if (three_slides) {
      method = "algebraic: three turns make the orientation, three slides the position";
      return;
    }
    const auto slides = std::count_if(loop.axes.begin(), loop.axes.end(), isSlide);
    if (slides > 2) return;
    hidden = chooseHiddenTurns(chain, loop, slides == 2 ? slidePairsOf(loop) : eliminationsOf(loop));
    if (!hidden.usable.empty()) method = "algebraic: " + hidden.usable.front()->words(chain);
  }

  SerialChain chain;
  Loop loop;
  std::optional<ThreeSlides> three_slides;
  HiddenTurnChoice hidden;
  std::string method;
};

AlgebraicSolver::AlgebraicSolver(std::shared_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}

std::optional<AlgebraicSolver> AlgebraicSolver::compile(const SerialChain& chain) {
  if (chain.size() != 6 || chain.hasMimic()) return std::nullopt;
  auto implementation = std::make_shared<const Implementation>(chain);
  if (implementation->method.empty()) return std::nullopt;
  return AlgebraicSolver(std::move(implementation));
}

void AlgebraicSolver::solve(const Pose& target, AlgebraicSolutions& solutions, bool find_continua) const {
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
  bool vanishing = true;
  for (int round = 0; round < 2 && !solutions.complete; ++round) {
    const int known = solutions.count;
    for (const HiddenTurns* turns : {&self.hidden.usable, &self.hidden.reserves}) {
      for (const std::shared_ptr<const HiddenTurn>& turn : *turns) {
        const Eliminated result = turn->solve(target, refiner);
        vanishing = vanishing && result == Eliminated::kVanishing;
        solutions.complete = result == Eliminated::kAll;
        if (solutions.complete) break;
      }
      if (solutions.complete || vanishing) break;
    }
    if (solutions.count == known) break;
  }
  if (find_continua) refiner.findContinua();
  solutions.degenerate = solutions.degenerate || vanishing;
  solutions.complete = solutions.complete && !solutions.degenerate;
}

const std::string& AlgebraicSolver::method() const {
  return implementation_->method;
}

}  // namespace screwline
