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
  bool clean = false;
  bool vanishing = true;
  // Solutions that are not double come in pairs: an odd number is reason to look again.
  for (const std::shared_ptr<const HiddenTurn>& turn : self.hidden.usable) {
    const Eliminated result = turn->solve(target, refiner);
    vanishing = vanishing && result == Eliminated::kVanishing;
    solutions.complete = solutions.complete || result == Eliminated::kAll;
    clean = result == Eliminated::kAll && solutions.count % 2 == 0;
    if (clean) break;
  }
  for (const std::shared_ptr<const HiddenTurn>& turn : self.hidden.reserves) {
    if (clean || vanishing || (solutions.complete && solutions.count % 2 == 0)) break;
    turn->solve(target, refiner);
  }
  if (find_continua) refiner.findContinua();
  solutions.degenerate = solutions.degenerate || vanishing;
  solutions.complete = solutions.complete && !solutions.degenerate;
}

const std::string& AlgebraicSolver::method() const {
  return implementation_->method;
}

}  // namespace screwline
