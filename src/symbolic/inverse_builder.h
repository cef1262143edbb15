#ifndef SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H
#define SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H

#include <array>
#include <string>
#include <vector>

#include "exact_chain.h"
#include "screwline/symbolic/inverse_formulas.h"

namespace screwline {

/// An axis of one of the small problems: what it does is Z J Z^-1, with J about or along z.
struct InverseAxis {
  TrigPose Z;      ///< A frame on it, in the base link, at zero joint values.
  int joint = -1;  ///< -1: an open row of the task.
  int symbol = 0;  ///< Of its value.
  bool slides = false;
  int sense = 1;  ///< -1 where it is taken from the tip to the base.
  Axis line;      ///< The same in numbers.
};

/// Writes lines of an inverse solution. Polynomials stay exact; a line's result is a symbol that later polynomials can
/// have in them.
class InverseBuilder {
 public:
  InverseBuilder(const SerialChain& chain, const SymbolicOptions& options, const Progress& progress);

  const SerialChain& chain() const { return chain_; }
  const RingPointer& ring() const { return exact_.ring; }
  TrigPolynomial number(int value) const { return TrigPolynomial::number(ring(), value); }
  TrigPolynomial symbol(int id) const { return TrigPolynomial::scalar(ring(), id); }

  InverseAxis axis(int joint, int sense) const;
  /// The slide along base axis `row` that a missing row of the task allows; `number` tells two of them apart.
  InverseAxis openRow(int row, int number) const;
  TrigPose motion(const InverseAxis& axis) const;
  TrigPose constantStep(int i) const;                   ///< Frame i + 1 in frame i at zero, i = 0..n: the tip the last.
  const TrigPose& base() const { return exact_.base; }  ///< Frame 0 of the table in the base link.
  TrigPose step(int i) const { return exact_.steps[static_cast<std::size_t>(i)]; }
  TrigPose zeroFrame(int frame) const;          ///< Of the table, in the base link, at zero; n + 1: the tip.
  TrigPolynomial offsetAlong(int joint) const;  ///< d of a revolute joint's row.
  ExactAngle offsetAbout(int joint) const;      ///< Constant part of theta.
  TrigMatrix rotationAboutZ(const ExactAngle& angle) const;
  TrigPose shiftAlongZ(const TrigPolynomial& length) const;
  TrigPose identity() const;

  TrigMatrix targetPoint() const;           ///< 3 x 1
  TrigMatrix targetRotation() const;        ///< 3 x 3
  int heading() const { return heading_; }  ///< The symbol phi.

  /// Whether it has neither joints nor inputs in it; then its value.
  bool isConstant(const TrigPolynomial& polynomial) const;
  double valueOf(const TrigPolynomial& constant) const;
  bool isZero(const TrigPolynomial& polynomial) const;

  /// Says something before the next line.
  void say(const std::string& text) { before_ = text; }
  /// A line for a polynomial that is more than a symbol; what comes back can be used in its place. `name` is one of
  /// kResults in inverse_builder.cpp.
  TrigPolynomial named(const std::string& name, const TrigPolynomial& polynomial);
  /// +- sqrt(radicand), of which the name is one of kResults.
  TrigPolynomial root(const std::string& name, const TrigPolynomial& radicand);
  /// A line of formulas only: its symbol is not for polynomials.
  Formula formulaNamed(const std::string& name, const Formula& value);
  Formula rootNamed(const std::string& name, const Formula& radicand);
  void addRoot(int id, const Formula& radicand);  ///< A line id = +- sqrt(radicand).
  Formula formula(const TrigPolynomial& polynomial) const { return exact_.formula(polynomial); }
  Formula inputsFirst(const TrigPolynomial& polynomial) const;  ///< The same, what is constant at its end.

  /// Solves equation = 0 for a joint; false where that takes more than a square root.
  bool solve(const InverseAxis& axis, const TrigPolynomial& equation);
  /// The joint that turns (from) to (to), seen along its axis.
  void turnBetween(const InverseAxis& axis, const TrigPolynomial& from_x, const TrigPolynomial& from_y,
                   const TrigPolynomial& to_x, const TrigPolynomial& to_y);
  /// The middle one of three turns, of which `height` is the third axis' component along the first and `column` where
  /// the third axis has to point.
  bool solveMiddle(const InverseAxis& axis, const TrigMatrix& column, const TrigPolynomial& height);
  /// A line for a joint. Where all of `free_if` are zero, any value does.
  void setJoint(int symbol, const Formula& value, const std::vector<Formula>& free_if = {});
  std::string suffix(const InverseAxis& axis) const;

  /// Leaves out lines that nothing needs.
  InverseFormulas finished();

  /// k + a cos + b sin of a joint's angle, or k + a q + b q^2 of a slide. False where there are higher terms.
  struct Parts {
    TrigPolynomial k;
    TrigPolynomial a;
    TrigPolynomial b;
  };
  bool partsOf(const InverseAxis& axis, const TrigPolynomial& polynomial, Parts& parts) const;

 private:
  static ExactTable tableOf(const SerialChain& chain, const SymbolicOptions& options);
  bool solveTurn(const InverseAxis& axis, const Parts& parts);
  bool solveSlide(const InverseAxis& axis, const Parts& parts);
  void addStep(InverseStep step);
  int addSymbol(const std::string& name);

  const SerialChain& chain_;
  ExactChain exact_;
  std::array<int, 12> target_{};
  int heading_ = 0;
  std::vector<InverseStep> steps_;
  std::string before_;
  int signs_ = 0;
};

/// A position that three axes reach: J1 J2 J3 start = goal, base link. False where its case is not written.
bool writePosition(InverseBuilder& builder, std::array<InverseAxis, 3> axes, TrigMatrix start, TrigMatrix goal);

/// Joints first, first + 1, first + 2 make the tip's rotation; all others are known.
bool writeOrientation(InverseBuilder& builder, int first);

/// Three parallel axes among six.
bool writeParallel(InverseBuilder& builder, const InverseOutline& outline);

TrigMatrix times(const TrigPose& X, const TrigMatrix& point);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H
