// A hundred million torque-free steps: 23 days at 0.02 s.
#include "integrator_laws.hpp"

namespace rigid_body_sim {
namespace {

struct LongFlight {
  const char* name;
  Vector3d I_BBcm_B;
  Vector3d w_WB_B;
  Quaterniond end;  // from long_flight_reference.py
};

TEST(LongFlight, OfAHundredMillionStepsEndsWhereItShould) {
  const int steps = 100'000'000;
  for (const LongFlight& one :
       {LongFlight{"tumbling",
                   {1, 2, 3},
                   {0.125, 5, 0.125},
                   {0.2920980544352864041, -0.6519500285936585697, 0.6292557372628982339,
                    0.3060671559210079980}},
        LongFlight{"stone",
                   {1, 1.25, 2},
                   {1.125, -2.25, 0.75},
                   {0.4694300778530245152, -0.5858338901936969969, -0.5918329427464058237,
                    -0.2935435623336886758}}}) {
    Bodies bodies(1);
    bodies.mass(0) = 1;
    bodies.I_BBcm_B.row(0) = one.I_BBcm_B;
    BodyState start;
    start.q_WB = Quaterniond(0.5, -0.5, 0.5, 0.5);
    start.L_WBcm_W = start.q_WB * one.I_BBcm_B.cwiseProduct(one.w_WB_B);  // exact: powers of two
    bodies.setState(0, start);
    const double E = energy(bodies);
    const auto integrator = integratorNamed("exact").make({});
    ActiveEffects none;
    for (int i = 0; i < steps; ++i) integrator->step(bodies, none, 0, 0.02);
    const BodyState end = bodies.state(0);
    const double angle = angleBetween(end.q_WB, one.end);
    RecordProperty(std::string(one.name) + "_attitude", std::to_string(angle * 1e9) + "e-9");
    EXPECT_TRUE(sameBits(end.L_WBcm_W, start.L_WBcm_W)) << one.name;
    EXPECT_NEAR(energy(bodies) / E, 1, 1e-14) << one.name;
    // 1e7 radians: the rounding of any constant of the motion turns it by 1e-9 rad.
    EXPECT_LE(angle, 1e-8) << one.name;
  }
}

}  // namespace
}  // namespace rigid_body_sim
