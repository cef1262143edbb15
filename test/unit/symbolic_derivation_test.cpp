#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "golden.h"
#include "screwline/kinematics/task_selection.h"
#include "screwline/model/urdf_reader.h"
#include "screwline/symbolic/derivation.h"

namespace screwline {
namespace {

SerialChain robot(const std::string& name) {
  return readUrdfFile(std::string(SCREWLINE_SOURCE_DIR) + "/urdf/" + name + ".urdf");
}

Derivation derived(const std::string& name, DocumentFormat format = DocumentFormat::kText) {
  const SerialChain chain = robot(name);
  DerivationOptions options;
  options.format = format;
  return deriveDocument(chain, deriveTask(chain), options);
}

TEST(SymbolicDerivation, NamesFactorsAndConditionsOfThePuma) {
  const Derivation derivation = derived("puma560");
  const std::vector<std::string> factors = {"-1", "a2", "a3*sin(theta3) + d4*cos(theta3)", "sin(theta5)",
                                            "a2*cos(theta2) + a3*cos(theta2 + theta3) - d4*sin(theta2 + theta3)"};
  EXPECT_EQ(derivation.factors, factors);
  ASSERT_EQ(derivation.conditions.size(), 3u);
  EXPECT_EQ(derivation.conditions[0].name, "elbow");
  EXPECT_EQ(derivation.conditions[1].name, "wrist");
  EXPECT_EQ(derivation.conditions[2].name, "shoulder");
  EXPECT_LE(derivation.worst_deviation, 1e-12);
  EXPECT_NE(derivation.document.find("theta5 = 0 or pi"), std::string::npos);
}

TEST(SymbolicDerivation, DoesNotChangeFromOneCallToTheNext) {
  EXPECT_EQ(derived("stanford_arm").document, derived("stanford_arm").document);
}

TEST(SymbolicDerivation, MayRunInSeveralThreads) {
  const std::string alone = derived("ur5").document;
  std::vector<std::string> found(4);
  std::vector<std::thread> threads;
  for (std::string& document : found) threads.emplace_back([&document] { document = derived("ur5").document; });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& document : found) EXPECT_EQ(document, alone);
}

TEST(SymbolicDerivation, EndsWhereItIsCancelledOrOutOfTime) {
  const SerialChain chain = robot("panda");
  const Task task = deriveTask(chain);
  DerivationOptions options;
  std::atomic<int> asked{0};
  options.progress.cancelled = [&asked] { return ++asked > 5; };
  EXPECT_THROW(deriveDocument(chain, task, options), DerivationStopped);
  options.progress = {};
  options.progress.time_limit = 0.02;
  EXPECT_THROW(deriveDocument(chain, task, options), DerivationStopped);
}

TEST(SymbolicDerivation, RefusesWhatItDoesNotKnow) {
  const SerialChain chain = robot("scara");
  DerivationOptions options;
  options.quantities = {"dynamics"};
  EXPECT_THROW(deriveDocument(chain, deriveTask(chain), options), InputError);
  EXPECT_THROW(documentFormatOf("pdf"), InputError);
}

TEST(SymbolicDerivation, SharesEqualLengthsWhereAsked) {
  const golden::File& file = *golden::load("seed003_03_rrr_articulated__special");
  DerivationOptions options;
  options.symbolic.share_equal_lengths = true;
  EXPECT_EQ(deriveDocument(file.table, file.task, options).symbols.size(), 1u);
  options.symbolic.share_equal_lengths = false;
  EXPECT_EQ(deriveDocument(file.table, file.task, options).symbols.size(), 2u);
}

TEST(SymbolicDerivation, WritesBalancedLatex) {
  const std::string latex = derived("puma560", DocumentFormat::kLatex).document;
  int depth = 0;
  for (std::size_t i = 0; i < latex.size(); ++i) {
    const bool escaped = i > 0 && latex[i - 1] == '\\';
    if (!escaped && latex[i] == '{') ++depth;
    if (!escaped && latex[i] == '}') --depth;
    ASSERT_GE(depth, 0) << i;
  }
  EXPECT_EQ(depth, 0);
  EXPECT_NE(latex.find("\\begin{document}"), std::string::npos);
}

}  // namespace
}  // namespace screwline
