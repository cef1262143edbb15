#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "screwline/symbolic/lost_direction.h"
#include "sections.h"

namespace screwline {
namespace {

constexpr std::size_t kShortDirection = 70;     ///< Characters of a direction that is given in the base's axes too.
constexpr std::size_t kLongestCondition = 200;  ///< Characters of a condition that is written again.
constexpr std::size_t kLongestSolution = 120;   ///< Characters of a joint's value where a condition holds.

std::string capitalised(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// "2", "1 or 2".
std::string choice(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const char* between = i == 0 ? "" : i + 1 == numbers.size() ? " or " : ", ";
    text += between + std::to_string(numbers[i]);
  }
  return text;
}

class SingularitySection {
 public:
  explicit SingularitySection(const SectionDraft& draft) : draft_(draft), document_(draft.document) {}

  std::vector<ConditionFormula> write() {
    document_.heading(2, "Singular conditions");
    std::vector<ConditionFormula> conditions = conditionsOf(draft_.symbolic, draft_.chain, draft_.task);
    const std::vector<ConditionMeeting> meetings = meetingsOf(draft_.symbolic, draft_.chain, draft_.task);
    if (conditions.empty() && meetings.empty()) {
      document_.paragraph(document_.text(
          "No factor that depends on the joints is common to all that the rank follows from, and no two or three short "
          "conditions were found that lower it together."));
      return conditions;
    }
    if (conditions.empty()) {
      document_.paragraph(document_.text("No single condition lowers the rank; conditions that hold together do."));
    } else {
      std::vector<std::string> items;
      const std::vector<ConditionLoss> losses = lossesOf(draft_.symbolic, draft_.chain, draft_.task);
      for (std::size_t i = 0; i < conditions.size(); ++i) items.push_back(item(conditions[i], losses[i]));
      document_.list(items);
    }
    writeMeetings(conditions, meetings);
    if (directions_ > 0) {
      document_.paragraph(document_.text(
          "Each lost direction was compared with the numeric Jacobian where its conditions hold, to 1e-9 of it."));
    }
    return conditions;
  }

 private:
  std::string item(const ConditionFormula& condition, const ConditionLoss& loss) {
    std::string text = document_.text(condition.name) + ": " + equationToZero(condition);
    std::string solvable;
    for (const ConditionSolution& solution : condition.solutions) {
      const Formula joint = Formula::symbol(solution.joint);
      if (lengthOf(condition.left_side) == lengthOf(joint)) continue;  // The condition is its solution.
      std::string values;
      bool is_long = false;
      for (const Formula& value : solution.values) {
        is_long = is_long || lengthOf(value) > kLongestSolution;
        values += (values.empty() ? "" : document_.text(" or ")) + document_.formula(value);
      }
      if (is_long) {
        solvable += (solvable.empty() ? "" : document_.text(" or ")) + document_.formula(joint);
      } else {
        text += "; " + document_.formula(joint) + " = " + values;
      }
    }
    if (!solvable.empty()) text += document_.text("; it has a solution for ") + solvable;
    text += ". " + document_.text(capitalised(condition.meaning)) + ".";
    if (loss.ranks.empty()) return text + document_.text(" No joint values were found where it holds.");
    return text + document_.text(" ") + rankAndLost("Rank ", loss);
  }

  std::string rankAndLost(const std::string& rank, const ConditionLoss& loss) {
    std::string text = document_.text(rank + choice(loss.ranks) + " of " + std::to_string(draft_.task.size()) + ".");
    for (std::size_t i = 0; i < loss.directions.size(); ++i)
      text += document_.text(i == 0 ? " Lost: " : ", and ") + lost(loss.directions[i]);
    directions_ += loss.directions.size();
    return text + (loss.directions.empty() ? "" : ".");
  }

  std::size_t lengthOf(const Formula& formula) const {
    return screwline::write(formula, draft_.symbolic.symbols(), FormulaStyle::kText).size();
  }

  std::string equationToZero(const Formula& left) const { return document_.formula(left) + " = 0"; }

  /// A long one by its name: it is written with the determinant.
  std::string equationToZero(const ConditionFormula& condition) const {
    if (lengthOf(condition.left_side) <= kLongestCondition) return equationToZero(condition.left_side);
    return document_.text("the long factor of the determinant above = 0");
  }

  std::string frameName(FrameNumber frame) const {
    if (frame == 0) return "the base";
    return frame == draft_.symbolic.size() + 1 ? "the tip" : "frame " + std::to_string(frame);
  }

  std::string pointName(FrameNumber frame) const {
    return frame == draft_.symbolic.size() + 1 ? "the tip"
                                               : "the origin of " + frameName(frame) + " (moving with the tip)";
  }

  /// "x of frame 2", or "(s3, 0, c3) in the axes of frame 2"; with the base's axes beside it where that is short.
  std::string along(const LostDirection& direction, const FormulaMatrix& column) const {
    const std::string frame = frameName(direction.axes);
    const std::string base = inBase(direction);
    for (int i = 0; i < 3; ++i) {
      bool unit = true;
      for (int k = 0; k < 3; ++k) unit = unit && column(k, 0).isNumber(k == i ? 1 : 0);
      if (!unit) continue;
      const std::string axis(1, "xyz"[i]);
      return document_.symbol(axis, axis) + document_.text(" of " + frame) + (base.empty() ? "" : ", " + base);
    }
    return document_.tuple(column) + document_.text(" in the axes of " + frame) + (base.empty() ? "" : ", " + base);
  }

  std::string lost(const LostDirection& direction) const {
    if (direction.isTranslation())
      return document_.text("velocity of " + pointName(direction.point) + " along ") + along(direction, direction.f);
    if (direction.isRotation()) {
      return document_.text("rotation about ") + along(direction, direction.n) +
             (direction.at_rest ? document_.text(", while the origin of " + frameName(direction.point) + " is at rest")
                                : "");
    }
    return document_.symbol("f v + n w", "f \\cdot v + n \\cdot \\omega") +
           document_.text(" with v the velocity of " + pointName(direction.point) + ", f = ") +
           document_.tuple(direction.f) + document_.text(" and n = ") + document_.tuple(direction.n) +
           document_.text(" in the axes of " + frameName(direction.axes));
  }

  std::string inBase(const LostDirection& direction) const {
    if (direction.axes == 0 || direction.in_base.rows == 0) return "";
    std::size_t length = 0;
    for (const Formula& entry : direction.in_base.entries) length += lengthOf(entry);
    if (length > kShortDirection) return "";
    return document_.tuple(direction.in_base) + document_.text(" in the base's axes");
  }

  void writeMeetings(const std::vector<ConditionFormula>& conditions, const std::vector<ConditionMeeting>& meetings) {
    if (meetings.empty()) return;
    document_.heading(2, "Where conditions meet");
    std::vector<std::string> items;
    for (const ConditionMeeting& meeting : meetings) {
      std::string together;
      const auto add = [&together](const std::string& equation) {
        together += (together.empty() ? "" : ", ") + equation;
      };
      for (const std::size_t i : meeting.conditions) add(equationToZero(conditions[i]));
      for (const Formula& other : meeting.others) add(equationToZero(other));
      items.push_back(together + document_.text(": ") +
                      (meeting.loss.ranks.empty() ? document_.text("no joint values were found where both or all hold.")
                                                  : rankAndLost("rank ", meeting.loss)));
    }
    document_.list(items);
    document_.paragraph(
        document_.text("These were found among the factors of minors, up to three at a time: there may be others."));
  }

  const SectionDraft& draft_;
  DocumentWriter& document_;
  std::size_t directions_ = 0;  ///< Written so far.
};

}  // namespace

std::vector<ConditionFormula> writeSingularities(const SectionDraft& draft) {
  return SingularitySection(draft).write();
}

}  // namespace screwline
