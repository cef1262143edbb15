#include "screwline/ros/service_adapter.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "screwline/ros/bounded_cache.h"

namespace screwline {
namespace ros_bridge {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

template <typename Response, typename Body>
Response answered(Body&& body) {
  Response response;
  EXPECT_TRUE(serve("service", response, [&] { return body(response); }));
  return response;
}

template <typename Body>
ComputeIK::Response answeredIk(Body&& body) {
  return answered<ComputeIK::Response>(std::forward<Body>(body));
}

TEST(ServiceAdapter, Success) {
  const auto response = answeredIk([](ComputeIK::Response& r) {
    r.joint_names = {"a"};
    return Outcome{AnswerCode::kSuccess, "2 solutions"};
  });
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.error_code, 1);
  EXPECT_EQ(response.message, "2 solutions");
  EXPECT_EQ(response.joint_names.size(), 1U);
}

TEST(ServiceAdapter, ExpectedFailureKeepsTheAnswer) {
  const auto response = answeredIk([](ComputeIK::Response& r) {
    r.distance_to_reachable = 0.5;
    return Outcome{AnswerCode::kNoIkSolution, "none"};
  });
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.error_code, -31);
  EXPECT_EQ(response.distance_to_reachable, 0.5);
}

TEST(ServiceAdapter, ExceptionsBecomeCodes) {
  const auto bad_input = answeredIk([](ComputeIK::Response& r) -> Outcome {
    r.joint_names = {"a"};
    throw InputError(AnswerCode::kInvalidLinkName, "link_name is 'x'");
  });
  EXPECT_FALSE(bad_input.success);
  EXPECT_EQ(bad_input.error_code, -18);
  EXPECT_EQ(bad_input.message, "link_name is 'x'");
  EXPECT_TRUE(bad_input.joint_names.empty());
  const auto model = answeredIk([](ComputeIK::Response&) -> Outcome { throw ModelError("no chain"); });
  EXPECT_EQ(model.error_code, 99999);
  EXPECT_EQ(model.message, "internal failure: no chain");
  const auto other = answeredIk([](ComputeIK::Response&) -> Outcome { throw std::bad_alloc(); });
  EXPECT_EQ(other.error_code, 99999);
  const auto unknown = answeredIk([](ComputeIK::Response&) -> Outcome { throw 7; });
  EXPECT_EQ(unknown.error_code, 99999);
  EXPECT_FALSE(unknown.success);
}

TEST(ServiceAdapter, NumbersThatAreNotFiniteNeverPass) {
  const auto fails = [](const std::function<void(ComputeIK::Response&)>& spoil) {
    const auto response = answeredIk([&](ComputeIK::Response& r) {
      r.solutions.resize(2);
      r.solutions[1].position = {0.0, 1.0};
      spoil(r);
      return Outcome();
    });
    return response.error_code == 99999 && !response.success && response.solutions.empty();
  };
  EXPECT_FALSE(fails([](ComputeIK::Response&) {}));
  EXPECT_TRUE(fails([](ComputeIK::Response& r) { r.solutions[1].position[1] = kNan; }));
  EXPECT_TRUE(fails([](ComputeIK::Response& r) { r.solutions[1].position[0] = kInf; }));
  EXPECT_TRUE(fails([](ComputeIK::Response& r) { r.closest.distance = kNan; }));
  EXPECT_TRUE(fails([](ComputeIK::Response& r) { r.distance_to_reachable = -kInf; }));
}

TEST(ServiceAdapter, DocumentedExceptionsPass) {
  const auto jacobian = answered<ComputeJacobian::Response>([](ComputeJacobian::Response& r) {
    r.determinant = kNan;
    return Outcome();
  });
  EXPECT_TRUE(jacobian.success);
  const auto disagreement = answered<ComputeJacobian::Response>([](ComputeJacobian::Response& r) {
    r.method_disagreement = kNan;
    return Outcome();
  });
  EXPECT_FALSE(disagreement.success);
  const auto describe = answered<Describe::Response>([](Describe::Response& r) {
    r.lower = {0.0, -kInf};
    r.upper = {kInf, 1.0};
    return Outcome();
  });
  EXPECT_TRUE(describe.success);
  const auto limits = answered<Describe::Response>([](Describe::Response& r) {
    r.lower = {kNan};
    return Outcome();
  });
  EXPECT_FALSE(limits.success);
  const auto range = answeredIk([](ComputeIK::Response& r) {
    r.solutions.resize(1);
    r.solutions[0].self_motion_upper = {1.0, kInf};
    return Outcome();
  });
  EXPECT_TRUE(range.success);
}

TEST(BoundedCache, MakesOnceAndStaysBounded) {
  BoundedCache<int, int> cache(3);
  int made = 0;
  const auto get = [&](int key) { return *cache.get(key, [&] { return ++made, 10 * key; }); };
  EXPECT_EQ(get(1), 10);
  EXPECT_EQ(get(1), 10);
  EXPECT_EQ(made, 1);
  EXPECT_THROW(cache.get(2, []() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(get(2), 20);
  const auto held = cache.get(1, [] { return 0; });
  for (int key = 3; key < 10; ++key) EXPECT_EQ(get(key), 10 * key);
  EXPECT_EQ(*held, 10);
  EXPECT_EQ(get(1), 10);
  EXPECT_EQ(made, 10);
}

}  // namespace
}  // namespace ros_bridge
}  // namespace screwline
