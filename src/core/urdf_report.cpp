#include <iomanip>
#include <locale>
#include <ostream>
#include <sstream>

#include "rigid_body_sim/urdf.hpp"

namespace rigid_body_sim {
namespace {

constexpr int kDigits = 7;
constexpr int kNumberWidth = 15;  // sign, digits, point, e-300 and a blank
constexpr int kLabelWidth = 26;

std::ostream& label(std::ostream& out, const char* text) {
  return out << "  " << std::left << std::setw(kLabelWidth) << text << std::right;
}

template <typename Vector>
void writeRow(std::ostream& out, const Vector& values) {
  // + 0.0 turns -0 into 0
  for (Eigen::Index i = 0; i < values.size(); ++i)
    out << std::setw(kNumberWidth) << values[i] + 0.0;
  out << '\n';
}

void writeMatrix(std::ostream& out, const char* text, const Matrix3d& matrix) {
  for (int i = 0; i < 3; ++i) writeRow(label(out, i == 0 ? text : ""), Vector3d(matrix.row(i)));
}

/// Of q and -q, the same rotation, the one with w >= 0; as x, y, z, w.
Eigen::Vector4d coefficients(const Quaterniond& q) { return q.w() < 0 ? -q.coeffs() : q.coeffs(); }

void writePose(std::ostream& out, const Isometry3d& X) {
  writeRow(label(out, "  position [m]"), Vector3d(X.translation()));
  writeRow(label(out, "  quaternion xyzw"), coefficients(Quaterniond(X.linear())));
}

void writeBody(std::ostream& out, const UrdfBody& body) {
  const MassProperties& properties = body.mass_properties;
  const PrincipalInertia principal = principalInertia(properties.I_BBcm_F);
  out << "\nbody '" << body.name << "', in the frame of its root link; inertia about its CoM\n";
  writeRow(label(out, "mass [kg]"), Eigen::Matrix<double, 1, 1>(properties.mass));
  writeRow(label(out, "CoM [m]"), properties.p_FBcm);
  writeMatrix(out, "inertia [kg m^2]", properties.I_BBcm_F);
  writeRow(label(out, "principal moments [kg m^2]"), principal.I_BBcm_B);
  writeMatrix(out, "principal axes (columns)", principal.q_FB.toRotationMatrix());
  writeRow(label(out, "  quaternion xyzw"), coefficients(principal.q_FB));
  out << "  pose in the model\n";
  writePose(out, body.X_ML);
  for (const FixedFrame& frame : body.frames) {
    out << "  lumped link '" << frame.name << "'\n";
    writePose(out, frame.X_LF);
  }
}

}  // namespace

std::string importReport(const UrdfModel& model) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(kDigits);
  out << "model '" << model.name << "': bodies " << model.bodies.size() << ", warnings "
      << model.warnings.size() << '\n';
  for (const UrdfBody& body : model.bodies) writeBody(out, body);
  if (!model.warnings.empty()) out << "\nwarnings\n";
  for (const std::string& warning : model.warnings) out << "  " << warning << '\n';
  return out.str();
}

}  // namespace rigid_body_sim
