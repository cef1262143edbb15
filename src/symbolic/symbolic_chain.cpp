#include "screwline/symbolic/symbolic_chain.h"

#include <utility>

#include "exact_chain.h"

namespace screwline {
namespace {

Formula angleOf(const ExactAngle& angle) {
  std::vector<Formula> terms;
  for (const auto& [symbol, times] : angle.symbols) terms.push_back(Formula::number(times) * Formula::symbol(symbol));
  if (angle.steps != 0) terms.push_back(Formula::number(angle.steps, 12) * Formula::pi());
  return Formula::sum(terms);
}

SymbolicPose formulasOf(const ExactChain& exact, const TrigPose& X) {
  return {exact.formula(X.R), exact.formula(X.p)};
}

/// 3 x 1 of the tip's wrench's components from symbol `first` on.
TrigMatrix inputs(const ExactChain& exact, const char* first) {
  const int id = exact.table.symbols.find(first).value_or(0);
  TrigMatrix column(exact.ring, 3, 1);
  for (int i = 0; i < 3; ++i) column(i, 0) = TrigPolynomial::scalar(exact.ring, id + i);
  return column;
}

}  // namespace

SymbolicChain::SymbolicChain(const SerialChain& chain, const SymbolicOptions& options, const Progress& progress)
    : exact_(std::make_unique<ExactChain>(chain, options, progress)) {}

SymbolicChain::~SymbolicChain() = default;

int SymbolicChain::size() const {
  return exact_->size;
}

int SymbolicChain::joints() const {
  return exact_->joints;
}

const SymbolTable& SymbolicChain::symbols() const {
  return exact_->table.symbols;
}

std::vector<SymbolicDhRow> SymbolicChain::dhRows() const {
  std::vector<SymbolicDhRow> rows;
  for (const ExactDhRow& row : exact_->table.rows) {
    rows.push_back({angleOf(row.alpha), exact_->formula(exact_->length(row.a)), exact_->formula(exact_->length(row.d)),
                    angleOf(row.theta)});
  }
  return rows;
}

SymbolicPose SymbolicChain::baseTransform() const {
  return formulasOf(*exact_, exact_->base);
}

SymbolicPose SymbolicChain::toolTransform() const {
  return formulasOf(*exact_, exact_->tool);
}

SymbolicPose SymbolicChain::pose(FrameNumber reference, FrameNumber frame) const {
  return formulasOf(*exact_, exact_->pose(reference, frame));
}

FormulaMatrix SymbolicChain::jacobian(FrameNumber frame) const {
  return exact_->formula(exact_->jacobian(frame, exact_->size + 1));
}

std::vector<SymbolicLinkVelocity> SymbolicChain::velocities() const {
  std::vector<SymbolicLinkVelocity> links;
  TrigMatrix w(exact_->ring, 3, 1);
  TrigMatrix v(exact_->ring, 3, 1);
  for (int i = 0; i < exact_->size; ++i) {
    const TrigPose& X = exact_->steps[static_cast<std::size_t>(i)];
    v = X.R.transposed() * (v + cross(w, X.p));
    w = X.R.transposed() * w;
    TrigMatrix& moved = exact_->prismatic[static_cast<std::size_t>(i)] ? v : w;
    moved(2, 0) += exact_->rate(i);
    links.push_back({exact_->formula(w), exact_->formula(v)});
  }
  return links;
}

std::vector<SymbolicLinkWrench> SymbolicChain::wrenches() const {
  std::vector<SymbolicLinkWrench> links(static_cast<std::size_t>(exact_->size));
  TrigMatrix f = inputs(*exact_, "fx");
  TrigMatrix n = inputs(*exact_, "nx");
  for (int i = exact_->size; i > 0; --i) {
    const TrigPose& X = exact_->steps[static_cast<std::size_t>(i)];
    f = X.R * f;
    n = X.R * n + cross(X.p, f);
    links[static_cast<std::size_t>(i - 1)] = {exact_->formula(f), exact_->formula(n)};
  }
  return links;
}

}  // namespace screwline
