// SPDX-License-Identifier: Apache-2.0
#include "robots/model/urdf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>
#include <Eigen/Eigenvalues>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

/// Keeps what urdfdom would print.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages() { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

urdf::ModelInterfaceSharedPtr parse(const std::filesystem::path& file) {
  static std::mutex one_at_a_time;  // urdfdom's messages go to one place for the whole process
  const std::scoped_lock lock(one_at_a_time);
  const std::string text = read_file(file);
  Messages messages;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: {}", file.string(), e.what()));
  }
  if (!model || !messages.first().empty())
    throw InputError(fmt::format("{}: {}", file.string(),
                                 messages.first().empty() ? "is no URDF" : messages.first()));
  return model;
}

SE3 to_se3(const urdf::Pose& pose) {
  const auto& q = pose.rotation;
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z),
          {pose.position.x, pose.position.y, pose.position.z}};
}

Link read_link(const urdf::Link& from, const std::filesystem::path& file) {
  Link link{.name = from.name};
  if (!from.inertial) return link;
  const urdf::Inertial& body = *from.inertial;
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: link '{}': {}", file.string(), from.name, what));
  };
  if (!(body.mass >= 0) || std::isinf(body.mass))
    fail(fmt::format("its mass {} kg is not positive", body.mass));
  const SE3 link_from_body = to_se3(body.origin);
  Eigen::Matrix3d inertia;
  inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz,
      body.izz;
  // Principal moments of a body are not negative and none exceeds the sum of the other two.
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  if (!(moments[0] >= 0) || moments[2] > (moments[0] + moments[1]) * (1 + 1e-6))
    fail(fmt::format("no body has the principal moments of inertia {:.6g}, {:.6g}, {:.6g} kg m2",
                     moments[0], moments[1], moments[2]));
  link.mass_kg = body.mass;
  link.centre_m = link_from_body.translation();
  link.inertia_kg_m2 = link_from_body.rotation() * inertia * link_from_body.rotation().transpose();
  return link;
}

Joint read_joint(const urdf::Joint& from, const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: joint '{}': {}", file.string(), from.name, what));
  };
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Joint joint{.name = from.name,
              .parent = from.parent_link_name,
              .child = from.child_link_name,
              .parent_from_child = to_se3(from.parent_to_joint_origin_transform)};
  switch (from.type) {
    case urdf::Joint::FIXED:
      return joint;
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      joint.kind = Joint::Kind::kTurning;
      break;
    case urdf::Joint::PRISMATIC:
      joint.kind = Joint::Kind::kSliding;
      break;
    default:
      fail("is neither fixed, revolute, continuous nor prismatic");
  }
  joint.axis = {from.axis.x, from.axis.y, from.axis.z};
  if (!(joint.axis.norm() > 1e-9)) fail("its axis has no direction");
  joint.axis.normalize();
  joint.lower = -kInf;
  joint.upper = joint.velocity = joint.effort = kInf;
  if (!from.limits) return joint;
  joint.velocity = from.limits->velocity;
  joint.effort = from.limits->effort;
  if (from.type != urdf::Joint::CONTINUOUS) {
    joint.lower = from.limits->lower;
    joint.upper = from.limits->upper;
  }
  if (joint.lower > joint.upper)
    fail(fmt::format("its lower limit {} is above its upper {}", joint.lower, joint.upper));
  if (!(joint.velocity >= 0))
    fail(fmt::format("its velocity limit {} is negative", joint.velocity));
  return joint;
}

/// Joints in an order in which each one's parent link is known before it.
std::vector<Joint> from_root(std::vector<Joint> joints, const std::string& root,
                             const std::filesystem::path& file) {
  std::vector<Joint> ordered;
  std::vector<std::string> known{root};
  for (bool more = true; more && !joints.empty();) {
    more = false;
    for (auto joint = joints.begin(); joint != joints.end();) {
      if (std::ranges::find(known, joint->parent) == known.end()) {
        ++joint;
        continue;
      }
      known.push_back(joint->child);
      ordered.push_back(std::move(*joint));
      joint = joints.erase(joint);
      more = true;
    }
  }
  if (!joints.empty())
    throw InputError(
        fmt::format("{}: joint '{}': link '{}' hangs in a circle of joints, no way "
                    "leads to it from the root '{}'",
                    file.string(), joints.front().name, joints.front().child, root));
  return ordered;
}

}  // namespace

double KinematicTree::mass_kg() const {
  double sum = 0;
  for (const Link& link : links) sum += link.mass_kg;
  return sum;
}

const Joint& KinematicTree::joint(std::string_view wanted) const {
  const auto found = std::ranges::find(joints, wanted, &Joint::name);
  if (found == joints.end())
    throw InputError(fmt::format("robot '{}': has no joint '{}'", name, wanted));
  return *found;
}

SE3 KinematicTree::root_from(std::string_view link,
                             const std::map<std::string, double>& positions) const {
  for (const auto& [moved, position] : positions) joint(moved);
  SE3 link_from_wanted;
  std::string here(link);
  if (std::ranges::find(links, here, &Link::name) == links.end())
    throw InputError(fmt::format("robot '{}': has no link '{}'", name, link));
  while (here != root) {
    const Joint& j = *std::ranges::find(joints, here, &Joint::child);
    const auto moved = positions.find(j.name);
    const double q = moved == positions.end() ? 0.0 : moved->second;
    SE3 motion;
    if (j.kind == Joint::Kind::kTurning) motion = SE3(so3_exp(q * j.axis), Eigen::Vector3d::Zero());
    if (j.kind == Joint::Kind::kSliding) motion = SE3(Eigen::Matrix3d::Identity(), q * j.axis);
    link_from_wanted = j.parent_from_child * motion * link_from_wanted;
    here = j.parent;
  }
  return link_from_wanted;
}

KinematicTree load_urdf(const std::filesystem::path& file) {
  const urdf::ModelInterfaceSharedPtr model = parse(file);
  KinematicTree tree{.name = model->getName(), .root = model->getRoot()->name};
  for (const auto& [name, link] : model->links_) tree.links.push_back(read_link(*link, file));
  std::map<std::string, std::string> joint_of;  // by child
  for (const auto& [name, joint] : model->joints_) {
    const auto [other, first] = joint_of.emplace(joint->child_link_name, name);
    if (!first)
      throw InputError(fmt::format("{}: link '{}' hangs on two joints, '{}' and '{}'",
                                   file.string(), joint->child_link_name, other->second, name));
    tree.joints.push_back(read_joint(*joint, file));
  }
  tree.joints = from_root(std::move(tree.joints), tree.root, file);
  return tree;
}

}  // namespace mh
