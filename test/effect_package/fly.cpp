// fly SCENE SECONDS: prints the end of a flight, a line a body: name, orientation x y z w.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <rigid_body_sim/simulator.hpp>

int main(int count, char** words) try {
  if (count != 3) return 2;
  rigid_body_sim::Simulator simulator(rigid_body_sim::readSceneFile(words[1]));
  const double end_s = std::atof(words[2]);
  while (simulator.time_s() < end_s - 0.5 * simulator.scene().step_s()) simulator.step();
  for (Eigen::Index i = 0; i < simulator.bodies().count(); ++i) {
    const Eigen::Vector4d q = simulator.linkMotion(i).q_WL.coeffs();
    std::printf("%s %.17g %.17g %.17g %.17g\n", simulator.scene().bodies[i].name.c_str(), q(0),
                q(1), q(2), q(3));
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
