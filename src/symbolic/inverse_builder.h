#ifndef SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H
#define SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "exact_chain.h"
#include "screwline/symbolic/inverse_formulas.h"

namespace screwline {

/// An axis of one of the small problems: what it does is Z J Z^-1, with Z a frame on it and J about or along its z.
struct InverseAxis {
  int place = -1;  ///< Among the axes that are solved for; -1: an open row of the task.
  int frame = 0;   ///< Z at zero joint values is `local` in this frame.
  TrigPose local;
  int symbol = 0;  ///< Of its value.
  bool slides = false;
  int sense = 1;  ///< -1 where it is taken from the tip to the base.
  Axis line;      ///< The same in numbers.
};

/// A point that moves with a frame, at zero joint values.
struct InversePoint {
  int frame = 0;
  TrigMatrix p;
};

/// Writes lines of an inverse solution. Polynomials stay exact; a line's result is a symbol that later polynomials can
/// have in them.
///
/// The axes that are solved for are those of the chain without a given joint, and with the tool's turn that a task may
/// allow. Frame 0 is the base link, or what takes its place, frame i + 1 lies on axis i, frame size() + 1 is the tip.
class InverseBuilder {
 public:
  InverseBuilder(const SerialChain& chain, const InverseOutline& outline, const SymbolicOptions& options,
                 const Progress& progress);

  const SerialChain& chain() const { return chain_; }
  const RingPointer& ring() const { return exact_.ring; }
  TrigPolynomial number(int value) const { return TrigPolynomial::number(ring(), value); }
  TrigPolynomial symbol(int id) const { return TrigPolynomial::scalar(ring(), id); }

  int size() const { return static_cast<int>(axes_.size()); }
  std::string namesOf(const std::vector<int>& places) const;  ///< "joints 5 and 6"; one place may be -1.
  InverseAxis axis(int place, int sense) const;
  /// The slide along base axis `row` that a missing row of the task allows; `number` tells two of them apart.
  InverseAxis openRow(int row, int number) const;
  TrigPose motion(const InverseAxis& axis) const;
  const TrigPose& base() const { return base_; }  ///< Frame 0 of the table in frame 0.
  const TrigPose& step(int i) const { return steps_[static_cast<std::size_t>(i)]; }  ///< Frame i + 1 in frame i.
  TrigPose constantStep(int i) const;                                                ///< The same at zero.
  TrigPose between(int from, int to) const;                                          ///< Frame `to` in `from`, at zero.
  TrigPose relative(const InverseAxis& from, const InverseAxis& to) const;           ///< The same of axes.
  TrigMatrix seenFrom(const InverseAxis& axis, const InversePoint& point) const;
  bool isDhRow(int place) const { return place >= 0 && place + first_ < static_cast<int>(exact_.table.rows.size()); }
  TrigPolynomial offsetAlong(int place) const;  ///< d of a revolute joint's row.
  ExactAngle offsetAbout(int place) const;      ///< Constant part of theta.
  TrigMatrix rotationAboutZ(const ExactAngle& angle) const;
  TrigPose shiftAlongZ(const TrigPolynomial& length) const;
  TrigPose identity() const;

  /// Lines for where the last frame has to be, seen from the first: base, tool and the given joint are taken off. To be
  /// called before any other line is written. Does nothing where no joint is given and no angle of base or tool needs a
  /// symbol. @param tool whether the target has a rotation, by which the tool can be taken off.
  void takeOff(bool tool);
  TrigMatrix targetPoint() const { return target_.p; }     ///< 3 x 1
  TrigMatrix targetRotation() const { return target_.R; }  ///< 3 x 3
  int heading() const { return heading_; }                 ///< The symbol phi.

  /// Whether it has neither joints nor inputs in it; then its value.
  bool isConstant(const TrigPolynomial& polynomial) const;
  double valueOf(const TrigPolynomial& constant) const;
  bool isZero(const TrigPolynomial& polynomial) const;

  /// Says something before the next line.
  void say(const std::string& text) { before_ = text; }
  /// A line for a polynomial that is more than a symbol; what comes back can be used in its place. `name` is one of
  /// kResults in inverse_builder.cpp.
  TrigPolynomial named(const std::string& name, const TrigPolynomial& polynomial);
  TrigPolynomial named(const std::string& name, const Formula& value);
  TrigMatrix namedEntries(const std::string& letter, TrigMatrix matrix);
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
  /// A function of a joint: k + a cos + b sin, or k + a q + b q^2 of a slide.
  struct Form {
    Formula k;
    Formula a;
    Formula b;
    bool fixed = true;  ///< a and b have neither joints nor inputs in them.
  };
  /// The form of a polynomial, its parts on lines called `letter` with 0, 1, 2. Empty where it has higher terms.
  std::string marksOf(const InverseAxis& axis) const;  ///< What 0, 1, 2 mean, for people.
  std::optional<Form> formOf(const InverseAxis& axis, const std::string& letter, const TrigPolynomial& polynomial);
  Form named(const std::string& letter, const Form& form);
  /// The form again, with the joint in it.
  Formula formula(const InverseAxis& axis, const Form& form) const;
  /// Solves (sum of the squares) = rest for a joint: a quartic in the tangent of half a turn, or in a slide.
  void solveSquares(const InverseAxis& axis, const std::vector<Form>& squares, const Form& rest);
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
  void addToolTurn(int tool_axis);
  void leaveOutGiven(int given);
  TrigPose wholeTarget() const;
  bool solveTurn(const InverseAxis& axis, const Parts& parts);
  bool solveSlide(const InverseAxis& axis, const Parts& parts);
  void addStep(InverseStep step);
  int addSymbol(const std::string& name);
  int resultSymbol(const std::string& name) const;
  Formula briefly(const std::string& name, const Formula& value);

  const SerialChain& chain_;
  ExactChain exact_;
  int first_ = 0;   ///< Row of the table on which axis 0 lies.
  int given_ = -1;  ///< Joint.
  int open_joint_ = -1;
  std::vector<InverseAxis> axes_;
  std::vector<TrigPose> steps_;
  TrigPose base_;
  TrigPose target_;
  std::array<int, 12> inputs_{};  ///< Symbols of the target.
  int heading_ = 0;
  std::vector<InverseStep> lines_;
  std::string before_;
  int signs_ = 0;
};

/// A position that three axes reach: J1 J2 J3 start = goal. False where its case is not written.
bool writePosition(InverseBuilder& builder, std::array<InverseAxis, 3> axes, InversePoint start, InversePoint goal);

/// The same for turns about two axes that do not meet and are not parallel, in the frame of the first: K1 carried has
/// to come to the goal; K1 is a turn about x and a shift along it.
bool writeSkewTurns(InverseBuilder& builder, const std::array<InverseAxis, 3>& axes, const TrigPose& K1,
                    const TrigMatrix& carried, const TrigMatrix& goal);

/// Axes first, first + 1, first + 2 make the tip's rotation; all others are known.
bool writeOrientation(InverseBuilder& builder, int first);

/// Three parallel axes among six.
bool writeParallel(InverseBuilder& builder, const InverseOutline& outline);

TrigMatrix times(const TrigPose& X, const TrigMatrix& point);

}  // namespace screwline

#endif  // SCREWLINE_SRC_SYMBOLIC_INVERSE_BUILDER_H
