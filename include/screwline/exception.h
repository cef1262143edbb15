#ifndef SCREWLINE_EXCEPTION_H
#define SCREWLINE_EXCEPTION_H

#include <stdexcept>
#include <string>

namespace screwline {

/// Numbers of the answers' error_code field (msg/ErrorCode.msg; those of MoveItErrorCodes where a meaning matches).
enum class AnswerCode : int {
  kSuccess = 1,
  kFailure = 99999,
  kTimedOut = -6,
  kInvalidGoal = -16,
  kInvalidRobotState = -17,
  kInvalidLinkName = -18,
  kFrameTransformFailure = -21,
  kNoIkSolution = -31,
  kLimitsInfeasible = 1001,
  kPathNotContinuous = 1002,
  kUnknownProfile = 1003,
  kTooLarge = 1004,
};

/// Base of everything that screwline throws. Expected outcomes (unreachable, singular) are values, not exceptions.
class Exception : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The robot cannot be served: malformed description, no chain, a bad axis, too many joints.
class ModelError : public Exception {
 public:
  using Exception::Exception;
};

/// A request broke its contract. The message names the field, its value and the bound; code() is the answer's
/// error_code.
class InputError : public Exception {
 public:
  InputError(AnswerCode code, const std::string& message) : Exception(message), code_(code) {}
  AnswerCode code() const { return code_; }

 private:
  AnswerCode code_;
};

}  // namespace screwline

#endif  // SCREWLINE_EXCEPTION_H
