// Several nodes push one body: real processes, each with a name of its own.
//   publishers_test --push NAME TOPIC   is one of them; it publishes what it reads from its input

#include <rosgraph_msgs/Log.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "probe_inputs.hpp"

namespace rigid_body_sim {
namespace {

const Vector3d kForce(2.1, -1.4, 0.9);
const Vector3d kTorque(-0.3, 0.5, 0.2);
constexpr int kTimeoutTicks = 50;  // wrench_timeout_s is 1 s

/// A node of its own that publishes wrenches on the probe.
class Pusher {
 public:
  Pusher(Sim& sim, const std::string& name) : sim_(sim) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      for (int fd = 3; fd < 1024; ++fd) close(fd);  // the sockets of this process
      execl("/proc/self/exe", "publishers_test", "--push", name.c_str(), kTopic, nullptr);
      _exit(127);
    }
    close(ends[0]);
    input_ = fdopen(ends[1], "w");
    api_ = std::make_unique<NodeApi>("/" + name);
    need("its connection", [&] { return api_->sends(kTopic, sim_.node()); });
  }
  Pusher(const Pusher&) = delete;
  Pusher& operator=(const Pusher&) = delete;

  ~Pusher() {
    std::fclose(input_);  // the end of its input ends it
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }

  /// Publishes `factor` times force and torque, in world axes. The node acts upon it in the next
  /// step: the message is on the node's socket, so that the node has read it before it has read a
  /// service call of later, and queued it before a call that comes after that one's answer.
  void push(double factor) {
    const int before = api_->sent(kTopic);
    std::fprintf(input_, "%.17g\n", factor);
    std::fflush(input_);
    need("a push", [&] { return api_->sent(kTopic) > before; });
    sim_.pause();
  }

  /// No farewell: nothing is unregistered.
  void kill9() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  static constexpr char kTopic[] = "/probe/wrench";
  Sim& sim_;
  pid_t process_ = 0;
  std::FILE* input_ = nullptr;
  std::unique_ptr<NodeApi> api_;
};

class Publishers : public NodeTest {
 protected:
  void expectGiven(const BodyStates& states, double factor) {
    expectMomentum(momentumOf(body, states),
                   momentumAtStart(body) + factor * Momentum{kForce, kTorque});
  }

  const Solid body = probe();
};

TEST_F(Publishers, ThreeNodesPushingOneBodyAddUpAndEachReplacesOnlyItsOwn) {
  Pusher alpha(sim, "alpha"), beta(sim, "beta"), gamma(sim, "gamma");
  alpha.push(1);
  beta.push(10);
  gamma.push(100);
  expectGiven(sim.step(10), 1110 * kStep_s);
  beta.push(20);
  expectGiven(sim.step(10), (1110 + 1210) * kStep_s);
  gamma.push(0);
  expectGiven(sim.step(10), (1110 + 1210 + 210) * kStep_s);
}

TEST_F(Publishers, TheWrenchOfAKilledNodeEndsAfterTheTimeoutWithOneLine) {
  Recording<rosgraph_msgs::Log> log(sim, "/rosout");
  Pusher alpha(sim, "alpha"), doomed(sim, "doomed");
  alpha.push(1);
  doomed.push(10);
  expectGiven(sim.step(5), 55 * kStep_s);
  doomed.kill9();
  expectGiven(sim.step(25), 330 * kStep_s);
  alpha.push(1);
  expectGiven(sim.step(20), 550 * kStep_s);  // tick 50, the doomed one's last
  EXPECT_TRUE(log.messages.empty()) << log.messages[0].msg;
  expectGiven(sim.step(), 551 * kStep_s);
  expectGiven(sim.step(20), 571 * kStep_s);
  log.expect(1);
  EXPECT_EQ(log.messages.size(), 1u);
  EXPECT_NE(log.messages[0].msg.find("probe/wrench from /doomed"), std::string::npos)
      << log.messages[0].msg;
  expectGiven(sim.step(100), (500 + 30 + kTimeoutTicks) * kStep_s);
}

// Factors of which no two sums in different orders round alike.
TEST_F(Publishers, TheOrderInWhichTheyArriveChangesNoBit) {
  Pusher alpha(sim, "alpha"), beta(sim, "beta"), gamma(sim, "gamma");
  std::vector<std::pair<Pusher*, double>> pushes = {
      {&alpha, 0.1}, {&beta, 1e3 / 3}, {&gamma, -333.3}};
  std::sort(pushes.begin(), pushes.end());
  std::vector<BodyStates> results;
  do {
    sim.reset();
    for (const auto& one : pushes) one.first->push(one.second);
    results.push_back(sim.step(7));
  } while (std::next_permutation(pushes.begin(), pushes.end()));
  ASSERT_EQ(results.size(), 6u);
  for (const BodyStates& one : results) EXPECT_TRUE(sameBits(one, results[0]));
}

TEST_F(Publishers, WithATimeoutOfZeroAWrenchNeverEnds) {
  Sim patient("/patient/sim");
  Input<WrenchStamped> wrench(patient, "/patient/probe/wrench");
  wrench.send(wrenchIn("world", kForce, kTorque));
  // A minute; 6,000 half kicks round to half an ulp each, 7e-13 of the sum at worst.
  expectGiven(patient.step(3000), 3000 * kStep_s);
}

TEST_F(Publishers, TenThousandImpulsesASecondAreAllTakenWhileItRuns) {
  Input<ImpulseStamped> impulse(sim, "/probe/impulse");
  impulse.send(impulseIn("world", Vector3d::Zero()));  // connected
  const int before = sim.api.received("/probe/impulse");
  const std::uint64_t accepted = sim.diagnostics().count("inputs accepted");
  Recording<BodyStates> states(sim, "/states");
  constexpr int kATick = 200, kCount = 10'000;  // 20 ms a tick
  int sent = 0;
  states.on_message = [&] {
    for (int i = 0; i < kATick && sent < kCount; ++i, ++sent)
      impulse.publisher().publish(impulseIn("world", 1e-3 * kForce, 1e-3 * kTorque));
  };
  sim.unpause();
  need("all to arrive", [&] { return sim.api.received("/probe/impulse") == before + kCount; });
  sim.pause();
  states.on_message = nullptr;
  const Momentum momentum = momentumOf(body, sim.step());
  const Momentum wanted = momentumAtStart(body) + 1e-3 * kCount * Momentum{kForce, kTorque};
  // Ten thousand additions of the same number, half an ulp each at worst.
  EXPECT_LE((momentum.P_WB - wanted.P_WB).norm(), kCount * 1.2e-16 * wanted.P_WB.norm());
  EXPECT_LE((momentum.L_WBcm_W - wanted.L_WBcm_W).norm(),
            kCount * 1.2e-16 * wanted.L_WBcm_W.norm());
  sim.diagnostics(
      [&](const Status& now) { return now.count("inputs accepted") == accepted + kCount; });
}

int push(int argc, char** argv) {
  ros::init(argc, argv, argv[2], ros::init_options::NoSigintHandler);
  ros::NodeHandle nh;
  ros::Publisher publisher = nh.advertise<WrenchStamped>(argv[3], 10);
  need("the simulator", [&] { return publisher.getNumSubscribers() > 0; });
  for (double factor; std::cin >> factor;)
    publisher.publish(wrenchIn("world", factor * kForce, factor * kTorque));
  return 0;
}

}  // namespace
}  // namespace rigid_body_sim

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--push") return rigid_body_sim::push(argc, argv);
  return rigid_body_sim::runRostest(argc, argv, "publishers_test");
}
