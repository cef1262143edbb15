// Derived formulas against the closed forms that the golden files and the sources' pages state: equal as expressions,
// by GiNaC, and not much longer.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <ginac/ginac.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "golden.h"
#include "screwline/symbolic/determinant.h"

namespace screwline {
namespace {

using GiNaC::ex;

/// Sines and cosines of sums of symbols become rational functions of the half angles' tangents.
struct ToTangents : GiNaC::map_function {
  explicit ToTangents(const std::map<std::string, ex>& names) : names_(names) {
    for (const auto& name : names_) tangents_[name.first] = GiNaC::symbol("t_" + name.first);
  }

  ex operator()(const ex& e) override {
    const bool sine = GiNaC::is_the_function<GiNaC::sin_SERIAL>(e);
    if (!sine && !GiNaC::is_the_function<GiNaC::cos_SERIAL>(e)) return e.map(*this);
    ex c = 1;
    ex s = 0;
    for (const auto& [name, symbol] : names_) {
      ex times = e.op(0).expand().coeff(symbol, 1);
      for (; !times.is_zero(); times -= times.info(GiNaC::info_flags::positive) ? 1 : -1) {
        const ex t = tangents_.at(name);
        const ex c1 = (1 - t * t) / (1 + t * t);
        const ex s1 = (times.info(GiNaC::info_flags::positive) ? 2 : -2) * t / (1 + t * t);
        const ex next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
      }
    }
    return sine ? s : c;
  }

 private:
  const std::map<std::string, ex>& names_;
  std::map<std::string, ex> tangents_;
};

/// The golden file's parameter with the symbol's value; its name with a minus where the value is the negative.
std::string parameterOf(const golden::File& file, const Symbol& symbol) {
  for (const auto& [name, value] : file.parameters) {
    if (std::abs(value - symbol.value) < 1e-12) return name;
    if (std::abs(value + symbol.value) < 1e-12) return "-" + name;
  }
  return "";
}

class Comparison {
 public:
  explicit Comparison(const std::string& name) : file_(*golden::load(name)), chain_(file_.table) {
    for (const auto& parameter : file_.parameters) names_[parameter.first] = GiNaC::symbol(parameter.first);
    for (const std::string& joint : file_.table.jointNames()) names_[joint] = GiNaC::symbol(joint);
  }

  const golden::File& file() const { return file_; }
  const SymbolicChain& chain() const { return chain_; }

  bool areEqual(const Formula& ours, const std::string& theirs) const {
    ex difference = parsed(ownText(ours)) - parsed(theirs);
    for (int id = 0; id < chain_.symbols().size(); ++id) {
      const Symbol& symbol = chain_.symbols()[id];
      if (symbol.kind != SymbolKind::kLength) continue;
      const std::string parameter = parameterOf(file_, symbol);
      EXPECT_NE(parameter, "") << symbol.name;
      const bool negative = parameter.rfind('-', 0) == 0;
      const ex value = names_.at(parameter.substr(negative ? 1 : 0));
      difference = difference.subs(own_.at(symbol.name) == (negative ? ex(-value) : value));
    }
    ToTangents to_tangents(names_);
    return to_tangents(difference).normal().is_zero();
  }
  std::string ownText(const Formula& ours) const { return write(ours, chain_.symbols(), FormulaStyle::kInfix); }

 private:
  ex parsed(const std::string& text) const {
    GiNaC::symtab table;
    for (const auto& name : names_) table[name.first] = name.second;
    for (int id = 0; id < chain_.symbols().size(); ++id) {
      const Symbol& symbol = chain_.symbols()[id];
      if (symbol.kind != SymbolKind::kLength) continue;
      if (own_.count(symbol.name) == 0) own_[symbol.name] = GiNaC::symbol("own_" + symbol.name);
      if (table.count(symbol.name) == 0) table[symbol.name] = own_.at(symbol.name);
    }
    std::string powers = text;
    for (std::size_t at = powers.find("**"); at != std::string::npos; at = powers.find("**"))
      powers.replace(at, 2, "^");
    GiNaC::parser parser(table, true);
    return parser(powers);
  }

  const golden::File& file_;
  SymbolicChain chain_;
  std::map<std::string, ex> names_;
  mutable std::map<std::string, ex> own_;
};

class DeterminantOf : public testing::TestWithParam<std::string> {};

TEST_P(DeterminantOf, IsTheClosedFormAndNotMuchLonger) {
  const Comparison comparison(GetParam());
  const YAML::Node yaml = YAML::LoadFile(std::string(SCREWLINE_TEST_DATA) + "/golden/" + GetParam() + ".yaml");
  const std::string closed_form = yaml["model"]["det_formula"].as<std::string>();
  const DeterminantFormula determinant = determinantOf(comparison.chain(), comparison.file().task);
  ASSERT_TRUE(determinant.square);
  const Formula value = determinant.value();
  EXPECT_TRUE(comparison.areEqual(value, closed_form)) << comparison.ownText(value) << " is not " << closed_form;
  EXPECT_FALSE(comparison.areEqual(value, "2*(" + closed_form + ")")) << "the comparison compares nothing";
  EXPECT_LE(3 * comparison.ownText(value).size(), 4 * closed_form.size())
      << comparison.ownText(value) << " against " << closed_form;
}

INSTANTIATE_TEST_SUITE_P(All, DeterminantOf,
                         testing::Values("seed000_prrr", "seed001_rrp_spherical", "seed003_01_rr_planar",
                                         "seed003_02_rrr_planar", "seed003_03_rrr_articulated", "seed003_04_rrp_offset",
                                         "seed003_05_rpp_cylindrical", "seed003_06_wrist", "seed003_07_scara",
                                         "seed003_08_prrr", "seed004_01_rrprrr", "seed004_02_rrr_dh",
                                         "seed004_03_orienting_3r", "seed004_05_planar_3r"));

struct ClosedForm {
  std::string file;
  std::string what;  ///< "p": the tip's position in the base; "J": rows of the Jacobian in the tip's axes.
  std::vector<std::string> entries;
};

class ClosedForms : public testing::TestWithParam<ClosedForm> {};

TEST_P(ClosedForms, AreWhatIsDerived) {
  const Comparison comparison(GetParam().file);
  const int tip = comparison.chain().size() + 1;
  const FormulaMatrix derived =
      GetParam().what == "p" ? comparison.chain().pose(0, tip).p : comparison.chain().jacobian(tip);
  std::size_t ours = 0;
  std::size_t theirs = 0;
  for (std::size_t i = 0; i < GetParam().entries.size(); ++i) {
    const std::string& closed_form = GetParam().entries[i];
    EXPECT_TRUE(comparison.areEqual(derived.entries[i], closed_form))
        << "entry " << i << ": " << comparison.ownText(derived.entries[i]) << " is not " << closed_form;
    ours += comparison.ownText(derived.entries[i]).size();
    theirs += closed_form.size();
  }
  EXPECT_LE(3 * ours, 4 * theirs);
}

INSTANTIATE_TEST_SUITE_P(
    Pages, ClosedForms,
    testing::Values(ClosedForm{"seed003_03_rrr_articulated",
                               "p",
                               {"(L2*cos(theta2) + L3*cos(theta2 + theta3))*cos(theta1)",
                                "(L2*cos(theta2) + L3*cos(theta2 + theta3))*sin(theta1)",
                                "-L2*sin(theta2) - L3*sin(theta2 + theta3)"}},
                    ClosedForm{"seed003_03_rrr_articulated",
                               "J",
                               {"0", "L2*sin(theta3)", "0", "0", "L2*cos(theta3) + L3", "L3",
                                "L2*cos(theta2) + L3*cos(theta2 + theta3)", "0", "0", "-sin(theta2 + theta3)", "0", "0",
                                "-cos(theta2 + theta3)", "0", "0", "0", "1", "1"}},
                    ClosedForm{"seed003_04_rrp_offset",
                               "p",
                               {"L2*sin(theta1) - d3*cos(theta1)*sin(theta2)",
                                "-L2*cos(theta1) - d3*sin(theta1)*sin(theta2)", "d3*cos(theta2)"}},
                    ClosedForm{"seed003_04_rrp_offset",
                               "J",
                               {"L2*cos(theta2)", "-d3", "0", "-d3*sin(theta2)", "0", "0", "-L2*sin(theta2)", "0", "1",
                                "sin(theta2)", "0", "0", "0", "-1", "0", "cos(theta2)", "0", "0"}},
                    ClosedForm{
                        "seed004_02_rrr_dh",
                        "J",
                        {"-l1*cos(theta2)*cos(theta3)", "0", "0", "(l1*sin(theta3) - l2)*cos(theta2)", "0", "l2",
                         "(l2*sin(theta3) - l1)*sin(theta2)", "-l2*cos(theta3)", "0", "sin(theta2)*cos(theta3)",
                         "sin(theta3)", "0", "-sin(theta2)*sin(theta3)", "cos(theta3)", "0", "-cos(theta2)", "0", "1"}},
                    ClosedForm{"seed004_05_planar_3r",
                               "J",
                               {"l1*sin(theta2 + theta3) + l2*sin(theta3)", "l2*sin(theta3)", "0",
                                "l1*cos(theta2 + theta3) + l2*cos(theta3) + l3", "l2*cos(theta3) + l3", "l3"}}));

}  // namespace
}  // namespace screwline
