#include "rigid_body_sim/urdf.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <exception>
#include <fstream>
#include <locale>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/urdf_check.hpp"
#include "core/urdf_prescan.hpp"

namespace rigid_body_sim {
namespace {

constexpr std::size_t kMaxName = 255;

/// Catches what the URDF parser logs while this lives; other threads' messages pass through.
class ParserLog : public console_bridge::OutputHandler {
 public:
  ParserLog() : previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~ParserLog() override { console_bridge::useOutputHandler(previous_); }
  ParserLog(const ParserLog&) = delete;
  ParserLog& operator=(const ParserLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* file,
           int line) override {
    if (std::this_thread::get_id() != owner_) {
      if (previous_ != nullptr) previous_->log(text, level, file, line);
    } else if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN) {
      messages_.push_back(oneLine(text, 200));
    }
  }

  const std::vector<std::string>& messages() const { return messages_; }

 private:
  console_bridge::OutputHandler* previous_;
  std::thread::id owner_ = std::this_thread::get_id();
  std::vector<std::string> messages_;
};

/// The URDF parser logs attribute values as printf formats: radius="%s%n" crashes it. '&' goes
/// too, "&#37;" being '%'. Neither can be in a link's name or in a number.
std::string withoutFormats(std::string text) {
  for (char& c : text)
    if (c == '%' || c == '&') c = '?';
  return text;
}

/// Parses a text that checkUrdf let pass, and appends what the parser warned of.
urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& source,
                                    std::vector<std::string>& warnings) {
  static std::mutex one_at_a_time;  // console_bridge has one handler for the whole process
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const ParserLog log;
  urdf::ModelInterfaceSharedPtr model;
  std::string why;
  try {
    model = urdf::parseURDF(withoutFormats(text));
  } catch (const std::exception& error) {
    why = " " + oneLine(error.what(), 200);
  }
  if (!model || !model->getRoot()) {
    for (const std::string& message : log.messages()) why += " " + message;
    throw std::invalid_argument(source + ": refused by the URDF parser:" + oneLine(why, 500));
  }
  for (const std::string& message : log.messages()) warnings.push_back("URDF parser: " + message);
  return model;
}

Isometry3d toIsometry(const urdf::Pose& pose) {
  const urdf::Vector3& p = pose.position;
  const urdf::Rotation& q = pose.rotation;
  Isometry3d X = Isometry3d::Identity();
  X.linear() = Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  X.translation() = Vector3d(p.x, p.y, p.z);
  return X;
}

/// In the link's frame; zero mass if the link has no inertial.
MassProperties massPropertiesOf(const urdf::Link& link) {
  if (!link.inertial) return {};
  const urdf::Inertial& inertial = *link.inertial;
  MassProperties body;
  body.mass = inertial.mass;
  body.I_BBcm_F << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,               //
      inertial.ixz, inertial.iyz, inertial.izz;
  return expressedIn(toIsometry(inertial.origin), body);
}

std::string typeName(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return "revolute";
    case urdf::Joint::CONTINUOUS:
      return "continuous";
    case urdf::Joint::PRISMATIC:
      return "prismatic";
    case urdf::Joint::PLANAR:
      return "planar";
    case urdf::Joint::FLOATING:
      return "floating";
    case urdf::Joint::FIXED:
      return "fixed";
    default:
      return "unknown";
  }
}

/// As a message shows it and a user types it again: to nine digits, well below invalidity's slack.
double toNineDigits(double number) {
  std::stringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << number;
  text >> number;
  return number;
}

/// The suggestion after a broken tensor; empty if there is none that would pass.
std::string suggestion(MassProperties body) {
  if (!(body.mass > 0) || !body.p_FBcm.allFinite() || !body.I_BBcm_F.allFinite()) return {};
  const Matrix3d nearest = nearestValidInertia(body.I_BBcm_F).unaryExpr(&toNineDigits);
  body.I_BBcm_F = nearest.selfadjointView<Eigen::Upper>();
  if (!invalidity(body).empty()) return {};
  const Matrix3d& I = body.I_BBcm_F;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(9);
  text << "; nearest valid tensor about the centre of mass, in link axes: ixx=" << I(0, 0)
       << " ixy=" << I(0, 1) << " ixz=" << I(0, 2) << " iyy=" << I(1, 1) << " iyz=" << I(1, 2)
       << " izz=" << I(2, 2);
  return text.str();
}

/// Why a link on its own is no rigid body; a lump may still be one.
std::string oddity(const MassProperties& link) {
  const bool is_point = link.I_BBcm_F.isZero(0);
  if (link.mass == 0) return is_point ? "" : "mass is 0: its inertia tensor is ignored";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  if (is_point) {
    text << "inertia tensor is zero: taken as a point mass of " << link.mass << " kg";
    return text.str();
  }
  return invalidity(link);
}

/// Walks the tree without recursion: a chain may be 10,000 links long.
class Lumper {
 public:
  Lumper(const urdf::ModelInterface& model, const std::string& source, MovableJoints movable,
         UrdfModel& result)
      : model_(model), source_(source), movable_(movable), result_(result) {}

  void run() {
    const urdf::LinkConstSharedPtr root = model_.getRoot();
    const bool is_frame = root->name == "world" && massPropertiesOf(*root).mass == 0;
    if (is_frame)
      startChildren(*root);
    else
      starts_.push_back({root, Isometry3d::Identity()});
    if (starts_.empty())
      throw std::invalid_argument(source_ + ": link 'world': a frame with no body on it");
    for (; !starts_.empty(); starts_.pop_front()) readBody(starts_.front());
  }

 private:
  struct PlacedLink {
    urdf::LinkConstSharedPtr link;
    Isometry3d X;  ///< in the model's root frame or, inside a lump, in its root link
  };

  PlacedLink childOf(const urdf::Joint& joint, const Isometry3d& X) const {
    const PlacedLink child = {model_.getLink(joint.child_link_name),
                              X * toIsometry(joint.parent_to_joint_origin_transform)};
    if (!child.X.matrix().allFinite())
      throw std::invalid_argument(source_ + ": joint '" + oneLine(joint.name) +
                                  "': origins add up to more than a double can hold");
    return child;
  }

  void warn(const std::string& kind, const std::string& name, const std::string& why) {
    result_.warnings.push_back(kind + " '" + oneLine(name) + "': " + why);
  }

  /// Throws for a joint that moves, or warns that it is locked.
  void requireLockable(const urdf::Joint& joint) {
    if (joint.type == urdf::Joint::FIXED || joint.type == urdf::Joint::FLOATING) return;
    if (movable_ == MovableJoints::kRefuse)
      throw std::invalid_argument(source_ + ": joint '" + oneLine(joint.name) + "': is " +
                                  typeName(joint) +
                                  ", only fixed and floating joints are simulated (or lock them)");
    warn("joint", joint.name, "is " + typeName(joint) + ", locked at zero");
  }

  void startChildren(const urdf::Link& world) {
    for (const auto& joint : world.child_joints) {
      requireLockable(*joint);
      if (joint->type != urdf::Joint::FLOATING)
        warn("joint", joint->name,
             "holds nothing: 'world' is a frame, and body '" + joint->child_link_name +
                 "' moves freely from there");
      starts_.push_back(childOf(*joint, Isometry3d::Identity()));
    }
  }

  void readBody(const PlacedLink& start) {
    std::vector<PlacedLink> lump = {{start.link, Isometry3d::Identity()}};
    for (std::size_t i = 0; i < lump.size(); ++i) {
      const PlacedLink parent = lump[i];
      for (const auto& joint : parent.link->child_joints) {
        requireLockable(*joint);
        if (joint->type == urdf::Joint::FLOATING)
          starts_.push_back(childOf(*joint, start.X * parent.X));
        else
          lump.push_back(childOf(*joint, parent.X));
      }
    }
    UrdfBody body;
    body.name = start.link->name;
    body.X_ML = start.X;
    for (std::size_t i = 1; i < lump.size(); ++i)
      body.frames.push_back({lump[i].link->name, lump[i].X});
    body.mass_properties = massPropertiesOfLump(lump);
    requireValid(body);
    result_.bodies.push_back(std::move(body));
  }

  MassProperties massPropertiesOfLump(const std::vector<PlacedLink>& lump) {
    std::vector<MassProperties> parts;
    for (const PlacedLink& part : lump) {
      parts.push_back(expressedIn(part.X, massPropertiesOf(*part.link)));
      if (lump.size() == 1) break;  // requireValid says it better
      const std::string why = oddity(parts.back());
      if (!why.empty()) warn("link", part.link->name, why);
    }
    MassProperties body = combined(parts);
    // R I R^T is symmetric only to rounding.
    body.I_BBcm_F = 0.5 * (body.I_BBcm_F + Matrix3d(body.I_BBcm_F.transpose()));
    return body;
  }

  void requireValid(const UrdfBody& body) const {
    const std::string why = invalidity(body.mass_properties);
    if (why.empty()) return;
    const std::string lumped =
        body.frames.empty() ? "" : " with " + std::to_string(body.frames.size()) + " lumped links";
    throw std::invalid_argument(source_ + ": link '" + body.name + "'" + lumped + ": " + why +
                                suggestion(body.mass_properties));
  }

  const urdf::ModelInterface& model_;
  const std::string& source_;
  MovableJoints movable_;
  UrdfModel& result_;
  std::deque<PlacedLink> starts_;
};

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool isNameCharacter(char c) {
  return isLetter(c) || (c >= '0' && c <= '9') || c == '_' || c == '/' || c == '-';
}

}  // namespace

UrdfModel readUrdf(const std::string& text, const std::string& source, MovableJoints movable) {
  const std::string shown_source = oneLine(source, std::string::npos);
  checkUrdf(scanXml(text, shown_source), shown_source);
  UrdfModel result;
  const urdf::ModelInterfaceSharedPtr model = parse(text, shown_source, result.warnings);
  result.name = oneLine(model->getName());
  Lumper(*model, shown_source, movable, result).run();
  return result;
}

UrdfModel readUrdfFile(const std::string& path, MovableJoints movable) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    text.resize(kMaxUrdfBytes + 1);  // one more than allowed: readUrdf refuses it
    file.read(&text[0], static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
  }
  if (!file.is_open() || file.bad())
    throw std::invalid_argument(oneLine(path, std::string::npos) +
                                ": cannot be read: " + std::strerror(errno));
  return readUrdf(text, path, movable);
}

void requireName(const std::string& name, const std::string& what) {
  const bool is_valid = !name.empty() && name.size() <= kMaxName && isLetter(name.front()) &&
                        std::all_of(name.begin(), name.end(), isNameCharacter) &&
                        name.back() != '/' && name.find("//") == std::string::npos;
  if (is_valid) return;
  throw std::invalid_argument(
      what + " '" + oneLine(name) +
      "': a name must begin with a letter, go on with letters, digits, _, - "
      "and single inner /, and have at most " +
      std::to_string(kMaxName) + " characters");
}

}  // namespace rigid_body_sim
