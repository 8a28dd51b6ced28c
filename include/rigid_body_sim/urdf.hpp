#pragma once

#include <string>
#include <vector>

#include "rigid_body_sim/mass_properties.hpp"

namespace rigid_body_sim {

/// A frame fixed to a body.
struct FixedFrame {
  std::string name;
  Isometry3d X_LF = Isometry3d::Identity();  ///< pose in the body's root link frame
};

/// A body as a URDF gives it: a root link and all that hangs on it by fixed (or locked) joints.
struct UrdfBody {
  std::string name;                ///< of its root link
  MassProperties mass_properties;  ///< of the whole lump, in the root link frame L
  std::vector<FixedFrame> frames;  ///< the lumped child links
  Isometry3d X_ML =
      Isometry3d::Identity();  ///< pose of L in the model's root frame, all joints at zero
};

/// What a model holds, and all that a user should know about how it was read.
struct UrdfModel {
  std::string name;
  std::vector<UrdfBody> bodies;
  std::vector<std::string> warnings;  ///< one line each: link, rule, numbers
};

/// What to do with joints other than fixed and floating.
enum class MovableJoints {
  kRefuse,
  kLock,  ///< frozen at zero, as if fixed
};

/// Reads the bodies of a URDF text.
/// One body is the root link lumped with all that hangs on it by fixed joints; a floating joint
/// starts a further body. A massless root link named `world` is a frame, not a body: each child of
/// it starts a body, by whatever joint.
/// Far stricter than the URDF parser, which reads a malformed number as zero: refused are numbers
/// that are not plain decimals, repeated and missing elements, unknown attributes of inertials and
/// poses, loops, and texts over 16 MiB, 10,000 links, 64 levels or 256 attributes an element.
/// A lump must be a possible rigid body (see invalidity); a single link of one is only warned of.
/// Safe to call from several threads. While it runs, console_bridge's output handler is replaced.
/// @param source names the text in messages (a file, a parameter).
/// @throws std::invalid_argument with one line that names source, link (or joint) and rule.
UrdfModel readUrdf(const std::string& text, const std::string& source,
                   MovableJoints movable = MovableJoints::kRefuse);

/// Reads the file, then as readUrdf. @throws std::invalid_argument also for an unreadable file.
UrdfModel readUrdfFile(const std::string& path, MovableJoints movable = MovableJoints::kRefuse);

/// The import report: per body total mass, centre of mass, tensor, principal moments and axes,
/// lumped frames, and every warning. Ends with a newline.
std::string importReport(const UrdfModel& model);

/// Throws unless `name` can be a frame and a topic: [A-Za-z][A-Za-z0-9_/-]*, at most 255
/// characters, with no empty part before, between or after slashes. `what` begins the message.
/// @throws std::invalid_argument
void requireName(const std::string& name, const std::string& what);

}  // namespace rigid_body_sim
