#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "exact_chain.h"
#include "screwline/model/structure.h"

namespace screwline {
namespace {

constexpr double kStep = kPi / 12.0;
constexpr double kZeroLength = 1e-12;  ///< Of the chain's length: below it a length is rounding.
constexpr double kEqualLength = 1e-12;
constexpr double kGimbal = 1e-12;

bool isShortName(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
}

/// Makes symbols for a chain's numbers.
class TableMaker {
 public:
  TableMaker(const SerialChain& chain, const SymbolicOptions& options) : chain_(chain), options_(options) {}

  ExactTable make() {
    addJoints();
    const ModifiedDh& dh = chain_.modifiedDh();
    table_.base = transform(dh.base_transform, {"x0", "y0", "z0"}, "base");
    for (std::size_t i = 0; i < dh.rows.size(); ++i) table_.rows.push_back(row(dh.rows[i], static_cast<int>(i) + 1));
    const std::string n = std::to_string(dh.rows.size());
    table_.tool = transform(dh.tool_transform, {"a" + n, "b" + n, "d" + std::to_string(dh.rows.size() + 1)}, "tool");
    groupAngles();
    addRatesAndWrench();
    return std::move(table_);
  }

 private:
  void addJoints() {
    for (const Axis& axis : chain_.axes()) {
      const bool revolute = chain_.joint(axis.source).isRevolute();
      if (axis.prismatic == revolute || axis.multiplier != std::round(axis.multiplier))
        throw DerivationStopped("joint '" + chain_.joint(axis.source).name +
                                "' is mimicked by a joint of another type or by a multiplier that is not an integer");
    }
    for (int i = 0; i < chain_.size(); ++i) {
      Symbol symbol;
      symbol.name = chain_.joint(i).name;
      symbol.index = i + 1;
      const std::string number = std::to_string(i + 1);
      const bool revolute = chain_.joint(i).isRevolute();
      symbol.kind = revolute ? SymbolKind::kAngle : SymbolKind::kSlide;
      symbol.brief = revolute ? "theta" + number : isShortName(symbol.name) ? symbol.name : "d" + number;
      symbol.latex = latexOfName(symbol.brief);
      symbol.meaning = "value of joint " + number;
      table_.symbols.add(symbol);
    }
  }

  int addConstant(const std::string& name, double value, SymbolKind kind, const std::string& meaning) {
    Symbol symbol;
    symbol.name = name;
    symbol.brief = name;
    symbol.latex = latexOfName(name);
    symbol.kind = kind;
    symbol.value = value;
    symbol.meaning = meaning;
    return table_.symbols.add(symbol);
  }

  ExactLength length(double value, const std::string& name, const std::string& meaning) {
    if (std::abs(value) <= kZeroLength * chain_.characteristicLength()) return {};
    if (options_.share_equal_lengths) {
      for (int id = 0; id < table_.symbols.size(); ++id) {
        const Symbol& other = table_.symbols[id];
        if (other.kind != SymbolKind::kLength) continue;
        for (const int sign : {1, -1}) {
          if (std::abs(value - sign * other.value) <= kEqualLength * std::abs(value)) return {{{id, sign}}};
        }
      }
    }
    return {{{addConstant(name, value, SymbolKind::kLength, meaning), 1}}};
  }

  ExactAngle angle(double value, const std::string& name, const std::string& meaning) {
    const double steps = std::round(value / kStep);
    if (std::abs(value - steps * kStep) <= kExactAngle) return {{}, static_cast<int>(steps)};
    return {{{addConstant(name, value, SymbolKind::kConstantAngle, meaning), 1}}, 0};
  }

  ExactDhRow row(const ModifiedDhRow& numbers, int i) {
    const Axis& axis = chain_.axes()[static_cast<std::size_t>(i - 1)];
    const std::string before = std::to_string(i - 1);
    const std::string number = std::to_string(i);
    const std::string table = " of the modified-DH table";
    ExactDhRow row;
    row.alpha = angle(numbers.alpha, "alpha" + before, "alpha_" + before + table);
    row.a = length(numbers.a, "a" + before, "a_" + before + table);
    row.d = length(numbers.d, (axis.prismatic ? "l" : "d") + number, "d_" + number + table + " at zero");
    row.theta = angle(numbers.theta, "beta" + number, "theta_" + number + table + " at zero");
    const std::pair<int, int> moved(axis.source, static_cast<int>(axis.multiplier));
    if (axis.prismatic) {
      row.d.symbols.insert(row.d.symbols.begin(), moved);
    } else {
      row.theta.symbols.insert(row.theta.symbols.begin(), moved);
    }
    return row;
  }

  ExactTransform transform(const Pose& X, const std::vector<std::string>& names, const std::string& where) {
    const double pitch = std::atan2(-X.R(2, 0), std::hypot(X.R(0, 0), X.R(1, 0)));
    const bool upright = std::hypot(X.R(0, 0), X.R(1, 0)) < kGimbal;  // Yaw and roll turn about the same axis.
    const double yaw = upright ? std::atan2(-X.R(0, 1), X.R(1, 1)) : std::atan2(X.R(1, 0), X.R(0, 0));
    const double roll = upright ? 0.0 : std::atan2(X.R(2, 1), X.R(2, 2));
    ExactTransform result;
    result.yaw = angle(yaw, where + "_yaw", "yaw of the " + where + " transform");
    result.pitch = angle(pitch, where + "_pitch", "pitch of the " + where + " transform");
    result.roll = angle(roll, where + "_roll", "roll of the " + where + " transform");
    result.x = length(X.p.x(), names[0], "x of the " + where + " transform");
    result.y = length(X.p.y(), names[1], "y of the " + where + " transform");
    result.z = length(X.p.z(), names[2], "z of the " + where + " transform");
    return result;
  }

  /// Angles of neighbouring parallel axes (slides between them do not turn), and their offsets, form a group.
  void groupAngles() {
    std::vector<int> leader(static_cast<std::size_t>(table_.symbols.size()));
    std::iota(leader.begin(), leader.end(), 0);
    const auto join = [&leader](int a, int b) {
      const int from = leader[static_cast<std::size_t>(a)];
      std::replace(leader.begin(), leader.end(), from, leader[static_cast<std::size_t>(b)]);
    };
    const Axis* last = nullptr;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      const Axis& axis = chain_.axes()[i];
      if (axis.prismatic) continue;
      for (const auto& share : table_.rows[i].theta.symbols) join(share.first, axis.source);
      if (last != nullptr && last->direction.cross(axis.direction).norm() < kStructureAngleTolerance)
        join(last->source, axis.source);
      last = &axis;
    }
    for (int id = 0; id < table_.symbols.size(); ++id) {
      std::vector<int> group;
      for (int other = 0; other < table_.symbols.size(); ++other) {
        const SymbolKind kind = table_.symbols[other].kind;
        const bool is_angle = kind == SymbolKind::kAngle || kind == SymbolKind::kConstantAngle;
        if (is_angle && leader[static_cast<std::size_t>(other)] == id) group.push_back(other);
      }
      if (!group.empty()) table_.angle_groups.push_back(group);
    }
    std::sort(table_.angle_groups.begin(), table_.angle_groups.end());
  }

  void addRatesAndWrench() {
    for (int i = 0; i < chain_.size(); ++i) {
      const Symbol joint = table_.symbols[i];
      Symbol rate;
      rate.name = joint.name + "_dot";
      rate.brief = joint.brief + "_dot";
      rate.latex = "\\dot{" + joint.latex + "}";
      rate.kind = SymbolKind::kRate;
      rate.index = i + 1;
      rate.meaning = "velocity of joint " + std::to_string(i + 1);
      table_.symbols.add(rate);
    }
    for (const char* name : {"fx", "fy", "fz", "nx", "ny", "nz"}) {
      Symbol component;
      component.name = name;
      component.brief = name;
      component.latex = std::string(1, name[0]) + "_{" + name[1] + "}";
      component.meaning = "component of the tip's wrench, tip frame";
      table_.symbols.add(component);
    }
  }

  const SerialChain& chain_;
  const SymbolicOptions& options_;
  ExactTable table_;
};

}  // namespace

ExactTable exactTableOf(const SerialChain& chain, const SymbolicOptions& options) {
  return TableMaker(chain, options).make();
}

}  // namespace screwline
