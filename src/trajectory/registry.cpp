#include "screwline/exception.h"
#include "screwline/trajectory/profile.h"

namespace screwline {
namespace {

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

std::vector<Profile> singleMoves() {
  return {
      {{"rectangular", "constant velocity between two waypoints; velocity steps at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildRectangular},
      {{"cubic", "3 tau^2 - 2 tau^3 between two waypoints; acceleration steps at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildCubic},
      {{"trapezoidal",
        "trapezoidal velocity between two waypoints. Any two of the parameters and the duration define it; with one of "
        "them, or the "
        "duration alone, thirds of equal length (moved as little as the limits ask); with nothing, the shortest within "
        "the limits",
        {{"peak_velocity", "[rad/s or m/s] of the joint that moves farthest", false},
         {"acceleration", "[rad/s^2 or m/s^2] of the joint that moves farthest", false},
         {"acceleration_time", "[s] of each ramp", false}}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildTrapezoidal},
      {{"polynomial_345", "10 tau^3 - 15 tau^4 + 6 tau^5 between two waypoints; zero acceleration at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial345},
      {{"polynomial_4567", "35 tau^4 - 84 tau^5 + 70 tau^6 - 20 tau^7; zero acceleration and jerk at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial4567},
      {{"cycloidal", "tau - sin(2 pi tau) / (2 pi) between two waypoints; zero acceleration at the ends", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildCycloidal},
      {{"minimum_jerk", "least integral of squared jerk from rest to rest: polynomial_345", {}},
       2,
       2,
       false,
       WaypointDerivatives::kNone,
       buildPolynomial345},
  };
}

std::vector<Profile> otherProfiles() {
  return {
      {{"sinusoidal",
        "joint i: offset_i + amplitude_i sin(omega_i t + phase_i) for the given duration; parameters not given are 0, "
        "the offsets may "
        "come from one waypoint instead",
        {{"offset_i", "[rad or m] of joint i, i from 0", true},
         {"amplitude_i", "[rad or m] of joint i", true},
         {"omega_i", "[rad/s] of joint i", true},
         {"phase_i", "[rad] of joint i", true}}},
       0,
       1,
       false,
       WaypointDerivatives::kNone,
       buildSinusoidal},
  };
}

const std::vector<Profile>& registry() {
  static const std::vector<Profile> profiles = [] {
    std::vector<Profile> all = singleMoves();
    for (auto& profile : otherProfiles()) all.push_back(profile);
    return all;
  }();
  return profiles;
}

}  // namespace

std::vector<ProfileInfo> listProfiles() {
  std::vector<ProfileInfo> infos;
  for (const auto& profile : registry()) infos.push_back(profile.info);
  return infos;
}

const Profile& findProfile(const std::string& name) {
  std::string known;
  for (const auto& profile : registry()) {
    if (profile.info.name == name) return profile;
    known += (known.empty() ? "" : ", ") + profile.info.name;
  }
  throw InputError(ErrorCode::kUnknownProfile, "profile '" + name + "' is unknown; known are " + known);
}

}  // namespace screwline
