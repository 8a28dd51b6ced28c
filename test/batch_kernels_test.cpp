// The batch kernels give the same bits whatever the instruction set, the number of bodies, and
// their place among them.
#include <cfenv>
#include <cstdlib>
#include <functional>

#include "batch_bodies.hpp"
#include "integrators/batch/kernels.hpp"
#include "reference/free_rotation.hpp"

namespace rigid_body_sim::batch {
namespace {

/// Some steps of one kind.
struct Work {
  std::string name;
  std::function<void(const Kernels&, Bodies&, const Pushes&, double h, Range)> steps;
};

void PrintTo(const Work& work, std::ostream* out) { *out << work.name; }

constexpr int kSteps = 5;

Work repeated(const std::string& name,
              const std::function<void(const Kernels&, const BodyColumns&, const WrenchColumns&,
                                       double, Range)>& step) {
  return {name, [step](const Kernels& k, Bodies& bodies, const Pushes& pushes, double h, Range r) {
            for (int i = 0; i < kSteps; ++i) step(k, columnsOf(bodies), columnsOf(pushes), h, r);
          }};
}

void rk4Steps(Kernels::Rk4Stage stage_of, Bodies& bodies, const Pushes& pushes, double h,
              Range range) {
  Bodies stages(bodies.count());
  std::vector<double> tiles(tileSize(bodies.count(), kRk4Numbers));
  for (int i = 0; i < kSteps; ++i)
    for (int stage = 0; stage < 4; ++stage)
      stage_of(columnsOf(bodies), columnsOf(stages), columnsOf(pushes), tiles.data(), stage, h,
               range);
}

/// Kicks now and then, so that bodies go from coasting to kicks and back.
void spinSteps(const Kernels& k, Bodies& bodies, const Pushes& pushes, double h, Range range) {
  std::vector<double> tiles(tileSize(bodies.count(), kSpinNumbers));
  for (int i = 0; i < 12; ++i) {
    if (i < 2 || i == 8)
      k.kickSpins(columnsOf(bodies), columnsOf(pushes), tiles.data(), 0.5 * h, range);
    k.driftSpins(columnsOf(bodies), tiles.data(), i == 10 ? 2 * h : h, range);
  }
}

/// The same in one pass, or part by part; with no kick at the end now and then.
template <bool at_once>
void flownSpins(const Kernels& k, Bodies& bodies, const Pushes& pushes, double h, Range range) {
  std::vector<double> tiles(tileSize(bodies.count(), kSpinNumbers));
  const BodyColumns columns = columnsOf(bodies);
  const WrenchColumns wrenches = columnsOf(pushes);
  for (int i = 0; i < 12; ++i) {
    const double before_s = 0.3 * h, after_s = i % 5 == 3 ? 0 : 0.5 * h;
    if (at_once) {
      k.flySpins(columns, wrenches, tiles.data(), before_s, h, after_s, range);
      continue;
    }
    k.kickSpins(columns, wrenches, tiles.data(), before_s, range);
    k.driftSpins(columns, tiles.data(), h, range);
    if (after_s != 0) k.kickSpins(columns, wrenches, tiles.data(), after_s, range);
  }
}

std::vector<Work> works() {
  return {
      repeated("Kick", [](auto& k, auto& b, auto& w, double h, Range r) { k.kick(b, w, h, r); }),
      repeated("Positions",
               [](auto& k, auto& b, auto&, double h, Range r) { k.driftPositions(b, h, r); }),
      repeated("ConstantRate", [](auto& k, auto& b, auto&, double h,
                                  Range r) { k.driftAtConstantRate(b, nullptr, h, r); }),
      repeated("KickAndConstantRate", [](auto& k, auto& b, auto& w, double h,
                                         Range r) { k.driftAtConstantRate(b, &w, h, r); }),
      repeated("Splitting", [](auto& k, auto& b, auto& w, double h,
                               Range r) { k.driftBySplitting(b, &w, h, r); }),
      repeated("NoGyroscopicTerm", [](auto& k, auto& b, auto&, double h,
                                      Range r) { k.driftWithoutGyroscopicTerm(b, h, r); }),
      repeated("Rk4Free",
               [](auto& k, auto& b, auto&, double h, Range r) { k.rk4Steady(b, nullptr, h, r); }),
      repeated("Rk4FreeNoGyroscopicTerm",
               [](auto& k, auto& b, auto&, double h, Range r) {
                 k.rk4SteadyWithoutGyroscopicTerm(b, nullptr, h, r);
               }),
      repeated("Rk4Steady",
               [](auto& k, auto& b, auto& w, double h, Range r) { k.rk4Steady(b, &w, h, r); }),
      repeated("Rk4SteadyNoGyroscopicTerm",
               [](auto& k, auto& b, auto& w, double h, Range r) {
                 k.rk4SteadyWithoutGyroscopicTerm(b, &w, h, r);
               }),
      {"Rk4",
       [](auto& k, auto& b, auto& w, double h, Range r) { rk4Steps(k.rk4Stage, b, w, h, r); }},
      {"Rk4WithVelocity", [](auto& k, auto& b, auto& w, double h,
                             Range r) { rk4Steps(k.rk4StageWithVelocity, b, w, h, r); }},
      {"Rk4NoGyroscopicTerm",
       [](auto& k, auto& b, auto& w, double h, Range r) {
         rk4Steps(k.rk4StageWithoutGyroscopicTerm, b, w, h, r);
       }},
      {"Spins", spinSteps},
      {"FlownSpins", flownSpins<true>},
  };
}

class BatchKernels : public testing::TestWithParam<Work> {
 protected:
  static Bodies after(const Kernels& k, Bodies bodies, const Pushes& pushes, double h = 0.02) {
    GetParam().steps(k, bodies, pushes, h, {0, bodies.count()});
    return bodies;
  }
};

TEST_P(BatchKernels, GiveTheSameBitsWithEveryInstructionSet) {
  for (Eigen::Index count = 1; count <= 33; ++count)
    for (const double h : {0.02, -0.7}) {
      const Bodies start = someBodies(count, 5 * count);
      const Pushes pushes = somePushes(count, 5 * count);
      const Bodies plain = after(availableKernels().front(), start, pushes, h);
      for (const Kernels& k : availableKernels())
        ASSERT_TRUE(sameNumbers(after(k, start, pushes, h), plain)) << k.name << " " << count;
    }
}

TEST_P(BatchKernels, GiveABodyTheSameBitsAloneAndInACrowd) {
  constexpr Eigen::Index kCount = 150;
  for (const Kernels& k : availableKernels()) {
    const Bodies crowd = after(k, someBodies(kCount), somePushes(kCount));
    for (Eigen::Index i = 0; i < kCount; ++i) {
      const Bodies alone = after(k, someBodies(1, i), somePushes(1, i));
      const BodyState a = alone.state(0), b = crowd.state(i);
      ASSERT_TRUE(sameNumbers(a.p_WBcm, b.p_WBcm) &&
                  sameNumbers(a.q_WB.coeffs(), b.q_WB.coeffs()) && sameNumbers(a.P_WB, b.P_WB) &&
                  sameNumbers(a.L_WBcm_W, b.L_WBcm_W))
          << k.name << " " << i;
    }
  }
}

TEST_P(BatchKernels, LeaveBodiesOutsideTheRangeAlone) {
  for (const Kernels& k : availableKernels())
    for (const Range range : {Range{8, 19}, Range{16, 17}, Range{24, 40}, Range{8, 8}}) {
      const Bodies start = someBodies(40);
      const Pushes pushes = somePushes(40);
      Bodies some = start;
      GetParam().steps(k, some, pushes, 0.02, range);
      const Bodies all = after(k, start, pushes);
      for (Eigen::Index i = 0; i < 40; ++i) {
        const BodyState is = some.state(i);
        const BodyState should = (i >= range.begin && i < range.end ? all : start).state(i);
        ASSERT_TRUE(sameNumbers(is.p_WBcm, should.p_WBcm) && sameNumbers(is.P_WB, should.P_WB) &&
                    sameNumbers(is.q_WB.coeffs(), should.q_WB.coeffs()) &&
                    sameNumbers(is.L_WBcm_W, should.L_WBcm_W))
            << k.name << " " << i;
      }
    }
}

TEST(Rk4Steady, HasTheBitsOfItsStages) {
  constexpr Eigen::Index kCount = 150;
  const Bodies start = someBodies(kCount);
  Pushes forces = somePushes(kCount);
  forces.t_Bcm_W.setZero();
  for (const Kernels& k : availableKernels())
    for (const Pushes& pushes : {somePushes(kCount), forces})
      for (const auto& [stages, whole] :
           {std::pair{k.rk4Stage, k.rk4Steady},
            std::pair{k.rk4StageWithoutGyroscopicTerm, k.rk4SteadyWithoutGyroscopicTerm}}) {
        Bodies by_stages = start, at_once = start;
        rk4Steps(stages, by_stages, pushes, 0.02, {0, kCount});
        const WrenchColumns wrenches = columnsOf(pushes);
        for (int i = 0; i < kSteps; ++i) whole(columnsOf(at_once), &wrenches, 0.02, {0, kCount});
        EXPECT_TRUE(sameNumbers(at_once, by_stages)) << k.name;
      }
}

TEST(FlownSpins, HaveTheBitsOfKickDriftAndKick) {
  constexpr Eigen::Index kCount = 150;
  for (const Kernels& k : availableKernels())
    for (const Eigen::Index turned : {kCount, Eigen::Index(70), Eigen::Index(0)}) {
      Pushes pushes = somePushes(kCount);
      pushes.t_Bcm_W.bottomRows(kCount - turned).setZero();
      Bodies at_once = someBodies(kCount), in_parts = at_once;
      flownSpins<true>(k, at_once, pushes, 0.02, {0, kCount});
      flownSpins<false>(k, in_parts, pushes, 0.02, {0, kCount});
      EXPECT_TRUE(sameNumbers(at_once, in_parts)) << k.name << " " << turned;
    }
}

TEST(FlownSpins, RaiseNoFloatingPointExceptionBesideEachOther) {
  // Spheres, bodies that spin about an axis, and fast ones in one pack: what is worked out for the
  // one is worked out, and dropped, for its neighbours.
  constexpr Eigen::Index kCount = 520;
  Bodies start = someBodies(kCount);
  Pushes pushes = somePushes(kCount);
  for (Eigen::Index i = 0; i < kCount; ++i) {
    if (!start.L_WBcm_W.row(i).allFinite()) start.L_WBcm_W.row(i).setOnes();
    if (start.I_BBcm_B(i, 0) < 1e100) continue;  // whose squares do overflow
    for (auto* columns : {&start.I_BBcm_B, &start.L_WBcm_W, &pushes.t_Bcm_W})
      columns->row(i) *= 1e-160;
  }
  for (const Kernels& k : availableKernels())
    for (const bool at_once : {false, true}) {
      Bodies bodies = start;
      std::feclearexcept(FE_ALL_EXCEPT);
      if (at_once)
        flownSpins<true>(k, bodies, pushes, 0.02, {0, kCount});
      else
        spinSteps(k, bodies, pushes, 0.02, {0, kCount});
      EXPECT_EQ(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), 0) << k.name;
    }
}

/// Bodies that all spin, so that all coast.
Bodies spinningBodies(Eigen::Index count) {
  Bodies bodies = someBodies(count);
  Sampler sample(5);
  for (Eigen::Index i = 0; i < count; ++i) {
    bodies.I_BBcm_B.row(i) = someMoments(sample, 0);
    bodies.L_WBcm_W.row(i) = sample.vector();
  }
  return bodies;
}

TEST(CoastingSpins, TakeUpTheOneThatSomebodyElseHasMoved) {
  constexpr Eigen::Index kCount = 32, kMoved = 11;
  for (const Kernels& k : availableKernels())
    for (const bool turns : {false, true}) {
      const auto drift = [&](Bodies& bodies, std::vector<double>& tiles) {
        tiles.resize(tileSize(kCount, kSpinNumbers));
        for (int i = 0; i < 6; ++i)
          k.driftSpins(columnsOf(bodies), tiles.data(), 0.02, {0, kCount});
      };
      Bodies moved = spinningBodies(kCount);
      std::vector<double> tiles, none;
      drift(moved, tiles);
      Bodies unmoved = moved;
      std::vector<double> tiles_of_unmoved = tiles;
      if (turns)
        moved.q_WB.row(kMoved) = moved.q_WB.row(kMoved + 1).eval();
      else
        moved.L_WBcm_W(kMoved, 2) += 0.5;
      Bodies anew = moved;
      drift(moved, tiles);
      drift(unmoved, tiles_of_unmoved);
      drift(anew, none);
      EXPECT_LT((moved.q_WB.row(kMoved) - anew.q_WB.row(kMoved)).norm(), 20 * kEps) << k.name;
      moved.q_WB.row(kMoved) = unmoved.q_WB.row(kMoved);
      EXPECT_TRUE(sameBits(moved.q_WB, unmoved.q_WB)) << k.name << turns;
    }
}

TEST(CoastingSpins, StandStillInNoTime) {
  for (const Kernels& k : availableKernels())
    for (const int steps : {0, 1, 2, 5}) {
      Bodies bodies = spinningBodies(20);
      std::vector<double> tiles(tileSize(20, kSpinNumbers));
      for (int i = 0; i < steps; ++i) k.driftSpins(columnsOf(bodies), tiles.data(), 0.02, {0, 20});
      Bodies flown = bodies;
      std::vector<double> tiles_of_flown = tiles;
      Pushes nothing(20);
      nothing.f_W.setZero();
      nothing.t_Bcm_W.setZero();
      k.driftSpins(columnsOf(bodies), tiles.data(), 0, {0, 20});
      k.flySpins(columnsOf(bodies), columnsOf(nothing), tiles.data(), 0, 0, 0, {0, 20});
      EXPECT_TRUE(sameBits(bodies.q_WB, flown.q_WB)) << k.name << " " << steps;
      k.driftSpins(columnsOf(bodies), tiles.data(), 0.02, {0, 20});
      k.driftSpins(columnsOf(flown), tiles_of_flown.data(), 0.02, {0, 20});
      EXPECT_TRUE(sameBits(bodies.q_WB, flown.q_WB)) << k.name << " " << steps;
    }
}

/// A torque takes all but a trace of the momentum away and brings it back, over and over: what
/// rounding has made of the momentum in the body's axes is then large beside the trace, and no
/// fault of the attitude. Of a sphere the attitude is known.
TEST(KickedSpins, KeepTheAttitudeWhereKicksTakeNearlyAllOfTheMomentum) {
  constexpr double kMoment = 1.3, h = 1.0 / 64;
  const Vector3d push(0.5, 0.25, 0.125), trace = std::ldexp(1, -12) * Vector3d(1, -1, 1);
  Bodies ball(1);
  ball.mass(0) = 1;
  ball.I_BBcm_B.row(0).setConstant(kMoment);
  ball.setState(0,
                {Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero(), 8.5 * push + trace});
  std::vector<double> tiles(tileSize(1, kSpinNumbers));
  Pushes pushes(1);
  pushes.f_W.setZero();
  reference::Quaternionr wanted = reference::Quaternionr::Identity();
  for (int i = 0; i < 20000; ++i) {
    const Vector3d impulse = i / 9 % 2 == 0 ? Vector3d(-push) : push;  // all sums are exact
    const reference::Vector3r L_W =
        (Vector3d(ball.L_WBcm_W.row(0)) + 0.5 * impulse).cast<reference::Real>();
    const reference::Vector3r turn = h * L_W / reference::Real(kMoment);
    wanted = Eigen::AngleAxis<reference::Real>(turn.norm(), turn.normalized()) * wanted;
    pushes.t_Bcm_W.row(0) = impulse / h;
    kernels().flySpins(columnsOf(ball), columnsOf(pushes), tiles.data(), h / 2, h, h / 2, {0, 1});
  }
  // Measured 4e-13, of twenty thousand rounded products; 5e-12 where the attitude took the blame.
  EXPECT_LT(angleBetween(ball.state(0).q_WB, wanted.cast<double>()), 1e-12);
}

/// The own spin of a thin rod is a millionth of its momentum: made anew from attitude and momentum
/// it would be as good as their roundings, a million times as large beside it.
TEST(KickedSpins, LeaveTheOwnSpinOfARod) {
  constexpr double h = 0.1;
  constexpr int kSteps = 200000;
  const Vector3d I(1e-6, 1, 1), m_B(1e-6, 0.7, -0.4);
  Bodies rod(1);
  rod.mass(0) = 1;
  rod.I_BBcm_B.row(0) = I;
  rod.setState(0, {Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero(), m_B});
  std::vector<double> tiles(tileSize(1, kSpinNumbers));
  Pushes pushes(1);
  pushes.f_W.setZero();
  pushes.t_Bcm_W.row(0) << 1e-60, 0, 0;  // so that it is turned step by step
  for (int i = 0; i < kSteps; ++i)
    kernels().flySpins(columnsOf(rod), columnsOf(pushes), tiles.data(), h / 2, h, h / 2, {0, 1});
  const reference::Rotation start = {Quaterniond::Identity(), m_B.cwiseQuotient(I)};
  const reference::Rotation wanted = reference::symmetricTop(I, start, h * kSteps);
  // It turns by 2e4 rad: measured 1e-9, and 4e-7 with the momentum made anew now and then.
  EXPECT_LT(angleBetween(rod.state(0).q_WB, wanted.q_WB), 1e-8);
}

TEST_P(BatchKernels, KeepTheAttitudeOfABodyWithoutSpinToTheBit) {
  Bodies start = someBodies(17);
  start.L_WBcm_W.setZero();
  start.q_WB.col(0) *= 1 + 1e-9;  // so that normalizing it would show
  Pushes pushes = somePushes(17);
  pushes.t_Bcm_W.setZero();
  for (const Kernels& k : availableKernels()) {
    const Bodies end = after(k, start, pushes);
    EXPECT_TRUE(sameBits(end.q_WB, start.q_WB)) << k.name;
    EXPECT_TRUE(sameBits(end.L_WBcm_W, start.L_WBcm_W)) << k.name;
  }
}

TEST_P(BatchKernels, AreFiniteForFiniteBodies) {
  for (Eigen::Index first = 0; first < 2000; first += 10) {  // ten without NaN
    const Eigen::Index k = first / 10 * 11;
    const Bodies end = after(kernels(), someBodies(10, k), somePushes(10, k));
    ASSERT_TRUE(end.q_WB.allFinite() && end.L_WBcm_W.allFinite()) << first;
    for (Eigen::Index i = 0; i < 10; ++i)
      ASSERT_NEAR(end.q_WB.row(i).norm(), 1, 4 * kEps) << first << " " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, BatchKernels, testing::ValuesIn(works()),
                         [](const auto& info) { return info.param.name; });

TEST(BatchKernelsTable, HasThePlainOneFirstAndAscends) {
  const std::vector<Kernels>& all = availableKernels();
  EXPECT_EQ(std::string(all.front().name), "plain");
  for (std::size_t i = 0; i + 1 < all.size(); ++i) EXPECT_LT(all[i].width, all[i + 1].width);
  if (!std::getenv("RIGID_BODY_SIM_KERNELS")) {
    EXPECT_EQ(kernels().width, all.back().width);
  }
}

}  // namespace
}  // namespace rigid_body_sim::batch
