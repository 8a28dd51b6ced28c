#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim::reference {

/// What somebody else published of a case.
struct Published {
  double time_s;             ///< [s]
  Quaterniond q_B0B;         ///< attitude relative to the start
  Vector3d w_WB_B;           ///< [rad/s]
  double attitude_rounding;  ///< of the printed digits [rad]
  double rate_rounding;      ///< of the printed digits [rad/s]
};

/// A torque-free body and how it starts to turn.
struct Case {
  std::string name;
  double mass;        ///< [kg]
  Vector3d I_BBcm_B;  ///< principal moments, ascending [kg m^2]
  Vector3d w_WB_B;    ///< [rad/s]
  std::string source;
  std::optional<Published> published = std::nullopt;
};

/// All cases.
const std::vector<Case>& cases();

/// The case with this name. @throws std::invalid_argument if there is none.
const Case& caseNamed(const std::string& name);

}  // namespace rigid_body_sim::reference
